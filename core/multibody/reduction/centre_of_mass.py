"""What nothing ties to a place: directions along which a part can be shifted, and the motion of its centre of mass.

A direction t is free where no row, stiffness, damping, gyration or formula sees it: W(q) t = 0 for every q, K t = 0 ...
Then s = t M q/(t M t) has a constant acceleration, whatever the others do, and the differences of the other coordinates
move without s. Both are exact: t is found by elimination in balls.
"""

from __future__ import annotations

from collections.abc import Iterator

from core.multibody.algebra.polynomials import ONE, ZERO, Ball, Poly, entry
from core.multibody.algebra.rank import Elimination, Line
from core.multibody.equations.dynamics import parts
from core.multibody.laws.linear import linear_form
from core.multibody.table.table import Table


def free_shift(table: Table) -> Line | None:
    """Return a direction with mass along which a part with quadratic terms can be shifted; None without one."""
    for part in parts(table):
        inside = set(part)
        if len(part) < 2 or not _quadratic(table, inside):
            continue
        elimination = Elimination()
        for line in _conditions(table, inside):
            elimination.add(line, ZERO)
            if len(elimination.pivots) == len(part):
                break
        for f in part:
            if f in elimination.pivots:
                continue
            shift = {f: ONE, **{j: -line[f] for j, (line, _) in elimination.pivots.items() if f in line}}
            if len(shift) > 1 and _inertia(table, shift) > 0:
                return shift
    return None


def centred(table: Table, shift: Line) -> tuple[list[Poly], tuple[Ball, Ball], str]:
    """Return the coordinates of a table by the differences from one of them and the centre of mass.

    Returns
    -------
    expressions : list of affine polynomials
        Of every coordinate; the first of the shift is now the centre of mass, and the others are differences from it.
    start : tuple of balls
        Centre of mass and its rate.
    name : str
    """
    pivot = min(shift)
    momenta = _times(table, shift)
    total = sum((shift[j] * momenta.get(j, ZERO) for j in shift), ZERO)
    weights = {j: x / total for j, x in momenta.items()}
    expressions: list[Poly] = [{(j,): ONE} for j in range(len(table.names))]
    for j, t in shift.items():
        expression: Poly = {(pivot,): t}
        for k, weight in weights.items():
            if k != pivot:
                expression[k,] = -t * weight
        if j != pivot:
            expression[j,] = entry(expression, (j,)) + 1
        expressions[j] = {key: x for key, x in expression.items() if 0 not in x}
    q = sum((x * table.q[j] for j, x in weights.items()), ZERO)
    v = sum((x * table.v[j] for j, x in weights.items()), ZERO)
    bodies = sorted({table.names[j].split(".")[0] for j in shift})
    among = ", ".join(bodies) if len(bodies) <= 4 else f"{len(bodies)} bodies"
    return expressions, (q, v), f"centre of {among}.{table.names[pivot].rpartition('.')[2]}"


def _quadratic(table: Table, inside: set[int]) -> bool:
    if any(key[0] in inside for key in table.gyration):
        return True
    laws = (law for law in table.acting if inside & law.coordinates())
    if any(linear_form(law.root, law.inputs, law.numbers) is None for law in laws):
        return True
    return any(not row.constant and inside & set(row.rates) for row in table.rows)


def _conditions(table: Table, inside: set[int]) -> Iterator[Line]:
    """Yield the linear equations of a direction in space that nothing sees."""
    for i in inside:
        if table.units[i] != "m":
            yield {i: ONE}
    for row in table.rows:
        if not inside & set(row.rates):
            continue
        by: dict[tuple[int, ...], Line] = {}
        for j, poly in row.rates.items():
            for key, value in poly.items():
                by.setdefault(key, {})[j] = value
        yield from by.values()
    for law in table.acting:
        # It reads nothing of the direction, and its forces along it add up to nothing.
        for line in (law.push, *({key[0]: x for key, x in one.form.items() if key} for one in law.inputs.values())):
            if inside & set(line):
                yield dict(line)
    for part in (table.stiffness, table.damping, table.gyration):
        keys: dict[tuple[int, ...], Ball] = dict(part.items())
        among = {key: value for key, value in keys.items() if key[0] in inside}
        for place in range(len(next(iter(among), ()))):
            lines: dict[tuple[int, ...], Line] = {}
            for key, value in among.items():
                line = lines.setdefault(key[:place] + key[place + 1 :], {})
                line[key[place]] = entry(line, key[place]) + value
            yield from lines.values()


def _times(table: Table, shift: Line) -> Line:
    """Return M times a direction."""
    found: Line = {}
    for (i, j), value in table.mass.items():
        for a, b in {(i, j), (j, i)}:
            if b in shift:
                found[a] = entry(found, a) + value * shift[b]
    return {j: x for j, x in found.items() if 0 not in x}


def _inertia(table: Table, shift: Line) -> Ball:
    return sum((shift[j] * x for j, x in _times(table, shift).items() if j in shift), ZERO)
