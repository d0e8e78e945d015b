"""Contacts that touch at one place of a path and hold nothing there: a pendulum at its lowest place, above a floor.

The line of such a gap follows from the connections, so that forces may be shared with them while nothing moves. But the
gap is larger on all sides, and what moves leaves it at once, however slowly it begins.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

from core.multibody.algebra.polynomials import Ball, substituted, variables
from core.multibody.contacts.complementarity import Decided
from core.multibody.contacts.contact_states import State, phase_table
from core.multibody.reduction.degenerate_rows import is_least
from core.multibody.reduction.passes import reduced
from core.multibody.table.table import Table


def without_passing_touch(base: Table, found: Decided, q: Sequence[Ball], v: Sequence[Ball]) -> Decided:
    """Return the states with those open that the motion leaves.

    Parameters
    ----------
    base : Table
        Without what is closed.
    q, v : sequence of ball
        The state.
    """
    for i, one in enumerate(found.unilateral):
        if found.states[i] is not State.CLOSED:
            continue
        states = [State.OPEN if k == i else state for k, state in enumerate(found.states)]
        table = phase_table(base, found.unilateral, states, q, v).table
        if is_least(table, one.gap) and variables([substituted(one.gap, reduced(table, pinning=True).expressions)]):
            found = replace(found, states=states)
    return found
