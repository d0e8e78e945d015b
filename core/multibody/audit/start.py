"""The start of an answer: bodies are where the description says, and its accelerations and forces keep the laws."""

from __future__ import annotations

from collections.abc import Mapping
from math import sqrt

import numpy as np

from core.multibody.answer import BodyAcceleration, SceneSolution
from core.multibody.audit.chosen_times import quickness
from core.multibody.audit.definitions import Description
from core.multibody.audit.energy import kinetic, potential, size_of
from core.multibody.audit.failure import Ledger
from core.multibody.audit.newton import Acceleration, Freedoms, balance
from core.multibody.audit.placement import STEP, Motion, Pose, Twist, Undefined, cross, moved, turned
from core.multibody.audit.samples import Samples, axis_of_top

SHORT = 2.0**-15
"""Time by which rates are compared before and after the start, in units of the quickest motion."""

HELD = 1e-7
"""Share of the terms to which an acceleration is known from that: the square of that time, and rounding over it."""


def check_start(
    ledger: Ledger, description: Description, freedoms: Freedoms, answer: SceneSolution, start: Samples
) -> None:
    """Compare what is answered about the start with the description and with the laws of motion.

    Parameters
    ----------
    start : Samples
        One sample of the motion, at the start.
    """
    _check_places(ledger, description, start)
    spun = all(start.spun(name) for name, body in description.bodies.items() if body.inertia is not None)
    struck = any(event.time <= 0.0 for event in answer.events)
    if answer.energy is not None and spun and not struck:
        size = 8.0 * ledger.rounding * size_of(description, start)
        own = (("kinetic", answer.energy.kinetic, kinetic), ("potential", answer.energy.potential, potential))
        for name, stated, of in own:
            off = np.broadcast_to(of(description, start), (1,)) - stated
            ledger.compare(f"{name} energy at the start", "", start.times, off, size)
    if answer.accelerations and answer.forces is not None and spun and not description.undefined:
        _check_balance(ledger, description, freedoms, answer.accelerations, answer, start)


def _check_places(ledger: Ledger, description: Description, start: Samples) -> None:
    size = max(float(np.max(np.abs(body.start.position))) for body in description.bodies.values())
    # A body in the origin is moved by as much as its axes turn the arms of its connections.
    size = max(size, *(connection.reach + connection.arm for connection in description.connections), 0.0)
    known = ledger.rounding
    for name, body in description.bodies.items():
        pose, errors = start.placement[name], start.errors[name]
        off = np.abs(pose.position[0] - body.start.position).max(keepdims=True)
        ledger.compare("place at the start", name, start.times, off, known * size + errors.position)
        if pose.turn is not None and body.start.turn is not None:
            off = pose.turn - body.start.turn
            ledger.compare("angle at the start", name, start.times, off, known * (1.0 + abs(off)) + errors.attitude)
        elif pose.rotation is not None and body.start.rotation is not None:
            # Of a top the axis alone is answered, and of a ball no attitude.
            shown = slice(None) if start.spun(name) else axis_of_top(body, description)
            off = np.abs(pose.rotation[0][:, shown] - body.start.rotation[:, shown]).max(keepdims=True).reshape(1)
            # Axes that were written with a few digits are no unit vectors; those of the answer are.
            given = body.start.rotation
            known_axes = known + 4.0 * float(np.abs(given.T @ given - np.eye(3)).max())
            if name in start.placed:
                ledger.compare("attitude at the start", name, start.times, off, known_axes + errors.attitude)


