"""Which of the touching contacts stay closed, stick, slide or open: all combinations are tried.

A closed contact has a push of at least zero, an open one a gap that does not shrink, a sticking one friction within its
cone, one that begins to slide a slip along its direction. Where such a figure is zero, a short motion with these states
shows its sign.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from contextlib import suppress
from dataclasses import dataclass
from itertools import product

import numpy as np
from scipy.optimize import root

from tests.oracles.plain_engine.coordinates import Floats, State
from tests.oracles.plain_engine.impacts import Struck
from tests.oracles.plain_engine.mechanism import Mechanism, NotSupported, Undecided
from tests.oracles.plain_engine.phase import (
    CLOSED,
    OPEN,
    STICK,
    Conditions,
    Inconsistent,
    Kind,
    Mode,
    Phase,
    Solution,
    sticks_more,
)

NEARLY = 1e-9
"""Share of the forces, accelerations or rates of a scene below which one of them has no sign."""
PROBES = (3e-4, 3e-3, 1e-2, 3e-2)
"""Times after which a figure without a sign is seen, relative to that in which the scene turns or falls by itself."""
MOST = 1500
"""Combinations of states that are tried."""

Probe = Callable[[Phase, State, float], State]


@dataclass(frozen=True)
class Candidate:
    """States that go with accelerations."""

    phase: Phase
    solution: Solution


def time_scale(solution: Solution, state: State) -> float:
    """Return the time in which a scene moves by itself (s)."""
    fast = float(np.abs(state.rates).max(initial=0.0))
    faster = float(np.sqrt(np.abs(solution.accelerations).max(initial=0.0)))
    return 1.0 / max(fast, faster, 1e-3)


def decide(mechanism: Mechanism, state: State, touching: Sequence[int], probe: Probe, fastest: float) -> Phase:
    """Return the phase that follows a state in which nothing that touches approaches.

    Parameters
    ----------
    fastest : float
        Largest rate so far, beside which slips and rates of gaps are zero.

    Raises
    ------
    Undecided
        Where no states, or several, go with a motion.
    """
    every = mechanism.one_sided
    _, rates = mechanism.gap_rates(state)
    speed = max(fastest, 1e-3)
    active = [i for i in touching if abs(rates[i]) <= NEARLY * speed]
    if not active:
        return Phase(mechanism, [OPEN] * len(every))
    whole = Phase(mechanism, [STICK if i in active and every[i].slips else CLOSED if i in active else OPEN
                              for i in range(len(every))])  # fmt: skip
    rows, _, slips, _ = whole.rows(state)
    choices = {i: _choices(every[i].slips, rows.rates[slips[i]] if i in slips else None, speed) for i in active}
    # Groups that do not push one another are decided apart: what is still undecided stays closed, if it can.
    modes = [choices[i][0] if i in choices else OPEN for i in range(len(every))]
    for group in Struck(mechanism, state, active).clusters():
        modes = _decide_group(mechanism, state, modes, group, choices, probe)
    return Phase(mechanism, modes)


def _decide_group(
    mechanism: Mechanism,
    state: State,
    settled: list[Mode],
    group: Sequence[int],
    choices: Mapping[int, tuple[Mode, ...]],
    probe: Probe,
) -> list[Mode]:
    """Return all states, with those of one group of contacts decided."""
    if int(np.prod([len(choices[i]) for i in group])) > MOST:
        raise NotSupported("more contacts at once than combinations of which are tried")
    consistent: list[Candidate] = []
    every = list(product(*(choices[i] for i in group)))
    # Several directions at once of what begins to slide in space are looked for only where nothing else is possible.
    for later in (False, True):
        for chosen in every:
            if (_onsets(chosen) > 1) is not later or (later and consistent):
                continue
            modes = list(settled)
            for i, mode in zip(group, chosen, strict=True):
                modes[i] = mode
            if any(sticks_more(other.phase.modes, modes) for other in consistent):
                continue
            with suppress(Inconsistent):
                found = _candidate(mechanism, state, modes, group, probe)
                consistent.extend([] if found is None else [found])
    least = [
        one for one in consistent if not any(sticks_more(other.phase.modes, one.phase.modes) for other in consistent)
    ]
    names = [mechanism.one_sided[i].name for i in group]
    if not least:
        raise Undecided("no-motion", names)
    first = least[0].solution.accelerations
    size = _hurry(mechanism, state, least[0].solution)
    for other in least[1:]:
        if float(np.abs(other.solution.accelerations - first).max(initial=0.0)) > 1e-6 * size:
            raise Undecided("several-motions", names)
    if not least[0].solution.unique:
        raise Undecided("undetermined-friction", names)
    best = max(least, key=lambda one: (len(one.phase.closed), len(one.phase.sticking)))
    return best.phase.modes


def _onsets(modes: Sequence[Mode]) -> int:
    return sum(mode.kind is Kind.SLIDE and not mode.along for mode in modes)


def _hurry(mechanism: Mechanism, state: State, solution: Solution) -> float:
    """Return the size of the accelerations of a scene, of those that gravity and its speed could give it, too."""
    fall, own = (float(np.abs(x).max(initial=0.0)) for x in (mechanism.gravity, solution.accelerations))
    return max(fall, own, _speed(state) ** 2, 1e-3)


def _speed(state: State) -> float:
    return max(float(np.abs(state.rates).max(initial=0.0)), 1e-3)


def _choices(width: int, slip: Floats | None, speed: float) -> tuple[Mode, ...]:
    if width == 0 or slip is None:
        return (CLOSED, OPEN)
    size = float(np.linalg.norm(slip))
    if size > NEARLY * speed:
        return (Mode(Kind.SLIDE, tuple((slip / size).tolist())), OPEN)
    if width == 1:
        return (STICK, Mode(Kind.SLIDE, (1.0,)), Mode(Kind.SLIDE, (-1.0,)), OPEN)
    return (STICK, Mode(Kind.SLIDE, ()), OPEN)


def _candidate(
    mechanism: Mechanism, state: State, modes: list[Mode], active: Sequence[int], probe: Probe
) -> Candidate | None:
    """Return the states with their accelerations, if they go with the conditions; None if not."""
    onsets = [i for i in active if modes[i].kind is Kind.SLIDE and not modes[i].along]
    if onsets:
        directions = _onset(mechanism, state, modes, onsets)
        if directions is None:
            return None
        for i, direction in directions.items():
            modes[i] = Mode(Kind.SLIDE, tuple(direction.tolist()))
    phase = Phase(mechanism, modes)
    solution = phase.solve(state)
    figures = _figures(phase, state, active, solution, at_start=True)
    if any(x < -NEARLY for x in figures.values()):
        return None
    doubtful = [key for key, x in figures.items() if x <= NEARLY]
    if doubtful and not _lasts(phase, state, active, solution, doubtful, probe):
        return None
    return Candidate(phase, solution)


def _lasts(
    phase: Phase, state: State, active: Sequence[int], solution: Solution, doubtful: list[tuple[str, int]], probe: Probe
) -> bool:
    """Return whether figures without a sign turn out to be at least zero."""
    if not state.rates.any() and not np.abs(solution.accelerations).max(initial=0.0) > NEARLY:
        # Nothing moves: what is zero stays zero.
        return True
    unit = time_scale(solution, state)
    left = set(doubtful)
    for part in PROBES:
        try:
            then = probe(phase, state, part * unit)
            later = _figures(phase, then, active, phase.solve(then), at_start=False)
        except (Inconsistent, FloatingPointError):
            return False
        for key in list(left):
            x = later[key]
            if x < -3 * NEARLY:
                return False
            if x > 3 * NEARLY:
                left.discard(key)
        if not left:
            return True
    return True


def _figures(
    phase: Phase, state: State, active: Sequence[int], solution: Solution, *, at_start: bool
) -> dict[tuple[str, int], float]:
    """Return what has to be at least zero, relative to what it is beside."""
    mechanism, every = phase.mechanism, phase.mechanism.one_sided
    conditions = Conditions(phase, solution, active)
    found = dict(conditions.determined)
    if conditions.share is not None:
        found["share", -1] = conditions.share
    opened = [i for i in active if phase.modes[i].kind is Kind.OPEN]
    size = _hurry(mechanism, state, solution)
    rates = _speed(state)
    if opened and at_start:
        gains = mechanism.gains_of_gaps(state, [every[i] for i in opened], solution.accelerations)
        found.update({("gap", i): float(x) / size for i, x in zip(opened, gains, strict=True)})
    elif opened:
        gaps, _ = mechanism.gap_rates(state)
        found.update({("gap", i): float(gaps[i]) for i in opened})
    begun = [i for i in phase.sliding if i in active]
    if begun:
        rows, _, slips, _ = phase.rows(state)
        for i in begun:
            slip, along = rows.rates[slips[i]], phase.along[i]
            if not at_start:
                found["slip", i] = float(along @ slip) / rates
            elif float(np.linalg.norm(slip)) <= NEARLY * rates:
                grows = rows.lines[slips[i]] @ solution.accelerations + rows.gains[slips[i]]
                found["slip", i] = float(along @ grows) / size
    return found


def _onset(mechanism: Mechanism, state: State, modes: list[Mode], onsets: list[int]) -> dict[int, Floats] | None:
    """Return directions in which contacts in space begin to slide: those of the slips that follow."""
    gripping = [STICK if i in onsets else mode for i, mode in enumerate(modes)]
    held = Phase(mechanism, gripping)
    rows, _, slips, _ = held.rows(state)
    frames: dict[int, Floats] = {}
    first = []
    try:
        solution = held.solve(state)
    except Inconsistent:
        return None
    for i in onsets:
        _, _, vt = np.linalg.svd(rows.lines[slips[i]].T)
        frames[i] = vt[:2]
        rub = frames[i] @ (solution.forces[solution.sticks[i]] @ solution.frames[i])
        first.append(np.arctan2(-rub[1], -rub[0]))

    def follow(angles: Floats) -> tuple[list[Floats], list[Floats]]:
        along = {i: np.array([np.cos(a), np.sin(a)]) @ frames[i] for i, a in zip(onsets, angles, strict=True)}
        changed = [Mode(Kind.SLIDE, tuple(along[i].tolist())) if i in along else mode for i, mode in enumerate(modes)]
        phase = Phase(mechanism, changed)
        found = phase.solve(state)
        rows, _, where, _ = phase.rows(state)
        grows = [rows.lines[where[i]] @ found.accelerations + rows.gains[where[i]] for i in onsets]
        return [along[i] for i in onsets], grows

    def beside(angles: Floats) -> Floats:
        missed = []
        for i, along, grows in zip(onsets, *follow(angles), strict=True):
            a, b = frames[i] @ along, frames[i] @ grows
            size = float(np.linalg.norm(b)) or 1.0
            missed.append((a[0] * b[1] - a[1] * b[0]) / size)
        return np.array(missed)

    try:
        found = root(beside, np.array(first), tol=1e-13)
        if np.abs(beside(found.x)).max() > 1e-9:
            return None
        along, grows = follow(found.x)
    except Inconsistent:
        return None
    if any(float(a @ b) <= 0.0 for a, b in zip(along, grows, strict=True)):
        return None
    return dict(zip(onsets, along, strict=True))
