"""What all kinds of connections of described scenes have in common."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import Field, dataclass
from typing import Annotated, Any, ClassVar, Literal, NewType

from core.multibody.algebra.polynomials import is_zero
from core.multibody.language.body import SceneBody
from core.multibody.language.declared_units import Measured
from core.multibody.language.numerals import Numerals
from core.multibody.language.written import Number, Place

Aspect = Literal["turn", "direction", "orientation"]
"""What a connection needs of a body beside its places: its angle, its axes in the plane, its axes in space."""

Occasion = NewType("Occasion", Mapping[str, Any])
"""``{"event": {"kind", "name", "nth"}}`` or ``{"when": {"quantity", "equals", "nth"}}``."""

Moment = Annotated[Number | Occasion, Measured("s")]
"""A time (s) or an occasion."""

ATTITUDE: tuple[Aspect, ...] = ("direction", "orientation")
"""The axes of a body, in the plane or in space."""


@dataclass(frozen=True)
class Surroundings:
    """The bodies among which a connection stands.

    Attributes
    ----------
    bodies : mapping of str to SceneBody
    numerals : Numerals
    plane : bool
        Whether the scene is one of the plane.
    """

    bodies: Mapping[str, SceneBody]
    numerals: Numerals
    plane: bool

    def rim(self, place: object) -> bool:
        """Return whether a place is a body with a radius: a drum or wheel of the plane, a ball of space."""
        body = self.bodies.get(place) if isinstance(place, str) else None
        return body is not None and body.rim is not None

    def outlined(self, place: object) -> bool:
        """Return whether a place is a body that stands for its whole shape, which is more than a circle about it."""
        body = self.bodies.get(place) if isinstance(place, str) else None
        return body is not None and body.shape is not None and not body.round

    def concentric(self, a: object, b: object) -> bool:
        """Return whether two bodies of the plane have one centre, at which a connection joins them."""
        if not self.plane:
            return False
        centres = []
        for place in (a, b):
            name, _, spot = place.partition(".") if isinstance(place, str) else ("", "", "")
            body = self.bodies.get(name)
            if body is None or not body.rigid or spot not in ("", "centre"):
                return False
            centres.append(self.numerals.vector(body.at, ("bodies", name, "at"), 2))
        return all(is_zero(x - y) for x, y in zip(*centres, strict=True))


class Connection:
    """What ties bodies to one another and to the ground; `name` is by default its kind and number."""

    kind: ClassVar[str]
    # Other words for the kind, by which clients may look for it.
    synonyms: ClassVar[tuple[str, ...]] = ()
    # Every kind is a dataclass; here a field would come before those of the kinds.
    __dataclass_fields__: ClassVar[dict[str, Field[Any]]]
    name: str | None

    @property
    def everywhere(self) -> bool:
        """Whether it acts on every body of a scene, and joins none to another."""
        return False

    continues = True
    """Whether a scene with it goes on where a string becomes slack, rather than ends there."""

    @property
    def one_sided(self) -> bool:
        """Whether it may act on one side only, so that touch and lift-off are events of the motion."""
        return False

    def places(self) -> Iterable[object]:
        """Return the places and bodies that it names, as they were written; None for one that it leaves out."""
        return ()

    def formulas(self) -> Iterable[object]:
        """Return the values, as they were written, that may be formulas of the motion."""
        return ()

    def aspects(self, surroundings: Surroundings) -> Iterable[tuple[object, Aspect]]:
        """Return what it needs to know of bodies beside their places: a place of each, as written, and the aspect."""
        return ()

    def occasions(self) -> Mapping[str, object]:
        """Return when it begins or ends, as it was written, by the fields; nothing of what acts all the time."""
        return {}

    @property
    def timed(self) -> bool:
        """Whether it begins or ends."""
        return False

    @property
    def starts(self) -> bool:
        """Whether it acts at the start."""
        return True


@dataclass(frozen=True, kw_only=True)
class TimedConnection(Connection):
    """A connection that may begin and end.

    Attributes
    ----------
    from_, until : moment, optional
        Between which it acts; by default from the start, and to the end. What it takes from the start, as a rod its
        length, is that of its beginning.
    """

    from_: Moment | None = None
    until: Moment | None = None

    def occasions(self) -> Mapping[str, object]:
        """See `Connection.occasions`."""
        return {name: value for name, value in (("from", self.from_), ("until", self.until)) if value is not None}

    @property
    def timed(self) -> bool:
        """See `Connection.timed`."""
        return self.from_ is not None or self.until is not None

    @property
    def starts(self) -> bool:
        """See `Connection.starts`."""
        return self.from_ is None


class TwoEnded(TimedConnection):
    """What is between two places or two bodies."""

    a: Place
    b: Place

    def places(self) -> Iterable[object]:
        """See `Connection.places`."""
        return (self.a, self.b)


def carrier_of(on: object) -> object:
    """Return the place of a surface ``{at, ...}`` as it was written; None of what is no surface."""
    return on.get("at") if isinstance(on, Mapping) else None


def listed(through: object) -> Iterable[Any]:
    """Return the places of a list as it was written; nothing of what is no list."""
    return through if isinstance(through, (list, tuple)) else ()
