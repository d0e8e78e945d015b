"""Volume, first and second moments of the solid inside a triangulated surface, in double-double, compiled.

By the divergence theorem the integral over the solid is the sum over the faces of the integral over the tetrahedron
that a face (a, b, c) forms with a reference point at the origin, signed by D = a . (b x c):

    1: D/6,   x_i: D s_i / 24,   x_i x_j: D (s_i s_j + a_i a_j + b_i b_j + c_i c_j) / 120,   s = a + b + c.

References
----------
B. Mirtich, "Fast and accurate computation of polyhedral mass properties", J. Graphics Tools 1 (1996), 31-50.
F. Tonon, "Explicit exact formulas for the 3-D tetrahedron inertia tensor in terms of its vertex coordinates",
J. Mathematics and Statistics 1 (2005), 8-11.
D. Eberly, "Polyhedral mass properties (revisited)", Geometric Tools (2002).
"""

from __future__ import annotations

import numpy as np

from core.arrays import Floats, Integers
from core.compiled import kernel
from core.double_double import Pair, dd_add, dd_mul, dd_sub

# Twice the relative error of the two products of a component of a cross product whose factors are differences.
_PARALLEL = 2.0**-50


@kernel()
def _cofactor(ph: float, pl: float, qh: float, ql: float, rh: float, rl: float, sh: float, sl: float) -> Pair:
    """Return p s - q r."""
    ah, al = dd_mul(ph, pl, sh, sl)
    bh, bl = dd_mul(qh, ql, rh, rl)
    return dd_sub(ah, al, bh, bl)


@kernel()
def signed_tetrahedra(
    vertices: Floats, tails: Floats, faces: Integers, surface: Integers, sums: Floats, volumes: Floats
) -> float:
    """Sum the integrals over all faces.

    Parameters
    ----------
    vertices, tails : ndarray, shape (n, 3)
        Coordinates as sums of two doubles, relative to the reference point, at most 1 in size.
    faces : ndarray, shape (m, 3)
        Vertices of each face, counter-clockwise as seen from outside.
    surface : ndarray, shape (n,)
        Number of the closed surface to which a vertex belongs.
    sums : ndarray, shape (2, 10)
        Filled with values and tails of the sums of D; D (a+b+c)_i; D (s_i s_j + ...) for xx, yy, zz, xy, xz, yz.
    volumes : ndarray, shape (number of surfaces,)
        Filled with the sum of D for each surface, in doubles.

    Returns
    -------
    float
        Sum over the faces of D with every term taken positive, to which the rounding error is proportional.
    """
    magnitude = 0.0
    sh, sl = np.empty(3), np.empty(3)
    for n in range(faces.shape[0]):
        i, j, k = faces[n, 0], faces[n, 1], faces[n, 2]
        dh, dl = 0.0, 0.0
        for x in range(3):
            y, z = (x + 1) % 3, (x + 2) % 3
            ch, cl = _cofactor(
                vertices[j, y], tails[j, y], vertices[j, z], tails[j, z],
                vertices[k, y], tails[k, y], vertices[k, z], tails[k, z],
            )  # fmt: skip
            ch, cl = dd_mul(ch, cl, vertices[i, x], tails[i, x])
            dh, dl = dd_add(dh, dl, ch, cl)
            magnitude += abs(vertices[i, x]) * (
                abs(vertices[j, y] * vertices[k, z]) + abs(vertices[j, z] * vertices[k, y])
            )
        volumes[surface[i]] += dh
        sums[0, 0], sums[1, 0] = dd_add(sums[0, 0], sums[1, 0], dh, dl)
        for x in range(3):
            h, low = dd_add(vertices[i, x], tails[i, x], vertices[j, x], tails[j, x])
            sh[x], sl[x] = dd_add(h, low, vertices[k, x], tails[k, x])
            h, low = dd_mul(dh, dl, sh[x], sl[x])
            sums[0, 1 + x], sums[1, 1 + x] = dd_add(sums[0, 1 + x], sums[1, 1 + x], h, low)
        for x in range(3):
            for y in range(x, 3):
                h, low = dd_mul(sh[x], sl[x], sh[y], sl[y])
                for v in (i, j, k):
                    ph, pl = dd_mul(vertices[v, x], tails[v, x], vertices[v, y], tails[v, y])
                    h, low = dd_add(h, low, ph, pl)
                h, low = dd_mul(dh, dl, h, low)
                place = 4 + x if x == y else 6 + x + y
                sums[0, place], sums[1, place] = dd_add(sums[0, place], sums[1, place], h, low)
    return magnitude


@kernel()
def faces_without_area(vertices: Floats, faces: Integers) -> tuple[int, int]:
    """Return the number of faces with collinear corners, within rounding, and the first of them (-1 if none)."""
    count, first = 0, -1
    for n in range(faces.shape[0]):
        i, j, k = faces[n, 0], faces[n, 1], faces[n, 2]
        flat = True
        for x in range(3):
            y, z = (x + 1) % 3, (x + 2) % 3
            p = (vertices[j, y] - vertices[i, y]) * (vertices[k, z] - vertices[i, z])
            q = (vertices[j, z] - vertices[i, z]) * (vertices[k, y] - vertices[i, y])
            if abs(p - q) > _PARALLEL * (abs(p) + abs(q)):
                flat = False
        if flat:
            count += 1
            if first < 0:
                first = n
    return count, first


@kernel()
def connected_surfaces(faces: Integers, surface: Integers) -> int:
    """Number the surfaces that share no vertex in `surface`, shape (n,), and return their number.

    A vertex that no face uses belongs to no surface and gets -1. (Disjoint sets with path halving: R. Sedgewick,
    K. Wayne, "Algorithms", 4th ed. (2011), section 1.5.)
    """
    parent = np.full(surface.size, -1, dtype=np.int64)
    for n in range(faces.shape[0]):
        for k in range(3):
            v = faces[n, k]
            if parent[v] < 0:
                parent[v] = v
        root = faces[n, 0]
        while parent[root] != root:
            parent[root] = parent[parent[root]]
            root = parent[root]
        for k in (1, 2):
            v = faces[n, k]
            while parent[v] != v:
                parent[v] = parent[parent[v]]
                v = parent[v]
            parent[v] = root
    count = 0
    for v in range(surface.size):
        surface[v] = -1
        if parent[v] == v:
            surface[v] = count
            count += 1
    for v in range(surface.size):
        if parent[v] >= 0:
            root = v
            while parent[root] != root:
                root = parent[root]
            surface[v] = surface[root]
    return count
