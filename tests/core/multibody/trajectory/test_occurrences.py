from __future__ import annotations

import json
import math
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from mpmath import ellipk, mp

from core.errors import InvalidParameter, NotApplicable
from core.multibody.solve import solve_scene
from core.multibody.trajectory.occurrences import ExtremesOf, When
from core.systems.methods.explicit_euler import ExplicitEuler
from tests.core.multibody.swings import Swing
from tests.core.multibody.worked_examples import column, points, read

PENDULUM = read(points((1,), (2.5,), (2,)))
SCENES = Path(__file__).parents[4] / "examples" / "scenes"


def times_of(scene, until, *asked):
    answer = solve_scene(scene, [until], asked)
    assert answer.occurrences is not None
    return [one.time for one in answer.occurrences], [one.error for one in answer.occurrences]


def test_a_pendulum_passes_its_lowest_place_at_odd_quarters_of_its_period():
    """T = 4 K(sin^2 1.25)/omega, Jacobi."""
    found, errors = times_of(PENDULUM, 9.0, When("p0.position.x", 0.0))
    with mp.workdps(30):
        quarter = ellipk(mp.sin(mp.mpf("1.25")) ** 2) / mp.sqrt(mp.mpf("9.81"))
        exact = [quarter * k for k in (1, 3, 5, 7, 9)]
    assert len(found) == 5
    for time, error, right in zip(found, errors, exact, strict=True):
        assert abs(time - right) <= error < 1e-14


def test_the_nth_is_the_nth_of_all():
    every, _ = times_of(PENDULUM, 20.0, When("r0.force", 30.0))
    for n in (1, 2, 5):
        assert times_of(PENDULUM, 20.0, When("r0.force", 30.0, n))[0] == [every[n - 1]]
    assert times_of(PENDULUM, 1.0, When("r0.force", 30.0, 9))[0] == []


def test_a_thrown_ball_is_as_high_twice_and_at_its_highest_once():
    ball = read({"gravity": [0, -9.81], "bodies": {"b": {"mass": 1, "at": [0, 0], "velocity": [1, 9.81]}}})
    found, errors = times_of(ball, 3.0, When("b.position.y", 3.0))
    root = math.sqrt(1 - 6 / 9.81)
    assert found == pytest.approx([1 - root, 1 + root], rel=1e-15)
    assert max(errors) < 1e-14
    # Just below the top two crossings lie close together, and just above it there are none.
    found, errors = times_of(ball, 3.0, When("b.position.y", 4.905 - 1e-10))
    for time, error, sign in zip(found, errors, (-1, 1), strict=True):
        assert abs(time - 1 - sign * math.sqrt(2e-10 / 9.81)) <= error + 1e-11
        assert error < 1e-9
    assert times_of(ball, 3.0, When("b.position.y", 4.905 + 1e-10))[0] == []


@pytest.mark.parametrize("contact", [False, True])
@pytest.mark.parametrize("exponent", [-26, -24, -20, -17, -16, -12, -8, -4, -2])
def test_a_value_beside_that_of_a_turning_point_is_taken_on_both_sides_of_it(exponent: int, contact: bool) -> None:
    """x = cos(2 t) from rest at 1: 1 - d is met at multiples of pi, less and more acos(1 - d)/2; 1 where it turns."""
    spring = {"kind": "spring", "a": "b", "b": [0, 0], "stiffness": 4, "rest_length": 0}
    line = {"kind": "contact" if contact else "track", "place": "b", "on": {"at": [0, 0]}}
    scene = {"gravity": [0, -1], "bodies": {"b": {"mass": 1, "at": [1, 0]}}, "connections": [line, spring]}
    found, errors = times_of(read(scene), 6.5, When("b.position.x", f"1 - 1e{exponent}"))
    with mp.workdps(60):
        off = mp.acos(1 - mp.mpf(10) ** exponent) / 2
        exact = [off, *(mp.pi * k + sign * off for k in (1, 2) for sign in (-1, 1))]
    assert len(found) == 5
    assert all(abs(time - right) <= error < 1e-14 for time, error, right in zip(found, errors, exact, strict=True))
    assert times_of(read(scene), 6.5, When("b.position.x", f"1 + 1e{exponent}"))[0] == []
    found, errors = times_of(read(scene), 6.5, When("b.position.x", 1))
    assert all(abs(time - mp.pi * k) <= error < 1e-12 for k, time, error in zip((1, 2), found, errors, strict=True))


