"""How the rod swings, what the wall does to it, and what ends its contact with the wall.

With k the depth of the centre below the axis, rho^2 = k^2 + kappa l^2 (moment about the axis over mass) and
w0^2 = g k/rho^2,

    N_A + N_B = M a (g cos psi/k + psi'^2),    N_A - N_B = (2 kappa M g a l/rho^2) sin psi,

and by energy the smaller force has the sign of (1 + q) cos psi - p |sin psi| + q (2m - 1), q = 2k^2/rho^2,
p = 2 kappa k l/rho^2: a single cosine of a shifted angle, so where contact is lost is an arc cosine and when an
elliptic integral.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace
from functools import cached_property
from typing import Any

import numpy as np

from core.arrays import Floats
from core.balls import raised
from core.scenes.enclosure import UNIT_ROUNDOFF, ZERO, Ball, Balls, angle_of, exact, sign
from core.scenes.equation import AcceleratedCoordinate, SceneEquation
from core.scenes.motion import Event, Samples, UnbrokenMotion, finite
from core.scenes.pendulum import Pendulum
from core.scenes.pendulum_in_balls import pendulum_in_balls
from core.systems.system import Model

WHY = {
    "rest": "the rod lies at the bottom",
    "libration": "the energy is less than that of standing upright: elliptic functions of modulus sin(amplitude/2)",
    "separatrix": "the energy is that of standing upright: hyperbolic functions",
    "rotation": "the energy exceeds that of standing upright: elliptic functions",
}


@dataclass(frozen=True)
class Rod:
    """The constants, as balls; `depth` is k and `inertia` rho^2."""

    radius: Ball
    length: Ball
    mass: Ball
    gravity: Ball
    factor: Ball
    depth: Ball

    @cached_property
    def inertia(self) -> Ball:
        """Moment of inertia about the axis over the mass."""
        return raised(self.depth, 2) + self.factor * raised(self.length, 2)

    @property
    def frequency(self) -> Ball:
        """w0, the rate of small oscillations."""
        return (self.gravity * self.depth / self.inertia).sqrt()

    @property
    def parameters(self) -> Balls:
        """q and p."""
        k = self.depth
        return 2 * k * k / self.inertia, 2 * self.factor * k * self.length / self.inertia

    @property
    def coefficients(self) -> tuple[Ball, Ball, Ball]:
        """Coefficients of cos psi and psi'^2 in the sum of the wall's forces and of sin psi in their difference."""
        weight = self.mass * self.gravity * self.radius
        return weight / self.depth, self.mass * self.radius, 2 * self.factor * weight * self.length / self.inertia

    def forces(self, sine: Ball, cosine: Ball, rate: Ball) -> Balls:
        """Return the wall's forces on A and B at an angle of this sine and cosine."""
        c1, c2, c3 = self.coefficients
        total = c1 * cosine + c2 * raised(rate, 2)
        difference = c3 * sine
        return (total + difference) / 2, (total - difference) / 2


def contact_limits(rod: Rod) -> Balls:
    """Return the largest angle of release and the least rate at the bottom of full turns that keep contact."""
    q, p = rod.parameters
    limit = angle_of(rod.inertia, 2 * rod.factor * rod.depth * rod.length)
    return limit, (rod.gravity / rod.depth * (q + (raised(1 + q, 2) + raised(p, 2)).sqrt())).sqrt()


