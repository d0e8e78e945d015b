"""A motion through phases as stretches on which it is smooth: the phases themselves, and the arcs of bounces in them.

At an event a rate may jump, and so do forces: a stretch has its own values at both of its ends.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace

import numpy as np
from flint import arb

from core.arrays import Floats
from core.errors import BudgetExceeded
from core.multibody.algebra.polynomials import ZERO, Ball, is_zero
from core.multibody.equations.expansion import Expansion
from core.multibody.equations.packed import pair
from core.multibody.motion.motion import States
from core.multibody.motion.numerical import BEFORE_SINGULAR
from core.multibody.motion.whole import Whole
from core.multibody.phases.accumulation import Accumulation
from core.multibody.phases.phase import Phase, PhaseMotion
from core.multibody.phases.phase_ends import expansions_of
from core.multibody.phases.phase_states import Times, columns_in, states_in
from core.multibody.phases.uniform_pieces import ExpandedUniform
from core.multibody.search.bands import SAFETY_FACTOR
from core.multibody.search.first_of_motion import Expansions
from core.multibody.trajectory.along import period_within
from core.systems.trajectory import Column, How

MOST_ARCS = 2000
"""Bounces, of those that accumulate, that are followed one by one."""
_GONE = 2.0**-60
"""Share of the first of them below which a bounce is nothing."""
_ROUNDED = 2.0**-51
"""Rounding of a state in doubles, as a share of its size: two units in the last place."""


@dataclass(frozen=True)
class Stretch:
    """A part of a phase on which the motion is smooth.

    Attributes
    ----------
    number : int
        Of the phase.
    phase : Phase
    start : ball
        Since the start of the scene.
    extent : ball
        How long it is (s).
    late : float
        Error of the start (s).
    arc : tuple of three lists of ball, or None
        State at the start of an arc, and its constant accelerations.
    finer : bool
        Whether pairs of doubles compute the motion where there is a choice.
    """

    number: int
    phase: Phase
    start: Ball
    extent: Ball
    late: float
    arc: tuple[Sequence[Ball], Sequence[Ball], Sequence[Ball]] | None = None
    finer: bool = False

    @property
    def whole(self) -> Whole:
        """The motion of the scene from its start."""
        return self.phase.models[0].whole

    @property
    def length(self) -> float:
        """The double nearest to how long it is (s)."""
        return float(self.extent)

    def states(self, times: Floats) -> States:
        """Return the states at times since the start of the stretch, shape (t,); those of the first may be negative."""
        if self.arc is None:
            return states_in(self.phase, self._since_the_start(times), finer=self.finer)
        within = np.clip(times, 0.0, self.length)
        q, v, a = (np.array([pair(x, 0) for x in vector]) for vector in self.arc)
        gain = a[:, 0]
        gone, won = within[:, None] * (v[:, 0] + 0.5 * within[:, None] * gain), within[:, None] * gain
        sizes = np.abs(q[:, 0]) + np.abs(within[:, None] * v[:, 0]) + np.abs(gone), np.abs(v[:, 0]) + np.abs(won)
        states = [np.stack([x[:, 0] + y, x[:, 1] + 0.0 * y], axis=-1) for x, y in ((q, gone), (v, won))]
        return States(states[0], states[1], _ROUNDED * sizes[0], _ROUNDED * sizes[1], None)

    def columns(self, times: Floats, how: How, group: str) -> dict[str, Column]:
        """Return the columns of one output at times since the start of the stretch."""
        return columns_in(self.phase, self._since_the_start(times), self.states(times), how, [group])

    def _since_the_start(self, times: Floats) -> Times:
        """Return times since the start of the scene."""
        within = np.clip(times, 0.0 if self.number else -np.inf, self.length)
        return within if is_zero(self.start) else [self.start + float(t) for t in within]

    def period(self, parts: Sequence[int], end: float) -> Ball | None:
        """Return the period (s) after which some parts are the same again, if that is shorter than a time.

        What is known from two tracks has a period of each.
        """
        if self.arc is not None or len(self.phase.tracks) > 1:
            return None
        return period_within([self.whole.parts[k][1] for k in parts], end)

    @property
    def expanded(self) -> float:
        """Time up to which it can be expanded (s): not to where a turning slip ends."""
        return BEFORE_SINGULAR * self.length if self.phase.turning and self.phase.end is not None else self.length

    def expansions(self, coordinates: Sequence[int] | None) -> Expansions:
        """Return computations of the motion from its start; of places, those that some coordinates follow."""
        if self.arc is None:
            return expansions_of(self.phase, coordinates, finer=self.finer)
        q, v, a = self.arc
        places = [[x, y, z / 2, ZERO, ZERO] for x, y, z in zip(q, v, a, strict=True)]
        arc = [ExpandedUniform(Expansion(places, self.phase.exact_motions[0].multipliers))]
        return Expansions(arc, arc)


def stretches(motion: PhaseMotion, end: float, *, finer: bool) -> Iterator[Stretch]:
    """Yield the stretches of a motion up to a time, in their order; the last may be the state after an event there."""
    for number, phase in enumerate(motion.phases):
        until = arb(end)
        if phase.end is not None and phase.end < until:
            until = phase.end
        if number and not until > phase.start:
            if until < phase.start:
                return
            until = phase.start
        late = float(phase.start.rad())
        late += SAFETY_FACTOR * max((abs(float(one.time - phase.start)) for one in phase.tracks), default=0.0)
        if phase.bounces is None:
            yield Stretch(number, phase, phase.start, until - phase.start, late, finer=finer)
        else:
            yield from _arcs(number, replace(phase, bounces=None), phase.bounces, until, late)


def _arcs(number: int, phase: Phase, bounces: Accumulation, until: Ball, late: float) -> Iterator[Stretch]:
    """Yield the arcs of bounces, and in one what is left of them where that is next to nothing."""
    reach = until - phase.start
    for n in range(MOST_ARCS):
        begins, power = bounces.begins(n), bounces.restitution**n
        if n and not begins < reach:
            return
        if float(power) < _GONE:
            q, v = bounces.limit()
            left = bounces.length - begins
            before = [x - left * y for x, y in zip(q, v, strict=True)]
            arc = before, v, [ZERO] * len(v)
            yield Stretch(number, phase, phase.start + begins, reach - begins, late, arc)
            return
        ends = bounces.begins(n + 1)
        extent = (ends if ends < reach else reach) - begins
        yield Stretch(number, phase, phase.start + begins, extent, late, (*bounces.state(begins, power), bounces.a))
    raise BudgetExceeded(
        "bounces that are followed one by one",
        MOST_ARCS,
        MOST_ARCS,
        path=("outputs",),
        remedy="ask for earlier times, or leave out integrals and searches along the motion",
    )
