"""When a quantity takes a value in a motion through events, and how far it goes, by closed forms of their own."""

from __future__ import annotations

from fractions import Fraction
from typing import Any

import numpy as np
import pytest
from mpmath import asin, mp, mpf, sqrt

from core.errors import BudgetExceeded, InvalidParameter
from core.multibody.answer import Occurrence
from core.multibody.solve import solve_scene
from core.multibody.trajectory.occurrences import ExtremesOf, When
from tests.core.multibody.phases.test_sums import bouncing
from tests.core.multibody.worked_examples import read

G = mpf("9.81")
STONE = {
    "gravity": [0, -9.81],
    "bodies": {"stone": {"mass": 1, "at": [0, -0.5], "velocity": [4, 0]}},
    "connections": [{"kind": "string", "name": "s", "through": ["stone", [0, 0]]}],
}


def found(scene: Any, end: float, search: When) -> tuple[Occurrence, ...]:
    answer = solve_scene(read(scene), [end], ["trajectory", search])
    assert answer.occurrences is not None
    return answer.occurrences


def require_at(one: Occurrence, time: Any) -> None:
    with mp.workdps(30):
        assert abs(one.time - mpf(time)) <= one.error
    assert one.error <= 1e-12


def bounce(n: int) -> Any:
    """Return when the n-th bounce begins."""
    first = sqrt(2 * mpf("1.25") / G)
    return first * (1 + 2 * sum(mpf("0.8") ** k for k in range(1, n)))


def test_every_bounce_passes_a_height_twice() -> None:
    """0.5 m is passed on the way down, then twice as long as 1.25 * 0.64^n is higher."""
    with mp.workdps(30):
        times = [sqrt(2 * mpf("0.75") / G)]
        for n in (1, 2):
            speed = G * bounce(1) * mpf("0.8") ** n
            reach = sqrt(speed**2 - G)
            times += [bounce(n) + (speed - reach) / G, bounce(n) + (speed + reach) / G]
    every = found(bouncing(), 6.0, When("ball.position.y", 0.5))
    assert [one.nth for one in every] == [1, 2, 3, 4, 5]
    for one, time in zip(every, times, strict=True):
        require_at(one, time)
    (third,) = found(bouncing(), 6.0, When("ball.position.y", 0.5, 3))
    assert third == every[2]


@pytest.mark.parametrize("height", ["1e-25", "1e-20", "1e-16", "1e-9"])
def test_a_height_just_above_the_floor_is_passed_before_and_after_every_bounce(height: str) -> None:
    every = found(bouncing(), 2.2, When("ball.position.y", height))
    with mp.workdps(50):
        times = []
        for n in (1, 2, 3):
            speed = G * bounce(1) * mpf("0.8") ** (n - 1)
            ahead, behind = (v - sqrt(v**2 - 2 * G * mpf(height)) for v in (speed, mpf("0.8") * speed))
            times += [bounce(n) - ahead / G, bounce(n) + behind / G]
    for one, time in zip(every, times, strict=True):
        require_at(one, time)


def test_what_a_velocity_is_before_an_impact_is_taken_there() -> None:
    """From 1.25 m with g 9.81 the speed is sqrt(24.525) at the floor: reached, and left by a jump."""
    (one,) = found(bouncing(), 1.0, When("ball.velocity.y", "-sqrt(2*9.81*1.25)"))
    with mp.workdps(30):
        require_at(one, bounce(1))


def test_what_an_impact_jumps_over_is_not_taken() -> None:
    """The velocity is zero at the top of every arc, not at the impacts that turn it; bounce 20 is among the summed."""
    every = found(bouncing(), 6.0, When("ball.velocity.y", 0.0))
    with mp.workdps(30):
        for n in (1, 2, 20):
            require_at(every[n - 1], bounce(n) + bounce(1) * mpf("0.8") ** n)


def test_a_value_at_an_event_is_taken_once() -> None:
    every = found(bouncing(), 3.0, When("ball.position.y", 0.0))
    assert len(every) == 5
    with mp.workdps(30):
        for n, one in enumerate(every, 1):
            require_at(one, bounce(n))


def test_what_keeps_its_value_takes_it_when_it_comes_there() -> None:
    """A block that friction brings to rest has no velocity from then on."""
    scene = {
        "gravity": [0, -9.81],
        "bodies": {"block": {"mass": 1, "at": [0, 0], "velocity": [3, 0]}},
        "connections": [{"kind": "contact", "name": "f", "place": "block", "on": {"at": [0, 0]}, "friction": 0.25}],
    }
    (one,) = found(scene, 5.0, When("block.velocity.x", 0.0))
    require_at(one, 3 / (mpf("0.25") * G))


