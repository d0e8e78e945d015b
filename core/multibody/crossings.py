"""When a phase ends: the first time at which a gap, a force or a rate of slip changes its sign.

With constant accelerations everything watched is a polynomial in time, and its roots are found in balls. Otherwise it
is sampled along the motion, more closely where it comes near zero, and the root found by Taylor series in balls about a
time next to it.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Literal

import numpy as np
from flint import arb

from core.errors import AccuracyUnreachable, BudgetExceeded
from core.multibody.contact_states import PhaseTable, State
from core.multibody.expansion import Expansion, Series, expansion, slope, value
from core.multibody.measures import Force, Unilateral
from core.multibody.modelling import Modelled
from core.multibody.numerical import Numerical
from core.multibody.packed import Floats, two_to
from core.multibody.periods import Periodic
from core.multibody.polynomials import ZERO, Ball, constant, is_zero
from core.multibody.table import Rates, Table
from core.multibody.uniform import Uniform
from core.multibody.whole import values

ORDER = 8
"""Highest power of the Taylor series by which roots are located."""
_NOISE = 2.0**-44
"""Share of its terms below which the sign of something sampled in doubles is noise."""
_CLOSER = 33
_MOST_NARROWINGS = 8
"""Of the bracket of an event, by a factor of 32 each: bounces rise and fall in a small part of an interval."""
_EXACT = 2.0**-112
"""Share of a series' terms by which its last one may count where an event is located by it."""
_UNKNOWN = 2.0**-90
"""Share of its terms below which the value of something at the start of a phase is zero."""
_SOONEST = 1e-6
"""Share of the first interval in which a return to zero is looked for; sooner ones are told by the Taylor series."""
_MOST_NODES = 200_000
_ROUNDS = 12


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
        found.append(Watch(i, "push", one, 1, Force("", "N", [(row, constant(ZERO + 1))])))
        if slip is not None:
            for sense in (1, -1):
                terms = [(row, constant(one.static)), (slip, constant(ZERO + sense))]
                found.append(Watch(i, "grip", one, sense, Force("", "N", terms)))
        if state.sense:
            found.append(Watch(i, "slip", one, state.sense))
    return found


@dataclass(frozen=True)
class Crossing:
    """The end of a phase.

    Attributes
    ----------
    time : ball
        Since the start of the phase.
    watch : Watch or None
        What changed its sign; None at a singular place.
    q, v : list of ball
        State there.
    grazes : list of Watch
        What came as near to zero before as can be told.
    """

    time: Ball
    watch: Watch | None
    q: list[Ball]
    v: list[Ball]


def is_uniform(model: Modelled) -> bool:
    """Return whether nothing but constant accelerations is in a model."""
    return all(isinstance(motion, Uniform) or motion.name == "rest" for _, motion in model.whole.parts)


def uniform_motion(table: Table, model: Modelled) -> Expansion:
    """Return a motion with constant accelerations as an exact expansion, its multipliers constant."""
    start = expansion(table, 2)
    places = [[q, v, a / 2, ZERO, ZERO] for q, v, a in zip(table.q, table.v, model.whole.acceleration, strict=True)]
    return Expansion(places, [[x[0], ZERO, ZERO] for x in start.multipliers])


def state_of(motion: Expansion, time: Ball) -> tuple[list[Ball], list[Ball]]:
    """Return coordinates and rates of an expansion at a time."""
    return [value(x, time) for x in motion.places], [value(slope(x), time) for x in motion.places]


def first_in_closed_form(
    motion: Expansion, watched: Sequence[Watch], end: Ball
) -> tuple[Crossing | None, list[tuple[Watch, Ball]]]:
    """Return the first crossing before `end` of a motion with constant accelerations, and what only grazes zero."""
    best: Ball = None
    which: Watch | None = None
    grazes: list[tuple[Watch, Ball]] = []
    for watch in watched:
        if watch.what in ("push", "grip"):
            continue
        series = watch.series(motion)
        root, touched = first_negative(series, end)
        grazes.extend((watch, t) for t in touched)
        if root is not None and (best is None or root.mid() < best.mid()):
            best, which = root, watch
    if best is None or which is None:
        return None, grazes
    q, v = state_of(motion, best)
    return Crossing(best, which, q, v), [(w, t) for w, t in grazes if t < best]


