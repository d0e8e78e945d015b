"""Short windows of a motion, on which rates are formed by interpolation: velocities, and the laws of Newton and Euler.

A window is sampled at the zeros of a Chebyshev polynomial. The rate of the polynomial through the samples is as wrong
as the stated errors, times the sum of the sizes of the weights, and the first terms that are left out, for which the
decay of the coefficients gives a size.

References
----------
L. N. Trefethen, "Approximation Theory and Approximation Practice", chapters 3, 5, 8 and 21.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.polynomial import chebyshev

from core.multibody.audit.definitions import Description
from core.multibody.audit.failure import NOISE, ROUNDING, Ledger
from core.multibody.audit.newton import Acceleration, Freedoms
from core.multibody.audit.placement import STEP, Numbers, Placement, Twist, cross
from core.multibody.audit.samples import ATTITUDE, POSITION, SPIN, VELOCITY, Samples, axis_of_top

NODES = 7
"""Samples of a window: with some seventh of a radian of motion in it, the eighth term is below 1e-12 of the first."""

SLOWEST = 0.05
"""Decay of the coefficients, two terms on, above which the terms that are left out are not known to be smaller."""

_PLACES = np.cos((2 * np.arange(NODES) + 1) * np.pi / (2 * NODES))[::-1]
_COEFFICIENTS = np.linalg.inv(chebyshev.chebvander(_PLACES, NODES - 1))
"""From values at the places to coefficients of Chebyshev polynomials."""

_STEEPEST = float(NODES**2)
"""Largest rate of the first term that is left out."""
_ITSELF = np.eye(NODES, dtype=bool)


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
        places = (times - (times[0] + times[-1]) / 2.0) / half
        self.away = places - _PLACES
        # The weights of the barycentric formula give those of the rate.
        apart = np.where(_ITSELF, 1.0, places[:, None] - places)
        weights = 1.0 / apart.prod(axis=1)
        rates = np.where(_ITSELF, 0.0, weights / (weights[:, None] * apart))
        self.differences = (rates - np.where(_ITSELF, rates.sum(axis=1), 0.0)) / half
        self.weights = np.abs(self.differences).sum(axis=1)

    def rates(self, values: Numbers, starts: Numbers, errors: Numbers) -> tuple[Numbers, Numbers]:
        """Return the rates of several quantities, shape (NODES, components), and their errors, (NODES, quantities).

        Parameters
        ----------
        values : ndarray, shape (NODES, components)
        starts : ndarray of int, shape (quantities,)
            The first component of every quantity.
        errors : ndarray, shape (quantities,)
        """
        found = self.differences @ values
        # To first order the values at the zeros themselves.
        coefficients = _COEFFICIENTS @ (values - (self.half * self.away)[:, None] * found)
        terms = np.sqrt(np.add.reduceat(coefficients**2, starts, axis=1))
        noise = errors + self.rounding * np.maximum.reduceat(np.abs(values).max(axis=0), starts)
        seen = np.maximum(terms, noise)
        # The slowest decay from one coefficient to the next of its parity, down to where they are noise.
        ratios = seen[3:] / np.maximum(seen[1:-2], np.finfo(float).tiny)
        decay = ratios.max(axis=0, where=seen[3:] > 2.0 * noise, initial=0.0)
        last = 4.0 * SLOWEST * _STEEPEST * np.maximum(terms[-1], terms[-2]) / self.half
        return found, self.weights[:, None] * noise + np.where(decay <= SLOWEST, last, np.inf)

    def rate(self, values: Numbers, error: float) -> Rate:
        """Return the rate of a quantity from its samples, shape (NODES, ...), with an error."""
        found, known = self.rates(values.reshape(NODES, -1), np.zeros(1, dtype=int), np.array([error]))
        return Rate(found.reshape(values.shape), known[:, 0])


@dataclass(frozen=True)
class _Quantity:
    """One quantity of a body in a window.

    Attributes
    ----------
    values : ndarray, shape (NODES, k)
    error : float
    expected : ndarray, shape (NODES, k), or None
        Its rate, where the answer has it: that of places.
    known : float
        Error of that rate.
    """

    law: str
    body: str
    values: Numbers
    error: float
    expected: Numbers | None = None
    known: float = 0.0


@dataclass(frozen=True)
class Gains:
    """Accelerations in a window, and how wrong the equations of motion may be for them.

    Attributes
    ----------
    accelerations : mapping of str to Acceleration
    spins : mapping of str to ndarray
        Of tops: their angular velocities, of which the answer has the axis alone.
    unsure : ndarray, shape (freedoms, NODES)
    """

    accelerations: dict[str, Acceleration]
    spins: dict[str, Twist]
    unsure: Numbers


def check_window(
    ledger: Ledger,
    description: Description,
    freedoms: Freedoms,
    samples: Samples,
    ahead: Placement,
    half: float,
    extent: float,
) -> Gains:
    """Compare rates with velocities in a window, and return the accelerations in it.

    Parameters
    ----------
    ahead : mapping of str to Pose
        The placement moved by an imaginary step along the motion.
    half : float
        Half of the width (s).
    extent : float
        Size of the scene (m).
    """
    window = Window(samples.times, half, ledger.rounding)
    places, speeds = _quantities(samples, ahead)
    every = [*places, *speeds]
    widths = [one.values.shape[1] for one in every]
    starts = np.concatenate([[0], np.cumsum(widths[:-1])])
    values = np.concatenate([one.values for one in every], axis=1)
    found, errors = window.rates(values, starts, np.array([one.error for one in every]))
    _check_kinematics(ledger, samples, places, starts, found, errors)
    rates = (speeds, starts[len(places) :], found, errors[:, len(places) :])
    return _gains(description, freedoms, samples, window, rates, extent)


def _quantities(samples: Samples, ahead: Placement) -> tuple[list[_Quantity], list[_Quantity]]:
    """Return places and attitudes, whose rates the answer has, and velocities and spins."""
    places: list[_Quantity] = []
    speeds: list[_Quantity] = []
    for name, pose in ahead.items():
        twist, error = samples.motion[name], samples.errors[name][0]
        own = [("velocity", pose.position, error[POSITION], error[VELOCITY])]
        if pose.turn is not None:
            own.append(("spin", pose.turn[:, None], error[ATTITUDE], error[SPIN]))
        elif pose.rotation is not None and twist.spin is not None and name in samples.placed:
            own.append(("spin", pose.rotation.reshape(NODES, 9), 2.0 * error[ATTITUDE], error[SPIN]))
        places.extend(
            _Quantity(f"rate of place is {law}", name, at.real, known, at.imag / STEP, rate)
            for law, at, known, rate in own
        )
        speeds.append(_Quantity("velocity", name, twist.velocity, error[VELOCITY]))
        if twist.spin is not None:
            speeds.append(_Quantity("spin", name, twist.spin.reshape(NODES, -1), error[SPIN]))
    return places, speeds


def _check_kinematics(
    ledger: Ledger, samples: Samples, places: list[_Quantity], starts: Numbers, found: Numbers, errors: Numbers
) -> None:
    expected = np.concatenate([one.expected for one in places if one.expected is not None], axis=1)
    own = starts[: len(places)]
    off = np.maximum.reduceat(np.abs(found[:, : expected.shape[1]] - expected), own, axis=1)
    size = np.maximum.reduceat(np.abs(expected), own, axis=1)
    allowed = errors[:, : len(places)] + np.array([one.known for one in places]) + ledger.rounding * size
    ledger.checked += 1
    for k in np.flatnonzero(~(off <= allowed).all(axis=0)).tolist():
        ledger.compare(places[k].law, places[k].body, samples.times, off[:, k], allowed[:, k])


def _gains(
    description: Description,
    freedoms: Freedoms,
    samples: Samples,
    window: Window,
    rates: tuple[list[_Quantity], Numbers, Numbers, Numbers],
    extent: float,
) -> Gains:
    speeds, starts, found, errors = rates
    linear: dict[str, Numbers] = {}
    angular: dict[str, Numbers] = {}
    spins: dict[str, Twist] = {}
    unsure = np.zeros((freedoms.count, NODES))
    for k, one in enumerate(speeds):
        name, body, gain = one.body, description.bodies[one.body], found[:, starts[k] : starts[k] + one.values.shape[1]]
        first, spin_at = freedoms.where[name]
        if one.law == "velocity":
            linear[name] = gain
            unsure[first : first + description.dimension] = body.mass * errors[:, k]
            continue
        assert body.inertia is not None, "what spins has inertia"
        angular[name] = gain.reshape(one.values.shape) if freedoms.spins == 3 else gain[:, 0]
        speed, error = float(np.abs(one.values).max()), samples.errors[name][0]
        off = errors[:, k] + 4.0 * speed * (error[SPIN] + speed * error[ATTITUDE])
        unsure[spin_at : spin_at + freedoms.spins] = float(np.abs(body.inertia).max()) * off
    for name, body in description.bodies.items():
        if body.inertia is None or name in angular:
            continue
        spin, gained = _of_top(description, samples, name, window)
        angular[name], spins[name] = gained.value, Twist(samples.motion[name].velocity, spin.value)
        speed, spin_at = float(np.abs(spin.value).max()), freedoms.where[name][1]
        off = gained.error + 4.0 * speed * spin.error
        unsure[spin_at : spin_at + 3] = float(np.abs(body.inertia).max()) * off
    heaviest = max(body.mass for body in description.bodies.values())
    with np.errstate(over="ignore", divide="ignore", invalid="ignore"):
        # Of windows and bodies near the ends of the doubles nothing is known.
        noise = NOISE * np.float64(heaviest) * extent * max(1.0, extent) / window.half / window.half
    unsure += noise if np.isfinite(noise) else np.inf
    return Gains({name: Acceleration(one, angular.get(name)) for name, one in linear.items()}, spins, unsure)


def _of_top(description: Description, samples: Samples, name: str, window: Window) -> tuple[Rate, Rate]:
    """Return spin and angular acceleration of a symmetric top in space, whose axis alone is answered.

    The component of the spin along the axis n is that of the start, for nothing turns it about its axis:
    w = n x n' + w_n n and w' = n x n'' + w_n n'.
    """
    body, pose, error = description.bodies[name], samples.placement[name], samples.errors[name][0, ATTITUDE]
    k = axis_of_top(body, description)
    about = 0.0 if body.angular_velocity is None else float(body.angular_velocity[k])
    assert pose.rotation is not None, "a top has an axis"
    n = pose.rotation[:, :, k]
    first = window.rate(n, error)
    second = window.rate(first.value, float(np.max(first.error)))
    spin = Rate(cross(n, first.value) + about * n, first.error + abs(about) * error)
    off = second.error + abs(about) * first.error + error * float(np.max(np.abs(second.value)))
    return spin, Rate(cross(n, second.value) + about * first.value, off)
