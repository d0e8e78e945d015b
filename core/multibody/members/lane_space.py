"""Space for what eight members compute at a time, their states, and the inverses of their matrices in doubles.

Every operation is that of `motion.series` and `motion.series_pairs`, in the same order, so that each lane has the bits
of its member alone. What is zero there and left out is added here: that changes the sign of a zero at most.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from core.arrays import Floats, Integers
from core.compiled import fma, kernel
from core.double_double import dd_div_d
from core.lanes import WIDTH, alike, lanes_at, put_lanes
from core.multibody.members.lane_table import LaneForm


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
    series : (planes, order + 1, LaneForm.series, 8)
        Coefficients, so that coefficient k of every product is the sum of a_i b_{k-i}: those of multipliers stand one
        place later, behind a zero, those of the entries of W one place earlier.
    middle : (p', 8)
        Of the coefficients that follow of products, what is known of them one order before.
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
    series: Floats
    middle: Floats
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
        np.zeros((planes, order + 1, form.series, WIDTH)),
        np.zeros((form.products.shape[0], WIDTH)),
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
def take_up(form: LaneForm, space: LaneSpace, numbers: Floats, member: int, lane: int) -> None:
    """Put the numbers of a member into a lane, and its state at the start."""
    for i in range(space.x.shape[0]):
        space.x[i, lane] = numbers[member, i]
    space.clock[0, lane] = space.clock[1, lane] = 0.0
    put_back(form, space, lane)


@kernel()
def put_back(form: LaneForm, space: LaneSpace, lane: int) -> None:
    """Put a lane at the start of its member."""
    for i in range(form.n):
        for plane in range(2):
            space.q[plane, i, lane] = space.x[form.q + 2 * i + plane, lane]
            space.v[plane, i, lane] = space.x[form.v + 2 * i + plane, lane]


@kernel()
def begin_series(form: LaneForm, space: LaneSpace) -> None:
    """Take up the states of all lanes as the first coefficients of places and rates."""
    n = form.n
    for plane in range(space.series.shape[0]):
        series, q, v = space.series[plane], space.q[plane], space.v[plane]
        for i in range(n):
            put_lanes(series, WIDTH * i, lanes_at(q, WIDTH * i))
            put_lanes(series, WIDTH * (n + i), lanes_at(v, WIDTH * i))
            put_lanes(series, WIDTH * (form.series + i), lanes_at(v, WIDTH * i))


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
