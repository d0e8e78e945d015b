"""The energy ellipsoid and the polhode on it, to any number of digits."""

from __future__ import annotations

from collections.abc import Callable
from fractions import Fraction

from flint import arb

from core.certified.decimals import decimal, decimals, floor_below
from core.certified.exact_inertia import ExactInertia
from core.certified.exact_inputs import Number, enclosed, exact
from core.certified.exact_start import ExactStart
from core.certified.free_rotation import CertifiedRotation, Rows
from core.certified.raising import bits_for, check_digits, determined, each_determined
from core.certified.turning_motion import TurningMotion
from core.errors import InvalidParameter, NotApplicable


def certified_semi_axes(inertia: ExactInertia, energy: Number, digits: int) -> list[str]:
    """Return the semi-axes sqrt(2E/I) of the energy ellipsoid, in ascending order of moments (rad/s).

    Raises
    ------
    InvalidParameter
        For an energy that is not positive, or digits outside 16 to 1000.
    """
    check_digits(digits)
    twice = 2 * exact(energy, "energy")
    if twice <= 0:
        raise InvalidParameter("energy", "be greater than 0 J")
    zero = Fraction(0)

    def evaluate() -> list[str]:
        rational = inertia.rational_moments
        if rational is not None:
            return [decimal(enclosed(twice / moment).sqrt(), digits) for moment in rational]
        moments = ExactStart(inertia, (zero, zero, zero)).principal_state().moments
        return [decimal((enclosed(twice) / moment).sqrt(), digits) for moment in moments]

    return determined(evaluate, bits_for(digits))


def certified_polhode(rotation: CertifiedRotation, count: int, digits: int) -> Rows:
    """Return points of the polhode in body axes, `count` rows of 3 numerals, equally spaced in time.

    A closed polhode is gone round once, from u = 0, in the direction of the motion and without repeating the first
    point. The arc of the separatrix through the start is given for u from -log(count) to log(count), where it has come
    as near to its ends as the points are to each other.

    Raises
    ------
    InvalidParameter
        For a count below 2, or digits outside 16 to 1000.
    NotApplicable
        If the angular velocity is constant, so that the polhode is one point.
    """
    if count < 2:
        raise InvalidParameter("count", "be at least 2")
    check_digits(digits, 3 * count)
    if not rotation.turns:
        raise NotApplicable("the angular velocity is constant, so its polhode is one point")

    def evaluators() -> Callable[[int], list[str]]:
        motion = TurningMotion(rotation.start)
        floor = floor_below(motion.largest_rate, digits)
        if motion.separatrix:
            reach = arb(count).log()
            return lambda i: decimals(
                motion.in_body(motion.in_frame(reach * (2 * i - count + 1) / (count - 1))), digits, floor
            )
        return lambda i: decimals(motion.in_body(motion.in_frame(arb(2 * i) / count)), digits, floor)

    return each_determined(evaluators, count, bits_for(digits))
