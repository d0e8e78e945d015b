"""What the start tells of the coordinates: those that nothing ever moves, and the centre of mass of what is free.

Both passes serve the motion from the given start only, never questions about its surroundings.
"""

from __future__ import annotations

from collections.abc import Iterable

from core.multibody.algebra.polynomials import ONE, ZERO, Ball, Poly, combined, constant, entry, is_zero
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
            or any(not _vanishes(table, poly, pinned) for j, poly in row.rates.items() if j not in pinned)
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


def _vanishes(table: Table, poly: Poly, pinned: set[int]) -> bool:
    """Return whether an affine polynomial is zero whatever the coordinates that are not pinned."""
    total: Ball = ZERO
    for key, value in poly.items():
        if not key:
            total = total + value
        elif key[0] in pinned:
            total = total + value * table.q[key[0]]
        else:
            return False
    return is_zero(total)


def _letting_go(table: Table, pinned: set[int]) -> set[int]:
    """Return the numbers of rows that keep one coordinate at rest alone, and leave it free where others vanish.

    So does x y + z^2 = 0 with x = z = 0 where y = 0: there the motion may go on along other places. What has no
    mass, as the products of a formula, is taken from the rows before.
    """
    holding = {
        number: {j: poly for j, poly in row.rates.items() if j in pinned and not _vanishes(table, poly, pinned)}
        for number, row in enumerate(table.rows)
    }
    for j in pinned - {i for key in table.mass for i in key}:
        plain = [number for number, line in holding.items() if set(line.get(j, ())) == {()}]
        if plain:
            first = holding.pop(min(plain, key=lambda number: len(holding[number])))
            for number in plain:
                if number in holding:
                    line, share = holding[number], holding[number][j][()] / first[j][()]
                    rest = {k: combined((ONE, line.get(k, {})), (-share, first.get(k, {}))) for k in line | first}
                    holding[number] = {k: poly for k, poly in rest.items() if poly}
    one = {number: next(iter(line.values())) for number, line in holding.items() if len(line) == 1}
    return {number for number, poly in one.items() if any(key and key[0] not in pinned for key in poly)}


def _stays(table: Table, i: int, pinned: set[int], coupled: Iterable[tuple[int, ...]], live: list[Row]) -> bool:
    """Return whether the equation of a pinned coordinate vanishes, the multipliers of idle rows being zero."""
    for row in live:
        for line in (row.rates, row.drag):
            if i in line and not _vanishes(table, line[i], pinned):
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
