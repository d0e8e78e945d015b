"""Units of tables: what rounding leaves of a zero tells nothing of sizes or times."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

from core.multibody.language.reading import scene_from
from core.multibody.solve import solve_scene

FLOOR = {"at": [0, 0]}


@pytest.mark.parametrize("across", ["0", "-x", "-sin(x) - vx*t"])
def test_a_bar_at_the_origin_lands_with_friction_in_air(across: str) -> None:
    """Its centre is at x = 0 to the rounding of its fall, by which lengths and times of formulas were measured.

    Until it lands its end falls as exp(-t/3) has it: y' = -30 (1 - exp(-t/3)).
    """
    bar = {"mass": 1, "inertia": "1/3", "at": [0, "0.2"], "places": {"end": [-1, 0]}}
    contact = {"kind": "contact", "place": "bar.end", "on": FLOOR, "friction": [0.5, 0.25], "restitution": 0}
    air = {"kind": "field", "acceleration": [across, "-vy/3"]}
    scene = {"gravity": [0, -10], "bodies": {"bar": bar}, "connections": [contact, air]}
    answer = solve_scene(scene_from(scene), [0.3], ("trajectory",))
    assert answer.problem is None
    (landed,) = answer.events
    fallen = 30 * landed.time + 90 * np.expm1(-landed.time / 3)
    assert fallen == pytest.approx(0.2, abs=1e-14)


def test_a_force_between_a_crate_that_stands_and_a_ladder_that_slides() -> None:
    """The line of their distance has a constant that rounding leaves of the crate's place: no arm of the ladder."""
    feet = {"l": [-0.2, -0.5], "r": [0.2, -0.5], "top": [0, 0.5]}
    bodies: dict[str, Any] = {
        "crate": {"mass": 0.5, "inertia": "0.5/6", "at": [0, "0.5"], "places": feet},
        "ladder": {
            "mass": 1,
            "inertia": "1/12",
            "at": ["5 - 1/4", "sqrt(3)/4"],
            "angle": "pi/3",
            "places": {"foot": [-0.5, 0], "head": [0.5, 0]},
        },
    }
    wall = {"at": [5, 0], "slope": {"degrees": 90}}
    connections = [
        *({"kind": "contact", "place": f"crate.{foot}", "on": FLOOR, "friction": 0.5} for foot in "lr"),
        {"kind": "contact", "name": "floor", "place": "ladder.foot", "on": {"at": [5, 0]}, "restitution": 0},
        {"kind": "contact", "name": "wall", "place": "ladder.head", "on": wall, "friction": 0.3, "restitution": 0},
        {"kind": "inverse-square", "a": "crate.top", "b": "ladder", "strength": -5},
    ]
    answer = solve_scene(scene_from({"gravity": [0, -10], "bodies": bodies, "connections": connections}), [0.5])
    assert answer.problem is None
    assert [event.kind for event in answer.events] == ["lift-off"]
