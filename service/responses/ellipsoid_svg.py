"""The energy ellipsoid with the curves on it as SVG, seen from a fixed direction without perspective.

An ellipsoid x = M u, |u| = 1, is seen as the ellipse P M u, P the projection: its outline is the boundary of
{P M u}, whose matrix is (P M)(P M)^T. A point is in front where its outward normal, along M^-T u, turns to the viewer.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from decimal import Decimal
from html import escape
from math import atan2, cos, degrees, pi, radians, sin
from typing import Any

import numpy as np
from numpy.typing import NDArray

from core.arrays import Floats
from service.responses.svg import COLOURS, heading, page

AZIMUTH, ELEVATION = radians(32.0), radians(24.0)
"""Of the viewer, from the body's x axis about z, and above the plane of x and y."""

CENTER, HALF = (330.0, 270.0), 200.0
"""Middle of the drawing and half its extent (pixels)."""

BEYOND = 0.28
"""Length of an axis outside of the surface, over the largest semi-axis."""

FRONT, BACK = 'stroke-width="1.6"', 'stroke-width="1" stroke-opacity="0.35"'


@dataclass(frozen=True)
class View:
    """The surface as it is seen.

    Attributes
    ----------
    axes : ndarray, shape (3, 3)
        Columns are the principal axes, in body axes.
    semi_axes : ndarray, shape (3,)
        In units of the largest.
    """

    axes: Floats
    semi_axes: Floats

    @property
    def towards(self) -> Floats:
        """Unit vector to the viewer, in body axes."""
        return np.array([cos(ELEVATION) * cos(AZIMUTH), cos(ELEVATION) * sin(AZIMUTH), sin(ELEVATION)])

    @property
    def screen(self) -> Floats:
        """Unit vectors to the right and up, shape (2, 3)."""
        right = np.array([-sin(AZIMUTH), cos(AZIMUTH), 0.0])
        return np.stack([right, np.cross(self.towards, right)])

    def on_surface(self, unit: Floats) -> Floats:
        """Return the points of the surface that unit vectors along the principal axes, shape (n, 3), are mapped to."""
        points: Floats = (unit * self.semi_axes) @ self.axes.T
        return points

    def in_front(self, points: Floats) -> NDArray[np.bool_]:
        """Return which points of the surface, shape (n, 3), the viewer sees."""
        least = self.semi_axes.min()
        unit = (points @ self.axes) / self.semi_axes
        seen: NDArray[np.bool_] = (unit * (least / self.semi_axes)) @ (self.axes.T @ self.towards) >= 0.0
        return seen

    def places(self, points: Floats) -> Floats:
        """Return places on the page, shape (n, 2), in pixels."""
        flat = points @ self.screen.T
        return np.stack(
            [CENTER[0] + HALF / self.extent * flat[:, 0], CENTER[1] - HALF / self.extent * flat[:, 1]], axis=1
        )

    @property
    def extent(self) -> float:
        """Largest distance from the middle of what is drawn, in units of the largest semi-axis."""
        ends = np.array([self.end_of(k) for k in range(3)]) @ self.screen.T
        return max(float(np.abs(ends).max()), float(np.sqrt(np.diag(self.outline_matrix)).max()))

    def end_of(self, k: int) -> Floats:
        """Return the end of a principal axis, outside of the surface."""
        end: Floats = (self.semi_axes[k] + BEYOND) * self.axes[:, k]
        return end

    @property
    def outline_matrix(self) -> Floats:
        """(P M)(P M)^T, shape (2, 2)."""
        flat = self.screen @ (self.axes * self.semi_axes)
        matrix: Floats = flat @ flat.T
        return matrix


def ellipsoid_figure(answer: Mapping[str, Any]) -> bytes:
    """Return the answer to a question about an energy ellipsoid, in doubles or in numerals, as an SVG document."""
    semi = [Decimal(x) for x in answer["semi_axes"]]
    unit = max(semi)
    # A needle that no double can show beside its length is drawn as thin as one can.
    view = View(
        np.array([[float(x) for x in row] for row in answer["axes"]]),
        np.array([max(float(x / unit), 1e-12) for x in semi]),
    )
    curves = [
        (curve["regime"], _in_units(curve["points"], unit))
        for curve in (*(answer.get("polhodes") or ()), *(answer.get("separatrix") or ()))
    ]
    regimes = list(dict.fromkeys(regime for regime, _ in curves))
    colour = {regime: COLOURS[k % len(COLOURS)] for k, regime in enumerate(sorted(regimes))}
    colour["separatrix"] = "black"
    parts = [
        heading(30, 30, f"Energy ellipsoid, E = {Decimal(answer['energy']):.4g} J"),
        *_axes(view, semi, away=True),
        _outline(view),
        *_graticule(view),
    ]
    for front in (False, True):
        for regime, points in curves:
            parts += _curve(view, points, colour[regime], front)
    parts += _axes(view, semi, away=False)
    for k, regime in enumerate(regimes):
        count = sum(regime == other for other, _ in curves)
        label = regime if regime == "separatrix" or count == 1 else f"{regime} ({count})"
        y = 70 + 22 * k
        parts.append(
            f'<line x1="670" y1="{y - 4}" x2="694" y2="{y - 4}" stroke="{colour[regime]}" stroke-width="2.5"/>'
        )
        parts.append(f'<text x="702" y="{y}" fill="{colour[regime]}">{escape(label)}</text>')
    return page(1080, 540, parts).encode()


