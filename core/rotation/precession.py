"""How a free body precesses: rates, periods and cones, from the initial state alone; nothing is integrated.

Two equal moments I beside I3, spin w3 along the axis e3 of the third and w_perp across it (regular precession):

    body rate   (I3 - I)/I w3                of the angular velocity about e3, seen in the body
    space rate  L/I                          of e3 about the angular momentum L, seen in space
    angles      tan(e3, L) = I w_perp / (I3 w3),   tan(e3, w) = w_perp / w3,
                tan(L, w) = |I3 - I| w_perp |w3| / (I w_perp^2 + I3 w3^2)

Three distinct moments: period 4K/p of the angular velocity, and the angle by which the circled axis turns about L in
it, whose quotient is the mean precession rate. The angle is right to the last digits; modulo a whole turn it is
Montgomery's 2 E T/L less the solid angle that L encloses in the body.

References
----------
L. D. Landau, E. M. Lifshitz, "Mechanics", sections 33 and 37. H. Goldstein, C. Poole, J. Safko, "Classical
Mechanics", 3rd ed., section 5.6. R. Montgomery, "How much does the rigid body rotate?", American Journal of Physics 59
(1991) 394.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from fractions import Fraction
from types import MappingProxyType
from typing import Literal, NamedTuple

import numpy as np

from core.bodies.exact import PI, exact_vector
from core.bodies.mass_properties import MassProperties, PrincipalInertia, Symmetry
from core.errors import InvalidParameter
from core.integration.system import Floats
from core.notices import Notice
from core.rotation import absence
from core.rotation.attitude import FreeAttitude
from core.rotation.closed_form import FreeRotation
from core.rotation.constants_of_motion import PERIODIC, REST, SEPARATRIX, STEADY
from core.rotation.exact_figures import SMALLEST, angle, double, square_root
from core.rotation.torque_free import pinned_notices

Regime = Literal["rest", "steady", "periodic", "separatrix"]
_REGIMES: Mapping[int, Regime] = {REST: "rest", STEADY: "steady", PERIODIC: "periodic", SEPARATRIX: "separatrix"}

_UPRIGHT = np.array([1.0, 0.0, 0.0, 0.0])


@dataclass(frozen=True, eq=False)
class Precession:
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
        Rate at which the angular velocity goes round `axis` in the body, positive in the right-hand sense; symmetric
        bodies only (rad/s).
    space_rate : float or None
        Rate L/I at which the axis goes round the angular momentum; symmetric bodies only. For a spin along the
        axis it is the rate of an infinitesimal wobble (rad/s).
    period : float or None
        Of the angular velocity in the body (s).
    flip_interval : float or None
        Between sign changes of the component along the middle axis (s).
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
    axis_to_angular_momentum: float | None = None
    axis_to_angular_velocity: float | None = None
    angular_momentum_to_angular_velocity: float | None = None
    order_of_directions: str | None = None
    precession_per_period: float | None = None
    mean_precession_rate: float | None = None
    absent: Mapping[str, str] = field(default_factory=lambda: MappingProxyType({}))
    warnings: tuple[Notice, ...] = ()


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
OF_SYMMETRIC_BODIES = (
    "body_rate",
    "space_rate",
    "axis_to_angular_momentum",
    "axis_to_angular_velocity",
    "angular_momentum_to_angular_velocity",
    "order_of_directions",
)
_OF_A_CHANGE = ("period", "flip_interval", "precession_per_period", "mean_precession_rate")


def precession(body: MassProperties, angular_velocity: Floats) -> Precession:
    """Return how a free body precesses that turns with an angular velocity at t = 0.

    Parameters
    ----------
    body : MassProperties
    angular_velocity : ndarray, shape (3,)
        In body axes (rad/s).

    Raises
    ------
    InvalidParameter
        If the angular velocity is not three finite numbers, or a moment of inertia is not positive.
    AccuracyUnreachable
        If the start is nearer to the separatrix than doubles resolve.
    """
    given = np.ascontiguousarray(angular_velocity, dtype=np.float64)
    if given.shape != (3,) or not np.isfinite(given).all():
        raise InvalidParameter("angular_velocity", "be three finite numbers")
    rotation = FreeRotation(body.principal_of_motion, given)
    found = _of(rotation)
    inherited = tuple(notice.inside("body") for notice in (*body.warnings, *pinned_notices(body)))
    return replace(found, warnings=(*inherited, *found.warnings))


def _of(rotation: FreeRotation) -> Precession:
    inertia = rotation.inertia
    symmetry = inertia.symmetry
    if not np.any(rotation.angular_velocity):
        absent = dict.fromkeys(("axis", *OF_SYMMETRIC_BODIES, *_OF_A_CHANGE), absence.NOTHING_TURNS)
        return Precession(symmetry, "rest", absent=MappingProxyType(absent))
    if symmetry == "spherical":
        return _sphere(rotation)
    if symmetry == "triaxial":
        return _triaxial(rotation)
    return _symmetric(rotation)


class _Figures:
    """Collects figures, and what is to be said about those that do not exist or leave the range of doubles."""

    def __init__(self) -> None:
        self.values: dict[str, float | None] = {}
        self.absent: dict[str, str] = {}
        self.notices: list[Notice] = []

    def put(self, name: str, value: float | Fraction | None) -> None:
        """State a figure; None, zero by underflow and infinity are told as out of range."""
        found = double(value) if isinstance(value, Fraction) else value
        if found is None or not math.isfinite(found) or 0.0 < abs(found) < SMALLEST:
            self.lack("leaves the range of double precision", name)
            self.notices.append(Notice("out-of-range", f"{name} leaves the range of double precision and is null"))
            return
        self.values[name] = found

    def lack(self, reason: str, *names: str) -> None:
        """State that figures do not exist, unless they were stated."""
        self.absent.update({name: reason for name in names if name not in self.values and name not in self.absent})

    def answer(
        self, symmetry: Symmetry, regime: Regime, axis: Floats | None, order_of_directions: str | None = None
    ) -> Precession:
        """Return the answer."""
        figures = {name: self.values.get(name) for name in FIGURES}
        return Precession(
            symmetry,
            regime,
            axis,
            order_of_directions=order_of_directions,
            absent=MappingProxyType(dict(self.absent)),
            warnings=tuple(self.notices),
            **figures,
        )


def _sphere(rotation: FreeRotation) -> Precession:
    figures = _Figures()
    i, tails = rotation.inertia.moments, rotation.inertia.moments_tail
    if not (i[0] == i[2] and tails[0] == tails[2]):
        figures.notices.append(_equal_within_rounding("the three moments"))
    figures.lack(absence.SPHERE, "axis", *OF_SYMMETRIC_BODIES)
    figures.lack(absence.STEADY_ANYHOW, *_OF_A_CHANGE)
    return figures.answer("spherical", "steady", None)


def _triaxial(rotation: FreeRotation) -> Precession:
    figures = _Figures()
    figures.lack(absence.TRIAXIAL, *OF_SYMMETRIC_BODIES)
    regime = _REGIMES[rotation.motion.regime]
    if regime == "steady":
        figures.lack(absence.STEADY_BY_AXIS, *_OF_A_CHANGE)
        spun = int(np.argmax(np.abs(rotation.start[0])))
        return figures.answer("triaxial", regime, _oriented(rotation.inertia, spun))
    if regime == "separatrix":
        figures.put("mean_precession_rate", momentum_of(rotation) / _moments(rotation.inertia)[1])
        figures.lack(absence.ON_THE_SEPARATRIX, *_OF_A_CHANGE)
        return figures.answer("triaxial", regime, _oriented(rotation.inertia, 1))
    _put_periodic(figures, rotation)
    return figures.answer("triaxial", regime, _oriented(rotation.inertia, rotation.motion.circled))


def _put_periodic(figures: _Figures, rotation: FreeRotation) -> None:
    """State what the elliptic closed form knows of a periodic motion."""
    turned = FreeAttitude(rotation, _UPRIGHT).precession_per_period
    motion = rotation.motion
    figures.put("period", rotation.period)
    figures.put("precession_per_period", turned)
    if turned is not None:
        per_second = Fraction(turned) * Fraction(motion.rate) * Fraction(motion.time_scale) / 4
        figures.put("mean_precession_rate", per_second)
    if rotation.flip_interval is None:
        figures.lack(absence.NO_MIDDLE_AXIS, "flip_interval")
    else:
        figures.put("flip_interval", rotation.flip_interval)


class _Split(NamedTuple):
    """A spin of a symmetric body, along its axis and across it."""

    equal: Fraction
    single: Fraction
    along: Fraction
    across_squared: Fraction


def _symmetric(rotation: FreeRotation) -> Precession:
    inertia = rotation.inertia
    symmetry = inertia.symmetry
    k = 2 if symmetry == "oblate" else 0
    moments = _moments(inertia)
    pair = (moments[0], moments[1]) if k == 2 else (moments[1], moments[2])
    w = exact_vector(*rotation.start)
    axis = _oriented(inertia, k)
    direction = 1 if np.array_equal(axis, inertia.axes[:, k]) else -1
    across = sum((x * x for n, x in enumerate(w) if n != k), Fraction(0))
    split = _Split((pair[0] + pair[1]) / 2, moments[k], direction * w[k], across)
    figures = _Figures()
    exactly = pair[0] == pair[1]
    if not exactly:
        regime = _REGIMES[rotation.motion.regime]
        figures.notices.append(_equal_within_rounding("two moments"))
        if regime == "separatrix" or (regime == "periodic" and rotation.motion.circled != k):
            return _beyond_symmetry(figures, rotation)
    else:
        regime = "steady" if across == 0 or w[k] == 0 else "periodic"
    _put_regular(figures, split, regime == "periodic")
    figures.lack(absence.NO_MIDDLE_AXIS, "flip_interval")
    order = order_of_directions(symmetry) if split.along != 0 and split.across_squared != 0 else None
    if order is None:
        figures.lack(absence.SAME_DIRECTION, "order_of_directions")
    return figures.answer(symmetry, regime, axis, order)


def _put_regular(figures: _Figures, s: _Split, periodic: bool) -> None:
    """State the figures of a regular precession, all of them rational but for square roots and pi."""
    body_rate = (s.single - s.equal) / s.equal * s.along
    momentum = square_root(s.equal**2 * s.across_squared + (s.single * s.along) ** 2)
    space_rate = momentum / s.equal
    figures.put("space_rate", space_rate)
    if periodic:
        period = 2 * PI / abs(body_rate)
        figures.put("body_rate", body_rate)
        figures.put("period", period)
        figures.put("precession_per_period", space_rate * period)
        figures.put("mean_precession_rate", space_rate)
    else:
        figures.lack(absence.STEADY_IN_BODY, "body_rate", *_OF_A_CHANGE)
    direction = -1 if s.along < 0 else 1
    along, across = s.along**2, s.across_squared
    figures.put("axis_to_angular_momentum", angle(s.equal**2 * across, s.single**2 * along, direction))
    figures.put("axis_to_angular_velocity", angle(across, along, direction))
    between = angle((s.single - s.equal) ** 2 * across * along, (s.equal * across + s.single * along) ** 2)
    figures.put("angular_momentum_to_angular_velocity", between)


def order_of_directions(symmetry: Symmetry) -> str:
    """Return which of axis, angular momentum and angular velocity lies between the others, no two in one direction."""
    if symmetry == "oblate":
        return "oblate: the angular momentum lies between the axis and the angular velocity"
    return "prolate: the angular velocity lies between the axis and the angular momentum"


def _beyond_symmetry(figures: _Figures, rotation: FreeRotation) -> Precession:
    """Return the answer where a difference of moments within rounding decides which axis is circled."""
    motion, symmetry = rotation.motion, rotation.inertia.symmetry
    reason = (
        "the spin lies so near the plane of two nearly equal moments that the body does not move as a symmetric one"
    )
    figures.lack(reason, *OF_SYMMETRIC_BODIES)
    if motion.regime == SEPARATRIX:
        figures.put("mean_precession_rate", momentum_of(rotation) / _moments(rotation.inertia)[1])
        figures.lack(absence.ON_THE_SEPARATRIX, *_OF_A_CHANGE)
        return figures.answer(symmetry, "separatrix", _oriented(rotation.inertia, 1))
    _put_periodic(figures, rotation)
    return figures.answer(symmetry, "periodic", _oriented(rotation.inertia, motion.circled))


def _equal_within_rounding(which: str) -> Notice:
    detail = f"{which} differ by less than 16 units in the last place of the largest and are taken as equal"
    return Notice("moments-equal-within-rounding", detail, ("body",))


def _moments(inertia: PrincipalInertia) -> list[Fraction]:
    return exact_vector(inertia.moments, inertia.moments_tail)


def momentum_of(rotation: FreeRotation) -> Fraction:
    """Return the magnitude of the angular momentum to 120 bits (kg m^2/s)."""
    i, w = _moments(rotation.inertia), exact_vector(*rotation.start)
    return square_root(sum(((m * x) ** 2 for m, x in zip(i, w, strict=True)), Fraction(0)))


def _oriented(inertia: PrincipalInertia, k: int) -> Floats:
    """Return a principal axis, turned to the positive side of the body axis that it is nearest to."""
    axis: Floats = inertia.axes[:, k].copy()
    if axis[np.argmax(np.abs(axis))] < 0.0:
        axis = 0.0 - axis
    axis.setflags(write=False)
    return axis