def first_negative(series: Sequence[Ball], end: Ball) -> tuple[Ball | None, list[Ball]]:
    """Return the first positive time up to `end` at which a polynomial becomes negative, and where it touches zero.

    It is not negative just after zero; leading coefficients that are zero are.
    """
    rest = [ZERO if is_zero(x) else x for x in series]
    while rest and rest[-1] == 0:
        rest.pop()
    while rest and rest[0] == 0:
        rest.pop(0)
    if len(rest) < 2:
        return None, []
    touched: list[Ball] = []
    for root, sign in _changes(rest, end, touched):
        if sign < 0:
            return root, [t for t in touched if t < root]
    return None, touched


def _changes(p: Sequence[Ball], end: Ball, touched: list[Ball] | None = None) -> list[tuple[Ball, int]]:
    """Return the roots in (0, end] at which a polynomial changes its sign, with the sign that follows."""
    while p and is_zero(p[-1]):
        p = p[:-1]
    if len(p) < 2:
        return []
    if len(p) == 2:
        root = -p[0] / p[1]
        return [(root, 1 if p[1] > 0 else -1)] if root > 0 and not root > end else []
    if len(p) == 3:
        c, b, a = p
        discriminant = b * b - 4 * a * c
        if is_zero(discriminant):
            if touched is not None and -b / (2 * a) > 0 and not -b / (2 * a) > end:
                touched.append(-b / (2 * a))
            return []
        if discriminant < 0:
            return []
        # The larger root by a sum of equal signs, the other by the product of both.
        s = -(b + discriminant.sqrt()) / 2 if b > 0 else (discriminant.sqrt() - b) / 2
        pairs = [x for x in (s / a, c / s if not is_zero(s) else ZERO) if x > 0 and not x > end]
        return [(x, 1 if 2 * a * x + b > 0 else -1) for x in sorted(pairs, key=float)]
    turns = [t for t, _ in _changes(slope(p), end)]
    found = []
    low, sign = ZERO, _sign(p[0])
    for t in [*turns, end]:
        here = _sign(value(p, t))
        if here == 0 and t is not end and touched is not None:
            touched.append(t)
        if here and sign and here != sign:
            found.append((_between(p, low, t), here))
        if here:
            sign, low = here, t
    return found


def _sign(x: Ball) -> int:
    return 0 if is_zero(x) else 1 if x > 0 else -1


def _between(p: Sequence[Ball], low: Ball, high: Ball) -> Ball:
    """Return the only root between two times: bisected, then by Newton's method in balls."""
    a, b, rising = arb(low.mid()), arb(high.mid()), value(p, high) > 0
    for _ in range(60):
        middle = (a + b) / 2
        middle = arb(middle.mid())
        if (value(p, middle) > 0) == rising:
            b = middle
        else:
            a = middle
    root, derivative = arb(((a + b) / 2).mid()), slope(p)
    for _ in range(_ROUNDS):
        step = value(p, root) / value(derivative, root)
        root = arb((root - step).mid())
    off = abs(value(p, root) / value(derivative, root))
    return arb(root.mid(), 2 * float(off.upper()) + 2.0**-300 * abs(float(root)))


