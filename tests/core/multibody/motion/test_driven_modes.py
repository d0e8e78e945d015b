"""Linear scenes that formulas of time drive, against closed forms: at any time, at resonance, after an impact."""

from __future__ import annotations

from collections.abc import Callable
from fractions import Fraction
from typing import Any

import mpmath as mp
import numpy as np
import pytest

from core.multibody.answer import SceneSolution
from core.multibody.language.reading import scene_from
from core.multibody.proven.proven_answer import proven_answer
from core.multibody.solve import solve_scene

TIMES = [0.0, 0.75, 3.0, 20.0, 1e4]
RAIL: dict[str, Any] = {"kind": "track", "place": "p", "on": {"at": [0, 0], "slope": 0}}
SPRING: dict[str, Any] = {"kind": "spring", "a": "p", "b": [0, 0], "stiffness": 9, "rest_length": 0}


def on_rail(*connections: dict[str, Any], at: Any = "0.5") -> dict[str, Any]:
    return {"bodies": {"p": {"mass": 1, "at": [at, 0]}}, "connections": [RAIL, *connections]}


def force(formula: str) -> dict[str, Any]:
    return {"kind": "force", "name": "drive", "place": "p", "force": [formula, 0]}


def require(scene: dict[str, Any], exact: Callable[[Any], Any], times: list[float] = TIMES) -> SceneSolution:
    """Require modes whose places are exact ones, and an error no less than the true one."""
    found = solve_scene(scene_from(scene), times)
    assert found.model.name == "modes"
    assert found.trajectory is not None
    place = found.trajectory.columns["p.position"]
    with mp.workdps(50):
        wanted = np.array([float(exact(mp.mpf(t))) for t in times])
    assert np.max(np.abs(place.values[:, 0] - wanted)) <= place.error < 1e-10
    return found


# x'' + 9 x = f: x = x_p + (1/2 - x_p(0)) cos 3t - x_p'(0)/3 sin 3t.
@pytest.mark.parametrize(
    ("formula", "particular"),
    [
        ("cos(2*t)", lambda t: mp.cos(2 * t) / 5),
        ("2*sin(2*t + pi/3) - 1", lambda t: 2 * mp.sin(2 * t + mp.pi / 3) / 5 - mp.mpf(1) / 9),
        ("sin(t)*cos(4*t)", lambda t: mp.sin(5 * t) / 2 / (9 - 25) - t * -mp.cos(3 * t) / 12),
        ("cos(3*t)", lambda t: t * mp.sin(3 * t) / 6),
        ("sin(t)^2", lambda t: mp.mpf(1) / 18 - mp.cos(2 * t) / 10),
        ("18*t - 9", lambda t: 2 * t - 1),
        ("exp(-t)", lambda t: mp.exp(-t) / 10),
        ("exp(-t/100)*cos(2*t)", lambda t: mp.re(mp.exp((2j - mp.mpf("0.01")) * t) / (9 + (2j - mp.mpf("0.01")) ** 2))),
        ("cos(2*t) + sin(2*t) + cos(2*t + 1)", lambda t: (mp.cos(2 * t) + mp.sin(2 * t) + mp.cos(2 * t + 1)) / 5),
    ],
)
def test_a_driven_oscillator_has_its_closed_form_at_any_time(
    formula: str, particular: Callable[[mp.mpf], mp.mpf]
) -> None:
    def exact(t: mp.mpf) -> mp.mpf:
        value, rate = particular(mp.mpf(0)), mp.diff(particular, 0)
        return particular(t) + (mp.mpf("0.5") - value) * mp.cos(3 * t) - rate / 3 * mp.sin(3 * t)

    found = require(on_rail(SPRING, force(formula)), exact)
    assert [(mode.frequency, mode.growth_rate) for mode in found.model.apart[-1].modes] == [(3.0, 0.0)]


def test_a_support_that_shakes_drives_modes() -> None:
    """x'' = -9 (x - 0.1 sin(2t + 1/2)), with the wheel of its sine turned before the start."""
    scene = on_rail(SPRING | {"b": ["0.1*sin(2*t + 1/2)", 0]})

    def particular(t: mp.mpf) -> mp.mpf:
        return mp.mpf("0.9") * mp.sin(2 * t + mp.mpf("0.5")) / 5

    def exact(t: mp.mpf) -> mp.mpf:
        return (
            particular(t)
            + (mp.mpf("0.5") - particular(0)) * mp.cos(3 * t)
            - mp.mpf("0.9") * 2 / 15 * mp.cos(mp.mpf("0.5")) * mp.sin(3 * t)
        )

    require(scene, exact)


def test_a_body_on_a_driven_cart_feels_its_accelerations() -> None:
    """The cart is another body whose place is a formula: x'' = -9 (x - sin(2t)/5)."""
    scene = on_rail(SPRING | {"b": "cart"})
    scene["bodies"]["cart"] = {"mass": 4, "at": [0, 0]}
    scene["connections"] += [
        RAIL | {"place": "cart"},
        {"kind": "relation", "of": "cart.x", "equals": "sin(2*t)/5"},
    ]
    require(
        scene,
        lambda t: mp.mpf("9") * mp.sin(2 * t) / 25 + mp.cos(3 * t) / 2 - mp.mpf("6") * mp.sin(3 * t) / 25,
    )


