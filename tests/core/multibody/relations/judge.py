"""Relations between answers, counted over many scenes.

    python -m tests.core.multibody.relations.judge 20000

tries so many relations on random scenes, four on each, every relation on every scene of the catalogue, and all pairs of
scenes of the catalogue side by side; the figures are written to benchmarks/results/relations.json.
"""

from __future__ import annotations

import json
import math
import signal
import sys
import time
from collections import Counter, defaultdict
from collections.abc import Callable, Iterator, Mapping
from functools import partial
from itertools import combinations
from pathlib import Path
from typing import Any

from tests.core.multibody.relations.comparison import Difference, differences
from tests.core.multibody.relations.hard_scenes import hard_scenes
from tests.core.multibody.relations.numbers import Json
from tests.core.multibody.relations.relations import (
    NAMES,
    RELATIONS,
    answered,
    checked,
    checked_by_digits,
)
from tests.core.multibody.relations.sources import catalogue, random_scene, side_by_side
from tests.core.multibody.relations.views import Refusal, View, viewed

TARGET = Path(__file__).parents[4] / "benchmarks" / "results" / "relations.json"
SHOWN = 8
"""Scenes that are named for every kind of difference."""

EACH = 4
"""Relations that are tried on each random scene."""
LONGEST = 20
"""Processor time (s) after which a comparison is given up, and counted."""


class TimeUp(BaseException):
    """A comparison takes too long."""


def limited(compare: Callable[..., list[Difference] | None], *inputs: Any) -> list[Difference] | None:
    """Return what a comparison finds within the time that it may take."""

    def stop(*_: object) -> None:
        raise TimeUp

    signal.signal(signal.SIGPROF, stop)
    signal.setitimer(signal.ITIMER_PROF, LONGEST)
    try:
        return compare(*inputs)
    except TimeUp:
        return [Difference("no answer in time", f"{LONGEST} s", math.inf)]
    finally:
        signal.setitimer(signal.ITIMER_PROF, 0)


Found = tuple[str, str, list[Difference] | None]


