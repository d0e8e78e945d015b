"""Samples of two shafts on one string, in doubles, from the phases that were found in ball arithmetic."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np
from flint import arb

from core.arrays import Floats
from core.balls import Undetermined
from core.errors import NotApplicable
from core.notices import Notice
from core.scenes.bounces import Sequence
from core.scenes.enclosure import ONE, UNIT_ROUNDOFF, ZERO, Ball, as_pair, exact_pair
from core.scenes.equation import AcceleratedCoordinate, SceneEquation
from core.scenes.motion import Event, NamedSceneMotion, Samples, finite
from core.scenes.string_phases import Phase, Phases
from core.scenes.string_state import State
from core.systems.system import Model

WHY = {"taut": "the string is taut", "slack": "the string is slack", "stick": "both shafts roll on the string's track"}
FREEDOM = {"taut": 3, "slack": 4, "stick": 2}
SMALLEST = 2.0**-1074


@dataclass(frozen=True)
class Coordinate:
    """One coordinate in one phase: value and rate at its start, acceleration, and the gain nu of the rate."""

    value: Ball
    rate: Ball
    acceleration: Ball
    gain: Ball = ZERO


class ShaftMotion(NamedSceneMotion):
    """Positions are quadratic in the time between events.

    Parameters
    ----------
    phases : Phases
        As they were found.
    radii : tuple of float
        Of the shafts (m).
    given : mapping of str to float
        Largest magnitude of each column in the given state.
    unresolved : float
        Difference of velocities that was small enough to be taken as zero (m/s).
    """

    def __init__(
        self, phases: Phases, radii: tuple[float, float], given: Mapping[str, float], unresolved: float
    ) -> None:
        self.phases, self._radii, self._given = phases, radii, given
        self._unresolved = unresolved + float(phases.cut)

    @property
    def model(self) -> Model:
        """The phases that occur, and the degrees of freedom of the freest."""
        kinds = list(dict.fromkeys(phase.drive.kind for phase in self.phases.phases))
        why = ", ".join(WHY[kind] for kind in kinds) + "; accelerations are constant between events"
        return Model("two unwinding shafts on one string", ", ".join(kinds), why, max(FREEDOM[kind] for kind in kinds))

    @property
    def valid_from(self) -> float:
        """Jerks and friction do not run backwards, so the motion begins with the given state."""
        return 0.0

    @property
    def end(self) -> Event | None:
        """The end of a string or of a slope, or the apex."""
        return self.phases.end

    def events(self) -> tuple[Event, ...]:
        """Jerks, ends of slipping, and the end."""
        return self.phases.events

    def at(self, time: Ball) -> Mapping[str, Any]:
        """Return positions, rates and lengths at one time, and the tension where it is determined."""
        here = self.phases.phases[0]
        for phase in self.phases.phases[1:]:
            if not phase.start.time > time:
                here = phase
        state, radii = _within(here, time - here.start.time), exact_pair(self._radii)
        found = {
            "positions": state.positions,
            "velocities": state.velocities,
            "spins": (state.rates[0] / radii[0], state.rates[1] / radii[1]),
            "unwound": state.unwound,
        }
        return found if here.drive.tension is None else {**found, "tension": here.drive.tension}

    def sample(self, times: Floats) -> Samples:
        """Evaluate the phase in which each of the times lies: right after a jerk, not right before it."""
        phases = self.phases.phases
        starts = np.array([float(phase.start.time) for phase in phases])
        which = np.searchsorted(starts, times, side="right") - 1
        radii = np.array(self._radii)
        x, v, s, r = (np.zeros((times.size, 2)) for _ in range(4))
        dx, dv, ds, dr = (np.zeros((times.size, 2)) for _ in range(4))
        tension = np.zeros(times.size)
        determinate = True
        with np.errstate(over="ignore", invalid="ignore", under="ignore", divide="ignore"):
            for k in np.unique(which):
                here = np.flatnonzero(which == k)
                phase = phases[k]
                clock = _Clock(phase, times[here])
                gains_x, gains_s, _ = phase.sequence.gains() if phase.sequence else ((ZERO, ZERO),) * 3
                for i in (0, 1):
                    along = Coordinate(
                        phase.start.positions[i], phase.start.velocities[i], phase.drive.positions[i], gains_x[i]
                    )
                    x[here, i], v[here, i], dx[here, i], dv[here, i] = clock.evaluate(along)
                    around = Coordinate(
                        phase.start.unwound[i], phase.start.rates[i], phase.drive.unwound[i], gains_s[i]
                    )
                    s[here, i], r[here, i], ds[here, i], dr[here, i] = clock.evaluate(around)
                if phase.drive.tension is None:
                    determinate = False
                else:
                    tension[here] = float(phase.drive.tension)
            drift = self._unresolved
            elapsed = np.abs(times)[:, None]
            values = {"positions": x, "velocities": v, "spins": r / radii, "unwound": s}
            errors = {
                "positions": dx + drift * elapsed,
                "velocities": dv + drift,
                # Of a large radius the quotient may be below the doubles.
                "spins": (dr + drift + UNIT_ROUNDOFF * np.abs(r)) / radii
                + SMALLEST * ((r / radii == 0.0) & (r != 0.0)),
                "unwound": ds + drift * elapsed,
            }
        notices: tuple[Notice, ...] = ()
        if determinate:
            values["tension"], errors["tension"] = tension, UNIT_ROUNDOFF * tension
        else:
            notices = (Notice("indeterminate", "nothing fixes the tension while both shafts stick: no such column"),)
        finite(values)
        scales = {
            name: max(float(np.max(np.abs(column), initial=0.0)), self._given.get(name, 0.0))
            for name, column in values.items()
        }
        columns = Samples(values, errors, scales, notices)
        if determinate:
            for phase in phases:
                columns = columns.without_underflow({"tension": phase.drive.tension or ZERO})
        return columns

    def equation(self) -> SceneEquation:
        """Return the constant accelerations of the positions and of the lengths unwound, of a motion in one phase."""
        first, *others = self.phases.phases
        if others or first.sequence is not None:
            raise NotApplicable(
                "jerks and changes between slipping and rolling interrupt the motion, and no method steps over them",
                path=("times",),
                remedy="leave the method out, or ask for times before the first of the events",
            )
        start, drive = first.start, first.drive
        along = zip(start.positions, start.velocities, drive.positions, strict=True)
        around = zip(start.unwound, start.rates, drive.unwound, strict=True)
        return SceneEquation(tuple(AcceleratedCoordinate(*one) for one in (*along, *around)), self.model)

    def states(self, columns: Mapping[str, Floats]) -> Floats:
        """Return positions and lengths unwound, and their rates."""
        rates = columns["spins"] * np.array(self._radii)
        return np.hstack((columns["positions"], columns["unwound"], columns["velocities"], rates))

    def observed(self, states: Floats) -> Mapping[str, Floats]:
        """Return positions, rates and lengths, and the tension where it is determined."""
        values = {
            "positions": states[:, 0:2],
            "velocities": states[:, 4:6],
            "spins": states[:, 6:8] / np.array(self._radii),
            "unwound": states[:, 2:4],
        }
        tension = self.phases.phases[0].drive.tension
        return values if tension is None else {**values, "tension": np.full(len(states), float(tension))}


def _within(phase: Phase, elapsed: Ball) -> State:
    """Return the state at a time after the start of a phase; in a sequence of jerks, in the arc between two of them."""
    if phase.sequence is None:
        return phase.start.after(phase.drive, elapsed)
    sequence = phase.sequence
    n = _arcs(sequence, elapsed / sequence.first)
    if phase.last_arc is not None:
        n = min(n, phase.last_arc)
    S = sequence.sum(n)
    return sequence.at(S).after(phase.drive, elapsed - sequence.first * S)


def _arcs(sequence: Sequence, firsts: Ball) -> int:
    """Return the number of arcs completed after a time in units of the first arc's duration."""
    e = sequence.restitution
    count = firsts if sequence.limit is None else (ONE - (1 - e) * firsts).log() / e.log()
    if not count.is_finite():
        raise Undetermined
    whole = count.floor().unique_fmpz()
    if whole is None:
        raise Undetermined
    return max(0, int(whole))


