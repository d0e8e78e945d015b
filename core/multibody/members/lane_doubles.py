"""The motion of many members in doubles, eight at a time, each with its own steps: `motion.series.advance` in lanes.

The series of a step are evaluated at the times that lie in it and not stored. A lane whose member has reached the end
takes up the next one.
"""

from __future__ import annotations

import numpy as np

from core.arrays import Floats, Integers
from core.compiled import fma, kernel
from core.double_double import dd_add, dd_add_d, dd_mul, two_prod, two_sum
from core.lanes import WIDTH, alike, lanes_at, put_lanes
from core.multibody.algebra.pair_arrays import gathered
from core.multibody.members.lane_space import (
    LaneSpace,
    lane_changes,
    lane_coefficients,
    lane_entries,
    lane_inverse,
    lane_space,
    lane_steps,
)
from core.multibody.members.lane_table import LaneForm
from core.multibody.motion.series import SHORTEST

FARTHEST = 1e150
"""Size of coordinates and rates beyond which a motion leaves the range of doubles."""


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
def ends_of_steps(space: LaneSpace, ends: Floats, fresh: Integers, member: Integers, last: Integers) -> None:
    """Limit the steps of all lanes to the time that is left; a lane that cannot go on ends, one that is new waits."""
    for lane in range(WIDTH):
        last[lane] = 0
        if member[lane] < 0 or fresh[lane] == 1:
            space.h[lane] = 0.0
            continue
        left = (ends[member[lane]] - space.clock[0, lane]) - space.clock[1, lane]
        if not space.h[lane] > SHORTEST * max(1.0, abs(space.clock[0, lane])):
            space.alive[lane] = 0
            space.h[lane] = 0.0
        elif space.h[lane] >= left:
            space.h[lane] = left
            last[lane] = 1


@kernel()
def follow_in_doubles(
    form: LaneForm,
    numbers: Floats,
    ends: Floats,
    order: int,
    tolerance: float,
    times: Floats,
    seen: Floats,
    q: Floats,
    v: Floats,
    turns: Integers,
    reached: Integers,
) -> None:
    """Follow each member to a time, and fill in their states at some times.

    Parameters
    ----------
    numbers : (members, numbers)
    ends : (members,)
        Times in the units of the tables, positive.
    times : (members, t)
        Ascending, from 0 to the ends.
    seen : (members, d, 2, n + 1)
        Coefficients of two components of directions, relative to their starts, whose turns are counted; the last of
        each is a constant.
    q, v : (members, t, n)
    turns : (members, t, d)
        Filled with how many times a direction has passed the one opposite to its start, up to a time.
    reached : (members,)
        1 for a member that was followed to the end.
    """
    n = form.n
    space = lane_space(form, order, 1)
    member, fresh, last = np.full(WIDTH, -1), np.zeros(WIDTH, np.int64), np.zeros(WIDTH, np.int64)
    passed, begun = np.zeros(WIDTH, np.int64), np.zeros((2, WIDTH))
    begin, middle, count = space.path[0, 0], np.zeros((n, WIDTH)), seen.shape[1]
    # Of each direction, in each lane: its components at the last node, and its turns there.
    nodes, turned = np.zeros((2, count, 2, WIDTH)), np.zeros((2, count, WIDTH), np.int64)
    path, sample = space.path[0], np.zeros((n, 1))
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
        for i in range(n):
            put_lanes(space.path[0, 0], WIDTH * i, lanes_at(space.q[0], WIDTH * i))
            put_lanes(space.path[0, 1], WIDTH * i, lanes_at(space.v[0], WIDTH * i))
            put_lanes(space.rates[0, 0], WIDTH * i, lanes_at(space.v[0], WIDTH * i))
        lane_changes(form, space, 1)
        lane_coefficients(form, space, 0)
        lane_steps(form, space, tolerance)
        ends_of_steps(space, ends, fresh, member, last)
        _half_way(form, space, middle)
        for lane in range(WIDTH):
            if member[lane] >= 0 and fresh[lane] == 0:
                _turn(begin, seen, member[lane], lane, nodes, turned, 1, 0)
                _turn(middle, seen, member[lane], lane, nodes, turned, 0, 1)
        _move(form, space)
        for lane in range(WIDTH):
            for i in range(n):
                if not (abs(space.q[0, i, lane]) < FARTHEST and abs(space.v[0, i, lane]) < FARTHEST):
                    space.alive[lane] = 0
            if fresh[lane] == 1:
                put_back(form, space, lane)
        lane_entries(form, space)
        lane_inverse(form, space)
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
                for d in range(count):
                    turned[1, d, lane] = 0
                    nodes[1, d, 0, lane], nodes[1, d, 1, lane] = 1.0, 0.0
                continue
            if space.alive[lane] == 1:
                sh, sl = two_sum(space.clock[0, lane], space.h[lane])
                space.clock[0, lane], space.clock[1, lane] = two_sum(sh, sl + space.clock[1, lane])
                while passed[lane] < times.shape[1]:
                    s = passed[lane]
                    if last[lane] == 0 and not times[own, s] < space.clock[0, lane]:
                        break
                    h = (times[own, s] - begun[0, lane]) - begun[1, lane]
                    _sample(path, h, lane, own, s, q, v)
                    late = 1 if h >= 0.5 * space.h[lane] else 0
                    for i in range(n):
                        sample[i, 0] = q[own, s, i]
                    for d in range(count):
                        x, y = _seen(sample, 0, seen, own, d, 0), _seen(sample, 0, seen, own, d, 1)
                        more = _passed(nodes[late, d, 0, lane], nodes[late, d, 1, lane], x, y)
                        turns[own, s, d] = turned[late, d, lane] + more
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
def _half_way(form: LaneForm, space: LaneSpace, middle: Floats) -> None:
    """Fill in the places in the middle of the steps, shape (n, 8)."""
    path, of_path = space.path[0], WIDTH * form.n
    last = of_path * (path.shape[0] - 1)
    by = lanes_at(space.h, 0) * alike(0.5)
    for i in range(0, of_path, WIDTH):
        total = lanes_at(path, last + i)
        for k in range(last - of_path, -1, -of_path):
            total = fma(total, by, lanes_at(path, k + i))
        put_lanes(middle, i, total)


