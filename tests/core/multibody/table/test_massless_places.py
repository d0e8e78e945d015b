"""Places without mass where springs meet: springs in a row are one spring, with its compliance and length."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

from core.errors import InvalidParameter, PlacesDisagree
from core.multibody.answer import SceneSolution
from core.multibody.language.reading import scene_from
from core.multibody.solve import solve_scene

TIMES = np.array([0.0, 0.4, 0.9])
OUTPUTS = ("accelerations", "forces", "trajectory", "forces-in-time", "energy-in-time", "work-in-time")


def spring(name: str, a: Any, b: Any, stiffness: Any, rest: Any) -> dict[str, Any]:
    return {"kind": "spring", "name": name, "a": a, "b": b, "stiffness": stiffness, "rest_length": rest}


def solved(gravity: list[Any], bodies: dict[str, Any], *connections: dict[str, Any], **more: Any) -> SceneSolution:
    scene = {"gravity": gravity, "bodies": bodies, "connections": list(connections), **more}
    return solve_scene(scene_from(scene), TIMES, OUTPUTS)


def columns(found: SceneSolution, *names: str) -> list[Any]:
    assert found.trajectory is not None
    return [found.trajectory.columns[name].values for name in names]


@pytest.mark.parametrize("turned_round", [False, True])
@pytest.mark.parametrize("x", [0, 100])
@pytest.mark.parametrize("way", [[1, 0], [1, 1, 0]])
def test_a_weight_swings_on_two_springs_as_on_one(way: list[int], x: int, turned_round: bool) -> None:
    """10 and 20 N/m in a row are 20/3 N/m, and their rest lengths add up."""
    down = [0] * (len(way) - 1)
    top, gravity = [x, *[0] * len(down)], [*down, -10]

    def at(height: Any) -> list[Any]:
        return [x, *down[1:], height]

    weight = {"bob": {"mass": 1, "at": at(-3), "velocity": way}}
    both = {"knot": {"mass": 0, "at": at(-2)}, **weight}
    springs = [spring("upper", "knot", top, 10, 1), spring("lower", "bob", "knot", 20, "1/2")]
    if turned_round:
        springs = [spring("lower", "knot", "bob", 20, "1/2"), spring("upper", top, "knot", 10, 1)]
    found = solved(gravity, both, *springs)
    known = solved(gravity, weight, spring("one", "bob", top, "20/3", "3/2"))
    for name in ("bob.position", "energy.potential", "energy.kinetic"):
        np.testing.assert_allclose(*(columns(one, name)[0] for one in (found, known)), atol=1e-11)
    pull = columns(known, "one.force")[0]
    for force in columns(found, "upper.force", "lower.force"):
        np.testing.assert_allclose(force, pull, atol=1e-11)
    assert found.model.degrees_of_freedom == len(way)


def test_two_springs_on_a_rail_have_the_period_of_one() -> None:
    """Unstretched at first, where the rail alone keeps their place from moving aside."""
    bodies = {"bob": {"mass": 1, "at": [3, 0], "velocity": [1, 0]}, "knot": {"mass": 0, "at": [1, 0]}}
    rails = [{"kind": "track", "place": name, "on": {"at": [0, 0]}} for name in bodies]
    found = solved([0, 0], bodies, spring("near", "knot", [0, 0], 10, 1), spring("far", "bob", "knot", 20, 2), *rails)
    rate = np.sqrt(20 / 3)
    assert found.period == pytest.approx(2 * np.pi / rate, rel=1e-15)
    (place,) = columns(found, "bob.position")
    np.testing.assert_allclose(place[:, 0], 3 + np.sin(rate * TIMES) / rate, atol=1e-13)


def test_springs_without_rest_length_meet_in_a_linear_scene() -> None:
    """Two of 10 N/m in a fork and a third one below: 20/3 N/m toward the middle between their ends."""
    bodies = {"bob": {"mass": 1, "at": [0, -3]}, "knot": {"mass": 0, "at": [0, -1]}}
    fork = [spring(f"s{x}", "knot", [x, 0], 10, 0) for x in (-1, 1)]
    found = solved([0, -10], bodies, *fork, spring("third", "bob", "knot", 10, 0))
    assert found.model.name == "modes"
    (place,) = columns(found, "bob.position")
    np.testing.assert_allclose(place[:, 1], -1.5 - 1.5 * np.cos(np.sqrt(20 / 3) * TIMES), atol=1e-13)


def test_what_does_not_balance_is_refused_with_the_places_that_do() -> None:
    bodies = {"bob": {"mass": 1, "at": [0, -3]}, "knot": {"mass": 0, "at": [0, -1]}}
    springs = [spring("upper", "knot", [0, 0], 10, 0), spring("lower", "bob", "knot", 20, 0)]
    with pytest.raises(PlacesDisagree, match="its springs balance") as refused:
        solved([0, -10], bodies, *springs)
    assert refused.value.path == ("bodies", "knot", "at")
    found = solved([0, -10], bodies, *springs, assemble="nearest")
    place = columns(found, "bob.position")[0][0]
    middle = columns(found, "knot.position")[0][0]
    np.testing.assert_allclose(3 * middle, 2 * place, atol=1e-12)


@pytest.mark.parametrize(
    "more",
    [
        {"kind": "field", "force": [1, 0]},
        {"kind": "damper", "a": "knot", "b": [1, 1], "coefficient": 1},
        {"kind": "force", "place": "bob", "force": ["-knot.x", 0]},
    ],
)
def test_what_else_acts_there_needs_a_mass(more: dict[str, Any]) -> None:
    bodies = {"bob": {"mass": 1, "at": [0, -3]}, "knot": {"mass": 0, "at": [0, -2]}}
    springs = [spring("upper", "knot", [0, 0], 10, 1), spring("lower", "bob", "knot", 20, "1/2")]
    with pytest.raises(InvalidParameter, match="have mass"):
        solved([0, -10], bodies, *springs, more)


@pytest.mark.parametrize("name", ["k", "m"])
def test_formulas_name_bodies_and_not_parts_of_names(name: str) -> None:
    """A force by the place of `disk` has nothing to do with a body `k`."""
    bodies = {
        name: {"mass": 0, "at": [1, 0]},
        "bob": {"mass": 1, "at": [2, 0]},
        "disk": {"mass": 1, "at": [5, 0], "velocity": [1, 0]},
    }
    springs = [spring("one", name, [0, 0], 10, 1), spring("other", "bob", name, 10, 1)]
    pull = {"kind": "force", "place": "disk", "force": ["-2*disk.x", 0]}
    found = solved([0, 0], bodies, *springs, pull)
    np.testing.assert_allclose(columns(found, "bob.position")[0], [[2.0, 0.0]] * 3, atol=1e-14)


@pytest.mark.parametrize("far", [100, 10000])
def test_a_knot_moves_alike_wherever_it_is(far: int) -> None:
    """Places in units of their distance from the origin make lengths small: it was not known whether rows keep rank."""
    found = []
    for x in (0, far):
        bodies = {
            "knot": {"mass": 0, "at": [x + 1, 0]},
            "bob": {"mass": 1, "at": [x + 3, 0], "velocity": [0, 1]},
        }
        springs = [spring("one", [x, 0], "knot", 30, "1/2"), spring("other", "knot", "bob", 30, "3/2")]
        (place,) = columns(solved([0, 0], bodies, *springs), "bob.position")
        found.append(place - np.array([x, 0]))
    np.testing.assert_allclose(found[0], found[1], rtol=0, atol=1e-9)
