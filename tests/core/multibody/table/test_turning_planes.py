"""Contacts with friction on planes that turn, as turntables do, against closed forms and other formulations."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from core.multibody.solve import DEFAULT_OUTPUTS, solve_scene
from tests.core.multibody.worked_examples import column, read
from tests.oracles.plain_engine.comparison.comparing import compared

G = 9.81
TABLE = {"at": [0, 0, 0], "normal": [0, 0, 1]}


def on_table(body: dict[str, Any], rate: float, friction: Any, **more: Any) -> dict[str, Any]:
    contact = {"kind": "contact", "name": "table", "place": "b", "on": TABLE | {"rate": rate}, "friction": friction}
    return {"gravity": [0, 0, -G], "bodies": {"b": body}, "connections": [contact | more]}


def test_a_coin_that_is_held_goes_round_with_the_table() -> None:
    """It needs the friction W^2 r/g of its weight, and the table does no work."""
    body = {"mass": 2, "at": [0.5, 0, 0], "velocity": [0, 1.5, 0]}
    answer = solve_scene(read(on_table(body, 3, 0.5)), [0.0, 0.7], ["trajectory", "forces-in-time"])
    assert [phase.states for phase in answer.phases] == [{"table": "stick"}]
    turned = 3 * 0.7
    place = [0.5 * math.cos(turned), 0.5 * math.sin(turned), 0]
    assert column(answer, "b.position").values[1] == pytest.approx(place, abs=1e-14)
    friction = [column(answer, f"table.friction.{x}").values[1] for x in "xyz"]
    assert friction == pytest.approx([-2 * 9 * x for x in place], abs=1e-12)


def test_a_box_that_is_held_goes_round_with_the_table() -> None:
    """How its corners share the load is not determined; the sums of their forces are."""
    shape = {"kind": "box", "width": 0.2, "height": 0.1, "depth": 0.1}
    body = {"mass": 1, "shape": shape, "at": [0.5, 0, 0.05], "velocity": [0, 1, 0], "angular_velocity": [0, 0, 2]}
    answer = solve_scene(read(on_table(body, 2, 0.5)), [0.3], [*DEFAULT_OUTPUTS, "forces-in-time"])
    assert column(answer, "b.position").values[0] == pytest.approx([0.5 * math.cos(0.6), 0.5 * math.sin(0.6), 0.05])
    assert answer.forces is not None
    assert answer.forces["table.1.normal"].value is None
    assert [answer.forces[f"table.{x}"].value for x in ("normal", "friction.x")] == pytest.approx([G, -2], rel=1e-13)


@pytest.mark.parametrize("rate", [5, -5])
def test_a_coin_that_is_not_held_slides_outwards(rate: float) -> None:
    """By Newton's law with mu g against the slip v - W x r, by scipy."""
    body = {"mass": 2, "at": [0.5, 0, 0], "velocity": [0, 0.5, 0]}
    answer = solve_scene(read(on_table(body, rate, 0.3)), [0.4], ["trajectory"])

    def rates(_: float, state: Any) -> Any:
        slip = state[2:] - rate * np.array([-state[1], state[0]])
        return np.concatenate([state[2:], -0.3 * G * slip / np.linalg.norm(slip)])

    found = solve_ivp(rates, (0.0, 0.4), [0.5, 0, 0, 0.5], method="DOP853", rtol=1e-13, atol=1e-15)
    assert column(answer, "b.position").values[0][:2] == pytest.approx(found.y[:2, -1], abs=1e-10)


@pytest.mark.parametrize(
    "body",
    [
        {"mass": 1, "radius": 0.1, "moments": [0.004] * 3, "at": [1, 0, 0.1], "velocity": [0.3, 0.5, 0]},
        {
            "mass": 1,
            "shape": {"kind": "disc", "radius": 0.1},
            "at": [1, 0, 0.08],
            "axes": [[1, 0, 0], [0, -0.6, 0.8], [0, -0.8, -0.6]],
            "angular_velocity": [0.2, 1, 9],
        },
    ],
    ids=["ball", "coin"],
)
def test_what_sticks_on_a_turntable_rolls_on_it(body: dict[str, Any]) -> None:
    rolling = on_table(body, 2, None)
    del rolling["connections"][0]["friction"]
    rolling["connections"][0]["kind"] = "rolling"
    first = solve_scene(read(rolling), [0.0, 0.6], ["trajectory", "forces-in-time"])
    start = column(first, "b.velocity").values[0].tolist()
    spin = {"angular_velocity": column(first, "b.angular_velocity").values[0].tolist()} if "shape" in body else {}
    if not spin:
        # What a ball turns with where it rolls: (v - W x r) = R w x n.
        slip = np.array(start) - 2 * np.array([-body["at"][1], body["at"][0], 0])
        spin = {"angular_velocity": [-float(slip[1]) / 0.1, float(slip[0]) / 0.1, 0]}
    second = solve_scene(read(on_table(body | {"velocity": start} | spin, 2, [50, 20])), [0.0, 0.6], ["trajectory"])
    one, other = column(first, "b.position"), column(second, "b.position")
    assert one.values[1] == pytest.approx(other.values[1], abs=1e-9)


@pytest.mark.parametrize(
    ("body", "more"),
    [
        ({"mass": 1, "at": [0.5, 0.1, 0], "velocity": [0, 0.5, 0]}, {}),
        ({"mass": 1, "radius": 0.1, "moments": [0.004] * 3, "at": [0.5, 0, 0.3]}, {"restitution": 0.5}),
    ],
    ids=["slides", "lands and bounces"],
)
def test_the_plain_engine_agrees(body: dict[str, Any], more: dict[str, Any]) -> None:
    verdict = compared(on_table(body, 4, 0.3, **more), [0.0, 0.2, 0.4])
    assert verdict.differences == []
    assert not verdict.not_supported
    assert verdict.compared > 0
