"""Scenes of parts that share no connection, held against each part alone and against closed forms."""

import math
from typing import Any

import numpy as np
import pytest
from mpmath import mp

from core.errors import AccuracyUnreachable, BudgetExceeded, InvalidParameter, NotApplicable
from core.multibody.answer import SceneSolution
from core.multibody.solve import solve_scene
from core.multibody.trajectory.occurrences import ExtremesOf, When
from core.multibody.trajectory.scene_request import MOST_NUMBERS
from core.systems.budget import Budget
from tests.core.multibody.worked_examples import read

Description = dict[str, Any]
ALL = ("accelerations", "forces", "energy", "trajectory", "forces-in-time", "energy-in-time", "momenta-in-time",
       "work-in-time", "paths-in-time")  # fmt: skip

PENDULUM: Description = {
    "bodies": {"bob": {"mass": 1, "at": ["sin(2.5)", "-cos(2.5)"]}},
    "connections": [{"kind": "rod", "name": "rod", "a": "bob", "b": [0, 0]}],
}
BALL: Description = {
    "bodies": {"ball": {"mass": 2, "at": [3, 1.25]}},
    "connections": [
        {"kind": "contact", "name": "floor", "place": "ball", "on": {"at": [0, 0]}, "restitution": 0.5},
    ],
}
FALL: Description = {
    "bodies": {"moth": {"mass": 1, "at": [9, 0]}, "lamp": {"mass": 1, "at": [10, 0]}},
    "connections": [{"kind": "inverse-square", "a": "moth", "b": "lamp", "strength": 1}],
}
DOUBLE: Description = {
    "bodies": {"u": {"mass": 1, "at": [21, 0]}, "w": {"mass": 1, "at": [22, 0]}},
    "connections": [{"kind": "rod", "a": "u", "b": [20, 0]}, {"kind": "rod", "a": "u", "b": "w"}],
}


def scene(*parts: Description, gravity: Any = (0, -10)) -> Any:
    bodies: Description = {}
    connections: list[Description] = []
    for part in parts:
        bodies |= part["bodies"]
        connections += part["connections"]
    return read({"gravity": list(gravity), "bodies": bodies, "connections": connections})


def columns(answer: SceneSolution) -> dict[str, Any]:
    assert answer.trajectory is not None
    return dict(answer.trajectory.columns)


def test_every_part_has_the_samples_errors_events_and_model_that_it_has_alone() -> None:
    times = [0.0, 0.3, 1.0, 2.5, 3.0, 10.0]
    both = solve_scene(scene(PENDULUM, BALL), times, ALL)
    found = columns(both)
    events: list[Any] = []
    for k, part in enumerate((PENDULUM, BALL)):
        alone = solve_scene(scene(part), times, ALL)
        assert both.model.apart[k] == alone.model.apart[0]
        for name, column in columns(alone).items():
            if name.split(".")[0] in ("bob", "rod", "ball", "floor"):
                assert np.array_equal(found[name].values, column.values)
                assert (found[name].error, found[name].how) == (column.error, column.how)
        for group in ("accelerations", "forces"):
            assert dict(getattr(alone, group)).items() <= dict(getattr(both, group)).items()
        events += alone.events
    assert list(both.events) == events
    assert events[-1].kind == "settle"


def test_columns_of_the_whole_scene_are_the_sums_of_those_of_its_parts() -> None:
    times = [0.0, 0.3, 1.0]
    found = columns(solve_scene(scene(PENDULUM, BALL), times, ALL))
    alone = [columns(solve_scene(scene(part), times, ALL)) for part in (PENDULUM, BALL)]
    for name in ("energy.kinetic", "energy.potential", "momentum", "angular_momentum", "gravity.work"):
        total = sum(part[name].values for part in alone)
        assert np.array_equal(found[name].values, total)
        assert found[name].error >= sum(part[name].error for part in alone)


def test_a_touch_of_one_part_does_not_end_the_motion() -> None:
    motion = solve_scene(scene(PENDULUM, BALL), [0.0, 0.8]).trajectory
    assert motion is not None
    assert [event.kind for event in motion.events] == ["touch"]
    assert motion.ended == "horizon"


