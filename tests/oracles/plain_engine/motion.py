"""The motion of a scene from event to event."""

from __future__ import annotations

from collections.abc import Sequence
from contextlib import suppress
from dataclasses import dataclass, field, replace
from functools import partial

import numpy as np

from core.multibody.language.scene import Scene
from tests.oracles.plain_engine.combinations import LEAST
from tests.oracles.plain_engine.coordinates import Floats, State
from tests.oracles.plain_engine.decisions import decide
from tests.oracles.plain_engine.impacts import impact
from tests.oracles.plain_engine.mechanism import Mechanism, NotSupported, Undecided
from tests.oracles.plain_engine.modes import OPEN, Kind
from tests.oracles.plain_engine.phase import Inconsistent, Key, Phase
from tests.oracles.plain_engine.readouts import forces_of, of_chains
from tests.oracles.plain_engine.stages import Stages
from tests.oracles.plain_engine.start import TOUCHING, start
from tests.oracles.plain_engine.steps import Crossing, Stepper

MOST_EVENTS = 300
AT_ONCE = 60
"""Impacts at one instant after which there is no end of them."""
SHORT = 1e-6
"""Length (m) at which one vanishes soon, in a time that its rate tells."""
SETTLED = 1e-5
"""Share of the largest rate so far below which what bounces comes to rest: what the rest of the bounces move is of
second order in it."""
LISTED = 12
"""Impacts of one contact in a row before it may come to rest."""
FEW = 3
"""The same of bounces a tenth as fast, which are hardly higher than gaps are known."""
SOON = 1e-4
"""Time (s) after which a quantity that has a value at the start of a phase shows on which side of it it goes on."""
APPROACHES = 1e-9
"""Share of the largest rate at which a gap closes that is none."""


