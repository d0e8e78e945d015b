"""How a free body precesses: rates, periods and cones, from the initial state alone; nothing is integrated.

Two equal moments I beside I3, spin w3 along the axis e3 of the third and w_perp across it (regular precession):

    body rate   (I3 - I)/I w3                of the angular velocity about e3, seen in the body
    space rate  L/I                          of e3 about the angular momentum L, seen in space
    angles      tan(e3, L) = I w_perp / (I3 w3),   tan(e3, w) = w_perp / w3,
                tan(L, w) = |I3 - I| w_perp |w3| / (I w_perp^2 + I3 w3^2)

Three distinct moments: period 4K/p of the angular velocity, and the angle by which the circled axis turns about L in
it, whose quotient is the mean precession rate. The angle is accurate to the last digit; modulo a whole turn it is
Montgomery's 2 E T/L less the solid angle that L encloses in the body.

Two moments that differ by rounding alone, less than 16 units in the last place, have the rates and angles of their mean
while the elliptic parameter m, and their difference as a share of that from the third, are below 2^-30. Period, and
angle in it, are always those of the moments as given, since near the plane of the two that little decides.

References
----------
L. D. Landau, E. M. Lifshitz, "Mechanics", sections 33 and 37. H. Goldstein, C. Poole, J. Safko, "Classical
Mechanics", 3rd ed., section 5.6. R. Montgomery, "How much does the rigid body rotate?", American Journal of Physics 59
(1991) 394.
"""

from __future__ import annotations

from collections.abc import Mapping
from math import inf, isfinite, isnan, nan
from types import MappingProxyType
from typing import Literal, NamedTuple

import numpy as np

from core.arrays import Floats
from core.bodies.mass_properties import MassProperties, Symmetry
from core.errors import InvalidParameter
from core.notices import Notice
from core.rotation.closed_form.circulation import (
    PERIODIC,
    SEPARATRIX,
    STEADY,
    UNREACHABLE,
    too_near_the_separatrix,
)
from core.rotation.closed_form.principal_frame import Resolved
from core.rotation.equal_moments import NEARLY_EQUAL, equal_within_rounding
from core.rotation.free_rotation import FreeRotation
from core.rotation.precession import missing_reasons
from core.rotation.precession.figure_errors import axis_error, figure_errors, found_figures
from core.rotation.precession.figures import OUT_OF_RANGE, UNRESOLVED
from core.rotation.precession.middle_axis import middle_axis_tilt
from core.rotation.stability.classification import unstable_axis, unstable_spin
from core.rotation.torque_free import inherited_notices

Regime = Literal["rest", "steady", "periodic", "separatrix"]
Absent = Mapping[str, str]
Errors = Mapping[str, float | tuple[float, float] | None]

FIGURES = (
    "body_rate",
    "space_rate",
    "period",
    "flip_interval",
    "axis_to_angular_momentum",
    "axis_to_angular_velocity",
    "angular_momentum_to_angular_velocity",
    "precession_per_period",
    "mean_precession_rate",
)
NO_ERRORS: Errors = dict.fromkeys(("axis", "middle_axis_tilt", *FIGURES))


