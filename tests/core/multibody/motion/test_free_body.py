from __future__ import annotations

import math

import numpy as np
import pytest
from flint import arb

from core.balls import precision
from core.errors import AccuracyUnreachable, BudgetExceeded
from core.multibody.algebra.polynomials import BITS
from core.multibody.motion.free_body import FreeBody
from core.multibody.motion.modelling import modelled
from core.multibody.search import followed
from core.multibody.solve import solve_scene
from core.multibody.trajectory.occurrences import ExtremesOf
from tests.core.multibody.judge import judged, numerical
from tests.core.multibody.worked_examples import column, read


def tumbling(seed):
    """Return a body with a full tensor, turned askew."""
    random = np.random.default_rng(seed)
    points = np.round(random.uniform(-1, 1, (4, 3)), 2)
    tensor = sum(float(p @ p) * np.eye(3) - np.outer(p, p) for p in points)
    numbers = [[f"{round(float(x) * 1e4)}/10000" for x in row] for row in tensor]
    angle = f"{random.uniform(-3, 3):.3f}"
    axes = [[f"cos({angle})", f"sin({angle})", 0], [f"-sin({angle})", f"cos({angle})", 0], [0, 0, 1]]
    omega = [float(f"{x:.3f}") for x in random.uniform(-3, 3, 3)]
    body = {"mass": 1, "tensor": numbers, "at": [0, 0, 0], "axes": axes, "angular_velocity": omega}
    return {"gravity": [0, 0, 0], "bodies": {"b": body}}


@pytest.mark.parametrize("seed", range(12))
def test_the_closed_form_is_the_motion_of_the_table(seed):
    description = tumbling(seed)
    with precision(BITS):
        ((_, motion),) = modelled(read(description)).whole.parts
        assert isinstance(motion, FreeBody)
        (table,) = numerical(description)
        for t in np.random.default_rng(seed).uniform(-3, 3, 2):
            found = motion.states(np.array([t]))
            for value, right in zip((found.q, found.v), judged(table, float(t)), strict=True):
                true = np.abs((value[0, :, 0] - right[:, 0]) + (value[0, :, 1] - right[:, 1]))
                assert np.all(true <= 1e-24 * np.abs(right[:, 0]).max())


@pytest.mark.parametrize(
    ("moments", "omega"),
    [
        ([1, 2, 3], [0, 0, 2]),
        ([1, 2, 3], [0, 2, 0]),
        ([2, 2, 2], [1, 2, 3]),
        ([1, 2, 3], ["sqrt(3)", 0.5, 1]),
        ([2, 2, 3], [1, 0.5, 2]),
        # On the separatrix: L^2 = 2 E I_2.
        ([1, 2, 3], ["sqrt(3)", 1, 1]),
    ],
)
def test_every_branch_keeps_energy_and_angular_momentum(moments, omega):
    body = {"mass": 1, "moments": moments, "at": [0, 0, 0], "angular_velocity": omega}
    # A torque, here of nothing, sees the body's orientation, so that it is not described by one axis.
    torque = {"kind": "torque", "body": "b", "torque": [0, 0, 0]}
    scene = read({"gravity": [0, 0, 0], "bodies": {"b": body}, "connections": [torque]})
    answer = solve_scene(scene, [-3.0, 0.0, 5.0])
    # What turns about an axis of its own leaves the others at rest along it.
    assert answer.model.name == ("one period" if omega.count(0) == 2 else "free rotation")
    attitude, rates = (column(answer, f"b.{name}").values for name in ("attitude", "angular_velocity"))
    momentum = []
    for (w, *axis), rate in zip(attitude, rates, strict=True):
        own, v = np.array(moments) * rate, np.array(axis)
        momentum.append(own + 2 * w * np.cross(v, own) + 2 * np.cross(v, np.cross(v, own)))
    for one in momentum:
        assert one == pytest.approx(momentum[1], abs=2e-14)
    energy = (np.array(moments) * rates**2).sum(axis=1)
    assert energy == pytest.approx(energy[1], rel=1e-14)


