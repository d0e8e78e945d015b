"""Times at which a quantity has a value, and its extremes, on an interval on which the motion is smooth."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from functools import cached_property
from itertools import islice

import numpy as np
from flint import arb

from core.arrays import Floats
from core.errors import AccuracyUnreachable
from core.multibody.algebra.polynomials import Ball
from core.multibody.search.bands import FLOOR, SAFETY_FACTOR, Quantity, with_band
from core.multibody.search.every_zero import EveryZero
from core.multibody.search.first_of_motion import Expansions
from core.multibody.search.followed import Found
from core.multibody.search.location import NotLocated, located
from core.multibody.search.pieces import Expanded, Pieces
from core.multibody.trajectory.quantities import Sought
from core.systems.trajectory import Column

Sampler = Callable[[Floats], Column]
"""From times to the column of one quantity, whose values have shape (t,)."""

_MOST_AT_ONCE = 256
"""Zeros of which the quantity is evaluated at once at most."""
_BESIDE = 2.0**-48
"""Share of the time of a jump by which its sides are before and after it: a few roundings."""
_NEARLY_ZERO = 2.0**-20
"""Share of the largest value below which a value may be one that vanishes, at a time that is not yet located."""
_LEAST = 2.0**-1000
"""Time (s) below which no power of it is a double."""


@dataclass(frozen=True)
class Hit:
    """A time at which a quantity has a value.

    Attributes
    ----------
    time : ball
        Since the start of the interval (s).
    error : float
    """

    time: Ball
    error: float


@dataclass(frozen=True)
class Extreme:
    """A least or largest value.

    Attributes
    ----------
    value, time : float
    error : float
        Of the time (s).
    known : float
        Error of the value: another one, at a time that is not told from this, may be so much larger or smaller.
    """

    value: float
    time: float
    error: float
    known: float


@dataclass(frozen=True)
class SearchAlong:
    """A search from time zero on.

    Attributes
    ----------
    expansions : Expansions
        Computations of the motion.
    sought : Sought
    sampler : callable
        Values of the quantity with their error, in doubles.
    end : float
        Latest time (s).
    expanded : float
        Time up to which the motion can be expanded (s).
    """

    expansions: Expansions
    sought: Sought
    sampler: Sampler
    end: float
    expanded: float = math.inf

    def hits(self, value: Ball) -> Iterator[Hit]:
        """Yield the times after zero at which the quantity has a value, in their order; what has it there leaves it.

        A touch that is not known from two crossings or from none, and two crossings that are not known apart, are one
        time, with an error that reaches to where the quantity certainly differs from the value. The last time may be
        beyond the end.
        """
        if self.has_throughout(value):
            # What has the value all the time takes it no more.
            return
        quantity = self.sought.less(value)
        # The end is rounded.
        end = min(math.nextafter(self.end, math.inf), self.expanded)
        zeros = EveryZero(self._motions, [quantity], self._coarse).until(end)
        count = 1
        while batch := list(islice(zeros, count)):
            for one in self._with_the_value(batch, float(value)):
                yield self._located(quantity, one)
            count = min(2 * count, _MOST_AT_ONCE)

    def starts_with(self, value: Ball) -> bool:
        """Return whether the quantity has a value at time zero, as far as is known."""
        return self._vanishes(self.sought.less(value), 1) and self._has_at_start(value)

    def has_throughout(self, value: Ball) -> bool:
        """Return whether it has a value all the time: its Taylor series at time zero is no more than the value."""
        return self._vanishes(self.sought.less(value)) and self._has_at_start(value)

    def _has_at_start(self, value: Ball) -> bool:
        return self.sought.has(float(self.sampler(np.zeros(1)).values[0]), float(value))

    def _vanishes(self, quantity: Quantity, count: int | None = None) -> bool:
        """Return whether the first coefficients of a quantity, or all of them, are zero as far as is known."""
        values, _, band, _ = with_band(quantity, self._at_start)
        return bool(np.all(np.abs(values[0, :count, 0]) <= band[0, :count]))

    @cached_property
    def _at_start(self) -> list[Pieces]:
        """The motion just after time zero."""
        return [motion(np.zeros(1), np.array([self.end])) for motion in self._motions]

    def extremes(self) -> tuple[Extreme, Extreme]:
        """Return the least and the largest value."""
        quantities = self.sought.turning()
        if not self.end > 0.0 or self._vanishes(quantities[0]):
            # Of a constant no time is told from another.
            start = self.sampler(np.zeros(1))
            constant = Extreme(float(start.values[0]), 0.0, self.end, start.error)
            return constant, constant
        zeros = EveryZero(self._motions, quantities, self._coarse)
        turns = [one for one in zeros.until(min(self.end, self.expanded)) if one.time < self.end]
        candidates: list[tuple[float, Found | None]] = [(0.0, None)]
        for one in turns:
            # A jump has two sides.
            beside = _BESIDE * one.time if one.index else 0.0
            candidates.extend((side, one) for side in dict.fromkeys((-beside, 0.0, beside)))
        candidates.append((self.end, None))
        times = np.array([side if one is None else one.time + side for side, one in candidates])
        column = self.sampler(np.clip(times, 0.0, self.end))
        values, hits = column.values.copy(), dict[int, Hit]()

        def locate(k: int) -> Hit | None:
            side, one = candidates[k]
            if one is not None and k not in hits:
                # What is found is the zero of a series that is cut off.
                hits[k] = self._located(quantities[one.index], one)
                times[k] = float(hits[k].time) + side
            return hits.get(k)

        # A length that vanishes does so as a corner: its value is that at the time itself.
        corners = np.flatnonzero(np.abs(values) <= _NEARLY_ZERO * np.max(np.abs(values)))
        if any([locate(k) is not None for k in corners.tolist()]):
            values[corners] = self.sampler(np.clip(times[corners], 0.0, self.end)).values
        found = []
        for sign in (-1.0, 1.0):
            # The first of those that cannot be told apart from the largest: the quantity is monotonic in between.
            best = int(np.argmax(sign * values))
            alike = sign * values >= sign * values[best] - 2.0 * column.error
            k = int(np.argmax(alike))
            hit, last = locate(k), k + int(np.argmin(np.append(alike[k:], False))) - 1
            time = float(np.clip(times[k], 0.0, self.end))
            error = max(float(times[last]) - time, 0.0)
            if hit is not None:
                error += hit.error + abs(candidates[k][0]) + 2.0**-52 * time
            own = self.sampler(np.clip(times[[k, best]], 0.0, self.end)).error
            known = own + float(sign * (values[best] - values[k]))
            found.append(Extreme(float(values[k]), time, error, known))
        return found[0], found[1]

    @property
    def _motions(self) -> tuple[Expanded, ...]:
        return tuple(self.expansions.forces if self.sought.of_forces else self.expansions.places)

    @property
    def _coarse(self) -> tuple[Expanded, ...]:
        return tuple(self.expansions.coarse[1 if self.sought.of_forces else 0])

    def _with_the_value(self, zeros: list[Found], value: float) -> list[Found]:
        """Return those zeros at which the quantity has the value."""
        if not self.sought.ambiguous:
            return zeros
        times = np.minimum(np.array([one.time for one in zeros]), self.end)
        values = self.sampler(times).values
        return [one for one, x in zip(zeros, values, strict=True) if self.sought.has(float(x), value)]

    def _located(self, quantity: Quantity, found: Found) -> Hit:
        """Return a zero to the last digits of pairs, with the error of its time."""
        if found.width > 0.0:
            return Hit(arb(found.time), found.width)
        reach = max(found.time, _LEAST)
        try:
            zeros = [located(motion, quantity, found.time, found.rest, reach) for motion in self._motions]
        except NotLocated:
            raise AccuracyUnreachable(
                None,
                1.0,
                f"a zero near {found.time:.17g} s cannot be located",
                path=("outputs",),
                remedy="ask for an earlier time",
            ) from None
        apart = abs(float(zeros[0].time - zeros[-1].time))
        return Hit(zeros[0].time, FLOOR * zeros[0].width + SAFETY_FACTOR * apart)
