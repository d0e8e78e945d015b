"""Integrals against rational arithmetic (tests/core/bodies/polyhedra.py), the ball, covariance; every refusal."""

from __future__ import annotations

from fractions import Fraction
from typing import Any

import numpy as np
import pytest
from hypothesis import assume, given, settings
from hypothesis import strategies as st

from core.bodies.mass_properties import MassProperties
from core.bodies.mesh import Mesh
from core.errors import InvalidParameter, OpenMesh, UnphysicalInertia
from tests.core.bodies.polyhedra import TETRAHEDRON, Faces, Vertices, cuboid, exact_properties, icosphere
from tests.drawn import draws

PAIR = Fraction(1, 10**29)
"""What a value and a tail are right to, as a share of the largest component."""


def judge(found: MassProperties, vertices: Vertices, faces: Faces, density: float = 1.0) -> None:
    volume, center, inertia = exact_properties(vertices, faces)
    mass = volume * Fraction(density)
    assert abs(found.exact_mass - mass) <= PAIR * mass
    box = max(max(column) - min(column) for column in zip(*vertices, strict=True))
    for have, want in zip(found.exact_center_of_mass, center, strict=True):
        assert abs(have - want) <= PAIR * Fraction(box) + abs(want) / 2**104
    size = max(abs(x) for row in inertia for x in row) * Fraction(density)
    for have_row, want_row in zip(found.exact_inertia, inertia, strict=True):
        for have, want in zip(have_row, want_row, strict=True):
            assert abs(have - want * Fraction(density)) <= PAIR * size


@pytest.mark.parametrize("corner", [(0, 0, 0), (1e6, -1e6, 1e6), (1e9, 3e9, -1e9), (1e15, 0.1, 0)])
def test_a_cuboid_is_as_right_far_away_as_at_the_origin(corner: tuple[float, float, float]) -> None:
    vertices, faces = cuboid((1, 2, 3), corner)
    found = Mesh(vertices, faces, density=0.7).mass_properties()
    judge(found, vertices, faces, 0.7)
    if all(float(c).is_integer() for c in corner):
        assert np.array_equal(found.inertia, np.diag([13 * 0.35, 3.5, 5 * 0.35]))
        assert found.principal.moments.tolist() == [5 * 0.35, 3.5, 13 * 0.35]


@pytest.mark.parametrize("scale", [1e-100, 1e-60, 1e60])
@pytest.mark.parametrize("given", ["density", "mass"])
def test_any_scale(scale: float, given: str) -> None:
    vertices, faces = cuboid((0.3 * scale, 0.7 * scale, 1.1 * scale), (scale, -3 * scale, 0))
    volume = 0.231 * scale**3
    found = Mesh(vertices, faces, **{given: 2.0 if given == "mass" else 2.0 / volume}).mass_properties()
    assert found.mass == pytest.approx(2.0, rel=1e-14)
    assert found.inertia[2, 2] / scale**2 == pytest.approx((0.09 + 0.49) / 6, rel=1e-13)
    assert not found.inertia[np.triu_indices(3, 1)].any()


@pytest.mark.parametrize("edges", [(1e-12, 1, 1), (1e-12, 1e-12, 1), (1e-30, 1e-20, 1), (1e-140, 1e-70, 1e70)])
def test_leaves_and_needles(edges: tuple[float, float, float]) -> None:
    vertices, faces = cuboid(edges)
    found = Mesh(vertices, faces, mass=12.0).mass_properties()
    a, b, c = (Fraction(e) ** 2 for e in edges)
    for have, want in zip(np.diag(found.inertia), (b + c, a + c, a + b), strict=True):
        assert have == pytest.approx(float(want), rel=1e-15)
    assert found.validity.physical


