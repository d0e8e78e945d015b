"""Motions that repeat: one period in pairs of doubles answers any time at one cost.

With one degree of freedom and a potential, the state returns. A motion that starts at rest turns back on its own path,
so half a period is enough. With two degrees of freedom and symmetry about the vertical the height returns, and the rest
is turned by an angle alpha: q(t) = R(k alpha) q(t - kT). T and alpha are found in pairs, so that their error, times the
number of periods, stays small.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, field

import numpy as np
from flint import arb

from core.arrays import Floats, largest_magnitude
from core.balls import precision
from core.compiled import kernel
from core.double_double import Pair, dd_add, dd_add_d, dd_mul, dd_mul_d
from core.multibody.algebra.polynomials import BITS, Ball, is_zero
from core.multibody.equations.packed import Units, packed, pair, state, two_to, units_of
from core.multibody.motion.lost_rank import lines_that_may_depend, up_to_lost_rank
from core.multibody.motion.motion import Motion, States
from core.multibody.motion.returns import PLACES, POWER, RATES, Passage, Section, added, distance, followed
from core.multibody.motion.run import Run
from core.multibody.motion.series_pairs import moved_pairs
from core.multibody.motion.series_run import CHECK_ORDER, CHECK_TOLERANCE, FINE_ORDER, FINE_TOLERANCE
from core.multibody.table.table import Table

CLOSED = 1e-20
"""How closely a state has to return, in units of the scene."""

UNCERTAIN = 2.0**-54
"""Share of a period by which two runs may differ: beside a separatrix what brings a motion back is rounding."""

_PARTS = 4
"""Nodes to a step of the series."""


@dataclass
class Periodic(Motion):
    """A part whose motion repeats, up to a turn about the vertical and a shift of what only winds on.

    Attributes
    ----------
    length : ndarray, shape (2,)
        Period in the units of the arrays, as a pair.
    turned : ball or None
        Angle alpha by which a period turns the motion about the vertical.
    winding, winding_error : float
        The same angle with its full turns, and its error (rad).
    """

    table: Table
    units: Units
    run: Run
    length: Floats
    half: bool
    shift: Floats
    uncertainty: tuple[float, float]
    turned: Ball = None
    winding: float = 0.0
    winding_error: float = 0.0
    name: str = "one period"
    why: str = "one degree of freedom in a potential: left to itself, the motion repeats"
    how: str = "measured against pairs"
    _turns: dict[float, tuple[Pair, Pair]] = field(default_factory=dict, repr=False)

    @property
    def period(self) -> Ball | None:
        """The period in seconds, as wide as two runs differ in it."""
        return (arb(self.length[0], self.uncertainty[0]) + arb(self.length[1])) * arb(2) ** self.units.time

    @property
    def moved_on(self) -> Sequence[Ball]:
        """By how much a period moves each of its coordinates on, as well as two runs agree in it."""
        off = self.uncertainty[1]
        return [
            (arb(high, off) + arb(low)) * arb(float(up)) if high else arb(0)
            for (high, low), up in zip(self.shift, self.units.up, strict=True)
        ]

    @property
    def winds_on(self) -> bool:
        """Whether a period turns it about the vertical, or moves some coordinates on."""
        return self.winding != 0.0 or bool(np.any(self.shift))

    @property
    def late(self) -> float:
        """Share of the period by which two runs differ in it."""
        return self.uncertainty[0] / float(self.length[0])

    def states(self, times: Floats, *, finer: bool = False) -> States:
        """Return the states: the time within the period, the step in which it lies, and its series in pairs."""
        n = len(self.table.names)
        scaled = np.ascontiguousarray(np.asarray(times, dtype=np.float64) * two_to(-self.units.time))
        q, v = np.zeros((len(times), n, 2)), np.zeros((len(times), n, 2))
        counts = np.zeros(len(times))
        late, off = self.uncertainty
        other, rate = np.zeros_like(q), np.zeros_like(v)
        shape = (self.run.starts, self.run.series, self.length, self.half, self.shift)
        _fold(*shape, scaled, late, q, v, other, rate, counts)
        if self.turned is not None:
            with precision(BITS):
                cosines = np.array([self._turn(k) for k in counts]).reshape(-1, 2, 2)
            for vector in (q, v, other, rate):
                _rotate(cosines, vector)
        fastest = largest_magnitude(self.run.series[:, :, 1, 0])
        hardest = 2.0 * largest_magnitude(self.run.series[:, :, 2, 0])
        drift = (np.abs(counts) + 1.0) * late + np.abs(scaled) * 2.0**-104
        up = self.units.up
        down = two_to(-self.units.time)
        q_error = np.outer(drift * fastest + off * (np.abs(counts) + 1.0), up)
        v_error = np.outer(drift * hardest + off * (np.abs(counts) + 1.0), up * down)
        place, speed = up[None, :, None], (up * down)[None, :, None]
        return States(q * place, v * speed, q_error, v_error, (other * place, rate * speed))

    def _turn(self, count: float) -> tuple[Pair, Pair]:
        if count not in self._turns:
            sine, cosine = (arb(count) * self.turned).sin_cos()
            self._turns[count] = (_as_pair(cosine), _as_pair(sine))
        return self._turns[count]

    def nodes(self, end: float) -> Floats:
        """Return four times a step, over one period or up to `end`."""
        starts = self.run.starts[:, 0]
        if self.half:
            starts = np.concatenate([starts, self.length[0] - starts[-2::-1]])
        fine = np.interp(np.arange(_PARTS * (len(starts) - 1) + 1) / _PARTS, np.arange(len(starts)), starts)
        fine = math.copysign(1.0, end) * fine * two_to(self.units.time)
        return np.append(fine[np.abs(fine) < abs(end)], end) if abs(fine[-1]) > abs(end) else fine


def repeating(table: Table, acceleration: Sequence[Ball], chosen: Sequence[int]) -> Periodic | None:
    """Return the motion of a part with one degree of freedom in a potential, if it returns; else None."""
    if len(table.names) - len(chosen) != 1 or not _conservative(table) or table.gyration or table.damping:
        return None
    units = units_of(table, acceleration)
    arrays = packed(table, chosen, units)
    q, v = state(table, units)
    free = [i for i in range(len(q)) if not _cyclic(table, i)]
    normal = np.zeros(len(q))
    at_rest = all(is_zero(x) for x in table.v)
    # In the units of the arrays it is of the order of one, however hard the pull.
    pull = np.array([pair(x, 2 * units.time - e)[0] for x, e in zip(acceleration, units.lengths, strict=True)])
    # What starts beside a turning point passes its place twice in a short time, its rate only once.
    slow = bool(np.max(np.abs(v[free, 0]), initial=0.0) <= np.max(np.abs(pull[free]), initial=0.0))
    normal[free] = pull[free] / max(np.max(np.abs(pull)), 1e-300) if slow else v[free, 0]
    if not np.any(normal):
        return None
    section = Section(normal, v if slow else q, RATES if slow else PLACES, 1.0)
    if at_rest:
        # Where it turns back its rate may be at right angles to that at the start.
        section = Section((normal != 0.0).astype(np.float64), v, POWER, 1.0)

    def returned(passages: list[Passage]) -> bool:
        end, rate = passages[-1].q, passages[-1].v
        size = max(1.0, float(np.max(np.abs(v[:, 0]))))
        if at_rest:
            return distance(rate, np.zeros_like(rate), free) < CLOSED * size
        return distance(end, q, free) < CLOSED and distance(rate, v, range(len(v))) < CLOSED * size

    found = followed(arrays, (q, v), section, returned, FINE_ORDER, FINE_TOLERANCE)
    check = None if found is None else followed(arrays, (q, v), section, returned, CHECK_ORDER, CHECK_TOLERANCE)
    if found is None or check is None or len(found[1]) != len(check[1]):
        return None
    run, (*_, (time, end, rate)) = found
    if up_to_lost_rank(arrays, lines_that_may_depend(table, chosen), run).singular:
        return None
    other = check[1][-1]
    late = abs((time[0] - other.time[0]) + (time[1] - other.time[1])) + 2.0**-100 * abs(time[0])
    off = max(distance(end, other.q, range(len(q))), distance(rate, other.v, range(len(q)))) + 2.0**-98
    if late > UNCERTAIN * abs(time[0]):
        return None
    if at_rest:
        return Periodic(table, units, run, 2.0 * time, True, np.zeros((len(q), 2)), (2.0 * late, off))
    shift = np.zeros((len(q), 2))
    for i in range(len(q)):
        if i not in free:
            wound = _pair_difference(end[i], q[i])
            # What comes back only seems to wind on, by less than is known.
            shift[i] = wound if abs(wound[0]) > off else 0.0
    return Periodic(table, units, run, time, False, shift, (late, off))


def _conservative(table: Table) -> bool:
    """Return whether the one degree of freedom of a table is in a potential.

    In one degree of freedom every force by the place alone has a potential along the path; on a closed path that is
    another one after each round, which shows in the rate with which the motion comes back.
    """
    if any(one.rate for law in table.acting for one in law.inputs.values()) or "s" in table.units:
        return False
    if any(row.rate != 0 or row.drag for row in table.rows):
        return False
    zero = arb(0)
    return all(is_zero(x - table.stiffness.get((j, i), zero)) for (i, j), x in table.stiffness.items())


def _cyclic(table: Table, i: int) -> bool:
    """Return whether nothing depends on a coordinate: it only winds on."""
    if i in table.load or any(i in key for key in table.stiffness):
        return False
    if any(i in law.coordinates() for law in table.acting):
        return False
    return not any((i,) in poly for row in table.rows for poly in row.rates.values())


@kernel()
def _fold(
    starts: Floats,
    series: Floats,
    length: Floats,
    half: bool,
    shift: Floats,
    times: Floats,
    late: float,
    q: Floats,
    v: Floats,
    other: Floats,
    rate: Floats,
    counts: Floats,
) -> None:
    """Evaluate at times of shape (t,) by the time within the period.

    `other` and `rate` are the state as late as the period's uncertainty would have it, for a reference of what follows
    from the state: so little later that three terms of Taylor's series are more than enough.
    """
    n, order = series.shape[1], series.shape[2] - 1
    for s in range(times.shape[0]):
        count, th, tl = 0.0, times[s], 0.0
        # Quotients are rounded, so that a count may be one off, or many of a number that has no unit's digit.
        for _ in range(3):
            more = np.floor(th / length[0])
            count += more
            ph, pl = dd_mul_d(length[0], length[1], -more)
            th, tl = dd_add(th, tl, ph, pl)
        counts[s] = count
        later = (abs(count) + 1.0) * late
        back = half and th > 0.5 * length[0]
        if back:
            th, tl = dd_add(length[0], length[1], -th, -tl)
            later = -later
        low, high = 0, series.shape[0] - 1
        while low < high:
            middle = (low + high + 1) // 2
            if starts[middle, 0] <= th:
                low = middle
            else:
                high = middle - 1
        hh, hl = dd_add(th, tl, -starts[low, 0], -starts[low, 1])
        moved_pairs(series[low], hh, hl, q[s], v[s])
        for i in range(n):
            gain = 0.0
            for k in range(order, 1, -1):
                gain = gain * hh + k * (k - 1) * series[low, i, k, 0]
            moved = later * (v[s, i, 0] + 0.5 * later * gain)
            rate[s, i, 0], rate[s, i, 1] = dd_add_d(v[s, i, 0], v[s, i, 1], later * gain)
            if back:
                v[s, i, 0], v[s, i, 1] = -v[s, i, 0], -v[s, i, 1]
                rate[s, i, 0], rate[s, i, 1] = -rate[s, i, 0], -rate[s, i, 1]
            if shift[i, 0] != 0.0:
                ph, pl = dd_mul_d(shift[i, 0], shift[i, 1], count)
                q[s, i, 0], q[s, i, 1] = dd_add(q[s, i, 0], q[s, i, 1], ph, pl)
            other[s, i, 0], other[s, i, 1] = dd_add_d(q[s, i, 0], q[s, i, 1], moved)


@kernel()
def _rotate(turns: Floats, q: Floats) -> None:
    """Turn the first two coordinates of q, shape (t, n, 2), by cosines and sines of shape (t, 2, 2)."""
    for s in range(q.shape[0]):
        c, d = turns[s, 0], turns[s, 1]
        xh, xl, yh, yl = q[s, 0, 0], q[s, 0, 1], q[s, 1, 0], q[s, 1, 1]
        ah, al = dd_mul(xh, xl, c[0], c[1])
        bh, bl = dd_mul(yh, yl, d[0], d[1])
        q[s, 0, 0], q[s, 0, 1] = dd_add(ah, al, -bh, -bl)
        ah, al = dd_mul(xh, xl, d[0], d[1])
        bh, bl = dd_mul(yh, yl, c[0], c[1])
        q[s, 1, 0], q[s, 1, 1] = dd_add(ah, al, bh, bl)


def _pair_difference(first: Floats, second: Floats) -> tuple[float, float]:
    return added(first, (-second[0], -second[1]))


def _as_pair(ball: Ball) -> Pair:
    high = float(ball.mid())
    return high, float((ball - high).mid())
