"""States and columns of a phase, at times since the start of the scene."""

from __future__ import annotations

from bisect import bisect_right
from collections.abc import Sequence

import numpy as np
from flint import arb

from core.arrays import Floats
from core.multibody.algebra.polynomials import ZERO, Ball, is_zero
from core.multibody.equations.packed import nearest, pair
from core.multibody.motion.motion import States
from core.multibody.phases.accumulation import Accumulation
from core.multibody.phases.phase import Phase
from core.multibody.search.bands import FLOOR, SAFETY_FACTOR
from core.multibody.trajectory.column_errors import FINEST
from core.multibody.trajectory.columns import NEAREST, Columns, Unknown
from core.multibody.trajectory.nearest import Nearest
from core.systems.trajectory import Column, How

Times = Floats | Sequence[Ball]
"""Doubles, or balls where a time is known to more digits."""


def in_closed_form(phase: Phase) -> bool:
    """Return whether the motion of a phase, and what came before it, is known without a series."""
    return len(phase.tracks) == 1 and all(part.how == "closed form" for _, part in phase.models[0].whole.parts)


def phase_at(phases: Sequence[Phase], time: float) -> int:
    """Return in which phase a time is; at the double that an event has it is in the one that begins."""
    return max(bisect_right(phases, time, key=lambda phase: nearest(phase.start)) - 1, 0)


def how_until(phases: Sequence[Phase], time: float) -> How:
    """Return how the errors of a motion up to a time are known."""
    reached = phases[: phase_at(phases, time) + 1]
    return "closed form" if all(map(in_closed_form, reached)) else "measured against pairs"


def states_in(phase: Phase, times: Times, *, finer: bool = False) -> States:
    """Return the states of a phase, with what its tracks differ by; finer ones where there is a choice."""
    if phase.bounces is not None:
        return _bouncing(phase, phase.bounces, times)
    found = [_of_track(phase, k, times, finer=finer) for k in range(len(phase.tracks))]
    first = found[0]
    sizes = np.abs(first.q[..., 0]), np.abs(first.v[..., 0])
    if not is_zero(phase.start):
        # At the start pairs of doubles know every coordinate to a share of itself, after events to one of the largest.
        sizes = sizes[0].max(axis=1, initial=0.0, keepdims=True), sizes[1].max(axis=1, initial=0.0, keepdims=True)
    q_error, v_error = first.q_error + FLOOR * sizes[0], first.v_error + FLOOR * sizes[1]
    unknown = _unknown(phase, times)
    if unknown is not None:
        q_error, v_error = q_error + unknown[0], v_error + unknown[1]
    reference = first.reference
    if len(found) > 1:
        other = found[1]
        reference = (other.q, other.v) if other.reference is None else other.reference
        q_error = q_error + SAFETY_FACTOR * np.abs((first.q - reference[0]).sum(axis=2))
        v_error = v_error + SAFETY_FACTOR * np.abs((first.v - reference[1]).sum(axis=2))
    if phase.tail is not None:
        # The models know nothing of bounces that are passed over; the tracks differ by as much with them as without.
        bouncing = _bouncing(phase, phase.tail, times)
        return States(bouncing.q, bouncing.v, q_error + bouncing.q_error, v_error + bouncing.v_error, None)
    return States(first.q, first.v, q_error, v_error, reference)


def _unknown(phase: Phase, times: Times) -> Unknown | None:
    """Return by how much coordinates and rates are wrong on all tracks alike, None where they are not."""
    if phase.unknown is None or phase.bounces is not None:
        return None
    moves = np.array([not still for still in phase.still])
    places, rates = np.array(phase.unknown[0]), np.array(phase.unknown[1]) * moves
    late = np.array([abs(float(arb(t) - phase.start)) for t in times])
    return places + np.outer(late, rates), np.broadcast_to(rates, (len(times), len(rates)))


def _of_track(phase: Phase, k: int, times: Times, *, finer: bool) -> States:
    """Return the states of one track at times since the start of the scene."""
    whole, start = phase.models[k].whole, phase.tracks[k].time
    if isinstance(times, np.ndarray) and is_zero(start):
        return whole.states(times, finer=finer)
    pairs = [pair(arb(t) - start, 0) for t in times]
    late = np.array([p[0] for p in pairs])
    rest = np.array([p[1] for p in pairs])
    if not is_zero(start):
        # A later phase is not followed backwards: what is before its start is a time known too roughly.
        rest, late = np.where(late > 0.0, rest, 0.0), np.maximum(late, 0.0)
    states = whole.states(late, finer=finer)
    if not np.any(rest):
        return states
    # Pairs take in of an acceleration what doubles hold of it, which is the same of both computations.
    gain = (
        np.array([float(x) for x in whole.acceleration]) if whole.uniform else whole.accelerations(states.q, states.v)
    )
    # What rests gains nothing, and not what rounding leaves of the forces on it.
    gain = np.where(phase.still, 0.0, gain)
    q, v = _later(states.q, states.v, gain, rest)
    reference = None if states.reference is None else _later(*states.reference, gain, rest)
    return States(q, v, states.q_error, states.v_error, reference)


def _later(q: Floats, v: Floats, gain: Floats, rest: Floats) -> tuple[Floats, Floats]:
    """Return states later by the tails of times: so small that one term of the Taylor series is right to pairs."""
    return _added(q, rest[:, None] * v[..., 0]), _added(v, rest[:, None] * gain)


def _added(pairs: Floats, more: Floats) -> Floats:
    """Return pairs of doubles with something small added."""
    high = pairs[..., 0] + more
    # What the first sum rounds off (Knuth), with the tail.
    part = high - pairs[..., 0]
    low = (pairs[..., 0] - (high - part)) + (more - part) + pairs[..., 1]
    total = high + low
    return np.stack([total, low - (total - high)], axis=-1)


def _bouncing(phase: Phase, bounces: Accumulation, times: Times) -> States:
    count = len(phase.tracks[0].q)
    q, v = np.zeros((len(times), count, 2)), np.zeros((len(times), count, 2))
    errors = np.zeros((2, len(times), count))
    for s, t in enumerate(times):
        late: Ball = arb(t) - phase.start
        late = late if late > 0 else ZERO
        for k, (vector, out) in enumerate(zip(bounces.at(late), (q, v), strict=True)):
            for i, x in enumerate(vector):
                out[s, i] = pair(x, 0)
                errors[k, s, i] = float(x.rad()) + FLOOR * abs(float(x))
    return States(q, v, errors[0], errors[1], None)


def columns_in(
    phase: Phase,
    times: Times,
    states: States,
    how: How,
    outputs: Sequence[object],
    rounding: float = FINEST,
) -> dict[str, Column]:
    """Return the columns of some outputs; forces that the phase does not determine are left out."""
    since = np.array([float(t) for t in times])
    columns = Columns(phase.models[0].whole, since, states, how, rounding, _unknown(phase, times))
    chosen = Nearest(columns).chosen if rounding == NEAREST else columns.chosen
    return chosen(outputs, phase.determined)
