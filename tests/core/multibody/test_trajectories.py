"""Trajectories of described scenes, with fewer digits."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

from core.multibody.solve import solve_scene
from core.systems.methods import RungeKutta4
from core.systems.trajectory import Trajectory
from tests.core.multibody.worked_examples import TWO_RODS, read


def moved(**others: Any) -> Trajectory:
    found = solve_scene(read(TWO_RODS), [0.1, 0.4, 0.9], ("trajectory", "forces-in-time"), **others).trajectory
    assert found is not None
    return found


@pytest.mark.parametrize("digits", [3, 8, 17])
def test_digits_are_as_many_and_the_error_covers_them(digits: int) -> None:
    whole, short = moved(), moved(digits=digits)
    for name, column in short.columns.items():
        difference = whole.columns[name].values - column.values
        change = np.abs(difference) if difference.ndim == 1 else np.linalg.norm(difference, axis=1)
        assert change.max() + whole.columns[name].error <= column.error * (1 + 1e-9)
        for value in column.values.ravel().tolist():
            assert float(f"{value:.{digits - 1}e}") == value
    assert short.accuracy.error >= whole.accuracy.error


def test_meaningful_places_are_those_that_the_error_supports() -> None:
    short = moved(digits="meaningful", method=RungeKutta4(0.05))
    column = short.columns["two.position"]
    for value in column.values.ravel().tolist():
        assert len(repr(value)) < 10
    assert column.error < 5e-2


def test_rounding_beyond_the_accuracy_is_reported() -> None:
    (warning,) = moved(digits=3).warnings
    assert warning.code == "rounded-beyond-accuracy"
