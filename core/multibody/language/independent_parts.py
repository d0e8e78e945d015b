"""Which bodies of a scene share no connection with the others: each such part moves as if it were alone.

Gravity, named numbers and the frame of reference are common to all parts, and tie none to another.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from typing import Any

from core.errors import InvalidParameter
from core.multibody.language.connection import Connection
from core.multibody.language.motion_formulas import references
from core.multibody.language.occasions import named_by
from core.multibody.language.scene import Scene, ScenePart, part_of
from core.multibody.language.written import GROUND


def independent_parts(scene: Scene) -> Sequence[Scene]:
    """Return the parts of a scene that have no connection in common, in the order of their first bodies.

    They are the connected components of the graph whose vertices are the bodies and whose edges are the connections. A
    scene that is connected, or that has a fault which only the whole shows, is returned as it is.
    """
    if len({_dimension(body.at) for body in scene.bodies.values()}) > 1:
        return [scene]
    part_of = {name: name for name in scene.bodies}

    def first_of(name: str) -> str:
        while part_of[name] != name:
            part_of[name] = part_of[part_of[name]]
            name = part_of[name]
        return name

    order = {name: number for number, name in enumerate(scene.bodies)}
    joined: dict[int, list[str]] = {}
    try:
        connections = dict(zip(scene.names(), scene.connections, strict=True)) if scene.changes else {}
    except InvalidParameter:
        return [scene]
    for number, connection in scene.numbered():
        named = {place.partition(".")[0] for place, _ in references(connection.formulas(), order, scene.let)}
        # What begins or ends for all bodies does so once, whichever of them it waits for.
        if connection.everywhere and (named or connection.occasions()):
            return [scene]
        joined[number] = [*_bodies_of(connection), *named]
        for name in (name for written in connection.occasions().values() for name in named_by(written)):
            owner = name.partition(".")[0]
            if owner not in order and owner not in connections:
                # A quantity of the whole scene, or a fault.
                return [scene]
            joined[number] += [owner] if owner in order else _bodies_of(connections[owner])
        if not all(name in order for name in joined[number]):
            return [scene]
        firsts = sorted({first_of(name) for name in joined[number]}, key=order.__getitem__)
        part_of.update({name: firsts[0] for name in firsts})
    leaders = [name for name in scene.bodies if first_of(name) == name]
    if len(leaders) == 1:
        return [scene]
    return [
        _part(scene, [name for name in scene.bodies if first_of(name) == leader], joined, first=leader == leaders[0])
        for leader in leaders
    ]


def _part(scene: Scene, bodies: Sequence[str], joined: Mapping[int, Sequence[str]], *, first: bool) -> ScenePart:
    """Return the part with some of the bodies; connections that join no body are faults, which the first part shows."""
    own = {
        number
        for number, connection in scene.numbered()
        if (joined[number][0] in bodies if joined[number] else first or connection.everywhere)
    }
    return part_of(scene, own, bodies)


def _bodies_of(connection: Connection) -> Iterator[str]:
    """Yield the names of the bodies that a connection joins."""
    for place in connection.places():
        if isinstance(place, str) and place != GROUND:
            yield place.partition(".")[0]


def _dimension(at: Any) -> int | None:
    """Return the number of components of a vector as it is written, None for what is no vector."""
    if isinstance(at, Mapping):
        return 2
    return len(at) if isinstance(at, (list, tuple)) else None
