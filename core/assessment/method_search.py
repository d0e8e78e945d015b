"""Which method samples of a free rotation come from: fixed steps of any length, or a solver that chooses its own.

An integrator of order p has an error proportional to step^p. From one run the step follows for which its error has the
size of the samples' error. Steps near it (parts of the spacing of the samples, round numbers, and the number itself)
are then run; of solvers that choose their steps, the tolerances whose error is of that size. What explains the error to
a thousandth, or to the last digit that the samples have, is what they are consistent with, unless another method does
so nearly as well. The solvers are SciPy's own, and are looked for where it is installed.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import suppress
from math import floor, inf, isfinite, log10
from typing import Any

import numpy as np

from core.arrays import Floats
from core.assessment.compare import norms
from core.assessment.sample_findings import Consistent
from core.assessment.student_methods import ExplicitMidpoint, Heun, SemiImplicitEuler
from core.errors import MechanicsError
from core.rotation.torque_free import TorqueFree
from core.systems.budget import Budget
from core.systems.methods import ExplicitEuler, ImplicitMidpoint, RungeKutta4, SymmetricSplitting
from core.systems.methods.from_scipy import has_scipy, scipy_integrate
from core.work import spend

METHODS = (ExplicitEuler, SemiImplicitEuler, ExplicitMidpoint, Heun, RungeKutta4, ImplicitMidpoint, SymmetricSplitting)

SOLVERS = ("RK45", "DOP853", "LSODA")
"""Of `scipy.integrate.solve_ivp`."""

ABSOLUTE: tuple[Callable[[float], float], ...] = (lambda rtol: 1e-6, lambda rtol: rtol, lambda rtol: 1e-3 * rtol)
"""Absolute tolerances that come with a relative one: the solver's default, the same, a thousandth."""

LOOSEST, TIGHTEST = 3, 12
"""Relative tolerances that are tried: 1e-3, the solvers' default, to 1e-12."""

EXPLAINED = 1e-3
"""Share of the error that may be left unexplained by a method that the samples are consistent with."""

VISIBLE = 0.1
"""Share of the error that the digits of the samples may leave open for a method to be looked for."""

DISTINCT = 3.0
"""Times as much that the next best method leaves unexplained."""

ROUNDS = 3
"""Times that a step is corrected by the error that it leads to."""

ALIKE = 0.5
"""Cosine between a method's errors at two steps: near 1 for short ones, where the error is step^p times one function of
time. Errors of another origin are nearly orthogonal to them."""

NEAR = 0.3
"""Share of the error that the best likely step may leave unexplained for a step near it to be looked for."""

RUNAWAYS, RUNAWAY = 6, 3.0
"""Times that a step is divided by 4 while its error exceeds so many times the largest rate."""

ROUNDED = 1e-12
"""Error, of the largest rate, that is explained by rounding."""

MOST_EVALUATIONS = 200_000
"""Of each run of a method; a step that needs more is not looked for."""

MOST_OF_SOLVERS = 40_000
"""Evaluations that all runs of solvers may take, for all samples at the same times; each takes some 20 us."""


