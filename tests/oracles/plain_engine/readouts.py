"""The forces of connections as the answer names them, by the power of a unit of each in every virtual motion."""

from __future__ import annotations

import numpy as np

from tests.oracles.plain_engine.coordinates import Floats, State
from tests.oracles.plain_engine.phase import Phase

SPANNED = 1e-7
"""Share of its size by which a generalized force may miss what the named forces of its connection can do."""


def forces_of(phase: Phase, state: State) -> dict[str, float]:
    """Return the forces that are determined, by name (N, N m)."""
    mechanism = phase.mechanism
    coordinates = mechanism.coordinates
    placement, motion = coordinates.placement(state), coordinates.motion(state.rates)
    virtual = coordinates.motion(np.eye(coordinates.size))
    solution = phase.solve(state)
    found: dict[str, float] = {}
    owners = _owners(phase, state)
    for one in mechanism.definitions:
        laws = one.laws(placement, motion)
        if laws:
            found.update({name: float(x) for name, x in laws.items()})
            continue
        mine = [k for k, owner in enumerate(owners) if owner is one]
        efforts = dict(one.efforts(placement, virtual))
        if not efforts:
            continue
        if not mine:
            found.update(dict.fromkeys(efforts, 0.0))
            continue
        columns = [np.broadcast_to(x, (coordinates.size,)) for x in efforts.values()]
        beside = [x.reshape(coordinates.size, -1) for x in one.unanswered(placement, virtual) if np.ndim(x)]
        matrix = np.concatenate([np.array(columns).T, *beside], axis=1)
        pulls = solution.columns[:, mine]
        inverse = np.linalg.pinv(matrix, rcond=1e-9)
        share = inverse @ pulls
        values = share @ solution.forces[mine]
        loose = np.abs(share @ solution.free[:, mine].T).max(axis=1, initial=0.0) > 1e-6 * np.abs(share).max(
            initial=0.0
        )
        # A force is not determined either where another of the same connection, or a moment, has the same effect.
        null = np.eye(matrix.shape[1]) - inverse @ matrix
        for k, name in enumerate(efforts):
            if not loose[k] and np.abs(null[k]).max() < 1e-6:
                found[name] = float(values[k])
        missed = pulls @ solution.forces[mine] - matrix @ values
        if np.abs(missed).max(initial=0.0) > SPANNED * max(solution.scale, 1e-300):
            for name in efforts:
                found.pop(name, None)
    return found


def _owners(phase: Phase, state: State) -> list[object]:
    """Return the definition that each row belongs to, in the order of the rows."""
    mechanism = phase.mechanism
    coordinates = mechanism.coordinates
    placement, motion = coordinates.placement(state), coordinates.motion(state.rates)
    owners: list[object] = []
    for one in mechanism.holding:
        for value in one.held(placement).values():
            owners.extend([one] * _width(value))
    owners.extend(entry.definition for entry in phase.normals)
    for one in mechanism.rolling:
        for value in one.held_rates(placement, motion).values():
            owners.extend([one] * _width(value))
    for i in phase.sticking:
        owners.extend([mechanism.one_sided[i].definition] * (1 if mechanism.one_sided[i].slips == 1 else 2))
    return owners


def _width(value: Floats) -> int:
    return 1 if np.ndim(value) == 0 else int(np.shape(value)[-1])