@pytest.mark.parametrize("exponent", [-34, -31, -30, -29, -28, -27])
def test_a_value_that_is_not_known_from_that_of_a_turning_point_is_one_time_whose_error_has_both(exponent: int) -> None:
    spring = {"kind": "spring", "a": "b", "b": [0, 0], "stiffness": 4, "rest_length": 0}
    line = {"kind": "track", "place": "b", "on": {"at": [0, 0]}}
    scene = {"gravity": [0, -1], "bodies": {"b": {"mass": 1, "at": [1, 0]}}, "connections": [line, spring]}
    found, errors = times_of(read(scene), 6.5, When("b.position.x", f"1 - 1e{exponent}"))
    with mp.workdps(60):
        off = mp.acos(1 - mp.mpf(10) ** exponent) / 2
        for right in (mp.pi * k + sign * off for k in (1, 2) for sign in (-1, 1)):
            assert any(abs(time - right) <= error < 1e-12 for time, error in zip(found, errors, strict=True))


def test_extremes_over_a_period_are_those_of_all_time():
    """The pull is m (3 g cos(theta) - 2 g cos(2.5)): least at the ends, largest below; E = m g (1 - cos)."""
    asked = [ExtremesOf("r0.force"), ExtremesOf("p0.velocity.length"), ExtremesOf("p0.position.y")]
    answer = solve_scene(PENDULUM, [100.0], asked)
    pull, speed, height = answer.extremes
    g, c = 9.81, math.cos(2.5)
    assert all(one.periodic and one.until == pytest.approx(answer.period) for one in answer.extremes)
    for one, least, largest in (
        (pull, 2 * g * c, 2 * g * (3 - 2 * c)),
        (speed, 0.0, math.sqrt(2 * g * (1 - c))),
        (height, -1.0, -c),
    ):
        assert abs(one.least - least) <= one.error + 1e-15
        assert abs(one.largest - largest) <= one.error + 1e-14
        assert one.error < 1e-12


def test_extremes_of_what_does_not_repeat_are_those_of_the_time():
    ball = read({"gravity": [0, -9.81], "bodies": {"b": {"mass": 1, "at": [0, 0], "velocity": [1, 9.81]}}})
    (found,) = solve_scene(ball, [3.0], [ExtremesOf("b.position.y")]).extremes
    assert (found.periodic, found.until) == (False, 3.0)
    assert found.largest == pytest.approx(4.905, rel=1e-15)
    assert found.largest_time == pytest.approx(1.0, abs=1e-7)
    assert (found.least, found.least_time) == (pytest.approx(9.81 * 3 - 4.905 * 9, rel=1e-14), 3.0)


def test_an_angle_is_unwrapped_when_it_is_searched():
    motor = json.loads((SCENES / "crank-slider.json").read_text())
    scene = read({key: value for key, value in motor.items() if key not in ("times", "outputs")})
    for value in (20.0, {"value": "3600/pi", "unit": "deg"}, {"value": "10/pi", "unit": "rev"}):
        found, errors = times_of(scene, 3.0, When("crank.angle", value))
        assert found == pytest.approx([2.0], rel=1e-14)
        assert errors[0] < 1e-13


@pytest.mark.parametrize(
    ("asked", "path"),
    [
        (When("p0.mass", 1.0), ("outputs", 0, "when", "quantity")),
        (When("p0.position", 1.0), ("outputs", 0, "when", "quantity")),
        (When("", 1.0), ("outputs", 0, "when", "quantity")),
        (When("r0.force", math.nan), ("outputs", 0, "when", "equals")),
        (When("r0.force", {"value": 1, "unit": "N m"}), ("outputs", 0, "when", "equals", "unit")),
        (When("p0.position.x", {"value": 1, "unit": "s"}), ("outputs", 0, "when", "equals", "unit")),
        (When("r0.force", 1.0, 0), ("outputs", 0, "when", "nth")),
        (ExtremesOf("nothing"), ("outputs", 0, "extremes")),
        (ExtremesOf(3), ("outputs", 0, "extremes")),  # type: ignore[arg-type]
    ],
)
def test_what_cannot_be_searched_is_refused_with_its_path(asked, path):
    with pytest.raises(InvalidParameter) as fault:
        solve_scene(PENDULUM, [1.0], [asked])
    assert fault.value.path == path


