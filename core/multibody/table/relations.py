"""Relations between places and angles that formulas say: gears, racks, screws, belts."""

from __future__ import annotations

from core.balls import as_text
from core.errors import InvalidParameter, Path, PlacesDisagree
from core.formulas import UnknownName
from core.multibody.algebra.polynomials import ONE, Poly, change_by, constant, difference, evaluated
from core.multibody.language.joints import Relation
from core.multibody.language.motion_formulas import MOTION_FUNCTIONS, TIME, TURNS, names_of_bodies
from core.multibody.language.switches import SWITCHING
from core.multibody.table.formula_laws import formula_at, input_of
from core.multibody.table.formulas_of_time import FormulaRows
from core.multibody.table.measures import CLOSE, Measures
from core.multibody.table.rows import add_rows
from core.multibody.table.scene_sizes import sizes

_HELD = ("x", "y", "z", "angle", "turn")
"""Last parts of the names of what a relation holds: places and angles."""


@add_rows.register
def relation(connection: Relation, measures: Measures, name: str, path: Path) -> None:
    """Hold a formula at a value; the force is the generalised one that acts along the formula."""
    of, names = _side(measures, name, connection.of, (*path, "of"))
    equals, _ = _side(measures, name, connection.equals, (*path, "equals"))
    if not names - {TIME}:
        raise InvalidParameter((*path, "of"), 'name places or angles of bodies, such as "2*a.angle + 5*b.angle"')
    apart = difference(of, equals)
    missed, q = evaluated(apart, measures.table.q), measures.table.q
    if not (measures.loose or abs(missed) < CLOSE * (ONE + change_by(apart, q, sizes(measures.table, q)))):
        rule = f"be {as_text(evaluated(of, q), 10)}, as the formula is {measures.moment}"
        raise PlacesDisagree((*path, "equals"), rule, remedy="change it, or move the bodies")
    row = measures.hold(name, apart)
    measures.force(
        f"{name}.force", [(row, constant(ONE))], "N m" if all(one.rpartition(".")[2] in TURNS for one in names) else "N"
    )


def _side(measures: Measures, name: str, value: object, path: Path) -> tuple[Poly, frozenset[str]]:
    """Return one side of a relation, and the names of its formula."""
    try:
        formula = formula_at(measures, value, (), path)
    except UnknownName as fault:
        # Of rates and of functions of several pieces formulas know, and relations do not.
        numerals, bodies = measures.numerals, measures.coordinates.scene.bodies
        names = [one for one in names_of_bodies(bodies, measures.dimension) if one.rpartition(".")[2] in _HELD]
        functions = [one for one in MOTION_FUNCTIONS if one not in SWITCHING]
        known = [*numerals.let, *numerals.formulas, TIME, *names]
        raise UnknownName.among(fault.name, known, functions).inside(*path) from None
    if formula is None:
        return constant(measures.numerals.number(value, path)), frozenset()
    inputs = {one: input_of(measures, one, {}, path) for one in sorted(formula.names)}
    for one, given in inputs.items():
        if given.rate:
            raise InvalidParameter(path, f'have places, angles and the time alone, unlike "{one}"')
    forms = {one: given.form for one, given in inputs.items()}
    return FormulaRows(measures, name, path, forms).of(formula.root), formula.names
