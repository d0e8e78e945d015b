"""The columns of a motion through its phases at any times, and how far they are as right as is requested."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from core.arrays import Floats
from core.errors import NotApplicable
from core.multibody.motion.motion import States
from core.multibody.phases.phase import Phase, PhaseMotion
from core.multibody.phases.phase_states import columns_in, how_until, phase_at, states_in
from core.multibody.trajectory.column_errors import FINEST, with_natural_sizes, worst
from core.systems.trajectory import Column, How

_HOLDS = 1e-8
"""Relative mismatch of a measure above which it is not held."""


@dataclass(frozen=True)
class ColumnsInPhases:
    """Makes the columns of a motion at many times.

    Attributes
    ----------
    motion : PhaseMotion
    outputs : sequence
        Those of the state are its columns.
    finer : bool
        Whether pairs of doubles compute the motion where there is a choice.
    rounding : float
        What rounding to doubles adds to an error, relative to the largest value of a column.
    """

    motion: PhaseMotion
    outputs: Sequence[object]
    finer: bool = False
    rounding: float = FINEST

    @property
    def numerical(self) -> bool:
        """Whether a phase may be computed in pairs of doubles in place of doubles."""
        phases = self.motion.phases
        return self.motion.smooth and any(part.has_finer_run for _, part in phases[0].models[0].whole.parts)

    def at(self, times: Floats) -> dict[str, Column]:
        """Return the columns at some times."""
        phases = self.motion.phases
        if not phases:
            return {}
        which = np.zeros(len(times), dtype=np.int64)
        if len(phases) > 1:
            which = np.array([phase_at(phases, float(t)) for t in times], dtype=np.int64)
        how = how_until(phases, float(times.max(initial=0.0)))
        pieces = []
        for k in sorted(set(which.tolist())) or [0]:
            mine = np.flatnonzero(which == k)
            pieces.append((mine, self._of_phase(phases[k], times[mine], how)))
        return self._merged(pieces, len(times))

    def _of_phase(self, phase: Phase, times: Floats, how: How) -> dict[str, Column]:
        states = states_in(phase, times, finer=self.finer)
        whole = phase.models[0].whole
        # What rests keeps to all of its rows: its rates are rounding, and no size for one another.
        moves = any(motion.moves for _, motion in whole.parts)
        if whole.dropped and moves and phase.bounces is None and whole.misfit(states) > _HOLDS:
            raise NotApplicable(
                "connections that depend on one another at the start do not do so later: the start is a singular place",
                path=("connections",),
                remedy="start elsewhere",
            )
        return columns_in(phase, times, states, how, self.outputs, self.rounding)

    def of_states(self, times: Floats, states: States, how: How) -> dict[str, Column]:
        """Return the columns of states of the first phase that are computed elsewhere."""
        return columns_in(self.motion.phases[0], times, states, how, self.outputs)

    def with_sizes(self, times: Floats) -> dict[str, Column]:
        """Return the columns at some times, with how large what is small at all of them is in between."""
        return with_natural_sizes(self.at(times), times, replace(self, finer=False, rounding=FINEST).at)

    def are_known(self, times: Floats, accuracy: float) -> bool:
        """Return whether the motion itself reaches an accuracy, so that only what doubles make of it does not.

        The force of a stiff spring is a small difference of lengths: doubles lose the digits that both share.
        """
        places = replace(self, outputs=("trajectory",), finer=True).at(times)
        return worst(places) <= max(accuracy, 2 * FINEST)

    def reached_until(self, times: Floats, accuracy: float) -> float | None:
        """Return the time before which the accuracy is reached, None if that is at none of the times or of one sign."""
        order = np.argsort(np.abs(times))
        if len(times) < 2 or np.min(times) < 0.0:
            return None
        reached, lost = 0, len(times)
        while lost - reached > 1:
            middle = (reached + lost) // 2
            known = worst(self.with_sizes(times[order[:middle]])) <= accuracy
            reached, lost = (middle, lost) if known else (reached, middle)
        return float(times[order[reached]]) if reached and times[order[reached - 1]] > 0.0 else None

    def _merged(self, pieces: Sequence[tuple[np.ndarray, dict[str, Column]]], count: int) -> dict[str, Column]:
        """Return the columns of all phases in one; a force that one of them does not determine is left out.

        Rates are measured by the largest of the motion, also where all samples are at rest.
        """
        found, fastest = {}, self.motion.fastest
        if len(pieces) == 1 and not fastest:
            return pieces[0][1]
        for name, first in pieces[0][1].items():
            if not all(name in own for _, own in pieces):
                continue
            values = first.values
            if len(pieces) > 1:
                values = np.zeros((count, *first.values.shape[1:]))
                for mine, own in pieces:
                    values[mine] = own[name].values
            error = max(own[name].error for _, own in pieces)
            known = [fastest.get(first.unit), *(own[name].scale for _, own in pieces)]
            scale = max((x for x in known if x is not None), default=None)
            found[name] = Column(values, first.unit, error, first.how, scale=scale)
        return found
