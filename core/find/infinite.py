"""Where a figure grows beyond all bounds: periods of what just goes round, amplitudes at resonance, speeds of escape.

Beside such a place the logarithm of a figure or the figure itself keeps growing with every halving of the distance, by
steps that do not become smaller. A figure that ends at a finite value has steps that fall with the distance.
"""

from __future__ import annotations

from itertools import pairwise
from math import inf

from core.find.borders import MOST_HALVINGS
from core.find.evaluations import Curve
from core.find.minima import GOLDEN
from core.find.scanning import Run, scanned
from core.find.solutions import Solution
from core.find.varied import beside, neighbours, rounding

OCTAVES = tuple(range(5, 33, 3))
"""Powers of one half of a place, or of the range if that is smaller, at which distances growth is looked at."""

LASTING = 0.5
"""Share of the first steps that the last must have: 1 of a logarithm, more of a power, little of a finite end."""


def unresolved_growth(run: Run, i: int) -> bool:
    """Return whether the figure may have a peak between two samples without their showing it."""
    return run.doubt(i) > 0.25 * run.variation(i)


def infinities_of(curve: Curve) -> list[Solution]:
    """Return where a figure is infinite: between samples, or where it ceases to exist."""
    run = scanned(curve, 0.0, unresolved_growth)
    found: list[Solution] = []
    for i in range(len(run.xs) - 1):
        one, other = run.numbers[i], run.numbers[i + 1]
        if (one is None) != (other is None):
            found += _at_border(curve, run.xs[i], run.xs[i + 1], rising=one is None)
        elif one is not None and other is not None and one * other < 0.0:
            found += _at_pole(curve, run.xs[i], run.xs[i + 1])
    sizes = [None if g is None else abs(g) for g in run.numbers]
    for i in range(1, len(sizes) - 1):
        left, own, right = sizes[i - 1 : i + 2]
        if left is not None and own is not None and right is not None and own >= left and own > right:
            found += _at_peak(curve, run.xs[i - 1], run.xs[i], run.xs[i + 1])
    return _once(sorted(found, key=lambda one: one.inputs))


def _once(found: list[Solution]) -> list[Solution]:
    kept: list[Solution] = []
    for one in found:
        if not kept or one.inputs[0] - kept[-1].inputs[0] > one.errors[0] + kept[-1].errors[0]:
            kept.append(one)
    return kept


def _at_border(curve: Curve, low: float, high: float, *, rising: bool) -> list[Solution]:
    """Return the border of a figure's existence if it grows towards that; `rising` if it exists above."""
    for _ in range(MOST_HALVINGS):
        if neighbours(low, high):
            break
        middle = curve.varied.middle(low, high)
        if (curve.number(middle) is None) == rising:
            low = middle
        else:
            high = middle
    place = high if rising else low
    if not grows(curve, place, 1 if rising else -1):
        return []
    return [
        Solution(
            (place,), (high - low + 2.0 * rounding(place),), "border", below=curve.number(low), above=curve.number(high)
        )
    ]


def _at_pole(curve: Curve, low: float, high: float) -> list[Solution]:
    """Return the place between two inputs where the figure changes its sign through infinity."""
    negative = (curve.number(low) or 0.0) < 0.0
    for _ in range(MOST_HALVINGS):
        if neighbours(low, high):
            break
        middle = curve.varied.middle(low, high)
        number = curve.number(middle)
        if number is None:
            return _at_border(curve, low, middle, rising=False)
        if (number < 0.0) == negative:
            low = middle
        else:
            high = middle
    if not (grows(curve, low, -1) and grows(curve, high, 1)):
        return []
    return [
        Solution(
            (low,), (high - low + 2.0 * rounding(low),), "border", below=curve.number(low), above=curve.number(high)
        )
    ]


def _at_peak(curve: Curve, low: float, middle: float, high: float) -> list[Solution]:
    """Return the place about which the figure grows from both sides, by golden sections down to its errors."""
    first, width = middle, high - low
    for _ in range(MOST_HALVINGS):
        wider_above = high - middle > middle - low
        x = middle + GOLDEN * ((high - middle) if wider_above else (low - middle))
        if x in (low, middle, high):
            break
        number, own = curve.number(x), curve.number(middle)
        if number is None:
            # Exactly at the place, or beside it, there is no figure: its border is the place.
            found = _at_border(curve, *((middle, x) if x > middle else (x, middle)), rising=x < middle)
            if found:
                return found
            break
        if own is None:
            break
        if abs(number) > abs(own):
            low, middle, high = (middle, x, high) if wider_above else (low, x, middle)
        elif wider_above:
            high = x
        else:
            low = x
        if abs(abs(number) - abs(own)) <= curve.error(x) + curve.error(middle) and high - low < 1e-6 * width:
            break
    if first == middle or not (grows(curve, middle, -1) and grows(curve, middle, 1)):
        return []
    below, above = (curve.number(x) for x in beside(middle, high - low))
    return [Solution((middle,), (high - low + 2.0 * rounding(middle),), "border", below=below, above=above)]


def grows(curve: Curve, place: float, side: int) -> bool:
    """Return whether the size of a figure keeps growing towards a place, on one side of it."""
    width = min(curve.varied.most - curve.varied.least, abs(place) or inf)
    sizes = []
    for octave in OCTAVES:
        x = place + side * width * 0.5**octave
        if not curve.varied.least <= x <= curve.varied.most:
            continue
        number = curve.number(x)
        if number is None:
            return False
        sizes.append(abs(number))
    steps = [b - a for a, b in pairwise(sizes)]
    return len(steps) > 3 and all(step > 0.0 for step in steps[2:]) and steps[-1] >= LASTING * steps[len(steps) // 2]
