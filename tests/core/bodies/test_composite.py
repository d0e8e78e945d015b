"""Bodies put together: places, attitudes, holes, limits, and how they are read from JSON."""

from __future__ import annotations

import json
import math
from fractions import Fraction
from typing import Any

import numpy as np
import pytest
from mpmath import mp, mpf
from pydantic import TypeAdapter, ValidationError

from core.bodies import Body
from core.bodies.composite import DEEPEST, MOST_PARTS, Composite, Part
from core.bodies.measured import InertiaTensor, PointMasses, PrincipalMoments
from core.bodies.mesh import Mesh
from core.bodies.solids import Ball, Cone, Cuboid, Cylinder, Hemisphere, Rod, SphericalShell
from core.errors import InvalidParameter, UnphysicalInertia

BALL = Ball(radius=1.0, mass=1.0)


def joined(*parts: Part, **options: Any) -> Any:
    return Composite(parts, **options).mass_properties()


def nested(levels: int, body: Any = BALL) -> Any:
    for _ in range(levels):
        body = Composite((Part(body, (1.0, 0.0, 0.0)),))
    return body


def test_one_part_in_place_is_the_part() -> None:
    alone, part = (
        Cone(radius=0.3, height=0.7, density=11.0).mass_properties(),
        Cone(radius=0.3, height=0.7, density=11.0),
    )
    found = joined(Part(part))
    assert (found.mass, found.mass_tail) == (alone.mass, alone.mass_tail)
    for name in ("center_of_mass", "center_of_mass_tail", "inertia", "inertia_tail"):
        assert (getattr(found, name) == getattr(alone, name)).all()
    assert found.warnings == ()
    assert found.validity.physical


def test_a_part_is_turned_about_its_own_origin_and_then_moved() -> None:
    # A quarter turn about x takes z to -y: the cone points to -y from its base at (1, 2, 3).
    found = joined(Part(Cone(radius=1.0, height=4.0, mass=1.0), (1.0, 2.0, 3.0), (1.0, 1.0, 0.0, 0.0)))
    assert found.center_of_mass.tolist() == [1.0, 1.0, 3.0]
    assert found.inertia[1, 1] == 0.3
    assert found.inertia[0, 0] == found.inertia[2, 2] == 3 / 20 + 3 / 80 * 16


def test_a_dumbbell() -> None:
    ball, rod = Ball(radius=0.5, mass=2.0), Rod(length=3.0, mass=1.0)
    found = joined(Part(ball, (0.0, 0.0, 2.0)), Part(rod), Part(ball, (0.0, 0.0, -2.0)))
    own = 0.4 * 2 * 0.25
    assert found.mass == 5.0
    assert found.center_of_mass.tolist() == [0.0, 0.0, 0.0]
    assert found.inertia.diagonal() == pytest.approx([2 * (own + 8) + 0.75, 2 * (own + 8) + 0.75, 2 * own], rel=1e-15)
    assert found.symmetry == "prolate"


@pytest.mark.parametrize(
    "hole",
    [
        Part(Cone(radius=0.5, height=1.0, density=-3.0), (0.0, 0.0, 1.0)),
        Part(Cone(radius=0.5, height=1.0, density=3.0), (0.0, 0.0, 1.0), hole=True),
        Part(
            Composite((Part(Cone(radius=0.5, height=1.0, density=3.0), (0.0, 0.0, 0.5)),)), (0.0, 0.0, 0.5), hole=True
        ),
    ],
)
def test_a_frustum_is_a_cone_without_its_tip(hole: Part) -> None:
    found = joined(Part(Cone(radius=1.0, height=2.0, density=3.0)), hole)
    with mp.workdps(40):
        # Slices of radius 1 - z/2 from 0 to 1.
        mass = 3 * mp.quad(lambda z: mp.pi * (1 - z / 2) ** 2, [0, 1])
        height = 3 * mp.quad(lambda z: z * mp.pi * (1 - z / 2) ** 2, [0, 1]) / mass
        axial = 3 * mp.quad(lambda z: mp.pi / 2 * (1 - z / 2) ** 4, [0, 1])
        across = axial / 2 + 3 * mp.quad(lambda z: (z - height) ** 2 * mp.pi * (1 - z / 2) ** 2, [0, 1])
        for value, tail, expected in (
            (found.mass, found.mass_tail, mass),
            (found.center_of_mass[2], found.center_of_mass_tail[2], height),
            (found.inertia[2, 2], found.inertia_tail[2, 2], axial),
            (found.inertia[0, 0], found.inertia_tail[0, 0], across),
        ):
            assert abs(mpf(float(value)) + mpf(float(tail)) - expected) < mpf(10) ** -31 * expected
    assert found.validity.physical
    assert found.warnings == ()


