"""Axes of space along which a scene is described best: the vertical, and the normal of the plane of its motion.

The passes choose among coordinates. A scene that is turned in space as a whole has the same motion, so what the passes
find must not depend on how it lies to the axes: the components of every vector are taken along axes of the scene.
"""

from __future__ import annotations

from collections.abc import Sequence

from core.multibody.algebra.directions import cross, perpendicular, unit
from core.multibody.algebra.polynomials import ZERO, Ball, is_zero
from core.multibody.reduction.reduction import Reduced
from core.multibody.table.table import Table, identity

Vector = Sequence[Ball]


def plane_axes(moving: Sequence[Vector], gravity: Vector) -> list[list[Ball]] | None:
    """Return the normal of the plane in which places move, as the first of three right-handed axes; None without.

    Parameters
    ----------
    moving : sequence of vectors
        Directions in which places move at the start.
    gravity : vector
        Its opposite, or what of it lies in the plane, is the third axis.
    """
    seen = [unit(vector, ()) for vector in moving if not _vanishes(vector)]
    up = None if _vanishes(gravity) else unit([-x for x in gravity], ())
    normal = _normal(seen)
    if normal is None and up is not None:
        normal = _normal([*seen, up])
    if normal is None:
        return None
    third = seen[0] if up is None or _vanishes(cross(up, normal)) else _within(up, normal)
    return _oblique([normal, cross(third, normal), third])


def vertical_axes(gravity: Vector) -> list[list[Ball]] | None:
    """Return three right-handed axes of which the third is upwards; None where one of the description is."""
    if _vanishes(gravity):
        return None
    third = unit([-x for x in gravity], ())
    first = perpendicular(third, ())[0]
    return _oblique([first, cross(third, first), third])


def _oblique(axes: list[list[Ball]]) -> list[list[Ball]] | None:
    """Return axes unless they are those of the description, in some order and with some signs."""
    return None if all(sum(not is_zero(x) for x in axis) == 1 for axis in axes) else axes


def spans_plane(vectors: Sequence[Vector]) -> bool:
    """Return whether not all of some vectors lie on a line."""
    seen = [vector for vector in vectors if not _vanishes(vector)]
    return any(not _vanishes(cross(seen[0], vector)) for vector in seen[1:])


def turned_to(table: Table, vectors: Sequence[Sequence[int]], axes: Sequence[Vector]) -> Reduced:
    """Return a table with the components of vectors along other axes, and the old coordinates in terms of the new.

    Parameters
    ----------
    vectors : sequence of three coordinates each
    axes : three unit vectors at right angles to one another
    """
    expressions = identity(len(table.names))
    for vector in vectors:
        for i, old in enumerate(vector):
            expressions[old] = {(new,): axis[i] for new, axis in zip(vector, axes, strict=True) if not is_zero(axis[i])}
    made = table.changed(expressions, range(len(table.names)))
    for vector in vectors:
        for new, axis, name in zip(vector, axes, "xyz", strict=True):
            made.names[new] = f"{table.names[vector[0]].rpartition('.')[0]}'.{name}"
            for numbers, before in ((made.q, table.q), (made.v, table.v)):
                numbers[new] = sum((x * before[old] for x, old in zip(axis, vector, strict=True)), ZERO)
    return Reduced(
        made, expressions, table.names, steps=["the axes are turned to the vertical and the plane of the motion"]
    )


def _normal(vectors: Sequence[Vector]) -> list[Ball] | None:
    """Return the unit normal of the plane of unit vectors; None where they lie in no plane, or on a line."""
    crossed = [cross(vectors[0], vector) for vector in vectors[1:]]
    best = max(crossed, key=lambda x: float(sum((y * y for y in x), ZERO)), default=None)
    if best is None or _vanishes(best):
        return None
    normal = unit(best, ())
    flat = all(is_zero(sum((x * y for x, y in zip(normal, vector, strict=True)), ZERO)) for vector in vectors)
    return normal if flat else None


def _within(vector: Vector, normal: Vector) -> list[Ball]:
    """Return the unit vector along what of a vector lies in the plane of a normal."""
    along = sum((x * y for x, y in zip(vector, normal, strict=True)), ZERO)
    return unit([x - along * y for x, y in zip(vector, normal, strict=True)], ())


def _vanishes(vector: Vector) -> bool:
    return all(is_zero(x) for x in vector)
