"""Places where connections lose their rank: every route says that the motion ends there."""

from __future__ import annotations

from collections.abc import Mapping
from fractions import Fraction
from typing import Any

import mpmath as mp
import numpy as np
import pytest

from core.balls import precision
from core.errors import AccuracyUnreachable
from core.multibody.algebra.polynomials import BITS
from core.multibody.language.reading import scene_from
from core.multibody.motion.lost_rank import UNKNOWN, first_lost, lines_that_may_depend
from core.multibody.motion.modelling import Modelled, modelled
from core.multibody.motion.numerical import Numerical
from core.multibody.proven.proven_answer import proven_answer
from core.multibody.solve import solve_scene
from core.systems.methods.runge_kutta_4 import RungeKutta4

Json = dict[str, Any]

CRANKS: Json = {
    "gravity": [0, -10],
    "bodies": {
        "a": {"mass": 1, "at": ["0.6", "-0.8"], "velocity": [4, 3]},
        "b": {"mass": 1, "at": ["1.6", "-0.8"], "velocity": [4, 3]},
    },
    "connections": [
        {"kind": "rod", "a": "a", "b": [0, 0]},
        {"kind": "rod", "a": "b", "b": [1, 0]},
        {"kind": "rod", "name": "coupler", "a": "a", "b": "b"},
    ],
}
"""A parallelogram, which moves as a pendulum does until its bars are in one line."""
SLIDER: Json = {
    "gravity": [0, -10],
    "bodies": {
        "a": {"mass": 1, "at": ["0.6", "0.8"], "velocity": ["-1.6", "1.2"]},
        "b": {"mass": 1, "at": ["1.2", 0], "velocity": ["-3.2", 0]},
    },
    "connections": [
        {"kind": "rod", "a": "a", "b": [0, 0]},
        {"kind": "rod", "a": "a", "b": "b"},
        {"kind": "track", "place": "b", "on": {"at": [0, 0]}},
    ],
}
"""Crank and rod are as long as one another: upright the slider may stay, or go on."""


HUMPS: Json = {
    "gravity": [0, -10],
    "bodies": {"a": {"mass": 1, "at": ["0.6", "0.8"]}, "b": {"mass": 1, "at": ["4.6", "3.8"]}},
    "connections": [
        {"kind": "contact", "place": "a", "on": {"at": [0, 0], "radius": 1}},
        {"kind": "contact", "place": "b", "on": {"at": [4, 3], "radius": 1}},
        {"kind": "rod", "a": "a", "b": "b"},
    ],
}
"""Contacts that hold, instead of two of the bars: before they open, the stones are in line with the rod."""


def stone_in_line() -> Any:
    """Return when a stone that slides from rest at a height of 0.8 is at a height of 0.6: energy, as an integral."""
    with mp.workdps(30):
        # The way is taken as s^2, or the integral had a pole at rest.
        start, end = mp.acos(mp.mpf("0.8")), mp.acos(mp.mpf("0.6"))
        return mp.quad(
            lambda s: 2 * s / mp.sqrt(40 * mp.sin(start + s * s / 2) * mp.sin(s * s / 2)), [0, mp.sqrt(end - start)]
        )


def pendulum_level() -> Any:
    """Return when a pendulum of 1 m is level that passes 53 degrees below with 5 m/s: energy, as an integral."""
    with mp.workdps(30):
        energy = mp.mpf(25) / 2 - 8
        return mp.quad(lambda angle: 1 / mp.sqrt(2 * (energy - 10 * mp.sin(angle))), [-mp.asin(mp.mpf("0.8")), 0])


def crank_upright() -> Any:
    """Return when the crank is upright: of T = (1 + 4 sin^2) angle'^2 / 2, as an integral."""
    with mp.workdps(30):
        energy = 2 * (1 + 4 * mp.mpf("0.64")) + 8
        return mp.quad(
            lambda angle: mp.sqrt((1 + 4 * mp.sin(angle) ** 2) / (2 * (energy - 10 * mp.sin(angle)))),
            [mp.asin(mp.mpf("0.8")), mp.pi / 2],
        )


def turned(scene: Json) -> Json:
    """Return a scene turned by acos(3/5)."""

    def turn(vector: list[Any]) -> list[str]:
        x, y = vector
        return [f"0.6*({x}) - 0.8*({y})", f"0.8*({x}) + 0.6*({y})"]

    bodies = {
        name: {key: turn(x) if isinstance(x, list) else x for key, x in one.items()}
        for name, one in scene["bodies"].items()
    }
    connections = []
    for one in scene["connections"]:
        one = {key: turn(x) if isinstance(x, list) else x for key, x in one.items()}
        if "on" in one:
            one["on"] = {"at": [0, 0], "slope": "atan(4/3)"}
        connections.append(one)
    return {"gravity": turn(scene["gravity"]), "bodies": bodies, "connections": connections}


def beside_a_ball(scene: Json, *, first: bool) -> Json:
    contact = [{"kind": "contact", "place": "ball", "on": {"at": [7, -2]}, "restitution": 0.5}]
    connections = [*contact, *scene["connections"]] if first else [*scene["connections"], *contact]
    return {**scene, "bodies": {**scene["bodies"], "ball": {"mass": 1, "at": [7, 1]}}, "connections": connections}


def with_a_floor(scene: Json) -> Json:
    """Return a scene whose first body might touch a floor, so that its motion is one in phases."""
    floor = {"kind": "contact", "place": "a", "on": {"at": [0, -3]}}
    return {**scene, "connections": [*scene["connections"], floor]}


