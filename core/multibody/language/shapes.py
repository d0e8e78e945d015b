"""Shapes of bodies: their outlines in the plane, their corners in space, and the inertia of homogeneous solids.

An outline is a convex polygon with everything within a radius of it: a disc has one corner and a radius, a capsule two,
a box four and no radius. What touches are then corners, edges and arcs, whatever the shape. In space there may be an
ellipsoid about every corner in place of a ball: the rim of a disc is one whose third semi-axis is zero, and a cylinder
has two of them.

References
----------
J. L. Meriam, L. G. Kraige, "Engineering Mechanics: Dynamics", appendix B ("Mass moments of inertia of homogeneous
bodies"). C. Steger, "On the calculation of arbitrary moments of polygons" (1996).
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from itertools import product
from typing import Any

from flint import arb

from core.errors import InvalidParameter, Path
from core.multibody.algebra.polynomials import ZERO, Ball, is_zero
from core.multibody.language.numerals import Numerals, member
from core.near_names import did_you_mean

MOST_CORNERS = 32
"""Corners of a polygon: each is a contact of its own, and is compared with every edge of what it may touch."""

CENTRED = 1e-9
"""Distance of a centroid from the centre of mass, beside the size of a polygon, that is the rounding of its corners."""

Corner = tuple[Ball, ...]
"""A point in body axes from the centre of mass (m)."""


@dataclass(frozen=True)
class Outline:
    """The points within a radius of a convex polygon, or of a segment or a point.

    Attributes
    ----------
    corners : sequence of tuple of ball
        In body axes from the centre of mass (m); in the plane counter-clockwise.
    radius : ball
        m.
    semi_axes : tuple of ball
        Of the ellipsoid about every corner, along the body axes (m); none where there is a ball.
    """

    corners: Sequence[Corner]
    radius: Ball = ZERO
    semi_axes: tuple[Ball, ...] = ()


@dataclass(frozen=True)
class Shape:
    """A shape as it was written, with its numbers read.

    Attributes
    ----------
    kind : str
    outline : Outline
    moments : tuple of ball
        Of the homogeneous solid about its centre, over its mass (m^2): one in the plane; in space about the body axes.
    centroid : tuple of ball
        Of the solid, in body axes from the centre of mass (m).
    """

    kind: str
    outline: Outline
    moments: tuple[Ball, ...]
    centroid: Corner

    @property
    def round(self) -> bool:
        """Whether it is a disc of the plane or a ball."""
        return len(self.outline.corners) == 1 and not self.outline.semi_axes

    @property
    def centred(self) -> bool:
        """Whether the centre of the solid is the centre of mass, up to the rounding of its corners."""
        terms = [abs(float(x)) for corner in (*self.outline.corners, self.outline.semi_axes) for x in corner]
        size = max(terms, default=0.0) + float(self.outline.radius)
        return all(is_zero(x) or bool(abs(x) < CENTRED * size) for x in self.centroid)


def shape_of(written: object, numerals: Numerals, path: Path, dimension: int) -> Shape:
    """Return a shape with its numbers.

    Raises
    ------
    InvalidParameter
        For a shape that does not exist or has not these fields, and for sizes that cannot be.
    """
    if not isinstance(written, Mapping):
        raise InvalidParameter(path, "be an object", remedy='such as {"kind": "box", "width": 0.2, "height": 0.1}')
    kinds = IN_PLANE if dimension == 2 else IN_SPACE
    kind = written.get("kind")
    if isinstance(kind, str) and kind in ALL and kind not in kinds:
        where = "plane" if dimension == 2 else "space"
        rule = f"be one of {', '.join(kinds)} in {'the ' if dimension == 2 else ''}{where}"
        raise InvalidParameter((*path, "kind"), rule)
    if not isinstance(kind, str) or kind not in kinds:
        raise InvalidParameter((*path, "kind"), f"be one of {', '.join(kinds)}", remedy=did_you_mean(kind, kinds))
    sizes, read = kinds[kind]
    known = (*sizes, *(("depth",) if kind == "box" and dimension == 2 else ()), "at", "kind")
    for key in written:
        if key not in known:
            rule = f"be left out; the fields here are {', '.join(known)}"
            raise InvalidParameter(member(path, key), rule, remedy=did_you_mean(key, known))
    for key in sizes:
        if key not in written:
            raise InvalidParameter((*path, key), "be given")
    at = (ZERO,) * dimension
    if written.get("at") is not None:
        at = numerals.vector(written["at"], (*path, "at"), dimension)
    return read(_Reader(kind, written, numerals, path), at)


@dataclass(frozen=True)
class _Reader:
    """Reads the sizes of one shape."""

    kind: str
    written: Mapping[str, Any]
    numerals: Numerals
    path: Path

    def size(self, name: str) -> Ball:
        """Return a length greater than zero."""
        found = self.numerals.number(self.written[name], (*self.path, name))
        if not found > 0:
            raise InvalidParameter((*self.path, name), "be greater than 0 m")
        return found

    def shape(self, at: Corner, corners: Sequence[Corner], radius: Ball, *moments: Ball) -> Shape:
        """Return a shape from corners counted from its centre."""
        moved = [tuple(x + y for x, y in zip(corner, at, strict=True)) for corner in corners]
        return Shape(self.kind, Outline(moved, radius), moments, at)

    def rounded(self, at: Corner, corners: Sequence[Corner], semi_axes: tuple[Ball, ...], *moments: Ball) -> Shape:
        """Return a shape with an ellipsoid about every corner; one of equal semi-axes is a ball."""
        found = self.shape(at, corners, semi_axes[0], *moments)
        if all(is_zero(x - semi_axes[0]) for x in semi_axes):
            return found
        return replace(found, outline=replace(found.outline, radius=ZERO, semi_axes=semi_axes))


def _disc(read: _Reader, at: Corner) -> Shape:
    r = read.size("radius")
    return read.shape(at, [(ZERO, ZERO)], r, r * r / 2)


def _box(read: _Reader, at: Corner) -> Shape:
    w, h = read.size("width"), read.size("height")
    if read.written.get("depth") is not None:
        read.size("depth")
    x, y = w / 2, h / 2
    return read.shape(at, [(-x, -y), (x, -y), (x, y), (-x, y)], ZERO, (w * w + h * h) / 12)


def _capsule(read: _Reader, at: Corner) -> Shape:
    """Return a stadium: a rectangle between two half discs, whose centroids are 4 r/(3 pi) beyond their centres."""
    r, span = read.size("radius"), read.size("length")
    middle, caps, half = 2 * r * span, arb.pi() * r * r, span / 2
    of_middle = (span * span + 4 * r * r) / 12
    of_caps = r * r / 2 + half * half + 2 * half * (4 * r / (3 * arb.pi()))
    moment = (middle * of_middle + caps * of_caps) / (middle + caps)
    return read.shape(at, [(-half, ZERO), (half, ZERO)], r, moment)


def _polygon(read: _Reader, at: Corner) -> Shape:
    given, path = read.written["corners"], (*read.path, "corners")
    if isinstance(given, (str, Mapping)) or not isinstance(given, Sequence) or not 3 <= len(given) <= MOST_CORNERS:
        raise InvalidParameter(path, f"be a list of 3 to {MOST_CORNERS} places")
    corners = [read.numerals.vector(corner, (*path, i), 2) for i, corner in enumerate(given)]
    count = len(corners)
    for k in range(count):
        for j in range(2, count):
            i = (k + j) % count
            if not _cross(corners[k], corners[(k + 1) % count], corners[i]) > 0:
                raise InvalidParameter(
                    (*path, i),
                    "be on the left of every edge: a polygon is convex, and its corners go counter-clockwise",
                    remedy="split a shape that is not convex into several bodies that are welded together",
                )
    pairs = list(zip(corners, [*corners[1:], corners[0]], strict=True))
    areas = [p[0] * q[1] - p[1] * q[0] for p, q in pairs]
    area = sum(areas, ZERO)
    sums = [sum((a * (p[i] + q[i]) for a, (p, q) in zip(areas, pairs, strict=True)), ZERO) for i in (0, 1)]
    centre = tuple(x / (3 * area) for x in sums)
    second = sum(
        (
            a * sum((p[i] * p[i] + p[i] * q[i] + q[i] * q[i] for i in (0, 1)), ZERO)
            for a, (p, q) in zip(areas, pairs, strict=True)
        ),
        ZERO,
    ) / (6 * area)
    moment = second - sum((x * x for x in centre), ZERO)
    moved = read.shape(at, corners, ZERO, moment)
    return Shape(moved.kind, moved.outline, moved.moments, tuple(x + y for x, y in zip(centre, at, strict=True)))


def _cross(a: Corner, b: Corner, c: Corner) -> Ball:
    """Return twice the area of a triangle, positive where its corners go counter-clockwise."""
    return (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])


def _ball(read: _Reader, at: Corner) -> Shape:
    r = read.size("radius")
    return read.shape(at, [(ZERO, ZERO, ZERO)], r, *[2 * r * r / 5] * 3)


def _box_in_space(read: _Reader, at: Corner) -> Shape:
    a, b, c = (read.size(name) for name in ("width", "height", "depth"))
    below = [(-1, -1), (1, -1), (1, 1), (-1, 1)]
    corners = [(x * a / 2, y * b / 2, z * c / 2) for z, (x, y) in product((-1, 1), below)]
    squares = [a * a, b * b, c * c]
    return read.shape(at, corners, ZERO, *((sum(squares, ZERO) - x) / 12 for x in squares))


def _capsule_in_space(read: _Reader, at: Corner) -> Shape:
    """Return a cylinder along z between two half balls, whose centroids are 3 r/8 beyond their centres."""
    r, span = read.size("radius"), read.size("length")
    half = span / 2
    # Volumes over pi r^2.
    middle, caps = span, 4 * r / 3
    across = middle * (r * r / 4 + span * span / 12) + caps * (2 * r * r / 5 + half * half + 2 * half * (3 * r / 8))
    along = middle * r * r / 2 + caps * 2 * r * r / 5
    moments = [x / (middle + caps) for x in (across, across, along)]
    return read.shape(at, [(ZERO, ZERO, -half), (ZERO, ZERO, half)], r, *moments)


def _disc_in_space(read: _Reader, at: Corner) -> Shape:
    r = read.size("radius")
    return read.rounded(at, [(ZERO, ZERO, ZERO)], (r, r, ZERO), r * r / 4, r * r / 4, r * r / 2)


def _cylinder(read: _Reader, at: Corner) -> Shape:
    r, h = read.size("radius"), read.size("height")
    across, ends = r * r / 4 + h * h / 12, [(ZERO, ZERO, -h / 2), (ZERO, ZERO, h / 2)]
    return read.rounded(at, ends, (r, r, ZERO), across, across, r * r / 2)


def _ellipsoid(read: _Reader, at: Corner) -> Shape:
    path = (*read.path, "semi_axes")
    axes = read.numerals.vector(read.written["semi_axes"], path, 3)
    for i, x in enumerate(axes):
        if not x > 0:
            raise InvalidParameter((*path, i), "be greater than 0 m")
    squares = [x * x for x in axes]
    return read.rounded(at, [(ZERO, ZERO, ZERO)], axes, *((sum(squares, ZERO) - x) / 5 for x in squares))


Kinds = Mapping[str, tuple[tuple[str, ...], Callable[[_Reader, Corner], Shape]]]
"""By kind, the sizes that a shape has, and what reads them."""

IN_PLANE: Kinds = {
    "disc": (("radius",), _disc),
    "box": (("width", "height"), _box),
    "polygon": (("corners",), _polygon),
    "capsule": (("radius", "length"), _capsule),
}
IN_SPACE: Kinds = {
    "ball": (("radius",), _ball),
    "box": (("width", "height", "depth"), _box_in_space),
    "capsule": (("radius", "length"), _capsule_in_space),
    "disc": (("radius",), _disc_in_space),
    "cylinder": (("radius", "height"), _cylinder),
    "ellipsoid": (("semi_axes",), _ellipsoid),
}
ALL = frozenset({*IN_PLANE, *IN_SPACE})
