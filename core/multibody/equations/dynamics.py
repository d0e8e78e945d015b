"""Accelerations, forces and energies at the start, in balls; the parts of a scene that do not see one another."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass, field
from math import inf

from core.errors import AccuracyUnreachable, InvalidParameter
from core.multibody.algebra.large_systems import LARGE, solved_from_doubles
from core.multibody.algebra.polynomials import BITS, ONE, ZERO, Ball, entry, evaluated, is_zero
from core.multibody.algebra.rank import Elimination, independent, is_share_of
from core.multibody.algebra.square_systems import solved
from core.multibody.laws.series import values_at
from core.multibody.table.connection_effects import Force
from core.multibody.table.measures import Measures
from core.multibody.table.table import Row, Table


def parts(table: Table) -> list[list[int]]:
    """Return the coordinates of the parts of a table that have no term in common; the clock belongs to all."""
    parent = list(range(len(table.names)))

    def root(i: int) -> int:
        while parent[i] != i:
            parent[i] = parent[parent[i]]
            i = parent[i]
        return i

    timeless = [unit != "s" for unit in table.units]

    def join(indices: Sequence[int]) -> None:
        seen = [i for i in indices if timeless[i]]
        for i in seen[1:]:
            parent[root(i)] = root(seen[0])

    for part in (table.mass, table.stiffness, table.damping, table.gyration):
        keys: list[tuple[int, ...]] = list(part)
        for key in keys:
            join(key)
    for row in table.rows:
        join(sorted(row.coordinates()))
    for law in table.acting:
        join(sorted(law.coordinates()))
    groups: dict[int, list[int]] = {}
    for i in range(len(parent)):
        if timeless[i]:
            groups.setdefault(root(i), []).append(i)
    clocks = [i for i in range(len(parent)) if not timeless[i]]
    found = [[*group, *clocks] if _sees(table, group, clocks) else group for group in groups.values()]
    if clocks and not any(set(clocks) <= set(group) for group in found):
        # What is driven alone is an expression of the time, which then is a part of its own.
        found.append(clocks)
    return found


def _sees(table: Table, group: list[int], clocks: list[int]) -> bool:
    inside, timed = set(group), set(clocks)
    if not timed:
        return False
    for part in (table.mass, table.stiffness, table.damping, table.gyration):
        keys: list[tuple[int, ...]] = list(part)
        for key in keys:
            if timed & set(key) and inside & set(key):
                return True
    every = [row.coordinates() for row in table.rows] + [law.coordinates() for law in table.acting]
    return any(timed & seen and inside & seen for seen in every)


def restricted(table: Table, indices: Sequence[int]) -> Table:
    """Return the table of one part."""
    number = {i: k for k, i in enumerate(indices)}
    new = Table([table.names[i] for i in indices], [table.units[i] for i in indices])
    new.q, new.v = [table.q[i] for i in indices], [table.v[i] for i in indices]
    new.mass = {(number[i], number[j]): x for (i, j), x in table.mass.items() if i in number and j in number}
    new.mass = {(min(key), max(key)): x for key, x in new.mass.items()}
    new.load = {number[i]: x for i, x in table.load.items() if i in number}
    new.stiffness = {(number[i], number[j]): x for (i, j), x in table.stiffness.items() if i in number}
    new.damping = {(number[i], number[j]): x for (i, j), x in table.damping.items() if i in number}
    new.gyration = {(number[i], number[j], number[k]): x for (i, j, k), x in table.gyration.items() if i in number}
    for row in table.rows:
        if not row.coordinates() <= set(number):
            continue
        renamed = None
        if row.measure is not None:
            renamed = {tuple(sorted(number[i] for i in key)): x for key, x in row.measure.items()}
        rates = {
            number[j]: {tuple(number[i] for i in key): x for key, x in poly.items()} for j, poly in row.rates.items()
        }
        drag = {
            number[j]: {tuple(number[i] for i in key): x for key, x in poly.items()} for j, poly in row.drag.items()
        }
        new.rows.append(Row(row.name, renamed, rates, row.rate, drag))
    new.laws = [law.renumbered(number) for law in table.acting if law.coordinates() <= set(number)]
    return new


def accelerations(table: Table) -> tuple[list[Ball], list[int]]:
    """Return the accelerations at the start, and the rows that do not follow from those before them.

    Raises
    ------
    InvalidParameter
        If something without mass can move by itself.
    """
    count = len(table.names)
    lines = [row.line(table.q) for row in table.rows]
    chosen = independent(lines)
    size = count + len(chosen)
    if not size:
        return [], []
    entries: dict[tuple[int, int], Ball] = {}
    for (i, j), value in table.mass.items():
        entries[i, j] = entries[j, i] = value
    for k, r in enumerate(chosen):
        entries.update({(count + k, j): value for j, value in lines[r].items()})
        entries.update({(j, count + k): -value for j, value in table.rows[r].pushed(table.q).items()})
    right = [*table.forces(), *(table.convective(table.rows[r]) for r in chosen)]
    found: Sequence[Ball] | None = solved_from_doubles(entries, right) if size >= LARGE else None
    if found is None:
        try:
            found = solved([[entry(entries, (i, j)) for j in range(size)] for i in range(size)], right)
        except ZeroDivisionError:
            raise weightless(table, range(count), lines) from None
    return list(found[:count]), chosen


def weightless(table: Table, indices: Iterable[int], lines: Iterable[dict[int, Ball]]) -> InvalidParameter:
    """Return the fault of coordinates that nothing determines: no mass, and no connection to what has some."""
    among = set(indices)
    free = undetermined(table, among, lines)
    names = sorted({table.names[i].split(".")[0] for i in free or among})
    return InvalidParameter(
        ("bodies", names[0]) if len(names) == 1 else ("bodies",),
        f"have mass and inertia where they move by themselves, unlike what {', '.join(names)} leaves free",
        remedy="give it mass or inertia, connect it to a body that has some, or start away from a singular place",
    )


def undetermined(table: Table, among: set[int], lines: Iterable[dict[int, Ball]]) -> list[int]:
    """Return coordinates of a set that neither mass nor rows determine."""
    elimination = Elimination()
    for i in among:
        column = {j: x for j in among if (x := table.mass.get((min(i, j), max(i, j)))) is not None}
        elimination.add(column, ZERO)
    for line in lines:
        elimination.add({j: x for j, x in line.items() if j in among}, ZERO)
    return [i for i in sorted(among) if i not in elimination.pivots]


def singular_row(table: Table, chosen: Sequence[int]) -> Row | None:
    """Return a measure that follows from others at the start only, which makes the start a singular place.

    Where a row of W depends on others, what is left of its second derivative has to vanish along every direction that
    the connections leave free; else the free places branch there, or there are none.
    """
    others = [r for r in range(len(table.rows)) if r not in set(chosen)]
    if not others:
        return None
    lines = [row.line(table.q) for row in table.rows]
    elimination = Elimination()
    for r in chosen:
        elimination.add(lines[r], ZERO)
    free = [j for j in range(len(table.names)) if j not in elimination.pivots]
    directions = [{f: ONE, **{j: -line[f] for j, (line, _) in elimination.pivots.items() if f in line}} for f in free]
    for r in others:
        measure = table.rows[r].measure
        if measure is None:
            continue
        weights = Elimination()
        for j in range(len(table.names)):
            column = {i: lines[i][j] for i in chosen if j in lines[i]}
            weights.add(column, lines[r].get(j, ZERO))
        bend = _slopes(table.rows[r], ONE)
        for i in weights.pivots:
            for key, x in _slopes(table.rows[i], -weights.pivots[i][1]).items():
                bend[key] = entry(bend, key) + x
        for a, first in enumerate(directions):
            for second in directions[: a + 1]:
                if not is_zero(_bilinear(bend, first, second)):
                    return table.rows[r]
    return None


def _slopes(row: Row, factor: Ball) -> dict[tuple[int, int], Ball]:
    """Return by how much the line of a row changes with each coordinate, times a factor."""
    return {
        (key[0], j): factor * value for j, poly in row.rates.items() for key, value in poly.items() if len(key) == 1
    }


def _bilinear(form: dict[tuple[int, int], Ball], first: dict[int, Ball], second: dict[int, Ball]) -> Ball:
    total = ZERO
    for key, x in form.items():
        i, j = key
        total = total + x * (entry(first, i) * entry(second, j) + entry(first, j) * entry(second, i))
    return total


@dataclass(frozen=True)
class ForceAtStart:
    """A force of a connection at the start.

    Attributes
    ----------
    value : ball or None
        None where the scene does not determine it.
    shared_with : tuple of str
        Connections between which an undetermined force is shared.
    """

    value: Ball | None
    shared_with: tuple[str, ...] = field(default=())


@dataclass(frozen=True)
class Multipliers:
    """All multipliers that give the accelerations at the start.

    Attributes
    ----------
    elimination : Elimination
        Multipliers by the numbers of their rows: those determined, in terms of those that are free.
    bodies : frozenset of str
        Names that are no connections: their rows are what makes a body rigid.
    """

    table: Table
    elimination: Elimination
    bodies: frozenset[str]

    @property
    def rank(self) -> int:
        """Number of rows that do not follow from others."""
        return len(self.elimination.pivots)

    def redundant(self) -> dict[str, tuple[str, ...]]:
        """Return the connections with a row that follows from others at the start, each with those others."""
        found: dict[str, tuple[str, ...]] = {}
        pivots = self.elimination.pivots
        for r, row in enumerate(self.table.rows):
            if r not in pivots:
                others = {self.table.rows[k].name for k, (rest, _) in pivots.items() if r in rest}
                found[row.name] = tuple(sorted(others - {row.name} - self.bodies))
        return {name: others for name, others in found.items() if others and name not in self.bodies}


def multipliers_at_start(measures: Measures, acceleration: Sequence[Ball], rounding: float = 0.0) -> Multipliers:
    """Return the multipliers that give the accelerations.

    Parameters
    ----------
    rounding : float
        Share of its terms up to which what is left of an equation may be that of a rounded state, and determines
        nothing.

    Raises
    ------
    InvalidParameter
        At a singular place, if none do.
    AccuracyUnreachable
        If numbers of very different size leave none that do.
    """
    table = measures.table
    pushed, given = table.inertial(acceleration), table.forces()
    lines: list[dict[int, Ball]] = [{} for _ in table.names]
    for r, row in enumerate(table.rows):
        for j, value in row.pushed(table.q).items():
            lines[j][r] = value
    elimination = Elimination()
    known = rounding * max((float(abs(x)) for x in (*pushed, *given)), default=0.0) if rounding else 0.0
    for line, inertia, force in zip(lines, pushed, given, strict=True):
        rest, left = elimination.reduced(line, inertia - force)
        if rest:
            if not (rounding and is_share_of([*rest.values()], rounding, [*line.values()]) and abs(left) <= known):
                elimination.determine(rest, left)
        elif not is_zero(left) and not abs(left) <= known:
            if len(table.independent_rows()) < len(table.rows):
                raise InvalidParameter(
                    ("connections",),
                    "be able to carry the loads: the start is a singular place, where no finite forces hold the bodies "
                    "as the connections require",
                    remedy="start elsewhere, or leave out the loads that act there",
                )
            # What is small beside the largest of the numbers was lost, and with it a coefficient.
            reason = f"the forces are not known in {BITS} bits, as the numbers of the scene differ too much in size"
            remedy = "choose units and an origin by which the numbers are moderate"
            raise AccuracyUnreachable(None, inf, reason, path=("bodies",), remedy=remedy)
    return Multipliers(table, elimination, frozenset(measures.coordinates.frames))


def forces_at_start(measures: Measures, multipliers: Multipliers) -> list[ForceAtStart]:
    """Return every named force; one is determined if it is the same for all multipliers that give the accelerations."""
    return [_force(measures, force, multipliers.elimination) for force in measures.forces]


def _force(measures: Measures, force: Force, elimination: Elimination) -> ForceAtStart:
    table = measures.table
    total = evaluated(force.of_state, table.q)
    for j, value in force.of_rates.items():
        total = total + value * table.v[j]
    for j, value in force.of_squares.items():
        total = total + value * table.v[j] * table.v[j]
    if force.of_laws:
        forces = values_at(table.laws, table.q, table.v)
        total = sum((value * forces[number] for number, value in force.of_laws.items()), total)
    line = {row: evaluated(poly, table.q) for row, poly in force.terms}
    free, value = elimination.reduced({row: x for row, x in line.items() if not is_zero(x)}, -total)
    if not free:
        return ForceAtStart(-value)
    # Whatever depends on the same free multipliers shares the undetermined load.
    shared = {table.rows[r].name for r in free}
    shared |= {table.rows[r].name for r, (rest, _) in elimination.pivots.items() if set(rest) & set(free)}
    return ForceAtStart(None, tuple(sorted(shared - set(measures.coordinates.frames))))


def kinetic(table: Table) -> Ball:
    """Return q' M q'/2 at the start."""
    momenta = table.inertial(table.v)
    return sum((p * v for p, v in zip(momenta, table.v, strict=True)), ZERO) / 2


def potential(table: Table) -> Ball:
    """Return q K q/2 - b q at the start."""
    total = ZERO
    for i, value in table.potential_load.items():
        total = total - value * table.q[i]
    for (i, j), value in table.stiffness.items():
        total = total + value * table.q[i] * table.q[j] / 2
    return total
