"""Which rotations of a free body last: every equilibrium with its eigenvalues, and what is proved about it.

About principal axis i at the rate W, with j and k the other two, small disturbances of the angular velocity grow as

    lambda^2 = W^2 (I_i - I_j)(I_k - I_i) / (I_j I_k),   and lambda = 0 along the axis:

a centre on the axes of largest and smallest moment, a saddle on the middle one. The differences are formed exactly.
What follows from them, and where it is proved, stands in `core.rotation.stability.classification`.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from math import isfinite
from typing import NamedTuple

import numpy as np

from core.arrays import Floats
from core.bodies.mass_properties import MassProperties, PrincipalInertia, Symmetry
from core.bodies.principal_inertia import ROUNDED_ONCE
from core.errors import AccuracyUnreachable, InvalidParameter, NotApplicable
from core.notices import Notice
from core.quantities import AngularRate, check_value
from core.rotation.equal_moments import moments_of_kinds
from core.rotation.free_rotation import FreeRotation
from core.rotation.precession.figures import OUT_OF_RANGE, oriented
from core.rotation.stability.classification import REST, Attitude, Kind, classify_equilibrium
from core.rotation.stability.errors import AT_REST, EquilibriumErrors, equilibrium_errors, flip_error
from core.rotation.stability.linearised import LinearRates, linear_rates
from core.rotation.torque_free import inherited_notices

Eigenvalue = tuple[float, float]


class Equilibrium(NamedTuple):
    """A constant angular velocity.

    Attributes
    ----------
    axis : ndarray, shape (3,), or None
        Unit vector in body axes; None for the state of rest.
    moment : float or None
        About this axis (kg m^2).
    eigenvalues : tuple of (real, imaginary), or None
        Of the linearised equation for the angular velocity: a pair and the zero along the axis (1/s). None where they
        leave the range of double precision.
    kind : {"center", "saddle", "degenerate"}
    stable : bool
        Whether the angular velocity stays as near as one likes to this one if it starts near enough (Lyapunov).
    growth_rate : float or None
        Exponential rate of a small disturbance, 0 where none grows exponentially (1/s).
    drift_rate : float or None
        Where a disturbance grows linearly: its rate of change per unit of disturbance (1/s); otherwise 0.
    linearly_stable : bool
        Whether disturbances of the linearised equation stay bounded.
    attitude : {"orbital", "unstable"}
        The attitude of a stable rotation is stable only as an orbit: a slightly different rate leads it astray in time.
    survives_dissipation : bool
        Whether a body that loses energy inside, at constant angular momentum, can end here: the axis of largest
        moment, or one of several that share it.
    reason : str
    errors : EquilibriumErrors
    """

    axis: Floats | None
    moment: float | None
    eigenvalues: tuple[Eigenvalue, Eigenvalue, Eigenvalue] | None
    kind: Kind
    stable: bool
    growth_rate: float | None
    drift_rate: float | None
    linearly_stable: bool
    attitude: Attitude
    survives_dissipation: bool
    reason: str
    errors: EquilibriumErrors = AT_REST


@dataclass(frozen=True)
class Flip:
    """What becomes of a disturbed rotation about the middle axis.

    Attributes
    ----------
    disturbance : tuple of 2 floats
        Rates added along the axes of smallest and largest moment (rad/s).
    interval : float or None
        Between sign changes of the component along the middle axis; None if there are none, or they are farther apart
        than doubles can say (s).
    reason : str
    error : float or None
        Of the interval (s).
    """

    disturbance: tuple[AngularRate, AngularRate]
    interval: float | None
    reason: str
    error: float | None = None


class Stability(NamedTuple):
    """All equilibria of a free body at one rate.

    Attributes
    ----------
    symmetry : str
        Class of the principal moments about the point about which the body turns.
    rate : float
        rad/s.
    equilibria : tuple of Equilibrium
        About the three principal axes in ascending order of moments, and the state of rest. Where moments are equal,
        every axis in their plane (of a sphere, in space) is an equilibrium, of which the ones listed stand for all.
    flip : Flip or None
        If a disturbance was given.
    warnings : tuple of Notice
    """

    symmetry: Symmetry
    rate: float
    equilibria: tuple[Equilibrium, ...]
    flip: Flip | None = None
    warnings: tuple[Notice, ...] = ()


def stability(body: MassProperties, rate: float = 1.0, disturbance: tuple[float, float] | None = None) -> Stability:
    """Return every equilibrium of a free body, whether it is stable, in which sense, and why.

    Parameters
    ----------
    body : MassProperties
    rate : float
        Of the rotations about the principal axes (rad/s).
    disturbance : tuple of 2 floats, optional
        Rates along the axes of smallest and largest moment, added to the rotation about the middle axis: the
        interval of its flips is then given (rad/s).

    Raises
    ------
    InvalidParameter
        If the rate or the disturbance is not finite, or a moment of inertia is not positive.
    NotApplicable
        If a disturbance is given and the body has no middle axis.
    AccuracyUnreachable
        If the disturbance is smaller than doubles resolve.
    """
    check_value("rate", AngularRate, rate)
    inertia = body.principal_of_motion
    if not inertia.moments[0] > 0.0:
        rule = "have three moments of inertia greater than 0 to rotate freely"
        raise InvalidParameter("body", rule, remedy="give a body with extent in at least two directions")
    moments, warnings = moments_of_kinds(inertia)
    rates = linear_rates(*moments, float(rate))
    pairs = list(zip(*(part.tolist() for part in moments), strict=True))
    shown = [_about(moments, pairs, k, rates[k], inertia) for k in range(3)]
    outside = [
        Notice(
            "out-of-range",
            f"eigenvalues of equilibrium {k} leave the range of double precision and are null",
            ("rate",),
        )
        for k, e in enumerate(shown)
        if e.eigenvalues is None or e.drift_rate is None
    ]
    flip = None if disturbance is None else _flip(inertia, len(set(pairs)), float(rate), disturbance)
    return Stability(
        inertia.symmetry, float(rate), (*shown, _AT_REST), flip, (*inherited_notices(body), *warnings, *outside)
    )


def _about(
    of_kinds: tuple[Floats, Floats],
    moments: list[tuple[float, float]],
    axis: int,
    rates: LinearRates,
    inertia: PrincipalInertia,
) -> Equilibrium:
    distinct = sorted(set(moments))
    verdict = classify_equilibrium([distinct.index(moment) for moment in moments], axis, rates.turning != 0.0)
    size = None if rates.size == OUT_OF_RANGE else rates.size
    pair: tuple[Eigenvalue, Eigenvalue] | None = None
    growth: float | None = 0.0
    if verdict.kind == "saddle":
        growth = size
    if size is not None:
        back = -size if size else 0.0
        pair = ((size, 0.0), (back, 0.0)) if verdict.kind == "saddle" else ((0.0, size), (0.0, back))
    *pointing, _ = oriented(inertia.axes, axis)
    axis_of: Floats = np.array(pointing)
    axis_of.setflags(write=False)
    drift = None if rates.drift == OUT_OF_RANGE else rates.drift
    return Equilibrium(
        axis_of,
        float(inertia.moments[axis]),
        None if pair is None else (*pair, (0.0, 0.0)),
        verdict.kind,
        verdict.stable,
        growth,
        drift,
        verdict.linearly_stable,
        verdict.attitude,
        verdict.survives_dissipation,
        verdict.reason,
        equilibrium_errors(inertia, of_kinds, axis, pointing, size, drift),
    )


_ZERO = (0.0, 0.0)
_AT_REST = Equilibrium(
    None,
    None,
    (_ZERO, _ZERO, _ZERO),
    REST.kind,
    REST.stable,
    0.0,
    0.0,
    REST.linearly_stable,
    REST.attitude,
    REST.survives_dissipation,
    REST.reason,
)


def _flip(inertia: PrincipalInertia, distinct: int, rate: float, disturbance: tuple[float, float]) -> Flip:
    if len(disturbance) != 2:
        raise InvalidParameter("disturbance", "be two rates, along the axes of smallest and largest moment")
    for n, x in enumerate(disturbance):
        check_value(("disturbance", n), AngularRate, x)
    if distinct < 3:
        raise no_middle_axis()
    given = (float(disturbance[0]), float(disturbance[1]))
    # A body along its principal axes moves as this one does; in them the disturbance is exact.
    along = replace(inertia, axes=np.eye(3), axes_tail=np.zeros((3, 3)), rounding=ROUNDED_ONCE, tensor=None)
    rotation = FreeRotation(along, np.array([given[0], rate, given[1]]))
    try:
        interval = rotation.flip_interval
    except AccuracyUnreachable as fault:
        fault.path = ("disturbance",)
        raise
    if interval is not None and not isfinite(interval):
        reason = "its component along the middle axis changes its sign only after a time beyond double precision"
        return Flip(given, None, f"{reason}; {rotation.model.why}")
    tilt = rotation.middle_axis_tilt
    tumbles = tilt is not None and tilt.tumbles
    error = flip_error(inertia, (given[0], rate, given[1]), interval)
    return Flip(given, interval, flip_reason(interval is not None, tumbles, rotation.model.why), error)


def no_middle_axis() -> NotApplicable:
    """Return the refusal of a disturbance where two moments are equal."""
    return NotApplicable(
        "two moments are equal, so that there is no middle axis to be disturbed",
        path=("disturbance",),
        remedy="leave out the disturbance",
    )


def flip_reason(periodic: bool, tumbles: bool, why: str) -> str:
    """Return what becomes of a disturbed rotation about the middle axis, with the reason for its model."""
    if not periodic:
        return f"it never turns over; {why}"
    if tumbles:
        return f"it turns over every half period; {why}"
    return (
        "the disturbance is so large that the body circles another axis and the middle axis never turns over: the "
        f"component along it changes its sign every half period, no more; {why}"
    )
