"""Initial value problems: a state at t = 0, an equation of motion, and perhaps a closed form."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any, NamedTuple, Protocol

from numba import types

from core.arrays import Floats
from core.compiled import kernel

VECTOR_FIELD = types.void(types.float64, types.float64[::1], types.float64[::1], types.float64[::1])
"""Signature of a compiled equation of motion: (time, state, parameters, derivative to be filled in)."""

PART_FLOW = types.void(types.int64, types.float64, types.float64[::1], types.float64[::1])
"""Signature of the exact flows of the parts of an equation: (part, duration, state to be moved, parameters)."""

DISCRETE_STEP = types.boolean(types.float64, types.float64[::1], types.float64[::1], types.float64[::1])
"""Signature of a step of discrete mechanics: (duration, state, parameters, increment of the state to be filled in).

It tells whether the discrete equation was solved; its solution is the one that tends to rest as the duration does.
"""

PROJECTION = types.void(types.float64[::1], types.float64[::1])
"""Signature of a projection onto what constrains a motion: (state to be moved, parameters)."""


@dataclass(frozen=True, eq=False)
class Splitting:
    """An equation of motion written as a sum of parts, each of which can be solved exactly.

    Methods that compose these flows keep every quantity that all of the flows keep, whatever the step.

    Attributes
    ----------
    parts : int
        Number of parts.
    flow : compiled function of signature `PART_FLOW`
        Moves the state along one part, numbered from 0, for a duration that may be negative.
    """

    parts: int
    flow: Any


@kernel(PROJECTION)
def unconstrained(state: Floats, parameters: Floats) -> None:
    """Leave a state where it is."""


@dataclass(frozen=True, eq=False)
class Structure:
    """What a system offers to structure-preserving methods beyond its equation of motion.

    One field per capability, each with a default for systems that lack it, so that a further one is a further field and
    no change for the systems without it.

    Attributes
    ----------
    splitting : Splitting or None
    discrete : compiled function of signature `DISCRETE_STEP`, or None
        The step of a discretised principle of least action.
    degree : int or None
        The equation does not depend on time and is homogeneous of this degree in the state: a state s times as large
        moves on the same curve, s times as large, s^(degree - 1) times as fast.
    projection : compiled function of signature `PROJECTION`
        Puts a state onto the constraints of the motion, which the equation alone would drift off; NaN where that does
        not succeed.
    weight : int
        Units of work (`core.work`) of one evaluation of the equation, which the budget counts as so many evaluations.
    """

    splitting: Splitting | None = None
    discrete: Any = None
    degree: int | None = None
    projection: Any = unconstrained
    weight: int = 1


@dataclass(frozen=True)
class Model:
    """The smallest model that suffices for a question, and why it does.

    Attributes
    ----------
    name : str
        For example ``"torque-free rigid body"``.
    regime : str
        The branch of the solution that applies, for example ``"rotation about the axis of largest moment"``.
    why : str
        The facts of the question that selected it.
    degrees_of_freedom : int
        Of the motion that is computed, not of the body.
    """

    name: str
    regime: str
    why: str
    degrees_of_freedom: int


class Range(NamedTuple):
    """A conserved quantity along samples: its value at the start, the least and the largest of the samples.

    All in one unit that need not be SI; NaN where it is not finite.
    """

    first: float
    least: float
    largest: float


class ClosedForm(Protocol):
    """An exact solution that can be evaluated at any time at the same cost."""

    @property
    def model(self) -> Model:
        """The model, with the regime that holds."""

    @property
    def period(self) -> float | None:
        """Period of the state, or None when it has none (s)."""

    @property
    def largest_norm(self) -> float:
        """Largest norm of the state in the whole motion, which errors are relative to."""

    def sample(self, times: Floats) -> Floats:
        """Return the states, shape (n, k), at `times`, shape (n,), in any order."""

    def error(self, times: Floats) -> float:
        """Return a bound of the numerical error of `sample`, relative to `largest_norm`, inputs taken as exact.

        It is that of the time farthest from the start, and holds for all; infinite where nothing is known of the phase.
        """

    def inherited(self, times: Floats, uncertainty: float) -> float:
        """Return a bound of the change of the states, relative to `largest_norm`, by inputs known to `uncertainty`.

        Infinite where nothing is known of the phase.
        """


class InitialValueProblem(Protocol):
    """A state at t = 0 and an equation of motion: what methods integrate."""

    @property
    def state_column(self) -> tuple[str, str]:
        """Name and unit of the state as a column."""

    @property
    def initial_state(self) -> Floats:
        """State at t = 0, shape (k,)."""

    @property
    def parameters(self) -> Floats:
        """What the equation of motion is given beside the state."""

    @property
    def equation(self) -> Any:
        """Compiled equation of motion, of signature `VECTOR_FIELD`."""

    @property
    def structure(self) -> Structure:
        """What structure-preserving methods may use; ``Structure()`` if there is nothing."""

    @property
    def model(self) -> Model:
        """The model as an integrator sees it."""

    def closed_form(self) -> ClosedForm | None:
        """Return the exact solution, or None where there is none."""

    def ranges(self, states: Floats) -> Mapping[str, Range]:
        """Return the ranges of the conserved quantities, by name, over states of shape (n, k), n > 0."""
