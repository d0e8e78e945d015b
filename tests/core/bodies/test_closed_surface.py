"""Which faces close, against a count of directed edges in a dictionary."""

from __future__ import annotations

from collections import Counter

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from core.bodies.closed_surface import closed
from core.errors import InvalidParameter, OpenMesh
from tests.core.bodies.polyhedra import CUBOID, TETRAHEDRON, cuboid, icosphere
from tests.drawn import draws

SHAPES = [
    (np.array([[0.0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]]), np.array(TETRAHEDRON)),
    (np.array(cuboid((1.0, 2.0, 3.0))[0]), np.array(CUBOID)),
    icosphere(1),
]
shape = st.sampled_from(range(len(SHAPES)))


def edges(faces: np.ndarray) -> Counter:
    return Counter((int(face[k]), int(face[k - 2])) for face in faces for k in range(3))


def closes(faces: np.ndarray) -> bool:
    """Tell whether every edge is run along once, and once the other way."""
    count = edges(faces)
    return all(n == 1 and count[b, a] == 1 for (a, b), n in count.items())


@settings(deadline=None, derandomize=True, max_examples=draws(60))
@given(shape, st.randoms(use_true_random=False))
def test_faces_in_any_order_from_any_corner_close_as_they_are(which: int, random) -> None:
    vertices, faces = SHAPES[which]
    order = random.sample(range(len(faces)), len(faces))
    given_faces = np.array([np.roll(faces[n], random.randrange(3)) for n in order])
    assert closes(given_faces)
    assert closed(vertices, given_faces) is given_faces


@settings(deadline=None, derandomize=True, max_examples=draws(60))
@given(shape, st.randoms(use_true_random=False))
def test_corners_of_each_triangle_s_own_are_joined_by_their_places(which: int, random) -> None:
    vertices, faces = SHAPES[which]
    corners = vertices[faces].reshape(-1, 3)
    # Minus zero is the same place as zero.
    signs = np.array([[random.choice([1.0, -1.0]) for _ in range(3)] for _ in corners])
    corners = np.where(corners == 0.0, 0.0 * signs, corners)
    own = np.arange(len(corners)).reshape(-1, 3)
    assert not closes(own)
    found = closed(corners, own)
    assert closes(found)
    assert np.array_equal(corners[found] + 0.0, vertices[faces])
    assert not found.flags.writeable


@settings(deadline=None, derandomize=True, max_examples=draws(60))
@given(shape, st.randoms(use_true_random=False))
def test_every_kind_of_damage_is_reported_with_its_face(which: int, random) -> None:
    vertices, faces = SHAPES[which]
    n = random.randrange(len(faces))
    with pytest.raises(OpenMesh, match="3 of") as hole:
        closed(vertices, np.delete(faces, n, axis=0))
    assert hole.value.path == ("faces",)
    turned = faces.copy()
    turned[n] = turned[n, ::-1]
    with pytest.raises(InvalidParameter, match=f"at 3 of {len(faces) * 3 // 2} edges both faces run in the same"):
        closed(vertices, turned)
    again = np.vstack([faces, np.roll(faces[n], 1)])
    with pytest.raises(InvalidParameter, match=f"differ from faces/{n}: it is the same face again") as repeated:
        closed(vertices, again)
    assert repeated.value.path == ("faces", len(faces))
    twice = faces.copy()
    twice[n, 1] = twice[n, 0]
    with pytest.raises(InvalidParameter, match="three different vertices") as refused:
        closed(vertices, twice)
    assert refused.value.path == ("faces", n)
    beyond = faces.copy()
    beyond[n, 2] = len(vertices)
    with pytest.raises(InvalidParameter, match=f"at most {len(vertices) - 1}") as missing:
        closed(vertices, beyond)
    assert missing.value.path == ("faces", n, 2)


def test_two_bodies_that_touch_in_an_edge_are_distinguished_from_a_hole() -> None:
    vertices, faces = SHAPES[0]
    # A second tetrahedron on the other side of the edge from vertex 0 to vertex 1.
    more = np.vstack([vertices, [[0.0, -1.0, 0.0], [0.0, 0.0, -1.0]]])
    second = np.array([0, 1, 4, 5])[np.array(TETRAHEDRON)]
    with pytest.raises(InvalidParameter, match=r"1 of 11 edges belong to more than two faces .*faces/"):
        closed(more, np.vstack([faces, second]))


def test_an_inner_wall_is_refused_at_its_three_edges() -> None:
    vertices, faces = SHAPES[0]
    # A second tetrahedron on the face of the first that has no vertex 3, and that face left in as a wall.
    more = np.vstack([vertices, -np.ones((1, 3))])
    mirrored = np.where(faces == 3, 4, faces)[:, ::-1]
    walls = [sorted(face) == [0, 1, 2] for face in faces.tolist()]
    assert sum(walls) == 1
    with pytest.raises(InvalidParameter, match=r"3 of 9 edges belong to more than two faces"):
        closed(more, np.vstack([faces, mirrored[~np.array(walls)]]))


def test_faces_that_shrink_to_a_point_close_nothing() -> None:
    with pytest.raises(OpenMesh, match="every face has corners that coincide"):
        closed(np.zeros((3, 3)), np.array([[0, 1, 2], [0, 2, 1], [0, 1, 2]]))