class Precession(NamedTuple):
    """Rates and angles of a precession; None where the motion has no such thing, and `absent` says why.

    Attributes
    ----------
    symmetry : str
        Class of the principal moments about the point about which the body turns.
    regime : {"rest", "steady", "periodic", "separatrix"}
        Of the angular velocity in the body.
    axis : ndarray, shape (3,), or None
        Unit vector in body axes: the symmetry axis, or the principal axis that the angular velocity circles. It points
        along the positive side of the body axis that it is nearest to.
    body_rate : float or None
        Rate at which the angular velocity goes round `axis` in the body, positive in the right-hand sense; 0 for a spin
        across the axis, None for one along it; symmetric bodies only (rad/s).
    space_rate : float or None
        Rate L/I at which the axis goes round the angular momentum; symmetric bodies only. For a spin along the
        axis it is the rate of an infinitesimal wobble (rad/s).
    period : float or None
        Of the angular velocity in the body (s).
    flip_interval : float or None
        Between sign changes of the component along the middle axis, whether or not that axis turns over (s).
    middle_axis_tilt : tuple of 2 floats, or None
        Least and largest angle between the middle axis and the angular momentum in the whole motion (rad).
    tumbles : bool
        Whether the middle axis turns over, from within 45 degrees of the angular momentum to within 45 degrees of its
        opposite.
    axis_to_angular_momentum, axis_to_angular_velocity : float or None
        Angle of the axis with each, from 0 to pi; symmetric bodies only (rad). The second is the half-angle of
        the body cone if it is acute.
    angular_momentum_to_angular_velocity : float or None
        Half-angle of the space cone; symmetric bodies only (rad).
    order_of_directions : str or None
        Which of axis, angular momentum and angular velocity lies between the others.
    precession_per_period : float or None
        Angle by which the axis turns about the angular momentum in a period, not reduced by whole turns (rad).
    mean_precession_rate : float or None
        That angle over the period; on the separatrix the limit that the rate tends to (rad/s).
    errors : mapping of str to float, pair of floats, or None
        Bounds of the errors of axis (the length of the difference), rates, times and angles, each under its name and in
        its unit; None where the field is.
    absent : mapping of str to str
        Why a field is None.
    warnings : tuple of Notice
    """

    symmetry: Symmetry
    regime: Regime
    axis: Floats | None = None
    body_rate: float | None = None
    space_rate: float | None = None
    period: float | None = None
    flip_interval: float | None = None
    middle_axis_tilt: tuple[float, float] | None = None
    tumbles: bool = False
    axis_to_angular_momentum: float | None = None
    axis_to_angular_velocity: float | None = None
    angular_momentum_to_angular_velocity: float | None = None
    order_of_directions: str | None = None
    precession_per_period: float | None = None
    mean_precession_rate: float | None = None
    errors: Errors = NO_ERRORS
    absent: Absent = MappingProxyType({})
    warnings: tuple[Notice, ...] = ()


OF_SYMMETRIC_BODIES = (
    "body_rate",
    "space_rate",
    "axis_to_angular_momentum",
    "axis_to_angular_velocity",
    "angular_momentum_to_angular_velocity",
    "order_of_directions",
)
_OF_A_CHANGE = ("period", "flip_interval", "precession_per_period", "mean_precession_rate")


