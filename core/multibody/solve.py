"""One question about a described scene, answered by the smallest model of each of its parts."""

from __future__ import annotations

from collections.abc import Sequence, Sized
from dataclasses import replace
from typing import Literal, get_args

import numpy as np

from core.arrays import Floats
from core.balls import precision
from core.errors import InvalidParameter, PlacesDisagree
from core.multibody.algebra.polynomials import BITS
from core.multibody.answer import SceneSolution
from core.multibody.assembly.assembled_scene import assembled
from core.multibody.assembly.nearest_that_fits import with_nearest
from core.multibody.audit.audit import audited
from core.multibody.audit.failure import require
from core.multibody.audit.nearest import audited_assembly
from core.multibody.audit.rest import audited_range
from core.multibody.language.numerals import Numerals
from core.multibody.language.scene import Scene, at_start
from core.multibody.parts.joined_answer import answered_by_parts
from core.multibody.phases.phase_answer import THRESHOLDS, answered
from core.multibody.statics.thresholds import RestOf, range_of_rest
from core.multibody.trajectory.events import searched_until
from core.multibody.trajectory.occurrences import (
    ExtremesOf,
    ValueSearch,
    When,
    checked_extremes,
    left_out,
    value_search,
)
from core.multibody.trajectory.scene_request import SceneRequest, require_affordable
from core.near_names import did_you_mean
from core.quantities import Tolerance, Uncertainty, check_value
from core.systems.budget import Budget
from core.systems.methods.method import AbstractMethod
from core.systems.rounding import Digits
from core.systems.solve import check_without_times, checked_times
from core.systems.trajectory import Trajectory

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
    "equations",
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
    require_affordable(len(moments), scene)
    if empty:
        check_without_times(method=method, round=digits)
        for output in outputs or ():
            if output in OF_MOTION:
                raise InvalidParameter("times", f"be given where {output} is requested")
    outputs = DEFAULT_OUTPUTS if outputs is None else outputs
    for i, output in enumerate(outputs):
        if isinstance(output, (When, ExtremesOf)):
            if not np.max(moments, initial=0.0) > 0.0:
                raise InvalidParameter("times", "reach beyond the start, up to where a quantity is to be searched for")
        elif not isinstance(output, RestOf) and (not isinstance(output, str) or output not in OUTPUTS):
            raise InvalidParameter(
                ("outputs", i), f"be one of {', '.join(OUTPUTS)}", remedy=did_you_mean(output, OUTPUTS)
            )
    found = assembled(scene)
    if found.assembly is not None and budget.audited:
        require(audited_assembly(scene, found.scene))
    with precision(BITS):
        of_motion = [_of_motion(output, i, scene) for i, output in enumerate(outputs)]
        request = SceneRequest(moments, of_motion, float(accuracy), method, input_uncertainty, digits, budget)
        ranges = [
            range_of_rest(at_start(scene), output, ("outputs", i, "thresholds"))
            for i, output in enumerate(outputs)
            if isinstance(output, RestOf)
        ]
        if scene.assemble is None and budget.audited:
            for found_range in ranges:
                require(audited_range(at_start(scene), found_range))
        try:
            answer = answered_by_parts(found.scene, request, _checked)
        except PlacesDisagree as fault:
            raise with_nearest(fault, found.scene) from fault
        return replace(
            answer,
            trajectory=_with_notices(answer, request),
            thresholds=tuple(ranges) or None,
            assembly=found.assembly,
        )


def _of_motion(output: str | When | ExtremesOf | RestOf, index: int, scene: Scene) -> str | ValueSearch | ExtremesOf:
    """Return what is to be computed of the motion for an output of a question."""
    if isinstance(output, When):
        return value_search(output, index, Numerals.of(scene.let, scene.numbers))
    if isinstance(output, ExtremesOf):
        return checked_extremes(output, index)
    return THRESHOLDS if isinstance(output, RestOf) else output


def _with_notices(answer: SceneSolution, request: SceneRequest) -> Trajectory | None:
    """Return the trajectory of an answer, with notices of what was searched for in vain or is left out."""
    motion = answer.trajectory
    if motion is None or answer.occurrences is None:
        return motion
    end = searched_until(float(np.max(request.times)), answer.ended)
    return replace(motion, warnings=(*motion.warnings, *left_out(request.outputs, answer.occurrences, end)))


def _checked(scene: Scene, request: SceneRequest) -> SceneSolution:
    """Answer a question about a scene as one part, and check the answer against the description."""
    answer, system = answered(scene, request)
    if request.budget.audited:
        verdict = audited(scene, answer, system.sampled, request.times)
        require(verdict.failure)
        answer = replace(answer, model=answer.model.with_noticed(verdict.noticed))
    return answer
