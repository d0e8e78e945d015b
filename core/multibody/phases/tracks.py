"""What is known of the state of a scene from phase to phase.

As long as phases have closed forms the state is exact, in balls: one track. From the first phase that has none on there
are two, run by series of different order and tolerance in pairs of doubles. Their difference says how right the state
is, and every sign at an event is decided in balls of that width.
"""

from __future__ import annotations

import sys
from collections.abc import Sequence
from dataclasses import dataclass

from flint import arb

from core.multibody.algebra.polynomials import ZERO, Ball, is_zero
from core.multibody.search.bands import FLOOR, SAFETY_FACTOR

NEGLIGIBLE_RATE = 2.0**-180
"""Share of the largest rate of its unit below which a rate is what is left of an exact zero."""

Vector = list[Ball]


@dataclass(frozen=True)
class Track:
    """One computation of the motion: its time and state at the start of a phase."""

    time: Ball
    q: Vector
    v: Vector

    def after(self, time: Ball, still: Sequence[bool], q: Vector, v: Vector) -> Track:
        """Return the track at a state some time later: what rests is where it was, without the rounding of forces."""
        places = [now if rests else x for rests, now, x in zip(still, self.q, q, strict=True)]
        rates = [ZERO if rests else x for rests, x in zip(still, v, strict=True)]
        return Track(self.time + time, places, rates)

    def bare(self) -> Track:
        """Return the track without the width of its balls."""
        return Track(arb(self.time.mid()), [arb(x.mid()) for x in self.q], [arb(x.mid()) for x in self.v])


def late(each: Sequence[Track]) -> float:
    """Return what the time of one track or two is wrong by."""
    time = each[0].time
    error = float(time.rad()) + 2.0**-53 * abs(float(time))
    if len(each) > 1:
        error += SAFETY_FACTOR * abs(float(time - each[1].time)) + FLOOR * abs(float(time))
    return error


