"""Every time at which a quantity is zero: where its sign changes, and where it comes so near that this is not known."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

from core.multibody.algebra.bernstein import FALLING, OPEN, POSITIVE, RISING, UNDECIDED, zero_between
from core.multibody.search.bands import Quantity
from core.multibody.search.batch import segments
from core.multibody.search.followed import Followed, Found, Interval, WatchedSign
from core.multibody.search.pieces import Expanded


class EveryZero:
    """The zeros of quantities after time zero, where what is zero there is divided out.

    Parameters
    ----------
    motions : sequence of Expanded
        One computation of the motion, or two whose difference is its error.
    quantities : sequence of callable
    coarse : sequence of Expanded
        The same computations in doubles, if they are faster.
    way : float
        -1 for the time before zero.

    Attributes
    ----------
    starts : list of float
        Times between which the motion is one polynomial each.
    """

    def __init__(
        self,
        motions: Sequence[Expanded],
        quantities: Sequence[Quantity],
        coarse: Sequence[Expanded] = (),
        way: float = 1.0,
    ) -> None:
        count = len(quantities)
        self._motion = Followed(motions, quantities, [True] * count, [None] * count, way, coarse, every=True)
        self._signs = [0] * count
        self._last: list[Found | None] = [None] * count
        self.starts: list[float] = []
        self._until = 0.0

    def until(self, end: float) -> Iterator[Found]:
        """Yield the zeros up to a time in their order, each once; see `Followed.intervals` for what is raised.

        A zero whose width reaches beyond the end, or that is beyond it by less than a piece, may be the last.
        """
        for one in self._motion.intervals(end):
            yield from self._searched(one)
        left = [watch for watch in self._motion.watched if watch.since is not None and self._signs[watch.index]]
        for watch in sorted(left, key=lambda watch: watch.since or 0.0):
            assert watch.since is not None
            yield self._within(watch, watch.since, end)

    def _searched(self, one: Interval) -> list[Found]:
        """Return what is found in an interval; what remains of it is left for later."""
        batch, number = one.batch, one.number
        assert batch is not None
        if one.start >= self._until:
            self.starts.append(self._motion.way * one.start)
            self._until = one.start + float(batch.natural[number])
        length = float(batch.lengths[number])
        open_from = 2.0
        for watch in self._motion.watched:
            start = 0.0
            for end, sign in segments(batch.of[watch.index], number):
                if sign == OPEN:
                    open_from = min(open_from, start)
                    break
                start = end
        until = min(open_from, one.reach / length, 1.0)
        found = [zero for watch in self._motion.watched for zero in self._scanned(one, watch, until, open_from)]
        self._motion.leave(one, length, open_from)
        return sorted(found, key=lambda zero: (abs(zero.time), self._motion.way * zero.rest))

    def _scanned(self, one: Interval, watch: WatchedSign, until: float, known: float) -> Iterator[Found]:
        """Yield the zeros of a quantity in the first part of an interval, up to which its signs are known."""
        assert one.batch is not None
        own, length = one.batch.of[watch.index], float(one.batch.lengths[one.number])
        start = 0.0
        for end, sign in segments(own, one.number):
            if start >= until:
                break
            here = one.start + start * length
            if sign == UNDECIDED:
                watch.since = here if watch.since is None else watch.since
                start = end
                continue
            before, near = self._signs[watch.index], None
            if watch.since is not None:
                # What is undecided from the start on leaves zero there.
                near = self._within(watch, watch.since, here) if before else None
                watch.since = None
            if near is not None and before == (1 if sign in (POSITIVE, FALLING) else -1) and self._is_last(near):
                # The zero at the end of a piece is undecided at the start of the next.
                near = None
            if sign not in (FALLING, RISING):
                if near is None and before and before != sign:
                    # The zero lies between two pieces that end and begin there.
                    near = self._within(watch, here, here)
                if near is not None:
                    yield self._taken(near)
                self._signs[watch.index] = sign
            else:
                after = -1 if sign == FALLING else 1
                share, tail = zero_between(own.curves[one.number], start, min(end, 1.0))
                if share > min(known, 1.0):
                    # It is found once more from there on.
                    if near is not None:
                        watch.since = abs(near.time) - near.width
                    return
                zero = self._motion.at(one.start, length, watch, share, tail)
                # One zero at the end of a piece may be undecided before it and certain after, where signs allow it.
                if near is not None and (before == after or abs(zero.time - near.time) > 2.0 * near.width):
                    yield self._taken(near)
                    before = 0
                # What is not above zero before it falls has done so at the end of the piece before.
                if before != after or near is not None:
                    yield self._taken(zero)
                self._signs[watch.index] = after
            start = end

    def _taken(self, zero: Found) -> Found:
        """Return a zero, which is the last one of its quantity."""
        self._last[zero.index] = zero
        return zero

    def _is_last(self, zero: Found) -> bool:
        """Return whether a zero cannot be told from the last one of its quantity."""
        last = self._last[zero.index]
        return last is not None and abs(zero.time - last.time) <= 2.0 * zero.width + last.width

    def _within(self, watch: WatchedSign, since: float, until: float) -> Found:
        """Return a zero that lies between two times, if there is one."""
        middle = 0.5 * (since + until)
        return Found(watch.index, self._motion.way * middle, 0.0, max(0.5 * (until - since), 2.0**-52 * middle))
