"""Motion while friction turns with the slip, in space: a Taylor series in pairs of doubles, up to where the slip ends.

The unit vector along the slip is no polynomial of the coordinates, so that the passes do not apply; the kernels know
its series (`core.multibody.motion.turning_friction`). Towards the end of a slip steps become shorter in proportion to
what is left of it: the motion is followed in legs, each in a unit of time that fits. Below `ENDED` the rest is passed
over at the last rate of change. A slip that begins from rest has no direction that the kernels could form: its first
step is made in balls.
"""

from __future__ import annotations

import math
from bisect import bisect_right
from collections.abc import Sequence
from dataclasses import dataclass, field, replace
from functools import cached_property

import numpy as np
from flint import arb, arb_poly

from core.arrays import Floats
from core.balls import precision
from core.errors import BudgetExceeded
from core.multibody.algebra.polynomials import ZERO, Ball, LinearForm, Poly, is_zero
from core.multibody.contacts.conditions_of_states import LOOKED
from core.multibody.contacts.contact_start import ContactStart
from core.multibody.equations.dynamics import accelerations
from core.multibody.equations.expansion import Expansion, expansion, slope, value
from core.multibody.equations.onsets_of_slip import rests
from core.multibody.equations.packed import Packed, Units, exponent, packed, pair, two_to, units_of
from core.multibody.motion.modelling import Modelled, Piece
from core.multibody.motion.motion import Motion, States
from core.multibody.motion.numerical import SINGULAR_TIME_ERROR
from core.multibody.motion.run import MOST_STEPS, Run, evaluate
from core.multibody.motion.series_pairs import multipliers_pairs
from core.multibody.motion.series_run import integrate
from core.multibody.motion.whole import Whole
from core.multibody.reduction.reduction import Reduced
from core.multibody.search.bands import SAFETY_FACTOR
from core.multibody.table.connection_effects import Force, Unilateral
from core.multibody.table.description import Described
from core.multibody.table.measures import COMPONENTS
from core.multibody.table.table import Row, Table, identity

ENDED = 2.0**-60
"""Time that is left of a slip, in the unit of time of its motion, which is passed over: its square is nothing beside
places, and rates are wrong by less than a hundredth of the rounding of doubles."""
_BITS = 256
"""Precision of the step from rest: more than twice that of pairs, in which its states are stated."""
_LONGEST = 1e6
"""Longest step (s) from rest, where slip does not change at all."""
_FROM_REST = {"fine": (32, 2.0**-100), "check": (30, 2.0**-94)}
"""Order and tolerance of the step from rest, as of the series that goes on from it."""


@dataclass
class Leg:
    """Steps in one unit of time.

    Attributes
    ----------
    begins : ball
        Since the start of the motion (s).
    table : Table
        With the state there.
    arrays, units : Packed and Units
    run : Run
    """

    begins: Ball
    table: Table
    arrays: Packed
    units: Units
    run: Run

    @property
    def ends(self) -> Ball:
        """The time reached (s)."""
        return self.begins + self._unit * _sum_of(self.run.starts[-1])

    @property
    def _unit(self) -> Ball:
        return arb(two_to(self.units.time))

    def since(self, time: Ball) -> tuple[float, float]:
        """Return a time in the units of the leg since it begins, as a pair."""
        return pair(time - self.begins, -self.units.time)

    def states(self, times: Sequence[tuple[float, float]]) -> tuple[Floats, Floats]:
        """Return coordinates and rates at times in its units, each of shape (t, n, 2), in SI units."""
        high, low = (np.array([time[i] for time in times]) for i in (0, 1))
        q, v = evaluate(self.run, high, low)
        up = self.units.up[None, :, None]
        return q * up, v * up * two_to(-self.units.time)


