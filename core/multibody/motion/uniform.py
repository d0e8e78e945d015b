"""Constant acceleration: no quadratic measures, no stiffness, no damping."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from core.arrays import Floats
from core.compiled import kernel
from core.double_double import dd_add, dd_mul_d
from core.multibody.algebra.polynomials import Ball
from core.multibody.equations.packed import pair
from core.multibody.motion.motion import BallState, ElementaryTerm, Motion, States
from core.multibody.table.table import Table


@dataclass(frozen=True)
class Uniform(Motion):
    """q = q_0 + v_0 t + a t^2/2, evaluated in pairs."""

    table: Table
    acceleration: Sequence[Ball]
    name: str = "constant acceleration"
    why: str = "the geometry is linear and no force depends on place or velocity"
    how: str = "closed form"
    period: Ball | None = None
    uniform: bool = True

    @cached_property
    def _numbers(self) -> list[Floats]:
        return [
            np.array([pair(x, 0) for x in values]).reshape(-1, 2)
            for values in (self.table.q, self.table.v, self.acceleration)
        ]

    def states(self, times: Floats, *, finer: bool = False) -> States:
        """Return the states, right to the last bit of a pair or so."""
        numbers = self._numbers
        n = len(self.table.q)
        q, v = np.empty((len(times), n, 2)), np.empty((len(times), n, 2))
        start, rate, gain = numbers
        _evaluate(start, rate, gain, np.ascontiguousarray(times, dtype=np.float64), q, v)
        t = np.abs(times)[:, None]
        place, fast, pull = (np.abs(x[:, 0])[None, :] for x in numbers)
        q_error = 2.0**-100 * (place + fast * t + pull * t * t)
        return States(q, v, q_error, 2.0**-100 * (fast + pull * t))

    def elementary(self) -> list[list[ElementaryTerm]]:
        """Return the coordinates as polynomials in time."""
        numbers = zip(self.table.q, self.table.v, self.acceleration, strict=True)
        return [[ElementaryTerm(x), ElementaryTerm(y, 1), ElementaryTerm(a / 2, 2)] for x, y, a in numbers]

    def in_balls(self, times: Sequence[Ball]) -> list[BallState]:
        """Return the states, which are polynomials in time."""
        numbers = list(zip(self.table.q, self.table.v, self.acceleration, strict=True))
        return [
            BallState([x + t * (y + t * a / 2) for x, y, a in numbers], [y + t * a for _, y, a in numbers])
            for t in times
        ]


@kernel()
def _evaluate(start: Floats, rate: Floats, gain: Floats, times: Floats, q: Floats, v: Floats) -> None:
    for s in range(times.shape[0]):
        t = times[s]
        for i in range(start.shape[0]):
            gh, gl = dd_mul_d(gain[i, 0], gain[i, 1], t)
            v[s, i, 0], v[s, i, 1] = dd_add(rate[i, 0], rate[i, 1], gh, gl)
            hh, hl = dd_add(rate[i, 0], rate[i, 1], 0.5 * gh, 0.5 * gl)
            hh, hl = dd_mul_d(hh, hl, t)
            q[s, i, 0], q[s, i, 1] = dd_add(start[i, 0], start[i, 1], hh, hl)
