"""Dry friction between shafts and slopes, at the line along which string and slope touch the shaft.

The force f_i up the slope and the tension T act along the same line, so mu_i u_i' = mu_i A_i - T - f_i. Sliding:
f_i = k_i N_i sgn(u_i). Sticking: |f_i| <= s_i N_i. This file runs only where a scene has friction.

References
----------
F. Pfeiffer, Ch. Glocker, "Multibody Dynamics with Unilateral Contacts" (1996), chapter 5 (sticking and sliding as
complementary states, forces of sticking contacts not always determined).
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Annotated

from core.errors import InvalidParameter
from core.quantities import Quantity, check
from core.scenes.enclosure import ZERO, Ball, Balls, exact_pair, sign
from core.scenes.string_state import Constants, Drive, State

FrictionCoefficient = Annotated[float, Quantity("1", at_least=0)]


@dataclass(frozen=True)
class Friction:
    """Coulomb friction of two shafts on their slopes.

    Attributes
    ----------
    static : tuple of float
        Largest ratio of friction to normal force while sticking.
    kinetic : tuple of float
        The ratio while sliding; at most the static one.
    """

    static: tuple[FrictionCoefficient, FrictionCoefficient]
    kinetic: tuple[FrictionCoefficient, FrictionCoefficient]

    def __post_init__(self) -> None:
        check(self)
        for i in (0, 1):
            if self.kinetic[i] > self.static[i]:
                raise InvalidParameter(("kinetic", i), f"be at most the static coefficient {float(self.static[i]):g}")


def with_friction(friction: Friction, constants: Constants, state: State) -> Drive:
    """Return what drives the shafts on rough slopes."""
    static, kinetic = exact_pair(friction.static), exact_pair(friction.kinetic)
    holds = (static[0] * constants.normal_forces[0], static[1] * constants.normal_forces[1])
    drags = (kinetic[0] * constants.normal_forces[0], kinetic[1] * constants.normal_forces[1])
    if state.tight and sign(state.opening) == 0:
        drive = _taut(constants, state, holds, drags)
        if drive.tension is None or sign(drive.tension) >= 0:
            return drive
        # A string cannot push: friction holds the leading shaft back more than the string would have to.
    return _slack(constants, state, holds, drags)


def _taut(constants: Constants, state: State, holds: Balls, drags: Balls) -> Drive:
    (e1, e2), (a, b) = constants.effective, constants.slope_accelerations
    excess = e1 * a - e2 * b
    way = sign(state.slips[0])
    if way == 0:
        if sign(abs(excess) - holds[0] - holds[1]) <= 0:
            return _sticking(constants, holds)
        way = sign(excess)
    f1, f2 = way * drags[0], -way * drags[1]
    slip = (excess - f1 + f2) / (e1 + e2)
    tension = e1 * (a - slip) - f1
    r1, r2 = (e1 * (a - slip), e2 * (b + slip))
    (m1, m2), (c1, c2) = constants.masses, constants.factors
    return Drive("taut", tension, (a - r1 / m1, b - r2 / m2), (r1 / (c1 * m1), r2 / (c2 * m2)), (f1, f2))


def _sticking(constants: Constants, holds: Balls) -> Drive:
    """Both shafts roll; T + f_i = mu_i A_i holds and nothing fixes T itself, if it has any room."""
    (e1, e2), (a, b), (c1, c2) = constants.effective, constants.slope_accelerations, constants.factors
    rolling = (a / (1 + c1), b / (1 + c2))
    low = ZERO
    for bound in (e1 * a - holds[0], e2 * b - holds[1]):
        low = bound if bound > low else low
    high = e1 * a + holds[0]
    high = e2 * b + holds[1] if e2 * b + holds[1] < high else high
    if sign(high - low) <= 0:
        return Drive("stick", low, rolling, rolling, (e1 * a - low, e2 * b - low))
    return Drive("stick", None, rolling, rolling, None, (low, high))


def _slack(constants: Constants, state: State, holds: Balls, drags: Balls) -> Drive:
    first = _alone(constants, state, holds, drags, 0)
    second = _alone(constants, state, holds, drags, 1)
    return Drive("slack", ZERO, (first[0], second[0]), (first[1], second[1]), (first[2], second[2]))


def _alone(constants: Constants, state: State, holds: Balls, drags: Balls, i: int) -> tuple[Ball, Ball, Ball]:
    """Return x'', s'' and the friction of a shaft without a string."""
    mass, factor, pull, effective = (
        constants.masses[i],
        constants.factors[i],
        constants.slope_accelerations[i],
        constants.effective[i],
    )
    way = sign(state.slips[i])
    if way == 0 and sign(effective * pull - holds[i]) <= 0:
        return pull / (1 + factor), pull / (1 + factor), effective * pull
    force = (way or 1) * drags[i]
    return pull - force / mass, force / (factor * mass), force
