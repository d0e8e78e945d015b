"""The motion of eight members at a time in pairs: the operations of `motion.series_pairs.advance_pairs` in lanes."""

from __future__ import annotations

import math

import numpy as np

from core.arrays import Floats
from core.compiled import fma, kernel
from core.double_double import Pair, dd_add, dd_mul, dd_mul_d, fast_two_sum
from core.lanes import WIDTH, alike, lanes_at, put_lanes
from core.multibody.algebra.pair_arrays import gathered, settled
from core.multibody.algebra.square_inverse import SUMMED_BELOW
from core.multibody.members.lane_doubles import add_corrections, add_residual
from core.multibody.members.lane_motion import following
from core.multibody.members.lane_series import lane_coefficients
from core.multibody.members.lane_space import LaneSpace, lane_inverse
from core.multibody.members.lane_table import LaneForm
from core.multibody.motion.series_pairs import moved_lanes, moved_pairs, paired_coefficients


@kernel()
def _expand(form: LaneForm, space: LaneSpace, tolerance: float) -> None:
    """Fill in the Taylor coefficients; a lane ends in which one is no number."""
    order = space.series.shape[1] - 1
    _changes(form, space, 1)
    _coefficients(form, space, paired_coefficients(order, tolerance))
    for lane in range(WIDTH):
        for i in range(form.n):
            if not math.isfinite(space.series[0, order, i, lane]):
                space.alive[lane] = 0


@kernel()
def _entries(form: LaneForm, space: LaneSpace) -> None:
    """Fill in the entries of W at the places."""
    x, high, low, q, tail = space.x, space.lines[0], space.lines[1], space.q, WIDTH * form.n
    for e in range(high.shape[0]):
        at = WIDTH * (form.lines + 2 * e)
        put_lanes(high, WIDTH * e, lanes_at(x, at))
        put_lanes(low, WIDTH * e, lanes_at(x, at + WIDTH))
    for p in range(form.varying.shape[0]):
        e, i, at = WIDTH * form.varying[p, 0], WIDTH * form.varying[p, 2], WIDTH * (form.slopes + 2 * p)
        ph, pl = dd_mul(lanes_at(x, at), lanes_at(x, at + WIDTH), lanes_at(q, i), lanes_at(q, tail + i))
        sh, sl = dd_add(lanes_at(high, e), lanes_at(low, e), ph, pl)
        put_lanes(high, e, sh)
        put_lanes(low, e, sl)


@kernel()
def _changes(form: LaneForm, space: LaneSpace, k: int) -> None:
    """Form coefficient k of the entries of W that vary."""
    x, high, low, of_power = space.x, space.series[0], space.series[1], WIDTH * form.series
    for p in range(form.varying.shape[0]):
        e, i = (k - 1) * of_power + WIDTH * form.varying[p, 1], k * of_power + WIDTH * form.varying[p, 2]
        at = WIDTH * (form.slopes + 2 * p)
        sh, sl = dd_mul(lanes_at(x, at), lanes_at(x, at + WIDTH), lanes_at(high, i), lanes_at(low, i))
        if form.varying[p, 3] == 1:
            sh, sl = dd_add(lanes_at(high, e), lanes_at(low, e), sh, sl)
        put_lanes(high, e, sh)
        put_lanes(low, e, sl)


@kernel(forceinline=True)
def _add(high: Floats, low: Floats, row: int, ah: float, al: float, bh: float, bl: float) -> None:
    """Add a product to a row of the right-hand side."""
    sh, sl = gathered(lanes_at(high, row), lanes_at(low, row), ah, al, bh, bl)
    put_lanes(high, row, sh)
    put_lanes(low, row, sl)


@kernel(forceinline=True)
def _sum(high: Floats, low: Floats, a: int, b: int, behind: int, of_power: int) -> Pair:
    """Return the sum of products of coefficients, those in the middle first, then the newest."""
    sh, sl = alike(0.0), alike(0.0)
    for step in range(of_power, behind + 2 * of_power, of_power):
        # Those of the newest coefficients, 0 and k, come last.
        up = step if step < behind else 0 if step == behind or behind == 0 else behind
        c, d = a + up, b + behind - up
        sh, sl = gathered(sh, sl, lanes_at(high, c), lanes_at(low, c), lanes_at(high, d), lanes_at(low, d))
    return sh, sl


