"""How large the errors of columns are: relative to the values of their units, and beside what is requested."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import replace

import numpy as np

from core.arrays import Floats, largest_magnitude, row_lengths
from core.errors import AccuracyUnreachable, NotApplicable
from core.multibody.search.bands import FLOOR
from core.systems.trajectory import Column

PLACES_BETWEEN = np.append(np.arange(1, 18) * ((5.0**0.5 - 1.0) / 2.0) % 1.0, 0.618 * 0.25 ** np.arange(3, 20))
"""Shares of a time that are spread evenly and meet none of the fractions of a period, and those near the start, where
motions are that come to rest soon."""
ROUNDED = 2.0**-46
"""Share of the largest value that the error of a column has by rounding alone, with that of its sizes."""
FINEST = 2.0**-50
"""An accuracy below this is only met by coordinates and rates that are the doubles nearest to pairs."""


def apart(column: Column, other: Column) -> float:
    """Return the largest distance between the samples of two columns of one quantity.

    Opposite quaternions are one attitude.
    """
    first, second = column.values, other.values
    if first.ndim == 1:
        return largest_magnitude(first - second)
    each = row_lengths(first - second)
    if first.shape[1] == 4:
        each = np.minimum(each, row_lengths(first + second))
    return float(each.max(initial=0.0))


def worst(columns: Mapping[str, Column]) -> float:
    """Return the largest error of a column, relative to the largest value among the columns of its unit."""
    return relative({name: column.error for name, column in columns.items()}, columns)


def relative(figures: Mapping[str, float], columns: Mapping[str, Column]) -> float:
    """Return the largest of figures by column, relative to the largest value among the columns of its unit."""
    scales = scales_of(columns)
    return max((figure / scales[name] for name, figure in figures.items() if scales[name] > 0.0), default=0.0)


def scales_of(columns: Mapping[str, Column]) -> dict[str, float]:
    """Return what the error of each column is relative to: the largest value among the columns of its unit.

    That is a scale that is known already, as of what is small at all samples, or the largest sample. What is zero by
    symmetry has no scale of its own. Angles that are zero within their error are measured against one radian, their
    rates against the largest speed over the largest distance, and speeds against the largest of these rates times that
    distance; so are those that are no more than rounding of these.
    """
    largest, unknown = _sizes(columns)
    for column in columns.values():
        if column.scale:
            largest[column.unit] = max(largest[column.unit], column.scale)
    away, speed, turn = (largest.get(unit, 0.0) for unit in ("m", "m/s", "rad/s"))
    for unit, scale in (("rad", 1.0), ("rad/s", speed / away if away > 0.0 else 0.0), ("m/s", turn * away)):
        if largest.get(unit, 0.0) <= max(unknown.get(unit, 0.0), FLOOR * scale):
            largest[unit] = max(largest.get(unit, 0.0), scale)
    # Momenta and energies that are zero within their error have no scale; what they follow from has.
    for unit in ("kg m/s", "kg m^2/s", "J"):
        if largest.get(unit, 0.0) <= unknown.get(unit, 0.0):
            largest[unit] = 0.0
    return {name: largest[column.unit] for name, column in columns.items()}


def _sizes(columns: Mapping[str, Column]) -> tuple[dict[str, float], dict[str, float]]:
    """Return the largest value and the largest error among the columns of each unit."""
    alike: dict[str, list[Column]] = {}
    for column in columns.values():
        alike.setdefault(column.unit, []).append(column)
    largest = {unit: max([0.0, *[column.largest for column in own]]) for unit, own in alike.items()}
    unknown = {unit: max([0.0, *[column.error for column in own]]) for unit, own in alike.items()}
    return largest, unknown


def with_natural_sizes(
    columns: Mapping[str, Column], times: Floats, columns_at: Callable[[Floats], Mapping[str, Column]]
) -> dict[str, Column]:
    """Return columns, those that are small at all times with how large they are between the start and the farthest.

    A rate is zero where the motion turns back. There its error is that of the whole motion, and no share of what is
    left of the rate. What is zero at the other times, too, has no size.

    Parameters
    ----------
    times : ndarray, shape (t,)
        Of the samples.
    columns_at : callable
        The same columns at other times.
    """
    largest, unknown = _sizes(columns)
    small = {unit for unit, size in largest.items() if unknown[unit] > ROUNDED * size}
    farthest = float(times[np.argmax(np.abs(times))]) if len(times) else 0.0
    if not small or farthest == 0.0:
        return dict(columns)
    other = columns_at(farthest * PLACES_BETWEEN)
    return {
        name: replace(column, scale=max(column.scale or 0.0, other[name].largest))
        if column.unit in small and name in other and other[name].largest > other[name].error
        else column
        for name, column in columns.items()
    }


def scaled(columns: Mapping[str, Column]) -> dict[str, Column]:
    """Return columns with what their errors are relative to."""
    scales = scales_of(columns)
    return {
        name: Column(one.values, one.unit, one.error, one.how, one.inherited, scales[name])
        for name, one in columns.items()
    }


def require_known(columns: Mapping[str, Column]) -> None:
    """Raise `NotApplicable` for columns that leave the range of doubles."""
    lost = [name for name, one in columns.items() if not (np.isfinite(one.values).all() and np.isfinite(one.error))]
    if lost:
        raise NotApplicable(
            f"{lost[0]} or its error leaves the range of doubles",
            path=("times",),
            remedy="ask for a shorter time, or choose units in which the numbers are moderate",
        )


def require_reached(columns: Mapping[str, Column], accuracy: float, *, before: float | None = None) -> None:
    """Raise for columns that leave the range of doubles, or whose errors are larger than the accuracy.

    The remedy names the time `before` which they are not, where that is known.

    Raises
    ------
    NotApplicable, AccuracyUnreachable
    """
    require_known(columns)
    reached = worst(columns)
    if reached > accuracy and reached <= 2 * FINEST:
        raise AccuracyUnreachable(
            accuracy,
            reached,
            "the samples are doubles, in which momenta, works, paths and the phases of contacts are computed",
            remedy="ask for other outputs, or for digits: POST /v1/certified/scenes",
        )
    if reached > accuracy:
        raise AccuracyUnreachable(
            accuracy,
            reached,
            "rounding is amplified, by the motion or by what is computed of it in doubles",
            remedy="ask for "
            + ("a shorter time" if before is None else f"times before {before:.6g} s")
            + (" or a larger accuracy" if reached < 1.0 else ""),
        )
