"""The whole attitude of bodies of which the axis, or nothing, would suffice: `attitudes`."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from scipy.integrate import solve_ivp
from scipy.spatial.transform import Rotation

from core.errors import InvalidParameter
from core.multibody.solve import solve_scene
from tests.core.multibody.worked_examples import read

FREE = {"mass": 2, "moments": [0.3, 0.3, 0.1], "at": [0, 0, 0], "angular_velocity": [1, -2, 5]}
TILTED = [[0.8, 0.0, -0.6], [0.0, 1.0, 0.0], [0.6, 0.0, 0.8]]


def columns(bodies: dict[str, Any], times: list[float], connections: Any = (), **rest: Any) -> Any:
    scene = read({"bodies": bodies, "connections": list(connections), "attitudes": True, **rest})
    trajectory = solve_scene(scene, times, ("trajectory",)).trajectory
    assert trajectory is not None
    return trajectory.columns


def rotation(quaternion: Any) -> Any:
    return Rotation.from_quat(np.roll(quaternion, -1)).as_matrix()


@pytest.mark.parametrize("at", [0.0, 1e3])
@pytest.mark.parametrize("axes", [None, TILTED])
def test_a_free_top_is_two_turns_at_constant_rates(at: float, axes: Any) -> None:
    """R(t) = exp(L t/I1) R(0) exp(e3 w3 (1 - I3/I1) t) (Landau and Lifshitz, Mechanics, section 35)."""
    start = np.eye(3) if axes is None else np.array(axes).T
    body = FREE | {"at": [at, 0, 0]} | ({} if axes is None else {"axes": axes})
    beside = {"mass": 1, "moments": [1, 1, 1], "at": [at + 5, 0, 0], "angular_velocity": [0, 3, 0]}
    times = [0.3, 10.0, -2.0]
    found = columns({"top": body, "ball": beside}, times)
    momentum = start @ (np.array([0.3, 0.3, 0.1]) * [1, -2, 5])
    for k, t in enumerate(times):
        own = Rotation.from_rotvec([0, 0, 5 * (1 - 0.1 / 0.3) * t]).as_matrix()
        expected = Rotation.from_rotvec(momentum / 0.3 * t).as_matrix() @ start @ own
        assert rotation(found["top.attitude"].values[k]) == pytest.approx(expected, abs=2e-14)
        # In body axes the angular velocity turns about the axis of symmetry, the other way.
        assert found["top.angular_velocity"].values[k] == pytest.approx(own.T @ [1, -2, 5], abs=1e-13)
        spun = Rotation.from_rotvec([0, 3 * t, 0]).as_matrix()
        assert rotation(found["ball.attitude"].values[k]) == pytest.approx(spun, abs=2e-14)


def test_a_heavy_top_spins_about_its_axis_as_euler_s_equations_say() -> None:
    """I w' = I w x w + r x m g in body axes, with the attitude as a matrix, by another integrator."""
    moments, arm = np.array([0.05, 0.05, 0.004]), np.array([0, 0, 0.2])
    weight = np.array([0, 0, -9.81])

    def rate(_: float, y: Any) -> Any:
        omega, attitude = y[:3], y[3:].reshape(3, 3)
        torque = np.cross(arm, attitude.T @ weight)
        spin = (np.cross(moments * omega, omega) + torque) / moments
        across = np.array([[0, -omega[2], omega[1]], [omega[2], 0, -omega[0]], [-omega[1], omega[0], 0]])
        return np.concatenate([spin, (attitude @ across).ravel()])

    start = np.concatenate([[0.0, 0.0, 40.0], np.array(TILTED).T.ravel()])
    expected = solve_ivp(rate, (0, 0.7), start, method="DOP853", rtol=1e-13, atol=1e-14).y[:, -1]
    top = {
        "mass": 1,
        "moments": [0.01, 0.01, 0.004],
        "at": [0.12, 0, 0.16],
        "axes": TILTED,
        "angular_velocity": [0, 0, 40],
        "places": {"tip": [0, 0, -0.2]},
    }
    pin = {"kind": "pin", "a": "top.tip", "b": [0, 0, 0]}
    found = columns({"top": top}, [0.7], [pin], gravity=[0, 0, -9.81])
    assert found["top.angular_velocity"].values[0] == pytest.approx(expected[:3], abs=1e-10)
    assert rotation(found["top.attitude"].values[0]) == pytest.approx(expected[3:].reshape(3, 3), abs=1e-11)


def test_a_rolling_ball_has_turned_by_its_way_over_its_radius() -> None:
    ball = {"mass": 1, "radius": 0.2, "moments": [0.016, 0.016, 0.016], "at": [0, 0, 0.2], "velocity": [3, 0, 0]}
    roll = {"kind": "rolling", "place": "ball", "on": {"at": [0, 0, 0], "normal": [0, 0, 1]}}
    found = columns({"ball": ball}, [0.5], [roll], gravity=[0, 0, -9.81])
    expected = Rotation.from_rotvec([0, 3 * 0.5 / 0.2, 0]).as_matrix()
    assert rotation(found["ball.attitude"].values[0]) == pytest.approx(expected, abs=1e-14)


def test_particles_and_the_plane_are_as_without() -> None:
    assert "stone.attitude" not in columns({"stone": {"mass": 1, "at": [0, 0, 0]}}, [1.0])
    found = columns({"rod": {"mass": 1, "inertia": 1, "at": [0, 0], "angular_velocity": 2}}, [1.0])
    assert found["rod.angle"].values[0] == 2.0


def test_it_is_true_or_false() -> None:
    with pytest.raises(InvalidParameter, match="be true or false"):
        read({"bodies": {"top": FREE}, "attitudes": "yes"})
