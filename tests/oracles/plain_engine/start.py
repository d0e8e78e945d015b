"""The start of a scene: places that meet what holds and touches, and the rates that the description leaves open."""

from __future__ import annotations

import numpy as np

from tests.oracles.plain_engine.coordinates import Floats, State
from tests.oracles.plain_engine.mechanism import Mechanism
from tests.oracles.plain_engine.phase import NO_ROW

TOUCHING = 1e-9
"""Gap (m, rad) below which something touches at the start."""
_ROUNDS = 30


def projected(mechanism: Mechanism, state: State, closed: list[int], *, sticking: list[int] | None = None) -> State:
    """Return the state with its places on what holds and is closed, and its rates so that they stay.

    Parameters
    ----------
    sticking : list of int
        Measures whose slip is held at zero.
    """
    every = mechanism.one_sided
    normals, slips = [every[i] for i in closed], [every[i] for i in sticking or ()]
    coordinates = mechanism.coordinates
    if not (mechanism.holding or mechanism.rolling or normals):
        return state
    for _ in range(_ROUNDS):
        rows = mechanism.rows(state, normals, slips)
        step = _least(rows.lines, -rows.values)
        state = coordinates.advanced(state, step)
        if float(np.abs(step).max(initial=0.0)) < 1e-14 * max(1.0, float(np.abs(state.position).max())):
            break
    rows = mechanism.rows(state, normals, slips)
    return State(state.position, state.turn, state.rates + _least(rows.lines, -rows.rates))


def _least(lines: Floats, right: Floats) -> Floats:
    sizes = np.linalg.norm(lines, axis=1)
    sizes[sizes < NO_ROW * sizes.max(initial=1e-300)] = sizes.max(initial=1.0)
    found: Floats = np.linalg.pinv(lines / sizes[:, None], rcond=1e-9) @ (right / sizes)
    return found


def start(mechanism: Mechanism, faster: float = 1.0) -> tuple[State, list[int]]:
    """Return the state at the start, and the one-sided measures that touch.

    Velocities that are given are conditions; what touches stays as far as they leave that open; of what is left
    open the kinetic energy is least.

    Parameters
    ----------
    faster : float
        Factor of all given velocities.
    """
    coordinates, every = mechanism.coordinates, mechanism.one_sided
    state = projected(mechanism, coordinates.start(), [])
    gaps, _ = mechanism.gap_rates(state)
    touching = [i for i, gap in enumerate(gaps) if abs(gap) < TOUCHING]
    if touching:
        state = projected(mechanism, state, touching)
    state = State(state.position, state.turn, np.zeros(coordinates.size))
    rows = mechanism.rows(state, [every[i] for i in touching])
    total = len(rows.rates)
    rolling = mechanism.rolling_rows
    wished = range(total - rolling - len(touching), total - rolling)
    held = [k for k in range(total) if k not in wished]
    lines, values = [rows.lines[k] for k in held], [-rows.rates[k] for k in held]
    given_lines, given = _given(mechanism, state)
    lines.extend(given_lines)
    values.extend(faster * x for x in given)
    if any(values):
        for k in wished:
            if _independent(lines, rows.lines[k]):
                lines.append(rows.lines[k])
                values.append(-rows.rates[k])
        state = State(
            state.position, state.turn, _least_energy(mechanism.inertia(state), np.array(lines), np.array(values))
        )
    return projected(mechanism, state, []), touching


def _given(mechanism: Mechanism, state: State) -> tuple[list[Floats], list[float]]:
    coordinates = mechanism.coordinates
    b = len(coordinates.bodies)
    d = coordinates.dimension
    lines, values = [], []
    for i, body in enumerate(coordinates.bodies):
        pairs: list[tuple[int, float]] = []
        if body.velocity is not None:
            pairs.extend(enumerate(np.asarray(body.velocity, dtype=float).tolist()))
        if body.angular_velocity is not None:
            spin = np.asarray(body.angular_velocity, dtype=float)
            spin = np.atleast_1d(spin) if d == 2 else state.turn[i] @ spin
            pairs.extend((d + k, float(x)) for k, x in enumerate(spin))
        for k, x in pairs:
            full = np.zeros((b, coordinates.width))
            full[i, k] = 1.0
            lines.append(full[coordinates.alive])
            values.append(x)
    return lines, values


def _independent(lines: list[Floats], line: Floats) -> bool:
    if not lines:
        return bool(line.any())
    sizes = np.linalg.norm(np.array(lines), axis=1)
    sizes[sizes == 0.0] = 1.0
    matrix = np.array(lines) / sizes[:, None]
    left = line - np.linalg.pinv(matrix, rcond=1e-9) @ (matrix @ line)
    return bool(np.linalg.norm(left) > 1e-8 * np.linalg.norm(line))


def _least_energy(mass: Floats, lines: Floats, values: Floats) -> Floats:
    n, m = len(mass), len(values)
    matrix = np.zeros((n + m, n + m))
    matrix[:n, :n] = mass
    matrix[:n, n:] = lines.T
    matrix[n:, :n] = lines
    found, _, _, _ = np.linalg.lstsq(matrix, np.concatenate([np.zeros(n), values]), rcond=1e-11)
    return found[:n]
