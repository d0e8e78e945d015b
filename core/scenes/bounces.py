"""A string that is jerked again and again: arcs of free motion between jerks, each a fraction e of the one before.

After a jerk the string opens at the rate w and closes again after d = 2w/Gamma, Gamma = u_1' + u_2' > 0, at the same
rate; the next arc has e w and e d. With S_n = 1 + e + ... + e^(n-1), arc n begins at d S_n, and every velocity and
position at the beginning of an arc is a polynomial in S_n:

    v_n = v_0 + nu S,    x_n = x_0 + d v_0 S + d nu S(S - 1)/(1 + e) + (a d^2/2) S(2 - (1 - e)S)/(1 + e),

nu = a d + (change at the first jerk). So a motion with infinitely many jerks costs no more than one with one: for e < 1
they accumulate at S = 1/(1 - e), where the string is taut at last; for e = 1 (S = n) they never end.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

from flint import arb

from core.scenes.enclosure import ZERO, Ball, Balls, sign
from core.scenes.quadratics import real_roots
from core.scenes.string_state import Constants, Drive, State

EXACT_COUNT = 2**53
"""Every whole number up to this is a double."""


def as_answered(count: int | None) -> int | Ball | None:
    """Return a number of jerks as an answer has it: beyond `EXACT_COUNT` as a ball, which is rounded like a figure."""
    return count if count is None or count <= EXACT_COUNT else arb(count)


@dataclass(frozen=True)
class Sequence:
    """Arcs that follow a jerk.

    Attributes
    ----------
    start : State
        Right after the jerk.
    drive : Drive
        Constant accelerations in every arc.
    restitution : ball
        e > 0.
    """

    constants: Constants
    start: State
    drive: Drive
    restitution: Ball

    @property
    def first(self) -> Ball:
        """Length d of the first arc."""
        return 2 * self.start.opening / self.drive.closing

    @property
    def limit(self) -> Ball | None:
        """Value of S at which the jerks accumulate, None if they do not."""
        return 1 / (1 - self.restitution) if self.restitution < 1 else None

    def sum(self, n: int) -> Ball:
        """Return S_n."""
        e = self.restitution
        # A count may be beyond what a machine's integers and doubles hold; a ball has it to its own precision.
        return (1 - e ** arb(n)) / (1 - e) if e < 1 else arb(n)

    def ratio(self, S: Ball) -> Ball:
        """Return e^n."""
        return 1 - (1 - self.restitution) * S

    def gains(self) -> tuple[Balls, Balls, Balls]:
        """Return nu of x_i', of s_i' and of u_i."""
        (x1, x2), (s1, s2), d = *self.constants.yields, self.first
        k1, k2 = self.constants.shares
        total = (1 + self.restitution) * self.start.opening
        (a1, a2), (b1, b2), (c1, c2) = self.drive.positions, self.drive.unwound, self.drive.slips
        return (
            (a1 * d - x1 * total, a2 * d - x2 * total),
            (b1 * d + s1 * total, b2 * d + s2 * total),
            (c1 * d - k1 * total, c2 * d - k2 * total),
        )

    def coefficients(self, value: Ball, rate: Ball, gain: Ball, acceleration: Ball) -> tuple[Ball, Ball, Ball]:
        """Return x_n as a quadratic in S: constant, linear and quadratic coefficient."""
        d, e = self.first, self.restitution
        linear = d * rate + (acceleration * d * d - d * gain) / (1 + e)
        quadratic = d * gain / (1 + e) - acceleration * d * d * (1 - e) / (2 * (1 + e))
        return value, linear, quadratic

    def at(self, S: Ball) -> State:
        """Return the state at the beginning of the arc with the given S, after its jerk."""
        begin, drive = self.start, self.drive
        gv, gr, gu = self.gains()

        def values(initial: Balls, rates: Balls, gains: Balls, accelerations: Balls) -> Balls:
            first, second = (self.coefficients(initial[i], rates[i], gains[i], accelerations[i]) for i in (0, 1))
            return tuple(c0 + S * (c1 + S * c2) for c0, c1, c2 in (first, second))

        def linear(initial: Balls, gains: Balls) -> Balls:
            return initial[0] + gains[0] * S, initial[1] + gains[1] * S

        return State(
            begin.time + self.first * S,
            values(begin.positions, begin.velocities, gv, drive.positions),
            linear(begin.velocities, gv),
            values(begin.unwound, begin.rates, gr, drive.unwound),
            linear(begin.rates, gr),
            ZERO,
            begin.opening * self.ratio(S),
            linear(begin.slips, gu),
        )

    def accumulated(self) -> State:
        """Return the state at which the jerks of e < 1 accumulate."""
        limit = self.limit
        if limit is None:
            raise ValueError("jerks with restitution 1 do not accumulate")
        state = self.at(limit)
        return State(state.time, state.positions, state.velocities, state.unwound, state.rates, ZERO, ZERO, state.slips)

    def candidates(
        self, margins: list[tuple[Ball, Ball, Ball, Ball]], signs: list[tuple[Ball, Ball, Ball]]
    ) -> list[int]:
        """Return the arcs among which is the first that something ends.

        A margin is (value, rate, acceleration, gain of the rate) of a quantity that must not turn negative, a sign is
        (value, rate, gain) of one that must not change sign. Whether arc n breaks the rule is decided by signs of
        quadratics in S, so it can change only next to one of their roots.
        """
        d, e = self.first, self.restitution
        found = {0}
        for value, rate, acceleration, gain in margins:
            c0, c1, c2 = self.coefficients(value, rate, gain, acceleration)
            breaks = real_roots(c2, c1, c0)
            # The rate at the beginning and at the end of an arc, and the lowest point between.
            breaks += real_roots(ZERO, gain, rate)
            breaks += real_roots(ZERO, gain - acceleration * d * (1 - e), rate + acceleration * d)
            breaks += real_roots(
                gain * gain - 2 * acceleration * c2,
                2 * rate * gain - 2 * acceleration * c1,
                rate * rate - 2 * acceleration * c0,
            )
            for S in breaks:
                found |= self._around(S)
        for value, rate, gain in signs:
            breaks = real_roots(ZERO, gain, value) + real_roots(ZERO, gain - rate * d * (1 - e), value + rate * d)
            for S in breaks:
                found |= self._around(S)
        return sorted(found)

    def _around(self, S: Ball) -> set[int]:
        if sign(S) < 0:
            return set()
        if self.restitution < 1:
            left = self.ratio(S)
            if sign(left) <= 0:
                return set()
            S = left.log() / self.restitution.log()
        whole = S.mid().floor().unique_fmpz()
        if whole is None:
            return set()
        n = int(whole)
        return {k for k in range(n - 2, n + 3) if k >= 0}

    def first_arc(
        self,
        margins: list[tuple[Ball, Ball, Ball, Ball]],
        signs: list[tuple[Ball, Ball, Ball]],
        leaves: Callable[[State, Ball], Ball | None],
    ) -> tuple[int, State, Ball] | None:
        """Return the first arc that something ends: its number, the state at its beginning, and the time in it.

        Parameters
        ----------
        margins, signs : list
            As for `candidates`.
        leaves : callable
            Given the state at the beginning of an arc and the length of the arc, when it is ended, or None.
        """
        for n in self.candidates(margins, signs):
            S = self.sum(n)
            state = self.at(S)
            time = leaves(state, self.first * self.ratio(S))
            if time is not None:
                return n, state, time
        return None
