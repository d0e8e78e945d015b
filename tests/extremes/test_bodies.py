"""Bodies at every extreme: laws of principal moments in exact arithmetic, and shapes that tend to simpler ones."""

from __future__ import annotations

from fractions import Fraction
from typing import Any

import numpy as np
import pytest

from tests.extremes.asking import ask
from tests.extremes.questions import QUESTIONS

PATH = "/v1/bodies/mass-properties"


def test_principal_moments_are_those_of_the_tensor() -> None:
    """The trace, the pairwise products and each axis: I n = i n, to a few ulps of the largest moment."""
    checked = 0
    for name, question in QUESTIONS[PATH]():
        reply = ask(PATH, question)
        if not reply.answered:
            continue
        answer = reply.answer
        tensor, moments = answer["inertia"]["about_center_of_mass"], answer["principal"]["moments"]
        assert moments == sorted(moments), name
        exact = [[Fraction(x) for x in row] for row in tensor]
        largest = max(abs(Fraction(x)) for x in moments)
        slack = 16 * Fraction(2) ** -53 * largest + 4 * Fraction(2) ** -1074
        assert abs(sum(exact[k][k] for k in range(3)) - sum(map(Fraction, moments))) <= slack, name
        axes = [[Fraction(x) for x in column] for column in np.transpose(answer["principal"]["axes"]).tolist()]
        for moment, axis in zip(moments, axes, strict=True):
            assert abs(sum(x * x for x in axis) - 1) <= Fraction(2) ** -50, name
            turned = [sum(exact[i][j] * axis[j] for j in range(3)) for i in range(3)]
            assert max(abs(t - Fraction(moment) * x) for t, x in zip(turned, axis, strict=True)) <= slack, name
        if answer["validity"]["physical"] and question["body"]["kind"] != "principal-moments":
            assert Fraction(moments[0]) + Fraction(moments[1]) >= Fraction(moments[2]) - slack, name
        checked += 1
    assert checked > 400


@pytest.mark.parametrize(
    ("near", "limit"),
    [
        ({"kind": "rod", "length": 2.0, "mass": 3.0, "radius": None}, {"kind": "rod", "length": 2.0, "mass": 3.0}),
        ({"kind": "cylinder", "height": 2.0, "mass": 3.0, "radius": None}, {"kind": "rod", "length": 2.0, "mass": 3.0}),
        ({"kind": "disc", "radius": 2.0, "mass": 3.0, "thickness": None}, {"kind": "disc", "radius": 2.0, "mass": 3.0}),
        ({"kind": "cuboid", "edges": [None, None, 2.0], "mass": 3.0}, {"kind": "rod", "length": 2.0, "mass": 3.0}),
        ({"kind": "capsule", "radius": 2.0, "length": None, "mass": 3.0}, {"kind": "ball", "radius": 2.0, "mass": 3.0}),
        (
            {"kind": "spherical-shell", "outer_radius": 2.0, "inner_radius": None, "mass": 3.0},
            {"kind": "ball", "radius": 2.0, "mass": 3.0},
        ),
        (
            {"kind": "cylindrical-shell", "outer_radius": 2.0, "inner_radius": None, "height": 1.0, "mass": 3.0},
            {"kind": "cylinder", "radius": 2.0, "height": 1.0, "mass": 3.0},
        ),
    ],
    ids=lambda body: body["kind"],
)
def test_a_vanishing_length_leaves_the_simpler_body(near: dict[str, Any], limit: dict[str, Any]) -> None:
    # A capsule's ball is left at a distance of the order of the length, all others of its square.
    power = 1 if near["kind"] == "capsule" else 2
    wanted = ask(PATH, {"body": limit}).of()["principal"]["moments"]
    for length in (1e-2, 1e-5, 1e-9, 1e-30, 1e-100, 1e-150):
        body = {
            name: [length if x is None else x for x in value] if isinstance(value, list) else value
            for name, value in near.items()
        }
        body = {name: length if value is None else value for name, value in body.items()}
        found = ask(PATH, {"body": body}).of()["principal"]["moments"]
        assert max(abs(f - w) for f, w in zip(found, wanted, strict=True)) <= (4 * length**power + 1e-15) * max(wanted)
