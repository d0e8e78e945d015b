"""Straight parts of strings that come to their end, in closed form, whatever moves beside them."""

from __future__ import annotations

from fractions import Fraction
from typing import Any

import numpy as np
import pytest

from core.errors import InvalidParameter
from core.multibody.answer import SceneSolution
from core.multibody.proven.proven_answer import proven_answer
from core.multibody.solve import solve_scene
from tests.core.multibody.worked_examples import column, read

G = 9.81


def over_a_drum(light: float, heavy: float, way: float, tilt: tuple[str, str] = ("1", "0")) -> dict[str, Any]:
    """Return Atwood's machine with a drum, its lighter mass `way` below the tangent point; all turned by an angle."""
    c, s = tilt

    def turned(x: str, y: str) -> list[str]:
        return [f"({c})*({x}) - ({s})*({y})", f"({s})*({x}) + ({c})*({y})"]

    return {
        "gravity": turned("0", f"-{G}"),
        "bodies": {
            "a": {"mass": light, "at": turned("-0.1", f"-{way}")},
            "b": {"mass": heavy, "at": turned("0.1", "-1")},
            "wheel": {"mass": 0.5, "radius": 0.1, "inertia": 0.0025, "at": [0, 0]},
        },
        "connections": [
            {"kind": "pin", "a": "wheel", "b": [0, 0]},
            {
                "kind": "string",
                "name": "s",
                "through": ["a", "wheel", "b"],
                "sides": {"wheel": ["left", "right"]},
            },
        ],
    }


def reached(light: float, heavy: float, way: float) -> float:
    """Return when the lighter mass is at its drum: a = (m_2 - m_1) g/(m_1 + m_2 + I/r^2)."""
    return float(np.sqrt(2 * way / ((heavy - light) * G / (light + heavy + 0.25))))


def ended(scene: dict[str, Any], end: float) -> SceneSolution:
    answer = solve_scene(read(scene), np.linspace(0, end, 21), ("trajectory",))
    assert answer.ended is not None
    assert answer.ended.kind == "singular"
    assert answer.trajectory is not None
    assert np.max(answer.trajectory.time) <= answer.ended.time
    return answer


@pytest.mark.parametrize(
    ("light", "heavy", "way", "tilt"),
    [
        (1, 2, 1, ("1", "0")),
        (0.5, 3, 0.3, ("1", "0")),
        (1, 1.01, 0.05, ("0.8", "0.6")),
        (1, 2, 0.7, ("5/13", "-12/13")),
    ],
)
def test_a_weight_that_reaches_its_drum_ends_the_motion(
    light: float, heavy: float, way: float, tilt: tuple[str, str]
) -> None:
    # Sides are named as seen in space: a turned machine keeps those of the upright one for turns below 90 degrees.
    scene = over_a_drum(light, heavy, way, tilt)
    expected = reached(light, heavy, way)
    answer = ended(scene, 1.5 * expected)
    assert answer.ended is not None
    assert answer.ended.time == pytest.approx(expected, rel=1e-14)
    assert answer.ended.name == "s"


@pytest.mark.parametrize("beside", ["contact", "restitution", "spring", "pendulum"])
def test_it_ends_the_motion_beside_everything(beside: str) -> None:
    scene = over_a_drum(1, 2, 1)
    expected = reached(1, 2, 1)
    if beside == "contact":
        scene["connections"].append({"kind": "contact", "place": "b", "on": {"at": [0, -50]}})
    elif beside == "restitution":
        scene["connections"][1]["restitution"] = 0.5
    elif beside == "spring":
        # A spring of almost no stiffness makes the motion one of modes.
        spring = {"kind": "spring", "a": "b", "b": [0.1, -1], "stiffness": 1e-9, "rest_length": 0}
        scene["connections"].append(spring)
    else:
        scene["bodies"]["bob"] = {"mass": 1, "at": [5.6, -0.8]}
        scene["connections"].append({"kind": "rod", "a": "bob", "b": [5, 0]})
    answer = ended(scene, 1.5 * expected)
    assert answer.ended is not None
    assert answer.ended.time == pytest.approx(expected, rel=1e-8 if beside == "spring" else 1e-14)


def test_a_block_on_a_rough_table_ends_at_its_pulley() -> None:
    scene = {
        "gravity": [0, -10],
        "bodies": {"m": {"mass": 1, "at": [-1, 0]}, "w": {"mass": 1, "at": [0, -0.5]}},
        "connections": [
            {"kind": "contact", "place": "m", "friction": 0.2, "on": {"at": [0, 0]}},
            {"kind": "string", "through": ["m", [0, 0], "w"]},
        ],
    }
    answer = ended(scene, 1.0)
    assert answer.ended is not None
    # (m g - mu m g)/(2 m) = 4 m/s^2 over one metre.
    assert answer.ended.time == pytest.approx(np.sqrt(0.5), rel=1e-14)


def test_proven_digits_end_there_too() -> None:
    found = proven_answer(read(over_a_drum(1, 2, 1)), 16, [Fraction(4, 5), Fraction(9, 10)], ["trajectory"])
    assert found.rows == [0]
    assert found.ended == "singular"