def _in_units(points: Any, unit: Decimal) -> Floats:
    return np.array([[float(Decimal(x) / unit) for x in point] for point in np.asarray(points).tolist()])


def _outline(view: View) -> str:
    values, vectors = np.linalg.eigh(view.outline_matrix)
    b, a = (HALF / view.extent * float(np.sqrt(max(0.0, x))) for x in values)
    turn = -degrees(atan2(float(vectors[1, 1]), float(vectors[0, 1])))
    x, y = CENTER
    return (
        f'<ellipse cx="{x:g}" cy="{y:g}" rx="{a:.2f}" ry="{b:.2f}" transform="rotate({turn:.2f} {x:g} {y:g})" '
        'fill="#f4f1ea" stroke="#777" stroke-width="1.2"/>'
    )


def _graticule(view: View) -> Iterator[str]:
    """Yield circles of latitude and longitude of the sphere that the surface is stretched from, as far as in front."""
    around = np.linspace(0.0, 2.0 * pi, 97)
    c, s = np.cos(around), np.sin(around)
    rings = [
        np.stack([cos(b) * c, cos(b) * s, np.full_like(c, sin(b))], axis=1) for b in np.linspace(-pi / 3, pi / 3, 5)
    ]
    rings += [np.stack([c * cos(b), c * sin(b), s], axis=1) for b in np.linspace(0.0, pi, 6, endpoint=False)]
    for ring in rings:
        points = view.on_surface(ring)
        for run in _runs(points, view.in_front(points), front=True):
            yield _line(view, run, "#d9d3c5", 'stroke-width="0.7"')


def _curve(view: View, points: Floats, colour: str, front: bool) -> Iterator[str]:
    seen = view.in_front(points)
    if len(points) == 1:
        if bool(seen[0]) == front:
            x, y = view.places(points)[0]
            yield f'<circle cx="{x:.1f}" cy="{y:.1f}" r="4" fill="{colour}" fill-opacity="{1 if front else 0.35}"/>'
        return
    for run in _runs(points, seen, front):
        yield _line(view, run, colour, FRONT if front else BACK)


def _runs(points: Floats, seen: NDArray[np.bool_], front: bool) -> Iterator[Floats]:
    """Yield the pieces of a curve whose segments are in front, or behind: a segment is where its first point is."""
    own = seen[:-1] == front
    edges = np.flatnonzero(np.diff(np.concatenate([[False], own, [False]]).astype(np.int8)))
    for first, last in zip(edges[::2], edges[1::2], strict=True):
        yield points[first : last + 1]


def _axes(view: View, semi: Sequence[Decimal], away: bool) -> Iterator[str]:
    along_body = np.array_equal(view.axes, np.eye(3))
    order = sorted(set(semi))
    for k in range(3):
        if (float(view.axes[:, k] @ view.towards) < 0.0) != away:
            continue
        tip, end = view.places(np.stack([view.semi_axes[k] * view.axes[:, k], view.end_of(k)]))
        origin = view.places(np.zeros((1, 3)))[0]
        dashed = 'stroke-width="0.8" stroke-dasharray="3 3" stroke-opacity="0.6"'
        yield from (_segment(origin, tip, dashed), _segment(tip, end, 'stroke-width="1.2"'))
        x, y = end + 12.0 * (end - origin) / max(1.0, float(np.hypot(*(end - origin))))
        if y < end[1]:
            # Its second line is written below the first.
            y -= 15.0
        # The longer the semi-axis, the smaller the moment.
        rank = {order[0]: "largest moment", order[-1]: "smallest moment"}.get(semi[k], "middle moment")
        note = f'<tspan x="{x:.1f}" dy="15">{rank}</tspan>' if len(order) == 3 else ""
        name = "xyz"[k] if along_body else f"axis {k + 1}"
        anchor = "start" if x > CENTER[0] + 20 else "end" if x < CENTER[0] - 20 else "middle"
        yield (
            f'<text x="{x:.1f}" y="{y:.1f}" dy="4" text-anchor="{anchor}">&#969; {name}'
            f'<tspan fill="#777" font-size="11">, {semi[k]:.4g} rad/s{note}</tspan></text>'
        )


def _segment(start: Floats, end: Floats, style: str) -> str:
    return f'<line x1="{start[0]:.1f}" y1="{start[1]:.1f}" x2="{end[0]:.1f}" y2="{end[1]:.1f}" stroke="#333" {style}/>'


def _line(view: View, points: Floats, colour: str, style: str) -> str:
    places = " ".join(f"{x:.1f},{y:.1f}" for x, y in view.places(points).tolist())
    return f'<polyline points="{places}" fill="none" stroke="{colour}" {style} stroke-linejoin="round"/>'
