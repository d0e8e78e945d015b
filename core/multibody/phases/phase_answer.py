"""What is answered about a scene with unilateral measures: its start, phases and events, its motion through them."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace

import numpy as np
from flint import arb

from core.arrays import Floats
from core.errors import InvalidParameter, MechanicsError, NotApplicable
from core.multibody.answer import (
    BodyAcceleration,
    ForceAnswer,
    MotionPhase,
    Occurrence,
    SceneExtremes,
    SceneModel,
    SceneProblem,
    SceneSolution,
)
from core.multibody.equations.dynamics import forces_at_start, multipliers_at_start
from core.multibody.equations.packed import nearest
from core.multibody.language.scene import Scene
from core.multibody.phases.inherited_in_phases import inherited_in_phases
from core.multibody.phases.phase import Phase, PhaseMotion
from core.multibody.phases.phase_states import columns_in, in_closed_form, phase_at, states_in
from core.multibody.phases.phases import motion_in_phases
from core.multibody.phases.searches_in_phases import SearchInPhases
from core.multibody.phases.stretches import stretches
from core.multibody.phases.sums_in_phases import SumsInPhases
from core.multibody.start import accelerations_of, at_rest, energy_of, forces_of_start, noticed_of, scene_model
from core.multibody.trajectory.column_errors import relative, require_reached, scales_of, worst
from core.multibody.trajectory.occurrences import ExtremesOf, When
from core.multibody.trajectory.trajectories import ONLY_SUMS, SceneRequest, require_affordable
from core.systems.methods.closed_form import ClosedFormEvaluation
from core.systems.question import MotionQuestion
from core.systems.trajectory import HORIZON, Accuracy, Column, How, Trajectory, Work

THRESHOLDS = "thresholds"
"""Place of a question about rest among the outputs: it is answered apart from the motion."""
_NO_HORIZON = "how long a motion through events stays within the accuracy is not looked for"


def answer_in_phases(scene: Scene, request: SceneRequest) -> SceneSolution:
    """Answer a question about a scene with contacts, or with strings that are slack at times.

    Raises
    ------
    InvalidParameter
        For a scene that cannot be, and for times before the start.
    NotApplicable
        For methods, and for equilibria.
    AccuracyUnreachable, BudgetExceeded
        As `core.multibody.solve.solve_scene`.
    """
    if request.method is not None:
        raise NotApplicable(
            "a scene with contacts is answered by its own phases, each with the smallest model that suffices",
            path=("method",),
            remedy="leave the method out",
        )
    if "equilibria" in request.outputs:
        raise NotApplicable(
            "equilibria are not answered where something may touch, slide or be slack",
            path=("outputs", list(request.outputs).index("equilibria")),
            remedy='ask between which values of a number it stays at rest: {"thresholds": {"vary", "between"}}',
        )
    before = np.flatnonzero(request.times < 0.0)
    if len(before):
        raise InvalidParameter(
            ("times", int(before[0])), "be at least 0: contacts and impacts do not say what was before the start"
        )
    end = float(np.max(request.times, initial=0.0))
    motion = motion_in_phases(scene, end)
    count = len(motion.base.measures.table.names)
    noticed = _noticed(motion)
    system = PhasedSystem(scene, motion, request.outputs)
    trajectory = request.solved(system)
    occurrences, extremes = (None, None) if trajectory is None else system.searched(end)
    started = motion.phases[0] if motion.phases else None
    accelerations: Mapping[str, BodyAcceleration] = {}
    forces: Mapping[str, ForceAnswer] = {}
    if started is None:
        problem = motion.problem
        assert problem is not None, "a motion without phases has a problem"
        model = SceneModel("undecided", problem.explanation, 0, 0, count, 0, (count, 0), (), tuple(noticed))
    else:
        found = started.models[0]
        multipliers = multipliers_at_start(found.described.measures, found.whole.acceleration)
        values = forces_at_start(found.described.measures, multipliers)
        noticed += noticed_of(found, values, multipliers)
        resting = [set(at_rest(phase.models[0])) for phase in motion.phases]
        still = [name for name in at_rest(found) if all(name in names for names in resting)]
        if still:
            last = end if motion.ended is None else motion.ended.time
            noticed.append(f"until {last:g} s nothing moves {', '.join(still)}")
        model = scene_model(found, noticed, multipliers.rank)
        accelerations = accelerations_of(found.described, found.whole.acceleration)
        forces = forces_of_start(found.described, values)
    outputs = request.outputs
    return SceneSolution(
        model,
        accelerations if "accelerations" in outputs else None,
        forces if "forces" in outputs else None,
        replace(energy_of(motion.base), conserved=_conserved(motion)) if "energy" in outputs else None,
        trajectory,
        None,
        None,
        tuple(motion.events),
        motion.ended,
        occurrences,
        extremes,
        phases=tuple(_phase_in_answer(phase, motion) for phase in motion.phases),
        problem=_problem(motion),
    )


def _conserved(motion: PhaseMotion) -> bool:
    """Return whether nothing works on a scene, no impact costs energy, and nothing slides with friction."""
    return (
        motion.base.measures.conservative
        and not any(event.energy_loss for event in motion.events)
        and not any(
            state.sense and one.kinetic
            for phase in motion.phases
            for one, state in zip(motion.unilateral, phase.states, strict=True)
        )
    )


def _noticed(motion: PhaseMotion) -> list[str]:
    return list(dict.fromkeys(motion.noticed))


def _phase_in_answer(phase: Phase, motion: PhaseMotion) -> MotionPhase:
    model = phase.models[0]
    names = list(dict.fromkeys(part.name for _, part in model.whole.parts))
    if phase.bounces is not None:
        name, why = (
            "accumulating bounces",
            "every bounce is the one before it on a smaller scale: their sums are geometric",
        )
    elif not names:
        name, why = "rest", "the connections and contacts hold everything where it is"
    elif len(names) == 1:
        name, why = names[0], model.whole.parts[0][1].why
    else:
        name, why = "parts apart", "the parts have no force or connection in common, and each has its own model"
    return MotionPhase(
        nearest(phase.start),
        None if phase.end is None else nearest(phase.end),
        name,
        why,
        sum(piece.freedom for piece in model.pieces),
        len(model.whole.reduced.table.names),
        {one.name: state.value for one, state in zip(motion.unilateral, phase.states, strict=True)},
    )


def _problem(motion: PhaseMotion) -> SceneProblem | None:
    problem = motion.problem
    if problem is None:
        return None
    assert motion.ended is not None
    return SceneProblem(
        problem.code,
        problem.explanation,
        motion.ended.time,
        problem.contacts,
        tuple(problem.candidates),
        problem.decided_by,
    )


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
            columns = _merged(pieces, len(times)) | self._sums(times, how)
            require_reached(columns, question.accuracy, before=_reached_until(pieces, times, question.accuracy))
            stated = Accuracy(question.accuracy, worst(columns), how)
            if question.input_uncertainty is not None and len(times):
                end = float(np.max(question.times))
                columns, stated = self._with_inherited(times, columns, stated, question.input_uncertainty, end)
        scales = scales_of(columns)
        return Trajectory(
            times,
            {name: replace(column, scale=scales[name]) for name, column in columns.items()},
            stated,
            None,
            ClosedFormEvaluation().kind,
            Work(len(times)),
            ended=HORIZON if motion.ended is None else motion.ended.kind,
            rows=rows,
            events=motion.events,
        )

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
            return _merged(self._pieces(other, times)[0], len(times))

        own = {name: columns[name] for name in columns_of(self.motion)}
        if not own:
            return columns, replace(stated, why=ONLY_SUMS)
        try:
            moved = inherited_in_phases(self.scene, self.motion, end, own, columns_of)
        except MechanicsError as fault:
            return columns, replace(stated, why=fault.detail)
        share = uncertainty * relative(moved, own)
        if not share < 1.0:
            return columns, replace(stated, why="nothing is known of the motion at the latest times")
        with_own = {name: replace(one, inherited=uncertainty * moved[name]) for name, one in own.items()}
        return columns | with_own, replace(stated, inherited=share, why=_NO_HORIZON)


def _reached_until(
    pieces: Sequence[tuple[np.ndarray, dict[str, Column]]], times: Floats, accuracy: float
) -> float | None:
    """Return the first of the times of a phase before which an accuracy is reached, None if it is at none or at all."""
    for k in range(len(pieces)):
        if worst(_merged(pieces[: k + 1], len(times))) > accuracy:
            return float(times[pieces[k][0][0]]) if k else None
    return None


def _merged(pieces: Sequence[tuple[np.ndarray, dict[str, Column]]], count: int) -> dict[str, Column]:
    """Return the columns of all phases in one; a force that one of them does not determine is left out."""
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
        found[name] = Column(values, first.unit, error, first.how)
    return found
