from __future__ import annotations

import numpy as np
import pytest

from core.balls import precision
from core.multibody.algebra.polynomials import BITS
from core.multibody.motion.modelling import modelled
from core.multibody.motion.numerical import Numerical
from core.multibody.solve import solve_scene
from tests.core.multibody.judge import numerical
from tests.core.multibody.worked_examples import column, read

DUMBBELL = {
    "gravity": [0, -9.81],
    "bodies": {
        "a": {"mass": 1, "at": [-0.3, 1], "velocity": [2, 3]},
        "b": {"mass": 2, "at": [0.3, 1], "velocity": [2, 6]},
    },
    "connections": [{"kind": "rod", "a": "a", "b": "b"}],
}


def test_what_is_thrown_is_its_centre_and_the_rest():
    with precision(BITS):
        found = modelled(read(DUMBBELL))
    names = [piece.table.names for piece in found.pieces]
    assert names == [["centre of a, b.x"], ["centre of a, b.y"], ["b.x - a.x", "b.y - a.y"]]
    assert [motion.name for _, motion in found.whole.parts] == 2 * ["constant acceleration"] + ["uniform rotation"]
    assert [float(x) for x in found.whole.reduced.table.v][:2] == pytest.approx([2, 5], rel=1e-15)


def test_the_motion_is_that_of_the_whole():
    """Against two bodies in one table, by the series: a second, massless tie to the ground would change nothing."""
    answer = solve_scene(read(DUMBBELL), [1.3])
    t, omega = 1.3, 5.0
    centre = np.array([0.1 + 2 * t, 1 + 5 * t - 9.81 / 2 * t * t])
    arm = 0.2 * np.array([np.cos(omega * t), np.sin(omega * t)])
    assert column(answer, "a.position").values[0] == pytest.approx(centre - 2 * arm, rel=1e-14)
    assert column(answer, "b.position").values[0] == pytest.approx(centre + arm, rel=1e-14)


def test_what_is_tied_to_a_place_has_no_free_shift():
    tied = {
        **DUMBBELL,
        "connections": [*DUMBBELL["connections"], {"kind": "spring", "a": "a", "b": [0, 3], "stiffness": 9}],
    }
    with precision(BITS):
        ((_, motion),) = modelled(read(tied)).whole.parts
    assert isinstance(motion, Numerical)
    assert not any("centre" in name for name in motion.table.names)


def test_three_bodies_leave_two_and_their_centre():
    bodies = {name: {"mass": i + 1, "at": [i, i * i], "velocity": [i % 2, 1 - i]} for i, name in enumerate("abc")}
    pairs = [{"kind": "gravitation", "a": a, "b": b, "constant": 1} for a, b in ("ab", "bc", "ca")]
    with precision(BITS):
        parts = numerical({"bodies": bodies, "connections": pairs})
    assert sorted(len(part.table.names) for part in parts) == [1, 1, 10]
    answer = solve_scene(read({"bodies": bodies, "connections": pairs}), [0.0, 0.4])
    places = sum((i + 1) * column(answer, f"{name}.position").values for i, name in enumerate("abc"))
    rates = sum((i + 1) * column(answer, f"{name}.velocity").values[0] for i, name in enumerate("abc"))
    assert places[1] - places[0] == pytest.approx(0.4 * rates, abs=1e-13)
