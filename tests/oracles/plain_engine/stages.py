"""The stages of a motion in which the same connections act: at the end of each the next one starts anew."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import replace

import numpy as np

from core.multibody.audit.blows import BlowDefinition
from core.multibody.audit.bodies import Reader, RigidBody
from core.multibody.audit.definition import Definition
from core.multibody.audit.definitions import description_of
from core.multibody.language.forces import Blow
from core.multibody.language.scene import Scene, part_of
from tests.oracles.plain_engine.coordinates import Floats, State
from tests.oracles.plain_engine.mechanism import Mechanism, NotSupported, Undecided
from tests.oracles.plain_engine.timetable import Entry, Happened, Timetable

MISSED = 1e-7
"""What a connection that begins may miss its places by (m, rad): those of a motion are known much better."""


class Stages:
    """The mechanism of the present stage, and what is still to begin, end and strike.

    Parameters
    ----------
    faster, heavier : float
        Factors of blows and of gravity.
    """

    def __init__(self, scene: Scene, faster: float, heavier: float) -> None:
        self.scene, self.faster, self.heavier = scene, faster, heavier
        self.timetable = Timetable(scene)
        self.acting = self.timetable.acting
        self.own: dict[str, list[Definition]] = {}
        self.mechanism = self._mechanism(None)

    def due(self, now: float, events: Sequence[Happened]) -> list[Entry]:
        """Return what happens now."""
        return self.timetable.due(now, events)

    def changed(self, state: State, due: Iterable[Entry]) -> State:
        """Take up what begins and drop what ends; return the state after that and after blows.

        Raises
        ------
        Undecided
            For what cannot begin in these places.
        """
        coordinates = self.mechanism.coordinates
        poses = coordinates.placement(state)
        bodies = {
            name: replace(body, start=poses[name], velocity=None, angular_velocity=None)
            for name, body in zip(coordinates.names, coordinates.bodies, strict=True)
        }
        begun = {entry.name for entry in due if entry.what == "begin"}
        ended = {entry.name for entry in due if entry.what == "end"}
        self.acting = (self.acting | begun) - ended
        spent = self.mechanism.spent
        self.mechanism = self._mechanism(bodies)
        self.mechanism.spent = spent
        rows = self.mechanism.rows(state)
        if np.abs(rows.values).max(initial=0.0) > MISSED:
            raise Undecided("cannot-begin", sorted(begun))
        struck = [entry.name for entry in due if entry.what == "impulse"]
        momenta = sum((self._blow(name, state) for name in struck), np.zeros(len(state.rates)))
        n, m = len(state.rates), len(rows.owners)
        matrix = np.block([[self.mechanism.inertia(state), rows.lines.T], [rows.lines, np.zeros((m, m))]])
        right = np.concatenate([momenta, -rows.rates])
        return replace(state, rates=state.rates + np.linalg.lstsq(matrix, right, rcond=1e-11)[0][:n])

    def _mechanism(self, bodies: Mapping[str, RigidBody] | None) -> Mechanism:
        """Return that of what acts; what has begun before keeps its definition."""
        names = dict(zip(self.scene.names(), self.scene.numbered(), strict=True))
        part = part_of(self.scene, {number for name, (number, _) in names.items() if name in self.acting})
        found = description_of(part, bodies=bodies)
        if found.undefined:
            raise NotSupported("; ".join(sorted(set(found.undefined.values()))))
        new: dict[str, list[Definition]] = {name: [] for name in names if name in self.acting}
        for one in found.connections:
            # The parts of a connection have its name and an ending.
            new[one.name if one.name in new else one.name.rpartition(".")[0]].append(one)
        self.own = {name: self.own.get(name, every) for name, every in new.items()}
        definitions = [one for every in self.own.values() for one in every]
        mechanism = Mechanism(Reader(part, bodies=bodies), definitions)
        if mechanism.chains and any(connection.everywhere for connection in part.connections):
            raise NotSupported("what acts everywhere does so on the links of a chain, too")
        mechanism.gravity = mechanism.gravity * self.heavier
        return mechanism

    def _blow(self, name: str, state: State) -> Floats:
        """Return the momenta that a blow gives to the rates."""
        (definition,) = self.own[name]
        i = self.scene.names().index(name)
        written = self.scene.connections[i]
        assert isinstance(definition, BlowDefinition)
        assert isinstance(written, Blow)
        coordinates, path = self.mechanism.coordinates, ("connections", i, "impulse")
        placement = coordinates.placement(state)
        reader = Reader(self.scene)
        if definition.turns and reader.dimension == 2:
            components = np.array([reader.number(written.impulse, path)])
        else:
            components = np.array(reader.vector(written.impulse, path))
            body = definition.place.body
            if written.in_ == "body" and body is not None:
                rotation = placement[body].rotation
                components = components if rotation is None else rotation @ components
        efforts = definition.efforts(placement, coordinates.motion(np.eye(coordinates.size)))
        found: Floats = sum(
            (x * effort for x, effort in zip(self.faster * components, efforts.values(), strict=True)),
            np.zeros(coordinates.size),
        )
        return found
