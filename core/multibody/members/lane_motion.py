"""The motion of many members, eight at a time, each with its own steps: `motion.series.advance` in lanes.

The series of a step are evaluated at the times that lie in it and not stored. A lane whose member has ended takes up
the next one.
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from core.arrays import Floats, Integers
from core.compiled import fma, kernel
from core.double_double import dd_add_d
from core.lanes import WIDTH, alike, lanes_at, put_lanes
from core.multibody.members.lane_series import lane_steps
from core.multibody.members.lane_space import LaneSpace, begin_series, lane_space, put_back, take_up
from core.multibody.members.lane_table import LaneForm
from core.multibody.motion.series import FARTHEST, SHORTEST

Follow = Callable[
    [LaneForm, Floats, Floats, int, float, Floats, Floats, Floats, Floats, Integers, Integers],
    None,
]
"""What `following` returns."""


def following(
    planes: int,
    expand: Callable[[LaneForm, LaneSpace, float], None],
    move: Callable[[LaneForm, LaneSpace], None],
    invert: Callable[[LaneForm, LaneSpace], None],
    correct: Callable[[LaneForm, LaneSpace], None],
    sample: Callable[[Floats, float, float, float, Floats, Floats], None],
) -> Follow:
    """Return what follows members in one arithmetic, by its kernels.

    Parameters
    ----------
    planes : int
        1 for doubles, 2 for pairs.
    expand : callable
        Fills in the coefficients of the series, to a tolerance.
    move : callable
        Moves the states by the steps.
    invert : callable
        Fills in the entries of W and the inverses at the states; a lane ends that has none.
    correct : callable
        Puts the states back on the rows.
    sample : callable
        Evaluates the series of one lane, shape (planes, order + 1, n), at a time; it began at a pair of times. Into
        places and rates of shape (n, 2).
    """

    @kernel()
    def follow(
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
        q, v : (members, t, n, 2)
        turns : (members, t, d)
            Filled with how many times a direction has passed the one opposite to its start, up to a time.
        reached : (members,)
            1 for a member that was followed to the end.
        """
        n, count = form.n, seen.shape[1]
        space = lane_space(form, order, planes)
        member, fresh, last = np.full(WIDTH, -1), np.zeros(WIDTH, np.int64), np.zeros(WIDTH, np.int64)
        passed, begun = np.zeros(WIDTH, np.int64), np.zeros((2, WIDTH))
        begin, middle = space.series[0, 0], np.zeros((n, WIDTH))
        # Of each direction, in each lane: its components at the last node, and its turns there.
        nodes, turned = np.zeros((2, count, 2, WIDTH)), np.zeros((2, count, WIDTH), np.int64)
        coming, going = 0, 0
        for lane in range(WIDTH):
            if coming < numbers.shape[0]:
                take_up(form, space, numbers, coming, lane)
                member[lane], fresh[lane] = coming, 1
                coming += 1
                going += 1
        while going > 0:
            for lane in range(WIDTH):
                space.alive[lane] = 1
                begun[0, lane], begun[1, lane] = space.clock[0, lane], space.clock[1, lane]
            begin_series(form, space)
            expand(form, space, tolerance)
            lane_steps(form, space, tolerance)
            _limit_steps(space, ends, fresh, member, last)
            if count > 0:
                _half_way(form, space, middle)
                for lane in range(WIDTH):
                    if member[lane] >= 0 and fresh[lane] == 0:
                        _turn(begin, seen, member[lane], lane, nodes, turned, 1, 0)
                        _turn(middle, seen, member[lane], lane, nodes, turned, 0, 1)
            move(form, space)
            for lane in range(WIDTH):
                if fresh[lane] == 1:
                    # Whatever became of the member before: this one stays at its start, where its inverse is formed.
                    space.alive[lane] = 1
                    put_back(form, space, lane)
                for i in range(n):
                    if not (abs(space.q[0, i, lane]) < FARTHEST and abs(space.v[0, i, lane]) < FARTHEST):
                        space.alive[lane] = 0
            invert(form, space)
            if form.m > 0:
                correct(form, space)
            for lane in range(WIDTH):
                own = member[lane]
                if own < 0:
                    continue
                if space.alive[lane] == 1 and fresh[lane] == 1:
                    put_back(form, space, lane)
                    fresh[lane] = passed[lane] = 0
                    for d in range(count):
                        turned[1, d, lane] = 0
                        nodes[1, d, 0, lane], nodes[1, d, 1, lane] = 1.0, 0.0
                    continue
                if space.alive[lane] == 1:
                    space.clock[0, lane], space.clock[1, lane] = dd_add_d(
                        space.clock[0, lane], space.clock[1, lane], space.h[lane]
                    )
                    path = space.series[:, :, :n, lane]
                    while passed[lane] < times.shape[1]:
                        s = passed[lane]
                        if last[lane] == 0 and not times[own, s] < space.clock[0, lane]:
                            break
                        sample(path, times[own, s], begun[0, lane], begun[1, lane], q[own, s], v[own, s])
                        late = 1 if times[own, s] - begun[0, lane] >= 0.5 * space.h[lane] else 0
                        for d in range(count):
                            x, y = _seen(q[own, s], 0, seen, own, d, 0), _seen(q[own, s], 0, seen, own, d, 1)
                            more = _passed(nodes[late, d, 0, lane], nodes[late, d, 1, lane], x, y)
                            turns[own, s, d] = turned[late, d, lane] + more
                        passed[lane] += 1
                    if last[lane] == 0:
                        continue
                    reached[own] = 1
                if coming < numbers.shape[0]:
                    take_up(form, space, numbers, coming, lane)
                    member[lane], fresh[lane] = coming, 1
                    coming += 1
                else:
                    member[lane] = -1
                    going -= 1

    return follow


@kernel()
def _limit_steps(space: LaneSpace, ends: Floats, fresh: Integers, member: Integers, last: Integers) -> None:
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
def _half_way(form: LaneForm, space: LaneSpace, middle: Floats) -> None:
    """Fill in the places in the middle of the steps, shape (n, 8)."""
    series, of_power = space.series[0], WIDTH * form.series
    last = of_power * (space.series.shape[1] - 1)
    by = lanes_at(space.h, 0) * alike(0.5)
    for i in range(0, WIDTH * form.n, WIDTH):
        total = lanes_at(series, last + i)
        for k in range(last - of_power, -1, -of_power):
            total = fma(total, by, lanes_at(series, k + i))
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
    n = seen.shape[3] - 1
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
