"""What ends a phase: gaps, forces and rates of slip that may not become negative while it lasts."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Literal

from core.multibody.algebra.polynomials import ONE, ZERO, constant
from core.multibody.contacts.contact_states import PhaseTable, State, disc
from core.multibody.equations.expansion import Expansion, Series
from core.multibody.table.connection_effects import Force, Unilateral


@dataclass(frozen=True)
class Watch:
    """Something that stays at or above zero during a phase.

    Attributes
    ----------
    number : int
        Of the unilateral measure.
    what : {"gap", "push", "grip", "slip"}
    force : Force or None
        What has to be positive, for "push" and "grip".
    rubs : tuple of Force
        Two components of friction in space, whose root of squares may not be above the force.
    """

    number: int
    what: Literal["gap", "push", "grip", "slip"]
    one: Unilateral
    sense: int = 1
    force: Force | None = None
    rubs: tuple[Force, ...] = ()

    def series(self, motion: Expansion) -> Series:
        """Return it along a motion."""
        if self.what == "gap":
            return motion.of(self.one.gap)
        if self.what == "slip":
            return [self.sense * x for x in motion.of_rates(self.one.slip or {})]
        total = _along(self.force, motion)
        return disc(total, [_along(rub, motion) for rub in self.rubs]) if self.rubs else total


def _along(force: Force | None, motion: Expansion) -> Series:
    """Return a sum of multipliers along a motion."""
    total: Series = [ZERO] * (motion.order - 1)
    for row, factor in force.terms if force is not None else ():
        total = [a + factor[()] * b for a, b in zip(total, motion.multipliers[row], strict=True)]
    return total


def watches(unilateral: Sequence[Unilateral], states: Sequence[State], phase: PhaseTable) -> list[Watch]:
    """Return what ends a phase."""
    found = []
    for i, (one, state) in enumerate(zip(unilateral, states, strict=True)):
        row, stuck = phase.normal[i], phase.grip(i)
        if row is None:
            found.append(Watch(i, "gap", one))
            continue
        found.append(Watch(i, "push", one, 1, Force("", "N", [(row, constant(ONE))])))
        if len(stuck) == 1:
            for sense in (1, -1):
                terms = [(row, constant(one.static)), (stuck[0], constant(sense * ONE))]
                found.append(Watch(i, "grip", one, sense, Force("", "N", terms)))
        elif stuck:
            most = Force("", "N", [(row, constant(one.static))])
            found.append(Watch(i, "grip", one, 1, most, tuple(Force("", "N", [(r, constant(ONE))]) for r in stuck)))
        if state.sense:
            found.append(Watch(i, "slip", one, state.sense))
    return found
