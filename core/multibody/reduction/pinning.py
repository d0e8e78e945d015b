"""What the start tells of the coordinates: those that nothing ever moves, and the centre of mass of what is free.

Both passes serve the motion from the given start only, never questions about its surroundings.
"""

from __future__ import annotations

from collections.abc import Iterable

from core.multibody.algebra.polynomials import (
    ONE,
    Ball,
    LinearForm,
    Poly,
    add_term,
    combined,
    constant,
    entry,
    is_zero,
)
from core.multibody.equations.dynamics import undetermined, weightless
from core.multibody.reduction.centre_of_mass import centred, free_shift
from core.multibody.reduction.reduction import Reduced, recast, substitute
from core.multibody.table.table import Row, Table


def pin(state: Reduced) -> bool:
    """Make constants of coordinates at rest whose equations vanish wherever the others are."""
    table = state.table
    pushed = {i for law in table.acting for i in law.push}
    pinned = {i for i in range(len(table.names)) if is_zero(table.v[i]) and table.units[i] != "s" and i not in pushed}
    coupled: dict[int, dict[tuple[int, ...], None]] = {i: {} for i in pinned}
    for part in (table.mass, table.stiffness, table.damping, table.gyration):
        keys: list[tuple[int, ...]] = list(part)
        for key in keys:
            if key[0] in coupled:
                coupled[key[0]][key] = None
            if part is table.mass and key[1] in coupled and key[0] != key[1]:
                coupled[key[1]][key] = None
    while pinned:
        letting_go = _letting_go(table, pinned)
        live = [
            row
            for number, row in enumerate(table.rows)
            if row.drag
            or any(_at_rest(table, poly, pinned) for j, poly in row.rates.items() if j not in pinned)
            or number in letting_go
        ]
        leave = {i for i in pinned if not _stays(table, i, pinned, coupled[i], live)}
        if not leave:
            break
        pinned -= leave
    if not pinned:
        return False
    massless = pinned - _moved_with_mass(table)
    if massless:
        lost = massless.intersection(undetermined(table, pinned, [row.line(table.q) for row in table.rows]))
        if lost:
            raise weightless(table, lost, ())
    moved = [any(expression) for expression in state.expressions]
    state.steps.append(f"constant throughout the motion: {', '.join(table.names[i] for i in sorted(pinned))}")
    expressions: list[Poly | None] = [None] * len(table.names)
    for i in pinned:
        expressions[i] = constant(table.q[i])
    substitute(state, expressions)
    stays = (was and not any(now) for was, now in zip(moved, state.expressions, strict=True))
    state.pinned.extend(name for name, still in zip(state.names, stays, strict=True) if still)
    return True


def separate(state: Reduced) -> bool:
    """Split off a coordinate of the centre of mass of what nothing ties to a place: it falls freely by itself."""
    shift = free_shift(state.table)
    if shift is None:
        return False
    expressions, start, name = centred(state.table, shift)
    pivot = min(shift)
    old = state.table
    recast(state, expressions, list(range(len(old.names))))
    table = state.table
    for j in shift:
        table.q[j], table.v[j] = (x[j] - shift[j] / shift[pivot] * x[pivot] for x in (old.q, old.v))
        table.names[j] = f"{old.names[j]} - {old.names[pivot]}"
    (table.q[pivot], table.v[pivot]), table.names[pivot] = start, name
    state.steps.append(f"{name} moves by itself")
    return True


def _moved_with_mass(table: Table) -> set[int]:
    """Return coordinates that have mass, or are connected to some: a weightless pulley stays where strings pull it."""
    found = {i for key in table.mass for i in key}
    waiting = [set(row.rates) for row in table.rows]
    while touching := [row for row in waiting if row & found]:
        found.update(*touching)
        waiting = [row for row in waiting if not row & found]
    return found


def _at_rest(table: Table, poly: Poly, pinned: set[int]) -> Poly:
    """Return an affine polynomial where coordinates are pinned, as one of the others."""
    total: Poly = {}
    for key, value in poly.items():
        resting = key and key[0] in pinned
        add_term(total, () if resting else key, value * table.q[key[0]] if resting else value)
    return {key: value for key, value in total.items() if not is_zero(value)}


def _letting_go(table: Table, pinned: set[int]) -> set[int]:
    """Return the numbers of rows that keep coordinates at rest only where polynomials of others do not vanish.

    So does x y + z^2 = 0 with x = z = 0 where y = 0: there the motion may go on along other places. The rows are a
    matrix of polynomials, in which other rows are taken from each as far as they have constant entries, as those of
    what formulas multiply: of p = x y and y = p t one row is left, in which y has 1 - x t. Of rows that hold several
    coordinates only those of formulas let go, which are linear in one: the axes of a body never depend on one another,
    and the lines of a direction, which has no mass, where its length is zero, and that ends a motion by itself.
    """
    heavy = {i for key in table.mass for i in key}
    holding: dict[int, LinearForm] = {}
    linear: dict[int, set[int]] = {}
    for number, row in enumerate(table.rows):
        line = {j: _at_rest(table, poly, pinned) for j, poly in row.rates.items() if j in pinned}
        holding[number] = {j: poly for j, poly in line.items() if poly}
        linear[number] = {j for j, poly in row.rates.items() if set(poly) == {()}}
    while True:
        pivots = (
            (len(line), number, j)
            for number, line in holding.items()
            for j, poly in line.items()
            if set(poly) == {()} and (j in heavy or j in linear[number] or j not in table.rows[number].rates)
        )
        pivot = min(pivots, default=None)
        if pivot is None:
            changing = {n: line for n, line in holding.items() if any(set(poly) != {()} for poly in line.values())}
            directions = pinned.difference(heavy, *linear.values())
            return {
                n for n, line in changing.items() if (len(line) == 1 or linear[n]) and not directions.issuperset(line)
            }
        _, number, j = pivot
        first = holding.pop(number)
        for other, line in holding.items():
            if j in line:
                share = combined((-1 / first[j][()], line[j]))
                rest = {
                    k: combined((ONE, line.get(k, {})), (ONE, _product(share, first.get(k, {}))))
                    for k in line | first
                    if k != j
                }
                holding[other] = {k: poly for k, poly in rest.items() if poly}


def _product(first: Poly, second: Poly) -> Poly:
    """Return the product of two polynomials of any degree."""
    total: Poly = {}
    for a, x in first.items():
        for b, y in second.items():
            add_term(total, tuple(sorted(a + b)), x * y)
    return total


def _stays(table: Table, i: int, pinned: set[int], coupled: Iterable[tuple[int, ...]], live: list[Row]) -> bool:
    """Return whether the equation of a pinned coordinate vanishes, the multipliers of idle rows being zero."""
    for row in live:
        for line in (row.rates, row.drag):
            if i in line and _at_rest(table, line[i], pinned):
                return False
    push: Ball = entry(table.load, i)
    carried: dict[int, Ball] = {}
    for key in coupled:
        if len(key) == 3:
            _, j, k = key
            if k not in pinned:
                if j not in pinned:
                    return False
                carried[k] = entry(carried, k) + table.gyration[(i, j, k)] * table.q[j]
            continue
        other = key[1] if key[0] == i else key[0]
        if other not in pinned:
            return False
        if key[0] == i and key in table.stiffness:
            push = push - table.stiffness[key] * table.q[other]
    return is_zero(push) and all(is_zero(value) for value in carried.values())
