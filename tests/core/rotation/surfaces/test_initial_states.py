"""Starts of one energy: on the surface exactly, uniform on the scaled sphere, the same for the same seed."""

from fractions import Fraction

import numpy as np
import pytest

from core.bodies.mass_properties import diagonal
from core.errors import BudgetExceeded, InvalidParameter
from core.rotation.surfaces.initial_states import initial_states

MOMENTS = (2.0, 1.0, 0.5)


def test_every_state_has_the_energy():
    for w in initial_states(diagonal(MOMENTS), 1.0, 200, 3):
        energy = sum(Fraction(i) * Fraction(float(x)) ** 2 for i, x in zip(MOMENTS, w, strict=True)) / 2
        assert abs(energy - 1) < 2e-15


def test_directions_are_uniform():
    """Archimedes: each coordinate of a uniform direction is uniform on [-1, 1]; Kolmogorov-Smirnov at about 4 sigma."""
    w = initial_states(diagonal(MOMENTS), 1.0, 20_000, 11) / np.sqrt(2.0 / np.array(MOMENTS))
    even = (np.arange(20_000) + 0.5) / 20_000
    for k in range(3):
        spread = np.abs(np.sort(0.5 * (w[:, k] + 1.0)) - even).max()
        assert spread < 2.1 / np.sqrt(20_000)
    assert abs(w.mean(axis=0)).max() < 4 / np.sqrt(3 * 20_000)


def test_seed_decides():
    first, again, other = (initial_states(diagonal(MOMENTS), 1.0, 5, seed) for seed in (1, 1, 2))
    assert np.array_equal(first, again)
    assert not np.array_equal(first, other)


def test_what_cannot_be_drawn_is_refused():
    with pytest.raises(InvalidParameter):
        initial_states(diagonal(MOMENTS), 1.0, 0, 1)
    with pytest.raises(InvalidParameter):
        initial_states(diagonal(MOMENTS), 1.0, 1, -1)
    with pytest.raises(BudgetExceeded):
        initial_states(diagonal(MOMENTS), 1.0, 10**7, 1)