def test_a_search_needs_times_and_the_motion_itself():
    with pytest.raises(InvalidParameter) as fault:
        solve_scene(PENDULUM, [-1.0], [When("r0.force", 1.0)])
    assert fault.value.path == ("times",)
    with pytest.raises(NotApplicable):
        solve_scene(PENDULUM, [1.0], [When("r0.force", 1.0)], method=ExplicitEuler(step=0.1))


@pytest.mark.parametrize("speed", [1e-2, 1e-4, -1e-2, -1e-4])
def test_what_happens_between_the_start_and_the_first_look_counts(speed):
    """By Jacobi's functions: half-way in angle to the turn, soon after the start or before the end of a period."""
    swing = Swing(speed)
    with mp.workdps(40):
        between = (mp.mpf("0.5") + swing.amplitude) / 2
        equals = float(mp.sin(between))
        up = swing.phase(mp.asin(mp.mpf(repr(equals)))) - swing.start
        exact = [up + 4 * k * swing.quarter for k in range(3)]
        exact += [2 * swing.quarter - 2 * swing.start - up + 4 * k * swing.quarter for k in range(3)]
        exact = sorted(t for t in exact if t > 0)[:4]
        largest = mp.sin(swing.amplitude)
    found, errors = times_of(swing.scene(), 5.0, When("bob.position.x", equals))
    for time, error, right in zip(found[:4], errors[:4], exact, strict=True):
        assert abs(time - right) <= error < 1e-10
    (extremes,) = solve_scene(swing.scene(), [5.0], [ExtremesOf("bob.position.x")]).extremes
    assert abs(extremes.largest - largest) <= extremes.error < 1e-15
    assert abs(extremes.least + largest) <= extremes.error


@pytest.mark.parametrize("search", [ExtremesOf("energy.kinetic"), When("p.position.x", 1e299)])
def test_what_is_found_beyond_the_range_of_doubles_is_refused(search: ExtremesOf | When) -> None:
    scene = {"gravity": [0, "-1e299"], "bodies": {"p": {"mass": 1, "at": [0, 0], "velocity": ["1e299", 0]}}}
    with pytest.raises(NotApplicable, match="leaves the range of doubles"):
        solve_scene(read(scene), [2.0], (search,))


@pytest.mark.parametrize(
    "hold", [{"kind": "slider", "a": "b", "b": [0, 0]}, {"kind": "contact", "place": "b", "on": {"at": [0, 0]}}]
)
def test_what_leaves_its_value_at_the_start_takes_it_no_sooner_than_it_returns(hold: dict[str, Any]) -> None:
    """x = -5 + 2 cos(sqrt(3) t): it leaves -3 with the square of time, and is there again a period later."""
    spring = {"kind": "spring", "a": "b", "b": [-10, 0], "stiffness": 3, "rest_length": 5}
    scene = {"gravity": [0, -10], "bodies": {"b": {"mass": 1, "at": [-3, 0]}}, "connections": [hold, spring]}
    found = solve_scene(read(scene), [4], (When("b.position.x", -3.0), When("b.position.x", -4.0))).occurrences
    period = 2 * math.pi / math.sqrt(3)
    right = [(-3.0, period), (-4.0, period / 6), (-4.0, 5 * period / 6)]
    assert [one.equals for one in found] == [equals for equals, _ in right]
    assert all(abs(one.time - time) <= one.error + 1e-15 for one, (_, time) in zip(found, right, strict=True))


def test_of_a_motion_that_repeats_the_first_thousand_are_right() -> None:
    """Odd quarters of the period, after hundreds of periods too; a value that is never taken costs one period."""
    found, errors = times_of(PENDULUM, 1e6, When("p0.position.x", 0.0))
    with mp.workdps(30):
        quarter = ellipk(mp.sin(mp.mpf("1.25")) ** 2) / mp.sqrt(mp.mpf("9.81"))
        exact = [quarter * (2 * k + 1) for k in range(1000)]
    assert len(found) == 1000
    assert all(abs(time - right) <= error for time, error, right in zip(found, errors, exact, strict=True))
    assert max(errors) < 1e-12
    assert times_of(PENDULUM, 1e6, When("p0.position.x", 2.0))[0] == []


def test_the_value_of_the_start_is_not_taken_there_though_no_double_has_it() -> None:
    """x = cos(t)/10: 0.1 is no double, and is reached again after each turn."""
    spring = {"kind": "spring", "a": "b", "b": [0, 0], "stiffness": 1, "rest_length": 0}
    scene = {"gravity": [0, 0], "bodies": {"b": {"mass": 1, "at": ["0.1", 0]}}, "connections": [spring]}
    found, errors = times_of(read(scene), 13.0, When("b.position.x", 0.1))
    assert len(found) == 2
    assert all(abs(time - 2 * math.pi * k) <= error for k, time, error in zip((1, 2), found, errors, strict=True))


