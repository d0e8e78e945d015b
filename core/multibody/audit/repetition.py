"""The period of an answer: the state returns after it, and not after a half, a third or a fifth of it."""

from __future__ import annotations

import numpy as np

from core.multibody.answer import SceneSolution
from core.multibody.audit.definitions import Description
from core.multibody.audit.failure import Ledger
from core.multibody.audit.placement import Numbers
from core.multibody.audit.samples import ATTITUDE, POSITION, SPIN, VELOCITY, Samples, axis_of_top

FRACTIONS = (1, 2, 3, 5)
"""Parts of the period at which the state is compared with that of the start."""

TOLD_APART = 1e3
"""How many times larger than what is known of it a motion is at least of which parts of the period are compared."""


def precession_of(answer: SceneSolution) -> tuple[float, float] | None:
    """Return by which angle the state is turned about the vertical after the period, and its error (rad)."""
    own = [part for part in answer.model.apart if part.precession is not None]
    if len(own) != 1 or own[0].precession is None:
        return None
    errors = own[0].errors
    return own[0].precession, 0.0 if errors is None or errors.precession is None else errors.precession


def times_of_period(answer: SceneSolution) -> Numbers:
    """Return the times at which the state is compared with that of the start; none without a period."""
    if answer.period is None:
        return np.zeros(0)
    return answer.period / np.array(FRACTIONS if precession_of(answer) is None else FRACTIONS[:1])


def check_repetition(
    ledger: Ledger, description: Description, answer: SceneSolution, start: Samples, later: Samples
) -> None:
    """Compare the state after a period with that of the start, up to a turn where the answer says so.

    Parameters
    ----------
    start, later : Samples
        One sample, and those at the times of `times_of_period`.
    """
    winding = precession_of(answer)
    if winding is None:
        check_period(ledger, description, answer, start, later)
    else:
        check_precession(ledger, description, answer, start, later, *winding)


def check_precession(
    ledger: Ledger,
    description: Description,
    answer: SceneSolution,
    start: Samples,
    later: Samples,
    winding: float,
    error: float,
) -> None:
    """Require that velocities and axes of tops after a period are those of the start, turned about the vertical.

    Heights are the same. Through which place the vertical goes the answer does not say, nor what it is in space without
    gravity: only speeds are compared there.

    Parameters
    ----------
    winding, error : float
        Angle of the turn (rad).
    """
    assert answer.period is not None, "the caller knows the period"
    late = max(answer.period_error or 0.0, ledger.rounding * answer.period)
    up = np.array([0.0, 0.0, 1.0] if description.dimension == 2 else [-x for x in description.gravity])
    size = float(np.linalg.norm(up))
    up = up / size if size > 0.0 else up
    turn = _turn_about(up, winding)[: description.dimension, : description.dimension]
    for name, twist in start.motion.items():
        then, known = later.motion[name].velocity, later.errors[name][:, VELOCITY]
        speed, gain = float(np.abs(then).max()), _gain(answer, later, name)
        # How fast velocities change after the period is not known without the accelerations.
        allowed = 4.0 * known + (error + 4.0 * ledger.rounding) * speed + 4.0 * late * gain
        allowed = allowed if answer.accelerations is not None else allowed + np.inf
        if size == 0.0:
            off = np.abs(np.linalg.norm(then, axis=1) - np.linalg.norm(twist.velocity, axis=1))
            ledger.compare("speeds return after the period", name, later.times, off, allowed)
            continue
        off = np.abs(then - twist.velocity @ turn.T).max(axis=1)
        ledger.compare("velocities return, turned, after the period", name, later.times, off, allowed)
        shown = start.placement[name].rotation, later.placement[name].rotation
        if twist.spin is None and shown[0] is not None and shown[1] is not None:
            k = axis_of_top(description.bodies[name], description)
            off = np.abs(shown[1][..., k] - shown[0][..., k] @ turn.T).max(axis=1)
            allowed = 4.0 * later.errors[name][:, ATTITUDE] + error + 4.0 * ledger.rounding + late * gain
            ledger.compare("the axis returns, turned, after the period", name, later.times, off, allowed)
        if then.shape[1] == 3:
            places = [one.placement[name].position[0] for one in (start, later)]
            away = float(np.abs(places).max())
            allowed = 4.0 * later.errors[name][:, POSITION] + 8.0 * ledger.rounding * away + late * speed
            off = np.full(1, abs(float(places[1] @ up) - float(places[0] @ up)))
            ledger.compare("heights return after the period", name, later.times, off, allowed)


