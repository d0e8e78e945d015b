"""The torque-free rigid body to any number of digits, for inputs that are taken as exact doubles.

The angular velocity is Jacobi's closed form, the attitude Euler's angles about the angular momentum, the precession
among them an integral of the third kind in Carlson's form. No theta function is used.

References
----------
.. [1] L. D. Landau, E. M. Lifshitz, Mechanics, 3rd ed., section 37 (the asymmetrical top).
.. [2] R. Montgomery, How much does the rigid body rotate?, American Journal of Physics 59 (1991) 394.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from fractions import Fraction
from typing import Any

from mpmath import mp, mpf

from .elliptic import SLACK
from .motion import Constant, Moving, Quaternion, Vector, product, real, rounded
from .polhode import Polhode, accelerates

Number = float | Fraction

# Enough for several digits of a difference that is a few ulps.
SENSITIVITY_DIGITS = 25


def free_motion(
    moments: Sequence[Number], angular_velocity: Sequence[Number], times: Sequence[Number] = (), digits: int = 50
) -> Constant | Moving:
    """Return the motion, ready to be evaluated to `digits` digits at the given times or earlier ones."""
    inertia = [Fraction(x) for x in moments]
    rates = [Fraction(x) for x in angular_velocity]
    horizon = max((abs(Fraction(t)) for t in times), default=Fraction(0))
    if accelerates(inertia, rates):
        return Moving(Polhode.through(inertia, rates), horizon, digits)
    return Constant(rates, horizon, digits)


def reference_angular_velocity(
    moments: Sequence[Number], angular_velocity: Sequence[Number], times: Sequence[Number], digits: int = 50
) -> list[Vector]:
    """Return the angular velocity in the body's principal axes [1]_.

    Parameters
    ----------
    moments : sequence of 3 floats or fractions
        Principal moments of inertia, positive, in the order of the body's axes.
    angular_velocity : sequence of 3 floats or fractions
        Components along these axes at ``t = 0``.
    times : sequence of floats or fractions
        In any order, of any sign.
    digits : int
        The error is below ``10**-digits`` of the largest rate.

    Returns
    -------
    list of tuple of 3 mpf
        One vector per time.
    """
    motion = free_motion(moments, angular_velocity, times, digits)
    return [motion.angular_velocity(Fraction(t)) for t in times]


def reference_attitude(
    moments: Sequence[Number],
    angular_velocity: Sequence[Number],
    times: Sequence[Number],
    attitude: Sequence[Number] = (1, 0, 0, 0),
    digits: int = 50,
) -> list[Quaternion]:
    """Return the attitude as unit quaternions [w, x, y, z], body to space, with the sign that continuity gives them.

    Parameters
    ----------
    moments, angular_velocity, times, digits
        As in `reference_angular_velocity`.
    attitude : sequence of 4 floats or fractions
        Attitude at ``t = 0``; normalised here.

    Returns
    -------
    list of tuple of 4 mpf
        One quaternion per time.
    """
    motion = free_motion(moments, angular_velocity, times, digits)
    turned = []
    with mp.workdps(digits + SLACK):
        start = [real(Fraction(x)) for x in attitude]
        norm = mp.norm(start)
        for t in times:
            w, x, y, z = rounded(product([x / norm for x in start], motion.rotation(Fraction(t))), digits)
            turned.append((w, x, y, z))
    return turned


def largest_rate(moments: Sequence[Number], angular_velocity: Sequence[Number], digits: int = 50) -> mpf:
    """Return the largest norm that the angular velocity takes in the whole motion."""
    return rounded([free_motion(moments, angular_velocity, digits=digits).largest_rate], digits)[0]


def period(moments: Sequence[Number], angular_velocity: Sequence[Number], digits: int = 50) -> mpf | None:
    """Return the period of the angular velocity in the body, None if it is constant or on the separatrix."""
    duration = free_motion(moments, angular_velocity, digits=digits).period
    return None if duration is None else rounded([duration], digits)[0]


def flip_interval(moments: Sequence[Number], angular_velocity: Sequence[Number], digits: int = 50) -> mpf | None:
    """Return the time between two changes of sign of the middle component, half a period.

    None if there is no period, or if two equal moments leave no middle axis.
    """
    duration = period(moments, angular_velocity, digits)
    return None if duration is None or len(set(moments)) < 3 else mp.ldexp(duration, -1)


def precession_per_period(
    moments: Sequence[Number], angular_velocity: Sequence[Number], digits: int = 50
) -> mpf | None:
    """Return the angle by which the circled axis turns about the angular momentum in one period.

    It is Euler's angle, positive about the angular momentum and not reduced modulo 2 pi; modulo 2 pi it is the angle
    by which the whole body has turned [2]_. None if there is no period.
    """
    angle = free_motion(moments, angular_velocity, digits=digits).precession_per_period
    return None if angle is None else rounded([angle], digits)[0]


def half_ulp_sensitivity(
    moments: Sequence[float], angular_velocity: Sequence[float], times: Sequence[float]
) -> list[float]:
    """Return by how much half an ulp in the inputs moves the angular velocity.

    Parameters
    ----------
    moments, angular_velocity, times
        As in `reference_angular_velocity`.

    Returns
    -------
    list of float
        For each time the sum over the six inputs of the norm of the change when that input alone grows in size by
        half an ulp. An input that is zero is exact.
    """

    def change(one: Vector, other: Vector) -> mpf:
        return mp.norm([x - y for x, y in zip(one, other, strict=True)])

    return _sensitivity(reference_angular_velocity, change, moments, angular_velocity, times)


def half_ulp_sensitivity_attitude(
    moments: Sequence[float], angular_velocity: Sequence[float], times: Sequence[float]
) -> list[float]:
    """Return by how much half an ulp in the moments and rates moves the rotation matrix, in the Frobenius norm.

    Otherwise as `half_ulp_sensitivity`. The initial attitude is taken as exact; which it is does not matter.
    """

    def change(one: Quaternion, other: Quaternion) -> mpf:
        # Two rotations an angle a apart differ by 2 sqrt(2) sin(a/2) in this norm.
        w, x, y, z = one
        return mp.sqrt(8) * mp.norm(product((w, -x, -y, -z), other)[1:])

    return _sensitivity(reference_attitude, change, moments, angular_velocity, times)


def _sensitivity(
    reference: Callable[..., list[Any]],
    change: Callable[[Any, Any], mpf],
    moments: Sequence[float],
    angular_velocity: Sequence[float],
    times: Sequence[float],
) -> list[float]:
    def samples(inputs: Sequence[Fraction]) -> list[Any]:
        return reference(inputs[:3], inputs[3:], times, digits=SENSITIVITY_DIGITS)

    given = [Fraction(x) for x in (*moments, *angular_velocity)]
    unmoved = samples(given)
    total = [mpf(0) for _ in times]
    with mp.workdps(SENSITIVITY_DIGITS):
        for i, x in enumerate(given):
            if x:
                half = Fraction(math.copysign(math.ulp(x), x)) / 2
                moved = samples([*given[:i], x + half, *given[i + 1 :]])
                total = [s + change(one, other) for s, one, other in zip(total, unmoved, moved, strict=True)]
    return [float(x) for x in total]
