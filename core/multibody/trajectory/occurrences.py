"""When a quantity takes a value, and how small and large it becomes: searched along the motion, located to a bit.

A quantity is a column of the answer, or a component of one: ``rod.angle``, ``ball.position.z``, ``s.tension``,
``energy.kinetic``. Between the times at which the motion is looked at, which follow its own steps, a quantity turns at
most once; where a parabola through three values comes near, it is looked at more closely.
"""

from __future__ import annotations

import sys
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from core.arrays import Floats
from core.errors import InvalidParameter, NotApplicable, Path
from core.multibody.answer import Occurrence, SceneExtremes
from core.multibody.motion.whole import Whole
from core.multibody.table.frames import Frame
from core.multibody.trajectory.along import period_within, watched_times
from core.multibody.trajectory.turns import closer_at_ends, dips
from core.near_names import did_you_mean
from core.systems.trajectory import Column

_SECTIONS = 33
_ROUNDS = 14
_MOST_ROUNDS = 100
_CROWDED = np.concatenate([[0.0], 2.0 ** -np.arange(2, 54, 2), -(2.0 ** -np.arange(2, 54, 2))])
_ROUNDED = 2.0**-52
"""Rounding of a difference from a value, as a share of it."""
_FLAT = 2.0**-51
MOST_FOUND = 1000
_BITS_OF_TIME = 60
"""Powers of two that lead from the end of a search down to the last digits of its times."""

Sampler = Callable[[Floats], Column]
"""From times to the column of one quantity, whose values have shape (t,)."""


@dataclass(frozen=True)
class When:
    """A question: when does a quantity take a value, for the n-th time after the start, or every time?"""

    quantity: str
    equals: float
    nth: int | None = None


@dataclass(frozen=True)
class ExtremesOf:
    """A question: how small and how large does a quantity become?"""

    quantity: str


def component(columns: dict[str, Column], quantity: str) -> Column | None:
    """Return the column of a quantity, or a component or the length of one; None if there is none."""
    if quantity in columns:
        return columns[quantity] if columns[quantity].values.ndim == 1 else None
    name, _, part = quantity.rpartition(".")
    column = columns.get(name)
    if column is None or column.values.ndim == 1:
        return None
    if part == "length":
        return Column(np.linalg.norm(column.values, axis=1), column.unit, column.error, column.how)
    order = _components(column)
    if len(part) != 1 or part not in order:
        return None
    return Column(column.values[:, order.index(part)], column.unit, column.error, column.how)


def _components(column: Column) -> str:
    """Return the names of a vector's components, a letter each."""
    return "wxyz" if column.values.shape[1] == 4 else "xyz"[: column.values.shape[1]]


def _quantities(columns: Mapping[str, Column]) -> Iterator[str]:
    """Yield every quantity of which the values can be searched for."""
    for name, column in columns.items():
        if column.values.ndim == 1:
            yield name
        else:
            yield from (f"{name}.{part}" for part in (*_components(column), "length"))


def occurrences(grid: Floats, sampler: Sampler, search: When, most: int = MOST_FOUND) -> list[Occurrence]:
    """Return the times after the start at which a quantity takes a value.

    Parameters
    ----------
    grid : ndarray, shape (k,)
        Times from zero to where the motion ends, between which nothing turns twice.
    sampler : callable
    """
    wanted = most if search.nth is None else search.nth
    grid = closer_at_ends(grid)
    column = sampler(grid)
    _require_in_range(search.quantity, column.error)
    curve = column.values - search.equals
    away = away_from_start(curve, column.error + _ROUNDED * abs(search.equals))
    crossings = brackets(grid[away:], curve[away:], sampler, search.equals, wanted)
    numbered = list(enumerate(crossings, 1))
    if search.nth is not None:
        numbered = numbered[search.nth - 1 : search.nth]
    return [located(sampler, search, low, high, number) for number, (low, high) in numbered]


def away_from_start(curve: Floats, noise: float) -> int:
    """Return the number of the first value that is not zero, as far as is known, of a curve that may begin with zero.

    What leaves its value at the start has it for as long as it moves by less than it is known, and takes it no more.
    """
    away = np.abs(curve) > noise
    return int(np.argmax(away)) if away.any() else max(len(curve) - 1, 0)


def brackets(grid: Floats, curve: Floats, sampler: Sampler, equals: float, wanted: int) -> list[tuple[float, float]]:
    """Return where a curve on a grid, a quantity less a value, is zero after the start: between which times."""
    crossings: list[tuple[float, float]] = []
    touching = _touching(grid, curve)
    for k in range(len(grid) - 1):
        if len(crossings) >= wanted:
            break
        if k > 0 and curve[k] == 0.0:
            crossings.append((grid[k], grid[k]))
        elif curve[k] * curve[k + 1] < 0.0:
            crossings.append((grid[k], grid[k + 1]))
        elif touching[k] and k + 2 < len(grid):
            crossings.extend(_pair(sampler, equals, grid[k], grid[k + 2], curve[k]))
    if len(grid) > 1 and curve[-1] == 0.0 and len(crossings) < wanted:
        crossings.append((grid[-1], grid[-1]))
    return crossings