@dataclass(frozen=True)
class Event:
    """Something that happens; its time may be known less exactly than the motion, by an error (s)."""

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
    accelerations : ndarray or None
        At the start.
    """

    mechanism: Mechanism
    events: list[Event] = field(default_factory=list)
    ended: Event | None = None
    states: dict[float, State] = field(default_factory=dict)
    forces: dict[float, dict[str, float]] = field(default_factory=dict)
    accelerations: Floats | None = None


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
    return _Run(Stages(scene, faster, heavier), sorted(times), tolerance, faster).go()


class _Run:
    def __init__(self, stages: Stages, times: list[float], tolerance: float, faster: float) -> None:
        self.stages, self.times, self.tolerance = stages, times, tolerance
        self.mechanism = stages.mechanism
        self.motion = Motion(self.mechanism)
        self.state, self.touching = start(self.mechanism, faster)
        self.now = 0.0
        self.phase: Phase | None = None
        self.fastest = 0.0
        self.bounces: dict[int, int] = {}
        self.stays = 0

    def go(self) -> Motion:
        """Follow the motion to its end."""
        end = max(self.times, default=0.0)
        try:
            with np.errstate(all="ignore"):
                while len(self.motion.events) <= MOST_EVENTS:
                    self._collide()
                    if self._change():
                        continue
                    phase = decide(self.mechanism, self.state, self.touching, self._probe, self.fastest)
                    self._tell(phase)
                    self.phase = phase
                    self._see_values(phase)
                    if self._change():
                        continue
                    self.state = Stepper(phase, self.tolerance).project(self.state)
                    self._sample(phase)
                    if self.now >= end or not self._advance(phase, end):
                        return self.motion
        except Undecided as problem:
            self.motion.ended = Event(problem.code, ", ".join(problem.names), self.now)
            return self.motion
        except (Inconsistent, np.linalg.LinAlgError):
            raise NotSupported("no accelerations go with what is held") from None
        raise NotSupported("more events than are followed")

    def _change(self) -> bool:
        """Let begin, end and strike what does so now; return whether there is any of that."""
        due = self.stages.due(self.now, self.motion.events)
        if not due:
            return False
        self.motion.events.extend(Event(entry.what, entry.name, self.now) for entry in due)
        before = {one.name: i for i, one in enumerate(self.mechanism.one_sided)}
        self.state = self.stages.changed(self.state, due)
        self.mechanism = self.motion.mechanism = self.stages.mechanism
        now = {one.name: i for i, one in enumerate(self.mechanism.one_sided)}
        gaps, _ = self.mechanism.gap_rates(self.state)
        begun = [i for name, i in now.items() if name not in before]
        if any(gaps[i] < -TOUCHING for i in begun):
            raise Undecided("cannot-begin", [entry.name for entry in due])
        touched = {i for name, i in now.items() if before.get(name) in self.touching}
        self.touching = sorted(touched | {i for i in begun if gaps[i] < TOUCHING})
        if self.phase is not None:
            modes = [
                self.phase.modes[before[one.name]] if one.name in before else OPEN for one in self.mechanism.one_sided
            ]
            self.phase = Phase(self.mechanism, modes)
        self.bounces = {}
        return True

    def _see_values(self, phase: Phase) -> None:
        """Find on which sides of values quantities are that are waited for."""
        waiting = self.stages.timetable.values()
        if waiting:
            after = self._probe(phase, self.state, SOON)
            for entry in waiting:
                entry.begin(phase, self.state, after)

    def _probe(self, phase: Phase, state: State, time: float) -> State:
        return Stepper(phase, 1e-11).to(state, 0.0, time)

    def _happens(self, kind: str, number: int, after: float = 0.0, error: float = 0.0) -> None:
        name = self.mechanism.one_sided[number].name
        self.motion.events.append(Event(kind, name, self.now + after, error))

    def _collide(self) -> None:
        every = self.mechanism.one_sided
        self.fastest = max(self.fastest, float(np.abs(self.state.rates).max(initial=0.0)))
        for _ in range(AT_ONCE):
            _, rates = self.mechanism.gap_rates(self.state)
            hit = [i for i in self.touching if rates[i] < -APPROACHES * max(self.fastest, LEAST)]
            if not hit:
                return
            settling = {i: left for i in hit if (left := self._settling(i, rates)) is not None}
            restitution = {i: 0.0 if i in settling else every[i].touch.restitution for i in self.touching}
            outcome = impact(self.mechanism, self.state, restitution)
            self.state = replace(self.state, rates=outcome.rates)
            for i, left in settling.items():
                self._happens("settle", i, left, 0.1 * left)
            largest = max(outcome.pushes.values(), default=0.0)
            for i in sorted(outcome.pushes, key=lambda x: (x not in hit, x)):
                if outcome.pushes[i] > APPROACHES * largest and i not in settling:
                    self._happens(every[i].closes, i)
            self.bounces.update((i, self.bounces.get(i, 0) + 1) for i in hit)
        raise Undecided("no-progress")

    def _settling(self, i: int, rates: Floats) -> float | None:
        """Return the time in which the bounces of one contact come to rest; None where that is not at hand."""
        e, name = self.mechanism.one_sided[i].touch.restitution, self.mechanism.one_sided[i].name
        slow = -rates[i] / (SETTLED * self.fastest)
        if self.bounces.get(i, 0) < (LISTED if slow > 0.1 else FEW) or not 0.0 < e < 1.0 or slow > 1.0:
            return None
        # Every bounce takes the part e of the one before.
        last = max(event.time for event in self.motion.events if event.name == name)
        return e * (self.now - last) / (1.0 - e)

    def _tell(self, phase: Phase) -> None:
        """Add the events of what changes its state."""
        before = self.phase.modes if self.phase else phase.modes
        for i, (old, new) in enumerate(zip(before, phase.modes, strict=True)):
            turns = old.kind is new.kind and len(old.along) == 1 and old.along != new.along
            if old.kind is not Kind.OPEN and (old.kind is not new.kind or turns):
                one = self.mechanism.one_sided[i]
                self._happens({Kind.OPEN: one.opens, Kind.STICK: one.sticks}.get(new.kind, "slip"), i)
        if [mode.kind for mode in before] != [mode.kind for mode in phase.modes]:
            self.bounces = {}

    def _sample(self, phase: Phase) -> None:
        if self.motion.accelerations is None:
            self.motion.accelerations = phase.solve(self.state).accelerations
        if self.now in self.times and self.now not in self.motion.states:
            self.motion.states[self.now] = self.state
            self.motion.forces[self.now] = forces_of(phase, self.state)

    def _figures(self, phase: Phase, state: State, kind: str | None = None, number: int = -1) -> dict[Key, float]:
        """Return what has to stay at or above zero, all or that of one kind alone, of gaps one alone."""
        mechanism, found = self.mechanism, dict[Key, float]()
        if kind == "gap":
            return {("gap", number): float(mechanism.gap_rates(state, slice(number, number + 1))[0][0])}
        opened = [i for i in range(len(mechanism.one_sided)) if i not in phase.closed]
        if kind is None and opened:
            gaps, _ = mechanism.gap_rates(state)
            # The other sides of guides stay at zero.
            found |= {("gap", i): float(gaps[i]) for i in opened if not mechanism.one_sided[i].opposite}
        if kind in (None, "rank"):
            found["rank", -1] = phase.independence(state)
        if kind in (None, "span"):
            slack = {mechanism.one_sided[i].name for i in opened}
            spans = enumerate(mechanism.spans(state))
            found |= {("span", k): span - SHORT for k, (name, span, _) in spans if name not in slack}
        if kind in (None, "value"):
            waiting = self.stages.timetable.values()
            found |= {("value", k): entry.above(phase, state) for k, entry in enumerate(waiting)}
        if kind not in ("rank", "span", "value"):
            # Where connections lose their rank there may be no forces.
            with suppress(Inconsistent):
                found |= of_chains(phase, state) | self._forced(phase, state)
        return found

    def _forced(self, phase: Phase, state: State) -> dict[Key, float]:
        if not phase.closed:
            return {}
        solution, fastest = phase.solve(state), max(self.fastest, 1e-9)
        slips = {("slip", i): float(phase.along[i] @ slip) / fastest for i, slip in solution.slips.items()}
        return phase.conditions(solution, phase.closed) | slips

    def _advance(self, phase: Phase, end: float) -> bool:
        """Go to the next event; return whether there is one."""
        figures = partial(self._figures, phase)
        stepper = Stepper(phase, self.tolerance)
        stop = min(end, self.stages.timetable.next_time())
        for found in stepper.until(self.state, self.now, stop, figures, self.times, self._first(phase)):
            if not isinstance(found, Crossing):
                self.now, self.state = found
                self._sample(phase)
                continue
            self.stays = self.stays + 1 if found.time == self.now else 0
            if self.stays > AT_ONCE:
                raise NotSupported("states that change at one instant without an end, as those of corners that meet")
            self.now, self.state = found.time, found.state
            kind, i = found.key
            if kind == "rank":
                self.motion.ended = Event("singular", "", self.now)
                return False
            if found.grazes:
                raise Undecided("grazing-contact", [self.mechanism.one_sided[i].name])
            if kind in ("lift-off", "end-of-chain"):
                self.motion.ended = Event(kind, self.mechanism.chains[i].name, self.now)
                return False
            if kind == "span":
                self.motion.ended = self._vanished(stepper, i)
                return False
            if kind == "value":
                self.stages.timetable.values()[i].pass_through()
            self._touch(phase, [i] if kind == "gap" else [])
            self._require_apart()
            return True
        self._touch(phase, [])
        return stop < end

    def _touch(self, phase: Phase, also: list[int]) -> None:
        """Find what touches at the end of a phase."""
        gaps, _ = self.mechanism.gap_rates(self.state)
        met = [k for k, gap in enumerate(gaps) if gap < TOUCHING]
        self.touching = sorted({*phase.closed, *met, *also})

    def _require_apart(self) -> None:
        """Refuse two ends of outlines that meet: each is nearest to the other, and one contact would count twice."""
        names = [self.mechanism.one_sided[i].name.rpartition(".")[0] for i in self.touching]
        rows = self.mechanism.rows(self.state, self.touching)
        lines = rows.lines[[rows.of("push", i)[0] for i in self.touching]]
        for a, first in enumerate(lines):
            for b, other in enumerate(lines[:a]):
                if names[a] == names[b] != "" and np.abs(first - other).max() < TOUCHING:
                    raise NotSupported("corners that meet round ends")

    def _vanished(self, stepper: Stepper, number: int) -> Event:
        """Return when a length is zero that is short: a power of the time left, which f f''/f'^2 tells."""
        name, span, rate = self.mechanism.spans(self.state)[number]
        step = 1e-3 * span / abs(rate)
        _, _, then = self.mechanism.spans(stepper.to(self.state, 0.0, step))[number]
        power = 1.0 / (1.0 - span * (then - rate) / step / rate**2)
        left = power * span / abs(rate)
        return Event("singular", name, self.now + left, 1e-3 * left)

    def _first(self, phase: Phase) -> float | None:
        """Return a first step within which what has just bounced comes back, if anything does soon."""
        gaps, rates = self.mechanism.gap_rates(self.state)
        fast = [r for i, r in enumerate(rates) if i not in phase.closed and abs(gaps[i]) < TOUCHING and r > 0.0]
        fall = max(float(np.abs(phase.solve(self.state).accelerations).max(initial=0.0)), 1e-9)
        return max(2.0 * min(fast) / fall, 1e-9) if fast else None
