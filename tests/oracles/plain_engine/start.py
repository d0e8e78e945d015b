"""The start of a scene: places that meet what holds and touches, and the rates that the description leaves open."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from tests.oracles.plain_engine.coordinates import Floats, State
from tests.oracles.plain_engine.mechanism import Mechanism
from tests.oracles.plain_engine.phase import RANK, sizes_of

TOUCHING = 1e-9
"""Gap (m, rad) below which something touches at the start."""
_ROUNDS = 30
_INDEPENDENT = 1e-8
"""Share of a row that others have to leave over for it to be one more condition."""


def projected(mechanism: Mechanism, state: State, closed: Sequence[int], sticking: Sequence[int] = ()) -> State:
    """Return the state with its places on what holds and is closed, and its rates so that they, and slips, stay."""
    for _ in range(_ROUNDS):
        rows = mechanism.rows(state, closed, sticking)
        if not rows.owners:
            return state
        step = _least(rows.lines, -rows.values)
        state = mechanism.coordinates.advanced(state, step)
        if float(np.abs(step).max(initial=0.0)) < 1e-14 * max(1.0, float(np.abs(state.position).max())):
            break
    return replace(state, rates=state.rates + _least(rows.lines, -rows.rates))


def _least(lines: Floats, right: Floats) -> Floats:
    sizes = sizes_of(lines)
    found: Floats = np.linalg.pinv(lines / sizes[:, None], rcond=RANK) @ (right / sizes)
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
    guides = [i for i, one in enumerate(mechanism.one_sided) if one.opposite]
    state = projected(mechanism, mechanism.coordinates.start(), guides)
    gaps, _ = mechanism.gap_rates(state)
    touching = [i for i, gap in enumerate(gaps) if abs(gap) < TOUCHING]
    state = projected(mechanism, state, touching)
    state = replace(state, rates=np.zeros(mechanism.coordinates.size))
    rows = mechanism.rows(state, touching)
    wished = [k for k, (what, i) in enumerate(rows.owners) if what == "push" and not mechanism.one_sided[i].opposite]
    held = [k for k in range(len(rows.owners)) if k not in wished]
    given, speeds = _given(mechanism, state)
    lines, values = np.concatenate([rows.lines[held], given]), np.concatenate([-rows.rates[held], faster * speeds])
    if values.any() or rows.rates[wished].any():
        for k in wished:
            if _independent(lines, rows.lines[k]):
                lines, values = np.vstack([lines, rows.lines[k]]), np.append(values, -rows.rates[k])
        n, m = len(state.rates), len(values)
        matrix = np.block([[mechanism.inertia(state), lines.T], [lines, np.zeros((m, m))]])
        right = np.concatenate([np.zeros(n), values])
        state = replace(state, rates=np.linalg.lstsq(matrix, right, rcond=1e-11)[0][:n])
    return projected(mechanism, state, guides), touching


def _given(mechanism: Mechanism, state: State) -> tuple[Floats, Floats]:
    """Return the rates that are given, as rows and their values."""
    coordinates = mechanism.coordinates
    full = np.full(coordinates.alive.shape, np.nan)
    for i, body in enumerate(coordinates.bodies):
        if body.velocity is not None:
            full[i, : coordinates.dimension] = body.velocity
        if body.angular_velocity is not None:
            spin = np.asarray(body.angular_velocity, dtype=float)
            full[i, coordinates.dimension :] = spin if coordinates.flat else state.turn[i] @ spin
    values = full[coordinates.alive]
    known = ~np.isnan(values)
    return np.eye(coordinates.size)[known], values[known]


def _independent(lines: Floats, line: Floats) -> bool:
    left = line - _least(lines, lines @ line)
    return bool(np.linalg.norm(left) > _INDEPENDENT * np.linalg.norm(line))
