"""Where a figure takes a value: roots, double ones, jumps past the value, and ranges on which it has it throughout."""

from __future__ import annotations

from dataclasses import dataclass
from itertools import pairwise
from math import inf

from core.find.evaluations import Curve
from core.find.infinite import grows
from core.find.known_roots import RootsOfDifference
from core.find.minima import Three, UndefinedBetween, drop_to_vertex, least_of, reaches_zero
from core.find.scanning import FINEST_BORDER, Run, interpolated, scanned
from core.find.solutions import Family, Nearest, Solution
from core.find.varied import neighbours, rounding

MOST_STEPS = 200
"""Steps towards a root: halving alone reaches neighbouring doubles in 64, and 128 halvings are enough for one at 0."""

POINTS = 4
"""Samples through which the inverse is interpolated."""

MOST_PASSES = 3
"""How often the samples are looked through: again after gaps in the figure were met between them."""

DIP = 0.5
"""Share of the smallest sample below which a minimum between samples is looked for: doubts are below that elsewhere."""

STEEP = 4.0
"""A step between neighbouring doubles is a jump if it is so many times the steps beside it."""


@dataclass
class Roots:
    """What is found of a figure that is to have a value."""

    solutions: list[Solution]
    families: list[Family]
    nearest: Nearest | None


def unresolved_root(run: Run, i: int) -> bool:
    """Return whether a root might hide between two samples, or more than one be there."""
    one, other = run.shapes[i], run.shapes[i + 1]
    if one is None or other is None:
        return False
    doubt = run.doubt(i)
    if one * other < 0.0:
        return doubt > 0.5 * abs(one - other)
    return doubt > 0.0 and doubt >= 0.5 * min(abs(one), abs(other))


def roots_of(curve: Curve, target: float) -> Roots:
    """Return where a figure has a value, in the range of its input."""
    for _ in range(MOST_PASSES):
        solutions, families, gaps = _looked_through(curve, target)
        if not gaps:
            break
    found = _apart([one for one in solutions if one is not None])
    nearest = None if found or families else _Search(curve, target).nearest()
    return Roots(found, families, nearest)


def _looked_through(curve: Curve, target: float) -> tuple[list[Solution | None], list[Family], int]:
    """Return what is found between the samples that there are, and how many gaps in the figure were met on the way."""
    run = scanned(curve, target, unresolved_root, finest_border=FINEST_BORDER, compressed=True)
    search = _Search(curve, target)
    zeros = search.zeros(run)
    families, taken = search.families(run, zeros)
    solutions: list[Solution | None] = [search.certified(run.xs[i], run.xs[i]) for i in zeros if i not in taken]
    for i in range(len(run.xs) - 1):
        one, other = run.numbers[i], run.numbers[i + 1]
        if one is None or other is None or i in zeros or i + 1 in zeros:
            continue
        if one * other < 0.0:
            solutions.append(search.between(run.xs[i], run.xs[i + 1]))
    for i in range(1, len(run.xs) - 1):
        if not {i - 1, i, i + 1} & set(zeros):
            solutions += search.dip(run, i)
    return solutions, families, search.gaps


def _apart(solutions: list[Solution]) -> list[Solution]:
    """Return solutions in order, those within the errors of one another once."""
    found: list[Solution] = []
    for one in sorted(solutions, key=lambda solution: solution.inputs):
        if found and one.inputs[0] - found[-1].inputs[0] <= max(one.errors[0], found[-1].errors[0]):
            found[-1] = min(one, found[-1], key=lambda solution: solution.errors)
        else:
            found.append(one)
    return found


class _Crossed(Exception):
    """The figure passes the value where it was only expected to come near."""

    def __init__(self, x: float) -> None:
        self.x = x


