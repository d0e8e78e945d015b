"""The products of Taylor series in a table's equation, eight at a time.

Coefficient k of a product of two series is the sum of a_i b_{k-i}. A table has three kinds of products: multipliers
with entries of W, entries of W with rates, and coordinates with rates. Each has a lane in blocks of eight, in which the
coefficients of its first and of its second factor follow one another, so that eight sums are formed at once.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from core.arrays import Floats, Integers
from core.compiled import fma, kernel
from core.double_double import Pair, dd_add, dd_div_d, dd_mul
from core.lanes import WIDTH, alike, lanes_at, put_lanes
from core.multibody.algebra.pair_arrays import gathered
from core.multibody.algebra.square_inverse import padded
from core.multibody.equations.packed import Packed

ROW, FIRST_FROM, FIRST_TO, SECOND_FROM, SECOND_TO = 0, 1, 2, 3, 4
"""What the columns of `Products.at` say."""


class Products(NamedTuple):
    """The products of a table, and space for series of one order: in doubles, or in two planes of value and tail.

    Attributes
    ----------
    at : (p, 5)
        Place of the sum on the right-hand side; places of a new coefficient of either factor in `now`, and of the one
        that goes with k = 0 in `first` and `second`.
    factor : (p, 2)
    entry : (p', 2)
        Place in `now` of the entry of W that a slope changes, and whether an earlier slope changes it too.
    first, second : (planes, blocks * (order + 1) * 8)
        Coefficients of the factors.
    sums : (planes, blocks * 8)
    now : (planes, 3 s + e)
        New coefficients: of coordinates, rates, multipliers (from n on), and entries of W; s is n + m, padded.
    right : (planes, s)
    path : (planes, (order + 1) * s)
        Coefficients of the coordinates, each order at k s.
    inverses : (order + 1, 2)
        Inverses of the natural numbers, in pairs.
    laws : (o, order + 1, 2)
        Coefficients of the operations of laws, in pairs.
    way : (1,)
        Sign of the times that follow.
    slips : (d, 6, order + 1, 2)
        Series of slips with which friction turns, in pairs.
    """

    at: Integers
    factor: Floats
    entry: Integers
    first: Floats
    second: Floats
    sums: Floats
    now: Floats
    right: Floats
    path: Floats
    inverses: Floats
    laws: Floats
    way: Floats
    slips: Floats


@kernel()
def products_of(table: Packed, order: int, planes: int) -> Products:
    """Return the products of a table, with space for series up to an order."""
    n, size = table.load.shape[0], padded(table.load.shape[0] + table.rate.shape[0])
    count = table.lines.shape[0]
    place = np.full(count, -1)
    varying, binding = 0, 0
    entry = np.zeros((table.slopes.shape[0], 2), dtype=np.int64)
    for p in range(table.slopes.shape[0]):
        e = table.slopes_at[p, 0]
        entry[p, 1] = place[e] >= 0
        if place[e] < 0:
            place[e] = 3 * size + varying
            varying += 1
            binding += table.binds[e]
        entry[p, 0] = place[e]
    total = varying + binding + table.gyre.shape[0]
    at, factor = np.zeros((total, 5), dtype=np.int64), np.zeros((total, 2))
    factor[:, 0] = 1.0
    p = 0
    for e in range(count):
        if place[e] >= 0:
            # lambda_{i-1} w_{k+1-i}, with lambda_{-1} = 0.
            r, j = table.lines_at[e, 0], table.lines_at[e, 1]
            at[p, ROW], at[p, FIRST_FROM], at[p, SECOND_FROM] = j, 2 * size + n + r, place[e]
            p += 1
            if table.binds[e] == 1:
                # w_{i+1} u_{k-i}
                at[p, ROW], at[p, FIRST_FROM], at[p, SECOND_FROM] = n + r, place[e], size + j
                p += 1
    for g in range(table.gyre.shape[0]):
        # q_i u_{k-i}
        i, j, l = table.gyre_at[g, 0], table.gyre_at[g, 1], table.gyre_at[g, 2]  # noqa: E741
        at[p, ROW], at[p, FIRST_FROM], at[p, SECOND_FROM] = i, j, size + l
        at[p, FIRST_TO] = WIDTH
        factor[p, 0], factor[p, 1] = table.gyre[g, 0], table.gyre[g, 1]
        p += 1
    for p in range(total):
        start = p // WIDTH * WIDTH * (order + 1) + p % WIDTH + WIDTH
        at[p, FIRST_TO] += start
        at[p, SECOND_TO] = start
    inverses = np.zeros((order + 1, 2))
    for k in range(1, order + 1):
        inverses[k, 0], inverses[k, 1] = dd_div_d(1.0, 0.0, float(k))
    lanes = padded(total)
    return Products(
        at,
        factor,
        entry,
        np.zeros((planes, lanes * (order + 1))),
        np.zeros((planes, lanes * (order + 1))),
        np.zeros((planes, lanes)),
        np.zeros((planes, 3 * size + varying)),
        np.zeros((planes, size)),
        np.zeros((planes, (order + 1) * size)),
        inverses,
        np.zeros((table.laws.operations.shape[0], order + 1, 2)),
        np.ones(1),
        np.zeros((table.slides.at.shape[0], 6, order + 1, 2)),
    )


@kernel(forceinline=True)
def started(table: Packed, products: Products) -> None:
    """Take up a new series whose coefficients 0 and 1 are in the path."""
    planes, size = products.right.shape
    at, now, path = products.at, products.now, products.path
    for plane in range(planes):
        for i in range(size):
            now[plane, i] = now[plane, size + i] = path[plane, size + i]
            now[plane, 2 * size + i] = 0.0
        for p in range(at.shape[0]):
            if at[p, FIRST_FROM] < size:
                products.first[plane, at[p, FIRST_TO] - 2 * WIDTH] = path[plane, at[p, FIRST_FROM]]
    if planes == 2:
        spread_pairs(table, products, -1)
    else:
        spread(table, products, -1)


@kernel(forceinline=True)
def spread(table: Packed, products: Products, k: int) -> None:
    """Put the coefficients that order k gives, in the first parts of `now`, into the lanes of the products."""
    at, entry, now = products.at, products.entry, products.now[0]
    first, second, slopes, slopes_at = products.first[0], products.second[0], table.slopes, table.slopes_at
    for p in range(entry.shape[0]):
        e = np.uintp(entry[p, 0])
        before = now[e] if entry[p, 1] else 0.0
        now[e] = fma(slopes[p, 0], now[np.uintp(slopes_at[p, 1])], before)
    ahead = WIDTH * k
    for p in range(at.shape[0]):
        first[np.uintp(at[p, FIRST_TO] + ahead)] = now[np.uintp(at[p, FIRST_FROM])]
        second[np.uintp(at[p, SECOND_TO] + ahead)] = now[np.uintp(at[p, SECOND_FROM])]


@kernel(forceinline=True)
def spread_pairs(table: Packed, products: Products, k: int) -> None:
    """Do as `spread` in pairs."""
    at, entry, high, low = products.at, products.entry, products.now[0], products.now[1]
    for p in range(entry.shape[0]):
        e, i = np.uintp(entry[p, 0]), np.uintp(table.slopes_at[p, 1])
        sh, sl = dd_mul(table.slopes[p, 0], table.slopes[p, 1], high[i], low[i])
        if entry[p, 1]:
            sh, sl = dd_add(high[e], low[e], sh, sl)
        high[e], low[e] = sh, sl
    ahead = WIDTH * k
    for plane in range(2):
        first, second, now = products.first[plane], products.second[plane], products.now[plane]
        for p in range(at.shape[0]):
            first[np.uintp(at[p, FIRST_TO] + ahead)] = now[np.uintp(at[p, FIRST_FROM])]
            second[np.uintp(at[p, SECOND_TO] + ahead)] = now[np.uintp(at[p, SECOND_FROM])]


@kernel(forceinline=True)
def summed(products: Products, k: int) -> None:
    """Form coefficient k of every product, in doubles."""
    first, second, sums = products.first[0], products.second[0], products.sums[0]
    length = WIDTH * products.inverses.shape[0]
    for b in range(0, sums.shape[0], WIDTH):
        i = b // WIDTH * length
        j = i + WIDTH * k
        total = alike(0.0)
        # The newest coefficients come last, so that nothing waits for them.
        for a in range(WIDTH, WIDTH * k, WIDTH):
            total = fma(lanes_at(first, i + a), lanes_at(second, j - a), total)
        total = fma(lanes_at(first, i), lanes_at(second, j), total)
        if k > 0:
            total = fma(lanes_at(first, j), lanes_at(second, i), total)
        put_lanes(sums, b, total)


@kernel(forceinline=True)
def summed_pairs(products: Products, k: int) -> None:
    """Form coefficient k of every product, in pairs."""
    length = WIDTH * products.inverses.shape[0]
    for b in range(0, products.sums.shape[1], WIDTH):
        i = b // WIDTH * length
        j = i + WIDTH * k
        sh, sl = alike(0.0), alike(0.0)
        for a in range(WIDTH, WIDTH * k, WIDTH):
            sh, sl = _with_product(products, sh, sl, i + a, j - a)
        sh, sl = _with_product(products, sh, sl, i, j)
        if k > 0:
            sh, sl = _with_product(products, sh, sl, j, i)
        put_lanes(products.sums[0], b, sh)
        put_lanes(products.sums[1], b, sl)


@kernel(forceinline=True)
def _with_product(products: Products, sh: float, sl: float, i: int, j: int) -> Pair:
    first, second = products.first, products.second
    return gathered(
        sh, sl, lanes_at(first[0], i), lanes_at(first[1], i), lanes_at(second[0], j), lanes_at(second[1], j)
    )
