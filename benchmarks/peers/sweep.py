"""One case asked of every peer with every setting."""

from __future__ import annotations

import math
import time
from collections.abc import Sequence
from typing import Any

import numpy as np

from benchmarks.machine import medians_in_turn
from benchmarks.peers.cases import Case
from benchmarks.peers.measures import measured
from benchmarks.peers.peer import Peer, Run
from benchmarks.peers.reference import confirmed, reference
from core.bodies.mass_properties import PrincipalInertia
from core.rotation.free_rotation import FreeRotation

TOO_LONG = 2.5
"""After a run that takes longer (s), a peer's dearer settings are left out."""

TAKEN_ONCE = 0.7
"""A run that takes longer (s) is not repeated: it is warm from the settings before, and hides no start-up."""

SHORT = 0.02
"""Runs that are shorter (s) are repeated most, and are tried thrice to see how short they are."""

QUICK = 0.2
"""What is too long in a quick trial (s)."""


def repeats(once: float) -> int:
    """Return how often a run that takes `once` seconds is taken for its median."""
    return 15 if once < SHORT else 5 if once < 0.2 else 3


def seconds(run: Run) -> float:
    """Return the time of one run."""
    start = time.perf_counter()
    run()
    return time.perf_counter() - start


def measure(case: Case, peers: Sequence[Peer], quick: bool) -> dict[str, Any]:
    """Return the points of every peer, each with errors, drifts, the median time and the time of the set-up."""
    times = case.times
    true = reference(case, times)
    found: dict[str, Any] = {
        "moments": case.moments,
        "start": case.start,
        "stop": case.stop,
        "note": case.note,
        "references apart": confirmed(case, times, true),
        "inherited": FreeRotation(PrincipalInertia.of(np.diag(case.moments)), np.array(case.start)).inherited(times),
        "peers": {},
    }
    runs: dict[str, Run] = {}
    once: dict[str, float] = {}
    firsts: dict[str, float] = {}
    points: dict[str, dict[str, Any]] = {}
    for peer in peers:
        if not peer.answers(case) or peer.version is None:
            continue
        own = found["peers"][peer.name] = {"setting": peer.setting, "points": []}
        settings = (peer.settings[0], peer.settings[len(peer.settings) // 2])[: len(peer.settings)]
        for setting in settings if quick else peer.settings:
            point: dict[str, Any] = {"setting": setting}
            own["points"].append(point)
            try:
                begun = time.perf_counter()
                run = peer.prepare(case, setting)
                prepared = time.perf_counter()
                states = run()
                done = time.perf_counter()
                point |= measured(case, states, true)
            except Exception as failure:
                # Whatever a library refuses with is its answer, and the page says so.
                point["failure"] = f"{type(failure).__name__}: {failure}".splitlines()[0][:200]
                continue
            spent = done - prepared
            if spent > TAKEN_ONCE and len(own["points"]) == 1:
                # The first run of all may compile.
                spent = seconds(run)
            if spent > TAKEN_ONCE:
                point["milliseconds"] = 1e3 * spent
                point["set-up milliseconds"] = 1e3 * (prepared - begun)
            else:
                key = f"{peer.name}, {setting:g}"
                once[key] = min(seconds(run) for _ in range(3)) if spent < SHORT else seconds(run)
                runs[key], points[key], firsts[key] = run, point, done - begun
            if spent > (QUICK if quick else TOO_LONG):
                own["left out"] = list(peer.settings[peer.settings.index(setting) + 1 :])
                break
    for key, median in medians_in_turn(runs, once, (lambda _: 3) if quick else repeats).items():
        points[key]["milliseconds"] = 1e3 * median
        points[key]["set-up milliseconds"] = max(0.0, 1e3 * (firsts[key] - median))
    return found


def best(points: Sequence[dict[str, Any]], error: float = math.inf) -> dict[str, Any] | None:
    """Return the fastest point that reaches an error, None if none does."""
    reached = [point for point in points if point.get("error", math.inf) <= error]
    return min(reached, key=lambda point: point["milliseconds"], default=None)


def closest(points: Sequence[dict[str, Any]]) -> dict[str, Any] | None:
    """Return the point with the smallest error, None if all failed."""
    return min((p for p in points if "error" in p), key=lambda point: point["error"], default=None)
