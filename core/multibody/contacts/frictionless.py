"""Contacts without friction, any number of them: which push and which open, and with what forces or impulses.

Forces f >= 0 along the gaps, accelerations a = A f + b >= 0 of the gaps, and f.a = 0: a linear complementarity problem
with Delassus' operator A, which is positive semidefinite. Its accelerations are unique (they are those of Gauss's
principle of least constraint), and so is what opens. An interior-point method in doubles finds which contacts push in
some solution, which open, and which do neither; that is then confirmed in balls. Motions without friction are unique
(Ballard), so that of contacts that do neither the first states that last are those of the motion.

References
----------
P. Ballard, "The dynamics of discrete mechanical systems with perfect unilateral constraints", Archive for Rational
Mechanics and Analysis 154 (2000). R. W. Cottle, J.-S. Pang, R. E. Stone, "The Linear Complementarity Problem" (1992),
chapters 3 and 5. S. Mehrotra, "On the implementation of a primal-dual interior point method", SIAM Journal on
Optimization 2 (1992).
"""

from __future__ import annotations

from collections.abc import Sequence
from itertools import product

import numpy as np
from flint import arb

from core.arrays import Floats
from core.errors import BudgetExceeded
from core.multibody.algebra.polynomials import ZERO, Ball, is_zero
from core.multibody.algebra.rank import Elimination
from core.multibody.contacts.conditions_of_states import Situation, lasts
from core.multibody.contacts.contact_forces import Balance, balanced
from core.multibody.contacts.contact_responses import Forces, Responses
from core.multibody.contacts.contact_states import Problem, State
from core.multibody.table.connection_effects import Unilateral

_STEPS = 60
"""Steps of the interior-point method, three times as many as it takes: 21 at most over 3,000 problems of 24."""
_ENDED = 1e-14
"""Mean product of force and acceleration, both of the size one, at which it ends: above the rounding of products."""
_NOTHING = 1e-5
"""Share of the largest force, or acceleration, below which one is nothing: those that are both zero are some 1e-7."""
_YIELD = 1e-12
"""How far a contact gives way to a force of the size one. Contacts that press against one another with nothing else to
hold, such as the sides of a shaft, then push with some force instead of any force, and no step is singular: the
yielding stands far above rounding, and what it adds to accelerations far below what is nothing."""
_REACH = 0.99
"""Share of the way to the border of positive forces and accelerations that a step takes at most."""
_MOST_TRIED = 256
"""Combinations of states that are tried of contacts that neither push nor open."""


def complementary(matrix: Floats, start: Floats) -> tuple[Floats, Floats]:
    """Return forces and accelerations of a linear complementarity problem, those with the most of them above zero.

    Parameters
    ----------
    matrix : ndarray, shape (n, n)
        Positive semidefinite.
    start : ndarray, shape (n,)
        Accelerations without forces.

    Returns
    -------
    forces, accelerations : ndarray, shape (n,)
        Each in units of its largest; zero where it is nothing beside that.
    """
    sizes = np.sqrt(np.clip(matrix.diagonal(), 0.0, None))
    sizes[sizes == 0.0] = 1.0
    scaled, free = matrix / np.outer(sizes, sizes) + _YIELD * np.eye(len(start)), start / sizes
    free = free / (np.abs(free).max() or 1.0)
    forces, gains = np.ones(len(free)), np.ones(len(free))
    for _ in range(_STEPS):
        rest = scaled @ forces + free - gains
        mean = float(forces @ gains) / len(free)
        if mean < _ENDED and np.abs(rest).max() < _ENDED**0.5:
            break
        slopes, missed = np.diag(gains) + forces[:, None] * scaled, forces * (gains + rest)
        # Mehrotra's predictor and corrector: how far a step to the border comes says how far to aim within it.
        step = np.linalg.solve(slopes, -missed)
        change = scaled @ step + rest
        reach = _reach(forces, gains, step, change)
        ahead = float((forces + reach * step) @ (gains + reach * change)) / len(free)
        step = np.linalg.solve(slopes, ahead**3 / mean**2 - step * change - missed)
        change = scaled @ step + rest
        reach = _reach(forces, gains, step, change)
        forces, gains = forces + reach * step, gains + reach * change
    return _without_nothing(forces) / sizes, _without_nothing(gains) * sizes


def _reach(forces: Floats, gains: Floats, step: Floats, change: Floats) -> float:
    """Return the share of a step that keeps forces and accelerations above zero, one at most."""
    return _REACH / max(_REACH, float((-step / forces).max()), float((-change / gains).max()))


def _without_nothing(values: Floats) -> Floats:
    """Return values over the largest, zero where they are nothing beside one or are nothing at all."""
    found: Floats = np.where(values < _NOTHING, 0.0, values)
    return found


