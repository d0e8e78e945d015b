"""Where connections lose their rank along the steps of a series: there free places branch, and the motion ends.

A motion may pass such a place smoothly, as cranks do that come into line, and steps are too long to meet it. The lines
of W that may depend on one another are followed on every step. Where P inverts them at a time, W(t) P = I, they keep
their rank as long as |(W(t + s) - W(t)) P| < 1, which rates and bounds of accelerations show; from there on another P
does. The stretches on which that holds become shorter in proportion to the time that is left to a place where the rank
is lost, and never reach beyond it. Every line counts in units of its largest entry: their own units differ.

Many lines can never depend on others, whatever the places. A line that is the only one with some of the coordinates,
among those left, can do so only where all its entries of these vanish: never, if one of these is a constant, or if they
vanish only where the measure itself is not zero, as that of the length of a rod. Where they vanish with the measure, as
those of the length of a spring do, a length is zero, which ends a motion by itself.
"""

from __future__ import annotations

import math
from collections import Counter
from collections.abc import Sequence, Set

import numpy as np

from core.arrays import Floats, Integers
from core.compiled import kernel
from core.errors import AccuracyUnreachable
from core.multibody.algebra.polynomials import ONE, ZERO, Poly, combined, constant, entry, is_zero, substituted
from core.multibody.algebra.rank import Elimination
from core.multibody.equations.packed import Packed
from core.multibody.motion.run import Run
from core.multibody.table.table import Row, Table

_KEPT = 0.9
"""Norm of a change of W below which it keeps its rank: less than one by more than rounding."""
_LIKELY = 0.7
"""Norm up to which a stretch is made shorter, that the next attempt succeeds."""
SHORTEST = 2.0**-40
"""Share of a step below which a stretch ends where the rank is lost: a thousand roundings of its time."""
_SMALLEST = 2.0**-46
"""Pivot, of lines whose largest entry is one, that is rounding: a hundred times that of doubles."""
_MOST = 20_000
"""Stretches of a step: some hundred to every halving of the distance from where the rank is lost."""

KEPT, UNKNOWN = math.inf, math.nan
"""In place of a time: where the rank is kept, and where that is not known."""


def lines_that_may_depend(table: Table, chosen: Sequence[int]) -> Integers:
    """Return which of the chosen rows may depend on one another at some place, by their numbers among those."""
    left = {number: table.rows[r] for number, r in enumerate(chosen)}
    heavy = {i for key in table.mass for i in key}
    while True:
        count = Counter(j for row in left.values() for j in row.rates)
        for number, row in left.items():
            if _never_vanishes(row, [j for j in row.rates if count[j] == 1], len(table.names), heavy):
                del left[number]
                break
        else:
            return np.array(sorted(left), dtype=np.int64)


def _never_vanishes(row: Row, own: Sequence[int], count: int, heavy: Set[int]) -> bool:
    """Return whether the entries of a line at some of `count` coordinates never vanish at once while its measure does.

    That they do where its length, which has no mass, is zero is left aside.
    """
    entries = [row.rates[j] for j in own]
    if any(set(poly) == {()} and not is_zero(poly[()]) for poly in entries):
        return True
    if row.measure is None or not entries:
        return False
    vanishing = Elimination()
    for poly in entries:
        vanishing.add({key[0]: x for key, x in poly.items() if key}, ZERO - entry(poly, ()))
    places: list[Poly] = [{(i,): ONE} for i in range(count)]
    for i, (line, value) in vanishing.pivots.items():
        places[i] = combined((value, constant(ONE)), (-ONE, {(k,): x for k, x in line.items()}))
    rest = substituted(row.measure, places)
    keys = {key for key, x in rest.items() if not is_zero(x)}
    return keys == {()} or (not keys and any((j, j) in row.measure for j in own if j not in heavy))


@kernel()
def _inverse(lines: Floats, inverse: Floats, pivots: Integers) -> bool:
    """Invert some columns of lines of shape (m, n), by elimination with complete pivoting; return whether that is done.

    The lines are used up. The inverse, shape (m, m), belongs to the columns for which pivots of shape (n,) are filled
    with its rows, and with -1 for the others.
    """
    m, n = lines.shape
    for j in range(n):
        pivots[j] = -1
    for r in range(m):
        largest = 0.0
        for j in range(n):
            largest = max(largest, abs(lines[r, j]))
        if not largest > 0.0:
            return False
        for j in range(n):
            lines[r, j] /= largest
        for c in range(m):
            inverse[r, c] = 1.0 / largest if r == c else 0.0
    for k in range(m):
        best, line, column = 0.0, k, -1
        for r in range(k, m):
            for j in range(n):
                if pivots[j] < 0 and abs(lines[r, j]) > best:
                    best, line, column = abs(lines[r, j]), r, j
        if not best > _SMALLEST:
            return False
        for j in range(n):
            lines[k, j], lines[line, j] = lines[line, j], lines[k, j]
        for c in range(m):
            inverse[k, c], inverse[line, c] = inverse[line, c], inverse[k, c]
        pivots[column] = k
        factor = 1.0 / lines[k, column]
        for j in range(n):
            lines[k, j] *= factor
        for c in range(m):
            inverse[k, c] *= factor
        for r in range(m):
            factor = lines[r, column]
            if r == k or factor == 0.0:
                continue
            for j in range(n):
                lines[r, j] -= factor * lines[k, j]
            for c in range(m):
                inverse[r, c] -= factor * inverse[k, c]
    return True


