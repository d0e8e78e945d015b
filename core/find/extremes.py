"""Where a figure is least or largest: local extremes inside of the range, and ends of the range.

An extreme is bounded by two inputs with which the figure is worse than between them by more than its errors. A figure
changes by the square of the distance there, so that the place is known to the root of its relative error.
"""

from __future__ import annotations

from math import sqrt

from core.find.evaluations import Curve
from core.find.minima import UndefinedBetween, least_of
from core.find.scanning import Run, scanned
from core.find.solutions import Family, Solution
from core.find.varied import beside, rounding

INWARD = 1e-6
"""Share of the first interval at which it is seen whether a figure goes up or down from an end of the range."""

WIDER = 2.0
"""Factor by which the bracket of an extreme is widened until it is decided."""

NARROWER = 16.0
"""Factor by which it is narrowed as long as it stays decided."""

JUMP = 16.0
"""A step between neighbouring doubles is a jump if it is so many times the figure's errors and the steps beside it."""


def unresolved_extreme(run: Run, i: int) -> bool:
    """Return whether the figure may turn between two samples without their showing it."""
    return run.doubt(i) > 0.25 * run.variation(i)


def extremes_of(curve: Curve, sign: float) -> tuple[list[Solution], list[Family]]:
    """Return where a figure, times a sign, is locally largest in the closed range, or the range if it is constant."""
    run = scanned(curve, 0.0, unresolved_extreme)
    search = _Search(curve, sign)
    if search.constant(run):
        return [], [Family((curve.varied.least,), (curve.varied.most,))]
    found = [*search.at_ends(run)]
    for i in range(1, len(run.xs) - 1):
        window = run.numbers[i - 1 : i + 2]
        sizes = [sign * f for f in window if f is not None]
        if len(sizes) == 3 and sizes[1] >= sizes[0] and sizes[1] > sizes[2]:
            found.append(search.inside(run.xs[i - 1], run.xs[i], run.xs[i + 1]))
    return sorted((one for one in found if one is not None), key=lambda one: one.inputs), []


class _Search:
    def __init__(self, curve: Curve, sign: float) -> None:
        self._curve, self._sign = curve, sign

    def f(self, x: float) -> float:
        """Return what is to be largest."""
        number = self._curve.number(x)
        if number is None:
            raise UndefinedBetween
        return self._sign * number

    def constant(self, run: Run) -> bool:
        """Return whether the figure does not change within its errors."""
        defined = [x for x, f in zip(run.xs, run.numbers, strict=True) if f is not None]
        if len(defined) < len(run.xs) or not defined:
            return False
        low, high = min(defined, key=self.f), max(defined, key=self.f)
        return self.f(high) - self.f(low) <= self._curve.error(high) + self._curve.error(low)

    def at_ends(self, run: Run) -> list[Solution | None]:
        """Return ends of the range where the figure falls inwards, and extremes between an end and the next sample."""
        found: list[Solution | None] = []
        for end, inner in ((0, 1), (-1, -2)):
            x, other = run.xs[end], run.xs[inner]
            if run.numbers[end] is None or run.numbers[inner] is None:
                continue
            near = x + (other - x) * INWARD
            if near == x or self._curve.number(near) is None:
                near = other
            if self.f(near) < self.f(x):
                found.append(self._at(x, 0.0, "border"))
            elif self.f(near) > self.f(x) and self.f(near) > self.f(other):
                found.append(self.inside(*sorted((x, near, other))))
        return found

    def _at(self, x: float, error: float, kind: str) -> Solution:
        value = self._curve.number(x)
        assert value is not None
        border = kind == "border"
        return Solution((x,), (error,), "border" if border else "extreme", 1, (value,), (self._curve.error(x),))

    def inside(self, low: float, middle: float, high: float) -> Solution | None:
        """Return the extreme between two inputs, better than both of which one between them is."""
        varied = self._curve.varied
        bracket = varied.coordinate(low), varied.coordinate(middle), varied.coordinate(high)
        try:
            best = varied.value(least_of(lambda place: -self.f(varied.value(place)), bracket))
            best = max((best, middle), key=self.f)
            jump = self._jump(best, low, high)
            if jump is not None:
                return jump
            curvature = self._curvature(low, best, high)
            error = self._curve.error(best)
            start = 2.0 * sqrt(error / curvature) if curvature > 0.0 else 0.0
            ends = [self._worse(best, start, side, low if side < 0 else high) for side in (-1, 1)]
        except UndefinedBetween:
            return None
        return self._at(best, max(abs(end - best) for end in ends), "extreme")

    def _curvature(self, low: float, best: float, high: float) -> float:
        """Return the smaller of the falls to both sides, per square of the distance."""
        return min((self.f(best) - self.f(x)) / (x - best) ** 2 for x in (low, high) if x != best)

    def _worse(self, best: float, distance: float, side: int, limit: float) -> float:
        """Return the nearest input found on a side with which the figure is worse by more than the errors."""
        distance = max(distance, 2.0 * rounding(best))

        def worse(distance: float) -> float | None:
            end = beside(best, distance)[0 if side < 0 else 1]
            if (limit - end) * side <= 0.0:
                return limit
            decided = self.f(best) - self.f(end) > self._curve.error(best) + self._curve.error(end)
            return end if decided else None

        end = worse(distance)
        while end is None:
            distance *= WIDER
            end = worse(distance)
        # At a corner the figure falls with the distance itself, and is decided much nearer.
        while distance > 4.0 * rounding(best) and (nearer := worse(distance / NARROWER)) not in (None, limit):
            distance, end = distance / NARROWER, nearer
        return end

    def _jump(self, best: float, low: float, high: float) -> Solution | None:
        """Return the jump beside which the figure is largest, if it leaps there."""
        for side in (0, 1):
            inner, outer = best, (low, high)[side]
            step = 8.0 * rounding(best)
            near, far, farther = (beside(best, k * step)[side] for k in (1, 2, 3))
            if not low < min(near, farther) <= max(near, farther) < high:
                continue
            leap = self.f(inner) - self.f(near)
            smooth = max(abs(self.f(near) - self.f(far)), abs(self.f(far) - self.f(farther)))
            if leap > JUMP * (smooth + self._curve.error(inner) + self._curve.error(near)) and outer != inner:
                below, above = (near, inner) if side == 0 else (inner, near)
                values = self._curve.number(below), self._curve.number(above)
                return Solution((best,), (abs(near - inner),), "jump", below=values[0], above=values[1])
        return None
