"""Every equilibrium of a free body to any number of digits.

About axis i at the rate W, lambda^2 = W^2 (I_i - I_j)(I_k - I_i)/(I_j I_k), and lambda = 0. Which moments are equal is
decided exactly; what follows from that stands in `core.rotation.stability.classification`.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from fractions import Fraction

from flint import arb

from core.balls import Undetermined
from core.bodies.exact_inertia import ExactInertia
from core.bodies.principal_inertia import Symmetry
from core.certified.directions import floor_of_directions, oriented
from core.certified.free_rotation import CertifiedRotation
from core.digits.adaptive_precision import bits_for, check_digits, until_determined
from core.digits.decimals import decimal, decimal_of_fraction, decimals
from core.digits.exact_inputs import Number, enclosed, exact, exact_numbers
from core.rotation.exact_start import Balls, PrincipalState, principal_axes
from core.rotation.regimes import triaxial_model
from core.rotation.stability.classification import REST, Attitude, Kind, Verdict, classify_equilibrium, drift
from core.rotation.stability.stability import flip_reason, no_middle_axis
from core.rotation.turning_motion import constants_of


@dataclass(frozen=True)
class CertifiedEquilibrium:
    """A constant angular velocity; the fields are those of `core.rotation.stability.Equilibrium`.

    Attributes
    ----------
    axis : list of 3 str, or None
        Unit vector in body axes, along the positive side of the body axis that it is nearest to; None for the state of
        rest.
    moment : str or None
        About this axis (kg m^2).
    eigenvalues : tuple of (real, imaginary)
        (1/s).
    growth_rate, drift_rate : str
        (1/s).
    """

    axis: list[str] | None
    moment: str | None
    eigenvalues: tuple[tuple[str, str], tuple[str, str], tuple[str, str]]
    kind: Kind
    stable: bool
    growth_rate: str
    drift_rate: str
    linearly_stable: bool
    attitude: Attitude
    survives_dissipation: bool
    reason: str


@dataclass(frozen=True)
class CertifiedFlip:
    """What becomes of a disturbed rotation about the middle axis.

    Attributes
    ----------
    disturbance : tuple of 2 str
        Rates along the axes of smallest and largest moment (rad/s).
    interval : str or None
        Between sign changes of the component along the middle axis (s).
    reason : str
    """

    disturbance: tuple[str, str]
    interval: str | None
    reason: str


@dataclass(frozen=True)
class CertifiedStability:
    """All equilibria of a free body at one rate, about the axes in ascending order of moments and at rest."""

    symmetry: Symmetry
    rate: str
    equilibria: tuple[CertifiedEquilibrium, ...]
    flip: CertifiedFlip | None


def certified_stability(
    inertia: ExactInertia, rate: Number, digits: int, disturbance: Sequence[Number] | None = None
) -> CertifiedStability:
    """Return every equilibrium and, if a disturbance is given, the interval of its flips.

    Raises
    ------
    InvalidParameter
        For a rate or a disturbance that is no number, a moment that is zero, or digits outside 16 to 1000.
    NotApplicable
        If a disturbance is given and the body has no middle axis.
    BudgetExceeded
        If a precision beyond the limit would be needed: a disturbance on the separatrix of irrational moments.
    """
    check_digits(digits)
    spin = exact(rate, "rate")
    inertia.require_extent()
    flip = None
    if disturbance is not None:
        flip = _flip(inertia, spin, exact_numbers(disturbance, ("disturbance",), 2), digits)
    rational = inertia.rational_moments
    ranks = (0, 1, 2) if rational is None else [sorted(set(rational)).index(moment) for moment in rational]
    verdict = [classify_equilibrium(ranks, axis, spin != 0) for axis in range(3)]

    def evaluate() -> tuple[CertifiedEquilibrium, ...]:
        state = principal_axes(inertia)
        return tuple(_about(state, rational, axis, spin, verdict[axis], digits) for axis in range(3))

    equilibria = (*until_determined(evaluate, bits_for(digits)), _rest())
    return CertifiedStability(inertia.symmetry, decimal_of_fraction(spin, digits), equilibria, flip)


def _about(
    state: PrincipalState,
    rational: tuple[Fraction, ...] | None,
    axis: int,
    spin: Fraction,
    verdict: Verdict,
    digits: int,
) -> CertifiedEquilibrium:
    size, drifts = "0", "0"
    if verdict.kind != "degenerate":
        size = decimal(enclosed(abs(spin)) * _eigenvalue(state, axis), digits)
    elif rational is not None:
        low, high = (rational[n] for n in range(3) if n != axis)
        drifts = decimal_of_fraction(drift(rational[axis], low, high, spin), digits)
    minus = "0" if size == "0" else f"-{size}"
    saddle = verdict.kind == "saddle"
    return CertifiedEquilibrium(
        decimals(oriented(_column(state, axis)), digits, floor_of_directions(digits)),
        decimal(state.moments[axis], digits) if rational is None else decimal_of_fraction(rational[axis], digits),
        ((size, "0"), (minus, "0"), ("0", "0")) if saddle else (("0", size), ("0", minus), ("0", "0")),
        verdict.kind,
        verdict.stable,
        size if saddle else "0",
        drifts,
        verdict.linearly_stable,
        verdict.attitude,
        verdict.survives_dissipation,
        verdict.reason,
    )


def _eigenvalue(state: PrincipalState, axis: int) -> arb:
    """Return |lambda| at the rate one."""
    first, second = (state.moments[k] for k in range(3) if k != axis)
    ab, bc, ac = state.gaps
    near = ((ab, ac), (ab, bc), (bc, ac))[axis]
    square = near[0] * near[1] / (first * second)
    if not square > 0:
        raise Undetermined
    return square.sqrt()


def _column(state: PrincipalState, axis: int) -> Balls:
    x, y, z = (row[axis] for row in state.axes)
    return x, y, z


def _rest() -> CertifiedEquilibrium:
    zero, verdict = ("0", "0"), REST
    return CertifiedEquilibrium(
        None,
        None,
        (zero, zero, zero),
        verdict.kind,
        verdict.stable,
        "0",
        "0",
        verdict.linearly_stable,
        verdict.attitude,
        verdict.survives_dissipation,
        verdict.reason,
    )


def _flip(inertia: ExactInertia, rate: Fraction, disturbance: tuple[Fraction, ...], digits: int) -> CertifiedFlip:
    if inertia.equal_moments > 1:
        raise no_middle_axis()
    small, large = disturbance
    given = (decimal_of_fraction(small, digits), decimal_of_fraction(large, digits))
    moments = inertia.rational_moments
    if moments is not None:
        along = CertifiedRotation.of_moments(moments, (small, rate, large))
        interval = along.flip_interval(digits)
        return CertifiedFlip(given, interval, flip_reason(interval is not None, along.tumbles, along.model.why))
    if (small, rate, large).count(0) >= 2:
        # Along one axis or at rest, whatever the moments are.
        steady = CertifiedRotation.of_moments((1, 2, 3), (small, rate, large))
        return CertifiedFlip(given, None, flip_reason(False, False, steady.model.why))

    def evaluate() -> tuple[str, int, bool]:
        state = principal_axes(inertia)
        low, _, high = state.moments
        ab, bc, _ = state.gaps
        # D_B = L^2 - 2E B.
        difference = high * bc * enclosed(large**2) - low * ab * enclosed(small**2)
        if not (difference > 0 or difference < 0):
            raise Undetermined
        side = 1 if difference > 0 else -1
        rates = (enclosed(small), enclosed(rate), enclosed(large))
        constants = constants_of(state.moments, state.gaps, rates, side, abs(difference))
        tumbles = bool(constants.least_tilt(state.moments, side) < arb.pi() / 4)
        return decimal(constants.half_period, digits), side, tumbles

    interval, side, tumbles = until_determined(evaluate, bits_for(digits))
    return CertifiedFlip(given, interval, flip_reason(True, tumbles, triaxial_model(side > 0).why))