def of_random_scenes(first: int, count: int) -> Iterator[Found]:
    """Yield the scene, the relation and the differences for a number of pairs; the relations take turns."""
    for number in range(0, count, EACH):
        seed = first + number // EACH
        scene = random_scene(seed)
        alone: list[View | Refusal] = []
        for k in range(EACH):
            # Five sources take turns as well: consecutive rounds of them meet every relation.
            relation = NAMES[(EACH * seed + k + seed // len(NAMES)) % len(NAMES)]
            yield f"seed {seed}", relation, limited(_of_random_scene, scene, relation, seed, alone)


def _of_random_scene(scene: Json, relation: str, seed: int, alone: list[View | Refusal]) -> list[Difference] | None:
    """Return the differences by a relation; what the scene is by itself is answered once for all of them."""
    if not alone:
        alone.append(viewed(partial(answered, scene)))
    return checked(scene, relation, seed, *alone)


def of_digits(first: int, count: int) -> Iterator[Found]:
    """Yield the differences of random scenes from their proven digits, where there are any."""
    for seed in range(first, first + count):
        yield f"seed {seed}", "with proven digits", limited(checked_by_digits, random_scene(seed))


def of_all_relations(scenes: Mapping[str, Json]) -> Iterator[Found]:
    """Yield the differences of every scene by every relation."""
    for name, scene in scenes.items():
        for relation in RELATIONS:
            found = limited(checked, scene, relation)
            yield name, relation, found
            if any(one.kind == "no answer in time" for one in found or ()):
                break


def of_pairs() -> Iterator[Found]:
    """Yield the differences between scenes of the catalogue alone and side by side."""
    scenes = catalogue()
    alone: dict[str, View | Refusal] = {}
    for one, other in combinations(scenes, 2):
        both = side_by_side(scenes[one], scenes[other])
        if both is None:
            continue
        both["times"] = scenes[one]["times"]
        if one not in alone:
            alone[one] = viewed(partial(answered, scenes[one]))
        yield f"{one} beside {other}", "side by side", limited(_beside, alone[one], both)


def _beside(alone: View | Refusal, request: Json) -> list[Difference]:
    """Return the differences of a scene beside another from what it is alone."""
    both = viewed(lambda: answered(request))
    if isinstance(alone, Refusal) or isinstance(both, Refusal):
        return [] if isinstance(alone, Refusal) else differences(alone, both)
    of_all = ("momentum", "angular_momentum", "kinetic", "potential", "total")
    own = alone.mapped(lambda one: None if one.what in of_all and one.owner in ("", "energy") else one)
    kept = {
        "figures": {key: one for key, one in both.figures.items() if key in own.figures},
        "events": [event for event in both.events if event.name in {known.name for known in own.events}],
        "models": [model for model in own.models if model in both.models],
    }
    ended = both.ended[1] if both.ended else math.inf
    found = View(**{**vars(both), **kept, "ended": own.ended, "problem": own.problem})
    own = View(**{**vars(own), "events": [event for event in own.events if event.time <= ended]})
    return differences(own, found)


def summary(results: Iterator[Found]) -> dict[str, Any]:
    """Return how many scenes were tried, and what differed how often and where."""
    tried: Counter[str] = Counter()
    wrong: Counter[str] = Counter()
    kinds: dict[str, Counter[str]] = defaultdict(Counter)
    shown: dict[str, list[str]] = defaultdict(list)
    worst: dict[str, float] = defaultdict(float)
    for scene, relation, found in _until_stopped(results):
        if found is None:
            continue
        tried[relation] += 1
        wrong[relation] += bool(found)
        for kind in {one.kind for one in found}:
            kinds[kind][relation] += 1
            first = max((one for one in found if one.kind == kind), key=lambda one: one.ratio)
            if math.isfinite(first.ratio):
                worst[kind] = max(worst[kind], first.ratio)
            if sum(relation in entry for entry in shown[kind]) < SHOWN:
                shown[kind].append(f"{scene}, {relation}: {first.where} ({first.ratio:.3g})")
    return {
        "tried": sum(tried.values()),
        "different": sum(wrong.values()),
        "by_relation": {name: {"tried": tried[name], "different": wrong[name]} for name in tried},
        "by_kind": {
            kind: {
                "scenes": sum(counts.values()),
                "relations": dict(counts),
                "largest_over_stated": worst[kind],
                "where": sorted(shown[kind]),
            }
            for kind, counts in sorted(kinds.items())
        },
    }


def _until_stopped(results: Iterator[Found]) -> Iterator[Found]:
    """Yield results until the process is asked to end: what is found so far is written then."""
    stopped: list[int] = []
    signal.signal(signal.SIGTERM, lambda number, _: stopped.append(number))
    for entry in results:
        yield entry
        if stopped:
            return


def main() -> None:
    count = int(sys.argv[1])
    first = int(sys.argv[2]) if len(sys.argv) > 2 else 0
    parts = sys.argv[3].split(",") if len(sys.argv) > 3 else ["hard", "random", "catalogue", "pairs", "digits"]
    target = Path(sys.argv[4]) if len(sys.argv) > 4 else TARGET
    found: dict[str, Any] = {"first_seed": first, "seeds": count}
    sources = {
        "random": lambda: of_random_scenes(first, count),
        "catalogue": lambda: of_all_relations(catalogue()),
        "hard": lambda: of_all_relations(hard_scenes()),
        "pairs": of_pairs,
        "digits": lambda: of_digits(first, max(1, count // 20)),
    }
    for part in parts:
        began = time.process_time()
        found[part] = summary(sources[part]())
        found[part]["processor_seconds"] = round(time.process_time() - began)
        target.write_text(json.dumps(found, indent=2) + "\n")


if __name__ == "__main__":
    main()
