"""One question about a described scene, answered by the smallest model of each of its parts."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any, Literal

import numpy as np

from core.balls import precision
from core.errors import AccuracyUnreachable, BudgetExceeded, InvalidParameter, NotApplicable
from core.multibody.answer import (
    BodyAcceleration,
    Column,
    Energy,
    ForceAnswer,
    PartModel,
    SceneAnswer,
    SceneEvent,
    SceneModel,
    SceneTrajectory,
)
from core.multibody.assembly import assemble_places, assemble_rates
from core.multibody.columns import Columns, worst
from core.multibody.description import Described, described
from core.multibody.dynamics import (
    ForceAtStart,
    Multipliers,
    accelerations,
    forces_at_start,
    kinetic,
    multipliers_at_start,
    parts,
    potential,
    restricted,
    singular_row,
)
from core.multibody.equilibria import equilibria_of
from core.multibody.events import first_event
from core.multibody.language import Scene
from core.multibody.modes import Modes
from core.multibody.motion import Motion, Rest
from core.multibody.numerical import Numerical
from core.multibody.packed import Floats
from core.multibody.passes import Reduced, reduced
from core.multibody.periods import Periodic, repeating
from core.multibody.polynomials import BITS, ZERO, Ball, is_zero
from core.multibody.table import Table
from core.multibody.uniform import Uniform
from core.multibody.vertical_symmetry import Shifted, Steady, precessing
from core.multibody.whole import Whole

Output = Literal["accelerations", "forces", "energy", "trajectory", "forces-in-time", "energy-in-time", "equilibria"]
OUTPUTS: tuple[Output, ...] = (
    "accelerations",
    "forces",
    "energy",
    "trajectory",
    "forces-in-time",
    "energy-in-time",
    "equilibria",
)
DEFAULT_OUTPUTS: tuple[Output, ...] = ("accelerations", "forces", "energy", "trajectory")

_HOLDS = 1e-8
"""Relative mismatch of a measure above which it is not held."""

MOST_NUMBERS = 5_000_000
"""Numbers that one trajectory may have."""


def solve_scene(
    scene: Scene,
    times: Sequence[float] | Floats = (),
    outputs: Sequence[Output] = DEFAULT_OUTPUTS,
    accuracy: float = 1e-9,
) -> SceneAnswer:
    """Answer a question about a scene.

    Parameters
    ----------
    scene : Scene
    times : sequence of float
        Seconds from the given state, of either sign and in any order.
    outputs : sequence of str
        Some of `OUTPUTS`.
    accuracy : float
        Largest error of any column, relative to its largest value, that is tolerated.

    Raises
    ------
    InvalidParameter
        For a scene that cannot be, with the path to the fault.
    AccuracyUnreachable
        Where neither doubles nor pairs of doubles reach the accuracy.
    BudgetExceeded
        Where it would take more steps or samples than one question may.
    """
    moments = _times(times)
    for i, output in enumerate(outputs):
        if output not in OUTPUTS:
            raise InvalidParameter(("outputs", i), f"be one of {', '.join(OUTPUTS)}")
    if not isinstance(accuracy, (int, float)) or not 0.0 < accuracy < 1.0:
        raise InvalidParameter("accuracy", "be greater than 0 and less than 1")
    with precision(BITS):
        return _solve(scene, moments, outputs, float(accuracy))


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


def _solve(scene: Scene, times: Floats, outputs: Sequence[Output], accuracy: float) -> SceneAnswer:
    found = described(scene)
    table = found.measures.table
    if len(times) * 4 * len(table.names) > MOST_NUMBERS:
        raise BudgetExceeded(
            "samples", len(times), MOST_NUMBERS // (4 * len(table.names)), path=("times",), remedy="ask for fewer times"
        )
    moved = assemble_places(table, found.paths)
    fitted = assemble_rates(table, found.measures.coordinates.given, found.paths)
    small = reduced(table, pinning=True)
    pieces = [_piece(found, small.table, indices) for indices in parts(small.table)]
    gains: list[Ball] = [ZERO] * len(small.table.names)
    for indices, _, gain, _ in pieces:
        for i, x in zip(indices, gain, strict=True):
            gains[i] = x
    full = [sum((c * gains[key[0]] for key, c in e.items() if key), ZERO) for e in small.expressions]
    motions = [(indices, _motion(part, gain, chosen)) for indices, part, gain, chosen in pieces]
    dropped = any(len(chosen) < len(part.rows) for _, part, _, chosen in pieces)
    whole = Whole(found.measures, small, full, gains, motions, dropped)
    multipliers = multipliers_at_start(found.measures, full)
    forces = forces_at_start(found.measures, multipliers)
    noticed = _noticed(found, small, moved, fitted, forces, multipliers)
    model = _model(found, small, pieces, motions, noticed, multipliers.rank)
    trajectory: SceneTrajectory | None = None
    events: tuple[SceneEvent, ...] = ()
    if len(times):
        trajectory, events = _trajectory(whole, forces, times, outputs, accuracy)
    equilibria = None
    if "equilibria" in outputs:
        equilibria = equilibria_of(found)
    periods = [motion.period for _, motion in motions if motion.name != "rest"]
    single = periods[0] if len(periods) == 1 else None
    return SceneAnswer(
        model,
        _accelerations(found, full) if "accelerations" in outputs else None,
        _forces(found, forces) if "forces" in outputs else None,
        _energy(found) if "energy" in outputs else None,
        trajectory,
        None if single is None else float(single),
        equilibria,
        events,
        next((event for event in events if event.time >= 0.0), None),
    )


Piece = tuple[list[int], Table, list[Ball], list[int]]
"""Coordinates of a part, its table, its accelerations and its independent rows."""


def _piece(found: Described, table: Table, indices: list[int]) -> Piece:
    part = restricted(table, indices)
    gain, chosen = accelerations(part)
    singular = singular_row(part, chosen)
    if singular is not None:
        raise InvalidParameter(
            found.paths.get(singular.name, ("connections",)),
            f'leave the motion determined: the start is a singular place, where "{singular.name}" and the connections '
            "around it lose their hold, and several motions are possible",
            remedy="start elsewhere",
        )
    return indices, part, gain, chosen


def _motion(part: Table, gain: list[Ball], chosen: list[int]) -> Motion:
    """Return the smallest model of a part."""
    if all(is_zero(x) for x in part.v) and all(is_zero(x) for x in gain):
        return Rest(part)
    linear = all(row.constant for row in part.rows)
    if linear and not part.stiffness and not part.damping and not part.gyration:
        return Uniform(part, gain)
    if linear and not part.gyration:
        return Modes.of(part, chosen)
    found: Motion | None = repeating(part, gain, chosen) or precessing(part, gain, chosen)
    if found is not None:
        return found
    free = len(part.names) - len(chosen)
    why = (
        "one degree of freedom that does not return soon, or is driven or damped"
        if free == 1
        else f"{free} degrees of freedom are coupled by quadratic terms"
    )
    return Numerical.of(part, gain, chosen, why)


def _noticed(
    found: Described,
    small: Reduced,
    moved: list[str],
    fitted: list[str],
    forces: list[ForceAtStart],
    multipliers: Multipliers,
) -> list[str]:
    measures = found.measures
    bodies = set(found.scene.bodies)
    said = []
    if moved:
        said.append(f"positions were moved by rounding's width so that {', '.join(moved)} hold exactly")
    if fitted:
        said.append(f"{', '.join(fitted)} were taken as rounded: the velocities follow from the connections")
    still = [name for name in small.pinned if name.split(".")[0] in bodies]
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


def _model(
    found: Described,
    small: Reduced,
    pieces: Sequence[Piece],
    motions: Sequence[tuple[list[int], Motion]],
    noticed: list[str],
    rank: int,
) -> SceneModel:
    table = found.measures.table
    apart = []
    for (_, part, _, chosen), (_, motion) in zip(pieces, motions, strict=True):
        modes: tuple[tuple[float, float], ...] = ()
        if isinstance(motion, Modes):
            modes = tuple((float(mode.frequency), float(mode.growth)) for mode in motion.modes)
        period = motion.period
        winding = motion.winding if isinstance(motion, (Periodic, Steady, Shifted)) and motion.winding else None
        apart.append(
            PartModel(
                motion.name,
                motion.why,
                len(part.names) - len(chosen),
                tuple(part.names),
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
    return SceneModel(
        name,
        why,
        sum(part.degrees_of_freedom for part in apart),
        len(table.names) - rank,
        len(small.table.names),
        sum(len(chosen) for _, _, _, chosen in pieces),
        (len(table.names), len(table.rows)),
        tuple(apart),
        tuple(noticed),
    )


def _trajectory(
    whole: Whole, forces: Sequence[ForceAtStart], times: Floats, outputs: Sequence[Output], accuracy: float
) -> tuple[SceneTrajectory, tuple[SceneEvent, ...]]:
    events: list[SceneEvent] = []
    rows = np.arange(len(times))
    determined = [value.value is not None for value in forces]
    watched = [limit for limit in whole.measures.limits if limit.force is None or determined[limit.force]]
    for end in {max(float(np.max(times)), 0.0), min(float(np.min(times)), 0.0)} - {0.0}:
        # What leaves the range of doubles is refused below.
        with np.errstate(over="ignore", invalid="ignore"):
            event = first_event(whole, watched, end)
        if event is not None:
            events.append(event)
            beyond = times[rows] > event.time if end > 0.0 else times[rows] < event.time
            rows = rows[~beyond]
    moments = times[rows]
    with np.errstate(over="ignore", invalid="ignore"):
        columns = _columns(whole, determined, moments, outputs, finer=False)
        if any(isinstance(motion, Numerical) for _, motion in whole.parts) and worst(columns) > accuracy:
            columns = _columns(whole, determined, moments, outputs, finer=True)
    lost = [name for name, one in columns.items() if not (np.isfinite(one.values).all() and np.isfinite(one.error))]
    if lost:
        raise NotApplicable(
            f"{lost[0]} or its error leaves the range of doubles",
            path=("times",),
            remedy="ask for a shorter time, or choose units in which the numbers are moderate",
        )
    reached = worst(columns)
    if reached > accuracy:
        raise AccuracyUnreachable(
            accuracy,
            reached,
            "the motion amplifies rounding, even that of pairs of doubles",
            remedy="ask for a shorter time or a larger accuracy",
        )
    return SceneTrajectory(moments, rows, columns), tuple(sorted(events, key=lambda event: event.time))


def _columns(
    whole: Whole, determined: Sequence[bool], times: Floats, outputs: Sequence[Output], *, finer: bool
) -> dict[str, Column]:
    states = whole.states(times, finer=finer)
    if whole.dropped and whole.misfit(states.q) > _HOLDS:
        raise NotApplicable(
            "connections that depend on one another at the start do not do so later: the start is a singular place",
            path=("connections",),
            remedy="start elsewhere",
        )
    closed = all(motion.how == "closed form" for _, motion in whole.parts)
    columns = Columns(whole, times, states, "closed form" if closed else "measured against pairs")
    found: dict[str, Column] = {}
    if "trajectory" in outputs:
        found.update(columns.trajectory())
    if "forces-in-time" in outputs and len(times):
        chosen = [force for force, known in zip(whole.measures.forces, determined, strict=True) if known]
        found.update(columns.forces(chosen))
    if "energy-in-time" in outputs:
        found.update(columns.energy())
    return found


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