def test_an_angle_that_winds_on_has_its_extremes_at_the_ends() -> None:
    """A pendulum that turns over repeats; its angle does not."""
    body = {
        "mass": 1,
        "inertia": 1,
        "at": [0, -1],
        "angular_velocity": 9,
        "velocity": [9, 0],
        "places": {"top": [0, 1]},
    }
    pin = {"kind": "pin", "a": "rod.top", "b": [0, 0]}
    scene = read({"gravity": [0, -9.81], "bodies": {"rod": body}, "connections": [pin]})
    angle, height = solve_scene(scene, [10.0], [ExtremesOf("rod.angle"), ExtremesOf("rod.position.y")]).extremes
    assert (angle.periodic, angle.least_time, angle.largest_time) == (False, 0.0, 10.0)
    assert angle.largest > 20 * math.pi
    assert height.periodic
    assert height.largest == pytest.approx(1.0, abs=height.error)
    found, errors = times_of(scene, 10.0, When("rod.angle", 14 * math.pi))
    (again,) = solve_scene(scene, found, ["trajectory"]).trajectory.columns["rod.angle"].values
    assert len(found) == 1
    assert again == pytest.approx(14 * math.pi, abs=9 * errors[0] + 1e-13)


@pytest.mark.parametrize(("part", "value"), [("w", 0.25), ("x", 0.25), ("y", -0.25), ("z", 0.0), ("y", 0.0)])
def test_an_attitude_has_the_components_that_are_sought(part: str, value: float) -> None:
    """Held against samples of the answer: it is as often on either side as there are zeros between."""
    scene = json.loads((SCENES / "asymmetric-top.json").read_text())
    scene = read({key: scene[key] for key in ("gravity", "bodies", "connections") if key in scene})
    (body,) = scene.bodies
    found, _ = times_of(scene, 5.0, When(f"{body}.attitude.{part}", value))
    times = np.linspace(0.0, 5.0, 4001)[1:]
    values = solve_scene(scene, times, ["trajectory"]).trajectory.columns[f"{body}.attitude"].values
    curve = values[:, "wxyz".index(part)] - value
    # Where the first component is zero the others jump to their opposites.
    changes = (curve[1:] * curve[:-1] < 0.0) & (values[1:, 0] > 0.05) & (np.abs(np.diff(curve)) < 0.1)
    counted = np.searchsorted(times, found, side="left")
    assert list(np.flatnonzero(changes) + 1) == sorted(counted)


def test_extremes_are_told_to_the_last_places_of_their_times() -> None:
    """The top of a throw, at 1 s."""
    ball = read({"gravity": [0, -9.81], "bodies": {"b": {"mass": 1, "at": [0, 0], "velocity": [1, "9.81"]}}})
    (found,) = solve_scene(ball, [3.0], [ExtremesOf("b.position.y")]).extremes
    assert abs(found.largest_time - 1.0) <= found.errors["largest_time"] <= 1e-15


BALL: dict[str, Any] = {"mass": 1, "at": [5, 1], "velocity": [0, 0]}
FLOOR = {"kind": "contact", "place": "ball", "on": {"at": [5, 0]}, "restitution": 0.5}
ALONE: dict[str, Any] = {"gravity": [0, -10], "bodies": {"ball": BALL}}
VAIN: dict[str, dict[str, Any]] = {
    "smooth": ALONE,
    "in phases": ALONE | {"connections": [FLOOR]},
    "beside a part": ALONE | {"bodies": {"ball": BALL, "other": {"mass": 1, "at": [0, 0]}}, "connections": [FLOOR]},
}


@pytest.mark.parametrize("name", VAIN)
def test_a_search_in_vain_leaves_a_notice(name: str) -> None:
    outputs = (
        When("ball.position.y", 0.75),
        "trajectory",
        When("ball.position.y", 2.0),
        When("ball.position.y", 0.75, nth=7),
        When("ball.position.y", 0.75, nth=1),
        When("ball.position.y", 3.0, nth=1),
    )
    answer = solve_scene(read(VAIN[name]), [0.3, 0.4], outputs)
    assert answer.trajectory is not None
    assert answer.occurrences is not None
    assert [one.equals for one in answer.occurrences] == [0.75, 0.75]
    notices = [notice for notice in answer.trajectory.warnings if notice.code == "value-not-taken"]
    assert [notice.path for notice in notices] == [("outputs", i, "when") for i in (2, 3, 5)]
    assert "7 times" in notices[1].detail
    assert "until 0.4 s" in notices[1].detail


