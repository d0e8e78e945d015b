"""What is answered about the start of a scene: its model, accelerations, forces and energy."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping, Sequence
from math import hypot, inf, nextafter
from typing import Any, NamedTuple, Protocol

from core.multibody.algebra.doubles import error_in_doubles, in_doubles
from core.multibody.algebra.polynomials import ZERO, Ball, is_zero
from core.multibody.answer import AccelerationErrors, BodyAcceleration, Energy, EnergyErrors, ForceAnswer
from core.multibody.equations.dynamics import ForceAtStart, Multipliers, kinetic, potential
from core.multibody.model_answer import PartErrors, PartModel, SceneModel
from core.multibody.motion.modelling import Modelled
from core.multibody.table.description import Described
from core.systems.trajectory import MotionEvent


class _Named(Protocol):
    @property
    def name(self) -> str: ...

    @property
    def why(self) -> str: ...


UNDECIDED = "undecided"
"""The name of the model of what mechanics does not decide from the start on."""


class NumberKind(NamedTuple):
    """How numbers of the start are written: each, and the bound of its error, None where digits are proven."""

    value: Callable[[Ball], Any]
    error: Callable[[Ball], float | None] | None


DOUBLES = NumberKind(in_doubles, error_in_doubles)


def name_of_parts(parts: Sequence[_Named]) -> tuple[str, str]:
    """Return the name of the model of parts that move independently, and why it suffices.

    What rests beside something that moves has no name of its own in it.
    """
    if not parts:
        return "rest", "the connections hold everything where it is"
    undecided = [part for part in parts if part.name == UNDECIDED]
    moving = undecided[:1] or [part for part in parts if part.name != "rest"] or parts[:1]
    if len({part.name for part in moving}) == 1:
        return moving[0].name, moving[0].why
    return "parts apart", "the parts have no force or connection in common, and each has its own model"


def scene_model(found: Modelled, noticed: list[str], multipliers: Multipliers) -> SceneModel:
    """Return the model of a scene whose forces at the start are these multipliers."""
    rank = multipliers.rank
    table = found.described.measures.table
    apart = []
    for piece, motion in found.moving:
        period = found.whole.returns_after(motion)
        apart.append(
            PartModel(
                motion.name,
                motion.why,
                piece.freedom,
                tuple(piece.table.names),
                None if period is None else float(period),
                motion.winding or None,
                tuple(mode.in_doubles() for mode in motion.modes),
                PartErrors(
                    None if period is None else error_in_doubles(period),
                    motion.winding_error if motion.winding else None,
                ),
            )
        )
    name, why = name_of_parts(apart)
    if not apart and len(table.names) != rank:
        why = "it starts at rest, and all forces balance"
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
        multipliers.redundant(),
    )


def accelerations_of(
    found: Described, full: Sequence[Ball], numbers: NumberKind = DOUBLES
) -> Mapping[str, BodyAcceleration]:
    """Return the accelerations of every body, in a kind of number."""
    table, answer = found.measures.table, {}
    for name, frame in found.measures.coordinates.frames.items():
        linear = [full[i] for i in frame.position]
        angular: list[Ball] | None = None
        if frame.turn is not None:
            angular = [full[frame.turn]]
        elif frame.direction is not None:
            c, s = frame.direction
            angular = [table.q[c] * full[s] - table.q[s] * full[c]]
        elif frame.axes is not None:
            # Half the sum of e x e'' is the rate of the angular velocity in space.
            space = [ZERO] * 3
            for axis in frame.axes:
                for i in range(3):
                    j, k = axis[(i + 1) % 3], axis[(i + 2) % 3]
                    space[i] = space[i] + (table.q[j] * full[k] - table.q[k] * full[j]) / 2
            angular = [sum((x * table.q[j] for x, j in zip(space, axis, strict=True)), ZERO) for axis in frame.axes]
        elif frame.turns is not None and frame.start_axes is not None:
            angular = [
                sum((full[j] * x for j, x in zip(frame.turns, axis, strict=True)), ZERO) for axis in frame.start_axes
            ]
        shown = None if angular is None else tuple(map(numbers.value, angular))
        errors = None
        if numbers.error is not None:
            errors = AccelerationErrors(
                _length(map(numbers.error, linear)),
                None if angular is None else _length(map(numbers.error, angular)),
            )
        in_plane = frame.turn is not None or frame.direction is not None
        answer[name] = BodyAcceleration(
            tuple(map(numbers.value, linear)), shown[0] if in_plane and shown else shown, errors
        )
    return answer


def _length(errors: Iterable[float | None]) -> float | None:
    """Return the length of the errors of a vector, None where one is not known."""
    known = list(errors)
    if None in known:
        return None
    length = hypot(*(x for x in known if x is not None))
    # Of one component it is that error.
    return length if len(known) == 1 else nextafter(length, inf) if length > 0.0 else 0.0


def forces_of_start(
    found: Described, forces: Sequence[ForceAtStart], numbers: NumberKind = DOUBLES
) -> Mapping[str, ForceAnswer]:
    """Return the forces of every connection, in a kind of number."""
    return {
        force.name: ForceAnswer(
            None if value.value is None else numbers.value(value.value),
            force.unit,
            value.value is not None,
            value.shared_with,
            None if value.value is None or numbers.error is None else numbers.error(value.value),
        )
        for force, value in zip(found.measures.forces, forces, strict=True)
    }


def energy_of(found: Described, numbers: NumberKind = DOUBLES) -> Energy:
    """Return the energies at the start, in a kind of number."""
    measures = found.measures
    spin = sum((frame.spin_energy for frame in measures.coordinates.frames.values()), ZERO)
    moving, resting = kinetic(measures.table) + spin, potential(measures.table) + measures.potential
    each = moving, resting, moving + resting
    errors = None if numbers.error is None else EnergyErrors(*map(numbers.error, each))
    kinetic_energy, potential_energy, total = map(numbers.value, each)
    return Energy(kinetic_energy, potential_energy, total, measures.conservative, errors)


def slack_strings(found: Modelled, forces: Sequence[ForceAtStart]) -> list[str]:
    """Return the strings that would have to push at the start: the scene begins with them slack."""
    return [event.name for event in lost_at_start(found, forces) if event.kind == "slack"]


def lost_at_start(found: Modelled, forces: Sequence[ForceAtStart]) -> list[MotionEvent]:
    """Return the events with which the motion ends at the start: what would have to push, or pull, and cannot."""
    return [
        MotionEvent(limit.event, limit.name, 0.0, 0.0)
        for limit in found.described.measures.limits
        if limit.force is not None and (forces[limit.force].value or ZERO) < 0
    ]


def at_rest(found: Modelled) -> list[str]:
    """Return the coordinates of bodies that nothing moves."""
    bodies = set(found.described.scene.bodies)
    return [name for name in found.whole.reduced.pinned if name.split(".")[0] in bodies]


def noticed_of(found: Modelled, forces: list[ForceAtStart], multipliers: Multipliers) -> list[str]:
    """Return what was noticed about a scene, in sentences."""
    measures = found.described.measures
    said = []
    if found.moved:
        said.append(f"positions were moved by rounding's width so that {', '.join(found.moved)} hold exactly")
    if found.fitted:
        said.append(f"{', '.join(found.fitted)} were taken as rounded: the velocities follow from the connections")
    for name, others in multipliers.redundant().items():
        beside = f" what {', '.join(others)} hold" if others else " itself"
        said.append(f"{name} partly repeats{beside}: the forces that are shared are not determined")
    for force, value in zip(measures.forces, forces, strict=True):
        if value.value is None:
            # Shared with nothing else, it acts along what no other connection holds, and what still cannot fail.
            why = f": what {value.shared_with[0]} says with it is true anyway" if len(value.shared_with) == 1 else ""
            said.append(f"{force.name} is not determined by the scene{why}")
    for limit in measures.limits:
        if limit.force is not None:
            tension = forces[limit.force].value
            if tension is None or not tension < 0:
                continue
            if limit.event == "lift-off":
                said.append(f"{limit.name} would have to hang on its peg from the start: it lifts off at once")
            else:
                said.append(f"{limit.name} would have to push from the start: it is slack, and the scene another one")
    return said
