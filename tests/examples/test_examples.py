"""Every example is answered, and what it is there to show is so."""

from __future__ import annotations

import json
import math
import sys
from pathlib import Path

import numpy as np
import pytest

from examples import ask
from examples.ask import names, path_of, request_of
from tests.core.bodies.example_bodies import deck_of_cards, t_handle_points

ROOT = Path(__file__).parents[2]
REFUSED = {"rotation/ensemble/thirty-starts-overflow": ("invalid-parameter", "/method/step")}
MOMENTS = np.array([2.0, 1.0, 0.5])
G = 9.81


@pytest.mark.parametrize("name", names())
def test_it_goes_to_an_endpoint_and_is_answered_as_intended(answer_of, name):
    assert path_of(name) in json.loads((ROOT / "docs" / "openapi.json").read_text())["paths"]
    answer = answer_of(name)
    if name in REFUSED:
        assert (answer["code"], answer["errors"][0]["pointer"]) == REFUSED[name]
    else:
        assert answer.get("signature", {}).get("source") == "polhode", answer


def test_the_script_prints_the_answer(service, monkeypatch, capsys):
    monkeypatch.setattr(sys, "argv", ["ask", "rotation/wobble/chandler", "--service", service])
    ask.main()
    assert json.loads(capsys.readouterr().out)["rotations"] == 430.0


@pytest.mark.parametrize(
    ("name", "start"),
    [("rotation/trajectory/aligned-start", [0.0, 0.0, 1.0]), ("rotation/trajectory/sphere", [3.0, 2.0, 1.0])],
)
def test_a_steady_rotation_does_not_change_in_any_bit(answer_of, name, start):
    answer = answer_of(name)
    assert answer["angular_velocity"] == 1000 * [start]
    assert answer["model"]["degrees_of_freedom"] == 0
    assert answer["accuracy"]["error"] == 0.0


def sine_and_cosine(request):
    """Return the motion of a body of moments (I1, I, I): w2 + i w3 turns at (I1 - I)/I w1."""
    i1, i, _ = request["body"]["moments"]
    w1, w2, w3 = request["angular_velocity"]
    span = request["times"]
    times = np.linspace(span["start"], span["stop"], span["count"])
    turned = (w2 + 1j * w3) * np.exp(1j * (i1 - i) / i * w1 * times)
    return np.stack([np.full_like(times, w1), turned.real, turned.imag], axis=1)


@pytest.mark.parametrize("kind", ["symmetric", "oblate", "prolate"])
def test_symmetric_bodies_move_as_sine_and_cosine(answer_of, kind):
    name = f"rotation/trajectory/{kind}"
    exact = sine_and_cosine(json.loads(request_of(name)))
    answer = answer_of(name)
    assert answer["method"] == "closed-form"
    np.testing.assert_allclose(answer["angular_velocity"], exact, rtol=0, atol=4e-14)


@pytest.mark.parametrize("kind", ["oblate", "prolate"])
def test_what_is_said_of_explicit_euler_is_the_distance_from_the_closed_form(answer_of, kind):
    name = f"rotation/trajectory/{kind}"
    exact = sine_and_cosine(json.loads(request_of(name)))
    answer = answer_of(name + "-euler")
    true = np.linalg.norm(answer["angular_velocity"] - exact, axis=1).max() / np.linalg.norm(exact[0])
    assert answer["accuracy"]["how"] == "measured against closed form"
    assert answer["accuracy"]["error"] == pytest.approx(true, rel=1e-9)
    assert "accuracy-not-reached" in [notice["code"] for notice in answer["warnings"]]


def test_thirty_starts_stay_on_their_energy_and_momentum(answer_of):
    answer = answer_of("rotation/ensemble/thirty-starts")
    states = np.array(answer["angular_velocity"])
    assert states.shape == (30, 10_000, 3)
    starts = np.array(answer_of("rotation/initial-states/thirty-starts")["angular_velocities"])
    away = np.linalg.norm(states[:, 0] - starts, axis=1)
    assert (away <= answer["error"] * np.linalg.norm(states, axis=2).max(axis=1)).all()
    np.testing.assert_allclose(0.5 * (MOMENTS * states**2).sum(axis=2), 1.0, rtol=5e-15)
    squares = ((MOMENTS * states) ** 2).sum(axis=2)
    np.testing.assert_allclose(squares, squares[:, :1] * np.ones(10_000), rtol=1e-14)


def test_the_starts_are_uniform_over_the_unscaled_sphere(answer_of):
    starts = np.array(answer_of("rotation/initial-states/thirty-starts")["angular_velocities"])
    unit = starts * np.sqrt(MOMENTS / 2.0)
    np.testing.assert_allclose(np.linalg.norm(unit, axis=1), 1.0, rtol=1e-15 * 4)
    # Of thirty uniform directions the mean is shorter than 0.45 with a probability of 0.9999.
    assert np.linalg.norm(unit.mean(axis=0)) < 0.45


