"""Arrays with fewer digits: those that mean something, or as many as the client wants.

A rounded number is the double nearest to a short decimal, so that it is written short. What rounding adds to the error
is returned, because an error that is stated covers what is sent.
"""

from __future__ import annotations

from dataclasses import replace
from math import ceil, floor, inf, log10
from typing import Any, Literal

import numpy as np

from core.arrays import Floats
from core.notices import Notice
from core.systems.trajectory import Trajectory
from core.work import spend

ROUND_TRIP = 17
"""Significant digits that tell every double from every other."""

EXACT_POWERS = 22
"""Powers of ten up to this are doubles without rounding."""

NUMBERS_PER_UNIT = 4
"""Numbers that are rounded in a unit of work (`core.work`)."""

NEAREST = 2.0**-53
"""From a decimal to the double nearest to it."""


Digits = Literal["meaningful"] | int
"""Significant digits of each number, or ``"meaningful"``: the decimal places that the stated errors support."""


def rounded(values: Floats, digits: Digits, error: float, scale: float | None = None) -> tuple[Floats, float]:
    """Return samples, shape (n, k) or (n,), with fewer digits, and the error that this adds, relative to `scale`.

    Parameters
    ----------
    digits : int or "meaningful"
    error : float
        What is not known of the samples, relative to `scale`.
    scale : float, optional
        Largest norm of the motion; the largest magnitude in `values` if omitted, which errs to more digits.
    """
    # Most are rounded all at once, but any may have to go through its decimals.
    spend(values.size / NUMBERS_PER_UNIT)
    if digits == "meaningful":
        largest = _largest(values) if scale is None else scale
        if not (0.0 < error < inf and 0.0 < largest < inf):
            return values, 0.0
        places = ceil(-log10(error) - log10(largest))
        written = to_places(values, places)
        return written, 0.0 if written is values else 0.5 * _width(values) * _ratio(places, largest) + NEAREST
    if digits >= ROUND_TRIP:
        return values, 0.0
    # Each component moves by half a unit of its last digit, and errors of components add as squares.
    return to_significant(values, digits), 5.0 * 10.0**-digits + NEAREST


def to_places(values: Floats, places: int) -> Floats:
    """Return values rounded to decimal places (powers of ten above one if negative); as they are if that is no gain."""
    largest = _largest(values)
    if largest == 0.0 or log10(largest) + places >= ROUND_TRIP - 2:
        return values
    if abs(places) <= EXACT_POWERS:
        # Whole numbers and powers of ten that are exact have the nearest double as their quotient.
        power = 10.0 ** abs(places)
        found: Floats = np.rint(values * power) / power if places >= 0 else np.rint(values / power) * power
        return found
    return _by_decimals(values, lambda value: _to_place(value, places))


def _to_place(value: float, places: int) -> float:
    """Return a number rounded to a decimal place; the largest doubles have nothing above them to be rounded to."""
    try:
        return round(value, places)
    except OverflowError:
        return value


def to_significant(values: Floats, digits: int) -> Floats:
    """Return values rounded to significant digits, each by itself."""
    flat = np.ravel(values)
    with np.errstate(divide="ignore"):
        exponents = np.floor(np.log10(np.abs(flat)))
    exponents[flat == 0.0] = 0.0
    places = digits - 1 - exponents
    plain = (np.abs(places) <= EXACT_POWERS) & (digits < ROUND_TRIP - 2)
    powers = np.array([10.0**k for k in range(EXACT_POWERS + 1)])
    power = powers[np.abs(np.where(plain, places, 0.0)).astype(np.int64)]
    if plain.all() and places.min(initial=0.0) >= 0.0:
        # Nearly always, and then no number need be picked out.
        quick: Floats = (np.rint(flat * power) / power).reshape(values.shape)
        return quick
    out = np.empty_like(flat)
    up, down = plain & (places >= 0), plain & (places < 0)
    out[up] = np.rint(flat[up] * power[up]) / power[up]
    out[down] = np.rint(flat[down] / power[down]) * power[down]
    out[~plain] = [float(f"{value:.{digits - 1}e}") for value in flat[~plain].tolist()]
    # The largest doubles have nothing above them to be rounded to.
    return np.where(np.isfinite(out), out, flat).reshape(values.shape)


def shortened(trajectory: Trajectory, digits: Digits) -> Trajectory:
    """Return a trajectory with fewer digits in every column, whose stated errors cover that.

    Parameters
    ----------
    digits : int or "meaningful"
        Significant digits; or the decimal places that the errors support, and the inherited ones where they are known.
    """
    stated = trajectory.accuracy
    norm, error, columns = stated.largest_norm, stated.error, {}
    for name, column in trajectory.columns.items():
        reach = min(column.largest, column.scale or inf) if norm is None else norm
        if norm is None and reach == 0.0:
            columns[name] = column
            continue
        if norm is None:
            unknown = (column.error + (column.inherited or 0.0)) / reach
        else:
            # Nothing is known of a state of which nothing bounds the inherited error.
            unknown = 1.0 if stated.inherited is None else stated.error + stated.inherited
        values, added = rounded(column.values, digits, unknown, reach)
        columns[name] = replace(column, values=values, error=column.error + added * reach)
        scale = reach if column.scale is None else column.scale
        error = max(error, stated.error + added if norm is not None else columns[name].error / scale if scale else 0.0)
    final = None if stated.final_error is None else stated.final_error + (error - stated.error)
    warnings = trajectory.warnings
    if stated.error <= stated.requested < error:
        detail = f"rounding leaves an error of {error:.3g}, where {stated.requested:.3g} was asked for"
        warnings = (*warnings, Notice("rounded-beyond-accuracy", detail, ("round",)))
    accuracy = replace(stated, error=error, final_error=final)
    return replace(trajectory, columns=columns, accuracy=accuracy, warnings=warnings)


def _by_decimals(values: Floats, shorten: Any) -> Floats:
    """Return values rounded one by one through their decimals, where powers of ten are not exact."""
    return np.array([shorten(value) for value in values.ravel().tolist()]).reshape(values.shape)


def _largest(values: Floats) -> float:
    return max(float(values.max()), -float(values.min())) if values.size else 0.0


def _width(values: Floats) -> float:
    """Return the factor from the error of a component to that of the norm of a row."""
    return float(np.sqrt(values.shape[-1])) if values.ndim > 1 else 1.0


def _ratio(places: int, scale: float) -> float:
    """Return 10^-places over `scale`, of which either may be far from one."""
    exponent = floor(log10(scale))
    return 10.0 ** (-places - exponent) / (scale / 10.0**exponent) if abs(exponent) < 300 else 10.0**-places / scale
