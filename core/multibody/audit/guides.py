"""Guides that rub: a slider or track of the plane as contacts on both sides of a line or circle, without play."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, replace
from typing import ClassVar

import numpy as np

from core.multibody.audit.bodies import Path, Reader
from core.multibody.audit.coefficients import touch_of
from core.multibody.audit.contacts import OnFace, OnRound
from core.multibody.audit.definition import Definition, Touch
from core.multibody.audit.joints import attitude_to, moments_between
from core.multibody.audit.outlines import ByCorners
from core.multibody.audit.placement import Motion, Numbers, Place, Placement
from core.multibody.audit.surfaces import Face, Round, Tip
from core.multibody.language.joints import GuideCurve, Slider

SIDES_OF_GUIDE = (1.0, -1.0)
"""Both sides of a line, that of its normal first; of a circle, outside and inside."""


@dataclass(frozen=True)
class Side(Definition):
    """One side of a guide at one place; both sides slip along one direction, by a sign each.

    Attributes
    ----------
    touching : OnFace or OnRound
    sign : float
    opposite : str
        The name of the other side.
    """

    kind: ClassVar[str] = "contact"
    touching: OnFace | OnRound
    sign: float
    opposite: str

    @property
    def coefficients(self) -> Touch | None:
        """See `Definition.coefficients`."""
        return self.touching.coefficients

    @property
    def reach(self) -> float:
        """See `Definition.reach`."""
        return self.touching.reach

    @property
    def excluded(self) -> str:
        """See `Definition.excluded`."""
        return self.opposite

    def works(self) -> bool:
        """See `Definition.works`."""
        return True

    def gaps(self, placement: Placement) -> Mapping[str, Numbers]:
        """See `Definition.gaps`."""
        return self.touching.gaps(placement)

    def slips(self, placement: Placement, motion: Motion) -> Mapping[str, Numbers]:
        """See `Definition.slips`."""
        return {key: self.sign * slip for key, slip in self.touching.slips(placement, motion).items()}

    def efforts(self, placement: Placement, motion: Motion) -> Mapping[str, Numbers]:
        """See `Definition.efforts`."""
        normal = f"{self.name}.normal"
        found = self.touching.efforts(placement, motion)
        return {key: power if key == normal else self.sign * power for key, power in found.items()}


@dataclass(frozen=True)
class Unturned(Definition):
    """Two bodies of the plane that do not turn to each other; the moment is that on the first.

    Attributes
    ----------
    attitude : ndarray
        Of the first to the second at the start (rad), shape ().
    """

    kind: ClassVar[str] = "slider"
    a: Place
    b: Place
    attitude: Numbers

    def held(self, placement: Placement) -> Mapping[str, Numbers]:
        """See `Definition.held`."""
        return {"attitude": attitude_to(placement, self.a.body, self.b.body) - self.attitude}

    def efforts(self, placement: Placement, motion: Motion) -> Mapping[str, Numbers]:
        """See `Definition.efforts`."""
        return moments_between(self.name, self.a.body, self.b.body, motion)


@dataclass(frozen=True)
class RubbingGuide(ByCorners):
    """A guide with friction by the sides of its places, and the attitude that it holds at a single place."""

    unturned: Unturned | None = None

    @property
    def members(self) -> tuple[Definition, ...]:
        """See `Definition.members`."""
        return super().members if self.unturned is None else (*super().members, self.unturned)


def is_rubbing(connection: Slider | GuideCurve, reader: Reader, name: str, path: Path) -> bool:
    """Return whether a slider or track has friction."""
    return connection.friction is not None and touch_of(reader, name, path, None, connection.friction).static > 0.0


def rubbing_slider(
    connection: Slider, reader: Reader, name: str, ends: tuple[Place, Place], line: Sequence[float], path: Path
) -> Definition:
    """Return the definition of a slider with friction.

    Parameters
    ----------
    line : two floats
        Its direction in the axes of the body of `b`.
    """
    a, b = ends
    length, width = (
        0.0 if size is None else reader.number(size, (*path, field))
        for field, size in (("length", connection.length), ("width", connection.width))
    )
    t = np.array(line)
    n, to_block = np.array([-t[1], t[0]]), _axes(reader, a).T @ _axes(reader, b)
    found = []
    for along in (-length / 2.0, length / 2.0) if length else (0.0,):
        for side in SIDES_OF_GUIDE:
            off = -side * width / 2.0 * n
            tip, at = _moved(a, to_block @ (along * t + off)), _moved(b, off)
            found.append(OnFace(name, (), _touch(connection, reader, name, path), Tip(tip), Face(at, _pair(side * n))))
    guide = _on_both_sides(name, (*a.bodies, *b.bodies), found)
    if length or not all(place.body is None or reader.turns(place.body) for place in ends):
        return guide
    unturned = Unturned(name, guide.bodies, a, b, attitude_to(reader.start, a.body, b.body))
    return replace(guide, unturned=unturned)


def rubbing_track(connection: GuideCurve, reader: Reader, name: str, place: Place, at: Place, path: Path) -> Definition:
    """Return the definition of a track with friction."""
    touch, where, on = _touch(connection, reader, name, path), (*path, "on"), connection.on
    found: list[OnFace | OnRound]
    if "radius" in on:
        radius = reader.number(on["radius"], (*where, "radius"))
        found = [OnRound(name, (), touch, Round(place, at, (0.0, side * radius))) for side in SIDES_OF_GUIDE]
    else:
        c, s = reader.direction(on.get("slope"), (*where, "slope"))
        found = [OnFace(name, (), touch, Tip(place), Face(at, (-side * s, side * c))) for side in SIDES_OF_GUIDE]
    return _on_both_sides(name, (*place.bodies, *at.bodies), found)


def _touch(connection: Slider | GuideCurve, reader: Reader, name: str, path: Path) -> Touch:
    return touch_of(reader, name, path, None, connection.friction)


def _axes(reader: Reader, place: Place) -> Numbers:
    """Return the axes of the body of a place at the start as columns; a particle has those of the ground."""
    rotation = None if place.body is None else reader.start[place.body].rotation
    return np.eye(2) if rotation is None else rotation


def _moved(place: Place, by: Numbers) -> Place:
    return replace(place, offset=_pair(np.array(place.offset) + by))


def _pair(vector: Numbers) -> tuple[float, float]:
    x, y = vector.tolist()
    return x, y


def _on_both_sides(name: str, bodies: tuple[str, ...], found: Iterable[OnFace | OnRound]) -> RubbingGuide:
    """Return a guide of sides with names of their own, of which every two in turn are of one place."""
    sides = []
    for i, one in enumerate(found):
        own, other = f"{name}.{i + 1}", f"{name}.{(i ^ 1) + 1}"
        touching = replace(one, name=own, bodies=bodies, touch=replace(one.touch, friction=(f"{own}.friction",)))
        sides.append(Side(own, bodies, touching, SIDES_OF_GUIDE[i % 2], other))
    return RubbingGuide(name, bodies, tuple(sides))
