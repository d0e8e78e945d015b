"""Curves on logarithmic scales as SVG, written without a library: a figure is an answer too."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass
from html import escape
from math import ceil, floor, log10

SVG = "image/svg+xml"
"""Media type."""

COLOURS = ("#1f4e8c", "#c1440e", "#7a1fa2", "#2a6f4e", "#b8860b", "#008b8b", "#8b2252", "#555555")
"""In the order of the pages, so that a component has one colour."""
LEFT, TOP, WIDTH, HEIGHT = 70.0, 40.0, 560.0, 400.0
MOST_TICKS = 9

Tick = tuple[float, str]
"""A place on an axis (pixels), and what is written there."""


@dataclass(frozen=True)
class Curve:
    """Points that belong together; a point that is not positive has no place on a logarithmic scale and is left out.

    Attributes
    ----------
    label : str
    points : sequence of (float, float)
    emphasised : bool
        Drawn broad and pale, under the others.
    """

    label: str
    points: Sequence[tuple[float, float]]
    emphasised: bool = False


@dataclass(frozen=True)
class Level:
    """A horizontal line across the figure."""

    label: str
    value: float


@dataclass(frozen=True)
class Scale:
    """Decades from `low` to `high` over `length` pixels from `start`, which may run backwards."""

    low: int
    high: int
    start: float
    length: float

    @classmethod
    def over(cls, values: Sequence[float], start: float, length: float) -> Scale:
        """Return the whole decades that hold all positive values."""
        exponents = [log10(value) for value in values if value > 0.0] or [0.0]
        low, high = floor(min(exponents)), ceil(max(exponents))
        return cls(low, max(high, low + 1), start, length)

    def __call__(self, value: float) -> float:
        """Return the place of a value in pixels."""
        return self.at(log10(value))

    def at(self, exponent: float) -> float:
        """Return the place of a power of ten in pixels; the power itself need not be a double."""
        return self.start + self.length * (exponent - self.low) / (self.high - self.low)

    @property
    def exponents(self) -> range:
        """Exponents that are marked."""
        return range(self.low, self.high + 1, ceil((self.high - self.low + 1) / MOST_TICKS))

    def ticks(self) -> Iterator[Tick]:
        """Yield the powers of ten that are marked."""
        for exponent in self.exponents:
            yield self.at(exponent), f'10<tspan dy="-5" font-size="9">{exponent}</tspan>'


def log_log(title: str, across: str, up: str, curves: Sequence[Curve], levels: Sequence[Level] = ()) -> str:
    """Return a figure of curves over two logarithmic axes as an SVG document."""
    shown = [(curve, [(x, y) for x, y in curve.points if x > 0.0 and y > 0.0]) for curve in curves]
    points = [point for _, own in shown for point in own]
    x = Scale.over([px for px, _ in points], LEFT, WIDTH)
    y = Scale.over([py for _, py in points] + [level.value for level in levels], TOP + HEIGHT, -HEIGHT)
    box = (LEFT, TOP, WIDTH, HEIGHT)
    parts = [heading(LEFT, 24, title), *framed(box, across, up, x.ticks(), y.ticks(), 42), *_levels(levels, y)]
    for curve, own in shown:
        if curve.emphasised and own:
            parts.append(_line(own, x, y, "#cccccc", 7.0))
    plain = [(curve, own) for curve, own in shown if not curve.emphasised]
    for k, (curve, own) in enumerate(plain):
        colour = COLOURS[k % len(COLOURS)]
        if own:
            parts.append(_line(own, x, y, colour, 1.2))
        parts += [f'<circle cx="{x(px):.1f}" cy="{y(py):.1f}" r="3" fill="{colour}"/>' for px, py in own]
        height = TOP + 14 + 20 * k
        parts.append(f'<text x="{LEFT + WIDTH + 16:g}" y="{height:g}" fill="{colour}">{escape(curve.label)}</text>')
    return page(840, 500, parts)


def framed(
    box: tuple[float, float, float, float], across: str, up: str, x: Iterable[Tick], y: Iterable[Tick], below: float
) -> Iterator[str]:
    """Yield a frame with its ticks and the names of its axes.

    Parameters
    ----------
    box : tuple of 4 floats
        Left, top, width and height (pixels).
    across, up : str
        Names.
    x, y : iterable of (float, str)
        Places (pixels) and labels; labels are SVG.
    below : float
        Distance of the lower name from the frame (pixels).
    """
    left, top, width, height = box
    bottom, right, middle = top + height, left + width, top + height / 2
    for place, label in x:
        yield f'<line x1="{place:.1f}" y1="{top:g}" x2="{place:.1f}" y2="{bottom:g}" stroke="#eee"/>'
        yield f'<text x="{place:.1f}" y="{bottom + 18:g}" text-anchor="middle" fill="#555">{label}</text>'
    for place, label in y:
        yield f'<line x1="{left:g}" y1="{place:.1f}" x2="{right:g}" y2="{place:.1f}" stroke="#eee"/>'
        yield f'<text x="{left - 8:g}" y="{place:.1f}" dy="4" text-anchor="end" fill="#555">{label}</text>'
    yield f'<rect x="{left:g}" y="{top:g}" width="{width:g}" height="{height:g}" fill="none" stroke="#999"/>'
    yield f'<text x="{left + width / 2:g}" y="{bottom + below:g}" text-anchor="middle">{escape(across)}</text>'
    turned = f'transform="rotate(-90 18 {middle:g})"'
    yield f'<text x="18" y="{middle:g}" {turned} text-anchor="middle">{escape(up)}</text>'


def page(width: float, height: float, parts: Iterable[str]) -> str:
    """Return parts on a white page as an SVG document."""
    return (
        f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {width:g} {height:g}" font-family="sans-serif" '
        f'font-size="13"><rect width="{width:g}" height="{height:g}" fill="white"/>{"".join(parts)}</svg>\n'
    )


def heading(left: float, top: float, title: str) -> str:
    """Return the title of a figure."""
    return f'<text x="{left:g}" y="{top:g}" font-weight="bold">{escape(title)}</text>'


def _levels(levels: Sequence[Level], y: Scale) -> list[str]:
    parts = []
    for level in levels:
        if level.value > 0.0:
            at = f"{y(level.value):.1f}"
            parts.append(
                f'<line x1="{LEFT:g}" y1="{at}" x2="{LEFT + WIDTH:g}" y2="{at}" stroke="black" stroke-dasharray="6 4"/>'
            )
            parts.append(f'<text x="{LEFT + WIDTH + 16:g}" y="{at}" dy="4">{escape(level.label)}</text>')
    return parts


def _line(points: Sequence[tuple[float, float]], x: Scale, y: Scale, colour: str, width: float) -> str:
    places = " ".join(f"{x(px):.1f},{y(py):.1f}" for px, py in points)
    return (
        f'<polyline points="{places}" fill="none" stroke="{colour}" stroke-width="{width:g}" stroke-linejoin="round"/>'
    )
