"""Space for what eight members compute at a time, and what their series in doubles and in pairs share.

Every operation is that of `motion.series` and `motion.series_pairs`, in the same order, so that each lane has the bits
of its member alone. What is zero there and left out is added here: that changes the sign of a zero at most.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np

from core.arrays import Floats, Integers
from core.compiled import fma, kernel
from core.double_double import dd_div_d
from core.lanes import WIDTH, alike, lanes_at, put_lanes
from core.multibody.members.lane_table import OF_LINE, OF_RATE, LaneForm
from core.multibody.motion.series import EARLY


class LaneSpace(NamedTuple):
    """Space of one run; planes are (value, tail), s is n + m.

    Attributes
    ----------
    x : ndarray, shape (numbers, 8)
        The numbers of the members in the lanes.
    q, v : (2, n, 8)
        States, as pairs.
    clock, h : (2, 8) and (8,)
        Times as pairs, and the steps.
    lines : (2, e, 8)
    path, rates : (planes, order + 1, n, 8)
        Coefficients of coordinates and of rates.
    pull : (planes, order + 1, m, 8)
        Those of multipliers.
    entries : (planes, order + 1, w, 8)
        Those of the entries of W that vary.
    right : (planes, s, 8)
    columns : (planes, s, s, 8)
        Of the inverse: column j at [:, j].
    rows, inverse : (s, s, 8)
    scale : (s, 8)
    whole : (s, s, 2, 8)
        The matrix in pairs; empty for doubles.
    residual : (m, 2, 8)
    inverses : (order + 1, 2)
        Inverses of the natural numbers.
    alive : (8,)
        1 for lanes whose member goes on.
    """

    x: Floats
    q: Floats
    v: Floats
    clock: Floats
    h: Floats
    lines: Floats
    path: Floats
    rates: Floats
    pull: Floats
    entries: Floats
    right: Floats
    columns: Floats
    rows: Floats
    inverse: Floats
    scale: Floats
    whole: Floats
    residual: Floats
    inverses: Floats
    alive: Integers


@kernel()
def lane_space(form: LaneForm, order: int, planes: int) -> LaneSpace:
    """Return space for the series of eight members."""
    n, m = form.n, form.m
    size, count = n + m, form.lines_at.shape[0]
    varying = 0
    for p in range(form.varying.shape[0]):
        varying = max(varying, form.varying[p, 1] + 1)
    inverses = np.zeros((order + 1, 2))
    for k in range(1, order + 1):
        inverses[k, 0], inverses[k, 1] = dd_div_d(1.0, 0.0, float(k))
    paired = size if planes == 2 else 0
    return LaneSpace(
        np.zeros((form.v + 2 * n, WIDTH)),
        np.zeros((2, n, WIDTH)),
        np.zeros((2, n, WIDTH)),
        np.zeros((2, WIDTH)),
        np.zeros(WIDTH),
        np.zeros((2, count, WIDTH)),
        np.zeros((planes, order + 1, n, WIDTH)),
        np.zeros((planes, order + 1, n, WIDTH)),
        np.zeros((planes, order + 1, m, WIDTH)),
        np.zeros((planes, order + 1, varying, WIDTH)),
        np.zeros((planes, size, WIDTH)),
        np.zeros((planes, size, size, WIDTH)),
        np.zeros((size, size, WIDTH)),
        np.zeros((size, size, WIDTH)),
        np.zeros((size, WIDTH)),
        np.zeros((paired, paired, 2, WIDTH)),
        np.zeros((m, 2, WIDTH)),
        inverses,
        np.zeros(WIDTH, dtype=np.int64),
    )


@kernel()
def lane_entries(form: LaneForm, space: LaneSpace) -> None:
    """Fill in the entries of W at the places, in doubles."""
    x, lines, q = space.x, space.lines[0], space.q[0]
    for e in range(lines.shape[0]):
        put_lanes(lines, WIDTH * e, lanes_at(x, WIDTH * (form.lines + 2 * e)))
    for p in range(form.varying.shape[0]):
        e = WIDTH * form.varying[p, 0]
        slope, place = lanes_at(x, WIDTH * (form.slopes + 2 * p)), lanes_at(q, WIDTH * form.varying[p, 2])
        put_lanes(lines, e, lanes_at(lines, e) + slope * place)


@kernel()
def lane_changes(form: LaneForm, space: LaneSpace, k: int) -> None:
    """Form coefficient k of the entries of W that vary, in doubles."""
    x, path, entries = space.x, space.path[0], space.entries[0]
    of_path, of_entries = k * WIDTH * form.n, k * WIDTH * entries.shape[1]
    for p in range(form.varying.shape[0]):
        e = of_entries + WIDTH * form.varying[p, 1]
        before = lanes_at(entries, e) if form.varying[p, 3] == 1 else alike(0.0)
        slope = lanes_at(x, WIDTH * (form.slopes + 2 * p))
        put_lanes(entries, e, fma(slope, lanes_at(path, of_path + WIDTH * form.varying[p, 2]), before))


@kernel(forceinline=True)
def _lane_sum(first: Floats, second: Floats, a: int, b: int, ahead: int, behind: int, k: int) -> float:
    """Return the sum of products of coefficients, those in the middle first, then the newest."""
    total = alike(0.0)
    for i in range(1, k):
        total = fma(lanes_at(first, a + ahead * i), lanes_at(second, b + behind * (k - i)), total)
    total = fma(lanes_at(first, a), lanes_at(second, b + behind * k), total)
    if k > 0:
        total = fma(lanes_at(first, a + ahead * k), lanes_at(second, b), total)
    return total


@kernel()
def lane_coefficients(form: LaneForm, space: LaneSpace, since: int) -> None:
    """Fill in the Taylor coefficients from since + 2 on, in doubles, the earlier ones being taken up."""
    n, m, x = form.n, form.m, space.x
    size = n + m
    path, rates, pull, entries = space.path[0], space.rates[0], space.pull[0], space.entries[0]
    right, columns = space.right[0], space.columns[0]
    of_path, of_pull, of_entries = WIDTH * n, WIDTH * m, WIDTH * entries.shape[1]
    last = path.shape[0] - 3
    for k in range(since, last + 1):
        for i in range(size):
            put_lanes(right, WIDTH * i, alike(0.0))
        if k == 0:
            for i in range(n):
                put_lanes(right, WIDTH * i, lanes_at(x, WIDTH * (form.load + 2 * i)))
        for p in range(form.stiff_at.shape[0]):
            i, j = WIDTH * form.stiff_at[p, 0], k * of_path + WIDTH * form.stiff_at[p, 1]
            factor = lanes_at(x, WIDTH * (form.stiff + 2 * p))
            put_lanes(right, i, lanes_at(right, i) - factor * lanes_at(path, j))
        for p in range(form.damp_at.shape[0]):
            i, j = WIDTH * form.damp_at[p, 0], (k + 1) * of_path + WIDTH * form.damp_at[p, 1]
            factor = lanes_at(x, WIDTH * (form.damp + 2 * p)) * alike(k + 1.0)
            put_lanes(right, i, lanes_at(right, i) - factor * lanes_at(path, j))
        for p in range(form.products.shape[0]):
            kind, row = form.products[p, 0], WIDTH * form.products[p, 1]
            a, b = WIDTH * form.products[p, 2], WIDTH * form.products[p, 3]
            if kind == OF_LINE:
                # The multiplier before the first is zero.
                total = alike(0.0)
                for i in range(1, k + 1):
                    of_line = lanes_at(entries, b + of_entries * (k - i + 1))
                    total = fma(lanes_at(pull, a + of_pull * (i - 1)), of_line, total)
                put_lanes(right, row, lanes_at(right, row) + total)
            elif kind == OF_RATE:
                total = _lane_sum(entries, rates, a + of_entries, b, of_entries, of_path, k)
                put_lanes(right, row, lanes_at(right, row) + total)
            else:
                total = _lane_sum(path, rates, a, b, of_path, of_path, k)
                put_lanes(right, row, fma(lanes_at(x, WIDTH * form.products[p, 4]), total, lanes_at(right, row)))
        for i in range(n, size):
            put_lanes(right, WIDTH * i, lanes_at(right, WIDTH * i) * alike(-(k + 1.0)))
        for i in range(size):
            total = alike(0.0)
            for j in range(size):
                total = fma(lanes_at(columns, WIDTH * (j * size + i)), lanes_at(right, WIDTH * j), total)
            if i < n:
                put_lanes(path, (k + 2) * of_path + WIDTH * i, total / alike((k + 1.0) * (k + 2.0)))
                put_lanes(rates, (k + 1) * of_path + WIDTH * i, total / alike(k + 1.0))
            else:
                put_lanes(pull, k * of_pull + WIDTH * (i - n), total)
        if k < last:
            lane_changes(form, space, k + 2)


@kernel()
def lane_steps(form: LaneForm, space: LaneSpace, tolerance: float) -> None:
    """Fill in the steps of all lanes: those of `motion.series.step_size` where no powers are missing."""
    n, path = form.n, space.path[0]
    order = path.shape[0] - 1
    # The last powers whose sizes are needed, behind those up to EARLY and one, in case these vanish.
    sizes = np.empty((order + 1, WIDTH))
    best = np.full(WIDTH, np.inf)
    share = math.log(tolerance)
    for g in range(5):
        present = False
        for i in range(n):
            present = present or form.group[i] == g
        if not present:
            continue
        for k in range(order + 1):
            if EARLY < k < order - 1:
                continue
            for lane in range(WIDTH):
                sizes[k, lane] = 0.0
            for i in range(n):
                if form.group[i] == g:
                    for lane in range(WIDTH):
                        sizes[k, lane] = max(sizes[k, lane], abs(path[k, i, lane]))
        for lane in range(WIDTH):
            nearest = 0.0 if g == 2 else math.log(sizes[0, lane])
            rate, gain = math.log(sizes[1, lane]), math.log(sizes[2, lane])
            for power in range(order, order - 2, -1):
                number = sizes[power, lane]
                if number > 0.0:
                    size = math.log(number)
                    scale = max(nearest, gain + 2.0 * (gain - size) / (power - 2))
                    scale = max(scale, rate + (rate - size) / (power - 1))
                    step = (scale - size) / power + share / power
                    for k in range(3, power):
                        if k > EARLY and step > -np.inf:
                            break
                        least = 0.0
                        if k <= EARLY or k >= order - 1:
                            least = sizes[k, lane]
                        else:
                            for i in range(n):
                                if form.group[i] == g:
                                    least = max(least, abs(path[k, i, lane]))
                        step = max(step, (math.log(least) - size) / (power - k) + share / (power - k))
                    if step > -np.inf:
                        best[lane] = min(best[lane], step)
    for lane in range(WIDTH):
        space.h[lane] = math.exp(best[lane])


@kernel()
def lane_inverse(form: LaneForm, space: LaneSpace) -> None:
    """Fill in the columns of the inverses in doubles, by elimination with scaled pivots; without one a lane ends."""
    n, x, a, out, scale, lines = form.n, space.x, space.rows, space.inverse, space.scale, space.lines[0]
    size = n + form.m
    for i in range(size):
        for j in range(size):
            put_lanes(a, WIDTH * (i * size + j), alike(0.0))
            put_lanes(out, WIDTH * (i * size + j), alike(1.0 if i == j else 0.0))
    for i in range(n):
        for j in range(n):
            put_lanes(a, WIDTH * (i * size + j), lanes_at(x, WIDTH * (form.mass + 2 * (i * n + j))))
    for e in range(lines.shape[0]):
        r, j = form.lines_at[e, 0], form.lines_at[e, 1]
        at = WIDTH * (j * size + n + r)
        put_lanes(a, at, lanes_at(a, at) - lanes_at(lines, WIDTH * e))
        if form.binds[e] == 1:
            put_lanes(a, WIDTH * ((n + r) * size + j), lanes_at(lines, WIDTH * e))
    for i in range(size):
        for lane in range(WIDTH):
            scale[i, lane] = 0.0
        for j in range(size):
            for lane in range(WIDTH):
                scale[i, lane] = max(scale[i, lane], abs(a[i, j, lane]))
        for lane in range(WIDTH):
            if not scale[i, lane] > 0.0:
                space.alive[lane] = 0
            scale[i, lane] = 1.0 / scale[i, lane]
    best, pivot = np.empty(WIDTH), np.empty(WIDTH, dtype=np.int64)
    for k in range(size):
        for lane in range(WIDTH):
            best[lane], pivot[lane] = -1.0, k
        for i in range(k, size):
            for lane in range(WIDTH):
                large = abs(a[i, k, lane]) * scale[i, lane]
                if large > best[lane]:
                    best[lane], pivot[lane] = large, i
        for lane in range(WIDTH):
            if not best[lane] > 1e-14:
                space.alive[lane] = 0
            p = pivot[lane]
            if p != k:
                for j in range(size):
                    a[k, j, lane], a[p, j, lane] = a[p, j, lane], a[k, j, lane]
                    out[k, j, lane], out[p, j, lane] = out[p, j, lane], out[k, j, lane]
                scale[p, lane] = scale[k, lane]
        factor = alike(1.0) / lanes_at(a, WIDTH * (k * size + k))
        for j in range(size):
            at = WIDTH * (k * size + j)
            put_lanes(a, at, lanes_at(a, at) * factor)
            put_lanes(out, at, lanes_at(out, at) * factor)
        for i in range(size):
            if i != k:
                factor = -lanes_at(a, WIDTH * (i * size + k))
                for j in range(size):
                    at, of = WIDTH * (i * size + j), WIDTH * (k * size + j)
                    # What lies left of the pivot is zero in its row.
                    if j >= k:
                        put_lanes(a, at, fma(factor, lanes_at(a, of), lanes_at(a, at)))
                    put_lanes(out, at, fma(factor, lanes_at(out, of), lanes_at(out, at)))
    columns = space.columns[0]
    for i in range(size):
        for j in range(size):
            put_lanes(columns, WIDTH * (j * size + i), lanes_at(out, WIDTH * (i * size + j)))
