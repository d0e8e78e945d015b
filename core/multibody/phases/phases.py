"""A scene with unilateral measures: from phase to phase, through the events between them.

In a phase every contact is closed, sticks, slides or is open, and the scene is a table like any other. At its end what
approaches collides, then the states of what touches are decided, and the next phase begins; infinitely many bounces are
summed up.
"""

from __future__ import annotations

import copy
import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace

from flint import arb

from core.balls import as_text, distance_bound, precision
from core.errors import AccuracyUnreachable, InvalidParameter, NotApplicable, PlacesDisagree
from core.multibody.algebra.polynomials import ZERO, Ball, evaluated, is_zero
from core.multibody.contacts.complementarity import Decided, decided
from core.multibody.contacts.conditions_of_states import LOOKED
from core.multibody.contacts.contact_responses import slip_rate
from core.multibody.contacts.contact_start import assemble_contacts
from core.multibody.contacts.contact_states import Problem, State, change_of, phase_table
from core.multibody.contacts.impacts import Impact, approaching, impact
from core.multibody.contacts.projection import projected
from core.multibody.contacts.shared_loads import share_that_counts
from core.multibody.equations.dynamics import kinetic
from core.multibody.equations.packed import nearest
from core.multibody.equations.starting_pieces import NoPiece, table_in_pieces
from core.multibody.language.numerals import Numerals
from core.multibody.language.scene import Scene
from core.multibody.phases.changed_connections import Change, changed
from core.multibody.phases.formula_ends import what_ends
from core.multibody.phases.level_phases import rim_that_tips, undecided_spin
from core.multibody.phases.openings import openings
from core.multibody.phases.passing_touch import without_passing_touch
from core.multibody.phases.phase import Phase, PhaseMotion, phase_of
from core.multibody.phases.phase_ends import SingularPlace, Undecided, crossings_of, state_at_time
from core.multibody.phases.recurring_bounces import LATER_LISTED, LISTED, MANY, SMALL, recurring
from core.multibody.phases.schedule import Entry, Schedule
from core.multibody.phases.slow_bounces import NEAR, SLOW, may_strike, rate_share, slowness, stopped_share, time_left
from core.multibody.phases.spun_friction import require_pressed_in_plane
from core.multibody.phases.tracks import Tracks
from core.multibody.phases.turning_slip import onset_power, turns
from core.multibody.phases.watches import Watch
from core.multibody.table.connection_effects import Unilateral
from core.multibody.table.description import Acting, Described, described
from core.multibody.table.facing import facing, is_on_a_corner
from core.multibody.table.law_pieces import Argument, Key, switching
from core.multibody.table.table import Table
from core.systems.trajectory import ImpactErrors, ImpactRates, MotionEvent

MOST_EVENTS = 500
"""Events that one question may have: what bounces elastically never ends."""
PRECISIONS = (480, 1280)
"""Precisions of a motion: the second where, in closed form, balls have become wide. An impact takes three bits."""
EXACT = 2.0**-130
"""Share up to which the width of a state in balls is nothing."""
_STILL = 60
"""Events at one time before no motion is seen in them."""


def motion_in_phases(scene: Scene, end: float, numerals: Callable[[], Numerals] | None = None) -> PhaseMotion:
    """Return the phases of a scene up to a time, whose numbers may be read in another way.

    Raises
    ------
    InvalidParameter
        For a scene that cannot be.
    AccuracyUnreachable
        If the first event cannot be located; a later one ends the motion.
    """
    for bits in PRECISIONS:
        with precision(bits):
            read = None if numerals is None else numerals()
            run = _Run(described(scene, read, one_sided=True), end, last=bits == PRECISIONS[-1])
            try:
                run.go()
            except _TooWide:
                continue
            return run.motion
    raise AssertionError("the last precision goes on without exact balls")


class _TooWide(Exception):
    """The balls of a motion in closed form have become wide: more bits keep them exact for longer."""


