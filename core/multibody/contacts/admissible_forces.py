"""What the forces of contacts have to satisfy during a phase: pushes, cones of friction, shares of a load."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from core.multibody.algebra.polynomials import ONE, ZERO, Ball, constant, entry, is_zero
from core.multibody.algebra.rank import Elimination, independent
from core.multibody.contacts.certificates import certificates
from core.multibody.contacts.contact_states import PhaseTable, State, disc
from core.multibody.equations.expansion import Expansion, Series
from core.multibody.table.connection_effects import Force, Unilateral
from core.multibody.table.table import Table


@dataclass(frozen=True)
class AdmissibleForce:
    """A sum of multipliers that has to be at least zero.

    Attributes
    ----------
    number : int
        Of the unilateral measure, of several the first.
    grips : bool
        Whether friction has a part in it.
    terms : dict of int to ball
        Factors of multipliers, by the numbers of their rows.
    rubs : tuple of int
        Rows of two components of friction in space, whose root of squares may not be above it.
    """

    number: int
    grips: bool
    terms: dict[int, Ball]
    rubs: tuple[int, ...] = ()

    @property
    def force(self) -> Force:
        """The sum as a force."""
        return Force("", "N", [(row, constant(x)) for row, x in self.terms.items()])

    def series(self, motion: Expansion) -> Series:
        """Return it along a motion."""
        total: Series = [ZERO] * (motion.order - 1)
        for row, factor in self.terms.items():
            total = [a + factor * b for a, b in zip(total, motion.multipliers[row], strict=True)]
        return disc(total, [motion.multipliers[row] for row in self.rubs]) if self.rubs else total


def admissible(
    unilateral: Sequence[Unilateral], group: Sequence[int], states: Sequence[State], phase: PhaseTable
) -> list[AdmissibleForce]:
    """Return what has to stay at least zero of the forces of some measures in a phase.

    Where rows follow from others, their multipliers are not unique. Then the conditions are those under which some
    share of the load is admissible; they are the same whatever the share. What sticks in space is taken with the
    multipliers of redundant rows zero, as are rows of which the dependence changes along the motion.
    """
    single: list[AdmissibleForce] = []
    for i in group:
        row, stuck, one = phase.normal[i], phase.grip(i), unilateral[i]
        if row is None:
            continue
        single.append(AdmissibleForce(i, False, {row: ONE}))
        if len(stuck) == 1:
            single.extend(AdmissibleForce(i, True, {row: one.static, stuck[0]: sense}) for sense in (ONE, -ONE))
        elif stuck:
            single.append(AdmissibleForce(i, True, {row: one.static}, tuple(stuck)))
    if any(one.rubs for one in single):
        return single
    shares = _shares(phase.table)
    if not shares:
        return single
    # That what sticks pushes follows from its cone.
    stuck_pushes = {one.number for one in single if one.grips}
    needed = [one for one in single if one.grips or one.number not in stuck_pushes]
    slopes = [
        {f: sum((x * entry(share, row) for row, x in one.terms.items()), ZERO) for f, share in enumerate(shares)}
        for one in needed
    ]
    return [_summed([(y, needed[k]) for k, y in weights.items()]) for weights in certificates(slopes)]


def _summed(parts: Sequence[tuple[Ball, AdmissibleForce]]) -> AdmissibleForce:
    terms: dict[int, Ball] = {}
    for y, one in parts:
        for row, x in one.terms.items():
            terms[row] = terms[row] + y * x if row in terms else y * x
    left = {row: x for row, x in terms.items() if not is_zero(x)}
    return AdmissibleForce(parts[0][1].number, any(one.grips for _, one in parts), left)


def _shares(table: Table) -> list[dict[int, Ball]]:
    """Return multipliers that give no force: of rows that follow from others, by their numbers."""
    if len(independent(row.line(table.q) for row in table.rows)) == len(table.rows):
        return []
    lines: dict[int, dict[int, Ball]] = {}
    for r, row in enumerate(table.rows):
        for j, x in row.pushed(table.q).items():
            lines.setdefault(j, {})[r] = x
    elimination = Elimination()
    for line in lines.values():
        elimination.add(line, ZERO)
    free = [r for r in range(len(table.rows)) if r not in elimination.pivots]
    return [{f: ONE, **{r: -rest[f] for r, (rest, _) in elimination.pivots.items() if f in rest}} for f in free]
