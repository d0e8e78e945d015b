"""Measures whose gradients depend on one another at the start: what they are worth along the motion.

Where the lines of W depend on one another at a place q_0, a combination g of the measures has a vanishing gradient
there, so that g is a quadratic form in q - q_0. Three cases matter for the motion:

* g is semidefinite: g = sum of d_i h_i^2 with d_i of one sign, and g = 0 is h_i = 0 for all i. The affine h_i replace
  it: an identity, wherever the scene is.
* The free places near the start lie in an affine subspace, as those of bars that only move parallel to themselves do.
  The subspace is found from places near the start and then proven: within it the measures that are left are as many as
  they have to be, and independent, so that the places of the subspace are all there are on the component of the start.
  g may be semidefinite along the directions that the lines of W leave: then only its kernel is free among these.
* Otherwise g follows from the others along the motion, or the start is a singular place
  (`core.multibody.equations.dynamics.singular_row`); nothing is changed.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence

import numpy as np

from core.errors import InvalidParameter
from core.multibody.algebra.orthogonal_rests import least_rest
from core.multibody.algebra.polynomials import (
    ONE,
    ZERO,
    Ball,
    LinearForm,
    Poly,
    combined,
    constant,
    entry,
    evaluated,
    is_zero,
    product,
    substituted,
)
from core.multibody.algebra.rank import Elimination, Line, independent
from core.multibody.algebra.recordable import recordable
from core.multibody.reduction.free_places import FreePlaces, tangent_directions
from core.multibody.reduction.reduction import Reduced
from core.multibody.table.table import Row, Table

_INDEPENDENT = 1e-6
"""Share of a line that is left beside others in doubles from which it does not depend on them for certain: far above
their rounding, also where those leave as little of one another."""


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
    lines = [row.line(table.q) for row in rows]
    return dependent_in_doubles([[entry(line, j) for j in range(len(table.names))] for line in lines])


@recordable
def dependent_in_doubles(rows: Sequence[Sequence[Ball]]) -> bool:
    """Return whether lines may depend on one another, as far as doubles tell."""
    return not least_rest(np.array([[float(x.mid()) for x in row] for row in rows])) > _INDEPENDENT


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
        why = "a sum of squares, each of which vanishes" if roots else "follows from other measures"
        return _hold(state, rows[k].name, roots, why, others)
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
    lines = [row.line(table.q) for row in rows]
    bounds = [rows[k].measure or {} for k in independent(lines)]
    double = _double(table, rows, bounds)
    if double is None:
        return False
    places = FreePlaces(table, [*bounds, *double], [row.measure or {} for row in rows])
    inside = places.inside
    if not places.span() or len(places.hull.pivots) == len(inside):
        return False
    held = [_through(table, form) for form in places.complement()]
    dimension = len(inside) - len(bounds) - len(double)
    if not _proven(table, rows, inside, held, dimension):
        return False
    if double and len(independent(row.line(places.last) for row in rows)) > len(bounds):
        # Elsewhere in the subspace the measures are independent: the start is where it meets other free places.
        return False
    return _hold(state, rows[0].name, held, "free places lie in an affine subspace", state.table.rows)


def _hold(state: Reduced, name: str, held: Sequence[Poly], why: str, others: Sequence[Row]) -> bool:
    """Add affine measures beside rows.

    Raises
    ------
    InvalidParameter
        If the rates of the start contradict them, which the lines of W at the start do not show.
    """
    rows = [Row.held(name, measure) for measure in held]
    for row in rows:
        if not is_zero(sum((x * state.table.v[j] for j, x in row.line(state.table.q).items()), ZERO)):
            raise InvalidParameter(
                ("connections",),
                f'agree with the velocities: the start is a singular place, where "{name}" and the connections around '
                "it hold what the velocities move, to second order",
                remedy="leave out the velocities, or start elsewhere",
            )
    state.table.rows = [*others, *rows]
    state.steps.append(f"{name}: {why}")
    return True


def _double(table: Table, rows: Sequence[Row], bounds: Sequence[Poly]) -> list[Poly] | None:
    """Return affine measures of the places where measures that depend on others vanish doubly; None where none are.

    Along the directions t that the lines of W leave, such a measure is t H t to second order. Where that is
    semidefinite, nothing but its kernel is free, and H (q - q_0) = 0 holds along the motion if the measures go on to
    depend on one another in the same way.
    """
    directions = tangent_directions(table, bounds)
    found: list[Poly] = []
    basis = Elimination()
    for _, measure in _dependent(table, rows):
        slopes, form = _bent(measure, directions)
        if squared(form) is None:
            return None
        for slope in slopes if form else ():
            across = {
                a: sum((y * slope[j] for j, y in t.items() if j in slope), ZERO) for a, t in enumerate(directions)
            }
            if basis.add({a: x for a, x in across.items() if not is_zero(x)}, ZERO) is None:
                found.append(_through(table, slope))
    return found


def _bent(measure: Poly, directions: Sequence[Line]) -> tuple[list[Line], Poly]:
    """Return the second derivative of a measure times each direction, and its quadratic form in shares of them."""
    bend = Row.held("", measure).rates
    slopes = [_applied(bend, direction) for direction in directions]
    form: Poly = {}
    for a, slope in enumerate(slopes):
        for b, direction in enumerate(directions[: a + 1]):
            x = sum((y * direction[j] for j, y in slope.items() if j in direction), ZERO)
            if not is_zero(x):
                form[b, a] = x / 2 if a == b else x
    return slopes, form


def is_least(table: Table, gap: Poly) -> bool:
    """Return whether a gap that is zero is larger at all places beside it to which the measures of a table lead.

    To second order: its line depends on those of the measures, and what they leave of its second derivative is a sum
    of squares. A pendulum at its lowest place has such a gap above a floor that it touches.
    """
    rows = [row for row in table.rows if row.measure is not None and not row.drag]
    rows.append(Row.held("", gap))
    own = next((measure for k, measure in _dependent(table, rows) if k == len(rows) - 1), None)
    if own is None:
        return False
    bounds = [rows[k].measure or {} for k in independent(row.line(table.q) for row in rows)]
    _, form = _bent(own, tangent_directions(table, bounds))
    return bool(squared(form)) and all(x > 0 for (a, b), x in form.items() if a == b)


def _applied(bend: LinearForm, direction: Line) -> Line:
    """Return the second derivative of a quadratic, given its gradient, times a direction."""
    found: Line = {}
    for j, poly in bend.items():
        x = sum((value * direction[key[0]] for key, value in poly.items() if key and key[0] in direction), ZERO)
        if not is_zero(x):
            found[j] = x
    return found


def _through(table: Table, form: Line) -> Poly:
    """Return a linear form less its value at the start."""
    measure: Poly = {(j,): x for j, x in form.items()}
    return combined((ONE, measure), (-evaluated(measure, table.q), constant(ONE)))


def _proven(table: Table, rows: Sequence[Row], inside: Sequence[int], held: Sequence[Poly], dimension: int) -> bool:
    """Return whether affine measures follow from others on the component of the start.

    The independent measures, and those where others vanish doubly, bound a manifold of a dimension at the start. Where
    the subspace holds a manifold of the same dimension on which all measures vanish, the two are one.
    """
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