@kernel()
def _coefficients(form: LaneForm, space: LaneSpace, until: int) -> None:
    """Fill in the Taylor coefficients up to until + 1 in pairs, and the others in doubles."""
    n, size, x = form.n, form.n + form.m, space.x
    high, low = space.series[0], space.series[1]
    right, right_tail, columns, columns_tail = space.right[0], space.right[1], space.columns[0], space.columns[1]
    of_power, powers = WIDTH * form.series, space.series.shape[1]
    zero = alike(0.0)
    for k in range(until + 2, powers):
        for i in range(0, WIDTH * n, WIDTH):
            put_lanes(low, k * of_power + i, zero)
    for k in range(until):
        now = k * of_power
        for i in range(size):
            put_lanes(right, WIDTH * i, zero)
            put_lanes(right_tail, WIDTH * i, zero)
        if k == 0:
            for i in range(n):
                put_lanes(right, WIDTH * i, lanes_at(x, WIDTH * (form.load + 2 * i)))
                put_lanes(right_tail, WIDTH * i, lanes_at(x, WIDTH * (form.load + 2 * i + 1)))
        for p in range(form.stiff_at.shape[0]):
            i, j = WIDTH * form.stiff_at[p, 0], now + WIDTH * form.stiff_at[p, 1]
            ah, al = lanes_at(x, WIDTH * (form.stiff + 2 * p)), lanes_at(x, WIDTH * (form.stiff + 2 * p + 1))
            _add(right, right_tail, i, -ah, -al, lanes_at(high, j), lanes_at(low, j))
        for p in range(form.products.shape[0]):
            row, at = WIDTH * form.products[p, 0], WIDTH * form.products[p, 3]
            sh, sl = _sum(high, low, WIDTH * form.products[p, 1], WIDTH * form.products[p, 2], now, of_power)
            _add(right, right_tail, row, lanes_at(x, at), lanes_at(x, at + WIDTH), sh, sl)
        for i in range(size):
            sh, sl = settled(lanes_at(right, WIDTH * i), lanes_at(right_tail, WIDTH * i))
            if i >= n:
                sh, sl = dd_mul_d(sh, sl, alike(-(k + 1.0)))
            put_lanes(right, WIDTH * i, sh)
            put_lanes(right_tail, WIDTH * i, sl)
        first_h, first_l = alike(space.inverses[k + 1, 0]), alike(space.inverses[k + 1, 1])
        second_h, second_l = alike(space.inverses[k + 2, 0]), alike(space.inverses[k + 2, 1])
        for i in range(size):
            sh, sl = zero, zero
            for j in range(0, WIDTH * size, WIDTH):
                c = j * size + WIDTH * i
                column, column_tail = lanes_at(columns, c), lanes_at(columns_tail, c)
                sh, sl = gathered(sh, sl, column, column_tail, lanes_at(right, j), lanes_at(right_tail, j))
            sh, sl = settled(sh, sl)
            at = now + of_power + WIDTH * (n + i)
            if i < n:
                sh, sl = dd_mul(sh, sl, first_h, first_l)
                qh, ql = dd_mul(sh, sl, second_h, second_l)
                put_lanes(high, at + of_power - WIDTH * n, qh)
                put_lanes(low, at + of_power - WIDTH * n, ql)
            put_lanes(high, at, sh)
            put_lanes(low, at, sl)
        if k < powers - 3:
            _changes(form, space, k + 2)
    lane_coefficients(form, space, until)


@kernel()
def _move(form: LaneForm, space: LaneSpace) -> None:
    """Move the states of all lanes by their steps."""
    high, low, by, order = space.series[0], space.series[1], lanes_at(space.h, 0), space.series.shape[1] - 1
    for at in range(0, WIDTH * form.n, WIDTH):
        moved_lanes(high, low, at, WIDTH * form.series, order, by, space.q, space.v)


@kernel()
def _invert(form: LaneForm, space: LaneSpace) -> None:
    """Fill in the entries of W and the inverses in pairs; a lane ends whose inverse in doubles does not do for that."""
    _entries(form, space)
    n, x, a, lines = form.n, space.x, space.whole, space.lines
    size = n + form.m
    lane_inverse(form, space)
    zero = alike(0.0)
    for i in range(size):
        for j in range(size):
            for plane in range(2):
                put_lanes(a, WIDTH * (2 * (i * size + j) + plane), zero)
    for i in range(n):
        for j in range(n):
            for plane in range(2):
                of = WIDTH * (form.mass + 2 * (i * n + j) + plane)
                put_lanes(a, WIDTH * (2 * (i * size + j) + plane), lanes_at(x, of))
    for e in range(form.lines_at.shape[0]):
        r, j = n + form.lines_at[e, 0], form.lines_at[e, 1]
        at, of = WIDTH * 2 * (r * size + j), WIDTH * 2 * (j * size + r)
        high, low = lanes_at(lines[0], WIDTH * e), lanes_at(lines[1], WIDTH * e)
        put_lanes(a, at, high)
        put_lanes(a, at + WIDTH, low)
        sh, sl = dd_add(lanes_at(a, of), lanes_at(a, of + WIDTH), -high, -low)
        put_lanes(a, of, sh)
        put_lanes(a, of + WIDTH, sl)
    _correct_inverse(size, space)


