"""A motion that is followed by pieces, and the signs of quantities on them.

Every quantity is a polynomial on a piece with a band of error: the difference of two computations of the motion,
rounding, and the powers left out. Where the latter leave a sign open the motion is expanded anew close by.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field

import numpy as np

from core.arrays import Floats
from core.errors import AccuracyUnreachable, BudgetExceeded
from core.multibody.algebra.bernstein import MOST_SEGMENTS, NEGATIVE, POSITIVE, decided_each
from core.multibody.search.bands import FLOOR, Quantity, later, with_band
from core.multibody.search.batch import MUCH_LONGER, Batch, Signs, usual_length
from core.multibody.search.pieces import Expanded

MOST_PIECES = 60_000
"""Pieces that one search may take."""
_AT_ONCE = 256
"""Pieces that are expanded at once at most: four times as many each time, as what follows an event is in vain."""
_COARSE = 2.0**-40
"""Share of the terms that a quantity is wrong by at most in doubles: thousands of roundings."""
_CLOSER = 2.0**-4
"""Share of a piece in which it is expanded anew: what is left out then is 2^-84 of what it was."""


@dataclass(frozen=True)
class Found:
    """Where a quantity falls below zero.

    Attributes
    ----------
    index : int
        Of the quantity.
    time, rest : float
        A pair, to about 2^-50 of a piece.
    width : float
        Half the length of the interval in which it is not known on which side of zero it is; zero where it is certain
        to fall below.
    unsure : float
        By how much the time may be wrong of what falls below for certain, beyond the error of the motion.
    """

    index: int
    time: float
    rest: float
    width: float = 0.0
    unsure: float = 0.0


@dataclass
class Interval:
    """Part of the time that is still to be searched, and, once expanded, its piece.

    Attributes
    ----------
    closely : bool
        Whether doubles do not do.
    """

    start: float
    reach: float
    batch: Batch | None = None
    number: int = 0
    closely: bool = False


@dataclass
class WatchedSign:
    """A quantity, and what is known of it so far.

    Attributes
    ----------
    power : int or None
        Of time with which it rises at the start, where that is known: lower ones are zero. With the power zero it is
        above zero there, by however little.
    above : bool
        Whether it has been above zero.
    since : float or None
        From when on it has been undecided.
    largest : ndarray
        Sizes of its terms so far, by powers: what has become small is known no better in doubles.
    """

    quantity: Quantity
    jumps: bool
    power: int | None
    index: int
    above: bool = True
    since: float | None = None
    largest: Floats = field(default_factory=lambda: np.zeros(1))


class Followed:
    """A motion from time zero on, and what is known of quantities along it.

    Parameters
    ----------
    motions : sequence of Expanded
        One computation of the motion, or two whose difference is its error.
    quantities : sequence of callable
    jumps : sequence of bool
        Of which quantities it matters whether they only touch zero: what follows is another motion then, and not the
        same to within its error.
    powers : sequence of int or None
        Of time with which each begins, where that is known: as many of its coefficients are zero at the start, whatever
        is computed of them, and it rises from there.
    way : float
        -1 for the time before zero.
    coarse : sequence of Expanded
        The same computations in doubles, if they are faster: for where everything is far from zero.
    every : bool
        Whether every sign is of interest, and not only the first below zero.

    Attributes
    ----------
    below : list of int
        The quantities that are below zero from the start on.
    """

    def __init__(
        self,
        motions: Sequence[Expanded],
        quantities: Sequence[Quantity],
        jumps: Sequence[bool],
        powers: Sequence[int | None],
        way: float = 1.0,
        coarse: Sequence[Expanded] = (),
        *,
        every: bool = False,
    ) -> None:
        self.motions, self.way, self.coarse, self.every = motions, way, coarse, every
        self.watched = [WatchedSign(*each, i) for i, each in enumerate(zip(quantities, jumps, powers, strict=True))]
        self._left: list[Interval] = []
        self._reached = 0.0
        self._last = 0.0
        self._count, self._at_once = 0, 1
        self.below: list[int] = []

    def intervals(self, end: float) -> Iterator[Interval]:
        """Yield intervals up to a time with what is known on them; what remains of one is put back by `leave`.

        Raises
        ------
        BudgetExceeded
            Where more pieces would be needed than one search may take.
        AccuracyUnreachable
            Where the motion leaves the range of doubles.
        """
        if not end > self._reached:
            return
        self._left = [Interval(self._reached, end - self._reached)]
        self._reached = end
        while self._left and self.watched:
            if self._left[-1].batch is None:
                self._expand()
            else:
                yield self._left.pop()

    def _expand(self) -> None:
        """Expand the next intervals, those that are longer than pieces have been in parts."""
        ahead: list[Interval] = []
        closely = self._left[-1].closely or not self.coarse
        # What is zero at the start is divided out of the first piece alone.
        most = 1 if self._left[-1].start == 0.0 else self._at_once
        closely = closely or self._left[-1].start == 0.0
        while self._left and len(ahead) < most and self._left[-1].batch is None:
            if ahead and self._left[-1].closely != ahead[0].closely:
                break
            one = self._left.pop()
            longest = self._last if self._last > 0.0 else one.reach
            while len(ahead) < most and one.reach > longest:
                following = later(one.start, longest)
                if not following > one.start:
                    break
                ahead.append(Interval(one.start, longest, closely=one.closely))
                one = Interval(following, one.reach - (following - one.start), closely=one.closely)
            if len(ahead) < most:
                ahead.append(one)
            else:
                self._left.append(one)
        self._at_once = min(4 * self._at_once, _AT_ONCE)
        expanded = self._with_pieces(ahead, closely=closely)
        if len(ahead) > 1:
            # What is left of those that are shorter than expected is expanded together as well: one batch of many
            # pieces takes little longer than one of a single piece.
            rests = [rest for one in expanded if (rest := self._rest(one)) is not None]
            if rests:
                expanded = sorted([*expanded, *self._with_pieces(rests, closely=closely)], key=lambda one: one.start)
        self._left.extend(reversed(expanded))

    @staticmethod
    def _rest(one: Interval) -> Interval | None:
        """Cut an interval to its piece, and return what follows in it, None where the piece is long enough."""
        if one.batch is None:
            return None
        length, end = float(one.batch.lengths[one.number]), one.start + one.reach
        start = later(one.start, length)
        if not (one.reach > length and one.start < start < end):
            return None
        one.reach = length
        return Interval(start, end - start)

    def _with_pieces(self, ahead: Sequence[Interval], *, closely: bool) -> list[Interval]:
        """Return intervals with their pieces; of those that end at a corner, what follows is not expanded yet."""
        self._count += len(ahead)
        if self._count > MOST_PIECES:
            needed = self._count * self._reached / max(ahead[-1].start, self._reached * 2.0**-60)
            what = "pieces of the motion that are searched"
            raise BudgetExceeded(what, needed, MOST_PIECES, path=("times",), remedy="ask for a shorter time")
        batch = self._batch(ahead, closely=closely)
        expanded: list[Interval] = []
        for number, one in enumerate(ahead):
            expanded.append(one)
            if batch.natural[number] < min(batch.lengths[number], one.reach):
                # The piece ends at a corner.
                until, end = later(one.start, float(batch.natural[number])), one.start + one.reach
                one.reach = float(batch.natural[number])
                if one.start < until < end:
                    expanded.append(Interval(until, end - until, closely=one.closely))
            if closely or batch.plain[number]:
                one.batch, one.number = batch, number
            else:
                one.closely = True
        self._last = batch.usual
        if batch.usual >= MUCH_LONGER * float(batch.lengths.max()):
            # Of what becomes smooth, many pieces of the present length would be in vain.
            self._at_once = 1
        return expanded

    def _batch(self, ahead: Sequence[Interval], *, closely: bool) -> Batch:
        """Return pieces, and what every quantity does on them."""
        times, until = np.array([one.start for one in ahead]), np.array([one.reach for one in ahead])
        if not np.all(until > 0.0):
            what = "what is watched has no value where its search leads, however short its pieces are"
            raise AccuracyUnreachable(None, math.inf, what, path=("times",))
        # What leaves the range of doubles is refused below.
        with np.errstate(over="ignore", invalid="ignore"):
            pieces = [
                motion(self.way * times, self.way * until) for motion in (self.motions if closely else self.coarse)
            ]
        cut = [np.where(each.cut, each.natural, np.inf) for each in pieces]
        shortest = np.minimum.reduce([np.abs(each.lengths) for each in pieces])
        # Computations that are a little apart may have corners at different times, or models of which one holds for
        # ever: how far they are apart is known as long as both hold.
        pieces = [each if np.all(np.abs(each.lengths) == shortest) else each.shortened(shortest) for each in pieces]
        lengths = np.abs(pieces[0].lengths)
        if not np.isfinite(lengths).all():
            raise AccuracyUnreachable(None, math.inf, "the motion leaves the range of doubles", path=("times",))
        natural = np.minimum.reduce([pieces[0].natural, *cut])
        share = np.minimum(np.minimum(until, natural) / lengths, 1.0)
        plain, of = np.ones(len(times), dtype=bool), {}
        remaining = []
        for watch in self.watched:
            values, sizes, band, left_out = with_band(watch.quantity, pieces)
            if not closely:
                watch.largest = np.maximum(watch.largest, np.max(sizes, axis=0))
                band = band + _COARSE * (sizes + watch.largest)
            if not (np.isfinite(values).all() and np.isfinite(band).all()):
                raise AccuracyUnreachable(None, math.inf, "the motion leaves the range of doubles", path=("times",))
            power = values.shape[1]
            if times[0] == 0.0:
                values, band, power = self._divided(watch, values, FLOOR * sizes, band)
                if not power:
                    continue
            remaining.append(watch)
            counts = np.empty(len(times), dtype=np.int64)
            ends, signs = np.empty((len(times), MOST_SEGMENTS)), np.empty((len(times), MOST_SEGMENTS), dtype=np.int64)
            decided_each(values, band, left_out, power, share, watch.above and not self.every, counts, ends, signs)
            known = signs[:, 0] == POSITIVE
            plain &= (counts == 1) & (known | (signs[:, 0] == NEGATIVE) if self.every else known)
            of[watch.index] = Signs(values, counts, ends, signs)
        self.watched = remaining
        return Batch(lengths, natural, usual_length(natural, lengths), plain, of)

    def _divided(self, watch: WatchedSign, values: Floats, rounded: Floats, band: Floats) -> tuple[Floats, Floats, int]:
        """Return the only piece of a quantity at time zero, with what is zero there but for rounding divided out.

        How far two computations are apart does not matter for that: each of them has the event that begins there. The
        power of the first coefficient that is left out follows; it is zero for what vanishes throughout.
        """
        assert len(values) == 1
        begun = np.arange(values.shape[1]) >= (watch.power or 0)
        known = begun & (np.abs(values[0, :, 0]) > rounded[0])
        if not known.any():
            return values, band, 0
        if watch.power == 0:
            # What is above zero by less than can be told may fall below at once: that is its event.
            return values, band, values.shape[1]
        zeros, count = int(np.argmax(known)), values.shape[1]
        shifted, errors = np.zeros_like(values), np.zeros_like(band)
        shifted[:, : count - zeros], errors[:, : count - zeros] = values[:, zeros:], band[:, zeros:]
        # Of what is left the first that is known decides the sign just after the start.
        sure = begun & (np.abs(values[0, :, 0]) > band[0])
        watch.above = bool(values[0, int(np.argmax(sure)) if sure.any() else zeros, 0] > 0.0)
        if not watch.above and watch.index not in self.below:
            self.below.append(watch.index)
        return shifted, errors, count - zeros

    def leave(self, one: Interval, length: float, open_from: float) -> None:
        """Put back what is still to be searched of an interval."""
        end = one.start + one.reach
        if open_from < min(one.reach / length, 1.0):
            start = later(one.start, open_from * length)
            closer = _CLOSER * length if start == end else min(_CLOSER * length, end - start)
            following = later(start, closer)
            if start < following < end:
                self._left.append(Interval(following, end - following))
            # Where there is no double between two times the rest follows from the same start.
            self._left.append(Interval(start, closer, closely=True))
        elif one.reach > length:
            start = later(one.start, length)
            if start < end:
                self._left.append(Interval(start, end - start))

    def at(self, start: float, length: float, watch: WatchedSign, share: float, tail: float) -> Found:
        """Return a zero at a share of a piece."""
        moved = share * length
        time = start + moved
        rounded = moved - (time - start) if start >= moved else start - (time - moved)
        return Found(watch.index, self.way * time, self.way * (rounded + tail * length))
