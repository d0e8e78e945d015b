"""What the audit does with numbers at the ends of the range of doubles, and with what rounding alone decides."""

from __future__ import annotations

from typing import Any

import pytest

from core.multibody.audit.definitions import description_of
from core.multibody.audit.failure import NOT_COMPARED
from core.multibody.solve import solve_scene
from tests.core.multibody.worked_examples import column, read

PLATE = {"mass": 1, "moments": [0.1, 0.1, 0.2]}


def scene(body: dict[str, Any], connection: dict[str, Any], gravity: Any = (0, 0, -9.81)) -> Any:
    return read({"bodies": {"a": body}, "gravity": list(gravity), "connections": [connection]})


@pytest.mark.parametrize("size", ["1e-250", "1e-170", "1e10", "1e160", "1e250"])
@pytest.mark.parametrize(
    ("kind", "field"), [("pin", "axis"), ("cylindrical", "axis"), ("screw", "axis"), ("slider", "direction")]
)
def test_the_length_of_a_direction_does_not_matter(kind: str, field: str, size: str) -> None:
    other = {"pitch": 0.1} if kind == "screw" else {}
    body = {**PLATE, "at": [0.3, 0, 0], "places": {"p": [-0.3, 0, 0]}}

    def motion(factor: str) -> Any:
        direction = [f"{share}*{factor}" for share in ("1", "2", "0.5")]
        joint = {"kind": kind, "a": "a.p", "b": [0, 0, 0], field: direction, **other}
        return column(solve_scene(scene(body, joint), [0.0, 0.3]), "a.position")

    found, one = motion(size), motion("1")
    assert abs(found.values - one.values).max() <= found.error + one.error


@pytest.mark.parametrize("y", [[0, 1, 1e-9], [0, 1, 9.9999e-10], [0, 1, 1.00001e-9]])
def test_whether_a_rim_is_level_is_decided_once(y: Any) -> None:
    disc = {**PLATE, "at": [0, 0, 1], "axes": [[1, 0, 0], y, [0, -y[2], 1]], "shape": {"kind": "disc", "radius": 0.5}}
    floor = {"kind": "contact", "name": "floor", "place": "a", "on": {"at": [0, 0, 0], "normal": [0, 0, 1]}}
    answer = solve_scene(scene(disc, {**floor, "restitution": 0.5}), [0.0, 0.2])
    assert column(answer, "a.position").values[1, 2] == pytest.approx(1 - 9.81 * 0.02)


@pytest.mark.parametrize(
    "connection",
    [
        {"kind": "spring", "a": [0, 0], "b": "a", "stiffness": 1, "rest_length": 1e155},
        {"kind": "spring", "a": [0, 0], "b": "a", "stiffness": 1e155, "rest_length": 1},
        {"kind": "track", "place": "a", "on": {"surface": "1e155*y"}},
        {"kind": "track", "place": "a", "on": {"surface": "1e-155*y"}},
    ],
)
def test_what_has_powers_that_are_no_doubles_is_not_audited(connection: dict[str, Any]) -> None:
    one = scene({"mass": 1, "at": [1, 0]}, connection, (0, -9.81))
    assert not description_of(one).moderate
    assert NOT_COMPARED in solve_scene(one, [0.0]).model.noticed


def test_a_coordinate_as_small_as_a_zero_is_audited() -> None:
    spring = {"kind": "spring", "a": [0, 1e-200], "b": "a", "stiffness": 1, "rest_length": 1}
    assert description_of(scene({"mass": 1, "at": [1, 1e-200]}, spring, (0, -9.81))).moderate
