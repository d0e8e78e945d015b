"""Where a motion passes through a section of its states: zeros of polynomials in pairs, found step by step."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from core.arrays import Floats
from core.compiled import kernel
from core.double_double import Pair, dd_add, dd_mul, dd_mul_d
from core.multibody.algebra.pair_arrays import gathered, settled
from core.multibody.equations.packed import Packed
from core.multibody.motion.numerical import Run
from core.multibody.motion.series import FULL
from core.multibody.motion.series_pairs import advance_pairs, moved_pairs

MOST_STEPS = 400
"""Steps within which a motion has to return to count as one that repeats."""

_CHUNK = 6
_PARTS = 8


@dataclass(frozen=True)
class Section:
    """Where a motion is looked for again: the zeros of normal . (q - origin), or of normal . (q' - origin).

    Attributes
    ----------
    normal : ndarray, shape (n,)
    origin : ndarray, shape (n, 2)
    of_rates : bool
    sign : float
        Sign of the function just after the start.
    """

    normal: Floats
    origin: Floats
    of_rates: bool
    sign: float


class Passage(NamedTuple):
    """A zero: its time as a pair, and places and rates there."""

    time: Floats
    q: Floats
    v: Floats


def followed(
    arrays: Packed,
    start: tuple[Floats, Floats],
    section: Section,
    done: Callable[[list[Passage]], bool],
    order: int,
    tolerance: float,
) -> tuple[Run, list[Passage]] | None:
    """Return the steps up to a return, and the passages through the section; None if there is no return."""
    q, v = start[0].copy(), start[1].copy()
    clock = np.zeros(2)
    starts: list[Floats] = []
    series: list[Floats] = []
    passages: list[Passage] = []
    sign, zeros = section.sign, np.empty((_PARTS, 2))
    while len(series) * _CHUNK < MOST_STEPS:
        chunk_starts, chunk = np.empty((_CHUNK + 1, 2)), np.empty((_CHUNK, len(q), order + 1, 2))
        ended, count = advance_pairs(arrays, q, v, clock, 1e300, tolerance, chunk_starts, chunk)
        if ended != FULL:
            return None
        for step in range(count):
            width = (chunk_starts[step + 1, 0] - chunk_starts[step, 0]) + chunk_starts[step + 1, 1]
            found, sign = _zeros(chunk[step], width, section.origin, section.normal, section.of_rates, sign, zeros)
            for local in zeros[:found]:
                end, rate = np.empty_like(q), np.empty_like(v)
                moved_pairs(chunk[step], local[0], local[1], end, rate)
                time = np.array(added(chunk_starts[step], local))
                passages.append(Passage(time, end, rate))
                if done(passages):
                    starts.extend([chunk_starts[: step + 1], time[None, :]])
                    series.append(chunk[: step + 1])
                    return Run(np.concatenate(starts), np.concatenate(series)), passages
        starts.append(chunk_starts[:count])
        series.append(chunk[:count])
    return None


@kernel()
def _along(series: Floats, origin: Floats, normal: Floats, of_rates: bool, curve: Floats) -> None:
    """Fill in the section's function of the time within a step, a polynomial of shape (order + 1, 2)."""
    n, order = series.shape[0], series.shape[1] - 1
    lowest = 1 if of_rates else 0
    curve[:] = 0.0
    for k in range(lowest, order + 1):
        sh, sl = 0.0, 0.0
        for i in range(n):
            ch, cl = series[i, k, 0], series[i, k, 1]
            if k == lowest:
                ch, cl = dd_add(ch, cl, -origin[i, 0], -origin[i, 1])
            sh, sl = gathered(sh, sl, ch, cl, normal[i], 0.0)
        sh, sl = settled(sh, sl)
        if of_rates:
            sh, sl = dd_mul_d(sh, sl, float(k))
        curve[k - lowest, 0], curve[k - lowest, 1] = sh, sl


@kernel()
def _value(curve: Floats, hh: float, hl: float) -> Pair:
    sh, sl = 0.0, 0.0
    for k in range(curve.shape[0] - 1, 0, -1):
        sh, sl = dd_add(sh, sl, curve[k, 0], curve[k, 1])
        sh, sl = dd_mul(sh, sl, hh, hl)
    return dd_add(sh, sl, curve[0, 0], curve[0, 1])


@kernel()
def _slope(curve: Floats, time: float) -> float:
    slope = 0.0
    for k in range(curve.shape[0] - 1, 0, -1):
        slope = slope * time + k * curve[k, 0]
    return slope


@kernel()
def _root(curve: Floats, low: float, high: float, before: float) -> Pair:
    """Return a zero between two times: bisection in doubles, then Newton's method in pairs."""
    for _ in range(40):
        middle = 0.5 * (low + high)
        if _value(curve, middle, 0.0)[0] * before > 0.0:
            low = middle
        else:
            high = middle
    th, tl = 0.5 * (low + high), 0.0
    slope = _slope(curve, th)
    if slope != 0.0:
        for _ in range(4):
            left, tail = _value(curve, th, tl)
            th, tl = dd_add(th, tl, -left / slope, -tail / slope)
    return th, tl


@kernel()
def _zeros(
    series: Floats, width: float, origin: Floats, normal: Floats, of_rates: bool, sign: float, times: Floats
) -> tuple[int, float]:
    """Fill in the zeros in a step as pairs, shape (parts, 2); return how many they are, and the sign at its end."""
    curve = np.empty((series.shape[1], 2))
    _along(series, origin, normal, of_rates, curve)
    count, last, parts = 0, 0.0, times.shape[0]
    for part in range(1, parts + 1):
        time = width * part / parts
        value = _value(curve, time, 0.0)[0]
        if sign * value < 0.0:
            times[count, 0], times[count, 1] = _root(curve, last, time, sign)
            count += 1
        if value != 0.0:
            sign, last = math.copysign(1.0, value), time
    return count, sign


def distance(first: Floats, second: Floats, indices: Sequence[int] | range) -> float:
    """Return the largest difference of two arrays of pairs among some entries."""
    each = np.abs((first[:, 0] - second[:, 0]) + (first[:, 1] - second[:, 1]))
    return float(max((each[i] for i in indices), default=0.0))


def added(first: Sequence[float] | Floats, second: Sequence[float] | Floats) -> tuple[float, float]:
    """Return the sum of two pairs."""
    high, low = dd_add(float(first[0]), float(first[1]), float(second[0]), float(second[1]))
    return high, low
