"""Names of the coordinates of a table as people write them, and what each is in the columns of an answer.

A coordinate of a body keeps the name that formulas have for it, ``bob.x`` or ``rod.angle``. What the reduction has made
has a name of its own and a formula of such columns.
"""

from __future__ import annotations

import re
from collections.abc import Collection, Mapping, Sequence

from core.formulas import Node
from core.multibody.algebra.polynomials import ONE, ZERO, Ball, Poly, combined, entry
from core.multibody.formulation.chart import DIRECTION, Chart
from core.multibody.formulation.formula_nodes import call, node_of_poly
from core.multibody.formulation.unused_names import unused
from core.multibody.reduction.reduction import Reduced

_AXES = {"x": "1", "y": "2", "z": "3"}
_PLAIN = re.compile(r"[A-Za-z][\w-]*(\.[A-Za-z][\w-]*)*", re.ASCII)
"""Names that need no other one."""


def symbols_of(names: Sequence[str]) -> list[str]:
    """Return names of coordinates as variables, each once."""
    found: list[str] = []
    for name in names:
        found.append(unused(_symbol(name), found))
    return found


def _symbol(name: str) -> str:
    # A number cannot be read as a part of a name, but at its end.
    name = re.sub(r"\.(\d+)", r"_\1", name)
    if _PLAIN.fullmatch(name):
        return name
    first = name.split(" - ")[0]
    head, _, axis = first.rpartition(".")
    if " - " in name:
        # A place relative to another body.
        return f"{head}.d{axis}"
    if name.startswith("centre of "):
        return f"centre.{axis}"
    # Along axes that are turned, or an angle less a share of a gap.
    head = head.rstrip("'")
    return f"{head}.s{_AXES[axis]}" if axis in _AXES else f"{head}.{axis}0"


def columns_of(reduced: Reduced, bodies: Collection[str], dimension: int) -> dict[int, Node]:
    """Return formulas of columns for the coordinates of a reduced table, as far as these follow from columns."""
    lines: list[tuple[dict[int, Ball], Poly, bool]] = []
    names: dict[int, Node] = {}
    for i, (name, expression) in enumerate(zip(reduced.names, reduced.expressions, strict=True)):
        column = _column(name, bodies, dimension)
        line = {key[0]: x for key, x in expression.items() if key}
        if column is not None and line:
            names[i] = column
            value = combined((ONE, {(i,): ONE}), (-ONE, {(): expression.get((), ZERO)}))
            lines.append((line, value, column.kind not in DIRECTION))
    # What stands alone in a column is that column, before any combination of others; the direction of a body is that of
    # its angle, which has its turns, before that of a place.
    lines.sort(key=lambda entry: (len(entry[0]), any(x != 1 for x in entry[0].values()), entry[2]))
    pivots: dict[int, tuple[dict[int, Ball], Poly]] = {}
    for line, value, _ in lines:
        _add(pivots, line, value)
    return {k: node_of_poly(value, names) for k, (line, value) in pivots.items() if not line}


def _add(pivots: dict[int, tuple[dict[int, Ball], Poly]], line: Mapping[int, Ball], value: Poly) -> None:
    rest: dict[int, Ball] = {}
    for k, x in line.items():
        other, known = pivots.get(k, ({k: -ONE}, {}))
        for j, y in other.items():
            rest[j] = rest.get(j, ZERO) - x * y
        value = combined((ONE, value), (-x, known))
    rest = {k: x for k, x in rest.items() if ZERO not in x}
    if not rest:
        return
    pivot = max(rest, key=lambda k: abs(float(rest[k])))
    lead = rest.pop(pivot)
    new = {k: x / lead for k, x in rest.items()}, combined((1 / lead, value))
    for k, (other, known) in list(pivots.items()):
        if pivot in other:
            x = other.pop(pivot)
            for j, y in new[0].items():
                other[j] = other.get(j, ZERO) - x * y
            pivots[k] = {j: y for j, y in other.items() if ZERO not in y}, combined((ONE, known), (-x, new[1]))
    pivots[pivot] = new


def _column(name: str, bodies: Collection[str], dimension: int) -> Node | None:
    """Return the column that a coordinate of the description is, None for what no column shows."""
    head, _, end = name.partition(".")
    if head not in bodies:
        return None
    if end in DIRECTION:
        return call(end, Node("name", f"{head}.angle"))
    if end in "xyz"[:dimension] or end == "angle" or re.fullmatch(r"axis[123]?\.[xyz]", end):
        return Node("name", name)
    return None


