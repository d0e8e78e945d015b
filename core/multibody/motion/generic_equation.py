"""A described scene as a system of ordinary differential equations that every method of the catalogue can run.

The state is (q, q') of the reduced table, in the units of its arrays; the packed table is the parameters, and one
compiled equation serves all scenes. The table is an equation of index 3. Its measures are differentiated twice, and
the accelerations come from the saddle system

    [M  -W^T; W  0] (q'', lambda) = (b - K q - D q' + B(q, q'), -W' q').

A measure's second derivative is held then and the measure itself is not, so that a method would drift off it. Methods
therefore project every step onto the measures, and then onto the rates, with the least change that the masses allow.
That has the order of the method (Hairer, Lubich, Wanner, section IV.4).

References
----------
E. Hairer, C. Lubich, G. Wanner, Geometric Numerical Integration, 2nd ed., Springer 2006, sections IV.4 (projection)
and VII.1.2 (the saddle system).
U. M. Ascher, L. R. Petzold, Computer Methods for Ordinary Differential Equations and Differential-Algebraic Equations,
SIAM 1998, section 9.2 (drift and stabilisation).
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from core.arrays import Floats, Integers, row_lengths
from core.balls import precision
from core.compiled import kernel
from core.errors import NotApplicable
from core.multibody.algebra.polynomials import BITS
from core.multibody.equations.packed import Packed, Units, packed, state, two_to, units_of
from core.multibody.motion.whole import Whole
from core.systems.system import PROJECTION, VECTOR_FIELD, ClosedForm, Model, Range, Structure

HEADER = 8
"""Parameters before the arrays: the rate of the table's clock, and seven counts."""

MOST_CORRECTIONS = 12
"""Newton steps onto the measures: they converge quadratically from the error of a step, and what takes more of them
has left its branch."""

QUADRATIC, ROUNDED = 1e-8, 4e-16
"""Newton's method ends at a correction of which the next one is the square; one of rounding's size changes nothing."""


@kernel()
def _factor(a: Floats, order: Integers) -> bool:
    """Factor a matrix in place into triangles, rows exchanged by scaled pivots; return whether that is possible."""
    n = a.shape[0]
    scale = np.empty(n)
    for k in range(n):
        order[k] = k
        largest = 0.0
        for j in range(n):
            largest = max(largest, abs(a[k, j]))
        if not largest > 0.0:
            return False
        scale[k] = 1.0 / largest
    for k in range(n):
        pivot, best = k, 0.0
        for i in range(k, n):
            if abs(a[i, k]) * scale[i] > best:
                pivot, best = i, abs(a[i, k]) * scale[i]
        if not best > 1e-14:
            return False
        if pivot != k:
            scale[pivot] = scale[k]
            for j in range(n):
                a[k, j], a[pivot, j] = a[pivot, j], a[k, j]
            order[k], order[pivot] = order[pivot], order[k]
        for i in range(k + 1, n):
            if a[i, k] != 0.0:
                factor = a[i, k] / a[k, k]
                a[i, k] = factor
                for j in range(k + 1, n):
                    a[i, j] -= factor * a[k, j]
    return True


@kernel()
def _solve(a: Floats, order: Integers, right: Floats, found: Floats) -> None:
    """Solve a system whose matrix is factored."""
    n = a.shape[0]
    for i in range(n):
        total = right[order[i]]
        for j in range(i):
            total -= a[i, j] * found[j]
        found[i] = total
    for i in range(n - 1, -1, -1):
        total = found[i]
        for j in range(i + 1, n):
            total -= a[i, j] * found[j]
        found[i] = total / a[i, i]


@kernel()
def _saddle(table: Floats, q: Floats, a: Floats, order: Integers, lines: Floats) -> bool:
    """Fill in W at a place and the factors of [M -W^T; W 0]; return whether there are any."""
    n, m, entries, slopes = int(table[1]), int(table[2]), int(table[6]), int(table[7])
    at = HEADER + n * n + n + 3 * m + 3 * int(table[3]) + 3 * int(table[4]) + 4 * int(table[5])
    bends = at + 3 * entries
    for e in range(entries):
        lines[e] = table[at + 3 * e + 2]
    for p in range(slopes):
        lines[int(table[bends + 3 * p])] += table[bends + 3 * p + 2] * q[int(table[bends + 3 * p + 1])]
    a[:] = 0.0
    for i in range(n):
        for j in range(n):
            a[i, j] = table[HEADER + n * i + j]
    for e in range(entries):
        r, j = int(table[at + 3 * e]), int(table[at + 3 * e + 1])
        a[j, n + r] = -lines[e]
        a[n + r, j] = lines[e]
    return _factor(a, order)