def _turn_about(axis: Numbers, angle: float) -> Numbers:
    """Return the rotation about a unit vector by an angle (Rodrigues' formula)."""
    x, y, z = axis
    across = np.array([[0.0, -z, y], [z, 0.0, -x], [-y, x, 0.0]])
    found: Numbers = np.eye(3) + np.sin(angle) * across + (1.0 - np.cos(angle)) * (across @ across)
    return found


def check_period(
    ledger: Ledger, description: Description, answer: SceneSolution, start: Samples, later: Samples
) -> None:
    """Compare the state after a period, and after parts of it, with that of the start.

    Parameters
    ----------
    start, later : Samples
        One sample, and those at the times of `times_of_period`.
    """
    period = answer.period
    assert period is not None, "the caller knows the period"
    late = max(answer.period_error or 0.0, ledger.rounding * period)
    away, allowed = _apart(description, answer, start, later, late, ledger.rounding)
    ledger.compare(
        "the state returns after the period (in units of what is known of it)",
        "",
        later.times[:1],
        away[:1],
        allowed[:1],
    )
    if away.max() < TOLD_APART or not _leaves(answer, start, later, period, ledger.rounding):
        # The motion is hardly larger than what is known of it, or begins beside a place where it would rest.
        return
    for k, part in enumerate(FRACTIONS[1:], start=1):
        if away[k] <= allowed[k]:
            # How far it should be away at least has no other measure than what can be told apart.
            ledger.compare(
                f"the state differs after 1/{part} of the period", "", later.times[k : k + 1], np.ones(1), 0.0
            )


def _leaves(answer: SceneSolution, start: Samples, later: Samples, period: float, rounding: float) -> bool:
    """Return whether the motion leaves the start, in a small part of the period, by more than what is known of it.

    Released from 1e-15 beside the top a pendulum is seen at the same place after half of its period.
    """
    soon = period / 100.0
    for name, twist in start.motion.items():
        gain = 0.0
        if answer.accelerations is not None:
            gain = float(np.abs(answer.accelerations[name].linear).max())
        way = soon * float(np.abs(twist.velocity).max()) + soon * soon * gain
        size = rounding * float(np.abs(start.placement[name].position).max())
        if way > TOLD_APART * (later.errors[name][0, POSITION] + size):
            return True
    return False


def _apart(
    description: Description, answer: SceneSolution, start: Samples, later: Samples, late: float, rounding: float
) -> tuple[Numbers, Numbers]:
    """Return how many times further apart than is allowed the states are in their worst quantity, and one."""
    worst = np.zeros(later.times.shape)
    for name in description.bodies:
        error = later.errors[name][0]
        first, then = start.placement[name], later.placement[name]
        moving, moved = start.motion[name], later.motion[name]
        speed = float(np.abs(moved.velocity).max())
        spin = 0.0 if moved.spin is None else float(np.abs(moved.spin).max())
        pairs: list[tuple[Numbers, Numbers, float]] = [
            (first.position, then.position, error[POSITION] + late * speed),
        ]
        velocities = moved.velocity
        if answer.accelerations is None:
            # How fast a velocity changes after the period is not known: it tells the parts of the period apart alone.
            velocities = np.concatenate([moving.velocity[:1], velocities[1:]])
        pairs.append((moving.velocity, velocities, error[VELOCITY] + late * _gain(answer, later, name)))
        if first.rotation is not None and then.rotation is not None:
            shown = slice(None)
            if moving.spin is None:
                # Of a top the axis alone is answered.
                k = axis_of_top(description.bodies[name], description)
                shown = slice(k, k + 1)
            pairs.append((first.rotation[..., shown], then.rotation[..., shown], error[ATTITUDE] + late * spin))
        if moving.spin is not None and moved.spin is not None:
            pairs.append(
                (moving.spin, moved.spin, error[SPIN] + late * _gain(answer, later, name) + late * spin * spin)
            )
        for one, other, known in pairs:
            off = np.abs(other - one).reshape(len(later.times), -1).max(axis=1)
            size = rounding * float(np.abs(other).max()) + 4.0 * known
            worst = np.maximum(worst, off / size if size > 0.0 else np.where(off > 0.0, np.inf, 0.0))
    return worst, np.ones(later.times.shape)


def _gain(answer: SceneSolution, samples: Samples, name: str) -> float:
    """Return a size of the acceleration of a body: that of the start, or a hundred times its speed in the time."""
    speed = float(np.abs(samples.motion[name].velocity).max())
    span = float(np.ptp(samples.times))
    slowly = speed * 100.0 / span if span > 0.0 else 0.0
    if answer.accelerations is None:
        return slowly
    return max(slowly, float(np.abs(answer.accelerations[name].linear).max()))
