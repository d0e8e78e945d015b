"""Passes that make a table smaller without changing its motion, to a fixed point, each saying what it found.

*Integrate*: rates in constant proportion are a measure. *Combine*: measures whose quadratic parts depend on one another
leave a linear one. *Linear*: a measure of degree one gives a coordinate away. *Factor*: a product is the factor that
vanishes, as long as the other one does not. *Twins*: functions of time that are the same are one. *Pin*: coordinates at
rest whose equations vanish wherever they stay are constants. *Separate*: what nothing ties to a place falls as its
centre of mass does. The last two serve the motion from the given start only, never questions about its surroundings.
"""

from __future__ import annotations

from dataclasses import replace

from core.multibody.algebra.polynomials import (
    ONE,
    ZERO,
    Ball,
    Poly,
    combined,
    constant,
    degree,
    difference,
    entry,
    evaluated,
    gradient,
    is_zero,
    product,
    substituted,
    variables,
)
from core.multibody.algebra.rank import Elimination, Line
from core.multibody.equations.dynamics import parts
from core.multibody.reduction.degenerate_rows import resolve
from core.multibody.reduction.pinning import pin, separate
from core.multibody.reduction.reduction import Reduced, substitute
from core.multibody.table.connection_effects import Limit
from core.multibody.table.table import Row, Table, identity

_MOST_FACTORED = 8
"""Coordinates in a measure for which a factor is looked for."""


def reduced(table: Table, *, pinning: bool) -> Reduced:
    """Apply the passes to a table until none of them finds anything."""
    return further(Reduced(table, identity(len(table.names)), table.names, twins=table.twins), pinning=pinning)


def further(state: Reduced, *, pinning: bool) -> Reduced:
    """Apply the passes to what has been reduced already, which is brought up to date, until none finds anything."""
    state.table = replace(state.table, rows=list(state.table.rows))
    while True:
        changed = _integrate(state.table)
        changed = _combine(state) or changed
        changed = _factor(state) or changed
        changed = _linear(state) or changed
        changed = _straighten(state) or changed
        if not changed:
            changed = resolve(state) or _twins(state)
        if not changed and pinning:
            changed = pin(state) or separate(state)
        if not changed:
            return state


def _integrate(table: Table) -> bool:
    """Turn rates in constant proportion that stay zero into measures."""
    changed = False
    for number, row in enumerate(table.rows):
        if row.measure is None and row.rate == 0 and row.constant and not row.drag:
            measure: Poly = {(j,): poly[()] for j, poly in row.rates.items()}
            measure = combined((ONE, measure), (-evaluated(measure, table.q), constant(ONE)))
            table.rows[number] = Row.held(row.name, measure)
            changed = True
    return changed


def _combine(state: Reduced) -> bool:
    """Find combinations of measures without quadratic terms, and drop measures that follow from others.

    What is replaced or dropped is the measure with the largest part in the combination, so that those that are left
    determine it well.
    """
    leading: dict[tuple[int, ...], tuple[Poly, Line]] = {}
    given = state.table.rows
    rows: dict[int, Row] = {}
    for number, row in enumerate(given):
        rows[number] = row
        if row.measure is None or degree(row.measure) < 2 or row.drag:
            continue
        rest, weights = row.measure, {number: ONE}
        while True:
            hit = next((key for key in rest if len(key) == 2 and key in leading), None)
            if hit is None:
                break
            rest, weights = _less(rest, weights, rest[hit], leading[hit])
        square = [key for key in rest if len(key) == 2]
        if square:
            pivot = max(square, key=lambda key: abs(float(rest[key].mid())))
            lead = 1 / rest[pivot]
            scaled = combined((lead, rest)), {i: lead * x for i, x in weights.items()}
            for key, (other, combination) in leading.items():
                if pivot in other:
                    leading[key] = _less(other, combination, other[pivot], scaled)
            leading[pivot] = scaled
            continue
        weightiest = max(weights, key=lambda i: abs(float(weights[i].mid())) * _largest(given[i]))
        name = given[weightiest].name
        if variables([rest]):
            rows[weightiest] = Row.held(name, rest)
            state.steps.append(f"{name}: linear beside other measures")
        else:
            del rows[weightiest]
            state.steps.append(f"{name}: follows from other measures")
        if weightiest != number:
            # Combinations in which it has a part are no longer those of the measures.
            state.table.rows = [*rows.values(), *given[number + 1 :]]
            return True
    changed = len(rows) < len(given) or any(rows[i] is not row for i, row in enumerate(given) if i in rows)
    state.table.rows = list(rows.values())
    return changed


