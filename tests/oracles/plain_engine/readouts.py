"""The forces of connections as the answer names them, by the power of a unit of each in every virtual motion."""

from __future__ import annotations

import numpy as np
from scipy.spatial.transform import Rotation

from tests.oracles.plain_engine.coordinates import Floats, State
from tests.oracles.plain_engine.mechanism import Mechanism
from tests.oracles.plain_engine.phase import Key, Phase

SPANNED = 1e-7
"""Share of its size by which a generalized force may miss what the named forces of its connection can do."""
DETERMINED = 1e-6
"""Share of a force by which it may change with what is open, and is still determined."""


def forces_of(phase: Phase, state: State) -> dict[str, float]:
    """Return the forces that are determined, by name (N, N m)."""
    mechanism, coordinates = phase.mechanism, phase.mechanism.coordinates
    n = coordinates.size
    placement, motion = coordinates.placement(state), coordinates.motion(state.rates)
    virtual = coordinates.motion(np.eye(n))
    solution = phase.solve(state)
    owners = [
        mechanism.definitions[number] if what == "held" else mechanism.one_sided[number].definition
        for what, number in solution.owners
    ]
    found: dict[str, float] = {}
    for one in mechanism.definitions:
        laws = one.laws(one.ahead(placement, motion), motion)
        efforts = {} if laws else one.efforts(placement, virtual)
        found.update({name: float(x.real) for name, x in laws.items()})
        mine = [k for k, owner in enumerate(owners) if owner is one]
        if not mine:
            found.update(dict.fromkeys(efforts, 0.0))
            continue
        beside = [x.reshape(n, -1) for x in one.unanswered(placement, virtual) if np.ndim(x)]
        matrix = np.concatenate([*(np.broadcast_to(x, n)[:, None] for x in efforts.values()), *beside], axis=1)
        inverse = np.linalg.pinv(matrix, rcond=1e-9)
        pulls = solution.columns[:, mine]
        whole = pulls @ solution.forces[mine]
        if one in mechanism.chains:
            whole = whole + mechanism.own_force(one, state, solution.accelerations)
        values = inverse @ whole
        if np.abs(whole - matrix @ values).max(initial=0.0) > SPANNED * solution.scale:
            continue
        share = inverse @ pulls
        loose = np.abs(share @ solution.free[:, mine].T).max(axis=1, initial=0.0)
        # A force is not determined either where another of the same connection, or a moment, has the same effect.
        alike = np.abs(np.eye(matrix.shape[1]) - inverse @ matrix).max(axis=1)
        for k, name in enumerate(efforts):
            if loose[k] <= DETERMINED * np.abs(share).max() and alike[k] < DETERMINED:
                found[name] = float(values[k])
    return found


def of_chains(phase: Phase, state: State) -> dict[Key, float]:
    """Return what chains need: sides with a length (m), and a force on the peg, relative to tensions."""
    coordinates, found = phase.mechanism.coordinates, dict[Key, float]()
    placement, motion = coordinates.placement(state), coordinates.motion(state.rates)
    forces = forces_of(phase, state) if phase.mechanism.chains else {}
    for k, chain in enumerate(phase.mechanism.chains):
        first, last = chain.sides(placement)
        found["end-of-chain", k] = float(min(first, last))
        pressed = chain.derived(placement, motion, forces)[f"{chain.name}.normal"]
        found["lift-off", k] = float(pressed) / (1.0 + sum(abs(forces[name]) for name in chain.forces))
    return found


def columns_of(mechanism: Mechanism, state: State) -> dict[str, Floats]:
    """Return what every body does, by the names of the columns of an answer."""
    coordinates = mechanism.coordinates
    velocity, spin = coordinates.spread(state.rates)
    found: dict[str, Floats] = {}
    for i, name in enumerate(coordinates.names):
        found[f"{name}.position"], found[f"{name}.velocity"] = state.position[i], velocity[i]
        if not coordinates.rigid[i]:
            continue
        if coordinates.dimension == 2:
            found[f"{name}.angle"], found[f"{name}.angular_velocity"] = state.turn[i : i + 1], spin[i : i + 1]
        else:
            found[f"{name}.attitude"] = Rotation.from_matrix(state.turn[i]).as_quat(canonical=True, scalar_first=True)
            found[f"{name}.angular_velocity"] = state.turn[i].T @ spin[i]
            found[f"{name}.angular_velocity_in_space"] = spin[i]
    return found


def quantities_of(mechanism: Mechanism, state: State) -> dict[str, float]:
    """Return the same number by number: components have the ending of their axis."""
    found: dict[str, float] = {}
    for name, value in columns_of(mechanism, state).items():
        if len(value) == 1:
            found[name] = float(value[0])
        elif not name.endswith(".attitude"):
            found |= {f"{name}.{axis}": float(x) for axis, x in zip("xyz", value, strict=False)}
    return found
