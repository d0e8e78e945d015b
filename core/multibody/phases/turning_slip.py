"""Motion while friction turns with the slip, in space: a Taylor series in balls, up to where the slip ends.

The unit vector along the slip is no polynomial of the coordinates, so that neither the passes nor the compiled series
apply: the whole table is expanded anew at every step. Towards the end of the slip steps become shorter in proportion to
it; below `ENDED` of the largest rate the rest is passed over at the last rate of change.
"""

from __future__ import annotations

import math
from bisect import bisect_right
from collections.abc import Sequence
from dataclasses import dataclass, field, replace
from functools import cached_property

import numpy as np
from flint import arb, arb_mat, arb_poly

from core.arrays import Floats
from core.balls import precision
from core.errors import BudgetExceeded
from core.multibody.algebra.polynomials import ZERO, Ball, LinearForm, Poly, is_zero
from core.multibody.contacts.conditions_of_states import LOOKED
from core.multibody.contacts.contact_start import ContactStart
from core.multibody.equations.dynamics import accelerations
from core.multibody.equations.expansion import Expansion, expansion, saddle, slope, value
from core.multibody.equations.packed import exponent, pair
from core.multibody.motion.modelling import Modelled, Piece
from core.multibody.motion.motion import Motion, States
from core.multibody.motion.whole import Whole
from core.multibody.reduction.reduction import Reduced
from core.multibody.search.bands import SAFETY_FACTOR
from core.multibody.table.connection_effects import Force, Unilateral
from core.multibody.table.description import Described
from core.multibody.table.measures import COMPONENTS
from core.multibody.table.table import Row, Table, identity

ENDED = 2.0**-72
"""Share of the largest rate below which slip ends."""
_BITS = 256
"""Precision of the series: more than twice that of pairs, in which its states are stated."""
_MOST_STEPS = 250
"""Steps that one phase of turning slip may take."""

_PART = 0.75
"""Share of the time in which slip could end that a step takes at most: the series diverges there, and beside it the
last terms, by which steps are chosen, are a quarter of what is left out."""
_NO_REST = 2.0**-30
"""Share of a step that is so little that the next one is followed from before its start."""
_LONGEST = 1e6
"""Longest step (s), where slip does not change at all."""
_KINDS = {"fine": (32, 2.0**-96), "check": (30, 2.0**-90)}
"""Order and tolerance of the two runs."""


@dataclass
class SlipSeries:
    """Steps so far.

    Attributes
    ----------
    starts : list of ball
        Times at which steps begin, and the time reached.
    steps : list of Expansion
    table : Table
        With the state reached.
    ended : Row or None
        Whose slip ended the run.
    fastest : dict of str to float
        Largest rate so far of every unit.
    """

    starts: list[Ball]
    steps: list[Expansion]
    table: Table
    ended: Row | None = None
    fastest: dict[str, float] = field(default_factory=dict)


