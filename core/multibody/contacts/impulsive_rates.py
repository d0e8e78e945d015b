"""What a state becomes in no time where a connection begins to hold, or a blow falls.

The rates change by M dv = W^T lambda + p, so that W (v + dv) = r: what holds takes whatever impulses lambda it needs, a
blow adds the momenta p. A connection that begins to hold is thus an impact without restitution, the change of rates of
least kinetic energy (Carnot).

References
----------
L. A. Pars, "A Treatise on Analytical Dynamics" (1965), chapter 14.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass

from core.multibody.algebra.polynomials import ZERO, Ball, evaluated, is_zero
from core.multibody.algebra.rank import Elimination, independent
from core.multibody.contacts.contact_responses import rate_along
from core.multibody.equations.dynamics import weightless
from core.multibody.equations.expansion import saddle_solved
from core.multibody.table.connection_effects import Force, Push
from core.multibody.table.table import Table


@dataclass(frozen=True)
class Struck:
    """What blows do to the rates of a table.

    Attributes
    ----------
    v : list of ball
        Rates afterwards.
    impulses : Elimination
        Those of the rows, as far as they are determined.
    """

    table: Table
    v: list[Ball]
    impulses: Elimination

    def impulse(self, force: Force) -> Ball | None:
        """Return the impulse of a force of a connection, None where the rows could share it otherwise."""
        line = {row: x for row, poly in force.terms if not is_zero(x := evaluated(poly, self.table.q))}
        free, value = self.impulses.reduced(line, ZERO)
        return None if free else -value


def struck(table: Table, pushes: Iterable[Push]) -> Struck:
    """Return the rates of a table after some blows, so that they keep its rows.

    Raises
    ------
    InvalidParameter
        If something without mass can move by itself.
    """
    count, lines = len(table.names), [row.line(table.q) for row in table.rows]
    momenta = _momenta(table, pushes)
    chosen = independent(lines)
    right = [[x] for x in momenta]
    right += [[table.rows[r].rate - rate_along(lines[r], table.v)] for r in chosen]
    try:
        change = [line[0] for line in saddle_solved(table, chosen, right)][:count] if right else []
    except ZeroDivisionError:
        raise weightless(table, range(count), lines) from None
    change = [ZERO if is_zero(x) else x for x in change]
    v = [x + dx for x, dx in zip(table.v, change, strict=True)]
    return Struck(table, v, _impulses(table, lines, change, momenta))


def _momenta(table: Table, pushes: Iterable[Push]) -> list[Ball]:
    found = [ZERO] * len(table.names)
    for push in pushes:
        for j, poly in push.momenta.items():
            found[j] = found[j] + evaluated(poly, table.q)
    return found


def _impulses(
    table: Table, lines: Sequence[Mapping[int, Ball]], change: Sequence[Ball], momenta: Sequence[Ball]
) -> Elimination:
    """Return the impulses of rows by W^T lambda = M dv - p."""
    of_coordinates: list[dict[int, Ball]] = [{} for _ in table.names]
    for r, line in enumerate(lines):
        for j, x in line.items():
            of_coordinates[j][r] = x
    found = Elimination()
    for line, gained, pushed in zip(of_coordinates, table.inertial(change), momenta, strict=True):
        found.add(line, gained - pushed)
    return found
