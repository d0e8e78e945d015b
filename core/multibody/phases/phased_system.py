"""The motion of a scene through phases, as a system: its samples, sums along it, and what is searched in it."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace

import numpy as np
from flint import arb

from core.arrays import Floats
from core.errors import AccuracyUnreachable, MechanicsError
from core.multibody.answer import Occurrence, SceneExtremes
from core.multibody.language.scene import Scene
from core.multibody.phases.inherited_in_phases import inherited_in_phases
from core.multibody.phases.phase import PhaseMotion
from core.multibody.phases.phase_states import columns_in, in_closed_form, phase_at, states_in
from core.multibody.phases.searches_in_phases import SearchInPhases
from core.multibody.phases.stretches import stretches
from core.multibody.phases.sums_in_phases import SumsInPhases
from core.multibody.trajectory.column_errors import require_reached, scaled, worst
from core.multibody.trajectory.inherited import with_inherited
from core.multibody.trajectory.occurrences import ExtremesOf, When
from core.multibody.trajectory.trajectories import ONLY_SUMS, PLACES_AND_FORCES, require_affordable
from core.systems.methods.closed_form import ClosedFormEvaluation
from core.systems.question import MotionQuestion
from core.systems.trajectory import HORIZON, Accuracy, Column, How, Trajectory, Work

_NO_HORIZON = "how long a motion through events stays within the accuracy is not looked for"


class PhasedSystem:
    """The motion of a scene through phases, as a system; `outputs` are its columns."""

    def __init__(self, scene: Scene, motion: PhaseMotion, outputs: Sequence[object]) -> None:
        self.scene, self.motion, self.outputs = scene, motion, outputs

    def trajectory(self, question: MotionQuestion) -> Trajectory:
        """Return the samples up to the end of the motion; see `core.systems.question.System`."""
        motion, phases = self.motion, self.motion.phases
        require_affordable(len(question.times), len(motion.base.measures.table.names))
        reached = list(range(len(question.times))) if phases else []
        if motion.ended is not None and phases:
            ends = phases[-1].end
            ends = arb(motion.ended.time) if ends is None else ends
            reached = [k for k, t in enumerate(question.times) if not arb(float(t)) > ends]
        rows = np.array(reached, dtype=np.int64)
        times = question.times[rows]
        with np.errstate(over="ignore", invalid="ignore"):
            pieces, how = self._pieces(motion, times)
            columns = _merged(pieces, len(times), motion.fastest) | self._sums(times, how)
            require_reached(columns, question.accuracy, before=self._reached_until(pieces, times, question.accuracy))
            stated = Accuracy(question.accuracy, worst(columns), how)
            if question.input_uncertainty is not None and len(times):
                end = float(np.max(question.times))
                columns, stated = self._with_inherited(times, columns, stated, question.input_uncertainty, end)
        return Trajectory(
            times,
            scaled(columns),
            stated,
            None,
            ClosedFormEvaluation().kind,
            Work(len(times)),
            ended=HORIZON if motion.ended is None else motion.ended.kind,
            rows=rows,
            events=motion.events,
        )

    def _reached_until(
        self, pieces: Sequence[tuple[np.ndarray, dict[str, Column]]], times: Floats, accuracy: float
    ) -> float | None:
        """Return the first time of a phase before which an accuracy is reached, None if it is at none or at all."""
        for k in range(len(pieces)):
            if worst(_merged(pieces[: k + 1], len(times), self.motion.fastest)) > accuracy:
                return float(times[pieces[k][0][0]]) if k else None
        return None

    def sampled(self, times: Floats) -> dict[str, Column]:
        """Return places, rates and forces at some times; without forces where they are not known."""
        with np.errstate(over="ignore", invalid="ignore"):
            try:
                return PhasedSystem(self.scene, self.motion, PLACES_AND_FORCES)._sampled(times)
            except AccuracyUnreachable:
                return PhasedSystem(self.scene, self.motion, PLACES_AND_FORCES[:1])._sampled(times)

    def _sampled(self, times: Floats) -> dict[str, Column]:
        return _merged(self._pieces(self.motion, times)[0], len(times), self.motion.fastest)

    def _sums(self, times: Floats, how: How) -> dict[str, Column]:
        """Return the columns of what is summed up along the motion."""
        if not {"work-in-time", "paths-in-time"} & set(self.outputs):
            return {}
        pieces = list(stretches(self.motion, float(np.max(times, initial=0.0))))
        sums = SumsInPhases(self.motion, pieces, times, how)
        found = sums.works() if "work-in-time" in self.outputs else {}
        return found | (sums.paths() if "paths-in-time" in self.outputs else {})

    def searched(self, end: float) -> tuple[tuple[Occurrence, ...] | None, tuple[SceneExtremes, ...] | None]:
        """Return when quantities take values and how large they become, up to a time or the end of the motion.

        None where no search is among the outputs.
        """
        searches = [(i, output) for i, output in enumerate(self.outputs) if isinstance(output, (When, ExtremesOf))]
        if not searches:
            return None, None
        end = end if self.motion.ended is None else min(end, self.motion.ended.time)
        pieces = list(stretches(self.motion, end))
        if not pieces:
            return (), ()
        exact = all(in_closed_form(piece.phase) for piece in pieces)
        along = SearchInPhases(pieces, "closed form" if exact else "measured against pairs")
        found: list[Occurrence] = []
        ranges: list[SceneExtremes] = []
        with np.errstate(over="ignore", invalid="ignore"):
            for index, search in searches:
                if isinstance(search, When):
                    found.extend(along.occurrences(search, index))
                else:
                    ranges.append(along.extremes(search, index))
        return tuple(found), tuple(ranges)

    def _pieces(self, motion: PhaseMotion, times: Floats) -> tuple[list[tuple[np.ndarray, dict[str, Column]]], How]:
        """Return the columns of every phase, with the numbers of the times in it, and how their errors are known."""
        phases = motion.phases
        which = np.array([phase_at(phases, float(t)) for t in times], dtype=np.int64)
        exact = all(in_closed_form(phases[k]) for k in range(int(np.max(which, initial=0)) + 1)) if phases else True
        how: How = "closed form" if exact else "measured against pairs"
        pieces: list[tuple[np.ndarray, dict[str, Column]]] = []
        for k in sorted(set(which.tolist())) or ([0] if phases else []):
            mine = np.flatnonzero(which == k)
            states = states_in(phases[k], times[mine])
            pieces.append((mine, columns_in(phases[k], times[mine], states, how, self.outputs)))
        return pieces, how

    def _with_inherited(
        self, times: Floats, columns: dict[str, Column], stated: Accuracy, uncertainty: float, end: float
    ) -> tuple[dict[str, Column], Accuracy]:
        """Add what the uncertainty of the inputs does, or why that is not known."""

        def columns_of(other: PhaseMotion) -> dict[str, Column]:
            return _merged(self._pieces(other, times)[0], len(times), self.motion.fastest)

        own = {name: columns[name] for name in columns_of(self.motion)}
        if not own:
            return columns, replace(stated, why=ONLY_SUMS)
        try:
            moved = inherited_in_phases(self.scene, self.motion, end, own, columns_of)
        except MechanicsError as fault:
            return columns, replace(stated, why=fault.detail)
        return with_inherited(columns, stated, moved, uncertainty, why=_NO_HORIZON)


def _merged(
    pieces: Sequence[tuple[np.ndarray, dict[str, Column]]], count: int, fastest: Mapping[str, float]
) -> dict[str, Column]:
    """Return the columns of all phases in one; a force that one of them does not determine is left out.

    Rates are measured by the largest of the motion, also where all samples are at rest.
    """
    if not pieces:
        return {}
    names = [name for name in pieces[0][1] if all(name in own for _, own in pieces)]
    found = {}
    for name in names:
        first = pieces[0][1][name]
        values = np.zeros((count, *first.values.shape[1:]))
        for mine, own in pieces:
            values[mine] = own[name].values
        error = max(own[name].error for _, own in pieces)
        known = [fastest.get(first.unit), *(own[name].scale for _, own in pieces)]
        scale = max((x for x in known if x is not None), default=None)
        found[name] = Column(values, first.unit, error, first.how, scale=scale)
    return found
