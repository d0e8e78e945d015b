"""A rigid body that touches a level plane at one point, in body axes, by scipy in doubles.

The state is the upward normal g, the angular velocity w and the velocity v of the centre of mass, by components along
the body axes; r(g) leads from the centre of mass to the point that touches. Without slip v = r x w, and with a
reaction F

    m (v' + w x v) = F - m gravity g,    J w' + w x J w = r x F,    g' = g x w.

With slip u = v + w x r the reaction is N (g - mu u/|u|), and g.u = 0 determines N.

References
----------
A. V. Borisov, I. S. Mamaev, "Rolling of a rigid body on plane and sphere. Hierarchy of dynamics", Regular and Chaotic
Dynamics 7 (2002), section 2 (rolling). J. J. Moffatt, Y. Shimomura, "Spinning eggs - a paradox resolved", Nature 416
(2002) (slip).
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.integrate import solve_ivp

Floats = NDArray[np.float64]

GRAVITY = 9.81


def ellipsoid(semi_axes: tuple[float, float, float], at: tuple[float, float, float] = (0.0, 0.0, 0.0)) -> Surface:
    """Return the lowest point of an ellipsoid about a point of the body; of a rim, one semi-axis is zero."""
    squares = np.diag(np.array(semi_axes) ** 2)

    def lowest(g: Floats) -> tuple[Floats, Floats]:
        reach = np.sqrt(g @ squares @ g)
        point = -squares @ g / reach
        slope = -squares / reach + np.outer(squares @ g, squares @ g) / reach**3
        return np.array(at) + point, slope

    return lowest


Surface = Callable[[Floats], tuple[Floats, Floats]]
"""From the normal to the point that touches, and the derivatives of that by the normal."""


@dataclass(frozen=True)
class BodyOnPlane:
    """A body with its tensor of inertia (kg m^2) and its surface."""

    mass: float
    tensor: Floats
    surface: Surface

    def rolls(self, g: Floats, w: Floats, end: float) -> tuple[Floats, Floats]:
        """Return normal and angular velocity after some time without slip."""

        def rates(_: float, state: Floats) -> Floats:
            g, w = state[:3], state[3:]
            r, slope = self.surface(g)
            change = np.cross(g, w)
            moved = slope @ change
            # F less what has w' as a factor, which is m r x w'.
            known = self.mass * (np.cross(moved, w) + np.cross(w, np.cross(r, w)) + GRAVITY * g)
            matrix = self.tensor + self.mass * (r @ r * np.eye(3) - np.outer(r, r))
            gain = np.linalg.solve(matrix, np.cross(r, known) - np.cross(w, self.tensor @ w))
            return np.concatenate([change, gain])

        return self._followed(rates, np.concatenate([g, w]), end)

    def slips(self, g: Floats, w: Floats, v: Floats, friction: float, end: float) -> tuple[Floats, Floats]:
        """Return normal and angular velocity after some time with slip."""

        def rates(_: float, state: Floats) -> Floats:
            g, w, v = state[:3], state[3:6], state[6:]
            r, slope = self.surface(g)
            change = np.cross(g, w)
            moved = slope @ change
            slip = v + np.cross(w, r)
            size = np.linalg.norm(slip)
            push = g - friction * slip / size if size > 0.0 else g
            matrix, right = np.zeros((7, 7)), np.zeros(7)
            matrix[:3, :3], matrix[:3, 6] = self.mass * np.eye(3), -push
            right[:3] = -self.mass * (np.cross(w, v) + GRAVITY * g)
            matrix[3:6, 3:6], matrix[3:6, 6] = self.tensor, -np.cross(r, push)
            right[3:6] = -np.cross(w, self.tensor @ w)
            # The rate of g.(v + w x r), with g.(w' x r) = (r x g).w'.
            matrix[6, :3], matrix[6, 3:6] = g, np.cross(r, g)
            right[6] = -change @ slip - g @ np.cross(w, moved)
            solved = np.linalg.solve(matrix, right)
            return np.concatenate([change, solved[3:6], solved[:3]])

        return self._followed(rates, np.concatenate([g, w, v]), end)

    def _followed(self, rates: Callable[[float, Floats], Floats], state: Floats, end: float) -> tuple[Floats, Floats]:
        found = solve_ivp(rates, (0.0, end), state, method="DOP853", rtol=1e-13, atol=1e-15)
        assert found.success, found.message
        return found.y[:3, -1], found.y[3:6, -1]