@dataclass
class TurningSlip(Motion):
    """The motion of a table with friction that turns."""

    table: Table
    name: str = "Taylor series"
    why: str = "the direction of friction turns with the slip"
    how: str = "measured against pairs"
    period: Ball | None = None
    _runs: dict[str, SlipSeries] = field(default_factory=dict, repr=False)

    @cached_property
    def chosen(self) -> list[int]:
        """Rows that do not follow from others."""
        return self.table.independent_rows()

    def run(self, kind: str, end: float) -> SlipSeries:
        """Return the steps to a time, or to the end of the slip.

        Raises
        ------
        BudgetExceeded
            For more steps than one phase may take.
        """
        found = self._runs.setdefault(kind, SlipSeries([ZERO], [], self.table))
        order, tolerance = _KINDS[kind]
        with precision(_BITS):
            while found.ended is None and found.starts[-1] < end:
                if len(found.steps) > _MOST_STEPS:
                    raise BudgetExceeded(
                        "steps", len(found.steps), _MOST_STEPS, path=("times",), remedy="ask for a shorter time"
                    )
                self._step(found, order, tolerance)
        return found

    def about(self, kind: str, time: float) -> tuple[Expansion, float]:
        """Return the motion about a time, from the step in which it lies, and how much of the step is left (s).

        After the end of the slip it is the last step that is followed.
        """
        run = self.run(kind, math.nextafter(time, math.inf))
        with precision(_BITS):
            at, last = arb(time), len(run.steps) - 1
            k = min(max(bisect_right(run.starts, at) - 1, 0), last)
            if k < last and float(run.starts[k + 1] - at) < _NO_REST * float(run.starts[k + 1] - run.starts[k]):
                k += 1
            rest = float(run.starts[k + 1] - at)
            later = arb_poly([at - run.starts[k], 1])
            motion = run.steps[k]
            found = Expansion(*([_moved(x, later) for x in each] for each in (motion.places, motion.multipliers)))
        return found, rest if rest > 0.0 else _LONGEST

    def _step(self, run: SlipSeries, order: int, tolerance: float) -> None:
        # Rows that follow from others at the start do so for good; on a state with its error they may not.
        motion = expansion(run.table, order, self.chosen)
        run.steps.append(motion)
        for unit, series in zip(self.table.units, motion.places, strict=True):
            run.fastest[unit] = max(run.fastest.get(unit, 0.0), abs(float(series[1])))
        h = min(_length(motion, self.table.units, run.fastest, tolerance), self._within(run.table, motion))
        ending = self._ending(run.table, motion, run.fastest)
        if ending is not None:
            h, run.ended = ending
        q, v = ([arb(value(x, h).mid()) for x in motion.places], [arb(value(slope(x), h).mid()) for x in motion.places])
        run.table = replace(run.table, q=q, v=v)
        run.starts.append(run.starts[-1] + h)

    def _within(self, table: Table, motion: Expansion) -> Ball:
        """Return the share of the time in which slip could end that a step may take: there the series diverges."""
        times = [arb(_LONGEST)]
        for row in table.rows:
            if row.slide is not None:
                slips, gains = table.slip_of(row), _gains(motion, row)
                fast, change = (sum((x * x for x in vector), ZERO).sqrt() for vector in (slips, gains))
                # What begins to slide has no slip yet.
                if change > 0 and fast > 0:
                    times.append(arb((_PART * fast / change).mid()))
        return min(times, key=float)

    def _ending(self, table: Table, motion: Expansion, fastest: dict[str, float]) -> tuple[Ball, Row] | None:
        """Return after which time slip ends, if it is about to."""
        for row in table.rows:
            if row.slide is None:
                continue
            x, y = table.slip_of(row)
            size = (x * x + y * y).sqrt()
            if not size > 0:
                continue
            gains = _gains(motion, row)
            loss = -(x * gains[0] + y * gains[1]) / size
            if float(size) < ENDED * fastest["m"] and loss > 0:
                return arb((size / loss).mid()), row
        return None

    def states(self, times: Floats, *, finer: bool = False) -> States:
        """Return the states by the finer run, judged by the other."""
        (q, v), (other, rate) = (self.by(kind, times) for kind in _KINDS)
        apart = [np.abs((a - b).sum(axis=2)) for a, b in ((q, other), (v, rate))]
        return States(q, v, SAFETY_FACTOR * apart[0], SAFETY_FACTOR * apart[1], (other, rate))

    def by(self, kind: str, times: Floats) -> tuple[Floats, Floats]:
        """Return coordinates and rates by one run, each of shape (t, n, 2)."""
        run = self.run(kind, float(times.max(initial=0.0)))
        n = len(self.table.names)
        q, v = np.zeros((len(times), n, 2)), np.zeros((len(times), n, 2))
        with precision(_BITS):
            for s, t in enumerate(times):
                if not run.steps:
                    q[s], v[s] = [pair(x, 0) for x in self.table.q], [pair(x, 0) for x in self.table.v]
                    continue
                at = min(arb(float(t)), run.starts[-1])
                # In balls: the last steps are shorter than what doubles tell apart.
                k = min(max(bisect_right(run.starts, at) - 1, 0), len(run.steps) - 1)
                late = at - run.starts[k]
                for i, series in enumerate(run.steps[k].places):
                    q[s, i], v[s, i] = pair(value(series, late), 0), pair(value(slope(series), late), 0)
        return q, v


