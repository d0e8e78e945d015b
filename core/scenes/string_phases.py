"""The motion of two shafts on one string as a sequence of phases with constant accelerations, from event to event."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import Literal

from core.balls import raised
from core.errors import BudgetExceeded
from core.scenes.bounces import Sequence
from core.scenes.enclosure import ZERO, Ball, exact, sign, smaller
from core.scenes.motion import Event
from core.scenes.quadratics import exit_time
from core.scenes.string_state import Constants, Drive, State
from core.work import spend

MOST_PHASES = 2000
WORK_OF_A_PHASE = 100
"""Units of work (`core.work`): a phase is a few hundred operations on balls."""
FAINTEST_JERK = 2.0**-60
"""Part of the fastest closing below which a jerk among others is the last: sticking and slipping between jerks leave no
closed form for how they accumulate. What is cut off enters the error."""
ROUNDING = 1e-12
"""Velocities that differ by less than this part of their terms count as equal, as a product R omega is rounded."""

Law = Callable[[Constants, State], Drive]


@dataclass(frozen=True)
class Limit:
    """A bound that ends the motion: the margin from it, way * (quantity - level), must not turn negative."""

    kind: str
    shaft: Literal[0, 1]
    quantity: Literal["positions", "unwound"]
    way: int
    level: Ball

    def margin(self, state: State, drive: Drive) -> tuple[Ball, Ball, Ball]:
        """Return the margin, its rate and its acceleration."""
        i = self.shaft
        if self.quantity == "positions":
            value, rate, acceleration = state.positions[i], state.velocities[i], drive.positions[i]
        else:
            value, rate, acceleration = state.unwound[i], state.rates[i], drive.unwound[i]
        return self.way * (value - self.level), self.way * rate, self.way * acceleration


@dataclass(frozen=True)
class Phase:
    """A time in which the accelerations do not change but for jerks.

    Attributes
    ----------
    start : State
        Right after the jerk that began it, if one did.
    duration : ball or None
        None for ever.
    impulse, dissipated : ball
        Of its jerks along the string (N s), and the energy that they cost (J); impulse None if there are infinitely
        many that do not accumulate.
    jerks : int or None
        How many, the one that began it included; None for infinitely many.
    sequence : Sequence or None
        The arcs, if jerks go on inside the phase.
    last_arc : int or None
        Number of the arc in which something ended the sequence.
    """

    start: State
    drive: Drive
    duration: Ball | None
    impulse: Ball | None = ZERO
    dissipated: Ball = ZERO
    jerks: int | None = 0
    sequence: Sequence | None = None
    last_arc: int | None = None

    @property
    def ends(self) -> Ball | None:
        """Time of its end, None if it lasts for ever."""
        return None if self.duration is None else self.start.time + self.duration


@dataclass(frozen=True)
class Phases:
    """The phases up to the end of the motion, or past the horizon.

    Attributes
    ----------
    end : Event or None
        What ends the motion.
    events : tuple of Event
        Everything that begins a phase, and the end.
    cut : ball
        Bound of the closing velocities of jerks that were left out (m/s).
    """

    phases: tuple[Phase, ...]
    end: Event | None
    events: tuple[Event, ...]
    cut: Ball = ZERO


class EventTracker:
    """Follows one motion from event to event.

    Parameters
    ----------
    constants : Constants
    restitution : ball
        Coefficient of restitution of a jerk of the string.
    limits : tuple of Limit
        What may end the motion.
    law : callable
        Returns what drives the shafts in a state.
    slip : bool
        Whether friction acts, so that jerks that die out end in a state of contact.
    """

    def __init__(
        self, constants: Constants, restitution: Ball, limits: tuple[Limit, ...], law: Law, slip: bool
    ) -> None:
        self.constants, self.restitution, self.limits, self.law, self.slip = constants, restitution, limits, law, slip
        self.phases: list[Phase] = []
        self.events: list[Event] = []
        self.fastest, self.last, self.cut = ZERO, ZERO, ZERO

    def follow(self, state: State, horizon: float) -> Phases:
        """Return the phases from a state until the motion ends or the horizon (s) has passed.

        Raises
        ------
        BudgetExceeded
            For more than `MOST_PHASES` phases.
        """
        while True:
            if len(self.phases) >= MOST_PHASES:
                raise BudgetExceeded(
                    "phases",
                    MOST_PHASES + 1,
                    MOST_PHASES,
                    path=("times",),
                    remedy="ask for times before the last phase",
                )
            spend(WORK_OF_A_PHASE)
            impulse, loss, jerks = ZERO, ZERO, 0
            if state.tight and sign(state.opening) < 0:
                closing = -state.opening
                restitution = self._restitution(closing)
                impulse, loss, jerks = self._impulse(closing, restitution), self._loss(closing, restitution), 1
                state = state.after_impulse(self.constants, closing, restitution)
                self.events.append(Event("jerk", state.time))
            drive = self.law(self.constants, state)
            if (
                jerks
                and drive.kind == "slack"
                and sign(state.opening) > 0
                and sign(drive.closing) > 0
                and self._steady(state)
            ):
                phase, state, end = self._bounce(state, drive, impulse, loss)
            else:
                phase, state, end = self._glide(state, drive, impulse, loss, jerks)
            self.phases.append(phase)
            if end is not None:
                self.events.append(end)
            if end is not None or phase.duration is None or float(state.time) > horizon:
                return Phases(tuple(self.phases), end, tuple(self.events), self.cut)

    def _restitution(self, closing: Ball) -> Ball:
        """Return the restitution of this jerk: none for the last of a sequence that dies out."""
        self.fastest = closing if closing > self.fastest else self.fastest
        if self.slip and sign(self.restitution) and closing < self.fastest * exact(FAINTEST_JERK):
            # The rest of the sequence, as a geometric series with the ratio of its last two jerks.
            ratio = closing / self.last if closing < self.last else self.restitution
            rest = closing / (1 - ratio) if ratio < 1 else closing * MOST_PHASES
            self.cut = self.cut + 4 * rest
            return ZERO
        self.last = closing
        return self.restitution

    def _impulse(self, closing: Ball, restitution: Ball) -> Ball:
        return (1 + restitution) * closing * self.constants.harmonic

    def _loss(self, closing: Ball, restitution: Ball) -> Ball:
        return (1 - raised(restitution, 2)) * closing * closing * self.constants.harmonic / 2

    def _steady(self, state: State) -> bool:
        """Whether every arc after a jerk has the accelerations of the first."""
        return not self.slip or all(sign(u) != 0 for u in state.slips)

    def _ending(self, state: State, drive: Drive) -> tuple[Ball | None, Limit | None]:
        first: Ball | None = None
        which: Limit | None = None
        for limit in self.limits:
            time = exit_time(*limit.margin(state, drive))
            if time is not None and (first is None or time < first):
                first, which = time, limit
        return first, which

    def _reversals(self, state: State, drive: Drive) -> list[tuple[Ball, int]]:
        """Return when a line of contact comes to rest, and which."""
        found = []
        if self.slip:
            for i in (0, 1):
                u, rate = state.slips[i], drive.slips[i]
                if sign(u) * sign(rate) < 0:
                    found.append((-u / rate, i))
        return found

    def _glide(
        self, state: State, drive: Drive, impulse: Ball, loss: Ball, jerks: int
    ) -> tuple[Phase, State, Event | None]:
        """Return one stretch without jerks inside, the state after it, and what ends the motion there."""
        duration, limit = self._ending(state, drive)
        closes = exit_time(state.slack, state.opening, -drive.closing) if drive.kind == "slack" else None
        reversals = self._reversals(state, drive)
        inner = closes
        for time, _ in reversals:
            inner = smaller(inner, time)
        if duration is not None and not (inner is not None and inner < duration):
            after = state.after(drive, duration)
            return Phase(state, drive, duration, impulse, loss, jerks), after, Event(limit.kind, after.time)  # type: ignore[union-attr]
        phase = Phase(state, drive, inner, impulse, loss, jerks)
        if inner is None:
            return phase, state, None
        after = state.after(drive, inner)
        if closes is not None and not inner < closes:
            after = replace(after, slack=ZERO)
        self._settle(after, drive, [i for time, i in reversals if not inner < time])
        return phase, self._settled, None

    def _settle(self, after: State, drive: Drive, at_rest: list[int]) -> None:
        """Make slips that have just vanished exact zeros, so that the next law sees them as such."""
        if at_rest and drive.kind == "taut":
            at_rest = [0, 1]
        slips = tuple(ZERO if i in at_rest else after.slips[i] for i in (0, 1))
        if at_rest:
            self.events.append(Event("slip-ends", after.time))
        self._settled = replace(after, slips=slips)

    def _bounce(self, state: State, drive: Drive, impulse: Ball, loss: Ball) -> tuple[Phase, State, Event | None]:
        """Return the whole sequence of jerks that begins here, the state after it, and what ends the motion in it."""
        sequence = Sequence(self.constants, state, drive, self.restitution)
        gains_x, gains_s, gains_u = sequence.gains()
        margins = []
        for limit in self.limits:
            gain = (gains_x if limit.quantity == "positions" else gains_s)[limit.shaft]
            margins.append((*limit.margin(state, drive), limit.way * gain))
        signs = [(state.slips[i], drive.slips[i], gains_u[i]) for i in (0, 1)] if self.slip else []
        before = tuple(sign(u) for u in state.slips)

        def leaves(arc: State, length: Ball) -> Ball | None:
            time, _ = self._ending(arc, drive)
            time = None if time is not None and time > length else time
            for moment, _ in self._reversals(arc, drive):
                if not moment > length:
                    time = smaller(time, moment)
            if time is None and self.slip:
                ended = arc.after(drive, length).after_impulse(self.constants, arc.opening, self.restitution)
                if tuple(sign(u) for u in ended.slips) != before:
                    return length
            return time

        found = sequence.first_arc(margins, signs, leaves)
        if found is None and sequence.limit is None:
            return Phase(state, drive, None, None, ZERO, None, sequence), state, None
        S = sequence.limit if found is None else sequence.sum(found[0])
        n = None if found is None else found[0]
        # The jerks after the first close at w, e w, ...: their sum and the sum of their squares.
        impulse = impulse + self._impulse(state.opening, self.restitution) * S
        loss = loss + self._loss(state.opening, self.restitution) * S * (1 + sequence.ratio(S)) / (1 + self.restitution)
        jerks = None if n is None else n + 1
        if found is None:
            after = sequence.accumulated()
            phase = Phase(state, drive, after.time - state.time, impulse, loss, jerks, sequence)
            self.events.append(Event("jerks-accumulate", after.time))
            return phase, after, None
        _, arc, moment = found
        after = arc.after(drive, moment)
        phase = Phase(state, drive, after.time - state.time, impulse, loss, jerks, sequence, n)
        time, which = self._ending(arc, drive)
        if which is not None and time is not None and not time > moment:
            return phase, after, Event(which.kind, after.time)
        resting = [i for at, i in self._reversals(arc, drive) if not at > moment]
        if not resting:
            # The end of the arc: the jerk that follows reverses a line of contact.
            return phase, replace(after, slack=ZERO, opening=-arc.opening), None
        self._settle(after, drive, resting)
        return phase, self._settled, None


def follow(
    constants: Constants,
    state: State,
    *,
    restitution: float,
    limits: tuple[Limit, ...],
    law: Law,
    slip: bool,
    horizon: float,
) -> Phases:
    """Follow a motion from event to event.

    Parameters
    ----------
    law : callable
        What drives the shafts in a state.
    slip : bool
        Whether the law depends on which way the lines of contact slip.
    horizon : float
        Time past which nothing need be known (s).

    Raises
    ------
    BudgetExceeded
        If sticking and slipping alternate too often before the horizon.
    """
    return EventTracker(constants, exact(restitution), limits, law, slip).follow(state, horizon)


def settled(opening: Ball, terms: Ball) -> Ball:
    """Return a velocity difference, or an exact zero where it is within rounding of its terms."""
    return ZERO if not abs(opening) > exact(ROUNDING) * terms else opening
