"""How touching contacts answer forces along one another.

With the lines W_c of gaps and slips, the acceleration along them is a = a_0 + A f, where f are the forces along the
same lines and A = W_c S W_c^T, S the upper left block of the inverse of the saddle matrix: Delassus' operator. An
impulse changes the rates along the lines by the same A.

References
----------
F. Pfeiffer, C. Glocker, "Multibody Dynamics with Unilateral Contacts" (1996), chapter 6.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from types import MappingProxyType

from core.errors import BudgetExceeded
from core.multibody.algebra.polynomials import ONE, ZERO, Ball, evaluated, is_zero
from core.multibody.algebra.rank import independent
from core.multibody.contacts.contact_states import State
from core.multibody.equations.dynamics import weightless
from core.multibody.equations.expansion import saddle_solved
from core.multibody.table.connection_effects import Unilateral
from core.multibody.table.table import Row, Table

MOST_UNDECIDED = 8
"""Contacts that push one another and are undecided at once."""

NO_DIRECTIONS: Mapping[int, tuple[Ball, Ball]] = MappingProxyType({})

Forces = dict[int, Ball]
"""Forces, or impulses, by the line along which they act."""


def rate_along(line: Mapping[int, Ball], v: Sequence[Ball]) -> Ball:
    """Return a line of W times rates."""
    return sum((x * v[j] for j, x in line.items()), ZERO)


def gap_rate(one: Unilateral, q: Sequence[Ball], v: Sequence[Ball]) -> Ball:
    """Return the rate of a gap."""
    return sum((evaluated(poly, q) * v[j] for j, poly in one.normal.items()), ZERO)


def slip_rate(one: Unilateral, q: Sequence[Ball], v: Sequence[Ball]) -> Ball:
    """Return the rate of slip, zero without friction; in space that along the first direction."""
    return sum((evaluated(poly, q) * v[j] for j, poly in (one.slip or {}).items()), ZERO)


def across_rate(one: Unilateral, q: Sequence[Ball], v: Sequence[Ball]) -> Ball:
    """Return the rate of slip along the second direction, zero in the plane."""
    return sum((evaluated(poly, q) * v[j] for j, poly in (one.across or {}).items()), ZERO)


@dataclass(frozen=True)
class Responses:
    """What the accelerations along contacts are: those without contact forces, and what forces add.

    Attributes
    ----------
    normal, slips, across : dict of int to int
        Line of the gap of each measure, and of its slip where it has friction; in space there are two.
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

    normal: dict[int, int]
    slips: dict[int, int]
    across: dict[int, int]
    free: list[Ball]
    matrix: list[list[Ball]]
    columns: list[list[Ball]]
    start: list[Ball]
    reactions: list[dict[int, Ball]]

    def clusters(self) -> list[list[int]]:
        """Return the groups of measures that push one another."""
        left = list(self.normal)
        found = []
        while left:
            group = [left.pop(0)]
            for i in group:
                for j in list(left):
                    if any(self.matrix[a][b] != 0 or self.matrix[b][a] != 0 for a in self._of(i) for b in self._of(j)):
                        group.append(j)
                        left.remove(j)
            found.append(sorted(group))
        return found

    def _of(self, i: int) -> list[int]:
        return [self.normal[i], *self.grip(i)]

    def grip(self, i: int) -> list[int]:
        """Return the lines of the slip of a measure: none, one in the plane, two in space."""
        return [lines[i] for lines in (self.slips, self.across) if i in lines]

    def unknowns(
        self,
        unilateral: Sequence[Unilateral],
        group: Sequence[int],
        states: Sequence[State],
        directions: Mapping[int, tuple[Ball, Ball]] = NO_DIRECTIONS,
    ) -> tuple[list[Forces], list[int]]:
        """Return the forces that states leave to be found, and the lines along which the states hold something.

        What slides rubs by its kinetic coefficient against the slip, with every unit of its normal force. In space it
        slides along the first direction of its slip, if no other is given by cosine and sine.
        """
        unknowns: list[Forces] = []
        held: list[int] = []
        for i, state in zip(group, states, strict=True):
            if state is State.OPEN:
                continue
            push = {self.normal[i]: ONE}
            if state.sense:
                rub = -state.sense * unilateral[i].kinetic
                c, s = directions.get(i, (ONE, ZERO))
                push[self.slips[i]] = rub * c
                if s != 0:
                    push[self.across[i]] = rub * s
            unknowns.append(push)
            held.append(self.normal[i])
            if state is State.STICK:
                for line in self.grip(i):
                    unknowns.append({line: ONE})
                    held.append(line)
        return unknowns, held

    def among(self, unknowns: Sequence[Forces], held: Sequence[int]) -> list[list[Ball]]:
        """Return the matrix from unknown forces to accelerations along the lines that are held."""
        return [[sum((self.matrix[a][b] * x for b, x in push.items()), ZERO) for push in unknowns] for a in held]

    def along(self, forces: Sequence[Ball], line: int) -> Ball:
        """Return the acceleration along a line by forces along every line."""
        return self.free[line] + sum((self.matrix[line][b] * force for b, force in enumerate(forces)), ZERO)

    def accelerations(self, forces: Sequence[Ball], *, from_rest: bool = False) -> list[Ball]:
        """Return the accelerations of all coordinates by forces along every line, with all other forces or alone."""
        total = [ZERO] * len(self.start) if from_rest else list(self.start)
        for b, force in enumerate(forces):
            if force != 0:
                total = [x + force * y for x, y in zip(total, self.columns[b], strict=True)]
        return total