class Tracks:
    """The present state on one track or two, and the sizes by which its errors are measured.

    Parameters
    ----------
    units : sequence of str
        Of the coordinates.
    q, v : list of ball
        The exact state at time zero.

    Attributes
    ----------
    each : list of Track
    left_out : float
        Share of the largest distance and rate of its unit by which what was left out changes the state at most.
    lost : two lists of float
        By how much coordinates and rates are wrong on all tracks alike: what was taken to be zero, or left out.
    """

    def __init__(self, units: Sequence[str], q: Sequence[Ball], v: Sequence[Ball]) -> None:
        self.units = units
        self.each = [Track(ZERO, list(q), list(v))]
        self.left_out = 0.0
        self.lost = [0.0] * len(q), [0.0] * len(q)
        self._largest: tuple[dict[str, float], dict[str, float]] = ({}, {})
        self._start = list(q)
        self._farthest: dict[str, float] = {}
        self.scales()

    @property
    def first(self) -> Track:
        """The track that is answered."""
        return self.each[0]

    @property
    def time(self) -> Ball:
        """The present time."""
        return self.each[0].time

    @property
    def exact(self) -> bool:
        """Whether the balls of the only track hold the state."""
        return len(self.each) == 1

    def wide(self) -> tuple[Vector, Vector]:
        """Return the state as balls that hold what is known of it."""
        first = self.first
        if self.exact:
            return first.q, first.v
        second = self.each[1]
        found = []
        for one, other, scales, sizes in zip(
            (first.q, first.v), (second.q, second.v), self.scales(), self.motion(), strict=True
        ):
            least = [FLOOR * scale + self.left_out * size for scale, size in zip(scales, sizes, strict=True)]
            found.append(
                [
                    arb(x.mid(), SAFETY_FACTOR * float(abs(x - y).mid()) + width)
                    for x, y, width in zip(one, other, least, strict=True)
                ]
            )
        return found[0], found[1]

    def scales(self) -> tuple[list[float], list[float]]:
        """Return the largest coordinate and rate so far of the unit of each."""
        found = []
        for largest, vector in zip(self._largest, (self.first.q, self.first.v), strict=True):
            for unit, x in zip(self.units, vector, strict=True):
                largest[unit] = max(largest.get(unit, 0.0), 0.0 if is_zero(x) else abs(float(x.mid())))
            found.append([largest[unit] for unit in self.units])
        places, rates = found
        # A body that hardly turns, beside others or itself that move, is known to turn no better than these are.
        place, rate = (largest.get("m", 0.0) for largest in self._largest)
        least = rate / place if place > 0.0 else 0.0
        turns = [unit in ("1", "rad") and x > 0.0 for unit, x in zip(self.units, rates, strict=True)]
        return places, [max(x, least) if turned else x for turned, x in zip(turns, rates, strict=True)]

    def motion(self) -> tuple[list[float], list[float]]:
        """Return the largest distance from the start and the largest rate so far of the unit of each coordinate.

        What is left out of a motion is a share of these: where the origin is does not matter to it.
        """
        return [self._farthest.get(unit, 0.0) for unit in self.units], self.scales()[1]

    def fastest(self, unit: str) -> float:
        """Return the largest rate so far of a unit."""
        return self._largest[1].get(unit, 0.0)

    def own_time(self) -> float:
        """Return the time in which the scene moves by its own size."""
        place, rate = (largest.get("m", 0.0) for largest in self._largest)
        # Where nothing is away from the origin or moves, any time is as good.
        return max(place / rate, sys.float_info.min) if place > 0.0 and rate > 0.0 else 1.0

    def follow_scales(
        self, time: float, before: Sequence[Ball], after: Sequence[Ball], acceleration: Sequence[Ball]
    ) -> None:
        """Take account of how large coordinates and rates were during a phase, as far as its ends tell.

        A way that pairs of doubles may leave of nothing would be fast in the short phases between bounces.
        """
        turned = {"rad": 1.0, "1": 1.0}
        nothing = [
            0.0 if self.exact else FLOOR * max(size, turned.get(unit, 0.0))
            for unit, size in zip(self.units, self.scales()[0], strict=True)
        ]
        self.lost = [x + time * y for x, y in zip(*self.lost, strict=True)], self.lost[1]
        for i, unit in enumerate(self.units):
            pull = abs(float(acceleration[i].mid()))
            moved = abs(float((after[i] - before[i]).mid()))
            moved = moved if moved > nothing[i] else 0.0
            # A phase may be shorter than the least double.
            rate = moved / time if time > 0.0 else 0.0
            for largest, x in zip(self._largest, (pull * time * time, max(pull * time, rate)), strict=True):
                largest[unit] = max(largest.get(unit, 0.0), x)
            away = abs(float((after[i] - self._start[i]).mid()))
            self._farthest[unit] = max(self._farthest.get(unit, 0.0), away, moved, pull * time * time)

    def late(self) -> float:
        """Return what the present time is wrong by."""
        return late(self.each)

    def width(self) -> float:
        """Return the largest width of the balls of the first track, relative to the scales."""
        return max(
            (
                float(x.rad()) / scale
                for vector, each in zip((self.first.q, self.first.v), self.scales(), strict=True)
                for x, scale in zip(vector, each, strict=True)
                if scale > 0.0
            ),
            default=0.0,
        )

    def lose(self, places: Sequence[float], rates: Sequence[float]) -> None:
        """Take account of changes of which the difference of the tracks says nothing."""
        q, v = ([x + y for x, y in zip(*both, strict=True)] for both in zip(self.lost, (places, rates), strict=True))
        self.lost = q, v

    def settle(self, q: Vector, v: Vector) -> None:
        """Make exact zeros of what a projection leaves of numbers that the rows hold at zero."""
        # What hardly turns has no scale of its own.
        turning = 1.0 / self.own_time()
        for largest, vector, least in zip(self._largest, (q, v), (0.0, turning), strict=True):
            for i, (unit, x) in enumerate(zip(self.units, vector, strict=True)):
                own = largest.get(unit, 0.0)
                if abs(float(x)) <= NEGLIGIBLE_RATE * (own if unit in ("m", "s") else max(own, least)):
                    vector[i] = ZERO

    def part(self, still: Sequence[bool], share: float = FLOOR, of_places: float = FLOOR) -> None:
        """Go on with two tracks, the second moved by a share of the largest, so that the growth of errors is seen.

        Parameters
        ----------
        still : sequence of bool
            Which coordinates are constants of the last phase on both: these remain the same.
        share, of_places : float
            Of the largest rates; of the largest distances, beside the rounding of places.
        """
        last = self.each[-1].bare()
        self.each = [self.first.bare(), last]
        q_scales, v_scales = self.scales()
        away = [max(FLOOR * x, of_places * y) for x, y in zip(q_scales, self.motion()[0], strict=True)]
        q = _moved(self.first.q, last.q, away, still)
        v = _moved(self.first.v, last.v, [share * x for x in v_scales], still)
        self.each = [self.first, Track(last.time, q, v)]


def _moved(first: Vector, second: Vector, away: Sequence[float], still: Sequence[bool]) -> Vector:
    """Return the second vector, so far from the first at least, to either side in turn."""
    moved = []
    for i, (x, y, least) in enumerate(zip(first, second, away, strict=True)):
        if (still[i] and x == y) or abs(float(x - y)) >= least:
            moved.append(y)
        else:
            moved.append(arb((x + (least if i % 2 else -least)).mid()))
    return moved
