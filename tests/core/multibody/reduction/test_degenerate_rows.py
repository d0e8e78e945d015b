"""Measures that depend on one another at the start: sums of squares, and free places in a subspace."""

from __future__ import annotations

from itertools import permutations
from typing import Any

import numpy as np
import pytest
from flint import arb

from core.balls import precision
from core.multibody.algebra.polynomials import BITS, Poly
from core.multibody.answer import SceneSolution
from core.multibody.reduction.degenerate_rows import squared
from core.multibody.solve import solve_scene
from tests.core.multibody.worked_examples import column, read

TIMES = (0.3, 0.9, 1.7)
POINTS = (("0.6", "0.8"), ("-0.8", "0.6"), ("5/13", "-12/13"), ("-12/13", "-5/13"), ("1", "0"), ("0", "-1"))
ANGLES = ("0", "acos(0.6)", "acos(5/13)", "pi/2", "0.3")


def test_a_sum_of_squares_is_found_with_what_is_squared() -> None:
    # (x - 2 y + 1)^2 + 3 (y - 5)^2, expanded by hand.
    whole: Poly = {
        (0, 0): arb(1),
        (0, 1): arb(-4),
        (1, 1): arb(7),
        (0,): arb(2),
        (1,): arb(-34),
        (): arb(76),
    }
    with precision(BITS):
        roots = squared(whole)
        assert roots is not None
        # Both vanish at y = 5, x = 9, and nowhere else.
        values = [sum(x * {(): 1, (0,): 9, (1,): 5}[key] for key, x in root.items()) for root in roots]
    assert len(roots) == 2
    assert values == [0, 0]


@pytest.mark.parametrize(
    "form", [{(0, 0): 1, (1, 1): -1}, {(0, 1): 1}, {(0, 0): 1, (1,): 1}], ids=["difference", "product", "parabola"]
)
def test_what_has_places_beside_is_no_sum_of_squares(form: dict[tuple[int, ...], int]) -> None:
    assert squared({key: arb(x) for key, x in form.items()}) is None


def pendulum(at: tuple[str, str], rate: str) -> dict[str, Any]:
    velocity = [f"-({rate})*({at[1]})", f"({rate})*({at[0]})"]
    return {
        "gravity": [0, -9.81],
        "bodies": {"p": {"mass": 4, "at": list(at), "velocity": velocity}},
        "connections": [{"kind": "rod", "a": "p", "b": [0, 0]}],
    }


def platform(at: tuple[str, str], rate: str, angle: str, places: list[tuple[str, str]]) -> dict[str, Any]:
    """Return a plate on parallel rods of length one, which moves as the pendulum of a point does."""
    scene = pendulum(at, rate)
    spots = {f"a{k}": list(place) for k, place in enumerate(places)}
    scene["bodies"]["p"].update(inertia=1, angle=angle, places=spots)
    scene["connections"] = [
        {
            "kind": "rod",
            "a": f"p.a{k}",
            "b": [f"cos({angle})*({x}) - sin({angle})*({y})", f"sin({angle})*({x}) + cos({angle})*({y})"],
        }
        for k, (x, y) in enumerate(places)
    ]
    return scene


def moved(scene: dict[str, Any]) -> SceneSolution:
    return solve_scene(read(scene), TIMES, ("trajectory",))


def alike(first: SceneSolution, second: SceneSolution) -> bool:
    places = [column(one, "p.position") for one in (first, second)]
    apart = np.abs(np.asarray(places[0].values) - np.asarray(places[1].values))
    return bool(np.all(apart <= np.max(places[0].error) + np.max(places[1].error)))


@pytest.mark.parametrize("order", list(permutations(range(3))))
def test_a_platform_on_three_rods_moves_as_a_pendulum_in_every_order(order: tuple[int, ...]) -> None:
    scene = platform(("0.6", "-0.8"), "0", "0", [("-0.5", "0"), ("0.5", "0"), ("0", "0")])
    scene["connections"] = [scene["connections"][k] for k in order]
    found, expected = moved(scene), moved(pendulum(("0.6", "-0.8"), "0"))
    assert alike(found, expected)
    assert found.period == expected.period
    assert np.all(np.asarray(column(found, "p.angle").values) == 0.0)