def askew(thickness: float) -> tuple[Vertices, Faces]:
    """Return a thin plate that is parallel to no coordinate plane, its corners rounded to doubles."""
    vertices, faces = cuboid((1.0, 1.3, thickness))
    turn = np.linalg.qr(np.random.default_rng(5).normal(size=(3, 3)))[0]
    return (np.array(vertices) @ (turn * np.linalg.det(turn)).T).tolist(), faces


@pytest.mark.parametrize("thickness", [1e-3, 1e-6, 1e-9, 1e-12, 1e-14, 1e-15])
def test_an_oblique_thin_plate_is_as_accurate_as_stated(thickness: float) -> None:
    vertices, faces = askew(thickness)
    found = Mesh(vertices, faces, density=1.0).mass_properties()
    volume, _, inertia = exact_properties(vertices, faces)
    error = abs(found.exact_mass / volume - 1)
    size = max(abs(x) for row in inertia for x in row)
    error = max(error, *(abs(found.exact_inertia[i][j] - inertia[i][j]) / size for i in range(3) for j in range(3)))
    said = [float(n.detail.split("right to ")[1].split(" ")[0]) for n in found.warnings if n.code == "thin-mesh"]
    assert bool(said) == (thickness < 1e-14)
    assert error < (said[0] if said else 2.0**-53)
    assert error < 1e-31 / thickness


def test_a_leaf_no_thicker_than_the_rounding_of_its_sum_is_refused() -> None:
    k = 30000
    # Whole numbers of determinant 1, of a size of 1e9.
    edges = np.array([[1, 0, 0], [k, 1, 0], [k, k, 1]]) @ np.array([[1, k, k], [0, 1, k], [0, 0, 1]])
    vertices = [[0.0, 0.0, 0.0], *edges.astype(float).tolist()]
    faces = TETRAHEDRON
    assert exact_properties(vertices, faces)[0] == Fraction(1, 6)
    with pytest.raises(InvalidParameter, match="zero to within the rounding") as caught:
        Mesh(vertices, faces, density=1.0).mass_properties()
    assert caught.value.path == ("faces",)


coordinate = st.floats(-1, 1, allow_subnormal=False)
corners = st.lists(st.lists(coordinate, min_size=3, max_size=3), min_size=4, max_size=4)


@settings(deadline=None, max_examples=draws(60))
@given(corners, st.sampled_from([0.0, 1.0, 1e6, 1e9]), st.floats(1e-3, 1e3))
def test_any_tetrahedron(vertices: Vertices, offset: float, density: float) -> None:
    vertices = [[x + offset for x in vertex] for vertex in vertices]
    edges = np.array(vertices[1:]) - np.array(vertices[0])
    lengths = np.linalg.norm(edges, axis=1)
    assume(lengths.min() > 1e-6 and abs(np.linalg.det(edges)) > 1e-6 * float(np.prod(lengths)))
    inverted = np.linalg.det(edges) < 0
    found = Mesh(vertices, TETRAHEDRON, density=density).mass_properties()
    faces = [face[::-1] for face in TETRAHEDRON] if inverted else TETRAHEDRON
    judge(found, vertices, faces, density)
    assert [notice.code for notice in found.warnings] == (["inverted-mesh"] if inverted else [])
    assert found.validity.physical


@settings(deadline=None, max_examples=25)
@given(st.lists(st.floats(-1, 1), min_size=4, max_size=4).filter(lambda q: np.linalg.norm(q) > 0.1))
def test_a_turned_mesh_has_the_turned_tensor(quaternion: list[float]) -> None:
    w, x, y, z = np.array(quaternion) / np.linalg.norm(quaternion)
    cross = np.array([[0, -z, y], [z, 0, -x], [-y, x, 0]])
    turn = np.eye(3) + 2 * w * cross + 2 * cross @ cross
    vertices, faces = cuboid((1, 2, 3), (0.5, -0.2, 4.0))
    before = Mesh(vertices, faces, mass=3.0).mass_properties()
    after = Mesh(np.array(vertices) @ turn.T, faces, mass=3.0).mass_properties()
    assert before.center_of_mass is not None
    assert after.center_of_mass == pytest.approx(turn @ before.center_of_mass, abs=1e-14)
    assert after.inertia == pytest.approx(turn @ before.inertia @ turn.T, abs=1e-14)
    assert after.principal.moments == pytest.approx([1.25, 2.5, 3.25], rel=1e-14)


