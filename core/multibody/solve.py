"""One question about a described scene, answered by the smallest model of each of its parts."""

from __future__ import annotations

from collections.abc import Sequence, Sized
from dataclasses import replace
from typing import Literal, get_args

import numpy as np

from core.arrays import Floats
from core.balls import precision
from core.errors import InvalidParameter, SelfCheckFailed, SlackAtStart
from core.multibody.algebra.doubles import error_in_doubles
from core.multibody.algebra.polynomials import BITS
from core.multibody.answer import SceneSolution
from core.multibody.audit.audit import audited
from core.multibody.equations.dynamics import forces_at_start, multipliers_at_start
from core.multibody.language.scene import Scene
from core.multibody.model_answer import PartErrors, PartModel
from core.multibody.motion.modelling import modelled
from core.multibody.parts.joined_answer import answered_by_parts
from core.multibody.phases.phase_answer import THRESHOLDS, answer_in_phases
from core.multibody.phases.phased_system import PhasedSystem
from core.multibody.phases.phases import one_sided
from core.multibody.start import (
    accelerations_of,
    at_rest,
    energy_of,
    forces_of_start,
    lost_at_start,
    noticed_of,
    scene_model,
    slack_strings,
)
from core.multibody.statics.equilibria import equilibria_of
from core.multibody.statics.thresholds import RestOf, range_of_rest
from core.multibody.table.chains import has_chain
from core.multibody.trajectory.occurrences import ExtremesOf, When, check_search, not_taken
from core.multibody.trajectory.trajectories import DescribedSystem, SceneRequest
from core.near_names import did_you_mean
from core.quantities import Tolerance, Uncertainty, check_value
from core.systems.budget import Budget
from core.systems.methods.method import AbstractMethod
from core.systems.rounding import Digits
from core.systems.solve import check_without_times, checked_times
from core.systems.trajectory import MotionEvent, Trajectory

Output = Literal[
    "accelerations",
    "forces",
    "energy",
    "trajectory",
    "forces-in-time",
    "energy-in-time",
    "momenta-in-time",
    "work-in-time",
    "paths-in-time",
    "equilibria",
]
OUTPUTS: tuple[Output, ...] = get_args(Output)
OF_MOTION: tuple[Output, ...] = ("trajectory", *(name for name in OUTPUTS if name.endswith("-in-time")))
"""What needs times."""
DEFAULT_OUTPUTS: tuple[Output, ...] = ("accelerations", "forces", "energy", "trajectory")


def solve_scene(
    scene: Scene,
    times: Sequence[float] | Floats = (),
    outputs: Sequence[Output | When | ExtremesOf | RestOf] | None = None,
    accuracy: float = 1e-9,
    *,
    method: AbstractMethod | None = None,
    input_uncertainty: float | None = None,
    digits: Digits | None = None,
    budget: Budget | None = None,
) -> SceneSolution:
    """Answer a question about a scene.

    Parameters
    ----------
    scene : Scene
    times : sequence of float
        Seconds from the given state, of either sign and in any order.
    outputs : sequence of str, When, ExtremesOf and RestOf, optional
        Some of `OUTPUTS`, by default `DEFAULT_OUTPUTS`; what is to be searched between the start and the latest time;
        and of which numbers the range is wanted in which the scene stays at rest.
    accuracy : float
        Largest error of any column, relative to the largest value in columns of its unit, that is tolerated.
    method : AbstractMethod, optional
        Computes the motion in place of the smallest model, and is answered whatever its error, with a warning where
        that is larger than the accuracy. Events are those of the motion itself.
    input_uncertainty : float, optional
        Relative uncertainty of every number of the description; if given, what it does to the samples is answered.
    digits : int or "meaningful", optional
        Of the samples; as many as doubles have if omitted.
    budget : Budget, optional
        Evaluations that the method may spend.

    Raises
    ------
    InvalidParameter
        For a scene that cannot be, with the path to the fault; for what only a motion has, without times.
    AccuracyUnreachable
        Where neither doubles nor pairs of doubles reach the accuracy.
    BudgetExceeded
        Where it would take more steps, evaluations or samples than one question may.
    NotApplicable
        Where the method does not exist for scenes.
    SelfCheckFailed
        Where the answer that was found does not keep the laws of mechanics: see `core.multibody.audit`.
    """
    budget = budget or Budget()
    check_value("accuracy", Tolerance, accuracy)
    if input_uncertainty is not None:
        check_value("input_uncertainty", Uncertainty, input_uncertainty)
    empty = isinstance(times, Sized) and len(times) == 0
    moments = np.zeros(0) if empty else checked_times(times, budget)
    if empty:
        check_without_times(method=method, round=digits)
        for output in outputs or ():
            if output in OF_MOTION:
                raise InvalidParameter("times", f"be given where {output} is requested")
    outputs = DEFAULT_OUTPUTS if outputs is None else outputs
    for i, output in enumerate(outputs):
        if isinstance(output, (When, ExtremesOf)):
            check_search(output, i)
            if not np.max(moments, initial=0.0) > 0.0:
                raise InvalidParameter("times", "reach beyond the start, up to where a quantity is to be searched for")
        elif not isinstance(output, RestOf) and (not isinstance(output, str) or output not in OUTPUTS):
            raise InvalidParameter(
                ("outputs", i), f"be one of {', '.join(OUTPUTS)}", remedy=did_you_mean(output, OUTPUTS)
            )
    of_motion = [output if not isinstance(output, RestOf) else THRESHOLDS for output in outputs]
    request = SceneRequest(moments, of_motion, float(accuracy), method, input_uncertainty, digits, budget)
    with precision(BITS):
        ranges = [
            range_of_rest(scene, output, ("outputs", i, "thresholds"))
            for i, output in enumerate(outputs)
            if isinstance(output, RestOf)
        ]
        answer = answered_by_parts(scene, request, _checked)
        return replace(answer, trajectory=_with_notices(answer, request), thresholds=tuple(ranges) or None)