def responses(table: Table, unilateral: Sequence[Unilateral], chosen: Sequence[int]) -> Responses:
    """Return how a table answers to forces along the gaps and slips of some measures.

    Raises
    ------
    InvalidParameter
        If something without mass can move by itself.
    """
    rows: list[Row] = []
    normal: dict[int, int] = {}
    slips: dict[int, int] = {}
    across: dict[int, int] = {}
    for i in chosen:
        one = unilateral[i]
        normal[i] = len(rows)
        rows.append(Row(one.name, one.gap, one.normal))
        for numbers, slip in zip((slips, across), one.slips, strict=False):
            numbers[i] = len(rows)
            rows.append(Row(one.name, None, slip))
    count = len(table.names)
    lines = [row.line(table.q) for row in table.rows]
    own = independent(lines)
    size = count + len(own)
    extra = [row.line(table.q) for row in rows]
    right = [[ZERO] * (1 + len(rows)) for _ in range(size)]
    for i, x in enumerate(table.forces()):
        right[i][0] = x
    for k, r in enumerate(own):
        right[count + k][0] = table.convective(table.rows[r])
    for b, line in enumerate(extra):
        for j, x in line.items():
            right[j][1 + b] = x
    try:
        solved = saddle_solved(table, own, right)
    except ZeroDivisionError:
        raise weightless(table, range(count), lines) from None
    start = [solved[i][0] for i in range(count)]
    columns = [[solved[i][1 + b] for i in range(count)] for b in range(len(rows))]
    free = [rate_along(line, start) - table.convective(row) for line, row in zip(extra, rows, strict=True)]
    matrix = [[_nought(rate_along(line, column)) for column in columns] for line in extra]
    reactions = [{r: solved[count + k][1 + b] for k, r in enumerate(own)} for b in range(len(rows))]
    return Responses(normal, slips, across, free, matrix, columns, start, reactions)


def _nought(x: Ball) -> Ball:
    return ZERO if is_zero(x) else x


def require_few(unilateral: Sequence[Unilateral], group: Sequence[int], what: str) -> None:
    """Raise `BudgetExceeded` if more than `MOST_UNDECIDED` contacts push one another: their states are enumerated."""
    if len(group) > MOST_UNDECIDED:
        names = ", ".join(unilateral[i].name for i in group)
        raise BudgetExceeded(
            f"{what} ({names})",
            len(group),
            MOST_UNDECIDED,
            path=("connections",),
            remedy="hold some of them by connections of another kind",
        )
