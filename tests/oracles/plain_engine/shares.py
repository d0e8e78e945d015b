"""Shares of a load that is not determined: a linear programme over pushes and cones of friction."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from scipy.optimize import linprog

from tests.oracles.plain_engine.coordinates import Floats

_CUTS = 40
"""Rounds in which a round cone is cut by the tangent planes where a solution leaves it: each squares the excess."""


@dataclass(frozen=True)
class Cone:
    """Rows of the push and of the friction of one contact; the second is None where it does not stick."""

    number: int
    push: int
    rub: slice | None
    coefficient: float


def best_share(forces: Floats, free: Floats, cones: Sequence[Cone]) -> float:
    """Return the largest t <= 1 for which some forces + z free leave push >= t and mu push - |friction| >= t."""
    size = max(float(np.abs(free).max()), 1e-300)
    free = free / size
    count = len(free)
    rows: list[Floats] = []
    right: list[float] = []

    def require(direction: Floats) -> None:
        """Require direction . (forces + z free) >= t."""
        rows.append(np.concatenate([-(free @ direction), [1.0]]))
        right.append(float(direction @ forces))

    def within(cone: Cone, unit: Floats) -> Floats:
        line = np.zeros(len(forces))
        line[cone.push] = cone.coefficient
        line[cone.rub] = -unit
        return line

    for cone in cones:
        push = np.zeros(len(forces))
        push[cone.push] = 1.0
        require(push)
        if cone.rub is not None:
            width = cone.rub.stop - cone.rub.start
            for unit in np.concatenate([np.eye(width), -np.eye(width)]):
                require(within(cone, unit))
    best = -np.inf
    for _ in range(_CUTS):
        found = linprog(
            np.concatenate([np.zeros(count), [-1.0]]),
            np.array(rows),
            np.array(right),
            bounds=[(-1e6, 1e6)] * count + [(None, 1.0)],
            method="highs",
            options={"primal_feasibility_tolerance": 1e-10, "dual_feasibility_tolerance": 1e-10},
        )
        if found.x is None:
            return -np.inf
        best = float(found.x[-1])
        whole = forces + found.x[:-1] @ free
        exceeded = False
        for cone in cones:
            if cone.rub is None or cone.rub.stop - cone.rub.start == 1:
                continue
            rub = whole[cone.rub]
            length = float(np.linalg.norm(rub))
            if length > 0.0 and cone.coefficient * whole[cone.push] - length < best - 1e-11:
                require(within(cone, rub / length))
                exceeded = True
        if not exceeded:
            break
    return best
