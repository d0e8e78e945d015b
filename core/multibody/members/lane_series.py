"""The Taylor series of eight members at a time in doubles, and their steps: `motion.series.coefficients` in lanes."""

from __future__ import annotations

import math

import numpy as np

from core.arrays import Floats
from core.compiled import fma, kernel
from core.double_double import Pair
from core.lanes import WIDTH, alike, lanes_at, put_lanes
from core.multibody.equations.packed import FORCES
from core.multibody.members.lane_space import LaneSpace
from core.multibody.members.lane_table import LaneForm
from core.multibody.motion.step_sizes import least_step


@kernel()
def lane_changes(form: LaneForm, space: LaneSpace, k: int) -> None:
    """Form coefficient k of the entries of W that vary, in doubles."""
    x, series, of_power = space.x, space.series[0], WIDTH * form.series
    for p in range(form.varying.shape[0]):
        e = (k - 1) * of_power + WIDTH * form.varying[p, 1]
        before = lanes_at(series, e) if form.varying[p, 3] == 1 else alike(0.0)
        slope = lanes_at(x, WIDTH * (form.slopes + 2 * p))
        put_lanes(series, e, fma(slope, lanes_at(series, k * of_power + WIDTH * form.varying[p, 2]), before))


@kernel(forceinline=True)
def _middle(series: Floats, a: int, b: int, behind: int, of_power: int) -> Pair:
    """Return the sums of the products of coefficients in the middle, of order k and of the next.

    In both stand coefficients up to k alone: what is read for one does for the other.
    """
    total, following = alike(0.0), alike(0.0)
    second = lanes_at(series, b + behind)
    for up in range(of_power, behind, of_power):
        first = lanes_at(series, a + up)
        following = fma(first, second, following)
        second = lanes_at(series, b + behind - up)
        total = fma(first, second, total)
    if behind > 0:
        following = fma(lanes_at(series, a + behind), second, following)
    return total, following


@kernel()
def lane_coefficients(form: LaneForm, space: LaneSpace, since: int) -> None:
    """Fill in the Taylor coefficients from since + 2 on, in doubles, the earlier ones being taken up."""
    n, size, x, products = form.n, form.n + form.m, space.x, form.products
    series, right, columns, middle = space.series[0], space.right[0], space.columns[0], space.middle
    of_power, last = WIDTH * form.series, space.series.shape[1] - 3
    for k in range(since, last + 1):
        now = k * of_power
        for i in range(size):
            put_lanes(right, WIDTH * i, alike(0.0))
        if k == 0:
            for i in range(n):
                put_lanes(right, WIDTH * i, lanes_at(x, WIDTH * (form.load + 2 * i)))
        for p in range(form.stiff_at.shape[0]):
            i, j = WIDTH * form.stiff_at[p, 0], now + WIDTH * form.stiff_at[p, 1]
            factor = lanes_at(x, WIDTH * (form.stiff + 2 * p))
            put_lanes(right, i, lanes_at(right, i) - factor * lanes_at(series, j))
        for p in range(products.shape[0]):
            a, b, row = WIDTH * products[p, 1], WIDTH * products[p, 2], WIDTH * products[p, 0]
            if (k - since) % 2 == 0:
                total, following = _middle(series, a, b, now, of_power)
                put_lanes(middle, WIDTH * p, following)
            else:
                total = lanes_at(middle, WIDTH * p)
            # The newest coefficients come last.
            total = fma(lanes_at(series, a), lanes_at(series, b + now), total)
            if k > 0:
                total = fma(lanes_at(series, a + now), lanes_at(series, b), total)
            put_lanes(right, row, fma(lanes_at(x, WIDTH * products[p, 3]), total, lanes_at(right, row)))
        for i in range(n, size):
            put_lanes(right, WIDTH * i, lanes_at(right, WIDTH * i) * alike(-(k + 1.0)))
        for i in range(size):
            total = alike(0.0)
            for j in range(size):
                total = fma(lanes_at(columns, WIDTH * (j * size + i)), lanes_at(right, WIDTH * j), total)
            at = now + of_power + WIDTH * (n + i)
            if i < n:
                put_lanes(series, at + of_power - WIDTH * n, total / alike((k + 1.0) * (k + 2.0)))
                put_lanes(series, at, total / alike(k + 1.0))
            else:
                put_lanes(series, at, total)
        if k < last:
            lane_changes(form, space, k + 2)


@kernel()
def lane_steps(form: LaneForm, space: LaneSpace, tolerance: float) -> None:
    """Fill in the steps of all lanes: `motion.step_sizes.step_size`."""
    powers = space.series.shape[1]
    sizes, best, share = np.empty((WIDTH, powers)), np.full(WIDTH, np.inf), math.log(tolerance)
    for g in range(FORCES + 1):
        present = False
        for i in range(form.n):
            if form.group[i] != g:
                continue
            for k in range(powers):
                for lane in range(WIDTH):
                    own = abs(space.series[0, k, i, lane])
                    sizes[lane, k] = max(sizes[lane, k], own) if present else own
            present = True
        if present:
            for lane in range(WIDTH):
                best[lane] = least_step(sizes[lane], g, share, powers - 1, best[lane])
    for lane in range(WIDTH):
        space.h[lane] = math.exp(best[lane])