@pytest.mark.parametrize(
    ("scene", "right"),
    [
        (CRANKS, pendulum_level()),
        (turned(CRANKS), pendulum_level()),
        (with_a_floor(CRANKS), pendulum_level()),
        (beside_a_ball(CRANKS, first=True), pendulum_level()),
        (beside_a_ball(CRANKS, first=False), pendulum_level()),
        (SLIDER, crank_upright()),
        (turned(SLIDER), crank_upright()),
        (with_a_floor(SLIDER), crank_upright()),
        (HUMPS, stone_in_line()),
    ],
)
def test_a_motion_ends_where_bars_come_into_line(scene: Json, right: Any) -> None:
    found = solve_scene(scene_from(scene), [0.0, 0.1, 2.0], ("trajectory",))
    assert found.ended is not None
    assert found.ended.kind == "singular"
    assert abs(found.ended.time - right) <= found.ended.error < 1e-8
    assert found.trajectory is not None
    assert np.array_equal(found.trajectory.time, [0.0, 0.1])


def test_it_ends_so_before_the_start() -> None:
    back = {name: {**one, "velocity": [-4, -3]} for name, one in CRANKS["bodies"].items()}
    found = solve_scene(scene_from({**CRANKS, "bodies": back}), [-1.0, 0.0], ("trajectory",))
    assert [event.kind for event in found.events] == ["singular"]
    assert abs(found.events[0].time + pendulum_level()) <= found.events[0].error


def test_methods_and_proven_digits_end_there() -> None:
    found = solve_scene(scene_from(CRANKS), [0.0, 0.2, 0.3], ("trajectory",), method=RungeKutta4(step=0.01))
    assert found.ended is not None
    assert found.ended.kind == "singular"
    proven = proven_answer(scene_from(CRANKS), 16, [Fraction(1, 10), Fraction(3, 10)])
    assert (proven.rows, proven.ended) == ([0], "singular")


@pytest.mark.parametrize("longer", ["1e-3", "1e-9"])
def test_bars_that_only_nearly_come_into_line_go_on(longer: str) -> None:
    bodies = {"a": CRANKS["bodies"]["a"], "b": {"mass": 1, "at": [f"1.6 + {longer}", "-0.8"]}}
    found = solve_scene(scene_from({**CRANKS, "bodies": bodies}), [0.0, 0.3], ("trajectory",))
    assert found.ended is None


def model_of(scene: Mapping[str, Any]) -> Modelled:
    with precision(BITS):
        return modelled(scene_from(scene))


CHAIN: Json = {
    "gravity": [0, -10],
    "bodies": {name: {"mass": 1, "at": [k + 1, 0]} for k, name in enumerate("abc")},
    "connections": [
        {"kind": "rod", "a": "a", "b": [0, 0]},
        *({"kind": "rod", "a": x, "b": y} for x, y in ("ab", "bc")),
    ],
}


@pytest.mark.parametrize(("scene", "count"), [(CHAIN, 0), (CRANKS, 3), (SLIDER, 2)])
def test_only_lines_of_loops_may_come_to_depend(scene: Json, count: int) -> None:
    (piece,) = model_of(scene).pieces
    assert len(lines_that_may_depend(piece.table, piece.chosen)) == count


def test_what_comes_too_near_for_long_is_refused(monkeypatch: pytest.MonkeyPatch) -> None:
    (_, motion), *_ = model_of(CRANKS).whole.parts
    assert isinstance(motion, Numerical)
    monkeypatch.setattr("core.multibody.motion.lost_rank.first_lost", lambda *_: (0, UNKNOWN))
    with pytest.raises(AccuracyUnreachable, match="keep their hold"):
        motion.run("doubles", 1.0)


@pytest.mark.parametrize("seed", range(8))
@pytest.mark.parametrize("power", [1, 2])
def test_the_first_loss_of_rank_is_found_on_any_path(seed: int, power: int) -> None:
    """A path through the place where the bars are in one line, or one that turns back there."""
    random = np.random.default_rng(seed)
    (_, motion), *_ = model_of(CRANKS).whole.parts
    assert isinstance(motion, Numerical)
    assert motion.table.names == ["a.x", "a.y", "b.x", "b.y"]
    lost = float(random.uniform(0.1, 0.9))
    path = np.polynomial.Polynomial([-lost, 1.0]) ** power * np.polynomial.Polynomial(random.normal(size=4))
    series = np.zeros((2, 4, 9))
    for i, place in enumerate((1.0, 0.0, 2.0, 0.0)):
        along = path * random.normal() + place * motion.units.down[i]
        for step, begun in enumerate((0.0, 0.5)):
            moved = along(np.polynomial.Polynomial([begun, 1.0])).coef
            series[step, i, : len(moved)] = moved
    step, time = first_lost(motion.arrays, motion.rows, np.array([[0.0, 0.0], [0.5, 0.0], [1.0, 0.0]]), series)
    assert 0.5 * step + time == pytest.approx(_first_root(path), abs=1e-6 if power == 2 else 1e-9)


def _first_root(path: np.polynomial.Polynomial) -> float:
    """Return the first zero from 0 to 1: at every zero the path is at the place in question."""
    roots = path.roots()
    real = roots.real[np.abs(roots.imag) < 1e-6]
    return float(min(x for x in real if 0.0 <= x <= 1.0))
