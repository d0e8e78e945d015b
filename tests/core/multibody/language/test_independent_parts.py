from typing import Any

import pytest

from core.multibody.language.independent_parts import independent_parts
from core.multibody.language.scene import ScenePart
from tests.core.multibody.worked_examples import read

POINT = {"mass": 1, "at": [0, -1]}
WHEEL = {"mass": 1, "inertia": 1, "radius": 1, "at": [0, 1], "places": {"rim": [1, 0]}}


def scene(*connections: dict[str, Any], bodies: str = "pqrs") -> Any:
    return read({"gravity": [0, -9.81], "bodies": dict.fromkeys(bodies, POINT), "connections": list(connections)})


def rod(a: Any, b: Any) -> dict[str, Any]:
    return {"kind": "rod", "a": a, "b": b}


def test_parts_are_the_connected_components_in_the_order_of_their_first_bodies() -> None:
    parts = independent_parts(scene(rod("s", "q"), rod("r", [0, 0]), rod("p", "r")))
    assert [list(part.bodies) for part in parts] == [["p", "r"], ["q", "s"]]
    assert [part.names() for part in parts] == [("rod-2", "rod-3"), ("rod-1",)]


@pytest.mark.parametrize(
    "joining",
    [
        rod("p", "q.centre"),
        {"kind": "torque", "body": "p", "torque": 1},
        {"kind": "contact", "place": "p", "on": {"at": "q", "slope": 0}},
        {"kind": "contact", "a": "p", "b": "q"},
        {"kind": "string", "through": ["p", [0, 3], "q"]},
        {"kind": "motor", "a": "p", "b": "q", "rate": 1},
    ],
)
def test_every_kind_of_field_joins_the_bodies_that_it_names(joining: dict[str, Any]) -> None:
    parts = independent_parts(scene(joining, bodies="pq"))
    assert len(parts) == (2 if joining["kind"] == "torque" else 1)


def test_the_ground_joins_nothing_and_the_frame_is_common() -> None:
    frame = {"kind": "spinning-frame", "rate": 1}
    motor = {"kind": "motor", "a": "p", "b": "ground", "rate": 1}
    parts = independent_parts(scene(motor, frame, rod("q", [0, 0]), bodies="pq"))
    assert [part.names() for part in parts] == [("motor-1", "spinning-frame-2"), ("spinning-frame-2", "rod-3")]


def test_connections_keep_the_numbers_that_they_have_in_the_description() -> None:
    _, part = independent_parts(scene(rod("p", [0, 0]), rod("q", [0, 0]), bodies="pq"))
    assert isinstance(part, ScenePart)
    assert list(part.numbered()) == [(1, part.connections[0])]


def test_what_is_connected_or_faulty_as_a_whole_is_not_divided() -> None:
    connected = scene(rod("p", "q"), bodies="pq")
    unknown = scene(rod("p", "nobody"), bodies="pq")
    mixed = read({"bodies": {"p": POINT, "q": {"mass": 1, "at": [0, 0, 0]}}})
    for whole in (connected, unknown, mixed):
        (only,) = independent_parts(whole)
        assert only is whole