@kernel(forceinline=True)
def _passed(x: float, y: float, to_x: float, to_y: float) -> int:
    """Return by how much the number of turns changes between two directions less than half a turn apart."""
    if (y >= 0.0) == (to_y >= 0.0):
        return 0
    left = x * to_y - y * to_x > 0.0
    if y >= 0.0:
        return 1 if left else 0
    return 0 if left else -1


@kernel(forceinline=True)
def _seen(place: Floats, lane: int, seen: Floats, member: int, d: int, component: int) -> float:
    """Return a component of a direction at a place of shape (n, lanes), relative to the direction's start."""
    n = place.shape[0]
    total: float = seen[member, d, component, n]
    for i in range(n):
        total += seen[member, d, component, i] * place[i, lane]
    return total


@kernel()
def _turn(
    place: Floats, seen: Floats, member: int, lane: int, nodes: Floats, turned: Integers, since: int, to: int
) -> None:
    """Follow the directions of a lane from one node to a place, which becomes the other node."""
    for d in range(seen.shape[1]):
        x, y = _seen(place, lane, seen, member, d, 0), _seen(place, lane, seen, member, d, 1)
        more = _passed(nodes[since, d, 0, lane], nodes[since, d, 1, lane], x, y)
        turned[to, d, lane] = turned[since, d, lane] + more
        nodes[to, d, 0, lane], nodes[to, d, 1, lane] = x, y


@kernel()
def _move(form: LaneForm, space: LaneSpace) -> None:
    """Move the states of all lanes by their steps."""
    path, h, of_path = space.path[0], lanes_at(space.h, 0), WIDTH * form.n
    q, q_tail, v, v_tail = space.q[0], space.q[1], space.v[0], space.v[1]
    for at in range(0, of_path, WIDTH):
        moved, rate = alike(0.0), alike(0.0)
        for k in range(path.shape[0] - 1, 2, -1):
            own = lanes_at(path, k * of_path + at)
            moved = (moved + own) * h
            rate = fma(own, alike(float(k)), rate) * h
        second = lanes_at(path, 2 * of_path + at)
        moved = ((moved + second) * h) * h
        # The largest terms, rate times step, are formed exactly; the rest is as much smaller as the step is short.
        ph, pl = two_prod(lanes_at(v, at), h)
        qh, ql = dd_add(lanes_at(q, at), lanes_at(q_tail, at), ph, pl + moved + lanes_at(v_tail, at) * h)
        ph, pl = two_prod(alike(2.0) * second, h)
        vh, vl = dd_add(lanes_at(v, at), lanes_at(v_tail, at), ph, pl + rate * h)
        put_lanes(q, at, qh)
        put_lanes(q_tail, at, ql)
        put_lanes(v, at, vh)
        put_lanes(v_tail, at, vl)


