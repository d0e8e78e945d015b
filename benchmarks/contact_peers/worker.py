"""One run of one engine, in a process of its own: python -m benchmarks.contact_peers.worker ENGINE CASE SETTING."""

from __future__ import annotations

import json
import statistics
import sys
import time
from collections.abc import Callable
from dataclasses import dataclass
from functools import partial
from importlib import metadata
from typing import Any

from benchmarks.contact_peers import bullet_engine, drake_engine, mujoco_engine, ours
from benchmarks.contact_peers.cases import CASES, ContactCase
from benchmarks.contact_peers.observed import Step, figures

STEPS = (1e-2, 1e-3, 1e-4, 1e-5)
ACCURACIES = (1e-3, 1e-5, 1e-7, 1e-9)
OURS = "Polhode"


@dataclass(frozen=True)
class Engine:
    """A way to compute a case.

    Attributes
    ----------
    package : str
        The distribution that has to be installed.
    setting : str
        What is swept.
    """

    name: str
    package: str
    setting: str
    settings: tuple[float, ...]
    prepare: Callable[..., Any]

    @property
    def installed(self) -> bool:
        """Whether its distribution is there."""
        try:
            metadata.version(self.package)
        except metadata.PackageNotFoundError:
            return False
        return True


ENGINES = (
    Engine(OURS, "numpy", "accuracy", (1e-9,), ours.prepared),
    Engine("MuJoCo, defaults", "mujoco", "step (s)", STEPS, partial(mujoco_engine.prepared, stiff=False)),
    Engine("MuJoCo, stiff contacts", "mujoco", "step (s)", STEPS, partial(mujoco_engine.prepared, stiff=True)),
    Engine("Drake, discrete, SAP", "drake", "step (s)", STEPS, partial(drake_engine.prepared, kind="sap")),
    Engine("Drake, discrete, lagged", "drake", "step (s)", STEPS, partial(drake_engine.prepared, kind="lagged")),
    Engine(
        "Drake, continuous, RK3", "drake", "accuracy", ACCURACIES, partial(drake_engine.prepared, kind="runge_kutta3")
    ),
    Engine("Drake, continuous, CENIC", "drake", "accuracy", ACCURACIES, partial(drake_engine.prepared, kind="cenic")),
    Engine("PyBullet", "pybullet", "step (s)", STEPS, partial(bullet_engine.prepared, reach=0.02)),
    Engine("PyBullet, contacts near", "pybullet", "step (s)", STEPS, partial(bullet_engine.prepared, reach=1e-4)),
)

AGAIN = 0.5
"""A run that takes longer (s) is taken once."""


def timed(run: Callable[[], Any]) -> tuple[Any, float]:
    """Return what a warm run returns, and the median of its time (s)."""
    since = time.perf_counter()
    found = run()
    once = time.perf_counter() - since
    if once > AGAIN:
        return found, once
    spent = []
    for _ in range(5):
        since = time.perf_counter()
        found = run()
        spent.append(time.perf_counter() - since)
    return found, statistics.median(spent)


def point(engine: Engine, case: ContactCase, setting: float) -> dict[str, Any]:
    """Return what one run gives."""
    run = engine.prepare(case, setting)
    if engine.name == OURS:
        # What is compiled at the first run is no part of it.
        run()
        answer, seconds = timed(run)
        found, stated, said = ours.measured(case, answer)
        return {"milliseconds": 1e3 * seconds, "figures": found, "stated": stated, "says": said}
    final, seconds = timed(lambda: run(None))
    steps: list[Step] = []
    run(steps)
    return {"milliseconds": 1e3 * seconds, "steps": len(steps), "figures": figures(case, final, steps)}


def main() -> None:
    """Do as the command line says; the last line of the output is the result."""
    name, case, setting = sys.argv[1:]
    engine = next(one for one in ENGINES if one.name == name)
    print(json.dumps(point(engine, next(one for one in CASES if one.name == case), float(setting))))


if __name__ == "__main__":
    main()