@kernel(VECTOR_FIELD)
def _equation(time: float, given: Floats, table: Floats, slope: Floats) -> None:
    """Fill in the rates and accelerations; NaN where there are none."""
    rate, n, m = table[0], int(table[1]), int(table[2])
    stiff, damp, gyre, entries, slopes = int(table[3]), int(table[4]), int(table[5]), int(table[6]), int(table[7])
    a, order = np.empty((n + m, n + m)), np.empty(n + m, np.int64)
    lines, right, found = np.empty(entries), np.empty(n + m), np.empty(n + m)
    q, v = given[:n], given[n:]
    if not _saddle(table, q, a, order, lines):
        slope[:] = math.nan
        return
    loads = HEADER + n * n
    right[:] = 0.0
    for i in range(n):
        right[i] = table[loads + i]
    at = loads + n + 3 * m
    for _ in range(stiff):
        right[int(table[at])] -= table[at + 2] * q[int(table[at + 1])]
        at += 3
    for _ in range(damp):
        right[int(table[at])] -= table[at + 2] * v[int(table[at + 1])]
        at += 3
    for _ in range(gyre):
        right[int(table[at])] += table[at + 3] * q[int(table[at + 1])] * v[int(table[at + 2])]
        at += 4
    bends = at + 3 * entries
    for p in range(slopes):
        e, i = int(table[bends + 3 * p]), int(table[bends + 3 * p + 1])
        r, j = int(table[at + 3 * e]), int(table[at + 3 * e + 1])
        right[n + r] -= table[bends + 3 * p + 2] * v[i] * v[j]
    _solve(a, order, right, found)
    for i in range(n):
        slope[i] = rate * v[i]
        slope[n + i] = rate * found[i]


@kernel(PROJECTION)
def _onto_constraints(given: Floats, table: Floats) -> None:
    """Put a state onto the measures and the rates; NaN where that does not succeed.

    Newton's method for the place, of which each step solves the saddle system with the residuals on its right.
    """
    n, m, entries = int(table[1]), int(table[2]), int(table[6])
    if m == 0:
        return
    held = HEADER + n * n + n
    at = held + 3 * m + 3 * int(table[3]) + 3 * int(table[4]) + 4 * int(table[5])
    a, order = np.empty((n + m, n + m)), np.empty(n + m, np.int64)
    lines, right, found = np.empty(entries), np.empty(n + m), np.empty(n + m)
    q, v = given[:n], given[n:]
    done = _saddle(table, q, a, order, lines)
    for correction in range(MOST_CORRECTIONS):
        if not done or correction == MOST_CORRECTIONS - 1:
            given[:] = math.nan
            return
        right[:] = 0.0
        for r in range(m):
            right[n + r] = -table[held + m + r]
        for e in range(entries):
            # Of a measure with gradient W = c + S q, constant c and symmetric S, the value is offset + (c + W) q/2.
            r, j = int(table[at + 3 * e]), int(table[at + 3 * e + 1])
            right[n + r] -= 0.5 * (table[at + 3 * e + 2] + lines[e]) * q[j]
        for r in range(m):
            if table[held + r] == 0.0:
                right[n + r] = 0.0
        _solve(a, order, right, found)
        change, size = 0.0, 0.0
        for i in range(n):
            q[i] += found[i]
            change, size = max(change, abs(found[i])), max(size, abs(q[i]))
        if change <= ROUNDED * size:
            break
        done = change < math.inf and _saddle(table, q, a, order, lines)
        if done and change <= QUADRATIC * size:
            break
    right[:] = 0.0
    for r in range(m):
        right[n + r] = table[held + 2 * m + r]
    for e in range(entries):
        right[n + int(table[at + 3 * e])] -= lines[e] * v[int(table[at + 3 * e + 1])]
    _solve(a, order, right, found)
    for i in range(n):
        v[i] += found[i]


def flat(arrays: Packed, rate: float) -> Floats:
    """Return a packed table, without the tails of its numbers, as the parameters of the equation.

    Parameters
    ----------
    rate : float
        Units of the table's time in a second.
    """
    entries = ((arrays.stiff, arrays.stiff_at), (arrays.damp, arrays.damp_at), (arrays.gyre, arrays.gyre_at))
    listed = [*entries, (arrays.lines, arrays.lines_at), (arrays.slopes, arrays.slopes_at)]
    header = [rate, len(arrays.load), len(arrays.rate), *(len(values) for values, _ in listed)]
    dense = [arrays.mass[..., 0].ravel(), arrays.load[:, 0], arrays.held, arrays.offset[:, 0], arrays.rate[:, 0]]
    triples = [np.concatenate([where, values[:, :1]], axis=1).ravel() for values, where in listed]
    return np.concatenate([np.array(header), *dense, *triples]).astype(np.float64)


