"""The end of a phase with constant accelerations: what is watched is a quadratic in time, its roots found in balls."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from core.multibody.algebra.polynomials import ZERO, Ball, is_zero
from core.multibody.contacts.contact_states import PhaseTable
from core.multibody.equations.expansion import Expansion, expansion, slope, value
from core.multibody.equations.polynomial_roots import first_negative
from core.multibody.motion.modelling import Modelled
from core.multibody.phases.watches import Watch
from core.multibody.table.table import Table

_ORDER = 6
"""Of the series that shows whether forces change: they are rational in time, and change from the first power on."""


@dataclass(frozen=True)
class Crossing:
    """The end of a phase.

    Attributes
    ----------
    time : ball
        Since the start of the phase.
    watch : Watch
        What changed its sign.
    q, v : list of ball
        State there.
    """

    time: Ball
    watch: Watch
    q: list[Ball]
    v: list[Ball]


def is_uniform(model: Modelled) -> bool:
    """Return whether nothing but constant accelerations is in a model."""
    return all(motion.uniform for _, motion in model.whole.parts)


def has_constant_forces(phase: PhaseTable) -> bool:
    """Return whether no force of a contact changes, as far as the start of its series shows.

    With constant accelerations forces may change all the same: where their arms do.
    """
    if all(row is None for row in phase.normal):
        return True
    multipliers = expansion(phase.table, _ORDER).multipliers
    return all(is_zero(x) for series in multipliers for x in series[1:])


def uniform_motion(table: Table, model: Modelled) -> Expansion:
    """Return a motion with constant accelerations and forces as an exact expansion."""
    places = [[q, v, a / 2, ZERO, ZERO] for q, v, a in zip(table.q, table.v, model.whole.acceleration, strict=True)]
    # What is free has no multipliers to be found.
    multipliers = expansion(table, 2).multipliers if table.rows else []
    return Expansion(places, [[x[0], ZERO, ZERO] for x in multipliers])


def state_of(motion: Expansion, time: Ball) -> tuple[list[Ball], list[Ball]]:
    """Return coordinates and rates of an expansion at a time."""
    return [value(x, time) for x in motion.places], [value(slope(x), time) for x in motion.places]


def first_in_closed_form(
    motion: Expansion, watched: Sequence[Watch], end: Ball
) -> tuple[Crossing | None, list[tuple[Watch, Ball]]]:
    """Return the first crossing before `end` of a motion with constant accelerations, and what only grazes zero."""
    best: Ball = None
    which: Watch | None = None
    grazes: list[tuple[Watch, Ball]] = []
    for watch in watched:
        if watch.what in ("push", "grip"):
            continue
        series = watch.series(motion)
        root, touched = first_negative(series, end)
        grazes.extend((watch, t) for t in touched)
        if root is not None and (best is None or root.mid() < best.mid()):
            best, which = root, watch
    if best is None or which is None:
        return None, grazes
    q, v = state_of(motion, best)
    return Crossing(best, which, q, v), [(w, t) for w, t in grazes if t < best]
