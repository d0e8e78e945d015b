"""The start of an answer: bodies are where the description says, and its accelerations and forces keep the laws."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from math import sqrt

import numpy as np

from core.multibody.answer import SceneSolution
from core.multibody.audit.chosen_times import quickness
from core.multibody.audit.definition import Definition
from core.multibody.audit.definitions import Description
from core.multibody.audit.failure import MARGIN, Ledger
from core.multibody.audit.laws_at_samples import ANGULAR, MeasureValues
from core.multibody.audit.newton import Acceleration, Freedoms
from core.multibody.audit.placement import STEP, Motion, Numbers, Placement, Pose, Twist, Undefined, cross, turned
from core.multibody.audit.samples import ATTITUDE, EPSILON, POSITION, Samples, axis_of_top

KNOWN = 2.0**-40
"""Share of forces to which others follow from them at a place in doubles."""

SHORT_TIME = 2.0**-15
"""Time by which rates are compared before and after the start, in units of the quickest motion."""

ACCELERATION_KNOWN = 1e-7
"""Share of the terms to which an acceleration is known from that: the square of that time, and rounding over it."""


def check_places(ledger: Ledger, description: Description, start: Samples) -> None:
    """Require bodies to begin where the description has them.

    Parameters
    ----------
    start : Samples
        At the start: one sample of the motion, or one of each motion of which the description has the places.
    """
    # A body in the origin is moved by as much as its axes turn the arms of its connections.
    size, known = description.extent, ledger.rounding
    for name, body in description.bodies.items():
        pose, given, error = start.placement[name], description.start[name], start.errors[name]
        off = np.abs(pose.position - given.position).max(axis=-1)
        ledger.compare("place at the start", name, start.times, off, known * size + error[:, POSITION])
        if pose.turn is not None and given.turn is not None:
            off = np.abs(pose.turn - given.turn)
            ledger.compare("angle at the start", name, start.times, off, known * (1.0 + off) + error[:, ATTITUDE])
        elif pose.rotation is not None and given.rotation is not None:
            # Of a top the axis alone is answered, and of a ball no attitude.
            shown = slice(None) if start.spun(name) else axis_of_top(body, description)
            off = (
                np.abs(pose.rotation[..., shown] - given.rotation[..., shown]).reshape(len(start.times), -1).max(axis=1)
            )
            # Axes that were written with a few digits are no unit vectors; those of the answer are.
            square = np.swapaxes(given.rotation, -1, -2) @ given.rotation
            known_axes = known + 4.0 * float(np.abs(square - np.eye(3)).max())
            if name in start.placed:
                ledger.compare("attitude at the start", name, start.times, off, known_axes + error[:, ATTITUDE])


def accelerations_of(description: Description, answer: SceneSolution) -> dict[str, Acceleration] | None:
    """Return the accelerations at the start that are answered, in the axes of space; None without them."""
    if not answer.accelerations:
        return None
    found: dict[str, Acceleration] = {}
    for name, one in answer.accelerations.items():
        body, angular = description.bodies[name], None
        if body.inertia is not None:
            if one.angular is None:
                return None
            angular = np.array(one.angular, dtype=np.float64)[None]
            if description.dimension == 3:
                assert body.start.rotation is not None, "a body of space with inertia has an attitude"
                angular = angular @ body.start.rotation.T
        found[name] = Acceleration(np.array(one.linear)[None], angular)
    return found


def unsure_of(description: Description, answer: SceneSolution, freedoms: Freedoms) -> Numbers:
    """Return what the stated errors of the accelerations at the start do to the equations, shape (freedoms, 1)."""
    unsure = np.zeros((freedoms.count, 1))
    for name, one in (answer.accelerations or {}).items():
        body = description.bodies[name]
        if one.errors is None:
            continue
        unsure[freedoms.moving(name)] = body.mass * (one.errors.linear or 0.0)
        if body.inertia is not None:
            unsure[freedoms.turning(name)] = body.moment * (one.errors.angular or 0.0)
    return unsure


def forces_of(answer: SceneSolution) -> tuple[dict[str, Numbers], dict[str, float]]:
    """Return the forces at the start that are answered, as one sample, NaN where not determined; and their errors."""
    given = (answer.forces or {}).items()
    forces = {name: np.array([np.nan if one.value is None else one.value]) for name, one in given}
    return forces, {name: one.error or 0.0 for name, one in given}


def check_forces(ledger: Ledger, description: Description, answer: SceneSolution, start: Samples, scale: float) -> None:
    """Require forces at the start that follow from others of their connections to do so.

    Parameters
    ----------
    start : Samples
        One sample of the motion, at the start.
    scale : float
        Size of the forces of the scene (N), beside which those that follow from weights are known.
    """
    forces, _ = forces_of(answer)
    for one in description.connections:
        if not one.derives or any(name not in forces for name in one.forces):
            continue
        try:
            derived = one.derived(start.placement, start.motion, forces)
        except Undefined:
            continue
        for name, value in derived.items():
            if name in forces and not np.isnan(value - forces[name]).any():
                # Of a sum of several parts some may not be determined.
                size = np.nansum([np.abs(forces[other]) for other in (*one.forces, name)], axis=0)

                def law(at: Samples, one: Definition = one, name: str = name) -> Numbers:
                    return one.derived(at.placement, at.motion, forces)[name] - forces[name]

                known, rest = KNOWN / ledger.rounding * size + scale, value - forces[name]
                said = f"{name} at the start by the others"
                ledger.hold(said, one.name, start, law, known, value=rest, bodies=one.bodies)


class AfterStart:
    """The motion a short time before and after the start, to second order, as two samples.

    Parameters
    ----------
    gains : mapping of str to Acceleration
        At the start.
    start : Samples
        One sample.
    """

    def __init__(self, description: Description, gains: Mapping[str, Acceleration], start: Samples) -> None:
        self.gains, self.start = gains, start
        self.fastest = max(float(np.abs(twist.velocity).max()) for twist in start.motion.values())
        self.steepest = max(float(np.abs(gain.linear).max()) for gain in gains.values())
        size = max(float(np.abs(pose.position).max()) for pose in start.placement.values())
        self.blur = EPSILON * max(size, description.extent)
        turning = max(
            (float(np.abs(gain.angular).max()) for gain in gains.values() if gain.angular is not None), default=0.0
        )
        spins = [float(np.abs(twist.spin).max()) for twist in start.motion.values() if twist.spin is not None]
        quick = quickness(description, start.placement, self.fastest, max(spins, default=0.0))
        self.rate = max(quick, sqrt(turning), sqrt(self.steepest / size) if size > 0.0 else 0.0)
        # Without a rate of its own, in the time that it takes to gain its speed, or in any time.
        slow = self.fastest / self.steepest if self.fastest > 0.0 < self.steepest else 1.0
        self.step = SHORT_TIME * (1.0 / self.rate if self.rate > 0.0 else slow)

    @property
    def gains_as_motion(self) -> Motion:
        """The accelerations, as a motion."""
        return {name: Twist(gain.linear, gain.angular) for name, gain in self.gains.items()}

    def samples(self) -> tuple[Placement, Motion]:
        """Return where bodies are, and how they move, after the step and before it."""
        placement, motion, step = {}, {}, np.array([self.step, -self.step])
        for name, twist in self.start.motion.items():
            placement[name], motion[name] = _after(self.start.placement[name], twist, self.gains[name], step)
        return placement, motion

    def check(self, ledger: Ledger, measures: Sequence[MeasureValues], first: int) -> None:
        """Require that the accelerations keep what is held: by the rates before and after the start.

        Parameters
        ----------
        measures : sequence of MeasureValues
        first : int
            Number of the first of the two samples among them.
        """
        for own in measures:
            connection, arm = own.connection, own.connection.arm + own.connection.reach
            angular = [self.gains[name].angular for name in connection.bodies]
            turning = max((float(np.abs(gain).max()) for gain in angular if gain is not None), default=0.0)
            for key, value in own.held.items():
                # What is held of an attitude has the size of a direction, whatever the places.
                size = max(1.0, arm) if key in ANGULAR else arm
                # Directions between places turn by as much as their coordinates are rounded, and rates with them.
                blurred = MARGIN * self.blur * self.rate / self.step
                terms = self.steepest + self.rate * self.fastest + size * (turning + self.rate**2)
                gain = (value[first].imag - value[first + 1].imag) / STEP / (2.0 * self.step)
                off, allowed = (
                    np.abs(gain).reshape(1, -1).max(axis=1),
                    (ACCELERATION_KNOWN + ledger.rounding) * terms + blurred,
                )
                law = f"{key} held by the accelerations"
                ledger.compare(law, connection.name, self.start.times, off, allowed)


def _after(pose: Pose, twist: Twist, gain: Acceleration, step: Numbers) -> tuple[Pose, Twist]:
    """Return a body some short times later, to second order, shapes (k, ...); it begins as one sample."""
    t = step[:, None]
    position = pose.position + t * (twist.velocity + t / 2.0 * gain.linear)
    velocity = twist.velocity + t * gain.linear
    if twist.spin is None or gain.angular is None:
        return Pose(position, time=step), Twist(velocity)
    if pose.turn is not None:
        turn = pose.turn + step * (twist.spin + step / 2.0 * gain.angular)
        return Pose(position, turned(turn), turn, step), Twist(velocity, twist.spin + step * gain.angular)
    turned_by, spin = t * (twist.spin + t / 2.0 * gain.angular), twist.spin + t * gain.angular
    assert pose.rotation is not None, "a body in space that spins has an attitude"
    axes = np.swapaxes(pose.rotation, -1, -2)
    once = cross(turned_by[..., None, :], axes)
    axes = axes + once + cross(turned_by[..., None, :], once) / 2.0
    return Pose(position, np.swapaxes(axes, -1, -2), time=step), Twist(velocity, spin)
