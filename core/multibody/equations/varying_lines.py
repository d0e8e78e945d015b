"""Entries of the lines of W and W + X along a motion whose own coefficients are still being found.

Friction in space turns with the slip s, whose direction is s/|s|. What begins to slide from rest is in
`core.multibody.equations.onsets_of_slip`.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from functools import partial

from core.multibody.algebra.polynomials import ZERO, Ball, LinearForm, is_zero
from core.multibody.laws.series import convolved
from core.multibody.table.table import Row, Table

Series = list[Ball]
"""Coefficients of powers of time, lowest first."""


class _Turning:
    """The direction s/|s| of a slip along a motion whose own coefficients are still being found."""

    def __init__(self, lines: Sequence[LinearForm], rates: Sequence[Series]) -> None:
        self._lines, self._rates = lines, rates
        self._slip: tuple[Series, Series] = ([], [])
        self._size: Series = []
        self.units: tuple[Series, Series] = ([], [])

    def at(self, power: int) -> tuple[Ball, Ball]:
        """Return the coefficients of the two components."""
        while len(self._size) <= power:
            k = len(self._size)
            for slip, line in zip(self._slip, self._lines, strict=True):
                slip.append(sum((poly[()] * self._rates[j][k] for j, poly in line.items()), ZERO))
            square = sum((convolved(s, s) for s in self._slip), ZERO)
            # |s|^2 and s = |s| u, power by power.
            inner = convolved(self._size[1:], self._size[1:])
            self._size.append(square.sqrt() if k == 0 else (square - inner) / (2 * self._size[0]))
            for unit, slip in zip(self.units, self._slip, strict=True):
                unit.append((slip[k] - convolved(unit, self._size[1:])) / self._size[0])
        return self.units[0][power], self.units[1][power]


class Entry:
    """An entry of a line that varies, along a motion whose own coefficients are still being found."""

    def __init__(self, coefficient: Callable[[int], Ball]) -> None:
        self._coefficient = coefficient
        self._known: Series = []

    def varying(self, power: int) -> Series:
        """Return the coefficients from that of time to that of a power of it."""
        while len(self._known) < power:
            self._known.append(self._coefficient(len(self._known) + 1))
        return self._known[:power]


def varying_entries(line: LinearForm, places: Sequence[Series]) -> dict[int, Entry]:
    """Return the entries of a line that vary with the places."""
    found = {}
    for j, poly in line.items():
        slopes = [(key[0], x) for key, x in poly.items() if key]
        if slopes:
            found[j] = Entry(partial(_along, slopes, places))
    return found


def _along(slopes: Sequence[tuple[int, Ball]], places: Sequence[Series], power: int) -> Ball:
    """Return a coefficient of an affine polynomial."""
    return sum((x * places[i][power] for i, x in slopes), ZERO)


def friction_entries(table: Table, row: Row, places: Sequence[Series], rates: Sequence[Series]) -> dict[int, Entry]:
    """Return the entries of the line of friction of a row that vary, as far as its slip is known."""
    if row.slide is None or not slips(table, row):
        return varying_entries(row.drag, places)
    factor, along, across = row.slide
    turning = _Turning((along, across), rates)

    def rubbed(first: Ball, second: Ball, power: int) -> Ball:
        units = turning.at(power)
        return first * units[0] + second * units[1]

    return {
        j: Entry(partial(rubbed, *(factor * line.get(j, {}).get((), ZERO) for line in (along, across))))
        for j in {*along, *across}
    }


def slips(table: Table, row: Row) -> bool:
    """Return whether a row with friction that turns has a slip."""
    return any(not is_zero(x) for x in table.slip_of(row))


def joined(first: Mapping[int, Entry], second: Mapping[int, Entry]) -> dict[int, Entry]:
    """Return the sums of the entries of two lines."""
    found = dict(first)
    for j, more in second.items():
        found[j] = Entry(partial(_sum, found[j], more)) if j in found else more
    return found


def _sum(first: Entry, second: Entry, power: int) -> Ball:
    return first.varying(power)[-1] + second.varying(power)[-1]