def test_a_slack_string_lets_the_stone_fall() -> None:
    """The parabola's top, after the string is slack at 0.33986875327139788 s: by its own closed form."""
    with mp.workdps(30):
        cosine = (G - 16) / (mpf(3) / 2 * G)
        speed = sqrt(16 - G * (1 - cosine))
        top = mpf("0.33986875327139788") + speed * sqrt(1 - cosine**2) / G
    (first,) = found(STONE, 0.6, When("stone.velocity.y", 0.0))
    require_at(first, top)
    # The tension is zero all the while, and takes that value where it begins.
    answer = solve_scene(read(STONE), [0.6], ["forces-in-time", When("s.tension", 0.0)])
    assert answer.occurrences is not None
    (slack,) = answer.occurrences
    assert slack.time == answer.events[0].time == pytest.approx(0.33986875327139788, rel=1e-15)


def test_extremes_have_both_sides_of_a_jump() -> None:
    answer = solve_scene(
        read(bouncing()), [1.2], ["trajectory", ExtremesOf("ball.velocity.y"), ExtremesOf("ball.position.y")]
    )
    assert answer.extremes is not None
    rates, places = answer.extremes
    with mp.workdps(30):
        fall = float(G * bounce(1))
    assert rates.least == pytest.approx(-fall, abs=rates.error)
    assert rates.largest == pytest.approx(0.8 * fall, abs=rates.error)
    assert rates.least_time == rates.largest_time == pytest.approx(float(bounce(1)), rel=1e-15)
    assert (places.largest, places.largest_time) == (1.25, 0.0)
    assert places.least == pytest.approx(0.0, abs=places.error)
    assert (places.until, places.periodic) == (1.2, False)


def test_a_smooth_extreme_within_a_phase_is_found() -> None:
    """A pendulum released at 60 degrees against an elastic stop at the lowest place: it turns back at 60 degrees."""
    scene = {
        "gravity": [0, -9.81],
        "let": {"a": "pi/3"},
        "bodies": {"bob": {"mass": 1, "at": ["sin(a)", "-cos(a)"]}},
        "connections": [
            {"kind": "rod", "name": "rod", "a": "bob", "b": [0, 0]},
            {
                "kind": "contact",
                "name": "wall",
                "place": "bob",
                "on": {"at": [0, 0], "slope": {"degrees": -90}},
                "restitution": 1,
            },
        ],
    }
    answer = solve_scene(
        read(scene), [2.0], ["trajectory", When("bob.velocity.y", 0.0, 1), ExtremesOf("bob.position.y")]
    )
    assert answer.occurrences is not None
    assert answer.extremes is not None
    with mp.workdps(30):
        # A quarter of the period to the wall, where the velocity is level before and after, a quarter back.
        quarter = mp.ellipk(mp.sin(mp.pi / 6) ** 2) / sqrt(G)
        assert abs(asin(mpf("0.5")) - mp.pi / 6) < 1e-25
    require_at(answer.occurrences[0], quarter)
    assert answer.extremes[0].largest == pytest.approx(-0.5, abs=answer.extremes[0].error + 1e-15)
    assert answer.extremes[0].least == pytest.approx(-1.0, abs=answer.extremes[0].error + 1e-15)


def test_searches_go_up_to_the_end_of_a_motion_that_is_undecided() -> None:
    chalk = {
        "mass": 1,
        "inertia": 0.3333,
        "at": [0.5, 0.8660254037844386],
        "angle": {"degrees": 60},
        "velocity": [-3, 0],
        "places": {"foot": [-1, 0]},
    }
    board = {"kind": "contact", "name": "board", "place": "chalk.foot", "on": {"at": [0, 0]}, "friction": 2}
    scene = {"gravity": [0, -9.81], "bodies": {"chalk": chalk}, "connections": [board]}
    answer = solve_scene(read(scene), [1.0], ["trajectory", When("chalk.position.y", 0.0), ExtremesOf("chalk.angle")])
    assert answer.occurrences == ()
    assert answer.extremes == ()


def test_bounces_that_hardly_lose_are_too_many_to_be_searched() -> None:
    with pytest.raises(BudgetExceeded, match="followed one by one") as refused:
        found(bouncing(0.99), 150.0, When("ball.position.y", 0.01))
    assert refused.value.remedy is not None


def test_a_quantity_that_is_none_names_those_that_are() -> None:
    with pytest.raises(InvalidParameter, match=r"ball\.velocity") as fault:
        found(bouncing(), 1.0, When("ball.speed", 0.0))
    assert fault.value.path == ("outputs", 1, "when", "quantity")


