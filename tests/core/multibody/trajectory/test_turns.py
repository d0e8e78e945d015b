"""Where curves turn: between samples, soon after the start, and just before the end."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from core.multibody.trajectory.turns import HALVINGS, closer_at_ends, dips, reversals

numbers = st.floats(-10, 10)
steps = st.floats(0.01, 10)


@pytest.mark.parametrize("way", [1.0, -1.0])
def test_intervals_halve_towards_both_ends(way: float) -> None:
    found = way * closer_at_ends(way * np.array([0.0, 1.0, 2.0, 4.0]), 3)
    assert found.tolist() == [0.0, 0.125, 0.25, 0.5, 1.0, 2.0, 3.0, 3.5, 3.75, 4.0]


def test_times_that_doubles_do_not_tell_apart_are_one() -> None:
    found = closer_at_ends(np.array([0.0, 1.0, 1.0 + 2.0**-50]))
    assert np.all(np.diff(found) > 0.0)
    assert len(found) == HALVINGS + 5
    assert closer_at_ends(np.array([3.0])).tolist() == [3.0]


@settings(deadline=None, derandomize=True)
@given(numbers, st.floats(0.1, 10), numbers, st.tuples(numbers, steps, steps))
def test_a_parabola_is_known_to_its_lowest_place(
    height: float, bend: float, at: float, where: tuple[float, ...]
) -> None:
    times = np.cumsum(where)
    curve = height + bend * (times - at) ** 2
    low = dips(times, curve)
    assert low[0] == low[2] == np.inf
    lowest = curve[1] <= curve[0] and curve[1] <= curve[2]
    scale = np.abs(curve).max() / min(np.diff(times)) * max(np.diff(times))
    assert low[1] == (pytest.approx(height, abs=1e-12 * scale) if lowest else np.inf)


@settings(deadline=None, derandomize=True)
@given(st.lists(st.floats(0.01, 3.1), min_size=1, max_size=8), st.integers(1, 3))
def test_a_velocity_turns_against_itself_where_it_is_nothing(gaps: list[float], size: int) -> None:
    roots = np.cumsum(gaps)
    direction = np.arange(1.0, size + 1.0)

    def velocity(times: np.ndarray) -> np.ndarray:
        signs = (-1.0) ** np.sum(times[:, None] > roots, axis=1)
        nearest = np.min(np.abs(times[:, None] - roots), axis=1)
        return (signs * nearest)[:, None] * direction

    grid = np.sort(np.concatenate([[0.0], roots[:-1] + 0.3 * np.diff(roots), [roots[-1] + 0.7]]))
    assert reversals(velocity, grid) == pytest.approx(roots, rel=1e-14)


def test_what_only_turns_aside_is_no_corner() -> None:
    assert not len(
        reversals(lambda times: np.stack([np.cos(times), np.sin(times)], axis=1), np.linspace(0.0, 20.0, 41))
    )