def precession(body: MassProperties, angular_velocity: Floats | tuple[float, float, float]) -> Precession:
    """Return how a free body precesses that turns with an angular velocity at t = 0.

    Parameters
    ----------
    body : MassProperties
    angular_velocity : ndarray, shape (3,), or tuple of 3 floats
        In body axes (rad/s).

    Raises
    ------
    InvalidParameter
        If the angular velocity is not three finite numbers, or a moment of inertia is not positive.
    AccuracyUnreachable
        If the start is nearer to the separatrix than doubles resolve.
    """
    x, y, z = _components(angular_velocity)
    if not (isfinite(x) and isfinite(y) and isfinite(z)):
        raise InvalidParameter("angular_velocity", "be three finite numbers")
    inertia, warnings = body.principal_of_motion, inherited_notices(body)
    if not inertia.moments[0] > 0.0:
        # Refused there unless a line of matter turns across itself.
        FreeRotation(inertia, np.array((x, y, z)))
    symmetry = inertia.symmetry
    if x == y == z == 0.0:
        return Precession(symmetry, "rest", absent=_AT_REST.copy(), warnings=warnings)
    if not any(inertia.apart):
        return Precession(symmetry, "steady", absent=_SPHERE.copy(), warnings=warnings)
    k = _SYMMETRY_AXIS[symmetry] if symmetry != "spherical" else _AXIS_NEAR_A_SPHERE[inertia.apart]
    resolved = Resolved.of(inertia, np.array((x, y, z)))
    regime, beyond, apart, axis, figures = found_figures(k, inertia, resolved)
    if regime == UNREACHABLE:
        raise too_near_the_separatrix()
    if symmetry == "spherical" or beyond:
        warnings += (NEARLY_EQUAL,)
    elif apart:
        warnings += (_EQUAL_IN_FIGURES,)
    report = _REPORTS[symmetry if k < 0 else _SYMMETRY_ABOUT[k], regime, beyond]
    absent = report.absent.copy()
    tilt = middle_axis_tilt(resolved, inertia)
    if tilt is not None:
        absent.pop("middle_axis_tilt", None)
        if not isfinite(tilt.least):
            code, reason = _LOST[OUT_OF_RANGE]
            absent["middle_axis_tilt"] = reason
            warnings += (Notice(code, f"middle_axis_tilt {reason} and is null"),)
    if report.regime == "steady" and inertia.moments[0] > 0.0:
        why = unstable_spin(inertia.apart, resolved.angular_velocity.tolist())
        warnings += () if why is None else (unstable_axis(why),)
    if report is _CONSTANT and isnan(figures[0]):
        absent["body_rate"] = missing_reasons.STEADY_IN_BODY
    if not isnan(figures[3]) and report.order is not None:
        if inertia.rounding.exact_zeros:
            # The moments are the body's own, and the middle one is known to differ.
            absent.pop("flip_interval", None)
        else:
            figures = (*figures[:3], nan, *figures[4:])
    if OUT_OF_RANGE in figures or UNRESOLVED in figures:
        lost = {name: _LOST[figure] for name, figure in zip(FIGURES, figures, strict=True) if figure in _LOST}
        absent |= {name: reason for name, (_, reason) in lost.items()}
        warnings += tuple(Notice(code, f"{name} {reason} and is null") for name, (code, reason) in lost.items())
    body_rate, space_rate, period, flip, to_momentum, to_velocity, between, turned, mean = [
        figure if isfinite(figure) else None for figure in figures
    ]
    *known, least, largest = figure_errors(k, inertia, resolved, figures, tilt)
    errors: dict[str, float | tuple[float, float] | None] = {
        "axis": axis_error(inertia, axis),
        "middle_axis_tilt": (least, largest) if tilt is not None and isfinite(tilt.least) else None,
        **{name: x if isfinite(figure) else None for name, figure, x in zip(FIGURES, figures, known, strict=True)},
    }
    pointing: Floats = np.array(axis)
    pointing.setflags(write=False)
    return Precession(
        symmetry, report.regime, pointing, body_rate, space_rate, period, flip,
        tilt.range if tilt is not None and isfinite(tilt.least) else None, tilt is not None and tilt.tumbles,
        to_momentum, to_velocity, between, report.order, turned, mean, errors, absent, warnings,
    )  # fmt: skip


def _components(vector: Floats | tuple[float, float, float]) -> tuple[float, float, float]:
    """Return the components of a vector, infinite if it has not three."""
    if type(vector) is tuple and len(vector) == 3:
        x, y, z = vector
        return float(x), float(y), float(z)
    given = np.asarray(vector, dtype=np.float64)
    x, y, z = given.tolist() if given.shape == (3,) else (inf, inf, inf)
    return x, y, z


_SYMMETRY_AXIS: Mapping[Symmetry, int] = {"triaxial": -1, "oblate": 2, "prolate": 0, "linear": 0}
"""Number, in ascending order, of the moment that is not equal to the other two."""

_AXIS_NEAR_A_SPHERE = {(False, True): 2, (True, False): 0, (True, True): -1}
"""The same of three nearly equal moments, by which of them differ."""

_SYMMETRY_ABOUT: Mapping[int, Symmetry] = {2: "oblate", 0: "prolate"}

_LOST: Mapping[float, tuple[str, str]] = {
    OUT_OF_RANGE: ("out-of-range", "leaves the range of double precision"),
    UNRESOLVED: ("unresolved", "is too small a part of a turn to be told from none in double precision"),
}
"""What is said of figures that exist and cannot be stated."""


