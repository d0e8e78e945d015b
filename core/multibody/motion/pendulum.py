"""A point on a circle in a uniform field, in closed form at any time, however near to the separatrix it starts.

A run that returns loses its period to rounding where the motion nearly comes to rest at the top. The elliptic functions
of `core.scenes.pendulum` do not.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field, replace
from functools import cached_property
from typing import Any

import numpy as np
from flint import arb, ctx

from core.arrays import Floats
from core.balls import Undetermined, precision, raised
from core.errors import AccuracyUnreachable
from core.multibody.algebra.polynomials import BITS, ZERO, Ball, entry, is_zero
from core.multibody.motion.motion import BallState, Motion, States, in_pairs
from core.multibody.table.table import Table
from core.scenes.pendulum import Pendulum
from core.scenes.pendulum_in_balls import pendulum_in_balls

LATE = 2.0**-84
"""Share of a period by which two runs of it differ beside the separatrix, and no pendulum elsewhere: from there on the
closed form is the better model."""
_ENOUGH = 2.0**-104
"""Share to which pairs of doubles hold a number."""


@dataclass(frozen=True)
class PlanePendulum(Motion):
    """A part whose two coordinates lie on a circle, with one mass and a constant load.

    Attributes
    ----------
    table : Table
    centre : tuple of two balls
    down : tuple of two balls
        From the centre to where the load pulls it, as long as the circle's radius.
    pendulum : Pendulum
        Its angle from there.
    """

    table: Table
    centre: tuple[Ball, Ball]
    down: tuple[Ball, Ball]
    pendulum: Pendulum
    name: str = "pendulum"
    why: str = "a point on a circle in a uniform field: elliptic functions"
    how: str = "closed form"
    _known: dict[int, Any] = field(default_factory=dict, repr=False)

    @cached_property
    def period(self) -> Ball | None:
        """The period in seconds; None on the separatrix, where it never returns."""
        with precision(max(BITS, ctx.prec)):
            return self.pendulum.period

    def states(self, times: Floats, *, finer: bool = False) -> States:
        """Return the states, enclosed by balls and rounded to pairs.

        Raises
        ------
        AccuracyUnreachable
            At a time so far away that 320 bits do not tell the angle.
        """
        with precision(BITS):
            try:
                states = self.in_balls([arb(float(t)) for t in times])
            except Undetermined:
                reason = "320 bits do not tell the angle at this time"
                raise AccuracyUnreachable(None, np.inf, reason, path=("times",)) from None
            q_error, v_error = (
                np.array([[float(x.rad()) + _ENOUGH * abs(float(x)) for x in vector] for vector in vectors])
                for vectors in ([state.q for state in states], [state.v for state in states])
            )
        return States(*in_pairs(states, 2), q_error.reshape(-1, 2), v_error.reshape(-1, 2))

    def angles_turned(self, times: Sequence[Ball]) -> list[Ball]:
        """Return how far it has turned."""
        return [state.turned for state in self.in_balls(times)]

    def in_balls(self, times: Sequence[Ball]) -> list[BallState]:
        """Return the states by elliptic functions; it raises as `Motion.in_balls`."""
        if ctx.prec not in self._known:
            # What is known of it at one precision is not known at a higher one.
            angle = pendulum_in_balls(replace(self.pendulum))
            self._known[ctx.prec] = angle, angle(ZERO)[3]
        angle, start = self._known[ctx.prec]
        (x, y), (a, b) = self.centre, self.down
        found = []
        for time in times:
            if time.is_zero():
                found.append(BallState(self.table.q, self.table.v, turned=ZERO))
                continue
            half_sine, half_cosine, rate, turned = angle(time)
            sine, cosine = 2 * half_sine * half_cosine, raised(half_cosine, 2) - raised(half_sine, 2)
            across, along = cosine * a - sine * b, cosine * b + sine * a
            found.append(BallState([x + across, y + along], [-rate * along, rate * across], turned=turned - start))
        return found


def plane_pendulum(table: Table, chosen: list[int] | tuple[int, ...]) -> PlanePendulum | None:
    """Return the motion of a part that is a plane pendulum, None of another one."""
    if len(table.names) != 2 or len(chosen) != 1 or table.stiffness or table.damping or table.gyration:
        return None
    row, mass = table.rows[chosen[0]], entry(table.mass, (0, 0))
    if row.measure is None or row.drag or not is_zero(row.rate) or not mass > 0:
        return None
    lead, cross = entry(row.measure, (0, 0)), entry(table.mass, (0, 1))
    even = is_zero(lead - entry(row.measure, (1, 1))) and is_zero(entry(row.measure, (0, 1)))
    if is_zero(lead) or not even or not is_zero(mass - entry(table.mass, (1, 1))) or not is_zero(cross):
        return None
    centre = tuple(-entry(row.measure, (i,)) / (2 * lead) for i in range(2))
    x, y = (place - middle for place, middle in zip(table.q, centre, strict=True))
    pull = [entry(table.load, i) for i in range(2)]
    square, load = x * x + y * y, (pull[0] * pull[0] + pull[1] * pull[1]).sqrt()
    if not (square > 0 and load > 0):
        return None
    radius = square.sqrt()
    along, across = (pull[0] * x + pull[1] * y) / (load * radius), (pull[0] * y - pull[1] * x) / (load * radius)
    if not 1 + along > 0:
        return None
    half = ((1 + along) / 2).sqrt()
    rate = (x * table.v[1] - y * table.v[0]) / square
    sine = ZERO if is_zero(across) else across / (2 * half)
    start = Pendulum((load / (mass * radius)).sqrt(), sine, half, ZERO if is_zero(rate) else rate)
    down = pull[0] * radius / load, pull[1] * radius / load
    return PlanePendulum(table, (centre[0], centre[1]), down, start)
