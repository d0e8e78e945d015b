"""Lines, arcs and letters of a figure as SVG, in pixels with y upwards."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from html import escape
from math import cos, hypot, sin

Point = tuple[float, float]


def polar(start: Point, length: float, angle: float) -> Point:
    """Return the point at a distance from another, in a direction from the horizontal (rad)."""
    return start[0] + length * cos(angle), start[1] + length * sin(angle)


@dataclass
class Drawing:
    """A figure of a size in pixels."""

    width: float
    height: float
    parts: list[str] = field(default_factory=list)

    def line(
        self, *points: Point, colour: str = "#333", width: float = 1.5, dash: str = "", fill: str = "none"
    ) -> None:
        """Draw a line through points."""
        places = " ".join(f"{x:.1f},{self.height - y:.1f}" for x, y in points)
        dashed = f' stroke-dasharray="{dash}"' if dash else ""
        self.parts.append(
            f'<polyline points="{places}" fill="{fill}" stroke="{colour}" stroke-width="{width:g}"{dashed} '
            'stroke-linejoin="round"/>'
        )

    def circle(
        self, center: Point, radius: float, colour: str = "#333", fill: str = "none", width: float = 1.5
    ) -> None:
        """Draw a circle."""
        x, y = center
        self.parts.append(
            f'<circle cx="{x:.1f}" cy="{self.height - y:.1f}" r="{radius:.1f}" fill="{fill}" stroke="{colour}" '
            f'stroke-width="{width:g}"/>'
        )

    def arc(self, center: Point, radius: float, start: float, end: float, **style: object) -> None:
        """Draw a part of a circle, counter-clockwise between two angles."""
        count = max(2, int(40 * abs(end - start)))
        angles = [start + (end - start) * i / count for i in range(count + 1)]
        self.line(*(polar(center, radius, angle) for angle in angles), **style)  # type: ignore[arg-type]

    def arrow(self, start: Point, end: Point, colour: str = "#c1440e", width: float = 2.0) -> None:
        """Draw an arrow."""
        self.line(start, end, colour=colour, width=width)
        length = hypot(end[0] - start[0], end[1] - start[1])
        along = ((end[0] - start[0]) / length, (end[1] - start[1]) / length)
        back = (end[0] - 10 * along[0], end[1] - 10 * along[1])
        sides = [(back[0] - s * 4 * along[1], back[1] + s * 4 * along[0]) for s in (1, -1)]
        self.line(sides[0], end, sides[1], sides[0], colour=colour, width=1, fill=colour)

    def text(self, at: Point, words: str, colour: str = "#222", anchor: str = "middle", size: float = 15) -> None:
        """Write words."""
        x, y = at
        self.parts.append(
            f'<text x="{x:.1f}" y="{self.height - y:.1f}" dy="5" fill="{colour}" text-anchor="{anchor}" '
            f'font-size="{size:g}">{escape(words)}</text>'
        )

    def cone(self, apex: Point, axis: float, half_angle: float, height: float, colour: str) -> None:
        """Draw a cone about an axis of the plane (rad), its base as an ellipse."""
        half = height * sin(half_angle) / cos(half_angle)
        middle = polar(apex, height, axis)
        self.line(polar(middle, half, axis + 1.5707963), apex, polar(middle, half, axis - 1.5707963), colour=colour)
        ring: Sequence[Point] = [
            polar(polar(middle, half * cos(0.1 * i), axis + 1.5707963), 0.22 * half * sin(0.1 * i), axis)
            for i in range(64)
        ]
        self.line(*ring, colour=colour, width=1, fill=f"{colour}22")

    def document(self) -> str:
        """Return the figure as an SVG document."""
        return (
            f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {self.width:g} {self.height:g}" '
            f'font-family="sans-serif"><rect width="{self.width:g}" height="{self.height:g}" fill="white"/>'
            + "".join(self.parts)
            + "</svg>\n"
        )
