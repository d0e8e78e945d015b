"""The motion of a table about one state as a Taylor polynomial in balls: it decides signs and locates events."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass

from flint import arb_mat

from core.multibody.algebra.polynomials import ZERO, Ball, LinearForm, Poly, entry, is_zero
from core.multibody.algebra.rank import independent
from core.multibody.algebra.square_systems import inverse, times_inverse
from core.multibody.equations.dynamics import weightless
from core.multibody.equations.onsets_of_slip import Onset, rests
from core.multibody.equations.varying_lines import friction_entries, joined, varying_entries
from core.multibody.laws.series import LawSeries, convolved
from core.multibody.table.table import Table

Series = list[Ball]
"""Coefficients of powers of time, lowest first."""


@dataclass(frozen=True)
class Expansion:
    """Taylor coefficients at a state.

    Attributes
    ----------
    places : list of Series
        Of every coordinate.
    multipliers : list of Series
        Of every row, those of rows that follow from others zero; two coefficients fewer than the places.
    """

    places: list[Series]
    multipliers: list[Series]

    @property
    def order(self) -> int:
        """Highest power of the places."""
        return len(self.places[0]) - 1 if self.places else 1

    def state(self, time: Ball) -> tuple[list[Ball], list[Ball]]:
        """Return coordinates and rates at a time, of a motion that is a polynomial."""
        return [value(x, time) for x in self.places], [value(slope(x), time) for x in self.places]

    def of(self, poly: Poly) -> Series:
        """Return a polynomial of the coordinates as a series."""
        size = self.order + 1
        total = [ZERO] * size
        for key, x in poly.items():
            if not key:
                total[0] = total[0] + x
            elif len(key) == 1:
                total = _added(total, x, self.places[key[0]])
            else:
                part = product(self.places[key[0]], self.places[key[1]])
                total = _added(total, x, part)
        return total

    def of_rates(self, rates: LinearForm) -> Series:
        """Return a linear form in the rates as a series, one coefficient shorter than the places."""
        total = [ZERO] * self.order
        for j, poly in rates.items():
            rate = [(k + 1) * self.places[j][k + 1] for k in range(self.order)]
            part = product(self.of(poly)[: self.order], rate)
            total = [a + b for a, b in zip(total, part, strict=True)]
        return total


def _added(total: Series, factor: Ball, series: Sequence[Ball]) -> Series:
    """Return a sum with a multiple of a series of the same length."""
    return [a if b == 0 else a + factor * b for a, b in zip(total, series, strict=True)]


def product(first: Sequence[Ball], second: Sequence[Ball]) -> Series:
    """Return the product of two series of one length, cut off there."""
    size = len(first)
    total = [ZERO] * size
    # Motions with constant accelerations have exact zeros beyond the square of time; what may be zero is not left out.
    others = [(b, y) for b, y in enumerate(second) if not y.is_zero()]
    for a, x in enumerate(first):
        if x == 0:
            continue
        for b, y in others:
            if a + b >= size:
                break
            total[a + b] = total[a + b] + x * y
    return total


def value(series: Sequence[Ball], time: Ball) -> Ball:
    """Return a series at a time."""
    total = ZERO
    for x in reversed(series):
        total = total * time + x
    return total


def slope(series: Sequence[Ball]) -> Series:
    """Return the derivative of a series."""
    return [k * series[k] for k in range(1, len(series))]


def saddle(table: Table, chosen: Sequence[int]) -> arb_mat:
    """Return the matrix [M -(W + X)^T; W 0] of chosen rows at the state of a table."""
    return arb_mat(_lines(table, chosen))


def _lines(table: Table, chosen: Sequence[int]) -> list[list[Ball]]:
    size = len(table.names) + len(chosen)
    found = [[ZERO] * size for _ in range(size)]
    for (i, j), x in _entries(table, chosen).items():
        found[i][j] = x
    return found


def _entries(table: Table, chosen: Sequence[int]) -> dict[tuple[int, int], Ball]:
    """Return the entries of the saddle matrix that are not zero."""
    count = len(table.names)
    found: dict[tuple[int, int], Ball] = {}
    for (i, j), x in table.mass.items():
        found[i, j] = found[j, i] = x
    for k, r in enumerate(chosen):
        found.update({(count + k, j): x for j, x in table.rows[r].line(table.q).items()})
        found.update({(j, count + k): -x for j, x in table.rows[r].pushed(table.q).items()})
    return found


def saddle_solved(table: Table, chosen: Sequence[int], right: Sequence[Sequence[Ball]]) -> list[list[Ball]]:
    """Return the solutions of the saddle's equations for the columns of a right side.

    Parts that no entry ties to one another are solved apart, each for the columns that it sees: what a scene of many
    bodies costs grows with their number, and not with its cube.

    Raises
    ------
    ZeroDivisionError
        Where the matrix is singular.
    """
    entries = _entries(table, chosen)
    found = [[ZERO] * len(line) for line in right]
    for part in _parts_apart(len(right), entries):
        seen = [b for b in range(len(right[0])) if not all(right[i][b].is_zero() for i in part)]
        matrix = arb_mat([[entry(entries, (i, j)) for j in part] for i in part])
        solved = matrix.solve(arb_mat([[right[i][b] for b in seen] for i in part]))
        for a, i in enumerate(part):
            for c, b in enumerate(seen):
                found[i][b] = solved[a, c]
    return found


def _parts_apart(size: int, entries: Iterable[tuple[int, int]]) -> list[list[int]]:
    """Return the groups of unknowns that entries tie to one another."""
    group = [[i] for i in range(size)]
    for i, j in entries:
        if group[i] is not group[j]:
            larger, smaller = sorted((group[i], group[j]), key=len, reverse=True)
            larger.extend(smaller)
            for k in smaller:
                group[k] = larger
    return [members for i, members in enumerate(group) if members[0] == i]


def expansion(start: Table, order: int, chosen: Sequence[int] | None = None) -> Expansion:
    """Return the Taylor coefficients of the motion of a table from its state.

    Friction in space turns with the slip s: its line is -mu (s/|s|) times the two lines of the slip, and the series of
    s/|s| is found to one power with that of s. What begins to slide from rest adds an equation for the friction across
    the direction in which it begins.

    Parameters
    ----------
    start : Table
    order : int
        Highest power of the places.
    chosen : sequence of int, optional
        Rows from which the others follow, where that is known better than from a state with its error.

    Raises
    ------
    InvalidParameter
        If something without mass can move by itself.
    """
    table = start.oriented()
    count = len(table.names)
    lines = [row.line(table.q) for row in table.rows]
    chosen = independent(lines) if chosen is None else chosen
    try:
        inverted = inverse(_lines(table, chosen)) if count + len(chosen) else None
    except ZeroDivisionError:
        raise weightless(table, range(count), lines) from None
    plain = inverted
    places: list[Series] = [[q, v] for q, v in zip(table.q, table.v, strict=True)]
    found: list[Series] = [[] for _ in chosen]
    rates: list[Series] = [[v] for v in table.v]
    # Entries of W and of W + X that vary, as series.
    varying = [varying_entries(table.rows[r].rates, places) for r in chosen]
    pushing = [joined(varying[k], friction_entries(table, table.rows[r], places, rates)) for k, r in enumerate(chosen)]
    laws = LawSeries(table.acting)
    onsets = [Onset.of(table.rows[r], found[n]) for n, r in enumerate(chosen) if rests(table, table.rows[r])]
    changes = bool(onsets)
    for k in range(order - 1):
        if k == 1:
            # What nothing presses yet has no direction of friction at the start.
            onsets = [onset for onset in onsets if not is_zero(onset.push[0])]
            changes = bool(onsets)
        if k and changes:
            try:
                inverted = inverse(_with_onsets(table, chosen, onsets, k))
            except ZeroDivisionError:
                # An acceleration of rounding alone: its direction is that of the start.
                onsets, inverted = [], plain
            changes = any(onset.begins == 1 for onset in onsets)
        more = len(onsets) if k else 0
        right = [ZERO] * (count + len(chosen) + more)
        if k == 0:
            for i, x in table.load.items():
                right[i] = right[i] + x
        for (i, j), x in table.stiffness.items():
            right[i] = right[i] - x * places[j][k]
        for (i, j), x in table.damping.items():
            right[i] = right[i] - x * rates[j][k]
        for (i, j, m), x in table.gyration.items():
            right[i] = right[i] + x * convolved(places[j][: k + 1], rates[m])
        laws.add_to(right, places, rates, k)
        for n in range(len(chosen)):
            for j, series in pushing[n].items():
                right[j] = right[j] + convolved(found[n], series.varying(k))
            total = ZERO
            for j, series in varying[n].items():
                total = total + convolved(series.varying(k + 1), rates[j])
            right[count + n] = right[count + n] - (k + 1) * total
        for n, onset in enumerate(onsets[:more]):
            drag = onset.drag(k)
            for j, x in onset.along.items():
                right[j] = right[j] + x * drag
            right[count + len(chosen) + n] = onset.slip_across(k)
        solved = times_inverse(inverted, right) if right else []
        for i in range(count):
            places[i].append(solved[i] / ((k + 1) * (k + 2)))
            rates[i].append(solved[i] / (k + 1))
        for n in range(len(chosen)):
            found[n].append(solved[count + n])
        for n, onset in enumerate(onsets):
            onset.find(k, solved[count + len(chosen) + n] if k else ZERO, solved)
    multipliers = [[ZERO] * (order - 1) for _ in table.rows]
    for n, r in enumerate(chosen):
        multipliers[r] = found[n]
    return Expansion(places, multipliers)


def _with_onsets(table: Table, chosen: Sequence[int], onsets: Sequence[Onset], k: int) -> list[list[Ball]]:
    """Return the saddle with the friction across slips that begin, and what it does to them at order k."""
    before = _lines(table, chosen)
    size, more = len(before), len(onsets)
    found = [[*line, *[ZERO] * more] for line in before] + [[ZERO] * (size + more) for _ in onsets]
    for n, onset in enumerate(onsets):
        for j, x in onset.across.items():
            found[size + n][j], found[j][size + n] = x, -x
        found[size + n][size + n] = -onset.compliance(k)
    return found


def leading_sign(series: Sequence[Ball]) -> int:
    """Return the sign just after the start of a series: that of its first coefficient that is not zero, else 0."""
    for x in series:
        if not is_zero(x):
            return 1 if x > 0 else -1
    return 0
