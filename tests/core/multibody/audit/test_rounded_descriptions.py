"""Descriptions whose numbers are rounded to nine digits are answered: the bodies are moved onto their connections."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

from core.multibody.solve import solve_scene
from tests.core.multibody.worked_examples import read


def rounded(vector: np.ndarray) -> Any:
    return vector.round(9).tolist()


@pytest.mark.parametrize("kind", ["line", "plane", "ball-joint", "rod"])
@pytest.mark.parametrize("origin", [True, False])
@pytest.mark.parametrize("seed", range(3))
def test_axes_and_places_of_nine_digits(kind: str, origin: bool, seed: int) -> None:
    """An answer that the audit refuses is an error; a body in the origin has no digits that tell how it was rounded."""
    random = np.random.default_rng(seed)
    axes = np.linalg.qr(random.normal(size=(3, 3)))[0]
    axes *= np.linalg.det(axes)
    arm, at = np.array([0.2, 0.3, -0.1]), np.zeros(3) if origin else random.normal(size=3).round(9)
    place, direction = at + axes @ arm, random.normal(size=3)
    direction /= np.linalg.norm(direction)
    connection = {
        "line": {"kind": "track", "place": "b.p", "on": {"at": rounded(place), "direction": rounded(direction)}},
        "plane": {"kind": "track", "place": "b.p", "on": {"at": rounded(place), "normal": rounded(direction)}},
        "ball-joint": {"kind": "ball-joint", "a": "b.p", "b": rounded(place)},
        "rod": {"kind": "rod", "a": "b.p", "b": rounded(place + direction)},
    }[kind]
    body = {"mass": 1, "moments": [0.1, 0.2, 0.25], "places": {"p": arm.tolist()}}
    body |= {"at": at.tolist(), "axes": [rounded(axis) for axis in axes.T]}
    scene = {"gravity": [0, 0, -9.81], "bodies": {"b": body}, "connections": [connection]}
    answer = solve_scene(read(scene), [0.1, 0.3])
    assert answer.trajectory is not None
    assert len(answer.trajectory.columns["b.position"].values) == 2


@pytest.mark.parametrize("stretch", ["0", "1e-12", "-1e-8", "1e-4"])
@pytest.mark.parametrize("origin", ["0", "1.7", "-1234.56"])
def test_the_energy_of_a_spring_near_its_natural_length_is_known_to_rounding_of_its_places(
    stretch: str, origin: str
) -> None:
    """An answer that the audit refuses is an error."""
    spring = {"kind": "spring", "a": "b", "b": [origin, origin], "stiffness": 100, "rest_length": f"0.5 - ({stretch})"}
    body = {"mass": 1, "at": [f"{origin} + 0.4", f"{origin} + 0.3"]}
    turned = {"mass": 1, "inertia": 1, "at": [5, 5], "angle": f"1 + ({stretch})"}
    torsion = {"kind": "torsion-spring", "a": "c", "stiffness": 7, "rest_angle": 1}
    scene = {"gravity": [0, 0], "bodies": {"b": body, "c": turned}, "connections": [spring, torsion]}
    answer = solve_scene(read(scene), [0.5])
    assert answer.energy is not None
    assert answer.energy.potential == pytest.approx(53.5 * float(stretch) ** 2)