class RodMotion(UnbrokenMotion):
    """A pendulum, as long as both ends are on the wall and none passes the rim.

    Parameters
    ----------
    rim : balls or None
        Sine and cosine of half the angle at which an end is at the rim; None without a rim.
    """

    def __init__(self, rod: Rod, pendulum: Pendulum, rim: Balls | None) -> None:
        self.rod, self.pendulum, self._rim = rod, pendulum, rim
        super().__init__(self._leaves(pendulum), lambda: self._leaves(replace(pendulum, rate=-pendulum.rate)))

    @property
    def model(self) -> Model:
        """The branch of the pendulum."""
        regime = self.pendulum.regime
        return Model("rod in a cylindrical hole", regime, WHY[regime], 0 if regime == "rest" else 1)

    def rate_at_horizontal(self) -> Ball | None:
        """Return psi' when the rod is horizontal for the first time, None if it never is."""
        swing = self.pendulum
        if swing.regime == "rest":
            return ZERO
        ways = (1, -1) if swing.regime == "libration" else (swing.direction,)
        arrivals = [(time, way) for way in ways if (time := swing.passes(ZERO, exact(1), way)) is not None]
        if not arrivals:
            return None
        time, way = min(arrivals, key=lambda arrival: float(arrival[0]))
        if self.end is not None and time > self.end.time:
            return None
        return way * 2 * swing.frequency * swing.m.sqrt()

    def _leaves(self, swing: Pendulum) -> Event | None:
        """Return what ends the motion first; there is none for a rod that only touches a bound."""
        candidates = []
        if self._rim is not None and sign(swing.m - raised(self._rim[0], 2)) > 0:
            candidates += [(swing.passes(*self._rim, 1), "end-b-passes-rim")]
            candidates += [(swing.passes(-self._rim[0], self._rim[1], -1), "end-a-passes-rim")]
        candidates += self._losses(swing)
        events = [Event(kind, time) for time, kind in candidates if time is not None]
        return min(events, key=lambda event: float(event.time)) if events else None

    def _losses(self, swing: Pendulum) -> list[tuple[Ball | None, str]]:
        """Return when the upper end leaves the wall, on either side."""
        q, p = self.rod.parameters
        size, level = (raised(1 + q, 2) + raised(p, 2)).sqrt(), q * (swing.m - swing.m1)
        if not level < size:
            return []
        shift = angle_of(p, 1 + q)
        lower = (-level / size).acos() - shift
        upper = 2 * lower.pi() - lower - 2 * shift
        s, c = (lower / 2).sin(), (lower / 2).cos()
        if sign(swing.m - raised(s, 2)) <= 0:
            return []
        here = 2 * angle_of(abs(swing.sine), swing.cosine)
        side = "b" if sign(swing.sine) > 0 else "a"
        if here > lower and here < upper:
            return [(ZERO, f"end-{side}-leaves-wall")]
        if not here < upper:
            # Above, held to the wall by its speed: it comes down on the other side of the top, or on this one.
            s, c = (upper / 2).sin(), (upper / 2).cos()
            way = swing.direction
            return [(swing.passes(-way * s, c, way), f"end-{'a' if way > 0 else 'b'}-leaves-wall")]
        return [
            (swing.passes(s, c, 1), "end-b-leaves-wall"),
            (swing.passes(-s, c, -1), "end-a-leaves-wall"),
        ]

    @cached_property
    def _swing(self) -> Callable[[Ball], tuple[Ball, Ball, Ball, Ball]]:
        return pendulum_in_balls(self.pendulum)

    def at(self, time: Ball) -> Mapping[str, Any]:
        """Return angle, rate and the wall's forces on A and B at one time."""
        c1, c2, c3 = self.rod.coefficients
        sine, cosine, rate, angle = self._swing(time)
        # A square as a product: the library returns NaN for the power of a ball that contains zero.
        total = c1 * (cosine - sine) * (cosine + sine) + c2 * rate * rate
        difference = 2 * c3 * sine * cosine
        forces = ((total + difference) / 2, (total - difference) / 2)
        return {"angle": angle, "angular_velocity": rate, "forces": forces}

    def sample(self, times: Floats) -> Samples:
        """Evaluate angle, rate and the wall's forces on A and B."""
        s, c, rate, angle = self.pendulum.sample(times)
        c1, _, c3 = (float(ball) for ball in self.rod.coefficients)
        with np.errstate(over="ignore", invalid="ignore", under="ignore"):
            forces, spin = self._forces(s, c, rate)
            values = finite({"angle": angle, "angular_velocity": rate, "forces": forces})
        few = 32.0 * UNIT_ROUNDOFF
        size = np.abs(c1) * (c * c + s * s) + np.abs(spin) + np.abs(c3 * s * c)
        errors = {
            "angle": few * np.abs(angle),
            "angular_velocity": few * np.abs(rate),
            "forces": 2.0 * few * size[:, None],
        }
        given = {
            "angle": float(2 * angle_of(abs(self.pendulum.sine), self.pendulum.cosine)),
            "angular_velocity": abs(float(self.pendulum.rate)),
            "forces": max(abs(float(force)) for force in self.rod.forces(*self.pendulum.whole, self.pendulum.rate)),
        }
        scales = {name: max(float(np.max(np.abs(column), initial=0.0)), given[name]) for name, column in values.items()}
        weight = self.rod.mass * self.rod.gravity
        return Samples(values, errors, scales).without_underflow({"forces": weight})

    def _forces(self, s: Floats, c: Floats, rate: Floats) -> tuple[Floats, Floats]:
        """Return the wall's forces, shape (n, 2), by sine and cosine of half the angle, and the share of the rate."""
        c1, _, c3 = (float(ball) for ball in self.rod.coefficients)
        speed = 2 * self.pendulum.frequency
        # c2 psi'^2 as a product that leaves the range of doubles only where the force itself does.
        unit, quick = float(self.rod.coefficients[1] * raised(speed, 2)), rate / float(speed)
        level, spin = c1 * (c - s) * (c + s), unit * quick * quick
        total, difference = level + spin, 2.0 * c3 * s * c
        return 0.5 * np.stack((total + difference, total - difference), axis=1), spin

    def equation(self) -> SceneEquation:
        """Return psi'' = -w0^2 sin psi."""
        swing = self.pendulum
        angle = AcceleratedCoordinate(
            2 * angle_of(swing.sine, swing.cosine), swing.rate, sine=-raised(swing.frequency, 2)
        )
        return SceneEquation((angle,), self.model)

    def states(self, columns: Mapping[str, Floats]) -> Floats:
        """Return psi and psi'."""
        return np.stack((columns["angle"], columns["angular_velocity"]), axis=1)

    def observed(self, states: Floats) -> Mapping[str, Floats]:
        """Return angle, rate and the wall's forces on A and B."""
        angle, rate = states.T
        forces, _ = self._forces(np.sin(0.5 * angle), np.cos(0.5 * angle), rate)
        return {"angle": angle, "angular_velocity": rate, "forces": forces}
