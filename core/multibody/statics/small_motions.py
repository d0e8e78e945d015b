"""Small motions near a place of rest, in balls: their characteristic roots, and whether they stay small.

With Z the directions that the rows leave free, they are those of Z^T M Z, Z^T D Z, gyroscopic terms included, and
Z^T (K - sum lambda dW) Z.
"""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np
from flint import acb, acb_mat, arb, arb_mat

from core.multibody.algebra.characteristic_roots import roots_but_zero
from core.multibody.algebra.polynomials import ONE, ZERO, Ball, is_zero
from core.multibody.algebra.rank import Elimination
from core.multibody.algebra.spectrum import spectrum
from core.multibody.motion.motion import Mode
from core.multibody.statics.exact_places import ExactPlace, RestEquations
from core.multibody.statics.mode_shapes import Change, change_along, matched, vectors_of
from core.multibody.table.table import Table
from core.work import spend

_UNITS_OF_MODES = 0.4
"""Units of work (`core.work`) for characteristic roots, times the cube of their number."""

_SOFT = 2.0**-6
"""Share of the terms of a stiffness that is left of them in a soft direction."""


class SoftDirection(NamedTuple):
    """A direction as changes of the coordinates, and the share that is left of the terms of its stiffness."""

    change: list[float]
    share: float


class SmallMotions(NamedTuple):
    """Modes near a place of rest, the change of coordinates in each as far as it is one, and whether it is stable.

    None where they do not decide.
    """

    modes: list[Mode]
    changes: list[Change | None]
    stable: bool | None


def small_motions(equations: RestEquations, place: ExactPlace) -> SmallMotions:
    """Return the small motions near a place of rest.

    Raises
    ------
    ValueError
        Where different roots are too close to be told apart.
    """
    directions = _directions(equations, place)
    if not directions:
        return SmallMotions([], [], True)
    mass, damping = _mass(equations.table), _damping(equations.table, place.q)
    m, d, k = (_projected(matrix, directions) for matrix in (mass, damping, equations.stiffness(place.multipliers)))
    size = len(directions)
    inverse = arb_mat(m).inv()
    stiff = inverse * arb_mat(k)
    symmetric = all(is_zero(k[i][j] - k[j][i]) for i in range(size) for j in range(i))
    if symmetric and all(is_zero(x) for row in d for x in row):
        squares = sorted(_squares(stiff), key=lambda x: float(x.mid()))
        modes = [Mode(_root(x), ZERO) if not x < 0 else Mode(ZERO, _root(-x)) for x in squares]
        lowest = squares[0]
        vectors = [(_root_of_square(square), vector) for square, vector in vectors_of(stiff, size)]
        stable = True if lowest > 0 else (False if lowest < 0 else None)
        return SmallMotions(modes, _changes(modes, vectors, directions), stable)
    damped = inverse * arb_mat(d)
    real_system = arb_mat(
        [[ONE if j == size + i else ZERO for j in range(2 * size)] for i in range(size)]
        + [[-stiff[i, j] for j in range(size)] + [-damped[i, j] for j in range(size)] for i in range(size)]
    )
    roots = _roots(acb_mat(real_system), 2 * size)
    kept = [root for root in roots if is_zero(root.imag) or root.imag > 0]
    kept.sort(key=lambda root: (float(root.imag.mid()), float(root.real.mid())))
    modes = [Mode(root.imag, root.real) for root in kept]
    changes = _changes(modes, vectors_of(real_system, size), directions)
    if any(root.real > 0 for root in roots):
        return SmallMotions(modes, changes, False)
    if all(root.real < 0 for root in roots):
        return SmallMotions(modes, changes, True)
    # Damping and gyroscopic terms cannot destroy a minimum of the potential.
    return SmallMotions(modes, changes, True if symmetric and _positive_definite(k) else None)


def _changes(
    modes: list[Mode], vectors: list[tuple[Any, list[Any]]], directions: list[dict[int, Ball]]
) -> list[Change | None]:
    found = matched(modes, vectors)
    return [None if vector is None else change_along(directions, vector) for vector in found]


def _root_of_square(square: Any) -> Any:
    """Return the root with which a mode of an angular frequency with this square is listed."""
    root = _root(abs(square.real))
    return acb(0, root) if not square.real < 0 else acb(root, 0)


