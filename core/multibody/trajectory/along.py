"""What is summed up along a motion: the work of every connection, and the lengths of paths."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from functools import partial
from math import copysign, inf

import numpy as np
from flint import arb

from core.arrays import Floats
from core.balls import precision
from core.errors import BudgetExceeded
from core.multibody.algebra.polynomials import BITS, Ball
from core.multibody.motion.whole import Whole, values
from core.multibody.table.connection_effects import WorkTerm
from core.multibody.table.frames import Frame
from core.multibody.table.momenta import work_of_potential
from core.multibody.trajectory.integrals import Integrand, integrated
from core.multibody.trajectory.turns import closer_at_ends, reversals
from core.systems.trajectory import Column, How

MOST_NODES = 20_000
"""Times at which a motion is looked at between the start and the last sample."""

_SMALL = 2.0**-50
_MARGIN = 4.0
_PARTS = 8
"""A motion proposes eight times for every step of its series; within a step an integrand is smooth."""

State = tuple[Floats, Floats]


def watched_times(whole: Whole, end: float, every: int = 1, *, of: Sequence[int] | None = None) -> Floats:
    """Return times from zero to `end` so close that nothing turns twice between two of them, whole periods included.

    Parameters
    ----------
    every : int, optional
        Of the times that each motion proposes, only each `every`-th is taken.
    of : sequence of int, optional
        Coordinates of the scene, if only these are watched.

    Raises
    ------
    BudgetExceeded
        Where they would be too many.
    """
    found = [np.array([0.0, end])]
    motions = [motion for _, motion in whole.parts] if of is None else whole.motions_of(of)
    for motion in motions:
        period = None if motion.period is None else float(motion.period)
        if period is None or period >= abs(end):
            found.append(motion.nodes(end)[::every])
            continue
        once = np.abs(motion.nodes(copysign(period, end))[::every])
        # A period may be so short that their number is no double.
        periods = abs(end) / period if period > 0.0 else inf
        if (periods + 1.0) * len(once) > MOST_NODES:
            what = "times at which the motion is looked at"
            remedy = "ask for earlier times, or without what is summed up or searched along the way"
            raise BudgetExceeded(what, (periods + 1.0) * len(once), MOST_NODES, path=("outputs",), remedy=remedy)
        count = int(periods) + 1
        found.append(copysign(1.0, end) * (np.arange(count)[:, None] * period + once).ravel())
    times = np.unique(np.abs(np.concatenate(found)))
    times = times[times <= abs(end)]
    if len(times) > MOST_NODES:
        remedy = "ask for earlier times"
        raise BudgetExceeded(
            "times at which the motion is looked at", len(times), MOST_NODES, path=("outputs",), remedy=remedy
        )
    return copysign(1.0, end) * times


def period_within(whole: Whole, end: float) -> Ball | None:
    """Return the period (s) after which a motion is the same again, if that is shorter than a time."""
    periods = {
        None if motion.period is None else float(motion.period): motion.period
        for _, motion in whole.parts
        if motion.name != "rest"
    }
    windings = any(getattr(motion, "winding", 0.0) for _, motion in whole.parts)
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

    def works(self) -> dict[str, Column]:
        """Return the work that gravity, springs, dampers, motors and forces have done on the scene (J)."""
        found = {}
        for work in self.whole.measures.works:
            if work.potential is not None:
                found[f"{work.name}.work"] = self._by_potential(work)
            else:
                nodes = partial(watched_times, self.whole, every=_PARTS)
                found[f"{work.name}.work"] = self._integral(power_of(self.whole, work), nodes, "J")
        return found

    def paths(self) -> dict[str, Column]:
        """Return the lengths of the paths of centres of mass (m)."""
        found = {}
        frames = self.whole.measures.coordinates.frames
        for name, velocity in velocities_of(frames).items():
            nodes = partial(self._nodes, velocity, list(frames[name].position))
            found[f"{name}.path"] = self._integral(partial(speed_of, velocity), nodes, "m")
        return found

    def _nodes(self, velocity: Callable[[State], Floats], of: Sequence[int], end: float) -> Floats:
        """Return times up to `end` between which the length of a velocity is smooth."""

        def followed(times: Floats) -> Floats:
            states = self.whole.states(times, finer=self.finer)
            return velocity((states.q, states.v))

        times = watched_times(self.whole, end, of=of)
        return np.concatenate([times[::_PARTS], times[-1:], reversals(followed, closer_at_ends(times))])

    def _by_potential(self, work: WorkTerm) -> Column:
        states = self.whole.states(self.times, finer=self.finer)
        start = self.whole.states(np.zeros(1), finer=self.finer).q[0]
        done, size = work_of_potential(work.potential or {}, start, states.q)
        error = _SMALL * float(np.max(size, initial=0.0))
        if states.reference is not None:
            other = work_of_potential(work.potential or {}, start, states.reference[0])[0]
            error += _MARGIN * float(np.max(np.abs(done - other), initial=0.0))
        return Column(done, "J", error, self.how)

    def _integral(self, function: Callable[[State], Floats], nodes: Callable[[float], Floats], unit: str) -> Column:
        def integrand(times: Floats) -> tuple[Floats, Floats, Floats]:
            states = self.whole.states(times, finer=self.finer)
            own = function((states.q, states.v))
            return own, own if states.reference is None else function(states.reference), np.abs(own)

        total, error = _from_the_start(self.whole, integrand, nodes, self.times)
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
    whole: Whole, integrand: Integrand, nodes: Callable[[float], Floats], times: Floats
) -> tuple[Floats, Floats]:
    total, error = np.zeros(len(times)), np.zeros(len(times))
    for way in (1.0, -1.0):
        chosen = way * times > 0.0
        if np.any(chosen):
            total[chosen], error[chosen] = _one_way(whole, integrand, nodes, times[chosen])
    return total, error


def _one_way(
    whole: Whole, integrand: Integrand, nodes: Callable[[float], Floats], times: Floats
) -> tuple[Floats, Floats]:
    """Return integrals to times of one sign; of a motion that repeats, those of whole periods are multiples of one."""
    end = float(times[np.argmax(np.abs(times))])
    period = period_within(whole, abs(end))
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
