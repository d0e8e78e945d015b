"""A figure along an input, sampled more closely where its samples do not follow smoothly from those beside them."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from itertools import pairwise
from math import asinh, inf
from statistics import median

from core.find.evaluations import Curve

FIRST = 8
"""Intervals between the first samples: a simple root is then found within 20 questions (docs/finding.md)."""

FINEST = 2.0**-9
"""Share of the range below which samples are not taken more closely to see how a figure runs."""

FINEST_BORDER = 2.0**-30
"""The same beside the border of what has the figure: roots may be close to it."""

SHIFT = 0.25
"""Share of an interval over which the first samples are shifted."""

GOLDEN = 0.6180339887498949
"""The golden ratio less 1, whose multiples modulo 1 are spread most evenly."""

MOST_SAMPLES = 400
"""Questions that are asked to see how a figure runs."""

NOISE = 1e-11
"""Share of a figure that is taken for rounding: a constant figure has no shape to be resolved."""


@dataclass(frozen=True)
class Run:
    """A figure along its input.

    Attributes
    ----------
    xs : list of float
        Ascending.
    numbers : list of float or None
        The figure less what it is compared with; None where there is none.
    shapes : list of float or None
        The same by which it is judged how smoothly they follow one another.
    doubts : list of float
        How far the shape of each is from what follows from its neighbours.
    """

    xs: list[float]
    numbers: list[float | None]
    shapes: list[float | None]
    doubts: list[float]

    def doubt(self, i: int) -> float:
        """Return how much is in doubt between the i-th sample and the next."""
        own = [d for d in self.doubts[i : i + 2] if d < inf]
        return max(own) if own else inf

    def variation(self, i: int) -> float:
        """Return the largest change between neighbours about the i-th interval."""
        window = [g for g in self.shapes[max(i - 1, 0) : i + 3] if g is not None]
        return max((abs(b - a) for a, b in pairwise(window)), default=0.0)


Unresolved = Callable[[Run, int], bool]
"""Whether the interval behind the i-th sample is to be halved."""


def scanned(
    curve: Curve,
    target: float,
    unresolved: Unresolved,
    first: int = FIRST,
    *,
    finest_border: float = FINEST,
    compressed: bool = False,
) -> Run:
    """Return a figure less a target, sampled until every interval is resolved or as narrow as `FINEST`."""
    varied = curve.varied
    for share in first_shares(first):
        curve.value(varied.at_share(share))
    while True:
        run = run_of(curve, target, compressed=compressed)
        wide = []
        for i in range(len(run.xs) - 1):
            at_border = (run.numbers[i] is None) != (run.numbers[i + 1] is None)
            width = varied.width(run.xs[i], run.xs[i + 1])
            if at_border:
                if width > finest_border:
                    wide.append((width, i))
            elif run.numbers[i] is not None and width > FINEST and unresolved(run, i):
                wide.append((width, i))
        room = MOST_SAMPLES - len(run.xs)
        if not wide or room <= 0:
            return run
        for _, i in sorted(wide, reverse=True)[:room]:
            curve.value(varied.middle(run.xs[i], run.xs[i + 1]))


def first_shares(count: int) -> list[float]:
    """Return the shares of the range of first samples: unevenly spaced, so that what oscillates does not hide."""
    inner = [(k + SHIFT * ((k * GOLDEN) % 1.0 - 0.5)) / count for k in range(1, count)]
    return [0.0, *inner, 1.0]


def run_of(curve: Curve, target: float, *, compressed: bool) -> Run:
    """Return all samples of a figure that were taken; `compressed` if magnitudes far from the target say little."""
    xs = curve.known
    found = [curve.number(x) for x in xs]
    numbers = [None if number is None else number - target for number in found]
    places = [curve.varied.coordinate(x) for x in xs]
    shapes, size = numbers, abs(target)
    if compressed:
        scale = size or median([abs(g) for g in numbers if g] or [1.0])
        # What grows over many magnitudes is then as smooth as its logarithm.
        shapes, size = [None if g is None else asinh(g / scale) for g in numbers], 1.0
    return Run(xs, numbers, shapes, [_doubt(places, shapes, i, size) for i in range(len(xs))])


def _doubt(places: Sequence[float], numbers: Sequence[float | None], i: int, size: float) -> float:
    """Return how far a sample is from the polynomial through its neighbours, two on each side as far as there are."""
    own = numbers[i]
    if own is None:
        return inf
    beside = [i + k for side in (-1, 1) for k in _defined(numbers, i, side)]
    if len(beside) < 3 or min(beside) > i or max(beside) < i:
        # At an end: what follows by extrapolation says little.
        return inf
    expected = interpolated([places[k] for k in beside], [numbers[k] or 0.0 for k in beside], places[i])
    doubt = abs(expected - own)
    return doubt if doubt > NOISE * max(abs(own), size) else 0.0


def _defined(numbers: Sequence[float | None], i: int, side: int) -> list[int]:
    """Return the steps to the next two samples on a side, as far as they have the figure."""
    found = []
    for k in (side, 2 * side):
        if not 0 <= i + k < len(numbers) or numbers[i + k] is None:
            break
        found.append(k)
    return found


def interpolated(places: Sequence[float], values: Sequence[float], place: float) -> float:
    """Return the polynomial through some points at another place (Neville's scheme)."""
    row = list(values)
    for level in range(1, len(row)):
        for k in range(len(row) - level):
            left, right = places[k], places[k + level]
            row[k] = ((place - right) * row[k] + (left - place) * row[k + 1]) / (left - right)
    return row[0]


def widest(curve: Curve) -> float:
    """Return the widest interval between neighbouring samples, in the unit of the input."""
    known = curve.known
    return max((b - a for a, b in pairwise(known)), default=curve.varied.most - curve.varied.least)
