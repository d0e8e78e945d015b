"""Polhodes, the closed curves of the angular velocity on the energy ellipsoid, and the separatrix between them.

A polhode is the intersection of the energy ellipsoid and the momentum ellipsoid. With the amplitudes of the motion it
is

    w_c = A_c cos(theta),   w_b = A_b sin(theta),   w_d = A_d sqrt(cos^2 theta + m1 sin^2 theta),

the closed form with theta = am u. Even steps of theta give evenly distributed points even near the separatrix, where
even steps of time would concentrate them at the middle axis. The extreme points, where a component vanishes or is
largest, are at multiples of pi/2. All four are among the points if and only if the number of points is a multiple of 4;
the first always is.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import lru_cache

import numpy as np

from core.arrays import Floats
from core.bodies.mass_properties import MassProperties, PrincipalInertia
from core.double_double import Scaled, sc_div, sc_mul, sc_pair, sc_sqrt, scaled
from core.errors import BudgetExceeded, InvalidParameter
from core.rotation.closed_form.circulation import REST, SEPARATRIX, STEADY
from core.rotation.free_rotation import FreeRotation
from core.rotation.precession.figures import OUT_OF_RANGE, stated
from core.rotation.surfaces.energy_surface import EnergyEllipsoid
from core.work import spend

MOST_POINTS = 100_000
WORK_OF_A_CURVE = 20
"""Units of work (`core.work`) of a curve for the constants of its motion, in addition to those of its points."""


@dataclass(frozen=True, eq=False)
class Polhode:
    """One curve.

    Attributes
    ----------
    regime : str
        Of the motion along it.
    closed : bool
        Whether the last point is the first; a steady rotation is a single point.
    angular_momentum : float or None
        Magnitude, the same at every point (kg m^2/s); None if it leaves the range of normal doubles.
    points : ndarray, shape (n, 3)
        In body axes (rad/s).
    """

    regime: str
    closed: bool
    angular_momentum: float | None
    points: Floats


def polhode(body: MassProperties, angular_velocity: Floats, count: int = 256) -> Polhode:
    """Return the polhode through an angular velocity, shape (3,), as `count` points and the first again.

    On the separatrix itself the result is the whole ellipse, of which the motion traces one half.

    Raises
    ------
    InvalidParameter, BudgetExceeded
        If the count is below 8 or above 100000, or the body cannot turn freely.
    """
    check_count(count)
    rotation = FreeRotation(body.principal_of_motion, angular_velocity)
    motion = rotation.motion
    regime = rotation.model.regime
    momentum = _momentum(rotation)
    if motion.regime in (REST, STEADY):
        return Polhode(regime, False, momentum, angular_velocity.reshape(1, 3).copy())
    cosine, sine = _circle(count)
    on_separatrix = motion.regime == SEPARATRIX
    along = cosine if on_separatrix else np.sqrt(cosine * cosine + motion.m1 * (sine * sine))
    c, d = (0, 2) if motion.circled == 2 else (2, 0)
    principal = np.empty((count + 1, 3))
    principal[:, c], principal[:, 1], principal[:, d] = motion.A_c * cosine, motion.A_b * sine, motion.A_d * along
    return Polhode(regime, True, momentum, rotation.frame.to_body(principal))


def separatrix(body: MassProperties, energy: float, count: int = 256) -> tuple[Polhode, ...]:
    """Return the separatrix of an energy (J): two ellipses that cross at the middle axis, none if moments are equal.

    From D_B = 0: A_b^2 = 2E/B, A_a^2 = B (C - B) A_b^2 / (A (C - A)), A_c^2 = B (B - A) A_b^2 / (C (C - A)).
    """
    check_count(count)
    principal = body.principal_of_motion
    middle = float(np.sort(EnergyEllipsoid.of(body, energy).semi_axes)[1])
    shares = _shares(principal)
    if shares is None:
        return ()
    cosine, sine = _circle(count)
    moment = scaled(float(principal.moments[1]), float(principal.moments_tail[1]), 1)
    size = stated(sc_sqrt(sc_mul(scaled(energy, 0.0, 0), moment)))
    momentum = None if size == OUT_OF_RANGE else size
    frame = FreeRotation(principal, np.zeros(3)).frame
    curves = []
    for side in (1.0, -1.0):
        points = np.stack([shares[0] * middle * cosine, middle * sine, side * shares[1] * middle * cosine], axis=1)
        curves.append(Polhode("separatrix", True, momentum, frame.to_body(points)))
    return tuple(curves)


def _momentum(rotation: FreeRotation) -> float | None:
    """Return |L|, formed with separate exponents; None if it leaves the range of normal doubles."""
    moments, rates = rotation.resolved.moments, rotation.resolved.angular_velocity
    size, rate = math.frexp(float(moments[2]))[1], math.frexp(float(np.abs(rates).max()))[1]
    mantissa, exponent = math.frexp(math.hypot(*(np.ldexp(moments, -size) * np.ldexp(rates, -rate)).tolist()))
    exponent += size + rate
    return math.ldexp(mantissa, exponent) if -1021 <= exponent <= 1024 else None


def _shares(principal: PrincipalInertia) -> tuple[float, float] | None:
    """Return A_a/A_b and A_c/A_b of the separatrix, or None if two moments are equal."""
    i = [scaled(h, low, 0) for h, low in zip(principal.moments.tolist(), principal.moments_tail.tolist(), strict=True)]

    def difference(j: int, k: int) -> Scaled:
        a, b = principal.moments, principal.moments_tail
        return scaled(float(a[j] - a[k]), float((a[j] - (a[j] - a[k])) - a[k] + (b[j] - b[k])), 0)

    low, high, whole = difference(1, 0), difference(2, 1), difference(2, 0)
    if not all(principal.apart):
        return None

    def share(step: Scaled, outer: Scaled) -> float:
        return float(sc_pair(sc_sqrt(sc_div(sc_mul(i[1], step), sc_mul(outer, whole))))[0])

    return share(high, i[0]), share(low, i[2])


@lru_cache(maxsize=4)
def _circle(count: int) -> tuple[Floats, Floats]:
    """Return cosines and sines of even steps around the circle, the last the same as the first.

    At the ends of a quadrant cosine and sine are exactly 0 and 1.
    """
    quadrant, rest = np.divmod(4 * np.arange(count), count)
    angle = rest * (0.5 * math.pi / count)
    c, s = np.cos(angle), np.sin(angle)
    cosine = np.choose(quadrant, (c, -s, -c, s)) + 0.0
    sine = np.choose(quadrant, (s, c, -s, -c)) + 0.0
    cosine, sine = np.append(cosine, cosine[0]), np.append(sine, sine[0])
    cosine.setflags(write=False)
    sine.setflags(write=False)
    return cosine, sine


def check_count(count: int) -> None:
    """Raise `InvalidParameter` for fewer than 8 points on a curve, `BudgetExceeded` for more than 100000."""
    if count < 8:
        raise InvalidParameter("points", "be at least 8")
    if count > MOST_POINTS:
        raise BudgetExceeded("points", count, MOST_POINTS, path=("points",), remedy="ask for fewer points on a curve")
    spend(count + WORK_OF_A_CURVE)
