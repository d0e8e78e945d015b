"""What is answered about a scene with unilateral measures: its start, phases and events, its motion through them."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from itertools import zip_longest

import numpy as np

from core.errors import InvalidParameter, NotApplicable
from core.multibody.answer import BodyAcceleration, ForceAnswer, MotionPhase, SceneProblem, SceneSolution
from core.multibody.equations.dynamics import forces_at_start, multipliers_at_start
from core.multibody.equations.packed import nearest
from core.multibody.language.scene import Scene
from core.multibody.model_answer import SceneModel
from core.multibody.phases.phase import Phase, PhaseMotion
from core.multibody.phases.phased_system import PhasedSystem
from core.multibody.phases.phases import motion_in_phases
from core.multibody.phases.tracks import late
from core.multibody.start import (
    accelerations_of,
    at_rest,
    energy_of,
    forces_of_start,
    name_of_parts,
    noticed_of,
    scene_model,
)
from core.multibody.trajectory.trajectories import SceneRequest

THRESHOLDS = "thresholds"
"""Place of a question about rest among the outputs: it is answered apart from the motion."""


def answer_in_phases(scene: Scene, request: SceneRequest) -> tuple[SceneSolution, PhasedSystem]:
    """Answer a question about a scene with contacts, or with strings that are slack at times, by its motion.

    Raises
    ------
    InvalidParameter
        For a scene that cannot be, and for times before the start.
    NotApplicable
        For methods, and for equilibria.
    AccuracyUnreachable, BudgetExceeded
        As `core.multibody.solve.solve_scene`.
    """
    _require_answerable(request)
    end = float(np.max(request.times, initial=0.0))
    motion = motion_in_phases(scene, end)
    system = PhasedSystem(scene, motion, request.outputs)
    trajectory = request.solved(system)
    occurrences, extremes = (None, None) if trajectory is None else system.searched(end)
    model, accelerations, forces = _start_of(motion, end)
    outputs = request.outputs
    answer = SceneSolution(
        model,
        accelerations if "accelerations" in outputs else None,
        forces if "forces" in outputs else None,
        replace(energy_of(motion.base), conserved=_conserved(motion)) if "energy" in outputs else None,
        trajectory,
        None,
        None,
        None,
        tuple(motion.events),
        motion.ended,
        occurrences,
        extremes,
        phases=tuple(
            _phase_in_answer(phase, following, motion)
            for phase, following in zip_longest(motion.phases, motion.phases[1:])
        ),
        problem=_problem(motion),
    )
    return answer, system


def _require_answerable(request: SceneRequest) -> None:
    """Raise what a question about a motion through phases is refused for."""
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


def _start_of(
    motion: PhaseMotion, end: float
) -> tuple[SceneModel, Mapping[str, BodyAcceleration], Mapping[str, ForceAnswer]]:
    """Return the model of the first phase of a motion up to `end`, and its accelerations and forces at the start."""
    noticed = list(dict.fromkeys(motion.noticed))
    if not motion.phases:
        problem, count = motion.problem, len(motion.base.measures.table.names)
        assert problem is not None, "a motion without phases has a problem"
        return SceneModel("undecided", problem.explanation, 0, 0, count, 0, (count, 0), (), tuple(noticed)), {}, {}
    found = motion.phases[0].models[0]
    multipliers = multipliers_at_start(found.described.measures, found.whole.acceleration)
    values = forces_at_start(found.described.measures, multipliers)
    noticed += noticed_of(found, values, multipliers)
    resting = [set(at_rest(phase.models[0])) for phase in motion.phases]
    still = [name for name in at_rest(found) if all(name in names for names in resting)]
    if still:
        last = end if motion.ended is None else motion.ended.time
        noticed.append(f"until {last:g} s nothing moves {', '.join(still)}")
    return (
        scene_model(found, noticed, multipliers.rank),
        accelerations_of(found.described, found.whole.acceleration),
        forces_of_start(found.described, values),
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


def _phase_in_answer(phase: Phase, following: Phase | None, motion: PhaseMotion) -> MotionPhase:
    model = phase.models[0]
    name, why = name_of_parts([part for _, part in model.whole.parts])
    if phase.bounces is not None:
        name = "accumulating bounces"
        why = "every bounce is the one before it on a smaller scale: their sums are geometric"
    elif not model.whole.parts:
        why = "the connections and contacts hold everything where it is"
    end_error = None
    if phase.end is not None and following is not None:
        end_error = late(following.tracks)
    elif phase.end is not None and motion.ended is not None:
        end_error = motion.ended.error
    return MotionPhase(
        nearest(phase.start),
        None if phase.end is None else nearest(phase.end),
        name,
        why,
        sum(piece.freedom for piece in model.pieces),
        len(model.whole.reduced.table.names),
        {one.name: state.value for one, state in zip(motion.unilateral, phase.states, strict=True)},
        {"start": late(phase.tracks), "end": end_error},
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
        motion.ended.error,
    )
