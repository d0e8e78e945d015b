"""How a load may be shared among places that stick in space, where friction is a round cone.

The share with the largest margin t, mu N - |F| >= t of what sticks and N >= t of what does not, is found by Newton's
method along the central path of the barrier -log((mu N - t)^2 - |F|^2). What holds it back is a certificate: a sum of
the pushes and frictions, each within its dual cone, in which the share cancels, so that it cannot be negative where
some share is admissible.

References
----------
S. Boyd, L. Vandenberghe, "Convex Optimization" (2004), sections 11.2 and 11.6.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from core.arrays import Floats

MARGINAL = 2.0**-36
"""Share of the largest force by which a margin of zero may be missed; the certificate is right to some 1e-13 of it."""
_GAP = 2.0**-28
"""Share of the largest force by which the margin of the last centre may be less than the largest: nearer to the cones
differences of squares leave no digits, and half of those of doubles are enough for the certificate to be polished."""
_ROUND = 1e-5
"""By how much less than one a direction may be long that is on the boundary of its cone."""
_POLISHED = 8
"""Gauss-Newton steps, of which each doubles the digits."""
_STEEPER = 100.0
"""By how much the margin counts more from one centre to the next."""
_NEWTON_STEPS_OF_A_CENTRE = 40
"""Of every centre: a few are needed where the one before was found."""
_FULL_STEPS_FROM = 0.05
"""Squared Newton decrement from which on full steps converge quadratically (Boyd and Vandenberghe, section 9.6.4)."""
_SHORTEST = 2.0**-30
"""Of a full step: shorter ones are rounding."""
_DECREMENT = 1e-4
"""Squared Newton decrement at which a centre is near enough for the next, and for the certificate to be polished."""
_LARGEST_ADDED = 1e4
"""Bound of what is added to the forces, as a share of the largest: squeezed bodies have no best share."""


@dataclass(frozen=True)
class Cone:
    """A condition on unknown forces, by their numbers.

    Attributes
    ----------
    push : int
        A normal force, at least zero.
    static : float
        Coefficient of friction, one where nothing sticks.
    rubs : tuple of int
        One component of friction or two, whose root of squares is at most the coefficient times the push; none where
        nothing sticks.
    """

    push: int
    static: float = 1.0
    rubs: tuple[int, ...] = ()


@dataclass(frozen=True)
class BestShare:
    """The share with the largest margin.

    Attributes
    ----------
    margin : float
        As a share of the largest force, at most one: the value of the certificate.
    free : ndarray, shape (f,)
        Multiples of the forces that may be added.
    weights : ndarray, shape (cones,)
        Of what holds it back: of static times the push of every cone.
    directions : ndarray, shape (cones, 2)
        Of the components of friction beside it, of length one at most.
    """

    margin: float
    free: Floats
    weights: Floats
    directions: Floats


class _Barrier:
    """The barrier of cones over z = (x, t): multiples x of what may be added, and the margin t."""

    def __init__(self, cones: Sequence[Cone], start: Floats, shares: Floats) -> None:
        count, free = len(cones), shares.shape[1]
        # The last is the bound t <= 1.
        self.a, self.slope_a = np.ones(count + 1), np.zeros((count + 1, free + 1))
        self.f, self.slope_f = np.zeros((count + 1, 2)), np.zeros((count + 1, 2, free + 1))
        self.slope_a[:, -1] = -1.0
        for k, cone in enumerate(cones):
            self.a[k] = cone.static * start[cone.push]
            self.slope_a[k, :-1] = cone.static * shares[cone.push]
            for i, rub in enumerate(cone.rubs):
                self.f[k, i], self.slope_f[k, i, :-1] = start[rub], shares[rub]
        self.curved = 2.0 * (
            np.einsum("ki,kj->kij", self.slope_a, self.slope_a) - np.einsum("kci,kcj->kij", self.slope_f, self.slope_f)
        )

    def at(self, z: Floats) -> tuple[Floats, Floats, Floats]:
        """Return mu N - t and F of every cone, and the difference of their squares."""
        a, f = self.a + self.slope_a @ z, self.f + self.slope_f @ z
        size = np.hypot(f[:, 0], f[:, 1])
        return a, f, (a - size) * (a + size)

    def inside(self, z: Floats) -> bool:
        """Return whether all cones hold with the margin."""
        a, _, rest = self.at(z)
        return bool(np.all(a > 0.0) and np.all(rest > 0.0) and z[:-1] @ z[:-1] < _LARGEST_ADDED**2)

    def centre(self, z: Floats, steepness: float) -> Floats:
        """Return the centre for a steepness, from one near by."""
        for _ in range(_NEWTON_STEPS_OF_A_CENTRE):
            a, f, rest = self.at(z)
            slopes = 2.0 * (a[:, None] * self.slope_a - np.einsum("kc,kci->ki", f, self.slope_f)) / rest[:, None]
            gradient = -np.sum(slopes, axis=0)
            gradient[-1] -= steepness
            hessian = slopes.T @ slopes - np.einsum("kij,k->ij", self.curved, 1.0 / rest)
            room = _LARGEST_ADDED**2 - float(z[:-1] @ z[:-1])
            away = 2.0 * z[:-1] / room
            gradient[:-1] += away
            hessian[:-1, :-1] += np.outer(away, away) + 2.0 / room * np.eye(len(away))
            step = -np.linalg.lstsq(hessian, gradient, rcond=None)[0]
            decrement = -float(gradient @ step)
            if not decrement > _DECREMENT:
                break
            # A barrier is self-concordant: steps damped so stay inside, but for rounding.
            length = 1.0 if decrement < _FULL_STEPS_FROM else 1.0 / (1.0 + decrement**0.5)
            while not self.inside(z + length * step) and length > _SHORTEST:
                length *= 0.5
            if length <= _SHORTEST:
                break
            z = z + length * step
        return z


def best_share(cones: Sequence[Cone], start: Floats, shares: Floats) -> BestShare:
    """Return the best share of a load.

    Parameters
    ----------
    cones : sequence of Cone
    start : ndarray, shape (n,)
        Forces that balance the load.
    shares : ndarray, shape (n, f)
        Forces that may be added in any multiple.
    """
    scale = float(np.max(np.abs(start), initial=0.0)) or 1.0
    barrier = _Barrier(cones, start / scale, shares)
    z = np.zeros(shares.shape[1] + 1)
    a, f, _ = barrier.at(z)
    z[-1] = float(np.min((a - np.hypot(f[:, 0], f[:, 1]))[:-1], initial=0.0)) - 1.0
    steepness = 1.0
    while True:
        z = barrier.centre(z, steepness)
        if 2 * len(a) / steepness < _GAP:
            break
        steepness *= _STEEPER
    a, f, rest = (x[:-1] for x in barrier.at(z))
    weights, directions = 2.0 * a / rest / steepness, -f / a[:, None]
    if np.sum(weights) < 0.5:
        # The bound of the margin holds it back, and not the cones.
        return BestShare(1.0, scale * z[:-1], np.zeros(len(cones)), directions)
    # What is farther from the boundary of its cone than it holds back does not hold back at all.
    weights = np.where(a - np.hypot(f[:, 0], f[:, 1]) < weights, weights, 0.0)
    weights, directions = _polished(barrier, weights / np.sum(weights), directions)
    value = float(weights @ barrier.a[:-1] + np.sum(weights[:, None] * directions * barrier.f[:-1]))
    return BestShare(min(value, 1.0), scale * z[:-1], weights, directions)


def _polished(barrier: _Barrier, weights: Floats, directions: Floats) -> tuple[Floats, Floats]:
    """Return weights and directions near by in whose sum no share is left, by the Gauss-Newton method.

    Directions on the boundary of their cones turn on it: a sum so found is less than a gap squared above the least.
    """
    slope_a, slope_f = barrier.slope_a[:-1, :-1], barrier.slope_f[:-1, :, :-1]
    turning = np.hypot(directions[:, 0], directions[:, 1]) > 1.0 - _ROUND
    directions = np.where(
        turning[:, None], directions / np.maximum(np.hypot(*directions.T), _ROUND)[:, None], directions
    )
    for _ in range(_POLISHED):
        along = slope_a + np.einsum("kc,kci->ki", directions, slope_f)
        left = np.append(weights @ along, np.sum(weights) - 1.0)
        across = np.einsum("kc,kci->ki", np.stack([-directions[:, 1], directions[:, 0]], axis=1), slope_f)
        holds = (weights > 0.0)[:, None]
        moves = [
            np.where(holds, np.hstack([along, np.ones((len(weights), 1))]), 0.0),
            np.hstack([np.where(turning, weights, 0.0)[:, None] * across, np.zeros((len(weights), 1))]),
            *(
                np.hstack([np.where(turning, 0.0, weights)[:, None] * slope_f[:, c], np.zeros((len(weights), 1))])
                for c in range(2)
            ),
        ]
        more, angle, *inner = np.split(-np.linalg.lstsq(np.vstack(moves).T, left, rcond=1e-12)[0], 4)
        weights = np.maximum(weights + more, 0.0)
        cosine, sine = np.cos(angle), np.sin(angle)
        directions = np.stack(
            [
                cosine * directions[:, 0] - sine * directions[:, 1] + inner[0],
                sine * directions[:, 0] + cosine * directions[:, 1] + inner[1],
            ],
            axis=1,
        )
    return weights, directions