class _Clock:
    """The number S of arcs done, and the time since the last jerk, at each of the times in one phase."""

    def __init__(self, phase: Phase, times: Floats) -> None:
        high, low = as_pair(phase.start.time)
        elapsed = (times - high) - low
        self.elapsed = np.maximum(elapsed, 0.0)
        self.first = 0.0
        self.S: Floats | float = 0.0
        self.ratio: Floats | float = 1.0
        self.time = self.elapsed
        self.gap = self.sum_of_ratios = 0.0
        if phase.sequence is not None:
            self._count(phase.sequence, phase.last_arc)

    def _count(self, sequence: Sequence, last_arc: int | None) -> None:
        e, d = sequence.restitution, float(sequence.first)
        self.first, self.gap, self.sum_of_ratios = d, float(1 - e), float(1 + e)
        arcs = self.elapsed / d
        if sequence.limit is None:
            n = np.floor(arcs)
            self.S, self.ratio = n, np.ones_like(n)
        else:
            log = float(e.log())
            left = 1.0 - self.gap * arcs
            with np.errstate(divide="ignore", invalid="ignore"):
                n = np.floor(np.log1p(-np.minimum(self.gap * arcs, 1.0)) / log)
            n = np.where(left > 0.0, np.maximum(n, 0.0), np.inf)
            if last_arc is not None:
                n = np.minimum(n, float(arb(last_arc)))
            self.ratio = np.exp(n * log)
            self.S = -np.expm1(n * log) / self.gap
        self.time = np.maximum(self.elapsed - d * self.S, 0.0)

    def evaluate(self, coordinate: Coordinate) -> tuple[Floats, Floats, Floats, Floats]:
        """Return value and rate, and bounds of their absolute errors."""
        y, v, a, nu = (
            float(ball) for ball in (coordinate.value, coordinate.rate, coordinate.acceleration, coordinate.gain)
        )
        t, S, d = self.time, self.S, self.first
        rate = v + nu * S
        value = y + t * (rate + 0.5 * a * t)
        size = np.abs(y) + t * (np.abs(v) + np.abs(nu) * S + np.abs(a) * t)
        if d > 0.0:
            jump = d * S * (v + (nu * (S - 1.0) + 0.5 * a * d * (1.0 + self.ratio)) / self.sum_of_ratios)
            value = value + jump
            size = size + d * S * (np.abs(v) + np.abs(nu) * (S + 1.0) + np.abs(a) * d)
        later = rate + a * t
        whole = self.elapsed
        pace = np.abs(v) + np.abs(nu) * S + np.abs(a) * t
        # What numbers lose below the normal range; zeros lose nothing.
        tiny = SMALLEST * (1.0 + whole) * (((v != 0.0) or (nu != 0.0)) + (a != 0.0) * whole)
        few = 32.0 * UNIT_ROUNDOFF
        return (
            value,
            later,
            few * (size + pace * whole) + tiny * whole + SMALLEST * (y != 0.0),
            few * (pace + np.abs(a) * (t if d == 0.0 else whole)) + tiny,
        )