def coordinates_of(quantity: str, frames: Mapping[str, Frame]) -> Sequence[int] | None:
    """Return the coordinates that a quantity follows, None where it may be any: those of a centre of mass are few."""
    body, _, column = quantity.partition(".")
    moves = body in frames and column.split(".", 1)[0] in ("position", "velocity")
    return list(frames[body].position) if moves else None


def extremes(whole: Whole, sampler: Sampler, quantity: str, end: float) -> SceneExtremes:
    """Return the least and the largest value between the start and `end`, or of a period that is shorter."""
    period = period_within(whole, end)
    end = end if period is None else float(period)
    grid = watched_times(whole, end, of=coordinates_of(quantity, whole.measures.coordinates.frames))
    return extremes_on(closer_at_ends(grid), sampler, quantity, periodic=period is not None)


def extremes_on(grid: Floats, sampler: Sampler, quantity: str, *, periodic: bool = False) -> SceneExtremes:
    """Return the least and the largest value on a grid of times from zero, between which nothing turns twice."""
    column = sampler(grid)
    ends = len(grid) - 1
    found: list[tuple[float, float]] = []
    windows: list[tuple[float, float]] = []
    signs: list[float] = []
    for sign in (-1.0, 1.0):
        curve = sign * column.values
        k = int(np.argmax(curve))
        found.append((float(curve[k]), float(grid[k])))
        # To the top it is less than four times as far as a parabola says.
        above = curve - 4.0 * (dips(grid, -curve) + curve) > curve[k] + _FLAT * abs(curve[k])
        near = np.union1d(np.flatnonzero(above), [k])
        windows.extend(zip(grid[np.maximum(near - 1, 0)], grid[np.minimum(near + 1, ends)], strict=True))
        signs.extend([sign] * len(near))
    window, which = np.array(windows), np.array(signs)
    for _ in range(_ROUNDS):
        fine = np.linspace(window[:, 0], window[:, 1], _SECTIONS, axis=1)
        values = which[:, None] * sampler(fine.ravel()).values.reshape(fine.shape)
        i = np.argmax(values, axis=1)[:, None]
        sides = np.hstack([np.maximum(i - 1, 0), np.minimum(i + 1, _SECTIONS - 1)])
        top, least = (np.take_along_axis(values, k, axis=1).min(axis=1) for k in (i, sides))
        go = np.zeros(len(which), dtype=bool)
        for number, sign in enumerate((-1.0, 1.0)):
            own = np.flatnonzero(which == sign)
            k = own[np.argmax(top[own])]
            if top[k] >= found[number][0]:
                found[number] = float(top[k]), float(fine[k, i[k, 0]])
            go[own] = 2.0 * top[own] - least[own] >= found[number][0]
            go[k] = True
        # Where all are flat to rounding, looking closer tells nothing more.
        if np.all(np.ptp(values, axis=1) <= _FLAT * np.abs(values).max(axis=1)):
            break
        window, which = np.take_along_axis(fine, sides, axis=1)[go], which[go]
    (least, low), (largest, high) = found
    least = -least
    error = sampler(np.array([low, high])).error
    _require_in_range(quantity, least, largest, error)
    until = float(grid[-1])
    errors = {
        "least_time": _error_of_time(sampler, low, least, error, until),
        "largest_time": _error_of_time(sampler, high, largest, error, until),
    }
    return SceneExtremes(quantity, column.unit, least, low, largest, high, error, until, periodic, errors)


def _error_of_time(sampler: Sampler, time: float, value: float, error: float, until: float) -> float:
    """Return how far from a time the values between zero and `until` are told from an extreme that was found there.

    Distances grow by a factor of two. The extreme of a curve that turns once between two samples is nearer than the
    first at which both sides differ by more than their errors.
    """
    steps = until * 2.0 ** -np.arange(_BITS_OF_TIME, -1.0, -1.0)
    sides = np.stack([time - steps, time + steps])
    outside = (sides < 0.0) | (sides > until)
    values = sampler(np.clip(sides, 0.0, until).ravel())
    apart = np.abs(values.values.reshape(sides.shape) - value) > 2.0 * (error + values.error)
    told = np.all(apart | outside, axis=0)
    k = int(np.argmax(told)) if np.any(told) else len(steps) - 1
    return float(steps[k]) + 2.0**-52 * abs(time)


