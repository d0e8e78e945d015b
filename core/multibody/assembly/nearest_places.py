"""The nearest places, in doubles, at which measures vanish: Newton's method on the manifold of these places.

Least is the sum over the bodies of the mean square of the displacements of their points. In natural coordinates that is
a constant quadratic form: for every body its mass matrix over its mass.

References
----------
P.-A. Absil, R. Mahony, R. Sepulchre, "Optimization Algorithms on Matrix Manifolds" (2008), chapter 6.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from core.arrays import Floats
from core.multibody.assembly.quadratics import SHORTEST, STEPS, Quadratics, vanish, vanishing

RANK = 2.0**-24
"""Singular value, relative to the largest, from which on a row is redundant: half the digits of doubles."""

STATIONARY = 2.0**-40
"""Gradient along the manifold at which the iteration ends; balls go on from there."""

FLAT = 2.0**-20
"""Least curvature, relative to the largest, that a Newton step is taken with; flatter directions get this one."""

OTHER_STARTS = 6
"""Places beside the sketch from which others are looked for."""


@dataclass(frozen=True)
class NearestPlace:
    """Places where all measures vanish.

    Attributes
    ----------
    q : ndarray, shape (n,)
    distance : float
        From the sketch (m).
    """

    q: Floats
    distance: float


@dataclass(frozen=True)
class Sketch:
    """Places that measures are to be met near.

    Attributes
    ----------
    measures : Quadratics
    q : ndarray, shape (n,)
        As they were given.
    across : ndarray, shape (n, f)
        Changes of the coordinates by changes of size one of what may change.
    counts : ndarray, shape (f,)
        One for what counts as displacement, zero for what follows from it.
    """

    measures: Quadratics
    q: Floats
    across: Floats
    counts: Floats

    def nearest_from(self, start: Floats) -> NearestPlace | None:
        """Return the places at which the displacement is least near a start; None where the measures are not met.

        Parameters
        ----------
        start : ndarray, shape (f,)
            Change from the sketch.
        """
        q = vanishing(self.measures, self.q + self.across @ start, self.across)
        if not vanish(self.measures, q):
            return None
        for _ in range(STEPS):
            lines = self.measures.jacobian(q) @ self.across
            left, sizes, right = np.linalg.svd(lines, full_matrices=True)
            rank = int(np.sum(sizes > RANK * sizes.max(initial=0.0)))
            free = right[rank:].T
            away = self.counts * self._change(q)
            slope = free.T @ away
            if not free.size or np.abs(slope).max() <= STATIONARY * np.abs(away).max(initial=1e-300):
                break
            weights = left[:, :rank] @ (right[:rank] @ -away / sizes[:rank])
            curvature = np.diag(self.counts) + self.across.T @ self.measures.curvature(weights) @ self.across
            bends, axes = np.linalg.eigh(free.T @ curvature @ free)
            bends = np.maximum(np.abs(bends), FLAT * np.abs(bends).max(initial=0.0))
            step = -self.across @ (free @ (axes @ (axes.T @ slope / bends)))
            further = self._shortened(q, step)
            if further is None:
                break
            q = further
        return NearestPlace(q, self.distance(q))

    def distance(self, q: Floats) -> float:
        """Return the displacement of places (m)."""
        return float(np.linalg.norm(self.counts * self._change(q)))

    @cached_property
    def _back(self) -> Floats:
        return np.asarray(np.linalg.pinv(self.across), dtype=np.float64)

    def _change(self, q: Floats) -> Floats:
        found: Floats = self._back @ (q - self.q)
        return found

    def _shortened(self, q: Floats, step: Floats) -> Floats | None:
        """Return the places after as much of a step as brings them nearer, None if none does."""
        share, before = 1.0, self.distance(q)
        while share >= SHORTEST:
            further = vanishing(self.measures, q + share * step, self.across)
            if vanish(self.measures, further) and self.distance(further) < before:
                return further
            share /= 2.0
        return None

    def found(self, spread: float) -> list[NearestPlace]:
        """Return the places that were found from the sketch and from places beside it, the nearest first.

        Parameters
        ----------
        spread : float
            How far beside it (m).
        """
        # A fixed seed: the same sketch has the same answer.
        random = np.random.default_rng(20)
        starts = [np.zeros(len(self.counts))]
        starts += [spread * self.counts * random.uniform(-1.0, 1.0, len(self.counts)) for _ in range(OTHER_STARTS)]
        found: list[NearestPlace] = []
        for start in starts:
            one = self.nearest_from(start)
            if one is None:
                continue
            apart = [np.linalg.norm(self._change(one.q) - self._change(other.q)) for other in found]
            if min(apart, default=np.inf) > 1e-6 * max(spread, one.distance):
                found.append(one)
        return sorted(found, key=lambda one: one.distance)
