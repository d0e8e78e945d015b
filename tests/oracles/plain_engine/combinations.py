"""All that contacts which push one another may do at once, in one law for accelerations and for impacts.

With x the accelerations of a state, or the change of its rates by an impact, p pushes or impulses, and y = W x + g what
gaps and slips do: p >= 0 and y >= 0 of a gap, one of them zero; a slip stays zero and |s| <= mu p, or s = -mu p along a
slip that grows. The gains g of a state are those by its present motion. Of an impact they are its rates, those of gaps
that close times 1 + e: Newton's law of restitution with Coulomb's friction.

References
----------
F. Pfeiffer, C. Glocker, "Multibody Dynamics with Unilateral Contacts" (1996), chapters 5 and 8.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from contextlib import suppress
from itertools import product

import numpy as np
from scipy.sparse.csgraph import connected_components

from tests.oracles.plain_engine.coordinates import Floats, State
from tests.oracles.plain_engine.mechanism import Mechanism, NotSupported, Undecided
from tests.oracles.plain_engine.modes import STICK, Directions, Kind, Mode, directions, sticks_more, tangents, toward
from tests.oracles.plain_engine.phase import Inconsistent, Key, Phase, Solution

NEARLY = 1e-9
"""Share of the forces, accelerations or rates of a scene below which one of them has no sign."""
LEAST = 1e-3
"""Speed (m/s, rad/s) or acceleration beside which rounding has no sign, where nothing else moves."""
COUPLED = 1e-11
"""Share of what a push changes below which it does not change the rate of another contact."""
ALIKE = 1e-6
"""Share of the accelerations, or of the rates, within which those of two combinations are the same."""
MOST = 1500
"""Combinations of states that are tried."""


class Combinations:
    """Contacts that push one another, in a state.

    Parameters
    ----------
    restitution : mapping of int to float, or None
        By measure, of an impact.
    """

    codes = ("no-motion", "several-motions", "undetermined-friction")

    def __init__(
        self, mechanism: Mechanism, state: State, group: Sequence[int], restitution: Mapping[int, float] | None = None
    ) -> None:
        self.mechanism, self.state, self.group, self.restitution = mechanism, state, list(group), restitution
        self.rows = mechanism.rows(state, self.group, mechanism.rough(group))
        self.gains = self.rows.gains if restitution is None else self.rows.after(restitution)
        self.speed = max(float(np.abs(state.rates).max(initial=0.0)), LEAST)

    def only(self, settled: Sequence[Mode], choices: Mapping[int, Sequence[Mode]]) -> tuple[Phase, Solution]:
        """Return the only combination that is possible, beside states of other contacts.

        Raises
        ------
        Undecided
            Where there is none, or several that do not do the same.
        """
        none, several, open_to = self.codes
        every = list(product(*(choices[i] for i in self.group)))
        if len(every) > MOST:
            raise NotSupported("more contacts at once than combinations of which are tried")
        found: list[tuple[Phase, Solution]] = []
        sides = self.mechanism.sides(self.group)
        # Several directions at once of what begins to slide in space are tried only where nothing else is possible.
        for chosen in sorted(every, key=lambda modes: sum(mode.undirected for mode in modes) > 1):
            modes = list(settled)
            for i, mode in zip(self.group, chosen, strict=True):
                modes[i] = mode
            if not all(self._without_preload(modes[i], modes[k]) for i, k in sides):
                continue
            more = sum(mode.undirected for mode in chosen) > 1
            if found and (more or any(sticks_more(phase.modes, modes) for phase, _ in found)):
                continue
            with suppress(Inconsistent):
                candidate = self._candidate(modes)
                found.extend([] if candidate is None else [candidate])
        # What slides may not do so where it may as well stick.
        least = [one for one in found if not any(sticks_more(other.modes, one[0].modes) for other, _ in found)]
        names = [self.mechanism.one_sided[i].name for i in self.group]
        if not least:
            raise Undecided(none, names)
        first = least[0][1]
        apart = max(float(np.abs(x.accelerations - first.accelerations).max(initial=0.0)) for _, x in least)
        if apart > ALIKE * self.size(first):
            raise Undecided(several, names)
        if not first.unique:
            raise Undecided(open_to, names)
        return max(least, key=lambda one: (len(one[0].closed), len(one[0].sticking)))

    def _without_preload(self, first: Mode, second: Mode) -> bool:
        """Return whether one side of a guide presses and the other does not; of an impact both may be left out."""
        idle = sum(mode.kind is Kind.OPEN for mode in (first, second))
        return idle == 1 or (idle == 2 and self.restitution is not None)

    def size(self, solution: Solution) -> float:
        """Return the size of what may change: the accelerations that gravity and speed could give are among it."""
        if self.restitution is not None:
            return self.speed
        fall, own = (float(np.abs(x).max(initial=0.0)) for x in (self.mechanism.gravity, solution.accelerations))
        return max(fall, own, self.speed**2, LEAST)

    def lasts(self, phase: Phase, solution: Solution, doubtful: set[Key]) -> bool:
        """Return whether figures without a sign turn out to be at least zero: after an impact that is left open."""
        return True

    def _candidate(self, modes: list[Mode]) -> tuple[Phase, Solution] | None:
        """Return a phase with what it does, if that goes with the conditions; None if not."""
        onsets = [i for i in self.group if modes[i].undirected]
        if onsets:
            along = self._onset(modes, onsets)
            if along is None:
                return None
            modes = toward(modes, along)
        phase = Phase(self.mechanism, modes)
        solution = phase.solve(self.state, self.restitution)
        figures = phase.conditions(solution, self.group)
        grows, size = self.rows.lines @ solution.accelerations + self.gains, self.size(solution)
        for i in self.group:
            slip = self.rows.of("slip", i)
            if modes[i].kind is Kind.OPEN:
                figures["gap", i] = float(grows[self.rows.of("push", i)][0]) / size
            elif modes[i].kind is Kind.SLIDE and self._begins(i):
                figures["slip", i] = float(phase.along[i] @ grows[slip]) / size
        if any(x < -NEARLY for x in figures.values()):
            return None
        doubtful = {key for key, x in figures.items() if x <= NEARLY}
        return (phase, solution) if self.lasts(phase, solution, doubtful) else None

    def _begins(self, i: int) -> bool:
        slip = self.rows.rates[self.rows.of("slip", i)]
        return self.restitution is not None or float(np.linalg.norm(slip)) <= NEARLY * self.speed

    def _onset(self, modes: list[Mode], onsets: list[int]) -> Directions | None:
        """Return the directions in which contacts in space begin to slide."""
        slips = {i: self.rows.of("slip", i) for i in onsets}
        held = Phase(self.mechanism, [STICK if i in onsets else mode for i, mode in enumerate(modes)])
        solution = held.solve(self.state, self.restitution)

        def follow(along: Directions) -> Directions:
            found = Phase(self.mechanism, toward(modes, along)).solve(self.state, self.restitution)
            grows = self.rows.lines @ found.accelerations + self.gains
            return {i: grows[at] for i, at in slips.items()}

        frames = {i: tangents(self.rows.lines[at]) for i, at in slips.items()}
        return directions(frames, {i: solution.rub(i) for i in onsets}, follow)


def clusters(mechanism: Mechanism, state: State, touching: Sequence[int]) -> list[list[int]]:
    """Return the measures in groups that do not push one another."""
    rows, response = mechanism.rows(state, touching, mechanism.rough(touching)), free_response(mechanism, state)
    lines = [rows.lines[[*rows.of("push", i), *rows.of("slip", i)]] for i in touching]
    coupled = [
        [np.abs(a @ response @ b.T).max() > COUPLED * max(np.linalg.norm(a @ response), 1e-300) for b in lines]
        for a in lines
    ]
    count, labels = connected_components(np.array(coupled).reshape(len(lines), -1))
    return [[i for i, label in zip(touching, labels, strict=True) if label == k] for k in range(count)]


def free_response(mechanism: Mechanism, state: State) -> Floats:
    """Return the change of the rates by unit impulses, beside what holds, shape (n, n)."""
    rows, mass = mechanism.rows(state), mechanism.inertia(state)
    n, m = len(mass), len(rows.lines)
    whole = np.block([[mass, -rows.lines.T], [rows.lines, np.zeros((m, m))]])
    found: Floats = np.linalg.pinv(whole, rcond=COUPLED)[:n, :n]
    return found
