"""Moments of welds, sliders and pins with an axis, by the balance of moments of a free body.

References
----------
R. C. Hibbeler, "Statics" (2016), chapter 7 (moments in cut beams); H. Goldstein, C. Poole, J. Safko, "Classical
Mechanics" (2002), section 5.5 (Euler's equations: what the bearings of an unbalanced rotor carry).
"""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

from core.multibody.solve import solve_scene
from tests.core.multibody.worked_examples import column, read

BEAM = {"mass": 2, "inertia": 0.5, "at": [1.5, 0], "places": {"end": [-1.5, 0]}}


def scene(bodies: Any, connections: Any, gravity: Any = (0, -9.81)) -> Any:
    return read({"gravity": list(gravity), "bodies": bodies, "connections": connections})


def force(answer: Any, name: str) -> float:
    found = answer.forces[name]
    assert found.unit == ("N m" if ".moment" in name else "N")
    assert found.error is not None
    assert found.error <= 1e-14 * max(abs(found.value), 1.0)
    value: float = found.value
    return value


@pytest.mark.parametrize("sign", [1, -1])
def test_a_cantilever(sign: int) -> None:
    """m g l less the torque on it; on the ground, if that is named first, the opposite."""
    ends = {"a": "beam.end", "b": [0, 0]} if sign == 1 else {"a": [0, 0], "b": "beam.end"}
    loads = [{"kind": "torque", "body": "beam", "torque": 3}]
    answer = solve_scene(scene({"beam": BEAM}, [{"kind": "weld", "name": "wall", **ends}, *loads]), [0.0, 1.0])
    assert force(answer, "wall.moment") == pytest.approx(sign * (2 * 9.81 * 1.5 - 3), rel=1e-15)
    assert force(answer, "wall.y") == pytest.approx(sign * 2 * 9.81, rel=1e-15)


def test_a_cantilever_in_space() -> None:
    beam = {"mass": 2, "moments": [0.1, 0.5, 0.5], "at": [1, 0.5, 0], "places": {"end": [-1, -0.5, 0]}}
    loads = [{"kind": "force", "place": "beam", "force": [0.5, -2, 4]}]
    weld = {"kind": "weld", "name": "wall", "a": "beam.end", "b": [0, 0, 0]}
    answer = solve_scene(scene({"beam": beam}, [weld, *loads], (0, 0, -9.81)))
    expected = -np.cross([1, 0.5, 0], [0.5, -2, 4 - 2 * 9.81])
    assert [force(answer, f"wall.moment.{x}") for x in "xyz"] == pytest.approx(expected, rel=1e-14)


def test_a_cut_through_a_beam_that_swings() -> None:
    """Two welded halves of a uniform bar, let go from the horizontal: at the cut M = -m g L/16, with m of the whole."""
    bodies = {
        name: {"mass": 1, "inertia": "1/12", "at": [x, 0], "places": {"in": [-0.5, 0], "out": [0.5, 0]}}
        for name, x in (("inner", 0.5), ("outer", 1.5))
    }
    joints = [
        {"kind": "pin", "a": "inner.in", "b": [0, 0]},
        {"kind": "weld", "name": "cut", "a": "outer.in", "b": "inner.out"},
    ]
    answer = solve_scene(scene(bodies, joints))
    # (4/3) l^2 (2 m) a = 2 m g l, and of the outer half the moment about its inner end.
    a = -9.81 * 3 / 4 / 1
    moment = (1 / 12) * a + 0.5 * (1.5 * a + 9.81)
    assert force(answer, "cut.moment") == pytest.approx(moment, rel=1e-14)


def test_a_slider_carries_the_moment_of_an_eccentric_load() -> None:
    block = {"mass": 2, "inertia": 0.5, "at": [1, 0], "places": {"corner": [0.3, 0.2]}}
    joints = [
        {"kind": "slider", "name": "rail", "a": "block", "b": [0, 0]},
        {"kind": "force", "place": "block.corner", "force": [3, 4]},
    ]
    answer = solve_scene(scene({"block": block}, joints))
    assert force(answer, "rail.moment") == pytest.approx(-(0.3 * 4 - 0.2 * 3), rel=1e-15)
    assert force(answer, "rail.normal") == pytest.approx(2 * 9.81 - 4, rel=1e-15)


def test_the_bearing_of_a_rotor_that_is_not_balanced() -> None:
    """w x J w = (-J_yz, J_xz, 0) w^2, which turns with the rotor."""
    tensor = [[0.5, 0, 0.1], [0, 0.6, -0.05], [0.1, -0.05, 0.7]]
    rotor = {"mass": 1, "tensor": tensor, "at": [0, 0, 0], "angular_velocity": [0, 0, 4]}
    pin = {"kind": "pin", "name": "bearing", "a": "rotor", "b": [0, 0, 0], "axis": [0, 0, 1]}
    question = scene({"rotor": rotor}, [pin], (0, 0, 0))
    answer = solve_scene(question, [0.0, 0.3], ["forces", "forces-in-time"])
    at_start = np.array([0.05, 0.1, 0]) * 16
    assert [force(answer, f"bearing.moment.{x}") for x in "xyz"] == pytest.approx(at_start, rel=1e-14, abs=1e-14)
    c, s = np.cos(1.2), np.sin(1.2)
    later = [c * at_start[0] - s * at_start[1], s * at_start[0] + c * at_start[1], 0.0]
    for axis, value in zip("xyz", later, strict=True):
        found = column(answer, f"bearing.moment.{axis}")
        assert abs(found.values[1] - value) <= found.error + 1e-15


def test_a_moment_that_the_scene_does_not_determine_is_null() -> None:
    welds = [
        {"kind": "weld", "name": "left", "a": "beam.end", "b": [0, 0]},
        {"kind": "weld", "name": "right", "a": "beam", "b": [1.5, 0]},
    ]
    answer = solve_scene(scene({"beam": BEAM}, welds))
    assert answer.forces is not None
    assert answer.forces["left.moment"].value is None
    assert set(answer.forces["left.moment"].shared_with) == {"left", "right"}
