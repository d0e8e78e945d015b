"""Forces that go with states of contacts: of what is closed, what sticks and what slides.

The lines that the states hold have no acceleration; that determines the forces where Delassus' operator has full rank.
Where it has not, forces that move nothing are free: then any share of the load will do with which everything pushes and
sticks, unless friction depends on the share.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from itertools import combinations

from flint import arb_mat

from core.errors import BudgetExceeded
from core.multibody.algebra.polynomials import ONE, ZERO, Ball, entry, is_zero
from core.multibody.algebra.rank import Elimination
from core.multibody.contacts.contact_responses import NO_DIRECTIONS, Forces, Responses, rate_along
from core.multibody.contacts.contact_states import Problem, State
from core.multibody.contacts.shares_in_space import shared_in_space
from core.multibody.table.connection_effects import Unilateral

_MOST_FREE = 3
"""Forces left free at once among whose shares one is looked for."""


@dataclass(frozen=True)
class Balance:
    """States of a group of contacts, with forces that go with them.

    Attributes
    ----------
    states : tuple of State
    forces : list of ball
        Along every line.
    acceleration : list of ball
        Of every coordinate.
    undetermined : bool
        Whether other forces would do as well.
    directions : dict of int to (ball, ball)
        Cosine and sine of the direction in which a measure begins to slide in space.
    """

    states: tuple[State, ...]
    forces: list[Ball]
    acceleration: list[Ball]
    undetermined: bool
    directions: dict[int, tuple[Ball, Ball]]


def balanced(
    unilateral: Sequence[Unilateral],
    group: Sequence[int],
    states: Sequence[State],
    found: Responses,
    directions: Mapping[int, tuple[Ball, Ball]] = NO_DIRECTIONS,
) -> Balance | Problem | None:
    """Return the forces that go with states, None where there are none.

    Where they are determined their signs are still to be checked.

    Raises
    ------
    BudgetExceeded
        For more undetermined forces than can be looked through.
    """
    unknowns, held = found.unknowns(unilateral, group, states, directions)
    size = len(unknowns)

    def balance(solved: Sequence[Ball], *, undetermined: bool = False) -> Balance:
        forces = _spread(solved, unknowns, found)
        return Balance(tuple(states), forces, found.accelerations(forces), undetermined, dict(directions))

    if not size:
        return balance([])
    matrix = found.among(unknowns, held)
    right = [-found.free[a] for a in held]
    try:
        return balance(arb_mat(matrix).solve(arb_mat([[x] for x in right])).entries())
    except ZeroDivisionError:
        pass
    elimination = Elimination()
    for line, x in zip(matrix, right, strict=True):
        left = elimination.add({j: y for j, y in enumerate(line) if not is_zero(y)}, x)
        if left is not None and not is_zero(left):
            return None
    free = [j for j in range(size) if j not in elimination.pivots]
    if not free:
        return balance(elimination.solution(range(size)))
    for f in free:
        alone = [ZERO] * size
        alone[f] = ONE
        for j, (rest, _) in elimination.pivots.items():
            alone[j] = -entry(rest, f)
        pushed = found.accelerations(_spread(alone, unknowns, found), from_rest=True)
        if all(is_zero(x) for x in pushed):
            continue
        if not any(state.sense for state in states):
            return None
        return Problem(
            "undetermined-friction",
            "how the load is shared between the contacts is not determined, and their friction depends on it",
            tuple(unilateral[i].name for i, state in zip(group, states, strict=True) if state is not State.OPEN),
            decided_by="compliances of the contacts, or one coefficient of friction for all of them",
        )
    if any(state is State.STICK and unilateral[i].across is not None for i, state in zip(group, states, strict=True)):
        shares = shared_in_space(unilateral, group, states, elimination, free, size)
    else:
        shares = _feasible(_conditions(unilateral, group, states), elimination, free, size)
    return None if shares is None else balance(shares, undetermined=True)


def _spread(solved: Sequence[Ball], unknowns: Sequence[Forces], found: Responses) -> list[Ball]:
    """Return the forces along every line."""
    forces = [ZERO] * len(found.free)
    for x, push in zip(solved, unknowns, strict=True):
        for b, factor in push.items():
            forces[b] = forces[b] + x * factor
    return forces


def _conditions(unilateral: Sequence[Unilateral], group: Sequence[int], states: Sequence[State]) -> list[Forces]:
    """Return what has to be at least zero, as sums of the unknowns: N, and mu N - F and mu N + F of what sticks."""
    conditions: list[Forces] = []
    j = 0
    for i, state in zip(group, states, strict=True):
        if state is State.OPEN:
            continue
        conditions.append({j: ONE})
        if state is State.STICK:
            mu = unilateral[i].static
            conditions.extend(({j: mu, j + 1: -ONE}, {j: mu, j + 1: ONE}))
            j += 1
        j += 1
    return conditions


def _feasible(
    conditions: Sequence[Forces], elimination: Elimination, free: Sequence[int], size: int
) -> list[Ball] | None:
    """Return a share of the load with which everything pushes and sticks, None without one.

    What is allowed is a polyhedron without a line in it: if it is not empty it has a corner, where as many conditions
    as there are free shares hold with equality.
    """
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
            corner.add({k: ONE, **rest}, x)
        if any(corner.add(condition, ZERO) is not None for condition in equal):
            continue
        shares = corner.solution(range(size))
        values = [rate_along(condition, shares) for condition in conditions]
        if all(is_zero(x) or bool(x > 0) for x in values):
            return shares
    return None
