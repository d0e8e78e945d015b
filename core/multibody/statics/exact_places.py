"""Places of rest in balls: what doubles find is refined by Newton's method, and enclosed by Krawczyk's.

An enclosure proves that one solution lies in it. Where the equations leave unknowns open, as the angle of a wheel,
these stay as doubles found them, and the place is one of many: what is left of the equations that depend on the others
has to be zero. Where it is not, the solution is a multiple one, such as a pendulum at its critical rate. Newton's
method comes to it by a constant share of the way in every step, and its error is what is left of that way.

References
----------
R. Krawczyk, "Newton-Algorithmen zur Bestimmung von Nullstellen mit Fehlerschranken", Computing 4 (1969).
L. B. Rall, "Convergence of the Newton process to multiple solutions", Numerische Mathematik 9 (1966).
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from flint import arb, arb_mat, ctx

from core.arrays import Floats
from core.multibody.algebra.directions import polar_angle
from core.multibody.algebra.pivoting import pivoted
from core.multibody.algebra.polynomials import ZERO, Ball, Poly, evaluated, is_zero
from core.multibody.table.table import Row, Table
from core.work import spend

_OPEN = 1e-7
"""Share of the largest singular value below which doubles take an unknown to be left open, to be decided in balls."""
_SCALINGS = 24
"""Each takes the root of what a row or column is off by: masses of 1e300 beside 1 are even after some twenty."""
_STEPS = 14
"""Newton's method doubles the digits in each: from three to more than 320 bits."""
_BLOCK, _SLOW_BLOCKS = 6, 64
"""Beside a solution of multiplicity three Newton's steps go a third of the way on the average, and are uneven: they are
taken together by six. So many blocks lead from 1e-9 to 1e-40 at a multiplicity of ten."""
_GUARD_OF_A_STEP = 40
"""Bits of the precision that rounding may take of a step."""
_FOLLOWED_TO = 2.0**-90
"""Share of the scene's size to which a multiple solution is followed: of multiplicity three, a third of the bits."""
_STALLED = 0.9
"""Ratio of the largest steps of two blocks from which on they lead nowhere."""
_WIDER = 2.0**20
"""By how much a box is widened if it is not proven to hold a solution; three times."""
_UNITS_OF_A_NEWTON_STEP = 0.02
"""Units of work (`core.work`) of a step, times the cube of the unknowns."""


@dataclass(frozen=True)
class Tie:
    """A row that holds the angle of a body to its direction, as affine polynomials and their values at the start."""

    turn: Poly
    cosine: Poly
    sine: Poly
    start: Ball
    heading: Ball

    def away(self, q: Sequence[Ball]) -> Ball:
        """Return by how much the angle differs from the direction, but for full turns."""
        gone = evaluated(self.turn, q) - self.start
        turned = polar_angle(evaluated(self.cosine, q), evaluated(self.sine, q)) - self.heading
        whole = 2 * arb.pi()
        return gone - turned - whole * ((gone - turned) / whole + 0.5).mid().floor()

    def line(self, q: Sequence[Ball]) -> dict[int, Ball]:
        """Return the derivatives of that."""
        c, s = evaluated(self.cosine, q), evaluated(self.sine, q)
        found: dict[int, Ball] = {}
        for poly, factor in (
            (self.turn, arb(1)),
            (self.sine, -c / (c * c + s * s)),
            (self.cosine, s / (c * c + s * s)),
        ):
            for key, value in poly.items():
                if key:
                    found[key[0]] = found.get(key[0], ZERO) + factor * value
        return found


@dataclass(frozen=True)
class ExactPlace:
    """A place of rest.

    Attributes
    ----------
    q, multipliers : list of ball
        Coordinates of the table, and multipliers of its rows; those that are left open are exact.
    one_of_many : bool
        Whether unknowns are left open.
    continuum : bool
        Whether coordinates are among these, and not forces that others share alone.
    """

    q: list[Ball]
    multipliers: list[Ball]
    one_of_many: bool = False
    continuum: bool = False


