"""Friction that turns with its slip, in the series of a table: the kernel.

In space the force of a multiplier lambda that slides is -mu (c a + s b) lambda along two constant lines a and b, with
the slip (a.u, b.u) = w (c, s) and c^2 + s^2 = 1. The coefficients of w, c and s follow from those of the rates u, power
by power, and are known to the power of a multiplier before that is. A slip that vanishes has the direction of a.

The series converges where the slip has no zero in the complex plane: for |s|/|s'| if s changes uniformly.
"""

from __future__ import annotations

import math

from core.arrays import Floats
from core.compiled import kernel
from core.double_double import Pair, dd_add, dd_div, dd_mul, dd_mul_d, dd_sqrt
from core.multibody.algebra.pair_arrays import gathered, settled
from core.multibody.equations.packed import Packed, PackedSlides
from core.multibody.motion.products import Products

ALONG, ACROSS, SIZE, COSINE, SINE, PUSH = 0, 1, 2, 3, 4, 5
"""Series of a slip: its components, its size, its direction, and the multiplier."""
ROW, ENTRY, FIRST, COUNT = 0, 1, 2, 3
"""What the columns of `PackedSlides.at` say."""
FROZEN = 2.0**-24
"""Time in which a slip would end, in the units of a table, below which its direction is taken to stay: coefficients of
the power 32 are within 2^768 then, and their products within the range of doubles."""
FARTHEST = 0.75
"""Share of the radius of convergence that a step takes at most."""


@kernel()
def _component(slides: PackedSlides, d: int, lines: Floats, path: Floats, at: int, factor: float) -> Pair:
    """Return a factor times a line of a slip, times what stands from a place on in a path of shape (planes, ...)."""
    sh, sl = 0.0, 0.0
    for t in range(slides.at[d, FIRST], slides.at[d, FIRST] + slides.at[d, COUNT]):
        j = at + slides.coordinates[t]
        low = path[1, j] if path.shape[0] == 2 else 0.0
        sh, sl = gathered(sh, sl, lines[t, 0], lines[t, 1], path[0, j], low)
    sh, sl = settled(sh, sl)
    return dd_mul_d(sh, sl, factor)


@kernel()
def put_friction(table: Packed, path: Floats, at: int, lines: Floats) -> None:
    """Fill in the entries of X that turn, for rates that stand from a place on in a path.

    Parameters
    ----------
    lines : (e, 2)
    """
    slides = table.slides
    for d in range(slides.at.shape[0]):
        xh, xl = _component(slides, d, slides.along, path, at, 1.0)
        yh, yl = _component(slides, d, slides.across, path, at, 1.0)
        ch, cl, sh, sl = _unit(xh, xl, yh, yl)
        ch, cl = dd_mul(ch, cl, slides.factor[d, 0], slides.factor[d, 1])
        sh, sl = dd_mul(sh, sl, slides.factor[d, 0], slides.factor[d, 1])
        for i in range(slides.at[d, COUNT]):
            e, t = slides.at[d, ENTRY] + i, slides.at[d, FIRST] + i
            ph, pl = dd_mul(ch, cl, slides.along[t, 0], slides.along[t, 1])
            qh, ql = dd_mul(sh, sl, slides.across[t, 0], slides.across[t, 1])
            lines[e, 0], lines[e, 1] = dd_add(ph, pl, qh, ql)


@kernel()
def _unit(xh: float, xl: float, yh: float, yl: float) -> tuple[float, float, float, float]:
    """Return the direction of a vector; that of the first axis for none."""
    # A power of two, so that squares neither overflow nor vanish.
    largest = max(abs(xh), abs(yh))
    if largest == 0.0:
        return 1.0, 0.0, 0.0, 0.0
    scale = math.ldexp(1.0, -math.frexp(largest)[1])
    xh, xl, yh, yl = xh * scale, xl * scale, yh * scale, yl * scale
    ah, al = dd_mul(xh, xl, xh, xl)
    bh, bl = dd_mul(yh, yl, yh, yl)
    wh, wl = dd_sqrt(*dd_add(ah, al, bh, bl))
    ch, cl = dd_div(xh, xl, wh, wl)
    sh, sl = dd_div(yh, yl, wh, wl)
    return ch, cl, sh, sl


@kernel()
def _product(series: Floats, a: int, b: int, first: int, k: int) -> Pair:
    """Return the sum of a_i b_(k-i) from i = first to k, of two series of shape (., order, 2)."""
    sh, sl = 0.0, 0.0
    for i in range(first, k + 1):
        sh, sl = gathered(sh, sl, series[a, i, 0], series[a, i, 1], series[b, k - i, 0], series[b, k - i, 1])
    return settled(sh, sl)


