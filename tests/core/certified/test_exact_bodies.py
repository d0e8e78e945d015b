from fractions import Fraction

import numpy as np
import pytest

from core.bodies.measured import PointMasses
from core.bodies.solids import Cuboid, Cylinder, Ellipsoid
from core.certified.exact_bodies import UNIFORM, exact_body
from core.errors import InvalidParameter, NotApplicable

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
    tensor = np.array(exact_body(body).tensor, dtype=float)
    properties = same.mass_properties()
    wanted = properties.inertia if properties.about == "center-of-mass" else properties.inertia_about_origin
    assert np.array_equal(tensor, wanted)


def test_decimal_strings_are_exact():
    tensor = exact_body({"kind": "cuboid", "edges": ["0.1", "0.2", "0.3"], "mass": "1.2"}).tensor
    assert tensor[0][0] == Fraction("1.2") * (Fraction("0.04") + Fraction("0.09")) / 12
    assert exact_body({"kind": "principal-moments", "moments": ["0.1", "0.2", "0.25"]}).tensor[1][1] == Fraction(1, 5)
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
        ({"kind": "cuboid", "radius": 1, "mass": 1}, ()),
        ({"kind": "rod", "length": 1, "mass": 1}, ()),
    ],
)
def test_what_is_no_body_is_refused(body, path):
    with pytest.raises(InvalidParameter) as caught:
        exact_body(body)
    assert caught.value.path == path


def test_what_cannot_be_exact_says_so():
    for body in ({"kind": "ball", "radius": 1, "density": 1}, {"kind": "mesh"}, {"kind": "composite"}, {}):
        with pytest.raises(NotApplicable):
            exact_body(body)
