"""Measure whole answers about described scenes; write benchmarks/results/described_scenes.json.

make peers-scenes                       (with every peer that can be installed)
python -m benchmarks.described_scenes   (with those that are)

Every example and every scene of the catalogue is answered as the service answers it, from the document to the error
statement, without HTTP and JSON. "set-up" is the same question without times.
"""

from __future__ import annotations

import json
import os
import statistics
import time
import timeit
from collections.abc import Callable
from functools import partial
from importlib import metadata
from typing import Any

import mpmath

from benchmarks.described_scenes.double_pendulum import ENTRANTS, EXACT, Entrant
from benchmarks.described_scenes.drake import PATIENCE, Late
from benchmarks.machine import RESULTS, described
from core.multibody.language.reading import scene_from
from core.multibody.solve import OF_MOTION, solve_scene
from core.systems.budget import Budget
from service.requests.described_scene import DescribedSceneRequest
from service.routes.described_scenes import described_examples, solved

REPEATS = 25
LINKS = (4, 16, 32, 64, 100)
TOO_LONG = 20.0
"""After a run that takes longer (s), dearer settings are left out."""


def installed(package: str) -> bool:
    """Return whether a distribution is there."""
    try:
        metadata.version(package)
    except metadata.PackageNotFoundError:
        return False
    return True


def least(run: Callable[[], Any], repeats: int) -> float:
    """Return the shortest processor time of a call (s), after one that warms up."""
    run()
    spent = []
    for _ in range(repeats):
        since = time.thread_time()
        run()
        spent.append(time.thread_time() - since)
    return min(spent)


def catalogue(repeats: int) -> dict[str, Any]:
    """Return milliseconds of the whole answer and of the set-up, where there is one without times, by scene."""
    rows = {}
    for entry in described_examples():
        document = json.loads(json.dumps(entry["example"]))
        question = DescribedSceneRequest.model_validate(document)
        of_start = [output for output in question.outputs if output not in OF_MOTION] if question.outputs else None
        start = question.model_copy(update={"times": None, "method": None, "round": None, "outputs": of_start})
        runs = {"whole": lambda q=question: solved(q, Budget()), "set-up": lambda q=start: solved(q, Budget())}
        if any(not isinstance(output, str) for output in question.outputs or ()):
            # What is searched along the motion needs times.
            del runs["set-up"]
        rows[entry["name"]] = {name: round(1e3 * least(run, repeats), 3) for name, run in runs.items()}
        rows[entry["name"]]["contacts"] = "phases" in runs["whole"]()
    return rows


def chains(repeats: int) -> dict[str, float]:
    """Return milliseconds of the whole answer about chains of rods for 1 s, released from the horizontal, by links."""
    found = {}
    for count in LINKS:
        scene = scene_from(chain(count))
        found[str(count)] = round(1e3 * least(lambda s=scene: solve_scene(s, [1.0], ("trajectory",), 1e-9), repeats), 2)
    return found


def chain(count: int) -> dict[str, Any]:
    """Return rods of length 1 in a row, each pinned to the one before."""
    places = {"top": [-0.5, 0], "end": [0.5, 0]}
    bodies = {f"rod-{k}": {"mass": 1, "inertia": "1/12", "at": [k + 0.5, 0], "places": places} for k in range(count)}
    pins = [{"kind": "pin", "a": f"rod-{k}.top", "b": f"rod-{k - 1}.end" if k else [0, 0]} for k in range(count)]
    return {"gravity": [0, -9.8125], "bodies": bodies, "connections": pins}


def stiff(repeats: int) -> dict[str, float]:
    """Return milliseconds of whole answers about the governor of the catalogue, its sleeve damped, by times (s)."""
    example = next(entry["example"] for entry in described_examples() if entry["name"] == "centrifugal-governor")
    ends = {"a": "sleeve", "b": [0, -3]}
    held = [
        {"kind": "spring", "name": "spring", **ends, "stiffness": 8e5, "rest_length": 2.2},
        {"kind": "damper", "name": "damper", **ends, "coefficient": 4e4},
    ]
    own = {name: value for name, value in example.items() if name in ("gravity", "bodies")}
    scene = scene_from({**own, "connections": [*example["connections"], *held]})
    found = {}
    for end in (0.1, 1.0, 10.0):
        run = partial(solve_scene, scene, [end], ("trajectory",), 1e-9)
        found[str(end)] = round(1e3 * least(run, repeats), 2)
    return found


def summary(rows: dict[str, Any]) -> dict[str, float]:
    """Return how long whole answers take, and how many there are."""
    whole = [row["whole"] for row in rows.values()]
    return {"scenes": len(rows), "median": statistics.median(whole), "worst": max(whole)}


def dial(entrant: Entrant) -> dict[str, Any]:
    """Return error against milliseconds of one way to compute the double pendulum."""
    points = []
    for setting in entrant.settings:
        since = time.perf_counter()
        try:
            run = entrant.prepare(setting)
            prepared = time.perf_counter() - since
            since = time.perf_counter()
            found = run()
        except Late:
            return {"points": points, "no answer": {"setting": setting, "after": PATIENCE}}
        once = time.perf_counter() - since
        with mpmath.workdps(30):
            error = float(max(abs(x - y) for x, y in zip(entrant.angles(found), EXACT, strict=True)))
        # The shortest of many, because other programs of the machine only ever add.
        seconds = min(timeit.repeat(run, number=1, repeat=REPEATS)) if once < 1.0 else once
        points.append({"setting": setting, "error": error, "milliseconds": 1e3 * seconds, "prepared": 1e3 * prepared})
        if once > TOO_LONG:
            break
    return {"points": points}


def main() -> None:
    """Measure, write and print."""
    before = os.getloadavg()[0]
    there = [entrant for entrant in ENTRANTS if installed(entrant.package)]
    scenes = catalogue(9)
    before_motion = [row["set-up"] for row in scenes.values() if "set-up" in row]
    result = {
        "machine": described(*sorted({entrant.package for entrant in there})),
        "load average": {"before": before, "after": os.getloadavg()[0]},
        "milliseconds": {
            "all": summary(scenes),
            "without contacts": summary({name: row for name, row in scenes.items() if not row["contacts"]}),
            "with contacts": summary({name: row for name, row in scenes.items() if row["contacts"]}),
            "median set-up": statistics.median(before_motion),
            "scenes": scenes,
        },
        "chains, 1 s, milliseconds by links": chains(3),
        "stiff governor, milliseconds by times (s)": stiff(3),
        "double pendulum, 10 s": {entrant.name: dial(entrant) for entrant in there},
    }
    text = json.dumps(result, indent=1) + "\n"
    (RESULTS / "described_scenes.json").write_text(text, encoding="utf-8")
    print(json.dumps({name: result["milliseconds"][name] for name in ("all", "without contacts", "with contacts")}))
    for name, own in result["double pendulum, 10 s"].items():
        for point in own["points"]:
            print(f"{name:48} {point['setting']:8.1e} {point['error']:9.1e} rad {point['milliseconds']:10.2f} ms")


if __name__ == "__main__":
    main()