def coordinates_of(chart: Chart, columns: Mapping[int, Node]) -> dict[str, Node | None]:
    """Return the formulas of columns that the variables of a chart are, None for what no column shows."""
    found: dict[str, Node | None] = {}
    known = {name: columns.get(i) for i, name in enumerate(chart.symbols)}
    for name in chart.variables:
        found[name] = known.get(name)
    for one in chart.rounds:
        arms = [None if _unknown(arm, columns) else node_of_poly(arm, columns) for arm in one.arms]
        if None in arms:
            continue
        x, y, *rest = [arm for arm in arms if arm is not None]
        flat = call("sqrt", Node("+", inner=(_square(x), _square(y))))
        if rest:
            up = rest[0] if one.heading else Node("negative", inner=(rest[0],))
            found[one.angles[0]] = call("atan2", flat, up)
            found[one.angles[1]] = call("atan2", y, x)
            flat = call("sqrt", Node("+", inner=(flat.inner[0], _square(rest[0]))))
        elif found.get(one.angles[0]) is None:
            name = one.angles[0]
            column = next(
                (columns[i].inner[0] for i in _directions(chart, one.arms) if _is_cosine(columns.get(i))), None
            )
            angle = call("atan2", y, x) if one.heading else call("atan2", x, Node("negative", inner=(y,)))
            found[name] = column or angle
        lengths = [key[0] for key in one.radius if key]
        if len(lengths) == 1 and _is_missing(found, chart.symbols[lengths[0]]):
            found[chart.symbols[lengths[0]]] = _length(flat, one.radius, lengths[0])
    for row in chart.table.rows:
        for i, name in enumerate(chart.symbols):
            if row.measure is not None and _is_missing(found, name):
                found[name] = _from_square(row.measure, i, columns) or _from_product(row.measure, i, columns)
    return {name: found[name] for name in chart.variables}


def _is_missing(found: Mapping[str, Node | None], name: str) -> bool:
    """Return whether a name is that of a variable without a formula."""
    return name in found and found[name] is None


def _from_square(measure: Poly, i: int, columns: Mapping[int, Node]) -> Node | None:
    """Return a positive coordinate whose square a measure says, None where it says something else."""
    own = [key for key in measure if i in key]
    if own != [(i, i)]:
        return None
    rest = combined((-1 / measure[i, i], {key: value for key, value in measure.items() if key != (i, i)}))
    return None if _unknown(rest, columns) else call("sqrt", node_of_poly(rest, columns))


def _from_product(measure: Poly, i: int, columns: Mapping[int, Node]) -> Node | None:
    """Return a coordinate in which a measure is linear, with a factor of others, None of another one."""
    factor: Poly = {}
    rest: Poly = {}
    for key, value in measure.items():
        if key.count(i) > 1:
            return None
        if i in key:
            factor[tuple(k for k in key if k != i)] = -value
        else:
            rest[key] = value
    if not factor or _unknown(factor, columns) or _unknown(rest, columns):
        return None
    return Node("/", inner=(node_of_poly(rest, columns), node_of_poly(factor, columns)))


def _length(flat: Node, radius: Poly, i: int) -> Node:
    """Return the coordinate of which a length is an affine function."""
    lead, offset = radius[i,], entry(radius, ())
    form: Poly = {(0,): 1 / lead}
    if offset != 0:
        form[()] = -offset / lead
    return node_of_poly(form, {0: flat})


def _directions(chart: Chart, arms: Sequence[Poly]) -> list[int]:
    """Return the coordinate that is the cosine of the angle of a body, if the arms are cosine and sine."""
    first = next(iter(arms[0]))
    if len(arms[0]) == 1 and chart.symbols[first[0]].endswith(f".{DIRECTION[0]}"):
        return [first[0]]
    return []


def _is_cosine(column: Node | None) -> bool:
    return column is not None and column.kind == DIRECTION[0]


def _unknown(poly: Poly, columns: Mapping[int, Node]) -> bool:
    return any(i not in columns for key in poly for i in key)


def _square(node: Node) -> Node:
    return Node("^", inner=(node, Node("number", "2")))
