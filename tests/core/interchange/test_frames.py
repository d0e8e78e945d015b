"""Rotations of files: each form back to another, and against compositions by hand."""

from __future__ import annotations

import numpy as np
import pytest

from core.interchange.frames import (
    Frame,
    as_quaternion,
    at,
    axes_from,
    of_quaternion,
    parallel,
    roll_pitch_yaw,
    turn_about,
    unit,
    vector,
)


def test_quaternions_of_any_rotation_are_found_again() -> None:
    """A hundred at random, and half turns, at which the scalar part is zero."""
    rng = np.random.default_rng(4)
    given = [*rng.normal(size=(100, 4)), *np.eye(4)[1:], [0.0, 1.0, 1.0, 0.0], [1e-9, 0.0, 0.0, 1.0]]
    for quaternion in given:
        rotation = of_quaternion(quaternion)
        assert rotation @ rotation.T == pytest.approx(np.eye(3), abs=1e-15)
        assert of_quaternion(as_quaternion(rotation)) == pytest.approx(rotation, abs=1e-15)


def test_roll_pitch_and_yaw_are_about_fixed_axes() -> None:
    """A quarter turn about x takes y to z, which a quarter turn about z then leaves."""
    rotation = roll_pitch_yaw((np.pi / 2, 0.0, np.pi / 2))
    assert rotation @ [0.0, 1.0, 0.0] == pytest.approx([0.0, 0.0, 1.0], abs=1e-15)
    assert rotation @ [1.0, 0.0, 0.0] == pytest.approx([0.0, 1.0, 0.0], abs=1e-15)


@pytest.mark.parametrize("normal", [(0.0, 0.0, 2.0), (0.0, 0.0, -1.0), (1.0, 2.0, -3.0), (1e-8, 0.0, 1.0)])
def test_axes_from_a_normal_have_it_as_z(normal: tuple[float, float, float]) -> None:
    rotation = axes_from(vector(normal))
    assert rotation[:, 2] == pytest.approx(np.array(normal) / np.linalg.norm(normal), abs=1e-15)
    assert np.linalg.det(rotation) == pytest.approx(1.0, abs=1e-15)


def test_frames_in_frames_and_points_in_and_out() -> None:
    outer = at((1.0, 2.0, 3.0), turn_about(np.array([0.6, 0.0, 0.8]), 0.7))
    inner: Frame = outer @ at((0.1, 0.2, 0.3))
    place = vector((0.5, -0.4, 2.0))
    assert inner.point(place) == pytest.approx(outer.point(place + vector((0.1, 0.2, 0.3))), abs=1e-15)
    assert inner.inside(inner.point(place)) == pytest.approx(place, abs=1e-15)
    assert parallel(outer.direction(vector((0.6, 0.0, 0.8))), vector((-0.6, 0.0, -0.8)))


def test_quaternions_of_any_length_are_rotations() -> None:
    """Squares of 1e-200 and 1e200 are no doubles."""
    for size in (1e-200, 1.0, 1e200):
        assert of_quaternion([size, 0.0, 0.0, size]) == pytest.approx(turn_about(np.array([0.0, 0.0, 1.0]), np.pi / 2))


def test_directions_of_any_length_have_length_one() -> None:
    for size in (1e-300, 1e-162, 1.0, 1e200):
        assert unit(size * np.array([3.0, 0.0, -4.0])) == pytest.approx([0.6, 0.0, -0.8], rel=1e-15)
