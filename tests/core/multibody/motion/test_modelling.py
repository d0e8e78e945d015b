"""Which model a part has."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

from core.multibody.language.reading import scene_from
from core.multibody.solve import solve_scene


def frame(*acceleration: Any) -> dict[str, Any]:
    """Return two equal bars that hang from a point, braced, at rest, in a field."""
    bodies = {"a": ["-sqrt(1/2)", "-sqrt(1/2)"], "b": ["sqrt(1/2)", "-sqrt(1/2)"]}
    return {
        "gravity": [0, -10],
        "bodies": {name: {"mass": 1, "at": at} for name, at in bodies.items()},
        "connections": [
            {"kind": "rod", "a": "a", "b": [0, 0]},
            {"kind": "rod", "a": "b", "b": [0, 0]},
            {"kind": "rod", "a": "a", "b": "b"},
            {"kind": "field", "acceleration": list(acceleration)},
        ],
    }


@pytest.mark.parametrize("across", ["-vx*t", "-sin(x) - vx*sin(t)", "vx*vy*t^2"])
def test_what_nothing_moves_at_any_time_rests(across: str) -> None:
    found = solve_scene(scene_from(frame(across, "-vy/3")), [0.0, 0.5], ("trajectory", "forces"))
    assert found.model is not None
    assert found.model.name == "rest"
    assert found.trajectory is not None
    assert np.all(np.asarray(found.trajectory.columns["a.velocity"].values) == 0.0)


@pytest.mark.parametrize("across", ["sin(t)", "-vx*t + t^3", "t*(x - 1)", "if(t - 0.1, 1, 0)", "max(t - 0.1, 0)"])
def test_what_is_moved_later_does_not_rest(across: str) -> None:
    """At the start nothing moves it, or so little that its acceleration is zero there."""
    found = solve_scene(scene_from(frame(across, 0)), [0.0, 0.5], ("trajectory",))
    assert found.trajectory is not None
    assert np.all(np.abs(np.asarray(found.trajectory.columns["a.velocity"].values[1])) > 1e-4)
