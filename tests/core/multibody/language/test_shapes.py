"""Shapes: moments of homogeneous solids by quadrature, and descriptions that are refused."""

from __future__ import annotations

from math import pi, sqrt
from typing import Any

import numpy as np
import pytest

from core.errors import InvalidParameter
from core.multibody.language.numerals import Numerals
from core.multibody.language.shapes import shape_of
from core.multibody.solve import solve_scene
from tests.core.multibody.worked_examples import read

PLAIN = Numerals.of({})


def moments(written: dict[str, Any], dimension: int) -> list[float]:
    return [float(x) for x in shape_of(written, PLAIN, ("shape",), dimension).moments]


def by_slices(width: Any, reach: float, about: float = 0.0) -> float:
    """Return the polar moment over the mass of what is `width(x)` high and symmetric, by Gauss's quadrature."""
    nodes, weights = np.polynomial.legendre.leggauss(400)
    x, own = reach * nodes, width(reach * nodes)
    return float((weights * (own * (x - about) ** 2 + own**3 / 12)).sum() / (weights * own).sum())


def test_moments_in_the_plane() -> None:
    """Polar moments over the mass, of the area cut into slices."""
    assert moments({"kind": "disc", "radius": 0.3}, 2) == [pytest.approx(0.3**2 / 2, rel=1e-15)]
    assert moments({"kind": "box", "width": 3, "height": 4}, 2) == [pytest.approx(25 / 12, rel=1e-15)]
    stadium = by_slices(lambda x: 2 * np.sqrt(0.04 - np.clip(abs(x) - 0.5, 0, None) ** 2), 0.7)
    assert moments({"kind": "capsule", "radius": 0.2, "length": 1}, 2) == [pytest.approx(stadium, rel=1e-4)]
    # A right triangle of legs a, b: (a^2 + b^2)/18 about its centroid.
    triangle = {"kind": "polygon", "corners": [[-1, -2], [2, -2], [-1, 4]]}
    assert moments(triangle, 2) == [pytest.approx((9 + 36) / 18, rel=1e-15)]


def test_moments_in_space() -> None:
    """A cylinder, a ball and an ellipsoid by their formulas; a capsule as a solid of revolution."""
    assert moments({"kind": "cylinder", "radius": 1, "height": 2}, 3) == pytest.approx([7 / 12, 7 / 12, 1 / 2])
    assert moments({"kind": "ellipsoid", "semi_axes": [1, 2, 3]}, 3) == pytest.approx([13 / 5, 2, 1])
    assert moments({"kind": "disc", "radius": 2}, 3) == pytest.approx([1, 1, 2])
    nodes, weights = np.polynomial.legendre.leggauss(400)
    z = 0.7 * nodes
    square = 0.04 - np.clip(abs(z) - 0.5, 0, None) ** 2
    volume = (weights * pi * square).sum()
    along = (weights * pi * square**2 / 2).sum() / volume
    across = along / 2 + (weights * pi * square * z**2).sum() / volume
    found = moments({"kind": "capsule", "radius": 0.2, "length": 1}, 3)
    assert found == pytest.approx([across, across, along], rel=1e-4)


@pytest.mark.parametrize(
    ("shape", "at"),
    [
        ({"kind": "square", "width": 1}, "kind"),
        ({"kind": "cylinder", "radius": 1, "height": 1}, "kind"),
        ({"kind": "box", "width": 1}, "height"),
        ({"kind": "box", "width": 1, "height": 1, "hight": 1}, "hight"),
        ({"kind": "disc", "radius": 0}, "radius"),
        ({"kind": "polygon", "corners": [[0, 0], [1, 0]]}, "corners"),
        ({"kind": "polygon", "corners": [[0, 0], [0, 1], [1, 0]]}, "corners"),
        ({"kind": "polygon", "corners": [[0, 0], [2, 0], [0.5, 0.5], [0, 2]]}, "corners"),
        # A star goes around twice, and turns to the left at each of its corners.
        ({"kind": "polygon", "corners": [[0, 3], [-2, -3], [3, 1], [-3, 1], [2, -3]]}, "corners"),
        ("box", None),
        ({"kind": ["box"]}, "kind"),
    ],
)
def test_shapes_that_cannot_be(shape: Any, at: str | None) -> None:
    with pytest.raises(InvalidParameter) as fault:
        shape_of(shape, PLAIN, ("shape",), 2)
    assert fault.value.path[:2] == (("shape",) if at is None else ("shape", at))


def test_homogeneous_solids_have_their_centroid_at_the_centre_of_mass() -> None:
    """Otherwise the inertia has to be given."""
    triangle = {"kind": "polygon", "corners": [[0, 0], [3, 0], [0, 3]]}
    scene: dict[str, Any] = {"bodies": {"b": {"mass": 1, "at": [0, 0], "shape": triangle, "angular_velocity": 1}}}
    with pytest.raises(InvalidParameter) as fault:
        solve_scene(read(scene))
    assert fault.value.path == ("bodies", "b", "shape")
    scene["bodies"]["b"]["inertia"] = 1
    assert solve_scene(read(scene)).energy.kinetic == 0.5  # type: ignore[union-attr]


def test_a_centred_disc_is_a_rim_and_has_its_own_inertia() -> None:
    """It rolls down a slope with 2/3 of the acceleration without friction."""
    scene = {
        "gravity": [0, -9.81],
        "bodies": {"wheel": {"mass": 2, "at": [0, 0.1], "shape": {"kind": "disc", "radius": 0.1}}},
        "connections": [{"kind": "rolling", "place": "wheel", "on": {"at": [0, 0], "slope": {"degrees": 0}}}],
    }
    scene["gravity"] = [9.81 / sqrt(2), -9.81 / sqrt(2)]
    answer = solve_scene(read(scene))
    assert answer.accelerations is not None
    assert answer.accelerations["wheel"].linear[0] == pytest.approx(2 / 3 * 9.81 / sqrt(2), rel=1e-15)


def test_a_drum_with_a_shape_touches_with_its_shape() -> None:
    """A box of 0.2 m with a drum of 0.3 m falls by what is below its corners."""
    body = {"mass": 1, "at": [0, 1], "radius": 0.3, "shape": {"kind": "box", "width": 0.2, "height": 0.2}}
    contact = {"kind": "contact", "name": "f", "place": "b", "on": {"at": [0, 0]}}
    scene = {"gravity": [0, -10], "bodies": {"b": body}, "connections": [contact], "simultaneous": "together"}
    assert solve_scene(read(scene), [1.0]).events[0].time == pytest.approx(sqrt(0.18), rel=1e-15)


def test_inertia_out_of_range_is_refused() -> None:
    body = {"mass": 1, "at": [0, 1], "shape": {"kind": "box", "width": 1e300, "height": 1}}
    with pytest.raises(InvalidParameter) as fault:
        solve_scene(read({"bodies": {"b": body}}))
    assert fault.value.path == ("bodies", "b", "shape")