@kernel()
def first_lost(table: Packed, rows: Integers, starts: Floats, series: Floats) -> tuple[int, float]:
    """Return the step in which some rows lose their rank, and the time since its start.

    Where they keep it, the time is infinite; no number where it is not known.

    Parameters
    ----------
    rows : (m,)
        Numbers of the rows that may depend on one another.
    starts : (s + 1, 2)
    series : (s, n, order + 1)
    """
    n, order = series.shape[1], series.shape[2] - 1
    number = np.full(table.rate.shape[0], -1)
    for k in range(len(rows)):
        number[rows[k]] = k
    lines, inverse = np.zeros((len(rows), n)), np.zeros((len(rows), len(rows)))
    pivots, place, speed, moved = np.zeros(n, np.int64), np.zeros(n), np.zeros(n), np.zeros(n)
    entries, change, weights = np.zeros(len(table.lines)), np.zeros(len(rows)), np.zeros(len(rows))
    sizes = np.zeros(len(rows))
    for step in range(len(series)):
        length = (starts[step + 1, 0] - starts[step, 0]) + (starts[step + 1, 1] - starts[step, 1])
        way, whole = math.copysign(1.0, length), abs(length)
        at, stretch, count = 0.0, whole, 0
        while at < whole:
            count += 1
            if count > _MOST:
                return step, UNKNOWN
            for i in range(n):
                place[i], speed[i] = 0.0, 0.0
                for k in range(order, -1, -1):
                    speed[i] = speed[i] * way * at + place[i]
                    place[i] = place[i] * way * at + series[step, i, k]
            lines[:] = 0.0
            for e in range(len(entries)):
                entries[e] = table.lines[e, 0]
            for p in range(len(table.slopes)):
                entries[table.slopes_at[p, 0]] += table.slopes[p, 0] * place[table.slopes_at[p, 1]]
            for e in range(len(entries)):
                r = number[table.lines_at[e, 0]]
                if r >= 0 and table.binds[e] == 1:
                    lines[r, table.lines_at[e, 1]] = entries[e]
            for r in range(len(rows)):
                sizes[r] = np.max(np.abs(lines[r]))
            if not _inverse(lines, inverse, pivots):
                return step, way * at
            for k in range(len(rows)):
                weights[k] = np.sum(np.abs(inverse[k]) * sizes)
            while True:
                until = min(at + stretch, whole)
                for i in range(n):
                    gain = 0.0
                    for k in range(order, 1, -1):
                        gain = gain * until + k * (k - 1) * abs(series[step, i, k])
                    moved[i] = (until - at) * (abs(speed[i]) + 0.5 * (until - at) * gain)
                change[:] = 0.0
                for p in range(len(table.slopes)):
                    e = table.slopes_at[p, 0]
                    r, k = number[table.lines_at[e, 0]], pivots[table.lines_at[e, 1]]
                    if r >= 0 and k >= 0 and table.binds[e] == 1:
                        change[r] += abs(table.slopes[p, 0]) * moved[table.slopes_at[p, 1]] * weights[k]
                norm = np.max(change / sizes)
                if norm < _KEPT:
                    break
                stretch = (until - at) * max(_LIKELY / norm, SHORTEST)
                if not stretch > SHORTEST * whole:
                    return step, way * at
            at, stretch = until, 2.0 * (until - at)
    return len(series), KEPT


def up_to_lost_rank(arrays: Packed, rows: Integers, run: Run) -> Run:
    """Return a run up to the first place where some rows lose their rank, the whole run where they keep it.

    Raises
    ------
    AccuracyUnreachable
        Where it is not known whether they do.
    """
    if not len(rows):
        return run
    values = run.series if run.series.ndim == 3 else run.series[..., 0]
    step, time = first_lost(arrays, rows, run.starts, np.ascontiguousarray(values))
    if time == KEPT:
        return run
    if math.isnan(time):
        raise AccuracyUnreachable(
            None,
            np.inf,
            "whether the connections keep their hold is not known: they come very near to places where they lose it",
            path=("times",),
            remedy="ask for earlier times",
        )
    starts = run.starts[: step + 2].copy()
    starts[-1] = starts[step] + [time, 0.0]
    return Run(starts, run.series[: step + 1], singular=True)
