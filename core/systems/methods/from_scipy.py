"""Methods that are SciPy's: run here, step by step, in units of the motion's own size and horizon.

SciPy's solvers hold absolute lengths for first and smallest steps and absolute tolerances. They are given the motion
in units in which the horizon and the largest component of the initial state lie between 1 and 2; the units are powers
of two, so nothing is rounded.

SciPy is optional, and imported when the first of these methods runs: nothing else is computed with it.

Its solvers hold the history of a motion, which cannot be moved: of a system with constraints the samples alone are
projected onto them.
"""

from __future__ import annotations

import math
import sys
import warnings
from dataclasses import dataclass
from importlib import import_module
from importlib.util import find_spec
from typing import Annotated, Any, ClassVar

import numpy as np

from core.arrays import Floats
from core.errors import InvalidParameter, NotApplicable
from core.quantities import Quantity
from core.systems.methods.method import Leg, StepChoosing, Units
from core.systems.system import InitialValueProblem
from core.work import spend

SMALLEST_TOLERANCE = 2.3e-14
"""SciPy works with no relative tolerance below 100 units of round-off."""

_UNITS_OF_IMPORT = 20_000
"""Of work (`core.work`): importing takes 0.2 s, which no event loop may wait."""

SciPyTolerance = Annotated[float, Quantity("1", at_least=SMALLEST_TOLERANCE, below=1)]


def has_scipy() -> bool:
    """Return whether SciPy is installed."""
    return find_spec("scipy") is not None


def scipy_integrate() -> Any:
    """Return the module `scipy.integrate`.

    Raises
    ------
    NotApplicable
        If SciPy is not installed.
    """
    if "scipy.integrate" not in sys.modules:
        spend(_UNITS_OF_IMPORT)
    try:
        return import_module("scipy.integrate")
    except ModuleNotFoundError:
        remedy = "install polhode[scipy], or use dormand-prince-853"
        raise NotApplicable("SciPy is not installed with this service", path=("kind",), remedy=remedy) from None


class _LimitMet(Exception):
    """The equation was evaluated as often as is allowed."""


class _Scaled:
    """The equation of motion in units of `size` and `horizon`, which counts how often it is evaluated."""

    def __init__(self, system: InitialValueProblem, size: float, horizon: float, limit: int) -> None:
        self.equation, self.parameters = system.equation, system.parameters
        self.size, self.horizon, self.limit = size, horizon, limit
        self.evaluations = 0

    def __call__(self, time: float, state: Floats) -> Floats:
        if self.evaluations >= self.limit:
            raise _LimitMet
        self.evaluations += 1
        slope = np.empty_like(state)
        self.equation(time * self.horizon, state * self.size, self.parameters, slope)
        return slope * self.horizon / self.size


@dataclass(frozen=True)
class FromSciPy(StepChoosing):
    """Base of the methods that are classes of `scipy.integrate`.

    SciPy does not tell how many steps were rejected, so none are counted; their evaluations are.

    Attributes
    ----------
    solver : str
        Name of the class, a subclass of `scipy.integrate.OdeSolver`.
    """

    tolerance: SciPyTolerance
    smallest: ClassVar[float] = SMALLEST_TOLERANCE
    solver: ClassVar[str]
    on_constraints: ClassVar[str] = "Samples alone are projected: between them the state drifts off the constraints."

    @classmethod
    def is_installed(cls) -> bool:
        """Return whether SciPy is installed."""
        return has_scipy()

    def _march(self, system: InitialValueProblem, start: Floats, targets: Floats, limit: int, units: Units) -> Leg:
        solvers = scipy_integrate()
        horizon = _power_of_two(abs(float(targets[-1])))
        size = _power_of_two(float(np.abs(start).max()))
        equation = _Scaled(system, size, horizon, limit)
        scaled = targets / horizon
        samples = np.empty((targets.size, start.size))
        steps = sample = 0
        now = 0.0
        try:
            with warnings.catch_warnings(), np.errstate(all="ignore"):
                # What fails is told by the status; SciPy's words for it would go to the process's standard error.
                warnings.simplefilter("ignore")
                solver = getattr(solvers, self.solver)(
                    equation, 0.0, start / size, float(scaled[-1]), rtol=self.tolerance, atol=self.tolerance
                )
                while sample < targets.size:
                    try:
                        solver.step()
                    except (ValueError, ArithmeticError, np.linalg.LinAlgError):
                        # SciPy's linear algebra refuses what has overflowed.
                        raise self._failed(units.given_time(now)) from None
                    if solver.status == "failed":
                        raise self._failed(units.given_time(now))
                    steps += 1
                    now = float(solver.t) * horizon
                    if solver.status == "finished":
                        end = targets.size
                    else:
                        end = int(np.searchsorted(np.abs(scaled), abs(solver.t), side="right"))
                    if end > sample:
                        samples[sample:end] = solver.dense_output()(scaled[sample:end]).T * size
                        if end == targets.size:
                            samples[-1] = solver.y * size
                        if not np.isfinite(samples[sample:end]).all():
                            raise self._overflow(
                                units.given_time(now), "ask for earlier times, or use dormand-prince-853"
                            )
                        sample = end
        except _LimitMet:
            raise self._out_of_budget(equation.evaluations, limit, now / float(targets[-1])) from None
        return Leg(samples, equation.evaluations, steps, 0)

    def _failed(self, time: float) -> InvalidParameter:
        rule = f"be within reach: SciPy gave up after t = {time:.6g} s"
        return InvalidParameter("tolerance", rule, remedy="ask for a larger tolerance, or use dormand-prince-853")


def _power_of_two(value: float) -> float:
    """Return the power of two next below a magnitude, one for zero."""
    return math.ldexp(1.0, max(math.frexp(value)[1] - 1, -1022)) if value > 0 else 1.0
