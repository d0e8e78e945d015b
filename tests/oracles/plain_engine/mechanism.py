"""The rows of a scene by differentiating the definitions of its connections, and the forces that are known beforehand.

The derivative of a measure along a motion is the imaginary part at a place that is moved by an imaginary step. What a
row gains by itself, the second derivative along the present motion, is a difference of eighth order of such rates at
places that are moved along it by finite times: to some 1e-12 of the terms.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from core.multibody.audit.between_places import BetweenPlaces
from core.multibody.audit.bodies import Reader
from core.multibody.audit.chains import ChainDefinition
from core.multibody.audit.contacts import OnFace, OnRound, Stop
from core.multibody.audit.definition import Definition, Touch
from core.multibody.audit.guides import Side
from core.multibody.audit.joints import RodDefinition
from core.multibody.audit.outlines import OnOutline
from core.multibody.audit.placement import STEP, Measure, Motion, Numbers, Placement, rate, with_rate
from core.multibody.audit.string_runs import Straight
from core.multibody.audit.strings import StringDefinition
from core.multibody.audit.turns_in_space import AxialStop
from tests.oracles.plain_engine.coordinates import Coordinates, Floats, State

_STENCIL = np.array([4.0, 3.0, 2.0, 1.0, -1.0, -2.0, -3.0, -4.0])
_WEIGHTS = np.array([-1 / 280, 4 / 105, -1 / 5, 4 / 5, -4 / 5, 1 / 5, -4 / 105, 1 / 280])
"""Central difference of eighth order for a first derivative (B. Fornberg, Math. Comp. 51 (1988) 699, table 1)."""
REACH = 2.0**-9
"""Part of the shortest length and of a radian by which the innermost places of the stencil are moved: rounding is some
1e-13 of the rates, and the truncated term nothing beside it. Where the outline of a shape bends, it reaches across."""
MOST_SPENT = 12000
"""Evaluations of the accelerations that one motion may take: steps that small mean a singular place or a fast body."""

Owner = tuple[str, int]
"""What a row belongs to: ("held", number of the definition), ("push", number of the measure) or ("slip", the same)."""


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
    order : float or None
        When it acts among impacts at one instant.
    closes, opens, sticks : str
        Its events.
    opposite : str
        In a guide without play the name of the other side; empty where there is none.
    """

    name: str
    key: str
    definition: Definition
    touch: Touch
    slips: int
    order: float | None
    closes: str
    opens: str
    sticks: str
    opposite: str = ""


@dataclass(frozen=True)
class Rows:
    """Linear forms in the rates, what they are equal to, and what their rates gain by themselves.

    Attributes
    ----------
    owners : list of Owner
    lines : ndarray, shape (m, n)
    values : ndarray, shape (m,)
        Of the measures (m, rad); zero of what holds rates alone.
    rates, gains, driven : ndarray, shape (m,)
        The forms at the present rates, what these gain, and the forms without any motion.
    tangential : sequence of float
        Restitution of the slip of each measure.
    """

    owners: list[Owner]
    lines: Floats
    values: Floats
    rates: Floats
    gains: Floats
    driven: Floats
    tangential: Sequence[float]

    def of(self, what: str, number: int) -> list[int]:
        """Return where the rows of an owner are."""
        return [k for k, owner in enumerate(self.owners) if owner == (what, number)]

    def after(self, restitution: Mapping[int, float]) -> Floats:
        """Return the gains of an impact: none of what holds; rates of slips and gaps, 1 + e times if these close."""
        closing = {i for (what, i), rate in zip(self.owners, self.rates, strict=True) if what == "push" and rate < 0.0}
        factors = [
            0.0 if what == "held" else 1.0 + (restitution if what == "push" else self.tangential)[i] * (i in closing)
            for what, i in self.owners
        ]
        found: Floats = np.array(factors) * self.rates
        return found


