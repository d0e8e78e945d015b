"""Whether a phase lets four places stand for a level rim: see `core.multibody.table.level_rims`."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

from core.errors import InvalidParameter
from core.multibody.algebra.polynomials import Ball, Poly, evaluated, is_zero
from core.multibody.contacts.conditions_of_states import LOOKED
from core.multibody.contacts.contact_states import Problem
from core.multibody.equations.expansion import expansion
from core.multibody.phases.phase import Phase
from core.multibody.table.description import Described


def rim_that_tips(base: Described, phase: Phase, q: Sequence[Ball], v: Sequence[Ball]) -> str | None:
    """Return the contact of a rim whose lowest point becomes none of its places in a phase, None without one.

    Parameters
    ----------
    q, v : sequence of ball
        The state at the start, as wide as it is not known.

    Raises
    ------
    InvalidParameter
        Where that is the start.
    """
    for rim in base.measures.level_rims:
        if any(_stays_level(x, phase, q, v) for x in rim.leaning):
            continue
        if not phase.start > 0:
            raise InvalidParameter(
                rim.path,
                "start inclined, above the plane too, where the rim of a disc or cylinder does not stay level: no "
                "point of a level rim is the lowest",
                remedy="turn the axes of the body so that it tips about the first or second of them, or describe "
                "places of its rim that touch",
            )
        return rim.name
    return None


def _stays_level(leaning: Poly, phase: Phase, q: Sequence[Ball], v: Sequence[Ball]) -> bool:
    """Return whether a diameter is level and stays so: by the passes, or as far as its series is looked at."""
    if not is_zero(evaluated(leaning, q)):
        return False
    if phase.models[0].whole.keeps(leaning):
        return True
    motion = expansion(replace(phase.tables[0].table, q=list(q), v=list(v)), LOOKED)
    return all(map(is_zero, motion.of(leaning)))


def undecided_spin(base: Described, phase: Phase, v: Sequence[Ball]) -> Problem | None:
    """Return what is undecided about a rim that slides while it spins: how its load is shared along the rim.

    Slips that all stay along one line leave no spin.

    Parameters
    ----------
    v : sequence of ball
        The rates at the start, as wide as they are not known.
    """
    turning = {row.name for row in phase.tables[0].table.rows if row.slide is not None}
    for rim in base.measures.level_rims:
        rubs = [
            one.name
            for one, state in zip(phase.unilateral, phase.states, strict=True)
            if state.sense and one.name.startswith(f"{rim.name}.")
        ]
        spins = not all(is_zero(v[i]) for i in rim.heading)
        if len(rubs) > 1 and (spins or not turning.isdisjoint(rubs)):
            return Problem(
                "undetermined-friction",
                "how the load is shared along a rim that lies on a plane is not determined, and the friction of its "
                "spin depends on it",
                (rim.name,),
                decided_by="places of the rim that touch, or no friction",
            )
    return None
