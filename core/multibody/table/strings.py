"""Strings through places and over drums, taut.

A straight part between two points is a length l with l^2 = d.d. A part that touches a drum has a direction u with
u.u = 1 and d x u = -(k_a R_a - k_b R_b), where k is the sense in which it winds, and its length changes at
u.(v_b - v_a) + k_a R_a omega_a - k_b R_b omega_b. A drum without slip divides a string in two.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from itertools import pairwise

from core.balls import raised
from core.errors import InvalidParameter, Path, SlackAtStart
from core.multibody.algebra.polynomials import (
    ONE,
    ZERO,
    Ball,
    LinearForm,
    Poly,
    combined,
    constant,
    coordinate,
    difference,
    dot,
    evaluated,
)
from core.multibody.language.numerals import member
from core.multibody.language.strings import String
from core.multibody.table.connection_effects import Limit
from core.multibody.table.formulas_of_time import driven
from core.multibody.table.measures import Measures
from core.multibody.table.rolling import rate_of, sum_of_rates
from core.multibody.table.rows import add_rows
from core.multibody.table.rubbing_strings import string_on_pegs
from core.multibody.table.string_measures import SIDES, Knot, at_most, course, require_long_enough, written_length
from core.multibody.table.table import Row

MOST_THROUGH = 50
"""Places that a string passes: coordinates and rows grow with them."""

SLACK = 1e-9
"""Share of its length by which a string may be longer than its way and still be meant as taut."""


@add_rows.register
def string(connection: String, measures: Measures, name: str, path: Path) -> None:
    """Add the coordinates and rows of a string.

    Raises
    ------
    InvalidParameter
        For fewer than two things to pass, sides that do not exist or cannot be, and strings of fixed points.
    """
    knots = _knots(measures, connection, path)
    if connection.drive is not None:
        _require_drivable(connection, knots, path)
    if connection.friction is not None:
        string_on_pegs(measures, name, connection, knots, path)
        return
    if connection.turns is not None:
        raise InvalidParameter((*path, "turns"), "be left out of a string without friction")
    runs: list[list[Knot]] = [[knots[0]]]
    for knot in knots[1:]:
        runs[-1].append(knot)
        if knot.radius is not None and knot.turn is not None and knot is not knots[-1]:
            runs.append([knot])
    if connection.length is not None and (len(runs) > 1 or any(knot.radius is not None for knot in knots)):
        raise InvalidParameter((*path, "length"), "be left out: the part that is wound on a drum is not counted")
    for number, run in enumerate(runs):
        part = name if len(runs) == 1 else f"{name}.{number + 1}"
        _run(measures, name, part, run, connection, path)
    for knot in knots[1:-1]:
        if knot.radius is not None and knot.senses[0] != knot.senses[1]:
            raise InvalidParameter(
                (*path, "sides", knot.name), "be sides between which the string winds around the drum in one sense"
            )


def _require_drivable(connection: String, knots: Sequence[Knot], path: Path) -> None:
    where = (*path, "drive")
    for other, given in (("length", connection.length), ("friction", connection.friction)):
        if given is not None:
            raise InvalidParameter(where, f"be left out beside {other}")
    if any(knot.radius is not None for knot in knots):
        remedy = "drive the turn of a drum by a motor"
        raise InvalidParameter(where, "be left out of a string that winds about drums", remedy=remedy)


def _driven_length(measures: Measures, part: str, way: Ball, connection: String, path: Path) -> Poly:
    """Return the length of a string that a formula of time gives, which is its way at the start where it is taut."""
    where = (*path, "drive")
    span = driven(measures, part, connection.drive, where)
    now = evaluated(span, measures.table.q)
    if not now > 0:
        raise InvalidParameter(where, f"be greater than 0 m {measures.moment}")
    if measures.one_sided:
        require_long_enough(measures, way, now, path, "drive")
        # A coordinate of its own, whose row has the power of what drives it while the string is taut.
        length = measures.table.coordinate(f"{part}.drive", "m", now)
        measures.hold(part, difference(coordinate(length), span))
        return coordinate(length)
    if not measures.loose:
        require_long_enough(measures, way, now, path, "drive")
        _require_taut(way, now, path, "drive")
    return span


def _knots(measures: Measures, connection: String, path: Path) -> list[Knot]:
    through = connection.through
    if not isinstance(through, (list, tuple)) or len(through) < 2:
        raise InvalidParameter((*path, "through"), "be a list of at least two places")
    if len(through) > MOST_THROUGH:
        raise InvalidParameter((*path, "through"), f"have at most {MOST_THROUGH} entries, not {len(through)}")
    if not isinstance(connection.sides, Mapping):
        raise InvalidParameter((*path, "sides"), "be an object of drums and sides")
    if isinstance(connection.slips, str) or not isinstance(connection.slips, Sequence):
        raise InvalidParameter((*path, "slips"), "be a list of drums")
    found: list[Knot] = []
    drums: set[str] = set()
    for i, entry in enumerate(through):
        where = (*path, "through", i)
        point = measures.coordinates.point(entry, where)
        frame = measures.coordinates.frames.get(entry) if isinstance(entry, str) else None
        if frame is None or frame.radius is None:
            found.append(Knot(point, str(entry)[:80], None, None, [], [], where))
            continue
        if measures.dimension != 2:
            raise InvalidParameter(where, "be a place: strings wind around drums in the plane only")
        if entry in drums:
            raise InvalidParameter(where, "be passed once only", remedy="describe the rest as another string")
        drums.add(str(entry))
        turn = None if entry in connection.slips else measures.coordinates.turn_of(str(entry), where)
        count = 1 if i in (0, len(through) - 1) else 2
        if turn is None and count == 1:
            raise InvalidParameter((*path, "slips"), "be drums that the string passes, not its ends")
        sides = _sides(connection.sides.get(entry), count, (*path, "sides", str(entry)))
        found.append(Knot(point, str(entry), frame.radius, turn, sides, [], where))
    for extra in connection.sides:
        if extra not in drums:
            raise InvalidParameter(member((*path, "sides"), extra), "be a drum that the string passes")
    for i, extra in enumerate(connection.slips):
        if not isinstance(extra, str) or extra not in drums:
            raise InvalidParameter((*path, "slips", i), "be a drum that the string passes")
    return found


def _sides(value: object, count: int, path: Path) -> list[str | None]:
    rule = f"be {'a side' if count == 1 else 'two sides'} out of {', '.join(SIDES)}"
    if value is None:
        remedy = "where the string touches the drum, as seen from its centre, where it comes and where it leaves"
        raise InvalidParameter(path, f"be given, and {rule}", remedy=remedy)
    listed = [value] if isinstance(value, str) else value
    if isinstance(listed, Mapping) or not isinstance(listed, Sequence) or len(listed) != count:
        raise InvalidParameter(path, rule)
    for side in listed:
        if not isinstance(side, str) or side not in SIDES:
            raise InvalidParameter(path, rule)
    return list(listed)


def _run(measures: Measures, name: str, part: str, run: list[Knot], connection: String, path: Path) -> None:
    """Add the rows of what lies between two ends or drums: the sum of its lengths does not change."""
    length = connection.length
    total: Poly = {}
    rates: LinearForm = {}
    straight = True
    for a, b in pairwise(run):
        if a.radius is None and b.radius is None:
            if a.point.body is None and b.point.body is None:
                d = [difference(y, x) for x, y in zip(a.point.at, b.point.at, strict=True)]
                total = combined((ONE, total), (ONE, constant(measures.squared(d).sqrt())))
                continue
            if len(run) == 2 and connection.drive is None:
                _single(measures, part, a, b, connection, path)
                return
            index = measures.length(name, a.point, b.point, b.at)
            total = combined((ONE, total), (ONE, coordinate(index)))
            rates = _joined(rates, {index: constant(ONE)})
        else:
            straight = False
            rates = _joined(rates, sum_of_rates(*_tangent(measures, name, a, b, path)))
    if not rates:
        raise InvalidParameter((*path, "through"), "pass something that moves")
    if straight:
        way = evaluated(total, measures.table.q)
        if connection.drive is not None:
            held = _driven_length(measures, part, way, connection, path)
        else:
            held = constant(way if length is None else written_length(measures, length, path))
            if measures.one_sided:
                require_long_enough(measures, way, evaluated(held, measures.table.q), path)
            else:
                _require_taut(way, evaluated(held, measures.table.q), path)
        longer = difference(total, held)
        if measures.one_sided:
            measures.unilateral.append(at_most(measures, part, longer, connection, path))
            return
        row = measures.hold(name, longer)
    elif measures.one_sided:
        # What the string lacks to be taut is a coordinate: it follows from rates that no measure gives.
        lack = measures.table.coordinate(f"{part}.slack", "m", ZERO)
        measures.roll(part, _joined(rates, {lack: constant(ONE)}))
        measures.unilateral.append(at_most(measures, part, {(lack,): -ONE}, connection, path))
        return
    else:
        row = measures.roll(name, rates)
    force = measures.force(f"{part}.tension", [(row, constant(-ONE))])
    measures.limits.append(Limit("slack", part, force=force))


def _require_taut(way: Ball, length: Ball, path: Path, field: str = "length") -> None:
    if length - way > SLACK * length:
        raise SlackAtStart(
            (*path, field), f"be {float(way):.10g} m here, where a string has to be taut", remedy="leave it out"
        )


def _single(measures: Measures, part: str, a: Knot, b: Knot, connection: String, path: Path) -> None:
    """Hold two points at a distance, as long as that takes a pull."""
    length = connection.length
    if measures.one_sided:
        d = [difference(y, x) for x, y in zip(a.point.at, b.point.at, strict=True)]
        square = measures.squared(d) if length is None else raised(written_length(measures, length, path), 2)
        if not square > 0:
            raise InvalidParameter((*path, "through"), "pass places that are apart")
        way = measures.squared(d)
        require_long_enough(measures, way.sqrt() if way > 0 else ZERO, square.sqrt(), path)
        half = 1 / (2 * square.sqrt())
        longer = combined((half, dot(d, d)), (-half * square, constant(ONE)))
        measures.unilateral.append(at_most(measures, part, longer, connection, path))
        return
    if length is not None:
        d = [difference(y, x) for x, y in zip(a.point.at, b.point.at, strict=True)]
        way = measures.squared(d)
        _require_taut(way.sqrt() if way > 0 else ZERO, written_length(measures, length, path), path)
    measures.rod(part, a.point, b.point, length, None, path)
    rod = measures.forces.pop()
    force = measures.force(f"{part}.tension", rod.terms)
    measures.limits.append(Limit("slack", part, force=force))


def _tangent(measures: Measures, name: str, a: Knot, b: Knot, path: Path) -> list[tuple[Poly, LinearForm]]:
    """Add direction and rows of a part that touches a drum; return what its length changes by."""
    table = measures.table
    d = [difference(y, x) for x, y in zip(a.point.at, b.point.at, strict=True)]
    ka, kb, offset, u = course(a, b, [evaluated(x, table.q) for x in d], path)
    if ka:
        a.senses.append(ka)
    if kb:
        b.senses.append(kb)
    first = table.coordinate(f"{name}.direction.x", "1", u[0])
    second = table.coordinate(f"{name}.direction.y", "1", u[1])
    table.rows.append(Row.held(name, {(first, first): ONE, (second, second): ONE, (): -ONE}))
    crossed: Poly = combined(
        *((value, _times(key, second)) for key, value in d[0].items()),
        *((-value, _times(key, first)) for key, value in d[1].items()),
        (offset, constant(ONE)),
    )
    measures.hold(name, crossed)
    # The straight part, which is at right angles to the radii at its ends: a weight that reaches its drum ends it.
    measures.limits.append(Limit("singular", name, length=dot(d, [coordinate(first), coordinate(second)])))
    parts = [(coordinate(first), rate_of(d[0])), (coordinate(second), rate_of(d[1]))]
    if ka and a.turn is not None:
        parts.append((constant(ka * a.radius), rate_of(a.turn)))
    if kb and b.turn is not None:
        parts.append((constant(-kb * b.radius), rate_of(b.turn)))
    return parts


def _times(key: tuple[int, ...], index: int) -> Poly:
    return {tuple(sorted((*key, index))): ONE}


def _joined(first: LinearForm, second: LinearForm) -> LinearForm:
    return {j: combined((ONE, first.get(j, {})), (ONE, second.get(j, {}))) for j in {*first, *second}}
