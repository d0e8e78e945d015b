"""Eigenvalues and eigenvectors of a symmetric 3 x 3 tensor in double-double arithmetic, by cyclic Jacobi rotations.

Jacobi's method, unlike a reduction to tridiagonal form or the roots of the characteristic polynomial, does not change
components that are already decoupled (a zero off-diagonal component costs no rotation and no rounding) and finds the
small eigenvalues of a graded positive tensor to high relative accuracy.

References
----------
G. H. Golub, C. F. Van Loan, "Matrix Computations", 4th ed. (2013), section 8.5.
J. Demmel, K. Veselic, "Jacobi's method is more accurate than QR", SIAM J. Matrix Anal. Appl. 13 (1992), 1204.
"""

from __future__ import annotations

import math

import numpy as np

from core.arrays import Floats
from core.compiled import kernel
from core.double_double import dd_add, dd_add_d, dd_div, dd_mul, dd_sqrt, dd_sub

_SWEEPS = 40
# An off-diagonal component below this fraction of sqrt(|a_pp a_qq|) changes no eigenvalue by one part in 2^106.
_NEGLIGIBLE = 2.0**-112


@kernel()
def jacobi(tensor: Floats, tensor_tail: Floats) -> tuple[Floats, Floats, Floats, Floats]:
    """Diagonalise a symmetric tensor.

    Parameters
    ----------
    tensor, tensor_tail : ndarray, shape (3, 3)
        Only the upper triangle is read. The largest component should be of order one.

    Returns
    -------
    values, values_tail : ndarray, shape (3,)
        Eigenvalues, in no order.
    vectors, vectors_tail : ndarray, shape (3, 3)
        Columns are the unit eigenvectors; determinant +1.
    """
    a, e = tensor.copy(), tensor_tail.copy()
    v, w = np.eye(3), np.zeros((3, 3))
    for _ in range(_SWEEPS):
        rotated = False
        for p, q in ((0, 1), (0, 2), (1, 2)):
            h, low = a[p, q], e[p, q]
            if h == 0.0:
                continue
            if abs(h) <= _NEGLIGIBLE * math.sqrt(abs(a[p, p])) * math.sqrt(abs(a[q, q])):
                continue
            rotated = True
            # cot(2 phi), and t = tan(phi) as the smaller root of t^2 + 2 t cot(2 phi) = 1.
            dh, dl = dd_sub(a[q, q], e[q, q], a[p, p], e[p, p])
            if abs(h) < 1e-60 * abs(dh):
                th, tl = dd_div(h, low, dh, dl)
            else:
                ch, cl = dd_div(dh, dl, 2.0 * h, 2.0 * low)
                sh, sl = dd_mul(ch, cl, ch, cl)
                sh, sl = dd_add_d(sh, sl, 1.0)
                rh, rl = dd_sqrt(sh, sl)
                if ch < 0.0:
                    rh, rl = -rh, -rl
                rh, rl = dd_add(ch, cl, rh, rl)
                th, tl = dd_div(1.0, 0.0, rh, rl)
            # Cosine c, sine s and u = s/(1 + c): updates written as x - s (y + u x) round only the small correction.
            sh, sl = dd_mul(th, tl, th, tl)
            sh, sl = dd_add_d(sh, sl, 1.0)
            sh, sl = dd_sqrt(sh, sl)
            ch, cl = dd_div(1.0, 0.0, sh, sl)
            sh, sl = dd_mul(th, tl, ch, cl)
            ch, cl = dd_add_d(ch, cl, 1.0)
            uh, ul = dd_div(sh, sl, ch, cl)
            th, tl = dd_mul(th, tl, h, low)
            a[p, p], e[p, p] = dd_sub(a[p, p], e[p, p], th, tl)
            a[q, q], e[q, q] = dd_add(a[q, q], e[q, q], th, tl)
            a[p, q], e[p, q] = 0.0, 0.0
            r = 3 - p - q
            i, j = min(p, r), max(p, r)
            k, m = min(q, r), max(q, r)
            a[i, j], e[i, j], a[k, m], e[k, m] = _turn(a[i, j], e[i, j], a[k, m], e[k, m], sh, sl, uh, ul)
            for n in range(3):
                v[n, p], w[n, p], v[n, q], w[n, q] = _turn(v[n, p], w[n, p], v[n, q], w[n, q], sh, sl, uh, ul)
        if not rotated:
            break
    return np.diag(a).copy(), np.diag(e).copy(), v, w


@kernel()
def _turn(
    xh: float, xl: float, yh: float, yl: float, sh: float, sl: float, uh: float, ul: float
) -> tuple[float, float, float, float]:
    """Return x - s (y + u x) and y + s (x - u y)."""
    ph, pl = dd_mul(uh, ul, xh, xl)
    ph, pl = dd_add(yh, yl, ph, pl)
    ph, pl = dd_mul(sh, sl, ph, pl)
    qh, ql = dd_mul(uh, ul, yh, yl)
    qh, ql = dd_sub(xh, xl, qh, ql)
    qh, ql = dd_mul(sh, sl, qh, ql)
    ph, pl = dd_sub(xh, xl, ph, pl)
    qh, ql = dd_add(yh, yl, qh, ql)
    return ph, pl, qh, ql
