"""Places without mass where springs meet: their forces balance at every time.

Of the potential V of the springs the force on a place k without mass is -dV/dk = 0. As a measure it lets the place
follow from the others, and its multiplier is zero: in the equation of the place, -dV/dk + lambda d^2V/dk^2 = 0, the
first term vanishes, and the second derivative does not where the place is determined.
"""

from __future__ import annotations

from collections.abc import Mapping

from core.errors import Path, PlacesDisagree
from core.formulas import names_in
from core.multibody.algebra.directions import unit
from core.multibody.algebra.polynomials import (
    ONE,
    ZERO,
    Ball,
    Poly,
    combined,
    coordinate,
    difference,
    evaluated,
    is_zero,
    product,
    size,
)
from core.multibody.language.forces import Field, Spring
from core.multibody.language.joints import GuideCurve
from core.multibody.table.measures import CLOSE, Measures
from core.multibody.table.moving_places import ends_of


def balance_massless_places(measures: Measures) -> None:
    """Add the balance of every body without mass on which linear springs act, and that a line may hold.

    What else acts on such a body leaves it as it is.

    Raises
    ------
    PlacesDisagree
        Where forces do not balance at the start.
    """
    table = measures.table
    for body, frame in measures.coordinates.frames.items():
        if any((i, i) in table.mass for i in frame.position) or frame.orients or frame.turn is not None:
            continue
        found = _springs_and_ways(measures, body)
        if found is None:
            continue
        springs, ways = found
        pulls = [_pull(measures, name, spring, path, body) for name, spring, path in springs]
        for way in ways:
            total = combined(*((x, pull[k]) for pull in pulls for k, x in enumerate(way) if not is_zero(x)))
            missed = evaluated(total, table.q)
            if not (measures.loose or is_zero(missed) or abs(missed) < CLOSE * size(total, table.q)):
                rule = f"be where its springs balance, which leave over {float(missed):.6g} N here"
                raise PlacesDisagree(("bodies", body, "at"), rule, remedy="move it, or give it mass")
            measures.hold(body, total)


def _springs_and_ways(measures: Measures, body: str) -> tuple[list[tuple[str, Spring, Path]], list[list[Ball]]] | None:
    """Return the springs at a body and the directions in which it is free; None where other things act on it."""
    scene = measures.coordinates.scene
    springs: list[tuple[str, Spring, Path]] = []
    ways = [[ONE if i == k else ZERO for i in range(measures.dimension)] for k in range(measures.dimension)]
    guided = False
    for name, (i, one) in zip(scene.names(), scene.numbered(), strict=True):
        names = {name for x in one.formulas() if isinstance(x, str) for name in names_in(x)}
        named = any(name.partition(".")[0] == body for name in names)
        touches = any(isinstance(x, str) and x.partition(".")[0] == body for x in one.places())
        if named or (isinstance(one, Field) and (one.on is None or body in one.on)):
            return None
        if isinstance(one, Spring) and one.law is None and touches:
            springs.append((name, one, ("connections", i)))
        elif isinstance(one, GuideCurve) and touches and one.place == body and one.friction is None and not guided:
            line = _line(measures, one, ("connections", i, "on"))
            if line is None:
                return None
            ways, guided = [line], True
        elif touches:
            return None
    return (springs, ways) if len(springs) > 1 else None


def _line(measures: Measures, guide: GuideCurve, path: Path) -> list[Ball] | None:
    """Return the direction of a line of the ground; None of other guides."""
    on = guide.on if isinstance(guide.on, Mapping) else {}
    if isinstance(on.get("at"), str):
        return None
    if measures.dimension == 2 and set(on) <= {"at", "slope"}:
        return list(measures.numerals.angle(on.get("slope", 0), (*path, "slope")))
    if measures.dimension == 3 and set(on) == {"at", "direction"}:
        return unit(measures.numerals.vector(on["direction"], (*path, "direction"), 3), path)
    return None


def _pull(measures: Measures, name: str, spring: Spring, path: Path, body: str) -> list[Poly]:
    """Return the components of the force of a spring on one of its ends: k (1 - l_0/l) d."""
    a, b = ends_of(spring, measures, name, path)
    numerals = measures.numerals
    k = numerals.number(spring.stiffness, (*path, "stiffness"))
    here, there = (a, b) if a.body == body else (b, a)
    d = [difference(y, x) for x, y in zip(here.at, there.at, strict=True)]
    rest = None if spring.rest_length is None else numerals.number(spring.rest_length, (*path, "rest_length"))
    if rest is not None and is_zero(rest):
        return [combined((k, x)) for x in d]
    length = measures.length(name, a, b, path)
    inverse = coordinate(measures.inverse(name, length))
    if rest is None:
        rest = measures.table.q[length]
    return [combined((k, x), (-k * rest, product(inverse, x))) for x in d]