def _largest(row: Row) -> float:
    """Return the largest coefficient of the measure of a row."""
    return max((abs(float(x.mid())) for x in (row.measure or {}).values()), default=0.0)


def _less(poly: Poly, weights: Line, factor: Ball, other: tuple[Poly, Line]) -> tuple[Poly, Line]:
    """Return a combination of measures, and its weights, less a multiple of another."""
    left = dict(weights)
    for i, x in other[1].items():
        left[i] = entry(left, i) - factor * x
    return combined((ONE, poly), (-factor, other[0])), left


def _factor(state: Reduced) -> bool:
    """Replace a measure that is a product by the factor that vanishes."""
    changed = False
    for number, row in enumerate(state.table.rows):
        if row.measure is None or degree(row.measure) < 2 or row.drag:
            continue
        if len(variables([row.measure])) > _MOST_FACTORED:
            continue
        factors = _factors(row.measure)
        if factors is None:
            continue
        values = [evaluated(factor, state.table.q) for factor in factors]
        zero = [i for i in (0, 1) if is_zero(values[i])]
        if len(zero) == 1:
            held, other = factors[zero[0]], factors[1 - zero[0]]
            state.table.rows[number] = Row.held(row.name, held)
            state.steps.append(f"{row.name}: a product of which one factor vanishes")
            if variables([difference(other, held)]):
                sign = ONE if values[1 - zero[0]] > 0 else -ONE
                branch = state.in_original(combined((sign, other)))
                state.branches.append(Limit("singular", row.name, length=branch))
            changed = True
    return changed


def _factors(measure: Poly) -> tuple[Poly, Poly] | None:
    """Return two affine factors of a quadratic, up to a constant, or None."""
    first = _completed(measure)
    if first is None:
        return _factors_without_squares(measure)
    base, rest = first
    # measure ~ base^2 + rest
    negative = combined((-ONE, rest))
    if degree(negative) == 0:
        if not negative[()] > 0:
            return None
        root = constant(negative[()].sqrt())
    else:
        pivot = next((key for key in negative if len(key) == 2 and key[0] == key[1]), None)
        if pivot is None or not negative[pivot] > 0:
            return None
        second = _completed(negative, pivot[0])
        if second is None or second[1]:
            return None
        root = combined((negative[pivot].sqrt(), second[0]))
    return combined((ONE, base), (ONE, root)), combined((ONE, base), (-ONE, root))


def _factors_without_squares(measure: Poly) -> tuple[Poly, Poly] | None:
    """Return two affine factors of a quadratic in which no coordinate has a square, or None."""
    i, j = next(key for key in measure if len(key) == 2)
    lead = measure[i, j]
    first, second = (
        {tuple(k for k in key if k != left): value / lead for key, value in measure.items() if left in key}
        for left in (j, i)
    )
    return None if combined((ONE, measure), (-lead, product(first, second))) else (first, second)


def _completed(poly: Poly, index: int | None = None) -> tuple[Poly, Poly] | None:
    """Write a quadratic over its coefficient of a square as (q_i + affine)^2 + rest."""
    if index is None:
        square = next((key for key in poly if len(key) == 2 and key[0] == key[1]), None)
        if square is None:
            return None
        index = square[0]
    lead = poly[(index, index)]
    base: Poly = {(index,): ONE}
    for key, value in poly.items():
        if index in key and key != (index, index):
            other = tuple(i for i in key if i != index)
            base[other] = value / (2 * lead)
    return base, combined((1 / lead, poly), (-ONE, product(base, base)))


def _twins(state: Reduced) -> bool:
    """Make one of functions of time that are the same and meet in a part; parts apart keep their own.

    Connections may say that sines are equal: cosines could change their sign then where they vanish.
    """
    part = {i: k for k, indices in enumerate(parts(state.table)) for i in indices}
    for twin, first in state.twins:
        both = state.expressions[twin], state.expressions[first]
        apart = combined((ONE, both[0]), (-ONE, both[1]))
        if variables([apart]) and len({part[i] for i in variables(both)}) == 1:
            state.table.rows.append(Row.held(state.names[twin], apart))
            state.steps.append(f"{state.names[twin]}: {state.names[first]} is the same function of time")
            return True
    return False