def test_nearly_everything_taken_away_leaves_every_digit() -> None:
    # 53 bits cancel; the wall is one ulp thick.
    outer, inner = 1.0 + 2.0**-52, 1.0
    found = joined(Part(Ball(radius=outer, density=5.0)), Part(Ball(radius=inner, density=-5.0)))
    shell = SphericalShell(outer_radius=outer, inner_radius=inner, density=5.0).mass_properties()
    assert found.mass == shell.mass
    assert (found.inertia == shell.inertia).all()
    assert found.inertia_tail == pytest.approx(shell.inertia_tail, rel=1e-14)


def test_far_from_the_origin_is_as_right_as_at_it() -> None:
    far = (1e150, -3e149, 7e145)
    parts = [(Ball(radius=0.5, mass=2.0), (1.0, 0.0, 0.0)), (Rod(length=3.0, mass=1.0), (0.0, 0.25, -2.0))]
    near = joined(*(Part(body, place) for body, place in parts))
    # Placed together and then moved away by an inner composite, so that the places themselves round nothing.
    inner = Composite(tuple(Part(body, place) for body, place in parts))
    moved = joined(Part(inner, far))
    assert (moved.inertia == near.inertia).all()
    assert (moved.inertia_tail == near.inertia_tail).all()
    assert moved.center_of_mass == pytest.approx(far, rel=1e-15)


def test_attitudes_within_attitudes_are_products() -> None:
    p, q = (1.0, 2.0, -1.0, 0.5), (0.25, -0.5, 3.0, 1.0)
    cone = Cone(radius=0.3, height=0.7, mass=2.0)
    w = p[0] * q[0] - p[1] * q[1] - p[2] * q[2] - p[3] * q[3]
    x = p[0] * q[1] + p[1] * q[0] + p[2] * q[3] - p[3] * q[2]
    y = p[0] * q[2] - p[1] * q[3] + p[2] * q[0] + p[3] * q[1]
    z = p[0] * q[3] + p[1] * q[2] - p[2] * q[1] + p[3] * q[0]
    twice = joined(Part(Composite((Part(cone, attitude=q),)), attitude=p))
    once = joined(Part(cone, attitude=(w, x, y, z)))
    assert (twice.inertia == once.inertia).all()
    assert (twice.inertia_tail == once.inertia_tail).all()
    assert (twice.center_of_mass == once.center_of_mass).all()


def test_every_kind_of_body_can_be_a_part() -> None:
    points = PointMasses(1.0, [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 2.0]])
    tensor = InertiaTensor(
        ((2.0, 0.1, 0.0), (0.1, 3.0, 0.0), (0.0, 0.0, 4.0)), mass=2.0, center_of_mass=(0.0, 1.0, 0.0)
    )
    found = joined(Part(points), Part(tensor, (5.0, 0.0, 0.0)), Part(points, hole=True))
    own = tensor.mass_properties()
    assert found.mass == 2.0
    assert found.center_of_mass == pytest.approx([5.0, 1.0, 0.0], rel=1e-15)
    assert found.inertia == pytest.approx(own.inertia, rel=1e-15, abs=1e-15)


@pytest.mark.parametrize(
    ("body", "missing"),
    [
        (PrincipalMoments((1.0, 2.0, 2.5)), "mass"),
        (InertiaTensor(((1.0, 0.0, 0.0), (0.0, 1.0, 0.0), (0.0, 0.0, 1.0)), mass=1.0), "center_of_mass"),
    ],
)
def test_a_part_needs_mass_and_centre_of_mass(body: Any, missing: str) -> None:
    inner = Composite((Part(BALL), Part(body)))
    with pytest.raises(InvalidParameter, match=f"known {missing} ") as refused:
        joined(Part(BALL), Part(BALL), Part(inner))
    assert refused.value.path == ("parts", 2, "body", "parts", 1, "body")
    assert "inertia-tensor" in str(refused.value.remedy)


def test_errors_of_a_part_have_its_path() -> None:
    with pytest.raises(InvalidParameter) as refused:
        joined(Part(BALL), Part(Rod(length=1.0, density=1.0)))
    assert refused.value.path == ("parts", 1, "body", "density")


