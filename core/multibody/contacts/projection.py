"""A state put onto the measures and rates of a table, in balls: rows hold as they would in exact numbers."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

from flint import arb

from core.multibody.algebra.polynomials import Ball, entry, evaluated
from core.multibody.algebra.rank import independent
from core.multibody.contacts.contact_responses import rate_along
from core.multibody.equations.assembly import least_change
from core.multibody.table.table import Row, Table

_NEWTON_STEPS_OF_A_STATE = 3
"""Of Newton's method, from a state that is right to a pair of doubles at least."""
HELD = 2.0**-240
"""Share of the largest coordinate to which a state is put onto its rows."""


def project(table: Table, around: Sequence[Ball]) -> None:
    """Put the state of a table onto its rows, by the least change: places first, then rates at the new places.

    Rows are redundant if they are within `around`, the places with the width to which they are known: beside the
    measures, redundant rows differ by what the places miss, and a change that undoes both has no bound.
    """
    held = [row for row in table.rows if row.measure is not None]
    first = dict(table.twins)

    def alike(state: Sequence[Ball]) -> list[Ball]:
        """Return a state in which what is one function of time is so, as the model of a phase takes it to be."""
        return [state[first.get(i, i)] for i in range(len(state))]

    def lines_of(rows: Sequence[Row], places: Sequence[Ball]) -> list[dict[int, Ball]]:
        found: list[dict[int, Ball]] = [{} for _ in rows]
        for own, row in zip(found, rows, strict=True):
            for j, x in row.line(places).items():
                own[first.get(j, j)] = entry(own, first.get(j, j)) + x
        return found

    around = alike(around)
    chosen = independent(lines_of(held, around))
    table.q = alike(table.q)
    for _ in range(_NEWTON_STEPS_OF_A_STATE):
        lines = lines_of([held[i] for i in chosen], table.q)
        residuals = [arb(evaluated(held[i].measure or {}, table.q).mid()) for i in chosen]
        step = least_change(table, lines, residuals)
        table.q = alike([arb((q - d).mid()) for q, d in zip(table.q, step, strict=True)])
    chosen = independent(lines_of(table.rows, around))
    lines = lines_of(table.rows, table.q)
    table.v = alike(table.v)
    for _ in range(_NEWTON_STEPS_OF_A_STATE):
        residuals = [rate_along(lines[i], table.v) - table.rows[i].rate for i in chosen]
        step = least_change(table, [lines[i] for i in chosen], residuals)
        table.v = alike([arb((v - d).mid()) for v, d in zip(table.v, step, strict=True)])
    # What is left over is far below this: rows hold, and squares complete, as they would in exact numbers.
    for vector in (table.q, table.v):
        scale = max((abs(float(x)) for x in vector), default=0.0)
        vector[:] = [arb(x.mid(), HELD * scale) for x in vector]


def projected(
    table: Table, q: Sequence[Ball], v: Sequence[Ball], around: Sequence[Ball]
) -> tuple[list[Ball], list[Ball]]:
    """Return a state put onto the rows of a table: see `project`."""
    put = replace(table, q=list(q), v=list(v))
    project(put, around)
    return put.q, put.v