class _Search(RootsOfDifference):
    """Looks for the roots of a figure less a target.

    Attributes
    ----------
    gaps : int
        How often it met inputs between samples with which there is no figure.
    """

    def __init__(self, curve: Curve, target: float) -> None:
        super().__init__(curve, target)
        self.gaps = 0

    def zeros(self, run: Run) -> list[int]:
        """Return which samples have the value within their errors."""
        size = max([abs(self._target), *(abs(g + self._target) for g in run.numbers if g is not None)])
        return [i for i, g in enumerate(run.numbers) if g is not None and self.is_zero(run.xs[i], size)]

    def families(self, run: Run, zeros: list[int]) -> tuple[list[Family], set[int]]:
        """Return the ranges on which the figure has the value throughout, and the samples in them."""
        families: list[Family] = []
        taken: set[int] = set()
        i = 0
        while i < len(zeros):
            j = i
            while j + 1 < len(zeros) and zeros[j + 1] == zeros[j] + 1 and self._zero_between(run, zeros[j]):
                j += 1
            if j > i:
                taken.update(zeros[i : j + 1])
                first, last = zeros[i], zeros[j]
                least = self._end(run.xs[first], run.xs[first - 1]) if first else run.xs[first]
                most = self._end(run.xs[last], run.xs[last + 1]) if last + 1 < len(run.xs) else run.xs[last]
                families.append(Family((least,), (most,)))
            i = j + 1
        return families, taken

    def _zero_between(self, run: Run, i: int) -> bool:
        x = self._curve.varied.middle(run.xs[i], run.xs[i + 1])
        return self._curve.number(x) is not None and self.is_zero(x, inf)

    def _end(self, inside: float, outside: float) -> float:
        """Return the last double with the value between one with it and one without."""
        for _ in range(MOST_STEPS):
            if neighbours(inside, outside):
                break
            middle = self._curve.varied.middle(inside, outside)
            if self._curve.number(middle) is not None and self.is_zero(middle, inf):
                inside = middle
            else:
                outside = middle
        return inside

    def between(self, low: float, high: float) -> Solution | None:
        """Return the root, or the jump, between two inputs with figures on either side of the target.

        None where the figure passes through infinity, or does not exist in between.
        """
        try:
            return self._between(low, high)
        except UndefinedBetween:
            self.gaps += 1
            return None

    def _between(self, low: float, high: float) -> Solution | None:
        first = low, high
        at_low, at_high = self.g(low), self.g(high)
        size, width, halve = max(abs(at_low), abs(at_high)), high - low, False
        near = [low, high, *self._around(low, high)]
        for _ in range(MOST_STEPS):
            if neighbours(low, high):
                break
            x = None if halve else self._inverse(near, low, high)
            if x is None:
                x = self._curve.varied.middle(low, high)
            g = self.g(x)
            if self.is_zero(x, size):
                return self.certified(x, x, first)
            near.append(x)
            if (g < 0.0) == (at_low < 0.0):
                low, at_low = x, g
            else:
                high, at_high = x, g
            # Interpolation that comes from one side leaves the bracket wide; it is halved every other step then.
            halve = not halve and high - low > 0.5 * width
            width = high - low
        if min(abs(at_low), abs(at_high)) > size and grows(self._curve, low, -1) and grows(self._curve, high, 1):
            return None
        return self._step(low, high, first)

    def _around(self, low: float, high: float) -> list[float]:
        """Return the neighbours of a bracket among the samples, as far as they have the figure."""
        known = self._curve.known
        i, j = known.index(low), known.index(high)
        beside = [known[k] for k in (i - 1, j + 1) if 0 <= k < len(known)]
        return [x for x in beside if self._curve.number(x) is not None]

    def _inverse(self, near: list[float], low: float, high: float) -> float | None:
        """Return where the inverse through the nearest samples has the target, None if that says nothing."""
        coordinate = self._curve.varied.coordinate
        for count in range(min(POINTS, len(near)), 1, -1):
            points = sorted(sorted(near, key=lambda x: abs(self.g(x)))[:count])
            values = [self.g(x) for x in points]
            rising = all(a < b for a, b in pairwise(values))
            falling = all(a > b for a, b in pairwise(values))
            if not (rising or falling):
                continue
            x = self._curve.varied.value(interpolated(values, [coordinate(p) for p in points], 0.0))
            if low < x < high:
                return x
        return None

    def _step(self, low: float, high: float, first: tuple[float, float]) -> Solution:
        """Return what lies between neighbouring doubles with figures on either side of the target."""
        step = abs(self.g(high) - self.g(low))
        steps = [
            abs(self.g(near) - self.g(far))
            for near, far in ((low, low - 4.0 * rounding(low)), (high, high + 4.0 * rounding(high)))
            if first[0] <= far <= first[1] and self._curve.number(far) is not None
        ]
        if step > STEEP * max(steps, default=0.0) and self.decided(low) and self.decided(high):
            below, above = self._curve.number(low), self._curve.number(high)
            return Solution((low,), (high - low + rounding(low),), "jump", below=below, above=above)
        return self.certified(low, high, first)

    def dip(self, run: Run, i: int) -> list[Solution | None]:
        """Return the roots about a sample that is nearer to the target than both beside it, on the same side."""
        window = run.numbers[i - 1 : i + 2]
        if any(g is None for g in window):
            return []
        left, own, right = (g for g in window if g is not None)
        if not (left * own > 0.0 and own * right > 0.0 and abs(own) <= min(abs(left), abs(right))):
            return []
        low, x, high = run.xs[i - 1 : i + 2]
        places, sizes = self._places(low, x, high), (abs(left), abs(own), abs(right))
        if drop_to_vertex(places, sizes) < (1.0 - DIP) * abs(own) and not reaches_zero(places, sizes):
            return []
        try:
            best = self._least_size(low, x, high, own)
        except UndefinedBetween:
            self.gaps += 1
            return []
        except _Crossed as crossed:
            return [self.between(low, crossed.x), self.between(crossed.x, high)]
        return [self.certified(best, best, (low, high))] if self.is_zero(best, inf) else []

    def _places(self, low: float, middle: float, high: float) -> Three:
        coordinate = self._curve.varied.coordinate
        return coordinate(low), coordinate(middle), coordinate(high)

    def _least_size(self, low: float, x: float, high: float, sign: float) -> float:
        """Return where the figure comes nearest to the target between two inputs; raise `_Crossed` if it passes it."""

        def size(place: float) -> float:
            here = self.g(self._curve.varied.value(place))
            if here * sign < 0.0:
                raise _Crossed(self._curve.varied.value(place))
            return abs(here)

        return self._curve.varied.value(least_of(size, self._places(low, x, high)))

    def nearest(self) -> Nearest | None:
        """Return the input with which the figure comes nearest to the target."""
        xs = [x for x in self._curve.known if self._curve.number(x) is not None]
        if not xs:
            return None
        best = min(xs, key=lambda x: abs(self.g(x)))
        i = xs.index(best)
        if 0 < i < len(xs) - 1:
            try:
                refined = self._least_size(xs[i - 1], best, xs[i + 1], self.g(best))
                best = min((refined, best), key=lambda x: abs(self.g(x)))
            except (UndefinedBetween, _Crossed):
                pass
        value = self._curve.number(best)
        return None if value is None else Nearest((best,), (value,), (self._curve.error(best),))
