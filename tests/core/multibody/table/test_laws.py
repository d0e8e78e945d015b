"""Tops and balls of space in a frame that spins: what they do outside of it, seen from it."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest

from core.multibody.solve import solve_scene
from tests.core.multibody.worked_examples import column, read

TURN = 0.8


def about_z(angle: float) -> Any:
    c, s = math.cos(angle), math.sin(angle)
    return np.array([[c, -s, 0], [s, c, 0], [0, 0, 1]])


def about(direction: Any, angle: float) -> Any:
    k = np.cross(np.eye(3), direction / np.linalg.norm(direction))
    return np.eye(3) + math.sin(angle) * k + (1 - math.cos(angle)) * (k @ k)


@pytest.mark.parametrize("rate", [2, -0.7])
def test_a_free_symmetric_top_precesses_about_its_angular_momentum(rate: float) -> None:
    """With L fixed outside of the frame, the top turns about L at |L|/I_1 and about its own axis at the rate left.

    L. D. Landau, E. M. Lifshitz, "Mechanics" (3rd ed.), section 33.
    """
    moments, seen = np.array([0.2, 0.2, 0.1]), np.array([0.5, 0.3, 3.0])
    axes = np.array([[1, 0, 0], [0, 0.8, 0.6], [0, -0.6, 0.8]])
    top = {"mass": 1, "moments": moments.tolist(), "at": [0, 0, 0], "axes": axes.tolist(), "velocity": [0, 0, 0]}
    top["angular_velocity"] = seen.tolist()
    scene = {"gravity": [0, 0, 0], "bodies": {"top": top}, "connections": [{"kind": "spinning-frame", "rate": rate}]}
    answer = solve_scene(read(scene), [TURN])
    spin = seen + axes @ [0, 0, rate]
    momentum = (moments * spin) @ axes
    own = spin[2] * (1 - moments[2] / moments[0])
    outside = about(momentum, float(np.linalg.norm(momentum)) / moments[0] * TURN) @ axes.T @ about_z(own * TURN)
    w, x, y, z = (float(v) for v in column(answer, "top.attitude").values[0])
    found = (2 * w * w - 1) * np.eye(3) + 2 * np.outer([x, y, z], [x, y, z])
    found = found + 2 * w * np.array([[0, -z, y], [z, 0, -x], [-y, x, 0]])
    assert found == pytest.approx(about_z(-rate * TURN) @ outside, abs=1e-13)


@pytest.mark.parametrize("held", [{"kind": "rolling"}, {"kind": "contact", "friction": 5}])
def test_a_ball_rolls_on_circles_seen_from_outside_of_a_turntable(held: dict[str, Any]) -> None:
    """Outside of it, the velocity of a uniform ball turns at 2/7 of the rate of the table.

    J. A. Burns, "Ball rolling on a turntable: Analog for charged particle dynamics", Am. J. Phys. 49 (1981) 56.
    """
    rate, place, speed = 2.0, np.array([0.5, 0.0, 1.0]), np.array([1.0, 0.0, 0.0])
    ball = {"mass": 1, "moments": [0.4, 0.4, 0.4], "radius": 1, "at": place.tolist(), "velocity": speed.tolist()}
    ball["angular_velocity"] = [0, 1, 0]
    connections = [
        {**held, "place": "ball", "on": {"at": [0, 0, 0], "normal": [0, 0, 1]}},
        {"kind": "spinning-frame", "rate": rate},
    ]
    scene = {"gravity": [0, 0, -10], "bodies": {"ball": ball}, "connections": connections}
    answer = solve_scene(read(scene), [TURN])
    up = np.array([0.0, 0.0, 2 / 7 * rate])
    begun = speed + np.cross([0, 0, rate], place)
    centre = place + np.cross(up, begun) / up[2] ** 2
    outside = centre + about_z(up[2] * TURN) @ (place - centre)
    assert column(answer, "ball.position").values[0] == pytest.approx(about_z(-rate * TURN) @ outside, abs=1e-13)
