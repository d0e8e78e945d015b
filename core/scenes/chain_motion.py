"""How a heavy chain slides over an apex: x'' = a_0 + k^2 (x - x_0), its tension there, and what ends it.

The square of the velocity is quadratic in x (energy), so is the tension at the apex, and so is T - rho v^2, whose sign
decides whether the chain stays on: the place where something ends the motion is a root of a quadratic, and the time
until then the logarithm of a ratio of e^(kt).
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np

from core.arrays import Floats
from core.balls import raised
from core.scenes.enclosure import UNIT_ROUNDOFF, ZERO, Ball, Balls, sign, square_root
from core.scenes.equation import AcceleratedCoordinate, SceneEquation
from core.scenes.motion import Event, Samples, UnbrokenMotion, finite
from core.scenes.quadratics import real_roots
from core.systems.system import Model

SMALLEST = 2.0**-1074
NAMES = ("position", "velocity", "apex_tension")


@dataclass(frozen=True)
class Slide:
    """The chain in its given state, as balls.

    Attributes
    ----------
    slope_accelerations : balls
        g sin(slope) of the faces.
    position, velocity : ball
        Length of chain on face 1, and its rate.
    """

    masses: Balls
    slope_accelerations: Balls
    length: Ball
    density: Ball
    position: Ball
    velocity: Ball

    @property
    def mass(self) -> Ball:
        """All that moves."""
        return self.masses[0] + self.masses[1] + self.density * self.length

    @cached_property
    def acceleration(self) -> Ball:
        """x'' in the given state."""
        return self.acceleration_at(self.position)

    def acceleration_at(self, x: Ball) -> Ball:
        """Return x'' with a length x on face 1."""
        (m1, m2), (a, b), rho = self.masses, self.slope_accelerations, self.density
        return ((m1 + rho * x) * a - (m2 + rho * (self.length - x)) * b) / self.mass

    @cached_property
    def square(self) -> Ball:
        """k^2, zero for a massless chain or two level faces."""
        return self.density * (self.slope_accelerations[0] + self.slope_accelerations[1]) / self.mass

    @cached_property
    def rate(self) -> Ball:
        """Rate k at which deviations from equilibrium grow."""
        return square_root(self.square)

    @property
    def equilibrium(self) -> Ball | None:
        """Position at which the chain balances, inside or outside of its length; None if there is none, or any."""
        return self.position - self.acceleration / self.square if sign(self.square) else None

    def tension(self, x: Ball) -> Ball:
        """Return the tension at the apex with a length x on face 1."""
        (m1, m2), (a, b), rho = self.masses, self.slope_accelerations, self.density
        return (a + b) * (m1 + rho * x) * (m2 + rho * (self.length - x)) / self.mass

    def velocity_squared(self, x: Ball) -> Ball:
        """Return x'^2 at x, negative where the motion does not come."""
        gone = x - self.position
        return raised(self.velocity, 2) + gone * (2 * self.acceleration + self.square * gone)

    def grip(self) -> tuple[Ball, Ball, Ball]:
        """Return T - rho x'^2 as a quadratic in the displacement from the given position: coefficients of 2, 1, 0."""
        (m1, m2), (a, b), rho, x = self.masses, self.slope_accelerations, self.density, self.position
        left, right = m1 + rho * x, m2 + rho * (self.length - x)
        unit = (a + b) / self.mass
        return (
            -2 * rho * self.square,
            unit * rho * (right - left) - 2 * rho * self.acceleration,
            unit * left * right - rho * raised(self.velocity, 2),
        )

    def reversed(self) -> Slide:
        """Return the chain with the opposite velocity: its future is this one's past."""
        return replace(self, velocity=-self.velocity)

    def mirrored(self) -> Slide:
        """Return the same chain with the faces exchanged: its position is the length on face 2."""
        (m1, m2), (a, b) = self.masses, self.slope_accelerations
        return Slide((m2, m1), (b, a), self.length, self.density, self.length - self.position, -self.velocity)

    def time_to(self, x: Ball, way: int) -> Ball:
        """Return the time until the chain is at x with a velocity of the sign `way`, given that it comes there."""
        gone, k = x - self.position, self.rate
        if sign(gone) == 0 and sign(self.velocity) in (0, way):
            # It is there already: both quotients below would be 0/0 where it also is at rest.
            return ZERO
        speed = way * square_root(self.velocity_squared(x))
        # The difference of the velocities, by their squares where it would cancel.
        total = speed + self.velocity
        turned = sign(speed) * sign(self.velocity) < 0
        gained = speed - self.velocity if turned else gone * (2 * self.acceleration + self.square * gone) / total
        if sign(k) == 0:
            return gained / self.acceleration if turned else 2 * gone / total
        # x' + k (x - x_eq) grows as e^(kt), x' - k (x - x_eq) decays: the larger of the two tells the time.
        growing, decaying = self.acceleration + k * self.velocity, self.acceleration - k * self.velocity
        if not abs(growing) < abs(decaying):
            return (k * (gained + k * gone) / growing).log1p() / k
        return -(-k * (gained - k * gone) / decaying).log1p() / k

    def leaves(self) -> Event | None:
        """Return what ends the motion first, or None if nothing does."""
        low: Ball = -self.position
        high: Ball = self.length - self.position
        below, above = "mass-1-at-apex", "mass-2-at-apex"
        if sign(self.density) > 0:
            c2, c1, c0 = self.grip()
            if sign(c0) < 0:
                return Event("lift-off", ZERO)
            # A concave quadratic, not negative here: the chain stays on between its roots.
            for root in real_roots(c2, c1, c0):
                if root > low and (sign(root) < 0 or (sign(root) == 0 and sign(c1) > 0)):
                    low, below = root, "lift-off"
                elif root < high and (sign(root) > 0 or (sign(root) == 0 and sign(c1) < 0)):
                    high, above = root, "lift-off"
        way = sign(self.velocity) or sign(self.acceleration)
        if way == 0:
            return None
        ahead, behind = (high, low) if way > 0 else (low, high)
        kinds = (above, below) if way > 0 else (below, above)
        goal = self.position + ahead
        if self._reaches(goal, way):
            return Event(kinds[0], self.time_to(goal, way))
        if self._turns(way):
            return Event(kinds[1], self.time_to(self.position + behind, -way))
        return None

    def _barrier(self) -> int:
        """Return the sign of (k x')^2 - x''^2: negative for motions that turn, positive if they pass equilibrium."""
        return sign(self.square * raised(self.velocity, 2) - raised(self.acceleration, 2))

    def _reaches(self, goal: Ball, way: int) -> bool:
        """Whether the chain comes to the goal, which lies the way it moves, without turning first."""
        opposed = sign(self.acceleration) * way < 0
        if sign(self.velocity_squared(goal)) < 0:
            return False
        beyond = sign(self.acceleration_at(goal)) * way
        if opposed and sign(self.square) and beyond >= 0:
            return self._barrier() > 0
        return True

    def _turns(self, way: int) -> bool:
        return sign(self.acceleration) * way < 0 and self._barrier() < 0


