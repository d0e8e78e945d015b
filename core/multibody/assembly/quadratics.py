"""Measures that stay zero as quadratic polynomials in doubles: values, derivatives, places where they vanish."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from core.arrays import Floats, Integers
from core.multibody.algebra.polynomials import Poly

STEPS = 100
"""Steps of each iteration in doubles: a Newton method takes five to ten, a damped one some dozens."""

VANISHED = 2.0**-44
"""Share of its terms to which a measure vanishes in doubles: some hundred roundings."""

DAMPING = 2.0**-50
"""Share of the largest eigenvalue that is added to a matrix of which redundant rows are singular."""

DECREASE = 1e-4
"""Share of the decrease to first order that a step has to make (Nocedal, Wright, "Numerical Optimization", 3.1)."""

SHORTEST = 2.0**-20
"""Shortest share of a step that is tried."""

LEAST_SCALE = 2.0**-970
"""Sum of squares of derivatives up to which a rounding of it is no normal double: steps have no digits then."""


@dataclass(frozen=True)
class Quadratics:
    """Polynomials of degree two at most, each over the size of its terms.

    Attributes
    ----------
    offset : ndarray, shape (m,)
    slope : ndarray, shape (m, n)
    row, first, second : ndarray of int, shape (k,)
        Terms of degree two: to which polynomial they belong, and their coordinates.
    factor : ndarray, shape (k,)
    """

    offset: Floats
    slope: Floats
    row: Integers
    first: Integers
    second: Integers
    factor: Floats

    @classmethod
    def of(cls, measures: Sequence[Poly], sizes: Floats, count: int) -> Quadratics:
        """Return polynomials in `count` coordinates, each divided by its size."""
        offset, slope = np.zeros(len(measures)), np.zeros((len(measures), count))
        terms: list[tuple[int, int, int, float]] = []
        for k, (measure, size) in enumerate(zip(measures, sizes, strict=True)):
            for key, ball in measure.items():
                value = float(ball) / size
                if len(key) == 2:
                    terms.append((k, key[0], key[1], value))
                elif len(key) == 1:
                    slope[k, key[0]] += value
                else:
                    offset[k] += value
        columns = np.array(terms, dtype=np.float64).reshape(-1, 4).T
        row, first, second = (column.astype(np.int64) for column in columns[:3])
        return cls(offset, slope, row, first, second, columns[3])

    def values(self, q: Floats) -> Floats:
        """Return the values, shape (m,)."""
        found: Floats = self.offset + self.slope @ q
        np.add.at(found, self.row, self.factor * q[self.first] * q[self.second])
        return found

    def jacobian(self, q: Floats) -> Floats:
        """Return the derivatives, shape (m, n)."""
        found = self.slope.copy()
        np.add.at(found, (self.row, self.first), self.factor * q[self.second])
        np.add.at(found, (self.row, self.second), self.factor * q[self.first])
        return found

    def curvature(self, weights: Floats) -> Floats:
        """Return the second derivatives of a weighted sum of the polynomials, shape (n, n)."""
        count = self.slope.shape[1]
        found = np.zeros((count, count))
        np.add.at(found, (self.first, self.second), weights[self.row] * self.factor)
        return found + found.T

    def weighted(self, weights: Floats) -> Quadratics:
        """Return the polynomials, each times a weight."""
        return Quadratics(
            weights * self.offset,
            weights[:, None] * self.slope,
            self.row,
            self.first,
            self.second,
            weights[self.row] * self.factor,
        )


def vanishing(measures: Quadratics, q: Floats, across: Floats) -> Floats:
    """Return places near `q` where measures vanish as far as they can: a damped Gauss-Newton method.

    Parameters
    ----------
    measures : Quadratics
    q : ndarray, shape (n,)
    across : ndarray, shape (n, f)
        Changes of the coordinates by unit changes of what may change, in the metric in which steps are shortest.

    References
    ----------
    N. Yamashita, M. Fukushima, "On the rate of convergence of the Levenberg-Marquardt method", Computing Supplementa 15
    (2001): with a damping of the size of the squared residuals it is quadratic where rows are redundant, too.
    """
    values = measures.values(q)
    for _ in range(STEPS):
        norm = float(np.linalg.norm(values))
        if np.abs(values).max(initial=0.0) <= VANISHED:
            break
        lines = measures.jacobian(q) @ across
        gram = lines @ lines.T
        scale = float(np.trace(gram))
        if not LEAST_SCALE < scale < np.inf:
            break
        # Each row by its own size: those of an axis without extent are larger than others by far.
        gram[np.diag_indices_from(gram)] += DAMPING * scale + min(norm, 1.0) ** 2 * gram.diagonal()
        change = -across @ (lines.T @ np.linalg.solve(gram, values))
        slope = float(values @ (measures.jacobian(q) @ change)) / norm
        share, further = 1.0, measures.values(q + change)
        while not float(np.linalg.norm(further)) <= norm + DECREASE * share * slope:
            share /= 2.0
            if share < SHORTEST:
                return q
            further = measures.values(q + share * change)
        q, values = q + share * change, further
    return q


def vanish(measures: Quadratics, q: Floats) -> bool:
    """Return whether all measures vanish to their rounding, with a margin for what redundant rows lose."""
    return bool(np.abs(measures.values(q)).max(initial=0.0) <= 2.0**8 * VANISHED)