@kernel()
def add_turning(table: Packed, products: Products, k: int) -> None:
    """Add to the right-hand side of order k what friction owes to the turning of its direction until then."""
    slides, path, right = table.slides, products.path, products.right
    n, size = table.load.shape[0], right.shape[1]
    for d in range(slides.at.shape[0]):
        series = products.slips[d]
        at = (k + 1) * size
        series[ALONG, k, 0], series[ALONG, k, 1] = _component(slides, d, slides.along, path, at, k + 1.0)
        series[ACROSS, k, 0], series[ACROSS, k, 1] = _component(slides, d, slides.across, path, at, k + 1.0)
        if k == 0:
            _start(series)
            continue
        if k == 1 and not reach_of(series) > FROZEN:
            series[SIZE, 0, 0] = 0.0
        push = (k + 1) * size + n + slides.at[d, ROW]
        low = path[1, push] if path.shape[0] == 2 else 0.0
        series[PUSH, k - 1, 0], series[PUSH, k - 1, 1] = dd_mul_d(path[0, push], low, k * (k + 1.0))
        if not series[SIZE, 0, 0] > 0.0:
            series[COSINE, k] = 0.0
            series[SINE, k] = 0.0
            continue
        _turn(series, k)
        xh, xl = _product(series, COSINE, PUSH, 1, k)
        yh, yl = _product(series, SINE, PUSH, 1, k)
        xh, xl = dd_mul(xh, xl, slides.factor[d, 0], slides.factor[d, 1])
        yh, yl = dd_mul(yh, yl, slides.factor[d, 0], slides.factor[d, 1])
        for t in range(slides.at[d, FIRST], slides.at[d, FIRST] + slides.at[d, COUNT]):
            j = slides.coordinates[t]
            low = right[1, j] if path.shape[0] == 2 else 0.0
            sh, sl = gathered(right[0, j], low, slides.along[t, 0], slides.along[t, 1], xh, xl)
            sh, sl = gathered(sh, sl, slides.across[t, 0], slides.across[t, 1], yh, yl)
            right[0, j] = sh
            if path.shape[0] == 2:
                right[1, j] = sl


@kernel()
def _start(series: Floats) -> None:
    """Fill in the first coefficients of the size and direction of a slip."""
    x, y = series[ALONG, 0], series[ACROSS, 0]
    c = series[COSINE, 0]
    s = series[SINE, 0]
    c[0], c[1], s[0], s[1] = _unit(x[0], x[1], y[0], y[1])
    wh, wl = dd_mul(x[0], x[1], c[0], c[1])
    ph, pl = dd_mul(y[0], y[1], s[0], s[1])
    series[SIZE, 0, 0], series[SIZE, 0, 1] = dd_add(wh, wl, ph, pl)


@kernel()
def _turn(series: Floats, k: int) -> None:
    """Fill in coefficient k of the size and direction of a slip.

    From s = w e with the unit vector e: w_k is the component of s_k along e_0, less what products of earlier ones add.
    """
    e = series[COSINE, 0], series[SINE, 0]
    wh, wl, rests = 0.0, 0.0, series[COSINE : SINE + 1, k]
    for i in range(2):
        # s_k less the sum of w_j e_(k-j) over 0 < j < k.
        ph, pl = 0.0, 0.0
        for j in range(1, k):
            own = series[COSINE + i, k - j]
            ph, pl = gathered(ph, pl, series[SIZE, j, 0], series[SIZE, j, 1], own[0], own[1])
        ph, pl = settled(ph, pl)
        rests[i, 0], rests[i, 1] = dd_add(series[ALONG + i, k, 0], series[ALONG + i, k, 1], -ph, -pl)
        qh, ql = dd_mul(rests[i, 0], rests[i, 1], e[i][0], e[i][1])
        wh, wl = dd_add(wh, wl, qh, ql)
    # What is left is w_0 e_k + w_k e_0, and e_0 . e_k is minus half of the sum of e_j . e_(k-j) over 0 < j < k.
    ph, pl = 0.0, 0.0
    for j in range(1, k):
        for i in range(2):
            a, b = series[COSINE + i, j], series[COSINE + i, k - j]
            ph, pl = gathered(ph, pl, a[0], a[1], b[0], b[1])
    ph, pl = settled(ph, pl)
    ph, pl = dd_mul(0.5 * ph, 0.5 * pl, series[SIZE, 0, 0], series[SIZE, 0, 1])
    wh, wl = dd_add(wh, wl, ph, pl)
    series[SIZE, k, 0], series[SIZE, k, 1] = wh, wl
    for i in range(2):
        ph, pl = dd_mul(wh, wl, e[i][0], e[i][1])
        ph, pl = dd_add(rests[i, 0], rests[i, 1], -ph, -pl)
        rests[i, 0], rests[i, 1] = dd_div(ph, pl, series[SIZE, 0, 0], series[SIZE, 0, 1])


@kernel()
def reach_of(series: Floats) -> float:
    """Return the radius of convergence of the direction of a slip that changes uniformly, infinite for none."""
    size, change = (
        math.hypot(series[ALONG, 0, 0], series[ACROSS, 0, 0]),
        math.hypot(series[ALONG, 1, 0], series[ACROSS, 1, 0]),
    )
    return math.inf if size == 0.0 or change == 0.0 else size / change


@kernel()
def longest_step(table: Packed, products: Products, tolerance: float) -> float:
    """Return the longest step over which the directions of all slips hold, with what they add to rates, to a tolerance.

    Rates change by the radius r of convergence at most while a direction turns, of which a step h leaves out the share
    (h/r)^order.
    """
    found, order = math.inf, products.inverses.shape[0] - 1
    for d in range(table.slides.at.shape[0]):
        reach = reach_of(products.slips[d])
        if FROZEN < reach < math.inf:
            share = math.exp(math.log(tolerance / reach) / order)
            found = min(found, min(share, FARTHEST) * reach)
    return found


@kernel()
def least_reach(table: Packed, products: Products) -> float:
    """Return the least radius of convergence of the directions of all slips, infinite without any."""
    found = math.inf
    for d in range(table.slides.at.shape[0]):
        found = min(found, reach_of(products.slips[d]))
    return found
