"""The language of described scenes: bodies, places, connections, as frozen dataclasses that hold what was written.

Four nouns suffice. A *body* has mass, a *place* is a point of a body or of the ground, a *connection* ties places or
turns, and a *question* (outputs, times) is put to the whole. Numbers are stored as they were written and read exactly
by `core.multibody.language.numerals`; what they mean is checked where the table is built, with the path to the fault.
"""

from __future__ import annotations

from collections.abc import Collection, Iterable, Mapping, Sequence, Sized
from dataclasses import dataclass, field, fields
from types import MappingProxyType
from typing import Literal, get_args

from core.errors import InvalidParameter, Path
from core.formulas import names_in
from core.multibody.language.body import SceneBody
from core.multibody.language.connection import Connection
from core.multibody.language.contacts import ImpactLaw, Simultaneous
from core.multibody.language.declared_units import check_units
from core.multibody.language.faults_of_parts import FaultsOfParts
from core.multibody.language.numerals import LONGEST_NAME, NAME, member
from core.multibody.language.switches import SWITCHING
from core.multibody.language.tabulated import is_table
from core.multibody.language.written import GROUND, Acceleration, Number
from core.near_names import did_you_mean

MOST_BODIES = 100
"""Bodies of a scene: the cost of its equations grows as the cube of their number."""

MOST_CONNECTIONS = 400
"""Connections of a scene: four for every body."""


def check_size(bodies: Sized, connections: Sized) -> None:
    """Raise `InvalidParameter` for more bodies or connections than a scene may have."""
    for name, given, most in (("bodies", bodies, MOST_BODIES), ("connections", connections, MOST_CONNECTIONS)):
        if len(given) > most:
            raise InvalidParameter(name, f"have at most {most} entries, not {len(given)}")


@dataclass(frozen=True)
class Scene:
    """Bodies and what connects them.

    Attributes
    ----------
    bodies : mapping of str to SceneBody
    connections : sequence of Connection
    gravity : vector, optional
        Acceleration of free fall (m/s^2), of two or three components; it decides plane or space. None without one.
    let : mapping of str to number
        Named numbers that formulas may use, formulas of the motion, and functions by points: ``{points,
        interpolation, outside}``.
    numbers : {"decimals", "doubles"}
        Whether 0.1 is the decimal or the double nearest to it.
    impacts : {"newton", "poisson", "stronge"}
        Law of the impacts of contacts that name none of their own.
    simultaneous : {"undecided", "together", "in order"}
        How contacts act that take impulses at one time: all together; one after another, by their `order` or as they
        are listed, the first of those that approach; or undecided, unless every order has one outcome.
    assemble : "nearest" or mapping, optional
        Takes places and velocities as a sketch, in place of which the nearest are found that satisfy the connections;
        ``{"nearest": [names]}`` moves these bodies alone.
    attitudes : bool
        Whether the whole attitude of every rigid body of space is followed, also of a top, of which the axis suffices.
    """

    bodies: Mapping[str, SceneBody]
    connections: Sequence[Connection] = ()
    gravity: Acceleration | None = None
    let: Mapping[str, Number] = field(default_factory=lambda: MappingProxyType({}))
    numbers: Literal["decimals", "doubles"] = "decimals"
    assemble: Literal["nearest"] | Mapping[str, Sequence[str]] | None = None
    impacts: ImpactLaw = "newton"
    simultaneous: Simultaneous = "undecided"
    attitudes: bool = False

    def __post_init__(self) -> None:
        if not isinstance(self.bodies, Mapping) or not self.bodies:
            raise InvalidParameter("bodies", "name at least one body")
        if isinstance(self.connections, (str, Mapping)) or not isinstance(self.connections, Sequence):
            raise InvalidParameter("connections", "be a list")
        if not isinstance(self.let, Mapping):
            raise InvalidParameter("let", "be an object of names and numbers")
        check_size(self.bodies, self.connections)
        if not isinstance(self.attitudes, bool):
            raise InvalidParameter("attitudes", "be true or false")
        _check_word("impacts", self.impacts, get_args(ImpactLaw))
        _check_word("simultaneous", self.simultaneous, get_args(Simultaneous))
        for name, body in self.bodies.items():
            check_name(name, member(("bodies",), name))
            if not isinstance(body, SceneBody):
                raise InvalidParameter(("bodies", name), "be a body")
            if not isinstance(body.places, Mapping):
                raise InvalidParameter(("bodies", name, "places"), "be an object of names and vectors")
            for place in body.places:
                check_name(place, member(("bodies", name, "places"), place))
        for i, connection in enumerate(self.connections):
            if not isinstance(connection, Connection):
                raise InvalidParameter(("connections", i), "be a connection")
        self.names()
        faults = FaultsOfParts()
        parts = [((), self), *((("bodies", name), body) for name, body in self.bodies.items())]
        for path, part in [*parts, *((("connections", i), one) for i, one in self.numbered())]:
            with faults.part():
                check_units(part, path)
        faults.raised()

    def numbered(self) -> Iterable[tuple[int, Connection]]:
        """Return the connections, each with its number in the description."""
        return enumerate(self.connections)

    @property
    def one_sided(self) -> bool:
        """Whether it has anything that pushes and does not pull, or a string of which a jerk is foreseen."""
        return any(connection.one_sided for connection in self.connections)

    @property
    def changes(self) -> bool:
        """Whether connections begin or end, or blows fall."""
        return any(connection.occasions() for connection in self.connections)

    @property
    def switches(self) -> bool:
        """Whether a formula may have several pieces."""
        return any(map(self.switches_in, self.connections))

    def switches_in(self, connection: Connection) -> bool:
        """Return whether a formula of a connection may have several pieces, by what it and its `let` name."""
        kinked = {*SWITCHING, *(name for name, value in self.let.items() if is_table(value))}
        used, texts = set[str](), [text for text in connection.formulas() if isinstance(text, str)]
        while texts:
            named = names_in(texts.pop()) - used
            used |= named
            texts.extend(value for value in map(self.let.get, named) if isinstance(value, str))
        return not kinked.isdisjoint(used)

    @property
    def continues(self) -> bool:
        """Whether its motion goes on where a string becomes slack: with a chain it does not."""
        return all(connection.continues for connection in self.connections)

    def names(self) -> tuple[str, ...]:
        """Return the names of the connections: those given, else kind and number."""
        found: dict[str, int] = {}
        for i, connection in self.numbered():
            given = connection.name
            if given is not None:
                check_name(given, ("connections", i, "name"))
            name = f"{connection.kind}-{i + 1}" if given is None else given
            if name in found or name in self.bodies:
                raise InvalidParameter(
                    ("connections", i, "name"),
                    f'be a name of its own; "{name}" has another owner',
                    remedy=f'call it "{_unlike(name, {*found, *self.bodies})}", say',
                )
            found[name] = i
        return tuple(found)


