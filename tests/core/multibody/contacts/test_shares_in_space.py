"""Loads shared under round cones of friction: the best share against linear programming, and tables that let go."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Any

import numpy as np
import pytest
from flint import arb
from numpy.typing import NDArray
from scipy.optimize import linprog

from core.balls import precision
from core.multibody.contacts.shares_in_space import Cone, best_share
from core.multibody.contacts.slip_directions import Direction, directions_together, one_of
from core.multibody.solve import solve_scene
from tests.core.multibody.table.test_contact_geometry import states
from tests.core.multibody.worked_examples import column, read

LEGS = {"f0": (0.5, 0.3), "f1": (-0.5, 0.3), "f2": (-0.5, -0.3), "f3": (0.5, -0.3)}
SIDES = 360


def balance(legs: list[tuple[float, float]]) -> NDArray[np.float64]:
    """Return forces and moments about the origin of the floor by N, F_x and F_y of every leg."""
    found = np.zeros((6, 3 * len(legs)))
    for k, (x, y) in enumerate(legs):
        found[2, 3 * k], found[0, 3 * k + 1], found[1, 3 * k + 2] = 1, 1, 1
        found[3, 3 * k], found[4, 3 * k] = y, -x
        found[5, 3 * k + 1], found[5, 3 * k + 2] = -y, x
    return found


def load(weight: float, pull: tuple[float, float], hook: tuple[float, float, float]) -> NDArray[np.float64]:
    """Return what the legs have to bear of a weight over the origin and a horizontal pull at a hook."""
    (px, py), (x, y, z) = pull, hook
    return -np.array([px, py, -weight, -z * py, z * px, x * py - y * px])


def largest_pull(
    legs: list[tuple[float, float]], friction: float, direction: tuple[float, float], hook: tuple[float, float, float]
) -> tuple[float, float]:
    """Return bounds of the largest pull that a table of 100 N bears, by polygons inside and around the cones."""
    count = 3 * len(legs)
    equal = np.hstack([balance(legs), -(load(0, direction, hook))[:, None]])
    bounds = []
    for inside in (math.cos(math.pi / SIDES), 1.0):
        cones = np.zeros((SIDES * len(legs), count + 1))
        for k in range(len(legs)):
            for s in range(SIDES):
                angle = 2 * math.pi * s / SIDES
                line = cones[SIDES * k + s]
                line[3 * k] = -friction * inside
                line[3 * k + 1], line[3 * k + 2] = math.cos(angle), math.sin(angle)
        cost = np.zeros(count + 1)
        cost[-1] = -1.0
        sides = [(0, None), (None, None), (None, None)] * len(legs) + [(0, 1000)]
        found = linprog(
            cost, A_ub=cones, b_ub=np.zeros(len(cones)), A_eq=equal, b_eq=load(100, (0, 0), hook), bounds=sides
        )
        bounds.append(float(found.x[-1]))
    return bounds[0], bounds[1]


@pytest.mark.parametrize("trial", range(12))
def test_the_best_share_has_the_largest_margin(trial: int) -> None:
    """Its certificate contains no share and has its margin as value; polygons on both sides of the cones agree."""
    random = np.random.default_rng(trial)
    legs = [(float(x), float(y)) for x, y in random.uniform(-1, 1, (int(random.integers(3, 6)), 2))]
    matrix = balance(legs)
    needed = load(100, tuple(random.uniform(-30, 30, 2)), tuple(random.uniform(-0.3, 0.3, 3)))
    start = np.linalg.lstsq(matrix, needed, rcond=None)[0]
    _, _, turned = np.linalg.svd(matrix)
    shares = turned[np.linalg.matrix_rank(matrix) :].T
    cones = [Cone(3 * k, 0.4, (3 * k + 1, 3 * k + 2)) for k in range(len(legs))]
    found = best_share(cones, start, shares)
    scale = float(np.max(np.abs(start)))
    certificate = np.zeros(len(start))
    for k, (weight, direction) in enumerate(zip(found.weights, found.directions, strict=True)):
        assert weight >= 0
        assert np.hypot(*direction) < 1 + 1e-12
        certificate[3 * k] = 0.4 * weight
        certificate[3 * k + 1 : 3 * k + 3] = weight * direction
    assert np.abs(certificate @ shares).max() < 1e-9
    assert certificate @ start / scale == pytest.approx(found.margin, abs=1e-12)
    bounds = []
    for inside in (math.cos(math.pi / SIDES), 1.0):
        lines = np.zeros((SIDES * len(legs), len(start)))
        for k in range(len(legs)):
            for s in range(SIDES):
                angle = 2 * math.pi * s / SIDES
                lines[SIDES * k + s, 3 * k : 3 * k + 3] = 0.4 * inside, math.cos(angle), math.sin(angle)
        best = linprog(
            [0.0] * shares.shape[1] + [-1.0],
            A_ub=np.hstack([-lines @ shares, np.full((len(lines), 1), inside)]),
            b_ub=lines @ start,
            bounds=[(None, None)] * (shares.shape[1] + 1),
        )
        bounds.append(float(best.x[-1]) / scale)
    assert min(bounds) - 1e-7 <= found.margin <= max(bounds) + 1e-7
    forces = (start + shares @ found.free) / scale
    least = min(0.4 * forces[3 * k] - np.hypot(forces[3 * k + 1], forces[3 * k + 2]) for k in range(len(legs)))
    assert least == pytest.approx(found.margin, abs=1e-7)


def pulled(direction: tuple[float, float], hook: tuple[float, float, float], friction: float) -> dict[str, Any]:
    """Return a table whose hook a heavy block pulls by a spring, with 10 N more every second."""
    (u, v), (x, y, z) = direction, hook
    return {
        "gravity": [0, 0, -10],
        "bodies": {
            "table": {
                "mass": 10,
                "moments": [1, 1.5, 2],
                "at": [0, 0, 0.7],
                "places": {
                    **{name: [a, b, -0.7] for name, (a, b) in LEGS.items()},
                    "hook": [x, y, f"{z} - 0.7"],
                },
            },
            "block": {"mass": 1e12, "at": [f"{x} + {u}", f"{y} + {v}", z], "velocity": [u, v, 0]},
        },
        "connections": [
            *(
                {
                    "kind": "contact",
                    "name": name,
                    "place": f"table.{name}",
                    "on": {"at": [0, 0, 0], "normal": [0, 0, 1]},
                    "friction": friction,
                }
                for name in LEGS
            ),
            {"kind": "track", "place": "block", "on": {"at": [x, y, z], "direction": [u, v, 0]}},
            {"kind": "spring", "a": "table.hook", "b": "block", "stiffness": 10},
        ],
    }


@pytest.mark.parametrize(
    ("direction", "hook", "friction"),
    [
        ((1, 0), (0, 0, 0.1), 0.4),
        ((0.6, 0.8), (0, 0, 0.1), 0.3),
        ((1, 0), (0, 0, 2.0), 0.4),
        ((0, 1), (0.5, 0, 0.2), 0.4),
        ((0.8, -0.6), (0.2, 0.3, 0.4), 0.5),
    ],
)
def test_a_table_stands_as_long_as_some_share_is_admissible(
    direction: tuple[float, float], hook: tuple[float, float, float], friction: float
) -> None:
    """It slides, turns about a leg, or tips: whatever the first is, no share within the cones bears more."""
    low, high = largest_pull(list(LEGS.values()), friction, direction, hook)
    assert high < 1.0001 * low
    answer = solve_scene(read(pulled(direction, hook, friction)), [1.01 * high / 10], ("trajectory",), 1e-6)
    assert states(answer)[0] == dict.fromkeys(LEGS, "stick")
    first = answer.events[0]
    assert low / 10 * (1 - 1e-9) <= first.time <= high / 10 * (1 + 1e-9)
    assert 1e-13 < first.error < 1e-9
    if hook == (0, 0, 2.0):
        # 100 N with an arm of 0.5 m against 10 N/s with one of 2 m.
        assert first.time == pytest.approx(2.5, rel=1e-10)
        assert {event.name for event in answer.events if event.kind == "lift-off"} == {"f1", "f2"}
    elif hook[:2] == (0, 0):
        assert first.time == pytest.approx(friction * 10, rel=1e-10)


def test_a_table_that_is_pulled_less_than_it_bears_stands() -> None:
    scene = pulled((1, 0), (0, 0, 0.1), 0.4)
    scene["bodies"]["block"]["velocity"] = [0, 0, 0]
    scene["connections"][-1]["rest_length"] = "1 - 0.3999"
    scene["connections"][-1]["stiffness"] = 100
    answer = solve_scene(read(scene), [1.0])
    assert answer.events == ()
    assert states(answer)[0] == dict.fromkeys(LEGS, "stick")


def test_what_slides_on_four_feet_turns_its_slip_as_a_point_does() -> None:
    """With the feet as high as its centre of mass a body slides without turning, whatever the share of its weight."""
    moving = {"mass": 2, "at": [0, 0, 0], "velocity": [0, 1.5, 0]}
    feet = {name: [a, b, 0] for name, (a, b) in LEGS.items()}
    body = {**moving, "moments": [1, 1.5, 2], "places": feet, "angular_velocity": [0, 0, 0]}
    found = []
    for one, places in ((moving, ["body"]), (body, [f"body.{name}" for name in LEGS])):
        scene = {
            "gravity": [2, 0, -9.81],
            "bodies": {"body": one},
            "connections": [
                {"kind": "contact", "place": place, "on": {"at": [0, 0, 0], "normal": [0, 0, 1]}, "friction": 0.4}
                for place in places
            ],
        }
        found.append(column(solve_scene(read(scene), [0.04], ("trajectory",)), "body.position"))
    point, standing = found
    assert np.linalg.norm(standing.values[0] - point.values[0]) <= standing.error + point.error
    assert standing.error < 1e-15


TRIPOD = {"a": (0.5, 0.4), "b": (0.5, -0.2), "c": (-0.5, 0.0)}


@pytest.mark.parametrize("feet", [LEGS, TRIPOD, {"a": (0.5, 0), "c": (-0.5, 0)}], ids=["four", "three", "two"])
@pytest.mark.parametrize("friction", [0.1, 0.4])
def test_what_is_released_on_a_steep_slope_begins_to_slide_on_all_of_its_feet(
    feet: dict[str, tuple[float, float]], friction: float
) -> None:
    """It translates down the line of greatest slope, with g (sin - mu cos), along the line that joins two feet."""
    (u, v) = (1, 0) if len(feet) == 2 else (0.8, -0.6)
    scene = {
        "gravity": [6 * u, 6 * v, -8],
        "bodies": {
            "table": {
                "mass": 10,
                "moments": [1, 1.5, 2],
                "at": [0, 0, 0.2],
                "places": {name: [x, y, -0.2] for name, (x, y) in feet.items()},
            }
        },
        "connections": [
            {"kind": "contact", "name": name, "place": f"table.{name}", "on": {"at": [0, 0, 0], "normal": [0, 0, 1]}}
            | {"friction": friction}
            for name in feet
        ],
    }
    answer = solve_scene(read(scene), [0.5], ("trajectory",))
    assert answer.problem is None
    assert answer.events == ()
    assert states(answer) == [dict.fromkeys(feet, "slide")]
    way = (6 - 8 * friction) * 0.125
    assert column(answer, "table.position").values[0] == pytest.approx([way * u, way * v, 0.2], abs=1e-14)


def test_directions_of_onsets_that_depend_on_one_another_converge_or_are_none() -> None:
    """Of two slips whose tangents are linear in those assumed."""

    def after(assumed: Sequence[Direction]) -> list[Direction]:
        (a, first), (b, second) = assumed
        return [(arb(1), second / b / 9 + 1 / arb(9)), (arb(1), first / a / 9)]

    with precision(320):
        found = directions_together([(arb(1), arb(0))] * 2, after)
        assert found is not None
        (c, s), (x, y) = found
        # Tangents are (9 t + 1)/81 of one another: t = 9/80 and 1/80.
        assert abs(s / c - arb(9) / 80) < 1e-60
        assert abs(y / x - arb(1) / 80) < 1e-60
        # Of slips that are known to 1e-24, directions are known so, and not better.
        wide = directions_together(
            [(arb(1), arb(0))] * 2, lambda ways: [(x + arb(0, 1e-24), y + arb(0, 1e-24)) for x, y in after(ways)]
        )
        assert wide is not None
        for (c, s), (x, y) in zip(wide, found, strict=True):
            assert 1e-24 < s.rad() < 1e-22
            assert c.overlaps(x)
            assert s.overlaps(y)
    assert directions_together([(arb(0), arb(0))], after) == []
    assert directions_together([(arb(1), arb(0))], lambda _: None) == []
    assert directions_together([(arb(1), arb(0))], lambda ways: [(-ways[0][1], ways[0][0])]) is None


def test_a_direction_along_an_axis_but_for_its_width_is_chosen_along_it() -> None:
    """What is left of the other component would tie coordinates that have nothing to do with one another."""
    with precision(320):
        assert one_of((arb(-1, 1e-24), arb(1e-35, 1e-24))) == (-1, 0)
        assert [float(x) for x in one_of((arb(3, 1e-24), arb(4, 1e-24)))] == [0.6, 0.8]


def test_friction_that_turns_is_shared_as_openly_as_the_pushes() -> None:
    """Four legs share the weight in many ways: across the first direction their friction is zero at the start alone."""
    legs = {f"f{i}": [x, y, -0.5] for i, (x, y) in enumerate(((0.5, 0.3), (-0.5, 0.3), (-0.5, -0.3), (0.5, -0.3)))}
    table = {"mass": 10, "moments": [1, 1.5, 2], "at": [0, 0, 0.5], "places": legs, "velocity": [1, 0, 0]}
    on = {"at": [0, 0, 0], "normal": [0, 0, 1]}
    feet = [{"kind": "contact", "name": leg, "place": f"table.{leg}", "on": on, "friction": 0.1} for leg in legs]
    pull = {"kind": "force", "place": "table", "force": [0, 3, 0]}
    bodies = {"table": {**table, "angular_velocity": [0, 0, 0]}}
    scene = {"gravity": [0, 0, -10], "bodies": bodies, "connections": [*feet, pull]}
    answer = solve_scene(read(scene), [0.3], ("trajectory", "forces-in-time"))
    assert answer.trajectory is not None
    assert column(answer, "table.velocity").values[0, 1] > 0.01
    assert not any(f"{leg}.friction.{axis}" in answer.trajectory.columns for leg in legs for axis in "xy")