class Mechanism:
    """A scene as definitions, in maximal coordinates."""

    def __init__(self, reader: Reader, definitions: Iterable[Definition]) -> None:
        self.coordinates = Coordinates(reader)
        self.definitions = list(definitions)
        self.gravity = np.array(reader.gravity)
        self.simultaneous = reader.scene.simultaneous
        self.spent = 0
        placement = self.coordinates.placement(self.coordinates.start())
        still = self.coordinates.motion(np.zeros(self.coordinates.size))
        self.one_sided = [entry for one in self.definitions for entry in _one_sided(one, placement, still, reader)]
        self.rolling = [(k, one) for k, one in enumerate(self.definitions) if one.rolls]
        self.pushing = [one for one in self.definitions if one.lawful or one.loads]
        self.chains = [one for one in self.definitions if isinstance(one, ChainDefinition)]
        self.straights = [
            (run.name, part, len(run.parts) > 1 or run.parts[0].senses != (0, 0))
            for one in self.definitions
            if isinstance(one, StringDefinition)
            for run in one.runs
            for part in run.parts
        ]
        # Where nothing moves, formulas of time do: their arguments change by less than a unit for one of time.
        self.driven = max([1.0, *(one.driven for one in self.definitions)])
        self.shortest_rod = min([1.0, *(one.length for one in self.definitions if isinstance(one, RodDefinition))])

    def spend(self, evaluations: int = 1) -> None:
        """Count evaluations of accelerations, and give up where there are too many."""
        self.spent += evaluations
        if self.spent > MOST_SPENT:
            raise NotSupported("more evaluations than one motion may take")

    def rows(self, state: State, closed: Iterable[int] = (), slipping: Sequence[int] = ()) -> Rows:
        """Return the rows of everything that holds, of gaps that are closed, and of slips that are wanted."""
        coordinates, u, n = self.coordinates, state.rates, self.coordinates.size
        fastest = float(np.abs(u).max(initial=0.0))
        h = REACH * self._shortest(state) / max(fastest, self.driven)
        motions = np.concatenate([np.eye(n + 1, n), np.broadcast_to(u, (9, n))])
        times = np.concatenate([np.zeros(n + 2), h * _STENCIL])
        there = coordinates.advanced(state, times[:, None] * motions, times)
        moving = coordinates.moving(there, motions)
        one_sided = self.one_sided
        found = [
            (("held", k), x) for k, one in enumerate(self.definitions) if one.holds for x in one.held(moving).values()
        ]
        found += [(("push", i), one_sided[i].definition.gaps(moving)[one_sided[i].key]) for i in closed]
        owners, held = _columns(found, n + 10)
        found = []
        if slipping or self.rolling:
            motion, placement = coordinates.motion(motions), coordinates.placement(there)
            found = [(("held", k), x) for k, one in self.rolling for x in one.held_rates(placement, motion).values()]
        found += [(("slip", i), one_sided[i].definition.slips(placement, motion)[one_sided[i].key]) for i in slipping]
        others, turned = _columns(found, n + 10)
        rates = np.concatenate([held.imag / STEP, turned.real], axis=1)
        driven = rates[n]
        return Rows(
            owners + others,
            (rates[:n] - driven).T,
            np.concatenate([held.real[n + 1], np.zeros(len(others))]),
            rates[n + 1],
            (_WEIGHTS @ rates[n + 2 :]) / h,
            driven,
            [one.touch.tangential for one in one_sided],
        )

    def sides(self, numbers: Sequence[int]) -> list[tuple[int, int]]:
        """Return which of some measures are both sides of a place in a guide."""
        where = {self.one_sided[i].name: i for i in numbers}
        pairs = ((i, where.get(self.one_sided[i].opposite, -1)) for i in numbers)
        return [(i, other) for i, other in pairs if i < other]

    def rough(self, numbers: Iterable[int]) -> list[int]:
        """Return those of some measures that have friction."""
        return [i for i in numbers if self.one_sided[i].slips]

    def _shortest(self, state: State) -> float:
        """Return the length (m) of the shortest rod or straight part, whose direction turns most for a move."""
        placement = self.coordinates.placement(state) if self.straights else {}
        return max(min([self.shortest_rod, *(float(_span(part, placement)) for _, part, _ in self.straights)]), 1e-6)

    def loads(self, state: State) -> Floats:
        """Return the forces that places and rates alone give, shape (n,)."""
        coordinates = self.coordinates
        total = coordinates.weights(state, self.gravity)
        if self.pushing:
            placement, motion = coordinates.placement(state), coordinates.motion(state.rates)
            virtual = coordinates.motion(np.eye(coordinates.size))
        for one in self.pushing:
            ahead = one.ahead(placement, motion)
            values = one.laws(ahead, motion)
            efforts = one.efforts(placement, virtual) if values else {}
            for name, value in values.items():
                total = total + value.real * efforts[name]
            total = total + one.load(ahead, motion, virtual).real
        for chain in self.chains:
            total = total - self._gradient(state, chain.potential)
        return total

    def inertia(self, state: State) -> Floats:
        """Return the mass matrix, with what chains add to it."""
        found = self.coordinates.inertia(state)
        for chain in self.chains:
            line = self._gradient(state, lambda placement, chain=chain: chain.sides(placement)[0])  # type: ignore[misc]
            found = found + chain.mass * np.outer(line, line)
        return found

    def own_force(self, chain: ChainDefinition, state: State, accelerations: Floats) -> Floats:
        """Return what the weight and the inertia of a chain do to the bodies at its ends, shape (n,).

        Its sides are straight and change with places linearly: they gain nothing by themselves.
        """
        line = self._gradient(state, lambda placement: chain.sides(placement)[0])
        found: Floats = -self._gradient(state, chain.potential) - chain.mass * line * (line @ accelerations)
        return found

    def gap_rates(self, state: State, numbers: slice = slice(None)) -> tuple[Floats, Floats]:
        """Return gaps and their rates, all or some, shape (k,) each."""
        moving = self.coordinates.moving(state, state.rates)
        gaps = np.array([one.definition.gaps(moving)[one.key] for one in self.one_sided[numbers]], dtype=complex)
        return gaps.real, gaps.imag / STEP

    def spans(self, state: State) -> list[tuple[str, float, float]]:
        """Return the lengths that have to stay positive, with their rates.

        They are those of straight parts of strings beside drums or pegs, and of what pulls along a line.
        """
        placement, motion = self.coordinates.placement(state), self.coordinates.motion(state.rates)
        moves = [
            (name, part) for name, part, bent in self.straights if bent and (part.a.place.body or part.b.place.body)
        ]
        found = [(name, with_rate(lambda x, part=part: _span(part, x), placement, motion)) for name, part in moves]  # type: ignore[misc]
        pulls = [
            one for one in self.definitions if isinstance(one, BetweenPlaces) and not isinstance(one, RodDefinition)
        ]
        found += [(one.name, with_rate(one.distance, placement, motion)) for one in pulls]
        return [(name, float(length), float(change)) for name, (length, change) in found]

    def _gradient(self, state: State, measure: Measure) -> Floats:
        n = self.coordinates.size
        return np.broadcast_to(
            rate(measure, self.coordinates.placement(state), self.coordinates.motion(np.eye(n))), (n,)
        )


