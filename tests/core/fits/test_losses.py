"""Losses against SciPy's, and what they cost where nothing is wrong with the data."""

from __future__ import annotations

from typing import Literal

import numpy as np
import pytest
from scipy.optimize import least_squares

from core.fits.losses import Robust


@pytest.mark.parametrize("loss", ["soft_l1", "huber", "cauchy"])
def test_losses_are_scipys(loss: Literal["soft_l1", "huber", "cauchy"]) -> None:
    residuals = np.random.default_rng(3).standard_t(1.5, size=50)
    robust = Robust(loss, 0.7)
    theirs = least_squares(lambda x: residuals + x, np.zeros(1), loss=loss, f_scale=0.7, max_nfev=1)
    assert 0.5 * 0.7**2 * np.sum(robust.rho((residuals / 0.7) ** 2)[0]) == pytest.approx(theirs.cost, rel=1e-12)
    z, step = np.array([0.1, 0.9, 1.1, 4.0]), 1e-6
    _, first, second = robust.rho(z)
    above, below = robust.rho(z + step), robust.rho(z - step)
    assert first == pytest.approx((above[0] - below[0]) / (2.0 * step), rel=1e-8)
    assert second == pytest.approx((above[1] - below[1]) / (2.0 * step), rel=1e-6, abs=1e-9)


@pytest.mark.parametrize("loss", ["huber", "cauchy"])
def test_default_scales_lose_five_percent_of_normal_data(loss: Literal["huber", "cauchy"]) -> None:
    residuals = np.random.default_rng(4).normal(size=200_000)
    assert Robust(loss).variance_factor(residuals, 0) == pytest.approx(1.0 / 0.95, abs=5e-3)
