"""Connections by touch: rolling without slip, and contacts that push and do not pull."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any, ClassVar, Literal

from core.multibody.language.connection import ATTITUDE, Aspect, Surroundings, TimedConnection, carrier_of
from core.multibody.language.written import Angle, Place, Ratio, Surface

ImpactLaw = Literal["newton", "poisson", "stronge"]
"""Law of impact: restitution by the rates of the gap, by the impulse, or by the work along the gap."""

Simultaneous = Literal["together", "in order", "undecided"]
"""What happens where contacts take impulses at one time: all act together, one after another, or mechanics leaves it
open unless every order has one outcome."""


class SurfaceConnection(TimedConnection):
    """What touches a surface of the ground or of a body: `place` touches `on`, or `a` touches `b`."""

    place: Place | None
    on: Surface | None
    a: Place | None
    b: Place | None

    @property
    def surface(self) -> Mapping[str, Any]:
        """What `place` touches; empty where two bodies touch."""
        return {} if self.on is None else self.on

    def turns(self, place: object, surroundings: Surroundings) -> bool:
        """Return whether the slip at a place depends on the turn of its body."""
        raise NotImplementedError

    def places(self) -> Iterable[object]:
        """See `Connection.places`."""
        return (self.place, self.a, self.b, carrier_of(self.on))

    def aspects(self, surroundings: Surroundings) -> Iterable[tuple[object, Aspect]]:
        """See `Connection.aspects`."""
        for aspect in ATTITUDE:
            yield carrier_of(self.on), aspect
        for place in (self.place, self.a, self.b):
            if self.turns(place, surroundings):
                yield place, "turn"
            for aspect in ATTITUDE if surroundings.outlined(place) else ():
                yield place, aspect


@dataclass(frozen=True)
class Rolling(SurfaceConnection):
    """A rim rolls without slip: `place` on a face or circle `on`, or body `a` on body `b`, or `inside` it."""

    place: str | None = None
    on: Surface | None = None
    a: str | None = None
    b: str | None = None
    inside: bool = False
    name: str | None = None
    kind: ClassVar[str] = "rolling"

    def turns(self, place: object, surroundings: Surroundings) -> bool:
        """See `SurfaceConnection.turns`; in space what is no ball rolls by its axes."""
        return surroundings.plane or not surroundings.outlined(place)


@dataclass(frozen=True)
class Contact(SurfaceConnection):
    """What touches pushes and does not pull.

    `place`, a point or a body with a rim or a shape, does not pass `on`: a face ``{at, slope}``, free on the left
    of its slope, or a circle ``{at, radius}``, from inside if the radius is negative, an edge if it is 0. In space
    a face is a plane ``{at, normal}``, free on the side of its normal, about which it may turn at a `rate` (rad/s), and
    a circle is a sphere. Or `a` does not pass `b`, of which one has a rim or a shape at least. Or with `measure`
    "turn", the turn of `a` relative to `b` stays `at_least` or `at_most` an angle; in space it is that about the axis
    of their joint, from the start. `friction` is one coefficient or two, that of sticking first; `order` says, where
    several impacts at once leave their outcome open, in which order they happen: those of equal order together.
    `impacts` is the law of its impacts, that of the scene if left out. `tangential_restitution` is the share of its
    slip that an impact turns back where friction suffices.
    """

    place: Place | None = None
    on: Surface | None = None
    a: Place | None = None
    b: Place | None = None
    measure: Literal["gap", "turn"] = "gap"
    at_least: Angle | None = None
    at_most: Angle | None = None
    friction: Ratio | Sequence[Ratio] | None = None
    restitution: Ratio | None = None
    tangential_restitution: Ratio | None = None
    order: Ratio | None = None
    impacts: ImpactLaw | None = None
    name: str | None = None
    kind: ClassVar[str] = "contact"

    one_sided = True

    def turns(self, place: object, surroundings: Surroundings) -> bool:
        """See `SurfaceConnection.turns`; in space a ball alone has friction that turns it."""
        return surroundings.plane or (self.friction is not None and surroundings.rim(place))

    def aspects(self, surroundings: Surroundings) -> Iterable[tuple[object, Aspect]]:
        """See `Connection.aspects`; a stop of space needs the axes of what it stops."""
        yield from super().aspects(surroundings)
        if self.measure == "turn" and not surroundings.plane:
            yield from ((end, "orientation") for end in (self.a, self.b))