def decided_without_friction(at: Situation, group: Sequence[int], settled: Sequence[State]) -> Balance:
    """Return the states of contacts without friction that push one another.

    Raises
    ------
    BudgetExceeded
        Where too many of them neither push nor open, so that their states follow from the motion alone.
    """
    found = at.found
    lines = [found.normal[i] for i in group]
    matrix = np.array([[float(found.matrix[a][b].mid()) for b in lines] for a in lines])
    forces, gains = complementary(matrix, np.array([float(found.free[a].mid()) for a in lines]))
    choices = [
        (State.OPEN,) if gain > 0.0 else (State.CLOSED,) if force > 0.0 else (State.CLOSED, State.OPEN)
        for force, gain in zip(forces, gains, strict=True)
    ]
    idle = forces + gains == 0.0
    if all(is_zero(x) for x in at.v):
        still = balanced(at.unilateral, group, [choice[-1] for choice in choices], found)
        at_rest = still is not None and all(is_zero(x) for x in still.acceleration)
        # Nothing moves, and nothing else is a motion from rest.
        if still is not None and at_rest and _pushes(found, still, lines, forces):
            return still
    for number, states in enumerate(product(*choices)):
        if number == _MOST_TRIED:
            break
        balance = balanced(at.unilateral, group, states, found)
        if balance is None or balance.moves:
            continue
        if not idle.any() and _pushes(found, balance, lines, forces):
            return balance
        if lasts(at, group, settled, balance):
            return balance
    raise BudgetExceeded(
        "undecided contacts at once (" + ", ".join(at.unilateral[i].name for i in group) + ")",
        len(group),
        _MOST_TRIED,
        path=("connections",),
        remedy="hold some of them by connections of another kind",
    )


def _pushes(found: Responses, balance: Balance, lines: Sequence[int], wanted: Floats) -> bool:
    """Return whether all that is closed pushes, with a share of the load near what is wanted; nothing approaches."""
    forces = list(balance.forces)
    if balance.shares:
        columns = np.array([[float(share[a].mid()) for share in balance.shares] for a in lines])
        own = np.array([float(forces[a].mid()) for a in lines])
        scale = np.abs(own).max() / (np.abs(wanted).max() or 1.0)
        for _ in range(2):
            best = np.linalg.lstsq(columns, scale * wanted - own, rcond=None)[0]
            reached = own + columns @ best
            scale = float(reached @ wanted) / float(wanted @ wanted)
        for x, share in zip(best.tolist(), balance.shares, strict=True):
            forces = [y + arb(x) * z for y, z in zip(forces, share, strict=True)]
    for a, state in zip(lines, balance.states, strict=True):
        value = found.along(balance.forces, a) if state is State.OPEN else forces[a]
        if not (value > 0 or (state is State.OPEN and is_zero(value))):
            return False
    return True


def impulses_without_friction(
    unilateral: Sequence[Unilateral], group: Sequence[int], rates: dict[int, Ball], found: Responses
) -> Forces | Problem:
    """Return impulses of contacts without friction that act together, by Newton's law of restitution."""
    lines = [found.normal[i] for i in group]
    start = [
        rates[a] * (1 + unilateral[i].restitution) if rates[a] < 0 else rates[a]
        for i, a in zip(group, lines, strict=True)
    ]
    matrix = np.array([[float(found.matrix[a][b].mid()) for b in lines] for a in lines])
    pushes, _ = complementary(matrix, np.array([float(x.mid()) for x in start]))
    elimination = Elimination()
    taking = [k for k, push in enumerate(pushes) if push > 0.0]
    for k in taking:
        line = {j: found.matrix[lines[k]][lines[j]] for j in taking if not is_zero(found.matrix[lines[k]][lines[j]])}
        left = elimination.add(line, -start[k])
        if left is not None and not is_zero(left):
            return _no_impact(unilateral, group)
    solved: dict[int, Ball] = dict(zip(taking, elimination.solution(taking), strict=True))
    free = [j for j in taking if j not in elimination.pivots]
    if free:
        solved = _near(elimination, taking, free, pushes)
    impulses: Forces = {lines[k]: ZERO if is_zero(x) else x for k, x in solved.items()}
    for k, a in enumerate(lines):
        push: Ball = impulses.get(a, ZERO)
        after: Ball = start[k] + sum((found.matrix[a][b] * p for b, p in impulses.items()), ZERO)
        closed = is_zero(after) and bool(push > 0)
        opens = is_zero(push) and (is_zero(after) or bool(after > 0))
        if not (closed or opens):
            return _no_impact(unilateral, group)
    return impulses


def _near(elimination: Elimination, taking: Sequence[int], free: Sequence[int], wanted: Floats) -> dict[int, Ball]:
    """Return a solution with what is free in proportion to what is wanted, as large as what is determined allows."""
    fixed = {j: float(elimination.pivots[j][1].mid()) for j in taking if j in elimination.pivots}
    # x_j + rest_j . free = value_j: of the scale of the wanted solution the one that fits best.
    rows = [
        (wanted[j] + sum(float(x.mid()) * wanted[k] for k, x in elimination.pivots[j][0].items()), value)
        for j, value in fixed.items()
    ]
    scale = sum(a * b for a, b in rows) / sum(a * a for a, _ in rows)
    chosen = {j: arb(float(scale * wanted[j])) for j in free}
    solved = dict(chosen)
    for j in fixed:
        rest, value = elimination.pivots[j]
        solved[j] = value - sum((x * chosen[k] for k, x in rest.items()), ZERO)
    return solved


def _no_impact(unilateral: Sequence[Unilateral], group: Sequence[int]) -> Problem:
    return Problem(
        "no-impact",
        "no impulses of these restitutions go with this impact",
        tuple(unilateral[i].name for i in group),
        decided_by="one coefficient of restitution for all, or another law of impact",
    )


def is_smooth(unilateral: Sequence[Unilateral], group: Sequence[int]) -> bool:
    """Return whether no contact of a group has friction."""
    return all(unilateral[i].slip is None for i in group)
