"""Two outlines of the plane that do not pass one another: every corner of one meets the edges and corners of the other.

Two convex polygons that are apart first touch at a corner of one of them. A corner is outside a polygon as long as its
height above one of the edges is above zero, whichever that is; it touches one edge between the ends of that. With radii
there are arcs about corners between the edges. Which part a corner may meet at a time is chosen from these facets
(`core.multibody.table.facing`).

References
----------
M. C. Lin, J. F. Canny, "A fast algorithm for incremental distance calculation" (1991).
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from functools import partial

from core.balls import as_text
from core.errors import Path, PlacesDisagree
from core.multibody.algebra.directions import unit
from core.multibody.algebra.polynomials import (
    ONE,
    ZERO,
    Ball,
    Poly,
    change_by,
    combined,
    constant,
    difference,
    dot,
    evaluated,
    is_zero,
)
from core.multibody.table.connection_effects import Facet, Unilateral
from core.multibody.table.contact_places import Side
from core.multibody.table.frames import Point
from core.multibody.table.measures import Measures
from core.multibody.table.scene_sizes import sizes
from core.multibody.table.touching_in_plane import circle, face

OVERLAP = 1e-9
"""Depth of an overlap beside the places that it is formed of, up to which it is their rounding."""


@dataclass(frozen=True)
class _Edge:
    """An edge from one corner to the next: unit vectors along it and outwards in body axes, and its first corner."""

    along: Sequence[Ball]
    normal: Sequence[Ball]
    number: int


def outlines(measures: Measures, a: Side, b: Side, common: Unilateral, path: Path) -> list[Unilateral]:
    """Return the contacts of the corners of two outlines, first those of `a`, then those of `b`.

    Raises
    ------
    PlacesDisagree
        Where they overlap at the start, with the depth.
    """
    if not measures.loose:
        _require_apart(measures, a, b, common.name, path)
    if b.single:
        return list(_against(measures, b, a, common, path))
    found = list(_against(measures, a, b, common, path))
    return found if a.single else [*found, *_against(measures, b, a, replace(common, first=False), path)]


def _against(measures: Measures, a: Side, b: Side, common: Unilateral, path: Path) -> Iterator[Unilateral]:
    """Yield the contacts of the corners of one outline with the edges and corners of another.

    Where two corners of round outlines meet, that is a contact of the first outline alone.
    """
    rubs, reach, edges = not is_zero(common.static), a.radius + b.radius, _edges(b, path)
    vector = partial(measures.coordinates.vector_of, path=path)
    lines = [vector(b.body, edge.along) for edge in edges]
    for i, point in enumerate(a.points):
        before = [dot(line, _apart(point, b.points[edge.number])) for line, edge in zip(lines, edges, strict=True)]
        after = [
            dot(line, _apart(b.points[(edge.number + 1) % len(edges)], point))
            for line, edge in zip(lines, edges, strict=True)
        ]
        own = [] if a.single else [vector(a.body, side) for side in _sides(a, i)]
        facets = []
        for k, edge in enumerate(edges):
            offset = [x + b.radius * y for x, y in zip(b.offsets[k], edge.normal, strict=True)]
            at = measures.coordinates.carried(str(b.body), offset, path)
            gap, slip = face(measures, (point, a.radius), at, edge.normal, path, rubs=rubs)
            sides = []
            if is_zero(reach) and not a.single:
                normal = vector(b.body, edge.normal)
                sides = [(dot(normal, side), dot(lines[k], side)) for side in own]
            facets.append(Facet(gap, slip, (before[k], after[k]), tuple(sides), edge=True))
        for k in range(len(edges)) if not is_zero(reach) else ():
            # Beyond the end of the edge before, and before the beginning of that after.
            region = (_negative(after[k - 1]), _negative(before[k]))
            gap, slip = constant(ONE), {} if rubs else None
            if common.first:
                gap, turned = circle(measures, (point, a.radius), (b.points[k], b.radius), path, rubs=rubs)
                # Along the outline in the sense in which it is on an edge.
                slip = None if turned is None else {j: _negative(poly) for j, poly in turned.items()}
            facets.append(Facet(gap, slip, region))
        yield replace(common, gap=facets[0].gap, slip=facets[0].slip, facets=tuple(facets))


def _edges(side: Side, path: Path) -> list[_Edge]:
    """Return the edges of an outline; a segment has one on either side."""
    count = len(side.offsets)
    found = []
    for k in range(count):
        span = [y - x for x, y in zip(side.offsets[k], side.offsets[(k + 1) % count], strict=True)]
        along = unit(span, path)
        found.append(_Edge(along, [along[1], -along[0]], k))
    return found


def _sides(side: Side, i: int) -> list[list[Ball]]:
    """Return the vectors from a corner to those beside it, in body axes."""
    count = len(side.offsets)
    here = side.offsets[i]
    return [[y - x for x, y in zip(here, side.offsets[(i + step) % count], strict=True)] for step in (1, -1)]


def _apart(a: Point, b: Point) -> list[Poly]:
    return [difference(x, y) for x, y in zip(a.at, b.at, strict=True)]


def _negative(poly: Poly) -> Poly:
    return combined((-ONE, poly))


def _require_apart(measures: Measures, a: Side, b: Side, name: str, path: Path) -> None:
    """Raise unless a line along an edge parts the polygons within two outlines: corners alone do not show a cross."""
    if a.single or b.single:
        return
    q = measures.table.q
    deepest, scale, extents = None, ZERO, sizes(measures.table, q)
    for one, other in ((a, b), (b, a)):
        for edge in _edges(one, path):
            # What has no width is parted by a line across its ends, too.
            directions = [edge.normal] if len(one.points) > 2 else [edge.normal, edge.along]
            for direction in directions:
                line = measures.coordinates.vector_of(one.body, direction, path)
                start = one.points[edge.number] if direction is edge.normal else one.points[edge.number - 1]
                heights = [dot(line, _apart(point, start)) for point in other.points]
                least = min((evaluated(x, q) for x in heights), key=lambda x: float(x.mid()))
                scale = max(scale, *(change_by(x, q, extents) for x in heights), key=lambda x: float(x.mid()))
                if deepest is None or least > deepest:
                    deepest = least
    if deepest is not None and deepest < -OVERLAP * scale:
        raise PlacesDisagree(
            path,
            f'start with what cannot overlap apart: "{name}" is missed by {as_text(a.radius + b.radius - deepest, 3)}',
            remedy="move the bodies apart",
        )
