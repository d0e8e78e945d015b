"""The uncertainty of inputs through events: derivatives of closed forms, and where there are none."""

from __future__ import annotations

from typing import Any

import pytest
from mpmath import diff, mp, mpf, sqrt

from core.multibody.solve import solve_scene
from tests.core.multibody.worked_examples import column, read

SHARE = 1e-4


def ball(restitution: float, height: float) -> dict[str, Any]:
    return {
        "gravity": [0, -9.81],
        "bodies": {"ball": {"mass": 2, "at": [0, height]}},
        "connections": [
            {"kind": "contact", "name": "floor", "place": "ball", "on": {"at": [0, 0]}, "restitution": restitution}
        ],
    }


def test_a_bounce_inherits_what_its_closed_form_says() -> None:
    """After a bounce y = (t - t1) e v - g (t - t1)^2/2 with v = sqrt(2 g h): derivatives by h, g and e."""
    answer = solve_scene(read(ball(0.75, 1.5)), [0.9], ("trajectory",), input_uncertainty=SHARE)

    def place(h: Any, g: Any, e: Any) -> Any:
        late = mpf("0.9") - sqrt(2 * h / g)
        return late * (e * sqrt(2 * g * h) - g * late / 2)

    with mp.workdps(40):
        at = (mpf("1.5"), mpf("9.81"), mpf("0.75"))
        expected = sum(abs(at[i] * diff(place, at, tuple(int(i == j) for j in range(3)))) for i in range(3))
    told = column(answer, "ball.position").inherited
    assert told == pytest.approx(float(SHARE * expected), rel=1e-4)
    assert answer.trajectory is not None
    assert answer.trajectory.accuracy.inherited is not None


def test_the_horizon_is_the_last_instant_at_which_changes_stay_below_the_accuracy() -> None:
    """While it falls the height h - g t^2/2 changes by h + g t^2/2, relative to the largest height of the samples."""
    answer = solve_scene(
        read(ball(0.75, 1.5)), [0.55, 0.9], ("trajectory",), accuracy=1e-9, input_uncertainty=1e-9 / 2.5
    )
    assert answer.trajectory is not None
    largest = abs(column(answer, "ball.position").values[:, 1]).max()
    instants = [0.9 * k / 64 for k in range(1, 65)]
    expected = max(t for t in instants if 1.5 + 9.81 * t**2 / 2 <= 2.5 * largest and t < 0.5)
    assert answer.trajectory.accuracy.horizon == pytest.approx(expected)


def test_slipping_and_rolling_inherit_through_the_time_at_which_rolling_begins() -> None:
    """Rolling at 2 v/3 whatever the friction: the velocity inherits what v does, and nothing of the rest."""
    scene = {
        "gravity": [0, -9.81],
        "bodies": {"disc": {"mass": 1, "inertia": "1/200", "radius": 0.1, "at": [0, 0.1], "velocity": [3, 0]}},
        "let": {},
        "connections": [{"kind": "contact", "name": "floor", "place": "disc", "on": {"at": [0, 0]}, "friction": 0.2}],
    }
    answer = solve_scene(read(scene), [1.0], ("trajectory",), input_uncertainty=SHARE)
    # v/(1 + I/(m R^2)), with the formula of I exact: 1 by v, and 1/3 by m and 2/3 by R, as a share of it.
    assert column(answer, "disc.velocity").inherited == pytest.approx(2 * SHARE * (1 + 1 / 3 + 2 / 3), rel=1e-4)


def test_where_other_numbers_lead_to_other_events_nothing_is_inherited() -> None:
    """A block exactly at the angle of friction sticks; with a little less friction it slides."""
    scene = {
        "gravity": [3, -4],
        "bodies": {"p": {"mass": 1, "at": [0, 0]}},
        "connections": [{"kind": "contact", "name": "slope", "place": "p", "on": {"at": [0, 0]}, "friction": 0.75}],
    }
    answer = solve_scene(read(scene), [1.0], ("trajectory",), input_uncertainty=SHARE)
    assert answer.trajectory is not None
    assert answer.trajectory.accuracy.inherited is None
    assert answer.trajectory.accuracy.why is not None
    assert column(answer, "p.position").inherited is None
