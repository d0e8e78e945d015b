"""What is answered about a scene: its start, phases and events, and its motion through them."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from itertools import zip_longest

from core.errors import NotApplicable, SlackAtStart, inside_field
from core.multibody.answer import BodyAcceleration, ForceAnswer, MotionPhase, SceneProblem, SceneSolution
from core.multibody.equations.packed import nearest
from core.multibody.equations_answer import SceneEquations
from core.multibody.formulation.scene_equations import equations_of
from core.multibody.language.scene import Scene
from core.multibody.model_answer import PartErrors, PartModel, SceneModel
from core.multibody.motion.modelling import modelled
from core.multibody.phases.before_start import follow_backwards
from core.multibody.phases.described_system import DescribedSystem
from core.multibody.phases.phase import Phase, PhaseMotion
from core.multibody.phases.phases import motion_in_phases
from core.multibody.phases.smooth_motion import ends_within, smooth_motion
from core.multibody.phases.tracks import late
from core.multibody.start import (
    accelerations_of,
    at_rest,
    energy_of,
    forces_of_start,
    name_of_parts,
    noticed_of,
    scene_model,
    slack_strings,
)
from core.multibody.statics.equilibria import equilibria_of
from core.multibody.table.description import Described
from core.multibody.trajectory.scene_request import SceneRequest

THRESHOLDS = "thresholds"
"""Place of a question about rest among the outputs: it is answered apart from the motion."""


def answered(scene: Scene, request: SceneRequest) -> tuple[SceneSolution, DescribedSystem]:
    """Return the answer to a question about a scene as one part, and the motion that it is from.

    Raises
    ------
    InvalidParameter
        For a scene that cannot be.
    NotApplicable
        For methods and equilibria where something is unilateral.
    AccuracyUnreachable, BudgetExceeded
        As `core.multibody.solve.solve_scene`.
    """
    motion = _motion_of(scene, request)
    system = DescribedSystem(scene, motion, request.outputs)
    # What is refused of these is refused before samples are computed.
    equations = _equations(scene, motion, request) if "equations" in request.outputs else None
    if request.method is None:
        system.require_answerable(request.times, request.accuracy)
    trajectory = request.solved(system)
    occurrences, extremes = (None, None) if trajectory is None else system.searched(request.times, request.accuracy)
    last = float(request.times.max(initial=0.0))
    model, accelerations, forces = _start_of(motion, last)
    outputs = request.outputs
    periods = [part.period for part in model.apart if part.period is not None]
    if periods and ends_within(motion, max(periods), last):
        # What would repeat comes to an end, or its strings to another phase, before it does.
        model = replace(model, apart=tuple(map(_without_period, model.apart)))
    # Of a motion through phases it is not stated.
    repeats = model.repeats if motion.smooth else None
    answer = SceneSolution(
        model,
        accelerations if "accelerations" in outputs else None,
        forces if "forces" in outputs else None,
        replace(energy_of(_first(motion)), conserved=_conserved(motion)) if "energy" in outputs else None,
        trajectory,
        None if repeats is None else repeats.period,
        None if repeats is None or repeats.errors is None else repeats.errors.period,
        equilibria_of(motion.base) if "equilibria" in outputs else None,
        tuple(motion.events),
        motion.ended,
        occurrences,
        extremes,
        phases=None
        if motion.smooth
        else tuple(
            _phase_in_answer(phase, following, motion)
            for phase, following in zip_longest(motion.phases, motion.phases[1:])
        ),
        problem=_problem(motion),
        equations=equations,
    )
    return answer, system


def _first(motion: PhaseMotion) -> Described:
    """Return the scene with the state of its start: that after blows which fall there."""
    struck = motion.base.scene.changes and motion.phases
    return motion.phases[0].models[0].described if struck else motion.base


def _equations(scene: Scene, motion: PhaseMotion, request: SceneRequest) -> SceneEquations | None:
    """Return the equations of the first phase of a motion, None where mechanics does not decide which it is."""
    if not motion.phases:
        return None
    with inside_field("outputs", list(request.outputs).index("equations")):
        return equations_of(motion.phases[0].models[0], [*scene.let, *scene.bodies])


def _motion_of(scene: Scene, request: SceneRequest) -> PhaseMotion:
    """Return the motion of a scene: through events where something is unilateral, or a string is slack at times."""
    passes = request.method is None and scene.continues
    if scene.one_sided or scene.changes or (passes and scene.switches and "equilibria" not in request.outputs):
        return _in_phases(scene, request)
    try:
        found = modelled(scene)
    except SlackAtStart:
        if not passes:
            raise
        return _in_phases(scene, request)
    motion = smooth_motion(found, request.times)
    if passes and slack_strings(found, motion.phases[0].start_forces[1]):
        return _in_phases(scene, request)
    slack = any(event.kind == "slack" and event.time >= 0.0 for event in motion.events)
    # Slack strings become taut again: the scene has further phases.
    if slack and passes and "equilibria" not in request.outputs:
        return _in_phases(scene, request)
    return motion


def _without_period(part: PartModel) -> PartModel:
    return replace(part, period=None, precession=None, errors=PartErrors(None, None))


def _in_phases(scene: Scene, request: SceneRequest) -> PhaseMotion:
    _require_answerable(request)
    motion = motion_in_phases(scene, float(request.times.max(initial=0.0)))
    if motion.phases:
        follow_backwards(motion, request.times)
    return motion


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
    multipliers, values = motion.phases[0].start_forces
    noticed += noticed_of(found, values, multipliers)
    resting = [set(at_rest(phase.models[0])) for phase in motion.phases]
    still = [name for name in at_rest(found) if all(name in names for names in resting)]
    if still:
        last = end if motion.ended is None else motion.ended.time
        names, when = ", ".join(still), f"until {last:g} s" if last > 0.0 else "at the start"
        noticed.append(f"constant throughout the motion: {names}" if motion.smooth else f"at rest {when}: {names}")
    return (
        scene_model(found, noticed, multipliers),
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
    name, why = name_of_parts([part for _, part in model.moving])
    if phase.bounces is not None:
        name = "accumulating bounces"
        why = "every bounce is the one before it on a smaller scale: their sums are geometric"
    elif not model.moving:
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
        sum(piece.freedom for piece, _ in model.moving),
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
