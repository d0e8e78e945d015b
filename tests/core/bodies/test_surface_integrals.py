"""Sums over faces against integrals of polynomials in rational arithmetic, and surfaces distinguished by search.

The oracle integrates over faces, the code over tetrahedra (`tests.core.bodies.polyhedra`). u^2 = 2^-106.
"""

from __future__ import annotations

from fractions import Fraction

import numpy as np
from hypothesis import given, settings
from hypothesis import strategies as st

from core.bodies.surface_integrals import connected_surfaces, faces_without_area, signed_tetrahedra
from tests.core.bodies.polyhedra import CUBOID, TETRAHEDRON, integral
from tests.drawn import draws

SQUARE = Fraction(2) ** -106

coordinate = st.floats(-1.0, 1.0).map(lambda x: x if abs(x) > 1e-20 else 0.0)
vertex = st.tuples(coordinate, coordinate, coordinate)
part = st.floats(-0.5, 0.5)
closed = st.one_of(
    st.tuples(st.lists(vertex, min_size=4, max_size=4), st.just(TETRAHEDRON)),
    st.tuples(st.lists(vertex, min_size=8, max_size=8), st.just(CUBOID)),
)
"""Closed by their indices, with corners anywhere and either orientation: integrals are signed."""

POWERS = ((2, 0, 0), (0, 2, 0), (0, 0, 2), (1, 1, 0), (1, 0, 1), (0, 1, 1))


@settings(deadline=None, derandomize=True, max_examples=30)
@given(closed, part)
def test_integrals_over_the_inside(surface, share) -> None:
    corners, faces = surface
    vertices = np.array(corners)
    tails = share * np.spacing(np.abs(vertices)) * (vertices != 0.0)
    sums, volumes = np.zeros((2, 10)), np.zeros(1)
    magnitude = signed_tetrahedra(
        vertices, tails, np.array(faces), np.zeros(len(corners), dtype=np.int64), sums, volumes
    )
    exact = [
        [Fraction(float(x)) + Fraction(float(t)) for x, t in zip(*row, strict=True)]
        for row in zip(vertices, tails, strict=True)
    ]
    got = [Fraction(float(h)) + Fraction(float(t)) for h, t in zip(*sums, strict=True)]
    wanted = [6 * integral(exact, faces, (0, 0, 0))]
    wanted += [24 * integral(exact, faces, tuple(int(k == x) for k in range(3))) for x in range(3)]
    wanted += [120 * integral(exact, faces, powers) for powers in POWERS]
    # A volume: a cofactor of two products and a difference, a product, three sums; then one sum a face. The sums of
    # corners are at most 3, what multiplies second moments at most 12, for one more product and a few sums.
    each = 4 + 4 + 3 + 4 + 9
    few = [each, *3 * [3 * (each + 6 + 4)], *6 * [12 * (each + 12 + 10 + 4)]]
    for g, w, count in zip(got, wanted, few, strict=True):
        assert abs(g - w) <= (count + 12 * 3 * len(faces)) * SQUARE * Fraction(float(magnitude))
    assert abs(Fraction(float(volumes[0])) - wanted[0]) <= len(faces) * Fraction(2) ** -53 * Fraction(magnitude)
    size = sum(
        abs(exact[i][x]) * (abs(exact[j][y] * exact[k][z]) + abs(exact[j][z] * exact[k][y]))
        for i, j, k in faces
        for x, y, z in ((0, 1, 2), (1, 2, 0), (2, 0, 1))
    )
    # What is rounded is stated from doubles: the tails left out, seven roundings a term and one a sum.
    assert abs(Fraction(magnitude) - size) <= (3 + 7 + 3 * len(faces)) * Fraction(2) ** -53 * size


@settings(deadline=None, derandomize=True, max_examples=draws(200))
@given(vertex, vertex, vertex, st.integers(-(2**20), 2**20))
def test_only_corners_on_one_line_have_no_area(a, b, c, along) -> None:
    faces = np.array([[0, 1, 2], [0, 1, 3]])
    # The fourth corner lies on the line through the first two where doubles allow it: on lattice points.
    grid = np.round(np.array([a, b, c]) * 1024)
    line = grid[0] + along * (grid[1] - grid[0])
    vertices = np.vstack([grid, line])
    count, first = faces_without_area(vertices, faces)
    flat = [n for n, face in enumerate(faces) if not area_squared(vertices[face])]
    assert (count, first) == (len(flat), flat[0] if flat else -1)
    assert 1 in flat


def area_squared(corners: np.ndarray) -> Fraction:
    a, b, c = ([Fraction(float(x)) for x in corner] for corner in corners)
    p, q = [y - x for x, y in zip(a, b, strict=True)], [y - x for x, y in zip(a, c, strict=True)]
    return sum(((p[i - 2] * q[i - 1] - p[i - 1] * q[i - 2]) ** 2 for i in range(3)), Fraction(0))


@settings(deadline=None, derandomize=True, max_examples=draws(150))
@given(st.data())
def test_surfaces_are_distinguished_by_their_vertices(data: st.DataObject) -> None:
    n = data.draw(st.integers(3, 14))
    corners = st.lists(st.integers(0, n - 1), min_size=3, max_size=3, unique=True)
    faces = data.draw(st.lists(corners, min_size=1, max_size=8))
    surface = np.zeros(n, dtype=np.int64)
    count = connected_surfaces(np.array(faces), surface)
    # By search: faces that share a vertex, merged until none does.
    groups: list[set[int]] = []
    for face in faces:
        met = [group for group in groups if group & set(face)]
        groups = [group for group in groups if group not in met] + [set(face).union(*met)]
    assert count == len(groups)
    used = set().union(*groups)
    assert all((surface[v] == -1) == (v not in used) for v in range(n))
    for v in used:
        for w in used:
            assert (surface[v] == surface[w]) == any({v, w} <= group for group in groups)
    assert set(surface[sorted(used)].tolist()) == set(range(count))
