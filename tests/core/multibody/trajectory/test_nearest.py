"""Angles, attitudes, forces and energies to half a unit of the last place, against proven digits and mpmath."""

from __future__ import annotations

import math
from fractions import Fraction
from typing import Any

import mpmath
import pytest

from core.multibody.answer import SceneSolution
from core.multibody.proven.proven_answer import proven_answer
from core.multibody.solve import solve_scene
from tests.core.multibody.worked_examples import TWO_RODS, column, read

FINEST = 1.2e-16
ROD: dict[str, Any] = {
    "gravity": [0, -9.81],
    "bodies": {
        "rod": {"mass": 1, "inertia": "1/12", "at": ["0.5*cos(0.3)", "0.5*sin(0.3)"], "angle": 0.3}
        | {"places": {"end": [-0.5, 0]}}
    },
    "connections": [{"kind": "pin", "name": "hinge", "a": "rod.end", "b": [0, 0]}],
}
THROWN: dict[str, Any] = {
    "gravity": [0, 0, -9.81],
    "bodies": {
        "body": {"mass": 1, "moments": [1, 2, 2.5], "at": [0, 0, 0], "velocity": [1, 0, 3]}
        | {"angular_velocity": [0.3, 2, 0.1]}
    },
}
OUTPUTS = ("trajectory", "forces-in-time", "energy-in-time")


def finest(scene: dict[str, Any], times: list[float], outputs: tuple[Any, ...] = OUTPUTS) -> SceneSolution:
    answer = solve_scene(read(scene), times, outputs, FINEST)
    assert answer.trajectory is not None
    assert answer.trajectory.accuracy.error <= FINEST
    return answer


@pytest.mark.parametrize(("scene", "time"), [(ROD, 0.25), (TWO_RODS, 0.125), (THROWN, 0.25)])
def test_samples_are_the_doubles_nearest_to_proven_digits(scene: dict[str, Any], time: float) -> None:
    answer = finest(scene, [time], ("trajectory",))
    proven = proven_answer(read(scene), 24, [Fraction(time)], ("trajectory",)).columns
    assert proven is not None
    for name in answer.trajectory.columns:  # type: ignore[union-attr]
        samples = column(answer, name)
        numerals = proven[name].values[0]
        for value, numeral in zip(
            samples.values[0].ravel().tolist(), numerals if isinstance(numerals, list) else [numerals], strict=True
        ):
            off = abs(Fraction(value) - Fraction(numeral))
            assert off <= Fraction(samples.error)
            assert off <= Fraction(math.ulp(value)) * Fraction("0.501")


def test_forces_and_energies_are_those_of_the_angle() -> None:
    """Energy: theta'^2 = 3 g (sin 0.3 - sin theta); along the rod the hinge pulls m (g sin theta + theta'^2/2)."""
    answer = finest(ROD, [0.25, 0.75, 1.5])
    proven = proven_answer(read(ROD), 30, [Fraction(t) for t in (0.25, 0.75, 1.5)], ("trajectory",)).columns
    assert proven is not None
    with mpmath.workdps(40):
        g = mpmath.mpf("9.81")
        for k, numeral in enumerate(proven["rod.angle"].values):
            theta = mpmath.mpf(numeral)
            square = 3 * g * (mpmath.sin(mpmath.mpf("0.3")) - mpmath.sin(theta))
            turning = -3 * g * mpmath.cos(theta) / 2
            right = {
                "energy.kinetic": square / 6,
                "energy.potential": g * mpmath.sin(theta) / 2,
                "hinge.x": (-mpmath.sin(theta) * turning - mpmath.cos(theta) * square) / 2,
                "hinge.y": (mpmath.cos(theta) * turning - mpmath.sin(theta) * square) / 2 + g,
            }
            for name, exact in right.items():
                found = column(answer, name)
                assert abs(found.values[k] - exact) <= found.error
                assert abs(found.values[k] - exact) <= mpmath.mpf("0.501") * math.ulp(found.values[k])


def test_full_turns_are_counted() -> None:
    """A free body of the plane turns at its rate."""
    wheel = {"mass": 1, "inertia": 1, "at": [0, 0], "angle": 0.5, "angular_velocity": 7, "places": {"p": [1, 0]}}
    scene = {
        "gravity": [0, 0],
        "bodies": {"wheel": wheel},
        "connections": [{"kind": "pin", "name": "axle", "a": "wheel", "b": [0, 0]}],
    }
    angles = column(finest(scene, [10.0, -3.0], ("trajectory",)), "wheel.angle")
    assert angles.values.tolist() == [70.5, -20.5]


@pytest.mark.parametrize("accuracy", [1e-9, 1e-15])
def test_a_stiff_spring_that_hardly_yields_is_known_to_any_accuracy(accuracy: float) -> None:
    """On a circle of 1 m at 2 m/s the spring of 1e8 N/m pulls with m v^2/r = 4 N, by 4e-8 m, at all times."""
    scene = {
        "gravity": [0, 0],
        "bodies": {"bob": {"mass": 1, "at": [1, 0], "velocity": [0, 2]}},
        "connections": [
            {"kind": "spring", "name": "spring", "a": "bob", "b": [0, 0], "stiffness": 1e8, "rest_length": 0.99999996}
        ],
    }
    answer = solve_scene(read(scene), [0.01, 0.02], ("trajectory", "forces-in-time"), accuracy)
    force = column(answer, "spring.force")
    assert force.error <= 4 * accuracy
    assert abs(force.values - 4.0).max() <= force.error
