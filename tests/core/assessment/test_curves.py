"""Curves are the same wherever they start, whichever way they go, and by however many points they are given."""

from __future__ import annotations

import numpy as np
import pytest

from core.assessment.compare import Reference, compare
from core.assessment.curves import dense, separation
from core.bodies import PrincipalMoments
from core.errors import InvalidParameter
from core.rotation.surfaces.polhodes import polhode

BODY = PrincipalMoments((1.0, 2.0, 2.5)).mass_properties()
SPIN = np.array([0.4, 1.0, 0.9])


def test_the_points_between_are_on_the_curve() -> None:
    """Energy and angular momentum, which the interpolation does not use, are those of the curve."""
    for count in (32, 64, 256):
        points, error = dense(polhode(BODY, SPIN, count).points)
        moments = np.array([1.0, 2.0, 2.5])
        for power in (1, 2):
            values, right = (moments**power * points**2).sum(axis=1), float((moments**power * SPIN**2).sum())
            # The gradient of such a sum is at most 2 I^power w.
            gradient = 2.0 * np.linalg.norm(moments**power * points, axis=1).min()
            assert np.abs(values - right).max() / gradient <= error
    assert error < 1e-5


@pytest.mark.parametrize("count", [60, 137, 1000])
def test_start_direction_and_number_of_points_do_not_matter(count: int) -> None:
    right = polhode(BODY, SPIN, 256).points
    given = polhode(BODY, SPIN, count).points[:-1]
    # What is left is the sag of the chords of the given points.
    sag = np.linalg.norm(np.diff(given, 2, axis=0), axis=1).max() / 4.0
    for curve in (given, np.roll(given, count // 3, axis=0), given[::-1]):
        assert separation(curve, right) <= sag + 1e-5


def test_distances_are_those_of_circles() -> None:
    angle = np.linspace(0.0, 2.0 * np.pi, 65)
    circle = np.stack([np.cos(angle), np.sin(angle), 0.0 * angle], axis=1)
    many = np.linspace(0.0, 2.0 * np.pi, 1500)[:-1]
    other = np.stack([1.1 * np.cos(many), 1.1 * np.sin(many), 0.05 + 0.0 * many], axis=1)
    assert separation(other, circle) == pytest.approx(np.hypot(0.1, 0.05), rel=1e-4)
    # Half of the circle is not the circle: the far end is one radius and more away.
    assert separation(other[:750] / 1.1, circle) > 0.9


def test_a_curve_is_judged_by_its_distance() -> None:
    right = polhode(BODY, SPIN, 256).points
    reference = Reference(right, "rad s^-1", "curve", float(np.abs(right).max()))
    given = polhode(BODY, SPIN, 200).points
    assert compare(reference, given[::-1]).verdict == "correct"
    assert compare(reference, 1.02 * given).verdict == "incorrect"
    assert compare(reference, polhode(BODY, SPIN * [1, 1, -1], 200).points).verdict == "incorrect"
    for wrong in (given[:5], given[:, :2], np.zeros((3000, 3)), 1.0):
        with pytest.raises(InvalidParameter):
            compare(reference, wrong)