def _check_balance(
    ledger: Ledger,
    description: Description,
    freedoms: Freedoms,
    given: Mapping[str, BodyAcceleration],
    answer: SceneSolution,
    start: Samples,
) -> None:
    accelerations: dict[str, Acceleration] = {}
    for name, one in given.items():
        body = description.bodies[name]
        angular = None
        if body.inertia is not None:
            angular = np.asarray(one.angular, dtype=np.float64)[None]
            if description.dimension == 3:
                assert body.start.rotation is not None
                angular = angular @ body.start.rotation.T
        accelerations[name] = Acceleration(np.array(one.linear)[None], angular)
    assert answer.forces is not None
    gains = {name: Twist(one.linear, one.angular) for name, one in accelerations.items()}
    _check_held(ledger, description, start, gains)
    forces = {name: np.array([one.value]) for name, one in answer.forces.items() if one.value is not None}
    try:
        found = balance(description, start.placement, start.motion, accelerations, forces, freedoms=freedoms)
    except Undefined:
        return
    for connection in description.connections:
        own = connection.own_rest(start.placement, start.motion, gains, forces)
        if own is not None:
            allowed = 8.0 * ledger.rounding * own[1]
            ledger.compare("equation of the chain at the start", connection.name, start.times, own[0], allowed)
    left = np.abs(found.left())
    allowed = found.allowed(np.zeros_like(left), ledger.rounding)
    worst = int(np.argmax(left[:, 0] - allowed[:, 0]))
    name = max(
        (one for one in freedoms.where if freedoms.where[one][0] <= worst), key=lambda one: freedoms.where[one][0]
    )
    ledger.compare("Newton and Euler at the start", name, start.times, left[worst], allowed[worst])


def _check_held(ledger: Ledger, description: Description, start: Samples, gains: Motion) -> None:
    """Require that the accelerations keep what is held: by the rates a short time before and after the start."""
    fastest = max(float(np.abs(twist.velocity).max()) for twist in start.motion.values())
    steepest = max(float(np.abs(twist.velocity).max()) for twist in gains.values())
    size = max(float(np.abs(pose.position).max()) for pose in start.placement.values())
    turning = max((float(np.abs(one.spin).max()) for one in gains.values() if one.spin is not None), default=0.0)
    rate = max(quickness(description, start), sqrt(turning), sqrt(steepest / size) if size > 0.0 else 0.0)
    # Without a rate of its own, in the time that it takes to gain its speed, or in any time.
    step = SHORT * (1.0 / rate if rate > 0.0 else fastest / steepest if fastest > 0.0 < steepest else 1.0)
    for connection in description.connections:
        own = start.of(connection.bodies)
        known = all(start.spun(name) or start.placement[name].rotation is None for name in connection.bodies)
        if not known or not connection.held(start.placement):
            continue
        ends = []
        for sign in (1.0, -1.0):
            placement, motion = dict(start.placement), {}
            for name, twist in own.items():
                placement[name], motion[name] = _after(start.placement[name], twist, gains[name], sign * step)
            ends.append(connection.held(moved(placement, motion)))
        arm = connection.arm + connection.reach
        spins = [
            float(np.abs(one.spin).max()) for one in (gains[name] for name in connection.bodies) if one.spin is not None
        ]
        terms = steepest + rate * fastest + arm * float(max(spins, default=0.0)) + arm * rate**2
        for key, after in ends[0].items():
            gain = (after.imag - ends[1][key].imag) / STEP / (2.0 * step)
            off = np.abs(gain).reshape(1, -1).max(axis=1)
            ledger.compare(
                f"{key} held by the accelerations", connection.name, start.times, off, (HELD + ledger.rounding) * terms
            )


def _after(pose: Pose, twist: Twist, gain: Twist, step: float) -> tuple[Pose, Twist]:
    """Return a body a short time later, to second order."""
    position = pose.position + step * (twist.velocity + step / 2.0 * gain.velocity)
    velocity = twist.velocity + step * gain.velocity
    if twist.spin is None or gain.spin is None:
        return Pose(position, pose.rotation, pose.turn), Twist(velocity)
    turned_by = step * (twist.spin + step / 2.0 * gain.spin)
    spin = twist.spin + step * gain.spin
    if pose.turn is not None:
        turn = pose.turn + turned_by
        return Pose(position, turned(turn), turn), Twist(velocity, spin)
    if pose.rotation is None:
        return Pose(position), Twist(velocity, spin)
    axes = np.swapaxes(pose.rotation, -1, -2)
    once = cross(turned_by[..., None, :], axes)
    axes = axes + once + cross(turned_by[..., None, :], once) / 2.0
    return Pose(position, np.swapaxes(axes, -1, -2)), Twist(velocity, spin)
