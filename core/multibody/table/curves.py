"""Tracks by formula: a surface on which a function of the place is zero, and a curve by a parameter.

Of a surface the components of the place are coordinates of their own, which the place follows: the multipliers of these
rows are the components of the force. A curve has its parameter as a coordinate without mass, and a row for each
component of the place.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence

from core.balls import as_text
from core.errors import InvalidParameter, Path, PlacesDisagree
from core.formulas import value_of
from core.multibody.algebra.directions import scalar_product
from core.multibody.algebra.polynomials import (
    ONE,
    ZERO,
    Ball,
    Poly,
    change_by,
    constant,
    coordinate,
    difference,
    evaluated,
    is_zero,
)
from core.multibody.language.joints import GuideCurve
from core.multibody.language.motion_formulas import TIME, MotionFormula, motion_formula
from core.multibody.language.numerals import BALLS
from core.multibody.table.formula_laws import of_number
from core.multibody.table.formulas_of_time import FormulaRows, clock
from core.multibody.table.frames import Point
from core.multibody.table.measures import CLOSE, COMPONENTS, Measures
from core.multibody.table.scene_sizes import sizes

PARAMETER = "u"
"""The name of the parameter of a curve."""

Curve = Callable[[Ball], Sequence[Ball]]
"""From a parameter to the components of a place."""

_DIFFERENCE = ONE / 2**100
"""Change of a parameter by which slopes are formed: in balls of 320 bits they are known to some 100 bits."""

_BESIDE = ONE / 2**40
"""Change of a parameter by which a curve with a direction turns little."""

_ROUNDS = 60
"""Of Gauss and Newton: from a guess near enough some six are needed, each beside the next 100 bits."""

_GUESSES = (ZERO, *(sign * ONE * k / 4 for k in range(1, 81) for sign in (1, -1)))
"""Parameters from which the one of the start is looked for where none is given, those near zero first."""


def on_surface(measures: Measures, name: str, connection: GuideCurve, path: Path) -> None:
    """Hold a place where a formula of its coordinates is zero."""
    p, where = _place(measures, connection, path), (*path, "on", "surface")
    if set(connection.on) != {"surface"}:
        raise InvalidParameter((*path, "on"), "have nothing beside surface")
    axes = COMPONENTS[: measures.dimension]
    formula = motion_formula(connection.on["surface"], measures.numerals, axes, (), where)
    if formula is None or not formula.names & set(axes):
        raise InvalidParameter(where, f"be a formula of {', '.join(axes)} that is zero on it")
    own = {}
    for axis, component in zip(axes, p.at, strict=True):
        index = measures.table.coordinate(f"{name}.{axis}", "m", evaluated(component, measures.table.q))
        row = measures.hold(name, difference(coordinate(index), component))
        measures.force(f"{name}.{axis}", [(row, constant(-ONE))])
        own[axis] = coordinate(index)
    value = _rows(measures, name, formula, own, where)
    if all(is_zero(x) for key, x in value.items() if key):
        raise InvalidParameter(where, f"change with {' or '.join(axes)}, and not have one value everywhere")
    missed = evaluated(value, measures.table.q)
    meant = CLOSE * (ONE + change_by(value, measures.table.q, sizes(measures.table, measures.table.q)))
    if not (measures.loose or abs(missed) < meant):
        rule = f"be zero where the place starts, and not {as_text(missed, 10)}"
        raise PlacesDisagree(where, rule, remedy="change it, or move the bodies")
    measures.hold(name, value)


def on_curve_by_formulas(measures: Measures, name: str, connection: GuideCurve, path: Path) -> None:
    """Hold a place on a curve whose components are formulas of a parameter."""
    p, where, on = _place(measures, connection, path), (*path, "on", "curve"), connection.on
    if not set(on) <= {"curve", "start"}:
        raise InvalidParameter((*path, "on"), "have nothing beside curve and start")
    given = on["curve"]
    if isinstance(given, (str, Mapping)) or not isinstance(given, Sequence) or len(given) != measures.dimension:
        raise InvalidParameter(where, f"be a list of {measures.dimension} formulas of {PARAMETER}")
    formulas = [_component(measures, value, (*where, i)) for i, value in enumerate(given)]
    if not any(PARAMETER in formula.names for formula in formulas):
        raise InvalidParameter(where, f"have formulas of {PARAMETER}")

    def at(u: Ball) -> list[Ball]:
        names = {**measures.numerals.let, PARAMETER: u, TIME: ZERO}
        return [value_of(formula.root, names, BALLS) for formula in formulas]

    place = [evaluated(component, measures.table.q) for component in p.at]
    guesses = _GUESSES
    if on.get("start") is not None:
        guesses = (measures.numerals.number(on["start"], (*path, "on", "start")),)
    found = _parameter(at, place, guesses, sketch=measures.loose)
    if found is None:
        remedy = "move the body, or give a parameter near it as start"
        raise PlacesDisagree(where, f"pass through the place {measures.moment}, in a direction", remedy=remedy)
    own = {PARAMETER: coordinate(measures.table.coordinate(f"{name}.parameter", "1", found))}
    for i, (axis, component, formula) in enumerate(zip(COMPONENTS, p.at, formulas, strict=False)):
        along = _rows(measures, name, formula, own, (*where, i))
        measures.force(f"{name}.{axis}", [(measures.hold(name, difference(component, along)), constant(ONE))])


def _place(measures: Measures, connection: GuideCurve, path: Path) -> Point:
    if connection.friction is not None:
        raise InvalidParameter((*path, "friction"), "be left out on a curve or surface by formula")
    place = measures.coordinates.point(connection.place, (*path, "place"))
    if place.body is None:
        raise InvalidParameter((*path, "place"), "belong to a body")
    return place


def _component(measures: Measures, value: object, path: Path) -> MotionFormula:
    found = motion_formula(value, measures.numerals, [PARAMETER], (), path)
    if found is not None:
        return found
    return of_number(measures.numerals.number(value, path))


def _rows(measures: Measures, name: str, formula: MotionFormula, own: Mapping[str, Poly], path: Path) -> Poly:
    names = {**own, TIME: coordinate(clock(measures))} if TIME in formula.names else own
    return FormulaRows(measures, name, path, names).of(formula.root)


def _parameter(at: Curve, place: Sequence[Ball], guesses: Sequence[Ball], *, sketch: bool) -> Ball | None:
    """Return the parameter at which a curve passes a place, or comes nearest in a sketch; None without any.

    Where a curve has no direction, as at a cusp, a step beside it changes its slope entirely.
    """

    def slope(u: Ball) -> list[Ball]:
        return [(x - y) / _DIFFERENCE for x, y in zip(at(u + _DIFFERENCE), at(u), strict=True)]

    for guess in guesses:
        u = guess
        for _ in range(_ROUNDS):
            way, missed = slope(u), [x - y for x, y in zip(place, at(u), strict=True)]
            square = scalar_product(way, way)
            if not (square.is_finite() and square > 0):
                break
            step = (scalar_product(way, missed) / square).mid()
            u = (u + step).mid()
            if not abs(step) < _DIFFERENCE * _DIFFERENCE * (ONE + abs(u)):
                continue
            turned = [x - y for x, y in zip(slope(u + _BESIDE), way, strict=True)]
            directed = 4 * scalar_product(turned, turned) < square
            extent = sum((abs(x) + abs(x - y) for x, y in zip(place, missed, strict=True)), ONE)
            if directed and (sketch or sum(map(abs, missed), ZERO) < CLOSE * extent):
                # Steps end beside the parameter; where it is a double, the place is on the curve without rounding.
                near = ONE * float(u)
                exact = all(is_zero(x - y) for x, y in zip(place, at(near), strict=True))
                return near if exact else u
            break
    return None
