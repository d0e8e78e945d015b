"""Described shafts on one string against the named scene of the same: slack strings, jerks, and bounces without end."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

from core.multibody.solve import solve_scene
from core.scenes.unwinding_shafts import UnwindingShafts
from tests.core.multibody.random_scenes import decimal
from tests.core.multibody.worked_examples import column, read


def shafts(named: UnwindingShafts) -> dict[str, Any]:
    """Return the same scene in bodies and connections, the apex at the origin."""
    bodies, connections = {}, []
    assert named.positions is not None
    for i, (name, side) in enumerate((("one", -1), ("two", 1))):
        mass, radius, slope = named.masses[i], named.radii[i], named.slopes[i]
        x, v, w = named.positions[i], named.velocities[i], named.spins[i]
        bodies[name] = {
            "mass": mass,
            "radius": radius,
            "inertia": f"{mass}*{radius}*{radius}/2",
            "at": [
                f"{side}*({x}*cos({slope}) + {radius}*sin({slope}))",
                f"{radius}*cos({slope}) - {x}*sin({slope})",
            ],
            "velocity": [f"{side}*({v})*cos({slope})", f"-({v})*sin({slope})"],
            "angular_velocity": -side * w,
        }
        rail = {"at": [f"{side}*{radius}*sin({slope})", f"{radius}*cos({slope})"], "slope": -side * slope}
        connections.append({"kind": "track", "name": f"face-{name}", "place": name, "on": rail})
    string = {
        "kind": "string",
        "name": "s",
        "through": ["one", [0, 0], "two"],
        "sides": {"one": "below", "two": "below"},
        "restitution": named.restitution,
    }
    return {"gravity": [0, f"-{named.gravity}"], "bodies": bodies, "connections": [*connections, string]}


@pytest.mark.parametrize("seed", range(24))
def test_described_shafts_jerk_as_the_named_ones(seed: int) -> None:
    random = np.random.default_rng(seed)
    named = UnwindingShafts(
        masses=(decimal(random, 0.5, 4), decimal(random, 0.5, 4)),
        radii=(decimal(random, 0.05, 0.3), decimal(random, 0.05, 0.3)),
        slopes=(decimal(random, 0.2, 1.2), decimal(random, 0.2, 1.2)),
        gravity=9.81,
        positions=(50.0, 50.0),
        wound=(40.0, 40.0),
        velocities=(decimal(random, -1, 2), decimal(random, -1, 2)),
        spins=(decimal(random, -10, 20), decimal(random, -10, 20)),
        restitution=(0.0, 0.3, 0.7)[seed % 3],
    )
    times = np.linspace(0.0, 1.5, 16)
    theirs = named.answer(times)
    assert theirs.trajectory is not None
    answer = solve_scene(read(shafts(named)), times)
    assert answer.problem is None
    jerks = [event for event in answer.events if event.kind == "taut"]
    phases = theirs.figures["phases"]
    starts = [phase["start"] for phase in phases if phase["kind"] == "taut" and 0.0 < phase["start"] < 1.5]
    ends = [event.time for event in answer.events if event.kind == "settle"] or [event.time for event in jerks[-1:]]
    if starts:
        assert ends[-1] == pytest.approx(starts[-1], rel=1e-14)
    for i, (name, side) in enumerate((("one", -1), ("two", 1))):
        down = np.array([side * np.cos(named.slopes[i]), -np.sin(named.slopes[i])])
        place = column(answer, f"{name}.position")
        start = np.array(place.values[0])
        expected = start + (theirs.trajectory["positions"][:, i] - 50.0)[:, None] * down
        away = np.linalg.norm(place.values - expected, axis=1).max()
        assert away <= place.error + 2e-15 * 60
        spin = column(answer, f"{name}.angular_velocity")
        assert np.abs(spin.values + side * theirs.trajectory["spins"][:, i]).max() <= spin.error + 1e-13
