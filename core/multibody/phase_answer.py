"""What is answered about a scene with unilateral measures: its start, phases and events, its motion through them."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace

import numpy as np
from flint import arb

from core.errors import InvalidParameter, MechanicsError, NotApplicable
from core.multibody.answer import (
    BodyAcceleration,
    ForceAnswer,
    MotionPhase,
    SceneAnswer,
    SceneModel,
    SceneProblem,
)
from core.multibody.columns import Columns, Unknown, relative, require_reached, scales_of, worst
from core.multibody.dynamics import forces_at_start, multipliers_at_start
from core.multibody.inherited_in_phases import inherited_in_phases
from core.multibody.language import Scene
from core.multibody.packed import Floats, nearest, pair
from core.multibody.phase import Phase, PhaseMotion
from core.multibody.phases import motion_in_phases
from core.multibody.polynomials import Ball
from core.multibody.start import accelerations_of, at_rest, energy_of, forces_of_start, noticed_of, scene_model
from core.multibody.tracks import FLOOR, TOLD
from core.multibody.trajectories import Output, SceneRequest, require_affordable
from core.multibody.whole import WholeStates
from core.systems.methods.closed_form import ClosedFormEvaluation
from core.systems.question import MotionQuestion
from core.systems.trajectory import HORIZON, Accuracy, Column, How, Trajectory, Work

ANSWERED = ("accelerations", "forces", "energy", "trajectory", "forces-in-time", "energy-in-time", "momenta-in-time")
"""Outputs that are answered about scenes with contacts."""
THRESHOLDS = "thresholds"
"""Place of a question about rest among the outputs: it is answered apart from the motion."""
_NO_HORIZON = "how long a motion through events stays within the accuracy is not looked for"


def answer_in_phases(scene: Scene, request: SceneRequest) -> SceneAnswer:
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
    unknown = [i for i, output in enumerate(request.outputs) if output not in (*ANSWERED, "equilibria", THRESHOLDS)]
    if unknown:
        raise NotApplicable(
            f"of a scene with contacts these are answered: {', '.join(ANSWERED)}",
            path=("outputs", unknown[0]),
            remedy=_instead_of(request.outputs[unknown[0]]),
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
    trajectory = request.solved(PhasedSystem(scene, motion, request.outputs))
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
        still = [name for name in at_rest(found) if all(name in at_rest(phase.models[0]) for phase in motion.phases)]
        if still:
            last = end if motion.ended is None else motion.ended.time
            noticed.append(f"until {last:g} s nothing moves {', '.join(still)}")
        model = scene_model(found, noticed, multipliers.rank)
        accelerations = accelerations_of(found.described, found.whole.acceleration)
        forces = forces_of_start(found.described, values)
    outputs = request.outputs
    return SceneAnswer(
        model,
        accelerations if "accelerations" in outputs else None,
        forces if "forces" in outputs else None,
        replace(energy_of(motion.base), conserved=_conserved(motion)) if "energy" in outputs else None,
        trajectory,
        None,
        None,
        tuple(motion.events),
        motion.ended,
        phases=tuple(_told(phase, motion) for phase in motion.phases),
        problem=_problem(motion),
    )


def _instead_of(output: Output) -> str:
    """Return what answers most of a question that is not answered about scenes with contacts."""
    if output == "work-in-time":
        return "ask for energy-in-time: what it and the energy_loss of the events leave over is the work on the scene"
    if output == "paths-in-time":
        return "ask for the trajectory at enough times: between the events, which are listed, paths are smooth"
    return "ask for the trajectory at enough times; touches, slips and stops are events, found without being requested"


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


def _told(phase: Phase, motion: PhaseMotion) -> MotionPhase:
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
            columns = _merged(pieces, len(times))
            lost = next((float(times[mine[0]]) for mine, own in pieces if worst(own) > question.accuracy), None)
            require_reached(columns, question.accuracy, before=lost)
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

    def _pieces(self, motion: PhaseMotion, times: Floats) -> tuple[list[tuple[np.ndarray, dict[str, Column]]], How]:
        """Return the columns of every phase, with the numbers of the times in it, and how their errors are known."""
        phases = motion.phases
        which = np.array([_phase_at(phases, float(t)) for t in times], dtype=np.int64)
        exact = all(_closed(phases[k]) for k in range(int(np.max(which, initial=0)) + 1)) if phases else True
        how: How = "closed form" if exact else "measured against pairs"
        pieces: list[tuple[np.ndarray, dict[str, Column]]] = []
        for k in sorted(set(which.tolist())) or ([0] if phases else []):
            mine = np.flatnonzero(which == k)
            states = _states(phases[k], times[mine], motion)
            pieces.append((mine, _columns(phases[k], times[mine], states, how, self.outputs)))
        return pieces, how

    def _with_inherited(
        self, times: Floats, columns: dict[str, Column], stated: Accuracy, uncertainty: float, end: float
    ) -> tuple[dict[str, Column], Accuracy]:
        """Add what the uncertainty of the inputs does, or why that is not known."""

        def columns_of(other: PhaseMotion) -> dict[str, Column]:
            return _merged(self._pieces(other, times)[0], len(times))

        try:
            moved = inherited_in_phases(self.scene, self.motion, end, columns, columns_of)
        except MechanicsError as fault:
            return columns, replace(stated, why=fault.detail)
        share = uncertainty * relative(moved, columns)
        if not share < 1.0:
            return columns, replace(stated, why="nothing is known of the motion at the latest times")
        with_own = {name: replace(one, inherited=uncertainty * moved[name]) for name, one in columns.items()}
        return with_own, replace(stated, inherited=share, why=_NO_HORIZON)


def _closed(phase: Phase) -> bool:
    return len(phase.tracks) == 1 and all(part.how == "closed form" for _, part in phase.models[0].whole.parts)


def _phase_at(phases: Sequence[Phase], time: float) -> int:
    """Return in which phase a time is; at an event it is in the one that begins."""
    low, high = 0, len(phases) - 1
    while low < high:
        middle = (low + high + 1) // 2
        if arb(time) < phases[middle].start:
            high = middle - 1
        else:
            low = middle
    return low


def _states(phase: Phase, times: Floats, motion: PhaseMotion) -> WholeStates:
    """Return the states of a phase, with what its tracks differ by."""
    if phase.bounces is not None:
        return _bouncing(phase, times)
    found = [_of_track(phase, k, times) for k in range(len(phase.tracks))]
    first = found[0]
    floor_q, floor_v = (
        FLOOR * np.max(np.abs(x[..., 0]), axis=1, initial=0.0, keepdims=True) for x in (first.q, first.v)
    )
    q_error, v_error = first.q_error + floor_q, first.v_error + floor_v
    unknown = _unknown(phase, times)
    if unknown is not None:
        q_error, v_error = q_error + unknown[0], v_error + unknown[1]
    reference = first.reference
    if len(found) > 1:
        other = found[1]
        reference = (other.q, other.v) if other.reference is None else other.reference
        q_error = q_error + TOLD * np.abs((first.q - reference[0]).sum(axis=2))
        v_error = v_error + TOLD * np.abs((first.v - reference[1]).sum(axis=2))
    return WholeStates(first.q, first.v, q_error, v_error, reference)


def _unknown(phase: Phase, times: Floats) -> Unknown | None:
    """Return by how much coordinates and rates are wrong on all tracks alike, None where they are not."""
    if phase.unknown is None or phase.bounces is not None:
        return None
    moves = np.array([not still for still in phase.still])
    places, rates = np.array(phase.unknown[0]), np.array(phase.unknown[1]) * moves
    late = np.array([max(float(arb(float(t)) - phase.start), 0.0) for t in times])
    return places + np.outer(late, rates), np.broadcast_to(rates, (len(times), len(rates)))


def _of_track(phase: Phase, k: int, times: Floats) -> WholeStates:
    """Return the states of one track at times since the start of the scene."""
    whole, start = phase.models[k].whole, phase.tracks[k].time
    pairs = [pair(arb(float(t)) - start, 0) for t in times]
    late = np.maximum(np.array([p[0] for p in pairs]), 0.0) if pairs else np.zeros(0)
    rest = np.array([p[1] if p[0] > 0.0 else 0.0 for p in pairs])
    states = whole.states(late)
    if not np.any(rest):
        return states
    q, v = _later(phase, k, states.q, states.v, rest)
    reference = None if states.reference is None else _later(phase, k, *states.reference, rest)
    return WholeStates(q, v, states.q_error, states.v_error, reference)


def _later(phase: Phase, k: int, q: Floats, v: Floats, rest: Floats) -> tuple[Floats, Floats]:
    """Return states later by the tails of times: so small that one term of the Taylor series is right to pairs."""
    gain = phase.models[k].whole.accelerations(q, v)
    return _added(q, rest[:, None] * v[..., 0]), _added(v, rest[:, None] * gain)


def _added(pairs: Floats, more: Floats) -> Floats:
    """Return pairs of doubles with something small added."""
    high = pairs[..., 0] + more
    # What the first sum rounds off (Knuth), with the tail.
    part = high - pairs[..., 0]
    low = (pairs[..., 0] - (high - part)) + (more - part) + pairs[..., 1]
    total = high + low
    return np.stack([total, low - (total - high)], axis=-1)


def _bouncing(phase: Phase, times: Floats) -> WholeStates:
    assert phase.bounces is not None
    count = len(phase.tracks[0].q)
    q, v = np.zeros((len(times), count, 2)), np.zeros((len(times), count, 2))
    errors = np.zeros((2, len(times), count))
    for s, t in enumerate(times):
        late: Ball = arb(float(t)) - phase.start
        for k, (vector, out) in enumerate(zip(phase.bounces.at(late), (q, v), strict=True)):
            for i, x in enumerate(vector):
                out[s, i] = pair(x, 0)
                errors[k, s, i] = float(x.rad()) + FLOOR * abs(float(x))
    return WholeStates(q, v, errors[0], errors[1], None)


def _columns(
    phase: Phase, times: Floats, states: WholeStates, how: How, outputs: Sequence[object]
) -> dict[str, Column]:
    model = phase.models[0]
    determined: Sequence[bool] = ()
    if "forces-in-time" in outputs:
        measures = model.described.measures
        multipliers = multipliers_at_start(measures, model.whole.acceleration)
        determined = [force.value is not None for force in forces_at_start(measures, multipliers)]
    return Columns(model.whole, times, states, how, unknown=_unknown(phase, times)).chosen(outputs, determined)


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