def _linear(state: Reduced) -> bool:
    """Give one coordinate away for every measure of degree one."""
    table = state.table
    linear = [row for row in table.rows if _gives_away(row)]
    if not linear:
        return False
    elimination = Elimination([_readiness(table, i) for i in range(len(table.names))])
    for row in linear:
        measure = row.measure or {}
        line = {key[0]: value for key, value in measure.items() if key}
        if elimination.add(line, -entry(measure, ())) is not None:
            state.steps.append(f"{row.name}: follows from other measures")
    table.rows = [row for row in table.rows if not _gives_away(row)]
    expressions: list[Poly | None] = [None] * len(table.names)
    for i, (line, value) in elimination.pivots.items():
        expression: Poly = {(k,): -y for k, y in line.items()}
        if value != 0:
            expression[()] = value
        expressions[i] = expression
    substitute(state, expressions)
    return True


def _straighten(state: Reduced) -> bool:
    """Make a coordinate of the gap of a rubbing contact, and drop its square from other measures.

    Such a measure of degree one cannot give its coordinate away: the friction needs its multiplier. But the gap w stays
    zero, so that w^2 has no part in the gradient of any other measure.
    """
    table = state.table
    closed = {next(iter(row.rates)) for row in table.rows if row.drag and _is_gap(row)}
    for row in table.rows:
        if row.measure is None or degree(row.measure) != 1 or not row.drag:
            continue
        line = {key[0]: x for key, x in row.measure.items() if key}
        free = [i for i in line if i not in closed]
        if (len(line) == 1 and () not in row.measure) or not free:
            continue
        pivot = max(free, key=lambda i: (_readiness(table, i), abs(float(line[i]))))
        away = _across(table, line, pivot)
        if len(free) < len(line):
            # The gaps of others stay what they are.
            away = {i: 1 / line[i] if i == pivot else ZERO for i in line}
        expressions = identity(len(table.names))
        gap: Poly = {(i,): -x / line[pivot] for i, x in line.items() if i != pivot}
        if () in row.measure:
            gap[()] = -row.measure[()] / line[pivot]
        for i in line:
            if i != pivot and away[i] != 0:
                expressions[i] = {(i,): ONE, (pivot,): away[i]}
        expressions[pivot] = {**gap, (pivot,): away[pivot]}
        unit = table.units[pivot]
        changed = table.changed(expressions, range(len(table.names)))
        changed.names[pivot], changed.units[pivot] = f"{row.name}.gap", unit
        for i in line:
            if i != pivot and away[i] != 0:
                # Along the level of the gap, and no longer along its axis.
                head, _, axis = table.names[i].rpartition(".")
                changed.names[i] = f"{head}'.{axis}"
        changed.q[pivot] = changed.v[pivot] = ZERO
        state.table = changed
        state.expressions = [substituted(expression, expressions) for expression in state.expressions]
        state.steps.append(f"{row.name}: its gap is a coordinate")
        return True
    changed_any = False
    for number, row in enumerate(table.rows):
        if row.measure is None or _is_gap(row):
            continue
        kept = {
            key: x for key, x in row.measure.items() if not (len(key) == 2 and key[0] == key[1] and key[0] in closed)
        }
        if len(kept) < len(row.measure):
            table.rows[number] = Row(row.name, kept, gradient(kept), ZERO, row.drag)
            changed_any = True
    return changed_any


def _across(table: Table, line: dict[int, Ball], pivot: int) -> dict[int, Ball]:
    """Return the direction in which a gap opens by one: across its level by the masses, so that these stay apart."""
    masses = {i: table.mass.get((i, i)) for i in line}
    coupled = any(i != j and (i in line or j in line) for i, j in table.mass)
    if coupled or any(mass is None for mass in masses.values()):
        return {i: 1 / line[i] if i == pivot else ZERO for i in line}
    total = sum((x * x / masses[i] for i, x in line.items()), ZERO)
    return {i: x / masses[i] / total for i, x in line.items()}


def _is_gap(row: Row) -> bool:
    return row.measure is not None and len(row.measure) == 1 and degree(row.measure) == 1


def _gives_away(row: Row) -> bool:
    """Return whether a row is a measure of degree one whose multiplier nothing else needs, as friction would."""
    return row.measure is not None and degree(row.measure) <= 1 and not row.drag


def _readiness(table: Table, i: int) -> int:
    """Return how readily a coordinate is given away: lengths and positions first, time never."""
    if table.units[i] == "m" and (i, i) not in table.mass:
        return 6
    return {"s": 0, "1": 1, "1/m": 1, "rad": 2, "m": 3}[table.units[i]]
