"""The motion of a scene from event to event."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field, replace
from functools import partial

import numpy as np

from core.multibody.audit.bodies import Reader
from core.multibody.audit.definitions import description_of
from core.multibody.language.scene import Scene
from tests.oracles.plain_engine.coordinates import Floats, State
from tests.oracles.plain_engine.decisions import decide
from tests.oracles.plain_engine.impacts import impact
from tests.oracles.plain_engine.mechanism import Mechanism, NotSupported, Undecided
from tests.oracles.plain_engine.phase import OPEN, Conditions, Inconsistent, Kind, Mode, Phase
from tests.oracles.plain_engine.readouts import forces_of
from tests.oracles.plain_engine.start import TOUCHING, start
from tests.oracles.plain_engine.steps import Crossing, Stepper

MOST_EVENTS = 300
SHORT = 1e-4
"""Length (m) at which one vanishes soon, in a time that its rate tells."""
SETTLED = 1e-5
"""Share of the largest rate so far below which what bounces comes to rest: what the rest of the bounces move is of
second order in it."""
LISTED = 12
"""Impacts of one contact in a row before it may come to rest."""
APPROACHES = 1e-9
"""Share of the largest rate at which a gap closes that is none."""


@dataclass(frozen=True)
class Event:
    """Something that happens.

    Attributes
    ----------
    error : float
        Of the time, where it is known to be less exact than the motion (s).
    """

    kind: str
    name: str
    time: float
    error: float = 0.0


@dataclass
class Motion:
    """What the plain engine answers.

    Attributes
    ----------
    ended : Event or None
        What ends the motion before the last time.
    states : dict of float to State
        At the times asked for that are reached.
    forces : dict of float to dict
        Of connections by name (N, N m), those that are determined.
    """

    mechanism: Mechanism
    events: list[Event] = field(default_factory=list)
    ended: Event | None = None
    states: dict[float, State] = field(default_factory=dict)
    forces: dict[float, dict[str, float]] = field(default_factory=dict)
    accelerations: Floats | None = None
    weight: float = 0.0
    modes: list[list[str]] = field(default_factory=list)


def mechanism_of(scene: Scene) -> Mechanism:
    """Return a scene in maximal coordinates.

    Raises
    ------
    NotSupported
        For kinds without a definition.
    """
    found = description_of(scene)
    if found.undefined:
        raise NotSupported("; ".join(sorted(set(found.undefined.values()))))
    return Mechanism(Reader(scene), found.connections)


def follow(
    scene: Scene, times: Sequence[float], *, tolerance: float = 1e-12, faster: float = 1.0, heavier: float = 1.0
) -> Motion:
    """Return the motion of a scene.

    Parameters
    ----------
    times : sequence of float
        At which states and forces are wanted, all at or after the start (s).
    tolerance : float
        Relative error of a step.
    faster, heavier : float
        Factors of all given velocities and of gravity: a start and a scene that are moved a little, with all symmetry.

    Raises
    ------
    NotSupported
        By the name of what is not.
    """
    mechanism = mechanism_of(scene)
    mechanism.gravity = mechanism.gravity * heavier
    return _Run(mechanism, sorted(times), tolerance, faster).go()


class _Run:
    def __init__(self, mechanism: Mechanism, times: list[float], tolerance: float, faster: float) -> None:
        self.mechanism, self.times, self.tolerance = mechanism, times, tolerance
        self.motion = Motion(mechanism)
        self.state, self.touching = start(mechanism, faster)
        still = mechanism.coordinates.start()
        weights = mechanism.coordinates.weights(still, mechanism.gravity)
        self.motion.weight = float(np.abs(weights).max(initial=0.0))
        self.now = 0.0
        self.modes: list[Mode] | None = None
        self.fastest = float(np.abs(self.state.rates).max(initial=0.0))
        self.bounces: dict[int, int] = {}

    def go(self) -> Motion:
        """Follow the motion to its end."""
        end = max(self.times, default=0.0)
        try:
            with np.errstate(all="ignore"):
                while len(self.motion.events) <= MOST_EVENTS:
                    self._collide()
                    phase = decide(self.mechanism, self.state, self.touching, self._probe, self.fastest)
                    self._tell(phase)
                    self.state = Stepper(phase, self.tolerance).project(self.state)
                    self._sample(phase, self.now, self.state)
                    if self.now >= end or not self._advance(phase, end):
                        return self.motion
        except Undecided as problem:
            self.motion.ended = Event(problem.code, ", ".join(problem.names), self.now)
            return self.motion
        except Inconsistent:
            raise NotSupported("no accelerations go with what is held") from None
        raise NotSupported("more events than are followed")

    def _probe(self, phase: Phase, state: State, time: float) -> State:
        return Stepper(phase, 1e-11).to(state, 0.0, time)

    def _collide(self) -> None:
        every = self.mechanism.one_sided
        self.fastest = max(self.fastest, float(np.abs(self.state.rates).max(initial=0.0)))
        for _ in range(60):
            _, rates = self.mechanism.gap_rates(self.state)
            hit = [i for i in self.touching if rates[i] < -APPROACHES * max(self.fastest, 1e-9)]
            if not hit:
                return
            restitution = {i: every[i].restitution for i in self.touching}
            settling = {i: left for i in hit if (left := self._settling(i, rates)) is not None}
            restitution.update(dict.fromkeys(settling, 0.0))
            outcome = impact(self.mechanism, self.state, self.touching, restitution)
            self.state = replace(self.state, rates=self.state.rates + outcome.change)
            for i, left in settling.items():
                self.motion.events.append(Event("settle", every[i].name, self.now + left, 0.1 * left))
            largest = max((push for push, _ in outcome.impulses.values()), default=0.0)
            for i, (push, _) in sorted(outcome.impulses.items(), key=lambda x: (x[0] not in hit, x[0])):
                if push > 1e-9 * largest and i not in settling:
                    self.motion.events.append(Event(every[i].closes, every[i].name, self.now))
            self.bounces.update((i, self.bounces.get(i, 0) + 1) for i in hit)
        raise Undecided("no-progress")

    def _settling(self, i: int, rates: Floats) -> float | None:
        """Return the time in which the bounces of one contact come to rest; None where that is not at hand."""
        one = self.mechanism.one_sided[i]
        e = one.restitution
        if self.bounces.get(i, 0) < LISTED or not 0.0 < e < 1.0 or -rates[i] > SETTLED * self.fastest:
            return None
        free = Phase(self.mechanism, [OPEN if k == i else mode for k, mode in enumerate(self.modes or [])])
        falls = -self.mechanism.gains_of_gaps(self.state, [one], free.solve(self.state).accelerations)[0]
        return None if falls <= 0.0 else 2.0 * e * -float(rates[i]) / (falls * (1.0 - e))

    def _tell(self, phase: Phase) -> None:
        """Add the events of what changes its state."""
        every = self.mechanism.one_sided
        if self.modes is not None:
            for one, old, new in zip(every, self.modes, phase.modes, strict=True):
                if old.kind is Kind.OPEN or (old.kind is new.kind and (len(old.along) != 1 or old.along == new.along)):
                    continue
                kind = one.opens if new.kind is Kind.OPEN else "slip"
                if new.kind is Kind.STICK:
                    kind = "roll" if one.rolls else "stick"
                self.motion.events.append(Event(kind, one.name, self.now))
        if self.modes is not None and [x.kind for x in self.modes] != [x.kind for x in phase.modes]:
            self.bounces = {}
        self.modes = phase.modes
        self.motion.modes.append([mode.shown for mode in phase.modes])

    def _sample(self, phase: Phase, time: float, state: State) -> None:
        if self.motion.accelerations is None:
            self.motion.accelerations = phase.solve(state).accelerations
        if time in self.times and time not in self.motion.states:
            self.motion.states[time] = state
            self.motion.forces[time] = forces_of(phase, state)

    def _figures(self, phase: Phase, state: State) -> dict[tuple[str, int], float]:
        """Return what has to stay at or above zero in a phase."""
        gaps, _ = self.mechanism.gap_rates(state)
        opened = {i for i, mode in enumerate(phase.modes) if mode.kind is Kind.OPEN}
        found = {("gap", i): float(gaps[i]) for i in opened}
        if phase.closed:
            solution = phase.solve(state)
            conditions = Conditions(phase, solution)
            found.update(conditions.determined)
            if conditions.share is not None:
                found["share", -1] = conditions.share
            for i, slip in solution.slips.items():
                found["slip", i] = float(phase.along[i] @ slip) / max(self.fastest, 1e-9)
        slack = {self.mechanism.one_sided[i].name for i in opened}
        spans = enumerate(self.mechanism.spans(state))
        return found | {("span", k): span - SHORT for k, (name, span, _) in spans if name not in slack}

    def _advance(self, phase: Phase, end: float) -> bool:
        """Go to the next event; return whether there is one."""
        stepper = Stepper(phase, self.tolerance)
        figures = partial(self._figures, phase)
        for found in stepper.until(self.state, self.now, end, figures, self.times, self._first(phase)):
            if not isinstance(found, Crossing):
                self.now, self.state = found
                self._sample(phase, self.now, self.state)
                continue
            self.now, self.state = found.time, found.state
            kind, i = found.key
            if found.grazes:
                raise Undecided("grazing-contact", [self.mechanism.one_sided[i].name])
            if kind == "span":
                self.motion.ended = self._vanished(phase, i)
                return False
            gaps, _ = self.mechanism.gap_rates(self.state)
            met = [k for k, gap in enumerate(gaps) if gap < TOUCHING]
            self.touching = sorted({*phase.closed, *met, *([i] if kind == "gap" else [])})
            return True
        return False

    def _vanished(self, phase: Phase, number: int) -> Event:
        """Return when a length is zero that is short: a power of the time left, which f f''/f'^2 tells."""
        name, span, rate = self.mechanism.spans(self.state)[number]
        step = 1e-3 * span / abs(rate)
        _, _, then = self.mechanism.spans(Stepper(phase, self.tolerance).to(self.state, 0.0, step))[number]
        power = 1.0 / (1.0 - span * (then - rate) / step / rate**2)
        left = power * span / abs(rate)
        return Event("singular", name, self.now + left, 1e-3 * left)

    def _first(self, phase: Phase) -> float | None:
        """Return a first step within which what has just bounced comes back, if anything does soon."""
        gaps, rates = self.mechanism.gap_rates(self.state)
        near = [i for i, mode in enumerate(phase.modes) if mode.kind is Kind.OPEN and abs(gaps[i]) < TOUCHING]
        fast = [float(rates[i]) for i in near if rates[i] > 0.0]
        if not fast:
            return None
        fall = max(float(np.abs(phase.solve(self.state).accelerations).max(initial=0.0)), 1e-9)
        return max(2.0 * min(fast) / fall, 1e-9)
