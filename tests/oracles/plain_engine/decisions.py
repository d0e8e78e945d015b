"""Which of the touching contacts stay closed, stick, slide or open: all combinations are tried.

A closed contact has a push of at least zero, an open one a gap that does not shrink, a sticking one friction within its
cone, one that begins to slide a slip along its direction. Where such a figure is zero, a short motion with these states
shows its sign.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from contextlib import suppress
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
LEAST = 1e-3
"""Speed (m/s, rad/s) or acceleration beside which rounding has no sign, where nothing else moves."""
ALIKE = 1e-6
"""Share of the accelerations of a scene within which those of two combinations are the same."""

Probe = Callable[[Phase, State, float], State]


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
    _, rates = mechanism.gap_rates(state)
    still = NEARLY * max(fastest, LEAST)
    active = [i for i in touching if abs(rates[i]) <= still]
    # Groups that do not push one another are decided apart: what is still undecided stays closed, if it can.
    modes = [OPEN] * len(mechanism.one_sided)
    if active:
        struck = Struck(mechanism, state, active)
        choices = {i: _choices(mechanism.one_sided[i].slips, struck.slip[i] @ state.rates, still) for i in active}
        for i in active:
            modes[i] = choices[i][0]
        for group in struck.clusters():
            modes = _Group(mechanism, state, group, probe).decided(modes, choices)
    return Phase(mechanism, modes)


def _choices(width: int, slip: Floats, still: float) -> tuple[Mode, ...]:
    size = float(np.linalg.norm(slip))
    if size > still:
        return (Mode(Kind.SLIDE, tuple((slip / size).tolist())), OPEN)
    sliding = {0: (), 1: (Mode(Kind.SLIDE, (1.0,)), Mode(Kind.SLIDE, (-1.0,)))}.get(width, (Mode(Kind.SLIDE),))
    return (STICK if width else CLOSED, *sliding, OPEN)


class _Group:
    """Contacts that push one another, in a state."""

    def __init__(self, mechanism: Mechanism, state: State, group: Sequence[int], probe: Probe) -> None:
        self.mechanism, self.state, self.group, self.probe = mechanism, state, group, probe
        self.speed = max(float(np.abs(state.rates).max(initial=0.0)), LEAST)

    def decided(self, settled: list[Mode], choices: Mapping[int, tuple[Mode, ...]]) -> list[Mode]:
        """Return all states, with those of this group decided."""
        every = list(product(*(choices[i] for i in self.group)))
        if len(every) > MOST:
            raise NotSupported("more contacts at once than combinations of which are tried")
        consistent: list[tuple[Phase, Solution]] = []
        # Several directions at once of what begins to slide in space are tried only where nothing else is possible.
        for chosen in sorted(every, key=lambda modes: _onsets(modes) > 1):
            modes = list(settled)
            for i, mode in zip(self.group, chosen, strict=True):
                modes[i] = mode
            if consistent and (_onsets(chosen) > 1 or any(sticks_more(x.modes, modes) for x, _ in consistent)):
                continue
            with suppress(Inconsistent):
                found = self._candidate(modes)
                consistent.extend([] if found is None else [found])
        least = [one for one in consistent if not any(sticks_more(x.modes, one[0].modes) for x, _ in consistent)]
        names = [self.mechanism.one_sided[i].name for i in self.group]
        if not least:
            raise Undecided("no-motion", names)
        first = least[0][1]
        apart = [float(np.abs(x.accelerations - first.accelerations).max(initial=0.0)) for _, x in least]
        if max(apart) > ALIKE * self._hurry(first):
            raise Undecided("several-motions", names)
        if not first.unique:
            raise Undecided("undetermined-friction", names)
        return max(least, key=lambda one: (len(one[0].closed), len(one[0].sticking)))[0].modes

    def _hurry(self, solution: Solution) -> float:
        """Return the size of the accelerations of a scene, of those that gravity and its speed could give it, too."""
        fall, own = (float(np.abs(x).max(initial=0.0)) for x in (self.mechanism.gravity, solution.accelerations))
        return max(fall, own, self.speed**2, LEAST)

    def _candidate(self, modes: list[Mode]) -> tuple[Phase, Solution] | None:
        """Return a phase with its accelerations, if they go with the conditions; None if not."""
        onsets = [i for i in self.group if modes[i].kind is Kind.SLIDE and not modes[i].along]
        if onsets:
            directions = _onset(self.mechanism, self.state, modes, onsets)
            if directions is None:
                return None
            for i, direction in directions.items():
                modes[i] = Mode(Kind.SLIDE, tuple(direction.tolist()))
        phase = Phase(self.mechanism, modes)
        solution = phase.solve(self.state)
        figures = self._figures(phase, solution, None)
        if any(x < -NEARLY for x in figures.values()):
            return None
        doubtful = {key for key, x in figures.items() if x <= NEARLY}
        return (phase, solution) if self._lasts(phase, solution, doubtful) else None

    def _lasts(self, phase: Phase, solution: Solution, doubtful: set[tuple[str, int]]) -> bool:
        """Return whether figures without a sign turn out to be at least zero."""
        fastest = float(np.abs(solution.accelerations).max(initial=0.0))
        if not self.state.rates.any() and not fastest > NEARLY:
            # Nothing moves: what is zero stays zero.
            return True
        for part in PROBES if doubtful else ():
            try:
                then = self.probe(phase, self.state, part / max(self.speed, np.sqrt(fastest)))
                later = self._figures(phase, phase.solve(then), then)
            except (Inconsistent, FloatingPointError):
                return False
            if any(later[key] < -3 * NEARLY for key in doubtful):
                return False
            doubtful = {key for key in doubtful if later[key] <= 3 * NEARLY}
            if not doubtful:
                break
        return True

    def _figures(self, phase: Phase, solution: Solution, then: State | None) -> dict[tuple[str, int], float]:
        """Return what has to be at least zero, relative to what it is beside: now, or in a later state."""
        conditions = Conditions(phase, solution, self.group)
        found = dict(conditions.determined)
        if conditions.share is not None:
            found["share", -1] = conditions.share
        size = self._hurry(solution)
        opened = [i for i in self.group if phase.modes[i].kind is Kind.OPEN]
        gaps = [self.mechanism.one_sided[i] for i in opened]
        if then is not None:
            speed = max(float(np.abs(then.rates).max(initial=0.0)), LEAST)
            later, _ = self.mechanism.gap_rates(then)
            found.update({("gap", i): float(later[i]) for i in opened})
            found.update({("slip", i): float(phase.along[i] @ x) / speed for i, x in solution.slips.items()})
            return found
        gains = self.mechanism.gains_of_gaps(self.state, gaps, solution.accelerations) if gaps else np.zeros(0)
        found.update({("gap", i): float(x) / size for i, x in zip(opened, gains, strict=True)})
        begun = [i for i in phase.sliding if i in self.group]
        rows, _, slips, _ = phase.rows(self.state)
        for i in begun:
            if float(np.linalg.norm(rows.rates[slips[i]])) <= NEARLY * self.speed:
                grows = rows.lines[slips[i]] @ solution.accelerations + rows.gains[slips[i]]
                found["slip", i] = float(phase.along[i] @ grows) / size
        return found


def _onsets(modes: Sequence[Mode]) -> int:
    return sum(mode.kind is Kind.SLIDE and not mode.along for mode in modes)


def _onset(mechanism: Mechanism, state: State, modes: list[Mode], onsets: list[int]) -> dict[int, Floats] | None:
    """Return directions in which contacts in space begin to slide: those of the slips that follow."""
    held = Phase(mechanism, [STICK if i in onsets else mode for i, mode in enumerate(modes)])
    rows, _, slips, _ = held.rows(state)
    frames = {i: np.linalg.svd(rows.lines[slips[i]].T)[2][:2] for i in onsets}

    def follow(angles: Floats) -> tuple[dict[int, Floats], list[Floats]]:
        along = {i: np.array([np.cos(a), np.sin(a)]) @ frames[i] for i, a in zip(onsets, angles, strict=True)}
        changed = [Mode(Kind.SLIDE, tuple(along[i].tolist())) if i in along else mode for i, mode in enumerate(modes)]
        phase = Phase(mechanism, changed)
        found = phase.solve(state)
        rows, _, where, _ = phase.rows(state)
        return along, [rows.lines[where[i]] @ found.accelerations + rows.gains[where[i]] for i in onsets]

    def beside(angles: Floats) -> Floats:
        missed = []
        along, grows = follow(angles)
        for i, grown in zip(onsets, grows, strict=True):
            a, b = frames[i] @ along[i], frames[i] @ grown
            missed.append((a[0] * b[1] - a[1] * b[0]) / (float(np.linalg.norm(b)) or 1.0))
        return np.array(missed)

    with suppress(Inconsistent):
        solution = held.solve(state)
        rubs = [frames[i] @ (solution.forces[solution.sticks[i]] @ solution.frames[i]) for i in onsets]
        found = root(beside, np.array([np.arctan2(-y, -x) for x, y in rubs]), tol=1e-13)
        along, grows = follow(found.x)
        follows = all(along[i] @ grown > 0.0 for i, grown in zip(onsets, grows, strict=True))
        return along if follows and np.abs(beside(found.x)).max() <= NEARLY else None
    return None
