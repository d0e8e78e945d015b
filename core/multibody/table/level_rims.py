"""Rims of discs and cylinders that start level: four places of each touch a plane, as the corners of a box do.

A level rim touches along all of itself. Four places of it are on two diameters at right angles, of which the first is
that about which the body turns at the start, else that along which it moves, or the first body axis. One of the four is
the lowest as long as one of these diameters stays level: while the rim lies, slides or falls flat, and while it tips
about one of them. A load within the square of the places holds the rim level. Where a motion tips it in another way its
lowest point is none of them, and the motion ends; a load between the square and the rim ends it, too, because they
would let it tip.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

from core.balls import raised
from core.errors import Path
from core.multibody.algebra.polynomials import ONE, ZERO, Ball, Poly, combined, coordinate, dot, evaluated, is_zero
from core.multibody.table.connection_effects import LevelRim
from core.multibody.table.contact_places import Side
from core.multibody.table.measures import Measures

LEVEL = 1e-9
"""Sine of an angle below which a rim is meant to be level: the attitude of a body is known to rounding."""
PLACES = ((1, 0), (0, 1), (-1, 0), (0, -1))
"""Where a rim is met, in radii along its two diameters."""


def with_places(measures: Measures, name: str, side: Side, n: Sequence[Poly], path: Path) -> Side:
    """Return what touches a plane with its rims, with four places of each in their stead where they are level.

    Parameters
    ----------
    n : three polynomials
        The normal of the plane.
    """
    axes = None if side.frame is None else side.frame.axes
    if axes is None or not side.semi_axes or not is_zero(side.semi_axes[2]):
        return side
    level = [dot(n, list(map(coordinate, axis))) for axis in axes[:2]]
    square = sum((raised(evaluated(x, measures.table.q), 2) for x in level), ZERO)
    if not square < LEVEL * LEVEL:
        return side
    assert side.body is not None
    c, s = _diameter(measures, side.body, axes)
    radius = side.semi_axes[0]
    offsets = [
        (corner[0] + radius * (c * x - s * y), corner[1] + radius * (s * x + c * y), corner[2])
        for corner in side.offsets
        for x, y in PLACES
    ]
    points = [measures.coordinates.carried(side.body, offset, path) for offset in offsets]
    leaning = (combined((c, level[0]), (s, level[1])), combined((-s, level[0]), (c, level[1])))
    measures.level_rims.append(LevelRim(name, leaning, tuple(axes[0]), path))
    return replace(side, points=points, offsets=offsets, radius=ZERO, semi_axes=())


def _diameter(measures: Measures, body: str, axes: Sequence[Sequence[int]]) -> tuple[Ball, Ball]:
    """Return the direction in body axes about which a level body turns at the start, beside its spin.

    Without such a turn it is that in which the body moves along the plane: friction tips it about the other diameter.

    Parameters
    ----------
    axes : sequence of sequence of int
        Coordinates of the body axes.
    """
    written, q = measures.coordinates.scene.bodies[body], measures.table.q
    if written.angular_velocity is not None:
        x, y, _ = measures.numerals.vector(written.angular_velocity, ("bodies", body, "angular_velocity"), 3)
        if not (is_zero(x) and is_zero(y)):
            return _unit(x, y)
    if written.velocity is not None:
        moves = measures.numerals.vector(written.velocity, ("bodies", body, "velocity"), 3)
        x, y = (sum((v * q[i] for v, i in zip(moves, axis, strict=True)), ZERO) for axis in axes[:2])
        # Of what falls, a direction along the plane that is rounding is none.
        if x * x + y * y > LEVEL * LEVEL * sum((v * v for v in moves), ZERO):
            return _unit(x, y)
    return ONE, ZERO


def _unit(x: Ball, y: Ball) -> tuple[Ball, Ball]:
    if is_zero(y):
        return ONE, ZERO
    size = (x * x + y * y).sqrt()
    return ZERO if is_zero(x) else x / size, y / size
