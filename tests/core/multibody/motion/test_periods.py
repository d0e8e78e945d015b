"""Motions that repeat, many periods after their start."""

from __future__ import annotations

from typing import Any

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


def period(scene: dict[str, Any]) -> float:
    found = solve_scene(read(scene), [0.1]).period
    assert found is not None
    return found


@pytest.mark.parametrize("degrees", ["10", "45", "44.9999999", "45.0001", "60", "89", "120", "135", "-45", "170"])
def test_the_period_of_a_pendulum_is_the_elliptic_integral_at_every_angle(degrees: str) -> None:
    """At 45 degrees the path turns by a right angle from one turning point to the other."""
    angle = f"{degrees}*pi/180"
    bob = {"mass": 1, "at": [f"2*sin({angle})", f"-2*cos({angle})"]}
    rod = {"kind": "rod", "a": "bob", "b": [0, 0]}
    found = period({"gravity": [0, "-9.81"], "bodies": {"bob": bob}, "connections": [rod]})
    with mpmath.workdps(40):
        half = mpmath.mpf(degrees) * mpmath.pi / 360
        right = 4 * mpmath.sqrt(2 / mpmath.mpf("9.81")) * mpmath.ellipk(mpmath.sin(half) ** 2)
        assert abs(found - right) <= 3e-16 * right


@pytest.mark.parametrize("slope", ["0.3", "1", "1.0001", "2"])
def test_the_period_of_a_bead_on_a_parabola_is_the_integral_along_it(slope: str) -> None:
    """On y = x^2 / 2, whose slope is x, from rest: the time over the arc is an integral."""
    track = {"kind": "track", "place": "bead", "on": {"at": [0, 0], "curvature": 1}}
    bead = {"mass": 1, "at": [slope, f"{slope}^2/2"]}
    found = period({"gravity": [0, "-9.81"], "bodies": {"bead": bead}, "connections": [track]})
    with mpmath.workdps(30):
        a = mpmath.mpf(slope)

        def along(angle: mpmath.mpf) -> mpmath.mpf:
            # x = a sin(angle), and the speed is sqrt(g (a^2 - x^2)).
            return mpmath.sqrt((1 + (a * mpmath.sin(angle)) ** 2) / mpmath.mpf("9.81"))

        right = 4 * mpmath.quad(along, [0, mpmath.pi / 4, mpmath.pi / 2])
        assert abs(found - right) <= 3e-16 * right
