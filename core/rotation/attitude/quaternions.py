"""Quaternions of 106 bits, compiled; for constants that multiply every sample."""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from core.compiled import kernel
from core.double_double import Pair, dd_add, dd_div, dd_mul, dd_sqr, dd_sqrt


class Quaternion(NamedTuple):
    """w + x i + y j + z k, each an unevaluated sum of two doubles."""

    w: Pair
    x: Pair
    y: Pair
    z: Pair


ZERO, ONE = (0.0, 0.0), (1.0, 0.0)
IDENTITY = Quaternion(ONE, ZERO, ZERO, ZERO)
"""The identity."""


@kernel()
def _minus(a: Pair) -> Pair:
    return -a[0], -a[1]


@kernel()
def _plus(a: Pair, b: Pair) -> Pair:
    return dd_add(a[0], a[1], b[0], b[1])


@kernel()
def _products(a: Pair, b: Pair, c: Pair, d: Pair, e: Pair, f: Pair, g: Pair, h: Pair) -> Pair:
    """Return a b + c d + e f + g h."""
    first = _plus(dd_mul(a[0], a[1], b[0], b[1]), dd_mul(c[0], c[1], d[0], d[1]))
    second = _plus(dd_mul(e[0], e[1], f[0], f[1]), dd_mul(g[0], g[1], h[0], h[1]))
    return _plus(first, second)


@kernel()
def product(p: Quaternion, q: Quaternion) -> Quaternion:
    """Return Hamilton's product p q: the rotation q, followed by p."""
    x, y, z = _minus(p.x), _minus(p.y), _minus(p.z)
    return Quaternion(
        _products(p.w, q.w, x, q.x, y, q.y, z, q.z),
        _products(p.w, q.x, p.x, q.w, p.y, q.z, z, q.y),
        _products(p.w, q.y, p.y, q.w, p.z, q.x, x, q.z),
        _products(p.w, q.z, p.z, q.w, p.x, q.y, y, q.x),
    )


@kernel()
def conjugate(q: Quaternion) -> Quaternion:
    """Return w - x i - y j - z k, the inverse rotation of a unit quaternion."""
    return Quaternion(q.w, _minus(q.x), _minus(q.y), _minus(q.z))


@kernel()
def unit(q: Quaternion) -> Quaternion:
    """Return q/|q|; q may be of any length but zero."""
    largest = max(max(abs(q.w[0]), abs(q.x[0])), max(abs(q.y[0]), abs(q.z[0])))
    # Powers of two in two steps: the inverse of a subnormal number would overflow.
    exponent = -math.frexp(largest)[1]
    half = exponent // 2
    f, g = math.ldexp(1.0, half), math.ldexp(1.0, exponent - half)
    w, x = (q.w[0] * f * g, q.w[1] * f * g), (q.x[0] * f * g, q.x[1] * f * g)
    y, z = (q.y[0] * f * g, q.y[1] * f * g), (q.z[0] * f * g, q.z[1] * f * g)
    square = _plus(_plus(dd_sqr(w[0], w[1]), dd_sqr(x[0], x[1])), _plus(dd_sqr(y[0], y[1]), dd_sqr(z[0], z[1])))
    h, low = dd_sqrt(square[0], square[1])
    return Quaternion(
        dd_div(w[0], w[1], h, low), dd_div(x[0], x[1], h, low), dd_div(y[0], y[1], h, low), dd_div(z[0], z[1], h, low)
    )


@kernel()
def of_matrix(m: NDArray[np.float64], tail: NDArray[np.float64]) -> Quaternion:
    """Return the unit quaternion of a rotation matrix, by its largest component (S. W. Shepperd, 1978).

    Parameters
    ----------
    m, tail : ndarray, shape (3, 3)
        The matrix is their sum.
    """
    a, b, c = (m[0, 0], tail[0, 0]), (m[1, 1], tail[1, 1]), (m[2, 2], tail[2, 2])
    p, q, r = _plus(ONE, a), _plus(ONE, _minus(a)), _plus(b, c)
    s = _plus(b, _minus(c))
    # Four times the squares of w, x, y, z.
    ww, xx, yy, zz = _plus(p, r), _plus(p, _minus(r)), _plus(q, s), _plus(q, _minus(s))
    wx = _plus((m[2, 1], tail[2, 1]), (-m[1, 2], -tail[1, 2]))
    wy = _plus((m[0, 2], tail[0, 2]), (-m[2, 0], -tail[2, 0]))
    wz = _plus((m[1, 0], tail[1, 0]), (-m[0, 1], -tail[0, 1]))
    xy = _plus((m[1, 0], tail[1, 0]), (m[0, 1], tail[0, 1]))
    xz = _plus((m[0, 2], tail[0, 2]), (m[2, 0], tail[2, 0]))
    yz = _plus((m[2, 1], tail[2, 1]), (m[1, 2], tail[1, 2]))
    largest = max(max(ww[0], xx[0]), max(yy[0], zz[0]))
    if ww[0] == largest:
        return unit(Quaternion(ww, wx, wy, wz))
    if xx[0] == largest:
        return unit(Quaternion(wx, xx, xy, xz))
    if yy[0] == largest:
        return unit(Quaternion(wy, xy, yy, yz))
    return unit(Quaternion(wz, xz, yz, zz))


@kernel()
def fill_between(p: Quaternion, r: Quaternion, out: NDArray[np.float64]) -> None:
    """Fill `out`, shape (4, 4), with the matrix that takes the components of q to those of p q r, rounded."""
    for k in range(4):
        basis = Quaternion(
            ONE if k == 0 else ZERO, ONE if k == 1 else ZERO, ONE if k == 2 else ZERO, ONE if k == 3 else ZERO
        )
        column = product(product(p, basis), r)
        out[0, k], out[1, k], out[2, k], out[3, k] = column.w[0], column.x[0], column.y[0], column.z[0]
