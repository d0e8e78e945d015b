"""What an instrument makes of figures, and its slopes against differences."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from core.fits.instrument import Frame, Offset, Scale, Stage, observed

FIGURES = np.random.default_rng(1).normal(size=(7, 4))
STAGES: list[tuple[Stage, slice]] = [
    (Frame((0, 2, 3)), slice(0, 3)),
    (Frame((1, 2)), slice(3, 4)),
    (Scale((0, 1)), slice(4, 5)),
    (Offset((2,)), slice(5, 6)),
]
NUMBERS = np.array([0.3, -0.2, 0.9, 0.4, 1.7, -0.5])


def test_axes_are_turned_by_the_rotation_vector() -> None:
    shown = Frame((0, 2, 3)).applied(FIGURES, NUMBERS[:3])
    # Components along turned axes are those of the vector turned back.
    expected = Rotation.from_rotvec(NUMBERS[:3]).inv().apply(FIGURES[:, [0, 2, 3]])
    assert shown[:, [0, 2, 3]] == pytest.approx(expected, abs=1e-14)
    assert np.array_equal(shown[:, 1], FIGURES[:, 1])


def test_a_perfect_instrument_changes_nothing() -> None:
    start = np.concatenate([stage.start for stage, _ in STAGES])
    assert observed(STAGES, FIGURES, (), start)[0] == pytest.approx(FIGURES, abs=1e-15)


def test_slopes_by_its_numbers_and_of_the_figures() -> None:
    change = np.random.default_rng(2).normal(size=FIGURES.shape)
    _, (pushed,), slopes = observed(STAGES, FIGURES, [change], NUMBERS)
    step = 1e-6

    def shown(figures: np.ndarray, numbers: np.ndarray) -> np.ndarray:
        return observed(STAGES, figures, (), numbers)[0]

    along = (shown(FIGURES + step * change, NUMBERS) - shown(FIGURES - step * change, NUMBERS)) / (2.0 * step)
    assert pushed == pytest.approx(along, abs=1e-8)
    for k in range(len(NUMBERS)):
        one = step * np.eye(len(NUMBERS))[k]
        difference = (shown(FIGURES, NUMBERS + one) - shown(FIGURES, NUMBERS - one)) / (2.0 * step)
        assert slopes[k] == pytest.approx(difference, abs=1e-8)
