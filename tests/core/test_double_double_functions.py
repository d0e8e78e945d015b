"""Functions of pairs of doubles, against mpmath at 60 digits."""

from __future__ import annotations

import mpmath as mp
import numpy as np
import pytest

from core import double_double_functions as functions

CLOSE = 2.0**-101
"""Thirty-two units of 2^-106: what some forty roundings leave."""


def pairs(low: float, high: float, count: int = 200) -> list[tuple[float, float]]:
    random = np.random.default_rng(20261125)
    return [(x, x * 2.0**-54 * random.uniform(-1, 1)) for x in random.uniform(low, high, count).tolist()]


def apart(found: tuple[float, float], exact: mp.mpf) -> float:
    return float(abs(mp.mpf(found[0]) + mp.mpf(found[1]) - exact) / max(abs(exact), mp.mpf(1)))


@pytest.fixture(autouse=True)
def digits() -> None:
    mp.mp.dps = 60


def test_logarithm() -> None:
    for high, low in pairs(1e-3, 50.0):
        assert apart(functions.dd_log(high, low), mp.log(mp.mpf(high) + mp.mpf(low))) < CLOSE


def test_sine_and_cosine() -> None:
    for high, low in [*pairs(-10.0, 10.0), *pairs(-0.01, 0.01), (0.0, 0.0)]:
        exact, found = mp.mpf(high) + mp.mpf(low), functions.dd_sin_cos(high, low)
        assert apart(found[:2], mp.sin(exact)) < CLOSE
        assert apart(found[2:], mp.cos(exact)) < CLOSE


def test_hyperbolic_sine_and_cosine() -> None:
    for high, low in pairs(-20.0, 20.0):
        exact, found = mp.mpf(high) + mp.mpf(low), functions.dd_sinh_cosh(high, low)
        assert apart(found[:2], mp.sinh(exact)) < CLOSE
        assert apart(found[2:], mp.cosh(exact)) < CLOSE


def test_angles() -> None:
    for (high, low), (other, less) in zip(pairs(-3.0, 3.0), reversed(pairs(-2.0, 2.5)), strict=True):
        exact = mp.atan2(mp.mpf(high) + mp.mpf(low), mp.mpf(other) + mp.mpf(less))
        assert apart(functions.dd_atan2(high, low, other, less), exact) < CLOSE
    for high, low in pairs(-0.99, 0.99):
        assert apart(functions.dd_asin(high, low), mp.asin(mp.mpf(high) + mp.mpf(low))) < 8 * CLOSE


def test_there_is_no_angle_of_a_sine_above_one() -> None:
    assert np.isnan(functions.dd_asin(1.5, 0.0)[0])
