"""What has just let go opens with a power of time; a string may be slack for less than doubles resolve.

A stone on a string of length l that has the speed v at its lowest place, v^2 = 5 g l (1 - e), is slack beside the
highest place. The gap is a t^3 - b t^4 from there on: it is taut again after the ratio of both.
"""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from mpmath import cos, mp, mpf, sin, sqrt

from core.multibody.solve import solve_scene
from tests.core.multibody.worked_examples import read

LENGTH, GRAVITY = mpf("0.5"), mpf("9.81")
SHORT = ["1e-12", "1e-14", "1e-17", "1e-20"]


def stone(short: str, at: float = 0.0, **string: Any) -> dict[str, Any]:
    return {
        "gravity": [0, -9.81],
        "bodies": {"p": {"mass": 1, "at": [at, -0.5], "velocity": [f"sqrt(24.525*(1-{short}))", 0]}},
        "connections": [{"kind": "string", "name": "s", "through": ["p", [at, 0]], **string}],
    }


def slack_for(short: str) -> float:
    """Return for how long the stone follows its parabola inside the circle, from sixty digits."""
    with mp.workdps(60):
        # Energy, and no tension: 5 (1 - e) - 2 = 3 cos.
        above = mp.acos((3 - 5 * mpf(short)) / 3)
        rising = sqrt(GRAVITY * LENGTH * cos(above)) * sin(above)
        # x^2 + y^2 - l^2 along the parabola is (g^2/4) t^4 - g v_y t^3: its lower powers vanish.
        return float(4 * rising / GRAVITY)


@pytest.mark.parametrize("short", SHORT)
@pytest.mark.parametrize("restitution", [0, 0.5])
def test_a_string_is_taut_again_after_less_than_doubles_resolve(short: str, restitution: float) -> None:
    answer = solve_scene(read(stone(short, restitution=restitution)), np.linspace(0.0, 0.9, 10), ("trajectory",))
    slack, taut = answer.events[:2]
    assert [slack.kind, taut.kind] == ["slack", "taut"]
    assert taut.time - slack.time == pytest.approx(slack_for(short), abs=slack.error + taut.error + 2.0**-53)


def test_it_is_so_every_time_the_stone_comes_by() -> None:
    events = solve_scene(read(stone("1e-14")), [3.0], ("trajectory",)).events
    assert [event.kind for event in events] == ["slack", "taut"] * 3


def test_a_string_that_is_slack_for_no_time_that_is_known_stays_taut() -> None:
    assert solve_scene(read(stone("1e-36")), [3.0], ("trajectory",)).events == ()


def test_it_does_so_far_from_the_origin() -> None:
    near, far = (solve_scene(read(stone("1e-14", at)), [0.9], ("trajectory",)).events for at in (0.0, 1e3))
    assert [event.kind for event in near] == [event.kind for event in far] == ["slack", "taut"]
    assert [event.time for event in near] == pytest.approx([event.time for event in far], abs=2e-16)
