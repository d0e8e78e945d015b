"""About when a phase ends whose motion is known by samples: what is watched is sampled more closely near zero."""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np

from core.arrays import Floats
from core.multibody.algebra.polynomials import LinearForm, evaluated, is_zero
from core.multibody.equations.expansion import expansion
from core.multibody.equations.packed import two_to
from core.multibody.equations.polynomial_roots import first_of_quadratic
from core.multibody.motion.modes import Modes
from core.multibody.motion.motion import check_sample_count
from core.multibody.motion.numerical import Numerical
from core.multibody.motion.periods import Periodic
from core.multibody.motion.turning import Turning
from core.multibody.motion.vertical_symmetry import Shifted
from core.multibody.motion.whole import Whole, values
from core.multibody.phases.taylor_crossings import ORDER
from core.multibody.phases.tracks import SAFETY_FACTOR
from core.multibody.phases.watches import Watch
from core.multibody.table.table import Table
from core.multibody.trajectory.turns import closer_at_ends, dips

_NOISE = 2.0**-44
"""Share of its terms below which the sign of something sampled in doubles is noise."""
_ROUNDED = 2.0**-46
"""Share of its largest terms that is noise where the motion itself is in doubles, of which terms may cancel."""
_CLOSER = 33
"""Samples of an interval that is looked at again."""
_MOST_NARROWINGS = 8
"""Of the bracket of an event, by a factor of 32 each: bounces rise and fall in a small part of an interval."""
KNOWN = 2.0**-46
"""Share of the noise of doubles below which a value that is known in pairs is zero."""
_HALVINGS = 20
_SOONEST = 2.0**-_HALVINGS
"""Share of the first interval in which a return to zero is looked for; sooner ones are told by the Taylor series."""
_MOST_NODES = 200_000


class SingularPlace(Exception):
    """The connections lose their hold at a time of the phase."""

    def __init__(self, time: float) -> None:
        super().__init__(time)
        self.time = time


