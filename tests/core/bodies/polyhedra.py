"""Closed surfaces of triangles, and the integrals inside them in rational arithmetic: the tests' own oracle.

The oracle integrates faces, not tetrahedra: by the divergence theorem the integral of x^p y^q z^r over a solid is the
flux of (x^(p+1) y^q z^r/(p+1), 0, 0) through its surface, and over a triangle a polynomial in barycentric coordinates
is integrated by l1^a l2^b l3^c -> a! b! c! / (a + b + c + 2)! times twice the area.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from fractions import Fraction
from itertools import product
from math import factorial

import numpy as np
from numpy.typing import NDArray

Vertices = list[list[float]]
Faces = list[list[int]]
Polynomial = dict[tuple[int, int, int], Fraction]

TETRAHEDRON: Faces = [[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]]
CUBOID: Faces = [[0, 1, 3], [0, 3, 2], [4, 6, 7], [4, 7, 5], [0, 4, 5], [0, 5, 1], [2, 3, 7], [2, 7, 6], [0, 2, 6],
                 [0, 6, 4], [1, 5, 7], [1, 7, 3]]  # fmt: skip


def cuboid(edges: Sequence[float], corner: Sequence[float] = (0.0, 0.0, 0.0)) -> tuple[Vertices, Faces]:
    """Return a block with edges along the axes, its lowest corner at `corner`."""
    corners = product(*((c, c + e) for c, e in zip(corner, edges, strict=True)))
    return [list(map(float, vertex)) for vertex in corners], [list(face) for face in CUBOID]


def icosphere(level: int) -> tuple[NDArray[np.float64], NDArray[np.int64]]:
    """Return a sphere of radius 1 as 20 * 4^level triangles with corners on it."""
    golden = (1 + 5**0.5) / 2
    corners = [[0.0, s, t * golden] for s in (-1, 1) for t in (-1, 1)]
    vertices = np.array([np.roll(corner, k) for k in range(3) for corner in corners])
    near = np.linalg.norm(vertices[:, None] - vertices[None], axis=2) < 2.1
    triples = [
        (i, j, k)
        for i in range(12) for j in range(i) for k in range(j) if near[i, j] and near[j, k] and near[k, i]
    ]  # fmt: skip
    faces = np.array([t if np.linalg.det(vertices[list(t)]) > 0 else t[::-1] for t in triples])
    vertices /= np.linalg.norm(vertices, axis=1)[:, None]
    for _ in range(level):
        edges = np.sort(np.vstack([faces[:, [0, 1]], faces[:, [1, 2]], faces[:, [2, 0]]]), axis=1)
        unique, place = np.unique(edges, axis=0, return_inverse=True)
        ab, bc, ca = place.reshape(3, -1) + len(vertices)
        middle = vertices[unique].sum(axis=1)
        vertices = np.vstack([vertices, middle / np.linalg.norm(middle, axis=1)[:, None]])
        a, b, c = faces.T
        faces = np.vstack([np.c_[a, ab, ca], np.c_[ab, b, bc], np.c_[ca, bc, c], np.c_[ab, bc, ca]])
    return vertices, faces


def integral(vertices: Iterable[Sequence[float]], faces: Iterable[Sequence[int]], powers: Sequence[int]) -> Fraction:
    """Return the integral of x^p y^q z^r over the inside, exactly."""
    points = [[Fraction(x) for x in vertex] for vertex in vertices]
    total = Fraction(0)
    for face in faces:
        a, b, c = (points[i] for i in face)
        # x component of (b - a) x (c - a): twice the area times the normal's.
        normal = (b[1] - a[1]) * (c[2] - a[2]) - (b[2] - a[2]) * (c[1] - a[1])
        terms: Polynomial = {(0, 0, 0): Fraction(1)}
        for axis, power in enumerate((powers[0] + 1, powers[1], powers[2])):
            for _ in range(power):
                terms = _times_coordinate(terms, (a[axis], b[axis], c[axis]))
        total += normal * sum(
            v * Fraction(factorial(i) * factorial(j) * factorial(k), factorial(i + j + k + 2))
            for (i, j, k), v in terms.items()
        )
    return total / (powers[0] + 1)


def _times_coordinate(terms: Polynomial, corners: Sequence[Fraction]) -> Polynomial:
    found: Polynomial = {}
    for key, value in terms.items():
        for n, corner in enumerate(corners):
            raised = (key[0] + (n == 0), key[1] + (n == 1), key[2] + (n == 2))
            found[raised] = found.get(raised, Fraction(0)) + value * corner
    return found


def exact_properties(vertices: Vertices, faces: Faces) -> tuple[Fraction, list[Fraction], list[list[Fraction]]]:
    """Return volume, centroid and tensor of inertia about it at density 1, exactly."""
    volume = integral(vertices, faces, (0, 0, 0))
    unit = [(1, 0, 0), (0, 1, 0), (0, 0, 1)]
    center = [integral(vertices, faces, u) / volume for u in unit]
    second = [
        [
            integral(vertices, faces, [a + b for a, b in zip(unit[i], unit[j], strict=True)])
            - volume * center[i] * center[j]
            for j in range(3)
        ]
        for i in range(3)
    ]
    trace = second[0][0] + second[1][1] + second[2][2]
    return volume, center, [[(trace if i == j else 0) - second[i][j] for j in range(3)] for i in range(3)]