def test_samples_at_the_impacts_do_not_hide_that_rates_jump_there() -> None:
    """With g 10 from 1.25 m and restitution 1/2: impacts at 0.5, 1 and 1.25 s, and between them two tops."""
    scene = bouncing("1/2") | {"gravity": [0, -10]}
    times = [0.0, 0.25, 0.5, 0.75, 1.0, 1.125, 1.25, 1.5, 1.75]
    answer = solve_scene(read(scene), times, ["trajectory", When("ball.velocity.y", 0)])
    assert answer.occurrences is not None
    assert [one.time for one in answer.occurrences[:2]] == [0.75, 1.125]


@pytest.mark.parametrize(("heavy", "acceleration"), [(2, "1/3"), (3, "1/2"), (9, "4/5")])
@pytest.mark.parametrize("restitution", ["0", "1/2"])
def test_a_weight_that_reaches_its_peg_as_the_other_one_lands_ends_there(
    heavy: int, acceleration: str, restitution: str
) -> None:
    """Weights of m and 1 kg at -1 m: a = g (m - 1)/(m + 1), and both go 1 m in sqrt(2/a) s."""
    bodies = {"left": {"mass": heavy, "at": ["-1/2", -1]}, "right": {"mass": 1, "at": ["1/2", -1]}}
    through = ["left", ["-1/2", 0], ["1/2", 0], "right"]
    string = {"kind": "string", "name": "s", "through": through, "restitution": restitution}
    floor = {"kind": "contact", "place": "left", "on": {"at": [0, -2]}, "restitution": "1/2"}
    scene = {"gravity": [0, -10], "bodies": bodies, "connections": [string, floor]}
    answer = solve_scene(read(scene), [3.0])
    assert answer.ended is not None
    assert (answer.ended.kind, answer.ended.name) == ("singular", "s")
    with mp.workdps(30):
        time = sqrt(mpf("0.2") / mpf(Fraction(acceleration).numerator) * Fraction(acceleration).denominator)
        assert abs(answer.ended.time - time) <= answer.ended.error + 1e-15


@pytest.mark.parametrize("angle", ["0.3", "acos(4/5)", "1.2"])
def test_a_sample_at_the_time_of_an_event_is_that_after_it(angle: str) -> None:
    """A pendulum against a wall at its lowest place: times of events are no doubles, and rounded either way."""
    bob = {"mass": 2, "at": [f"sin({angle})", f"-cos({angle})"]}
    rod = {"kind": "rod", "a": "bob", "b": [0, 0]}
    wall = {
        "kind": "contact",
        "name": "wall",
        "place": "bob",
        "on": {"at": [0, 0], "slope": {"degrees": -90}},
        "restitution": "1/2",
    }
    scene = read({"gravity": [0, -10], "bodies": {"bob": bob}, "connections": [rod, wall]})
    times = [event.time for event in solve_scene(scene, [3.0]).events]
    outputs = ["trajectory", "energy-in-time", "work-in-time"]
    columns = solve_scene(scene, sorted([0.0, *times, 3.0]), outputs).trajectory.columns
    assert len(times) >= 2
    assert all(columns["bob.velocity"].values[1:-1, 0] > 0.0)
    start = columns["energy.kinetic"].values[0] + columns["energy.potential"].values[0]
    left = columns["energy.kinetic"].values + columns["energy.potential"].values - columns["wall.impacts.work"].values
    assert np.max(np.abs(left - start)) < 1e-12


@pytest.mark.parametrize("end", [1.0, 3.0])
def test_both_sides_of_a_jump_at_the_last_time_count_for_extremes(end: float) -> None:
    """Two stones at 1 m from one another, one of which rises at 1 m/s: their string of sqrt(2) m is taut at 1 s."""
    bodies = {"a": {"mass": 1, "at": [0, 1]}, "b": {"mass": 1, "at": [1, 1], "velocity": [0, 1]}}
    string = {"kind": "string", "through": ["a", "b"], "length": "sqrt(2)"}
    scene = {"gravity": [0, -9.81], "bodies": bodies, "connections": [string]}
    answer = solve_scene(read(scene), [end], ["trajectory", ExtremesOf("a.velocity.x"), ExtremesOf("b.velocity.x")])
    assert [(one.kind, one.time) for one in answer.events] == [("taut", 1.0)]
    if end == 1.0:
        # A quarter of the relative velocity along 45 degrees, in each direction.
        one, other = answer.extremes or ()
        assert (one.least, other.largest) == (0.0, 0.0)
        assert one.largest == pytest.approx(0.25, abs=1e-14)
        assert other.least == pytest.approx(-0.25, abs=1e-14)
        assert one.largest_time == other.least_time == 1.0


def test_of_equal_extremes_the_first_is_answered() -> None:
    answer = solve_scene(read(bouncing(1)), [9.0], ["trajectory", ExtremesOf("ball.position.y")])
    (height,) = answer.extremes or ()
    assert height.largest_time == 0.0
    assert abs(height.least_time - bounce(1)) <= height.errors["least_time"]
