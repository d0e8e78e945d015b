"""Two degrees of freedom that are symmetric about the vertical: spherical pendulums, and tops by their axis.

The test is written for the gyroscopic terms too: every term of the table has to be unchanged by a turn about the
vertical through the centre of the one quadratic measure.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from flint import arb

from core.arrays import Floats
from core.double_double import dd_add, dd_sub
from core.multibody.algebra.directions import polar_angle
from core.multibody.algebra.polynomials import ONE, ZERO, Ball, Poly, entry, is_zero
from core.multibody.equations.packed import packed, pair, state, two_to, units_of
from core.multibody.motion.motion import Motion, States
from core.multibody.motion.periods import UNCERTAIN, Periodic
from core.multibody.motion.returns import RATES, Passage, Section, distance, followed
from core.multibody.motion.series_run import CHECK_ORDER, CHECK_TOLERANCE, FINE_ORDER, FINE_TOLERANCE
from core.multibody.table.table import Table


@dataclass(frozen=True)
class Steady(Motion):
    """The height stays, and the rest turns about the vertical at a constant rate."""

    table: Table
    rate: Ball
    name: str = "steady precession"
    why: str = "the motion is symmetric about the vertical, and its height is in equilibrium"
    how: str = "closed form"

    @property
    def period(self) -> Ball | None:
        """Time of one turn."""
        return 2 * arb.pi() / abs(self.rate)

    @property
    def winding(self) -> float:
        """Angle of a period."""
        return math.copysign(2 * math.pi, float(self.rate))

    @property
    def winding_error(self) -> float:
        """Error of that angle: the rounding of a whole turn."""
        return math.ulp(2 * math.pi)

    def states(self, times: Floats, *, finer: bool = False) -> States:
        """Return the start, turned."""
        q, v = np.zeros((len(times), 3, 2)), np.zeros((len(times), 3, 2))
        x, y, z = self.table.q
        for s, t in enumerate(times):
            sine, cosine = (self.rate * float(t)).sin_cos()
            a, b = x * cosine - y * sine, x * sine + y * cosine
            q[s] = [pair(a, 0), pair(b, 0), pair(z, 0)]
            v[s, :2] = [pair(-self.rate * b, 0), pair(self.rate * a, 0)]
        return States(q, v, np.abs(q[..., 0]) * 2.0**-100, np.abs(v[..., 0]) * 2.0**-100)

    def nodes(self, end: float) -> Floats:
        """Return eight times to a radian, over one turn or up to `end`."""
        return np.linspace(0.0, math.copysign(min(abs(end), float(self.period or math.inf)), end), 65)


@dataclass(frozen=True)
class Shifted(Motion):
    """A motion about a vertical that does not pass through the origin."""

    motion: Periodic | Steady
    centre: tuple[Ball, Ball]

    @property
    def name(self) -> str:
        """The model."""
        return self.motion.name

    @property
    def why(self) -> str:
        """What made it suffice."""
        return self.motion.why

    @property
    def how(self) -> str:
        """How errors are stated."""
        return self.motion.how

    @property
    def period(self) -> Ball | None:
        """The period in seconds."""
        return self.motion.period

    @property
    def winding(self) -> float:
        """Angle of precession in a period (rad)."""
        return self.motion.winding

    @property
    def winding_error(self) -> float:
        """Error of that angle (rad)."""
        return self.motion.winding_error

    @property
    def winds_on(self) -> bool:
        """Whether a period turns it about the vertical."""
        return self.motion.winds_on

    def states(self, times: Floats, *, finer: bool = False) -> States:
        """Return the states of the motion about its own vertical, moved back."""
        found = self.motion.states(times, finer=finer)
        for i, c in enumerate(self.centre):
            high, low = pair(c, 0)
            for q in (found.q,) if found.reference is None else (found.q, found.reference[0]):
                for s in range(len(times)):
                    q[s, i] = dd_add(q[s, i, 0], q[s, i, 1], high, low)
        return found

    def nodes(self, end: float) -> Floats:
        """Return times close enough for events."""
        return self.motion.nodes(end)


def precessing(table: Table, acceleration: Sequence[Ball], chosen: Sequence[int]) -> Periodic | Steady | Shifted | None:
    """Return the motion of a part with symmetry about the vertical and two degrees of freedom, if it is one."""
    centre = _centre(table, chosen)
    if centre is None:
        return None
    shifted = not all(is_zero(c) for c in centre)
    if shifted:
        expressions: list[Poly] = [
            {(i,): ONE, **({(): centre[i]} if i < 2 and not is_zero(centre[i]) else {})} for i in range(3)
        ]
        moved = table.changed(expressions, range(3))
        moved.q = [table.q[0] - centre[0], table.q[1] - centre[1], table.q[2]]
        table = moved
    if not _invariant(table):
        return None
    z_rate, z_gain = table.v[2], acceleration[2]
    if is_zero(z_rate) and is_zero(z_gain):
        radius = table.q[0] * table.q[0] + table.q[1] * table.q[1]
        turning = table.q[0] * table.v[1] - table.q[1] * table.v[0]
        if is_zero(radius) or is_zero(turning):
            return None
        steady = Steady(table, turning / radius)
        return Shifted(steady, centre) if shifted else steady
    units = units_of(table, acceleration)
    arrays = packed(table, chosen, units)
    start = state(table, units)
    # The height turns back at an extreme, and there again a period later.
    resting = is_zero(z_rate)
    sign = math.copysign(1.0, float(z_gain if resting else z_rate))
    section = Section(np.array([0.0, 0.0, 1.0]), np.zeros((3, 2)), RATES, sign)
    count = 2 if resting else 3

    def returned(passages: list[Passage]) -> bool:
        return len(passages) == count

    found = followed(arrays, start, section, returned, FINE_ORDER, FINE_TOLERANCE)
    check = None if found is None else followed(arrays, start, section, returned, CHECK_ORDER, CHECK_TOLERANCE)
    if found is None or check is None:
        return None
    run, passages = found
    first = Passage(np.zeros(2), *start) if resting else passages[0]
    other = Passage(np.zeros(2), *start) if resting else check[1][0]
    last, other_last = passages[-1], check[1][-1]
    time, other_time = _between(first, last), _between(other, other_last)
    size = max(1.0, float(np.max(np.abs(start[1][:, 0]))))
    if abs(float(last.q[2, 0] - first.q[2, 0])) > 1e-12 or abs(other_time[0] - time[0]) > UNCERTAIN * time[0]:
        return None
    late = abs((time[0] - other_time[0]) + (time[1] - other_time[1])) + 2.0**-100 * time[0]
    off = size * 2.0**-96 + max(distance(last.q, other_last.q, range(3)), distance(last.v, other_last.v, range(3)))
    turned = _angle((first.q, first.v), (last.q, last.v))
    apart = abs(turned - _angle((other.q, other.v), (other_last.q, other_last.v)))
    motion = Periodic(table, units, run, time, False, np.zeros((3, 2)), (late, 4.0 * off), turned)
    motion.why = "the motion is symmetric about the vertical: its height repeats, and each period turns it further"
    winding = _unwrapped(motion, float(turned))
    if winding is None:
        return None
    motion.winding = winding
    # As of the state, what the two runs differ by; and the rounding of the angle and of its full turns.
    reach = math.hypot(*first.q[:2, 0], *first.v[:2, 0])
    motion.winding_error = float(apart.upper()) + 4.0 * off / reach + 2.0 * math.ulp(winding)
    return Shifted(motion, centre) if shifted else motion


def _centre(table: Table, chosen: Sequence[int]) -> tuple[Ball, Ball] | None:
    """Return the vertical about which the one measure of a triple of coordinates is symmetric."""
    names = [name.rpartition(".") for name in table.names]
    if [entry[2] for entry in names] != ["x", "y", "z"] or len({entry[0] for entry in names}) != 1 or len(chosen) != 1:
        return None
    measure = table.rows[chosen[0]].measure
    if measure is None or table.rows[chosen[0]].rate != 0 or len(table.rows) != 1:
        return None
    a, b = entry(measure, (0, 0)), entry(measure, (1, 1))
    if is_zero(a) or not is_zero(a - b) or any(key in measure for key in ((0, 1), (0, 2), (1, 2))):
        return None
    return -entry(measure, (0,)) / (2 * a), -entry(measure, (1,)) / (2 * a)


def _invariant(table: Table) -> bool:
    """Return whether no term of a table of (x, y, z) changes by a turn about z."""

    def same(entries: dict[tuple[int, int], Ball], sign: int) -> bool:
        def get(i: int, j: int) -> Ball:
            return entry(entries, (i, j))

        apart = [get(0, 2), get(2, 0), get(1, 2), get(2, 1), get(0, 0) - get(1, 1), get(0, 1) - sign * get(1, 0)]
        return all(is_zero(x) for x in apart)

    mass = {**table.mass, **{(j, i): x for (i, j), x in table.mass.items()}}
    if not same(mass, 1) or (0, 1) in table.mass:
        return False
    if not is_zero(entry(table.load, 0)) or not is_zero(entry(table.load, 1)):
        return False
    if not same(table.stiffness, 1) or (0, 1) in table.stiffness:
        return False
    if not same(table.damping, -1) or (0, 0) in table.damping or (2, 2) in table.damping:
        return False
    if not table.gyration:
        return True
    p = entry(table.gyration, (0, 1, 2))
    cyclic = {(0, 1, 2), (1, 2, 0), (2, 0, 1)}
    return (
        all(is_zero(x - p) if key in cyclic else is_zero(x + p) for key, x in table.gyration.items())
        and len(table.gyration) == 6
        and all(len(set(key)) == 3 for key in table.gyration)
    )


def _between(first: Passage, last: Passage) -> Floats:
    high, low = dd_sub(last.time[0], last.time[1], first.time[0], first.time[1])
    return np.array([high, low])


def _angle(start: tuple[Floats, Floats], end: tuple[Floats, Floats]) -> Ball:
    """Return the angle by which a period turns place and velocity about the vertical."""
    cosine, sine = ZERO, ZERO
    for before, after in zip(start, end, strict=True):
        x, y, u, w = (arb(p[0]) + arb(p[1]) for p in (before[0], before[1], after[0], after[1]))
        cosine = cosine + x * u + y * w
        sine = sine + x * w - y * u
    return polar_angle(cosine, sine)


def _unwrapped(motion: Periodic, angle: float) -> float | None:
    """Return the angle of a period with its full turns, followed along the period; None beyond the range of doubles."""
    length = float(motion.length[0]) * two_to(motion.units.time)
    with np.errstate(over="ignore", invalid="ignore"):
        found = replace(motion, turned=None).states(np.linspace(0.0, length * (1 - 1e-12), 513))
    if not np.isfinite(found.q).all():
        return None
    azimuth = np.unwrap(np.arctan2(found.q[:, 1, 0], found.q[:, 0, 0]))
    gone = float(azimuth[-1] - azimuth[0])
    return angle + 2 * math.pi * round((gone - angle) / (2 * math.pi))
