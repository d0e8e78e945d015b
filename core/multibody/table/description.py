"""From a description to its table: every body and connection in turn."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

from core.errors import Path
from core.multibody.algebra.polynomials import Ball, Poly, is_zero
from core.multibody.language.connection import Aspect, Surroundings
from core.multibody.language.faults_of_parts import FaultsOfParts
from core.multibody.language.motion_formulas import TURNS, references
from core.multibody.language.numerals import Numerals
from core.multibody.language.scene import Scene
from core.multibody.table import (
    attraction,
    blows,
    chains,
    contact_geometry,
    formula_laws,
    joints,
    joints_of_space,
    laws,
    relations,
    rolling_in_space,
    strings,
    torques,
)
from core.multibody.table.connection_effects import WorkTerm
from core.multibody.table.coordinates import Coordinates, dimension_of
from core.multibody.table.formulas_of_time import clock
from core.multibody.table.massless_places import balance_massless_places
from core.multibody.table.measures import Measures
from core.multibody.table.moving_places import driven_works
from core.multibody.table.rows import add_rows
from core.multibody.table.timed import add_timed, needs_clock

FORMS = (
    attraction,
    blows,
    chains,
    contact_geometry,
    formula_laws,
    joints,
    joints_of_space,
    laws,
    relations,
    rolling_in_space,
    strings,
    torques,
)
"""The modules with the forms of `add_rows` for the kinds of the catalogue: their import registers them."""

Acting = Mapping[str, Sequence[Ball] | None]
"""The connections that act at a time, of those that begin or end: the coordinates of the table at their beginning, None
for that of the start."""


@dataclass(frozen=True)
class Described:
    """A scene as a table, and what its rows mean."""

    scene: Scene
    measures: Measures
    paths: Mapping[str, Path]


def described(
    scene: Scene,
    numerals: Numerals | None = None,
    *,
    one_sided: bool = False,
    sketch: bool = False,
    acting: Acting | None = None,
) -> Described:
    """Return the table of a scene, its numbers read by `numerals` if given; the precision of balls is the caller's.

    If it is `one_sided`, strings are no rows but unilateral measures, as contacts are. The places of a `sketch` need
    not satisfy the connections, and its bodies have the coordinates of their whole orientation. Of connections that
    begin or end those that are `acting` have an effect, by default those of the start.

    Raises
    ------
    InvalidParameter
        With the paths to what cannot be: to a fault of every connection, where the bodies have none.
    """
    numerals = numerals or Numerals.of(scene.let, scene.numbers)
    names = scene.names()
    seen = _seen(scene, numerals)
    if one_sided and dimension_of(scene) == 2:
        # Angles are coordinates of their own, so that turns are counted across every event.
        seen = {name: what | {"turn"} if "direction" in what else what for name, what in seen.items()}
    if (sketch or scene.attitudes) and dimension_of(scene) == 3:
        # A top of which the axis alone is seen is to be described with all of its axes.
        seen = {
            name: what | {"orientation"} if what - {"turn"} or (scene.attitudes and scene.bodies[name].rigid) else what
            for name, what in seen.items()
        }
    coordinates = Coordinates(scene, numerals, seen)
    measures = Measures(coordinates, one_sided=one_sided, sketch=sketch)
    paths: dict[str, Path] = {name: ("bodies", name) for name in scene.bodies}
    paths["clock"] = ()
    faults = FaultsOfParts()
    numbered = list(zip(names, scene.numbered(), strict=True))
    timed = [one for one in numbered if one[1][1].timed]
    measures.begun = {
        i: None if acting is None else acting.get(name)
        for name, (i, connection) in numbered
        if not connection.timed or (connection.starts if acting is None else name in acting)
    }
    if needs_clock([connection for _, (_, connection) in timed], scene.let):
        clock(measures)
    for name, (i, connection) in numbered:
        paths[name] = ("connections", i)
        if connection.timed:
            continue
        with faults.part():
            first, before = len(measures.table.rows), len(measures.unilateral)
            add_rows(connection, measures, name, ("connections", i))
            _number(measures, before, i)
            driven = list(driven_works(measures, name, first))
            measures.works.extend(driven)
            measures.conservative = measures.conservative and not driven
    for name, (i, connection) in timed:
        with faults.part():
            acts, begun, before = i in measures.begun, measures.begun.get(i), len(measures.unilateral)
            add_timed(connection, measures, name, ("connections", i), begun, acts=acts)
            _number(measures, before, i)
    faults.raised()
    balance_massless_places(measures)
    if "gravity" not in paths:
        measures.works.extend(_weight(measures))
    return Described(scene, measures, paths)


def _number(measures: Measures, first: int, number: int) -> None:
    """Give the number of a connection to the measures from one on: those of what is timed come last."""
    measures.unilateral[first:] = [replace(one, listed=number) for one in measures.unilateral[first:]]


def _weight(measures: Measures) -> list[WorkTerm]:
    """Return what gravity does, where there is any."""
    fall: Poly = dict(measures.fall)
    for frame in measures.coordinates.frames.values():
        for i, pull in zip(frame.position, measures.coordinates.gravity, strict=True):
            mass = measures.table.mass.get((i, i))
            if mass is not None and not is_zero(pull):
                fall[i,] = -mass * pull
    return [WorkTerm("gravity", fall)] if fall else []


def _seen(scene: Scene, numerals: Numerals) -> dict[str, set[str]]:
    """Return what of each body the connections see: places by name, and "direction", "turn", "orientation"."""
    found: dict[str, set[str]] = {name: set() for name in scene.bodies}
    plane = dimension_of(scene) == 2

    def see(place: object, *what: Aspect) -> None:
        if not isinstance(place, str):
            return
        body, _, spot = place.partition(".")
        if body in found:
            found[body].update(what)
            if spot and spot != "centre":
                found[body].add(spot)
                if plane:
                    found[body].add("direction")

    surroundings = Surroundings(scene.bodies, numerals, plane)
    for connection in scene.connections:
        for place in connection.places():
            see(place)
        for place, aspect in connection.aspects(surroundings):
            see(place, aspect)
        for place, column in references(connection.formulas(), scene.bodies, scene.let):
            see(place, *(("turn",) if plane and column in TURNS else ()))
    return found
