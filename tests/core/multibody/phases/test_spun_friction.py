"""Friction in a plane that spins about its vertical: answered where Coriolis' force has no part in it."""

from __future__ import annotations

import math
from typing import Any

import pytest

from core.errors import NotApplicable
from core.multibody.solve import solve_scene
from tests.core.multibody.table.test_contact_geometry import states
from tests.core.multibody.worked_examples import column, read


def bead(slope: float, friction: float, at: list[float], rate: float, **body: Any) -> dict[str, Any]:
    return {
        "gravity": [0, -10],
        "bodies": {"bead": {"mass": 1, "at": at, **body}},
        "connections": [
            {
                "kind": "contact",
                "name": "wire",
                "place": "bead",
                "on": {"at": at, "slope": {"degrees": slope}},
                "friction": friction,
            },
            {"kind": "spinning-frame", "rate": rate},
        ],
    }


@pytest.mark.parametrize("speed", [1, -1])
@pytest.mark.parametrize("slope", [0, 20])
def test_what_slides_across_the_axis_is_refused_with_its_friction(speed: float, slope: float) -> None:
    """The bead would be pressed by 2 m W v across the plane: by far more than in it."""
    turn = math.radians(slope)
    velocity = [speed * math.cos(turn), speed * math.sin(turn)]
    with pytest.raises(NotApplicable, match="Coriolis") as refused:
        solve_scene(read(bead(slope, 0.3, [2, 0], 30, velocity=velocity)), [1.0])
    assert refused.value.path == ("connections", 0, "friction")
    without = bead(slope, 0.3, [2, 0], 30, velocity=velocity)
    del without["connections"][0]["friction"]
    assert solve_scene(read(without), [0.01]).problem is None


@pytest.mark.parametrize("rate", [1, 2.4])
def test_what_rests_relative_to_the_plane_is_answered(rate: float) -> None:
    """At 0.5 m friction of 3 N at most bears W^2 r."""
    answer = solve_scene(read(bead(0, 0.3, [0.5, 0], rate)), [1.0])
    assert (rate**2 * 0.5 < 3) == (states(answer)[0] == {"wire": "stick"})


@pytest.mark.parametrize(("rate", "friction"), [(3, 0.2), (2, 0.5)])
def test_what_slides_along_the_axis_is_pressed_by_the_centrifugal_force_alone(rate: float, friction: float) -> None:
    """The wall at r presses by m W^2 r: the bead falls with g - mu W^2 r."""
    answer = solve_scene(read(bead(90, friction, [1, 0], rate, velocity=[0, -1])), [0.5])
    gain = 10 - friction * rate**2
    assert column(answer, "bead.velocity").values[0] == pytest.approx([0, -1 - 0.5 * gain], rel=1e-12)
