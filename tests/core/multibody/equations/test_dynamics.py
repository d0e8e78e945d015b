"""Parts of a scene whose rates are prescribed."""

from __future__ import annotations

from fractions import Fraction
from typing import Any

import numpy as np
import pytest

from core.multibody.proven.proven_answer import proven_answer
from core.multibody.solve import solve_scene
from tests.core.multibody.worked_examples import column, read

TIMES = (0.25, 0.75, 2.0)

PIN = {"kind": "pin", "a": "wheel", "b": [0, 0]}
WHEEL = {"mass": 1, "radius": 0.1, "inertia": 0.01, "at": [0, 0]}
OTHERS: dict[str, tuple[dict[str, Any], list[dict[str, Any]]]] = {
    "alone": ({}, []),
    "pendulum": ({"bob": {"mass": 1, "at": [5.6, -0.8]}}, [{"kind": "rod", "a": "bob", "b": [5, 0]}]),
    "thrown": ({"bob": {"mass": 1, "at": [5, 0], "velocity": [1, 1]}}, []),
    "oscillator": ({"bob": {"mass": 1, "at": [5, -1]}}, [{"kind": "spring", "a": "bob", "b": [5, 0], "stiffness": 7}]),
}
DRIVEN: dict[str, tuple[dict[str, Any], list[dict[str, Any]], str, float]] = {
    # A column of each scene and its rate, in units of that of the motor.
    "wheel": ({"wheel": WHEEL}, [PIN], "wheel.angle", 1.0),
    "without a pin": ({"wheel": WHEEL}, [], "wheel.angle", 1.0),
    "winch": (
        {"wheel": WHEEL, "load": {"mass": 2, "at": [0.1, -30]}},
        [PIN, {"kind": "string", "through": ["load", "wheel"], "sides": {"wheel": "right"}}],
        "load.position",
        0.1,
    ),
    "gears": (
        {"wheel": WHEEL, "gear": {"mass": 1, "radius": 0.3, "inertia": 0.02, "at": [0.4, 0]}},
        [PIN, {"kind": "pin", "a": "gear", "b": [0.4, 0]}, {"kind": "rolling", "a": "wheel", "b": "gear"}],
        "gear.angle",
        -1 / 3,
    ),
    "rolling": (
        {"wheel": WHEEL | {"at": [0, 0.1]}},
        [{"kind": "rolling", "place": "wheel", "on": {"at": [0, 0]}}],
        "wheel.position",
        -0.1,
    ),
}
CASES = [(kind, other) for kind in DRIVEN for other in OTHERS]


def scene(kind: str, other: str, rate: str) -> dict[str, Any]:
    bodies, connections, _, _ = DRIVEN[kind]
    more, held = OTHERS[other]
    motor = {"kind": "motor", "a": "wheel", "rate": rate}
    return {"gravity": [0, -9.81], "bodies": {**bodies, **more}, "connections": [motor, *connections, *held]}


def travelled(values: Any, start: float) -> Any:
    """Return how far an angle, or the component of a place that moves, has come."""
    array = np.asarray(values, dtype=np.float64)
    if array.ndim == 1:
        return array - start
    return array[:, 0] if start == 0.0 else array[:, 1] - start


@pytest.mark.parametrize("rate", ["-3.2", "2.5"])
@pytest.mark.parametrize(("kind", "other"), CASES)
def test_what_a_motor_drives_moves_at_its_rate_beside_anything_else(kind: str, other: str, rate: str) -> None:
    _, _, name, ratio = DRIVEN[kind]
    found = column(solve_scene(read(scene(kind, other, rate)), TIMES, ("trajectory",)), name)
    expected = ratio * float(rate) * np.array(TIMES)
    start = -30.0 if kind == "winch" else 0.0
    assert np.max(np.abs(travelled(found.values, start) - expected)) <= np.max(found.error) + 1e-14


@pytest.mark.parametrize("kind", DRIVEN)
def test_what_a_motor_drives_moves_in_proven_digits_too(kind: str) -> None:
    _, _, name, ratio = DRIVEN[kind]
    found = proven_answer(read(scene(kind, "thrown", "-3.2")), 16, [Fraction(3, 4)], ["trajectory"])
    assert found.columns is not None
    start = -30.0 if kind == "winch" else 0.0
    (moved,) = travelled(found.columns[name].values, start)
    assert abs(moved - ratio * -3.2 * 0.75) < 1e-13
