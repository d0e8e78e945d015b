"""Where it is not known how a motion goes on: bodies come too close, or a formula has no value.

That is the root of what becomes negative, or a division by zero.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from core.arrays import Floats
from core.formulas import Node
from core.multibody.contacts.contact_states import Problem
from core.multibody.language.switches import ends_of_domain
from core.multibody.laws.law import Law
from core.multibody.laws.samples import values_of
from core.multibody.motion.numerical import BEFORE_SINGULAR
from core.multibody.phases.phase import Phase

VANISHED = 2.0**-16
"""Share of its terms, then or at the start of a phase, below which an argument vanishes where a motion ends."""


def what_ends(phase: Phase, late: float) -> Problem | None:
    """Return why it is not known how a motion goes on from where its phase ends, None at a singular place.

    Parameters
    ----------
    late : float
        Time from the start of the phase to that end (s).
    """
    for _, motion in phase.models[0].whole.parts:
        lost = motion.lost_in(2.0 * late)
        if lost:
            return Problem("lost-event", lost, (), decided_by="an answer up to an earlier time")
    return formula_that_ends(phase, late)


def formula_that_ends(phase: Phase, late: float) -> Problem | None:
    """Return the formula that leaves its domain where the motion of a phase ends, None where another thing ends it.

    Parameters
    ----------
    late : float
        Time from the start of the phase to that end (s).
    """
    whole = phase.models[0].whole
    laws = [law for law in phase.tables[0].table.acting if law.inputs]
    if not laws:
        return None
    q, v = whole.in_pairs(np.array([0.0, late * BEFORE_SINGULAR]))
    for law in laws:
        for argument in ends_of_domain(law.root):
            value, size = values_of(replace(law, root=argument, push={}), q, v)
            if abs(value[1]) <= VANISHED * np.max(size):
                return Problem(
                    "formula",
                    f"a formula of {law.name} has no value from here on: it divides by zero, or leaves the domain of a "
                    f"function, where {_state(law, q, v)}",
                    (law.name,),
                    decided_by="a formula that has a value there",
                )
    return None


def _state(law: Law, q: Floats, v: Floats) -> str:
    """Return the names of a formula with their values."""
    values = {
        name: float(values_of(replace(law, root=Node("name", name), push={}), q, v)[0][-1])
        for name in sorted(law.inputs)
    }
    return ", ".join(f"{name} = {value:.6g}" for name, value in values.items())
