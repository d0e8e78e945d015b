"""The motion of many members in pairs of doubles, eight at a time: `motion.series_pairs.advance_pairs` in lanes."""

from __future__ import annotations

import math

import numpy as np

from core.arrays import Floats, Integers
from core.compiled import fma, kernel
from core.double_double import dd_add, dd_add_d, dd_mul, dd_mul_d, fast_two_sum, two_prod, two_sum
from core.lanes import WIDTH, alike, lanes_at, put_lanes
from core.multibody.algebra.pair_arrays import gathered, settled
from core.multibody.algebra.square_inverse import SUMMED_BELOW
from core.multibody.members.lane_doubles import (
    FARTHEST,
    add_corrections,
    add_residual,
    ends_of_steps,
    put_back,
    take_up,
)
from core.multibody.members.lane_space import LaneSpace, lane_coefficients, lane_inverse, lane_space, lane_steps
from core.multibody.members.lane_table import OF_LINE, OF_RATE, LaneForm
from core.multibody.motion.series_pairs import LAST_DIGITS


@kernel()
def follow_in_pairs(
    form: LaneForm,
    numbers: Floats,
    ends: Floats,
    order: int,
    tolerance: float,
    times: Floats,
    q: Floats,
    v: Floats,
    reached: Integers,
) -> None:
    """Follow members as `follow_in_doubles` does, in pairs; q and v of shape (members, t, n, 2)."""
    n = form.n
    space = lane_space(form, order, 2)
    member, fresh, last = np.full(WIDTH, -1), np.zeros(WIDTH, np.int64), np.zeros(WIDTH, np.int64)
    passed, begun = np.zeros(WIDTH, np.int64), np.zeros((2, WIDTH))
    paired = min(max(int(order * (1.0 + LAST_DIGITS / math.log2(tolerance))), 1), order - 1)
    following, going = 0, 0
    for lane in range(WIDTH):
        if following < numbers.shape[0]:
            take_up(form, space, numbers, following, lane)
            member[lane], fresh[lane] = following, 1
            following += 1
            going += 1
    while going > 0:
        for lane in range(WIDTH):
            space.alive[lane] = 1
            begun[0, lane], begun[1, lane] = space.clock[0, lane], space.clock[1, lane]
        for plane in range(2):
            for i in range(n):
                put_lanes(space.path[plane, 0], WIDTH * i, lanes_at(space.q[plane], WIDTH * i))
                put_lanes(space.path[plane, 1], WIDTH * i, lanes_at(space.v[plane], WIDTH * i))
                put_lanes(space.rates[plane, 0], WIDTH * i, lanes_at(space.v[plane], WIDTH * i))
        _changes(form, space, 1)
        _coefficients(form, space, paired)
        for lane in range(WIDTH):
            for i in range(n):
                if not math.isfinite(space.path[0, order, i, lane]):
                    space.alive[lane] = 0
        lane_steps(form, space, tolerance)
        ends_of_steps(space, ends, fresh, member, last)
        _move(form, space)
        for lane in range(WIDTH):
            for i in range(n):
                if not (abs(space.q[0, i, lane]) < FARTHEST and abs(space.v[0, i, lane]) < FARTHEST):
                    space.alive[lane] = 0
            if fresh[lane] == 1:
                space.alive[lane] = 1
                put_back(form, space, lane)
        _entries(form, space)
        _inverse(form, space)
        if form.m > 0:
            _correct(form, space)
        for lane in range(WIDTH):
            own = member[lane]
            if own < 0:
                continue
            if space.alive[lane] == 1 and fresh[lane] == 1:
                put_back(form, space, lane)
                fresh[lane] = 0
                passed[lane] = 0
                continue
            if space.alive[lane] == 1:
                space.clock[0, lane], space.clock[1, lane] = dd_add_d(
                    space.clock[0, lane], space.clock[1, lane], space.h[lane]
                )
                while passed[lane] < times.shape[1]:
                    s = passed[lane]
                    if last[lane] == 0 and not times[own, s] < space.clock[0, lane]:
                        break
                    hh, hl = dd_add(times[own, s], 0.0, -begun[0, lane], -begun[1, lane])
                    _sample(space.path, hh, hl, lane, own, s, q, v)
                    passed[lane] += 1
                if last[lane] == 0:
                    continue
                reached[own] = 1
            if following < numbers.shape[0]:
                take_up(form, space, numbers, following, lane)
                member[lane], fresh[lane] = following, 1
                following += 1
            else:
                member[lane] = -1
                going -= 1


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
    x, path, path_tail, high, low = space.x, space.path[0], space.path[1], space.entries[0], space.entries[1]
    of_path, of_entries = k * WIDTH * form.n, k * WIDTH * high.shape[1]
    for p in range(form.varying.shape[0]):
        e, i = of_entries + WIDTH * form.varying[p, 1], of_path + WIDTH * form.varying[p, 2]
        at = WIDTH * (form.slopes + 2 * p)
        sh, sl = dd_mul(lanes_at(x, at), lanes_at(x, at + WIDTH), lanes_at(path, i), lanes_at(path_tail, i))
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


