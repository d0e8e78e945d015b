"""What a benchmark ran on, and how it measures."""

from __future__ import annotations

import os
import platform
import statistics
import time
from collections.abc import Callable
from importlib import metadata
from pathlib import Path
from typing import Any

RESULTS = Path(__file__).parent / "results"


def described(*packages: str) -> dict[str, Any]:
    """Return processor, cores, Python and the versions of packages."""
    model = ""
    if Path("/proc/cpuinfo").exists():
        lines = Path("/proc/cpuinfo").read_text().splitlines()
        model = next((line.split(":")[1].strip() for line in lines if line.startswith("model name")), "")
    versions = {package: metadata.version(package) for package in packages}
    return {"processor": model, "cores": os.cpu_count(), "python": platform.python_version(), "versions": versions}


def medians(runs: dict[str, Callable[[], object]], repeats: int, least: float = 2e-3) -> dict[str, float]:
    """Return the median time of each run (s), all taken in turn so that a drifting machine drifts for all.

    Short runs are repeated within one measurement until it lasts `least` seconds.
    """
    once = {}
    for name, run in runs.items():
        run()
        start = time.perf_counter()
        run()
        once[name] = time.perf_counter() - start
    return medians_in_turn(runs, once, lambda _: repeats, least)


def medians_in_turn(
    runs: dict[str, Callable[[], object]],
    once: dict[str, float],
    repeats: Callable[[float], int],
    least: float = 2e-3,
) -> dict[str, float]:
    """Return the median time of each run (s) as `medians` does, for runs that are warm and take about `once` seconds.

    `repeats` says how often to take one, given how long it takes.
    """
    loops = {name: max(1, int(least / max(once[name], 1e-9))) for name in runs}
    wanted = {name: repeats(once[name]) for name in runs}
    spent: dict[str, list[float]] = {name: [] for name in runs}
    for turn in range(max(wanted.values(), default=0)):
        for name, run in runs.items():
            if turn < wanted[name]:
                if loops[name] > 1:
                    # The runs between have emptied the caches; a long run fills them again by itself.
                    run()
                start = time.perf_counter()
                for _ in range(loops[name]):
                    run()
                spent[name].append((time.perf_counter() - start) / loops[name])
    return {name: statistics.median(times) for name, times in spent.items()}


T_HANDLE = {"kind": "principal-moments", "moments": [795.7921810699588, 713.5092592592592, 395.7829218106996]}
"""The body of most measurements."""
