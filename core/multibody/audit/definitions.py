"""The definitions of all connections of a description.

They are written from what a connection means and from the conventions of docs/describing-scenes.md alone, and share
nothing with the table of equations that answers are computed by.
"""

from __future__ import annotations

from collections.abc import Collection, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np

from core.multibody.audit import (
    blows,
    contact_definitions,
    formula_definitions,
    joint_definitions,
    joints_of_space,
    law_definitions,
    string_definitions,
)
from core.multibody.audit.bodies import Path, Reader, RigidBody
from core.multibody.audit.definition import Definition
from core.multibody.audit.definition_of import definition_of
from core.multibody.audit.placement import LARGEST, LEAST, Place, Placement, Undefined
from core.multibody.language.scene import Scene

FORMS = (
    blows,
    contact_definitions,
    formula_definitions,
    joint_definitions,
    joints_of_space,
    law_definitions,
    string_definitions,
)
"""The modules with the forms of `definition_of` for the kinds of the catalogue: their import registers them."""


@dataclass(frozen=True)
class Description:
    """What a description says, in doubles.

    Attributes
    ----------
    dimension : int
    gravity : tuple of float
        m/s^2.
    bodies : mapping of str to RigidBody
    connections : tuple of Definition
    undefined : mapping of str to str
        Connections without a definition by their names, and what is missing.
    start : mapping of str to Pose
    within : bool
        Whether the powers of all its numbers are doubles.
    elsewhere : tuple of Place
        Those that connections name which do not act now: by these, too, a motion shows of a top its axis alone.
    """

    dimension: int
    gravity: tuple[float, ...]
    bodies: dict[str, RigidBody]
    connections: tuple[Definition, ...]
    undefined: dict[str, str]
    start: Placement
    within: bool = True
    elsewhere: tuple[Place, ...] = ()

    @cached_property
    def places(self) -> float:
        """Largest component of a place of a body at the start (m)."""
        return max(float(np.abs(pose.position).max()) for pose in self.start.values())

    @cached_property
    def extent(self) -> float:
        """The same, or the largest size of a connection: what a place is known beside (m)."""
        return max(self.places, *(connection.reach + connection.arm for connection in self.connections), 0.0)

    @cached_property
    def masses(self) -> dict[str, float]:
        """Masses of the bodies that have any (kg)."""
        return {name: body.mass for name, body in self.bodies.items() if body.mass > 0.0}

    @cached_property
    def shortest(self) -> float | None:
        """Least length that a connection has by itself (m), None where none has any."""
        return min((connection.reach for connection in self.connections if connection.reach > 0.0), default=None)

    @property
    def impulsive(self) -> Description:
        """What is left of it in no time: bodies and connections, without gravity and what acts by a law alone."""
        own = tuple(connection for connection in self.connections if not connection.loads)
        return replace(self, gravity=(0.0,) * self.dimension, connections=own)

    @property
    def moderate(self) -> bool:
        """Whether its numbers are of sizes for which rates are formed to all digits."""
        # A coordinate may be as small beside others as a zero is.
        numbers = [x for x in (*(body.mass for body in self.bodies.values()), self.places) if x]
        numbers.extend(connection.reach for connection in self.connections if connection.reach)
        numbers.extend(connection.mass for connection in self.connections if connection.mass)
        numbers.extend(abs(x) for x in self.gravity if x)
        return self.within and all(LEAST < x < LARGEST for x in numbers)


def description_of(
    scene: Scene,
    instead: Mapping[Path, float] | None = None,
    answered: Collection[str] | None = None,
    bodies: Mapping[str, RigidBody] | None = None,
    begun: Mapping[int, Placement] | None = None,
) -> Description:
    """Return the bodies of a scene and the definitions of its connections.

    The scene has been read and found in order before: nothing is checked here.

    Parameters
    ----------
    instead : mapping of path to float, optional
        Numbers in place of those that are written.
    answered : collection of str, optional
        Contacts of which an answer has states.
    bodies : mapping of str to RigidBody, optional
        As they are at another time, in place of the start.
    begun : mapping of int to placement, optional
        Where the bodies were when connections began, by their numbers.
    """
    reader = Reader(scene, instead, answered, bodies, begun)
    found: list[Definition] = []
    undefined: dict[str, str] = {}
    for name, (i, connection) in zip(scene.names(), scene.numbered(), strict=True):
        try:
            found.extend(definition_of(connection, reader, name, ("connections", i)).members)
        except Undefined as missing:
            undefined[name] = missing.what
    return Description(
        reader.dimension, reader.gravity, reader.bodies, tuple(found), undefined, reader.start, reader.moderate
    )


def kinds(connections: Sequence[Definition]) -> frozenset[str]:
    """Return the kinds of some connections."""
    return frozenset(connection.kind for connection in connections)
