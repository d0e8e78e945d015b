"""Volume, centre of mass and second moments of a closed triangle mesh in double-double, compiled.

A closed surface is the signed sum of the tetrahedra that its triangles span with any one point, and over a tetrahedron
with a corner at the origin and edges a, b, c, of determinant D = a.(b x c),

    integral dV = D/6,   integral x dV = D (a + b + c)/24,
    integral x x^T dV = D [(a + b + c)(a + b + c)^T + a a^T + b b^T + c c^T]/120.

The point is first the middle of the mesh, then the centre of mass itself, so that nothing cancels wherever the mesh is.

References
----------
F. Tonon, "Explicit exact formulas for the 3-D tetrahedron inertia tensor", J. Math. Stat. 1 (2005), 8-11.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from core.compiled import kernel
from core.double_double import dd_add, dd_add_d, dd_div, dd_mul, dd_sub, two_sum

Floats = NDArray[np.float64]


@kernel()
def mesh_integrals(vertices: Floats, faces: NDArray[np.int64], middle: Floats, out: Floats) -> None:
    """Fill `out`, shape (2, 10): volume, centre of mass (3), second moments xx yy zz xy xz yz about it; and tails."""
    center, shift = np.zeros((2, 3)), np.zeros((2, 3))
    edges = np.zeros((2, 3, 3))
    first, second = np.zeros((2, 3)), np.zeros((2, 3, 3))
    vh, vl = 0.0, 0.0
    for turn in range(2):
        vh, vl = 0.0, 0.0
        first[:], second[:] = 0.0, 0.0
        for f in range(faces.shape[0]):
            for k in range(3):
                for j in range(3):
                    h, t = two_sum(vertices[faces[f, k], j], -middle[j])
                    edges[0, k, j], edges[1, k, j] = dd_sub(h, t, shift[0, j], shift[1, j])
            dh, dl = _determinant(edges)
            vh, vl = dd_add(vh, vl, dh, dl)
            _add_moments(edges, dh, dl, first, second, turn == 1)
        if turn == 0:
            for j in range(3):
                h, t = dd_div(first[0, j], first[1, j], 4.0 * vh, 4.0 * vl) if vh != 0.0 else (0.0, 0.0)
                shift[0, j], shift[1, j] = h, t
                center[0, j], center[1, j] = dd_add_d(h, t, middle[j])
    out[0, 0], out[1, 0] = dd_div(vh, vl, 6.0, 0.0)
    for j in range(3):
        out[0, 1 + j], out[1, 1 + j] = center[0, j], center[1, j]
        out[0, 4 + j], out[1, 4 + j] = dd_div(second[0, j, j], second[1, j, j], 120.0, 0.0)
    out[0, 7], out[1, 7] = dd_div(second[0, 0, 1], second[1, 0, 1], 120.0, 0.0)
    out[0, 8], out[1, 8] = dd_div(second[0, 0, 2], second[1, 0, 2], 120.0, 0.0)
    out[0, 9], out[1, 9] = dd_div(second[0, 1, 2], second[1, 1, 2], 120.0, 0.0)


@kernel()
def _determinant(m: Floats) -> tuple[float, float]:
    """Return the determinant of the rows of `m`, shape (2, 3, 3)."""
    sh, sl = 0.0, 0.0
    for i in range(3):
        j, k = (i + 1) % 3, (i + 2) % 3
        ph, pl = dd_mul(m[0, 1, j], m[1, 1, j], m[0, 2, k], m[1, 2, k])
        qh, ql = dd_mul(m[0, 1, k], m[1, 1, k], m[0, 2, j], m[1, 2, j])
        ph, pl = dd_sub(ph, pl, qh, ql)
        ph, pl = dd_mul(ph, pl, m[0, 0, i], m[1, 0, i])
        sh, sl = dd_add(sh, sl, ph, pl)
    return sh, sl


@kernel()
def _add_moments(m: Floats, dh: float, dl: float, first: Floats, second: Floats, deep: bool) -> None:
    """Add D (a + b + c) to `first` and, if `deep`, 120 times the second moments to the upper triangle of `second`."""
    for i in range(3):
        sh, sl = dd_add(m[0, 0, i], m[1, 0, i], m[0, 1, i], m[1, 1, i])
        sh, sl = dd_add(sh, sl, m[0, 2, i], m[1, 2, i])
        sh, sl = dd_mul(sh, sl, dh, dl)
        if not deep:
            first[0, i], first[1, i] = dd_add(first[0, i], first[1, i], sh, sl)
            continue
        for j in range(i, 3):
            th, tl = dd_add(m[0, 0, j], m[1, 0, j], m[0, 1, j], m[1, 1, j])
            th, tl = dd_add(th, tl, m[0, 2, j], m[1, 2, j])
            th, tl = dd_mul(th, tl, sh, sl)
            for k in range(3):
                ph, pl = dd_mul(m[0, k, i], m[1, k, i], m[0, k, j], m[1, k, j])
                ph, pl = dd_mul(ph, pl, dh, dl)
                th, tl = dd_add(th, tl, ph, pl)
            second[0, i, j], second[1, i, j] = dd_add(second[0, i, j], second[1, i, j], th, tl)