def test_the_icosphere_becomes_the_ball_at_second_order() -> None:
    errors = []
    for level in (1, 2, 3, 4):
        found = Mesh(*icosphere(level), density=1.0).mass_properties()
        assert found.symmetry == "spherical"
        assert found.mass is not None
        errors.append((4 * np.pi / 3 - found.mass, 8 * np.pi / 15 - found.inertia[0, 0]))
    slopes = np.log2(np.array(errors[:-1]) / np.array(errors[1:]))
    assert np.all(np.array(errors) > 0)
    assert slopes[-1] == pytest.approx(2.0, abs=0.02)


def test_faces_turned_inwards_throughout_are_taken_the_other_way_with_a_warning() -> None:
    vertices, faces = cuboid((1, 2, 3))
    right = Mesh(vertices, faces, density=2.0).mass_properties()
    turned = Mesh(vertices, [face[::-1] for face in faces], density=2.0).mass_properties()
    assert [(notice.code, notice.path) for notice in turned.warnings] == [("inverted-mesh", ("faces",))]
    assert not right.warnings
    assert np.array_equal(right.inertia, turned.inertia)
    assert right.mass == turned.mass == 12.0


def test_a_surface_turned_inwards_is_a_cavity_with_a_warning() -> None:
    outer, faces = cuboid((4, 4, 4))
    inner, _ = cuboid((2, 2, 2), (1, 1, 1))
    hollow = Mesh(outer + inner, faces + [[8 + i for i in face[::-1]] for face in faces], density=1.0)
    found = hollow.mass_properties()
    assert found.mass == 64 - 8
    assert np.array_equal(found.inertia, np.diag([(64 * 32 - 8 * 8) / 12] * 3))
    assert [notice.code for notice in found.warnings] == ["inward-surfaces"]
    assert "1 of 2" in found.warnings[0].detail


def test_separate_blocks_add_up() -> None:
    one, faces = cuboid((1, 1, 1))
    other, _ = cuboid((1, 1, 1), (9, 0, 0))
    found = Mesh(one + other, faces + [[8 + i for i in face] for face in faces], density=6.0).mass_properties()
    assert not found.warnings
    assert np.array_equal(np.diag(found.inertia), [2.0, 2 + 12 * 4.5**2, 2 + 12 * 4.5**2])


def test_triangles_with_corners_of_their_own_close_by_place() -> None:
    vertices, faces = cuboid((1, 2, 3), (0, -1, 0))
    # Zeros of either sign are one place.
    loose = [[-0.0 if x == 0 and n % 2 else x for x in vertices[i]] for n, face in enumerate(faces) for i in face]
    soup = Mesh(loose, np.arange(36).reshape(-1, 3), density=1.0).mass_properties()
    assert np.array_equal(soup.inertia, Mesh(vertices, faces, density=1.0).mass_properties().inertia)
    assert not soup.warnings


def test_faces_without_area_add_nothing_and_are_named() -> None:
    vertices, faces = cuboid((1, 2, 3))
    a, b, c = faces[3]
    # The edge from a to b is cut in its middle on this side only; a face without area fills the seam.
    middle = [(x + y) / 2 for x, y in zip(vertices[a], vertices[b], strict=True)]
    split = [*faces[:3], [a, 8, c], [8, b, c], *faces[4:], [a, b, 8]]
    found = Mesh([*vertices, middle], split, density=1.0).mass_properties()
    assert [(notice.code, notice.path) for notice in found.warnings] == [("degenerate-faces", ("faces", 13))]
    assert np.array_equal(found.inertia, Mesh(vertices, faces, density=1.0).mass_properties().inertia)