@dataclass(frozen=True)
class ScenePart(Scene):
    """Some bodies of a scene with their connections, which keep the numbers that they have in the description.

    Attributes
    ----------
    numbers_of_connections : tuple of int
    """

    numbers_of_connections: tuple[int, ...] = ()

    def numbered(self) -> Iterable[tuple[int, Connection]]:
        """Return the connections, each with its number in the description."""
        return zip(self.numbers_of_connections, self.connections, strict=True)


def part_of(scene: Scene, numbers: Collection[int], bodies: Collection[str] | None = None) -> ScenePart:
    """Return the part of a scene with the connections of some numbers, and some of the bodies or all."""
    own = [(number, connection) for number, connection in scene.numbered() if number in numbers]
    given = {entry.name: getattr(scene, entry.name) for entry in fields(Scene)}
    given["connections"] = tuple(connection for _, connection in own)
    if bodies is not None:
        given["bodies"] = {name: scene.bodies[name] for name in bodies}
    return ScenePart(**given, numbers_of_connections=tuple(number for number, _ in own))


def at_start(scene: Scene) -> Scene:
    """Return a scene with the connections that act at the start, and without blows."""
    if not scene.changes:
        return scene
    return part_of(scene, {number for number, one in scene.numbered() if one.starts and "at" not in one.occasions()})


def _unlike(name: str, others: set[str]) -> str:
    """Return a name followed by the first number that makes it another."""
    return next(new for k in range(2, len(others) + 3) if (new := f"{name[: LONGEST_NAME - 5]}-{k}") not in others)


def _check_word(field: str, value: object, words: Sequence[str]) -> None:
    if value not in words:
        raise InvalidParameter(field, f"be one of {', '.join(words)}", remedy=did_you_mean(value, words))


def check_name(name: object, path: Path) -> None:
    """Raise `InvalidParameter` unless something may be called so."""
    if not isinstance(name, str) or not NAME.fullmatch(name) or name == GROUND:
        rule = (
            f'have a name of at most {LONGEST_NAME} letters, digits, "-" and "_" '
            f'that begins with a letter and is not "{GROUND}"'
        )
        raise InvalidParameter(path, rule)
