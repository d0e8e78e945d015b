"""The inverse of the matrix of random scenes, in doubles and in pairs, against rational arithmetic."""

from __future__ import annotations

import math
from fractions import Fraction
from itertools import pairwise

import numpy as np
import pytest
from flint import fmpq, fmpq_mat

from core.balls import precision
from core.multibody.algebra.polynomials import BITS
from core.multibody.equations.packed import Packed, state
from core.multibody.equations.saddle import CORRECTED, DIRECT, FAILED, inverted, inverted_pairs, saddle_space
from core.multibody.motion.series_pairs import entries_of_lines_pairs
from tests.core.multibody.judge import numerical
from tests.core.multibody.random_scenes import any_scene
from tests.core.multibody.worked_examples import points
from tests.drawn import ALL


def placed(description: dict) -> tuple[Packed, np.ndarray]:
    """Return a table at its start, with the entries of W there."""
    with precision(BITS):
        motion = numerical(description)[0]
        place, _ = state(motion.table, motion.units)
    lines = np.empty((len(motion.arrays.lines), 2))
    entries_of_lines_pairs(motion.arrays, place, lines)
    return motion.arrays, lines


def exact(table: Packed, lines: np.ndarray) -> fmpq_mat:
    n, m = len(table.load), len(table.rate)
    a = [[fmpq(0)] * (n + m) for _ in range(n + m)]
    for i in range(n):
        for j in range(n):
            a[i][j] = rational(table.mass[i, j])
    for e, (r, j) in enumerate(table.lines_at):
        a[j][n + r] -= rational(lines[e])
        if table.binds[e]:
            a[n + r][j] = rational(lines[e])
    return fmpq_mat(a).inv()


def rational(pair: np.ndarray) -> fmpq:
    value = Fraction(float(pair[0])) + Fraction(float(pair[1]))
    return fmpq(value.numerator, value.denominator)


def off(found: np.ndarray, right: fmpq_mat) -> float:
    """Return the largest error of columns of pairs, relative to the largest entry."""
    size = len(found[0])
    pairs = [(fmpq(right[i, j]), rational(found[:, j, i])) for i in range(size) for j in range(size)]
    ratio = max(abs(x - y) for x, y in pairs) / max(abs(x) for x, _ in pairs)
    return float(Fraction(int(ratio.p), int(ratio.q)))


@pytest.mark.parametrize("seed", [0, 1, 3, 5, 8, 16, 23, 30] if ALL else [3, 16])
def test_inverses_are_right_to_doubles_and_to_pairs(seed: int) -> None:
    table, lines = placed(any_scene(seed))
    right = exact(table, lines)
    doubles, pairs = saddle_space(table, 1), saddle_space(table, 2)
    assert inverted(table, np.ascontiguousarray(lines[:, 0]), doubles)
    assert inverted_pairs(table, lines, pairs) == CORRECTED
    both = np.stack([doubles.columns[0], np.zeros_like(doubles.columns[0])])
    assert off(both, right) < 2.0**-40
    assert off(pairs.columns, right) < 2.0**-90


def chain(count: int, *, closed: bool = False) -> dict:
    """Return rods that hang from one another along an arc, of a closed chain the last one also from the ground."""
    at = [(math.sin(0.2 * k), -math.cos(0.2 * k)) for k in range(count + 1)]
    rods, pins = {}, []
    for k, ((x, y), (z, w)) in enumerate(pairwise(at)):
        half, angle = math.hypot(z - x, w - y) / 2, math.atan2(w - y, z - x)
        places = {"top": [-half, 0], "end": [half, 0]}
        middle = [(x + z) / 2, (y + w) / 2]
        rods[f"rod-{k}"] = {"mass": 1 + k % 3, "inertia": 0.1, "at": middle, "angle": angle, "places": places}
        pins.append({"kind": "pin", "a": f"rod-{k}.top", "b": f"rod-{k - 1}.end" if k else list(at[0])})
    if closed:
        pins.append({"kind": "pin", "a": f"rod-{count - 1}.end", "b": list(at[-1])})
    return {"gravity": [0, -10], "bodies": rods, "connections": pins}


def with_friction(table: Packed, lines: np.ndarray) -> tuple[Packed, np.ndarray]:
    """Return a table with forces beside those of some rows that the lines do not have, and its entries."""
    more, at = np.array([[0.1, 0.0], [-0.25, 1e-18]]), np.array([[0, 5], [3, 1]])
    lines_at, binds = np.concatenate([table.lines_at, at]), np.concatenate([table.binds, np.zeros(2, np.int64)])
    return table._replace(lines=np.concatenate([table.lines, more]), lines_at=lines_at, binds=binds), np.concatenate(
        [lines, more]
    )


@pytest.mark.parametrize("closed", [False, True])
@pytest.mark.parametrize("rubbed", [False, True])
def test_large_inverses_by_blocks_are_right_to_doubles_and_to_pairs(closed: bool, rubbed: bool) -> None:
    table, lines = placed(chain(12, closed=closed))
    if rubbed:
        table, lines = with_friction(table, lines)
    doubles, pairs = saddle_space(table, 1), saddle_space(table, 2)
    assert len(pairs.blocks.weights[0]) == len(table.load)
    assert inverted(table, np.ascontiguousarray(lines[:, 0]), doubles)
    assert inverted_pairs(table, lines, pairs) == CORRECTED
    right = exact(table, lines)
    assert off(np.stack([doubles.columns[0], np.zeros_like(doubles.columns[0])]), right) < 2.0**-45
    assert off(pairs.columns, right) < 2.0**-95


def test_large_matrices_whose_mass_has_no_inverse_are_inverted_as_a_whole() -> None:
    table, lines = placed(chain(12))
    mass = table.mass.copy()
    mass[0], mass[:, 0] = 0.0, 0.0
    table = table._replace(mass=mass)
    space = saddle_space(table, 2)
    assert not space.blocks.weights.size
    assert inverted_pairs(table, lines, space) == CORRECTED
    assert off(space.columns, exact(table, lines)) < 2.0**-95


def test_large_matrices_without_an_inverse_have_none() -> None:
    table, lines = placed(chain(12))
    assert inverted_pairs(table, np.zeros_like(lines), saddle_space(table, 2)) == FAILED
    assert not inverted(table, np.zeros(len(lines)), saddle_space(table, 1))


def test_where_doubles_fail_the_elimination_runs_in_pairs() -> None:
    table, lines = placed(points((1, 2), ("0.7", "-1"), (1, "1e-17")))
    space = saddle_space(table, 2)
    assert inverted_pairs(table, lines, space) == DIRECT
    assert off(space.columns, exact(table, lines)) < 2.0**-40


def test_without_an_inverse_none_is_found() -> None:
    table, lines = placed(any_scene(0))
    assert inverted_pairs(table, np.zeros_like(lines), saddle_space(table, 2)) == FAILED
