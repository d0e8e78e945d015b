"""How a load may be shared among places that stick in space, where their forces are not determined.

Friction cones are round: mu N >= |F|. A share is looked for by linear programming with a polygon inside each cone, as
far inside as it goes, and then verified in balls with the round ones.
"""

from __future__ import annotations

from collections.abc import Sequence
from math import cos, pi, sin

import numpy as np
from flint import arb
from scipy.optimize import linprog

from core.multibody.algebra.polynomials import ZERO, Ball
from core.multibody.algebra.rank import Elimination
from core.multibody.contacts.contact_states import State
from core.multibody.table.connection_effects import Unilateral

_SIDES = 32
"""Of the polygon inside a circle: what sticks by less than 0.5 % of the load may not be seen to."""


def shared_in_space(
    unilateral: Sequence[Unilateral],
    group: Sequence[int],
    states: Sequence[State],
    elimination: Elimination,
    free: Sequence[int],
    size: int,
) -> list[Ball] | None:
    """Return a share of the load with which everything pushes and sticks, None where none is found.

    Parameters
    ----------
    elimination : Elimination
        Of the balance, whose unknowns are a push, and two components of friction of what sticks, in turn.
    free : sequence of int
        Unknowns that it leaves open.
    size : int
        Number of unknowns.
    """
    solved, slopes = np.zeros(size), np.zeros((size, len(free)))
    for k, f in enumerate(free):
        slopes[f, k] = 1.0
    for j, (rest, x) in elimination.pivots.items():
        solved[j] = float(x)
        for k, f in enumerate(free):
            slopes[j, k] = -float(rest[f]) if f in rest else 0.0
    lines = _cones(unilateral, group, states, size)
    scale = float(np.max(np.abs(solved), initial=0.0)) or 1.0
    # Every condition lines (solved + slopes x) >= t, with t as large as it can be.
    bound = np.hstack([-lines @ slopes, np.ones((len(lines), 1))])
    cost = np.zeros(len(free) + 1)
    cost[-1] = -1.0
    limits = [(None, None)] * len(free) + [(None, scale)]
    found = linprog(cost, A_ub=bound, b_ub=lines @ solved, bounds=limits)
    if not found.success or found.x is None:
        return None
    values = {f: arb(float(x)) for f, x in zip(free, found.x, strict=False)}
    shares = [values.get(j, ZERO) for j in range(size)]
    for j, (rest, x) in elimination.pivots.items():
        shares[j] = x - sum((y * values[k] for k, y in rest.items()), ZERO)
    return shares if _holds(unilateral, group, states, shares) else None


def _cones(
    unilateral: Sequence[Unilateral], group: Sequence[int], states: Sequence[State], size: int
) -> np.ndarray[tuple[int, int], np.dtype[np.float64]]:
    """Return what has to be at least zero, as lines of the unknowns."""
    lines, j = [], 0
    for i, state in zip(group, states, strict=True):
        if state is State.OPEN:
            continue
        push = np.zeros(size)
        push[j] = 1.0
        lines.append(push)
        if state is State.STICK:
            for k in range(_SIDES):
                side = np.zeros(size)
                side[j] = float(unilateral[i].static) * cos(pi / _SIDES)
                side[j + 1], side[j + 2] = cos(2 * pi * k / _SIDES), sin(2 * pi * k / _SIDES)
                lines.append(side)
            j += 2
        j += 1
    return np.array(lines)


def _holds(
    unilateral: Sequence[Unilateral], group: Sequence[int], states: Sequence[State], shares: Sequence[Ball]
) -> bool:
    """Return whether a share is one indeed."""
    j = 0
    for i, state in zip(group, states, strict=True):
        if state is State.OPEN:
            continue
        push = shares[j]
        if not (push > 0 or 0 in push):
            return False
        if state is State.STICK:
            rest = (unilateral[i].static * push) ** 2 - shares[j + 1] ** 2 - shares[j + 2] ** 2
            if not (rest > 0 or 0 in rest):
                return False
            j += 2
        j += 1
    return True
