"""Friction of a string on fixed pegs or a drum: between sticking tensions the ratio exp(mu theta), as on a capstan.

With the tensions T_1 and T_2 at the ends, their mean N is the multiplier of what the string lacks to be taut, and their
difference F = T_2 - T_1 that of the slip s' = (l_1' - l_2')/2. T_2 <= T_1 exp(mu theta) and its reverse are then
|F| <= 2 tanh(mu theta/2) N: Coulomb's law with another coefficient. The angle theta around all pegs together is a
number as long as the parts at the ends keep their directions. On a drum, on which the string winds in the sense k, the
slip is s' - k R omega, and F turns the drum by k R F.

References
----------
L. Euler, "Remarques sur l'effet du frottement dans l'equilibre", Memoires de l'academie des sciences de Berlin 18
(1769). J. L. Meriam, L. G. Kraige, "Engineering Mechanics: Statics", section 6/8 (flexible belts).
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import replace
from itertools import pairwise

from flint import arb

from core.errors import InvalidParameter, Path
from core.multibody.algebra.directions import perpendicular, scalar_product, unit
from core.multibody.algebra.polynomials import (
    ONE,
    ZERO,
    Ball,
    Poly,
    combined,
    constant,
    difference,
    dot,
    evaluated,
    is_zero,
)
from core.multibody.language.strings import String
from core.multibody.table.connection_effects import Kept, Limit
from core.multibody.table.contact_geometry import coefficients_of_friction
from core.multibody.table.measures import Measures
from core.multibody.table.rolling import rate_of
from core.multibody.table.string_measures import Knot, at_most, course, require_long_enough, written_length

MOST_TURNS = 10**9
"""Beside the angle between a string's parts; a decimal with an exponent of hundreds is none that anybody counts."""


def string_on_pegs(measures: Measures, name: str, connection: String, knots: Sequence[Knot], path: Path) -> None:
    """Add the measure of a string with friction, and what ends its motion.

    Raises
    ------
    InvalidParameter
        Unless it runs from a body over points of the ground to a body; for coefficients and turns that cannot be.
    """
    _require_pegs(connection, knots, path)
    static, kinetic = coefficients_of_friction(measures, connection.friction, (*path, "friction"))
    q, points = measures.table.q, [knot.point for knot in knots]
    ways = [[difference(y, x) for x, y in zip(a.at, b.at, strict=True)] for a, b in pairwise(points)]
    starts = [[evaluated(x, q) for x in way] for way in ways]
    drum, turning = knots[1], {}
    if drum.radius is not None and drum.turn is not None:
        _, sense, _, u = course(knots[0], drum, starts[0], path)
        after, _, _, w = course(drum, knots[2], starts[1], path)
        if sense != after:
            raise InvalidParameter(
                (*path, "sides", drum.name), "be sides between which the string winds around the drum in one sense"
            )
        directions: list[Sequence[Ball]] = [u, w]
        angle = _around(u, w, -sense) + _turns(measures, connection, path)
        turning = combined((-sense * drum.radius, drum.turn))
    else:
        directions = [unit(way, knot.at) for way, knot in zip(starts, knots[1:], strict=True)]
        angle = sum((_between(u, w) for u, w in pairwise(directions)), _turns(measures, connection, path))
    for k in (0, -1):
        measures.kept.extend(_keeps_its_direction(ways[k], directions[k], path))
    parts = [dot(list(map(constant, u)), way) for u, way in zip(directions, ways, strict=True)]
    for part in (parts[0], parts[-1]):
        measures.limits.append(Limit("singular", name, length=part))
    way = combined(*((ONE, part) for part in parts))
    held = evaluated(way, q)
    if connection.length is not None:
        held = written_length(measures, connection.length, path)
        require_long_enough(measures, evaluated(way, q), held, path)
    taut = at_most(measures, name, combined((ONE, way), (-held, constant(ONE))), connection, path)
    slip = rate_of(combined((ONE / 2, parts[0]), (-ONE / 2, parts[-1]), (ONE, turning)))
    shares = [2 * (mu * angle / 2).tanh() for mu in (static, kinetic)]
    measures.unilateral.append(replace(taut, slip=slip, static=shares[0], kinetic=shares[1]))


def _require_pegs(connection: String, knots: Sequence[Knot], path: Path) -> None:
    ends, inner = (knots[0], knots[-1]), knots[1:-1]
    drums = [knot for knot in inner if knot.radius is not None]
    for knot in inner:
        if knot.point.body is not None and knot.radius is None:
            raise InvalidParameter(
                knot.at,
                "be a point of the ground, or a drum: a string with friction rubs on fixed pegs or on a drum",
                remedy="leave out the friction",
            )
    if connection.slips:
        raise InvalidParameter((*path, "slips"), "be left out of a string with friction")
    if drums and len(inner) > 1:
        raise InvalidParameter((*path, "through"), "pass one drum alone, or pegs, for a string with friction")
    # A belt may end at the ground, as that of a brake does: then its drum moves beside it.
    fixed = [knot for knot in ends if knot.point.body is None]
    if not inner or any(knot.radius is not None for knot in ends) or len(fixed) > len(drums):
        raise InvalidParameter(
            (*path, "through"),
            "be a place of a body, pegs or a drum, and a place of a body, for a string with friction",
            remedy="one end may be a point of the ground where it passes a drum",
        )


def _around(u: Sequence[Ball], w: Sequence[Ball], sense: int) -> Ball:
    """Return the angle from one direction to another in a sense of turning, 1 counter-clockwise (rad, 0 to 2 pi)."""
    crossed = sense * (u[0] * w[1] - u[1] * w[0])
    if is_zero(crossed):
        return ZERO if scalar_product(u, w) > 0 else arb.pi()
    angle = arb.atan2(crossed, scalar_product(u, w))
    return angle if angle > 0 else angle + 2 * arb.pi()


def _keeps_its_direction(way: Sequence[Poly], direction: Sequence[Ball], path: Path) -> Iterator[Kept]:
    for across in perpendicular(direction, path):
        yield Kept(
            dot(list(map(constant, across)), way),
            "be left out where the parts at the ends of a string change their directions: the angle around its pegs "
            "changes with them",
            "guide the ends by tracks, or leave out the friction",
            (*path, "friction"),
        )


def _turns(measures: Measures, connection: String, path: Path) -> Ball:
    if connection.turns is None:
        return ZERO
    turns = measures.numerals.number(connection.turns, (*path, "turns"))
    # What is varied or uncertain passes what is between whole numbers, as the turns that would just hold.
    whole = turns.unique_fmpz() is not None or not measures.numerals.as_written
    if not (whole and 0 <= turns <= MOST_TURNS):
        raise InvalidParameter(
            (*path, "turns"),
            f"be a whole number from 0 to {MOST_TURNS}",
            remedy="what is less than a turn follows from the places of the pegs",
        )
    return 2 * arb.pi() * turns


def _between(u: Sequence[Ball], w: Sequence[Ball]) -> Ball:
    """Return the angle between two unit vectors (rad)."""
    along = scalar_product(u, w)
    beside = [x - along * y for x, y in zip(w, u, strict=True)]
    square = scalar_product(beside, beside)
    # A part that goes on straight, or turns back, has no part across the one before it.
    across = square.sqrt() if square > 0 else ZERO
    if abs(along) > across:
        small = (across / abs(along)).atan()
        return small if along > 0 else arb.pi() - small
    return arb.pi() / 2 - (along / across).atan()