@dataclass
class SlipSeries:
    """The motion so far.

    Attributes
    ----------
    legs : list of Leg
    onset : Expansion or None
        The step from rest, and when it ends (s).
    onset_ends : ball
    ended : Row or None
        Whose slip ended the run.
    """

    legs: list[Leg]
    onset: Expansion | None = None
    onset_ends: Ball = ZERO
    ended: Row | None = None

    @property
    def reached(self) -> Ball:
        """The time reached (s)."""
        return self.legs[-1].ends

    @property
    def singular(self) -> bool:
        """Whether a singular place ended it."""
        return self.legs[-1].run.singular

    def end_state(self) -> tuple[list[Ball], list[Ball]]:
        """Return coordinates and rates at the time reached."""
        leg = self.legs[-1]
        q, v = leg.states([(float(leg.run.starts[-1, 0]), float(leg.run.starts[-1, 1]))])
        return [_sum_of(x) for x in q[0]], [_sum_of(x) for x in v[0]]

    def leg_at(self, time: Ball) -> int:
        """Return the number of the leg in which a time is; -1 for the step from rest."""
        if self.onset is not None and time < self.onset_ends:
            return -1
        return max(bisect_right([leg.begins for leg in self.legs], time) - 1, 0)


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
        """Rows that do not follow from others; those that do so at the start do for good."""
        return self.table.independent_rows()

    @cached_property
    def packed(self) -> tuple[Packed, Units]:
        """The table for compiled code, in the unit of time of its motion."""
        units = units_of(self.table, accelerations(self.table)[0])
        return packed(self.table, self.chosen, units), units

    @property
    def first_reach(self) -> float:
        """Time (s) until which a search goes at first."""
        return 2.0 * two_to(self.packed[1].time)

    def run(self, kind: str, end: float) -> SlipSeries:
        """Return the motion to a time, or to the end of the slip.

        Raises
        ------
        BudgetExceeded
            For more steps than a motion may take.
        """
        with precision(_BITS):
            found = self._runs.get(kind)
            if found is None:
                found = self._runs[kind] = self._begun(kind)
            while found.ended is None and not found.singular and found.reached < end:
                if sum(len(leg.run.series) for leg in found.legs) > MOST_STEPS:
                    raise BudgetExceeded(
                        "steps", MOST_STEPS, MOST_STEPS, path=("times",), remedy="ask for a shorter time"
                    )
                leg = found.legs[-1]
                goal = float((arb(end) - leg.begins) * arb(2) ** -leg.units.time)
                # Up to the last time that is asked for, to rounding.
                goal = math.nextafter(goal, math.inf)
                more = integrate(leg.table, leg.arrays, leg.units, kind, goal, leg.run if len(leg.run.series) else None)
                leg.run = more if not len(leg.run.series) else leg.run.followed_by(more)
                if leg.run.slowed:
                    self._go_on(found)
        return found

    def _begun(self, kind: str) -> SlipSeries:
        if not any(rests(self.table, self.table.rows[r]) for r in self.chosen):
            return SlipSeries([self._leg(ZERO, self.table, *self.packed)])
        order, tolerance = _FROM_REST[kind]
        motion = expansion(self.table, order, self.chosen)
        h = _length(motion, self.table.units, tolerance)
        q, v = [arb(value(x, h).mid()) for x in motion.places], [arb(value(slope(x), h).mid()) for x in motion.places]
        return SlipSeries([self._leg(h, replace(self.table, q=q, v=v), *self.packed)], motion, h)

    def _leg(self, begins: Ball, table: Table, arrays: Packed, units: Units) -> Leg:
        nothing = np.zeros((0, len(table.names), 1, 2))
        return Leg(begins, table, arrays, units, Run(np.zeros((1, 2)), nothing))

    def _go_on(self, found: SlipSeries) -> None:
        """Begin another leg in a unit of time that fits, or end the slip that is about to end."""
        leg, (q, v) = found.legs[-1], found.end_state()
        gain = _accelerations(leg, q, v)
        reach, ends, ending = math.inf, math.inf, None
        for row in (self.table.rows[r] for r in self.chosen):
            if row.slide is None:
                continue
            (x, y), (a, b) = (_components(row, vector) for vector in (v, gain))
            size, change, falls = math.hypot(x, y), math.hypot(a, b), -(x * a + y * b)
            reach = min(reach, size / change if change > 0.0 else math.inf)
            if falls > 0.0 and size * size / falls < ends:
                ends, ending = size * size / falls, row
        base, units = self.packed
        table = replace(self.table, q=q, v=v)
        if ending is not None and ends < math.ldexp(ENDED, units.time):
            found.ended = ending
            found.legs.append(_last(leg, found.reached, table, gain, ends))
            return
        time = min(units.time, math.floor(math.log2(reach))) if reach < math.inf else units.time
        if time < units.time:
            units = replace(units, time=time)
            base = packed(self.table, self.chosen, units)
            base = base._replace(slides=base.slides._replace(finer=1))
        found.legs.append(self._leg(found.reached, table, base, units))

    def ended(self, end: float) -> tuple[float, float] | None:
        """Return the time of a singular place before `end` and its error, None without one."""
        run = self.run("fine", end)
        return (float(run.reached), SINGULAR_TIME_ERROR * float(run.reached)) if run.singular else None

    def about_rest(self, kind: str, time: float) -> tuple[Expansion, float]:
        """Return the motion about a time within the step from rest, and how much of the step is left (s)."""
        run = self._runs[kind]
        assert run.onset is not None
        with precision(_BITS):
            later = arb_poly([arb(time), 1])
            moved = ([_moved(x, later) for x in each] for each in (run.onset.places, run.onset.multipliers))
            return Expansion(*moved), float(run.onset_ends - arb(time))

    def states(self, times: Floats, *, finer: bool = False) -> States:
        """Return the states by the finer run, judged by the other."""
        (q, v), (other, rate) = (self.by(kind, times) for kind in _FROM_REST)
        apart = [np.abs((a - b).sum(axis=2)) for a, b in ((q, other), (v, rate))]
        return States(q, v, SAFETY_FACTOR * apart[0], SAFETY_FACTOR * apart[1], (other, rate))

    def by(self, kind: str, times: Floats) -> tuple[Floats, Floats]:
        """Return coordinates and rates by one run, each of shape (t, n, 2)."""
        run = self.run(kind, float(times.max(initial=0.0)))
        n = len(self.table.names)
        q, v = np.zeros((len(times), n, 2)), np.zeros((len(times), n, 2))
        with precision(_BITS):
            where: dict[int, list[int]] = {}
            for s, t in enumerate(times.tolist()):
                where.setdefault(run.leg_at(arb(t)), []).append(s)
            for k, own in where.items():
                if k < 0:
                    assert run.onset is not None
                    for s in own:
                        for i, series in enumerate(run.onset.places):
                            late = arb(float(times[s]))
                            q[s, i], v[s, i] = pair(value(series, late), 0), pair(value(slope(series), late), 0)
                    continue
                leg = run.legs[k]
                if not len(leg.run.series):
                    q[own], v[own] = ([pair(x, 0) for x in vector] for vector in (leg.table.q, leg.table.v))
                    continue
                q[own], v[own] = leg.states([leg.since(arb(float(times[s]))) for s in own])
        return q, v


