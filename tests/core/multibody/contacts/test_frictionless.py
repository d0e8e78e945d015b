"""Many contacts without friction: against non-negative least squares, and in scenes that mechanics knows."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from scipy.optimize import nnls

from core.multibody.contacts.frictionless import complementary
from core.multibody.solve import solve_scene
from tests.core.multibody.worked_examples import column, read

G = 9.81


@pytest.mark.parametrize("seed", range(6))
def test_forces_are_those_of_least_constraint(seed: int) -> None:
    """The accelerations are those of Gauss's principle, by non-negative least squares, also where forces are shared."""
    random = np.random.default_rng(seed)
    rows = random.normal(size=(20, 12))
    rows[5:8] = rows[:3] + rows[3]
    free = random.normal(size=12)
    push, _ = nnls(rows.T, -free)
    expected = rows @ (free + rows.T @ push)
    forces, gains = complementary(rows @ rows.T, rows @ free)
    assert ((forces > 0) <= (expected < 1e-9)).all()
    assert ((gains > 0) == (expected > 1e-9)).all()
    assert gains[gains > 0] / gains.max() == pytest.approx(expected[gains > 0] / expected.max(), abs=1e-6)


@pytest.mark.parametrize("states", [2, 3])
def test_which_push_and_which_open_is_that_of_planted_problems(states: int) -> None:
    """Accelerations are unique, whatever forces press redundant contacts, or those of a shaft, against one another."""
    random = np.random.default_rng(states)
    for _ in range(300):
        count = int(random.integers(1, 25))
        rows = random.integers(-2, 3, (count, int(random.integers(1, count + 1)))) * (random.random((count, 1)) < 0.7)
        state = random.integers(0, states, count)
        push, gain = ((state == k) * (random.random(count) + 0.1) for k in (0, 1))
        forces, gains = complementary((rows @ rows.T).astype(float), gain - rows @ rows.T @ push)
        assert ((gains > 0) == (gain > 0)).all()
        assert not ((forces > 0) & (gain > 0)).any()
        assert ((forces > 0) >= (push > 0)).all()


def test_what_neither_pushes_nor_opens_is_told() -> None:
    """Beads in free fall."""
    matrix = 2 * np.eye(9) - np.eye(9, k=1) - np.eye(9, k=-1)
    forces, gains = complementary(matrix, np.zeros(9))
    assert not forces.any()
    assert not gains.any()


def beads(count: int) -> dict[str, Any]:
    bodies = {f"b{i}": {"mass": 1, "radius": 0.1, "at": [f"{i}/5", 1]} for i in range(count)}
    touching = [{"kind": "contact", "name": f"c{i}", "a": f"b{i}", "b": f"b{i + 1}"} for i in range(count - 1)]
    return {"gravity": [0, -G], "bodies": bodies, "connections": touching}


def test_ten_beads_fall_side_by_side() -> None:
    answer = solve_scene(read(beads(10)), [0.3])
    assert not answer.events
    assert column(answer, "b7.position").values[0] == pytest.approx([1.4, 1 - G * 0.045], rel=1e-15)
    assert answer.forces is not None
    assert {force.value for force in answer.forces.values()} == {0.0}


def test_a_push_passes_through_ten_beads() -> None:
    """A force at one end accelerates all alike; each contact has what is behind it."""
    scene = {**beads(10), "gravity": [0, 0]}
    scene["connections"].append({"kind": "force", "place": "b0", "force": [10, 0]})
    answer = solve_scene(read(scene))
    assert answer.forces is not None
    assert [answer.forces[f"c{i}.normal"].value for i in range(9)] == pytest.approx(
        [9 - i for i in range(9)], rel=1e-15
    )


def test_ten_beads_stop_at_a_wall_together() -> None:
    """With e = 1 at the wall and 0 between them, all by Newton's law: the impulse at the wall is twice the momentum."""
    scene = beads(10)
    scene["gravity"] = [0, 0]
    for body in scene["bodies"].values():
        body["velocity"] = [-1, 0]
    wall = {"kind": "contact", "name": "wall", "place": "b0", "on": {"at": [-1, 0], "normal": [1, 0]}}
    scene["connections"].append({**wall, "restitution": 1})
    scene["simultaneous"] = "together"
    answer = solve_scene(read(scene), [2.0])
    impulses = {event.name: event.impulses["normal"] for event in answer.events if event.impulses}
    assert impulses["wall"] == pytest.approx(20, rel=1e-15)
    assert impulses["c0"] == pytest.approx(18, rel=1e-15)
    assert column(answer, "b9.velocity").values[0, 0] == pytest.approx(1, rel=1e-15)


def test_a_pile_of_discs_rests_between_walls() -> None:
    """Ten discs in four rows: that on top presses with m g/(2 cos 30) on each of two, whatever is below."""
    scene: dict[str, Any] = {"gravity": [0, -G], "bodies": {}, "connections": []}
    places = {(r, j): f"d{r}{j}" for r in range(4) for j in range(4 - r)}
    for (r, j), name in places.items():
        scene["bodies"][name] = {"mass": 1, "radius": 1, "at": [2 * j + r, f"1 + {r}*sqrt(3)"]}
        pairs = [places[k] for k in ((r, j + 1), (r + 1, j - 1), (r + 1, j)) if k in places]
        scene["connections"] += [{"kind": "contact", "name": name + b, "a": name, "b": b} for b in pairs]
        if r == 0:
            scene["connections"].append({"kind": "contact", "place": name, "on": {"at": [0, 0]}})
    for name, x, way in (("d00", -1, 1), ("d03", 7, -1)):
        scene["connections"].append({"kind": "contact", "place": name, "on": {"at": [x, 0], "normal": [way, 0]}})
    answer = solve_scene(read(scene), [1.0])
    assert not answer.events
    assert answer.forces is not None
    assert answer.forces["d20d30.normal"].value == pytest.approx(G / np.sqrt(3), rel=1e-15)
    assert answer.forces["d00d10.normal"].value is None
