"""The kinds of connections of described scenes, as frozen dataclasses that hold what was written."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from decimal import Decimal
from fractions import Fraction
from types import MappingProxyType
from typing import Any, ClassVar, Literal

Number = int | float | str | Decimal | Fraction | Mapping[str, Any]
"""A decimal, a formula over names in ``let``, or ``{"degrees": number}``."""

Vector = Sequence[Number] | Mapping[str, Any]
"""A list of two or three numbers, or in the plane ``{"polar": [distance, angle]}``."""

Place = str | Vector
"""``"body"`` (its centre of mass), ``"body.place"``, or a point of the ground."""

GROUND = "ground"


@dataclass(frozen=True)
class Connection:
    """What ties bodies to one another and to the ground; `name` is by default its kind and number."""

    kind: ClassVar[str]


@dataclass(frozen=True)
class Pin(Connection):
    """Two places coincide; in space, with an `axis`, the bodies turn about it only."""

    a: Place
    b: Place
    axis: Vector | None = None
    name: str | None = None
    kind: ClassVar[str] = "pin"


@dataclass(frozen=True)
class BallJoint(Connection):
    """Two places coincide, in space."""

    a: Place
    b: Place
    name: str | None = None
    kind: ClassVar[str] = "ball-joint"


@dataclass(frozen=True)
class Weld(Connection):
    """Two bodies move as one; their position to each other is that of the start."""

    a: Place
    b: Place
    name: str | None = None
    kind: ClassVar[str] = "weld"


@dataclass(frozen=True)
class Slider(Connection):
    """Place `a` stays on a line through place `b`, fixed in the body of `b`; the bodies do not turn to each other."""

    a: Place
    b: Place
    slope: Number | None = None
    direction: Vector | None = None
    name: str | None = None
    kind: ClassVar[str] = "slider"


@dataclass(frozen=True)
class Rod(Connection):
    """Two places stay at a distance: the one they start at, unless a length is given."""

    a: Place
    b: Place
    length: Number | None = None
    name: str | None = None
    kind: ClassVar[str] = "rod"


@dataclass(frozen=True)
class Rolling(Connection):
    """A rim rolls without slip: `place` on a face or circle `on`, or body `a` on body `b`, or `inside` it."""

    place: str | None = None
    on: Mapping[str, Any] | None = None
    a: str | None = None
    b: str | None = None
    inside: bool = False
    name: str | None = None
    kind: ClassVar[str] = "rolling"


@dataclass(frozen=True)
class Track(Connection):
    """A place stays on a curve or surface.

    `on` is a line ``{at, slope}`` (in space ``{at, direction}``), a circle or sphere ``{at, radius}``, a parabola
    ``{at, curvature, slope}`` (y = curvature x^2/2 from its vertex), in space a plane ``{at, normal}``.
    """

    place: Place
    on: Mapping[str, Any]
    name: str | None = None
    kind: ClassVar[str] = "track"


@dataclass(frozen=True)
class Contact(Connection):
    """What touches pushes and does not pull.

    `place`, a point or a body with a rim, does not pass `on`: a face ``{at, slope}``, free on the left of its slope, or
    a circle ``{at, radius}``, from inside if the radius is negative, an edge if it is 0. In space a face is a plane
    ``{at, normal}``, free on the side of its normal, and a circle is a sphere. Or `a` does not pass `b`, of which one
    has a rim at least. Or with `measure` "turn", the turn of `a` relative to `b` stays `at_least` or
    `at_most` an angle. `friction` is one coefficient or two, that of sticking first; `order` says, where several
    impacts at once leave their outcome open, in which order they happen: those of equal order together.
    """

    place: Place | None = None
    on: Mapping[str, Any] | None = None
    a: Place | None = None
    b: Place | None = None
    measure: Literal["gap", "turn"] = "gap"
    at_least: Number | None = None
    at_most: Number | None = None
    friction: Number | Sequence[Number] | None = None
    restitution: Number | None = None
    order: Number | None = None
    name: str | None = None
    kind: ClassVar[str] = "contact"


@dataclass(frozen=True)
class String(Connection):
    """An inextensible string through places and over drums; a drum without slip divides it.

    It is taut at the start unless it is longer than its way. `restitution` is that of the jerk when it becomes taut;
    where it is given, velocities may open or jerk the string at the start.
    """

    through: Sequence[Place]
    sides: Mapping[str, Any] = field(default_factory=lambda: MappingProxyType({}))
    slips: Sequence[str] = ()
    length: Number | None = None
    restitution: Number | None = None
    order: Number | None = None
    name: str | None = None
    kind: ClassVar[str] = "string"


@dataclass(frozen=True)
class Chain(Connection):
    """A heavy inextensible chain of the plane from a body over a small smooth peg of the ground to another body.

    `through` names these three places. Both sides are straight: they hang, or lie on smooth faces, and an end stays on
    the line from the peg through its place. A bare end is a body of mass 0. `density` is the mass per length (kg/m);
    the length is that of the way at the start unless it is given. A chain is followed until it lifts off the peg, or
    until one of its ends comes there.
    """

    through: Sequence[Place]
    density: Number
    length: Number | None = None
    name: str | None = None
    kind: ClassVar[str] = "chain"


@dataclass(frozen=True)
class Spring(Connection):
    """A linear spring between two places (N/m); unstretched at the start unless a rest length is given."""

    a: Place
    b: Place
    stiffness: Number
    rest_length: Number | None = None
    name: str | None = None
    kind: ClassVar[str] = "spring"


@dataclass(frozen=True)
class TorsionSpring(Connection):
    """A linear spring between the turns of two bodies, or of one and the ground (N m/rad), in the plane."""

    a: str
    stiffness: Number
    b: str = GROUND
    rest_angle: Number | None = None
    name: str | None = None
    kind: ClassVar[str] = "torsion-spring"


@dataclass(frozen=True)
class Gravitation(Connection):
    """Two bodies attract one another by their masses, as their centres do: constant m_a m_b/r^2."""

    a: str
    b: str
    constant: Number = "6.6743e-11"
    name: str | None = None
    kind: ClassVar[str] = "gravitation"


@dataclass(frozen=True)
class InverseSquare(Connection):
    """Two places attract one another by strength/r^2 (N m^2); a negative strength repels, as equal charges do."""

    a: Place
    b: Place
    strength: Number
    name: str | None = None
    kind: ClassVar[str] = "inverse-square"


@dataclass(frozen=True)
class Damper(Connection):
    """A force against the rate of a distance (N s/m), or with `measure` "turn" against that of a turn (N m s)."""

    a: Place
    coefficient: Number
    b: Place = GROUND
    measure: Literal["length", "turn"] = "length"
    name: str | None = None
    kind: ClassVar[str] = "damper"


@dataclass(frozen=True)
class Motor(Connection):
    """Body `a` turns at a given rate relative to body `b` or the ground (rad/s), in the plane."""

    a: str
    rate: Number
    b: str = GROUND
    name: str | None = None
    kind: ClassVar[str] = "motor"


@dataclass(frozen=True)
class SpinningFrame(Connection):
    """The scene is seen from a frame that spins (rad/s).

    In space about the vertical through `at`. In the plane about the vertical in the plane, unless `about` is "normal".
    """

    rate: Number
    at: Vector | None = None
    about: Literal["vertical", "normal"] = "vertical"
    name: str | None = None
    kind: ClassVar[str] = "spinning-frame"


@dataclass(frozen=True)
class Force(Connection):
    """A constant force on a place (N)."""

    place: Place
    force: Vector
    name: str | None = None
    kind: ClassVar[str] = "force"


@dataclass(frozen=True)
class Torque(Connection):
    """A constant torque on a body (N m): a number in the plane, a vector in space."""

    body: str
    torque: Number | Vector
    name: str | None = None
    kind: ClassVar[str] = "torque"


KINDS: Mapping[str, type[Any]] = MappingProxyType(
    {
        cls.kind: cls
        for cls in (
            Pin,
            BallJoint,
            Weld,
            Slider,
            Rod,
            Rolling,
            Track,
            Contact,
            String,
            Chain,
            Spring,
            TorsionSpring,
            Gravitation,
            InverseSquare,
            Damper,
            Motor,
            SpinningFrame,
            Force,
            Torque,
        )
    }
)
"""The catalogue of connections."""

NOT_YET = ("impulse",)
"""Kinds that the language foresees and that no model answers yet."""
