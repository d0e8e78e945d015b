"""How a free body precesses: rates, periods and cones, without integrating anything.

A body with two equal moments I and a single one I3 about its axis e: the angular velocity goes round e in the body at
the signed rate (I3 - I)/I w3, and e goes round the angular momentum L in space at L/I. The angular velocity, L and e stay
in one plane, and each pair keeps its angle:

    tan(e, L) = I w_perp / (I3 w3)    tan(e, w) = w_perp / w3    tan(L, w) = |I3 - I| w_perp |w3| / 2E

With three distinct moments the axis that is circled nutates between two inclinations while it turns about L, by the same
angle in every period of the angular velocity; modulo a whole turn it is Montgomery's 2 E T/L less the solid angle that L
encloses in the body.

References
----------
L. D. Landau, E. M. Lifshitz, "Mechanics", sections 33, 35 to 37. H. Goldstein, "Classical Mechanics", section 5.6.
R. Montgomery, "How much does the rigid body rotate?", American Journal of Physics 59 (1991) 394.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from fractions import Fraction
from typing import Literal

import numpy as np

from core.bodies.mass_properties import Symmetry
from core.integration.system import Floats, Model
from core.notices import Notice
from core.rotation.attitude import FreeAttitude
from core.rotation.closed_form import FreeRotation
from core.rotation.constants_of_motion import PERIODIC, REST, SEPARATRIX, STEADY
from core.rotation.exact_figures import SMALLEST, angle, double, square_root
from core.rotation.exact_state import ExactState

MomentumLies = Literal[
    "between the axis and the angular velocity",
    "beyond the angular velocity from the axis",
    "along the angular velocity",
]

UNTURNED = np.array([1.0, 0.0, 0.0, 0.0])


@dataclass(frozen=True)
class Cones:
    """Half-angles of the cones of a symmetric body, in [0, pi] from the direction `axis` (rad).

    Attributes
    ----------
    axis_to_angular_momentum : float or None
        Of the cone that the axis draws about the angular momentum.
    axis_to_angular_velocity : float or None
        Of the body cone, which the angular velocity draws about the axis.
    angular_momentum_to_angular_velocity : float or None
        Of the space cone, which the angular velocity draws about the angular momentum; in [0, pi/2).
    angular_momentum_lies : str
        For an oblate body between axis and angular velocity, for a prolate one beyond the angular velocity. Where the
        angle with the axis is obtuse, seen from the opposite direction of the axis.
    """

    axis_to_angular_momentum: float | None
    axis_to_angular_velocity: float | None
    angular_momentum_to_angular_velocity: float | None
    angular_momentum_lies: MomentumLies


@dataclass(frozen=True)
class FreePrecession:
    """Rates and angles of one free rotation; None where the motion has no such thing, or where a notice says why.

    Attributes
    ----------
    model : Model
        The branch of the closed form that holds.
    symmetry : str
        Class of the body, moments within rounding of each other counting as equal.
    regime : str
        Of the motion.
    axis : tuple of 3 floats or None
        Unit vector in body axes, its largest component positive: the axis of symmetry, or else the axis that is
        circled or spun about. None at rest and for a body without a distinguished axis.
    body_rate : float or None
        Rate at which the angular velocity goes round `axis` in the body, positive by the right-hand rule; bodies of two
        equal moments (rad/s).
    space_rate : float or None
        Rate at which `axis` goes round the angular momentum in space, L/I, always positive; the same bodies (rad/s).
    period : float or None
        Of the angular velocity in the body (s).
    flip_interval : float or None
        Between sign changes of the component along the middle axis; bodies of three distinct moments (s).
    cones : Cones or None
        Bodies of two equal moments that do not rest.
    nutation : tuple of 2 floats or None
        Least and largest angle between `axis` and the angular momentum (rad). On the separatrix the largest is pi/2
        (or the least, if the axis points away), never quite reached.
    mean_precession_rate : float or None
        Rate at which the circled axis turns about the angular momentum: the mean over a period; on the separatrix the
        limit L/I of the middle axis (rad/s).
    precession_per_period : float or None
        Angle by which it turns in one period, not reduced modulo 2 pi (rad).
    warnings : tuple of Notice
        Figures outside the range of doubles, equalities that rest on rounding, and why there is no precession.
    """

    model: Model
    symmetry: Symmetry
    regime: str
    axis: tuple[float, float, float] | None
    body_rate: float | None
    space_rate: float | None
    period: float | None
    flip_interval: float | None
    cones: Cones | None
    nutation: tuple[float, float] | None
    mean_precession_rate: float | None
    precession_per_period: float | None
    warnings: tuple[Notice, ...] = ()


class _Statement:
    """States figures as doubles, and notes those that no double holds.

    Attributes
    ----------
    notices : list of Notice
    """

    def __init__(self) -> None:
        self.notices: list[Notice] = []

    def __call__(self, name: str, value: Fraction | float | None) -> float | None:
        number = double(value) if isinstance(value, Fraction) else value
        if number is not None and (number == 0.0 or SMALLEST <= abs(number) < math.inf):
            return number
        self.notices.append(Notice("out-of-range", f"{name} leaves the range of double precision and is null"))
        return None


def precession(rotation: FreeRotation) -> FreePrecession:
    """Return everything about the precession of a free body.

    Raises
    ------
    AccuracyUnreachable
        If the constants of the motion cannot be held by doubles.
    """
    state, stated = ExactState.of(rotation), _Statement()
    regime = rotation.motion.regime
    turns = regime in (PERIODIC, SEPARATRIX)
    number = _axis_number(rotation, state)
    axis, sign = _pointing(rotation.inertia.axes[:, number]) if number is not None else (None, 1)

    period = flip = per_period = mean = None
    if regime == PERIODIC:
        duration = rotation.period
        assert duration is not None
        period = stated("period", duration)
        if rotation.flip_interval is not None:
            flip = stated("flip_interval", rotation.flip_interval)
        turned = FreeAttitude(rotation, UNTURNED).precession_per_period
        assert turned is not None
        per_period = stated("precession_per_period", turned)
        mean = stated("mean_precession_rate", turned / duration)
    elif regime == SEPARATRIX:
        mean = stated("mean_precession_rate", square_root(state.squared_momentum) / state.moments[1])

    body_rate = space_rate = cones = None
    symmetric = state.symmetry_axis
    if symmetric is not None and regime != REST:
        body_rate, space_rate = _symmetric_rates(state, symmetric, sign, stated)
        cones = _cones(state, symmetric, sign, stated)
        if space_rate is not None and turns:
            mean = space_rate
    elif period is not None and _nearly_symmetric_about(rotation) == number:
        # The rates of a symmetric body whose moments were rounded apart are the means of the true motion.
        body_rate = _mean_body_rate(state, number, sign, period) if number is not None else None
        space_rate = mean
        stated.notices.append(_equal_within_stated(rotation))
    return FreePrecession(
        model=rotation.model,
        symmetry=rotation.inertia.symmetry,
        regime=rotation.model.regime,
        axis=axis,
        body_rate=body_rate,
        space_rate=space_rate,
        period=period,
        flip_interval=flip,
        cones=cones,
        nutation=_nutation(state, rotation.motion.circled, sign, stated) if turns else None,
        mean_precession_rate=mean,
        precession_per_period=per_period,
        warnings=tuple(stated.notices),
    )


def _axis_number(rotation: FreeRotation, state: ExactState) -> int | None:
    """Return the principal axis that the answer is about, by number in ascending order."""
    if state.symmetry_axis is not None:
        return state.symmetry_axis
    if rotation.motion.regime in (PERIODIC, SEPARATRIX):
        return rotation.motion.circled
    along = [k for k in range(3) if state.rates[k] != 0]
    return along[0] if rotation.motion.regime == STEADY and len(set(state.moments)) == 3 else None


def _pointing(axis: Floats) -> tuple[tuple[float, float, float], int]:
    """Return an axis with its largest component positive, and the sign that made it so."""
    sign = 1 if axis[np.argmax(np.abs(axis))] > 0.0 else -1
    x, y, z = (float(sign * component) + 0.0 for component in axis)
    return (x, y, z), sign


def _symmetric_rates(
    state: ExactState, number: int, sign: int, stated: _Statement
) -> tuple[float | None, float | None]:
    single, equal = state.moments[number], state.moments[1]
    along = sign * state.rates[number]
    body_rate = (single - equal) / equal * along
    if all(state.rates[k] == 0 for k in range(3) if k != number):
        detail = "the spin lies along the axis of symmetry, so nothing precesses"
        rate = double(body_rate)
        if rate is not None:
            detail += (
                f"; after a small tilt the angular velocity would go round the axis in the body at {rate:.6g} rad/s"
            )
        stated.notices.append(Notice("no-precession", detail))
        return None, None
    return stated("body_rate", body_rate), stated("space_rate", square_root(state.squared_momentum) / equal)


def _cones(state: ExactState, number: int, sign: int, stated: _Statement) -> Cones:
    single, equal = state.moments[number], state.moments[1]
    along = sign * state.rates[number]
    across = sum((w * w for k, w in enumerate(state.rates) if k != number), Fraction(0))
    between = (single - equal) ** 2 * along**2 * across
    if between == 0:
        lies: MomentumLies = "along the angular velocity"
    elif single > equal:
        lies = "between the axis and the angular velocity"
    else:
        lies = "beyond the angular velocity from the axis"
    direction = -1 if along < 0 else 1
    return Cones(
        stated("axis_to_angular_momentum", angle(equal**2 * across, (single * along) ** 2, direction)),
        stated("axis_to_angular_velocity", angle(across, along**2, direction)),
        stated("angular_momentum_to_angular_velocity", angle(between, state.twice_energy**2)),
        lies,
    )


def _nutation(state: ExactState, circled: int, sign: int, stated: _Statement) -> tuple[float, float] | None:
    """Return the extremes of the inclination of the circled axis d.

    tan^2 is I_c |D_d| / (I_d |D_c|) where the middle component is zero and I_b |D_d| / (I_d |D_b|) where it is largest.
    """
    d, c = circled, 2 - circled
    direction = 1 if sign * state.rates[d] > 0 else -1
    inclined = abs(state.excess(d))
    first = angle(state.moments[c] * inclined, state.moments[d] * abs(state.excess(c)), direction)
    second = angle(state.moments[1] * inclined, state.moments[d] * abs(state.excess(1)), direction)
    one, other = stated("nutation", first), stated("nutation", second)
    return None if one is None or other is None else (min(one, other), max(one, other))


def _nearly_symmetric_about(rotation: FreeRotation) -> int | None:
    return {"oblate": 2, "prolate": 0, "linear": 0}.get(rotation.inertia.symmetry)


def _mean_body_rate(state: ExactState, number: int, sign: int, period: float) -> float:
    """Return +-2 pi over the period: forward about the axis of largest moment, backward about the smallest."""
    forward = (number == 2) == (sign * state.rates[number] > 0)
    return math.copysign(2.0 * math.pi / period, 1.0 if forward else -1.0)


def _equal_within_stated(rotation: FreeRotation) -> Notice:
    low, middle, high = (float(x) for x in rotation.inertia.moments)
    gap = min((middle - low) / high, (high - middle) / high)
    return Notice(
        "nearly-symmetric",
        f"two moments differ by {gap:.1g} of the largest, no more than rounding explains; the motion is that of three "
        "distinct moments, and body_rate and space_rate are its means",
    )
