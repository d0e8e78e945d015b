"""What is summed up along a motion: the work of every connection, and the lengths of paths."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from functools import partial
from math import copysign

import numpy as np
from flint import arb

from core.arrays import Floats, row_lengths
from core.balls import precision
from core.multibody.algebra.polynomials import BITS, ONE, Ball
from core.multibody.laws.samples import values_of
from core.multibody.motion.motion import Motion
from core.multibody.motion.whole import Whole, values
from core.multibody.search.curves import Curve
from core.multibody.search.every_zero import EveryZero
from core.multibody.search.first_of_motion import Expansions
from core.multibody.search.pieces import Pieces
from core.multibody.table.connection_effects import WorkTerm
from core.multibody.table.frames import Frame
from core.multibody.trajectory.integrals import POINTS_OF_INTERVAL, Integrand, integrated, require_few_points

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


def velocities_of(frames: Mapping[str, Frame]) -> dict[str, Callable[[State], Floats]]:
    """Return the velocities of the centres of mass of bodies, as functions of the state, each of shape (t, k)."""

    def velocity(where: Sequence[int], state: State) -> Floats:
        return state[1][:, where, 0]

    return {name: partial(velocity, list(frame.position)) for name, frame in frames.items()}


def speed_of(velocity: Callable[[State], Floats], state: State) -> Floats:
    """Return the length of a velocity in states, shape (t,)."""
    speed: Floats = row_lengths(velocity(state))
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
        for number in work.laws:
            law = whole.measures.table.laws[number]
            rate = sum((float(x) * v[:, i, 0] for i, x in law.push.items()), np.zeros(len(q)))
            total += values_of(law, q, v)[0] * rate
        if work.rows:
            multipliers = whole.multipliers(q, v)
            for row, poly in work.rows:
                total -= values(poly, q)[0] * multipliers[:, row]
        return total

    return power


def summed(
    integrand: Integrand, nodes: Callable[[float], Floats], period: Callable[[float], Ball | None], times: Floats
) -> tuple[Floats, Floats]:
    """Return integrals from zero to times of either sign, and bounds of their errors, each of shape (t,).

    Parameters
    ----------
    nodes : callable
        Returns times up to one, between which the integrand is smooth.
    period : callable
        Returns the period of the integrand, None where it is longer than a time.
    """
    total, error = np.zeros(len(times)), np.zeros(len(times))
    for way in (1.0, -1.0):
        chosen = way * times > 0.0
        if np.any(chosen):
            total[chosen], error[chosen] = _one_way(integrand, nodes, period, times[chosen])
    return total, error


def _one_way(
    integrand: Integrand, nodes: Callable[[float], Floats], period_within: Callable[[float], Ball | None], times: Floats
) -> tuple[Floats, Floats]:
    """Return integrals to times of one sign; of what repeats, those of whole periods are multiples of one."""
    end = float(times[np.argmax(np.abs(times))])
    period = period_within(abs(end))
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
