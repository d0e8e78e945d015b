"""The turn of a body of space about the axis of a pin that joins it to another one, or to the ground."""

from __future__ import annotations

from core.errors import InvalidParameter, Path
from core.multibody.algebra.directions import perpendicular
from core.multibody.algebra.polynomials import ONE, ZERO, Poly, combined, constant, coordinate, dot
from core.multibody.language.joints import axis_of_turn
from core.multibody.language.written import GROUND
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
    found = axis_of_turn(measures.coordinates.scene.numbered(), str(a), str(b))
    if found is None:
        rule = "be joined to b by a pin, cylindrical joint or screw with an axis, about which it turns"
        raise InvalidParameter((*path, "a"), rule, remedy="give that pin its axis, or name what it joins")
    axis, where = found
    # The second is the axis times the first.
    across = perpendicular(measures.numerals.vector(axis, where, 3), where)
    first, second = (None if body == GROUND else str(body) for body in (a, b))
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