@kernel()
def _coefficients(form: LaneForm, space: LaneSpace, until: int) -> None:
    """Fill in the Taylor coefficients up to until + 1 in pairs, and the others in doubles."""
    n, m, x = form.n, form.m, space.x
    size = n + m
    path, path_tail, rates, rates_tail = space.path[0], space.path[1], space.rates[0], space.rates[1]
    pull, pull_tail, entries, entries_tail = space.pull[0], space.pull[1], space.entries[0], space.entries[1]
    right, right_tail, columns, columns_tail = space.right[0], space.right[1], space.columns[0], space.columns[1]
    of_path, of_pull, of_entries = WIDTH * n, WIDTH * m, WIDTH * entries.shape[1]
    last = path.shape[0] - 3
    zero, one = alike(0.0), alike(1.0)
    for i in range(2 * of_path, path.shape[0] * of_path, WIDTH):
        put_lanes(path_tail, i, zero)
    for k in range(until):
        for i in range(size):
            put_lanes(right, WIDTH * i, zero)
            put_lanes(right_tail, WIDTH * i, zero)
        if k == 0:
            for i in range(n):
                put_lanes(right, WIDTH * i, lanes_at(x, WIDTH * (form.load + 2 * i)))
                put_lanes(right_tail, WIDTH * i, lanes_at(x, WIDTH * (form.load + 2 * i + 1)))
        for p in range(form.stiff_at.shape[0]):
            i, j = WIDTH * form.stiff_at[p, 0], k * of_path + WIDTH * form.stiff_at[p, 1]
            ah, al = lanes_at(x, WIDTH * (form.stiff + 2 * p)), lanes_at(x, WIDTH * (form.stiff + 2 * p + 1))
            _add(right, right_tail, i, -ah, -al, lanes_at(path, j), lanes_at(path_tail, j))
        for p in range(form.damp_at.shape[0]):
            i, j = WIDTH * form.damp_at[p, 0], (k + 1) * of_path + WIDTH * form.damp_at[p, 1]
            ah, al = lanes_at(x, WIDTH * (form.damp + 2 * p)), lanes_at(x, WIDTH * (form.damp + 2 * p + 1))
            ph, pl = dd_mul_d(lanes_at(path, j), lanes_at(path_tail, j), alike(k + 1.0))
            _add(right, right_tail, i, -ah, -al, ph, pl)
        for p in range(form.products.shape[0]):
            kind, row = form.products[p, 0], WIDTH * form.products[p, 1]
            a, b = WIDTH * form.products[p, 2], WIDTH * form.products[p, 3]
            if kind == OF_LINE:
                sh, sl = zero, zero
                for i in range(1, k + 1):
                    c, d = a + of_pull * (i - 1), b + of_entries * (k - i + 1)
                    first, first_tail = lanes_at(pull, c), lanes_at(pull_tail, c)
                    sh, sl = gathered(sh, sl, first, first_tail, lanes_at(entries, d), lanes_at(entries_tail, d))
                _add(right, right_tail, row, one, zero, sh, sl)
            elif kind == OF_RATE:
                c = a + of_entries
                sh, sl = _sum(entries, entries_tail, rates, rates_tail, c, b, of_entries, of_path, k)
                _add(right, right_tail, row, one, zero, sh, sl)
            else:
                sh, sl = _sum(path, path_tail, rates, rates_tail, a, b, of_path, of_path, k)
                at = WIDTH * form.products[p, 4]
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
            if i < n:
                uh, ul = dd_mul(sh, sl, first_h, first_l)
                qh, ql = dd_mul(uh, ul, second_h, second_l)
                c = (k + 1) * of_path + WIDTH * i
                put_lanes(rates, c, uh)
                put_lanes(rates_tail, c, ul)
                put_lanes(path, c + of_path, qh)
                put_lanes(path_tail, c + of_path, ql)
            else:
                c = k * of_pull + WIDTH * (i - n)
                put_lanes(pull, c, sh)
                put_lanes(pull_tail, c, sl)
        if k < last:
            _changes(form, space, k + 2)
    lane_coefficients(form, space, until)


