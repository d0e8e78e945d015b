"""Many random scenes, or the whole catalogue, answered by the product and by the plain engine.

    python -m tests.oracles.plain_engine.comparison.run 1000 0

compares 1000 scenes from seed 0 on, one after another; with `changes` in front of the numbers, scenes in which
connections begin and end and blows fall. The figures are written to benchmarks/results/plain_engine.json, or another
file: counts by class, with a seed that shows each.
"""

from __future__ import annotations

import json
import sys
import time
from collections import Counter
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np

from tests.oracles.plain_engine.comparison.changing_scenes import changing_scene_of
from tests.oracles.plain_engine.comparison.comparing import Verdict, compared
from tests.oracles.plain_engine.comparison.drawing import Json
from tests.oracles.plain_engine.comparison.scenes import scene_of

RESULTS = Path(__file__).parents[4] / "benchmarks" / "results"
CATALOGUE = Path(__file__).parents[4] / "examples" / "scenes"
SEEDS = 8
"""Seeds that are listed of each class."""
KEPT = ("gravity", "let", "bodies", "connections", "numbers", "impacts", "simultaneous")
"""What a motion depends on."""
LATEST = 1.5
"""Last time at which scenes of the catalogue are compared (s)."""


def classes_of(verdict: Verdict) -> str:
    """Return the class of what came of a scene, "" where both answers agree."""
    if verdict.not_supported:
        return f"not supported by the plain engine: {verdict.not_supported}"[:120]
    if verdict.differences:
        one = verdict.differences[0]
        return f"{one.what}: {one.detail}"
    return ""


def figures(
    count: int, first: int = 0, out: Path | None = None, source: Callable[[int], tuple[Json, list[float]]] = scene_of
) -> dict[str, Any]:
    """Return counts by class of many scenes, and write them as they grow."""
    total: Counter[str] = Counter()
    seeds: dict[str, list[int]] = {}
    shown: dict[str, Any] = {}
    begun = time.perf_counter()
    found: dict[str, Any] = {}
    for seed in range(first, first + count):
        scene, times = source(seed)
        try:
            verdict = compared(scene, times)
            name = classes_of(verdict)
        except Exception as fault:
            # Faults of the plain engine itself, and of the product where it has no name for them, are counted, too.
            verdict, name = Verdict(), f"failed: {type(fault).__name__}: {fault}"[:120]
        total[name or "agree"] += 1
        if name:
            seeds.setdefault(name, []).append(seed)
        if verdict.differences and name not in shown:
            one = verdict.differences[0]
            shown[name] = {"seed": seed, "right": repr(one.right)[:300], "answered": repr(one.answered)[:300]}
        found = {
            "scenes": seed + 1 - first,
            "first_seed": first,
            "agree": total["agree"],
            "classes": [
                {"class": name, "count": n, "seeds": seeds[name][:SEEDS], **shown.get(name, {})}
                for name, n in total.most_common()
                if name != "agree"
            ],
        }
        if out is not None and (seed % 5 == 0 or seed + 1 == first + count):
            out.write_text(json.dumps(found, indent=1, default=str) + "\n")
    print(f"{count} scenes in {time.perf_counter() - begun:.0f} s, {total['agree']} agree")  # noqa: T201
    return found


def catalogue() -> dict[str, str]:
    """Return what came of each worked scene, where both answers do not agree."""
    found = {}
    for path in sorted(CATALOGUE.glob("*.json")):
        described = json.loads(path.read_text())
        times = described.get("times", [0.5])
        if isinstance(times, dict):
            times = np.linspace(times["start"], times["stop"], times["count"]).tolist()
        wanted = sorted({0.0, *(float(t) for t in times if 0.0 <= float(t) <= LATEST)})[:6]
        scene = {key: described[key] for key in KEPT if key in described}
        name = classes_of(compared(scene, wanted if len(wanted) > 1 else [0.0, 0.1]))
        if name:
            found[path.stem] = name
    return found


SOURCES = {"scenes": scene_of, "changes": changing_scene_of}

if __name__ == "__main__":
    arguments = sys.argv[1:]
    if arguments == ["catalogue"]:
        print(json.dumps(catalogue(), indent=1))  # noqa: T201
    else:
        drawn = SOURCES[arguments.pop(0) if arguments[0] in SOURCES else "scenes"]
        target = RESULTS / (arguments[2] if len(arguments) > 2 else "plain_engine.json")
        figures(int(arguments[0]), int(arguments[1]) if len(arguments) > 1 else 0, target, drawn)