def weight_of(size: int) -> int:
    """Return as how many evaluations one counts that factors a matrix of so many rows."""
    return 4 + size**3 // 200


@dataclass(frozen=True, eq=False)
class SceneSystem:
    """A whole described scene, as methods see it.

    Attributes
    ----------
    whole : Whole
        Whose reduced table is run, all parts at once.
    """

    whole: Whole

    def __post_init__(self) -> None:
        if self.whole.reduced.table.acting:
            raise NotApplicable(
                "methods do not run scenes whose forces are formulas yet",
                remedy="leave the method out, or write forces that are linear in places and rates",
            )

    @cached_property
    def _packed(self) -> tuple[Packed, Units]:
        table = self.whole.reduced.table
        units = units_of(table, self.whole.reduced_accelerations)
        return packed(table, table.independent_rows(), units), units

    @cached_property
    def initial_state(self) -> Floats:
        """Places and rates at t = 0 in the units of the arrays, shape (2 n,)."""
        q, v = state(self.whole.reduced.table, self._packed[1])
        return np.concatenate([q[:, 0], v[:, 0]])

    @cached_property
    def parameters(self) -> Floats:
        """The packed table."""
        arrays, units = self._packed
        return flat(arrays, two_to(-units.time))

    @property
    def equation(self) -> object:
        """The one equation of all scenes."""
        return _equation

    @property
    def structure(self) -> Structure:
        """The projection onto the measures and rates, and what an evaluation costs: it factors a matrix."""
        return Structure(projection=_onto_constraints, weight=weight_of(self.size))

    @property
    def model(self) -> Model:
        """The table as it is."""
        free = int(self.parameters[1] - self.parameters[2])
        return Model("a described scene", "", "a method was named, and runs the whole table", free)

    @property
    def state_column(self) -> tuple[str, str]:
        """The coordinates and rates of the reduced table, which share no unit."""
        return "state", "1"

    def closed_form(self) -> ClosedForm | None:
        """Return None: what a scene is compared with is its own answer, column by column."""
        return None

    def ranges(self, states: Floats) -> Mapping[str, Range]:
        """Return nothing: the energy is a column of the answer."""
        return {}

    @property
    def size(self) -> int:
        """Unknowns of the saddle system that every evaluation solves."""
        return int(self.parameters[1] + self.parameters[2])

    def places_and_rates(self, states: Floats) -> tuple[Floats, Floats]:
        """Return coordinates and rates of the reduced table in SI units, each of shape (t, n), from states."""
        units = self._packed[1]
        up = np.array([two_to(e) for e in units.lengths])
        n = len(up)
        return states[:, :n] * up, states[:, n:] * (up * two_to(-units.time))

    def reference(self, times: Floats) -> tuple[str, Floats, float]:
        """Return how the motion itself is known, its states at times of shape (t,), and their largest error as a norm.

        Raises
        ------
        NotApplicable
            If the motion ends before the last time.
        """
        units = self._packed[1]
        shape = (len(times), len(units.lengths))
        places, rates, wrong, wrong_rates = (np.zeros(shape) for _ in range(4))
        closed = True
        with precision(BITS):
            for indices, motion in self.whole.parts:
                where = list(indices)
                if any(motion.ended(float(f(times))) for f in (np.min, np.max)):
                    raise NotApplicable(
                        "the motion ends at a singular place before the last of the times",
                        path=("times",),
                        remedy="ask for earlier times",
                    )
                found = motion.states(times, finer=True)
                places[:, where], rates[:, where] = found.q[..., 0], found.v[..., 0]
                wrong[:, where], wrong_rates[:, where] = found.q_error, found.v_error
                closed = closed and motion.how == "closed form"
        down = np.array([two_to(-e) for e in units.lengths])
        scale = np.concatenate([down, down * two_to(units.time)])
        states = np.concatenate([places, rates], axis=1) * scale
        errors = row_lengths(np.concatenate([wrong, wrong_rates], axis=1) * scale)
        rounding = 2.0**-52 * float(np.max(row_lengths(states)))
        return "closed form" if closed else "pairs of doubles", states, float(np.max(errors)) + rounding


def scene_system(whole: Whole) -> SceneSystem:
    """Return a scene as a system, its numbers packed, for use outside of the precision of balls.

    Raises
    ------
    NotApplicable
        If nothing moves.
    """
    system = SceneSystem(whole)
    if not len(system.initial_state) or not len(system.parameters):
        raise NotApplicable("nothing moves, and no method has anything to do", remedy="give something a velocity")
    return system
