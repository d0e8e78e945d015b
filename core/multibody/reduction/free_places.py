"""Places next to the start that meet a set of measures, and the affine subspace in which they lie.

Places are found by Newton's method from steps along the connections, in balls; what they span is found by elimination.
"""

from __future__ import annotations

from collections.abc import Sequence

from flint import arb

from core.errors import NotApplicable
from core.multibody.algebra.polynomials import ONE, ZERO, Ball, Poly, evaluated, is_zero, variables
from core.multibody.algebra.rank import Elimination, Line
from core.multibody.equations.assembly import least_change
from core.multibody.table.table import Row, Table

_STRIDE = 0.125
"""How far from the start places are taken, as a share of the coordinates: the n-th derivatives of the free places are
then visible as 8^-n, beside 2^-280 to which the places are known."""

_NEWTON_STEPS_OF_A_PLACE = 12
"""From a share of an eighth to 2^-280 quadratic convergence takes nine."""


def tangent_directions(table: Table, measures: Sequence[Poly]) -> list[Line]:
    """Return a basis of the directions of the coordinates in measures that their lines of W leave free."""
    tangent = Elimination()
    for measure in measures:
        tangent.add(Row.held("", measure).line(table.q), ZERO)
    free = [j for j in sorted(variables(measures)) if j not in tangent.pivots]
    return [{f: ONE, **{j: -line[f] for j, (line, _) in tangent.pivots.items() if f in line}} for f in free]


class FreePlaces:
    """Places on independent measures, which meet more measures.

    Parameters
    ----------
    table : Table
    bounds : sequence of polynomials
        Measures that are independent at the start.
    measures : sequence of polynomials
        What the places have to meet.

    Attributes
    ----------
    inside : list of int
        The coordinates in the measures.
    hull : Elimination
        The ways from the start to the places so far.
    last : list of balls
        The last place.
    """

    def __init__(self, table: Table, bounds: Sequence[Poly], measures: Sequence[Poly]) -> None:
        self._table, self._measures = table, measures
        self._bounds = [Row.held("", bound) for bound in bounds]
        self.inside = sorted(variables(measures))
        self.hull, self.last = Elimination(), list(table.q)
        self._directions = tangent_directions(table, bounds)
        sizes = {unit: [float(abs(table.q[j])) for j in self.inside if table.units[j] == unit] for unit in table.units}
        self._scale = {unit: max(size, default=0.0) or 1.0 for unit, size in sizes.items()}

    def span(self) -> bool:
        """Find places until they add nothing to what they span; return whether all of them were found."""
        if not self._directions:
            return True
        idle = 0
        # A place adds a direction, but for a set of measure zero; two in a row that add none end it.
        for number in range(2 * len(self.inside) + 2):
            place = self._place(self._step(number))
            if place is None:
                return False
            self.last = place
            way = {j: x for j in self.inside if not is_zero(x := place[j] - self._table.q[j])}
            idle = 0 if self.hull.add(way, ZERO) is None else idle + 1
            if idle == 2 or len(self.hull.pivots) == len(self.inside):
                return True
        return False

    def complement(self) -> list[Line]:
        """Return linear forms that vanish on what the ways span."""
        found = []
        for j in self.inside:
            if j not in self.hull.pivots:
                form: Line = {j: ONE}
                for i, (line, _) in self.hull.pivots.items():
                    if j in line:
                        form[i] = ZERO - line[j]
                found.append(form)
        return found

    def _step(self, number: int) -> Line:
        """Return one of a sequence of steps along the measures."""
        step: Line = {}
        for k, direction in enumerate(self._directions):
            # Multiples of the golden ratio are spread evenly (Weyl) and depend on one another for no short sequence.
            share = ((number + 1) * (k + 1) * 0.6180339887498949) % 1.0 - 0.5
            first = next(iter(direction))
            length = ONE * (_STRIDE * share * self._scale[self._table.units[first]])
            for j, x in direction.items():
                step[j] = step.get(j, ZERO) + length * x
        return step

    def _place(self, step: Line) -> list[Ball] | None:
        """Return the place next to one that is a step away from the start, None where it does not meet all measures."""
        q = [x + step[j] if j in step else x for j, x in enumerate(self._table.q)]
        for _ in range(_NEWTON_STEPS_OF_A_PLACE):
            q = [x.mid() for x in q]
            try:
                lines = [bound.line(q) for bound in self._bounds]
                change = least_change(self._table, lines, [evaluated(bound.measure or {}, q) for bound in self._bounds])
            except NotApplicable:
                return None
            q = [x - d for x, d in zip(q, change, strict=True)]
            largest, size = (max((float(abs(x)) for x in values), default=0.0) for values in (change, q))
            if largest <= 2.0**-150 * size:
                q = [arb(x.mid(), max(largest, 2.0**-280 * size)) for x in q]
                return q if all(is_zero(evaluated(measure, q)) for measure in self._measures) else None
        return None
