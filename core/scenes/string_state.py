"""Two shafts on one string: the constants, the state between two jerks, and what drives it.

Notation: x_i is the distance of shaft i down its slope, s_i = R_i theta_i the string that has left it,
u_i = x_i' - s_i' the velocity of its line of contact down the slope (of the string on that side, if taut),
c_i = I_i / M_i R_i^2, mu_i = M_i c_i/(1 + c_i). The string is slack by sigma = s_1 + s_2 - x_1 - x_2 + const >= 0,
sigma' = -(u_1 + u_2).
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Literal

from core.scenes.enclosure import ZERO, Ball, Balls, sign
from core.scenes.quadratics import advanced

Kind = Literal["taut", "slack", "stick"]


@dataclass(frozen=True)
class Constants:
    """What does not change, as balls.

    Attributes
    ----------
    masses, radii, factors : balls
        M_i, R_i, c_i.
    slope_accelerations : balls
        g sin(slope): acceleration of a point sliding freely.
    normal_forces : balls
        Normal forces M_i g cos(slope).
    """

    masses: Balls
    radii: Balls
    factors: Balls
    slope_accelerations: Balls
    normal_forces: Balls

    @property
    def effective(self) -> Balls:
        """Reduced masses mu_i = M_i c_i/(1 + c_i): the inertia of a shaft to a pull on its string."""
        (m1, m2), (c1, c2) = self.masses, self.factors
        return m1 * c1 / (1 + c1), m2 * c2 / (1 + c2)

    @property
    def determinate(self) -> bool:
        """Whether at least one shaft has inertia about its axis, without which the spins are not determined."""
        return any(sign(c) > 0 for c in self.factors)

    @property
    def shares(self) -> Balls:
        """Parts mu_j/(mu_1 + mu_2) of a closing velocity that shaft i, not j, takes up."""
        e1, e2 = self.effective
        return e2 / (e1 + e2), e1 / (e1 + e2)

    @property
    def harmonic(self) -> Ball:
        """mu_1 mu_2/(mu_1 + mu_2): what a jerk along the string has to move."""
        return self.effective[0] * self.shares[0] if self.determinate else ZERO

    @property
    def yields(self) -> tuple[Balls, Balls]:
        """What a unit of closing velocity takes from x_i' and adds to s_i' of each shaft: together its share."""
        (s1, s2), (c1, c2) = self.shares, self.factors
        return (s1 * c1 / (1 + c1), s2 * c2 / (1 + c2)), (s1 / (1 + c1), s2 / (1 + c2))


@dataclass(frozen=True)
class Drive:
    """Constant accelerations that hold for a while.

    Attributes
    ----------
    tension : ball or None
        None where forces are not determined; then `tension_range` bounds it.
    positions, unwound : balls
        x_i'' and s_i''.
    friction : balls or None
        Forces up the slope at the lines of contact, None where not determined.
    """

    kind: Kind
    tension: Ball | None
    positions: Balls
    unwound: Balls
    friction: Balls | None = (ZERO, ZERO)
    tension_range: Balls | None = None

    @property
    def slips(self) -> Balls:
        """u_i''s rate."""
        return self.positions[0] - self.unwound[0], self.positions[1] - self.unwound[1]

    @property
    def closing(self) -> Ball:
        """Rate at which the string loses slackness ever faster: -sigma''."""
        return ZERO if self.kind != "slack" else sum(self.slips, ZERO)


@dataclass(frozen=True)
class State:
    """State at an instant; `opening` is sigma', `slips` are u_i, both kept apart so that an exact zero stays one."""

    time: Ball
    positions: Balls
    velocities: Balls
    unwound: Balls
    rates: Balls
    slack: Ball
    opening: Ball
    slips: Balls

    @property
    def tight(self) -> bool:
        """Whether the string has no slack at this instant."""
        return sign(self.slack) <= 0

    def after(self, drive: Drive, time: Ball) -> State:
        """Return the state a time later under constant accelerations."""
        a, b, u = drive.positions, drive.unwound, drive.slips

        def moved(values: Balls, rates: Balls, accelerations: Balls) -> Balls:
            return (
                advanced(values[0], rates[0], accelerations[0], time),
                advanced(values[1], rates[1], accelerations[1], time),
            )

        none = (ZERO, ZERO)
        free = drive.kind == "slack"
        return State(
            self.time + time,
            moved(self.positions, self.velocities, a),
            moved(self.velocities, a, none),
            moved(self.unwound, self.rates, b),
            moved(self.rates, b, none),
            advanced(self.slack, self.opening, -drive.closing, time) if free else self.slack,
            self.opening - drive.closing * time if free else self.opening,
            moved(self.slips, u, none),
        )

    def after_impulse(self, constants: Constants, closing: Ball, restitution: Ball) -> State:
        """Return the state after the jerk of a string that closed at the velocity `closing` > 0.

        The impulse is (1 + e) closing mu_1 mu_2/(mu_1 + mu_2); contacts transmit none, as normal forces stay finite.
        """
        (x1, x2), (s1, s2) = constants.yields
        (k1, k2), total = constants.shares, (1 + restitution) * closing
        return replace(
            self,
            velocities=(self.velocities[0] - x1 * total, self.velocities[1] - x2 * total),
            rates=(self.rates[0] + s1 * total, self.rates[1] + s2 * total),
            slips=(self.slips[0] - k1 * total, self.slips[1] - k2 * total),
            slack=ZERO,
            opening=restitution * closing,
        )


def frictionless(constants: Constants, state: State) -> Drive:
    """Return what drives the shafts on smooth slopes: both slide freely, or the string pulls them as one machine."""
    a, b = constants.slope_accelerations
    if not (state.tight and sign(state.opening) == 0):
        return Drive("slack", ZERO, (a, b), (ZERO, ZERO))
    closing = a + b
    (x1, x2), (s1, s2) = constants.yields
    return Drive(
        "taut",
        closing * constants.harmonic,
        (a - closing * x1, b - closing * x2),
        (closing * s1, closing * s2),
    )