def _sum_of(number: Floats) -> Ball:
    return arb(float(number[0])) + arb(float(number[1]))


def _components(row: Row, vector: Sequence[Ball]) -> tuple[float, float]:
    """Return both components of a slip, or of its change, whose lines are constant."""
    assert row.slide is not None
    x, y = (sum((poly[()] * vector[j] for j, poly in line.items()), ZERO) for line in row.slide[1:])
    return float(x), float(y)


def _accelerations(leg: Leg, q: Sequence[Ball], v: Sequence[Ball]) -> list[Ball]:
    """Return the accelerations at a state of a leg (SI)."""
    lengths, time = leg.units.lengths, leg.units.time
    places = np.array([[pair(x, -e) for x, e in zip(q, lengths, strict=True)]])
    rates = np.array([[pair(x, time - e) for x, e in zip(v, lengths, strict=True)]])
    gain, multipliers = np.zeros_like(places), np.zeros((1, len(leg.arrays.rate), 2))
    multipliers_pairs(leg.arrays, places, rates, gain, multipliers)
    return [_sum_of(x) * arb(2) ** (e - 2 * time) for x, e in zip(gain[0], lengths, strict=True)]


def _last(leg: Leg, begins: Ball, table: Table, gain: Sequence[Ball], left: float) -> Leg:
    """Return the leg over the last of a slip, at the last rate of change."""
    time, lengths = leg.units.time, leg.units.lengths
    series = np.zeros((1, len(table.names), leg.run.series.shape[2], 2))
    for k, (vector, factor) in enumerate(((table.q, 1), (table.v, 1), (gain, arb(1) / 2))):
        for i, x in enumerate(vector):
            series[0, i, k] = pair(x * factor, k * time - lengths[i])
    starts = np.array([(0.0, 0.0), pair(arb(left), -time)])
    return Leg(begins, table, leg.arrays, leg.units, Run(starts, series))


