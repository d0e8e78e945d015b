"""A second way to the torque-free motion, for judging the first: Taylor's series, step by step.

Euler's equations and the kinematics of the quaternion are quadratic, so every coefficient of the series is a sum of
products of earlier ones. These sums are FLINT's, in balls of which only the middles are used from one step to the next.

References
----------
.. [1] A. Jorba, M. Zou, A software package for the numerical integration of ODEs by means of high-order Taylor
   methods, Experimental Mathematics 14 (2005) 99: order and step size.
"""

from __future__ import annotations

from collections.abc import Sequence
from operator import mul

from flint import arb, arb_poly, ctx
from mpmath import mp, mpf

from .elliptic import real_of

State = list[mpf]


def rigid_body(moments: Sequence[float]) -> State:
    """Return the coefficients k of Euler's equations ``w1' = k1 w2 w3`` and cyclic."""
    a, b, c = map(mpf, moments)
    return [(b - c) / a, (c - a) / b, (a - b) / c]


def integrate(k: Sequence[mpf], start: Sequence[mpf], times: Sequence[float]) -> list[State]:
    """Integrate ``w1' = k1 w2 w3`` and cyclic, and the quaternion ``q' = q w / 2``, at the current precision.

    Parameters
    ----------
    k : sequence of 3 mpf
        Coefficients.
    start : sequence of 3 or 7 mpf
        Rates at ``t = 0`` and, if wanted, the quaternion [w, x, y, z].
    times : sequence of float
        In any order, of any sign.

    Returns
    -------
    list of list of mpf
        One state per time.
    """
    states: dict[float, State] = {}
    before, ctx.prec = ctx.prec, mp.prec + 30
    try:
        factors = list(map(arb, k))
        for direction in (1, -1):
            now, state = mpf(0), list(start)
            for time in sorted((t for t in set(times) if direction * t >= 0), key=abs):
                while now != time:
                    series = _coefficients(factors, state)
                    step = min(abs(time - now), _step(series))
                    state = [real_of(arb_poly(one)(arb(direction * step))) for one in series]
                    now = mpf(time) if step == abs(time - now) else now + direction * step
                states[time] = state
    finally:
        ctx.prec = before
    return [states[time] for time in times]


def _coefficients(k: Sequence[arb], state: State) -> list[list[arb]]:
    """Return the Taylor coefficients of every component."""
    series = [[arb(x)] for x in state]
    for n in range(round(1.15 * mp.dps) + 2):

        def convolution(i: int, j: int) -> arb:
            return sum(map(mul, series[i], reversed(series[j])), arb(0))

        rates = [k[i] * convolution((i + 1) % 3, (i + 2) % 3) for i in range(3)]
        if len(state) == 7:
            w, x, y, z = 3, 4, 5, 6
            rates += [
                -(convolution(x, 0) + convolution(y, 1) + convolution(z, 2)) / 2,
                (convolution(w, 0) + convolution(y, 2) - convolution(z, 1)) / 2,
                (convolution(w, 1) + convolution(z, 0) - convolution(x, 2)) / 2,
                (convolution(w, 2) + convolution(x, 1) - convolution(y, 0)) / 2,
            ]
        for coefficients, rate in zip(series, rates, strict=True):
            coefficients.append(rate / (n + 1))
    return series


def _step(series: list[list[arb]]) -> mpf:
    """Return the step at which the last two terms fall below the rounding unit of the state."""
    order = len(series[0]) - 1
    size, *last = (max(abs(real_of(c[n])) for c in series) for n in (0, order - 1, order))
    return min((mp.eps * size / term) ** (mpf(1) / n) for n, term in zip((order - 1, order), last, strict=True) if term)
