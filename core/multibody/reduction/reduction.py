"""A table on its way to fewer coordinates, in terms of which those of the first one stay known."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field

from core.multibody.algebra.polynomials import ONE, ZERO, Ball, Poly, combined, constant, entry, substituted
from core.multibody.algebra.rank import Elimination
from core.multibody.table.connection_effects import Limit
from core.multibody.table.table import Table


@dataclass
class Reduced:
    """A smaller table, and the coordinates of the larger one in terms of it.

    Attributes
    ----------
    expressions : list of affine polynomials
        Every coordinate of the original table.
    names : list of str
        Of the coordinates of the original table.
    pinned : list of str
        Coordinates of the original table that nothing ever moves, though the connections would let it.
    steps : list of str
        What each pass did.
    twins : sequence of (int, int)
        Coordinates of the original table that are one function of time.
    branches : list of Limit
        Where the branch that a measure was replaced by meets another one of its places, in the original coordinates.
    """

    table: Table
    expressions: list[Poly]
    names: list[str]
    pinned: list[str] = field(default_factory=list)
    steps: list[str] = field(default_factory=list)
    twins: Sequence[tuple[int, int]] = ()
    branches: list[Limit] = field(default_factory=list)

    def directions(self, changes: Sequence[Ball]) -> list[Ball]:
        """Return rates or higher derivatives of every coordinate of the original table, from those of this one."""
        return [sum((x * changes[key[0]] for key, x in e.items() if key), ZERO) for e in self.expressions]

    def in_original(self, poly: Poly) -> Poly:
        """Return an affine polynomial of the coordinates of this table in terms of those of the original table."""
        shares = Elimination()
        for j in range(len(self.table.names)):
            shares.add({i: e[j,] for i, e in enumerate(self.expressions) if (j,) in e}, entry(poly, (j,)))
        found: Poly = {(i,): value for i, (_, value) in shares.pivots.items()}
        apart = entry(poly, ()) - entry(substituted(found, self.expressions), ())
        return combined((ONE, found), (apart, constant(ONE)))


def substitute(state: Reduced, expressions: list[Poly | None]) -> None:
    """Replace coordinates by expressions in those that have none."""
    fresh = [i for i, expression in enumerate(expressions) if expression is None]
    number = {i: k for k, i in enumerate(fresh)}
    final: list[Poly] = []
    for i, expression in enumerate(expressions):
        if expression is None:
            final.append({(number[i],): ONE})
        else:
            final.append({tuple(number[k] for k in key): value for key, value in expression.items()})
    recast(state, final, fresh)


def recast(state: Reduced, final: list[Poly], fresh: list[int]) -> None:
    """Write the table in new coordinates, of which the present ones are affine functions."""
    state.table = state.table.changed(final, fresh)
    state.table.rows = [row for row in state.table.rows if row.rates or (row.measure is None and row.rate != 0)]
    state.expressions = [substituted(expression, final) for expression in state.expressions]
