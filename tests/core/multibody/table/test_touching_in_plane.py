"""Gaps and slips of circles on faces and on one another, against the motion of the points that touch."""

from __future__ import annotations

from math import cos, sin

import numpy as np
import pytest
from flint import arb

from core.multibody.algebra.polynomials import evaluated
from core.multibody.table.description import described
from tests.core.multibody.worked_examples import read


def test_slip_is_that_of_the_points_that_touch() -> None:
    """v + w x r of both bodies at the point, along the face: by the definition of a slip, in doubles."""
    contact = {"kind": "contact", "place": "disc", "on": {"at": "box.top", "slope": 0.2}, "friction": 0.3}
    scene = {
        "bodies": {
            "disc": {"mass": 1, "inertia": 1, "radius": 0.3, "at": [0.1, 1.9], "velocity": [0.7, -0.2]},
            "box": {"mass": 1, "inertia": 1, "at": [0.2, 0.4], "angle": 0.5, "velocity": [0.1, 0.3]},
        },
        "connections": [contact],
    }
    scene["bodies"]["disc"]["angular_velocity"] = 1.3  # type: ignore[index]
    scene["bodies"]["box"]["angular_velocity"] = -0.6  # type: ignore[index]
    scene["bodies"]["box"]["places"] = {"top": [0.05, 0.6]}  # type: ignore[index]
    found = described(read(scene))
    (one,) = found.measures.unilateral
    along = np.array([cos(0.7), sin(0.7)])
    normal = np.array([-sin(0.7), cos(0.7)])
    arm = np.array([0.05 * cos(0.5) - 0.6 * sin(0.5), 0.05 * sin(0.5) + 0.6 * cos(0.5)])
    height = normal @ (np.array([0.1, 1.9]) - np.array([0.2, 0.4]) - arm) - 0.3
    q = found.measures.table.q
    assert float(evaluated(one.gap, q)) == pytest.approx(height, rel=1e-14)
    # Rates of the coordinates of the bodies, from the velocities that are given.
    rates = {"disc.x": 0.7, "disc.y": -0.2, "box.x": 0.1, "box.y": 0.3, "disc.angle": 1.3}
    rates |= {"box.cos": 0.6 * sin(0.5), "box.sin": -0.6 * cos(0.5), "box.angle": -0.6}
    v = [arb(rates[name]) for name in found.measures.table.names]
    slip = float(sum((evaluated(poly, q) * v[j] for j, poly in (one.slip or {}).items()), arb(0)))
    touch = np.array([0.1, 1.9]) - 0.3 * normal
    own = np.array([0.7, -0.2]) + 1.3 * np.array([0.3 * normal[1], -0.3 * normal[0]])
    # The face is taken through the point that touches: its points move along it as one.
    beside = touch - np.array([0.2, 0.4]) - height * normal
    other = np.array([0.1, 0.3]) - 0.6 * np.array([-beside[1], beside[0]])
    assert slip == pytest.approx(along @ (own - other), rel=1e-13)
