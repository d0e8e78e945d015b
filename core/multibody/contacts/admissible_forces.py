"""What the forces of contacts have to satisfy during a phase: pushes, cones of friction, shares of a load."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from flint import arb

from core.arrays import Floats
from core.multibody.algebra.polynomials import ONE, ZERO, Ball, constant, entry, is_zero
from core.multibody.algebra.rank import Elimination
from core.multibody.contacts.certificates import certificates
from core.multibody.contacts.contact_states import PhaseTable, State, disc
from core.multibody.contacts.shares_in_space import Cone, best_share
from core.multibody.equations.expansion import Expansion, Series, expansion
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
        Rows of the components of friction, whose root of squares may not be above it; one beside others of two.
    """

    number: int
    grips: bool
    terms: dict[int, Ball]
    rubs: tuple[int, ...] = ()

    @property
    def round(self) -> bool:
        """Whether it is a cone in space, which is not linear."""
        return len(self.rubs) > 1

    def flat(self) -> list[AdmissibleForce]:
        """Return it with a single component of friction as two linear conditions, else as it is."""
        if len(self.rubs) != 1:
            return [self]
        (row,) = self.rubs
        return [replace(self, terms={**self.terms, row: sense}, rubs=()) for sense in (ONE, -ONE)]

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


@dataclass(frozen=True)
class SharedCones:
    """A load that is shared by what sticks in space.

    Attributes
    ----------
    conditions : list of AdmissibleForce
        Of every contact, as if its multipliers were known.
    shares : list of dict of int to ball
        Multipliers that give no force, by the numbers of their rows.
    """

    conditions: list[AdmissibleForce]
    shares: list[dict[int, Ball]]

    def certificate(self, multipliers: Floats) -> tuple[float, AdmissibleForce]:
        """Return the margin of the best share of a load, and what holds it back as a sum without the share.

        The sum cannot be negative where some share is admissible; for the multipliers given it is the least of such
        sums.

        Parameters
        ----------
        multipliers : ndarray, shape (rows,)
            Of which redundant rows may have zero.
        """
        rows = sorted({row for one in self.conditions for row in (*one.terms, *one.rubs)})
        where = {row: i for i, row in enumerate(rows)}
        cones = []
        for one in self.conditions:
            ((row, factor),) = one.terms.items()
            cones.append(Cone(where[row], float(factor), tuple(where[r] for r in one.rubs)))
        slopes = np.array([[float(entry(share, row)) for share in self.shares] for row in rows])
        best = best_share(cones, multipliers[rows], slopes)
        parts = []
        for one, weight, direction in zip(self.conditions, best.weights, best.directions, strict=True):
            rubs = {row: arb(float(x)) for row, x in zip(one.rubs, direction, strict=False)}
            parts.append((arb(float(weight)), AdmissibleForce(one.number, one.grips, {**one.terms, **rubs})))
        return best.margin, _summed(parts)


def admissible(
    unilateral: Sequence[Unilateral], group: Sequence[int], states: Sequence[State], phase: PhaseTable
) -> list[AdmissibleForce]:
    """Return what has to stay at least zero of the forces of some measures in a phase.

    Where rows follow from others, their multipliers are not unique. Then the conditions are those under which some
    share of the load is admissible; they are the same whatever the share. Of cones in space there are infinitely many:
    one stands for what holds back the best share at the start. Where the dependence of the rows changes along the
    motion, the multipliers of redundant rows are taken as zero.
    """
    cones = _cones(unilateral, group, phase)
    shares = _shares_of(cones, phase.table)
    if not shares:
        single: list[AdmissibleForce] = []
        for one in cones:
            if one.grips:
                # It follows from the cone, but what lets go is another event than what slips.
                single.append(AdmissibleForce(one.number, False, dict.fromkeys(one.terms, ONE)))
            single.extend(one.flat())
        return single
    if not any(one.round for one in cones):
        return _without_share([flat for one in cones for flat in one.flat()], shares)
    start = np.array([float(x[0].mid()) if x else 0.0 for x in expansion(phase.table, 2).multipliers])
    return [SharedCones(cones, shares).certificate(start)[1]]


