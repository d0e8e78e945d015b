"""Several contacts that take impulses at one time, as `simultaneous` and the laws of impact say."""

from __future__ import annotations

from typing import Any

import pytest

from core.errors import InvalidParameter
from core.multibody.solve import solve_scene
from tests.core.multibody.worked_examples import column, read


def row(count: int, restitution: float, **more: Any) -> dict[str, Any]:
    """Return balls in a row, all in touch but the first, which comes at 1 m/s."""
    bodies = {
        f"b{i}": {"mass": 1, "radius": 0.1, "at": [f"{i}/5" if i else -1, 0], "velocity": [0 if i else 1, 0]}
        for i in range(count)
    }
    contacts = [
        {"kind": "contact", "name": f"c{i}", "a": f"b{i}", "b": f"b{i + 1}", "restitution": restitution}
        for i in range(count - 1)
    ]
    return {"bodies": bodies, "connections": contacts, **more}


def speeds(scene: dict[str, Any]) -> list[float]:
    answer = solve_scene(read(scene), [2.0])
    return [float(column(answer, f"{name}.velocity").values[0, 0]) for name in scene["bodies"]]


@pytest.mark.parametrize("law", ["newton", "poisson", "stronge"])
def test_a_cradle_in_order_passes_the_speed_on(law: str) -> None:
    """Equal balls exchange their speeds; of 0.5 each impact leaves (1 + e)/2 of it to the next."""
    assert speeds(row(5, 1, simultaneous="in order", impacts=law)) == pytest.approx([0, 0, 0, 0, 1], abs=1e-15)
    assert speeds(row(3, 0.5, simultaneous="in order", impacts=law))[2] >= 0.5625


def test_a_cradle_together_by_newton_and_poisson() -> None:
    """By Newton's law the balls behind stay in touch; by Poisson's each contact expands by its own compression.

    Three balls: compression leaves 1/3 for all with the impulses 2/3 and 1/3, and expansion doubles them for e = 1.
    """
    assert speeds(row(3, 1, simultaneous="together")) == pytest.approx([-1 / 3, 2 / 3, 2 / 3], abs=1e-15)
    found = speeds(row(3, 1, simultaneous="together", impacts="poisson"))
    assert found == pytest.approx([1 - 4 / 3, 4 / 3 - 2 / 3, 2 / 3], abs=1e-15)
    # A lighter ball in the middle: compression leaves 1/(2.5) and the impulses 0.6 and 0.4 of the first's momentum.
    light = row(3, 1, simultaneous="together", impacts="poisson")
    light["bodies"]["b1"]["mass"] = 0.5
    assert speeds(light) == pytest.approx([1 - 1.2, (1.2 - 0.8) / 0.5, 0.8], abs=1e-15)


def test_equal_order_is_together() -> None:
    scene = row(3, 1)
    for contact in scene["connections"]:
        contact["order"] = 1
    assert speeds(scene) == speeds(row(3, 1, simultaneous="together"))


def test_a_box_that_lands_flat() -> None:
    """Both corners at once, without friction: it rebounds with e of its speed by every law and in every order."""
    shape = {"kind": "box", "width": 0.4, "height": 0.2}
    floor = {"kind": "contact", "name": "f", "place": "b", "on": {"at": [0, 0]}, "restitution": 0.5}
    bodies = {"b": {"mass": 1, "shape": shape, "at": [0, 1], "velocity": [0, -1]}}
    for law in ("newton", "poisson"):
        scene = {"bodies": bodies, "connections": [floor], "simultaneous": "together", "impacts": law}
        answer = solve_scene(read(scene), [2.0])
        assert column(answer, "b.velocity").values[0].tolist() == [0, 0.5]


@pytest.mark.parametrize(
    ("change", "at"),
    [
        ({"impacts": "newtons"}, ("impacts",)),
        ({"simultaneous": "at once"}, ("simultaneous",)),
    ],
)
def test_words_that_do_not_exist_are_refused(change: dict[str, str], at: tuple[str, ...]) -> None:
    with pytest.raises(InvalidParameter) as fault:
        solve_scene(read({**row(2, 1), **change}))
    assert fault.value.path == at
    scene = row(2, 1)
    scene["connections"][0]["impacts"] = "hertz"
    with pytest.raises(InvalidParameter) as fault:
        solve_scene(read(scene))
    assert fault.value.path == ("connections", 0, "impacts")