def _gains(motion: Expansion, row: Row) -> list[Ball]:
    """Return the rates of change of both components of a slip, whose lines are constant."""
    assert row.slide is not None
    return [sum((2 * poly[()] * motion.places[j][2] for j, poly in line.items()), ZERO) for line in row.slide[1:]]


def _moved(series: Sequence[Ball], later: arb_poly) -> list[Ball]:
    """Return the series of the same polynomial about a later time."""
    found = arb_poly(list(series))(later).coeffs()
    return [*found, *[ZERO] * (len(series) - len(found))]


def _length(motion: Expansion, units: Sequence[str], fastest: dict[str, float], tolerance: float) -> Ball:
    """Return the length of a step: its last terms are a share of the largest rate of their unit, or of a lower term."""
    # What rests as yet has no rate but what the step itself gains.
    scales = _scales(motion, units, fastest)
    h = _LONGEST
    for unit, series in zip(units, motion.places, strict=True):
        for k in (len(series) - 2, len(series) - 1):
            # Terms of a slip that is about to end are beyond the range of doubles.
            last = exponent(k * series[k])
            if last is not None and scales[unit]:
                # More than the longest, whose power of two may be beyond doubles, is not needed.
                power = max((math.log2(tolerance) + scale - last) / (k - j) for j, scale in scales[unit] if j < k)
                h = min(h, 2.0 ** min(power, math.log2(_LONGEST)))
    return arb(h)


