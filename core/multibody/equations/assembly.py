"""The state at the start: positions that meet every measure, velocities that meet every connection."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from itertools import combinations

from flint import arb, arb_mat

from core.balls import as_text
from core.errors import InvalidParameter, NotApplicable, Path, PlacesDisagree
from core.multibody.algebra.polynomials import ONE, ZERO, Ball, change_by, evaluated, is_zero, larger, size
from core.multibody.algebra.rank import Elimination, Line, independent
from core.multibody.table.frames import Given
from core.multibody.table.measures import CLOSE
from core.multibody.table.scene_sizes import sizes
from core.multibody.table.table import Row, Table

CLOSE_RATE = 1e-9
"""Relative mismatch of rates up to which rounded figures are taken to be meant as the connections say."""

_NEWTON_STEPS_OF_POSITIONS = 40
"""Newton steps of the positions: quadratic convergence takes three from a mismatch of 1e-6. The others are for
singular places, where every step halves what is left."""

_APART = 0.75
"""Power of the share by which places miss their measures up to which lines depend on one another on them: redundant
ones differ by a multiple of that share (the power one), those of a singular place by its square root."""


def assemble_places(table: Table, paths: Mapping[str, Path]) -> list[str]:
    """Move the coordinates onto the measures, as little as possible; return what had to be moved.

    Newton's method in balls on W W^T. A position that is right to the precision of balls is not touched.

    Raises
    ------
    InvalidParameter
        If the positions contradict a connection by more than rounding, with the connection and by how much.
    """
    # The motion that has led here may have rounded what follows from others apart from these.
    table.q = _followed(table, list(table.q))
    rows = [row for row in table.rows if row.measure is not None]
    residuals = [evaluated(row.measure or {}, table.q) for row in rows]
    if all(is_zero(x) for x in residuals):
        return []
    moved: list[str] = []
    extents = _extents(table)
    for row, residual in zip(rows, residuals, strict=True):
        if is_zero(residual):
            continue
        scale = change_by(row.measure or {}, table.q, extents)
        if not abs(residual) < CLOSE * scale:
            raise PlacesDisagree(
                paths.get(row.name, ()),
                f'agree with the positions: "{row.name}" misses them by {as_text(abs(residual), 3)}'
                f" (of the sizes of the terms of its equation, {as_text(abs(residual) / scale, 2)} is left over)",
                remedy="move the bodies so that connected places meet",
            )
        if row.name not in moved:
            moved.append(row.name)
    _newton(table, paths)
    return moved


def _extents(table: Table) -> list[Ball]:
    """Return for every coordinate the size of the vector of which it is a component: that of a direction is one.

    Lengths are those of the scene, and not distances from the origin.
    """
    largest: dict[tuple[str, str], Ball] = {}
    owners = [(name.rpartition(".")[0] or name, unit) for name, unit in zip(table.names, table.units, strict=True)]
    for owner, q in zip(owners, table.q, strict=True):
        before: Ball = largest.get(owner, ONE if owner[1] == "1" else ZERO)
        largest[owner] = larger(before, abs(q))
    return sizes(table, [largest[owner] for owner in owners])


def _newton(table: Table, paths: Mapping[str, Path]) -> None:
    # What follows from others keeps its tie to them to first order, and has its own value after every step.
    rows = [*(row for row in table.rows if row.measure is not None), *(one.row for one in table.follows)]
    extents, fixed = _extents(table), {*table.timed, *table.clocks}
    terms = [size(row.measure or {}, extents) for row in rows]
    for _ in range(_NEWTON_STEPS_OF_POSITIONS):
        table.q = [q.mid() for q in table.q]
        lines = [{j: x for j, x in row.line(table.q).items() if j not in fixed} for row in rows]
        residuals = [evaluated(row.measure or {}, table.q) for row in rows]
        # Lines are known as well as the measures are met: rows that are redundant there differ by that much here.
        missed = max((float(abs(x) / y) for x, y in zip(residuals, terms, strict=True) if y > 0), default=0.0)
        chosen = independent(lines, missed**_APART)
        step = least_change(table, [lines[i] for i in chosen], [residuals[i] for i in chosen])
        table.q = _followed(table, [q - d for q, d in zip(table.q, step, strict=True)])
        scale = max(float(abs(q)) for q in table.q)
        if max(float(abs(d)) for d in step) <= 2.0**-150 * scale:
            # Quadratic convergence: what is left is far below the last step, whose width is that of the measures: what
            # has begun has the places of its beginning in them.
            least = 2.0**-280 * scale
            q = [arb(q.mid(), max(float(d.abs_upper()), least)) for q, d in zip(table.q, step, strict=True)]
            table.q = _followed(table, q)
            break
    for row in rows:
        residual = evaluated(row.measure or {}, table.q)
        if not is_zero(residual) and not abs(residual) < 1e-60 * size(row.measure or {}, table.q):
            raise InvalidParameter(
                paths.get(row.name, ()), f'agree with the other connections: "{row.name}" cannot hold beside them'
            )


def _followed(table: Table, q: list[Ball]) -> list[Ball]:
    """Return coordinates of which those that follow from others do so."""
    for one in table.follows:
        for i, value in zip(one.indices, one.function(evaluated(one.argument, q)), strict=True):
            q[i] = value
    return q


def least_change(table: Table, lines: Sequence[Line], residuals: Sequence[Ball]) -> list[Ball]:
    """Return the smallest change that undoes residuals to first order."""
    count = len(lines)
    if not count:
        return [ZERO] * len(table.q)
    gram = arb_mat(
        [
            [sum((x * lines[b][j] for j, x in lines[a].items() if j in lines[b]), ZERO) for b in range(count)]
            for a in range(count)
        ]
    )
    try:
        weights = gram.solve(arb_mat([[x] for x in residuals])).entries()
    except ZeroDivisionError:
        raise NotApplicable(
            "lengths or masses are so far apart that 320 bits cannot tell which connections hold",
            path=("connections",),
            remedy="leave out whatever is negligibly small",
        ) from None
    step = [ZERO] * len(table.q)
    for line, weight in zip(lines, weights, strict=True):
        for j, x in line.items():
            step[j] = step[j] + x * weight
    return step


def assemble_rates(
    table: Table, given: Sequence[Given], paths: Mapping[str, Path], gaps: Sequence[Row] = ()
) -> list[str]:
    """Set the rates at the start: those given, and of the others those of least kinetic energy.

    The rates of `gaps` that touch are zero as far as they can all be, and positive where they do not hold.

    Raises
    ------
    InvalidParameter
        If a given velocity contradicts the connections, with the value that goes with them.
    """
    if all(is_zero(entry.value) for entry in given) and all(row.rate == 0 for row in table.rows):
        return []
    elimination = Elimination()
    noticed: list[str] = []
    for row in table.rows:
        left = elimination.add(row.line(table.q), row.rate)
        if left is not None and not is_zero(left):
            raise InvalidParameter(
                paths.get(row.name, ()), f'agree with the other connections: the rates that "{row.name}" holds do not'
            )
    # In balls: rates may be beyond the range of doubles.
    scale = ZERO
    for entry in given:
        scale = larger(scale, abs(entry.value))
    for entry in given:
        left = elimination.add(entry.line, entry.value)
        if left is None or is_zero(left):
            continue
        if not abs(left.mid()) <= CLOSE_RATE * scale:
            follows = entry.value - left
            raise InvalidParameter(
                entry.path,
                f"agree with the connections and the velocities before it, from which {as_text(follows, 10)} follows",
                remedy="leave it out, or change what it contradicts",
            )
        noticed.append("/".join(map(str, entry.path)))
    table.v = _least_energy(table, _with_gaps(table, elimination, [row.line(table.q) for row in gaps]))
    return noticed


def _with_gaps(table: Table, others: Elimination, gaps: Sequence[Line]) -> Elimination:
    """Return equations with those of gaps that stay closed, whatever their order.

    Gaps that can all stay closed do. Of those that cannot, as a string and a floor beside what moves upwards, the rates
    are those of least kinetic energy by which none closes.
    """
    found = others.copy()
    if all(is_zero(left) for line in gaps if (left := found.add(line, ZERO)) is not None):
        return found
    contrary = _contrary(others, gaps, len(table.q))
    found = others.copy()
    for i, line in enumerate(gaps):
        if i not in contrary:
            found.add(line, ZERO)
    return _closed_at_least_energy(table, found, [gaps[i] for i in sorted(contrary)])


def _contrary(others: Elimination, gaps: Sequence[Line], count: int) -> set[int]:
    """Return the gaps whose rates depend on one another in a way by which they cannot all be zero.

    The rates are unknowns beside those of the coordinates, which are determined first: what is left are equations
    between the rates of gaps. Those that share unknowns belong together, in whatever order they were found.
    """
    found = Elimination([1] * count + [0] * len(gaps))
    found.pivots = others.copy().pivots
    for i, line in enumerate(gaps):
        found.add({**line, count + i: -ONE}, ZERO)
    together: list[tuple[set[int], bool]] = []
    for pivot, (line, value) in found.pivots.items():
        if pivot < count or not line:
            # A coordinate, or a gap whose rate nothing can change.
            continue
        members, contradict = {pivot - count, *(j - count for j in line)}, not is_zero(value)
        shared = [group for group in together if group[0] & members]
        together = [group for group in together if not group[0] & members]
        members = members.union(*(group for group, _ in shared))
        together.append((members, contradict or any(other for _, other in shared)))
    return {i for members, contradict in together if contradict for i in members}


def _closed_at_least_energy(table: Table, others: Elimination, gaps: Sequence[Line]) -> Elimination:
    """Return equations with those of gaps that are closed where energy is least of all rates by which none closes.

    These are the ones beside which none closes, and of which each would close if it were not held.
    """
    rates: dict[tuple[int, ...], list[Ball]] = {}
    for closed in (some for number in range(len(gaps) + 1) for some in combinations(range(len(gaps)), number)):
        found = others.copy()
        if any(found.add(gaps[i], ZERO) is not None for i in closed):
            # One follows from the others, or contradicts them.
            continue
        v = _least_energy(table, found)
        rates[closed] = [sum((x * v[j] for j, x in line.items()), ZERO) for line in gaps]
        without = [rates[tuple(j for j in closed if j != i)][i] for i in closed]
        if not any(x < 0 and not is_zero(x) for x in (*rates[closed], *(-x for x in without))):
            return found
    # One closes whatever is chosen: that is an impact at the start.
    return others


def _least_energy(table: Table, elimination: Elimination) -> list[Ball]:
    count = len(table.q)
    start = elimination.solution(range(count))
    free = [j for j in range(count) if j not in elimination.pivots]
    momenta = table.inertial(start)
    if not free or all(is_zero(p) for p in momenta):
        return start
    modes: list[Line] = []
    for f in free:
        mode = {f: ONE}
        for j, (line, _) in elimination.pivots.items():
            if f in line:
                mode[j] = -line[f]
        modes.append(mode)
    pushed = []
    for mode in modes:
        dense = [ZERO] * count
        for j, x in mode.items():
            dense[j] = x
        pushed.append(table.inertial(dense))
    least = Elimination()
    for mode in modes:
        line = {b: sum((x * pushed[b][j] for j, x in mode.items()), ZERO) for b in range(len(modes))}
        least.add(
            {b: x for b, x in line.items() if not is_zero(x)}, -sum((x * momenta[j] for j, x in mode.items()), ZERO)
        )
    for mode, weight in zip(modes, least.solution(range(len(modes))), strict=True):
        for j, x in mode.items():
            start[j] = start[j] + weight * x
    return start
