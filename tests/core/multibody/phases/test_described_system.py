"""Trajectories of described scenes, with fewer digits."""

from __future__ import annotations

import math
from fractions import Fraction
from typing import Any

import numpy as np
import pytest

from core.errors import AccuracyUnreachable, BudgetExceeded, InvalidParameter, NotApplicable
from core.multibody.phases.described_system import DescribedSystem
from core.multibody.proven.proven_answer import proven_answer
from core.multibody.solve import solve_scene
from core.multibody.trajectory.occurrences import ExtremesOf, When
from core.multibody.trajectory.scene_request import MOST_NUMBERS, require_affordable
from core.systems.methods import RungeKutta4
from core.systems.trajectory import Trajectory
from tests.core.multibody.worked_examples import TWO_RODS, points, read


def moved(**others: Any) -> Trajectory:
    found = solve_scene(read(TWO_RODS), [0.1, 0.4, 0.9], ("trajectory", "forces-in-time"), **others).trajectory
    assert found is not None
    return found


@pytest.mark.parametrize("digits", [3, 8, 17])
def test_digits_are_as_many_and_the_error_covers_them(digits: int) -> None:
    whole, short = moved(), moved(digits=digits)
    for name, column in short.columns.items():
        difference = whole.columns[name].values - column.values
        change = np.abs(difference) if difference.ndim == 1 else np.linalg.norm(difference, axis=1)
        assert change.max() + whole.columns[name].error <= column.error * (1 + 1e-9)
        for value in column.values.ravel().tolist():
            assert float(f"{value:.{digits - 1}e}") == value
    assert short.accuracy.error >= whole.accuracy.error


@pytest.mark.parametrize("scene", [points((1,), ("2.5",), (1,)), points((1, 1), ("1", "-0.5"), (1, 1))])
def test_an_accuracy_of_half_an_ulp_is_answered_from_the_pairs(scene: dict[str, Any]) -> None:
    """Every sample is the double nearest to the motion, as many digits of which are proven by balls."""
    found = solve_scene(read(scene), [0.1], ("trajectory",), 1.2e-16).trajectory
    proven = proven_answer(read(scene), 20, [Fraction(0.1)]).columns
    assert found is not None
    assert proven is not None
    assert found.accuracy.error <= 1.2e-16
    for name, column in found.columns.items():
        for value, numeral in zip(column.values[0].tolist(), proven[name].values[0], strict=True):
            assert abs(Fraction(value) - Fraction(numeral)) <= Fraction(column.error)
            assert abs(Fraction(value) - Fraction(numeral)) <= Fraction(math.ulp(value)) * Fraction("0.501")


def test_what_doubles_cannot_hold_is_refused_with_the_certified_route() -> None:
    for accuracy in (1e-16, 1e-20):
        with pytest.raises(AccuracyUnreachable, match="samples are doubles") as refusal:
            moved(accuracy=accuracy)
        assert "/v1/certified/scenes" in str(refusal.value.remedy)


def test_meaningful_places_are_those_that_the_error_supports() -> None:
    short = moved(digits="meaningful", method=RungeKutta4(0.05))
    column = short.columns["two.position"]
    for value in column.values.ravel().tolist():
        assert len(repr(value)) < 10
    assert column.error < 5e-2


def test_rounding_beyond_the_accuracy_is_reported() -> None:
    (warning,) = moved(digits=3).warnings
    assert warning.code == "rounded-beyond-accuracy"


def thrown(mass: float | str, strings: int, faster: str = "1") -> dict[str, Any]:
    """Return a bob that is too slow for the top of its circle, on strings between the same ends."""
    return {
        "gravity": [0, f"-9.81*{faster}^2"],
        "bodies": {"bob": {"mass": mass, "at": [0, -1], "velocity": [f"6*{faster}", 0]}},
        "connections": [{"kind": "string", "name": f"s{i}", "through": ["bob", [0, 0]]} for i in range(strings)],
    }


