"""Curves over linear axes as SVG, in panels below one another."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from html import escape
from math import ceil, floor, log10

import numpy as np

from core.arrays import Floats
from service.responses.svg import COLOURS, Tick, framed, heading, page, stroke

LEFT, TOP, WIDTH, HEIGHT = 80.0, 50.0, 520.0, 260.0
SQUARE = 520.0
"""Height of a panel in which both axes have one scale."""
GAP, PAGE = 70.0, 870.0
SAMPLE = 34.0
"""Length of the piece of a curve that stands before its label, in pixels."""
MOST_LABELS = 16
MOST_POINTS = 4000
"""Points of one curve; of more, every second, third ... is drawn."""


@dataclass(frozen=True)
class Line:
    """Points that belong together, each coordinate of shape (n,), joined by a curve or, as `dots`, each for itself."""

    label: str
    x: Floats
    y: Floats
    dots: bool = False


@dataclass(frozen=True)
class Panel:
    """Lines over two axes.

    Attributes
    ----------
    across, up : str
        Names of the axes.
    lines : sequence of Line
    one_scale : bool
        Whether a length is as long on either axis.
    """

    across: str
    up: str
    lines: Sequence[Line]
    one_scale: bool = False

    @property
    def height(self) -> float:
        """In pixels, without what stands around the axes."""
        return SQUARE if self.one_scale else HEIGHT


@dataclass(frozen=True)
class Axis:
    """From values to pixels; values are divided by a power of ten first, so that their differences are doubles."""

    low: float
    high: float
    exponent: int
    start: float
    length: float

    @classmethod
    def over(cls, values: Floats, start: float, length: float) -> Axis:
        """Return the axis that holds all values, with a margin where they are one."""
        largest = float(np.max(np.abs(values), initial=0.0))
        exponent = floor(log10(largest)) if largest > 0.0 else 0
        shares = _divided(values, exponent) if len(values) else np.zeros(1)
        low, high = float(shares.min()), float(shares.max())
        if not high - low > 1e-9:
            low, high = low - 1.0, high + 1.0
        return cls(low, high, exponent, start, length)

    def widened(self, width: float) -> Axis:
        """Return the axis about the same middle with another width, in units of its power of ten."""
        middle = 0.5 * (self.low + self.high)
        return Axis(middle - 0.5 * width, middle + 0.5 * width, self.exponent, self.start, self.length)

    def at(self, values: Floats) -> Floats:
        """Return the places of values in pixels."""
        found: Floats = self.start + self.length * (_divided(values, self.exponent) - self.low) / (self.high - self.low)
        return found

    def ticks(self) -> Iterator[Tick]:
        """Yield round values as places in pixels, with their labels."""
        width = self.high - self.low
        step = 10.0 ** floor(log10(width / 4))
        step *= next(factor for factor in (1, 2, 5, 10) if width / (factor * step) <= 8)
        for k in range(ceil(self.low / step), floor(self.high / step) + 1):
            place = self.start + self.length * (k * step - self.low) / width
            plain = -4 <= self.exponent <= 4
            yield place, f"{k * step * 10.0**self.exponent:.6g}" if plain else f"{k * step:.6g}e{self.exponent}"


def panels(title: str, shown: Sequence[Panel]) -> str:
    """Return a figure of panels as an SVG document."""
    parts, top = [heading(LEFT, 24, title)], TOP
    for panel in shown:
        parts.extend(_drawn(panel, top))
        top += panel.height + GAP
    return page(PAGE, top, parts)


def _drawn(panel: Panel, top: float) -> Iterator[str]:
    x = Axis.over(np.concatenate([line.x for line in panel.lines] or [np.zeros(0)]), LEFT, WIDTH)
    y = Axis.over(np.concatenate([line.y for line in panel.lines] or [np.zeros(0)]), top + panel.height, -panel.height)
    if panel.one_scale:
        x, y = _alike(x, y)
    box = (LEFT, top, WIDTH, panel.height)
    yield from framed(box, panel.across, panel.up, x.ticks(), y.ticks(), 38)
    for k, line in enumerate(panel.lines):
        colour = COLOURS[k % len(COLOURS)]
        every = slice(None, None, max(1, ceil(len(line.x) / MOST_POINTS)))
        places = [*zip(x.at(line.x[every]).tolist(), y.at(line.y[every]).tolist(), strict=True)]
        if line.dots:
            yield from (f'<circle cx="{px:.1f}" cy="{py:.1f}" r="1.5" fill="{colour}"/>' for px, py in places)
            continue
        points = " ".join(f"{px:.1f},{py:.1f}" for px, py in places)
        yield f'<polyline points="{points}" fill="none" {stroke(k)} stroke-width="1.2" stroke-linejoin="round"/>'
        if len(line.x) == 1:
            yield f'<circle cx="{points.partition(",")[0]}" cy="{points.partition(",")[2]}" r="3" fill="{colour}"/>'
        if k < MOST_LABELS:
            height, start = top + 14 + 18 * k, LEFT + WIDTH + 10
            if line.label:
                sample = f'x1="{start:g}" y1="{height - 4:g}" x2="{start + SAMPLE:g}" y2="{height - 4:g}"'
                yield f'<line {sample} {stroke(k)} stroke-width="1.2"/>'
            yield f'<text x="{start + SAMPLE + 6:g}" y="{height:g}" fill="{colour}">{escape(line.label)}</text>'


def _alike(x: Axis, y: Axis) -> tuple[Axis, Axis]:
    """Return two axes with one scale."""
    exponent = max(x.exponent, y.exponent)
    x, y = (_in_unit(axis, exponent) for axis in (x, y))
    scale = max((x.high - x.low) / abs(x.length), (y.high - y.low) / abs(y.length))
    return x.widened(scale * abs(x.length)), y.widened(scale * abs(y.length))


def _in_unit(axis: Axis, exponent: int) -> Axis:
    factor = 10.0 ** max(axis.exponent - exponent, -300)
    return Axis(axis.low * factor, axis.high * factor, exponent, axis.start, axis.length)


def _divided(values: Floats, exponent: int) -> Floats:
    # Two factors, of which neither leaves the range of doubles.
    half = exponent // 2
    found: Floats = values / 10.0**half / 10.0 ** (exponent - half)
    return found