def test_places_that_push_without_a_potential_are_modes() -> None:
    """z'' = -(1 - i/2) z for z = x + i y."""
    scene = {
        "bodies": {"p": {"mass": 1, "at": [1, 0]}},
        "connections": [{"kind": "force", "place": "p", "force": ["-x - y/2", "-y + x/2"]}],
    }
    found = require(scene, lambda t: mp.re(mp.cos(mp.sqrt(1 - mp.mpc(0, 0.5)) * t)), [0.0, 1.0, 10.0])
    assert len(found.model.apart[-1].modes) == 2


def test_crossed_fields_make_a_cycloid() -> None:
    """q E/m = 1 along x, q B/m = 2: x = (1 - cos 2t)/4."""
    scene = {
        "bodies": {"p": {"mass": 1, "at": [0, 0]}},
        "connections": [{"kind": "field", "force": ["1 + 2*vy", "-2*vx"]}],
    }
    require(scene, lambda t: (1 - mp.cos(2 * t)) / 4, [0.0, 1.0, 10.0, 1e4])


def test_what_drives_goes_on_after_an_impact() -> None:
    """A ball under 15 - 2 t and g = 10 rises until t = 5, falls back, and the formula counts from the start still."""
    scene = {
        "gravity": [0, -10],
        "bodies": {"p": {"mass": 1, "at": [0, 0]}},
        "connections": [
            {"kind": "contact", "name": "floor", "place": "p", "on": {"at": [0, 0]}, "restitution": 0.5},
            {"kind": "force", "place": "p", "force": [0, "15 - 2*t + 0*sin(t) + cos(t)*0"]},
        ],
    }
    found = solve_scene(scene_from(scene), [8.0])
    touch = found.events[0]
    # y = 5 t^2/2 - t^3/3.
    assert (touch.kind, touch.time) == ("touch", pytest.approx(7.5, rel=1e-15))
    assert found.trajectory is not None
    speed = (5 * 7.5 - 7.5**2) * -0.5
    tau = 0.5
    height = speed * tau + (5 - 2 * 7.5) * tau**2 / 2 - tau**3 / 3
    assert found.trajectory.columns["p.position"].values[0, 1] == pytest.approx(height, abs=1e-13)


def test_a_formula_that_stays_constant_is_constant_acceleration() -> None:
    found = solve_scene(scene_from(on_rail(force("3 + 0*x"))), [2.0])
    assert found.model.name == "constant acceleration"
    assert found.trajectory is not None
    assert found.trajectory.columns["p.position"].values[0, 0] == 6.5


def test_digits_of_a_driven_oscillator_are_proven() -> None:
    proven = proven_answer(scene_from(on_rail(SPRING, force("cos(3*t)"))), 40, [Fraction(7)], ("trajectory",))
    assert proven.columns is not None
    with mp.workdps(60):
        exact = mp.cos(21) / 2 + mp.mpf(7) * mp.sin(21) / 6
        assert abs(mp.mpf(proven.columns["p.position"].values[0][0]) - exact) < mp.mpf(10) ** -40


@pytest.mark.parametrize(
    ("formula", "place", "frequency"), [("18 - 2*vx", 2.0, 8**0.5), ("7*x + 1", 0.5, 2**0.5), ("0*vx - 7*x", 0.0, 4.0)]
)
def test_linear_formulas_have_equilibria(formula: str, place: float, frequency: float) -> None:
    found = solve_scene(scene_from(on_rail(SPRING, force(formula))), outputs=("equilibria",))
    assert found.equilibria is not None
    (one,) = found.equilibria
    assert one.positions["p"][0] == pytest.approx(place, abs=1e-15)
    assert [mode.frequency for mode in one.modes] == [pytest.approx(frequency, rel=1e-14)]


def driven_pair(name: str, x: float, rate: float) -> tuple[dict[str, Any], list[dict[str, Any]]]:
    """Return a bar that a motor turns about a point, and one welded to its end, whose angle is no coordinate."""
    places = {"top": [-0.5, 0], "end": [0.5, 0]}
    bar = {"mass": 1, "inertia": 0.1, "at": [x + 0.5, 0], "places": places}
    other = {"mass": 0.5, "inertia": 0.05, "at": [x + 1, -0.5], "angle": "-pi/2", "places": places}
    connections: list[dict[str, Any]] = [
        {"kind": "pin", "a": f"{name}1.top", "b": [x, 0]},
        {"kind": "motor", "a": f"{name}1", "rate": rate},
        {"kind": "weld", "a": f"{name}2.top", "b": f"{name}1.end"},
    ]
    return {f"{name}1": bar, f"{name}2": other}, connections


@pytest.mark.parametrize("rates", [(-2,), (-2, -2), (-2, 5), (3, -3)])
def test_what_is_welded_to_driven_bars_turns_with_them(rates: tuple[float, ...]) -> None:
    """Alone at any time; of two that a spring of no length couples, at different rates, as far as turns are counted."""
    bodies: dict[str, Any] = {}
    connections: list[dict[str, Any]] = []
    for name, x, rate in zip("ab", (0, 4), rates, strict=False):
        own, held = driven_pair(name, x, rate)
        bodies |= own
        connections += held
    if len(rates) > 1:
        connections.append({"kind": "spring", "a": "a2.end", "b": "b2.end", "stiffness": 3, "rest_length": 0})
    found = solve_scene(scene_from({"gravity": [0, -10], "bodies": bodies, "connections": connections}), TIMES)
    assert found.trajectory is not None
    for name, rate in zip("ab", rates, strict=False):
        column = found.trajectory.columns[f"{name}2.angle"]
        wanted = np.array([-np.pi / 2 + rate * t for t in TIMES])
        assert np.max(np.abs(column.values - wanted)) <= column.error + np.spacing(np.abs(wanted).max())
        assert column.error < 1e-9