def shared_cones(unilateral: Sequence[Unilateral], group: Sequence[int], phase: PhaseTable) -> SharedCones | None:
    """Return the load that measures share which stick in space, None where they share none."""
    cones = _cones(unilateral, group, phase)
    if not any(one.round for one in cones):
        return None
    shares = _shares_of(cones, phase.table)
    return SharedCones(cones, shares) if shares else None


def _cones(unilateral: Sequence[Unilateral], group: Sequence[int], phase: PhaseTable) -> list[AdmissibleForce]:
    """Return of every closed measure its cone where it sticks, else its push."""
    found = []
    for i in group:
        row, stuck = phase.normal[i], phase.grip(i)
        if row is not None:
            found.append(AdmissibleForce(i, bool(stuck), {row: unilateral[i].static if stuck else ONE}, tuple(stuck)))
    return found


def _without_share(conditions: Sequence[AdmissibleForce], shares: Sequence[dict[int, Ball]]) -> list[AdmissibleForce]:
    """Return the least sums of linear conditions in which no share has a part."""
    slopes = [
        {f: sum((x * entry(share, row) for row, x in one.terms.items()), ZERO) for f, share in enumerate(shares)}
        for one in conditions
    ]
    return [_summed([(y, conditions[k]) for k, y in weights.items()]) for weights in certificates(slopes)]


def _summed(parts: Sequence[tuple[Ball, AdmissibleForce]]) -> AdmissibleForce:
    terms: dict[int, Ball] = {}
    for y, one in parts:
        for row, x in one.terms.items():
            terms[row] = terms[row] + y * x if row in terms else y * x
    left = {row: x for row, x in terms.items() if not is_zero(x)}
    return AdmissibleForce(parts[0][1].number, any(one.grips for _, one in parts), left)


def _shares_of(conditions: Sequence[AdmissibleForce], table: Table) -> list[dict[int, Ball]]:
    """Return multipliers that give no force and have a part in conditions, if they are the same along the motion."""
    if len(table.independent_rows()) == len(table.rows):
        return []
    rows = {row for one in conditions for row in (*one.terms, *one.rubs)}
    forceless = _balanced(table, {})
    assert forceless is not None, "no multipliers give no force"
    free = [r for r in range(len(table.rows)) if r not in forceless.pivots]
    shares = [{f: ONE, **{r: -rest[f] for r, (rest, _) in forceless.pivots.items() if f in rest}} for f in free]
    found = [share for share in shares if any(not is_zero(entry(share, row)) for row in rows)]
    motion = expansion(table, 2)
    for power in (1, 2):
        # Along the rates, and along the accelerations: what is free stays as it is, and so have the others to.
        moved = [series[power] for series in motion.places]
        for share in found if not all(is_zero(x) for x in moved) else ():
            change = _balanced(table, _lost(table, share, moved))
            if change is None or any(row in change.pivots and not is_zero(change.pivots[row][1]) for row in rows):
                return []
    return found


def _balanced(table: Table, load: dict[int, Ball]) -> Elimination | None:
    """Return the multipliers that give a load on the coordinates, None where none do."""
    lines: dict[int, dict[int, Ball]] = {j: {} for j in load}
    for r, row in enumerate(table.rows):
        for j, x in row.pushed(table.q).items():
            lines.setdefault(j, {})[r] = x
    elimination = Elimination()
    for j, line in lines.items():
        left = elimination.add(line, entry(load, j))
        if left is not None and not is_zero(left):
            return None
    return elimination


def _lost(table: Table, share: dict[int, Ball], moved: Sequence[Ball]) -> dict[int, Ball]:
    """Return less the load that multipliers give once the coordinates have moved, to first order."""
    found: dict[int, Ball] = {}
    for r, factor in share.items():
        for part in (table.rows[r].rates, table.rows[r].drag):
            for j, poly in part.items():
                for key, x in poly.items():
                    if key:
                        found[j] = entry(found, j) - factor * x * moved[key[0]]
    return found