def _scales(motion: Expansion, units: Sequence[str], fastest: dict[str, float]) -> dict[str, list[tuple[int, float]]]:
    """Return by unit the powers of time of places, and the logarithms of base 2 of how fast their terms are."""
    found = {unit: [(1, math.log2(x))] if x > 0.0 else [] for unit, x in fastest.items()}
    for unit, series in zip(units, motion.places, strict=True):
        sizes = ((j, exponent(j * series[j])) for j in range(2, motion.order // 2))
        found[unit].extend((j, float(size)) for j, size in sizes if size is not None)
    return found


@dataclass(frozen=True)
class TurningWhole(Whole):
    """A scene in motion whose friction turns.

    Attributes
    ----------
    turning : mapping of str to list of (Unilateral, int, int)
        Forces of friction that turn, by name: of every measure that they are of, itself, the axis of the component,
        the row of the push. Those of a shape are the sums of those of its corners.
    """

    turning: dict[str, list[tuple[Unilateral, int, int]]] = field(default_factory=dict)

    def multipliers(self, q: Floats, v: Floats) -> Floats:
        """Return the multipliers of every row, shape (t, rows)."""
        return self._at(q, v)[1]

    def accelerations(self, q: Floats, v: Floats) -> Floats:
        """Return the acceleration of every coordinate at states, shape (t, n)."""
        return self._at(q, v)[0]

    def _at(self, q: Floats, v: Floats) -> tuple[Floats, Floats]:
        table = self.measures.table
        count = len(table.names)
        gains, found = np.zeros((len(q), count)), np.zeros((len(q), len(table.rows)))
        chosen = table.independent_rows()
        for s in range(len(q)):
            places, rates = ([arb(float(x[0])) + arb(float(x[1])) for x in vector[s]] for vector in (q, v))
            now = replace(table, q=places, v=rates).oriented()
            right = [[x] for x in now.forces()] + [[now.convective(now.rows[r])] for r in chosen]
            solved = saddle(now, chosen).solve(arb_mat(right)).entries()
            gains[s] = [float(x.mid()) for x in solved[:count]]
            for k, r in enumerate(chosen):
                found[s, r] = float(solved[count + k].mid())
        return gains, found

    def keeps(self, measure: Poly) -> bool:
        """Return whether a function of the coordinates is constant: without passes, its series has to say so."""
        return all(is_zero(x) for x in expansion(self.measures.table, LOOKED).of(measure)[1:])

    def turns_with(self, force: Force) -> list[int]:
        """Return the rows of the pushes with which a force turns: none where its direction stays."""
        return [
            row
            for one, axis, row in self.turning.get(force.name, ())
            if one.tangents is not None and not all(is_zero(tangent[axis]) for tangent in one.tangents)
        ]

    def force(self, force: Force, q: Floats, v: Floats, multipliers: Floats) -> tuple[Floats, Floats]:
        """Return a force at every state, and the sum of the magnitudes of its terms, each of shape (t,)."""
        parts = self.turning.get(force.name, ())
        turned = {row for _, _, row in parts}
        rest = replace(force, terms=[term for term in force.terms if term[0] not in turned])
        total, size = super().force(rest, q, v, multipliers)
        for one, axis, row in parts:
            assert one.tangents is not None
            slip = np.array([_slip(line or {}, v) for line in (one.slip, one.across)])
            # What begins to slide does so along the first direction.
            slip[0, ~slip.any(axis=0)] = 1.0
            length = np.maximum(np.hypot(slip[0], slip[1]), 1e-300)
            along = (float(one.tangents[0][axis]) * slip[0] + float(one.tangents[1][axis]) * slip[1]) / length
            push = float(one.kinetic) * multipliers[:, row]
            total, size = total - push * along, size + np.abs(push)
        return total, size


def _slip(line: LinearForm, v: Floats) -> Floats:
    """Return a rate of slip at rates of shape (t, n, 2); where slip ends its terms cancel, down to their tails."""
    found = np.zeros(len(v))
    with precision(_BITS):
        for s, rates in enumerate(v.tolist()):
            terms = (poly[()] * (arb(rates[j][0]) + arb(rates[j][1])) for j, poly in line.items())
            found[s] = float(sum(terms, ZERO).mid())
    return found


def turning_model(
    found: Described, unilateral: Sequence[Unilateral], normal: Sequence[int | None], start: ContactStart
) -> Modelled:
    """Return the only model of a table with friction that turns.

    Parameters
    ----------
    normal : sequence of int or None
        Number of the row of each measure.
    """
    table = found.measures.table
    gain, chosen = accelerations(table)
    motion = TurningSlip(table)
    everything = list(range(len(table.names)))
    turning: dict[str, list[tuple[Unilateral, int, int]]] = {}
    for one, row in zip(unilateral, normal, strict=True):
        if row is None or table.rows[row].slide is None:
            continue
        for name in (one.name,) if one.whole is None else (one.name, one.whole):
            for i, axis in enumerate(COMPONENTS):
                turning.setdefault(f"{name}.friction.{axis}", []).append((one, i, row))
    small = Reduced(table, identity(len(table.names)), table.names)
    whole = TurningWhole(found.measures, small, gain, gain, [(everything, motion)], turning=turning)
    return Modelled(found, whole, [Piece(everything, table, gain, chosen)], start.moved, start.fitted)


def begins_at_once(table: Table, name: str) -> bool:
    """Return whether what slips from rest in space does so with an acceleration along its first direction."""
    motion = expansion(table, 2)
    lines = [row.slide[1] for row in table.rows if row.slide is not None and row.name == name]
    return all(bool(motion.of_rates(line)[1] > 0) for line in lines)


def turns(table: Table, names: Sequence[str], order: int) -> list[str]:
    """Return which of the contacts named, whose friction may turn, do so: their slip does not stay along one line."""
    rows = [row for row in table.rows if row.slide is not None and row.name in names]
    if not rows:
        return []
    motion = expansion(table, order)
    return [row.name for row in rows if any(not is_zero(x) for x in motion.of_rates((row.slide or (0, {}, {}))[2]))]