def _span(part: Straight, placement: Placement) -> Numbers:
    d = part.between(placement)
    return np.sqrt((d * d).sum(axis=-1) - part.offset**2)


def _columns(found: list[tuple[Owner, Numbers]], count: int) -> tuple[list[Owner], Numbers]:
    """Return measures as columns, and whose each is."""
    parts = [np.broadcast_to(x, (count, *np.shape(x)[1:])).reshape(count, -1) for _, x in found]
    owners = [owner for (owner, _), part in zip(found, parts, strict=True) for _ in range(part.shape[1])]
    return owners, np.concatenate([np.zeros((count, 0)), *parts], axis=1)


def _one_sided(one: Definition, placement: Placement, still: Motion, reader: Reader) -> Iterator[OneSided]:
    """Yield the measures of a connection that stay at or above zero."""
    closes, opens, rolls = "touch", "lift-off", False
    opposite = one.opposite if isinstance(one, Side) else ""
    if isinstance(one, StringDefinition):
        closes, opens = "taut", "slack"
    elif isinstance(one, (Stop, AxialStop)):
        closes, opens = "stop", "release"
    elif opposite:
        opens = "release"
    elif isinstance(one, OnFace):
        rolls = one.tip.size > 0.0
    elif isinstance(one, OnOutline):
        rolls = one.reach > 0.0
    elif isinstance(one, OnRound):
        rims = zip((one.round.a, one.round.b), one.round.radii, strict=True)
        rolls = any(place.body is not None and radius > 0.0 for place, radius in rims)
    connections = dict(zip(reader.scene.names(), reader.scene.connections, strict=True))
    for key in one.gaps(placement):
        touch = one.coefficients
        assert touch is not None, "what is one-sided has coefficients"
        name = key.rsplit(".", 1)[0]
        slip = one.slips(placement, still).get(key)
        connection = connections[name] if name in connections else connections[name.rsplit(".", 1)[0]]
        order = getattr(connection, "order", None)
        when = None if order is None else reader.number(order, ("connections", "order"))
        width = 0 if slip is None else np.size(slip)
        yield OneSided(name, key, one, touch, width, when, closes, opens, "roll" if rolls else "stick", opposite)