def test_a_string_whose_force_leaves_the_doubles_is_not_said_to_stay_taut() -> None:
    """At any mass it becomes slack after 0.48 s; in doubles the tension of these is infinite, or zero."""
    assert solve_scene(read(thrown("1e300", 1)), [0, 2]).events[0].kind == "slack"
    for mass, faster in (("1e300", "1e5"), ("1e-300", "1e-15")):
        with pytest.raises(NotApplicable, match="whether it stays positive"):
            solve_scene(read(thrown(mass, 1, faster)), [0, 2 / float(faster)])


def test_forces_that_are_not_determined_are_said_not_to_be_watched() -> None:
    found = [solve_scene(read(thrown(1, strings)), [0, 0.1]).trajectory for strings in (1, 2)]
    assert [[notice.code for notice in one.warnings] for one in found if one is not None] == [[], ["end-not-known"]]


def test_a_phase_shorter_than_the_least_double_is_no_failure() -> None:
    """With this friction it stops after 1e-401 s."""
    contact = {"kind": "contact", "name": "c", "place": "b", "on": {"at": [0, 0]}, "friction": "1e300"}
    bodies = {"b": {"mass": 1, "at": [0, 0], "velocity": ["1e-100", 0]}}
    answer = solve_scene(read({"gravity": [0, -9.81], "bodies": bodies, "connections": [contact]}), [0, 1])
    assert [(event.kind, event.time) for event in answer.events] == [("stick", 0.0)]
    assert answer.trajectory is not None
    assert answer.trajectory.columns["b.position"].values.tolist() == [[0.0, 0.0], [0.0, 0.0]]


def test_a_trajectory_has_no_more_numbers_than_one_may_have() -> None:
    """That is known from the description, before anything is computed."""
    bodies = {f"b{k}": {"mass": 1, "at": [k, 0]} for k in range(100)}
    scene = read({"bodies": bodies, "connections": []})
    most = MOST_NUMBERS // (4 * 2 * 100)
    require_affordable(most, scene)
    with pytest.raises(BudgetExceeded, match=str(most)):
        solve_scene(scene, np.linspace(0, 1, most + 1))


PENDULUM = {
    "gravity": [0, -9.81],
    "bodies": {"bob": {"mass": 1, "at": [0.6, -0.8]}},
    "connections": [{"kind": "rod", "a": "bob", "b": [0, 0]}],
}
FALLING = {"gravity": [0, -9.81], "bodies": {"stone": {"mass": 1, "at": [0, 0], "velocity": [1, 0]}}}


@pytest.mark.parametrize(
    ("scene", "end", "output", "error"),
    [
        (PENDULUM, 1.0, ExtremesOf("bob.sped"), InvalidParameter),
        (PENDULUM, 1.0, When("bob.sped", 1), InvalidParameter),
        (PENDULUM, 1.0, "paths-in-time", BudgetExceeded),
        (PENDULUM, 100.0, "paths-in-time", BudgetExceeded),
        (FALLING, 1.0, "paths-in-time", BudgetExceeded),
        (FALLING, -1.0, "paths-in-time", BudgetExceeded),
    ],
)
def test_what_cannot_be_answered_is_refused_before_a_sample_is_computed(
    monkeypatch: pytest.MonkeyPatch, scene: Any, end: float, output: Any, error: type[Exception]
) -> None:
    def computed(*_: Any) -> Any:
        raise AssertionError

    monkeypatch.setattr(DescribedSystem, "trajectory", computed)
    with pytest.raises(error):
        solve_scene(read({"connections": [], **scene}), np.linspace(0.0, end, 20_000), ["trajectory", output])


def test_as_many_times_as_can_be_summed_up_to_are_not_refused() -> None:
    """13 333 intervals of thirty points; along what repeats, times that come again count once."""
    with pytest.raises(BudgetExceeded):
        solve_scene(read({"connections": [], **FALLING}), np.linspace(0.0, 1.0, 13_335), ["paths-in-time"])
    for scene, times in ((FALLING, np.linspace(0.0, 1.0, 13_000)), (FALLING, np.repeat([0.5, 1.0], 10_000))):
        assert solve_scene(read({"connections": [], **scene}), times, ["paths-in-time"]).trajectory is not None
