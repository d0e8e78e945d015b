"""Stated errors of described scenes compared with a series of higher order in pairs of doubles.

    python -m tests.core.multibody.judge 10000

judges so many random motions, at two times each, and writes the figures to benchmarks/results/scene_errors.json. Every
motion is made from its number alone, so that any of them can be judged again.
"""

from __future__ import annotations

import json
import statistics
import sys
from collections.abc import Callable, Iterator, Sequence
from pathlib import Path
from typing import Any

import numpy as np

from core.arrays import Floats
from core.balls import precision
from core.double_double import dd_sub
from core.errors import MechanicsError, NotApplicable
from core.multibody.algebra.polynomials import BITS
from core.multibody.equations.assembly import assemble_places, assemble_rates
from core.multibody.equations.dynamics import accelerations, parts, restricted
from core.multibody.equations.packed import state, two_to
from core.multibody.motion.modelling import followed
from core.multibody.motion.numerical import Numerical
from core.multibody.motion.series import DONE, FULL
from core.multibody.motion.series_pairs import advance_pairs, moved_pairs
from core.multibody.reduction.passes import reduced
from core.multibody.table.description import described
from tests.core.multibody.random_scenes import any_scene, attracted_or_rolling
from tests.core.multibody.worked_examples import read

TARGET = Path(__file__).parents[3] / "benchmarks" / "results" / "scene_errors.json"
KINDS = 11
"""Kinds of random scenes, one after the other."""


def numerical(description: dict[str, Any]) -> list[Numerical]:
    found = described(read(description))
    table = found.measures.table
    assemble_places(table, found.paths)
    assemble_rates(table, found.measures.coordinates.given, found.paths)
    small = reduced(table, pinning=True).table
    motions = []
    for indices in parts(small):
        part = restricted(small, indices)
        gain, chosen = accelerations(part)
        motions.append(followed(part, gain, chosen, "a test"))
    return motions


def judged(motion: Numerical, end: float) -> tuple[Floats, Floats]:
    """Return the state at a time by a series of order 40 whose steps leave out 2^-108."""
    q, v = state(motion.table, motion.units)
    starts, series = np.empty((1001, 2)), np.empty((1000, len(q), 41, 2))
    scaled, clock, ended = end * two_to(-motion.units.time), np.zeros(2), FULL
    # Bodies that pass one another closely take many steps.
    for _ in range(40):
        ended, count = advance_pairs(motion.arrays, q, v, clock, scaled, 2.0**-108, starts, series)
        if ended != FULL:
            break
    if ended != DONE:
        raise NotApplicable("the judge does not reach this time")
    # The last step ends within a rounding of the time; its series is evaluated at the time itself.
    first = starts[count - 1]
    moved_pairs(series[count - 1], *dd_sub(scaled, 0.0, first[0], first[1]), q, v)
    up = np.array([two_to(e) for e in motion.units.lengths])[:, None]
    return q * up, v * up * two_to(-motion.units.time)


def stated_over_true(
    seed: int, runs: Sequence[bool] = (False,), scene: Callable[[int], dict[str, Any]] = any_scene
) -> Iterator[float]:
    """Yield the least of stated over true errors of every part of a random scene at two times, where any is seen.

    Parameters
    ----------
    runs : sequence of bool
        Whether each motion is answered in doubles (False) or in pairs (True).
    scene : callable
        From a seed to a description.

    Raises
    ------
    AssertionError
        If an error is larger than what is stated with the rounding of the answer.
    """
    with precision(BITS):
        for motion in numerical(scene(seed)):
            for t in np.random.default_rng(seed).uniform(-3, 3, 2):
                for finer in runs:
                    found = motion.states(np.array([t]), finer=finer)
                    for value, error, right in zip(
                        (found.q, found.v), (found.q_error, found.v_error), judged(motion, float(t)), strict=True
                    ):
                        true = np.abs((value[0, :, 0] - right[:, 0]) + (value[0, :, 1] - right[:, 1]))
                        size = np.abs(right[:, 0]).max()
                        stated = 1.02 * error[0] + (2.0**-98 if finer else 2.0**-50) * size
                        assert np.all(true <= stated), (seed, t, finer, true, stated)
                        if np.any(true > 2.0**-50 * size):
                            yield float(np.min(stated[true > 0] / true[true > 0]))


def figures(count: int, scene: Callable[[int], dict[str, Any]]) -> dict[str, Any]:
    """Return what is found of so many motions."""
    ratios: list[float] = []
    too_small: list[int] = []
    refused = 0
    for seed in range(count):
        try:
            ratios.extend(stated_over_true(seed, scene=scene))
        except AssertionError:
            too_small.append(seed)
        except MechanicsError:
            refused += 1
    return {
        "motions": count,
        "stated_too_small": too_small,
        "refused": refused,
        "above_rounding": len(ratios),
        "stated_over_true": {"least": min(ratios), "median": statistics.median(ratios)},
    }


def main(count: int) -> None:
    """Judge, write and print."""
    others = figures(7 * count // 50, attracted_or_rolling)
    result = figures(count, any_scene) | {"attracted_or_rolling": others}
    TARGET.write_text(json.dumps(result, indent=1) + "\n", encoding="utf-8")
    sys.stdout.write(f"{result}\n")


if __name__ == "__main__":
    main(int(sys.argv[1]))
