"""Strings and chains."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, field
from types import MappingProxyType
from typing import Annotated, Any, ClassVar

from core.multibody.language.connection import Aspect, Connection, Surroundings, TimedConnection, listed
from core.multibody.language.declared_units import Measured
from core.multibody.language.written import Length, Number, Place, Ratio


@dataclass(frozen=True)
class String(TimedConnection):
    """An inextensible string through places and over drums; a drum without slip divides it.

    It is taut at the start unless it is longer than its way. `restitution` is that of the jerk when it becomes taut;
    where it is given, velocities may open or jerk the string at the start. Between its ends it may rub on pegs, points
    of the ground, or on one drum, with `friction`: one coefficient or two, that of sticking first. Around them it winds
    by the angle between its parts, and as many whole `turns` beside that. With a `drive` it is as long as that says by
    time (m).
    """

    through: Sequence[Place]
    sides: Mapping[str, Any] = field(default_factory=lambda: MappingProxyType({}))
    slips: Sequence[str] = ()
    length: Length | None = None
    drive: Length | None = None
    restitution: Ratio | None = None
    order: Ratio | None = None
    friction: Ratio | Sequence[Ratio] | None = None
    turns: Ratio | None = None
    name: str | None = None
    kind: ClassVar[str] = "string"

    @property
    def one_sided(self) -> bool:
        """See `Connection.one_sided`: where a jerk is foreseen, and where it sticks or slips on pegs."""
        return self.restitution is not None or self.friction is not None

    def places(self) -> Iterable[object]:
        """See `Connection.places`."""
        return listed(self.through)

    def aspects(self, surroundings: Surroundings) -> Iterable[tuple[object, Aspect]]:
        """See `Connection.aspects`."""
        return [(place, "turn") for place in listed(self.through) if surroundings.rim(place)]


@dataclass(frozen=True)
class Chain(Connection):
    """A heavy inextensible chain of the plane from a body over a small smooth peg of the ground to another body.

    `through` names these three places. Both sides are straight: they hang, or lie on smooth faces, and an end stays on
    the line from the peg through its place. A bare end is a body of mass 0. `density` is the mass per length (kg/m);
    the length is that of the way at the start unless it is given. A chain is followed until it lifts off the peg, or
    until one of its ends comes there.
    """

    through: Sequence[Place]
    density: Annotated[Number, Measured("kg/m")]
    length: Length | None = None
    name: str | None = None
    kind: ClassVar[str] = "chain"

    continues = False

    def places(self) -> Iterable[object]:
        """See `Connection.places`."""
        return listed(self.through)
