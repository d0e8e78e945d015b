"""Lengths beside which places are rounded: those of the scene, wherever the origin is."""

from __future__ import annotations

from typing import Any

import pytest

from core.errors import PlacesDisagree
from core.multibody.solve import solve_scene
from core.multibody.table.description import described
from core.multibody.table.scene_sizes import FAR, sizes
from tests.core.multibody.worked_examples import read

FAR_AWAY = ["0", "1e3", "-1e6", "1e8"]


def _above(place: str, gap: str, more: list[str]) -> dict[str, Any]:
    """A ball that starts by a gap above a floor."""
    nought = ["0"] * len(more)
    on: dict[str, Any] = {"at": [place, place, *more]}
    if more:
        on = {"at": [place, place, *more], "normal": [0, 1, 0]}
    return {
        "gravity": [0, -10, *nought],
        "bodies": {"a": {"mass": 1, "radius": "1/10", "at": [place, f"{place} + 1/10 + {gap}", *more]}},
        "connections": [{"kind": "contact", "name": "c", "place": "a", "on": on, "restitution": 0.5}],
    }


@pytest.mark.parametrize("place", FAR_AWAY)
@pytest.mark.parametrize("space", [False, True])
def test_a_gap_is_what_the_numbers_say_wherever_the_scene_is(place: str, space: bool) -> None:
    """From 5e-6 m it falls for (2 h/g)^(1/2) = 1 ms; what doubles round at 1e8 m is a hundredth of that height."""
    answer = solve_scene(read(_above(place, "5e-6", [place] if space else [])), [0.0, 0.5], ("trajectory",), 1e-3)
    first = answer.events[0]
    assert (first.kind, first.name) == ("touch", "c")
    assert abs(first.time - 1e-3) <= first.error + 2.0**-53 * 1e-3


@pytest.mark.parametrize("place", FAR_AWAY)
def test_a_gap_of_rounding_touches_wherever_the_scene_is(place: str) -> None:
    answer = solve_scene(read(_above(place, "1e-12", [])), [0.0, 0.5], ("trajectory",), 1e-3)
    assert not answer.events
    assert any('"c"' in sentence or "c" in sentence.split() for sentence in answer.model.noticed)


@pytest.mark.parametrize("place", FAR_AWAY)
@pytest.mark.parametrize(("off", "meant"), [("1e-7", True), ("1e-3", False), ("0.5", False)])
def test_a_pin_closes_what_is_rounded_and_not_what_is_far_from_the_origin(place: str, off: str, meant: bool) -> None:
    """Beside one metre a relative 1e-6 is rounding; beside 1e8 m half a metre would be."""
    body = {"mass": 1, "inertia": 1, "at": [f"{place} + 1 + {off}", place], "places": {"p": [-1, 0]}}
    scene = {
        "gravity": [0, -10],
        "bodies": {"a": body},
        "connections": [{"kind": "pin", "a": "a.p", "b": [place, place]}],
    }
    if meant:
        assert solve_scene(read(scene)).problem is None
    else:
        with pytest.raises(PlacesDisagree):
            solve_scene(read(scene))


def test_lengths_are_at_most_those_of_the_scene_and_other_coordinates_themselves() -> None:
    ball = {"mass": 1, "inertia": 1, "at": [1000, 3], "angle": 7, "radius": "1/2"}
    rod = {"kind": "rod", "a": "a", "b": [1004, 3]}
    table = described(read({"gravity": [0, -10], "bodies": {"a": ball}, "connections": [rod]})).measures.table
    found = dict(zip(table.names, (float(x) for x in sizes(table, table.q)), strict=True))
    assert found["a.x"] == pytest.approx(4 + FAR * 1000, rel=1e-12)
    assert found["a.y"] == 3.0
    assert found["a.angle"] == 7.0
