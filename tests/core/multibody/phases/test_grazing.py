"""Contacts that are only just reached or missed: told as undecided, or decided however narrowly."""

from __future__ import annotations

from typing import Any

import pytest
from mpmath import acos, ellipf, ellipk, mp, mpf, sqrt

from core.multibody.solve import solve_scene
from tests.core.multibody.table.test_contact_geometry import kinds
from tests.core.multibody.worked_examples import read


def pendulum(wall: Any) -> dict[str, Any]:
    """Return a pendulum of 1 m, released level at rest, that turns back level on the other side."""
    return {
        "gravity": [0, -9.81],
        "bodies": {"bob": {"mass": 1, "at": [1, 0]}},
        "connections": [
            {"kind": "rod", "name": "rod", "a": "bob", "b": [0, 0]},
            {"kind": "contact", "name": "wall", "place": "bob", "on": {"at": [wall, 0], "slope": {"degrees": -90}}},
        ],
    }


@pytest.mark.parametrize("wall", [-1, "-1 - 1e-32"])
def test_a_wall_at_the_turning_point_is_undecided(wall: Any) -> None:
    answer = solve_scene(read(pendulum(wall)), [1.0, 2.0])
    assert answer.problem is not None
    assert answer.problem.code == "grazing-contact"
    assert [set(one) for one in answer.problem.candidates] == [{"wall"}, {"wall"}]
    half = 2 * ellipk(mpf(1) / 2) / sqrt(mpf("9.81"))
    # The gap leaves zero as the fourth power of time: when it is lowest is known that much less.
    assert abs(answer.events[0].time - half) <= answer.events[0].error < 1e-6
    assert answer.trajectory is not None
    assert answer.trajectory.rows.tolist() == [0]


def test_a_wall_that_is_clearly_missed_by_little_is_missed() -> None:
    answer = solve_scene(read(pendulum("-1 - 1e-24")), [1.0, 2.0])
    assert kinds(answer) == []


def test_a_wall_that_is_clearly_reached_by_little_is_reached() -> None:
    """At sin(theta) = 1 - 1e-20 on the way up: the time by elliptic integrals, of modulus 1/sqrt 2."""
    answer = solve_scene(read(pendulum("-1 + 1e-20")), [1.0, 2.0])
    assert kinds(answer)[0] == ("touch", "wall")
    with mp.workdps(50):
        angle = acos(sqrt(1 - (1 - mpf(10) ** -20) ** 2))
        # sin(theta/2) = sin(phi)/sqrt 2 from the lowest place on.
        phi = mp.asin(sqrt(2) * mp.sin(angle / 2))
        when = (ellipk(mpf(1) / 2) + ellipf(phi, mpf(1) / 2)) / sqrt(mpf("9.81"))
        assert abs(answer.events[0].time - when) <= answer.events[0].error


def test_in_closed_form_a_touch_at_rest_is_decided() -> None:
    scene = {
        "gravity": [0, -10],
        "bodies": {"ball": {"mass": 1, "at": [0, 0], "velocity": [0, 4]}},
        "connections": [
            {"kind": "contact", "name": "ceiling", "place": "ball", "on": {"at": [0, 0.8], "slope": {"degrees": 180}}}
        ],
    }
    answer = solve_scene(read(scene), [0.8])
    assert answer.problem is None
    assert kinds(answer) == []
    assert any("touches at rest" in sentence for sentence in answer.model.noticed)
