"""How many answers to random scenes the audit refuses, and what it costs.

    python -m tests.core.multibody.audit.judge COUNT [FIRST]

Right answers should all pass; what is refused is printed, with its seed, to be looked into. Scenes are numbered, so
that many of them may be answered in pieces.
"""

from __future__ import annotations

import json
import sys
from collections import Counter
from collections.abc import Callable
from statistics import median
from time import thread_time
from typing import Any

import numpy as np

import core.multibody.solve as solving
from core.errors import MechanicsError, SelfCheckFailed
from core.multibody.language.reading import scene_from
from tests.core.multibody import contact_judge, random_scenes
from tests.core.multibody.random_laws import with_law
from tests.core.multibody.relations import combined_scenes

OUTPUTS = ("accelerations", "forces", "energy", "trajectory")
SOURCES: tuple[Callable[[int], dict[str, Any]], ...] = (
    random_scenes.any_scene,
    random_scenes.attracted_or_rolling,
    contact_judge.any_scene,
    combined_scenes.plane,
    combined_scenes.space,
)


def main(count: int, first: int = 0) -> None:
    """Answer `count` scenes, print the refused ones, their number, and the share of the audit in the time."""
    found: Counter[str] = Counter()
    shares: list[float] = []
    own = solving.audited
    for number in range(first, first + count):
        source, seed = SOURCES[number % len(SOURCES)], number // len(SOURCES)
        times = np.linspace(0.0, float(np.random.default_rng(seed).choice([0.5, 2.0, 10.0])), 21)
        spent = 0.0

        def timed(*given: Any) -> Any:
            nonlocal spent
            begin = thread_time()
            failure = own(*given)
            spent += thread_time() - begin
            return failure

        solving.audited = timed
        begin = thread_time()
        try:
            solving.solve_scene(scene_from(with_law(source(seed), number)), times, OUTPUTS, 1e-6)
            found["passed"] += 1
            shares.append(spent / max(thread_time() - begin - spent, 1e-9))
        except SelfCheckFailed as failure:
            found["refused by the audit"] += 1
            sys.stdout.write(f"{source.__module__}.{source.__name__}({seed}): {failure.detail}\n")
        except MechanicsError:
            found["refused before"] += 1
        finally:
            solving.audited = own
    sys.stdout.write(json.dumps({**found, "median share of the audit": median(shares)}) + "\n")


if __name__ == "__main__":
    main(*map(int, sys.argv[1:]))