class MethodSearch:
    """Looks for the methods of samples at the same times; runs that do not depend on the samples are made once.

    Parameters
    ----------
    system : TorqueFree
    times : ndarray, shape (n,)
        In any order (s).
    right : ndarray, shape (n, 3)
        The exact motion, in body axes (rad/s).
    solvers : bool
        Whether to look for solvers that choose their steps, too.
    """

    def __init__(self, system: TorqueFree, times: Floats, right: Floats, *, solvers: bool = True) -> None:
        self.system, self.times, self.right = system, times, right
        self.largest = float(np.abs(right).max())
        apart = np.diff(np.unique(np.append(times, 0.0)))
        self.spacing = float(np.median(apart)) if apart.size else 0.0
        self._first: dict[Any, Floats | None] = {}
        self._solved: dict[tuple[str, float, float], Floats | None] = {}
        self._left = MOST_OF_SOLVERS if solvers else 0

    def consistent(self, rows: Floats) -> Consistent | None:
        """Return the one method that explains samples, shape (n, 3) (rad/s), or None."""
        error = float(norms(rows - self.right).max())
        coarse = 2.0 * _resolution(rows)
        if error <= ROUNDED * self.largest + coarse:
            return Consistent("exact", None, None, error)
        enough = EXPLAINED * error + coarse
        if enough > VISIBLE * error or self.spacing == 0.0:
            return None
        found = [one for member in METHODS if (one := _StepSearch(member, self, rows, error, enough).found())]
        found = found or list(self._of_solvers(rows, error, enough))
        found.sort(key=lambda one: one.unexplained)
        if not found or any(
            one.method != found[0].method and one.unexplained < DISTINCT * found[0].unexplained for one in found
        ):
            return None
        return found[0]

    def run(self, member: Any, step: float) -> Floats | None:
        """Return what a method gives with a step, None if that leaves the doubles or takes too long."""
        if step == self.spacing:
            if member not in self._first:
                self._first[member] = self._run(member, step)
            return self._first[member]
        return self._run(member, step)

    def _run(self, member: Any, step: float) -> Floats | None:
        if not (step > 0.0 and isfinite(step)):
            return None
        with suppress(MechanicsError):
            # A run of another method than the samples' may leave the range of doubles.
            budget = Budget(evaluations=MOST_EVALUATIONS)
            states: Floats = member(step).integrate(self.system, self.times, budget).states
            return states if np.isfinite(states).all() else None
        return None

    def _of_solvers(self, rows: Floats, error: float, enough: float) -> Iterator[Consistent]:
        if not has_scipy() or self.times.min() < 0.0 or len(np.unique(self.times)) < len(self.times):
            return
        for solver in SOLVERS:
            for absolute in ABSOLUTE:
                for power in self._powers(solver, absolute, error):
                    states = self._solution(solver, 10.0**-power, absolute(10.0**-power))
                    left = inf if states is None else float(norms(states - rows).max())
                    if left <= enough:
                        yield Consistent(solver, None, 10.0**-power, left)

    def _powers(self, solver: str, absolute: Callable[[float], float], error: float) -> Iterator[int]:
        """Yield the powers of ten near the tolerance whose error has a size, for a solver whose error falls with it."""
        low, high = LOOSEST, TIGHTEST
        while low < high:
            # The loosest tolerance whose error is less.
            middle = (low + high) // 2
            states = self._solution(solver, 10.0**-middle, absolute(10.0**-middle))
            if states is None or float(norms(states - self.right).max()) < error:
                high = middle
            else:
                low = middle + 1
        yield from (power for power in (low - 1, low, low + 1) if LOOSEST <= power <= TIGHTEST)

    def _solution(self, solver: str, rtol: float, atol: float) -> Floats | None:
        key = solver, rtol, atol
        if key not in self._solved and self._left > 0:
            self._solved[key] = self._solve(*key)
        return self._solved.get(key)

    def _solve(self, solver: str, rtol: float, atol: float) -> Floats | None:
        tensor, inverse = self.system.tensor, np.linalg.inv(self.system.tensor)

        def slope(time: float, state: Floats) -> Floats:
            self._left -= 1
            if self._left < 0:
                raise _TooMany
            x, y, z = state.tolist()
            p, q, r = (tensor @ state).tolist()
            turned: Floats = inverse @ np.array((q * z - r * y, r * x - p * z, p * y - q * x))
            return turned

        before, order = self._left, np.argsort(self.times)
        with suppress(_TooMany), np.errstate(all="ignore"):
            span, at = (0.0, float(self.times[order[-1]])), self.times[order]
            found = scipy_integrate().solve_ivp(
                slope, span, self.system.angular_velocity, solver, at, rtol=rtol, atol=atol
            )
            spend(before - self._left)
            if found.success and found.y.shape[1] == len(order):
                return np.asarray(found.y.T[np.argsort(order)], np.float64)
        return None


