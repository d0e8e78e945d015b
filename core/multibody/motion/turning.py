"""What goes round at a constant rate, in closed form: the direction of a body of the plane, a place on a circle."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from flint import arb

from core.arrays import Floats, largest_magnitude
from core.multibody.algebra.polynomials import ZERO, Ball, LinearForm, entry, is_zero
from core.multibody.motion.motion import BallState, Motion, States, in_pairs
from core.multibody.table.table import Table

FEW_RADIANS = 64.0
"""Up to which the sine of an angle in doubles is right to 2^-46."""


@dataclass(frozen=True)
class Turning(Motion):
    """Two coordinates on a circle, and the angle of a direction where that is a coordinate, at a constant rate.

    Attributes
    ----------
    direction : tuple of int
        The two coordinates; of a direction its cosine and sine.
    turn : int or None
    rate : ball
        Angular velocity (rad/s).
    centre : tuple of balls
        Of the circle.
    """

    table: Table
    direction: tuple[int, int]
    turn: int | None
    rate: Ball
    centre: tuple[Ball, Ball] = (ZERO, ZERO)
    name: str = "uniform rotation"
    why: str = "nothing turns the body: it goes on at the rate it has"
    how: str = "closed form"

    @property
    def period(self) -> Ball | None:
        """The time of one turn, where the angle is no coordinate of its own."""
        return None if self.turn is not None or is_zero(self.rate) else 2 * arb.pi() / abs(self.rate)

    def states(self, times: Floats, *, finer: bool = False) -> States:
        """Return the states, right to the last bit of a pair or so."""
        q, v = in_pairs(self.in_balls([arb(float(t)) for t in times]), len(self.table.q))
        return States(q, v, 2.0**-100 * np.abs(q[..., 0]), 2.0**-100 * np.abs(v[..., 0]))

    def in_balls(self, times: Sequence[Ball]) -> list[BallState]:
        """Return the states by sines and cosines."""
        turned = self.angles_turned(times)
        c, s = self.direction
        first, second = self._away
        found = []
        for time, way in zip(times, turned, strict=True):
            angle, q, v = self.rate * time, list(self.table.q), list(self.table.v)
            sine, cosine = angle.sin_cos()
            x, y = first * cosine - second * sine, second * cosine + first * sine
            q[c], q[s], v[c], v[s] = self.centre[0] + x, self.centre[1] + y, -self.rate * y, self.rate * x
            if self.turn is not None:
                q[self.turn], v[self.turn] = self.table.q[self.turn] + angle, self.rate
            found.append(BallState(q, v, turned=way))
        return found

    def angles_turned(self, times: Sequence[Ball]) -> list[Ball]:
        """Return how far it has turned."""
        rate = self.rate if self.direction[0] < self.direction[1] else -self.rate
        return [rate * time for time in times]

    @property
    def _away(self) -> tuple[Ball, Ball]:
        """The start less the centre."""
        c, s = self.direction
        return self.table.q[c] - self.centre[0], self.table.q[s] - self.centre[1]

    @property
    def is_faster_in_doubles(self) -> bool:
        """Return that it is."""
        return True

    def in_doubles(self, times: Floats) -> tuple[Floats, Floats] | None:
        """Return coordinates and rates in doubles, None after so many radians that sines lose digits."""
        rate = float(self.rate)
        if abs(rate) * largest_magnitude(times) > FEW_RADIANS:
            return None
        n = len(self.table.q)
        q, v = np.empty((len(times), n)), np.empty((len(times), n))
        c, s = self.direction
        start, centre = (complex(*map(float, one)) for one in (self._away, self.centre))
        now = start * np.exp(1j * rate * times)
        q[:, c], q[:, s] = centre.real + now.real, centre.imag + now.imag
        v[:, c], v[:, s] = -rate * now.imag, rate * now.real
        if self.turn is not None:
            q[:, self.turn], v[:, self.turn] = float(self.table.q[self.turn]) + rate * times, rate
        return q, v


def turning(part: Table, chosen: Sequence[int]) -> Turning | None:
    """Return the motion of a part that is a free direction, None if it is something else."""
    if part.load or part.stiffness or part.damping or part.gyration or any(row.drag for row in part.rows):
        return None
    measures = [row for row in part.rows if row.measure is not None]
    rates = [row for row in part.rows if row.measure is None]
    if len(measures) != 1 or len(part.names) != 2 + len(rates) or len(rates) > 1 or len(chosen) != len(part.rows):
        return None
    measure = measures[0].measure or {}
    squares = [key for key in measure if len(key) == 2]
    if len(squares) != 2 or any(a != b for a, b in squares):
        return None
    c, s = squares[0][0], squares[1][0]
    if any(len(key) == 1 and key[0] not in (c, s) for key in measure):
        return None
    if set(part.mass) != {(c, c), (s, s)} or not is_zero(part.mass[(c, c)] - part.mass[(s, s)]):
        return None
    if not is_zero(measure[squares[0]] - measure[squares[1]]):
        return None
    first, second = (-entry(measure, (i,)) / (2 * measure[squares[0]]) for i in (c, s))
    x, y = part.q[c] - first, part.q[s] - second
    square = x * x + y * y
    if not square > 0:
        return None
    rate = (x * part.v[s] - y * part.v[c]) / square
    turn = None
    if rates:
        turn = next(i for i in range(3) if i not in (c, s))
        line = rates[0].rates
        # The angle's rate is that of the direction, of which squares add up to one.
        expected: LinearForm = {turn: {(): ZERO + 1}, s: {(c,): ZERO - 1}, c: {(s,): ZERO + 1}}
        factor = line.get(turn, {}).get((), ZERO)
        at_origin = is_zero(first) and is_zero(second)
        if (
            not at_origin
            or is_zero(factor)
            or not is_zero(square - 1)
            or rates[0].rate != 0
            or set(line) != set(expected)
        ):
            return None
        for j, poly in expected.items():
            mine = line[j]
            if set(mine) != set(poly) or any(not is_zero(mine[key] / factor - x) for key, x in poly.items()):
                # The other sense of the angle is the same with sine and cosine exchanged.
                return None
    return Turning(part, (c, s), turn, rate, (first, second))
