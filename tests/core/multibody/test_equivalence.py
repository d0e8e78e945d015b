"""The same scene described in two ways has the same answer."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from core.multibody.answer import SceneSolution
from core.multibody.solve import solve_scene
from tests.core.multibody.random_scenes import pendulum_of_points, pendulum_of_rods
from tests.core.multibody.worked_examples import MASSIVE_PULLEY, column, force, read

TIMES = np.array([0.3, 0.9, -0.4])
seeds = st.integers(0, 10**6)
few = settings(max_examples=12)


def chain(seed: int) -> dict[str, Any]:
    random = np.random.default_rng(seed)
    return pendulum_of_points(random, 2) if seed % 2 else pendulum_of_rods(random, 2)


def answered(description: dict[str, Any], times: Any = TIMES) -> SceneSolution:
    return solve_scene(read(description), times, ("trajectory", "forces", "energy"))


def bodies(description: dict[str, Any]) -> list[str]:
    return list(description["bodies"])


def same(first: Any, second: Any, error: float) -> bool:
    return bool(np.max(np.abs(np.asarray(first) - np.asarray(second))) <= error)


@few
@given(seeds)
def test_names_do_not_matter(seed: int) -> None:
    import json

    given_ = chain(seed)
    text = json.dumps(given_)
    for old, new in (("p0", "zeta"), ("b0", "zeta"), ("p1", "alpha"), ("b1", "alpha")):
        text = text.replace(f'"{old}"', f'"{new}"').replace(f'"{old}.', f'"{new}.')
    renamed = json.loads(text)
    first, second = answered(given_), answered(renamed)
    for old, new in zip(bodies(given_), bodies(renamed), strict=True):
        assert np.array_equal(column(first, f"{old}.position").values, column(second, f"{new}.position").values)


@few
@given(seeds, st.integers(-8, 8), st.integers(-8, 8), st.integers(-8, 8))
def test_units_of_powers_of_two_do_not_matter_to_a_bit(seed: int, length: int, mass: int, time: int) -> None:
    given_ = pendulum_of_points(np.random.default_rng(seed), 2)
    scaled = pendulum_of_points(np.random.default_rng(seed), 2)
    for body in scaled["bodies"].values():
        body["mass"] = f"{body['mass']}*{2.0**mass}"
        body["at"] = [f"({x})*{2.0**length}" for x in body["at"]]
        body["velocity"] = [f"({x})*{2.0**length}/{2.0**time}" for x in body["velocity"]]
    scaled["gravity"] = [0, f"-9.81*{2.0**length}/{2.0**time}/{2.0**time}"]
    first, second = answered(given_), answered(scaled, TIMES * 2.0**time)
    for name in bodies(given_):
        place = column(first, f"{name}.position").values * 2.0**length
        assert np.array_equal(place, column(second, f"{name}.position").values)
    for name in ("r0.force", "r1.force"):
        factor = 2.0 ** (mass + length - 2 * time)
        assert force(first, name) * factor == force(second, name)
    assert first.energy is not None
    assert second.energy is not None
    assert first.energy.kinetic * 2.0 ** (mass + 2 * length - 2 * time) == second.energy.kinetic


@few
@given(seeds, st.sampled_from(["turned", "mirrored", "moved"]))
def test_where_a_scene_stands_does_not_matter(seed: int, how: str) -> None:
    given_ = pendulum_of_points(np.random.default_rng(seed), 2)
    changed = pendulum_of_points(np.random.default_rng(seed), 2)

    def vector(v: list[Any], *, free: bool) -> list[Any]:
        x, y = v
        if how == "turned":
            return [f"-({y})", x]
        if how == "mirrored":
            return [f"-({x})", y]
        return v if free else [f"{x} + 0.7", f"{y} - 2"]

    changed["gravity"] = vector(changed["gravity"], free=True)
    for body in changed["bodies"].values():
        body["at"] = vector(body["at"], free=False)
        body["velocity"] = vector(body["velocity"], free=True)
    changed["connections"][0]["b"] = vector([0, 0], free=False)
    first, second = answered(given_), answered(changed)
    for name in bodies(given_):
        a, b = column(first, f"{name}.position"), column(second, f"{name}.position")
        x, y = a.values[:, 0], a.values[:, 1]
        expected = {"turned": (-y, x), "mirrored": (-x, y), "moved": (x + 0.7, y - 2)}[how]
        assert same(np.stack(expected, axis=1), b.values, a.error + b.error)
    for name in ("r0.force", "r1.force"):
        assert force(first, name) == pytest.approx(force(second, name), rel=1e-14, abs=1e-13)


@few
@given(seeds)
def test_a_rod_through_a_place_of_a_body_is_a_pin(seed: int) -> None:
    """A point at the end of a weightless rod, and the same as a rigid body without inertia."""
    given_ = pendulum_of_points(np.random.default_rng(seed), 1)
    body = given_["bodies"]["p0"]
    held = {
        **given_,
        "bodies": {"p0": {**body, "inertia": 0, "places": {"top": [f"-({x})" for x in body["at"]]}}},
        "connections": [{"kind": "pin", "name": "r0", "a": "p0.top", "b": [0, 0]}],
    }
    first, second = answered(given_), answered(held)
    a, b = column(first, "p0.position"), column(second, "p0.position")
    assert same(a.values, b.values, a.error + b.error)
    assert first.period == second.period or first.period == pytest.approx(second.period or 0, rel=1e-15)


@few
@given(st.integers(1, 9), st.integers(1, 9), st.integers(1, 40))
def test_a_string_through_more_places_and_a_pulley_elsewhere(a: int, b: int, up: int) -> None:
    def machine(height: float, through: list[Any]) -> dict[str, Any]:
        return {
            "gravity": [0, -9.81],
            "bodies": {"a": {"mass": a, "at": [0, -1]}, "b": {"mass": b, "at": [0.5, -2]}},
            "connections": [{"kind": "string", "name": "s", "through": through}],
        }

    short = answered(machine(0, ["a", [0, 0], [0.5, 0], "b"]))
    high = answered(machine(0, ["a", [0, f"{up}/10"], [0.5, f"{up}/10"], "b"]))
    split = answered(machine(0, ["a", [0, "-0.3"], [0, 0], [0.25, 0], [0.5, 0], "b"]))
    for other in (high, split):
        assert force(other, "s.tension") == force(short, "s.tension")
        if other.ended is None and short.ended is None:
            assert np.array_equal(column(other, "a.position").values, column(short, "a.position").values)


def test_a_pulley_does_not_care_which_end_of_its_string_is_first() -> None:
    turned = MASSIVE_PULLEY.replace('["a","wheel","b"]', '["b","wheel","a"]').replace(
        '["left","right"]', '["right","left"]'
    )
    first, second = solve_scene(read(MASSIVE_PULLEY)), solve_scene(read(turned))
    assert force(first, "s.1.tension") == force(second, "s.2.tension")
    assert first.accelerations == second.accelerations
