"""Which of the touching contacts stay closed, stick, slide or open: all combinations are tried.

A closed contact has N >= 0, an open one a gap that does not shrink, a sticking one |F| <= mu N, one that begins to
slide a rate of slip that grows against its friction. A sign is that of the first Taylor coefficient that is not zero,
in balls.
Contacts that do not push one another are decided apart.

References
----------
F. Pfeiffer, C. Glocker, "Multibody Dynamics with Unilateral Contacts" (1996). P. Painleve, "Sur les lois du frottement
de glissement", Comptes rendus 121 (1895).
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from itertools import combinations, product

from flint import arb_mat

from core.errors import BudgetExceeded
from core.multibody.contact_states import Problem, State, phase_table
from core.multibody.dynamics import weightless
from core.multibody.expansion import expansion, leading_sign, saddle
from core.multibody.measures import Unilateral
from core.multibody.polynomials import ZERO, Ball, entry, evaluated, gradient, is_zero
from core.multibody.rank import Elimination, independent
from core.multibody.table import Row, Table

MOST = 8
"""Contacts that push one another and are undecided at once."""
LOOKED = 8
"""Highest Taylor coefficient of the places that is looked at."""
_MOST_FREE = 3


def rate_along(rates: dict[int, Ball], v: Sequence[Ball]) -> Ball:
    """Return a line of W times rates."""
    return sum((x * v[j] for j, x in rates.items()), ZERO)


def gap_rate(one: Unilateral, q: Sequence[Ball], v: Sequence[Ball]) -> Ball:
    """Return the rate of a gap."""
    return sum((evaluated(poly, q) * v[j] for j, poly in gradient(one.gap).items()), ZERO)


def slip_rate(one: Unilateral, q: Sequence[Ball], v: Sequence[Ball]) -> Ball:
    """Return the rate of slip, zero without friction."""
    return sum((evaluated(poly, q) * v[j] for j, poly in (one.slip or {}).items()), ZERO)


@dataclass(frozen=True)
class Responses:
    """What the accelerations along contacts are: those without contact forces, and what forces add.

    Attributes
    ----------
    free : list of ball
        Accelerations of every line without contact forces.
    matrix : list of list of ball
        matrix[a][b]: acceleration along line a by a force one along line b.
    columns : list of list of ball
        Accelerations of all coordinates by a force one along each line.
    start : list of ball
        Accelerations of all coordinates without contact forces.
    reactions : list of dict
        Multipliers of the table's own rows, by their numbers, that answer a force one along each line.
    """

    free: list[Ball]
    matrix: list[list[Ball]]
    columns: list[list[Ball]]
    start: list[Ball]
    reactions: list[dict[int, Ball]]


def responses(table: Table, rows: Sequence[Row]) -> Responses:
    """Return how a table answers to forces along further rows.

    Raises
    ------
    InvalidParameter
        If something without mass can move by itself.
    """
    count = len(table.names)
    lines = [row.line(table.q) for row in table.rows]
    chosen = independent(lines)
    size = count + len(chosen)
    extra = [row.line(table.q) for row in rows]
    right = [[ZERO] * (1 + len(rows)) for _ in range(size)]
    for i, x in enumerate(table.forces()):
        right[i][0] = x
    for k, r in enumerate(chosen):
        right[count + k][0] = table.convective(table.rows[r])
    for b, line in enumerate(extra):
        for j, x in line.items():
            right[j][1 + b] = x
    try:
        solved = saddle(table, chosen).solve(arb_mat(right)).tolist()
    except ZeroDivisionError:
        raise weightless(table, range(count), lines) from None
    start = [solved[i][0] for i in range(count)]
    columns = [[solved[i][1 + b] for i in range(count)] for b in range(len(rows))]
    free = [rate_along(line, start) - table.convective(row) for line, row in zip(extra, rows, strict=True)]
    matrix = [[_nought(rate_along(line, column)) for column in columns] for line in extra]
    reactions = [{r: solved[count + k][1 + b] for k, r in enumerate(chosen)} for b in range(len(rows))]
    return Responses(free, matrix, columns, start, reactions)


def _nought(x: Ball) -> Ball:
    return ZERO if is_zero(x) else x


@dataclass(frozen=True)
class _Candidate:
    states: tuple[State, ...]
    forces: list[Ball]
    acceleration: list[Ball]
    undetermined: bool


def decided(
    base: Table, unilateral: Sequence[Unilateral], touching: Sequence[int], q: Sequence[Ball], v: Sequence[Ball]
) -> list[State] | Problem:
    """Return the states of all unilateral measures just after a state, or what is undecided about them.

    Parameters
    ----------
    touching : sequence of int
        Those whose gap is zero; none of them approaches.

    Raises
    ------
    BudgetExceeded
        For more than `MOST` contacts that push one another.
    """
    states = [State.OPEN] * len(unilateral)
    here = phase_table(base, (), (), q, v).table
    open_to: dict[int, tuple[State, ...]] = {}
    for i in touching:
        if not is_zero(gap_rate(unilateral[i], q, v)):
            continue
        one = unilateral[i]
        if one.slip is None:
            open_to[i] = (State.CLOSED, State.OPEN)
            continue
        slip = slip_rate(one, q, v)
        if is_zero(slip):
            open_to[i] = (State.STICK, State.FORWARD, State.BACKWARD, State.OPEN)
        else:
            open_to[i] = (State.FORWARD if slip > 0 else State.BACKWARD, State.OPEN)
    if not open_to:
        return states
    rows, normal, slips = lines_of(unilateral, list(open_to))
    found = responses(here, rows)
    for group in clusters(list(open_to), normal, slips, found.matrix):
        if len(group) > MOST:
            names = ", ".join(unilateral[i].name for i in group)
            raise BudgetExceeded(
                f"undecided contacts at once ({names})",
                len(group),
                MOST,
                path=("connections",),
                remedy="hold some of them by connections of another kind",
            )
        chosen = _one_group(base, unilateral, group, states, open_to, q, v, found, normal, slips)
        if isinstance(chosen, Problem):
            return chosen
        for i, state in zip(group, chosen, strict=True):
            states[i] = state
    return states


def lines_of(
    unilateral: Sequence[Unilateral], chosen: Sequence[int]
) -> tuple[list[Row], dict[int, int], dict[int, int]]:
    """Return the rows of gaps and slips of some measures, and which of them belong to which."""
    rows: list[Row] = []
    normal: dict[int, int] = {}
    slips: dict[int, int] = {}
    for i in chosen:
        one = unilateral[i]
        normal[i] = len(rows)
        rows.append(Row.held(one.name, one.gap))
        if one.slip is not None:
            slips[i] = len(rows)
            rows.append(Row(one.name, None, one.slip))
    return rows, normal, slips


def clusters(
    chosen: Sequence[int], normal: dict[int, int], slips: dict[int, int], matrix: Sequence[Sequence[Ball]]
) -> list[list[int]]:
    """Return the groups of measures that push one another."""
    left = list(chosen)
    found = []
    while left:
        group = [left.pop(0)]
        for i in group:
            mine = [normal[i], *([slips[i]] if i in slips else [])]
            for j in list(left):
                other = [normal[j], *([slips[j]] if j in slips else [])]
                if any(matrix[a][b] != 0 or matrix[b][a] != 0 for a in mine for b in other):
                    group.append(j)
                    left.remove(j)
        found.append(sorted(group))
    return found


def _one_group(
    base: Table,
    unilateral: Sequence[Unilateral],
    group: Sequence[int],
    settled: Sequence[State],
    open_to: dict[int, tuple[State, ...]],
    q: Sequence[Ball],
    v: Sequence[Ball],
    found: Responses,
    normal: dict[int, int],
    slips: dict[int, int],
) -> tuple[State, ...] | Problem:
    names = tuple(unilateral[i].name for i in group)
    consistent: list[_Candidate] = []
    for states in product(*(open_to[i] for i in group)):
        candidate = _balanced(unilateral, group, states, found, normal, slips)
        if isinstance(candidate, Problem):
            return candidate
        if candidate is None:
            continue
        if _lasts(base, unilateral, group, settled, candidate, open_to, q, v, found, normal, slips):
            consistent.append(candidate)
    if not consistent:
        return Problem(
            "no-motion",
            "no states of the contacts go with a motion of rigid bodies: the friction of what slides presses it on "
            "more strongly than its inertia gives way (Painleve)",
            names,
            decided_by="a compliance of the contact, or an impact without collision, in which the slip stops at once",
        )
    sticking = [one for one in consistent if not any(_sticks_more(other, one) for other in consistent)]
    for other in sticking[1:]:
        if not _same(sticking[0].acceleration, other.acceleration):
            return Problem(
                "several-motions",
                f"several motions are possible: {'; '.join(_told(one.states) for one in sticking)}",
                names,
                tuple({name: state.value for name, state in zip(names, one.states, strict=True)} for one in sticking),
                "a compliance of the contact and how it came to this state",
            )
    return max(sticking, key=lambda one: (sum(s is not State.OPEN for s in one.states), _stuck(one.states))).states


def _told(states: Sequence[State]) -> str:
    return ", ".join(state.value for state in states)


def _stuck(states: Sequence[State]) -> int:
    return sum(state is State.STICK for state in states)


def _sticks_more(other: _Candidate, one: _Candidate) -> bool:
    """Return whether another candidate differs only in that it sticks where this one begins to slide."""
    pairs = list(zip(other.states, one.states, strict=True))
    return any(a is not b for a, b in pairs) and all(a is b or (a is State.STICK and b.sense != 0) for a, b in pairs)


def _same(first: Sequence[Ball], second: Sequence[Ball]) -> bool:
    return all(is_zero(a - b) for a, b in zip(first, second, strict=True))


def _balanced(
    unilateral: Sequence[Unilateral],
    group: Sequence[int],
    states: Sequence[State],
    found: Responses,
    normal: dict[int, int],
    slips: dict[int, int],
) -> _Candidate | Problem | None:
    """Return the forces that go with states, None where none do that push."""
    unknowns: list[dict[int, Ball]] = []
    held: list[int] = []
    for i, state in zip(group, states, strict=True):
        if state is State.OPEN:
            continue
        push = {normal[i]: ZERO + 1}
        if state.sense:
            push[slips[i]] = -state.sense * unilateral[i].kinetic
        unknowns.append(push)
        held.append(normal[i])
        if state is State.STICK:
            unknowns.append({slips[i]: ZERO + 1})
            held.append(slips[i])
    size = len(unknowns)
    matrix = [[sum((found.matrix[a][b] * x for b, x in push.items()), ZERO) for push in unknowns] for a in held]
    right = [-found.free[a] for a in held]
    if not size:
        return _candidate(states, [ZERO] * len(found.free), found, undetermined=False)
    try:
        solved = arb_mat(matrix).solve(arb_mat([[x] for x in right])).entries()
        return _candidate(states, _spread(solved, unknowns, found), found, undetermined=False)
    except ZeroDivisionError:
        pass
    elimination = Elimination()
    for line, x in zip(matrix, right, strict=True):
        left = elimination.add({j: y for j, y in enumerate(line) if not is_zero(y)}, x)
        if left is not None and not is_zero(left):
            return None
    free = [j for j in range(size) if j not in elimination.pivots]
    if not free:
        return _candidate(
            states, _spread(elimination.solution(range(size)), unknowns, found), found, undetermined=False
        )
    for f in free:
        alone = [ZERO] * size
        alone[f] = ZERO + 1
        for j, (rest, _) in elimination.pivots.items():
            alone[j] = -entry(rest, f)
        pushed = _accelerations(_spread(alone, unknowns, found), found, from_rest=True)
        if not all(is_zero(x) for x in pushed):
            if not any(state.sense for state in states):
                return None
            sliding = tuple(unilateral[i].name for i, s in zip(group, states, strict=True) if s is not State.OPEN)
            return Problem(
                "undetermined-friction",
                "how the load is shared between the contacts is not determined, and their friction depends on it",
                sliding,
                decided_by="compliances of the contacts, or one coefficient of friction for all of them",
            )
    shares = _feasible(unilateral, group, states, elimination, free, size)
    if shares is None:
        return None
    return _candidate(states, _spread(shares, unknowns, found), found, undetermined=True)


def _spread(solved: Sequence[Ball], unknowns: Sequence[dict[int, Ball]], found: Responses) -> list[Ball]:
    forces = [ZERO] * len(found.free)
    for x, push in zip(solved, unknowns, strict=True):
        for b, factor in push.items():
            forces[b] = forces[b] + x * factor
    return forces


def _accelerations(forces: Sequence[Ball], found: Responses, *, from_rest: bool = False) -> list[Ball]:
    total = [ZERO] * len(found.start) if from_rest else list(found.start)
    for b, force in enumerate(forces):
        if force != 0:
            total = [x + force * y for x, y in zip(total, found.columns[b], strict=True)]
    return total


def _candidate(states: Sequence[State], forces: list[Ball], found: Responses, *, undetermined: bool) -> _Candidate:
    return _Candidate(tuple(states), forces, _accelerations(forces, found), undetermined)


def _feasible(
    unilateral: Sequence[Unilateral],
    group: Sequence[int],
    states: Sequence[State],
    elimination: Elimination,
    free: Sequence[int],
    size: int,
) -> list[Ball] | None:
    """Return a share of the load with which everything pushes and sticks, None without one.

    What is allowed is a polyhedron without a line in it: if it is not empty it has a corner, where as many conditions
    as there are free shares hold with equality.
    """
    conditions: list[dict[int, Ball]] = []
    j = 0
    for i, state in zip(group, states, strict=True):
        if state is State.OPEN:
            continue
        conditions.append({j: ZERO + 1})
        if state is State.STICK:
            mu = unilateral[i].static
            conditions.extend(({j: mu, j + 1: ZERO - 1}, {j: mu, j + 1: ZERO + 1}))
            j += 1
        j += 1
    if len(free) > _MOST_FREE:
        raise BudgetExceeded(
            "undetermined forces at once",
            len(free),
            _MOST_FREE,
            path=("connections",),
            remedy="let fewer places stick at once",
        )
    for equal in combinations(conditions, len(free)):
        corner = Elimination()
        for k, (rest, x) in elimination.pivots.items():
            corner.add({k: ZERO + 1, **rest}, x)
        if any(corner.add(condition, ZERO) is not None for condition in equal):
            continue
        shares = corner.solution(range(size))
        if all(_at_least_zero(rate_along(condition, shares)) for condition in conditions):
            return shares
    return None


def _at_least_zero(x: Ball) -> bool:
    return is_zero(x) or bool(x > 0)


def _lasts(
    base: Table,
    unilateral: Sequence[Unilateral],
    group: Sequence[int],
    settled: Sequence[State],
    candidate: _Candidate,
    open_to: dict[int, tuple[State, ...]],
    q: Sequence[Ball],
    v: Sequence[Ball],
    found: Responses,
    normal: dict[int, int],
    slips: dict[int, int],
) -> bool:
    """Return whether every condition of a candidate holds just after the start."""
    undecided = False
    along = [
        x + sum((found.matrix[a][b] * force for b, force in enumerate(candidate.forces)), ZERO)
        for a, x in enumerate(found.free)
    ]
    for i, state in zip(group, candidate.states, strict=True):
        values = []
        push = candidate.forces[normal[i]]
        if state is State.OPEN:
            values.append(along[normal[i]])
        else:
            values.append(push)
        if state is State.STICK:
            rub = candidate.forces[slips[i]]
            values.extend((unilateral[i].static * push - rub, unilateral[i].static * push + rub))
        if state.sense and State.STICK in open_to[i]:
            values.append(state.sense * along[slips[i]])
        for x in values:
            if is_zero(x):
                undecided = True
            elif x < 0:
                return False
    if not undecided or candidate.undetermined:
        return True
    full = list(settled)
    for i, state in zip(group, candidate.states, strict=True):
        full[i] = state
    return all(leading_sign(series) >= 0 for series in _conditions(base, unilateral, group, full, open_to, q, v))


def _conditions(
    base: Table,
    unilateral: Sequence[Unilateral],
    group: Sequence[int],
    states: Sequence[State],
    open_to: dict[int, tuple[State, ...]],
    q: Sequence[Ball],
    v: Sequence[Ball],
) -> Iterator[list[Ball]]:
    """Yield the Taylor series of everything that has to stay at or above zero."""
    phase = phase_table(base, unilateral, states, q, v)
    motion = expansion(phase.table, LOOKED)
    for i in group:
        one, row, slip = unilateral[i], phase.normal[i], phase.slip[i]
        if row is None:
            # Gap and rate are zero: the contact touches.
            yield motion.of(one.gap)[2:]
            continue
        push = motion.multipliers[row]
        yield push
        if slip is not None:
            rub = motion.multipliers[slip]
            yield [one.static * a - b for a, b in zip(push, rub, strict=True)]
            yield [one.static * a + b for a, b in zip(push, rub, strict=True)]
        if states[i].sense and State.STICK in open_to[i]:
            yield [states[i].sense * x for x in motion.of_rates(one.slip or {})[1:]]
