"""The motion of a part by its Taylor series: doubles, judged by pairs of doubles, or the pairs themselves."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from functools import cached_property

import numpy as np

from core.arrays import Floats, Integers
from core.errors import AccuracyUnreachable, BudgetExceeded
from core.multibody.algebra.polynomials import Ball
from core.multibody.equations.packed import Packed, Units, packed, state, two_to, units_of
from core.multibody.motion.lost_rank import lines_that_may_depend, up_to_lost_rank
from core.multibody.motion.motion import Motion, States
from core.multibody.motion.other_rows import rows_for
from core.multibody.motion.run import MOST_STEPS, Run, evaluate
from core.multibody.motion.series import placed
from core.multibody.motion.series_run import integrate
from core.multibody.motion.stiff import MANY, limiting_oscillation, rates_of_decay
from core.multibody.table.table import Table

_SAME_PLACE = 1e-3
"""Relative difference of the times at which doubles and pairs may meet one singular place."""

SINGULAR_TIME_ERROR = 1e-9
"""Relative error of the time of a singular place: steps end where they are shorter than 1e-12 of the time reached, and
a thousand such steps are a margin for what is left to the place."""

BEFORE_SINGULAR = 1.0 - SINGULAR_TIME_ERROR
"""Share of the time of a singular place up to which the motion is followed."""

COLLIDED = 2.0**13
"""Inverse of a distance, in units of the scene, from which on a singular place is a collision: distances fall as the
power 2/3 of the time that is left, to 1e-8 where steps are the shortest, and are of the order of one elsewhere."""

DOUBLES_SHARE, FINE_SHARE = 2.0**-10, 2.0**-4
"""Largest error of a reference's coordinates, as a share of the largest that it finds: of doubles, and of pairs."""
ALIKE_MARGIN = 16.0
"""Factor of the difference of two runs in pairs that are of about the same accuracy."""

FINE_MARGIN, GROWTH = 4.0, 2.0**-50
"""Factor of the difference of two runs in pairs, and share of the errors of doubles, which tell how rounding grows."""


