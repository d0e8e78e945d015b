"""Bounces that accumulate: arcs of constant acceleration between impacts, each a fraction e of the one before.

The gap opens at the rate w and closes after d = 2w/gamma. The n-th impulse is p_n = (1 + e) w e^(n-1)/D at the time
t_n = d (1 - e^n)/(1 - e), with D the rate that an impulse one adds to the gap's. Every sum over impulses is a geometric
one, so that infinitely many cost no more than one; they end at d/(1 - e).
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from flint import arb

from core.multibody.algebra.polynomials import ZERO, Ball, is_zero
from core.multibody.equations.expansion import Expansion
from core.multibody.equations.polynomial_roots import first_negative
from core.multibody.equations.starting_pieces import series_of
from core.multibody.laws.law import Law
from core.multibody.phases.uniform_pieces import polynomial_of


def _up_to(x: Ball) -> Ball:
    """Return a ball that holds all that is between zero and a number."""
    return x / 2 + arb(0, abs(x / 2).upper())


@dataclass(frozen=True)
class Accumulation:
    """Bounces that follow an impact.

    Attributes
    ----------
    q, v, a : sequence of ball
        State right after the impact, and the accelerations of every arc.
    push : sequence of ball
        What an impulse one along the gap, with its friction, adds to the rates.
    yields : ball
        Rate D that it adds to the gap's.
    opening, closing : ball
        Rate w at which the gap opens, and gamma > 0 at which that falls.
    restitution : ball
        0 < e < 1.
    """

    q: Sequence[Ball]
    v: Sequence[Ball]
    a: Sequence[Ball]
    push: Sequence[Ball]
    yields: Ball
    opening: Ball
    closing: Ball
    restitution: Ball

    @property
    def first(self) -> Ball:
        """Length d of the first arc."""
        return 2 * self.opening / self.closing

    @property
    def length(self) -> Ball:
        """Time until the bounces end."""
        return self.first / (1 - self.restitution)

    @property
    def total(self) -> Ball:
        """Sum of the impulses."""
        return (1 + self.restitution) * self.opening / (self.yields * (1 - self.restitution))

    def begins(self, n: int) -> Ball:
        """Return when arc n begins."""
        return self.first * (1 - self.restitution**n) / (1 - self.restitution)

    def arc(self, time: Ball) -> int:
        """Return in which arc a time is."""
        left = 1 - time * (1 - self.restitution) / self.first
        if not left > 0:
            return 0 if time <= 0 else 1 << 20
        n = max(0, int(float((left.log() / self.restitution.log()).mid())) - 1)
        while self.begins(n + 1) < time or 0 in self.begins(n + 1) - time:
            n += 1
        return n

    def at(self, time: Ball) -> tuple[list[Ball], list[Ball]]:
        """Return the state at a time before the end."""
        return self.state(time, self.restitution ** self.arc(time))

    def limit(self) -> tuple[list[Ball], list[Ball]]:
        """Return the state at the end."""
        return self.state(self.length, ZERO)

    def keeps_sign(self, law: Law, sign: int) -> bool:
        """Return whether a formula certainly has a sign at all times before the end."""
        state = Expansion([[x, y] for x, y in zip(*self._enclosure(), strict=True)], [])
        if not is_zero(series_of(law, state, 1)[0]):
            return True
        if any(not is_zero(self.push[i]) for i in law.coordinates()):
            return False
        # What the impulses do not change is a polynomial in time: it may be zero at the end.
        motion = Expansion([[q, v, a / 2] for q, v, a in zip(self.q, self.v, self.a, strict=True)], [])
        series = polynomial_of(law, motion)
        if series is None:
            return False
        root, _ = first_negative([sign * x for x in series], self.length)
        return root is None or not root < self.length

    def _enclosure(self) -> tuple[list[Ball], list[Ball]]:
        """Return balls that hold the coordinates and rates of all times before the end."""
        rates = [
            v + _up_to(a * self.length) + _up_to(r * self.total)
            for v, a, r in zip(self.v, self.a, self.push, strict=True)
        ]
        return [q + _up_to(self.length) * rate for q, rate in zip(self.q, rates, strict=True)], rates

    def state(self, time: Ball, power: Ball) -> tuple[list[Ball], list[Ball]]:
        """Return the state at a time, after as many impulses as the power of the restitution."""
        e, d = self.restitution, self.first
        total = self.total * (1 - power)
        # Sum of the impulses, each times when it came.
        moment = self.total * d / (1 - e) * ((1 - power) - e * (1 - power * power) / (1 + e))
        places = [
            q + time * (v + a * time / 2) + r * (total * time - moment)
            for q, v, a, r in zip(self.q, self.v, self.a, self.push, strict=True)
        ]
        rates = [v + a * time + r * total for v, a, r in zip(self.v, self.a, self.push, strict=True)]
        return places, rates