def test_every_polhode_lies_on_both_ellipsoids(answer_of):
    answer = answer_of("rotation/energy-ellipsoid/source-surface")
    starts = np.array(answer_of("rotation/initial-states/thirty-starts")["angular_velocities"])
    assert len(answer["polhodes"]) == 30
    for curve, start in zip(answer["polhodes"], starts, strict=True):
        points = np.array(curve["points"])
        assert curve["closed"]
        assert points[0].tolist() == points[-1].tolist()
        np.testing.assert_allclose((MOMENTS * points**2).sum(axis=1), 2.0, rtol=1e-14)
        momentum = ((MOMENTS * start) ** 2).sum()
        np.testing.assert_allclose(((MOMENTS * points) ** 2).sum(axis=1), momentum, rtol=1e-14)


def test_the_separatrix_has_the_middle_axis_momentum_and_the_grid_the_energy(answer_of):
    answer = answer_of("rotation/energy-ellipsoid/source-surface")
    for curve in answer["separatrix"]:
        points = np.array(curve["points"])
        np.testing.assert_allclose(((MOMENTS * points) ** 2).sum(axis=1), 2.0 * 1.0, rtol=1e-14)
    grid = np.stack([answer["grid"][axis] for axis in "xyz"])
    assert grid.shape == (3, 40, 20)
    np.testing.assert_allclose(np.einsum("i,ijk->jk", MOMENTS, grid**2), 2.0, rtol=1e-14)


def test_the_points_of_the_t_handle_are_the_lesson_s():
    points = t_handle_points()
    for name in ("t-handle", "rotation/trajectory/t-handle-pinned", "bodies/mass-properties/t-handle"):
        body = json.loads(request_of(name))["body"]
        assert body["masses"] == points.masses
        assert np.array_equal(body["positions"], points.positions)


def test_the_t_handle_turns_over_at_its_flip_interval(answer_of):
    answer = answer_of("t-handle")
    middle = np.array(answer["angular_velocity"])[:, 1]
    time = np.array(answer["time"])
    crossed = np.flatnonzero(middle[:-1] * middle[1:] < 0.0)
    share = middle[crossed] / (middle[crossed] - middle[crossed + 1])
    crossings = time[crossed] + share * (time[crossed + 1] - time[crossed])
    assert len(crossings) == 8
    np.testing.assert_allclose(np.diff(crossings), 2.453763074, rtol=0, atol=2e-7)


def test_flips_agree_between_trajectory_and_stability(answer_of):
    free, stable = answer_of("t-handle"), answer_of("rotation/stability/t-handle")
    assert stable["flip"]["interval"] == pytest.approx(free["flip_interval"], rel=1e-13)


def test_only_the_middle_axis_of_the_deck_is_unstable_and_none_of_the_coin_s_flips(answer_of):
    deck, coin = answer_of("rotation/stability/deck-of-cards"), answer_of("rotation/stability/coin")
    assert json.loads(request_of("bodies/mass-properties/deck-of-cards"))["body"] == {
        "kind": "cuboid", "edges": list(deck_of_cards().edges), "mass": deck_of_cards().mass,
    }  # fmt: skip
    assert [x["kind"] for x in deck["equilibria"]] == ["center", "saddle", "center", "degenerate"]
    assert [x["stable"] for x in deck["equilibria"]] == [True, False, True, True]
    assert "saddle" not in [x["kind"] for x in coin["equilibria"]]
    assert coin["flip"] is None


def test_the_pinned_t_handle_is_said_not_to_be_free(answer_of):
    codes = {name: [notice["code"] for notice in answer_of(name)["warnings"]] for name in names() if "t-handle" in name}
    assert {name for name, found in codes.items() if "not-free" in found} == {
        "rotation/trajectory/t-handle-pinned",
        "rotation/trajectory/t-handle-pinned-euler",
    }


def test_the_rod_keeps_its_energy_and_the_forces_of_release(answer_of):
    answer = answer_of("scenes/rod-in-hole/swing")
    rate, angle = np.array(answer["trajectory"]["angular_velocity"]), np.array(answer["trajectory"]["angle"])
    k, inertia = math.sqrt(0.75), 1 - 1 / 6
    energy = inertia * rate**2 / 2 - G * k * np.cos(angle)
    np.testing.assert_allclose(energy, -G * k / 2, rtol=0, atol=1e-13)
    lower, upper = G * (16 - 3) / (8 * k * 5), G * (8 - 1) / (8 * k * 5)
    assert answer["forces_at_release"] == pytest.approx([upper, lower], rel=1e-13)
    assert answer["contact"]["kept"]


def test_the_shafts_stop_when_a_string_has_run_out(answer_of):
    answer = answer_of("scenes/unwinding-shafts/until-unwound")
    (event,), trajectory = answer["events"], answer["trajectory"]
    assert answer["ended"] == event["kind"] == "string-2-unwound"
    assert trajectory["time"][-1] <= event["time"]
    x, x0, time = np.array(trajectory["positions"]), np.array([1.0, 1.5]), np.array(trajectory["time"])
    np.testing.assert_allclose(x, x0 + 0.5 * np.array(answer["accelerations"]) * time[:, None] ** 2, rtol=1e-14)


def test_the_chain_obeys_its_equation(answer_of):
    answer = answer_of("scenes/chain-on-wedge/sliding")
    time, x = np.array(answer["trajectory"]["time"]), np.array(answer["trajectory"]["position"])
    k, center = answer["growth_rate"], answer["equilibrium"]
    np.testing.assert_allclose(x, center + (1.0 - center) * np.cosh(k * time), rtol=1e-14)