@dataclass
class Numerical(Motion):
    """A part that has no closed form.

    Attributes
    ----------
    chosen : sequence of int
        The rows of the table that are in the arrays.
    rows : ndarray of int
        Numbers, among these, of those that may come to depend on one another.
    """

    table: Table
    chosen: Sequence[int]
    units: Units
    name: str = "Taylor series"
    why: str = "several degrees of freedom are coupled by quadratic terms"
    how: str = "measured against pairs"
    period: Ball | None = None
    lost_to_doubles: bool = False
    rows: Integers = field(default_factory=lambda: np.zeros(0, np.int64))
    _turns: str = field(default="", repr=False)
    _runs: dict[tuple[str, int], Run] = field(default_factory=dict, repr=False)
    _met: list[Floats] = field(default_factory=list, repr=False)

    @classmethod
    def of(cls, table: Table, acceleration: Sequence[Ball], chosen: Sequence[int], why: str) -> Numerical:
        """Return the motion of a table in its own units."""
        units = units_of(table, acceleration)
        rows = lines_that_may_depend(table, chosen)
        return cls(table, chosen, units, why=why, rows=rows)

    @cached_property
    def arrays(self) -> Packed:
        """Its table for compiled code."""
        return packed(self.table, self.chosen, self.units)

    def keep_to_pairs(self) -> None:
        """Have it answered by pairs, judged by a coarser run in pairs."""
        self.lost_to_doubles = True

    @property
    def in_arrays(self) -> tuple[Packed, Units]:
        """Its table and units for compiled code."""
        return self.arrays, self.units

    def run(self, kind: str, end: float) -> Run:
        """Return steps to a time in the units of the arrays: "doubles", "reference", "fine" or "check"."""
        key = (kind, 1 if end >= 0.0 else -1)
        found = self._runs.get(key)
        if found is not None and (abs(found.end) >= abs(end) or found.singular):
            return found
        try:
            self._runs[key] = self.steps(kind, end, found)
        except BudgetExceeded as fault:
            oscillation = self._oscillation(end, MOST_STEPS)
            if oscillation:
                fault.remedy = f"{fault.remedy}, or put a rod in the place of the stiffest spring: {oscillation}"
            raise
        steps = len(self._runs[key].series)
        if steps > MANY and not self._turns:
            self._turns = self._oscillation(end, steps)
            self.why = "; ".join(filter(None, (self.why, self._turns)))
        return self._runs[key]

    @cached_property
    def rates_at_start(self) -> Floats | None:
        """Eigenvalues of the motion beside the start; see `rates_of_decay`."""
        return rates_of_decay(self.arrays, *state(self.table, self.units))

    def _oscillation(self, end: float, steps: int) -> str:
        """Return what oscillates so fast that it takes most of the steps to a time; empty where nothing does."""
        springs = self.table.stiffness or self.table.acting
        frequency = limiting_oscillation(self.rates_at_start, end, steps) if springs else None
        if frequency is None:
            return ""
        return f"what oscillates at {frequency * two_to(-self.units.time):.3g} rad/s is followed turn by turn"

    def steps(self, kind: str, end: float, since: Run | None = None) -> Run:
        """Take steps to a time in the units of the arrays, from the start, or on from a run that does not reach it."""
        if since is not None and since.series.ndim == 4:
            # Searches go on and on: what they have behind them is not computed again. The series of doubles do not
            # hold what their compensated sums left.
            more = self.followed(kind, end, since)
            if more.starts[-1, 0] != more.starts[0, 0]:
                found = since.followed_by(up_to_lost_rank(self.arrays, self.rows, more))
                return self.steps(kind, end) if found.singular and self._takes_other_rows(found) else found
        found = up_to_lost_rank(self.arrays, self.rows, self.followed(kind, end))
        return self.steps(kind, end) if found.singular and self._takes_other_rows(found) else found

    def followed(self, kind: str, end: float, since: Run | None = None) -> Run:
        """Take steps to a time wherever rows keep their rank."""
        return integrate(self.table, self.arrays, self.units, kind, end, since)

    def _takes_other_rows(self, run: Run) -> bool:
        """Take rows that keep their rank where a run ends, and before where others did; return whether there are."""
        count, table = len(self.arrays.rate), self.table
        if count == len(table.rows):
            return False
        met = [*(self._met or [np.array([float(x) for x in table.q])])]
        met.append(evaluate(run, np.array([run.end]))[0][0, :, 0] * self.units.up)
        chosen = rows_for(table, count, met)
        if chosen is None:
            return False
        # Runs by other rows differ by rounding, and are made anew.
        self._met, self.rows = met, lines_that_may_depend(table, chosen)
        self.chosen, self.arrays = chosen, packed(table, chosen, self.units)
        self._runs.clear()
        return True

    def states(self, times: Floats, *, finer: bool = False) -> States:
        """Return the states, and how far they are from a run in pairs."""
        names = ("fine", "check") if finer or self.lost_to_doubles else ("doubles", "reference")
        (q, v), (other, rate) = (self.by(kind, times) for kind in names)
        share, factor = self.margins(names[0])
        q_error, v_error = (factor * self._apart(a, b, share) for a, b in ((q, other), (v, rate)))
        if finer and factor < ALIKE_MARGIN:
            coarse = self.states(times)
            q_error = FINE_MARGIN * q_error + GROWTH * coarse.q_error
            v_error = FINE_MARGIN * v_error + GROWTH * coarse.v_error
        return States(q, v, q_error, v_error, (other, rate))

    def margins(self, kind: str) -> tuple[float, float]:
        """Return the share of the largest difference from its reference that each coordinate may miss beside its own.

        And by what all differences are multiplied.
        """
        return DOUBLES_SHARE if kind == "doubles" else FINE_SHARE, ALIKE_MARGIN if self.lost_to_doubles else 1.0

    def _apart(self, first: Floats, second: Floats, share: float) -> Floats:
        """Return differences of places or rates, shape (t, n), with a share of the largest of all coordinates."""
        up = self.units.up
        each = np.abs((first[..., 0] - second[..., 0]) + (first[..., 1] - second[..., 1]))
        # Where the difference of one coordinate passes through zero, the reference's own error is larger.
        found: Floats = each + share * np.max(each / up, axis=1, initial=0.0, keepdims=True) * up
        return found

    def by(self, kind: str, times: Floats) -> tuple[Floats, Floats]:
        """Return coordinates and rates by one kind of run, each of shape (t, n, 2)."""
        n = len(self.table.names)
        scaled = np.asarray(times, dtype=np.float64) * two_to(-self.units.time)
        q, v = np.zeros((len(times), n, 2)), np.zeros((len(times), n, 2))
        for way in (scaled >= 0.0, scaled < 0.0):
            if np.any(way):
                chosen = scaled[way]
                farthest = float(chosen[np.argmax(np.abs(chosen))])
                run = self.run(kind, farthest)
                if run.singular and abs(farthest) > (1.0 + _SAME_PLACE) * abs(run.end):
                    # A coarser run steps across a place that this one meets.
                    raise AccuracyUnreachable(
                        None,
                        np.inf,
                        f"the connections lose their hold at {run.end * two_to(self.units.time):.6g} s, where motions "
                        "beside this one branch",
                        path=("times",),
                        remedy="ask for earlier times",
                    )
                q[way], v[way] = evaluate(run, chosen)
        up = self.units.up[None, :, None]
        return q * up, v * up * two_to(-self.units.time)

    def places_in_doubles(self, times: Floats) -> Floats:
        """Return coordinates alone, shape (t, n), without a reference: enough to count turns."""
        scaled = np.asarray(times, dtype=np.float64) * two_to(-self.units.time)
        run = self.run("fine" if self.lost_to_doubles else "doubles", float(scaled[np.argmax(np.abs(scaled))]))
        if run.series.ndim == 3:
            q = np.empty((len(times), run.series.shape[1]))
            placed(run.starts, run.series, np.ascontiguousarray(scaled), run.which(scaled), q)
        else:
            q = evaluate(run, scaled)[0][..., 0]
        found: Floats = q * self.units.up
        return found

    def nodes(self, end: float) -> Floats:
        """Return two times a step, in which nothing turns by more than some two radians."""
        run = self.run("fine" if self.lost_to_doubles else "doubles", end * two_to(-self.units.time))
        starts = run.starts[:, 0] * two_to(self.units.time)
        if not np.isfinite(starts).all():
            raise AccuracyUnreachable(None, np.inf, "the motion leaves the range of doubles", path=("times",))
        starts = starts[np.abs(starts) <= abs(end) * (1 + 1e-15)]
        fine = np.interp(np.arange(2 * (len(starts) - 1) + 1) / 2.0, np.arange(len(starts)), starts)
        return fine if run.singular else np.append(fine[np.abs(fine) < abs(end)], end)

    @property
    def has_finer_run(self) -> bool:
        """Return that there is one."""
        return True

    def ended(self, end: float) -> tuple[float, float] | None:
        """Return the time of a singular place before `end` and its error, None without one; it raises as `reach`."""
        reached = self.reach(end)
        return None if reached is None else (reached, SINGULAR_TIME_ERROR * abs(reached))

    def reach(self, end: float) -> float | None:
        """Return the time of a singular place before `end`, None without one.

        Where doubles lose the connections and pairs do not, the place is not singular, and pairs answer instead.

        Raises
        ------
        AccuracyUnreachable
            Where pairs lose them too, but elsewhere.
        """
        scaled = end * two_to(-self.units.time)
        run = self.run("doubles", scaled)
        if not run.singular:
            return None
        reference = self.run("reference", scaled)
        if not reference.singular:
            self.keep_to_pairs()
            return None
        if self._apart_in(reference) is not None:
            return reference.end * two_to(self.units.time)
        if reference.end == 0.0 or abs(reference.end - run.end) > _SAME_PLACE * abs(reference.end):
            raise AccuracyUnreachable(
                None,
                np.inf,
                "masses or lengths are so unequal that the connections are lost to rounding, even in pairs of doubles",
                path=("bodies",),
            )
        return reference.end * two_to(self.units.time)

    def lost_in(self, end: float) -> str:
        """Return how close bodies come that attract or repel where it ends; empty where none do.

        A collision cannot be told from a pass so close that the connections are lost to rounding.
        """
        run = self.run("fine" if self.lost_to_doubles else "reference", end * two_to(-self.units.time))
        apart = self._apart_in(run) if run.singular else None
        if apart is None:
            return ""
        return (
            f"bodies that attract or repel come within {apart:.2g} m of one another at "
            f"{run.end * two_to(self.units.time):.10g} s, where even pairs of doubles lose them"
        )

    def _apart_in(self, run: Run) -> float | None:
        """Return the distance (m) at the end of a run of bodies that attract or repel, None where none are close."""
        inverse = [i for i, unit in enumerate(self.table.units) if unit == "1/m"]
        nearest = np.abs(evaluate(run, np.array([run.end]))[0][0, inverse, 0]).max(initial=0.0)
        return two_to(-self.units.lengths[inverse[0]]) / float(nearest) if nearest > COLLIDED else None
