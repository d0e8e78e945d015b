"""One heavy rigid body about a point: Taylor series of its angular velocity and axes, in pairs of doubles.

The equations of Euler and Poisson (`core.multibody.motion.turning_body`) are of first order and quadratic, with twelve
unknowns and no multipliers: no matrix is inverted, so that pairs cost no more here than doubles in the table. After
every step the axes are made orthonormal again by one Newton correction, e <- e - (e e^T - 1) e/2.
"""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np

from core.arrays import Floats
from core.compiled import kernel
from core.double_double import dd_add, dd_add_d, dd_div_d, dd_mul_d
from core.multibody.algebra.pair_arrays import gathered, settled
from core.multibody.algebra.polynomials import Ball
from core.multibody.equations.packed import pair, units_of
from core.multibody.motion.numerical import Numerical
from core.multibody.motion.run import Run, run_by
from core.multibody.motion.series import DONE, FULL, LOST, SHORTEST
from core.multibody.motion.series_pairs import moved_pairs
from core.multibody.motion.series_run import CHECK_TOLERANCE, FINE_TOLERANCE
from core.multibody.motion.step_sizes import step_size
from core.multibody.motion.turning_body import TurningBody, cross_matrix, inverse_of, product_of
from core.multibody.table.table import Table

_CHUNK = 64
"""Steps whose series are allocated at a time."""

_ORDERS = {
    "doubles": (22, 2.0**-66),
    "reference": (26, 2.0**-78),
    "fine": (32, FINE_TOLERANCE),
    "check": (30, CHECK_TOLERANCE),
}


@dataclass
class EulerPoisson(Numerical):
    """A heavy body about a point; what is called doubles elsewhere is a coarser run in pairs here, too.

    Attributes
    ----------
    squares : ndarray, shape (3, 6, 2)
        What w_j w_k, j <= k, do to w_i'.
    torque : ndarray, shape (3, 3, 2)
        What the components of a unit vector along the pull, in body axes, do.
    pull : ndarray, shape (3, 2)
    start : ndarray, shape (12, 2)
        Angular velocity in body axes, and the axes.
    """

    squares: Floats = field(default_factory=lambda: np.zeros((3, 6, 2)))
    torque: Floats = field(default_factory=lambda: np.zeros((3, 3, 2)))
    pull: Floats = field(default_factory=lambda: np.zeros((3, 2)))
    start: Floats = field(default_factory=lambda: np.zeros((12, 2)))

    @classmethod
    def about(cls, table: Table, body: TurningBody, acceleration: list[Ball]) -> EulerPoisson | None:
        """Return the motion of a body; None where its tensor has no inverse."""
        inverse = inverse_of(body.tensor)
        if inverse is None:
            return None
        units = units_of(table, acceleration)
        time = units.time
        squares = np.zeros((3, 6, 2))
        # J w x w = sum of w_k (column k of J) x w, times the inverse: of each product the two orders are one entry.
        for number, (j, k) in enumerate(_PAIRS):
            for i in range(3):
                total = _turned(body, inverse, i, j, k)
                if j != k:
                    total = total + _turned(body, inverse, i, k, j)
                squares[i, number] = pair(total, 0)
        torque = np.zeros((3, 3, 2))
        if body.arm is not None:
            matrix = product_of(inverse, cross_matrix(body.arm))
            torque = np.array([[pair(x, 2 * time) for x in row] for row in matrix])
        start = [pair(x, time) for x in body.angular_velocity] + [pair(x, 0) for axis in body.axes for x in axis]
        return cls(
            table,
            range(len(table.rows)),
            units,
            name="Euler-Poisson",
            why="one rigid body turns about a point under its weight",
            squares=squares,
            torque=torque,
            pull=np.array([pair(x, 0) for x in body.pull]),
            start=np.array(start),
        )

    def steps(self, kind: str, end: float, since: Run | None = None) -> Run:
        """Take steps to a time in the units of the arrays, always from the start: series are those of the axes alone.

        Raises
        ------
        BudgetExceeded
            Where more steps would be needed than one part may take.
        AccuracyUnreachable
            Where the motion leaves the range of doubles.
        """
        order, tolerance = _ORDERS[kind]
        y = self.start.copy()

        def steps(clock: Floats, starts: Floats, series: Floats) -> tuple[int, int]:
            return _advance(self.squares, self.torque, self.pull, y, clock, end, tolerance, starts, series)

        return run_by(steps, end, (self.start[3:], _rates(self.start)), (9, order + 1, 2), _CHUNK)


_PAIRS = ((0, 0), (0, 1), (0, 2), (1, 1), (1, 2), (2, 2))
"""Rows and columns of the upper triangle of a symmetric matrix."""


def _turned(body: TurningBody, inverse: list[list[Ball]], i: int, j: int, k: int) -> Ball:
    """Return the coefficient of w_j w_k in component i of J^-1 (J w x w), J w's factor being w_j."""
    column = [body.tensor[a][j] for a in range(3)]
    crossed = [row[k] for row in cross_matrix(column)]
    return sum((inverse[i][a] * crossed[a] for a in range(3)), inverse[0][0] * 0)


def _rates(y: Floats) -> Floats:
    """Return the rates of the axes in doubles and tails, shape (9, 2)."""
    c = np.zeros((12, 2, 2))
    c[:, 0] = y
    _axes(c, 0)
    found: Floats = c[3:, 1]
    return found


