"""Where a motion passes through a section of its states: zeros of polynomials in pairs, found step by step."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from core.compiled import kernel
from core.double_double import Pair, dd_add
from core.multibody.numerical import Run
from core.multibody.packed import Floats, Packed
from core.multibody.pair_arrays import gathered, settled
from core.multibody.series import FULL
from core.multibody.series_pairs import advance_pairs, moved_pairs

MOST_STEPS = 400
"""Steps within which a motion has to return to count as one that repeats."""

_CHUNK = 16
_PARTS = 8


@dataclass(frozen=True)
class Section:
    """Where a motion is looked for again: the zeros of normal . (q - q_0), or of normal . q', the start apart.

    Attributes
    ----------
    normal : ndarray, shape (n,)
    of_rates : bool
    sign : float
        Sign of the function just after the start.
    """

    normal: Floats
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
    sign = section.sign
    while len(series) * _CHUNK < MOST_STEPS:
        chunk_starts, chunk = np.empty((_CHUNK + 1, 2)), np.empty((_CHUNK, len(q), order + 1, 2))
        ended, count = advance_pairs(arrays, q, v, clock, 1e300, tolerance, chunk_starts, chunk)
        if ended != FULL:
            return None
        for step in range(count):
            width = (chunk_starts[step + 1, 0] - chunk_starts[step, 0]) + chunk_starts[step + 1, 1]
            changes, sign = _sign_changes(chunk[step], width, start[0], section, sign)
            for low, high, before in changes:
                local = _root(chunk[step], low, high, before, start[0], section)
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


def _sign_changes(
    series: Floats, width: float, origin: Floats, section: Section, sign: float
) -> tuple[list[tuple[float, float, float]], float]:
    """Return brackets of the zeros in a step with the sign before each, and the sign at its end."""
    found = []
    last = 0.0
    for part in range(1, _PARTS + 1):
        time = width * part / _PARTS
        value = _value(series, time, 0.0, origin, section.normal, section.of_rates)[0]
        if sign * value < 0.0:
            found.append((last, time, sign))
        if value != 0.0:
            sign, last = math.copysign(1.0, value), time
    return found, sign


def _root(
    series: Floats, low: float, high: float, before: float, origin: Floats, section: Section
) -> tuple[float, float]:
    """Return a zero in a step as a pair: bisection in doubles, then Newton's method in pairs."""

    def value(hh: float, hl: float) -> Pair:
        return _value(series, hh, hl, origin, section.normal, section.of_rates)

    for _ in range(40):
        middle = 0.5 * (low + high)
        if value(middle, 0.0)[0] * before > 0.0:
            low = middle
        else:
            high = middle
    time: tuple[float, float] = (0.5 * (low + high), 0.0)
    slope = _slope(series, time[0], section.normal, section.of_rates)
    for _ in range(4):
        if slope == 0.0:
            break
        left = value(*time)
        time = added(time, (-left[0] / slope, -left[1] / slope))
    return time


@kernel()
def _value(series: Floats, hh: float, hl: float, origin: Floats, normal: Floats, of_rates: bool) -> Pair:
    n = series.shape[0]
    q, v = np.empty((n, 2)), np.empty((n, 2))
    moved_pairs(series, hh, hl, q, v)
    sh, sl = 0.0, 0.0
    for i in range(n):
        if of_rates:
            sh, sl = gathered(sh, sl, v[i, 0], v[i, 1], normal[i], 0.0)
        else:
            dh, dl = dd_add(q[i, 0], q[i, 1], -origin[i, 0], -origin[i, 1])
            sh, sl = gathered(sh, sl, dh, dl, normal[i], 0.0)
    return settled(sh, sl)


@kernel()
def _slope(series: Floats, h: float, normal: Floats, of_rates: bool) -> float:
    total = 0.0
    n, order = series.shape[0], series.shape[1] - 1
    for i in range(n):
        rate = 0.0
        if of_rates:
            for k in range(order, 1, -1):
                rate = rate * h + k * (k - 1) * series[i, k, 0]
        else:
            for k in range(order, 0, -1):
                rate = rate * h + k * series[i, k, 0]
        total += rate * normal[i]
    return total


def distance(first: Floats, second: Floats, indices: Sequence[int] | range) -> float:
    """Return the largest difference of two arrays of pairs among some entries."""
    each = np.abs((first[:, 0] - second[:, 0]) + (first[:, 1] - second[:, 1]))
    return float(max((each[i] for i in indices), default=0.0))


def added(first: Sequence[float] | Floats, second: Sequence[float] | Floats) -> tuple[float, float]:
    """Return the sum of two pairs."""
    high, low = dd_add(float(first[0]), float(first[1]), float(second[0]), float(second[1]))
    return high, low