@kernel()
def _correct_inverse(size: int, space: LaneSpace) -> None:
    """Bring the columns of the inverses in doubles to pairs: `algebra.square_inverse.correct_inverse`."""
    a, high, low, rest, whole = space.whole, space.columns[0], space.columns[1], space.rows, space.inverse
    zero = alike(0.0)
    largest, terms = np.zeros(WIDTH), np.zeros(WIDTH, np.int64)
    for j in range(size):
        for i in range(size):
            sh, sl = alike(1.0 if i == j else 0.0), zero
            for k in range(size):
                of = WIDTH * 2 * (k * size + j)
                column = lanes_at(high, WIDTH * (k * size + i))
                sh, sl = gathered(sh, sl, column, zero, -lanes_at(a, of), -lanes_at(a, of + WIDTH))
            put_lanes(rest, WIDTH * (j * size + i), sh + sl)
            for lane in range(WIDTH):
                largest[lane] = max(largest[lane], abs(rest[j, i, lane]))
    most = 0
    for lane in range(WIDTH):
        largest[lane] *= size
        if not largest[lane] < SUMMED_BELOW:
            space.alive[lane] = 0
            largest[lane] = SUMMED_BELOW
        terms[lane] = 1 + int(53.0 / max(1.0, -math.log2(max(largest[lane], 2.0**-60))))
        most = max(most, terms[lane])
    for j in range(size):
        for i in range(size):
            put_lanes(low, WIDTH * (j * size + i), zero)
    for term in range(most):
        for j in range(size):
            for i in range(size):
                at = WIDTH * (j * size + i)
                put_lanes(whole, at, lanes_at(high, at) + lanes_at(low, at))
        same = True
        for lane in range(WIDTH):
            same = same and term < terms[lane]
        for j in range(size):
            for i in range(size):
                total = zero
                for k in range(size):
                    left = lanes_at(rest, WIDTH * (k * size + i))
                    total = fma(left, lanes_at(whole, WIDTH * (j * size + k)), total)
                if same:
                    put_lanes(low, WIDTH * (j * size + i), total)
                else:
                    # Lanes whose sum converges faster have ended with fewer terms.
                    put_lanes(space.scale, 0, total)
                    for lane in range(WIDTH):
                        if term < terms[lane]:
                            low[j, i, lane] = space.scale[0, lane]
    for j in range(size):
        for i in range(size):
            at = WIDTH * (j * size + i)
            sh, sl = fast_two_sum(lanes_at(high, at), lanes_at(low, at))
            put_lanes(high, at, sh)
            put_lanes(low, at, sl)


@kernel()
def _correct(form: LaneForm, space: LaneSpace) -> None:
    """Put the places back on the measures, and the rates onto the rows there."""
    x, q, v, lines, residual = space.x, space.q, space.v, space.lines, space.residual
    half, tail, of_lines = alike(0.5), WIDTH * form.n, WIDTH * form.lines_at.shape[0]
    for r in range(form.m):
        for plane in range(2):
            put_lanes(residual, WIDTH * (2 * r + plane), -lanes_at(x, WIDTH * (form.offset + 2 * r + plane)))
    for e in range(form.lines_at.shape[0]):
        r, j, at = form.lines_at[e, 0], WIDTH * form.lines_at[e, 1], WIDTH * (form.lines + 2 * e)
        high, low = lanes_at(lines, WIDTH * e), lanes_at(lines, of_lines + WIDTH * e)
        sh, sl = dd_add(high, low, lanes_at(x, at), lanes_at(x, at + WIDTH))
        add_residual(residual, r, half * sh, half * sl, lanes_at(q, j), lanes_at(q, tail + j))
    add_corrections(form, space, q, True)
    _entries(form, space)
    for r in range(form.m):
        for plane in range(2):
            put_lanes(residual, WIDTH * (2 * r + plane), lanes_at(x, WIDTH * (form.rate + 2 * r + plane)))
    for e in range(form.lines_at.shape[0]):
        r, j = form.lines_at[e, 0], WIDTH * form.lines_at[e, 1]
        high, low = lanes_at(lines, WIDTH * e), lanes_at(lines, of_lines + WIDTH * e)
        add_residual(residual, r, high, low, lanes_at(v, j), lanes_at(v, tail + j))
    add_corrections(form, space, v, False)


@kernel()
def _sample(path: Floats, time: float, begun: float, begun_tail: float, q: Floats, v: Floats) -> None:
    """Evaluate the series of a lane, as `motion.series_pairs.sampled_pairs` does."""
    hh, hl = dd_add(time, 0.0, -begun, -begun_tail)
    moved_pairs(path.T, hh, hl, q, v)


follow_in_pairs = following(2, _expand, _move, _invert, _correct, _sample)
