"""The rows of a scene by differentiating the definitions of its connections, and the forces that are known beforehand.

The derivative of a measure along a motion is the imaginary part at a place that is moved by an imaginary step. What a
row gains by itself, the second derivative along the present motion, is a difference of eighth order of such rates at
places that are moved along it by finite times: to some 1e-13 of the terms.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from core.multibody.audit.bodies import Reader
from core.multibody.audit.contacts import OnFace, OnRound, Stop
from core.multibody.audit.definition import Definition
from core.multibody.audit.joints import RodDefinition
from core.multibody.audit.laws import Pull
from core.multibody.audit.placement import STEP, Motion, Numbers, Placement
from core.multibody.audit.strings import ChainDefinition, Straight, StringDefinition
from tests.oracles.plain_engine.coordinates import Coordinates, Floats, State

_STENCIL = np.array([4.0, 3.0, 2.0, 1.0, -1.0, -2.0, -3.0, -4.0])
_WEIGHTS = np.array([-1 / 280, 4 / 105, -1 / 5, 4 / 5, -4 / 5, 1 / 5, -4 / 105, 1 / 280])
"""Central difference of eighth order for a first derivative (B. Fornberg, Math. Comp. 51 (1988) 699, table 1)."""
REACH = 2.0**-7
"""Part of the shortest length and of a radian by which the innermost places of the stencil are moved: the truncated
term is some 1e-15 of the rates, and rounding some 1e-14."""


MOST_SPENT = 5000
"""Evaluations of the accelerations that one motion may take: steps that small mean a singular place or a fast body."""


class NotSupported(Exception):
    """A kind of connection, or a combination, that this engine does not answer, by its name."""


class Undecided(Exception):
    """Mechanics does not decide what happens.

    Parameters
    ----------
    code : str
        As the answer of the product has it.
    """

    def __init__(self, code: str, names: Sequence[str] = ()) -> None:
        super().__init__(code)
        self.code, self.names = code, tuple(names)


@dataclass(frozen=True)
class OneSided:
    """A measure that stays at or above zero.

    Attributes
    ----------
    name : str
        Of the contact, or of one part of a string.
    key : str
        Of its force, by which its definition knows it.
    slips : int
        Components of its slip: 0 without friction, 1 in the plane, 3 in space.
    """

    name: str
    key: str
    definition: Definition
    static: float
    kinetic: float
    restitution: float
    slips: int
    closes: str
    opens: str
    rolls: bool
    order: float | None = None


@dataclass(frozen=True)
class Rows:
    """Linear forms in the rates, what they are equal to, and what their rates gain by themselves.

    Attributes
    ----------
    lines : ndarray, shape (m, n)
    values : ndarray, shape (m,)
        Of the measures (m, rad); zero of what holds rates alone.
    rates : ndarray, shape (m,)
        The forms at the present rates, less what is driven.
    gains : ndarray, shape (m,)
    driven : ndarray, shape (m,)
        The forms without any motion.
    """

    lines: Floats
    values: Floats
    rates: Floats
    gains: Floats
    driven: Floats


class Mechanism:
    """A scene as definitions, in maximal coordinates.

    Raises
    ------
    NotSupported
        For kinds without a definition.
    """

    def __init__(self, reader: Reader, definitions: Iterable[Definition]) -> None:
        self.coordinates = Coordinates(reader)
        self.definitions = list(definitions)
        self.gravity = np.array(reader.gravity)
        self.spent = 0
        placement = self.coordinates.placement(self.coordinates.start())
        still = self.coordinates.motion(np.zeros(self.coordinates.size))
        self.holding = [one for one in self.definitions if one.held(placement)]
        self.rolling = [one for one in self.definitions if one.held_rates(placement, still)]
        self.rolling_rows = sum(_width(x) for one in self.rolling for x in one.held_rates(placement, still).values())
        """Rows that hold rates alone."""
        self.one_sided = [entry for one in self.definitions for entry in _one_sided(one, placement, still, reader)]
        self.acting = [one for one in self.definitions if _acts(one)]
        self.chains = [one for one in self.definitions if isinstance(one, ChainDefinition)]
        self.every_straight = [
            part
            for one in self.definitions
            if isinstance(one, StringDefinition)
            for run in one.runs
            for part in run.parts
        ]
        self.shortest_rod = min([1.0, *(one.length for one in self.definitions if isinstance(one, RodDefinition))])
        self.pulls = [one for one in self.definitions if isinstance(one, Pull)]
        self.straights = [
            (run.name, part)
            for one in self.definitions
            if isinstance(one, StringDefinition)
            for run in one.runs
            if len(run.parts) > 1 or run.parts[0].senses != (0, 0)
            for part in run.parts
            if part.a.place.body is not None or part.b.place.body is not None
        ]

    def spend(self, evaluations: int = 1) -> None:
        """Count evaluations of accelerations, and give up where there are too many."""
        self.spent += evaluations
        if self.spent > MOST_SPENT:
            raise NotSupported("more evaluations than one motion may take")

    def rows(self, state: State, normals: Iterable[OneSided] = (), slips: Iterable[OneSided] = ()) -> Rows:
        """Return the rows of everything that holds, then of closed gaps, then of slips that are wanted."""
        normals, slips = list(normals), list(slips)
        coordinates, u = self.coordinates, state.rates
        n = coordinates.size
        velocity, spin = coordinates.spread(u)
        fastest = max(float(np.max(np.abs(velocity), initial=0.0)), float(np.max(np.abs(spin), initial=0.0)))
        h = REACH * self._shortest(state) / fastest if fastest > 0.0 else 1.0
        motions = np.concatenate([np.eye(n), np.zeros((1, n)), np.tile(u, (9, 1))])
        times = np.concatenate([np.zeros(n + 2), h * _STENCIL])
        placements = coordinates.placement(state, motions, times)
        found = []
        for one in self.holding:
            found.extend(one.held(placements).values())
        found.extend(entry.definition.gaps(placements)[entry.key] for entry in normals)
        held = _columns(found, n + 10)
        rates, values = held.imag / STEP, held.real[n + 1]
        if self.rolling or slips:
            real = {
                name: type(pose)(*(None if x is None else x.real for x in (pose.position, pose.rotation, pose.turn)))
                for name, pose in placements.items()
            }
            motion = coordinates.motion(motions)
            turned: list[Numbers] = []
            for one in self.rolling:
                turned.extend(one.held_rates(real, motion).values())
            turned.extend(entry.definition.slips(real, motion)[entry.key] for entry in slips)
            more = _columns(turned, n + 10).real
            rates = np.concatenate([rates, more], axis=1)
            values = np.concatenate([values, np.zeros(more.shape[1])])
        driven = rates[n]
        lines = (rates[:n] - driven).T
        return Rows(lines, values, rates[n + 1], (_WEIGHTS @ rates[n + 2 :]) / h, driven)

    def gains_of_gaps(self, state: State, gaps: Sequence[OneSided], accelerations: Floats) -> Floats:
        """Return the second derivatives of gaps, shape (k,)."""
        rows = self.rows(state, gaps)
        found: Floats = rows.lines @ accelerations + rows.gains
        end = len(found) - self.rolling_rows
        return found[end - len(gaps) : end]

    def _shortest(self, state: State) -> float:
        """Return the length (m) of the shortest rod or straight part, whose direction turns most for a move."""
        found = self.shortest_rod
        if self.every_straight:
            placement = self.coordinates.placement(state)
            found = min(found, *(float(np.real(_span(part, placement))) for part in self.every_straight))
        return max(found, 1e-6)

    def loads(self, state: State) -> Floats:
        """Return the forces that places and rates alone give, shape (n,)."""
        coordinates = self.coordinates
        total = coordinates.weights(state, self.gravity)
        if self.acting or self.chains:
            placement, motion = coordinates.placement(state), coordinates.motion(state.rates)
            virtual = coordinates.motion(np.eye(coordinates.size))
            for one in self.acting:
                values = one.laws(placement, motion)
                efforts = one.efforts(placement, virtual) if values else {}
                for name, value in values.items():
                    total = total + value * efforts[name]
                total = total + one.load(placement, motion, virtual)
            for chain in self.chains:
                total = total - self._gradient(state, chain.potential)
        return total

    def inertia(self, state: State) -> Floats:
        """Return the mass matrix, with what chains add to it."""
        found = self.coordinates.inertia(state)
        for chain in self.chains:
            line = self._gradient(state, lambda placement, chain=chain: chain.sides(placement)[0])  # type: ignore[misc]
            found = found + chain.density * chain.length * np.outer(line, line)
        return found

    def gap_rates(self, state: State) -> tuple[Floats, Floats]:
        """Return all gaps and their rates, shape (k,) each."""
        placements = self.coordinates.placement(state, state.rates[None], np.zeros(1))
        pairs = [entry.definition.gaps(placements)[entry.key].reshape(-1)[0] for entry in self.one_sided]
        both = np.array(pairs, dtype=complex)
        return both.real, both.imag / STEP

    def spans(self, state: State) -> list[tuple[str, float, float]]:
        """Return the lengths that have to stay positive, with their rates.

        They are those of straight parts of strings beside drums or pegs, and of what pulls along a line.
        """
        placement = self.coordinates.placement(state, state.rates[None], np.zeros(1))
        found = [(name, _span(part, placement)) for name, part in self.straights]
        found += [(one.name, one.distance(placement)) for one in self.pulls]
        return [(name, float(x.real[0]), float(x.imag[0]) / STEP) for name, x in found]

    def _gradient(self, state: State, measure: Callable[[Placement], Numbers]) -> Floats:
        n = self.coordinates.size
        found = measure(self.coordinates.placement(state, np.eye(n), np.zeros(n)))
        return np.broadcast_to(np.imag(found) / STEP, (n,))


def _span(part: Straight, placement: Placement) -> Numbers:
    d = part.between(placement)
    return np.sqrt((d * d).sum(axis=-1) - part.offset**2)


def _width(value: Numbers) -> int:
    return 1 if np.ndim(value) == 0 else int(np.shape(value)[-1])


def _columns(found: list[Numbers], count: int) -> Any:
    if not found:
        return np.zeros((count, 0), dtype=complex)
    parts = [np.broadcast_to(x, (count, *x.shape[1:])) if np.ndim(x) else np.full(count, x) for x in found]
    return np.concatenate([x.reshape(count, -1) for x in parts], axis=1)


def _acts(one: Definition) -> bool:
    kind = type(one)
    return kind.laws is not Definition.laws or kind.load is not Definition.load


def _one_sided(one: Any, placement: Placement, still: Motion, reader: Reader) -> list[OneSided]:
    found = []
    for key in one.gaps(placement):
        touch = one.touch
        closes, opens, rolls = "touch", "lift-off", False
        if isinstance(one, StringDefinition):
            closes, opens = "taut", "slack"
        elif isinstance(one, Stop):
            closes, opens = "stop", "release"
        elif isinstance(one, OnFace):
            rolls = one.radius > 0.0
        elif isinstance(one, OnRound):
            rims = zip((one.round.a, one.round.b), one.round.radii, strict=True)
            rolls = any(place.body is not None and radius > 0.0 for place, radius in rims)
        slip = one.slips(placement, still).get(key)
        width = 0 if slip is None else _width(slip)
        name = key.rsplit(".", 1)[0]
        order = getattr(reader.scene.connections[_number(reader, name)], "order", None)
        found.append(
            OneSided(
                name,
                key,
                one,
                touch.static,
                touch.kinetic,
                touch.restitution,
                width,
                closes,
                opens,
                rolls,
                None if order is None else reader.number(order, ("connections", "order")),
            )
        )
    return found


def _number(reader: Reader, name: str) -> int:
    names: Mapping[str, int] = {one: i for i, one in enumerate(reader.scene.names())}
    return names[name] if name in names else names[name.rsplit(".", 1)[0]]
