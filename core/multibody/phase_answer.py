"""What is answered about a scene with unilateral measures: its start, phases and events, its motion through them."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace

import numpy as np
from flint import arb

from core.errors import AccuracyUnreachable, BudgetExceeded, InvalidParameter, MechanicsError, NotApplicable
from core.multibody.answer import (
    BodyAcceleration,
    Column,
    ForceAnswer,
    How,
    SceneAccuracy,
    SceneAnswer,
    SceneModel,
    ScenePhase,
    SceneProblem,
    SceneTrajectory,
)
from core.multibody.columns import Columns, relative, worst
from core.multibody.dynamics import ForceAtStart, forces_at_start, multipliers_at_start
from core.multibody.inherited_in_phases import inherited_in_phases
from core.multibody.language import Scene
from core.multibody.modelling import Modelled
from core.multibody.packed import Floats, nearest, pair
from core.multibody.phase import Phase, PhaseMotion
from core.multibody.phases import motion_in_phases
from core.multibody.polynomials import Ball
from core.multibody.shortened import shortened
from core.multibody.start import accelerations_of, at_rest, energy_of, forces_of_start, noticed_of, scene_model
from core.multibody.tracks import FLOOR, TOLD
from core.multibody.trajectories import AskedMotion
from core.multibody.whole import WholeStates

MOST_NUMBERS = 5_000_000
ANSWERED = ("accelerations", "forces", "energy", "trajectory", "forces-in-time", "energy-in-time", "momenta-in-time")
"""Outputs that are answered about scenes with contacts."""
THRESHOLDS = "thresholds"
"""Place of a question about rest among the outputs: it is answered apart from the motion."""


def answer_in_phases(scene: Scene, asked: AskedMotion) -> SceneAnswer:
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
    if asked.method is not None:
        raise NotApplicable(
            "a scene with contacts is answered by its own phases, each with the smallest model that suffices",
            path=("method",),
            remedy="leave the method out",
        )
    unknown = [i for i, output in enumerate(asked.outputs) if output not in (*ANSWERED, "equilibria", THRESHOLDS)]
    if unknown:
        raise NotApplicable(
            f"of a scene with contacts these are answered: {', '.join(ANSWERED)}",
            path=("outputs", unknown[0]),
            remedy="leave it out; events are found without being asked for",
        )
    if "equilibria" in asked.outputs:
        raise NotApplicable(
            "equilibria are not answered where something may touch, slide or be slack",
            path=("outputs", list(asked.outputs).index("equilibria")),
            remedy="hold what touches by a connection of another kind",
        )
    before = np.flatnonzero(asked.times < 0.0)
    if len(before):
        raise InvalidParameter(
            ("times", int(before[0])), "be at least 0: contacts and impacts do not say what was before the start"
        )
    end = float(np.max(asked.times, initial=0.0))
    motion = motion_in_phases(scene, end)
    count = len(motion.base.measures.table.names)
    if len(asked.times) * 4 * count > MOST_NUMBERS:
        most = MOST_NUMBERS // (4 * count)
        raise BudgetExceeded("samples", len(asked.times), most, path=("times",), remedy="ask for fewer times")
    noticed = _noticed(motion)
    trajectory = None
    with np.errstate(over="ignore", invalid="ignore"):
        if len(asked.times):
            trajectory = _trajectory(motion, asked)
            if asked.input_uncertainty is not None:
                trajectory = _with_inherited(scene, motion, trajectory, asked)
            if asked.digits is not None:
                trajectory = shortened(trajectory, asked.digits)
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
    outputs = asked.outputs
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


def _told(phase: Phase, motion: PhaseMotion) -> ScenePhase:
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
    return ScenePhase(
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


def _trajectory(motion: PhaseMotion, asked: AskedMotion) -> SceneTrajectory:
    reached = list(range(len(asked.times)))
    if motion.ended is not None and motion.phases:
        ends = motion.phases[-1].end
        ends = arb(motion.ended.time) if ends is None else ends
        reached = [k for k, t in enumerate(asked.times) if not arb(float(t)) > ends]
    if not motion.phases:
        reached = []
    rows = np.array(reached, dtype=np.int64)
    times = asked.times[rows]
    pieces, how = _pieces(motion, times, asked.outputs)
    columns = _merged(pieces, len(times))
    bad = [name for name, one in columns.items() if not (np.isfinite(one.values).all() and np.isfinite(one.error))]
    if bad:
        raise NotApplicable(
            f"{bad[0]} or its error leaves the range of doubles", path=("times",), remedy="ask for a shorter time"
        )
    stated = SceneAccuracy(asked.accuracy, worst(columns), how)
    if stated.error > asked.accuracy:
        lost = next((float(times[mine[0]]) for mine, own in pieces if worst(own) > asked.accuracy), times[-1])
        raise AccuracyUnreachable(
            asked.accuracy,
            stated.error,
            "the motion amplifies rounding, even that of pairs of doubles",
            remedy=f"ask for times before {lost:.6g} s, or for a larger accuracy",
        )
    return SceneTrajectory(times, rows, columns, stated)


def _pieces(
    motion: PhaseMotion, times: Floats, outputs: Sequence[object]
) -> tuple[list[tuple[np.ndarray, dict[str, Column]]], How]:
    """Return the columns of every phase, with the numbers of the times in it, and how their errors are known."""
    which = np.array([_phase_at(motion.phases, float(t)) for t in times], dtype=np.int64)
    exact = all(_closed(motion.phases[k]) for k in range(int(np.max(which, initial=0)) + 1)) if motion.phases else True
    how: How = "closed form" if exact else "measured against pairs"
    pieces: list[tuple[np.ndarray, dict[str, Column]]] = []
    for k in sorted(set(which.tolist())) or ([0] if motion.phases else []):
        mine = np.flatnonzero(which == k)
        phase = motion.phases[k]
        states = _states(phase, times[mine], motion)
        pieces.append((mine, _columns(phase.models[0], times[mine], states, how, outputs)))
    return pieces, how


def _with_inherited(
    scene: Scene, motion: PhaseMotion, trajectory: SceneTrajectory, asked: AskedMotion
) -> SceneTrajectory:
    """Return a trajectory with what the uncertainty of the inputs does, or why that is not known."""
    uncertainty, times, columns = asked.input_uncertainty or 0.0, trajectory.time, dict(trajectory.columns)
    if not len(times):
        return trajectory

    def columns_of(other: PhaseMotion) -> dict[str, Column]:
        return _merged(_pieces(other, times, asked.outputs)[0], len(times))

    try:
        moved = inherited_in_phases(scene, motion, float(np.max(asked.times)), columns, columns_of)
    except MechanicsError as fault:
        return replace(trajectory, accuracy=replace(trajectory.accuracy, why=fault.detail))
    share = uncertainty * relative(moved, columns)
    if not share < 1.0:
        why = "nothing is known of the motion at the latest times"
        return replace(trajectory, accuracy=replace(trajectory.accuracy, why=why))
    with_own = {name: replace(one, inherited=uncertainty * moved[name]) for name, one in columns.items()}
    why = "how long a motion through events stays within the accuracy is not looked for"
    return replace(trajectory, columns=with_own, accuracy=replace(trajectory.accuracy, inherited=share, why=why))


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
    reference = first.reference
    if len(found) > 1:
        other = found[1]
        reference = (other.q, other.v) if other.reference is None else other.reference
        q_error = q_error + TOLD * np.abs((first.q - reference[0]).sum(axis=2))
        v_error = v_error + TOLD * np.abs((first.v - reference[1]).sum(axis=2))
    return WholeStates(first.q, first.v, q_error, v_error, reference)


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
    model: Modelled, times: Floats, states: WholeStates, how: How, outputs: Sequence[object]
) -> dict[str, Column]:
    columns = Columns(model.whole, times, states, how)
    found: dict[str, Column] = {}
    if "trajectory" in outputs:
        found.update(columns.trajectory())
    if "forces-in-time" in outputs:
        measures = model.described.measures
        multipliers = multipliers_at_start(measures, model.whole.acceleration)
        known: list[ForceAtStart] = forces_at_start(measures, multipliers)
        found.update(
            columns.forces([f for f, one in zip(measures.forces, known, strict=True) if one.value is not None])
        )
    if "energy-in-time" in outputs:
        found.update(columns.energy())
    if "momenta-in-time" in outputs:
        found.update(columns.momenta())
    return found


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