class _Run:
    def __init__(self, base: Described, end: float, *, last: bool) -> None:
        self.base, self.last = base, last
        # What has the double of the last time is asked for: a time is the decimal of which that is the nearest one.
        self.end = arb(end) + math.ulp(end) / 2 if end > 0.0 else ZERO
        self.unilateral = base.measures.unilateral
        self.motion = PhaseMotion(base, self.unilateral)
        self.start = assemble_contacts(base)
        self.touching = self.start.touching
        table = base.measures.table
        self.tracks = Tracks(table.units, table.q, table.v)
        self.states = [State.OPEN] * len(self.unilateral)
        self.decided = Decided(self.states, list(self.unilateral))
        self.described, self.arguments = base, dict[Key, Argument]()
        self.schedule = Schedule.of(base)
        self.acting: Acting = {name: None for name, one in base.measures.timed.items() if one.acts}
        self.passages: list[tuple[Entry, Watch]] = []
        self.turning: dict[str, int | None] = {}
        # What struck together last, and how often in turn.
        self.bounced: tuple[tuple[int, ...], int] = (), 0

    def go(self) -> None:
        """Go through the phases until the end, or until mechanics does not decide."""
        try:
            self._follow()
        except InvalidParameter:
            if self.tracks.exact or not self.motion.phases:
                raise
            # The description is not at fault: what is known of the state does not tell any more what holds it.
            explanation = "the error of the motion has grown as large as the motion, and what holds it cannot be told"
            self._stop(Problem("lost-event", explanation, (), decided_by="an answer up to an earlier time"))
        self.motion.fastest = {"m/s": self.tracks.fastest("m"), "rad/s": self.tracks.fastest("rad")}

    def _follow(self) -> None:
        still, last, known = 0, -1.0, 0
        while self.motion.ended is None:
            if not self._collide():
                return
            if self._changes():
                continue
            problem = self._decide(known)
            if problem is not None:
                self._stop(problem)
                return
            if self._changes():
                continue
            opening = openings(self.base.measures.table, self.decided, self.touching, *self.tracks.wide())
            phase = phase_of(self.base, self.decided, self.turning, self.tracks, self.start, opening)
            phase.arguments = tuple(self.arguments.values())
            if self._ends_at_a_rim(phase):
                return
            self.passages = list(self.schedule.passages(phase))
            if self._changes():
                continue
            self.motion.phases.append(phase)
            known = len(self.motion.events)
            if self._accumulate(phase):
                known = len(self.motion.events)
                continue
            try:
                if not self._advance(phase):
                    return
            except AccuracyUnreachable as lost:
                if len(self.motion.phases) == 1:
                    raise
                self._stop(Problem("lost-event", lost.detail, (), decided_by="an answer up to an earlier time"))
                return
            now = float(self.tracks.time)
            still, last = (still + 1, last) if now <= last else (0, now)
            if still > _STILL:
                self._stop(Problem("no-progress", "events follow one another without any time between them", ()))
                return
            if len(self.motion.events) >= MOST_EVENTS:
                explanation = f"{MOST_EVENTS} events are as many as one question may have, and more would follow"
                decided_by = "another question, from the state that is answered last"
                self._stop(Problem("event-limit", explanation, (), decided_by=decided_by))
                return

    def _changes(self) -> bool:
        """Let begin, end and strike what does so now; return whether there is any of that."""
        due = self.schedule.due(self.tracks.time, self.motion.events)
        if not due:
            return False
        try:
            change = changed(self.described, self.acting, due, self.tracks)
            self.tracks.each = change.each
            begun = self._with_changed_measures(change)
        except InvalidParameter as fault:
            if not self.motion.phases:
                raise
            names = tuple(entry.name for entry in due)
            begins = any(entry.kind == "begin" for entry in due)
            what = "/".join(map(str, fault.path)) or "the places"
            happens = "begin" if begins else "end"
            explanation = f"{', '.join(names)} cannot {happens} here: {what} would have to {fault.rule}"
            decided_by = "places at which it can begin, or another occasion"
            self._stop(Problem("cannot-begin", explanation, names, decided_by=decided_by))
            return True
        self.base = self.described = change.base
        self.acting, self.bounced = change.acting, ((), 0)
        self.touching = begun
        self.motion.events.extend(change.events)
        sudden = [(name, work) for name, work in change.works.items() if not is_zero(work)]
        self.motion.impacts.extend((len(self.motion.phases), name, work) for name, work in sudden)
        return True

    def _with_changed_measures(self, change: Change) -> list[int]:
        """Take up the measures of connections that begin or end; return what touches then."""
        measures, touching = change.base.measures, set(self.touching)
        self.unilateral, self.states = list(self.unilateral), list(self.states)
        q, _ = self.tracks.wide()
        for name in change.names:
            for i in measures.timed[name].unilateral:
                one = measures.unilateral[i]
                gap = evaluated(one.gap, q)
                if not is_zero(gap) and gap < 0:
                    raise PlacesDisagree((), f'be apart: "{one.name}" is missed by {as_text(-gap, 3)}')
                self.unilateral[i], self.states[i] = one, State.OPEN
                touching = touching | {i} if is_zero(gap) else touching - {i}
        return sorted(touching)

    def _ends_at_a_rim(self, phase: Phase) -> bool:
        """End the motion where places of a level rim do not stand for it any more; return whether that is so."""
        q, v = self.tracks.wide()
        tips = rim_that_tips(self.base, phase, q, v)
        if tips is not None:
            self.motion.ended = self._event("singular", tips)
            return True
        spins = undecided_spin(self.base, phase, v)
        if spins is not None:
            self._stop(spins)
        return spins is not None

    def _stop(self, problem: Problem) -> None:
        """End the motion where mechanics does not decide."""
        self.motion.problem = problem
        self.motion.ended = self._event(problem.code, ", ".join(problem.contacts))

    def _event(self, kind: str, name: str) -> MotionEvent:
        """Add an event at the present time."""
        event = MotionEvent(kind, name, nearest(self.tracks.time), self.tracks.late())
        self.motion.events.append(event)
        return event

    def _collide(self) -> bool:
        """Resolve what approaches; return whether that is decided."""
        table, tracks = self.base.measures.table, self.tracks
        for tried in range(_STILL):
            problem = self._face()
            if problem is not None:
                self._stop(problem)
                return False
            q, v = tracks.wide()
            hit = approaching(self.unilateral, self.touching, q, v)
            if not hit:
                if not tried:
                    self._come_to_rest()
                return True
            unilateral, settling, left = self.unilateral, list[int](), 0.0
            for limit in (SLOW, NEAR):
                share = slowness(self.unilateral, hit, self.motion.events, tracks, limit)
                if share > 0.0:
                    left = time_left(unilateral, hit, self.motion.phases[-1], tracks)
                    unilateral, settling = self._settling(share, limit)
                    q, v = tracks.wide()
                outcome = impact(table, unilateral, self.touching, q, v, simultaneous=self.base.scene.simultaneous)
                # Which of small bounces in turn comes first may be beyond what is known of the state.
                if not (isinstance(outcome, Problem) and outcome.code == "simultaneous-impacts"):
                    break
            if isinstance(outcome, Problem):
                self._stop(outcome)
                return False
            alike: list[Impact] = []
            for track in tracks.each if not tracks.exact else ():
                # Rows that follow from others do so on the rows alone: a state beside them would be held by all.
                state, how = projected(table, track.q, track.v, q), self.base.scene.simultaneous
                one = impact(table, unilateral, self.touching, *state, settled=outcome, simultaneous=how)
                if isinstance(one, Problem):
                    self._record(hit, outcome, q, v)
                    self._stop(one)
                    return False
                alike.append(one)
            self._record(hit, outcome.widened(alike), q, v)
            rates = [found.v for found in alike or [outcome]]
            tracks.each = [replace(track, v=v) for track, v in zip(tracks.each, rates, strict=True)]
            self._settled(settling, left)
        self._stop(Problem("no-progress", "impacts follow one another without end", ()))
        return False

    def _come_to_rest(self) -> None:
        """Let contacts rest of which it is not known whether they strike: an impact would have stopped their slip.

        The state is wide enough then for whatever slip the last of their bounces may have left. Without a slip nothing
        but the unknown rate itself is left open, which the contact holds.
        """
        if self.tracks.exact:
            return
        # The end of bounces that are summed up is known.
        ended = self.motion.phases[-1].settles
        beyond = [i for i in self.touching if self.states[i] is State.OPEN and self.unilateral[i].name not in ended]
        settling = may_strike(self.unilateral, beyond, self.motion.events, self.tracks)
        if not settling:
            return
        left = time_left(self.unilateral, settling, self.motion.phases[-1], self.tracks)
        share = stopped_share(self.unilateral, settling, self.tracks)
        if share > 0.0:
            settling = self._settling(share, math.inf)[1]
        self._settled(settling, left)

    def _settled(self, settling: Sequence[int], left: float) -> None:
        """Add the events of bounces that have come to rest, which would have gone on for so long (s) at most."""
        for i in settling:
            settled = self.unilateral[i]
            # The end of bounces that are not listed is an event already.
            listed = settled.name in self.motion.phases[-1].settles
            if self.states[i] is State.OPEN and settled.restitution > 0 and not listed:
                event = self._event("settle", settled.name)
                self.motion.events[-1] = replace(event, error=event.error + left)

    def _face(self) -> Problem | None:
        """Choose what the corners of shapes may meet from the present state on; what leaves an edge touches no more."""
        q, v = self.tracks.wide()
        found = facing(self.unilateral, q, v)
        touching = set(self.touching)
        for i, (one, old) in enumerate(zip(found, self.unilateral, strict=True)):
            if one.facets and not (one.region and (one.gap is old.gap or is_zero(evaluated(one.gap, q)))):
                touching.discard(i)
            elif one.gap is not old.gap:
                touching.add(i)
        self.unilateral, self.touching = found, sorted(touching)
        for i in self.touching:
            if is_on_a_corner(found[i], q, v):
                return Problem(
                    "corner-on-corner",
                    "two corners meet: in which direction they push one another is not determined",
                    (found[i].name,),
                    decided_by="a radius of one of them, as capsules have, or another start",
                )
        return None

    def _settling(self, share: float, limit: float) -> tuple[list[Unilateral], list[int]]:
        """Let what bounces so little come to rest in no time; return the measures, and which of them do.

        The tracks are moved apart by what that omits: a share of the largest rates.
        """
        table, tracks = self.base.measures.table, self.tracks
        tracks.left_out = max(tracks.left_out, share)
        tracks.part(self.motion.phases[-1].still, share, share)
        tracks.lose(*([share * x for x in sizes] for sizes in tracks.motion()))
        q, v = tracks.wide()
        # What is within that of another contact touches it.
        near = [i for i, one in enumerate(self.unilateral) if is_zero(evaluated(one.gap, q))]
        self.touching = sorted({*self.touching, *near})
        settling = [i for i in self.touching if rate_share(self.unilateral[i], tracks) < limit]
        # What each of them takes of the bounces left out is not known, only that it is not more than all take.
        left_out = arb(0, kinetic(replace(table, q=q, v=v)).rad())
        names = [self.unilateral[i].name for i in self.touching]
        self.motion.impacts.extend((len(self.motion.phases), name, left_out) for name in names)
        # They come to rest together.
        return [
            replace(one, restitution=ZERO, tangential=ZERO, order=ZERO) if i in settling else one
            for i, one in enumerate(self.unilateral)
        ], settling

    def _record(self, hit: Sequence[int], outcome: Impact, q: Sequence[Ball], v: Sequence[Ball]) -> None:
        """Add the events of an impact from a state, each with the energy that its connection takes."""
        group, count = self.bounced
        self.bounced = tuple(hit), count + 1 if group == tuple(hit) else 1
        for i in sorted(outcome.impulses, key=lambda i: (i not in hit, outcome.unilateral[i].listed, i)):
            one, balls = outcome.unilateral[i], outcome.components(i)
            impulses = {name: nearest(ball) for name, ball in balls.items()}
            time, late = nearest(self.tracks.time), self.tracks.late()
            work = outcome.works[i]
            loss, known = nearest(ZERO - work), None if i in outcome.shared else work
            if not all(map(math.isfinite, [loss, *impulses.values()])):
                raise NotApplicable(
                    f"the impulse of {one.name}, or the energy that it takes, leaves the range of doubles",
                    path=("bodies",),
                    remedy="choose units in which the numbers are moderate",
                )
            self.motion.impacts.append((len(self.motion.phases), one.name, known))
            errors = ImpactErrors(
                {name: None if known is None else distance_bound(x, impulses[name]) for name, x in balls.items()},
                None if known is None else distance_bound(-work, loss),
            )
            before, after = outcome.rates(i, q, v), outcome.rates(i, q, outcome.v)
            rates = {name: _impact_rates(x, after[name]) for name, x in before.items()}
            self.motion.events.append(MotionEvent(one.closes, one.name, time, late, impulses, loss, errors, rates))

    def _choose(self, q: Sequence[Ball], v: Sequence[Ball]) -> Decided | Problem:
        """Find the pieces of formulas and the states of what touches, which may depend on one another."""
        found: list[Decided | Problem] = []

        def moving(table: Table) -> Table | None:
            found.append(decided(table, self.unilateral, self.touching, q, v))
            states = found[-1]
            if isinstance(states, Problem):
                return None
            return phase_table(table, states.unilateral, states.states, q, v).table

        table = self.described.measures.table
        if not switching(table.laws):
            return decided(table, self.unilateral, self.touching, q, v)
        try:
            chosen = table_in_pieces(table, q, v, moving)
        except NoPiece as fault:
            if not self.motion.phases:
                raise
            if fault.without_value:
                return Problem(
                    "formula",
                    f"a formula of {fault.law.name} has no value from here on: it divides by zero, or leaves the "
                    "domain of a function",
                    (fault.law.name,),
                    decided_by="a formula that has a value there",
                )
            return Problem(
                "formula",
                f"a formula of {fault.law.name} does not say how the motion goes on: either side of the zero on which "
                "it depends leads back to it, or both lead away",
                (fault.law.name,),
                decided_by="friction that holds what is at rest, described by a contact",
            )
        if chosen is None:
            return found[-1]
        measures = copy.copy(self.described.measures)
        measures.table = chosen.table
        self.base = replace(self.described, measures=measures)
        self._switch(chosen.arguments)
        return decided(chosen.table, self.unilateral, self.touching, q, v)

    def _switch(self, arguments: Mapping[Key, Argument]) -> None:
        """Take up the arguments of formulas that hold now; where one has changed its sign there is an event."""
        before = {key: one.sign for key, one in self.arguments.items()}
        changed = [one for key, one in arguments.items() if before.get(key, one.sign) != one.sign]
        for name in dict.fromkeys(name for one in changed for name in one.names):
            self._event("switch", name)
        self.arguments = dict(arguments)

    def _decide(self, known: int) -> Problem | None:
        """Find the states of what touches, and what changes by them; so many events were known before this one."""
        q, v = self.tracks.wide()
        found = self._choose(q, v)
        if isinstance(found, Problem):
            return found
        table = self.base.measures.table
        found = without_passing_touch(self.base, found, self.tracks, self.start)
        require_pressed_in_plane(self.base, found)
        now = phase_table(table, found.unilateral, found.states, q, v)
        self.turning = dict.fromkeys(turns(now.table, [one.name for one in found.unilateral], LOOKED))
        sharing = share_that_counts(now, found.unilateral, found.shares, [*self.turning])
        if sharing:
            return Problem(
                "undetermined-friction",
                "how the load is shared between the contacts is not determined, and their friction depends on it from "
                "here on: what slides begins to turn",
                sharing,
                decided_by="compliances of the contacts, or three of them",
            )
        for one in found.unilateral:
            if one.name not in self.turning or not is_zero(slip_rate(one, q, v)):
                continue
            self.turning[one.name] = onset_power(now.table, one.name)
            if self.turning[one.name] is None:
                return Problem(
                    "turning-onset",
                    "what begins to slide in space while nothing presses it yet may rub along any direction at first",
                    (one.name,),
                    decided_by="a push at the start, or a velocity with which it slides already",
                )
        for one, old, new in zip(self.unilateral, self.states, found.states, strict=True):
            kind = change_of(one, old, new)
            if self.motion.phases and old is State.OPEN and new is not State.OPEN:
                # What closes without an approach that is known has had no impact.
                met = {event.name for event in self.motion.events[known:]} | {*self.motion.phases[-1].settles}
                # Where one corner of a shape takes over from another, the shape has touched before.
                pairs = zip(self.unilateral, self.states, strict=True)
                touched = {other.whole for other, state in pairs if other.whole and state is not State.OPEN}
                kind = "" if one.name in met or one.whole in touched else one.closes
            if kind and self.motion.phases:
                self._event(kind, one.name)
            if old is not new:
                self.bounced = (), 0
        self.decided, self.states = found, found.states
        return None

    def _advance(self, phase: Phase) -> bool:
        """Go to the end of a phase; return whether anything comes after it."""
        end = self.schedule.until(self.end)
        left = end - phase.start
        if not left > 0:
            return False
        try:
            watches = [watch for _, watch in self.passages]
            crossings = crossings_of(self.base, phase, left, self.motion.noticed, watches)
        except Undecided as undecided:
            phase.end = phase.start + undecided.graze.time
            self.tracks.each = [replace(track, time=phase.end) for track in self.tracks.each]
            name = undecided.graze.watch.one.name
            self._stop(
                Problem(
                    "grazing-contact",
                    f"whether {name} is reached is not known: the gap turns back at zero, to the width of its error",
                    (name,),
                    ({name: "touches, and bounces at less than is known"}, {name: "is passed by"}),
                    "a start from which it is clearly reached or missed",
                )
            )
            return False
        except SingularPlace as place:
            phase.end = phase.start + place.time
            lost = None if place.name else what_ends(phase, float(place.time))
            kind, name = ("singular", place.name) if lost is None else (lost.code, ", ".join(lost.contacts))
            self.motion.problem = lost
            self.motion.ended = MotionEvent(kind, name, nearest(phase.end), self.tracks.late() + place.error)
            self.motion.events.append(self.motion.ended)
            return False
        if not crossings and end is self.end:
            return False
        crossings = crossings or state_at_time(phase, end)
        for entry, watch in self.passages:
            if crossings[0].watch is watch:
                entry.passages, entry.side = entry.passages + 1, -entry.side
        first, tracks = crossings[0], self.tracks
        before = phase.tracks if len(phase.tracks) == len(crossings) else phase.tracks * len(crossings)
        tracks.each = [t.after(x.time, phase.still, x.q, x.v) for t, x in zip(before, crossings, strict=True)]
        # Whether what rests has moved is seen from places that are rounded or not, as they are at the end.
        acceleration = phase.models[0].whole.acceleration
        tracks.follow_scales(float(first.time), phase.tracks[0].q, tracks.first.q, acceleration)
        wide = tracks.exact and tracks.width() > EXACT
        if wide and not self.last:
            raise _TooWide
        if wide or not tracks.exact:
            tracks.part(phase.still, phase.share)
        phase.end = tracks.time
        # Where a facet ends, or a height above an edge beyond its ends, another is met, and not necessarily touched.
        facets = first.watch.one.facets
        self._meet(phase, () if first.watch.what == "region" or facets else (first.watch.number,))
        return True

    def _meet(self, phase: Phase, ending: Sequence[int]) -> None:
        """Find what touches at the end of a phase: what was closed, what ended it, and what is met there as well."""
        q, _ = self.tracks.wide()
        closed = [i for i, state in enumerate(phase.states) if state is not State.OPEN]
        met = []
        for i, one in enumerate(self.unilateral):
            gap = evaluated(one.gap, q)
            if i not in closed and (i in ending or is_zero(gap) or bool(gap < 0)):
                met.append(i)
        self.touching = sorted({*closed, *met})
        # The other sides of guides touch all the time.
        names = [self.unilateral[i].name for i in met if self.unilateral[i].opposite is None]
        if len(names) > 1:
            self.motion.noticed.append(f"{', '.join(names)} touch at one time, as far as that is known")

    def _accumulate(self, phase: Phase) -> bool:
        """Pass over infinitely many bounces, where those that follow are alike; return whether that was done."""
        group, count = self.bounced
        if not group:
            return False
        few = len(self.motion.events) >= MANY or rate_share(self.unilateral[group[0]], self.tracks) < SMALL
        listed = count >= (LATER_LISTED if few else LISTED)
        found = recurring(self.unilateral, group, phase, self.tracks, self.end, listed=listed)
        if found is None or self.schedule.forbids([self.unilateral[i].name for i in group]):
            return False
        until = self.schedule.until(self.end)
        if until is not self.end and not phase.start + found.tail.length < until:
            return False
        if not all(found.tail.keeps_sign(one.law, one.sign) for one in phase.arguments if one.sign):
            return False
        phase.end = phase.start + found.tail.length
        phase.settles = tuple(self.unilateral[i].name for i in group)
        if found.exact:
            phase.bounces = found.tail
        else:
            phase.tail = found.tail
        self.tracks.each = found.ends
        if not (self.tracks.exact and found.exact):
            self.tracks.part(phase.still)
        for name in phase.settles:
            self._event("settle", name)
        self._meet(phase, group)
        self.bounced = (), 0
        return True


def _impact_rates(before: Ball, after: Ball) -> ImpactRates:
    """Return a rate before and after an impact with the error of both; what cannot be told from zero is zero."""
    first, then = (0.0 if is_zero(x) else nearest(x) for x in (before, after))
    return ImpactRates(first, then, max(_off(before, first), _off(after, then)))


def _off(ball: Ball, value: float) -> float:
    """Return how far a double is at most from what a ball stands for."""
    off = distance_bound(ball, value)
    return math.inf if off is None else off
