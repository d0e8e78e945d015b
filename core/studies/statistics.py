"""Statistics of one figure over the members of a study, from the whole column in member order.

Sums are exact and rounded once, so that the same column gives the same bits on every machine and in
whatever order its parts came about. Members without the figure are NaN in the column and left out.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping, Sequence
from typing import Any, Literal, NamedTuple, get_args

import numpy as np

from core.arrays import Floats

Statistic = Literal["mean", "std", "quantiles", "extremes", "histogram", "failures"]
STATISTICS: tuple[Statistic, ...] = get_args(Statistic)

PROBABILITIES = (0.01, 0.025, 0.05, 0.25, 0.5, 0.75, 0.95, 0.975, 0.99)
BINS = 50

PIECE = 2**18
"""Numbers that are added at a time: few enough that the sums of parts of their significands are exact."""


class Quantile(NamedTuple):
    """The value below which a share of the members lies, linear between two members.

    Attributes
    ----------
    probability : float
    value : float
        In the unit of the figure.
    """

    probability: float
    value: float


class Extreme(NamedTuple):
    """A smallest or largest figure, and the first member that has it."""

    value: float
    member: int


class Histogram(NamedTuple):
    """Members by figure.

    Attributes
    ----------
    edges : ndarray, shape (bins + 1,)
        Of the bins, ascending; the last bin includes its upper edge.
    counts : ndarray, shape (bins,)
        Of members.
    """

    edges: Floats
    counts: np.ndarray[Any, np.dtype[np.int64]]


class ColumnStatistics(NamedTuple):
    """Statistics of a figure; those that are not wanted, or do not exist, are None.

    Attributes
    ----------
    present : int
        Members that have the figure.
    mean : float or None
    standard_error : float or None
        Of the mean, for independent members: the deviation over the root of their number.
    std : float or None
        Deviation of the sample, with n - 1.
    quantiles : tuple of Quantile or None
    min, max : Extreme or None
    histogram : Histogram or None
    """

    present: int
    mean: float | None = None
    standard_error: float | None = None
    std: float | None = None
    quantiles: tuple[Quantile, ...] | None = None
    min: Extreme | None = None
    max: Extreme | None = None
    histogram: Histogram | None = None


def column_statistics(
    column: Floats,
    wanted: Sequence[Statistic] = STATISTICS,
    *,
    probabilities: Sequence[float] = PROBABILITIES,
    bins: int = BINS,
) -> ColumnStatistics:
    """Return the statistics of a column, shape (n,), NaN where a member has no such figure."""
    known = ~np.isnan(column)
    values = column if known.all() else column[known]
    if not values.size:
        return ColumnStatistics(0)
    found: dict[str, Any] = {}
    low, high = int(values.argmin()), int(values.argmax())
    # Exact scaling, so that no sum or square leaves the range of doubles.
    exponent = math.frexp(max(abs(values[low]), abs(values[high])))[1]
    if "mean" in wanted or "std" in wanted:
        scaled = np.ldexp(values, -exponent)
        mean = _sum(scaled) / values.size
        deviation = None
        if values.size > 1:
            squares = np.square(scaled - mean)
            deviation = math.sqrt(_sum(squares) / (values.size - 1))
        if "mean" in wanted:
            found["mean"] = _unscaled(mean, exponent)
            found["standard_error"] = _unscaled(
                None if deviation is None else deviation / math.sqrt(values.size), exponent
            )
        if "std" in wanted:
            found["std"] = _unscaled(deviation, exponent)
    ordered = np.sort(values) if "quantiles" in wanted or "histogram" in wanted else values
    if "quantiles" in wanted:
        found["quantiles"] = tuple(Quantile(p, _quantile(ordered, p)) for p in probabilities)
    if "extremes" in wanted:
        found["min"] = Extreme(float(values[low]), _member(known, low))
        found["max"] = Extreme(float(values[high]), _member(known, high))
    if "histogram" in wanted:
        found["histogram"] = _histogram(ordered, bins)
    return ColumnStatistics(int(values.size), **found)


def failure_counts(codes: np.ndarray[Any, Any], names: Sequence[str]) -> Mapping[str, int]:
    """Return how many members have each code, by name in alphabetic order; code 0 is none, k stands for names[k-1]."""
    counted = np.bincount(codes.astype(np.int64), minlength=len(names) + 1)[1:].tolist()
    return {name: count for name, count in sorted(zip(names, counted, strict=True)) if count}


def _sum(values: Floats) -> float:
    """Return the exact sum, rounded once; no partial sum may leave the range of doubles."""
    return math.fsum(term for start in range(0, values.size, PIECE) for term in _terms(values[start : start + PIECE]))


def _terms(values: Floats) -> Iterator[float]:
    """Yield a few numbers whose sum is exactly that of many.

    Of numbers with the same exponent the upper 27 and the lower 26 bits are added as integers, which doubles hold.
    """
    significands, exponents = np.frexp(values)
    lowest = int(exponents.min())
    upper = np.trunc(significands * 2.0**27)
    for bits, part in ((27, upper), (53, significands * 2.0**53 - upper * 2.0**26)):
        sums = np.bincount(exponents - lowest, part)
        yield from map(math.ldexp, sums.tolist(), range(lowest - bits, lowest - bits + sums.size))


def _member(known: np.ndarray[Any, np.dtype[np.bool_]], place: int) -> int:
    """Return which member is the one at a place among those that have the figure."""
    return int(np.searchsorted(np.cumsum(known), place + 1))


def _unscaled(value: float | None, exponent: int) -> float | None:
    if value is None:
        return None
    try:
        return math.ldexp(value, exponent)
    except OverflowError:
        return None


def _quantile(ordered: Floats, probability: float) -> float:
    """Return a quantile of ascending values, by linear interpolation (definition 7 of Hyndman and Fan 1996)."""
    place = probability * (ordered.size - 1)
    below = min(int(place), ordered.size - 1)
    above = min(below + 1, ordered.size - 1)
    share = place - below
    low, high = float(ordered[below]), float(ordered[above])
    # In this form nothing exceeds the range of doubles, and equal values give themselves.
    return low if low == high else low * (1.0 - share) + high * share


def _histogram(ordered: Floats, bins: int) -> Histogram:
    low, high = float(ordered[0]), float(ordered[-1])
    if low == high:
        return Histogram(np.array([low, high]), np.array([ordered.size]))
    shares = np.arange(bins + 1) / bins
    edges = low * (1.0 - shares) + high * shares
    edges[0], edges[-1] = low, high
    # Of a range of few ulps some edges coincide.
    edges = np.unique(edges)
    below = np.searchsorted(ordered, edges)
    below[-1] = ordered.size
    return Histogram(edges, np.diff(below).astype(np.int64))
