"""With which power of time a gap opens that is zero at the start of a phase.

What has just let go has no rate and no acceleration there: a string that becomes slack draws away with the third power
of time. Computations of a motion leave roundings of the lower ones, and sometimes agree on them to more digits than
they know.
"""

from __future__ import annotations

from collections.abc import Sequence
from itertools import takewhile

from core.multibody.algebra.polynomials import Ball, evaluated, is_zero
from core.multibody.contacts.complementarity import Decided
from core.multibody.contacts.conditions_of_states import LOOKED
from core.multibody.contacts.contact_responses import gap_rate
from core.multibody.contacts.contact_states import State, phase_table
from core.multibody.equations.expansion import expansion
from core.multibody.table.table import Table


def openings(
    base: Table, found: Decided, touching: Sequence[int], q: Sequence[Ball], v: Sequence[Ball]
) -> dict[int, int]:
    """Return the powers by the numbers of the measures, zero for what is open.

    What stays at zero as far as it is looked at is left out.

    Parameters
    ----------
    base : Table
        Without what is closed.
    touching : sequence of int
        The measures whose gap is zero.
    q, v : sequence of ball
        The state at the start, as wide as it is not known.
    """
    away = {i: 0 for i, one in enumerate(found.unilateral) if i not in touching and evaluated(one.gap, q) > 0}
    one_sided = [i for i in touching if found.unilateral[i].opposite is None]
    open_ = [i for i in one_sided if found.states[i] is State.OPEN and is_zero(evaluated(found.unilateral[i].gap, q))]
    powers = {**away, **{i: 1 for i in open_}}
    slow = [i for i in open_ if is_zero(gap_rate(found.unilateral[i], q, v))]
    if not slow:
        return powers
    motion = expansion(phase_table(base, found.unilateral, found.states, q, v).table, LOOKED)
    for i in slow:
        gap = motion.of(found.unilateral[i].gap)
        powers[i] = 2 + sum(1 for _ in takewhile(is_zero, gap[2:]))
    return {i: power for i, power in powers.items() if power <= LOOKED}
