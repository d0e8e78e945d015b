"""The energy ellipsoid as a figure: where outline, curves and axes are, and that it is well-formed at the extremes."""

from __future__ import annotations

from typing import Any
from xml.etree import ElementTree

import numpy as np
import pytest

from service.responses.ellipsoid_svg import CENTER, HALF, View, ellipsoid_figure
from service.responses.svg import COLOURS
from tests.service.conftest import client_of, inline_service

SERVICE = inline_service()
PATH = "/v1/rotation/energy-ellipsoid"
CERTIFIED = "/v1/certified/rotation/energy-ellipsoid"
SOURCE = {"kind": "principal-moments", "moments": [2.0, 1.0, 0.5]}
OBLIQUE = {"kind": "inertia-tensor", "tensor": [[2.0, 0.1, 0.2], [0.1, 2.5, 0.3], [0.2, 0.3, 1.8]]}
SVG = "{http://www.w3.org/2000/svg}"

pytestmark = pytest.mark.anyio


async def figure(question: dict[str, Any], path: str = PATH) -> ElementTree.Element:
    async with client_of(SERVICE) as client:
        response = await client.post(path, json=question, headers={"accept": "image/svg+xml"})
    assert response.status_code == 200, response.text
    assert response.headers["content-type"] == "image/svg+xml"
    assert b"nan" not in response.content
    return ElementTree.fromstring(response.content)


def colours(found: ElementTree.Element) -> set[str]:
    return {line.get("stroke", "") for line in found.iter(f"{SVG}polyline")}


def texts(found: ElementTree.Element) -> str:
    return "\n".join("".join(text.itertext()) for text in found.iter(f"{SVG}text"))


async def test_polhodes_of_either_side_and_the_separatrix_are_distinguished() -> None:
    found = await figure({"body": SOURCE, "energy": 1.0, "polhodes": {"count": 9, "seed": 1}, "separatrix": True})
    assert {"black", *COLOURS[:2]} < colours(found)
    told = texts(found)
    for words in ("largest moment", "middle moment", "smallest moment", "separatrix", "E = 1 J", "ω x", "ω z"):
        assert words in told, words
    (longest,) = (line for line in told.splitlines() if line.startswith("ω z"))
    assert "smallest moment" in longest
    (shortest,) = (line for line in told.splitlines() if line.startswith("ω x"))
    assert "largest moment" in shortest


@pytest.mark.parametrize(("side", "opacity"), [(1.0, None), (-1.0, "0.35")])
def test_a_curve_on_the_side_of_the_viewer_is_drawn_over_the_other(side: float, opacity: str | None) -> None:
    towards = View(np.eye(3), np.ones(3)).towards
    aside = np.cross(towards, [1.0, 0.0, 0.0])
    points = side * towards + 0.1 * np.outer([-1.0, 0.0, 1.0], aside)
    points /= np.linalg.norm(points, axis=1)[:, None]
    curve = {"regime": "about one axis", "points": points}
    answer = {"energy": 0.5, "semi_axes": [1.0] * 3, "axes": np.eye(3), "polhodes": [curve]}
    found = ElementTree.fromstring(ellipsoid_figure(answer))
    (drawn,) = (line for line in found.iter(f"{SVG}polyline") if line.get("stroke") == COLOURS[0])
    assert drawn.get("stroke-opacity") == opacity


async def test_of_numerals_the_figure_is_that_of_doubles() -> None:
    question = {"body": SOURCE, "angular_velocity": [0.4, 1.0, 0.7], "separatrix": True, "points": 64}
    doubles, numerals = await figure(question), await figure(question | {"digits": 30}, CERTIFIED)
    assert ElementTree.tostring(doubles) == ElementTree.tostring(numerals)


@pytest.mark.parametrize(
    "question",
    [
        {"body": OBLIQUE, "energy": 1e-300, "polhodes": {"count": 3}, "separatrix": True},
        {"body": {"kind": "ball", "radius": 1.0, "mass": 1.0}, "angular_velocity": [0.0, 0.0, 1.0]},
        {"body": SOURCE, "energy": 1.0},
        {
            "body": {"kind": "principal-moments", "moments": ["1e-400", "1", "2"]},
            "energy": "1e500",
            "separatrix": True,
            "digits": 20,
        },
    ],
    ids=["small", "ball", "alone", "needle"],
)
async def test_extremes_are_drawn(question: dict[str, Any]) -> None:
    found = await figure(question, CERTIFIED if "digits" in question else PATH)
    assert found.find(f"{SVG}ellipse") is not None


@pytest.mark.parametrize("turn", [0.0, 0.7])
def test_the_outline_touches_where_the_normal_is_across_the_view(turn: float) -> None:
    """Points of the surface lie within the outline, and those on its border neither in front nor behind."""
    c, s = np.cos(turn), np.sin(turn)
    view = View(np.array([[c, -s, 0.0], [s, c, 0.0], [0.0, 0.0, 1.0]]), np.array([0.3, 1.0, 0.6]))
    directions = np.random.default_rng(5).normal(size=(4000, 3))
    points = view.on_surface(directions / np.linalg.norm(directions, axis=1)[:, None])
    flat = points @ view.screen.T
    level = np.einsum("ni,ij,nj->n", flat, np.linalg.inv(view.outline_matrix), flat)
    assert 0.99 < level.max() <= 1.0 + 1e-12
    # Two points are seen at each place; their mean is the centre of the chord, whose ends are on either side.
    seen = view.in_front(points)
    depth = points @ view.towards
    for k in np.argsort(level)[:50]:
        assert seen[k] == (depth[k] > 0.0)
    places = view.places(points)
    assert (np.abs(places - CENTER) <= HALF + 1e-9).all()


def test_a_steady_rotation_is_a_dot() -> None:
    answer = {
        "energy": 1.0,
        "semi_axes": [1.0, 1.4, 0.7],
        "axes": np.eye(3),
        "polhodes": [{"regime": "steady rotation", "points": np.array([[0.0, 0.0, 0.7]])}],
    }
    found = ElementTree.fromstring(ellipsoid_figure(answer))
    assert len(list(found.iter(f"{SVG}circle"))) == 1
