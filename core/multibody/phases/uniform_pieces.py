"""A motion with constant accelerations: what is watched is a polynomial in time, its coefficients in balls.

Bounces in turn become shorter than pairs of doubles resolve beside the places at which they happen. The coefficients of
a gap, however small, are known to all their digits.
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from flint import arb

from core.arrays import Floats
from core.multibody.algebra.polynomials import ZERO, Ball, LinearForm, Poly, is_zero
from core.multibody.equations.dynamics import Multipliers
from core.multibody.equations.expansion import Expansion, Series, product, slope
from core.multibody.equations.packed import pair, two_to
from core.multibody.equations.starting_pieces import series_of
from core.multibody.laws.law import Law
from core.multibody.laws.tape import Op, Tape
from core.multibody.search.curves import Curve
from core.multibody.search.pieces import COEFFICIENTS, Pieces
from core.multibody.table.connection_effects import Force
from core.multibody.table.table import Row, Table

HIGHEST_DEGREE = 16
"""Of polynomials in time whose zeros are found in balls, one derivative after another."""


def uniform_motion(table: Table, accelerations: Sequence[Ball], multipliers: Multipliers) -> Expansion:
    """Return a motion with constant accelerations, and the forces at its start, as an exact expansion."""
    places = [[q, v, a / 2, ZERO, ZERO] for q, v, a in zip(table.q, table.v, accelerations, strict=True)]
    start = multipliers.elimination.solution(range(len(table.rows)))
    return Expansion(places, [[x, ZERO, ZERO] for x in start])


def keeps_its_forces(table: Table, motion: Expansion) -> bool:
    """Return whether the multipliers at the start of a motion with constant accelerations move it at all times.

    They may change all the same: where their arms do, or a formula of what moves acts on what rests. The equations of
    motion with the multipliers of the start are polynomials in time, and hold at all times where every coefficient
    vanishes.
    """
    return _moved_by(table, motion, [_push(row, motion) for row in table.rows])


def steady_forces(table: Table, motion: Expansion, forces: Sequence[Force]) -> list[bool]:
    """Return which forces keep the value of the start for all the time of a motion with constant accelerations.

    The row of a string that is drawn in straight pushes along one direction, as strongly as its length says: its
    multiplier changes by as much the other way, and what it does stays the same.
    """
    pushes = [_push(row, motion) for row in table.rows]
    steady = [
        {j: [series[0], *[ZERO] * motion.order] for j, series in push.items()} if _keeps_its_direction(push) else push
        for push in pushes
    ]
    if not _moved_by(table, motion, steady):
        return [False] * len(forces)
    return [
        not (force.of_state or force.of_rates or force.of_squares or force.of_laws)
        and all(_are_alike(motion.of(poly), _strongest(pushes[row])) for row, poly in force.terms)
        for force in forces
    ]


def _push(row: Row, motion: Expansion) -> dict[int, Series]:
    """Return what a multiplier one does to every coordinate, along a motion."""
    found: dict[int, Series] = {}
    for line in (row.rates, row.drag):
        for j, poly in line.items():
            more = motion.of(poly)
            found[j] = [x + y for x, y in zip(found[j], more, strict=True)] if j in found else more
    return found


def _keeps_its_direction(push: Mapping[int, Series]) -> bool:
    return all(_are_alike(series, _strongest(push)) for series in push.values())


def _strongest(push: Mapping[int, Series]) -> Series:
    """Return the largest component of a push at the start."""
    return max(push.values(), key=lambda series: abs(float(series[0])), default=[ZERO])


def _are_alike(first: Series, second: Series) -> bool:
    """Return whether a polynomial in time is a multiple of another, which is not zero at the start."""
    return not is_zero(second[0]) and all(
        is_zero(x * second[0] - y * first[0]) for x, y in zip(first[1:], second[1:], strict=True)
    )


def _moved_by(table: Table, motion: Expansion, pushes: Sequence[Mapping[int, Series]]) -> bool:
    """Return whether the multipliers of the start satisfy the equations of motion at all times, with these pushes."""
    order, rates = motion.order, [slope(series) for series in motion.places]
    read = [(one, key[0]) for law in table.acting for one in law.inputs.values() for key in one.form if key]
    if any(not is_zero(x) for one, i in read for x in (rates if one.rate else motion.places)[i][1:]):
        return False
    left = [[ZERO] * order for _ in table.names]

    def add(i: int, factor: Ball, series: Sequence[Ball]) -> None:
        left[i] = [x + factor * y for x, y in zip(left[i], series[:order], strict=True)]

    for (i, j), stiffness in table.stiffness.items():
        add(i, stiffness, motion.places[j])
    for (i, j), damping in table.damping.items():
        add(i, damping, rates[j])
    for (i, j, k), gyration in table.gyration.items():
        add(i, -gyration, product(motion.places[j][:order], rates[k]))
    for push, multiplier in zip(pushes, motion.multipliers, strict=True):
        for j, series in push.items():
            add(j, -multiplier[0], series)
    return all(is_zero(x) for series in left for x in series[1:])


def polynomial_of(law: Law, motion: Expansion) -> Series | None:
    """Return a formula along a motion with constant accelerations as a polynomial in time; None where it is none.

    Its degree is that of the formula, which may be beyond that of the expansion of the motion.
    """
    tape, degrees = Tape.of([law]), list[int]()
    for code, a, b, c, _ in tape.operations:
        found = 0
        if code in (Op.PLACE, Op.RATE):
            every = [motion.places[i] for i, _, _ in tape.terms[b:c]]
            found = max((k for place in every for k, x in enumerate(place) if not x.is_zero()), default=0)
            found = max(found - int(code == Op.RATE), 0)
        elif code in (Op.ADD, Op.SUBTRACT):
            found = max(degrees[a], degrees[b])
        elif code == Op.MULTIPLY:
            found = degrees[a] + degrees[b]
        elif code == Op.DIVIDE and tape.operations[b][0] == Op.NUMBER:
            found = degrees[a]
        elif code != Op.NUMBER:
            return None
        if found > HIGHEST_DEGREE:
            return None
        degrees.append(found)
    order = degrees[tape.outputs[0]] + 1
    places = [[*place, *[ZERO] * (order + 1 - len(place))] for place in motion.places]
    return series_of(law, Expansion(places, []), order)


@dataclass(frozen=True)
class UniformPieces(Pieces):
    """A motion with constant accelerations on some intervals.

    Attributes
    ----------
    motions : list of Expansion
        From the start of each.
    """

    motions: tuple[Expansion, ...] = ()

    def place(self, i: int) -> Curve:
        """Return a coordinate."""
        return self.curve([motion.places[i] for motion in self.motions])

    def rate(self, i: int) -> Curve:
        """Return its rate."""
        return self.curve([slope(motion.places[i]) for motion in self.motions])

    def multiplier(self, row: int) -> Curve:
        """Return the multiplier of a row."""
        return self.curve([motion.multipliers[row] for motion in self.motions])

    def of(self, poly: Poly) -> Curve:
        """Return a polynomial of the coordinates."""
        return self.curve([motion.of(poly) for motion in self.motions])

    def of_rates(self, line: LinearForm) -> Curve:
        """Return a linear form in the rates."""
        return self.curve([motion.of_rates(line) for motion in self.motions])

    def curve(self, each: Sequence[Series]) -> Curve:
        """Return a quantity from its coefficients on every piece."""
        values = np.zeros((*self.shape, 2))
        for p, (series, length) in enumerate(zip(each, self.lengths, strict=True)):
            _, exponent = math.frexp(abs(length))
            for k, x in enumerate(series):
                if not is_zero(x):
                    values[p, k] = pair(x * (-1) ** (k * (length < 0.0)), k * (exponent - 1))
        return Curve(values, np.abs(values[..., 0]))


@dataclass(frozen=True)
class ExpandedUniform:
    """A motion with constant accelerations, from its exact expansion at time zero."""

    motion: Expansion

    def __call__(self, times: Floats, reach: Floats) -> UniformPieces:
        """Return the pieces, each as long as is of interest."""
        lengths = np.array([math.copysign(two_to(math.ceil(math.log2(abs(x)))), x) for x in reach])
        nothing = np.zeros((len(times), 0, COEFFICIENTS, 2))
        sizes = nothing[..., 0]
        motions = tuple(self._from(float(t)) for t in times)
        return UniformPieces(lengths, np.full(len(times), np.inf), nothing, sizes, nothing, sizes, motions)

    def _from(self, time: float) -> Expansion:
        if time == 0.0:
            return self.motion
        q, v = self.motion.state(arb(time))
        places = [[a, b, *own[2:]] for a, b, own in zip(q, v, self.motion.places, strict=True)]
        return Expansion(places, self.motion.multipliers)
