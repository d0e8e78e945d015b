"""Linear algebra on arrays of pairs of doubles, whose last axis is (value, tail)."""

from __future__ import annotations

from core.arrays import Floats
from core.compiled import fma, kernel
from core.double_double import Pair, dd_add, dd_div, dd_mul, fast_two_sum, two_prod, two_sum


@kernel()
def gathered(sh: float, sl: float, ah: float, al: float, bh: float, bl: float) -> Pair:
    """Return s + a b with the tail of s summed in doubles: n products are right to about n 2^-105 of their sizes."""
    p, e = two_prod(ah, bh)
    s, t = two_sum(sh, p)
    return s, sl + (t + (e + fma(ah, bl, al * bh)))


@kernel()
def invert_pairs(a: Floats, out: Floats) -> bool:
    """Invert a matrix of pairs by Gauss-Jordan elimination with scaled pivots; `a` is used up.

    Parameters
    ----------
    a, out : (n, n, 2)
    """
    n = a.shape[0]
    for i in range(n):
        for j in range(n):
            out[i, j, 0] = 1.0 if i == j else 0.0
            out[i, j, 1] = 0.0
    scale = out[:, 0, 0].copy()
    for i in range(n):
        largest = 0.0
        for j in range(n):
            largest = max(largest, abs(a[i, j, 0]))
        if not largest > 0.0:
            return False
        scale[i] = 1.0 / largest
    for k in range(n):
        pivot, best = k, -1.0
        for i in range(k, n):
            size = abs(a[i, k, 0]) * scale[i]
            if size > best:
                pivot, best = i, size
        if not best > 1e-28:
            return False
        if pivot != k:
            for j in range(n):
                for part in range(2):
                    a[k, j, part], a[pivot, j, part] = a[pivot, j, part], a[k, j, part]
                    out[k, j, part], out[pivot, j, part] = out[pivot, j, part], out[k, j, part]
            scale[pivot] = scale[k]
        fh, fl = dd_div(1.0, 0.0, a[k, k, 0], a[k, k, 1])
        for j in range(n):
            a[k, j, 0], a[k, j, 1] = dd_mul(a[k, j, 0], a[k, j, 1], fh, fl)
            out[k, j, 0], out[k, j, 1] = dd_mul(out[k, j, 0], out[k, j, 1], fh, fl)
        for i in range(n):
            if i == k or a[i, k, 0] == 0.0:
                continue
            fh, fl = a[i, k, 0], a[i, k, 1]
            for j in range(k, n):
                if a[k, j, 0] != 0.0:
                    ph, pl = dd_mul(a[k, j, 0], a[k, j, 1], fh, fl)
                    a[i, j, 0], a[i, j, 1] = dd_add(a[i, j, 0], a[i, j, 1], -ph, -pl)
            for j in range(n):
                if out[k, j, 0] != 0.0:
                    ph, pl = dd_mul(out[k, j, 0], out[k, j, 1], fh, fl)
                    out[i, j, 0], out[i, j, 1] = dd_add(out[i, j, 0], out[i, j, 1], -ph, -pl)
    return True


@kernel()
def settled(sh: float, sl: float) -> Pair:
    """Return a gathered sum as a pair."""
    return fast_two_sum(sh, sl)