def _moved(series: Sequence[Ball], later: arb_poly) -> list[Ball]:
    """Return the series of the same polynomial about a later time."""
    found = arb_poly(list(series))(later).coeffs()
    return [*found, *[ZERO] * (len(series) - len(found))]


def _length(motion: Expansion, units: Sequence[str], tolerance: float) -> Ball:
    """Return the length of a step: its last terms are a share of the largest rate of their unit, or of a lower term."""
    # What rests as yet has no rate but what the step itself gains.
    scales: dict[str, list[tuple[int, float]]] = {}
    for unit, series in zip(units, motion.places, strict=True):
        sizes = ((j, exponent(j * series[j])) for j in range(1, motion.order // 2))
        scales.setdefault(unit, []).extend((j, float(size)) for j, size in sizes if size is not None)
    h = _LONGEST
    for unit, series in zip(units, motion.places, strict=True):
        for k in (len(series) - 2, len(series) - 1):
            last = exponent(k * series[k])
            if last is not None and scales[unit]:
                power = max((math.log2(tolerance) + scale - last) / (k - j) for j, scale in scales[unit] if j < k)
                h = min(h, 2.0 ** min(power, math.log2(_LONGEST)))
    return arb(h)


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

    @cached_property
    def arrays(self) -> tuple[Packed, Units, list[int]]:
        """The table as described for compiled code, its units, and the rows that it holds."""
        (_, motion), *_ = self.parts
        assert isinstance(motion, TurningSlip)
        return *motion.packed, motion.chosen

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


def onset_power(table: Table, name: str) -> int | None:
    """Return the power of time with which what slips from rest in space begins to, None where none is found."""
    motion = expansion(table, LOOKED)
    for row, push in zip(table.rows, motion.multipliers, strict=True):
        if row.slide is not None and row.name == name and not is_zero(push[0]):
            slip = motion.of_rates(row.slide[1])
            found = next((k for k, x in enumerate(slip) if k and not is_zero(x)), None)
            return found if found is not None and slip[found] > 0 else None
    return None


def turns(table: Table, names: Sequence[str], order: int) -> list[str]:
    """Return which of the contacts named, whose friction may turn, do so: their slip does not stay along one line."""
    rows = [row for row in table.rows if row.slide is not None and row.name in names]
    if not rows:
        return []
    motion = expansion(table, order)
    return [row.name for row in rows if row.slide is not None and not _is_straight(motion, *row.slide[1:])]


def _is_straight(motion: Expansion, along: LinearForm, across: LinearForm) -> bool:
    """Return whether a slip stays along the line of its lowest power of time, which is not known without its width."""
    first, second = motion.of_rates(along), motion.of_rates(across)
    begins = next((k for k, x in enumerate(first) if not is_zero(x)), None)
    aside = ZERO if begins is None else second[begins] / first[begins]
    return all(is_zero(y - aside * x) for x, y in zip(first, second, strict=True))
