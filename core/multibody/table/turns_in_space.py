"""The turn of a body of space about the axis of a pin that joins it to another one, or to the ground."""

from __future__ import annotations

from collections.abc import Sequence

from core.errors import InvalidParameter, Path
from core.multibody.algebra.directions import perpendicular
from core.multibody.algebra.polynomials import ONE, ZERO, Ball, Poly, combined, constant, coordinate, dot
from core.multibody.language.joints import axes_of_turn
from core.multibody.language.written import GROUND
from core.multibody.table.frames import axis_after
from core.multibody.table.measures import Measures
from core.multibody.table.rolling import rate_of, sum_of_rates


def turn_in_space(measures: Measures, name: str, a: object, b: object, path: Path) -> Poly:
    """Return the turn of body `a` relative to `b` since the start, positive about the axis as their joint has it.

    With p fixed in `a` and p', q' in `b`, all across the axis, c = p.p' and s = p.q' are cosine and sine of the turn
    since the start, and c s' - s c' is its rate.
    """
    frames = measures.coordinates.frames
    for end, body in (("a", a), ("b", b)):
        if not isinstance(body, str) or (body != GROUND and (body not in frames or frames[body].axes is None)):
            raise InvalidParameter((*path, end), "name a body that has moments")
    joints = axes_of_turn(measures.coordinates.scene.numbered(), str(a), str(b))
    own = [number for number in joints if measures.waiting or number in measures.begun]
    if not own:
        rule = "be joined to b by a pin, cylindrical joint or screw with an axis, about which it turns"
        if joints:
            remedy = "let it begin no earlier and end no later than that joint"
            raise InvalidParameter((*path, "a"), f"{rule} whenever it acts", remedy=remedy)
        raise InvalidParameter((*path, "a"), rule, remedy="give that pin its axis, or name what it joins")
    number = own[0]
    where: Path = ("connections", number, "axis")
    axis = measures.numerals.vector(joints[number], where, 3)
    begun = measures.begun.get(number)
    return turn_about(measures, name, (str(a), str(b)), axis, measures.start_places if begun is None else begun, path)


def turn_about(
    measures: Measures, name: str, bodies: tuple[str, str], axis: Sequence[Ball], then: Sequence[Ball], path: Path
) -> Poly:
    """Return the turn of a body relative to another about an axis that is fixed in both.

    Parameters
    ----------
    bodies : two of str
        Either may be the ground.
    axis : three balls
        In space.
    then : sequence of ball
        The coordinates where it is that.
    """
    first, second = (None if body == GROUND else body for body in bodies)
    frame, now = None if second is None else measures.coordinates.frames[second], measures.table.q
    # What has not moved since keeps all the digits that it has.
    if frame is not None and any(now[i] is not then[i] for i in frame.coordinates):
        axis = axis_after(axis, frame, then, now)
    # The second is the axis times the first.
    across = perpendicular(axis, path)
    p, *others = (
        measures.coordinates.vector_of(body, measures.in_body(body, vector), path)
        for body, vector in ((first, across[0]), (second, across[0]), (second, across[1]))
    )
    c, s = (
        measures.affine(name, f"{name}.{own}", "1", dot(p, other))
        for own, other in zip(("cos", "sin"), others, strict=True)
    )
    turn = coordinate(measures.table.coordinate(f"{name}.turn", "rad", ZERO))
    measures.roll(
        name, sum_of_rates((c, rate_of(s)), (combined((-ONE, s)), rate_of(c)), (constant(-ONE), rate_of(turn)))
    )
    return turn