def test_states_in_balls_are_those_in_pairs_also_of_rates_in_a_principal_plane():
    for omega in ([1, 1, 0], [0.5, 1, 2]):
        body = {"mass": 1, "moments": [1, 2, 3], "at": [0, 0, 0], "angular_velocity": omega}
        torque = {"kind": "torque", "body": "b", "torque": [0, 0, 0]}
        scene = read({"gravity": [0, 0, 0], "bodies": {"b": body}, "connections": [torque]})
        with precision(BITS):
            motion = next(one for _, one in modelled(scene).moving if isinstance(one, FreeBody))
            (state,) = motion.in_balls([arb(1.5)])
            found = motion.states(np.array([1.5]))
        assert [float(x) for x in state.q] == pytest.approx(found.q[0, :, 0], abs=1e-15)
        assert [float(x) for x in state.v] == pytest.approx(found.v[0, :, 0], abs=1e-15)


def test_any_time_is_answered_alike():
    """The middle axis turned about at 1 rad/s, a billion seconds later: the exact rate by its elliptic functions."""
    answer = solve_scene(read(tumbling(4)), [0.0, 2.0**30], ["trajectory", "energy", "energy-in-time"])
    assert answer.trajectory.accuracy.error < 2e-15
    energy = column(answer, "energy.kinetic").values
    assert energy[1] == pytest.approx(energy[0], rel=1e-15)
    with pytest.raises(AccuracyUnreachable):
        solve_scene(read(tumbling(4)), [1e80])


def test_a_full_turn_returns():
    body = {"mass": 1, "moments": [1, 2, 3], "at": [0, 0, 0], "angular_velocity": [0, 0, 2]}
    answer = solve_scene(read({"gravity": [0, 0, 0], "bodies": {"b": body}}), [math.pi / 2])
    assert column(answer, "b.attitude").values[0] == pytest.approx([0, 0, 0, 1], abs=1e-15)


def test_a_slow_approach_of_many_turns_is_refused_and_no_touch_is_missed(monkeypatch):
    """The place dips by about 1 m in every turn; with sparse samples the first of these touches would be passed by."""

    def drifting(height):
        start = {"at": [0, 0, height], "velocity": [0, 0, -1], "angular_velocity": [7.3, 0.1, 0.2]}
        body = {"mass": 1, "moments": [1, 2, 2.5], "places": {"p": [0, 1, 0]}} | start
        wall = {"at": [0, 0, 0], "normal": [0, 0, 1]}
        contact = {"kind": "contact", "name": "c", "place": "b.p", "on": wall, "restitution": 0}
        return {"gravity": [0, 0, 0], "bodies": {"b": body}, "connections": [contact]}

    scene = drifting(100)
    touch = solve_scene(read(scene), [99.5], ("trajectory",)).events[0].time
    times = np.linspace(98.9, touch - 1e-9, 400)
    answer = solve_scene(read(scene | {"connections": []}), times, ("trajectory",))
    w, x, y, z = column(answer, "b.attitude").values.T
    assert np.all(column(answer, "b.position").values[:, 2] + 2.0 * (y * z + w * x) > 0.0)
    # Of the pieces that are allowed a few, as all of them take long.
    monkeypatch.setattr(followed, "MOST_PIECES", 2_000)
    with pytest.raises(BudgetExceeded, match="pieces of the motion"):
        solve_scene(read(drifting(10_000)), [10_000], ("trajectory",))


@pytest.mark.parametrize("horizon", [100.0, 3600.0, 1e5])
def test_the_path_of_its_centre_is_followed_however_often_it_turns(horizon):
    """v = (1, 0, 3 - g t): the path is that of a projectile, and the highest place is 9/(2g) above the start."""
    start = {"at": [0, 0, 1], "velocity": [1, 0, 3], "angular_velocity": [0.1, 10, 0.1]}
    scene = read({"gravity": [0, 0, -10], "bodies": {"b": {"mass": 1, "moments": [1, 2, 2.5]} | start}})
    answer = solve_scene(scene, [horizon], ("paths-in-time", ExtremesOf("b.position.z")))

    def length(w):
        return (w * math.hypot(1.0, w) + math.asinh(w)) / 2.0

    path = answer.trajectory.columns["b.path"]
    assert path.values[0] == pytest.approx((length(10.0 * horizon - 3.0) + length(3.0)) / 10.0, rel=1e-14)
    assert answer.extremes[0].largest == pytest.approx(1.45, abs=answer.extremes[0].error)