def test_that_occurrences_are_left_out_is_noticed() -> None:
    answer = solve_scene(PENDULUM, [1e6], ["trajectory", When("p0.position.x", 0), When("p0.position.x", 0, nth=1000)])
    assert answer.trajectory is not None
    (notice,) = (one for one in answer.trajectory.warnings if one.code == "occurrences-left-out")
    assert notice.path == ("outputs", 1, "when")


@pytest.mark.parametrize("beside", [[], [{"kind": "contact", "place": "b", "on": {"at": [0, -9]}}]])
def test_what_grows_beyond_bounds_is_searched_to_just_before_its_end(beside: list[dict[str, Any]]) -> None:
    """A fall into a centre: x (v^2/2 - mu/x + mu/h) = 0, x ~ (9 mu/2)^(1/3) (T - t)^(2/3), T = pi sqrt(h^3/(8 mu))."""
    fall = {"kind": "inverse-square", "name": "sun", "a": "b", "b": [0, 0], "strength": 3}
    scene = {"gravity": [0, 0], "bodies": {"b": {"mass": 1, "at": [0, 0.72]}}, "connections": [fall, *beside]}
    asked = [ExtremesOf("b.velocity.length"), When("b.velocity.length", 1e6), When("b.velocity.length", 1000)]
    answer = solve_scene(read(scene), [1.0], ["trajectory", *asked])
    end = math.pi * math.sqrt(0.72**3 / 24)
    assert answer.ended is not None
    assert (answer.ended.kind, answer.ended.name) == ("singular", "sun")
    assert abs(answer.ended.time - end) <= answer.ended.error + 1e-16
    (speed,) = answer.extremes or ()
    assert speed.largest_time == speed.until == answer.ended.time * (1 - 1e-9)
    x = (13.5 * (end * 1e-9) ** 2) ** (1 / 3)
    assert speed.largest == pytest.approx(math.sqrt(6 / x - 6 / 0.72), rel=1e-4)
    (found,) = answer.occurrences or ()
    assert found.equals == 1000.0
    assert answer.trajectory is not None
    (notice,) = answer.trajectory.warnings
    assert notice.code == "value-not-taken"


def test_extremes_of_a_quaternion_have_both_sides_of_a_jump() -> None:
    """Held against samples of the answer: they lie within the extremes, and come near to them."""
    scene = json.loads((SCENES / "thrown-body.json").read_text())
    scene = read({key: scene[key] for key in ("gravity", "bodies", "connections") if key in scene})
    asked = [ExtremesOf(f"body.attitude.{part}") for part in "wxyz"]
    answer = solve_scene(scene, np.linspace(0.0, 3.0, 1501), ["trajectory", *asked])
    values = answer.trajectory.columns["body.attitude"].values
    for found, curve in zip(answer.extremes, values.T, strict=True):
        assert found.least - found.error <= np.min(curve)
        assert np.max(curve) <= found.largest + found.error
        assert np.min(curve) - found.least + found.largest - np.max(curve) < 0.02


def test_a_constant_of_a_fast_motion_has_no_time_of_its_own() -> None:
    scene = json.loads((SCENES / "lagrange-top.json").read_text())
    scene = read({key: scene[key] for key in ("gravity", "bodies", "connections") if key in scene})
    (found,) = solve_scene(scene, [10.0], [ExtremesOf("top.angular_momentum.z")]).extremes
    assert found.largest - found.least <= 2.0 * found.error
    assert found.errors["least_time"] == found.until


def test_the_end_of_what_is_searched_has_an_error() -> None:
    """A pendulum repeats after a period; a ball is followed to the last time, or to where its bounces are undecided."""
    rod = {"kind": "rod", "a": "p", "b": [0, 0]}
    scene = {"gravity": [0, -9.81], "bodies": {"p": {"mass": 1, "at": [1, -1]}}}
    answer = solve_scene(read(scene | {"connections": [rod]}), [10.0], [ExtremesOf("p.position.x")])
    (found,) = answer.extremes
    assert found.periodic
    assert abs(found.until - answer.period) <= found.errors["until"] + answer.period_error
    assert 0.0 < found.errors["until"] < 1e-15
    (found,) = solve_scene(read(scene | {"connections": []}), [0.7], [ExtremesOf("p.position.y")]).extremes
    assert (found.until, found.errors["until"]) == (0.7, 0.0)


