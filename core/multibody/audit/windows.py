"""Short windows of a motion, on which rates are formed by interpolation: velocities, and the laws of Newton and Euler.

A window is sampled at the zeros of a Chebyshev polynomial. The rate of the polynomial through the samples is as wrong
as the stated errors, times the sum of the sizes of the weights, and the first terms that are left out, for which the
decay of the coefficients gives a size.

References
----------
L. N. Trefethen, "Approximation Theory and Approximation Practice", chapters 3, 5, 8 and 21.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import accumulate

import numpy as np
from numpy.polynomial import chebyshev

from core.multibody.audit.definitions import Description
from core.multibody.audit.failure import NOISE, ROUNDING, Ledger
from core.multibody.audit.newton import Acceleration, Freedoms
from core.multibody.audit.placement import STEP, Numbers, Placement, cross
from core.multibody.audit.samples import ATTITUDE, SPIN, Samples, axis_of_top

NODES = 7
"""Samples of a window: with some seventh of a radian of motion in it, the eighth term is below 1e-12 of the first."""

SLOWEST = 0.05
"""Decay of the coefficients, two terms on, above which the terms that are left out are not known to be smaller."""

FORMULAS_KNOWN = 2.0**-30
"""Share of its largest value below which nothing is known of the terms of a formula."""

GRID = 2.0**20
"""Places of the samples in a window are multiples of its half width over this: their times are then doubles, and the
weights are the same in all windows."""

_ITSELF = np.eye(NODES, dtype=bool)
_PLACES = np.round(GRID * np.cos((2 * np.arange(NODES) + 1) * np.pi / (2 * NODES))[::-1]) / GRID
_COEFFICIENTS = np.linalg.inv(chebyshev.chebvander(_PLACES, NODES - 1))
"""From values at the places to coefficients of Chebyshev polynomials."""


def _weights() -> Numbers:
    """Return the matrix from values at the places to the rates of the polynomial, by the barycentric formula."""
    apart = np.where(_ITSELF, 1.0, _PLACES[:, None] - _PLACES)
    weights = 1.0 / apart.prod(axis=1)
    rates = np.where(_ITSELF, 0.0, weights / (weights[:, None] * apart))
    found: Numbers = rates - np.where(_ITSELF, rates.sum(axis=1), 0.0)
    return found


_DIFFERENCES = _weights()
_SIZES = np.abs(_DIFFERENCES).sum(axis=1)[:, None]
_STEEPEST = float(NODES**2)
"""Largest rate of the first term that is left out."""
_LEAST = float(np.finfo(float).tiny)
_UNDERFLOW = float(np.finfo(float).smallest_subnormal)
"""What a double is rounded by at least, however small it is: a place after 1e-310 s is none."""


def nodes(middle: float, half: float) -> Numbers:
    """Return the times of a window."""
    return middle + half * _PLACES


class Windows:
    """Forms rates from samples in windows.

    Parameters
    ----------
    halves : sequence of float
        Half of the width of each (s).
    rounding : float
        Share of themselves to which samples are known apart from stated errors.
    """

    def __init__(self, halves: Sequence[float], rounding: float = ROUNDING) -> None:
        self.half, self.rounding = np.array(halves)[:, None, None], rounding

    def rates(self, values: Numbers, starts: Numbers, errors: Numbers) -> tuple[Numbers, Numbers]:
        """Return the rates of several quantities, shape (n, components), and their errors, (n, quantities).

        Parameters
        ----------
        values : ndarray, shape (n, components)
            At the samples of all windows, one after another.
        starts : ndarray of int, shape (quantities,)
            The first component of every quantity.
        errors : ndarray, shape (quantities,)
        """
        parted = values.reshape(len(self.half), NODES, -1)
        found = _DIFFERENCES @ parted / self.half
        terms = np.sqrt(np.add.reduceat((_COEFFICIENTS @ parted) ** 2, starts, axis=2))
        sizes = np.maximum.reduceat(np.abs(parted).max(axis=1, keepdims=True), starts, axis=2)
        noise = errors + self.rounding * sizes + _UNDERFLOW
        seen = np.maximum(terms, noise)
        # The slowest decay from one coefficient to the next of its parity, down to where they are noise.
        ratios = seen[:, 3:] / np.maximum(seen[:, 1:-2], _LEAST)
        decay = ratios.max(axis=1, where=seen[:, 3:] > 2.0 * noise, initial=0.0)
        last = 4.0 * SLOWEST * _STEEPEST * np.maximum(terms[:, -1], terms[:, -2])
        known = (_SIZES * noise + np.where(decay <= SLOWEST, last, np.inf)[:, None]) / self.half
        return found.reshape(values.shape), known.reshape(len(values), -1)


@dataclass(frozen=True)
class _Quantity:
    """One quantity of a body in windows.

    Attributes
    ----------
    values : ndarray, shape (n, k)
    error : float
    expected : ndarray, shape (n, k), or None
        Its rate, where the answer has it: that of places.
    known : float
        Error of that rate.
    rate : int
        Number of that rate among the velocities and spins.
    """

    law: str
    body: str
    values: Numbers
    error: float
    expected: Numbers | None = None
    known: float = 0.0
    rate: int = 0


@dataclass(frozen=True)
class Gains:
    """Accelerations in windows, and how wrong the equations of motion may be for them.

    Attributes
    ----------
    accelerations : mapping of str to Acceleration
    spins : mapping of str to ndarray
        Of tops: their angular velocities, of which the answer has the axis alone.
    unsure : ndarray, shape (freedoms, n)
    """

    accelerations: dict[str, Acceleration]
    spins: dict[str, Numbers]
    unsure: Numbers


def check_windows(
    ledger: Ledger,
    description: Description,
    freedoms: Freedoms,
    samples: Samples,
    ahead: Placement,
    halves: Sequence[float],
    extent: float,
) -> Gains:
    """Compare rates with velocities in windows, and return the accelerations in them.

    Parameters
    ----------
    samples : Samples
        Those of all windows, one after another.
    ahead : mapping of str to Pose
        The placement moved by an imaginary step along the motion.
    halves : sequence of float
        Half of the width of each (s).
    extent : float
        Size of the scene (m).
    """
    windows = Windows(halves, ledger.rounding)
    places, speeds = _quantities(samples, ahead)
    every = [*places, *speeds]
    starts = np.array([0, *accumulate(one.values.shape[1] for one in every[:-1])])
    values = np.concatenate([one.values for one in every], axis=1)
    found, errors = windows.rates(values, starts, np.array([one.error for one in every]))
    _check_kinematics(ledger, samples, places, starts, found, errors)
    return _gains(description, freedoms, samples, windows, (speeds, starts, found, errors, len(places)), extent)


def _quantities(samples: Samples, ahead: Placement) -> tuple[list[_Quantity], list[_Quantity]]:
    """Return places and attitudes, whose rates the answer has, and velocities and spins."""
    places: list[_Quantity] = []
    speeds: list[_Quantity] = []
    count = len(samples.times)
    for name, pose in samples.placement.items():
        twist, (position, attitude, velocity, spinning) = samples.motion[name], samples.errors[name][0].tolist()
        law, spin = "rate of place is spin", None if twist.spin is None else twist.spin.reshape(count, -1)
        which = len(speeds)
        moves = "rate of place is velocity"
        places.append(_Quantity(moves, name, pose.position, position, twist.velocity, velocity, which))
        speeds.append(_Quantity("velocity", name, twist.velocity, velocity))
        if spin is None:
            continue
        speeds.append(_Quantity("spin", name, spin, spinning))
        turned = ahead[name].rotation
        if pose.turn is not None:
            places.append(_Quantity(law, name, pose.turn[:, None], attitude, spin, spinning, which + 1))
        elif turned is not None and name in samples.placed:
            axes = turned.reshape(count, 9)
            places.append(_Quantity(law, name, axes.real, 2.0 * attitude, axes.imag / STEP, spinning, which + 1))
    return places, speeds


def _check_kinematics(
    ledger: Ledger, samples: Samples, places: list[_Quantity], starts: Numbers, found: Numbers, errors: Numbers
) -> None:
    expected = np.concatenate([one.expected for one in places if one.expected is not None], axis=1)
    own = starts[: len(places)]
    off = np.maximum.reduceat(np.abs(found[:, : expected.shape[1]] - expected), own, axis=1)
    size = np.maximum.reduceat(np.abs(expected), own, axis=1)
    allowed = errors[:, : len(places)] + np.array([one.known for one in places]) + ledger.rounding * size
    # A place has one power of the time more than its rate, and is resolved in a window no better.
    rates = errors[:, [len(places) + one.rate for one in places]]
    allowed = np.where(np.isfinite(rates), allowed, np.inf)
    ledger.checked += 1
    within = off <= allowed
    if within.all():
        return
    for k in np.flatnonzero(~within.all(axis=0)).tolist():
        ledger.compare(places[k].law, places[k].body, samples.times, off[:, k], allowed[:, k])


def _gains(
    description: Description,
    freedoms: Freedoms,
    samples: Samples,
    windows: Windows,
    rates: tuple[list[_Quantity], Numbers, Numbers, Numbers, int],
    extent: float,
) -> Gains:
    speeds, starts, found, errors, first = rates
    linear: dict[str, Numbers] = {}
    angular: dict[str, Numbers] = {}
    spins: dict[str, Numbers] = {}
    unsure = np.empty((freedoms.count, len(samples.times)))
    for k, one in enumerate(speeds, start=first):
        name, body, gain = one.body, description.bodies[one.body], found[:, starts[k] : starts[k] + one.values.shape[1]]
        if one.law == "velocity":
            linear[name] = gain
            unsure[freedoms.moving(name)] = body.mass * errors[:, k]
            continue
        angular[name] = gain if freedoms.spins == 3 else gain[:, 0]
        speed, error = float(np.abs(one.values).max()), samples.errors[name][0]
        off = errors[:, k] + 4.0 * speed * (error[SPIN] + speed * error[ATTITUDE])
        unsure[freedoms.turning(name)] = body.moment * off
    for name, body in description.bodies.items():
        if body.inertia is None or name in angular:
            continue
        spins[name], angular[name], off = _of_top(description, samples, name, windows)
        unsure[freedoms.turning(name)] = body.moment * off
    heaviest = max(body.mass for body in description.bodies.values())
    # Of windows and bodies near the ends of the doubles nothing is known.
    noise = NOISE * heaviest * extent * max(1.0, extent) / windows.half[:, 0, 0] / windows.half[:, 0, 0]
    unsure += np.repeat(np.where(np.isfinite(noise), noise, np.inf), NODES)
    unsure += np.repeat(_of_corners(description, samples, windows), NODES)
    return Gains({name: Acceleration(one, angular.get(name)) for name, one in linear.items()}, spins, unsure)


def _of_corners(description: Description, samples: Samples, windows: Windows) -> Numbers:
    """Return infinity for the windows in which a formula has a corner, as drag has where a body turns back, else zero.

    The velocity hides it: its first terms are smooth, and what follows them does not decay as they do.
    """
    found, own = np.zeros(len(windows.half)), Windows(windows.half[:, 0, 0].tolist(), FORMULAS_KNOWN)
    for formula in (one for connection in description.connections for one in connection.formulas):
        values = np.broadcast_to(formula.value(samples.placement, samples.motion), samples.times.shape)[:, None]
        _, known = own.rates(values, np.zeros(1, dtype=int), np.zeros(1))
        found += np.where(np.isfinite(known).reshape(-1, NODES).all(axis=1), 0.0, np.inf)
    return found


def _of_top(
    description: Description, samples: Samples, name: str, windows: Windows
) -> tuple[Numbers, Numbers, Numbers]:
    """Return spin, angular acceleration and how wrong its rate is, of a top in space, whose axis alone is answered.

    The component of the spin along the axis n is that of the start, for nothing turns it about its axis:
    w = n x n' + w_n n and w' = n x n'' + w_n n'.
    """
    body, pose, error = description.bodies[name], samples.placement[name], samples.errors[name][0, ATTITUDE]
    k = axis_of_top(body, description)
    about = 0.0 if body.angular_velocity is None else float(body.angular_velocity[k])
    assert pose.rotation is not None, "a top has an axis"
    n, whole = pose.rotation[:, :, k], np.zeros(1, dtype=int)
    first, known = windows.rates(n, whole, np.array([error]))
    largest = known.reshape(-1, NODES, 1).max(axis=1, keepdims=True)
    second, gained = windows.rates(first, whole, largest)
    spin = cross(n, first) + about * n
    off = gained + abs(about) * known + error * np.abs(second).max()
    off += 4.0 * np.abs(spin).max() * (known + abs(about) * error)
    return spin, cross(n, second) + about * first, off[:, 0]
