from fractions import Fraction

import numpy as np
import pytest
from pydantic import TypeAdapter

from core.bodies import Body
from core.bodies.exact_bodies import UNIFORM, exact_body
from core.bodies.measured import PointMasses
from core.bodies.solids import Cuboid, Cylinder, Ellipsoid
from core.errors import BudgetExceeded, InvalidParameter, NotApplicable, UnphysicalInertia

POINTS = [[0.5, 0.25, 1.0], [1.0, 0.0, -2.0], [-1.0, 3.0, 0.125], [2.0, 2.0, 2.0]]


@pytest.mark.parametrize(
    ("body", "same"),
    [
        ({"kind": "cuboid", "edges": [1.0, 2.0, 3.0], "mass": 2.0}, Cuboid(edges=(1.0, 2.0, 3.0), mass=2.0)),
        ({"kind": "cuboid", "edges": [1.0, 2.0, 3.0], "density": 2.0}, Cuboid(edges=(1.0, 2.0, 3.0), density=2.0)),
        ({"kind": "cylinder", "radius": 1.0, "height": 3.0, "mass": 2.0}, Cylinder(radius=1.0, height=3.0, mass=2.0)),
        ({"kind": "ellipsoid", "semi_axes": [1, 2, 4], "mass": 1}, Ellipsoid(semi_axes=(1.0, 2.0, 4.0), mass=1.0)),
        ({"kind": "point-masses", "masses": 0.5, "positions": POINTS}, PointMasses(0.5, POINTS)),
        (
            {"kind": "point-masses", "masses": [1, 2, 3, 4], "positions": POINTS, "about": "origin"},
            PointMasses([1.0, 2.0, 3.0, 4.0], POINTS, about="origin"),
        ),
    ],
)
def test_the_catalogues_own_tensor_is_this_one_rounded(body, same):
    tensor = np.array(exact_body(body).of_motion.tensor, dtype=float)
    properties = same.mass_properties()
    wanted = properties.inertia if properties.about == "center-of-mass" else properties.inertia_about_origin
    assert np.array_equal(tensor, wanted)


def test_decimal_strings_are_exact():
    tensor = exact_body({"kind": "cuboid", "edges": ["0.1", "0.2", "0.3"], "mass": "1.2"}).inertia
    assert tensor[0][0] == Fraction("1.2") * (Fraction("0.04") + Fraction("0.09")) / 12
    assert exact_body({"kind": "principal-moments", "moments": ["0.1", "0.2", "0.25"]}).inertia[1][1] == Fraction(1, 5)
    assert exact_body({"kind": "inertia-tensor", "tensor": [[2, "0.1", 0], ["0.1", 2, 0], [0, 0, 3]], "mass": 3})


def test_every_uniform_solid_is_known():
    assert {"ball", "cuboid", "cylinder", "torus", "cone", "capsule"} <= set(UNIFORM)


@pytest.mark.parametrize(
    ("body", "path"),
    [
        ({"kind": "principal-moments"}, ("moments",)),
        ({"kind": "principal-moments", "moments": [1, 2, 3], "mass": 1}, ("mass",)),
        ({"kind": "point-masses", "positions": POINTS}, ("masses",)),
        ({"kind": "point-masses", "positions": POINTS, "masses": 1, "about": "here"}, ("about",)),
        ({"kind": "cuboid", "edges": [1, "x", 3], "mass": 1}, ("edges", 1)),
        ({"kind": "cuboid", "edges": [1, -2, 3], "mass": 1}, ("edges", 1)),
        ({"kind": "cuboid", "edges": [1, 2, 3], "mass": "1e400"}, ("mass",)),
        ({"kind": "cuboid", "edges": [1, 2, 3], "mass": -1}, ("mass",)),
        ({"kind": "cuboid", "radius": 1, "mass": 1}, ("radius",)),
        ({"kind": "point-masses", "masses": 1, "positions": [[1, 2, 3]]}, ()),
    ],
)
def test_what_is_no_body_is_refused(body, path):
    with pytest.raises(InvalidParameter) as caught:
        exact_body(body)
    assert caught.value.path == path


def test_inputs_that_cannot_be_exact_are_rejected():
    for body in ({"kind": "ball", "radius": 1, "density": 1}, {"kind": "mesh"}, {}):
        with pytest.raises(NotApplicable):
            exact_body(body)


