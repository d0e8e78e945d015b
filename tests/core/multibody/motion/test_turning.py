"""Bodies of the plane that nothing turns, at any horizon, against the angle and the gap written out in mpmath."""

from __future__ import annotations

from typing import Any

import mpmath
import pytest

from core.errors import BudgetExceeded
from core.multibody.search import followed
from core.multibody.solve import solve_scene
from tests.core.multibody.worked_examples import column, read

FREE: dict[str, Any] = {"bodies": {"b": {"mass": 1, "inertia": 1, "at": [0, 0], "angular_velocity": "7/3"}}}
ON_AN_AXLE: dict[str, Any] = {
    "bodies": {
        "b": {
            "mass": 1,
            "inertia": 1,
            "at": [1, 0],
            "angle": "0.3",
            "angular_velocity": "-7/3",
            "places": {"p": [-1, 0]},
        }
    },
    "connections": [{"kind": "pin", "a": "b.p", "b": ["1 - cos(0.3)", "-sin(0.3)"]}],
}


@pytest.mark.parametrize("horizon", [1e2, 1e4, 1e6, 1e12, 1e17])
def test_the_angle_counts_every_turn(horizon: float) -> None:
    times = [horizon, -horizon, 0.5 * horizon, 1.0]
    for scene, start, sign in ((FREE, "0", 1), (ON_AN_AXLE, "0.3", -1)):
        answer = solve_scene(read(scene), times, ("trajectory",))
        assert answer.trajectory is not None
        with mpmath.workdps(50):
            right = [mpmath.mpf(start) + sign * mpmath.mpf(7) / 3 * mpmath.mpf(time) for time in times]
            errors = [abs(x - y) for x, y in zip(column(answer, "b.angle").values.tolist(), right, strict=True)]
        assert max(errors) <= answer.trajectory.columns["b.angle"].error


def drifting(height: int) -> dict[str, Any]:
    """Return a rod that drifts towards a wall while it turns: its end is at height - t + sin(7.3 t)."""
    body = {"mass": 1, "inertia": 1, "at": [0, height], "velocity": [0, -1], "angular_velocity": 7.3}
    contact = {"kind": "contact", "name": "c", "place": "b.p", "on": {"at": [0, 0]}, "restitution": 0}
    return {"gravity": [0, 0], "bodies": {"b": body | {"places": {"p": [1, 0]}}}, "connections": [contact]}


def test_a_slow_approach_of_many_turns_ends_at_the_first_touch() -> None:
    """The end dips by 1 m in every turn of 0.86 s, while the rod comes nearer by as much."""
    (event,) = solve_scene(read(drifting(900)), [899.5], ("trajectory",)).events
    with mpmath.workdps(30):
        gap = [900 - t + mpmath.sin(mpmath.mpf("7.3") * t) for t in mpmath.linspace(898.9, event.time - 1e-9, 5000)]
        assert min(gap) > 0
        first = mpmath.findroot(lambda t: 900 - t + mpmath.sin(mpmath.mpf("7.3") * t), event.time)
    assert abs(event.time - first) <= event.error


def test_more_turns_than_can_be_searched_are_refused_and_not_skipped(monkeypatch: pytest.MonkeyPatch) -> None:
    # Of the pieces that are allowed a few, as all of them take long.
    monkeypatch.setattr(followed, "MOST_PIECES", 2_000)
    with pytest.raises(BudgetExceeded, match="pieces of the motion") as refused:
        solve_scene(read(drifting(100_000)), [1e5], ("trajectory",))
    assert refused.value.path == ("times",)


@pytest.mark.parametrize("horizon", [1e4, 1e100])
def test_what_repeats_in_every_turn_is_looked_at_for_one(horizon: float) -> None:
    """A dumbbell on a string in free space: the tension is the same for ever."""
    ends = {name: {"mass": 1, "at": [x, 0], "velocity": [0, 3 * x]} for name, x in (("a", 1), ("b", -1))}
    string = {"kind": "string", "name": "s", "through": ["a", "b"]}
    answer = solve_scene(read({"gravity": [0, 0], "bodies": ends, "connections": [string]}), [horizon])
    assert not answer.events


@pytest.mark.parametrize("centre", [("0", "0"), ("3", "-7/3"), ("1e6/3", "1/7")], ids=str)
@pytest.mark.parametrize("kind", ["rod", "track", "in space"])
def test_a_place_goes_round_any_centre_at_a_constant_rate(kind: str, centre: tuple[str, str]) -> None:
    """Without gravity: (x, y) = c + 0.5 (cos, sin)(0.9 t/0.5)."""
    more = ["1/8"] if kind == "in space" else []
    at = [*centre, *more]
    body = {"mass": "1/3", "at": [f"{centre[0]} + 0.5", *at[1:]], "velocity": [0, 0.9, 0][: len(at)]}
    held: dict[str, Any] = {"kind": "rod", "a": "b", "b": at}
    if kind == "track":
        held = {"kind": "track", "place": "b", "on": {"at": at, "radius": 0.5}}
    times = [0.1, 3.0, 1e3, 1e12]
    answer = solve_scene(read({"bodies": {"b": body}, "connections": [held]}), times, ("trajectory",))
    assert answer.model.name == "uniform rotation"
    found = column(answer, "b.position")
    with mpmath.workdps(50):
        x, y = (mpmath.mpf(p) / mpmath.mpf(q or 1) for p, _, q in (one.partition("/") for one in centre))
        for time, row in zip(times, found.values.tolist(), strict=True):
            angle = mpmath.mpf(9) / 5 * mpmath.mpf(time)
            assert abs(row[0] - x - mpmath.cos(angle) / 2) <= found.error
            assert abs(row[1] - y - mpmath.sin(angle) / 2) <= found.error
        assert answer.period is not None
        assert abs(answer.period - 10 * mpmath.pi / 9) <= (answer.period_error or 0)
