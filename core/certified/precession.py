"""How a free body precesses, to any number of digits."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from fractions import Fraction
from math import isqrt

from flint import arb

from core.certified.decimals import decimal, decimal_of_fraction
from core.certified.exact_inertia import Vector
from core.certified.exact_inputs import enclosed
from core.certified.exact_start import Regime
from core.certified.free_rotation import CertifiedRotation
from core.certified.raising import bits_for, check_digits, determined
from core.certified.turning_motion import TurningMotion


@dataclass(frozen=True)
class CertifiedPrecession:
    """Rates and angles of a precession, as numerals; None where the motion has no such thing.

    Attributes
    ----------
    regime : str
    period : str or None
        Of the angular velocity in the body (s).
    flip_interval : str or None
        Between sign changes of the middle component (s).
    precession_per_period : str or None
        Angle by which the circled axis turns about the angular momentum in a period, not reduced (rad).
    mean_precession_rate : str or None
        That angle over the period (rad/s); on the separatrix, the limit that the rate tends to, L/I of the middle axis.
    body_rate : str or None
        Rate at which the angular velocity goes round the symmetry axis, signed; symmetric bodies only (rad/s).
    space_rate : str or None
        Rate at which the symmetry axis goes round the angular momentum, L/I; symmetric bodies only (rad/s).
    momentum_angle, spin_angle : str or None
        Angle of the symmetry axis with the angular momentum and with the angular velocity; symmetric bodies only (rad).
    absent : mapping of str to str
        Why a field is None.
    """

    regime: Regime
    period: str | None
    flip_interval: str | None
    precession_per_period: str | None
    mean_precession_rate: str | None
    body_rate: str | None
    space_rate: str | None
    momentum_angle: str | None
    spin_angle: str | None
    absent: Mapping[str, str]


def certified_precession(rotation: CertifiedRotation, digits: int) -> CertifiedPrecession:
    """Return everything about the precession of a free body with so many significant digits.

    Raises
    ------
    InvalidParameter
        For digits outside 16 to 1000.
    BudgetExceeded
        If a precision beyond the limit would be needed.
    """
    check_digits(digits)
    start, bits = rotation.start, bits_for(digits)

    def number(evaluate: Callable[[], arb]) -> str:
        return determined(lambda: decimal(evaluate(), digits), bits)

    def per_period() -> arb:
        angle = TurningMotion(start).precession_per_period
        assert angle is not None
        return angle

    def mean_rate() -> arb:
        motion = TurningMotion(start)
        if motion.separatrix:
            return motion.L / motion.moments[1]
        angle, period = motion.precession_per_period, motion.period
        assert angle is not None
        assert period is not None
        return angle / period

    periodic = rotation.regime == "periodic"
    symmetric = _Symmetric.of(rotation)
    figures: dict[str, str | None] = dict(
        period=rotation.period(digits),
        flip_interval=rotation.flip_interval(digits),
        precession_per_period=number(per_period) if periodic else None,
        mean_precession_rate=number(mean_rate) if rotation.turns else None,
        body_rate=symmetric.body_rate(digits) if symmetric else None,
        space_rate=number(symmetric.space_rate) if symmetric else None,
        momentum_angle=number(symmetric.momentum_angle) if symmetric else None,
        spin_angle=number(symmetric.spin_angle) if symmetric else None,
    )
    absent = {name: _why_absent(rotation, name) for name, figure in figures.items() if figure is None}
    return CertifiedPrecession(rotation.regime, **figures, absent=absent)


def _why_absent(rotation: CertifiedRotation, name: str) -> str:
    of_symmetric_bodies = name in ("body_rate", "space_rate", "momentum_angle", "spin_angle")
    if rotation.regime == "rest":
        return "nothing turns"
    if of_symmetric_bodies and rotation.inertia.equal_moments != 2:
        equal = (
            "are equal, so that every axis is" if rotation.inertia.equal_moments == 3 else "differ, so that no axis is"
        )
        return f"the three moments {equal} one of symmetry"
    if rotation.regime == "steady":
        return "the angular velocity is constant in the body"
    if rotation.regime == "separatrix":
        return "on the separatrix the body tends to the middle axis and never returns"
    return "two moments are equal, so that there is no middle axis"


@dataclass(frozen=True)
class _Symmetric:
    """A spin of a body with exactly two equal moments, along and across its symmetry axis.

    Attributes
    ----------
    equal, single : Fraction
        The double moment and the other.
    along_squared, across_squared : Fraction
        Squares of the components of the angular velocity.
    direction : int
        Sign of the component along the axis; the axis points along the body axis that it is nearest to.
    squared_momentum : Fraction
    """

    equal: Fraction
    single: Fraction
    along_squared: Fraction
    across_squared: Fraction
    direction: int
    squared_momentum: Fraction

    @classmethod
    def of(cls, rotation: CertifiedRotation) -> _Symmetric | None:
        inertia = rotation.inertia
        moments = inertia.rational_moments
        if moments is None or inertia.equal_moments != 2 or rotation.regime == "rest":
            return None
        equal, single = (moments[0], moments[2]) if moments[0] == moments[1] else (moments[2], moments[0])
        t, w = inertia.tensor, rotation.angular_velocity_at_start
        columns: list[Vector] = [
            (t[0][j] - (equal if j == 0 else 0), t[1][j] - (equal if j == 1 else 0), t[2][j] - (equal if j == 2 else 0))
            for j in range(3)
        ]
        longest = max(range(3), key=lambda j: abs(columns[j][j]))
        axis = columns[longest]
        dot = sum((x * y for x, y in zip(axis, w, strict=True)), Fraction(0)) * (1 if axis[longest] > 0 else -1)
        along = dot * dot / sum((x * x for x in axis), Fraction(0))
        total = sum((x * x for x in w), Fraction(0))
        sign = (dot > 0) - (dot < 0)
        return cls(equal, single, along, total - along, sign, rotation.start.squared_momentum)

    def body_rate(self, digits: int) -> str | None:
        """(I3 - I)/I w3: rational where w3 is."""
        if self.across_squared == 0 or self.along_squared == 0:
            return None
        factor = (self.single - self.equal) / self.equal * self.direction
        root = _rational_root(self.along_squared)
        if root is not None:
            return decimal_of_fraction(factor * root, digits)
        return determined(
            lambda: decimal(enclosed(factor) * enclosed(self.along_squared).sqrt(), digits), bits_for(digits)
        )

    def space_rate(self) -> arb:
        """L/I."""
        return enclosed(self.squared_momentum).sqrt() / enclosed(self.equal)

    def momentum_angle(self) -> arb:
        """Return the angle between axis and angular momentum."""
        across, along = enclosed(self.across_squared).sqrt(), enclosed(self.along_squared).sqrt()
        return arb.atan2(enclosed(self.equal) * across, enclosed(self.single) * self.direction * along)

    def spin_angle(self) -> arb:
        """Return the angle between axis and angular velocity."""
        across, along = enclosed(self.across_squared).sqrt(), enclosed(self.along_squared).sqrt()
        return arb.atan2(across, self.direction * along)


def _rational_root(square: Fraction) -> Fraction | None:
    top, bottom = isqrt(square.numerator), isqrt(square.denominator)
    root = Fraction(top, bottom)
    return root if root * root == square else None