class Sampled:
    """A phase whose motion is sampled: finds its end on one track, and refines it on each."""

    def __init__(self, phase: PhaseTable, model: Modelled, watched: Sequence[Watch]) -> None:
        self.phase, self.model, self.watched = phase, model, list(watched)
        self.whole = model.whole

    def grid(self, end: float) -> tuple[Floats, float | None]:
        """Return times up to `end` between which nothing turns twice, and the time of a singular place."""
        singular: float | None = None
        motions = [motion for _, motion in self.whole.parts if motion.name != "rest"]
        for motion in motions:
            if isinstance(motion, Numerical):
                run = motion.run("fine", end * two_to(-motion.units.time))
                if run.singular:
                    reached = run.end * two_to(motion.units.time)
                    singular = reached if singular is None else min(singular, reached)
        end = end if singular is None else min(end, singular)
        nodes = [np.array([0.0, end])]
        for motion in motions:
            own = motion.nodes(end)
            if isinstance(motion, Periodic) and own[-1] < end:
                if len(motions) == 1 and not np.any(motion.shift):
                    end = float(own[-1])
                else:
                    count = math.ceil(end / own[-1])
                    if count * len(own) > _MOST_NODES:
                        raise BudgetExceeded(
                            "looks for events",
                            count * len(own),
                            _MOST_NODES,
                            path=("times",),
                            remedy="ask for a shorter time",
                        )
                    own = (np.arange(count)[:, None] * own[-1] + own[None, :]).ravel()
            nodes.append(own)
        times = np.unique(np.concatenate(nodes))
        return times[(times >= 0.0) & (times <= end)], singular

    def curves(self, times: Floats) -> tuple[Floats, Floats]:
        """Return everything watched at times, and below which size it is noise, each of shape (watches, t)."""
        q, v = self.whole.in_pairs(times)
        multipliers = None
        found, noise = np.empty((len(self.watched), len(times))), np.empty((len(self.watched), len(times)))
        for k, watch in enumerate(self.watched):
            if watch.what == "gap":
                found[k], size = values(watch.one.gap, q)
            elif watch.what == "slip":
                found[k], size = _rates(watch.one.slip or {}, q, v)
                found[k] *= watch.sense
            else:
                if multipliers is None:
                    multipliers = self.whole.multipliers(q, v)
                assert watch.force is not None
                found[k], size = self.whole.force(watch.force, q, v, multipliers)
                size = np.maximum(size, float(np.max(np.abs(multipliers), initial=0.0)))
            noise[k] = _NOISE * size
        return found, noise

    def first(self, end: float) -> tuple[float, Watch] | None:
        """Return about when and by what the phase ends; a singular place has no watch."""
        near = self._near_start()
        scale = max(
            [two_to(m.units.time) for _, m in self.whole.parts if isinstance(m, (Numerical, Periodic))] or [end]
        )
        before, reach = 0.0, min(end, 2.0 * scale)
        while True:
            times, singular = self.grid(reach)
            chosen = times[times >= before] if before else times
            hit = self._look(chosen) if len(chosen) > 1 else None
            if near is not None and (hit is None or near[0] < hit[0]) and near[0] <= times[-1]:
                return near
            if hit is not None:
                return hit
            if singular is not None:
                raise SingularPlace(singular)
            if times[-1] < reach or reach >= end:
                return None
            # One interval more, so that what turns at the seam is seen.
            before, reach = float(times[-3]) if len(times) > 3 else 0.0, min(end, 2.0 * reach)

    def _near_start(self) -> tuple[float, Watch] | None:
        """Return the first root that comes so soon that the start of its Taylor series tells it."""
        motion = expansion(self.phase.table, ORDER)
        noise = self.curves(np.zeros(1))[1][:, 0] * (_UNKNOWN / _NOISE)
        best: tuple[float, Watch] | None = None
        for watch, unknown in zip(self.watched, noise, strict=True):
            series = [0.0 if is_zero(x) else float(x.mid()) for x in watch.series(motion)]
            if abs(series[0]) <= unknown:
                series[0] = 0.0
            while series and series[0] == 0.0:
                series.pop(0)
            if len(series) < 3 or not series[0] > 0.0:
                continue
            guess = _first_of_quadratic(*series[:3])
            if guess is None or guess > 1e30 or guess < 1e-30:
                continue
            terms = [abs(x) * guess**k for k, x in enumerate(series)]
            if sum(terms[3:]) > 0.05 * max(terms[:3]):
                continue
            if best is None or guess < best[0]:
                best = guess, watch
        return best

    def _look(self, times: Floats) -> tuple[float, Watch] | None:
        found, noise = self.curves(times)
        best: tuple[float, Watch] | None = None
        for k, watch in enumerate(self.watched):
            f = found[k]
            lost = f < -noise[k]
            # What is zero at the start may be negative by rounding there.
            lost[0] = lost[0] and times[0] > 0.0
            fine, g, low = times, f, noise[k]
            first = int(np.argmax(lost)) if lost.any() else len(f)
            dips = self._dips(f, first)
            for i in dips:
                closer = np.linspace(times[i - 1], times[i + 1], 4 * _CLOSER)
                alone = Sampled(self.phase, self.model, [watch])
                h, small = (x[0] for x in alone.curves(closer))
                if (h < -small).any():
                    fine, g, low, first = closer, h, small, int(np.argmax(h < -small))
                    break
            if first == len(g) or first == 0:
                continue
            above = np.flatnonzero(g[:first] > low[:first])
            if not len(above):
                # It rises from zero and returns between two times, or was noise all the time.
                fine = times[0] + (fine[first] - times[0]) * np.geomspace(_SOONEST, 1.0, 4 * _CLOSER)
                g, low = (x[0] for x in Sampled(self.phase, self.model, [watch]).curves(fine))
                above = np.flatnonzero(g > low)
                if not len(above):
                    continue
                first = int(above[0]) + int(np.argmax(g[above[0] :] < -low[above[0] :]))
                above = above[above < first]
            start = int(above[-1])
            for narrowing in range(_MOST_NARROWINGS):
                # Newton's method needs a start on the falling side of a curve that may have risen before.
                fine = np.linspace(fine[start], fine[first], _CLOSER)
                g, low = (x[0] for x in Sampled(self.phase, self.model, [watch]).curves(fine))
                below = g < -low
                first = int(np.argmax(below)) if below.any() else _CLOSER - 1
                start = max(first - 1, 0)
                if narrowing > 0 and start > 0 and g[start] <= g[start - 1]:
                    break
            a, b = g[start], g[first]
            guess = fine[start] + (fine[first] - fine[start]) * (a / (a - b) if a > 0 else 0.5)
            if best is None or guess < best[0]:
                best = float(guess), watch
        return best

    @staticmethod
    def _dips(f: Floats, until: int) -> list[int]:
        """Return where a parabola through three samples comes near zero."""
        if len(f) < 3:
            return []
        left, middle, right = f[:-2], f[1:-1], f[2:]
        bend = left - 2 * middle + right
        with np.errstate(divide="ignore", invalid="ignore"):
            lowest = middle - (right - left) ** 2 / (8 * bend)
            low = (middle <= left) & (middle <= right) & (bend > 0) & (lowest < 0.5 * np.abs(middle))
        return [int(i) + 1 for i in np.flatnonzero(low) if i + 1 < until]

    def refined(self, watch: Watch, time: float, kind: str) -> Crossing:
        """Return the crossing next to a time, by Taylor series about it."""
        for _ in range(_ROUNDS):
            motion = self.expanded(time, kind)
            series = watch.series(motion)
            derivative = slope(series)
            step: Ball = ZERO
            for _ in range(_ROUNDS):
                change = value(series, step) / value(derivative, step)
                step = arb((step - change).mid()) if change.is_finite() else ZERO
            moved = float(step)
            if not math.isfinite(moved):
                break
            if _cut_off(motion, self.phase.table.units, moved) < _EXACT:
                q, v = state_of(motion, step)
                return Crossing(arb(time) + step, watch, q, v)
            time = max(time + moved, 0.5 * time)
        raise AccuracyUnreachable(
            None,
            1.0,
            f'the event of "{watch.one.name}" near {time:.6g} s of its phase cannot be located',
            path=("times",),
        )

    def expanded(self, time: float, kind: str) -> Expansion:
        """Return the Taylor series about a time of the phase."""
        q, v = self.whole.in_pairs(np.array([time]), kind)
        table = self.phase.table
        old = table.q, table.v
        table.q = [arb(float(x[0])) + arb(float(x[1])) for x in q[0]]
        table.v = [arb(float(x[0])) + arb(float(x[1])) for x in v[0]]
        try:
            return expansion(table, ORDER)
        finally:
            table.q, table.v = old


