"""One question about a described scene, answered by the smallest model of each of its parts."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any, Literal

import numpy as np

from core.balls import precision
from core.errors import BudgetExceeded, InvalidParameter
from core.multibody.answer import (
    BodyAcceleration,
    Energy,
    ForceAnswer,
    PartModel,
    SceneAnswer,
    SceneEvent,
    SceneModel,
    SceneTrajectory,
)
from core.multibody.description import Described
from core.multibody.dynamics import (
    ForceAtStart,
    Multipliers,
    forces_at_start,
    kinetic,
    multipliers_at_start,
    potential,
)
from core.multibody.equilibria import equilibria_of
from core.multibody.language import Scene
from core.multibody.modelling import Modelled, modelled
from core.multibody.modes import Modes
from core.multibody.occurrences import ExtremesOf, When, check_search
from core.multibody.packed import Floats
from core.multibody.periods import Periodic
from core.multibody.polynomials import BITS, ZERO, Ball, is_zero
from core.multibody.trajectories import AskedMotion, Searched, trajectory_of
from core.multibody.vertical_symmetry import Shifted, Steady
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
    outputs: Sequence[Output | When | ExtremesOf] = DEFAULT_OUTPUTS,
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
    outputs : sequence of str, When and ExtremesOf
        Some of `OUTPUTS`, and what is to be searched between the start and the latest time.
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
        elif not isinstance(output, str) or output not in OUTPUTS:
            raise InvalidParameter(("outputs", i), f"be one of {', '.join(OUTPUTS)}")
    if not isinstance(accuracy, (int, float)) or not 0.0 < accuracy < 1.0:
        raise InvalidParameter("accuracy", "be greater than 0 and less than 1")
    if input_uncertainty is not None:
        check_value("input_uncertainty", Uncertainty, input_uncertainty)
    asked = AskedMotion(moments, outputs, float(accuracy), method, input_uncertainty, digits, budget or Budget())
    with precision(BITS):
        return _solve(scene, asked)


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
    found = modelled(scene)
    table, outputs = found.described.measures.table, asked.outputs
    if len(asked.times) * 4 * len(table.names) > MOST_NUMBERS:
        most = MOST_NUMBERS // (4 * len(table.names))
        raise BudgetExceeded("samples", len(asked.times), most, path=("times",), remedy="ask for fewer times")
    multipliers = multipliers_at_start(found.described.measures, found.whole.acceleration)
    forces = forces_at_start(found.described.measures, multipliers)
    noticed = _noticed(found, forces, multipliers)
    model = _model(found, noticed, multipliers.rank)
    trajectory: SceneTrajectory | None = None
    events: tuple[SceneEvent, ...] = ()
    searched = Searched()
    if len(asked.times):
        determined = [value.value is not None for value in forces]
        trajectory, events, searched = trajectory_of(scene, found, determined, asked)
    motions = found.whole.parts
    periods = [motion.period for _, motion in motions if motion.name != "rest"]
    single = periods[0] if len(periods) == 1 else None
    return SceneAnswer(
        model,
        _accelerations(found.described, found.whole.acceleration) if "accelerations" in outputs else None,
        _forces(found.described, forces) if "forces" in outputs else None,
        _energy(found.described) if "energy" in outputs else None,
        trajectory,
        None if single is None else float(single),
        equilibria_of(found.described) if "equilibria" in outputs else None,
        events,
        next((event for event in events if event.time >= 0.0), None),
        searched.occurrences,
        searched.extremes,
    )


def _noticed(found: Modelled, forces: list[ForceAtStart], multipliers: Multipliers) -> list[str]:
    measures = found.described.measures
    bodies = set(found.described.scene.bodies)
    said = []
    if found.moved:
        said.append(f"positions were moved by rounding's width so that {', '.join(found.moved)} hold exactly")
    if found.fitted:
        said.append(f"{', '.join(found.fitted)} were taken as rounded: the velocities follow from the connections")
    still = [name for name in found.whole.reduced.pinned if name.split(".")[0] in bodies]
    if still:
        said.append(f"nothing ever moves {', '.join(still)}")
    for name, others in multipliers.redundant().items():
        beside = f" beside {', '.join(others)}" if others else ""
        said.append(f"{name} holds more than it has to{beside}: forces that it shares are not determined")
    for force, value in zip(measures.forces, forces, strict=True):
        if value.value is None:
            said.append(f"{force.name} is not determined by the scene")
    for limit in measures.limits:
        if limit.force is not None:
            tension = forces[limit.force].value
            if tension is not None and tension < 0:
                said.append(f"{limit.name} would have to push from the start: it is slack, and the scene another one")
    return said


def _model(found: Modelled, noticed: list[str], rank: int) -> SceneModel:
    table = found.described.measures.table
    apart = []
    for piece, (_, motion) in zip(found.pieces, found.whole.parts, strict=True):
        modes: tuple[tuple[float, float], ...] = ()
        if isinstance(motion, Modes):
            modes = tuple((float(mode.frequency), float(mode.growth)) for mode in motion.modes)
        period = motion.period
        winding = motion.winding if isinstance(motion, (Periodic, Steady, Shifted)) and motion.winding else None
        apart.append(
            PartModel(
                motion.name,
                motion.why,
                piece.freedom,
                tuple(piece.table.names),
                None if period is None else float(period),
                winding,
                modes,
            )
        )
    kinds = {part.name for part in apart}
    if not apart:
        name, why = "rest", "the connections hold everything where it is"
    elif len(kinds) == 1:
        name, why = apart[0].name, apart[0].why
    else:
        name, why = "parts apart", "the parts have no force or connection in common, and each has its own model"
    spins = any(not is_zero(frame.spin_momentum) for frame in found.described.measures.coordinates.frames.values())
    if name == "rest" and spins:
        name, why = "steady spin", "what turns spins steadily about its axis, and nothing moves its centre or the axis"
    return SceneModel(
        name,
        why,
        sum(part.degrees_of_freedom for part in apart),
        len(table.names) - rank,
        len(found.whole.reduced.table.names),
        sum(len(piece.chosen) for piece in found.pieces),
        (len(table.names), len(table.rows)),
        tuple(apart),
        tuple(noticed),
    )


def _accelerations(found: Described, full: Sequence[Ball]) -> Mapping[str, BodyAcceleration]:
    table, answer = found.measures.table, {}
    for name, frame in found.measures.coordinates.frames.items():
        angular: float | tuple[float, ...] | None = None
        if frame.turn is not None:
            angular = float(full[frame.turn])
        elif frame.direction is not None:
            c, s = frame.direction
            angular = float(table.q[c] * full[s] - table.q[s] * full[c])
        elif frame.axes is not None:
            # Half the sum of e x e'' is the rate of the angular velocity in space.
            space = [ZERO] * 3
            for axis in frame.axes:
                for i in range(3):
                    j, k = axis[(i + 1) % 3], axis[(i + 2) % 3]
                    space[i] = space[i] + (table.q[j] * full[k] - table.q[k] * full[j]) / 2
            angular = tuple(
                float(sum((x * table.q[j] for x, j in zip(space, axis, strict=True)), ZERO)) for axis in frame.axes
            )
        elif frame.turns is not None and frame.start_axes is not None:
            angular = tuple(
                float(sum((full[j] * x for j, x in zip(frame.turns, axis, strict=True)), ZERO))
                for axis in frame.start_axes
            )
        answer[name] = BodyAcceleration(tuple(float(full[i]) for i in frame.position), angular)
    return answer


def _forces(found: Described, forces: Sequence[ForceAtStart]) -> Mapping[str, ForceAnswer]:
    return {
        force.name: ForceAnswer(
            None if value.value is None else _double(value.value),
            force.unit,
            value.value is not None,
            value.shared_with,
        )
        for force, value in zip(found.measures.forces, forces, strict=True)
    }


def _double(ball: Ball) -> float:
    return 0.0 if is_zero(ball) else float(ball)


def _energy(found: Described) -> Energy:
    measures = found.measures
    spin = sum((frame.spin_energy for frame in measures.coordinates.frames.values()), ZERO)
    moving, resting = kinetic(measures.table) + spin, potential(measures.table) + measures.potential
    return Energy(_double(moving), _double(resting), _double(moving + resting), measures.conservative)
