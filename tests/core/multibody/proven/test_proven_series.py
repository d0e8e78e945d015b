"""A series with a rigorous remainder: against elliptic functions, and against what its own radii say."""

from __future__ import annotations

from typing import Any

import pytest
from flint import arb

from core.balls import precision
from core.errors import BudgetExceeded
from core.multibody.algebra.polynomials import BITS, evaluated
from core.multibody.motion.modelling import modelled
from core.multibody.proven.proven_series import ProvenSeries
from tests.core.multibody.worked_examples import TWO_RODS, read

SWING: dict[str, Any] = {
    "gravity": [0, -9.81],
    "bodies": {"bob": {"mass": 1, "at": ["sin(2.5)", "-cos(2.5)"]}},
    "connections": [{"kind": "rod", "a": "bob", "b": [0, 0]}],
}


def series_of(scene: dict[str, Any]) -> ProvenSeries:
    with precision(BITS):
        (piece,) = modelled(read(scene)).pieces
    return ProvenSeries(piece.table, piece.chosen)


@pytest.mark.parametrize("scene", [SWING, TWO_RODS], ids=["pendulum", "two rods"])
def test_measures_hold_and_more_bits_lie_within_fewer(scene: dict[str, Any]) -> None:
    series = series_of(scene)
    with precision(BITS):
        times = [arb("0.1"), arb("-0.07"), arb(0)]
    with precision(140):
        rough = series.states(times)
    with precision(220):
        fine = series.states(times)
        for few, many in zip(rough, fine, strict=True):
            for row in series.rows:
                assert evaluated(row.measure or {}, few.q).contains(0)
            for x, y in zip((*few.q, *few.v), (*many.q, *many.v), strict=True):
                assert x.overlaps(y)
                assert y.rad() <= x.rad()
        assert all(float(x.rad()) < 1e-25 for x in rough[0].q)
    assert all(x.overlaps(y) for x, y in zip(rough[2].q, series.table.q, strict=True))


def test_a_motion_longer_than_can_be_proven_is_refused_before_it_is_followed() -> None:
    with precision(120), pytest.raises(BudgetExceeded) as refusal:
        series_of(SWING).states([arb(1000)])
    assert refusal.value.path == ("times",)
    assert refusal.value.needed > refusal.value.limit
