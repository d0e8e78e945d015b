"""The sensitivity to half an ulp, where it can be told by hand."""

from __future__ import annotations

from math import sqrt, ulp

import pytest

from .free_rotation import half_ulp_sensitivity, half_ulp_sensitivity_attitude


def test_at_the_start_only_the_rates_matter() -> None:
    moments, rates = (1.0, 2.0, 3.0), (0.3, -0.8, 0.0)
    (change,) = half_ulp_sensitivity(moments, rates, [0.0])
    # What is zero is exact.
    assert change == pytest.approx((ulp(0.3) + ulp(0.8)) / 2, rel=1e-6)
    assert half_ulp_sensitivity_attitude(moments, rates, [0.0]) == [pytest.approx(0, abs=1e-24)]


def test_a_principal_spin_drifts_linearly() -> None:
    moments, rates, times = (1.0, 2.0, 3.0), (0.0, 0.0, 1.5), [10.0, -1e9]
    expected = [sqrt(2) * abs(t) * ulp(1.5) / 2 for t in times]
    assert half_ulp_sensitivity_attitude(moments, rates, times) == pytest.approx(expected, rel=1e-6)
    assert half_ulp_sensitivity(moments, rates, times) == pytest.approx([ulp(1.5) / 2] * 2, rel=1e-6)


def test_beside_the_separatrix_everything_is_at_stake() -> None:
    moments, rates = (14.0, 21.0, 24.0), (6.0, 1.0, 7.0)
    early, late = half_ulp_sensitivity(moments, rates, [1.0, 60.0])
    assert early < 1e-13
    assert late > 1


def test_a_power_of_two_scales_it() -> None:
    moments, rates, times = (1.0, 2.0, 3.0), (0.3, -0.8, 0.6), [10.0, -300.0]
    larger = [i * 2.0**400 for i in moments], [w * 2.0**300 for w in rates], [t / 2.0**300 for t in times]
    scaled = [x / 2.0**300 for x in half_ulp_sensitivity(*larger)]
    assert scaled == pytest.approx(half_ulp_sensitivity(moments, rates, times), rel=1e-6)
