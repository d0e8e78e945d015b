"""What ends a phase: gaps, forces and rates of slip that may not become negative while it lasts."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Literal

from core.multibody.contact_states import PhaseTable, State
from core.multibody.expansion import Expansion, Series
from core.multibody.measures import Force, Unilateral
from core.multibody.polynomials import ONE, ZERO, constant


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
    """

    number: int
    what: Literal["gap", "push", "grip", "slip"]
    one: Unilateral
    sense: int = 1
    force: Force | None = None

    def series(self, motion: Expansion) -> Series:
        """Return it along a motion."""
        if self.what == "gap":
            return motion.of(self.one.gap)
        if self.what == "slip":
            return [self.sense * x for x in motion.of_rates(self.one.slip or {})]
        total: Series = [ZERO] * (motion.order - 1)
        for row, factor in self.force.terms if self.force is not None else ():
            total = [a + factor[()] * b for a, b in zip(total, motion.multipliers[row], strict=True)]
        return total


def watches(unilateral: Sequence[Unilateral], states: Sequence[State], phase: PhaseTable) -> list[Watch]:
    """Return what ends a phase."""
    found = []
    for i, (one, state) in enumerate(zip(unilateral, states, strict=True)):
        row, slip = phase.normal[i], phase.slip[i]
        if row is None:
            found.append(Watch(i, "gap", one))
            continue
        found.append(Watch(i, "push", one, 1, Force("", "N", [(row, constant(ONE))])))
        if slip is not None:
            for sense in (1, -1):
                terms = [(row, constant(one.static)), (slip, constant(sense * ONE))]
                found.append(Watch(i, "grip", one, sense, Force("", "N", terms)))
        if state.sense:
            found.append(Watch(i, "slip", one, state.sense))
    return found
