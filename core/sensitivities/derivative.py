"""Derivative of a figure by one number, from its values beside that number, with an error.

Central differences over steps that are halved each time are extrapolated to a step of zero. Two things limit the
result: what extrapolation leaves, for which the difference between neighbours in the scheme stands, and the errors of
the figure divided by the step. Of all entries of the scheme the one is taken in which both together are least.

A figure that has a corner or jumps at the number has no derivative. Its slopes to either side then do not approach one
another as the steps become small.

References
----------
C. J. F. Ridders, "Accurate computation of F'(x) and F'(x) F''(x)", Advances in Engineering Software 4 (1982) 75.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from core.arrays import Floats, largest_magnitude
from core.errors import MechanicsError, NotApplicable

FIRST_STEP = 2.0**-6
"""Of the scale: smaller than what usually changes the regime, and far above rounding."""
MOST_HALVINGS = 30
"""Beyond, the step is so small that a figure has less than six digits in its differences."""
WIDEST = 8
"""Columns of the scheme: each multiplies the share of errors little, and removes one power of the step squared."""
ENOUGH = 1e-10
"""Error, relative to the largest entry, with which the steps end."""
CORNER = 0.75
"""Ratio of the differences of the slopes to either side at a step and its double, above which they do not vanish: 1/2
for a smooth figure, 1 at a corner, 2 at a jump."""
IN_A_ROW, MOST_IN_A_ROW = 3, 12
"""More ratios than the first have to say it where the steps end, and with more than the second they end: what is
steep may look like a jump to a step that is too long for it."""
OUT_OF_RANGE = "its derivative leaves the range of doubles, or the number cannot be changed within it"
ROUNDING = 2.0**-52


@dataclass(frozen=True)
class Derivative:
    """A derivative and an estimate of its error, of the figure's shape each."""

    value: Floats
    error: Floats


@dataclass(frozen=True)
class Known:
    """The value of a figure, and a bound of the error of its entries."""

    value: Floats
    error: float

    @property
    def bound(self) -> Floats:
        """The same with what rounding to doubles adds."""
        return self.error + 0.5 * ROUNDING * np.abs(self.value)


def derivative(evaluate: Callable[[float], Known], at: float, scale: float, *, tolerance: float = ENOUGH) -> Derivative:
    """Return the derivative of a figure by a number.

    Parameters
    ----------
    evaluate : callable
        From another number to the figure; raises `MechanicsError` where there is none, or none of this kind.
    at : float
        The number.
    scale : float
        A change of the number that may matter: usually its magnitude.
    tolerance : float
        Relative error at which no smaller step is tried.

    Raises
    ------
    MechanicsError
        What `evaluate` raises at the number itself.
    NotApplicable
        Where the derivative does not exist, or cannot be told from errors.
    """
    with np.errstate(over="ignore", invalid="ignore"):
        return _extrapolated_to_zero(evaluate, at, scale, tolerance)


def _extrapolated_to_zero(evaluate: Callable[[float], Known], at: float, scale: float, tolerance: float) -> Derivative:
    middle = evaluate(at)
    rows: list[tuple[Floats, Floats]] = []
    """Of the scheme: entries and what the errors of the figure do to them, each of shape (columns, ...)."""
    best = Derivative(np.zeros_like(middle.value), np.full_like(middle.value, np.inf))
    bends = Bends(middle)
    reason: MechanicsError | None = None
    size = 0.0
    for k in range(MOST_HALVINGS):
        step = scale * FIRST_STEP * 2.0**-k
        above, below = at + step, at - step
        if not below < at < above or not np.isfinite([above, below]).all():
            break
        try:
            more, less = evaluate(above), evaluate(below)
        except MechanicsError as fault:
            reason, rows, bends = fault, [], Bends(middle)
            continue
        width = above - below
        slope = (more.value - less.value) / width
        noise = (more.bound + less.bound) / width + np.abs(slope) * ROUNDING * abs(at) / width
        rows.append(_next_row(rows[-1] if rows else None, slope, noise))
        best = _better(best, rows)
        bends.add(more, less, step, best)
        if bends.in_a_row > MOST_IN_A_ROW:
            break
        # A derivative that is 0 is told from what would be one.
        size = max(size, largest_magnitude(best.value), largest_magnitude(more.value - middle.value) / scale)
        done = np.all(best.error <= tolerance * size) or np.all(rows[-1][1][0] > best.error)
        if len(rows) > 1 and done and not bends.in_a_row:
            break
    if bends.in_a_row > IN_A_ROW:
        raise NotApplicable("it has a corner or jumps at this value: its slopes to either side differ")
    if not np.all(np.isfinite(best.error)):
        raise NotApplicable(reason.detail if reason else OUT_OF_RANGE)
    return best


class Bends:
    """By how much the slopes to either side of a number differ, as the step becomes small.

    Parameters
    ----------
    middle : Known
        The figure at the number.
    """

    def __init__(self, middle: Known) -> None:
        self._middle, self._wider = middle, np.full_like(middle.value, np.inf)
        self._stays = np.zeros(middle.value.shape, dtype=np.int64)

    def add(self, more: Known, less: Known, step: float, best: Derivative) -> None:
        """Take the figure at one step to either side."""
        closer = np.abs((more.value - self._middle.value) - (self._middle.value - less.value)) / step
        noise = (more.bound + less.bound + 2.0 * self._middle.bound) / step
        seen = (closer > 4.0 * noise) & (closer > best.error)
        self._stays = np.where(seen & (closer > CORNER * self._wider), self._stays + 1, 0)
        self._wider = closer

    @property
    def in_a_row(self) -> int:
        """After how many of the last steps the difference had not become smaller, of any entry."""
        return int(np.max(self._stays, initial=0))


def _next_row(before: tuple[Floats, Floats] | None, slope: Floats, noise: Floats) -> tuple[Floats, Floats]:
    """Return the next row of the scheme, given the one before."""
    entries, errors = [slope], [noise]
    for j in range(0 if before is None else min(len(before[0]), WIDEST)):
        assert before is not None
        power = 4.0 ** (j + 1)
        entries.append((power * entries[j] - before[0][j]) / (power - 1.0))
        errors.append((power * errors[j] + before[1][j]) / (power - 1.0))
    return np.stack(entries), np.stack(errors)


def _better(best: Derivative, rows: list[tuple[Floats, Floats]]) -> Derivative:
    """Return the best entries with those of the last row of the scheme."""
    if len(rows) < 2:
        return best
    (before, _), (entries, errors) = rows[-2:]
    value, error = best.value, best.error
    for j in range(1, len(entries)):
        left = np.maximum(np.abs(entries[j] - entries[j - 1]), np.abs(entries[j] - before[j - 1]))
        known = left + errors[j]
        value, error = np.where(known < error, entries[j], value), np.minimum(known, error)
    return Derivative(value, error)