def test_touches_at_one_instant_in_parts_that_share_nothing() -> None:
    """Two equal pendulums, each against a wall below its pivot: a quarter of a period, by the elliptic integral."""
    bodies = {name: {"mass": 1, "at": [x + 0.6, -0.8]} for name, x in (("a", 0), ("b", 5))}
    rods = [{"kind": "rod", "a": name, "b": [x, 0]} for name, x in (("a", 0), ("b", 5))]
    walls = [
        {"kind": "contact", "place": name, "on": {"at": [x, 0], "slope": {"degrees": -90}}}
        for name, x in (("a", 0), ("b", 5))
    ]
    answer = solve_scene(read({"gravity": [0, -10], "bodies": bodies, "connections": rods + walls}), [0.8])
    with mp.workdps(30):
        sine = mp.sqrt((1 - mp.mpf("0.8")) / 2)
        quarter = mp.ellipk(sine**2) / mp.sqrt(10)
        assert [event.kind for event in answer.events] == ["touch", "touch"]
        for event in answer.events:
            assert abs(event.time - quarter) <= event.error
    assert answer.ended is None
    assert answer.phases is not None
    assert [list(phase.states.values()) for phase in answer.phases] == [["open", "open"], ["closed", "closed"]]


def test_a_motor_turns_at_its_rate_beside_something_else() -> None:
    wheel = {"mass": 1, "inertia": 0.1, "at": [7, 7]}
    driven = [{"kind": "motor", "a": "c", "rate": -3.2}, {"kind": "pin", "a": "c", "b": [7, 7]}]
    motor: Description = {"bodies": {"c": wheel}, "connections": driven}
    found = columns(solve_scene(scene(motor, PENDULUM, gravity=(0, -9.81)), [0.5, 2.0]))
    assert np.abs(found["c.angle"].values - [-1.6, -6.4]).max() <= found["c.angle"].error
    assert np.array_equal(found["c.angular_velocity"].values, [-3.2, -3.2])


def test_phases_begin_at_the_events_of_every_part() -> None:
    other: Description = {
        "bodies": {"stone": {"mass": 1, "at": [9, 4.05]}},
        "connections": [{"kind": "contact", "name": "sand", "place": "stone", "on": {"at": [9, 0]}}],
    }
    answer = solve_scene(scene(BALL, other, PENDULUM), [0.95])
    assert answer.phases is not None
    assert [phase.start for phase in answer.phases] == [0.0, *(event.time for event in answer.events)]
    assert [phase.end for phase in answer.phases[:-1]] == [phase.start for phase in answer.phases[1:]]
    assert answer.phases[-1].end is None
    assert [event.name for event in answer.events] == ["floor", "sand"]
    assert answer.phases[-1].states == {"floor": "open", "sand": "closed"}
    assert answer.phases[0].degrees_of_freedom == 3


def test_the_motion_ends_where_that_of_the_first_part_ends() -> None:
    """Two particles fall into one another: half a period of the degenerate ellipse, pi sqrt(a^3/(G m)), a = 1/2."""
    end = math.pi * math.sqrt(0.5**3 / 2)
    searches = [When("bob.position.y", 0.5), ExtremesOf("bob.velocity.length"), When("moth.position.x", 9.1)]
    times = [0.2, 3.0, 0.1, 0.8]
    answer = solve_scene(scene(DOUBLE, FALL, PENDULUM, gravity=(0, 0)), times, ["trajectory", *searches])
    assert answer.ended is not None
    assert (answer.ended.kind, answer.problem) == ("singular", None)
    assert answer.ended.time == pytest.approx(end, rel=1e-9)
    assert answer.trajectory is not None
    assert (list(answer.trajectory.rows), list(answer.trajectory.time)) == ([0, 2], [0.2, 0.1])
    assert all(len(column.values) == 2 for column in columns(answer).values())
    assert answer.extremes is not None
    assert answer.extremes[0].until == answer.ended.time
    assert answer.occurrences is not None
    assert [one.quantity for one in answer.occurrences] == ["moth.position.x"]


