"""Measures whose gradients depend on one another at the start: what they are worth along the motion.

Where the lines of W depend on one another at a place q_0, a combination g of the measures has a vanishing gradient
there, so that g is a quadratic form in q - q_0. Three cases matter for the motion:

* g is semidefinite: g = sum of d_i h_i^2 with d_i of one sign, and g = 0 is h_i = 0 for all i. The affine h_i replace
  it: an identity, wherever the scene is.
* The free places near the start lie in an affine subspace, as those of bars that only move parallel to themselves do.
  The subspace is found from places near the start and then proven: within it the measures that are left are as many as
  they have to be, and independent, so that the places of the subspace are all there are on the component of the start.
* Otherwise g follows from the others along the motion, or the start is a singular place
  (`core.multibody.equations.dynamics.singular_row`); nothing is changed.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import replace

import numpy as np
from flint import arb

from core.errors import NotApplicable
from core.multibody.algebra.polynomials import (
    ONE,
    ZERO,
    Ball,
    Poly,
    combined,
    constant,
    entry,
    evaluated,
    is_zero,
    product,
    substituted,
    variables,
)
from core.multibody.algebra.rank import Elimination, Line, independent
from core.multibody.equations.assembly import least_change
from core.multibody.reduction.reduction import Reduced
from core.multibody.table.table import Row, Table

_INDEPENDENT = 1e-6
"""Ratio of singular values in doubles from which lines are independent for certain: far above their rounding."""

_STRIDE = 0.125
"""How far from the start places are taken, as a share of the coordinates: the n-th derivatives of the free places are
then visible as 8^-n, beside 2^-280 to which the places are known."""

_NEWTON_STEPS = 12
"""From a share of an eighth to 2^-280 quadratic convergence takes nine."""


def resolve(state: Reduced) -> bool:
    """Replace measures that depend on others at the start by the affine ones that they mean."""
    rows = [row for row in state.table.rows if row.measure is not None and not row.drag]
    if not _may_depend(state.table, rows):
        return False
    return _squares(state, rows) or _subspace(state, rows)


def _may_depend(table: Table, rows: Sequence[Row]) -> bool:
    """Return whether the lines of measures may depend on one another at the start."""
    if not rows:
        return False
    lines = np.zeros((len(rows), len(table.names)))
    for k, row in enumerate(rows):
        for j, value in row.line(table.q).items():
            lines[k, j] = float(value.mid())
    size = np.max(np.abs(lines), axis=1)
    if len(rows) > len(table.names) or not np.all(size > 0.0) or not np.all(np.isfinite(size)):
        return True
    singular = np.linalg.svd(lines / size[:, None], compute_uv=False)
    return bool(singular[-1] <= _INDEPENDENT * singular[0])


def _dependent(table: Table, rows: Sequence[Row]) -> Iterator[tuple[int, Poly]]:
    """Yield the rows whose line depends on those before them, with their measure less that of those."""
    lines = [row.line(table.q) for row in rows]
    chosen: list[int] = []
    basis = Elimination()
    for k, line in enumerate(lines):
        if basis.add(line, ZERO) is None:
            chosen.append(k)
            continue
        weights = Elimination()
        for j in range(len(table.names)):
            weights.add({i: lines[i][j] for i in chosen if j in lines[i]}, line.get(j, ZERO))
        terms = ((-weights.pivots[i][1], rows[i].measure or {}) for i in weights.pivots)
        yield k, combined((ONE, rows[k].measure or {}), *terms)


def _squares(state: Reduced, rows: Sequence[Row]) -> bool:
    """Replace a measure that is, beside others, a sum of squares of one sign by what is squared."""
    for k, measure in _dependent(state.table, rows):
        roots = squared(measure)
        if roots is None:
            continue
        others = [row for row in state.table.rows if row is not rows[k]]
        state.table.rows = [*others, *(Row.held(rows[k].name, root) for root in roots)]
        state.steps.append(
            f"{rows[k].name}: a sum of squares, each of which vanishes"
            if roots
            else f"{rows[k].name}: follows from other measures"
        )
        return True
    return False


def squared(measure: Poly) -> list[Poly] | None:
    """Return affine polynomials whose squares, with factors of one sign, add up to a quadratic; None where none do.

    Squares are completed one coordinate after another (Lagrange).
    """
    rest, found, sign = measure, [], 0
    while rest:
        pivot = next((key[0] for key in rest if len(key) == 2 and key[0] == key[1]), None)
        if pivot is None:
            return None
        lead = rest[pivot, pivot]
        positive = 1 if lead > 0 else -1
        if sign == -positive:
            return None
        sign = positive
        root: Poly = {(pivot,): ONE}
        for key, value in rest.items():
            if pivot in key and key != (pivot, pivot):
                root[tuple(i for i in key if i != pivot)] = value / (2 * lead)
        rest = combined((ONE, rest), (-lead, product(root, root)))
        rest = {key: value for key, value in rest.items() if pivot not in key}
        found.append(root)
    return found


def _subspace(state: Reduced, rows: Sequence[Row]) -> bool:
    """Add the affine measures that hold for all free places next to the start."""
    table = state.table
    inside = sorted(variables(row.measure or {} for row in rows))
    hull = _affine_hull(table, rows, inside)
    if hull is None or len(hull.pivots) == len(inside):
        return False
    held = [_through(table, line) for line in _complement(hull, inside)]
    if not _proven(table, rows, inside, held):
        return False
    name = ", ".join(dict.fromkeys(row.name for row in rows))
    state.table.rows = [*table.rows, *(Row.held(rows[0].name, measure) for measure in held)]
    state.steps.append(f"{name}: their free places lie in an affine subspace")
    return True


def _affine_hull(table: Table, rows: Sequence[Row], inside: Sequence[int]) -> Elimination | None:
    """Return the span of the ways from the start to free places next to it, None where these are not found."""
    lines = [row.line(table.q) for row in rows]
    chosen = independent(lines)
    tangent = Elimination()
    for k in chosen:
        tangent.add(lines[k], ZERO)
    free = [j for j in inside if j not in tangent.pivots]
    scale = {
        unit: max((float(abs(table.q[j])) for j in inside if table.units[j] == unit), default=0.0) or 1.0
        for unit in set(table.units)
    }
    hull = Elimination()
    if not free:
        return hull
    idle = 0
    # A place of the subspace adds a direction, but for a set of measure zero; two in a row that add none end it.
    for number in range(2 * len(inside) + 2):
        place = _free_place(table, rows, chosen, _stride(tangent, free, number, scale, table.units))
        if place is None:
            return None
        way = {j: x for j in inside if not is_zero(x := place[j] - table.q[j])}
        idle = 0 if hull.add(way, ZERO) is None else idle + 1
        if idle == 2 or len(hull.pivots) == len(inside):
            return hull
    return None


def _stride(
    tangent: Elimination, free: Sequence[int], number: int, scale: dict[str, float], units: Sequence[str]
) -> Line:
    """Return one of a sequence of steps along the connections."""
    step: Line = {}
    for k, f in enumerate(free):
        # Multiples of the golden ratio are spread evenly (Weyl) and depend on one another for no short sequence.
        share = ((number + 1) * (k + 1) * 0.6180339887498949) % 1.0 - 0.5
        step[f] = ONE * (_STRIDE * share * scale[units[f]])
    for j, (line, _) in tangent.pivots.items():
        step[j] = sum((-line[f] * step[f] for f in free if f in line), ZERO)
    return step


def _free_place(table: Table, rows: Sequence[Row], chosen: Sequence[int], step: Line) -> list[Ball] | None:
    """Return the place on the measures next to one that is a step away from the start, None where there is none."""
    q = [x + step[j] if j in step else x for j, x in enumerate(table.q)]
    trial = replace(table)
    for _ in range(_NEWTON_STEPS):
        q = [x.mid() for x in q]
        lines = [rows[k].line(q) for k in chosen]
        try:
            change = least_change(trial, lines, [evaluated(rows[k].measure or {}, q) for k in chosen])
        except NotApplicable:
            return None
        q = [x - d for x, d in zip(q, change, strict=True)]
        largest, size = (max((float(abs(x)) for x in values), default=0.0) for values in (change, q))
        if largest <= 2.0**-150 * size:
            q = [arb(x.mid(), max(largest, 2.0**-280 * size)) for x in q]
            return q if all(is_zero(evaluated(row.measure or {}, q)) for row in rows) else None
    return None


def _complement(hull: Elimination, inside: Sequence[int]) -> list[Line]:
    """Return linear forms that vanish on a span of ways."""
    found = []
    for j in inside:
        if j not in hull.pivots:
            form: Line = {j: ONE}
            for i, (line, _) in hull.pivots.items():
                if j in line:
                    form[i] = ZERO - line[j]
            found.append(form)
    return found


def _through(table: Table, form: Line) -> Poly:
    """Return a linear form less its value at the start."""
    measure: Poly = {(j,): x for j, x in form.items()}
    return combined((ONE, measure), (-evaluated(measure, table.q), constant(ONE)))


def _proven(table: Table, rows: Sequence[Row], inside: Sequence[int], held: Sequence[Poly]) -> bool:
    """Return whether affine measures follow from others on the component of the start.

    The independent measures bound a manifold of dimension d at the start. Where the subspace holds a manifold of the
    same dimension on which all measures vanish, the two are one.
    """
    lines = [row.line(table.q) for row in rows]
    dimension = len(inside) - len(independent(lines))
    elimination = Elimination()
    for measure in held:
        elimination.add({key[0]: x for key, x in measure.items() if key}, -entry(measure, ()))
    expressions: list[Poly] = [{(i,): ONE} for i in range(len(table.names))]
    for i, (line, value) in elimination.pivots.items():
        expressions[i] = combined((-ONE, {(k,): y for k, y in line.items()}), (value, constant(ONE)))
    left: list[Poly] = []
    leading = _Independent()
    for row in rows:
        rest = leading.added(substituted(row.measure or {}, expressions))
        if rest:
            left.append(rest)
    gradients = [Row.held("", rest).line(table.q) for rest in left]
    free = len(inside) - len(elimination.pivots)
    return len(independent(gradients)) == len(left) == free - dimension


class _Independent:
    """Polynomials without those that are combinations of others."""

    def __init__(self) -> None:
        self._numbers: dict[tuple[int, ...], int] = {}
        self._elimination = Elimination()

    def added(self, poly: Poly) -> Poly:
        """Return a polynomial, empty if it is a combination of those before."""
        line = {self._numbers.setdefault(key, len(self._numbers)): x for key, x in poly.items()}
        return {} if self._elimination.add(line, ZERO) is not None else poly
