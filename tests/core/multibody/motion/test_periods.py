"""Motions that repeat, many periods after their start."""

from __future__ import annotations

import mpmath
import pytest

from core.multibody.solve import solve_scene
from tests.core.multibody.worked_examples import column, read


@pytest.mark.parametrize("strength", [4, 20, 30, 36, 40, 44])
@pytest.mark.parametrize("time", [7.3, 10.0, 3.1e3])
def test_a_place_after_up_to_1e25_periods_is_the_elliptic_function_within_its_error(strength: int, time: float) -> None:
    # Beyond 2^53 periods their number is no whole number in doubles; pairs still tell the phase.
    bob = {"mass": 2, "at": ["sin(2.5)", "-cos(2.5)"]}
    rod = {"kind": "rod", "a": "bob", "b": [0, 0]}
    scene = {"gravity": [0, f"-1e{strength}"], "bodies": {"bob": bob}, "connections": [rod]}
    place = column(solve_scene(read(scene), [time], accuracy=0.5), "bob.position")
    with mpmath.workdps(80):
        # sin(theta/2) = k cd(omega t, k), with k the sine of half the amplitude
        k = mpmath.sin(mpmath.mpf("1.25"))
        half = mpmath.asin(
            k * mpmath.ellipfun("cd", mpmath.sqrt(mpmath.mpf(10) ** strength) * mpmath.mpf(time), m=k * k)
        )
        assert abs(mpmath.sin(2 * half) - place.values[0, 0]) <= place.error
    assert place.error < max(1e-14, 10.0 ** (strength / 2 - 26) * time)