@pytest.mark.parametrize("hole", [1.0, 1.5])
def test_holes_as_heavy_as_the_parts_are_refused(hole: float) -> None:
    with pytest.raises(InvalidParameter, match="weigh more than the holes") as refused:
        joined(Part(BALL), Part(Ball(radius=0.5, mass=-hole)))
    assert refused.value.path == ("parts",)
    # A ball and its two halves: their volumes are rounded apart, and yet nothing is left.
    with pytest.raises(InvalidParameter, match="weigh more than the holes"):
        joined(
            Part(Ball(radius=0.3, density=1.0)),
            Part(Hemisphere(radius=0.3, density=-1.0)),
            Part(Hemisphere(radius=0.3, density=-1.0), attitude=(0.3, 0.1, 0.7, 0.2)),
        )


def test_a_hole_larger_than_what_it_is_cut_from_is_refused() -> None:
    with pytest.raises(UnphysicalInertia, match="larger than what it is cut from") as refused:
        joined(Part(Ball(radius=1.0, mass=2.0)), Part(Ball(radius=3.0, mass=-1.0)))
    assert refused.value.path == ("parts",)


def test_a_hole_that_sticks_out_is_warned_of() -> None:
    # Longer than the block along z: second moments along z are negative, principal moments are not.
    found = joined(Part(Cuboid(edges=(4.0, 4.0, 1.0), mass=2.0)), Part(Cuboid(edges=(0.1, 0.1, 2.0), mass=-1.0)))
    assert not found.validity.physical
    assert [notice.code for notice in found.warnings] == ["unphysical-inertia"]
    assert found.warnings[0].path == ("parts",)


def test_a_hole_is_not_a_hole_twice() -> None:
    with pytest.raises(InvalidParameter) as refused:
        Part(Ball(radius=1.0, mass=-1.0), hole=True)
    assert refused.value.path == ("hole",)


def test_a_hole_in_a_mesh_and_of_a_mesh() -> None:
    vertices = [[x, y, z] for x in (-1.0, 1.0) for y in (-1.0, 1.0) for z in (-1.0, 1.0)]
    faces = [
        [0, 1, 3], [0, 3, 2], [4, 6, 7], [4, 7, 5], [0, 4, 5], [0, 5, 1],
        [2, 3, 7], [2, 7, 6], [0, 2, 6], [0, 6, 4], [1, 5, 7], [1, 7, 3],
    ]  # fmt: skip
    mesh, hollow = Mesh(vertices=vertices, faces=faces, density=2.0), Mesh(vertices=vertices, faces=faces, density=-2.0)
    block = Cuboid(edges=(4.0, 4.0, 4.0), density=2.0)
    expected = joined(Part(block), Part(Cuboid(edges=(2.0, 2.0, 2.0), density=-2.0)))
    for part in (Part(mesh, hole=True), Part(hollow)):
        found = joined(Part(block), part)
        assert found.mass == expected.mass
        assert found.inertia == pytest.approx(expected.inertia, rel=1e-14, abs=1e-14)


def test_pinned_at_the_origin() -> None:
    found = joined(Part(BALL, (3.0, 0.0, 0.0)), about="origin")
    assert found.about == "origin"
    assert found.principal_of_motion.moments == pytest.approx([0.4, 9.4, 9.4], rel=1e-15)
    with pytest.raises(InvalidParameter) as refused:
        Part(Composite((Part(BALL),), about="origin"))
    assert refused.value.path == ("body", "about")
    with pytest.raises(InvalidParameter) as refused:
        Part(PointMasses(1.0, [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0]], about="origin"))
    assert refused.value.path == ("body", "about")


@pytest.mark.parametrize(
    ("build", "path"),
    [
        (lambda: Composite(()), ("parts",)),
        (lambda: Composite(7), ("parts",)),  # type: ignore[arg-type]
        (lambda: Composite((BALL,)), ("parts", 0)),  # type: ignore[arg-type]
        (lambda: Composite((Part(BALL),) * (MOST_PARTS + 1)), ("parts",)),
        (lambda: Composite((Part(BALL),), about="rim"), ("about",)),  # type: ignore[arg-type]
        (lambda: Part("ball"), ("body",)),  # type: ignore[arg-type]
        (lambda: Part(BALL, (0.0, 1.0)), ("position",)),  # type: ignore[arg-type]
        (lambda: Part(BALL, (0.0, math.nan, 0.0)), ("position", 1)),
        (lambda: Part(BALL, attitude=(0.0, 0.0, 0.0, 0.0)), ("attitude",)),
        (lambda: Part(BALL, attitude=(math.inf, 0.0, 0.0, 0.0)), ("attitude", 0)),
        (lambda: Part(BALL, hole=1), ("hole",)),  # type: ignore[arg-type]
    ],
)
def test_what_is_no_composite_is_refused_by_place(build: Any, path: tuple[str | int, ...]) -> None:
    with pytest.raises(InvalidParameter) as refused:
        build()
    assert refused.value.path == path