class Sampled:
    """A phase whose motion is sampled to find about when it ends.

    Parameters
    ----------
    table : Table
        Of the phase.
    whole : Whole
        Its motion.
    watched : sequence of Watch
    other : Table, optional
        Of another computation of the same phase: what they differ by at the start is not known.
    """

    def __init__(self, table: Table, whole: Whole, watched: Sequence[Watch], other: Table | None = None) -> None:
        self.table, self.whole, self.watched, self.other = table, whole, list(watched), other

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
            if own[-1] < end:
                # It repeats, unless each period turns it about the vertical, or something only winds on.
                inner = motion.motion if isinstance(motion, Shifted) else motion
                winds = isinstance(inner, Periodic) and (inner.winding != 0.0 or bool(np.any(inner.shift)))
                if len(motions) == 1 and not winds:
                    # Two intervals of the next period, so that what turns where one ends is seen.
                    own = np.append(own, own[-1] + own[1:3])
                    end = min(end, float(own[-1]))
                else:
                    periods = end / own[-1] if own[-1] > 0.0 else math.inf
                    check_sample_count((periods + 1.0) * len(own), _MOST_NODES)
                    own = (np.arange(math.ceil(periods))[:, None] * own[-1] + own[None, :]).ravel()
            nodes.append(own)
        times = np.unique(np.concatenate(nodes))
        return times[(times >= 0.0) & (times <= end)], singular

    def curves(self, times: Floats) -> tuple[Floats, Floats]:
        """Return everything watched at times, and below which size it is noise, each of shape (watches, t)."""
        q, v, in_doubles = self.whole.in_doubles(times)
        multipliers = None
        found, noise = np.empty((len(self.watched), len(times))), np.empty((len(self.watched), len(times)))
        for k, watch in enumerate(self.watched):
            if watch.what == "gap":
                found[k], size = values(watch.one.gap, q)
            elif watch.what == "slip":
                found[k], size = rates_along(watch.one.slip or {}, q, v)
                found[k] *= watch.sense
            else:
                if multipliers is None:
                    multipliers = self.whole.multipliers(q, v)
                assert watch.force is not None
                found[k], size = self.whole.force(watch.force, q, v, multipliers)
                if watch.rubs:
                    rubs = [self.whole.force(rub, q, v, multipliers)[0] for rub in watch.rubs]
                    found[k] -= np.hypot(*rubs)
                size = np.maximum(size, float(np.max(np.abs(multipliers), initial=0.0)))
            noise[k] = _NOISE * size
            if in_doubles:
                noise[k] += _ROUNDED * np.max(size, initial=0.0)
        return found, noise

    def first(self, end: float) -> tuple[float, Watch] | None:
        """Return about when and by what the phase ends; a singular place has no watch."""
        near = self._near_start()
        motions = [motion for _, motion in self.whole.parts]
        scales = [2.0 * two_to(motion.units.time) for motion in motions if isinstance(motion, (Numerical, Periodic))]
        # Later states of what turns are evaluated in balls, which takes a hundred times as long.
        ends = [motion.in_doubles_until for motion in motions if isinstance(motion, (Modes, Turning))]
        before, reach = 0.0, min(end, max(scales) if scales else min(ends, default=end))
        while True:
            times, singular = self.grid(reach)
            # A motion followed further has other steps: without the time before, there would be a gap at the seam.
            chosen = closer_at_ends(times[max(int(np.searchsorted(times, before, side="right")) - 1, 0) :], _HALVINGS)
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
        motion = expansion(self.table, ORDER)
        noise = np.maximum(self.curves(np.zeros(1))[1][:, 0] * KNOWN, [self._apart(watch) for watch in self.watched])
        best: tuple[float, Watch] | None = None
        for watch, unknown in zip(self.watched, noise, strict=True):
            series = [0.0 if is_zero(x) else float(x.mid()) for x in watch.series(motion)]
            if abs(series[0]) <= unknown:
                series[0] = 0.0
            while series and series[0] == 0.0:
                series.pop(0)
            if len(series) < 3 or not series[0] > 0.0:
                continue
            guess = first_of_quadratic(*series[:3])
            if guess is None or guess > 1e30 or guess < 1e-30:
                continue
            terms = [abs(x) * guess**k for k, x in enumerate(series)]
            if sum(terms[3:]) > 0.05 * max(terms[:3]):
                continue
            if best is None or guess < best[0]:
                best = guess, watch
        return best

    def _apart(self, watch: Watch) -> float:
        """Return by how much a gap at the start is wrong, as two computations say."""
        if self.other is None or watch.what != "gap":
            return 0.0
        gap = watch.one.gap
        return SAFETY_FACTOR * abs(float(evaluated(gap, self.table.q) - evaluated(gap, self.other.q)))

    def _look(self, times: Floats) -> tuple[float, Watch] | None:
        """Return about when and what first becomes negative between times."""
        found, noise = self.curves(times)
        best: tuple[float, Watch] | None = None
        for watch, curve, low in zip(self.watched, found, noise, strict=True):
            guess = Sampled(self.table, self.whole, [watch])._first_loss(times, curve, low)
            if guess is not None and (best is None or guess < best[0]):
                best = guess, watch
        return best

    def _closer(self, start: float, end: float, count: int) -> tuple[Floats, Floats, Floats]:
        """Return times between two, with the only curve there and its noise."""
        fine = np.linspace(start, end, count)
        curve, noise = (x[0] for x in self.curves(fine))
        return fine, curve, noise

    def _first_loss(self, times: Floats, curve: Floats, noise: Floats) -> float | None:
        """Return about when the only curve becomes negative, None if it does not."""
        lost = curve < -noise
        # What is zero at the start may be negative by rounding there.
        lost[0] = lost[0] and times[0] > 0.0
        first = int(np.argmax(lost)) if lost.any() else len(curve)
        low = np.flatnonzero(dips(times, curve) < 0.5 * np.abs(curve))
        for i in low[low < first]:
            closer = self._closer(times[i - 1], times[i + 1], 4 * _CLOSER)
            if (closer[1] < -closer[2]).any():
                start, (times, curve, noise) = times[0], closer
                first = int(np.argmax(curve < -noise))
                break
        else:
            start = times[0]
        if first in (0, len(curve)):
            return None
        above = np.flatnonzero(curve[:first] > noise[:first])
        if not len(above):
            # It rises from zero and returns between two times, or was noise all the time.
            times = start + (times[first] - start) * np.geomspace(_SOONEST, 1.0, 4 * _CLOSER)
            curve, noise = (x[0] for x in self.curves(times))
            above = np.flatnonzero(curve > noise)
            if not len(above):
                return None
            first = int(above[0]) + int(np.argmax(curve[above[0] :] < -noise[above[0] :]))
            above = above[above < first]
        before = int(above[-1])
        for narrowing in range(_MOST_NARROWINGS):
            # Newton's method needs a start on the falling side of a curve that may have risen before.
            times, curve, noise = self._closer(times[before], times[first], _CLOSER)
            below = curve < -noise
            first = int(np.argmax(below)) if below.any() else _CLOSER - 1
            before = max(first - 1, 0)
            if narrowing > 0 and before > 0 and curve[before] <= curve[before - 1]:
                break
        a, b = curve[before], curve[first]
        return float(times[before] + (times[first] - times[before]) * (a / (a - b) if a > 0 else 0.5))


def rates_along(line: LinearForm, q: Floats, v: Floats) -> tuple[Floats, Floats]:
    """Return a linear form in the rates at states, and how large its terms are."""
    total, size = np.zeros(len(q)), np.zeros(len(q))
    for j, poly in line.items():
        factor, factor_size = values(poly, q)
        total = total + factor * v[:, j, 0]
        size = size + factor_size * np.abs(v[:, j, 0])
    return total, size
