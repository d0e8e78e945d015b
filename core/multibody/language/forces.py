"""Connections that pull or drive: springs, attraction, dampers, motors, spinning frames, constant forces."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from typing import Annotated, ClassVar, Literal

from core.multibody.language.connection import (
    ATTITUDE,
    Aspect,
    Connection,
    Moment,
    Surroundings,
    TimedConnection,
    TwoEnded,
    listed,
)
from core.multibody.language.declared_units import Measured
from core.multibody.language.written import GROUND, Acceleration, Angle, Length, Number, Place, Vector

AngularRate = Annotated[Number, Measured("rad/s")]
"""A number in radians per second."""

Force = Annotated[Vector, Measured("N")]
"""A vector in newtons."""


def _turns(connection: TwoEnded, surroundings: Surroundings) -> Iterable[tuple[object, Aspect]]:
    """Return what a connection of two turns needs of its bodies."""
    return [(end, "turn" if surroundings.plane else "orientation") for end in (connection.a, connection.b)]


@dataclass(frozen=True)
class Spring(TwoEnded):
    """A spring between two places, linear by its `stiffness` (N/m) or with its pull as a formula `law` (N).

    It is unstretched at the start unless a rest length is given. A law has the names `stretch`, `length` and `rate`.
    """

    a: Place
    b: Place
    stiffness: Annotated[Number, Measured("N/m")] | None = None
    rest_length: Length | None = None
    law: str | None = None
    name: str | None = None
    kind: ClassVar[str] = "spring"

    def formulas(self) -> Iterable[object]:
        """See `Connection.formulas`."""
        return (self.law,)


@dataclass(frozen=True)
class TorsionSpring(TwoEnded):
    """A linear spring between the turns of two bodies, or of one and the ground (N m/rad).

    In space they turn about the axis of the joint between them, from the start, where their turn is zero.
    """

    a: str
    stiffness: Annotated[Number, Measured("N m/rad")]
    b: str = GROUND
    rest_angle: Angle | None = None
    name: str | None = None
    kind: ClassVar[str] = "torsion-spring"

    def aspects(self, surroundings: Surroundings) -> Iterable[tuple[object, Aspect]]:
        """See `Connection.aspects`."""
        return _turns(self, surroundings)


@dataclass(frozen=True)
class Gravitation(TwoEnded):
    """Two bodies attract one another by their masses, as their centres do: constant m_a m_b/r^2."""

    a: str
    b: str
    constant: Annotated[Number, Measured("m^3/kg/s^2")] = "6.6743e-11"
    name: str | None = None
    kind: ClassVar[str] = "gravitation"


@dataclass(frozen=True)
class InverseSquare(TwoEnded):
    """Two places attract one another by strength/r^2 (N m^2); a negative strength repels, as equal charges do."""

    a: Place
    b: Place
    strength: Annotated[Number, Measured("N m^2")]
    name: str | None = None
    kind: ClassVar[str] = "inverse-square"


@dataclass(frozen=True)
class Damper(TwoEnded):
    """A force against the rate of a distance (N s/m), or with `measure` "turn" against that of a turn (N m s).

    It is the `coefficient` times that rate, or a formula `law` of it.
    """

    a: Place
    coefficient: Annotated[Number, Measured("N s/m", of_turn="N m s")] | None = None
    b: Place = GROUND
    measure: Literal["length", "turn"] = "length"
    law: str | None = None
    name: str | None = None
    kind: ClassVar[str] = "damper"

    def aspects(self, surroundings: Surroundings) -> Iterable[tuple[object, Aspect]]:
        """See `Connection.aspects`."""
        if self.measure != "turn":
            return ()
        return _turns(self, surroundings)

    def formulas(self) -> Iterable[object]:
        """See `Connection.formulas`."""
        return (self.law,)


@dataclass(frozen=True)
class Motor(TwoEnded):
    """Body `a` turns at a given rate relative to body `b` or the ground (rad/s), or by a `drive` (rad).

    Both may be formulas of time. In space it turns about the axis of the joint between the two, from the start.
    """

    a: str
    rate: AngularRate | None = None
    b: str = GROUND
    drive: Angle | None = None
    name: str | None = None
    kind: ClassVar[str] = "motor"

    def aspects(self, surroundings: Surroundings) -> Iterable[tuple[object, Aspect]]:
        """See `Connection.aspects`."""
        return _turns(self, surroundings)


@dataclass(frozen=True)
class SpinningFrame(Connection):
    """The scene is seen from a frame that spins (rad/s).

    In space about the vertical through `at`. In the plane about the vertical in the plane, unless `about` is "normal".
    """

    rate: AngularRate
    at: Annotated[Vector, Measured("m")] | None = None
    about: Literal["vertical", "normal"] = "vertical"
    name: str | None = None
    kind: ClassVar[str] = "spinning-frame"

    @property
    def everywhere(self) -> bool:
        """See `Connection.everywhere`."""
        return True

    def aspects(self, surroundings: Surroundings) -> Iterable[tuple[object, Aspect]]:
        """See `Connection.aspects`."""
        return () if surroundings.plane else [(name, "orientation") for name in surroundings.bodies]


@dataclass(frozen=True)
class AppliedForce(TimedConnection):
    """A force on a place (N), whose components are numbers or formulas.

    With `in_` "body" they are along the axes of the body, and turn with it.
    """

    place: Place
    force: Force
    in_: Literal["body"] | None = None
    name: str | None = None
    kind: ClassVar[str] = "force"

    def places(self) -> Iterable[object]:
        """See `Connection.places`."""
        return (self.place,)

    def formulas(self) -> Iterable[object]:
        """See `Connection.formulas`."""
        return listed(self.force)

    def aspects(self, surroundings: Surroundings) -> Iterable[tuple[object, Aspect]]:
        """See `Connection.aspects`."""
        return [(self.place, aspect) for aspect in ATTITUDE] if self.in_ == "body" else ()


@dataclass(frozen=True)
class Torque(TimedConnection):
    """A torque on a body (N m): in the plane a number or formula, in space a vector of them.

    In space with `in_` "body" the components are along the axes of the body, and turn with it.
    """

    body: str
    torque: Annotated[Number | Vector, Measured("N m")]
    in_: Literal["body"] | None = None
    name: str | None = None
    kind: ClassVar[str] = "torque"

    def places(self) -> Iterable[object]:
        """See `Connection.places`."""
        return (self.body,)

    def formulas(self) -> Iterable[object]:
        """See `Connection.formulas`."""
        return (*listed(self.torque), self.torque)

    def aspects(self, surroundings: Surroundings) -> Iterable[tuple[object, Aspect]]:
        """See `Connection.aspects`."""
        return [(self.body, "turn" if surroundings.plane else "orientation")]


@dataclass(frozen=True)
class Field(TimedConnection):
    """A force (N) or an acceleration (m/s^2) of every body, or of some, by numbers and formulas of its centre."""

    acceleration: Acceleration | None = None
    force: Force | None = None
    on: Sequence[str] | None = None
    name: str | None = None
    kind: ClassVar[str] = "field"

    @property
    def everywhere(self) -> bool:
        """See `Connection.everywhere`."""
        return self.on is None

    def places(self) -> Iterable[object]:
        """See `Connection.places`."""
        return listed(self.on)

    def formulas(self) -> Iterable[object]:
        """See `Connection.formulas`."""
        return [*listed(self.acceleration), *listed(self.force)]


@dataclass(frozen=True)
class Blow(Connection):
    """A blow: an impulse on a `place` (N s), or with a `body` in place of it an impulsive torque on that (N m s).

    It falls `at` a time or event, by default at the start. With `in_` "body" its components are along the axes of the
    body. In the plane that of a body is one number.
    """

    impulse: Annotated[Number | Vector, Measured("N s", of_turn="N m s")]
    place: Place | None = None
    body: str | None = None
    at: Moment = 0
    in_: Literal["body"] | None = None
    name: str | None = None
    kind: ClassVar[str] = "impulse"
    synonyms: ClassVar[tuple[str, ...]] = ("blow", "strike", "hit", "kick")

    @property
    def measure(self) -> str:
        """What it acts along: a "length" or a "turn", which decides its unit."""
        return "length" if self.body is None else "turn"

    def places(self) -> Iterable[object]:
        """See `Connection.places`."""
        return (self.place, self.body)

    def aspects(self, surroundings: Surroundings) -> Iterable[tuple[object, Aspect]]:
        """See `Connection.aspects`."""
        if self.body is not None:
            return [(self.body, "turn" if surroundings.plane else "orientation")]
        return [(self.place, aspect) for aspect in ATTITUDE] if self.in_ == "body" else ()

    def occasions(self) -> Mapping[str, object]:
        """See `Connection.occasions`."""
        return {"at": self.at}