@pytest.mark.parametrize("seed", range(24))
def test_plates_on_parallel_rods_move_as_a_pendulum(seed: int) -> None:
    random = np.random.default_rng(seed)
    at = POINTS[random.integers(len(POINTS))]
    rate, angle = ("0", "1.5", "-6")[random.integers(3)], ANGLES[random.integers(len(ANGLES))]
    collinear = bool(random.integers(2))
    grid = [(str(x / 4), "0" if collinear else str(y / 4)) for x in range(-4, 5) for y in range(-4, 5)]
    places = list(dict.fromkeys(grid))
    # Four places not on one circle, or three on one line, leave parallel motion alone.
    chosen = [places[i] for i in random.permutation(len(places))[: 3 if collinear else 4]]
    assert alike(moved(platform(at, rate, angle, chosen)), moved(pendulum(at, rate)))


def touching(gravity: list[Any]) -> dict[str, Any]:
    """Return a point that is held on a circle and on a line that touches it there."""
    return {
        "gravity": gravity,
        "bodies": {"p": {"mass": 1, "at": ["0.6", "0.8"]}},
        "connections": [
            {"kind": "rod", "a": "p", "b": [0, 0]},
            {"kind": "track", "place": "p", "on": {"at": ["0.6", "0.8"], "slope": "atan(-0.75)"}},
        ],
    }


def test_a_point_where_a_circle_touches_a_line_stays() -> None:
    found = moved(touching([-6, -8]))
    assert found.model.name == "rest"
    assert np.allclose(np.asarray(column(found, "p.position").values), [0.6, 0.8], atol=1e-15, rtol=0)


def test_a_load_that_no_finite_force_carries_is_refused() -> None:
    # Both connections push along the radius alone.
    with pytest.raises(ValueError, match="singular place"):
        moved(touching([0, -10]))


def test_crank_and_coupler_in_line_remain_a_singular_place() -> None:
    # Two cranks and a coupler on one line: the parallelogram and its crossed form meet there.
    scene = platform(("1", "0"), "0", "0", [("-0.5", "0"), ("0.5", "0")])
    with pytest.raises(ValueError, match="singular place"):
        moved(scene)


def test_velocities_that_hold_to_first_order_only_are_refused() -> None:
    scene = touching([-6, -8])
    scene["bodies"]["p"]["velocity"] = [0.8, -0.6]
    with pytest.raises(ValueError, match="singular place"):
        moved(scene)


@pytest.mark.parametrize("rate", [["0", "0"], ["0.3", "-1"]])
@pytest.mark.parametrize("at", [("0.48", "0.36", "-0.8"), ("-0.64", "0.48", "-0.6"), ("3/13", "-4/13", "-12/13")])
@pytest.mark.parametrize("count", [4, 5])
def test_plates_in_space_on_parallel_rods_move_as_a_pendulum(
    at: tuple[str, str, str], rate: list[str], count: int
) -> None:
    """The fourth rod holds the turn about the rods to second order only, a fifth off its circle to first order."""
    x, y, z = at
    u, v = rate
    body = {"mass": 4, "at": list(at), "velocity": [u, v, f"-(({u})*({x}) + ({v})*({y}))/({z})"]}
    point = {
        "gravity": [0, 0, -9.81],
        "bodies": {"p": body},
        "connections": [{"kind": "rod", "a": "p", "b": [0, 0, 0]}],
    }
    places = [[0.5, 0.3, 0], [-0.5, 0.3, 0], [-0.5, -0.3, 0], [0.5, -0.3, 0], [0.1, 0.2, 0]][:count]
    plate = {
        "gravity": [0, 0, -9.81],
        "bodies": {"p": body | {"moments": [0.5, 0.6, 0.8], "places": {f"a{k}": at for k, at in enumerate(places)}}},
        "connections": [{"kind": "rod", "a": f"p.a{k}", "b": at} for k, at in enumerate(places)],
    }
    assert alike(moved(plate), moved(point))
