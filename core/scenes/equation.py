"""The equation of motion of a named scene, which methods integrate: y'' = a + b (y - c) + d sin y of each coordinate.

Every scene whose motion is known in closed form between events has one: constant accelerations, a deviation that grows
or oscillates, a pendulum. It is separable, so that the exact flows of its two parts, positions at constant rates and
rates at constant positions, compose to the Stormer-Verlet method.

References
----------
E. Hairer, C. Lubich, G. Wanner, Geometric Numerical Integration, 2nd ed., Springer 2006, section VI.3.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from core.arrays import Floats
from core.compiled import kernel
from core.scenes.enclosure import ZERO, Ball
from core.systems.system import PART_FLOW, VECTOR_FIELD, ClosedForm, Model, Range, Splitting, Structure


@kernel(VECTOR_FIELD)
def _equation(time: float, state: Floats, parameters: Floats, slope: Floats) -> None:
    """Fill in the rates and the accelerations."""
    n = state.size // 2
    for i in range(n):
        a, b, c, d = parameters[4 * i], parameters[4 * i + 1], parameters[4 * i + 2], parameters[4 * i + 3]
        slope[i] = state[n + i]
        slope[n + i] = a + b * (state[i] - c) + d * math.sin(state[i])


@kernel(PART_FLOW)
def _flow(part: int, duration: float, state: Floats, parameters: Floats) -> None:
    """Move the coordinates at constant rates, or the rates at constant coordinates."""
    n = state.size // 2
    for i in range(n):
        if part == 0:
            state[i] += duration * state[n + i]
        else:
            a, b, c, d = parameters[4 * i], parameters[4 * i + 1], parameters[4 * i + 2], parameters[4 * i + 3]
            state[n + i] += duration * (a + b * (state[i] - c) + d * math.sin(state[i]))


@dataclass(frozen=True)
class AcceleratedCoordinate:
    """One coordinate y at t = 0, and its acceleration a + b (y - c) + d sin y.

    Attributes
    ----------
    value, rate : ball
    constant, slope, origin, sine : ball
        a, b, c and d.
    """

    value: Ball
    rate: Ball
    constant: Ball = ZERO
    slope: Ball = ZERO
    origin: Ball = ZERO
    sine: Ball = ZERO


@dataclass(frozen=True, eq=False)
class SceneEquation:
    """A named scene between events, as methods see it: the state is (y, y') of its coordinates, in SI units.

    Attributes
    ----------
    coordinates : tuple of AcceleratedCoordinate
    model : Model
        Of the motion.
    """

    coordinates: tuple[AcceleratedCoordinate, ...]
    model: Model

    @cached_property
    def initial_state(self) -> Floats:
        """Coordinates and rates at t = 0, shape (2 n,)."""
        return np.array([float(one.value) for one in self.coordinates] + [float(one.rate) for one in self.coordinates])

    @cached_property
    def parameters(self) -> Floats:
        """The numbers of the coordinates, one after another."""
        numbers = ((one.constant, one.slope, one.origin, one.sine) for one in self.coordinates)
        return np.array([float(number) for four in numbers for number in four])

    @property
    def equation(self) -> object:
        """The one equation of all named scenes."""
        return _equation

    @property
    def structure(self) -> Structure:
        """The two flows."""
        return Structure(splitting=Splitting(2, _flow))

    @property
    def state_column(self) -> tuple[str, str]:
        """The coordinates and rates, which share no unit."""
        return "state", "1"

    def closed_form(self) -> ClosedForm | None:
        """Return None: what a scene is compared with is its own motion, column by column."""
        return None

    def ranges(self, states: Floats) -> Mapping[str, Range]:
        """Return nothing: no energy is among the columns of a scene."""
        return {}
