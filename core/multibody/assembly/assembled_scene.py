"""From a sketch to the scene that it means: the nearest places and velocities that satisfy the connections.

What a connection takes from the start and its description does not give, such as the length of a rod or the attitude of
two bodies that are welded, is that of the sketch. The scene that is found has the same connections, and the places as
numbers of `DIGITS` digits: everything that takes scenes takes it.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np
from flint import arb

from core.arrays import Floats
from core.balls import precision
from core.errors import InvalidParameter, NotApplicable, SlackAtStart
from core.multibody.algebra.doubles import error_in_doubles, in_doubles
from core.multibody.algebra.polynomials import ZERO, Ball, Poly, evaluated, is_zero, size
from core.multibody.assembly.described_bodies import (
    BITS_OF_RATES,
    moving_body,
    placed_body,
    rounded,
    same,
    square_of,
    turned_angle,
)
from core.multibody.assembly.exact_places import BITS, DIGITS, exact_places, sizes_of
from core.multibody.assembly.four_bar import four_bar_of, place_of
from core.multibody.assembly.metric import Metric, metric_of
from core.multibody.assembly.misfit import refusal
from core.multibody.assembly.nearest_places import NearestPlace, Sketch
from core.multibody.assembly.nearest_velocities import nearest_rates
from core.multibody.assembly.quadratics import Quadratics
from core.multibody.language.connection import Connection
from core.multibody.language.joints import Pin
from core.multibody.language.numerals import Numerals
from core.multibody.language.scene import Scene
from core.multibody.model_answer import AssembledBody, Assembly
from core.multibody.table.description import Described, described
from core.multibody.table.facing import facing
from core.multibody.table.frames import axis_after
from core.near_names import near_and_all
from core.work import spend

_UNITS_OF_A_SKETCH = 2e-4
"""Units of work (`core.work`) of the places of a sketch, times the cube of its coordinates."""


@dataclass(frozen=True)
class AssembledScene:
    """A scene whose start satisfies its connections, and how far that is from the sketch.

    Attributes
    ----------
    scene : Scene
        Without `assemble`.
    assembly : Assembly or None
        None where nothing was requested.
    """

    scene: Scene
    assembly: Assembly | None


@dataclass(frozen=True)
class _Places:
    """The coordinates that were found for a table."""

    q: list[Ball]
    found: Sequence[NearestPlace]
    extent: float


def assembled(scene: Scene, numerals: Numerals | None = None) -> AssembledScene:
    """Return a scene with the nearest places and velocities that satisfy its connections, if it requests them.

    Parameters
    ----------
    numerals : Numerals, optional
        By which the numbers of the sketch are read.

    Raises
    ------
    InvalidParameter
        For connections that cannot be satisfied, with by how much they are missed at least.
    NotApplicable
        Where none of the places is the nearest; for scenes with a chain.
    """
    if scene.assemble is None:
        return AssembledScene(scene, None)
    movable = _movable(scene)
    if not scene.continues:
        raise NotApplicable(
            "a chain has the lengths of its sides from the places of its ends, which are no sketch then",
            path=("assemble",),
            remedy="leave assemble out, and give the places of the ends",
        )
    with precision(BITS):
        plain = replace(scene, assemble=None)
        found = described(plain, numerals, one_sided=True, sketch=True)
        places = _places(plain, found, movable)
        result = _at(plain, found, places)
        with precision(BITS_OF_RATES):
            moving = _moving(result, numerals, places.extent)
        return AssembledScene(moving, _assembly(plain, found, places, changed=moving is not result))


def _movable(scene: Scene) -> list[str]:
    """Return the bodies that may be moved."""
    assemble = scene.assemble
    if assemble == "nearest":
        return list(scene.bodies)
    names = assemble.get("nearest") if isinstance(assemble, Mapping) and set(assemble) == {"nearest"} else None
    if not isinstance(names, Sequence) or isinstance(names, str) or not names:
        raise InvalidParameter("assemble", 'be "nearest", or {"nearest": [names of the bodies that may be moved]}')
    for i, name in enumerate(names):
        if name not in scene.bodies:
            remedy = near_and_all(name, scene.bodies, "bodies")
            raise InvalidParameter(("assemble", "nearest", i), "name a body of the scene", remedy=remedy)
    return list(names)


def _places(scene: Scene, found: Described, bodies: Sequence[str]) -> _Places:
    """Return the nearest places at which all connections hold and nothing overlaps."""
    table, frames = found.measures.table, found.measures.coordinates.frames
    given = np.array([float(x) for x in table.q])
    extent = _extent(found)
    metric = metric_of(table, list(frames.values()), arb(extent))
    owned = {name: {i for (i, _) in metric_of(table, [frame], arb(extent))} for name, frame in frames.items()}
    fixed = set().union(*(owned[name] for name in frames if name not in bodies))
    clocks = {i for i, unit in enumerate(table.units) if unit == "s"}
    free = [i for i in range(len(given)) if i not in fixed and i not in clocks and i not in table.timed]
    rows = [(row.name, row.measure) for row in table.rows if row.measure is not None]
    spend(_UNITS_OF_A_SKETCH * len(given) ** 3)
    kept: dict[str, Poly] = {}
    while True:
        names = [*(name for name, _ in rows), *(name.split(".")[0] for name in kept)]
        measures = [*(measure for _, measure in rows), *kept.values()]
        nearest, q = _met(scene, found, names, measures, metric, free, extent)
        overlapping = [
            one
            for one in facing(found.measures.unilateral, q, table.v)
            if one.name not in kept and evaluated(one.gap, q) < -(arb(10) ** -(DIGITS - 15)) * size(one.gap, q)
        ]
        if not overlapping:
            return _Places(q, nearest, extent)
        # What the sketch, or the nearest places without it, would overlap is put in touch.
        kept |= {one.name: one.gap for one in overlapping}


def _met(
    scene: Scene,
    found: Described,
    names: Sequence[str],
    measures: Sequence[Poly],
    metric: Metric,
    free: Sequence[int],
    extent: float,
) -> tuple[Sequence[NearestPlace], list[Ball]]:
    """Return the nearest places at which measures vanish, in doubles with others, and in balls."""
    table, frames = found.measures.table, found.measures.coordinates.frames
    if all(is_zero(evaluated(measure, table.q)) for measure in measures):
        return [], list(table.q)
    given = np.array([float(x) for x in table.q])
    sizes = sizes_of(table, measures, extent)
    quadratics = Quadratics.of(measures, sizes, len(given))
    across, counts = _across(table.units, metric, free, extent)
    sketch = Sketch(quadratics, given, across, counts)
    nearest = [one for one in sketch.found(extent) if _right_handed(found, one.q)]
    if not nearest:
        linkage = four_bar_of(scene, found.measures)
        raise refusal(quadratics, names, given, across, frames, found.paths, linkage)
    return nearest, exact_places(table, measures, metric, free, nearest[0].q, extent)


def _across(units: Sequence[str], metric: Metric, free: Sequence[int], extent: float) -> tuple[Floats, Floats]:
    """Return changes of the coordinates of size one in the metric, shape (n, f), and which of them count."""
    place = {i: k for k, i in enumerate(free)}
    weights = np.zeros((len(free), len(free)))
    for (i, j), value in metric.items():
        if i in place and j in place:
            weights[place[i], place[j]] = float(value)
    counts = (np.diag(weights) > 0.0).astype(np.float64)
    for k, i in enumerate(free):
        if not counts[k]:
            # What follows from the places, such as the length of a spring: by its unit, in the size of the scene.
            weights[k, k] = {"m": 1.0, "1": extent**2, "rad": extent**2, "1/m": extent**4}.get(units[i], 1.0)
    across = np.zeros((len(units), len(free)))
    across[list(free)] = np.linalg.inv(np.linalg.cholesky(weights)).T
    return across, counts


def _right_handed(found: Described, q: Floats) -> bool:
    frames = found.measures.coordinates.frames.values()
    return all(np.linalg.det(q[np.array(frame.axes)]) > 0.0 for frame in frames if frame.axes is not None)


def _extent(found: Described) -> float:
    """Return the size of a scene: of its places from their middle, and of its bodies (m)."""
    table, frames = found.measures.table, found.measures.coordinates.frames.values()
    centres = np.array([[float(table.q[i]) for i in frame.position] for frame in frames])
    arms = [abs(float(x)) for frame in frames for place in frame.places.values() for x in place]
    size_of = max(float(np.ptp(centres, axis=0).max()), 2.0 * max(arms, default=0.0), float(np.abs(centres).max()))
    return size_of or 1.0


def _at(scene: Scene, found: Described, places: _Places) -> Scene:
    """Return a scene with its bodies at other places."""
    coordinates, table = found.measures.coordinates, found.measures.table
    bodies = {
        name: placed_body(
            body,
            coordinates.frames[name],
            table,
            places.q,
            coordinates.start_angle(name) if coordinates.dimension == 2 else ZERO,
            places.extent,
        )
        for name, body in scene.bodies.items()
    }
    connections = [_turned(connection, found, places) for connection in scene.connections]
    return replace(scene, bodies=bodies, connections=tuple(connections))


def _turned(connection: Connection, found: Described, places: _Places) -> Connection:
    """Return a connection; the axis of a pin, which is given in space at the start, turns with its body."""
    if not isinstance(connection, Pin) or connection.axis is None:
        return connection
    coordinates, before = found.measures.coordinates, found.measures.table.q
    carriers = [place.partition(".")[0] for place in (connection.a, connection.b) if isinstance(place, str)]
    frame = coordinates.frames[carriers[0]] if len(carriers) == 2 else None
    if frame is None or frame.axes is None or all(same(axis, before, places.q, 1.0) for axis in frame.axes):
        return connection
    axis = coordinates.numerals.vector(connection.axis, (), 3)
    length = max(float(abs(x)) for x in axis)
    after = axis_after(axis, frame, before, places.q)
    return replace(connection, axis=tuple(rounded(x, length) for x in after))


def _moving(scene: Scene, numerals: Numerals | None, extent: float) -> Scene:
    """Return a scene with the nearest velocities that its connections allow."""
    if all(body.velocity is None and body.angular_velocity is None for body in scene.bodies.values()):
        return scene
    written = None if numerals is None else numerals.without_places()
    one_sided = any(connection.one_sided for connection in scene.connections)
    try:
        # Strings that are taut hold, as in the motion of a scene that nothing else is one-sided in.
        found = described(scene, written, one_sided=one_sided, sketch=True)
    except SlackAtStart:
        found = described(scene, written, one_sided=True, sketch=True)
    coordinates, table = found.measures.coordinates, found.measures.table
    metric = metric_of(table, list(coordinates.frames.values()), arb(extent))
    rates = nearest_rates(table, coordinates.given, metric)
    if rates is None:
        return scene
    bodies = {
        name: moving_body(body, coordinates.frames[name], table, rates, coordinates.numerals)
        for name, body in scene.bodies.items()
    }
    return replace(scene, bodies=bodies)


def _assembly(scene: Scene, found: Described, places: _Places, *, changed: bool) -> Assembly:
    """Return what is answered about the places that were found."""
    coordinates, table = found.measures.coordinates, found.measures.table
    unsure = (arb(10) ** -DIGITS) * arb(0, 1)
    after = [x + unsure * (places.extent if unit == "m" else 1) for x, unit in zip(places.q, table.units, strict=True)]
    bodies: dict[str, AssembledBody] = {}
    for name, frame in coordinates.frames.items():
        moved = _root(square_of([after[i] - table.q[i] for i in frame.position]))
        turned = turned_angle(frame, table.q, after)
        angle = coordinates.start_angle(name) + turned if frame.direction or frame.turn is not None else None
        centre = [after[i] for i in frame.position]
        axes = None if frame.axes is None else [[after[i] for i in axis] for axis in frame.axes]
        errors = {
            "at": _largest(centre),
            "angle": None if angle is None else error_in_doubles(angle),
            "axes": None if axes is None else _largest([x for axis in axes for x in axis]),
            "moved": error_in_doubles(moved),
            "turned": error_in_doubles(turned),
        }
        bodies[name] = AssembledBody(
            tuple(map(in_doubles, centre)),
            None if angle is None else in_doubles(angle),
            None if axes is None else tuple(tuple(map(in_doubles, axis)) for axis in axes),
            in_doubles(moved),
            in_doubles(turned),
            errors,
        )
    metric = metric_of(table, list(coordinates.frames.values()), arb(places.extent))
    square = ZERO
    for (i, j), weight in metric.items():
        square = square + (after[i] - table.q[i]) * weight * (after[j] - table.q[j])
    distance = _root(square)
    linkage = four_bar_of(scene, found.measures)
    others = tuple(one.distance for one in places.found[1:])
    return Assembly(
        in_doubles(distance),
        bodies,
        others,
        changed,
        None
        if linkage is None
        else linkage.answer([place_of(joint, found.measures, places.q) for joint in linkage.joints]),
        {"distance": error_in_doubles(distance), "others": 2.0**-30 * max(others, default=0.0)},
    )


def _root(square: Ball) -> Ball:
    return square.sqrt() if square > 0 else ZERO


def _largest(balls: Sequence[Ball]) -> float | None:
    errors = [error_in_doubles(x) for x in balls]
    return None if None in errors else max(x for x in errors if x is not None)
