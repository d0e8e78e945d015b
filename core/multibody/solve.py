"""One question about a described scene, answered by the smallest model of each of its parts."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from typing import Any, Literal

import numpy as np

from core.balls import precision
from core.errors import BudgetExceeded, InvalidParameter, SlackAtStart
from core.multibody.answer import SceneAnswer, SceneEvent, SceneTrajectory
from core.multibody.dynamics import forces_at_start, multipliers_at_start
from core.multibody.equilibria import equilibria_of
from core.multibody.language import Scene
from core.multibody.modelling import modelled
from core.multibody.occurrences import ExtremesOf, When, check_search
from core.multibody.packed import Floats
from core.multibody.phase_answer import ANSWERED, THRESHOLDS, answer_in_phases
from core.multibody.phases import one_sided
from core.multibody.polynomials import BITS
from core.multibody.start import accelerations_of, at_rest, energy_of, forces_of_start, noticed_of, scene_model
from core.multibody.thresholds import RestOf, range_of_rest
from core.multibody.trajectories import AskedMotion, Searched, trajectory_of
from core.quantities import Uncertainty, check_value
from core.systems.budget import Budget
from core.systems.methods.method import AbstractMethod
from core.systems.rounding import Digits

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
OUTPUTS: tuple[Output, ...] = (
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
)
DEFAULT_OUTPUTS: tuple[Output, ...] = ("accelerations", "forces", "energy", "trajectory")

MOST_NUMBERS = 5_000_000
"""Numbers that one trajectory may have."""


def solve_scene(
    scene: Scene,
    times: Sequence[float] | Floats = (),
    outputs: Sequence[Output | When | ExtremesOf | RestOf] = DEFAULT_OUTPUTS,
    accuracy: float = 1e-9,
    *,
    method: AbstractMethod | None = None,
    input_uncertainty: float | None = None,
    digits: Digits | None = None,
    budget: Budget | None = None,
) -> SceneAnswer:
    """Answer a question about a scene.

    Parameters
    ----------
    scene : Scene
    times : sequence of float
        Seconds from the given state, of either sign and in any order.
    outputs : sequence of str, When, ExtremesOf and RestOf
        Some of `OUTPUTS`, what is to be searched between the start and the latest time, and of which numbers the range
        is wanted in which the scene stays at rest.
    accuracy : float
        Largest error of any column, relative to its largest value, that is tolerated.
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
        For a scene that cannot be, with the path to the fault.
    AccuracyUnreachable
        Where neither doubles nor pairs of doubles reach the accuracy.
    BudgetExceeded
        Where it would take more steps, evaluations or samples than one question may.
    NotApplicable
        Where the method does not exist for scenes.
    """
    moments = _times(times)
    for i, output in enumerate(outputs):
        if isinstance(output, (When, ExtremesOf)):
            check_search(output, i)
            if not np.max(moments, initial=0.0) > 0.0:
                raise InvalidParameter("times", "reach beyond the start, up to where a quantity is to be searched for")
        elif not isinstance(output, RestOf) and (not isinstance(output, str) or output not in OUTPUTS):
            raise InvalidParameter(("outputs", i), f"be one of {', '.join(OUTPUTS)}")
    if not isinstance(accuracy, (int, float)) or not 0.0 < accuracy < 1.0:
        raise InvalidParameter("accuracy", "be greater than 0 and less than 1")
    if input_uncertainty is not None:
        check_value("input_uncertainty", Uncertainty, input_uncertainty)
    of_motion = [output if not isinstance(output, RestOf) else THRESHOLDS for output in outputs]
    asked = AskedMotion(moments, of_motion, float(accuracy), method, input_uncertainty, digits, budget or Budget())
    with precision(BITS):
        ranges = [
            range_of_rest(scene, output, ("outputs", i, "thresholds"))
            for i, output in enumerate(outputs)
            if isinstance(output, RestOf)
        ]
        return replace(_solve(scene, asked), thresholds=tuple(ranges) or None)


def _times(times: Any) -> Floats:
    try:
        moments = np.array(times, dtype=np.float64)
    except (TypeError, ValueError, OverflowError):
        raise InvalidParameter("times", "be a list of numbers") from None
    if moments.ndim != 1:
        raise InvalidParameter("times", "be a list of numbers")
    bad = np.flatnonzero(~np.isfinite(moments))
    if len(bad):
        raise InvalidParameter(("times", int(bad[0])), "be finite")
    return moments


def _solve(scene: Scene, asked: AskedMotion) -> SceneAnswer:
    if one_sided(scene):
        return answer_in_phases(scene, asked)
    try:
        found = modelled(scene)
    except SlackAtStart:
        if asked.method is not None:
            raise
        return answer_in_phases(scene, asked)
    table, outputs = found.described.measures.table, asked.outputs
    if len(asked.times) * 4 * len(table.names) > MOST_NUMBERS:
        most = MOST_NUMBERS // (4 * len(table.names))
        raise BudgetExceeded("samples", len(asked.times), most, path=("times",), remedy="ask for fewer times")
    multipliers = multipliers_at_start(found.described.measures, found.whole.acceleration)
    forces = forces_at_start(found.described.measures, multipliers)
    noticed = noticed_of(found, forces, multipliers)
    still = at_rest(found)
    if still:
        noticed.append(f"nothing ever moves {', '.join(still)}")
    model = scene_model(found, noticed, multipliers.rank)
    trajectory: SceneTrajectory | None = None
    events: tuple[SceneEvent, ...] = ()
    searched = Searched()
    if len(asked.times):
        determined = [value.value is not None for value in forces]
        trajectory, events, searched = trajectory_of(scene, found, determined, asked)
    if any(event.kind == "slack" and event.time >= 0.0 for event in events) and _has_phases(asked):
        # Slack strings become taut again: the scene has further phases.
        return answer_in_phases(scene, asked)
    motions = found.whole.parts
    periods = [motion.period for _, motion in motions if motion.name != "rest"]
    single = periods[0] if len(periods) == 1 else None
    return SceneAnswer(
        model,
        accelerations_of(found.described, found.whole.acceleration) if "accelerations" in outputs else None,
        forces_of_start(found.described, forces) if "forces" in outputs else None,
        energy_of(found.described) if "energy" in outputs else None,
        trajectory,
        None if single is None else float(single),
        equilibria_of(found.described) if "equilibria" in outputs else None,
        events,
        next((event for event in events if event.time >= 0.0), None),
        searched.occurrences,
        searched.extremes,
    )


def _has_phases(asked: AskedMotion) -> bool:
    """Return whether what is asked can be answered through events."""
    forward = bool(np.min(asked.times) >= 0.0)
    return forward and asked.method is None and all(output in (*ANSWERED, THRESHOLDS) for output in asked.outputs)