class _TooMany(Exception):
    """The solvers have evaluated the equation as often as they may."""


class _StepSearch:
    """Looks for the step with which one method gives the samples."""

    def __init__(self, member: Any, search: MethodSearch, rows: Floats, error: float, enough: float) -> None:
        self._member, self._search, self._rows, self._error, self._enough = member, search, rows, error, enough
        self._exactly = enough - EXPLAINED * error + ROUNDED * search.largest
        self._tried = dict[float, float]()

    def found(self) -> Consistent | None:
        best = self._likely()
        if best is None or self._tried[best] > NEAR * self._error:
            return None
        for width in (0.1, 1e-3):
            if self._tried[best] > self._exactly:
                best = self._refined(best, width)
        left = self._tried[best]
        return Consistent(self._member.kind, best, None, left) if left <= self._enough else None

    def _likely(self) -> float | None:
        """Return the step of those tried that explains most, None if none is likely to be near."""
        step, corrected = self._search.spacing, 0
        for _ in range(ROUNDS + RUNAWAYS):
            states = self._search.run(self._member, step)
            if self._unexplained(step, states) <= self._enough:
                return step
            own, alike = self._likeness(states)
            if not 0.0 < own < RUNAWAY * self._search.largest:
                step /= 4.0
                continue
            if corrected == ROUNDS or (corrected and alike < ALIKE):
                break
            corrected += 1
            step *= (self._error / own) ** (1.0 / self._member.order)
            if not 0.0 < step < inf:
                break
            if alike < ALIKE:
                # A step that is far too long shows little yet; one of about this error does.
                continue
            for candidate in _candidates(step, self._search.spacing):
                if self._unexplained(candidate) <= self._enough:
                    return candidate
        return min(self._tried, key=lambda one: self._tried[one])

    def _refined(self, step: float, width: float) -> float:
        """Return the step near one that leaves the least unexplained, by golden section."""
        low, high, golden = (1.0 - width) * step, (1.0 + width) * step, 0.6180339887498949
        for _ in range(30):
            left, right = high - golden * (high - low), low + golden * (high - low)
            low, high = (low, right) if self._unexplained(left) <= self._unexplained(right) else (left, high)
        return min(self._tried, key=lambda one: self._tried[one])

    def _unexplained(self, step: float, states: Floats | None = None) -> float:
        if step not in self._tried:
            states = self._search.run(self._member, step) if states is None else states
            self._tried[step] = inf if states is None else float(norms(states - self._rows).max())
        return self._tried[step]

    def _likeness(self, states: Floats | None) -> tuple[float, float]:
        """Return the method's own largest error, and the cosine between its errors and those of the samples."""
        if states is None:
            return 0.0, 0.0
        own, given = states - self._search.right, self._rows - self._search.right
        largest = float(norms(own).max())
        with np.errstate(over="ignore", invalid="ignore", divide="ignore"):
            unit, other = own / largest, given / self._error
            alike = float((unit * other).sum() / np.sqrt((unit**2).sum() * (other**2).sum()))
        return largest, alike


def _candidates(step: float, spacing: float) -> Iterator[float]:
    """Yield likely steps near one: parts and multiples of the spacing, round numbers, parts of a second, the step."""
    parts = spacing / step
    for count in {max(1, floor(parts) + k) for k in (-1, 0, 1, 2)}:
        yield spacing / count
    if parts < 1.0:
        yield spacing * round(1.0 / parts)
    digit = 10.0 ** (floor(log10(step)) - 1)
    for offset in (-1, 0, 1):
        yield float(f"{(round(step / digit) + offset) * digit:.2g}")
        yield 1.0 / max(1, round(1.0 / step) + offset)
    yield step


def _resolution(rows: Floats) -> float:
    """Return half a unit of the last decimal place that any of the numbers has, 0 for numbers with all their digits."""
    for places in range(13):
        if np.array_equal(np.round(rows, places), rows):
            return 0.5 * 10.0**-places
    return 0.0