def soft_directions(equations: RestEquations, place: ExactPlace) -> list[SoftDirection]:
    """Return the directions in which hardly any force brings a scene back.

    Beside a bifurcation there is one, and other places of rest lie along it.
    """
    directions = _directions(equations, place)
    if not directions:
        return []
    stiffness = equations.stiffness(place.multipliers)
    masses = np.array(_in_doubles(_projected(_mass(equations.table), directions)))
    forces = np.array(_in_doubles(_projected(stiffness, directions)))
    # The size of the terms that cancel where a direction is soft.
    plain = equations.stiffness([ZERO] * len(place.multipliers))
    held = [[x - y for x, y in zip(*rows, strict=True)] for rows in zip(stiffness, plain, strict=True)]
    sizes = sum(np.abs(_in_doubles(_projected(one, directions))) for one in (plain, held))
    scale = np.sqrt(np.diag(masses))
    if not (np.isfinite(forces).all() and (scale > 0.0).all()):
        return []
    even = np.outer(scale, scale)
    values, vectors = np.linalg.eigh((forces + forces.T) / (2.0 * even))
    most = float(np.max(sizes / even, initial=0.0))
    found = []
    for k in np.flatnonzero(np.abs(values) <= _SOFT * most):
        weights = (vectors[:, k] / scale).tolist()
        change = [
            float(sum(x * float(one[i]) for x, one in zip(weights, directions, strict=True) if i in one))
            for i in range(equations.count)
        ]
        found.append(SoftDirection(change, abs(float(values[k])) / most))
    return found


def _in_doubles(matrix: list[list[Ball]]) -> list[list[float]]:
    return [[float(x.mid()) for x in row] for row in matrix]


def _directions(equations: RestEquations, place: ExactPlace) -> list[dict[int, Ball]]:
    """Return a basis of what the rows leave free: each vector moves one coordinate and those that depend on it."""
    elimination = Elimination()
    for line in equations.lines(place.q):
        elimination.add({j: x for j, x in line.items() if not is_zero(x)}, ZERO)
    free = [j for j in range(equations.count) if j not in elimination.pivots]
    return [{f: ONE, **{j: -line[f] for j, (line, _) in elimination.pivots.items() if f in line}} for f in free]


def _mass(table: Table) -> dict[tuple[int, int], Ball]:
    return table.mass | {(j, i): x for (i, j), x in table.mass.items()}


def _damping(table: Table, q: list[Ball]) -> dict[tuple[int, int], Ball]:
    found = dict(table.damping)
    for (i, j, k), value in table.gyration.items():
        found[i, k] = found.get((i, k), ZERO) - value * q[j]
    return found


def _projected(matrix: Any, directions: list[dict[int, Ball]]) -> list[list[Ball]]:
    """Return Z^T A Z for a matrix as rows or by its entries."""
    entries = (
        list(matrix.items())
        if isinstance(matrix, dict)
        else [((i, j), x) for i, row in enumerate(matrix) for j, x in enumerate(row)]
    )
    return [
        [sum((a[i] * x * b[j] for (i, j), x in entries if i in a and j in b), ZERO) for b in directions]
        for a in directions
    ]


def _squares(matrix: Any) -> list[Ball]:
    """Return the roots of M^-1 K, which are real: squares of angular frequencies."""
    size = matrix.nrows()
    found = spectrum(matrix)
    if found is not None and all(isinstance(x, arb) for x in found[0]):
        return list(found[0])
    return [root.real for root in _roots(acb_mat(matrix), size)]


def _roots(matrix: Any, size: int) -> list[Any]:
    """Return the characteristic roots of a matrix."""
    spend(_UNITS_OF_MODES * size**3)
    try:
        found: list[Any] = matrix.eig(multiple=True)
    except ValueError:
        found = roots_but_zero(matrix)
        found += [acb(0)] * (size - len(found))
    return found


def _root(square: Ball) -> Ball:
    """Return the square root of a number that is not negative, as far as it is known."""
    if square > 0:
        return square.sqrt()
    upper = abs(square).upper().sqrt()
    return arb(0, upper)


def _positive_definite(matrix: list[list[Ball]]) -> bool:
    """Return whether all pivots of a symmetric matrix are positive."""
    rows = [list(row) for row in matrix]
    for k in range(len(rows)):
        if not rows[k][k] > 0:
            return False
        for i in range(k + 1, len(rows)):
            factor = rows[i][k] / rows[k][k]
            rows[i] = [x - factor * y for x, y in zip(rows[i], rows[k], strict=True)]
    return True
