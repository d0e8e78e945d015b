"""How a free body precesses, to any number of digits."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from fractions import Fraction
from math import isqrt

from flint import arb

from core.bodies.exact_inertia import Vector
from core.bodies.principal_inertia import Symmetry
from core.certified.directions import floor_of_directions, oriented
from core.certified.free_rotation import CertifiedRotation
from core.digits.adaptive_precision import bits_for, check_digits, until_determined
from core.digits.decimals import decimal, decimal_of_fraction, decimals
from core.digits.exact_inputs import enclosed
from core.rotation.exact_start import Balls, Regime
from core.rotation.precession import missing_reasons
from core.rotation.precession.precession import OF_SYMMETRIC_BODIES, order_of_directions
from core.rotation.turning_motion import TurningMotion


@dataclass(frozen=True)
class CertifiedPrecession:
    """Rates and angles of a precession, as numerals; the fields are those of `core.rotation.precession.Precession`.

    Attributes
    ----------
    axis : list of 3 str, or None
        Unit vector in body axes: the symmetry axis, or the principal axis that the angular velocity circles. It points
        along the positive side of the body axis that it is nearest to.
    body_rate, space_rate, mean_precession_rate : str or None
        (rad/s).
    period, flip_interval : str or None
        (s).
    middle_axis_tilt : tuple of 2 str, or None
        Least and largest angle between the middle axis and the angular momentum (rad).
    tumbles : bool
        Whether the middle axis turns over.
    axis_to_angular_momentum, axis_to_angular_velocity, angular_momentum_to_angular_velocity : str or None
        Symmetric bodies only (rad).
    precession_per_period : str or None
        Not reduced by whole turns (rad).
    absent : mapping of str to str
        Why a field is None.
    """

    symmetry: Symmetry
    regime: Regime
    axis: list[str] | None
    body_rate: str | None
    space_rate: str | None
    period: str | None
    flip_interval: str | None
    middle_axis_tilt: tuple[str, str] | None
    tumbles: bool
    axis_to_angular_momentum: str | None
    axis_to_angular_velocity: str | None
    angular_momentum_to_angular_velocity: str | None
    order_of_directions: str | None
    precession_per_period: str | None
    mean_precession_rate: str | None
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
        return until_determined(lambda: decimal(evaluate(), digits), bits)

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
    symmetry = rotation.inertia.symmetry
    has_axis = rotation.regime != "rest" and symmetry != "spherical"
    floor = floor_of_directions(digits)
    found: dict[str, str | None] = dict(
        body_rate=symmetric.body_rate(digits) if symmetric else None,
        space_rate=number(symmetric.space_rate) if symmetric else None,
        period=rotation.period(digits),
        flip_interval=rotation.flip_interval(digits),
        axis_to_angular_momentum=number(symmetric.axis_to_angular_momentum) if symmetric else None,
        axis_to_angular_velocity=number(symmetric.axis_to_angular_velocity) if symmetric else None,
        angular_momentum_to_angular_velocity=number(symmetric.between) if symmetric else None,
        order_of_directions=order_of_directions(symmetry) if symmetric and symmetric.inclined else None,
        precession_per_period=number(per_period) if periodic else None,
        mean_precession_rate=number(mean_rate) if rotation.turns else None,
    )
    axis = until_determined(lambda: decimals(oriented(_axis(rotation)), digits, floor), bits) if has_axis else None
    tilt = rotation.middle_axis_tilt(digits)
    stated = {**found, "axis": axis, "middle_axis_tilt": tilt}
    absent = {name: _why_absent(rotation, name) for name, figure in stated.items() if figure is None}
    return CertifiedPrecession(
        symmetry, rotation.regime, axis, **found, middle_axis_tilt=tilt, tumbles=rotation.tumbles, absent=absent
    )


def _axis(rotation: CertifiedRotation) -> Balls:
    """Return the axis of symmetry, the one that is circled, or the one about which the body turns steadily."""
    inertia, start = rotation.inertia, rotation.start
    if inertia.equal_moments == 2:
        x, y, z = (enclosed(entry) for entry in _axis_of_symmetry(rotation)[0])
    elif rotation.regime == "steady":
        x, y, z = (enclosed(entry) for entry in rotation.angular_velocity_at_start)
    else:
        state = start.principal_state()
        k = 1 if start.side == 0 else 2 if start.side > 0 else 0
        x, y, z = (row[k] for row in state.axes)
        return x, y, z
    if inertia.diagonal:
        # One component alone is not zero.
        x, y, z = (abs(entry) / abs(entry) if not entry.is_zero() else entry for entry in (x, y, z))
        return x, y, z
    norm = (x * x + y * y + z * z).sqrt()
    return x / norm, y / norm, z / norm


def _axis_of_symmetry(rotation: CertifiedRotation) -> tuple[Vector, Fraction, Fraction]:
    """Return a vector along the axis of the single moment of two equal ones, the double moment, and the single one."""
    moments, t = rotation.inertia.rational_moments, rotation.inertia.tensor
    assert moments is not None
    equal, single = (moments[0], moments[2]) if moments[0] == moments[1] else (moments[2], moments[0])
    # I - equal has rank one, so its columns are along the axis; the diagonal holds the squares of the components.
    columns: list[Vector] = [
        (t[0][j] - (equal if j == 0 else 0), t[1][j] - (equal if j == 1 else 0), t[2][j] - (equal if j == 2 else 0))
        for j in range(3)
    ]
    longest = max(range(3), key=lambda j: abs(columns[j][j]))
    x, y, z = columns[longest]
    axis = (x, y, z) if columns[longest][longest] > 0 else (-x, -y, -z)
    return axis, equal, single


def _why_absent(rotation: CertifiedRotation, name: str) -> str:
    equal = rotation.inertia.equal_moments
    if rotation.regime == "rest":
        return missing_reasons.NOTHING_TURNS
    if name == "axis":
        return missing_reasons.SPHERE
    if name == "middle_axis_tilt":
        return missing_reasons.SPHERE if equal == 3 else missing_reasons.NO_MIDDLE_AXIS
    if name in OF_SYMMETRIC_BODIES and equal != 2:
        return missing_reasons.SPHERE if equal == 3 else missing_reasons.TRIAXIAL
    if name == "order_of_directions":
        return missing_reasons.SAME_DIRECTION
    if rotation.regime == "steady":
        return {1: missing_reasons.STEADY_BY_AXIS, 2: missing_reasons.STEADY_IN_BODY, 3: missing_reasons.STEADY_ANYHOW}[
            equal
        ]
    return missing_reasons.ON_THE_SEPARATRIX if rotation.regime == "separatrix" else missing_reasons.NO_MIDDLE_AXIS


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
        if rotation.inertia.equal_moments != 2 or rotation.regime == "rest":
            return None
        axis, equal, single = _axis_of_symmetry(rotation)
        w = rotation.angular_velocity_at_start
        dot = sum((x * y for x, y in zip(axis, w, strict=True)), Fraction(0))
        along = dot * dot / sum((x * x for x in axis), Fraction(0))
        total = sum((x * x for x in w), Fraction(0))
        sign = (dot > 0) - (dot < 0)
        return cls(equal, single, along, total - along, sign, rotation.start.squared_momentum)

    @property
    def inclined(self) -> bool:
        """Whether the spin lies neither along the axis nor across it."""
        return self.along_squared != 0 and self.across_squared != 0

    def body_rate(self, digits: int) -> str | None:
        """(I3 - I)/I w3: rational where w3 is; none for a spin along the axis, which does not go round it."""
        if self.across_squared == 0:
            return None
        if self.along_squared == 0:
            return "0"
        factor = (self.single - self.equal) / self.equal * self.direction
        root = _rational_root(self.along_squared)
        if root is not None:
            return decimal_of_fraction(factor * root, digits)
        return until_determined(
            lambda: decimal(enclosed(factor) * enclosed(self.along_squared).sqrt(), digits), bits_for(digits)
        )

    def space_rate(self) -> arb:
        """L/I."""
        return enclosed(self.squared_momentum).sqrt() / enclosed(self.equal)

    def axis_to_angular_momentum(self) -> arb:
        """Return the angle between axis and angular momentum."""
        across, along = enclosed(self.across_squared).sqrt(), enclosed(self.along_squared).sqrt()
        return arb.atan2(enclosed(self.equal) * across, enclosed(self.single) * self.direction * along)

    def axis_to_angular_velocity(self) -> arb:
        """Return the angle between axis and angular velocity."""
        across, along = enclosed(self.across_squared).sqrt(), enclosed(self.along_squared).sqrt()
        return arb.atan2(across, self.direction * along)

    def between(self) -> arb:
        """Return the angle between angular momentum and angular velocity."""
        product = enclosed(self.along_squared * self.across_squared).sqrt()
        dot = enclosed(self.equal * self.across_squared + self.single * self.along_squared)
        return arb.atan2(enclosed(abs(self.single - self.equal)) * product, dot)


def _rational_root(square: Fraction) -> Fraction | None:
    top, bottom = isqrt(square.numerator), isqrt(square.denominator)
    root = Fraction(top, bottom)
    return root if root * root == square else None
