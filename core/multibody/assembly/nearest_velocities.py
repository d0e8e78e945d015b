"""Velocities that satisfy the connections, nearest to those given: least squares in the metric of the places.

    minimize (D v - d)^T C (D v - d)  subject to  W v = r

where d are the given rates. Rates that are left out stay open; they follow as in every scene.
"""

from __future__ import annotations

from collections.abc import Sequence

from core.multibody.algebra.polynomials import ONE, ZERO, Ball, entry, is_zero
from core.multibody.algebra.rank import Elimination, Line
from core.multibody.assembly.metric import Metric
from core.multibody.table.frames import Given
from core.multibody.table.table import Table


def nearest_rates(table: Table, given: Sequence[Given], metric: Metric) -> list[Ball] | None:
    """Return rates of all coordinates of which those given are the nearest possible; None where they need no change.

    Parameters
    ----------
    table : Table
        At places that satisfy the connections. Where its rows contradict one another, nothing is changed.
    given : sequence of Given
    metric : Metric
    """
    elimination = Elimination()
    for row in table.rows:
        left = elimination.add(row.line(table.q), row.rate)
        if left is not None and not is_zero(left):
            return None
    count = len(table.q)
    start = elimination.solution(range(count))
    modes: dict[int, Line] = {f: {f: ONE} for f in range(count) if f not in elimination.pivots}
    for j, (line, _) in elimination.pivots.items():
        for f, x in line.items():
            modes[f][j] = -x
    missed = [entry_of.value - _along(entry_of.line, dict(enumerate(start))) for entry_of in given]
    shown = [{f: x for f, mode in modes.items() if not is_zero(x := _along(one.line, mode))} for one in given]
    within = Elimination()
    if all(left is None or is_zero(left) for left in map(within.add, shown, missed)):
        return None
    pulls = [[_product(one, other, metric) for other in given] for one in given]
    normal = Elimination()
    for f in modes:
        weighted = [
            sum((line.get(f, ZERO) * pulls[e][g] for e, line in enumerate(shown) if f in line), ZERO)
            for g in range(len(given))
        ]
        total: Line = {}
        for weight, other in zip(weighted, shown, strict=True):
            for h, x in other.items():
                total[h] = total.get(h, ZERO) + weight * x
        value = sum((weight * x for weight, x in zip(weighted, missed, strict=True)), ZERO)
        normal.add({h: x for h, x in total.items() if not is_zero(x)}, value)
    rates = list(start)
    for f, share in zip(modes, normal.solution(modes), strict=True):
        for j, x in modes[f].items():
            rates[j] = rates[j] + share * x
    return rates


def _along(line: Line, rates: Line) -> Ball:
    return sum((x * rates[j] for j, x in line.items() if j in rates), ZERO)


def _product(one: Given, other: Given, metric: Metric) -> Ball:
    """Return the product of two rates in the metric."""
    return sum((x * entry(metric, (i, j)) * y for i, x in one.line.items() for j, y in other.line.items()), ZERO)