def test_a_vertex_that_no_face_uses_does_not_matter() -> None:
    vertices, faces = cuboid((1, 2, 3))
    found = Mesh([*vertices, [1e300, -1e308, 0.0]], faces, density=1.0).mass_properties()
    assert np.array_equal(found.inertia, Mesh(vertices, faces, density=1.0).mass_properties().inertia)


def test_the_report_lists_checked_and_unchecked_conditions() -> None:
    report = Mesh(*cuboid((1, 2, 3)), mass=1.0).mass_properties().validity.report
    details = {condition.name: condition.detail for condition in report}
    assert "18 edges" in details["closed-surface"]
    assert "consistent-orientation" in details
    assert "6 m^3" in details["positive-volume"]
    assert "self-intersection is not looked for" in details["positive-volume"]


BLOCK, SIDES = cuboid((1, 2, 3))


def without(*numbers: int) -> Faces:
    return [face for i, face in enumerate(SIDES) if i not in numbers]


def turned(*numbers: int) -> Faces:
    return [face[::-1] if i in numbers else face for i, face in enumerate(SIDES)]


REFUSALS: list[tuple[str, dict[str, Any], type[InvalidParameter], tuple[str | int, ...], str]] = [
    ("one face missing", {"faces": without(3)}, OpenMesh, ("faces",), "3 of 18 edges"),
    ("two faces missing", {"faces": without(2, 3)}, OpenMesh, ("faces",), "4 of 17 edges"),
    ("one face turned", {"faces": turned(5)}, InvalidParameter, ("faces",), "at 3 of 18 edges"),
    ("one face twice", {"faces": [*SIDES, SIDES[7]]}, InvalidParameter, ("faces", 12), "differ from faces/7"),
    (
        "one face twice, from another corner",
        {"faces": [*SIDES, SIDES[7][1:] + SIDES[7][:1]]},
        InvalidParameter,
        ("faces", 12),
        "differ from faces/7",
    ),
    ("index too large", {"faces": [*SIDES, [0, 1, 8]]}, InvalidParameter, ("faces", 12, 2), "at most 7"),
    ("huge index", {"faces": [*SIDES, [0, 1, 10**30]]}, InvalidParameter, ("faces", 12, 2), "64-bit"),
    ("negative index", {"faces": [[0, -1, 2], *SIDES]}, InvalidParameter, ("faces", 0, 1), "at least 0"),
    ("index not whole", {"faces": [[0, 1.5, 2], *SIDES]}, InvalidParameter, ("faces", 0, 1), "whole number"),
    ("vertex named twice", {"faces": [*SIDES, [1, 2, 1]]}, InvalidParameter, ("faces", 12), "three different"),
    ("face of four", {"faces": [*SIDES, [0, 1, 2, 3]]}, InvalidParameter, ("faces", 12), "list of 3 numbers"),
    ("too few faces", {"faces": SIDES[:3]}, InvalidParameter, ("faces",), "entries"),
    ("too few vertices", {"vertices": BLOCK[:3]}, InvalidParameter, ("vertices",), "entries"),
    ("NaN", {"vertices": [*BLOCK[:7], [0, float("nan"), 0]]}, InvalidParameter, ("vertices", 7, 1), "finite"),
    ("no mass", {"density": None}, InvalidParameter, ("mass",), "exactly one"),
    ("mass and density", {"mass": 1.0}, InvalidParameter, ("mass",), "exactly one"),
    ("no density", {"density": 0.0}, InvalidParameter, ("density",), "not be 0"),
    ("density not finite", {"density": float("inf")}, InvalidParameter, ("density",), "finite"),
]