class ChainMotion(UnbrokenMotion):
    """A hyperbola in time, or a parabola where the chain has no mass, until an end is at the apex or it lifts off."""

    def __init__(self, slide: Slide) -> None:
        super().__init__(slide.leaves(), lambda: slide.reversed().leaves())
        self.slide = slide

    @property
    def model(self) -> Model:
        """The branch of the solution."""
        if sign(self.slide.acceleration) == 0 and sign(self.slide.velocity) == 0:
            return Model("heavy chain on a wedge", "rest", "the chain balances", 0)
        if sign(self.slide.square) == 0:
            why = "the pull does not depend on the position: no mass in the chain, or level faces"
            return Model("heavy chain on a wedge", "constant acceleration", why, 1)
        return Model("heavy chain on a wedge", "hyperbolic", "the pull grows in proportion to the deviation", 1)

    def at(self, time: Ball) -> Mapping[str, Ball]:
        """Return position, velocity and tension at one time."""
        slide = self.slide
        k, x0, v0, a0 = slide.rate, slide.position, slide.velocity, slide.acceleration
        if k.is_zero():
            x, v = x0 + time * (v0 + a0 * time / 2), v0 + a0 * time
        else:
            sinh, cosh = (k * time).sinh_cosh()
            half = (k * time / 2).sinh()
            x, v = x0 + v0 * sinh / k + 2 * a0 * half * half / (k * k), v0 * cosh + a0 * sinh / k
        return {"position": x, "velocity": v, "apex_tension": slide.tension(x)}

    def sample(self, times: Floats) -> Samples:
        """Evaluate by the form of the solution that cancels less at these times, column by column."""
        slide = self.slide
        with np.errstate(over="ignore", invalid="ignore", under="ignore"):
            x, v, dx, dv = _evaluated(slide, times)
            # A difference from the length would lose the short side of a chain that nearly lies on the other.
            y, _, dy, _ = _evaluated(slide.mirrored(), times)
            greatest, left, right = self._loads(x, y)
            chain, length = slide.density * slide.length, float(slide.length)
            thick, thin = (_share(chain, mass + chain) for mass in slide.masses)
            tension = greatest * (left * right)
            # What the products lose below the normal range; a side without mass is exactly without tension.
            loses = (left != 0.0) & (right != 0.0)
            shift = np.abs(thick * (dx / length) * right) + np.abs(thin * (dy / length) * left) + SMALLEST * loses
            values = finite({"position": x, "velocity": v, "apex_tension": tension})
            errors = {
                "position": dx,
                "velocity": dv,
                "apex_tension": 16 * UNIT_ROUNDOFF * np.abs(tension) + greatest * shift,
            }
        given = (slide.position, slide.velocity, slide.tension(slide.position))
        scales = {
            name: max(float(np.max(np.abs(values[name]), initial=0.0)), abs(float(ball)))
            for name, ball in zip(NAMES, given, strict=True)
        }
        return Samples(values, errors, scales).without_underflow({"apex_tension": given[2]})

    def _loads(self, x: Floats, y: Floats) -> tuple[float, Floats, Floats]:
        """Return the largest tension there may be, and what lengths x and y on the faces make of it on either side.

        Masses are shares of the greatest there may be on a side, so that no product but the last leaves the range of
        doubles unless the tension does.
        """
        slide = self.slide
        (a, b), (m1, m2) = slide.slope_accelerations, slide.masses
        chain, length = slide.density * slide.length, float(slide.length)
        most = (a + b) * (m1 + chain) * (m2 + chain) / slide.mass
        left = _share(m1, m1 + chain) + _share(chain, m1 + chain) * (x / length)
        right = _share(m2, m2 + chain) + _share(chain, m2 + chain) * (y / length)
        return float(most), left, right

    def equation(self) -> SceneEquation:
        """Return x'' = a_0 + k^2 (x - x_0)."""
        slide = self.slide
        position = AcceleratedCoordinate(
            slide.position, slide.velocity, slide.acceleration, slide.square, slide.position
        )
        return SceneEquation((position,), self.model)

    def states(self, columns: Mapping[str, Floats]) -> Floats:
        """Return x and x'."""
        return np.stack((columns["position"], columns["velocity"]), axis=1)

    def observed(self, states: Floats) -> Mapping[str, Floats]:
        """Return position, velocity and tension."""
        x, v = states.T
        greatest, left, right = self._loads(x, float(self.slide.length) - x)
        return {"position": x, "velocity": v, "apex_tension": greatest * (left * right)}