WELDED = {
    "kind": "composite",
    "parts": [
        {"body": {"kind": "cuboid", "edges": [1.0, 2.0, 3.0], "mass": 4.0}, "attitude": [1.0, 0.2, -0.3, 0.4]},
        {"body": {"kind": "ball", "radius": 0.2, "mass": 0.01}, "position": [0.1, 0.2, 0.1], "hole": True},
        {"body": {"kind": "cuboid", "edges": [0.1, 0.1, 0.1], "density": -0.5}, "position": [-0.1, 0.2, 0.1]},
        {"body": {"kind": "point-masses", "masses": 0.5, "positions": POINTS}, "position": [0.0, 1.0, 0.3]},
        {
            "body": {
                "kind": "inertia-tensor",
                "tensor": [[1.0, 0.1, 0.0], [0.1, 2.0, 0.0], [0.0, 0.0, 1.5]],
                "mass": 2.0,
                "center_of_mass": [0.1, 0.0, 0.2],
            },
            "attitude": [0.5, 0.5, 0.5, -0.5],
        },
        {
            "body": {
                "kind": "composite",
                "parts": [{"body": {"kind": "rod", "length": 1.5, "mass": 0.3}, "attitude": [1.0, 1.0, 0.0, 0.0]}],
            }
        },
    ],
}


@pytest.mark.parametrize("about", ["center-of-mass", "origin"])
def test_bodies_welded_together(about):
    """The composite's own sums, whose units of 2^-4096 are rounded to doubles, against fractions."""
    question = WELDED | {"about": about}
    found = exact_body(question)
    same = TypeAdapter(Body).validate_python(question).mass_properties()
    wanted = same.inertia if about == "center-of-mass" else same.inertia_about_origin
    assert np.array_equal(np.array(found.of_motion.tensor, dtype=float), wanted)
    assert float(found.mass) == same.mass
    assert [float(x) for x in found.center_of_mass] == same.center_of_mass.tolist()
    assert [notice.code for notice in found.notices] == ([] if about == "center-of-mass" else ["not-free"])


def test_a_centre_of_mass_that_rounding_moves_is_at_the_origin():
    for offset, told in (("1e-17", []), ("1e-3", ["not-free"])):
        points = [[1, 0, 0], [-1, 0, 0], [0, 1, offset], [0, -1, 0]]
        body = {"kind": "point-masses", "masses": 1, "positions": points, "about": "origin"}
        assert [notice.code for notice in exact_body(body).notices] == told


def test_a_part_is_turned_and_moved_exactly():
    turned = {"kind": "cuboid", "edges": ["0.1", "0.2", "0.3"], "mass": "1.2"}
    found = exact_body({"kind": "composite", "parts": [{"body": turned, "attitude": [0, "0.1", 0, 0]}]})
    assert found.of_motion.tensor == exact_body(turned).of_motion.tensor
    # A third of a turn about the diagonal takes x to y.
    third = exact_body({"kind": "composite", "parts": [{"body": turned, "attitude": ["0.3"] * 4}]})
    assert [third.inertia[i][i] for i in (1, 2, 0)] == [exact_body(turned).inertia[i][i] for i in range(3)]
    moved = exact_body({"kind": "composite", "parts": [{"body": turned, "position": ["0.1", 0, 0]}], "about": "origin"})
    assert moved.of_motion.tensor[1][1] - third.inertia[2][2] == Fraction("0.012")


BALL = {"kind": "ball", "radius": 1, "mass": 1}
UNIT = [[1, 0, 0], [0, 1, 0], [0, 0, 1]]


def part(body, **more):
    return {"kind": "composite", "parts": [{"body": body, **more}]}


@pytest.mark.parametrize(
    ("body", "error", "path"),
    [
        ({"kind": "composite"}, InvalidParameter, ("parts",)),
        (part({"kind": "principal-moments", "moments": [1, 2, 3]}), InvalidParameter, ("parts", 0, "body")),
        (part({"kind": "ball", "radius": 1, "density": 1}), NotApplicable, ("parts", 0, "body", "density")),
        (part({"kind": "mesh"}), NotApplicable, ("parts", 0, "body", "kind")),
        (part({"kind": "ball", "radius": 1, "mass": "x"}), InvalidParameter, ("parts", 0, "body", "mass")),
        (part({"kind": "ball", "radius": 1, "mass": -1}), InvalidParameter, ("parts",)),
        (part(BALL, attitude=[0, 0, 0, 0]), InvalidParameter, ("parts", 0, "attitude")),
        (part(BALL, colour=1), InvalidParameter, ("parts", 0, "colour")),
        ({"kind": "composite", "parts": part(BALL)["parts"] * 101}, BudgetExceeded, ("parts",)),
        ({"kind": "inertia-tensor", "tensor": UNIT, "mass": 0}, InvalidParameter, ("mass",)),
        (
            {
                "kind": "composite",
                "parts": [
                    {"body": {"kind": "ball", "radius": 1, "mass": 2}},
                    {"body": {"kind": "ball", "radius": 2, "mass": 1}, "hole": True},
                ],
            },
            UnphysicalInertia,
            ("parts",),
        ),
    ],
    ids=str,
)  # fmt: skip
def test_what_cannot_be_welded(body, error, path):
    with pytest.raises(error) as caught:
        exact_body(body)
    assert caught.value.path == path
