"""Whether friction goes on not to depend on how a load is shared, once what slides turns its slip.

Four feet of a table that slides without a turn rub along one direction, and how they share the load moves nothing. As
soon as the table turns, each rubs along a direction of its own, and the shares count: nothing in the mechanics of rigid
bodies tells them. Where it turns about its middle alone, opposite feet rub against one another, and the shares do not
count. The motion is expanded with one share and with others; where these differ, the shares count.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence

from core.multibody.algebra.polynomials import Ball, is_zero
from core.multibody.algebra.rank import independent
from core.multibody.contacts.conditions_of_states import LOOKED
from core.multibody.contacts.contact_states import PhaseTable
from core.multibody.equations.expansion import Expansion, expansion
from core.multibody.table.connection_effects import Unilateral
from core.multibody.table.table import Table

Share = Mapping[int, Ball]
"""Normal forces, by contacts, that may be added in any multiple with all that is held as it is."""


def share_that_counts(
    phase: PhaseTable, unilateral: Sequence[Unilateral], shares: Sequence[Share], turning: Sequence[str]
) -> tuple[str, ...]:
    """Return the contacts of a share that moves something just after a state, though not there; none if none does.

    Parameters
    ----------
    phase : PhaseTable
        Of the phase that begins.
    shares : sequence of Share
        That move nothing at the state.
    turning : sequence of str
        The contacts whose slip turns: where none of a share does, its friction stays what it is.
    """
    affected = [share for share in shares if any(unilateral[i].name in turning for i in share)]
    if not affected:
        return ()
    chosen = phase.table.independent_rows()
    motion = expansion(phase.table, LOOKED, chosen)
    if not _holds(phase.table, motion):
        return ()
    for share in affected:
        rows = [row for i in share if (row := phase.normal[i]) is not None]
        for other in _otherwise(phase.table, motion, chosen, rows):
            if _holds(phase.table, other) and not _is_same(motion, other):
                return tuple(unilateral[i].name for i in share)
    return ()


def _otherwise(table: Table, motion: Expansion, chosen: Sequence[int], rows: Sequence[int]) -> Iterator[Expansion]:
    """Yield motions in which one of the rows of a share carries nothing that carries something now."""
    lines = [row.line(table.q) for row in table.rows]
    for left_out in rows:
        if left_out not in chosen or all(is_zero(x) for x in motion.multipliers[left_out]):
            continue
        order = [*(r for r in range(len(lines)) if r != left_out), left_out]
        others = [order[k] for k in independent(lines[r] for r in order)]
        if left_out not in others:
            yield expansion(table, LOOKED, sorted(others))


def _holds(table: Table, motion: Expansion) -> bool:
    """Return whether all rows go on to hold, also those that follow from the others at the state."""
    return all(is_zero(x) for row in table.rows for x in motion.of_rates(row.rates)[1:])


def _is_same(first: Expansion, second: Expansion) -> bool:
    return all(
        is_zero(a - b) for x, y in zip(first.places, second.places, strict=True) for a, b in zip(x, y, strict=True)
    )