def test_limits_of_depth_and_number() -> None:
    assert nested(DEEPEST).depth == DEEPEST
    assert nested(DEEPEST).mass_properties().center_of_mass.tolist() == [DEEPEST, 0.0, 0.0]
    with pytest.raises(InvalidParameter, match="nested at most 8") as refused:
        nested(DEEPEST + 1)
    assert refused.value.path == ("parts", 0, "body")
    half = Composite((Part(BALL),) * (MOST_PARTS // 2))
    assert Composite((Part(half), Part(half))).count == MOST_PARTS
    with pytest.raises(InvalidParameter, match="1001") as refused:
        Composite((Part(half), Part(half), Part(BALL)))
    assert refused.value.path == ("parts",)


READER: TypeAdapter[Any] = TypeAdapter(Body)


def document(levels: int) -> str:
    start, end = '{"kind":"composite","parts":[{"position":[1.0,0.0,0.0],"body":', "}]}"
    return start * levels + '{"kind":"ball","radius":1.0,"mass":1.0}' + end * levels


@pytest.mark.parametrize("levels", [0, 1, 3, DEEPEST])
def test_nested_documents_are_read(levels: int) -> None:
    body = READER.validate_json(document(levels), strict=True)
    assert body == nested(levels)


@pytest.mark.parametrize("levels", [DEEPEST + 1, 20, 60, 100, 10_000])
def test_deep_documents_are_refused_with_one_fault(levels: int) -> None:
    with pytest.raises(ValidationError) as refused:
        READER.validate_json(document(levels), strict=True)
    (fault,) = refused.value.errors(include_url=False, include_input=False)
    if levels <= 60:
        assert isinstance(fault["ctx"]["error"], InvalidParameter)
    else:
        assert fault["type"] == "json_invalid"
        assert "recursion" in fault["msg"]


def test_a_long_list_of_parts_is_refused_before_it_is_built() -> None:
    part = '{"body":{"kind":"ball","radius":1.0,"mass":1.0}}'
    with pytest.raises(ValidationError) as refused:
        READER.validate_json('{"kind":"composite","parts":[' + ",".join([part] * 20_000) + "]}", strict=True)
    (fault,) = refused.value.errors(include_url=False, include_input=False)
    assert fault["type"] == "too_long"


def test_the_schema_refers_to_itself() -> None:
    schema = READER.json_schema()
    parts = schema["$defs"]["Composite"]["properties"]["parts"]
    assert (parts["minItems"], parts["maxItems"]) == (1, MOST_PARTS)
    assert parts["items"] == {"$ref": "#/$defs/Part"}
    choices = schema["$defs"]["Part"]["properties"]["body"]
    assert {"$ref": "#/$defs/Composite"} in choices["oneOf"]
    assert json.dumps(schema)


def test_a_composite_with_a_skew_axis_has_the_moments_of_its_parts() -> None:
    # By hand in doubles: two unit points on a rod of length 2 sqrt(2) along (1, 1, 0).
    point = Ball(radius=1e-3, mass=1.0)
    found = joined(Part(point, (1.0, 1.0, 0.0)), Part(point, (-1.0, -1.0, 0.0)))
    small = 0.4e-6 * 2
    expected = np.array([[2 + small, -2, 0], [-2, 2 + small, 0], [0, 0, 4 + small]])
    assert found.inertia == pytest.approx(expected, rel=1e-14)
    assert found.principal.moments == pytest.approx([small, 4 + small, 4 + small], rel=1e-9)


def test_cylinders_cut_in_unequal_pieces() -> None:
    whole = Cylinder(radius=0.5, height=4.0, density=2.0).mass_properties()
    pieces = joined(
        Part(Cylinder(radius=0.5, height=1.0, density=2.0), (0.0, 0.0, -1.5)),
        Part(Cylinder(radius=0.5, height=3.0, density=2.0), (0.0, 0.0, 0.5)),
    )
    assert (pieces.inertia == whole.inertia).all()
    assert pieces.exact_mass - whole.exact_mass == Fraction(0)
