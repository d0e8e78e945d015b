"""Shares of a load that is not determined: a linear programme over pushes and cones of friction."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from scipy.optimize import linprog

from tests.oracles.plain_engine.coordinates import Floats

_CUTS = 40
"""Rounds in which a round cone is cut by the tangent planes where a solution leaves it: each squares the excess."""
_BOUND = 1e6
"""Largest part that a free combination of forces may have, relative to the forces of the scene."""
_EXACT = {"primal_feasibility_tolerance": 1e-10, "dual_feasibility_tolerance": 1e-10}


@dataclass(frozen=True)
class Cone:
    """Where the push and the friction of one contact are; no friction where it does not stick."""

    push: int
    rub: list[int]
    coefficient: float


def best_share(forces: Floats, free: Floats, cones: Sequence[Cone]) -> float:
    """Return the largest t <= 1 for which some forces + z free leave push >= t and mu push - |friction| >= t."""
    free = free / max(float(np.abs(free).max()), 1e-300)
    width = max(len(cone.rub) for cone in cones)
    # Conditions are directions in the space of forces: those of pushes, and of planes that touch the cones.
    planes = [_plane(cone, np.zeros(len(cone.rub)), 1.0, len(forces)) for cone in cones]
    for cone in cones:
        units = np.concatenate([np.eye(len(cone.rub)), -np.eye(len(cone.rub))])
        planes += [_plane(cone, unit, cone.coefficient, len(forces)) for unit in units]
    best = -np.inf
    for _ in range(_CUTS if width > 1 else 1):
        directions = np.array(planes)
        found = linprog(
            np.append(np.zeros(len(free)), -1.0),
            np.column_stack([-directions @ free.T, np.ones(len(planes))]),
            directions @ forces,
            bounds=[(-_BOUND, _BOUND)] * len(free) + [(None, 1.0)],
            options=_EXACT,
        )
        if found.x is None:
            return -np.inf
        best, whole = float(found.x[-1]), forces + found.x[:-1] @ free
        lengths = [float(np.linalg.norm(whole[cone.rub])) for cone in cones]
        exceeded = [
            _plane(cone, whole[cone.rub] / length, cone.coefficient, len(forces))
            for cone, length in zip(cones, lengths, strict=True)
            if len(cone.rub) > 1 and length > 0.0 and cone.coefficient * whole[cone.push] - length < best - 1e-11
        ]
        if not exceeded:
            break
        planes += exceeded
    return best


def _plane(cone: Cone, unit: Floats, coefficient: float, count: int) -> Floats:
    line = np.zeros(count)
    line[cone.push], line[cone.rub] = coefficient, -unit
    return line
