"""The metric in which places are near: the mean square of the displacements of the points of every body.

In natural coordinates it is the mass matrix of a body over its mass: one for each coordinate of the centre, and for the
direction cosines the integrals of products of body coordinates over the mass.
"""

from __future__ import annotations

from collections.abc import Sequence

from core.multibody.algebra.polynomials import ONE, ZERO, Ball, entry
from core.multibody.table.frames import Frame
from core.multibody.table.table import Table

Metric = dict[tuple[int, int], Ball]
"""Entries by two coordinates, both triangles."""

THINNEST = ONE / 2**20
"""Share of its largest extent that a body has at least: the turn of a thin rod about itself moves no point of it, and
has to be determined all the same."""


def metric_of(table: Table, frames: Sequence[Frame], extent: Ball) -> Metric:
    """Return the metric of the coordinates of bodies.

    Parameters
    ----------
    extent : ball
        Size of the scene (m), for bodies that have neither mass nor places.
    """
    found: Metric = {}
    for frame in frames:
        found |= {(i, i): ONE for i in frame.position}
        mass = entry(table.mass, (frame.position[0], frame.position[0]))
        blocks = _directions(frame)
        largest = ZERO
        for block in blocks:
            for a in block:
                for b in block:
                    weight = entry(table.mass, (min(a, b), max(a, b)))
                    if mass > 0 and weight != 0:
                        found[a, b] = weight / mass
                largest = largest.max(entry(found, (a, a)))
        if not largest > 0:
            largest = _of_places(frame, extent)
            found |= {(a, a): largest for block in blocks for a in block}
        for block in blocks:
            # Angles beside direction cosines have no mass of their own.
            massless = all(entry(found, (a, a)) == 0 for a in block)
            least = largest if massless else THINNEST * largest
            found |= {(a, a): entry(found, (a, a)).max(least) for a in block}
    return found


def _directions(frame: Frame) -> list[Sequence[int]]:
    """Return the coordinates of the orientation of a body that have weights with one another."""
    if frame.direction is not None:
        return [frame.direction] if frame.turn is None else [frame.direction, (frame.turn,)]
    if frame.axes is not None:
        blocks: list[Sequence[int]] = [[axis[i] for axis in frame.axes] for i in range(3)]
        return blocks if frame.turns is None else [*blocks, frame.turns]
    own = [None if frame.turn is None else (frame.turn,), None if frame.axis is None else frame.axis[1], frame.turns]
    return [block for block in own if block is not None]


def _of_places(frame: Frame, extent: Ball) -> Ball:
    """Return the mean square of the distances of the places of a body from its centre, or of its rim."""
    squares = [sum((x * x for x in place), ZERO) for place in frame.places.values()]
    total: Ball = sum(squares, ZERO)
    if total > 0:
        return total / len(squares)
    radius: Ball = extent if frame.radius is None else frame.radius
    return radius * radius
