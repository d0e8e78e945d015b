"""Connections that hold places or bodies to one another: pins, welds, sliders, rods, tracks."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from typing import ClassVar

from core.multibody.language.connection import (
    ATTITUDE,
    Aspect,
    Connection,
    Surroundings,
    TimedConnection,
    TwoEnded,
    carrier_of,
    listed,
)
from core.multibody.language.written import GROUND, Angle, Direction, Length, Number, Place, Ratio, Surface, Vector


@dataclass(frozen=True)
class Pin(TwoEnded):
    """Two places coincide; in space, with an `axis`, the bodies turn about it only."""

    a: Place
    b: Place
    axis: Direction | None = None
    name: str | None = None
    kind: ClassVar[str] = "pin"

    def aspects(self, surroundings: Surroundings) -> Iterable[tuple[object, Aspect]]:
        """See `Connection.aspects`."""
        if self.axis is None:
            return ()
        return [(end, aspect) for end in (self.a, self.b) for aspect in ATTITUDE]


@dataclass(frozen=True)
class BallJoint(TwoEnded):
    """Two places coincide, in space."""

    a: Place
    b: Place
    name: str | None = None
    kind: ClassVar[str] = "ball-joint"


@dataclass(frozen=True)
class Weld(TwoEnded):
    """Two bodies move as one; their position to each other is that of the start."""

    a: Place
    b: Place
    name: str | None = None
    kind: ClassVar[str] = "weld"

    def aspects(self, surroundings: Surroundings) -> Iterable[tuple[object, Aspect]]:
        """See `Connection.aspects`."""
        if surroundings.concentric(self.a, self.b):
            return [(self.a, "turn"), (self.b, "turn")]
        return [(end, aspect) for end in (self.a, self.b) for aspect in ATTITUDE]


@dataclass(frozen=True)
class Cylindrical(TwoEnded):
    """In space, place `a` stays on a line along the `axis` through place `b`, about which alone the bodies turn."""

    a: Place
    b: Place
    axis: Direction
    name: str | None = None
    kind: ClassVar[str] = "cylindrical"

    def aspects(self, surroundings: Surroundings) -> Iterable[tuple[object, Aspect]]:
        """See `Connection.aspects`."""
        return [(end, aspect) for end in (self.a, self.b) for aspect in ATTITUDE]


@dataclass(frozen=True)
class Screw(TwoEnded):
    """In space, place `a` stays on a line along the `axis` through place `b`, and moves along it as the bodies turn.

    By one turn of `a` relative to `b`, positive about the axis, it moves by the `pitch` (m), negative of a left-hand
    screw.
    """

    a: Place
    b: Place
    axis: Direction
    pitch: Length
    name: str | None = None
    kind: ClassVar[str] = "screw"

    def aspects(self, surroundings: Surroundings) -> Iterable[tuple[object, Aspect]]:
        """See `Connection.aspects`."""
        return [(end, aspect) for end in (self.a, self.b) for aspect in ATTITUDE]


@dataclass(frozen=True)
class Universal(TwoEnded):
    """In space, two places coincide, and the first of two `axes`, fixed in `a`, stays at right angles to the second.

    That is fixed in `b`: the axes are those of the cross of a universal joint.
    """

    a: Place
    b: Place
    axes: Sequence[Direction]
    name: str | None = None
    kind: ClassVar[str] = "universal"

    def aspects(self, surroundings: Surroundings) -> Iterable[tuple[object, Aspect]]:
        """See `Connection.aspects`."""
        return [(end, aspect) for end in (self.a, self.b) for aspect in ATTITUDE]


@dataclass(frozen=True)
class Slider(TwoEnded):
    """Place `a` stays on a line through place `b`, fixed in the body of `b`; the bodies do not turn to each other.

    With a `drive` by time it is that far from `b` along the line (m). In the plane it may rub, with `friction`: one
    coefficient or two, that of sticking first. Its guide holds it without play and without preload: at `a`, or, with a
    `length` (m), at both ends of a block of that length about `a`, and of a `width` (m) across the line.
    """

    a: Place
    b: Place
    slope: Angle | None = None
    direction: Direction | None = None
    drive: Length | None = None
    friction: Ratio | Sequence[Ratio] | None = None
    length: Length | None = None
    width: Length | None = None
    name: str | None = None
    kind: ClassVar[str] = "slider"

    @property
    def one_sided(self) -> bool:
        """See `Connection.one_sided`: where it rubs it sticks or slides, on one side of its guide or the other."""
        return self.friction is not None

    def aspects(self, surroundings: Surroundings) -> Iterable[tuple[object, Aspect]]:
        """See `Connection.aspects`."""
        more: tuple[Aspect, ...] = () if self.length is None else ("turn",)
        return [(end, aspect) for end in (self.a, self.b) for aspect in (*ATTITUDE, *more)]


@dataclass(frozen=True)
class Rod(TwoEnded):
    """Two places stay at a distance: the one they start at, unless a length is given, or a `drive` by time (m)."""

    a: Place
    b: Place
    length: Length | None = None
    drive: Length | None = None
    name: str | None = None
    kind: ClassVar[str] = "rod"


@dataclass(frozen=True)
class GuideCurve(TimedConnection):
    """A place stays on a curve or surface.

    `on` is a line ``{at, slope}`` (in space ``{at, direction}``), a circle or sphere ``{at, radius}``, a parabola
    ``{at, curvature, slope}`` (y = curvature x^2/2 from its vertex), in space a plane ``{at, normal}``. By formula it
    is a ``{surface}`` on which a function of x, y and z is zero, or a ``{curve, start}``: components by a parameter u,
    and a guess of that at the start. These formulas may have the time t.
    On a line or circle of the plane it may rub, with `friction`: one coefficient or two, that of sticking first.
    """

    place: Place
    on: Surface
    friction: Ratio | Sequence[Ratio] | None = None
    name: str | None = None
    kind: ClassVar[str] = "track"

    @property
    def one_sided(self) -> bool:
        """See `Connection.one_sided`: where it rubs it sticks or slides, on one side of the curve or the other."""
        return self.friction is not None

    def places(self) -> Iterable[object]:
        """See `Connection.places`."""
        return (self.place, carrier_of(self.on))

    def formulas(self) -> Iterable[object]:
        """See `Connection.formulas`."""
        return (self.on.get("surface"), *listed(self.on.get("curve"))) if isinstance(self.on, Mapping) else ()

    def aspects(self, surroundings: Surroundings) -> Iterable[tuple[object, Aspect]]:
        """See `Connection.aspects`."""
        return [(carrier_of(self.on), aspect) for aspect in ATTITUDE]


@dataclass(frozen=True)
class Relation(TimedConnection):
    """A formula of places and angles equals a number, or another formula: gears, racks, screws, belts."""

    of: str
    equals: Number = 0
    name: str | None = None
    kind: ClassVar[str] = "relation"

    def formulas(self) -> Iterable[object]:
        """See `Connection.formulas`."""
        return (self.of, self.equals)


def axes_of_turn(connections: Iterable[tuple[int, Connection]], a: str, b: str) -> dict[int, Vector]:
    """Return the axes about which body `a` turns relative to another, as they were written, by numbers of their joints.

    Parameters
    ----------
    connections : iterable of (int, Connection)
        Each with its number in the description.
    a, b : str
        Of the bodies; the ground is one.
    """
    found: dict[int, Vector] = {}
    for i, one in connections:
        if isinstance(one, (Pin, Cylindrical, Screw)) and one.axis is not None:
            ends = {end.partition(".")[0] if isinstance(end, str) else GROUND for end in (one.a, one.b)}
            if ends == {a, b}:
                found[i] = one.axis
    return found
