"""The first time at which one of several quantities falls below zero, or comes so near that this is not known.

The motion is followed by pieces, and every quantity is a polynomial on each with a band of error: the difference of two
computations of the motion, rounding, and the powers left out. Where the latter leave a sign open the motion is expanded
anew close by (`followed`).
"""

from __future__ import annotations

from collections.abc import Sequence

from core.multibody.algebra.bernstein import FALLING, NEGATIVE, OPEN, POSITIVE, RISING, UNDECIDED, zero_between
from core.multibody.search.bands import Quantity
from core.multibody.search.batch import segments
from core.multibody.search.followed import Followed, Found, Interval, WatchedSign
from core.multibody.search.pieces import Expanded

_BELOW = (FALLING, NEGATIVE)


class FirstZero:
    """A search from time zero on.

    Parameters
    ----------
    motions : sequence of Expanded
        One computation of the motion, or two whose difference is its error.
    quantities : sequence of callable
    jumps : sequence of bool
        Of which quantities it matters whether they only touch zero: what follows is another motion then, and not the
        same to within its error.
    powers : sequence of int or None
        Of time with which each begins: see `Followed`.
    way : float
        -1 for the time before zero.
    coarse : sequence of Expanded
        The same computations in doubles, if they are faster: for where everything is far from zero.
    """

    def __init__(
        self,
        motions: Sequence[Expanded],
        quantities: Sequence[Quantity],
        jumps: Sequence[bool],
        powers: Sequence[int | None],
        way: float = 1.0,
        coarse: Sequence[Expanded] = (),
    ) -> None:
        self._motion = Followed(motions, quantities, jumps, powers, way, coarse)

    @property
    def below(self) -> list[int]:
        """The quantities that are below zero from the start on: what they do once they have been above is found."""
        return self._motion.below

    def until(self, end: float) -> Found | None:
        """Return the first zero up to a time, or where it is first not known whether there is one.

        A search that found nothing goes on from the time until which it went. What is found may be beyond the end, by
        less than a piece.

        Raises
        ------
        BudgetExceeded
            Where more pieces would be needed than one search may take.
        AccuracyUnreachable
            Where the motion leaves the range of doubles.
        """
        for one in self._motion.intervals(end):
            found = self._searched(one)
            if found is not None:
                return found
        return None

    def _searched(self, one: Interval) -> Found | None:
        """Return what is found in an interval; what remains of it is left for later."""
        batch, number = one.batch, one.number
        assert batch is not None
        length = float(batch.lengths[number])
        share = min(one.reach / length, 1.0)
        if batch.plain[number] and all(watch.above and watch.since is None for watch in self._motion.watched):
            self._motion.leave(one, length, 2.0)
            return None
        open_from = 2.0
        for watch in self._motion.watched:
            own = batch.of[watch.index]
            start = 0.0
            for end, sign in segments(own, number):
                if sign == OPEN:
                    open_from = min(open_from, start)
                if sign == OPEN or (watch.above and sign in _BELOW):
                    break
                start = end
        until = min(open_from, share)
        found = [self._scanned(one, watch, until) for watch in self._motion.watched]
        hits = [hit for hit in found if hit is not None]
        if hits:
            return min(hits, key=lambda hit: (abs(hit.time), self._motion.way * hit.rest))
        self._motion.leave(one, length, open_from)
        return None

    def _scanned(self, one: Interval, watch: WatchedSign, until: float) -> Found | None:
        """Return where a quantity falls below zero in the first part of an interval, or comes too near."""
        assert one.batch is not None
        own, length = one.batch.of[watch.index], float(one.batch.lengths[one.number])
        start = 0.0
        for end, sign in segments(own, one.number):
            if start >= until:
                break
            here = one.start + start * length
            if sign == UNDECIDED:
                watch.since = here if watch.since is None else watch.since
            elif watch.since is not None:
                since, watch.since = watch.since, None
                if watch.above:
                    middle, width = 0.5 * (since + here), 0.5 * (here - since)
                    if sign in (NEGATIVE, RISING):
                        # From below zero Newton's method comes to the last zero, not to that at the start. What
                        # is above zero there by less than is known reaches it somewhere in between.
                        unsure = here if since == 0.0 and watch.power == 0 else 0.0
                        return Found(watch.index, self._motion.way * here, 0.0, unsure=unsure)
                    if watch.jumps and since > 0.0:
                        return Found(watch.index, self._motion.way * middle, 0.0, max(width, 2.0**-52 * middle))
            if watch.above and sign == FALLING:
                share, tail = zero_between(own.curves[one.number], start, min(end, 1.0))
                return self._motion.at(one.start, length, watch, share, tail)
            if watch.above and sign == NEGATIVE:
                return self._motion.at(one.start, length, watch, start, 0.0)
            if sign in (POSITIVE, RISING):
                watch.above = True
            start = end
        return None
