"""A root of a figure, and how well it is known.

A root is bounded by two inputs with which the figure is above and below the value by more than its errors: whatever is
continuous between them has a root there. The figure's error and its slope thus decide how well the root is known.
"""

from __future__ import annotations

from math import log, log2

from core.find.evaluations import Curve
from core.find.minima import UndefinedBetween
from core.find.solutions import Solution
from core.find.varied import beside, rounding

LOOKED_AT = 1e-5
"""Share of the first values below which a value is compared with its error, which may cost questions of its own."""

WIDER = 4.0
"""Factor by which the bracket of a root is widened until the figure is decided at its ends."""

CLEARLY = 10.0
"""How many times its error a value is at least by which a slope is known to a tenth."""

STEEPER = 1.5
"""Power of the distance above which the multiplicity of a root is looked at."""

FARTHER = 100.0
"""How many times farther than an end of the bracket a sample is by which that power is seen."""


class RootsOfDifference:
    """A figure less a target, whose roots are certified."""

    def __init__(self, curve: Curve, target: float) -> None:
        self._curve, self._target = curve, target
        self._least, self._most = curve.varied.least, curve.varied.most

    def g(self, x: float) -> float:
        """Return the figure less the target."""
        number = self._curve.number(x)
        if number is None:
            raise UndefinedBetween
        return number - self._target

    def is_zero(self, x: float, size: float) -> bool:
        """Return whether the figure has the value within its error; `size` is that of values about it."""
        g = abs(self.g(x))
        return g == 0.0 or (g <= LOOKED_AT * size and g <= self._curve.error(x))

    def decided(self, x: float) -> bool:
        """Return whether the figure is above or below the target by more than its error."""
        return abs(self.g(x)) > self._curve.error(x)

    def certified(self, x: float, other: float, within: tuple[float, float] | None = None) -> Solution:
        """Return a root at or between two inputs, with a bracket on whose ends the figure is decided."""
        low, high = within or (self._least, self._most)
        best = min((x, other), key=lambda place: abs(self.g(place)))
        g, error = self.g(best), self._curve.error(best)
        slope = self._slope(best, error)
        needed = 2.0 * (abs(g) + error) / slope if slope > 0.0 else 0.0
        ends = [self._end_of_bracket(best, needed, side, low, high) for side in (-1, 1)]
        distance = max(abs(end - best) for end in ends)
        # A root at an end of the range may be beyond it by as much as is not known.
        distance = max(distance, needed if best in (self._least, self._most) else 0.0, 2.0 * rounding(best))
        even = all(map(self.decided, ends)) and self.g(ends[0]) * self.g(ends[1]) > 0.0
        steep = even or self._power(best, ends) > STEEPER
        multiplicity = self._multiplicity(best, distance, even=even) if steep else 1
        value = self._curve.number(best)
        figures = None if value is None else (value,)
        return Solution((best,), (distance,), "root", multiplicity, figures, (error,))

    def _power(self, x: float, ends: list[float]) -> float:
        """Return with which power of the distance a figure leaves the target, from the samples that there are."""
        powers = []
        for side, end in zip((-1, 1), ends, strict=True):
            far = [p for p in self._curve.known if (p - end) * side > 0.0 and self._curve.number(p) is not None]
            if far and end != x and self.decided(end):
                for p in sorted(far, key=lambda p: abs(p - x)):
                    if abs(p - x) > FARTHER * abs(end - x):
                        powers.append(log(abs(self.g(p) / self.g(end))) / log(abs((p - x) / (end - x))))
                        break
        return max(powers, default=1.0)

    def _slope(self, x: float, error: float) -> float:
        """Return the smaller slope to either of the nearest samples that are decided; 0 without any."""
        slopes = []
        for side in (-1, 1):
            sampled = [p for p in self._curve.known if (p - x) * side > 0.0 and self._curve.number(p) is not None]
            for p in sorted(sampled, key=lambda p: abs(p - x)):
                if abs(self.g(p)) > CLEARLY * error:
                    slopes.append(abs(self.g(p)) / abs(p - x))
                    break
        return min(slopes, default=0.0)

    def _end_of_bracket(self, x: float, distance: float, side: int, low: float, high: float) -> float:
        """Return the nearest input found on a side with which the figure is decided; the limit if there is none."""
        limit = low if side < 0 else high
        distance = max(distance, 2.0 * rounding(x))
        while True:
            end = beside(x, distance)[0 if side < 0 else 1]
            if (limit - end) * side <= 0.0:
                return limit
            if self._curve.number(end) is not None and self.decided(end):
                return end
            distance *= WIDER

    def _multiplicity(self, x: float, distance: float, *, even: bool) -> int:
        """Return the power with which a figure leaves the target, by its values at one and two distances."""
        powers = []
        for side in (-1.0, 1.0):
            near, far = x + side * WIDER * distance, x + side * 2.0 * WIDER * distance
            if self._least <= far <= self._most and None not in (self._curve.number(near), self._curve.number(far)):
                one, two = abs(self.g(near)), abs(self.g(far))
                if one > 0.0 and two > 0.0:
                    powers.append(log2(two / one))
        power = round(sum(powers) / len(powers)) if powers else 1
        least = 2 if even else 1
        return max(least, power if power % 2 == least % 2 else power - 1)
