"""A bicycle of four bodies, whose wheels roll on their rims, against the published linearised equations.

M q'' + v C_1 q' + (g K_0 + v^2 K_2) q = 0 for the lean and the steer of the benchmark bicycle: J. P. Meijaard,
J. M. Papadopoulos, A. Ruina, A. L. Schwab, "Linearized dynamics equations for the balance and steer of a bicycle: a
benchmark and review", Proceedings of the Royal Society A 463 (2007), tables 1 and 2 and equations (6.3).
"""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from scipy.linalg import expm

from core.multibody.solve import solve_scene
from tests.core.multibody.worked_examples import column, read

MASS = np.array([[80.81722, 2.31941332208709], [2.31941332208709, 0.29784188199686]])
WEIGHT = np.array([[-80.95, -2.59951685249872], [-2.59951685249872, -0.80329488458618]])
SPEED_SQUARED = np.array([[0, 76.59734589573222], [0, 2.65431523794604]])
DAMPING = np.array([[0, 33.86641391492494], [-0.85035641456978, 1.68540397397560]])
G = 9.81


def linearised(v: float) -> np.ndarray[Any, np.dtype[np.float64]]:
    """Return the matrix of the rates of lean, steer and their rates."""
    force = -np.linalg.solve(MASS, G * WEIGHT + v * v * SPEED_SQUARED)
    return np.block([[np.zeros((2, 2)), np.eye(2)], [force, -np.linalg.solve(MASS, v * DAMPING)]])


def bicycle(v: float, lean_rate: str) -> dict[str, Any]:
    """Return the benchmark bicycle, x ahead and z up, upright, straight and leaning at a rate about its track."""
    plane = {"at": [0, 0, 0], "normal": [0, 0, 1]}

    def body(mass: float, at: list[Any], **more: Any) -> dict[str, Any]:
        moving = {"velocity": [v, f"-({lean_rate})*({at[2]})", 0], "angular_velocity": [lean_rate, 0, 0]}
        return {"mass": mass, "at": at} | moving | more

    def wheel(mass: float, radius: float, across: float, about: float, x: float) -> dict[str, Any]:
        return body(
            mass,
            [x, 0, radius],
            moments=[across, across, about],
            shape={"kind": "disc", "radius": radius},
            axes=[[1, 0, 0], [0, 0, 1], [0, -1, 0]],
            angular_velocity=[lean_rate, 0, f"-({v})/{radius}"],
        )

    frame = body(85, [0.3, 0, 0.9], tensor=[[9.2, 0, -2.4], [0, 11, 0], [-2.4, 0, 2.8]])
    fork = body(4, [0.9, 0, 0.7], tensor=[[0.05892, 0, 0.00756], [0, 0.06, 0], [0.00756, 0, 0.00708]])
    # The axis of the steer meets the ground 0.08 m before the front wheel, and is inclined by pi/10.
    frame["places"] = {"hub": [-0.3, 0, -0.6], "head": [0.8, 0, -0.9]}
    fork["places"] = {"hub": [0.12, 0, -0.35], "head": [0.2, 0, -0.7]}
    return {
        "gravity": [0, 0, -G],
        "bodies": {
            "rear": wheel(2, 0.3, 0.0603, 0.12, 0),
            "front": wheel(3, 0.35, 0.1405, 0.28, 1.02),
            "frame": frame,
            "fork": fork,
        },
        "connections": [
            {"kind": "pin", "a": "rear", "b": "frame.hub", "axis": [0, 1, 0]},
            {"kind": "pin", "a": "front", "b": "fork.hub", "axis": [0, 1, 0]},
            {"kind": "pin", "a": "fork.head", "b": "frame.head", "axis": ["-sin(pi/10)", 0, "cos(pi/10)"]},
            {"kind": "rolling", "place": "rear", "on": plane},
            {"kind": "rolling", "place": "front", "on": plane},
        ],
    }


def test_the_linearised_equations_have_the_published_eigenvalues() -> None:
    weave = complex(-0.77534188219585, 4.46486771378823)
    expected = [-14.07838969279822, weave.conjugate(), weave, -0.32286642900409]
    found = sorted(np.linalg.eigvals(linearised(5.0)), key=lambda x: (x.real, x.imag))
    assert found == pytest.approx(sorted(expected, key=lambda x: (x.real, x.imag)), rel=1e-12)


@pytest.mark.parametrize("v", [3, 5, 8], ids=["weaves", "runs straight", "capsizes"])
def test_a_bicycle_leans_as_its_linearised_equations_say(v: int) -> None:
    times = [0.5, 1.0, 2.0]
    answer = solve_scene(read(bicycle(v, "1e-4")), times, ["trajectory"])
    assert answer.model.mobility == 3
    lean = 2 * column(answer, "frame.attitude").values[:, 1]
    expected = [(expm(linearised(v) * time) @ [0, 0, 1e-4, 0])[0] for time in times]
    # What is left is of the third order in the lean, which is 1e-4 at most.
    assert lean == pytest.approx(expected, abs=1e-7 * max(map(abs, expected)))