@kernel(forceinline=True)
def _sum(
    first: Floats,
    first_tail: Floats,
    second: Floats,
    second_tail: Floats,
    a: int,
    b: int,
    ahead: int,
    behind: int,
    k: int,
) -> tuple[float, float]:
    """Return the sum of products of coefficients, those in the middle first, then the newest."""
    sh, sl = alike(0.0), alike(0.0)
    for step in range(1, k + 2):
        # Those of the newest coefficients, 0 and k, come last.
        i = step if step < k else k * (step - k)
        c, d = a + ahead * i, b + behind * (k - i)
        left, left_tail = lanes_at(first, c), lanes_at(first_tail, c)
        sh, sl = gathered(sh, sl, left, left_tail, lanes_at(second, d), lanes_at(second_tail, d))
    return sh, sl


@kernel()
def _move(form: LaneForm, space: LaneSpace) -> None:
    """Move the states of all lanes by their steps: `motion.series_pairs._moved`."""
    high, low, by, of_path = space.path[0], space.path[1], lanes_at(space.h, 0), WIDTH * form.n
    q, v, last = space.q, space.v, of_path * (high.shape[0] - 1)
    for at in range(0, of_path, WIDTH):
        sh, sl = lanes_at(high, last + at), lanes_at(low, last + at)
        rh, rl = alike(0.0), alike(0.0)
        for k in range(last - of_path, -of_path, -of_path):
            ph, pl = two_prod(rh, by)
            rh, e = two_sum(ph, sh)
            rl = fma(rl, by, pl + (e + sl))
            ph, pl = two_prod(sh, by)
            sh, e = two_sum(ph, lanes_at(high, k + at))
            sl = fma(sl, by, pl + (e + lanes_at(low, k + at)))
        sh, sl = fast_two_sum(sh, sl)
        rh, rl = fast_two_sum(rh, rl)
        put_lanes(q, at, sh)
        put_lanes(q, of_path + at, sl)
        put_lanes(v, at, rh)
        put_lanes(v, of_path + at, rl)


@kernel()
def _inverse(form: LaneForm, space: LaneSpace) -> None:
    """Fill in the columns of the inverses in pairs; a lane ends whose inverse in doubles does not do for that."""
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
def _sample(path: Floats, hh: float, hl: float, lane: int, member: int, s: int, q: Floats, v: Floats) -> None:
    """Evaluate the series of a lane, as `motion.series_pairs.moved_pairs` does."""
    order = path.shape[1] - 1
    for i in range(path.shape[2]):
        sh, sl = path[0, order, i, lane], path[1, order, i, lane]
        rh, rl = 0.0, 0.0
        for k in range(order - 1, -1, -1):
            ph, pl = two_prod(rh, hh)
            pl = fma(rl, hh, fma(rh, hl, pl + sl))
            rh, e = two_sum(ph, sh)
            rl = pl + e
            ph, pl = two_prod(sh, hh)
            pl = fma(sl, hh, fma(sh, hl, pl + path[1, k, i, lane]))
            sh, e = two_sum(ph, path[0, k, i, lane])
            sl = pl + e
        q[member, s, i, 0], q[member, s, i, 1] = fast_two_sum(sh, sl)
        v[member, s, i, 0], v[member, s, i, 1] = fast_two_sum(rh, rl)
