"""Sobol points against SciPy's, to the bit: it has the same direction numbers and scrambles them in the same way."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.stats import qmc

from core.studies.sobol import BITS, MOST_DIMENSIONS, SobolPoints


def generator(seed: int) -> np.random.Generator:
    return np.random.Generator(np.random.PCG64(np.random.SeedSequence(seed)))


@pytest.mark.parametrize("dimensions", [1, 2, 3, 7, MOST_DIMENSIONS])
def test_points_are_those_of_scipy(dimensions: int) -> None:
    # SciPy draws from a child of the generator that it is given.
    expected = qmc.Sobol(dimensions, rng=generator(5)).random(2048)
    (child,) = generator(5).spawn(1)
    assert np.array_equal(SobolPoints(dimensions, child).points(0, 2048), expected)


def test_points_far_on_are_found_without_those_before() -> None:
    sequence = qmc.Sobol(3, rng=generator(1))
    sequence.fast_forward(1_000_003)
    (child,) = generator(1).spawn(1)
    assert np.array_equal(SobolPoints(3, child).points(1_000_003, 1_000_103), sequence.random(100))


def test_the_last_points_differ() -> None:
    points = SobolPoints(2, generator(2)).points(2**BITS - 64, 2**BITS)
    assert len(np.unique(points, axis=0)) == 64
    assert ((points >= 0.0) & (points < 1.0)).all()


def test_every_elementary_interval_of_a_plane_has_one_point() -> None:
    """The first two dimensions are a (0, m, 2)-net, which scrambling keeps (Niederreiter 1992, section 4.1)."""
    points = SobolPoints(2, generator(3)).points(0, 256)
    for power in range(9):
        places = np.floor(points * [2**power, 2 ** (8 - power)]).astype(int)
        assert len(np.unique(places, axis=0)) == 256
