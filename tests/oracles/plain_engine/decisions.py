"""Which of the touching contacts stay closed, stick, slide or open.

Where a figure that has to be at least zero has no sign, a short motion with these states shows it.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence

import numpy as np

from tests.oracles.plain_engine.combinations import LEAST, NEARLY, Combinations, clusters
from tests.oracles.plain_engine.coordinates import Floats, State
from tests.oracles.plain_engine.mechanism import Mechanism
from tests.oracles.plain_engine.modes import OPEN, Kind, Mode, ways
from tests.oracles.plain_engine.phase import Inconsistent, Key, Phase, Solution

PROBES = (3e-4, 3e-3, 1e-2, 3e-2)
"""Times after which a figure without a sign is seen, relative to that in which the scene turns or falls by itself."""

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
    rows = mechanism.rows(state, (), mechanism.rough(active))
    choices = {i: _choices(mechanism.one_sided[i].slips, rows.rates[rows.of("slip", i)], still) for i in active}
    # Groups that do not push one another are decided apart: what is still undecided stays closed, if it can. What one
    # does may show by the motion of another alone.
    modes = [choices[i][0] if i in choices else OPEN for i in range(len(mechanism.one_sided))]
    for _, other in mechanism.sides(active):
        modes[other] = OPEN
    groups = clusters(mechanism, state, active) if active else []
    for group in groups if len(groups) < 2 else groups * 2:
        modes = _Lasting(mechanism, state, group, probe).only(modes, choices)[0].modes
    return Phase(mechanism, modes)


def _choices(width: int, slip: Floats, still: float) -> tuple[Mode, ...]:
    size = float(np.linalg.norm(slip))
    return (Mode(Kind.SLIDE, tuple((slip / size).tolist())), OPEN) if size > still else ways(width)


class _Lasting(Combinations):
    """Combinations that stay possible for a while."""

    def __init__(self, mechanism: Mechanism, state: State, group: Sequence[int], probe: Probe) -> None:
        super().__init__(mechanism, state, group)
        self.probe = probe

    def lasts(self, phase: Phase, solution: Solution, doubtful: set[Key]) -> bool:
        """See `Combinations.lasts`."""
        fastest = float(np.abs(solution.accelerations).max(initial=0.0))
        if not self.state.rates.any() and not fastest > NEARLY:
            # Nothing moves: what is zero stays zero.
            return True
        for part in PROBES:
            if not doubtful:
                break
            try:
                later = self._later(phase, self.probe(phase, self.state, part / max(self.speed, np.sqrt(fastest))))
            except (Inconsistent, FloatingPointError):
                return False
            if any(later[key] < -3 * NEARLY for key in doubtful):
                return False
            doubtful = {key for key in doubtful if later[key] <= 3 * NEARLY}
        return True

    def _later(self, phase: Phase, then: State) -> dict[Key, float]:
        solution, (gaps, _) = phase.solve(then), self.mechanism.gap_rates(then)
        speed = max(float(np.abs(then.rates).max(initial=0.0)), LEAST)
        found = phase.conditions(solution, self.group)
        found |= {("gap", i): float(gaps[i]) for i in self.group}
        return found | {("slip", i): float(phase.along[i] @ x) / speed for i, x in solution.slips.items()}