def _touching(grid: Floats, curve: Floats) -> np.ndarray:
    """Return whether the curve may cross zero twice between a value and the next but one, as a parabola says."""
    found = np.zeros(len(curve), dtype=bool)
    for own in (curve, -curve):
        near = (dips(grid, own)[1:-1] < 0.25 * own[:-2]) & (own[1:-1] > 0.0)
        found[: len(near)] |= near
    return found


def _pair(sampler: Sampler, equals: float, low: float, high: float, before: float) -> list[tuple[float, float]]:
    """Return brackets of two crossings beside a turning point; none where the curve turns before it gets there."""
    sign = 1.0 if before > 0.0 else -1.0
    first, last = low, high
    for _ in range(_ROUNDS):
        fine = np.linspace(low, high, _SECTIONS)
        values = sign * (sampler(fine).values - equals)
        i = int(np.argmin(values))
        if values[i] < 0.0:
            return [(first, float(fine[i])), (float(fine[i]), last)]
        low, high = fine[max(i - 1, 0)], fine[min(i + 1, _SECTIONS - 1)]
    return []


def located(sampler: Sampler, search: When, low: float, high: float, number: int) -> Occurrence:
    """Return where the sign changes between two times, to the last bit, with the error of the time."""
    first = sampler(np.array([low])).values[0] - search.equals
    fine = np.linspace(low, high, _SECTIONS)
    for _ in range(_MOST_ROUNDS):
        if not low < np.nextafter(low, high) < high:
            break
        values = sampler(fine).values - search.equals
        beyond = values * first <= 0.0
        k = int(np.argmax(beyond)) if np.any(beyond) else len(fine) - 1
        if k == 0:
            break
        low, high = fine[k - 1], fine[k]
        # The chord's zero is close where the curve is smooth: the next times crowd around it. Where all of them are
        # rounded to the ends, the middle goes on.
        near = low + (high - low) * values[k - 1] / (values[k - 1] - values[k])
        around = near + (high - low) * _CROWDED
        inner = np.append(around[(around > low) & (around < high)], 0.5 * (low + high))
        fine = np.unique(np.concatenate([[low, high], inner]))
    reach = (high - low) + 1e-6 * max(abs(high), np.finfo(float).tiny)
    around = sampler(np.array([low - reach, high, high + reach]))
    slope = abs(around.values[2] - around.values[0]) / (2 * reach + (high - low))
    off = sampler(np.array([high])).error
    # Where the quantity turns back its slope is nothing, and its curvature holds it.
    wide = 1e-4 * max(abs(high), np.finfo(float).tiny)
    left, middle, right = sampler(np.array([high - wide, high, high + wide])).values
    bend = abs(left - 2 * middle + right) / wide**2
    known = [2.0 * (2.0 * off / bend) ** 0.5] if bend > 0.0 else []
    error = min([off / slope, *known] if slope > 0.0 else [abs(high), *known])
    error += (high - low) + 2.0**-52 * abs(high)
    _require_in_range(search.quantity, high, error)
    return Occurrence(search.quantity, search.equals, around.unit, number, float(high), float(error), around.how)


def _require_in_range(quantity: str, *numbers: float) -> None:
    if not np.isfinite(numbers).all():
        remedy = "ask for a shorter time, or choose units in which the numbers are moderate"
        raise NotApplicable(
            f"what is found of {quantity} leaves the range of doubles", path=("outputs",), remedy=remedy
        )


def check_search(search: When | ExtremesOf, index: int) -> None:
    """Raise `InvalidParameter` unless a question can be answered as it stands."""
    where: Path = ("outputs", index, "when") if isinstance(search, When) else ("outputs", index)
    key = "quantity" if isinstance(search, When) else "extremes"
    if not isinstance(search.quantity, str) or not search.quantity:
        raise InvalidParameter((*where, key), "name a column of the trajectory, or a component of one")
    if isinstance(search, ExtremesOf):
        return
    number = isinstance(search.equals, (int, float)) and not isinstance(search.equals, bool)
    # A whole number may be too large for a double.
    if not number or not abs(search.equals) <= sys.float_info.max:
        raise InvalidParameter((*where, "equals"), "be a finite number")
    nth = search.nth
    if nth is not None and (isinstance(nth, bool) or not isinstance(nth, int) or not 1 <= nth <= MOST_FOUND):
        raise InvalidParameter((*where, "nth"), f"be a whole number from 1 to {MOST_FOUND}")


def unknown(search: When | ExtremesOf, index: int, columns: Mapping[str, Column]) -> InvalidParameter:
    """Return the fault of a quantity that the scene has not."""
    near = did_you_mean(search.quantity, _quantities(columns))
    components = 'take a component of a vector by ".x", its length by ".length"'
    return InvalidParameter(
        ("outputs", index, "when", "quantity") if isinstance(search, When) else ("outputs", index, "extremes"),
        f'name a quantity of the scene, unlike "{search.quantity[:80]}"; there are {", ".join([*columns][:40])}',
        remedy=f"{near} {components}" if near else components,
    )
