"""Contacts that touch at one place of a path and hold nothing there: a pendulum at its lowest place, above a floor.

The line of such a gap follows from the connections, so that forces may be shared with them while nothing moves. But the
gap is larger on all sides, and what moves leaves it at once, however slowly it begins.
"""

from __future__ import annotations

from dataclasses import replace

from core.multibody.algebra.polynomials import variables
from core.multibody.contacts.complementarity import Decided
from core.multibody.contacts.contact_start import ContactStart
from core.multibody.contacts.contact_states import State, phase_table
from core.multibody.phases.phase import model_of
from core.multibody.phases.tracks import Tracks
from core.multibody.reduction.degenerate_rows import is_least
from core.multibody.table.description import Described


def without_passing_touch(base: Described, found: Decided, tracks: Tracks, start: ContactStart) -> Decided:
    """Return the states with those open that the motion leaves."""
    first = tracks.first
    for i, one in enumerate(found.unilateral):
        if found.states[i] is not State.CLOSED:
            continue
        freed = replace(found, states=[State.OPEN if k == i else state for k, state in enumerate(found.states)])
        phase = phase_table(base.measures.table, found.unilateral, freed.states, first.q, first.v)
        if not is_least(phase.table, one.gap):
            continue
        whole = model_of(base, freed, phase, start).whole
        if any(motion.moves for motion in whole.motions_of(sorted(variables([one.gap])))):
            found = freed
    return found