def _with_notices(answer: SceneSolution, request: SceneRequest) -> Trajectory | None:
    """Return the trajectory of an answer, with notices of what was searched for in vain."""
    motion = answer.trajectory
    if motion is None or answer.occurrences is None:
        return motion
    end = float(np.max(request.times))
    end = end if answer.ended is None else min(end, answer.ended.time)
    return replace(motion, warnings=(*motion.warnings, *not_taken(request.outputs, answer.occurrences, end)))


def _checked(scene: Scene, request: SceneRequest) -> SceneSolution:
    """Answer a question about a scene as one part, and check the answer against the description."""
    answer, system = _answered(scene, request)
    failure = audited(scene, answer, system.sampled, request.times) if request.budget.audited else None
    if failure is not None:
        raise SelfCheckFailed(failure.law, failure.connection, failure.time, failure.residual, failure.allowed)
    return answer


def _answered(scene: Scene, request: SceneRequest) -> tuple[SceneSolution, DescribedSystem | PhasedSystem]:
    """Return the answer to a question about a scene as one part, and the motion that it is from."""
    if one_sided(scene):
        return answer_in_phases(scene, request)
    try:
        found = modelled(scene)
    except SlackAtStart:
        if request.method is not None or has_chain(scene):
            raise
        return answer_in_phases(scene, request)
    multipliers = multipliers_at_start(found.described.measures, found.whole.acceleration)
    forces = forces_at_start(found.described.measures, multipliers)
    if slack_strings(found, forces) and request.method is None and not has_chain(scene):
        return answer_in_phases(scene, request)
    noticed = noticed_of(found, forces, multipliers)
    still = at_rest(found)
    if still:
        noticed.append(f"constant throughout the motion: {', '.join(still)}")
    model = scene_model(found, noticed, multipliers.rank)
    system = DescribedSystem(scene, found, [value.value is not None for value in forces], request.outputs)
    trajectory = request.solved(system)
    events: Sequence[MotionEvent] = lost_at_start(found, forces) if trajectory is None else trajectory.events
    if any(event.kind == "slack" and event.time >= 0.0 for event in events) and _has_phases(scene, request):
        # Slack strings become taut again: the scene has further phases.
        return answer_in_phases(scene, request)
    searched = None if trajectory is None else system.searched(trajectory, request.times)
    motions, outputs = found.whole.parts, request.outputs
    periods = [motion.period for _, motion in motions if motion.moves]
    single = periods[0] if len(periods) == 1 else None
    if single is not None and system.ends_within(float(single)):
        # What would repeat comes to an end, or its strings to another phase, before it does.
        single, model = None, replace(model, apart=tuple(map(_without_period, model.apart)))
    answer = SceneSolution(
        model,
        accelerations_of(found.described, found.whole.acceleration) if "accelerations" in outputs else None,
        forces_of_start(found.described, forces) if "forces" in outputs else None,
        energy_of(found.described) if "energy" in outputs else None,
        trajectory,
        None if single is None else float(single),
        None if single is None else error_in_doubles(single),
        equilibria_of(found.described) if "equilibria" in outputs else None,
        tuple(events),
        next((event for event in events if event.time >= 0.0), None),
        *((None, None) if searched is None else searched),
    )
    return answer, system


def _without_period(part: PartModel) -> PartModel:
    return replace(part, period=None, precession=None, errors=PartErrors(None, None))


def _has_phases(scene: Scene, request: SceneRequest) -> bool:
    """Return whether what is requested of a scene can be answered through events."""
    if has_chain(scene):
        return False
    forward = bool(np.min(request.times) >= 0.0)
    return forward and request.method is None and "equilibria" not in request.outputs