@kernel()
def add_corrections(form: LaneForm, space: LaneSpace, state: Floats, measures_only: bool) -> None:
    """Add to places, or to rates, what undoes the residuals."""
    n, m, columns, residual = form.n, form.m, space.columns[0], space.residual
    of_tails = WIDTH * n
    size = n + m
    for i in range(n):
        total = alike(0.0)
        for r in range(m):
            if not measures_only or form.held[r] == 1:
                rest = lanes_at(residual, 2 * WIDTH * r) + lanes_at(residual, 2 * WIDTH * r + WIDTH)
                total = total + lanes_at(columns, WIDTH * ((n + r) * size + i)) * rest
        sh, sl = dd_add_d(lanes_at(state, WIDTH * i), lanes_at(state, of_tails + WIDTH * i), total)
        put_lanes(state, WIDTH * i, sh)
        put_lanes(state, of_tails + WIDTH * i, sl)


@kernel(forceinline=True)
def add_residual(residual: Floats, r: int, ah: float, al: float, bh: float, bl: float) -> None:
    """Subtract a product from the residual of a row."""
    at = 2 * WIDTH * r
    sh, sl = gathered(lanes_at(residual, at), lanes_at(residual, at + WIDTH), -ah, -al, bh, bl)
    put_lanes(residual, at, sh)
    put_lanes(residual, at + WIDTH, sl)


@kernel()
def _correct(form: LaneForm, space: LaneSpace) -> None:
    """Put the places back on the measures, and the rates onto the rows there."""
    x, q, v, residual, tail = space.x, space.q, space.v, space.residual, WIDTH * form.n
    for r in range(form.m):
        for plane in range(2):
            put_lanes(residual, WIDTH * (2 * r + plane), -lanes_at(x, WIDTH * (form.offset + 2 * r + plane)))
    _add_lines(form, space, q)
    for p in range(form.varying.shape[0]):
        e, i = form.varying[p, 0], WIDTH * form.varying[p, 2]
        r, j = form.lines_at[e, 0], WIDTH * form.lines_at[e, 1]
        if form.held[r] == 1:
            ph, pl = dd_mul(lanes_at(q, i), lanes_at(q, tail + i), lanes_at(q, j), lanes_at(q, tail + j))
            at = WIDTH * (form.slopes + 2 * p)
            half = alike(0.5)
            add_residual(residual, r, half * lanes_at(x, at), half * lanes_at(x, at + WIDTH), ph, pl)
    add_corrections(form, space, q, True)
    lane_entries(form, space)
    for r in range(form.m):
        for plane in range(2):
            put_lanes(residual, WIDTH * (2 * r + plane), lanes_at(x, WIDTH * (form.rate + 2 * r + plane)))
    _add_lines(form, space, v)
    for p in range(form.varying.shape[0]):
        e, i = form.varying[p, 0], WIDTH * form.varying[p, 2]
        r, j = form.lines_at[e, 0], WIDTH * form.lines_at[e, 1]
        ph, pl = dd_mul(lanes_at(q, i), lanes_at(q, tail + i), lanes_at(v, j), lanes_at(v, tail + j))
        at = WIDTH * (form.slopes + 2 * p)
        add_residual(residual, r, lanes_at(x, at), lanes_at(x, at + WIDTH), ph, pl)
    add_corrections(form, space, v, False)


@kernel()
def _add_lines(form: LaneForm, space: LaneSpace, state: Floats) -> None:
    """Subtract from the residuals what the constant entries of W give with places or rates."""
    x, residual, tail = space.x, space.residual, WIDTH * form.n
    for e in range(form.lines_at.shape[0]):
        r, j = form.lines_at[e, 0], WIDTH * form.lines_at[e, 1]
        high, low = lanes_at(x, WIDTH * (form.lines + 2 * e)), lanes_at(x, WIDTH * (form.lines + 2 * e + 1))
        add_residual(residual, r, high, low, lanes_at(state, j), lanes_at(state, tail + j))


@kernel()
def _sample(path: Floats, h: float, lane: int, member: int, s: int, q: Floats, v: Floats) -> None:
    """Evaluate the series of a lane, as `motion.series.sampled` does."""
    for i in range(path.shape[1]):
        moved, rate = 0.0, 0.0
        for k in range(path.shape[0] - 1, 1, -1):
            moved = (moved + path[k, i, lane]) * h
            rate = (rate + k * path[k, i, lane]) * h
        moved = (moved + path[1, i, lane]) * h
        q[member, s, i] = path[0, i, lane] + moved
        v[member, s, i] = path[1, i, lane] + rate