@pytest.mark.parametrize(("changes", "kind", "path", "words"), [r[1:] for r in REFUSALS], ids=[r[0] for r in REFUSALS])
def test_refusals(changes: dict[str, Any], kind: type, path: tuple[str | int, ...], words: str) -> None:
    with pytest.raises(InvalidParameter, match=words) as caught:
        Mesh(**{"vertices": BLOCK, "faces": SIDES, "density": 1.0, **changes})
    assert type(caught.value) is kind
    assert caught.value.path == path


def test_two_blocks_that_share_an_edge_are_refused() -> None:
    vertices = [*BLOCK, *cuboid((1, 2, 3), (1, 2, 0))[0]]
    shared = {8: 6, 9: 7}
    faces = [*SIDES, *([shared.get(8 + i, 8 + i) for i in face] for face in SIDES)]
    with pytest.raises(InvalidParameter, match="1 of 35 edges belong to more than two faces") as caught:
        Mesh(vertices, faces, density=1.0)
    assert caught.value.path == ("faces",)


@pytest.mark.parametrize("offset", [0.0, 1e6])
def test_no_volume_is_refused(offset: float) -> None:
    flat = [[offset + x, offset + y, offset + 0.3 * (x + y)] for x, y in ((0, 0), (1, 0), (0, 1), (0.25, 0.25))]
    sheet = [[0, 1, 2], [0, 2, 1], [0, 1, 3], [0, 3, 1]]
    for vertices, faces in ((flat, sheet[:2] * 2), (cuboid((1, 2, 0), (offset, 0, 0))[0], SIDES)):
        with pytest.raises(InvalidParameter) as caught:
            Mesh(vertices, faces, density=1.0).mass_properties()
        assert caught.value.path[0] == "faces"


def test_a_folded_sheet_encloses_no_volume() -> None:
    vertices = [[0.1, 0.7, 0.3], [1.9, 0.2, 0.4], [0.5, 1.3, 0.9], [0.8, 0.6, 1.7]]
    # Two leaves hinged on the edge 0-1, each a triangle on both of its sides.
    faces = [[0, 1, 2], [1, 0, 3], [0, 2, 1], [0, 1, 3]]
    with pytest.raises(InvalidParameter, match="1 of 5 edges belong to more than two faces"):
        Mesh(vertices, faces, density=1.0)
    nearly_flat = [[0.0, 0.0, 0.0], [1.0, 0.0, 1.0], [0.0, 1.0, 1.0], [1.0, 1.0, 2.0]]
    with pytest.raises(InvalidParameter, match="zero to within the rounding") as caught:
        Mesh(nearly_flat, TETRAHEDRON, density=1.0).mass_properties()
    assert caught.value.path == ("faces",)


def test_a_part_turned_inwards_outside_of_the_others_is_refused_where_no_matter_can_be_so() -> None:
    small, faces = cuboid((1, 1, 1), (100, 0, 0))
    big, _ = cuboid((2, 2, 2))
    vertices = big + small
    both = faces + [[8 + i for i in face[::-1]] for face in faces]
    with pytest.raises(UnphysicalInertia) as caught:
        Mesh(vertices, both, density=1.0).mass_properties()
    assert caught.value.path == ("faces",)


@pytest.mark.parametrize("field", ["mass", "density"])
def test_a_hole_is_a_mesh_but_no_body(field: str) -> None:
    hole = Mesh(BLOCK, SIDES, **{field: -2.0})
    assert hole.is_hole
    with pytest.raises(InvalidParameter) as caught:
        hole.mass_properties()
    assert caught.value.path == (field,)


def test_out_of_the_range_of_doubles() -> None:
    vertices, faces = cuboid((1e200, 1e200, 1e200))
    with pytest.raises(InvalidParameter, match="range of doubles"):
        Mesh(vertices, faces, density=1.0).mass_properties()


def test_a_hundred_thousand_faces_are_integrated() -> None:
    vertices, faces = icosphere(6)
    rows, triples = vertices.tolist(), faces.tolist()
    assert Mesh(rows, triples, mass=1.0).mass_properties().symmetry == "spherical"