def _cut_off(motion: Expansion, units: Sequence[str], step: float) -> float:
    """Return the last term of every series at a step, relative to the largest term of its unit."""
    last: dict[str, float] = {}
    largest: dict[str, float] = {}
    for unit, series in zip(units, motion.places, strict=True):
        terms = [abs(float(x.mid())) * abs(step) ** k for k, x in enumerate(series)]
        last[unit] = max(last.get(unit, 0.0), terms[-1])
        largest[unit] = max(largest.get(unit, 0.0), *terms)
    return max((last[unit] / x for unit, x in largest.items() if x > 0.0), default=0.0)


def _first_of_quadratic(c: float, b: float, a: float) -> float | None:
    """Return the first positive root of c + b t + a t^2 with c > 0, None without one."""
    discriminant = b * b - 4.0 * a * c
    if discriminant < 0.0 or (a == 0.0 and b >= 0.0):
        return None
    s = -(b + math.copysign(math.sqrt(discriminant), b)) / 2.0
    roots = [x for x in ((s / a if a != 0.0 else 0.0), (c / s if s != 0.0 else 0.0)) if x > 0.0]
    return min(roots, default=None)


class SingularPlace(Exception):
    """The connections lose their hold at a time of the phase."""

    def __init__(self, time: float) -> None:
        super().__init__(time)
        self.time = time


def _rates(line: Rates, q: Floats, v: Floats) -> tuple[Floats, Floats]:
    total, size = np.zeros(len(q)), np.zeros(len(q))
    for j, poly in line.items():
        factor, factor_size = values(poly, q)
        total = total + factor * v[:, j, 0]
        size = size + factor_size * np.abs(v[:, j, 0])
    return total, size
