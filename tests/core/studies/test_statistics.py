"""Statistics against exact rational arithmetic and the standard library, at every scale of doubles."""

from __future__ import annotations

import math
import statistics
from fractions import Fraction

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from core.studies.statistics import PIECE, PROBABILITIES, column_statistics, failure_counts

COLUMNS = st.lists(st.floats(-1e100, 1e100), min_size=2, max_size=40)


@given(COLUMNS)
@settings(deadline=None)
def test_mean_and_deviation_are_those_of_exact_arithmetic(values: list[float]) -> None:
    found = column_statistics(np.array(values))
    exact = [Fraction(x) for x in values]
    mean = sum(exact) / len(exact)
    size = max(map(abs, exact))
    assert found.mean is not None
    assert found.std is not None
    assert found.standard_error is not None
    assert abs(Fraction(found.mean) - mean) <= size * Fraction(1, 2**51)
    variance = sum((x - mean) ** 2 for x in exact) / (len(exact) - 1)
    assert abs(found.std - math.sqrt(variance / size**2) * float(size) if size else found.std) <= 2.0**-50 * size
    assert found.standard_error == pytest.approx(found.std / math.sqrt(len(values)), rel=1e-15)


def test_sums_of_many_numbers_of_every_scale_are_exact() -> None:
    chance = np.random.default_rng(5)
    size = PIECE + 1000
    column = chance.normal(size=size) * 10.0 ** chance.uniform(-340.0, 0.0, size)
    # The scaling by a power of two is exact, so that one rounding of the sum and one of the quotient are left.
    exponent = math.frexp(float(np.abs(column).max()))[1]
    found = column_statistics(column, ["mean", "std"])
    scaled = np.ldexp(column, -exponent)
    mean = math.fsum(scaled.tolist()) / size
    assert found.mean == math.ldexp(mean, exponent)
    squares = np.square(scaled - mean)
    assert found.std == math.ldexp(math.sqrt(math.fsum(squares.tolist()) / (size - 1)), exponent)


@given(COLUMNS)
@settings(deadline=None)
def test_quantiles_are_those_of_the_standard_library(values: list[float]) -> None:
    found = column_statistics(np.array(values), ["quantiles"], probabilities=(0.25, 0.5, 0.75))
    assert found.quantiles is not None
    expected = statistics.quantiles([Fraction(x) for x in values], n=4, method="inclusive")
    size = max(map(abs, values))
    for entry, exact in zip(found.quantiles, expected, strict=True):
        assert abs(Fraction(entry.value) - exact) <= Fraction(size) * Fraction(1, 2**49)


@given(COLUMNS, st.integers(1, 30))
@settings(deadline=None)
def test_every_member_is_in_a_bin(values: list[float], bins: int) -> None:
    histogram = column_statistics(np.array(values), ["histogram"], bins=bins).histogram
    assert histogram is not None
    assert histogram.counts.sum() == len(values)
    assert (histogram.edges[0], histogram.edges[-1]) == (min(values), max(values))
    for k, count in enumerate(histogram.counts.tolist()):
        low, high = histogram.edges[k], histogram.edges[k + 1]
        last = k == len(histogram.counts) - 1
        assert count == sum(low <= x < high or (last and x == high) for x in values)


def test_the_order_of_extremes_and_absent_members() -> None:
    found = column_statistics(np.array([np.nan, 2.0, 1.0, np.nan, 1.0, 5.0, 5.0]))
    assert found.present == 5
    assert found.min == (1.0, 2)
    assert found.max == (5.0, 5)


def test_sums_do_not_depend_on_the_order_of_members() -> None:
    chance = np.random.default_rng(1)
    values = chance.normal(size=10_000) * 10.0 ** chance.integers(-20, 20, 10_000)
    assert column_statistics(values).mean == column_statistics(values[::-1].copy()).mean


def test_the_ends_of_the_range_of_doubles() -> None:
    largest = np.finfo(float).max
    assert column_statistics(np.array([largest, largest])).mean == largest
    assert column_statistics(np.array([largest, -largest])).std is None
    tiny = column_statistics(np.array([5e-324, 5e-324, 1e-323]))
    assert tiny.min == (5e-324, 0)
    assert tiny.mean is not None
    assert 0.0 < tiny.mean <= 1e-323


def test_what_is_not_there_has_no_statistics() -> None:
    assert column_statistics(np.array([np.nan, np.nan])) == (0, None, None, None, None, None, None, None)
    alone = column_statistics(np.array([3.0]))
    assert (alone.mean, alone.std, alone.standard_error) == (3.0, None, None)
    assert alone.quantiles is not None
    assert [entry.value for entry in alone.quantiles] == [3.0] * len(PROBABILITIES)
    assert alone.histogram is not None
    assert alone.histogram.counts.tolist() == [1]


def test_only_what_is_wanted_is_formed() -> None:
    found = column_statistics(np.array([1.0, 2.0]), ["extremes"])
    assert (found.mean, found.std, found.quantiles, found.histogram) == (None, None, None, None)
    assert found.max == (2.0, 1)


def test_failures_are_counted_by_name() -> None:
    assert failure_counts(np.array([0, 2, 1, 2], dtype=np.uint16), ("b", "a", "c")) == {"a": 2, "b": 1}