def test_an_end_that_is_among_the_times_takes_no_further_sample() -> None:
    parts = scene(FALL, PENDULUM, gravity=(0, 0))
    ended = solve_scene(parts, [3.0]).ended
    assert ended is not None
    answer = solve_scene(parts, [0.1, 0.2, ended.time], ("trajectory",), budget=Budget(samples=3))
    assert answer.trajectory is not None
    assert list(answer.trajectory.time)[:2] == [0.1, 0.2]


def test_a_part_that_is_refused_later_is_answered_up_to_the_end_of_another() -> None:
    """A double pendulum cannot be followed for 1e4 s, nor has it to be."""
    with pytest.raises((AccuracyUnreachable, BudgetExceeded)):
        solve_scene(scene(DOUBLE, PENDULUM), [0.5, 1e4])
    horizontal = {**FALL["connections"][0], "strength": 4}
    held = [{"kind": "track", "place": name, "on": {"at": [0, 0]}} for name in FALL["bodies"]]
    fall = {"bodies": FALL["bodies"], "connections": [horizontal, *held]}
    answer = solve_scene(scene(DOUBLE, fall), [0.1, 1e4])
    assert answer.trajectory is not None
    assert list(answer.trajectory.time) == [0.1]


def test_what_is_undecided_in_a_part_at_the_start_ends_the_motion_there() -> None:
    """A chalk that slides so fast that no force keeps it from entering the floor: Painleve's paradox."""
    chalk: Description = {
        "bodies": {
            "chalk": {"mass": 1, "inertia": "1/12", "at": ["-cos(1)/2 + 40", "sin(1)/2"], "angle": "-1",
                    "velocity": [5, 0], "places": {"tip": [0.5, 0]}},
        },
        "connections": [{"kind": "contact", "name": "cb", "place": "chalk.tip", "on": {"at": [0, 0]}, "friction": 3}],
    }  # fmt: skip
    asked = ("trajectory", When("chalk.position.x", 0.0), ExtremesOf("chalk.velocity.x"))
    alone, beside = (solve_scene(scene(*parts), [0.0, 1.0], asked) for parts in ((chalk,), (PENDULUM, chalk)))
    assert alone.problem is not None
    assert (alone.occurrences, alone.extremes) == (beside.occurrences, beside.extremes) == ((), ())
    assert (beside.problem, beside.ended, beside.phases) == (alone.problem, alone.ended, ())
    assert beside.model.name == alone.model.name == "undecided"


def test_searches_are_answered_in_the_order_in_which_they_are_requested() -> None:
    searches = [
        When("ball.position.y", 0.2, 2),
        ExtremesOf("bob.velocity.length"),
        When("bob.position.x", 0.0),
        When("ball.position.y", 0.2),
        ExtremesOf("ball.position.y"),
        When("bob.position.x", 0.0, 5),
    ]
    both = solve_scene(scene(PENDULUM, BALL), [3.0], searches)
    one = solve_scene(scene(PENDULUM), [3.0], searches[1:3] + searches[5:])
    other = solve_scene(scene(BALL), [3.0], [searches[0], *searches[3:5]])
    for found in (both, one, other):
        assert found.occurrences is not None
        assert found.extremes is not None
    crossings = len(one.occurrences)
    assert crossings > 1
    assert both.occurrences == (other.occurrences[0], *one.occurrences, *other.occurrences[1:])
    assert both.extremes == (*one.extremes, *other.extremes)


def test_quantities_of_the_whole_scene_are_searched_too() -> None:
    free: Description = {"bodies": {"x": {"mass": 1, "at": [0, 0]}, "y": {"mass": 1, "at": [1, 0]}}, "connections": []}
    answer = solve_scene(scene(free), [2.0], [When("energy.kinetic", 100.0)])
    assert answer.occurrences is not None
    (found,) = answer.occurrences
    assert abs(found.time - 1.0) <= found.error


