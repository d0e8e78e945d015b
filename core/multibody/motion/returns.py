"""Where a motion passes through a section of its states: zeros of polynomials in pairs, found step by step."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from core.arrays import Floats
from core.compiled import kernel
from core.double_double import dd_add, dd_mul, dd_mul_d
from core.multibody.algebra.bernstein import (
    FALLING,
    MOST_SEGMENTS,
    NEGATIVE,
    POSITIVE,
    RISING,
    decided,
    one_sign,
    zero_between,
)
from core.multibody.algebra.pair_arrays import gathered, settled
from core.multibody.equations.packed import Packed
from core.multibody.motion.run import Run
from core.multibody.motion.series import FULL
from core.multibody.motion.series_pairs import advance_pairs, moved_pairs

MOST_STEPS = 400
"""Steps within which a motion has to return to count as one that repeats."""

PLACES, RATES, POWER = 0, 1, 2
"""Functions of a section."""

_CHUNK = 6
"""Steps that are made before the section is looked for on them: most often a return is within a few."""

_MOST_ZEROS = 64
"""Of one step."""
_ROUNDED = 2.0**-96
"""Share of its terms that a function is wrong by: a thousand roundings of pairs."""
_LEFT_OUT = 2.0**-6
"""Share of the last coefficient but two that the powers left out are at most, as coefficients fall by eight."""


@dataclass(frozen=True)
class Section:
    """Where a motion is looked for again.

    Attributes
    ----------
    normal : ndarray, shape (n,)
    origin : ndarray, shape (n, 2)
    kind : {PLACES, RATES, POWER}
        The zeros of normal . (q - origin), of normal . (q' - origin), or of q' . q'' of the coordinates whose normal is
        not zero. What turns back on its path does so at a simple zero of the last, wherever the path has turned to.
    sign : float
        Sign of the function just after the start.
    """

    normal: Floats
    origin: Floats
    kind: int
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
    sign, zeros = section.sign, np.empty((_MOST_ZEROS, 2))
    while len(series) * _CHUNK < MOST_STEPS:
        chunk_starts, chunk = np.empty((_CHUNK + 1, 2)), np.empty((_CHUNK, len(q), order + 1, 2))
        ended, count = advance_pairs(arrays, q, v, clock, 1e300, tolerance, chunk_starts, chunk)
        if ended != FULL:
            return None
        function, step = (section.origin, section.normal, section.kind), 0
        while step < count:
            step, found, sign = _next_zeros(chunk_starts, chunk, step, count, *function, sign, not starts, zeros)
            for local in zeros[:found]:
                end, rate = np.empty_like(q), np.empty_like(v)
                moved_pairs(chunk[step], local[0], local[1], end, rate)
                time = np.array(added(chunk_starts[step], local))
                passages.append(Passage(time, end, rate))
                if done(passages):
                    starts.extend([chunk_starts[: step + 1], time[None, :]])
                    series.append(chunk[: step + 1])
                    return Run(np.concatenate(starts), np.concatenate(series)), passages
            step += 1
        starts.append(chunk_starts[:count])
        series.append(chunk[:count])
    return None


@kernel()
def _along(series: Floats, origin: Floats, normal: Floats, kind: int, curve: Floats, sizes: Floats) -> None:
    """Fill in the section's function of the time within a step, pairs of shape (order + 1, 2), and its terms' sizes."""
    n, order = series.shape[0], series.shape[1] - 1
    lowest = 1 if kind == RATES else 0
    for k in range(order + 1):
        curve[k, 0], curve[k, 1], sizes[k] = 0.0, 0.0, 0.0
    if kind == POWER:
        for i in range(n):
            if normal[i] == 0.0:
                continue
            for k in range(order - 1):
                sh, sl, size = curve[k, 0], curve[k, 1], 0.0
                for a in range(k + 1):
                    # (a + 1) q_{a+1} (b + 1) (b + 2) q_{b+2}
                    b = k - a
                    factor = (a + 1.0) * (b + 1.0) * (b + 2.0)
                    rh, rl = dd_mul_d(series[i, a + 1, 0], series[i, a + 1, 1], factor)
                    ph, pl = dd_mul(rh, rl, series[i, b + 2, 0], series[i, b + 2, 1])
                    sh, sl = dd_add(sh, sl, ph, pl)
                    size += abs(ph)
                curve[k, 0], curve[k, 1] = sh, sl
                sizes[k] += size
        return
    for k in range(lowest, order + 1):
        sh, sl, size = 0.0, 0.0, 0.0
        for i in range(n):
            ch, cl = series[i, k, 0], series[i, k, 1]
            size += abs(ch * normal[i])
            if k == lowest:
                ch, cl = dd_add(ch, cl, -origin[i, 0], -origin[i, 1])
            sh, sl = gathered(sh, sl, ch, cl, normal[i], 0.0)
        sh, sl = settled(sh, sl)
        if kind == RATES:
            sh, sl = dd_mul_d(sh, sl, float(k))
            size *= k
        curve[k - lowest, 0], curve[k - lowest, 1], sizes[k - lowest] = sh, sl, size


@kernel()
def _next_zeros(
    starts: Floats,
    series: Floats,
    step: int,
    count: int,
    origin: Floats,
    normal: Floats,
    kind: int,
    sign: float,
    fresh: bool,
    times: Floats,
) -> tuple[int, int, float]:
    """Go on from a step to the first of `count` in which the sign changes; fill in where, as `_zeros` does.

    Return that step, `count` where there is none, with how often the sign changes and the last sign. The motion starts
    with step 0 where the steps are `fresh`.
    """
    for k in range(step, count):
        width = (starts[k + 1, 0] - starts[k, 0]) + starts[k + 1, 1]
        first = fresh and k == 0
        if first or not _keeps(series[k], width, origin, normal, kind, sign):
            found, sign = _zeros(series[k], width, origin, normal, kind, sign, first, times)
            if found > 0:
                return k, found, sign
    return count, 0, sign


@kernel()
def _keeps(series: Floats, width: float, origin: Floats, normal: Floats, kind: int, sign: float) -> bool:
    """Return whether doubles show that the section's function keeps its sign in a step."""
    n, order = series.shape[0], series.shape[1] - 1
    curve, sizes = np.zeros(order + 1), np.zeros(order + 1)
    speed, gain = np.empty(order), np.empty(order - 1)
    for i in range(n):
        if normal[i] == 0.0:
            continue
        if kind == POWER:
            for k in range(order):
                speed[k] = (k + 1.0) * series[i, k + 1, 0]
            for k in range(order - 1):
                gain[k] = (k + 1.0) * speed[k + 1]
            for k in range(order - 1):
                for a in range(k + 1):
                    term = speed[a] * gain[k - a]
                    curve[k] += term
                    sizes[k] += abs(term)
        else:
            lowest = 1 if kind == RATES else 0
            for k in range(lowest, order + 1):
                term = series[i, k, 0]
                sizes[k - lowest] += abs(term * normal[i]) * max(k, 1)
                if k == lowest:
                    term = (term - origin[i, 0]) + (series[i, k, 1] - origin[i, 1])
                curve[k - lowest] += term * normal[i] * (k if kind == RATES else 1)
    at, size = 1.0, 0.0
    for k in range(order + 1):
        curve[k], sizes[k] = curve[k] * at, sizes[k] * at
        size += sizes[k]
        at *= width
    left_out = max(sizes[order], max(sizes[order - 1], sizes[order - 2]) * _LEFT_OUT)
    return one_sign(curve, left_out + _ROUNDED * size, size) == int(sign)


@kernel()
def _zeros(
    series: Floats, width: float, origin: Floats, normal: Floats, kind: int, sign: float, start: bool, times: Floats
) -> tuple[int, float]:
    """Fill in where the sign changes in a step, as pairs of shape (zeros, 2); return how often, and the last sign.

    At the start of the motion the function is zero by construction, which counts for none.
    """
    order = series.shape[1] - 1
    curve, sizes = np.empty((order + 1, 2)), np.empty(order + 1)
    _along(series, origin, normal, kind, curve, sizes)
    # Powers of two change no digit of a pair.
    length, factor = 2.0 ** math.ceil(math.log2(width)), 1.0
    for k in range(order + 1):
        curve[k, 0], curve[k, 1], sizes[k] = curve[k, 0] * factor, curve[k, 1] * factor, sizes[k] * factor
        factor *= length
    for k in range(order - 1, -1, -1):
        # What is even in time has odd powers of rounding alone.
        sizes[k] = max(sizes[k], sizes[k + 1])
    shift = 0
    if start:
        while shift <= order and abs(curve[shift, 0]) <= _ROUNDED * sizes[shift]:
            shift += 1
        if shift > order:
            return 0, sign
        for k in range(order + 1):
            inside = k + shift <= order
            curve[k, 0] = curve[k + shift, 0] if inside else 0.0
            curve[k, 1] = curve[k + shift, 1] if inside else 0.0
            sizes[k] = sizes[k + shift] if inside else 0.0
    left_out = max(sizes[order - shift], sizes[max(order - shift - 2, 0)] * _LEFT_OUT)
    band = sizes * _ROUNDED
    ends, signs = np.empty(MOST_SEGMENTS), np.empty(MOST_SEGMENTS, dtype=np.int64)
    segments = decided(curve, band, left_out, order + 1 - shift, width / length, ends, signs, False)
    count, low, since = 0, 0.0, 0.0
    for segment in range(segments):
        end, what = ends[segment], signs[segment]
        crosses = what in (FALLING, RISING)
        before = sign
        if low * length >= width:
            break
        if what in (POSITIVE, FALLING):
            before = 1.0
        elif what in (NEGATIVE, RISING):
            before = -1.0
        if before != sign and count < len(times):
            # It changed where it is too small to be told from zero.
            times[count, 0], times[count, 1] = 0.5 * (since + low), 0.0
            count += 1
        sign = before
        if crosses:
            zh, zl = zero_between(curve, low, end)
            if zh * length > width:
                break
            if count < len(times):
                times[count, 0], times[count, 1] = zh, zl
                count += 1
            sign = -sign
        low = end
        if what in (POSITIVE, NEGATIVE) or crosses:
            since = end
    for k in range(count):
        times[k, 0], times[k, 1] = dd_mul_d(times[k, 0], times[k, 1], length)
    return count, sign


def distance(first: Floats, second: Floats, indices: Sequence[int] | range) -> float:
    """Return the largest difference of two arrays of pairs among some entries."""
    each = np.abs((first[:, 0] - second[:, 0]) + (first[:, 1] - second[:, 1]))
    return float(max((each[i] for i in indices), default=0.0))


def added(first: Sequence[float] | Floats, second: Sequence[float] | Floats) -> tuple[float, float]:
    """Return the sum of two pairs."""
    high, low = dd_add(float(first[0]), float(first[1]), float(second[0]), float(second[1]))
    return high, low