@pytest.mark.parametrize("across", ["1e-2", "3e-3"])
def test_what_is_extreme_where_it_is_known_worst_is_as_right_as_is_asked(across: str) -> None:
    """A fall past a centre at a millionth of the distance: doubles lose the speed there, and no sample shows it."""
    centre = {"kind": "inverse-square", "name": "c", "a": "p", "b": [0, 0], "strength": 3}
    body = {"mass": 2, "at": [0, 0.5], "velocity": [across, 0]}
    scene = {"gravity": [0, -10], "bodies": {"p": body}, "connections": [centre]}
    (found,) = solve_scene(read(scene), [1.0], [ExtremesOf("p.velocity.length")], 1e-6).extremes
    assert found.error <= 1e-6 * found.largest
    assert found.largest > 400.0
    nearest = solve_scene(read(scene), [found.largest_time], ("trajectory",), 1e-3)
    away = float(np.linalg.norm(column(nearest, "p.position").values[-1]))
    # Energy: 3/r - 2 g y - v^2 is what it was.
    height = float(column(nearest, "p.position").values[-1, 1])
    speed = np.sqrt(float(across) ** 2 + 3.0 * (1.0 / away - 2.0) + 20.0 * (0.5 - height))
    assert found.largest == pytest.approx(speed, rel=1e-3)


def test_extremes_say_where_the_bodies_are() -> None:
    """A stone that is thrown is highest at vx vy/g, vy^2/(2 g); at the last time it is as far as it comes."""
    stone = {"mass": 1, "at": [0, 0], "velocity": [3, 4]}
    scene = read({"gravity": [0, -10], "bodies": {"stone": stone}})
    searches = [ExtremesOf("stone.position.y"), ExtremesOf("stone.position.x")]
    heights, ways = solve_scene(scene, [1.0], searches).extremes or ()
    assert heights.largest_places["stone"] == pytest.approx((1.2, 0.8), abs=heights.place_errors["stone"] + 1e-15)
    assert heights.least_places["stone"] == pytest.approx((3.0, -1.0), abs=heights.place_errors["stone"] + 1e-15)
    assert ways.least_places["stone"] == (0.0, 0.0)
    assert ways.largest_places["stone"] == pytest.approx((3.0, -1.0), abs=1e-15)
    assert 0.0 <= heights.place_errors["stone"] < 1e-14


def test_places_of_extremes_of_parts_and_beside_impacts() -> None:
    scene = read(
        {
            "gravity": [0, -10],
            "bodies": {"ball": {"mass": 1, "at": [1, 0.8]}, "other": {"mass": 1, "at": [5, 0], "velocity": [1, 0]}},
            "connections": [{"kind": "contact", "place": "ball", "on": {"at": [0, 0]}, "restitution": 0.5}],
        }
    )
    (found,) = solve_scene(scene, [0.7], [ExtremesOf("ball.position.y")]).extremes or ()
    assert found.least_places.keys() == {"ball"}
    assert found.least_places["ball"] == pytest.approx((1.0, 0.0), abs=found.place_errors["ball"] + 1e-15)
    assert found.largest_places["ball"] == (1.0, 0.8)


def test_a_speed_that_vanishes_between_two_steps_is_zero_there() -> None:
    """A body on a line that turns back: its velocity changes its sign, so that its least speed is zero."""
    scene = {
        "gravity": [0, -9.81],
        "bodies": {
            "a": {"mass": 2, "at": [1, 0], "velocity": [1, 0]},
            "b": {"mass": "1.04", "inertia": "0.13", "radius": "0.5", "at": [3, 0]},
        },
        "connections": [
            {"kind": "track", "place": "a", "on": {"at": [1, 0]}},
            {"kind": "force", "place": "a", "force": [-3, 0]},
            {"kind": "rolling", "place": "b", "on": {"at": [3, "-0.5"]}},
            {"kind": "spring", "a": "b", "b": "a", "stiffness": 10},
        ],
    }
    answer = solve_scene(read(scene), [0.0, 1.0], (ExtremesOf("a.velocity.length"), "trajectory"))
    (found,) = answer.extremes
    assert found.least <= found.error < 1e-14
    velocity = solve_scene(read(scene), [found.least_time], ("trajectory",))
    assert abs(column(velocity, "a.velocity").values[0, 0]) < 1e-15
