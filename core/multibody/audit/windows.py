"""Short windows of a motion, on which rates are formed by interpolation: velocities, and the laws of Newton and Euler.

A window is sampled at the zeros of a Chebyshev polynomial. The rate of the polynomial through the samples is as wrong
as the stated errors, times the sum of the sizes of the weights, and the first terms that are left out, for which the
decay of the coefficients gives a size.

References
----------
L. N. Trefethen, "Approximation Theory and Approximation Practice", chapters 3, 8 and 21.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.polynomial import chebyshev

from core.multibody.audit.definitions import Description
from core.multibody.audit.failure import ROUNDING, Ledger
from core.multibody.audit.newton import Acceleration, Freedoms, balance
from core.multibody.audit.placement import Numbers, Twist, Undefined, cross
from core.multibody.audit.samples import Samples, axis_of_top

NODES = 7
"""Samples of a window: with some seventh of a radian of motion in it, the eighth term is below 1e-12 of the first."""

NOISE = 2.0**-100
"""Share of the largest forces and places to which what vanishes is solved for: in pairs of doubles."""

SLOWEST = 0.05
"""Decay of the coefficients, two terms on, above which the terms that are left out are not known to be smaller."""

_PLACES = np.cos((2 * np.arange(NODES) + 1) * np.pi / (2 * NODES))[::-1]
_STEEPEST = float(NODES**2)
"""Largest rate of the first term that is left out."""


@dataclass(frozen=True)
class Rate:
    """The rate of a quantity at the samples of a window, and how wrong it may be, shapes (n, ...) and (n,)."""

    value: Numbers
    error: Numbers


def nodes(middle: float, half: float) -> Numbers:
    """Return the times of a window."""
    return middle + half * _PLACES


class Window:
    """Forms rates from samples at the times of a window.

    Parameters
    ----------
    times : ndarray, shape (NODES,)
        Doubles: where the zeros of the polynomial have been rounded to.
    half : float
        Half of the width (s).
    rounding : float
        Share of themselves to which samples are known apart from stated errors.
    """

    def __init__(self, times: Numbers, half: float, rounding: float = ROUNDING) -> None:
        self.half, self.rounding = half, rounding
        middle = (times[0] + times[-1]) / 2.0
        places = (times - middle) / half
        values = chebyshev.chebvander(places, NODES - 1)
        # The rate of T_k is k U_(k-1), with U_k = 2 T_k + U_(k-2).
        second = np.zeros((NODES, NODES + 1))
        second[:, 1], second[:, 2] = 1.0, 2.0 * places
        for k in range(2, NODES):
            second[:, k + 1] = 2.0 * values[:, k] + second[:, k - 1]
        self.coefficients = np.linalg.inv(values)
        self.differences = (np.arange(NODES) * second[:, :NODES]) @ self.coefficients / half
        self.weights = np.abs(self.differences).sum(axis=1)

    def rate(self, values: Numbers, error: float) -> Rate:
        """Return the rate of a quantity from its samples, shape (NODES, ...), with an error."""
        flat = values.reshape(NODES, -1)
        coefficients = np.sqrt(((self.coefficients @ flat) ** 2).sum(axis=1))
        noise = error + self.rounding * float(np.abs(flat).max())
        seen = np.maximum(coefficients, noise)
        # The slowest decay from one coefficient to the next of its parity, down to where they are noise.
        decay = float(
            (seen[3:] / np.maximum(seen[1:-2], np.finfo(float).tiny)).max(where=seen[3:] > 2.0 * noise, initial=0.0)
        )
        left_out = np.inf
        if decay <= SLOWEST:
            left_out = 4.0 * SLOWEST * _STEEPEST * float(max(coefficients[-1], coefficients[-2])) / self.half
        return Rate((self.differences @ flat).reshape(values.shape), self.weights * noise + left_out)


def check_window(ledger: Ledger, description: Description, freedoms: Freedoms, samples: Samples, half: float) -> None:
    """Compare rates with velocities, and accelerations with forces, in a window."""
    window = Window(samples.times, half, ledger.rounding)
    accelerations: dict[str, Acceleration] = {}
    motion = dict(samples.motion)
    unsure = np.zeros((freedoms.count, NODES))
    for name, body in description.bodies.items():
        pose, twist, error = samples.placement[name], samples.motion[name], samples.errors[name]
        going = window.rate(pose.position, error.position)
        _compare(ledger, "velocity", name, samples, going, twist.velocity, error.velocity)
        gain = window.rate(twist.velocity, error.velocity)
        first, spin_at = freedoms.where[name]
        unsure[first : first + description.dimension] = body.mass * gain.error
        if body.inertia is None:
            accelerations[name] = Acceleration(gain.value, None)
            continue
        largest = float(np.max(np.abs(body.inertia)))
        if twist.spin is None:
            spun = _of_top(description, samples, name, window)
            motion[name], angular = Twist(twist.velocity, spun[0].value), spun[1]
            speed = float(np.max(np.abs(spun[0].value)))
            unsure[spin_at : spin_at + 3] = largest * (angular.error + 4.0 * speed * spun[0].error)
        else:
            angular = window.rate(twist.spin, error.spin)
            speed = float(np.max(np.abs(twist.spin)))
            off = angular.error + 4.0 * speed * (error.spin + speed * error.attitude)
            unsure[spin_at : spin_at + freedoms.spins] = largest * off
            _check_attitude(ledger, samples, name, window)
        accelerations[name] = Acceleration(gain.value, angular.value)
    size = max(float(np.abs(pose.position).max()) for pose in samples.placement.values())
    size = max(size, *(connection.arm + connection.reach for connection in description.connections), 0.0)
    heaviest = max(body.mass for body in description.bodies.values())
    if not np.isfinite(unsure).all():
        # Rates that are not known in the window say nothing of the forces.
        return
    unsure += NOISE * heaviest * size * max(1.0, size) / half**2
    try:
        _balance(ledger, description, freedoms, samples, motion, accelerations, unsure)
    except Undefined:
        return


def _compare(
    ledger: Ledger, law: str, name: str, samples: Samples, rate: Rate, expected: Numbers, error: float
) -> None:
    off = (rate.value - expected).reshape(NODES, -1)
    size = ledger.rounding * np.abs(expected).reshape(NODES, -1).max(axis=1)
    ledger.compare(f"rate of place is {law}", name, samples.times, np.abs(off).max(axis=1), rate.error + error + size)


def _check_attitude(ledger: Ledger, samples: Samples, name: str, window: Window) -> None:
    """Compare the rate of an angle or an attitude with the spin."""
    pose, spin, error = samples.placement[name], samples.motion[name].spin, samples.errors[name]
    assert spin is not None, "the caller knows the spin"
    if pose.turn is not None:
        _compare(ledger, "spin", name, samples, window.rate(pose.turn, error.attitude), spin, error.spin)
        return
    if pose.rotation is None or not np.ptp(pose.rotation, axis=0).any():
        # A ball, of which no attitude is answered.
        return
    turning = window.rate(pose.rotation, error.attitude)
    product = turning.value @ np.swapaxes(pose.rotation, 1, 2)
    found = np.stack([product[:, 2, 1], product[:, 0, 2], product[:, 1, 0]], axis=1)
    _compare(ledger, "spin", name, samples, Rate(found, 2.0 * turning.error), spin, error.spin)


def _of_top(description: Description, samples: Samples, name: str, window: Window) -> tuple[Rate, Rate]:
    """Return spin and angular acceleration of a symmetric top in space, whose axis alone is answered.

    The component of the spin along the axis n is that of the start, for nothing turns it about its axis:
    w = n x n' + w_n n and w' = n x n'' + w_n n'.
    """
    body, pose, error = description.bodies[name], samples.placement[name], samples.errors[name]
    k = axis_of_top(body, description)
    about = 0.0 if body.angular_velocity is None else float(body.angular_velocity[k])
    assert pose.rotation is not None, "a top has an axis"
    n = pose.rotation[:, :, k]
    first = window.rate(n, error.attitude)
    second = window.rate(first.value, float(np.max(first.error)))
    spin = Rate(cross(n, first.value) + about * n, first.error + abs(about) * error.attitude)
    off = second.error + abs(about) * first.error + error.attitude * float(np.max(np.abs(second.value)))
    return spin, Rate(cross(n, second.value) + about * first.value, off)


def _balance(
    ledger: Ledger,
    description: Description,
    freedoms: Freedoms,
    samples: Samples,
    motion: dict[str, Twist],
    accelerations: dict[str, Acceleration],
    unsure: Numbers,
) -> None:
    found = balance(
        description, samples.placement, motion, accelerations, samples.forces, samples.force_errors, freedoms
    )
    left, allowed = np.abs(found.left()), found.allowed(unsure, ledger.rounding)
    if np.all(left <= allowed):
        ledger.checked += 1
        return
    allowed = allowed + _moved(description, samples, motion, accelerations)
    ratio = np.max(left - allowed, axis=0)
    worst = np.argmax(left - allowed, axis=0)
    rows = np.arange(len(ratio))
    k = int(np.argmax(ratio))
    where = freedoms.where
    name = max((name for name in where if where[name][0] <= worst[k]), key=lambda name: where[name][0])
    ledger.compare("Newton and Euler", name, samples.times, left[worst, rows], allowed[worst, rows])


def _moved(
    description: Description,
    samples: Samples,
    motion: dict[str, Twist],
    accelerations: dict[str, Acceleration],
) -> Numbers:
    """Return by how much the stated errors of places and rates change the equations, shape (freedoms, n)."""
    changed = Samples(
        samples.times, samples.placement, motion, samples.forces, samples.errors, samples.force_errors
    ).perturbed(description.bodies)
    count = next(iter(changed.placement.values())).position.shape[0]
    flat = changed.flattened()
    repeated = {
        name: Acceleration(
            np.tile(one.linear, (count, 1)),
            None if one.angular is None else np.tile(one.angular, (count, *(1,) * (one.angular.ndim - 1))),
        )
        for name, one in accelerations.items()
    }
    forces = {name: np.tile(values, count) for name, values in samples.forces.items()}
    left = balance(description, flat.placement, flat.motion, repeated, forces).left()
    left = left.reshape(left.shape[0], count, -1)
    moved: Numbers = 2.0 * np.abs(left[:, 1:] - left[:, :1]).sum(axis=1)
    return moved
