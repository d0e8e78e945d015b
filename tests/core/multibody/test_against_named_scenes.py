"""Described scenes against named ones of the same: jerks, friction, bounces without end, a rod that leaves its hole."""

from __future__ import annotations

import pytest

from tests.core.multibody.named_judge import (
    random_rod,
    random_shafts,
    require_same_rod,
    require_same_shafts,
    shafts,
)


@pytest.mark.parametrize("seed", range(24))
def test_described_shafts_jerk_as_the_named_ones(seed: int) -> None:
    require_same_shafts(random_shafts(seed))


@pytest.mark.parametrize("seed", range(9))
def test_described_shafts_on_rough_slopes_slip_and_stick_as_the_named_ones(seed: int) -> None:
    require_same_shafts(random_shafts(seed, rough=True))


@pytest.mark.parametrize("seed", range(12))
def test_a_described_rod_leaves_its_hole_as_the_named_one(seed: int) -> None:
    require_same_rod(random_rod(seed))


def test_the_judge_sees_another_restitution() -> None:
    named = random_shafts(1)
    other = shafts(named)
    other["connections"][-1]["restitution"] = 0.31
    assert shafts(random_shafts(1)) != other
    with pytest.raises(AssertionError):
        require_same_shafts(named, other)
