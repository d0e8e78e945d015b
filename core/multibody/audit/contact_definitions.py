"""From the description of a contact or of rolling to its definition."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import replace
from typing import Any

from core.multibody.audit.ball_on_box import OnBox
from core.multibody.audit.bodies import Outline, Path, Reader
from core.multibody.audit.coefficients import touch_of
from core.multibody.audit.contacts import OnFace, OnRound, Stop
from core.multibody.audit.definition import Definition, Touch
from core.multibody.audit.definition_of import definition_of
from core.multibody.audit.level_rims import ContactOfLevelRims, level_rim
from core.multibody.audit.outlines import ByCorners, OnOutline
from core.multibody.audit.placement import Place, Undefined
from core.multibody.audit.rolling import RollingOnBall, RollingOnCylinder, RollingOnFace, RollingOnRound
from core.multibody.audit.surfaces import Face, Round, Tip
from core.multibody.audit.turns_in_space import AxialStop, axis_between
from core.multibody.language.contacts import Contact, Rolling
from core.multibody.language.written import GROUND

BOX = 8
"""Corners of a box; other shapes of space have two at most."""


@definition_of.register
def contact(connection: Contact, reader: Reader, name: str, path: Path) -> Definition:
    """Return the definition of a contact."""
    touch = touch_of(reader, name, path, connection.restitution, connection.friction, connection.impacts)
    if connection.tangential_restitution is not None:
        back = reader.number(connection.tangential_restitution, (*path, "tangential_restitution"))
        touch = replace(touch, tangential=back)
    if connection.measure == "turn":
        least = connection.at_least is not None
        field = "at_least" if least else "at_most"
        limit = reader.number(getattr(connection, field), (*path, field))
        if reader.dimension == 3:
            bodies, axis = axis_between(reader, connection.a, connection.b)
            return AxialStop(name, bodies, axis, limit, 1 if least else -1, touch)
        first, other = str(connection.a), None if connection.b in (None, GROUND) else str(connection.b)
        both = (first,) if other is None else (first, other)
        return Stop(name, both, first, other, limit, 1 if least else -1, touch)
    if connection.place is None:
        a, b = (reader.outline(getattr(connection, end), (*path, end)) for end in "ab")
        if reader.dimension == 3 and max(len(a.corners), len(b.corners)) == BOX:
            ball, box = (b, a) if len(a.corners) == BOX else (a, b)
            return _on_box(name, ball, box, touch)
        return _by_corners(name, [*_between(name, a, b, touch)])
    own, on = reader.outline(connection.place, (*path, "place")), connection.surface
    where = (*path, "on")
    at = reader.place(on["at"], (*where, "at"))
    if "radius" in on:
        around = Outline((at,), reader.number(on["radius"], (*where, "radius")))
        return _by_corners(name, [*_between(name, own, around, touch)])
    face = _face(reader, on, where)
    rim = level_rim(own, face, name, reader.bodies, reader.answered)
    tips = [Tip(place, own.radius, own.semi_axes) for place in own.corners] if rim is None else list(rim.tips)
    found = _by_corners(name, [OnFace(name, (*tip.place.bodies, *at.bodies), touch, tip, face) for tip in tips])
    return found if rim is None else ContactOfLevelRims(name, found.bodies, found, rim)


def _on_box(name: str, ball: Outline[Place], box: Outline[Place], touch: Touch) -> OnBox:
    """Return the contact of a ball and a box, whose corners are in order of their faces."""
    (place,), low, high = ball.corners, box.corners[0], box.corners[6]
    ends = list(zip(low.offset, high.offset, strict=True))
    middle = Place(low.body, tuple((x + y) / 2.0 for x, y in ends))
    half = tuple((y - x) / 2.0 for x, y in ends)
    return OnBox(name, (*place.bodies, *middle.bodies), touch, place, middle, half, ball.radius)


def _between(name: str, a: Outline[Place], b: Outline[Place], touch: Touch) -> Iterator[OnRound | OnOutline]:
    """Yield the contacts of two outlines by the corners of the first, then those of the second."""
    if b.radius < 0.0 or (len(a.corners) == 1 and len(b.corners) == 1):
        (other,) = b.corners
        for place in a.corners:
            yield OnRound(name, (*place.bodies, *other.bodies), touch, Round(place, other, (a.radius, b.radius)))
        return
    pairs = [(a, b), (b, a)] if len(b.corners) > 1 else [(b, a)]
    sharp = a.radius + b.radius == 0.0
    for one, two in pairs:
        own, others, count = one.corners, two.corners, len(one.corners)
        for i, place in enumerate(own if len(others) > 1 else ()):
            bodies = (*place.bodies, *others[0].bodies)
            beside = (own[i - 1], own[(i + 1) % count]) if count > 1 and sharp else ()
            yield OnOutline(name, bodies, touch, place, others, (one.radius, two.radius), beside)


def _by_corners(name: str, corners: Sequence[OnFace | OnRound | OnOutline]) -> Definition:
    """Return the contact of a shape, each of whose corners has a name of its own if there are several."""
    if len(corners) == 1:
        return corners[0]
    numbered = []
    for i, one in enumerate(corners):
        own = f"{name}.{i + 1}"
        friction = tuple(f"{own}{force[len(name) :]}" for force in one.touch.friction)
        numbered.append(replace(one, name=own, touch=replace(one.touch, friction=friction)))
    return ByCorners(name, corners[0].bodies, tuple(numbered))


@definition_of.register
def rolling(connection: Rolling, reader: Reader, name: str, path: Path) -> Definition:
    """Return the definition of what rolls."""
    if connection.place is None:
        a, b = (reader.place(getattr(connection, end), (*path, end)) for end in "ab")
        first, second = reader.rim(connection.a), reader.rim(connection.b)
        around = Round(a, b, (first, -second if connection.inside else second))
        return RollingOnRound(name, (*a.bodies, *b.bodies), around)
    # In space a ball may roll whose centre is a place of it, and not its centre of mass.
    place, on = reader.place(connection.place, (*path, "place")), connection.surface
    radius = reader.rim(place.body)
    tip = Tip(place, radius)
    if not radius:
        outline = reader.outline(connection.place, (*path, "place"))
        tip = Tip(outline.corners[0], outline.radius, outline.semi_axes)
    where = (*path, "on")
    at = reader.place(on["at"], (*where, "at"))
    bodies = (*place.bodies, *at.bodies)
    if "direction" in on:
        axis, size = (
            reader.unit(on["direction"], (*where, "direction")),
            reader.number(on["radius"], (*where, "radius")),
        )
        return RollingOnCylinder(name, bodies, place, radius, at, axis, size)
    if "radius" in on:
        around = Round(place, at, (radius, reader.number(on["radius"], (*where, "radius"))))
        return RollingOnRound(name, bodies, around) if reader.dimension == 2 else RollingOnBall(name, bodies, around)
    return RollingOnFace(name, bodies, tip, _face(reader, on, where))


def _face(reader: Reader, on: Any, where: Path) -> Face:
    at = reader.place(on["at"], (*where, "at"))
    if "normal" in on:
        turning = reader.number(on["rate"], (*where, "rate")) if on.get("rate") is not None else 0.0
        return Face(at, reader.unit(on["normal"], (*where, "normal")), turning)
    if reader.dimension != 2:
        raise Undefined("a face of space without a normal")
    c, s = reader.direction(on.get("slope"), (*where, "slope"))
    return Face(at, (-s, c))