def _evaluated(slide: Slide, times: Floats) -> tuple[Floats, Floats, Floats, Floats]:
    """Return position, velocity and bounds of their errors, each by the form that cancels less."""
    forms = [_from_start(slide, times)]
    if sign(slide.square):
        forms.append(_from_equilibrium(slide, times))
    x, dx = min(((form[0], form[2]) for form in forms), key=lambda column: _largest(column[1]))
    v, dv = min(((form[1], form[3]) for form in forms), key=lambda column: _largest(column[1]))
    return x, v, dx, dv


def _from_start(slide: Slide, t: Floats) -> tuple[Floats, Floats, Floats, Floats]:
    """Return x, x' and bounds of their errors from x_0 + x_0' sinh(kt)/k + x_0'' 2 sinh^2(kt/2)/k^2."""
    x0, v0, a0, k = (float(ball) for ball in (slide.position, slide.velocity, slide.acceleration, slide.rate))
    z = k * t
    half = t * _sinhc(0.5 * z)
    square = 0.5 * a0 * half * half
    single = t * _sinhc(z)
    cosh = np.cosh(z)
    x = x0 + (v0 * single + square)
    v = v0 * cosh + a0 * single
    few = UNIT_ROUNDOFF * (16.0 + 4.0 * np.abs(z))
    # What numbers lose below the normal range; zeros lose nothing.
    tiny = SMALLEST * (1.0 + np.abs(t)) * (1.0 + cosh) * ((v0 != 0.0) + (a0 != 0.0) * np.abs(t))
    dx = few * (np.abs(x0) + np.abs(v0 * single) + np.abs(square)) + tiny * np.abs(t)
    return x, v, dx, few * (np.abs(v0) * cosh + np.abs(a0 * single)) + tiny


def _from_equilibrium(slide: Slide, t: Floats) -> tuple[Floats, Floats, Floats, Floats]:
    """Return x, x' and bounds of their errors from x_eq + P e^(kt) + N e^(-kt)."""
    k = slide.rate
    away, drift = slide.acceleration / slide.square, slide.velocity / k
    equilibrium, growing, decaying, rate = (
        float(ball) for ball in (slide.position - away, (away + drift) / 2, (away - drift) / 2, k)
    )
    z = rate * t
    # A coefficient of zero stays zero however large its exponential.
    up = growing * np.exp(z) if growing else np.zeros_like(z)
    down = decaying * np.exp(-z) if decaying else np.zeros_like(z)
    few = UNIT_ROUNDOFF * (16.0 + 4.0 * np.abs(z))
    size = np.abs(up) + np.abs(down)
    tiny = SMALLEST * (1.0 + rate) * (size != 0.0)
    return (
        equilibrium + (up + down),
        rate * (up - down),
        few * size + 4 * UNIT_ROUNDOFF * (abs(equilibrium) + size) + tiny,
        few * rate * size + tiny,
    )


def _share(part: Ball, whole: Ball) -> float:
    """Return a part of a mass, none of which is none."""
    return float(part / whole) if sign(whole) else 0.0


def _sinhc(z: Floats) -> Floats:
    """Return sinh(z)/z."""
    safe = np.where(z == 0.0, 1.0, z)
    return np.where(z == 0.0, 1.0, np.sinh(safe) / safe)


def _largest(bound: Floats) -> float:
    largest = float(np.max(bound, initial=0.0))
    return largest if np.isfinite(largest) else np.inf
