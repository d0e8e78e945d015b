"""Forces that go with states of contacts: of what is closed, what sticks and what slides.

The lines that the states hold have no acceleration; that determines the forces where Delassus' operator has full rank.
Where it has not, forces that move nothing of what is held are free: shares of the load.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np
from flint import arb_mat

from core.multibody.algebra.polynomials import ONE, ZERO, Ball, entry, is_zero
from core.multibody.algebra.rank import Elimination
from core.multibody.contacts.contact_responses import NO_DIRECTIONS, Forces, Responses
from core.multibody.contacts.contact_states import State
from core.multibody.contacts.shares_in_space import MARGINAL, Cone, best_share
from core.multibody.table.connection_effects import Unilateral


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
    directions : dict of int to (ball, ball)
        Cosine and sine of the direction in which a measure begins to slide in space.
    shares : list of list of ball
        Forces along every line that may be added, in any multiple, with all that is held as it is.
    moved : list of list of ball
        Accelerations of every coordinate by each of them: zero where the motion does not depend on the share.
    best : list of ball
        Forces with the share for which what sticks in space does so best; empty where none is looked for.
    marginal : bool
        Whether what sticks in space does so by nothing, as far as that is known.
    """

    states: tuple[State, ...]
    forces: list[Ball]
    acceleration: list[Ball]
    directions: dict[int, tuple[Ball, Ball]]
    shares: Sequence[Sequence[Ball]] = ()
    moved: Sequence[Sequence[Ball]] = ()
    best: Sequence[Ball] = ()
    marginal: bool = False

    @property
    def moves(self) -> bool:
        """Whether the acceleration depends on how the load is shared."""
        return any(not is_zero(x) for gain in self.moved for x in gain)

    def with_shares_where(self, conditions: Sequence[Forces], equal: Sequence[Ball]) -> Balance | None:
        """Return the balance in which some sums of the forces have values, None where it depends on the share still."""
        elimination = Elimination()
        for condition, value in zip(conditions, equal, strict=True):
            now = sum((x * self.forces[b] for b, x in condition.items()), ZERO)
            line = {
                f: total
                for f, share in enumerate(self.shares)
                if not is_zero(total := sum((x * share[b] for b, x in condition.items()), ZERO))
            }
            elimination.add(line, value - now)
        acceleration = list(self.acceleration)
        for j in range(len(acceleration)):
            free, value = elimination.reduced(
                {f: gain[j] for f, gain in enumerate(self.moved) if not is_zero(gain[j])}, ZERO
            )
            if free:
                return None
            acceleration[j] = acceleration[j] - value
        return replace(self, acceleration=acceleration)


def balanced(
    unilateral: Sequence[Unilateral],
    group: Sequence[int],
    states: Sequence[State],
    found: Responses,
    directions: Mapping[int, tuple[Ball, Ball]] = NO_DIRECTIONS,
    *,
    shared: bool = True,
) -> Balance | None:
    """Return the forces that go with states, None where there are none; their signs are still to be checked.

    Of places that stick in space and share a load, the best share is looked for if they are `shared`.
    """
    unknowns, held = found.unknowns(unilateral, group, states, directions)
    size = len(unknowns)

    def balance(solved: Sequence[Ball]) -> Balance:
        forces = _spread(solved, unknowns, found)
        return Balance(tuple(states), forces, found.accelerations(forces), dict(directions))

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
    alone = []
    for f in free:
        unit = [ZERO] * size
        unit[f] = ONE
        for j, (rest, _) in elimination.pivots.items():
            unit[j] = -entry(rest, f)
        alone.append(unit)
    solved = elimination.solution(range(size))
    shares = [_spread(unit, unknowns, found) for unit in alone]
    moved = [found.accelerations(share, from_rest=True) for share in shares]
    if not (shared and sticks_in_space(unilateral, group, states)):
        return replace(balance(solved), shares=shares, moved=moved)
    best = best_share(
        _cones(unilateral, group, states),
        np.array([float(x) for x in solved]),
        np.array([[float(unit[j]) for unit in alone] for j in range(size)]),
    )
    if best.margin < -MARGINAL:
        return None
    now = balance(solved)
    best_forces = list(now.forces)
    for x, share in zip(best.free.tolist(), shares, strict=True):
        best_forces = [y + x * z for y, z in zip(best_forces, share, strict=True)]
    return replace(now, shares=shares, moved=moved, best=best_forces, marginal=best.margin <= MARGINAL)


def _cones(unilateral: Sequence[Unilateral], group: Sequence[int], states: Sequence[State]) -> list[Cone]:
    """Return what has to hold of unknown forces: a push, and the components of friction of what sticks, in turn."""
    found: list[Cone] = []
    j = 0
    for i, state in zip(group, states, strict=True):
        if state is State.OPEN:
            continue
        # A string that rubs has one component of friction, in space too.
        rubs = tuple(range(j + 1, j + 1 + len(unilateral[i].slips))) if state is State.STICK else ()
        found.append(Cone(j, float(unilateral[i].static), rubs) if rubs else Cone(j))
        j += 1 + len(rubs)
    return found


def sticks_in_space(unilateral: Sequence[Unilateral], group: Sequence[int], states: Sequence[State]) -> bool:
    """Return whether something sticks in space, where what friction may be is a cone and not linear."""
    return any(
        state is State.STICK and unilateral[i].across is not None for i, state in zip(group, states, strict=True)
    )


def _spread(solved: Sequence[Ball], unknowns: Sequence[Forces], found: Responses) -> list[Ball]:
    """Return the forces along every line."""
    forces = [ZERO] * len(found.free)
    for x, push in zip(solved, unknowns, strict=True):
        for b, factor in push.items():
            forces[b] = forces[b] + x * factor
    return forces