class RestEquations:
    """K q - b = W^T lambda and g = 0 for some rows of a table, in balls.

    Parameters
    ----------
    table : Table
    rows : sequence of int
        Those that are independent.
    ties : mapping of int to Tie
        By the number of the row.
    sizes : sequence of float
        Of coordinates and multipliers, in the order of the unknowns.
    """

    def __init__(self, table: Table, rows: Sequence[int], ties: Mapping[int, Tie], sizes: Sequence[Ball]) -> None:
        self.table, self.sizes = table, sizes
        self.rows: list[tuple[Row, Tie | None]] = [(table.rows[r], ties.get(r)) for r in rows]
        self.count = len(table.names)

    def residuals(self, x: Sequence[Ball]) -> list[Ball]:
        """Return what is left of the equations."""
        q, multipliers = x[: self.count], x[self.count :]
        left = [ZERO] * self.count
        for i, value in self.table.load.items():
            left[i] = left[i] - value
        for (i, j), value in self.table.stiffness.items():
            left[i] = left[i] + value * q[j]
        for (row, _), multiplier in zip(self.rows, multipliers, strict=True):
            for j, poly in row.rates.items():
                left[j] = left[j] - multiplier * evaluated(poly, q)
        return left + [evaluated(row.measure or {}, q) if tie is None else tie.away(q) for row, tie in self.rows]

    def potential(self, q: Sequence[Ball]) -> Ball:
        """Return the potential energy of a place."""
        total = ZERO
        for i, value in self.table.load.items():
            total = total - value * q[i]
        for (i, j), value in self.table.stiffness.items():
            total = total + value * q[i] * q[j] / 2
        return total

    def share_left(self, place: ExactPlace) -> float:
        """Return the largest force that is left over, as a share of the largest load and pull of springs."""
        pulls = [ZERO] * self.count
        for (i, j), value in self.table.stiffness.items():
            pulls[i] = pulls[i] + value * place.q[j]
        terms = sum(
            (max(map(abs, forces), key=float, default=ZERO) for forces in (self.table.load.values(), pulls)), ZERO
        )
        residuals = self.residuals([*place.q, *place.multipliers])[: self.count]
        left = max((abs(x).upper() for x in residuals), default=ZERO)
        return float(left / terms) if terms > 0 else 0.0

    def lines(self, q: Sequence[Ball]) -> list[dict[int, Ball]]:
        """Return W."""
        return [
            {j: evaluated(poly, q) for j, poly in row.rates.items()} if tie is None else tie.line(q)
            for row, tie in self.rows
        ]

    def stiffness(self, multipliers: Sequence[Ball]) -> list[list[Ball]]:
        """Return K less the multipliers times the slopes of W, shape (n, n)."""
        found = [[ZERO] * self.count for _ in range(self.count)]
        for (i, j), value in self.table.stiffness.items():
            found[i][j] = found[i][j] + value
        for (row, _), multiplier in zip(self.rows, multipliers, strict=True):
            for j, poly in row.rates.items():
                for key, value in poly.items():
                    if key:
                        found[j][key[0]] = found[j][key[0]] - multiplier * value
        return found

    def derivatives(self, x: Sequence[Ball]) -> list[list[Ball]]:
        """Return the matrix of derivatives, by rows."""
        n, m = self.count, len(self.rows)
        matrix = [row + [ZERO] * m for row in self.stiffness(x[n:])] + [[ZERO] * (n + m) for _ in range(m)]
        for r, line in enumerate(self.lines(x[:n])):
            for j, value in line.items():
                matrix[n + r][j] = value
        for r, (row, _) in enumerate(self.rows):
            for j, poly in row.rates.items():
                matrix[j][n + r] = matrix[j][n + r] - evaluated(poly, x[:n])
        return matrix

    def place(self, q: Floats, multipliers: Floats) -> ExactPlace | None:
        """Return the place of rest beside one that doubles found, in units of the sizes; None where there is none."""
        return self.refined([arb(float(x)) * size for x, size in zip((*q, *multipliers), self.sizes, strict=True)])

    def refined(self, x: Sequence[Ball]) -> ExactPlace | None:
        """Return the place of rest beside coordinates and multipliers, None where there is none."""
        every = range(len(x))
        found, one_of_many, continuum = self._near(x, every, every), False, False
        if found is None:
            unknowns, equations = self._determined(x)
            one_of_many = len(equations) < len(x)
            continuum = not {*range(self.count)} <= {*unknowns}
            found = self._near(x, unknowns, equations) if one_of_many else None
            if found is not None:
                left = self.residuals(found)
                if not all(is_zero(left[i]) for i in set(every) - set(equations)):
                    found = None
        if found is None:
            found, one_of_many, continuum = self._slowly(x), False, False
        if found is None:
            return None
        return ExactPlace(found[: self.count], found[self.count :], one_of_many, continuum)

    def _determined(self, x: Sequence[Ball]) -> tuple[list[int], list[int]]:
        """Return the unknowns that the equations determine there, as doubles tell, and as many equations that do."""
        size, rows = len(x), self.derivatives(x)
        scaled = [[float((y * unit).mid()) for y, unit in zip(row, self.sizes, strict=True)] for row in rows]
        matrix = _equilibrated(np.array(scaled))
        left, values, right = np.linalg.svd(matrix)
        count = int(np.sum(values <= _OPEN * max(values[0], 1e-300)))
        if not count:
            return list(range(size)), list(range(size))
        free = pivoted(right[size - count :])[0][:count].tolist()
        spare = pivoted(left[:, size - count :].T)[0][:count].tolist()
        return [i for i in range(size) if i not in free], [i for i in range(size) if i not in spare]

    def _step(self, x: Sequence[Ball], unknowns: Sequence[int], equations: Sequence[int]) -> list[Ball] | None:
        """Return Newton's step of the unknowns, None where the equations do not determine it."""
        spend(_UNITS_OF_A_NEWTON_STEP * len(unknowns) ** 3)
        rows, left = self.derivatives(x), self.residuals(x)
        matrix = arb_mat([[rows[i][j].mid() for j in unknowns] for i in equations])
        try:
            solved = matrix.solve(arb_mat([[left[i].mid()] for i in equations])).mid().entries()
        except ZeroDivisionError:
            return None
        found: list[Ball] = solved
        return found

    def _near(self, x: Sequence[Ball], unknowns: Sequence[int], equations: Sequence[int]) -> list[Ball] | None:
        """Return the enclosure of the solution near a place, None if Newton's method finds none."""
        x = list(x)
        for _ in range(_STEPS):
            step = self._step(x, unknowns, equations)
            if step is None:
                return None
            for i, change in zip(unknowns, step, strict=True):
                x[i] = (x[i] - change).mid()
            share = self._share(unknowns, step)
            if not share < 1.0:
                return None
            if share < 2.0 ** (_GUARD_OF_A_STEP - ctx.prec):
                return self._enclosed(x, unknowns, equations)
        return None

    def _share(self, unknowns: Sequence[int], step: Sequence[Ball]) -> float:
        """Return how large a step is, in units of the sizes."""
        return max((abs(float(change / self.sizes[i])) for i, change in zip(unknowns, step, strict=True)), default=0.0)

    def _enclosed(self, x: list[Ball], unknowns: Sequence[int], equations: Sequence[int]) -> list[Ball] | None:
        """Return a box in which one solution is proven to lie, None where that is not proven."""
        rows = self.derivatives(x)
        try:
            inverse = arb_mat([[rows[i][j].mid() for j in unknowns] for i in equations]).inv().mid()
        except ZeroDivisionError:
            return None
        left = self.residuals(x)
        off = (inverse * arb_mat([[left[i]] for i in equations])).entries()
        wide = [
            4 * abs(y).upper() + self.sizes[i] * arb(2) ** (_GUARD_OF_A_STEP - ctx.prec)
            for i, y in zip(unknowns, off, strict=True)
        ]
        for _ in range(3):
            box = list(x)
            for i, radius in zip(unknowns, wide, strict=True):
                box[i] = arb(x[i], radius)
            slopes = self.derivatives(box)
            product = (inverse * arb_mat([[slopes[i][j] for j in unknowns] for i in equations])).tolist()
            moved = [
                abs(y) + sum((abs((1 if a == b else 0) - product[a][b]) * wide[b] for b in range(len(unknowns))), ZERO)
                for a, y in enumerate(off)
            ]
            if all(one < radius for one, radius in zip(moved, wide, strict=True)):
                return box
            wide = [radius * _WIDER for radius in wide]
        return None

    def _slowly(self, x: Sequence[Ball]) -> list[Ball] | None:
        """Return a multiple solution, as wide as the way that is left to it; None where Newton's method finds none."""
        x, every, before = list(x), range(len(x)), 1.0
        for _ in range(_SLOW_BLOCKS):
            largest = 0.0
            for _ in range(_BLOCK):
                step = self._step(x, every, every)
                share = 1.0 if step is None else self._share(every, step)
                if step is None or not share < 1.0:
                    return None
                for i, change in zip(every, step, strict=True):
                    x[i] = (x[i] - change).mid()
                largest = max(largest, share)
            ratio = largest / before
            if largest < _FOLLOWED_TO or (largest < _FOLLOWED_TO**0.5 and ratio > _STALLED):
                # Each block goes the share 1 - ratio of what is left of the way.
                rest = 2.0 * _BLOCK * largest / (1.0 - min(ratio, _STALLED))
                return [arb(y, size * rest) for y, size in zip(x, self.sizes, strict=True)]
            before = largest
        return None


def _equilibrated(matrix: Floats) -> Floats:
    """Return a matrix whose rows and columns have been scaled until their largest entries are about one.

    References
    ----------
    D. Ruiz, "A scaling algorithm to equilibrate both rows and columns norms in matrices", RAL-TR-2001-034 (2001).
    """
    for _ in range(_SCALINGS):
        for axis in (0, 1):
            largest = np.sqrt(np.abs(matrix).max(axis=axis, keepdims=True))
            matrix = matrix / np.where(largest > 0.0, largest, 1.0)
    return matrix
