"""Axes along which a scene is described best: of its plane, of the vertical, and of the line of what moves along one.

The passes choose among coordinates. A scene that is turned as a whole has the same motion, so what the passes find must
not depend on how it lies to the axes: the components of every vector are taken along axes of the scene. Each vector may
have its own, since its mass is the same in all directions.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

from core.multibody.algebra.directions import cross, perpendicular, unit
from core.multibody.algebra.polynomials import ONE, ZERO, Ball, combined, entry, is_zero
from core.multibody.reduction.reduction import Reduced
from core.multibody.table.table import Row, Table, identity

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
    moves = [vector for vector in moving if not _vanishes(vector)]
    if not all(_has_direction(vector) for vector in moves):
        return None
    seen = [unit(vector, ()) for vector in moves]
    up = None if _vanishes(gravity) else unit([-x for x in gravity], ())
    normal = _normal(seen)
    if normal is None and up is not None:
        normal = _normal([*seen, up])
    if normal is None:
        return None
    third = seen[0] if up is None or _vanishes(cross(up, normal)) else _within(up, normal)
    return _oblique([normal, cross(third, normal), third])


def vertical_axes(gravity: Vector) -> list[list[Ball]] | None:
    """Return right-handed axes of which the last is upwards; None where that of the description is, or without gravity.

    Motions that are symmetric about the vertical turn about the last axis.
    """
    if _vanishes(gravity) or (all(is_zero(x) for x in gravity[:-1]) and gravity[-1] < 0):
        return None
    last = unit([-x for x in gravity], ())
    first = perpendicular(last, ())[0]
    if len(last) == 2:
        return [[-x for x in first], last]
    return [first, cross(last, first), last]


def line_axes(changes: Sequence[Vector]) -> list[list[Ball]] | None:
    """Return axes of which the first is along the line on which vectors lie; None without one, or where it is an axis.

    Parameters
    ----------
    changes : sequence of vectors
        Derivatives by time of one vector, in the plane or in space.
    """
    seen = [vector for vector in changes if not _vanishes(vector)]
    if (
        not seen
        or not _has_direction(seen[0])
        or not all(is_zero(x) for vector in seen[1:] for x in _across(seen[0], vector))
    ):
        return None
    along = unit(seen[0], ())
    return _oblique([along, *perpendicular(along, ())])


def _across(a: Vector, b: Vector) -> Sequence[Ball]:
    """Return the cross product, which vanishes for vectors on a line; in the plane its only component."""
    return [a[0] * b[1] - a[1] * b[0]] if len(a) == 2 else cross(a, b)


def _oblique(axes: list[list[Ball]]) -> list[list[Ball]] | None:
    """Return axes unless they are those of the description, in some order and with some signs."""
    return None if all(sum(not is_zero(x) for x in axis) == 1 for axis in axes) else axes


def spans_plane(vectors: Sequence[Vector]) -> bool:
    """Return whether not all of some vectors lie on a line."""
    seen = [vector for vector in vectors if not _vanishes(vector)]
    return any(not _vanishes(cross(seen[0], vector)) for vector in seen[1:])


def turned_to(table: Table, vectors: Sequence[Sequence[int]], axes: Sequence[Sequence[Vector] | None]) -> Reduced:
    """Return a table with the components of vectors along other axes, and the old coordinates in terms of the new.

    Parameters
    ----------
    vectors : sequence of sequences of int
        The coordinates that are the components of each vector.
    axes : sequence of as many lists of unit vectors, or None
        At right angles to one another; None leaves a vector as it is.
    """
    expressions = identity(len(table.names))
    turned = [(vector, own) for vector, own in zip(vectors, axes, strict=True) if own is not None]
    for vector, own in turned:
        for i, old in enumerate(vector):
            expressions[old] = {(new,): axis[i] for new, axis in zip(vector, own, strict=True) if not is_zero(axis[i])}
    made = table.changed(expressions, range(len(table.names)))
    made.rows = _solved(made.rows)
    for vector, own in turned:
        for new, axis, name in zip(vector, own, "xyz", strict=False):
            made.names[new] = f"{table.names[vector[0]].rpartition('.')[0]}'.{name}"
            for numbers, before in ((made.q, table.q), (made.v, table.v)):
                numbers[new] = sum((x * before[old] for x, old in zip(axis, vector, strict=True)), ZERO)
    return Reduced(made, expressions, table.names, steps=["the axes are turned to the directions of the motion"])


def _solved(rows: Sequence[Row]) -> list[Row]:
    """Return rows of which the rates of each connection are solved for those that have constant factors.

    A velocity that vanishes in space is three rows along axes; along others each of these holds what moves and what
    does not.
    """
    found = list(rows)
    by_name: dict[str, list[int]] = {}
    for number, row in enumerate(rows):
        if row.measure is None and row.rate == 0 and not row.drag and not row.constant:
            by_name.setdefault(row.name, []).append(number)
    for numbers in by_name.values():
        for number in numbers:
            line = {j: poly[()] for j, poly in found[number].rates.items() if () in poly}
            pivot = max(line, key=lambda j: abs(float(line[j])), default=None)
            if pivot is None:
                continue
            found[number] = _sum(found[number], 1 / line[pivot], found[number], ZERO)
            for other in numbers:
                factor = entry(found[other].rates.get(pivot, {}), ())
                if other != number and not is_zero(factor):
                    found[other] = _sum(found[other], ONE, found[number], -factor)
    return found


def _sum(row: Row, factor: Ball, other: Row, more: Ball) -> Row:
    """Return a row times a factor and more of another."""
    lines = {
        j: combined((factor, row.rates.get(j, {})), (more, other.rates.get(j, {}))) for j in row.rates | other.rates
    }
    return replace(row, rates={j: poly for j, poly in lines.items() if poly})


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


def _has_direction(vector: Vector) -> bool:
    """Return whether a vector is longer than it is wide: some components may not be told from zero, others be tiny."""
    return bool(sum((x * x for x in vector), ZERO) > 0)


def _vanishes(vector: Vector) -> bool:
    return all(is_zero(x) for x in vector)
