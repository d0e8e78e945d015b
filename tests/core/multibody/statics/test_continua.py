"""Places of rest on lines and surfaces, one of each: which of them hang together is known from their geometry."""

from __future__ import annotations

import math
from typing import Any

import pytest

from core.multibody.solve import solve_scene
from tests.core.multibody.worked_examples import read

RAIL = {"kind": "slider", "name": "rail", "a": "bead", "b": [0, 0]}
LINE: dict[str, Any] = {"bodies": {"bead": {"mass": 1, "at": [0.3, 0]}}, "connections": [RAIL], "gravity": [0, -9.81]}
CIRCLE: dict[str, Any] = {
    "bodies": {"bead": {"mass": 1, "at": [1.3, 0]}},
    "connections": [{"kind": "spring", "a": "bead", "b": [0, 0], "stiffness": 3, "rest_length": 1}],
}
SPHERE: dict[str, Any] = {
    "bodies": {"bob": {"mass": 1, "at": [0.6, -0.8, 0]}},
    "connections": [{"kind": "rod", "a": "bob", "b": [0, 0, 0]}],
}


@pytest.mark.parametrize("scene", [LINE, CIRCLE, SPHERE])
def test_of_a_line_or_surface_one_place_is_answered(scene: dict[str, Any]) -> None:
    answer = solve_scene(read(scene), outputs=["equilibria"])
    assert answer.equilibria is not None
    (one,) = answer.equilibria
    assert one.continuum
    assert one.stable is None


def test_lines_of_equal_energy_that_do_not_meet_are_told_apart() -> None:
    """A spring longer than its way to the rail rests at sqrt(1.2^2 - 1) on either side, and hardly in the middle."""
    bodies = {"bead": {"mass": 1, "at": [0.3, 0]}, "other": {"mass": 1, "at": [0.2, -3]}}
    spring = {"kind": "spring", "a": "bead", "b": [0, 1], "stiffness": 3, "rest_length": 1.2}
    free = {"kind": "slider", "name": "free", "a": "other", "b": [0, -3]}
    answer = solve_scene(read({"bodies": bodies, "connections": [RAIL, spring, free]}), outputs=["equilibria"])
    assert answer.equilibria is not None
    found = sorted((one.positions["bead"][0], one.continuum) for one in answer.equilibria)
    assert [x for x, _ in found] == pytest.approx([-math.sqrt(0.44), 0.0, math.sqrt(0.44)], abs=1e-12)
    assert all(one for _, one in found)


def test_places_that_stand_alone_are_no_continuum() -> None:
    scene = {
        "gravity": [0, -9.81],
        "bodies": {"bob": {"mass": 1, "at": [0.6, -0.8]}},
        "connections": [{"kind": "rod", "a": "bob", "b": [0, 0]}],
    }
    answer = solve_scene(read(scene), outputs=["equilibria"])
    assert answer.equilibria is not None
    assert [one.continuum for one in answer.equilibria] == [False, False]
