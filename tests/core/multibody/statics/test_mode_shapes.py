"""Shapes of modes near places of rest, against closed forms and against numpy's eigenvectors."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

from core.multibody.answer import Equilibrium, ModeShape
from core.multibody.solve import solve_scene
from tests.core.multibody.worked_examples import read


def lowest(description: dict[str, Any]) -> Equilibrium:
    found = solve_scene(read(description), outputs=("equilibria",)).equilibria
    assert found is not None
    return found[0]


def shown(shape: ModeShape | None) -> ModeShape:
    assert shape is not None
    return shape


def masses(damping: float = 0.0, at: float = 0.0, turned: bool = False) -> dict[str, Any]:
    """Return two masses on a rail between a wall and two springs, along x or y."""

    def place(x: float) -> list[float]:
        return [at, x] if turned else [x, at]

    rail = {"at": place(0), "slope": {"degrees": 90} if turned else 0}
    springs = [("a", place(0)), ("b", "a")]
    damper = {"kind": "damper", "a": "a", "b": place(0), "coefficient": damping}
    return {
        "bodies": {"a": {"mass": 1, "at": place(1)}, "b": {"mass": 2, "at": place(2)}},
        "connections": [
            *({"kind": "spring", "a": a, "b": b, "stiffness": 3, "rest_length": 1} for a, b in springs),
            *({"kind": "track", "place": name, "on": rail} for name in "ab"),
            *([damper] if damping else []),
        ],
        "gravity": [0, 0],
    }


@pytest.mark.parametrize("at", [0.0, 1e3])
@pytest.mark.parametrize("turned", [False, True])
def test_undamped_masses_move_as_the_vectors_of_their_matrix(at: float, turned: bool) -> None:
    """M^-1 K of two masses 1 and 2 on springs of 3 N/m."""
    one = lowest(masses(at=at, turned=turned))
    squares, vectors = np.linalg.eig(np.array([[6.0, -3.0], [-1.5, 1.5]]))
    for k, i in enumerate(np.argsort(squares)):
        shape, vector = shown(one.shapes[k]), vectors[:, i] / vectors[np.argmax(np.abs(vectors[:, i])), i]
        assert one.modes[k].frequency == pytest.approx(np.sqrt(squares[i]), rel=1e-14)
        for name, x in zip("ab", vector, strict=True):
            assert shape.positions[name][int(turned)] == pytest.approx(x, abs=1e-14)
            assert shape.positions[name][1 - int(turned)] == 0.0
        assert shape.positions_quarter is None
        assert shape.error < 1e-14


def test_damped_masses_do_not_move_in_phase() -> None:
    """The complex vectors of the first-order system, with the phase of the mass that moves most."""
    one = lowest(masses(damping=0.5))
    system = np.zeros((4, 4))
    system[:2, 2:], system[2:, :2] = np.eye(2), -np.array([[6.0, -3.0], [-1.5, 1.5]])
    system[2, 2] = -0.5
    roots, vectors = np.linalg.eig(system)
    for mode, shape in zip(one.modes, map(shown, one.shapes), strict=True):
        i = int(np.argmin(np.abs(roots - complex(mode.growth_rate, mode.frequency))))
        vector = vectors[:2, i] / vectors[np.argmax(np.abs(vectors[:2, i])), i]
        assert shape.positions_quarter is not None
        for name, x in zip("ab", vector, strict=True):
            assert shape.positions[name][0] == pytest.approx(x.real, abs=1e-13)
            assert shape.positions_quarter[name][0] == pytest.approx(x.imag, abs=1e-13)


def test_a_double_pendulum_of_points_swings_with_and_against() -> None:
    """Equal masses and lengths: the lower angle is plus or minus root 2 times the upper, so x is 1 : 1 +- root 2."""
    scene = {
        "gravity": [0, -9.81],
        "bodies": {"one": {"mass": 1, "at": [0, -1]}, "two": {"mass": 1, "at": [0, -2]}},
        "connections": [{"kind": "rod", "a": "one", "b": [0, 0]}, {"kind": "rod", "a": "two", "b": "one"}],
    }
    slow, fast = map(shown, lowest(scene).shapes)
    assert slow.positions["one"] == pytest.approx((1 / (1 + np.sqrt(2)), 0.0), abs=1e-15)
    assert fast.positions["two"] == pytest.approx((1 - np.sqrt(2), 0.0), abs=1e-15)


def test_a_body_that_turns_about_its_centre_has_an_angle_of_one() -> None:
    wheel = {"mass": 1, "inertia": 2, "at": [0, 0], "angle": 0.3}
    spring = {"kind": "torsion-spring", "a": "wheel", "stiffness": 5, "rest_angle": 0}
    one = lowest({"bodies": {"wheel": wheel}, "connections": [{"kind": "pin", "a": "wheel", "b": [0, 0]}, spring]})
    assert shown(one.shapes[0]).angles == {"wheel": 1.0}
    assert shown(one.shapes[0]).positions == {"wheel": (0.0, 0.0)}


def test_modes_that_coincide_have_no_shape_of_their_own() -> None:
    bob = {"bob": {"mass": 1, "at": [0, 0, -1]}}
    one = lowest(
        {"gravity": [0, 0, -9.81], "bodies": bob, "connections": [{"kind": "rod", "a": "bob", "b": [0, 0, 0]}]}
    )
    assert len(one.modes) == 2
    assert one.shapes == (None, None)