def test_a_yo_yo_thrown_up_reaches_the_end_of_its_string() -> None:
    scene = {
        "gravity": [0, -G],
        "bodies": {"y": {"mass": 0.1, "radius": 0.01, "inertia": 4e-5, "at": [0.01, -0.5], "velocity": [0, 4]}},
        "connections": [{"kind": "string", "name": "s", "through": [[0, 0], "y"], "sides": {"y": "left"}}],
    }
    answer = ended(scene, 1.0)
    assert answer.ended is not None
    fall = G / (1 + 4e-5 / (0.1 * 0.01**2))
    time = (4 - np.sqrt(16 - 2 * fall * 0.5)) / fall
    assert answer.ended.time == pytest.approx(time, rel=1e-13)
    assert np.max(column(answer, "y.position").values[:, 1]) < 0.0


def test_a_massless_pulley_that_hangs_straight_down_is_followed_until_a_weight_reaches_it() -> None:
    """The pulley stands for 4 m1 m2/(m1 + m2); beside it the lighter weight rises with (g + a)/3."""
    scene = {
        "gravity": [0, -G],
        "bodies": {
            "m": {"mass": 4, "at": [-0.3, -1]},
            "p": {"mass": 0, "at": [0.2, -0.5]},
            "a": {"mass": 1, "at": [0.2, -1]},
            "b": {"mass": 2, "at": [0.2, -1.2]},
        },
        "connections": [
            {"kind": "string", "name": "u", "through": ["m", [-0.3, 0], [0.2, 0], "p"]},
            {"kind": "string", "name": "l", "through": ["a", "p", "b"]},
        ],
    }
    gain = G * (4 - 8 / 3) / (4 + 8 / 3)
    answer = ended(scene, 0.6)
    assert answer.ended is not None
    assert answer.ended.time == pytest.approx(np.sqrt(2 * 0.5 / ((G + gain) / 3)), rel=1e-13)
    assert answer.trajectory is not None
    fallen = -1 - gain * np.asarray(answer.trajectory.time) ** 2 / 2
    assert np.max(np.abs(column(answer, "m.position").values[:, 1] - fallen)) < 1e-14


def winch(drive: str, **more: Any) -> dict[str, Any]:
    """Return a weight of 2 kg that hangs 1 m below the origin on a string whose length is driven."""
    string = {"kind": "string", "name": "s", "through": ["bob", [0, 0]], "drive": drive, **more}
    return {"gravity": [0, -10], "bodies": {"bob": {"mass": 2, "at": [0, -1]}}, "connections": [string]}


def test_a_winch_lifts_a_weight() -> None:
    """With the length 1 - t^2/4 the weight of 20 N is accelerated by 1/2 m/s^2."""
    times = np.array([0.0, 0.5, 1.0])
    found = solve_scene(read(winch("1 - t^2/4")), times, ("trajectory", "forces-in-time", "work-in-time"))
    np.testing.assert_allclose(column(found, "bob.position").values[:, 1], -1 + times**2 / 4, atol=1e-14)
    np.testing.assert_allclose(column(found, "s.tension").values, 21, rtol=1e-14)
    np.testing.assert_allclose(column(found, "s.work").values, 21 * times**2 / 4, atol=1e-13)


def test_a_string_that_is_paid_out_too_fast_goes_slack() -> None:
    """The length 1 + t^3 is accelerated by 6 t, the weight by 10: from 5/3 s on it falls freely."""
    found = solve_scene(read(winch("1 + t^3", restitution=0)), [0.0, 1.0, 2.0])
    assert [event.kind for event in found.events] == ["slack"]
    assert found.events[0].time == pytest.approx(5 / 3, abs=1e-13)
    first = 5 / 3
    fallen = 1 + first**3 + 3 * first**2 * (2 - first) + 5 * (2 - first) ** 2
    np.testing.assert_allclose(column(found, "bob.position").values[-1], [0, -fallen], atol=1e-12)


def test_a_string_that_is_reeled_in_jerks_its_weight() -> None:
    """Loose by 0.3 m, and wound in at 1 m/s from -1.3 m: it meets the falling weight where 5 t^2 = 0.3 - t."""
    found = solve_scene(read(winch("1.3 - t", restitution="1/2")), [0.0, 0.3])
    time = (-1 + np.sqrt(1 + 20 * 0.3)) / 10
    assert found.events[0].kind == "taut"
    assert found.events[0].time == pytest.approx(time, abs=1e-13)
    # They close at 1 + 10 t, and leave each other at half of that.
    assert found.events[0].impulses["normal"] == pytest.approx(2 * 1.5 * (1 + 10 * time), abs=1e-11)


@pytest.mark.parametrize(
    ("drive", "more", "rule"),
    [
        ("0.9 - t", {}, "be at least 1 m"),
        ("1 + bob.y", {}, "known names"),
        ("1", {"length": 1}, "left out beside length"),
        ("t", {}, "greater than 0 m at the start"),
        ("2 - t", {"through": ["bob", [0, 0], [1, 0]], "friction": 0.2}, "left out beside friction"),
    ],
)
def test_strings_that_cannot_be_driven_so_are_refused(drive: str, more: dict[str, Any], rule: str) -> None:
    with pytest.raises(InvalidParameter, match=rule) as refused:
        solve_scene(read(winch(drive, **more)), [0.0, 1.0])
    assert refused.value.path == ("connections", 0, "drive")