def test_a_box_that_lands_flat_in_order_comes_to_rest() -> None:
    """Its corners strike in turn without end: the limit is rest, and their impulses add up to the momentum."""
    shape = {"kind": "box", "width": 0.2, "height": 0.1}
    floor = {"kind": "contact", "name": "f", "place": "b", "on": {"at": [0, 0]}, "friction": 0.5}
    bodies = {"b": {"mass": 2, "shape": shape, "at": [0, 0.37], "velocity": [-0.5, 0]}}
    scene = {"gravity": [0, -9.81], "bodies": bodies, "connections": [floor], "simultaneous": "in order"}
    answer = solve_scene(read(scene), [1.0])
    assert [event.name for event in answer.events] == ["f.1", "f.2"]
    total = sum(event.impulses["normal"] for event in answer.events)
    assert total == pytest.approx(2 * (2 * 9.81 * 0.32) ** 0.5, rel=1e-15)
    assert sum(event.impulses["friction"] for event in answer.events) == pytest.approx(1, rel=1e-15)
    assert column(answer, "b.velocity").values[0].tolist() == [0, 0]


def plank(restitution: float, legs: int = 6) -> dict[str, Any]:
    """Return a plank that lands level, and symmetrically, on more legs than of which every order is tried."""
    places = {f"p{i}": [2 * i - legs + 1, -1] for i in range(legs)}
    body = {"mass": 1, "inertia": 50, "at": [0, 2], "velocity": [0, -1], "places": places}
    legs_on_floor = [
        {"kind": "contact", "name": name, "place": f"b.{name}", "on": {"at": [0, 0]}, "restitution": restitution}
        for name in places
    ]
    return {"bodies": {"b": body}, "connections": legs_on_floor}


def test_orders_of_many_contacts_that_disagree_are_undecided() -> None:
    answer = solve_scene(read(plank(0.5)), [1.5])
    assert answer.problem is not None
    assert answer.problem.code == "simultaneous-impacts"


def test_orders_of_many_contacts_that_agree_are_decided() -> None:
    """Six equal balls that all meet at once: those of Newton's law in any order exchange their speeds, as together."""
    scene = row(6, 1)
    scene["bodies"]["b0"]["at"] = [0, 0]
    for i, speed in enumerate((3, 2, 1, -1, -2, -3)):
        scene["bodies"][f"b{i}"]["velocity"] = [speed, 0]
    answer = solve_scene(read(scene), [1.0])
    found = [float(column(answer, f"b{i}.velocity").values[0, 0]) for i in range(6)]
    assert found == pytest.approx([-3, -2, -1, 1, 2, 3], abs=1e-15)


def test_what_slides_on_while_something_else_bounces_takes_no_part() -> None:
    """A ladder slides down a wall, and nothing but a damper joins it to a ball that bounces."""
    scene: dict[str, Any] = {
        "gravity": [0, -10],
        "impacts": "stronge",
        "bodies": {
            "ball": {"mass": 1, "at": [-3, 0.2]},
            "ladder": {
                "mass": 1,
                "inertia": "1/10",
                "at": ["-1/4", "sqrt(3)/4"],
                "angle": "pi/3",
                "places": {"foot": [-0.5, 0], "head": [0.5, 0]},
            },
        },
        "connections": [
            {"kind": "contact", "name": "pad", "place": "ball", "on": {"at": [0, 0]}, "restitution": 0.8},
            {"kind": "contact", "name": "floor", "place": "ladder.foot", "on": {"at": [0, 0]}, "friction": 0.1},
            {"kind": "contact", "name": "wall", "place": "ladder.head", "on": {"at": [0, 0], "slope": "pi/2"}},
            {"kind": "damper", "name": "damper", "a": "ball", "b": "ladder", "coefficient": 2},
        ],
    }
    answer = solve_scene(read(scene), [0.0, 0.3])
    assert answer.problem is None
    assert [event.kind for event in answer.events] == ["touch"]


@pytest.mark.parametrize("until", [None, 100])
def test_contacts_act_as_they_are_listed_whether_or_not_they_end(until: float | None) -> None:
    # A level plank falls on both its ends by 2 m/s. An impulse changes the rate of its end by 4 of it, of the other by
    # -2: the left one stops by 1/2, the right one turns back from 3 by 3/2, and the left one stops again by 3/4.
    scene: dict[str, Any] = {
        "gravity": [0, -10],
        "simultaneous": "in order",
        "bodies": {
            "plank": {"mass": 1, "inertia": "1/3", "at": [0, 0.2], "places": {"l": [-1, 0], "r": [1, 0]}},
        },
        "connections": [
            {"kind": "contact", "name": "left", "place": "plank.l", "on": {"at": [0, 0]}, "until": until},
            {"kind": "contact", "name": "right", "place": "plank.r", "on": {"at": [0, 0]}, "restitution": 1},
        ],
    }
    found = solve_scene(read(scene), [0.201])
    struck = {event.name: event.impulses["normal"] for event in found.events if event.kind == "touch"}
    assert list(struck) == ["left", "right"]
    assert [*struck.values()] == pytest.approx([5 / 4, 3 / 2], rel=1e-12)