def test_the_uncertainty_of_inputs_acts_as_in_each_part_alone() -> None:
    times = [0.5, 2.0]
    both = solve_scene(scene(PENDULUM, DOUBLE), times, ("trajectory",), input_uncertainty=1e-6)
    assert both.trajectory is not None
    stated = []
    for part in (PENDULUM, DOUBLE):
        alone = solve_scene(scene(part), times, ("trajectory",), input_uncertainty=1e-6)
        assert alone.trajectory is not None
        stated.append(alone.trajectory.accuracy)
        for name, column in columns(alone).items():
            assert columns(both)[name].inherited == column.inherited
    assert both.trajectory.accuracy.inherited == max(one.inherited for one in stated)
    horizons = [one.horizon for one in stated if one.horizon is not None]
    assert both.trajectory.accuracy.horizon == min(horizons, default=None)


def test_samples_are_rounded_once() -> None:
    answer = solve_scene(scene(PENDULUM, BALL), [0.3, 1.0], ("trajectory", "energy-in-time"), digits=6)
    for column in columns(answer).values():
        flat = column.values.ravel()
        assert all(float(f"{value:.5e}") == value for value in flat)


def test_faults_of_all_parts_are_told_with_their_places_in_the_description() -> None:
    wrong = [
        {"bodies": PENDULUM["bodies"], "connections": [{"kind": "spring", "a": "bob", "b": [0, 0], "stiffness": -1}]},
        {"bodies": BALL["bodies"], "connections": [{"kind": "damper", "a": "ball", "b": [0, 0], "coefficient": -1}]},
    ]
    with pytest.raises(InvalidParameter) as found:
        solve_scene(scene(*wrong), [1.0])
    paths = [fault.path for fault in (found.value, *found.value.further)]
    assert paths == [("connections", 0, "stiffness"), ("connections", 1, "coefficient")]


def test_a_fault_that_all_parts_have_is_told_once() -> None:
    with pytest.raises(InvalidParameter) as found:
        solve_scene(scene(PENDULUM, BALL, gravity=(0, "nothing")), [1.0])
    assert (found.value.path, found.value.further) == (("gravity", 1), ())


def test_more_samples_than_one_trajectory_may_have_are_refused_of_all_parts_together() -> None:
    bodies = {f"b{k}": {"mass": 1, "at": [k, 0]} for k in range(4)}
    count = MOST_NUMBERS // (4 * 2) // 3
    with pytest.raises(BudgetExceeded):
        solve_scene(read({"gravity": [0, -10], "bodies": bodies}), np.linspace(0, 1, count), ("trajectory",))


def test_methods_and_equilibria_are_of_the_whole_scene() -> None:
    pair: Description = {
        "bodies": {"q": {"mass": 1, "at": [30, -2]}},
        "connections": [{"kind": "rod", "a": "q", "b": [30, 0]}],
    }
    answer = solve_scene(scene(PENDULUM, pair), outputs=("equilibria",))
    assert answer.equilibria is not None
    heights = sorted((round(one.positions["bob"][1]), round(one.positions["q"][1])) for one in answer.equilibria)
    assert heights == [(-1, -2), (-1, 2), (1, -2), (1, 2)]
    with pytest.raises(NotApplicable):
        solve_scene(scene(PENDULUM, BALL), outputs=("equilibria",))


def test_only_what_moves_gives_a_scene_its_period() -> None:
    still: Description = {
        "bodies": {"q": {"mass": 1, "at": [30, -2]}},
        "connections": [{"kind": "rod", "a": "q", "b": [30, 0]}],
    }
    one = solve_scene(scene(PENDULUM), [1.0]).period
    assert one is not None
    assert solve_scene(scene(still, PENDULUM), [1.0]).period == one
    assert solve_scene(scene(still, PENDULUM), [1.0]).model.name == "one period"
    assert solve_scene(scene(BALL, PENDULUM), [1.0]).period is None
    assert solve_scene(scene(BALL, PENDULUM), [1.0]).model.name == "parts apart"