class RegimeReport(NamedTuple):
    """What one kind of motion is called, and what is said of the figures that it does not have."""

    regime: Regime
    order: str | None
    absent: dict[str, str]


def _absent(*reasons: tuple[str, tuple[str, ...]]) -> dict[str, str]:
    return {name: reason for reason, names in reasons for name in names}


_AT_REST = _absent((missing_reasons.NOTHING_TURNS, ("axis", "middle_axis_tilt", *OF_SYMMETRIC_BODIES, *_OF_A_CHANGE)))
_SPHERE = _absent(
    (missing_reasons.SPHERE, ("axis", "middle_axis_tilt", *OF_SYMMETRIC_BODIES)),
    (missing_reasons.STEADY_ANYHOW, _OF_A_CHANGE),
)
_THREE = missing_reasons.TRIAXIAL, OF_SYMMETRIC_BODIES
_BEYOND = (
    "the spin lies so near the plane of two nearly equal moments, or the third is so near to them, that the body does "
    "not move as a symmetric one",
    OF_SYMMETRIC_BODIES,
)
_NEAR_A_SPHERE = (
    "the three moments are nearly equal, and the body moves neither as a sphere nor as one with an axis of symmetry",
    OF_SYMMETRIC_BODIES,
)
_NEVER_RETURNS = missing_reasons.ON_THE_SEPARATRIX, _OF_A_CHANGE[:-1]


def _of_three(reason: tuple[str, tuple[str, ...]]) -> dict[int, RegimeReport]:
    return {
        STEADY: RegimeReport("steady", None, _absent(reason, (missing_reasons.STEADY_BY_AXIS, _OF_A_CHANGE))),
        PERIODIC: RegimeReport("periodic", None, _absent(reason)),
        SEPARATRIX: RegimeReport("separatrix", None, _absent(reason, _NEVER_RETURNS)),
    }


_UNLIKE_SYMMETRIC = {
    PERIODIC: RegimeReport("periodic", None, _absent(_BEYOND)),
    SEPARATRIX: RegimeReport("separatrix", None, _absent(_BEYOND, _NEVER_RETURNS)),
}
_CONSTANT = RegimeReport(
    "steady",
    None,
    _absent(
        (missing_reasons.STEADY_IN_BODY, _OF_A_CHANGE),
        (missing_reasons.SAME_DIRECTION, ("order_of_directions",)),
        (missing_reasons.NO_MIDDLE_AXIS, ("middle_axis_tilt",)),
    ),
)
_NO_MIDDLE_AXIS = _absent((missing_reasons.NO_MIDDLE_AXIS, ("flip_interval", "middle_axis_tilt")))


def order_of_directions(symmetry: Symmetry) -> str:
    """Return which of axis, angular momentum and angular velocity lies between the others, no two in one direction."""
    if symmetry == "oblate":
        return "oblate: the angular momentum lies between the axis and the angular velocity"
    return "prolate: the angular velocity lies between the axis and the angular momentum"


def _all_reports() -> Mapping[tuple[Symmetry, int, bool], RegimeReport]:
    """Return the reports by symmetry, regime and whether a symmetric body does not move as one."""
    found: dict[tuple[Symmetry, int, bool], RegimeReport] = {
        ("triaxial", regime, False): report for regime, report in _of_three(_THREE).items()
    }
    found |= {("spherical", regime, False): report for regime, report in _of_three(_NEAR_A_SPHERE).items()}
    symmetric: tuple[Symmetry, ...] = ("oblate", "prolate")
    for symmetry in symmetric:
        found[symmetry, STEADY, False] = _CONSTANT
        found[symmetry, PERIODIC, False] = RegimeReport("periodic", order_of_directions(symmetry), _NO_MIDDLE_AXIS)
        found |= {(symmetry, regime, True): report for regime, report in _UNLIKE_SYMMETRIC.items()}
    return found


_REPORTS = _all_reports()


_EQUAL_IN_FIGURES = equal_within_rounding(
    "two moments",
    "the figures that only a symmetric body has; period, and angle in it, are those of the moments as given",
)