@kernel()
def _product(a: Floats, b: Floats, k: int) -> tuple[float, float]:
    """Return coefficient k of the product of two series of shape (order + 1, 2)."""
    sh, sl = 0.0, 0.0
    for m in range(k + 1):
        sh, sl = gathered(sh, sl, a[m, 0], a[m, 1], b[k - m, 0], b[k - m, 1])
    return settled(sh, sl)


@kernel()
def _axes(c: Floats, k: int) -> None:
    """Fill in coefficient k + 1 of the axes: e_a' = w_c e_b - w_b e_c for a, b, c in turn."""
    for a in range(3):
        b, d = (a + 1) % 3, (a + 2) % 3
        for i in range(3):
            ph, pl = _product(c[d], c[3 + 3 * b + i], k)
            mh, ml = _product(c[b], c[3 + 3 * d + i], k)
            ph, pl = dd_add(ph, pl, -mh, -ml)
            c[3 + 3 * a + i, k + 1, 0], c[3 + 3 * a + i, k + 1, 1] = dd_div_d(ph, pl, k + 1.0)


@kernel()
def _coefficients(squares: Floats, torque: Floats, pull: Floats, c: Floats) -> None:
    """Fill in the coefficients c[:, 1:] of shape (12, order + 1, 2)."""
    order = c.shape[1] - 1
    products, along = np.empty((6, 2)), np.empty((3, 2))
    for k in range(order):
        number = 0
        for j in range(3):
            for m in range(j, 3):
                products[number, 0], products[number, 1] = _product(c[j], c[m], k)
                number += 1
            sh, sl = 0.0, 0.0
            for i in range(3):
                sh, sl = gathered(sh, sl, pull[i, 0], pull[i, 1], c[3 + 3 * j + i, k, 0], c[3 + 3 * j + i, k, 1])
            along[j, 0], along[j, 1] = settled(sh, sl)
        for i in range(3):
            sh, sl = 0.0, 0.0
            for p in range(6):
                sh, sl = gathered(sh, sl, squares[i, p, 0], squares[i, p, 1], products[p, 0], products[p, 1])
            for j in range(3):
                sh, sl = gathered(sh, sl, torque[i, j, 0], torque[i, j, 1], along[j, 0], along[j, 1])
            sh, sl = settled(sh, sl)
            c[i, k + 1, 0], c[i, k + 1, 1] = dd_div_d(sh, sl, k + 1.0)
        _axes(c, k)


@kernel()
def _orthonormal(y: Floats) -> None:
    """Correct the axes y[3:], shape (9, 2), to first order in what they miss."""
    away = np.empty((3, 3, 2))
    for a in range(3):
        for b in range(3):
            sh, sl = (-1.0 if a == b else 0.0), 0.0
            for i in range(3):
                p, r = 3 + 3 * a + i, 3 + 3 * b + i
                sh, sl = gathered(sh, sl, y[p, 0], y[p, 1], y[r, 0], y[r, 1])
            away[a, b, 0], away[a, b, 1] = settled(sh, sl)
    change = np.empty((9, 2))
    for a in range(3):
        for i in range(3):
            sh, sl = 0.0, 0.0
            for b in range(3):
                sh, sl = gathered(sh, sl, away[a, b, 0], away[a, b, 1], y[3 + 3 * b + i, 0], y[3 + 3 * b + i, 1])
            sh, sl = settled(sh, sl)
            change[3 * a + i, 0], change[3 * a + i, 1] = dd_mul_d(sh, sl, -0.5)
    for p in range(9):
        y[3 + p, 0], y[3 + p, 1] = dd_add(y[3 + p, 0], y[3 + p, 1], change[p, 0], change[p, 1])


@kernel()
def _advance(
    squares: Floats,
    torque: Floats,
    pull: Floats,
    y: Floats,
    clock: Floats,
    end: float,
    tolerance: float,
    starts: Floats,
    series: Floats,
) -> tuple[int, int]:
    """Take steps until the time `end` or until the arrays are full, as `series_pairs.advance_pairs` does.

    Parameters
    ----------
    y : (12, 2)
        Angular velocity and axes; moved along.
    series : (s, 9, order + 1, 2)
        Filled with the coefficients of the axes.
    """
    order = series.shape[2] - 1
    c, rates = np.empty((12, order + 1, 2)), np.empty((12, 2))
    group = np.zeros(12, dtype=np.int64)
    group[:3] = 1
    way = 1.0 if end >= clock[0] else -1.0
    for step in range(series.shape[0]):
        starts[step, 0], starts[step, 1] = clock[0], clock[1]
        left = (end - clock[0]) - clock[1]
        if left * way <= 0.0:
            return DONE, step
        for i in range(c.shape[0]):
            c[i, 0, 0], c[i, 0, 1] = y[i, 0], y[i, 1]
        _coefficients(squares, torque, pull, c)
        for i in range(series.shape[1]):
            for k in range(series.shape[2]):
                series[step, i, k, 0], series[step, i, k, 1] = c[3 + i, k, 0], c[3 + i, k, 1]
        h = way * step_size(c[:, :, 0], group, tolerance, c.shape[1] - 1)
        if not abs(h) > SHORTEST * max(1.0, abs(clock[0])):
            return LOST, step
        if abs(h) >= abs(left):
            h = left
        moved_pairs(c, h, 0.0, y, rates)
        for i in range(12):
            if not abs(y[i, 0]) < 1e150:
                return LOST, step
        _orthonormal(y)
        clock[0], clock[1] = dd_add_d(clock[0], clock[1], h)
        starts[step + 1, 0], starts[step + 1, 1] = clock[0], clock[1]
        if h == left:
            return DONE, step + 1
    return FULL, series.shape[0]
