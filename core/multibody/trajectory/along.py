"""What is summed up along a motion: the work of every connection, and the lengths of paths."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from functools import partial
from math import copysign

import numpy as np
from flint import arb

from core.arrays import Floats
from core.balls import precision
from core.multibody.algebra.polynomials import BITS, ONE, Ball
from core.multibody.motion.motion import Motion
from core.multibody.motion.numerical import BEFORE_SINGULAR
from core.multibody.motion.whole import Whole, values
from core.multibody.search.curves import Curve
from core.multibody.search.every_zero import EveryZero
from core.multibody.search.first_of_motion import Expansions
from core.multibody.search.pieces import Pieces
from core.multibody.table.connection_effects import WorkTerm
from core.multibody.table.frames import Frame
from core.multibody.table.momenta import work_of_potential
from core.multibody.trajectory.events import runs_of
from core.multibody.trajectory.integrals import POINTS_OF_INTERVAL, Integrand, integrated, require_few_points
from core.systems.trajectory import Column, How

_SMALL = 2.0**-50
"""Rounding of a work in doubles, as a share of its largest term: four units in the last place."""

_MARGIN = 4.0
"""Factor on the difference from the reference, which has an error of its own."""

State = tuple[Floats, Floats]


def smooth_times(expansions: Expansions, places: Sequence[Sequence[int]], end: float) -> Floats:
    """Return times from zero to `end` between which the motion is one polynomial and no velocity turns back.

    Parameters
    ----------
    places : sequence of sequence of int
        Coordinates of the points of which the velocities are followed.
    end : float
        Negative for the time before the start.

    Raises
    ------
    BudgetExceeded
        Where they are more than can be summed up over.
    """
    quantities = [partial(_square_of_speed, of) for of in places]
    # What never vanishes is followed to the end.
    zeros = EveryZero(expansions.places, [*quantities, _one], expansions.coarse[0], copysign(1.0, end))
    corners = []
    for zero in zeros.until(abs(end)):
        corners.append(zero.time)
        require_few_points(POINTS_OF_INTERVAL * len(zeros.starts))
    times = np.unique(np.abs([0.0, *zeros.starts, *corners]))
    return copysign(1.0, end) * np.append(times[times < abs(end)], abs(end))


def _square_of_speed(of: Sequence[int], pieces: Pieces) -> Curve:
    total = pieces.nothing()
    for i in of:
        rate = pieces.rate(i)
        total = total.plus(ONE, rate.times(rate))
    return total


def _one(pieces: Pieces) -> Curve:
    return Curve.constant(ONE, pieces.shape)


def period_within(motions: Sequence[Motion], end: float) -> Ball | None:
    """Return the period (s) after which some motions are the same again, if that is shorter than a time."""
    periods = {
        None if motion.period is None else float(motion.period): motion.period for motion in motions if motion.moves
    }
    windings = any(motion.winding for motion in motions)
    if len(periods) != 1 or windings:
        return None
    ((approximate, period),) = periods.items()
    return period if approximate is not None and approximate < end else None


class Along:
    """Sums along a motion at some times.

    Parameters
    ----------
    whole : Whole
    times : ndarray, shape (t,)
    how : str
    finer : bool
        Whether the motion is answered in pairs.
    """

    def __init__(self, whole: Whole, times: Floats, how: How, *, finer: bool) -> None:
        self.whole, self.times, self.how, self.finer = whole, times, how, finer
        self._known: dict[tuple[tuple[int, ...], float], Floats] = {}

    def works(self) -> dict[str, Column]:
        """Return the work that gravity, springs, dampers, motors and forces have done on the scene (J)."""
        found = {}
        for work in self.whole.measures.works:
            if work.potential is not None:
                found[f"{work.name}.work"] = self._by_potential(work)
            else:
                found[f"{work.name}.work"] = self._integral(power_of(self.whole, work), "J")
        return found

    def paths(self) -> dict[str, Column]:
        """Return the lengths of the paths of centres of mass (m)."""
        found = {}
        frames = self.whole.measures.coordinates.frames
        for name, velocity in velocities_of(frames).items():
            found[f"{name}.path"] = self._integral(partial(speed_of, velocity), "m", frames[name].position)
        return found

    def _nodes(self, parts: tuple[int, ...], end: float) -> Floats:
        """Return times up to `end` between which functions of some parts are smooth, and the speeds in them."""
        if (parts, end) not in self._known:
            frames = self.whole.measures.coordinates.frames.values()
            moved = [list(frame.position) for frame in frames if self.whole.parts_of(frame.position) == parts]
            of = sorted({i for place in moved for i in place}) if moved else None
            # The last sample may be as good as at a singular place; beyond, halves are as smooth.
            until = BEFORE_SINGULAR * end
            self._known[parts, end] = smooth_times(Expansions.of(runs_of(self.whole), of), moved, until)
        return self._known[parts, end]

    def _by_potential(self, work: WorkTerm) -> Column:
        states = self.whole.states(self.times, finer=self.finer)
        start = self.whole.states(np.zeros(1), finer=self.finer).q[0]
        done, size = work_of_potential(work.potential or {}, start, states.q)
        error = _SMALL * float(np.max(size, initial=0.0))
        if states.reference is not None:
            other = work_of_potential(work.potential or {}, start, states.reference[0])[0]
            error += _MARGIN * float(np.max(np.abs(done - other), initial=0.0))
        return Column(done, "J", error, self.how)

    def _integral(self, function: Callable[[State], Floats], unit: str, of: Sequence[int] | None = None) -> Column:
        def integrand(times: Floats) -> tuple[Floats, Floats, Floats]:
            states = self.whole.states(times, finer=self.finer)
            own = function((states.q, states.v))
            return own, own if states.reference is None else function(states.reference), np.abs(own)

        parts = self.whole.parts_of(of)
        motions = [self.whole.parts[k][1] for k in parts]
        total, error = _from_the_start(motions, integrand, partial(self._nodes, parts), self.times)
        return Column(total, unit, float(np.max(error, initial=0.0)), self.how)


def velocities_of(frames: Mapping[str, Frame]) -> dict[str, Callable[[State], Floats]]:
    """Return the velocities of the centres of mass of bodies, as functions of the state, each of shape (t, k)."""

    def velocity(where: Sequence[int], state: State) -> Floats:
        return state[1][:, where, 0]

    return {name: partial(velocity, list(frame.position)) for name, frame in frames.items()}


def speed_of(velocity: Callable[[State], Floats], state: State) -> Floats:
    """Return the length of a velocity in states, shape (t,)."""
    speed: Floats = np.linalg.norm(velocity(state), axis=1)
    return speed


def power_of(whole: Whole, work: WorkTerm) -> Callable[[State], Floats]:
    """Return the power of what is no potential, as a function of the state."""

    def power(state: State) -> Floats:
        q, v = state
        total = np.zeros(len(q))
        if work.square is not None:
            rate = sum((float(x) * v[:, i, 0] for i, x in work.square[1].items()), np.zeros(len(q)))
            total -= float(work.square[0]) * rate**2
        for factor, i, j in work.terms:
            total += float(factor) * q[:, i, 0] * v[:, j, 0]
        if work.rows:
            multipliers = whole.multipliers(q, v)
            for row, poly in work.rows:
                total -= values(poly, q)[0] * multipliers[:, row]
        return total

    return power


def _from_the_start(
    motions: Sequence[Motion], integrand: Integrand, nodes: Callable[[float], Floats], times: Floats
) -> tuple[Floats, Floats]:
    total, error = np.zeros(len(times)), np.zeros(len(times))
    for way in (1.0, -1.0):
        chosen = way * times > 0.0
        if np.any(chosen):
            total[chosen], error[chosen] = _one_way(motions, integrand, nodes, times[chosen])
    return total, error


def _one_way(
    motions: Sequence[Motion], integrand: Integrand, nodes: Callable[[float], Floats], times: Floats
) -> tuple[Floats, Floats]:
    """Return integrals to times of one sign; of a motion that repeats, those of whole periods are multiples of one."""
    end = float(times[np.argmax(np.abs(times))])
    period = period_within(motions, abs(end))
    if period is None:
        return integrated(integrand, nodes(end), times)
    once = copysign(float(period), end)
    counts = np.floor(np.abs(times) / abs(once))
    with precision(BITS):
        late = [arb(abs(t)) - arb(k) * period for t, k in zip(times.tolist(), counts.tolist(), strict=True)]
        within = np.append(np.clip([float(t) for t in late], 0.0, abs(once)), abs(once))
        rounded = np.array([float(t - arb(own)) for t, own in zip([*late, period], within.tolist(), strict=True)])
    found, errors = integrated(integrand, nodes(once), np.copysign(within, end))
    # An eccentric orbit goes far in what a double leaves of a period at its pericentre.
    found = found + integrand(np.copysign(within, end))[0] * np.copysign(1.0, end) * rounded
    total = counts * found[-1] + found[:-1]
    rounding = 2.0**-51 * (np.abs(total) + np.abs(found[-1]))
    return total, counts * errors[-1] + errors[:-1] + rounding
