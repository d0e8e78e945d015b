"""A scene with unilateral measures: phases of one motion each, and the events between them.

In a phase every contact is closed, sticks, slides or is open, and the scene is a table like any other, with the
smallest model that suffices. The state is exact, in balls, as long as phases have closed forms. From the first one
that has none on there are two tracks, run by series of different order and tolerance in pairs of doubles: their
difference says how right the state is, and every sign at an event is decided in balls of that width.
"""

from __future__ import annotations

import copy
from collections.abc import Sequence
from dataclasses import dataclass, field, replace

from flint import arb

from core.balls import precision
from core.errors import AccuracyUnreachable, BudgetExceeded, InvalidParameter
from core.multibody.accumulation import Accumulation
from core.multibody.answer import SceneEvent
from core.multibody.assembly import assemble_places, assemble_rates, least_change
from core.multibody.complementarity import Responses, decided, gap_rate, lines_of, responses, slip_rate
from core.multibody.contact_states import PhaseTable, Problem, State, forces_of, phase_table
from core.multibody.crossings import (
    Crossing,
    Sampled,
    SingularPlace,
    Watch,
    first_in_closed_form,
    is_uniform,
    uniform_motion,
    watches,
)
from core.multibody.description import Described, described
from core.multibody.impacts import Impact, approaching, impact
from core.multibody.language import Scene
from core.multibody.measures import Unilateral
from core.multibody.modelling import Modelled, Piece, models_of
from core.multibody.motion import Motion
from core.multibody.numerical import Numerical
from core.multibody.packed import nearest
from core.multibody.polynomials import BITS, ZERO, Ball, evaluated, is_zero, size
from core.multibody.rank import independent
from core.multibody.table import Row, Table

MOST_EVENTS = 500
"""Events that one question may have: what bounces elastically never ends."""
TOUCHING = 1e-9
"""Gap, relative to its terms, below which something touches at the start."""
SHORT = 2.0**-30
"""Share of a scene's own time in which the bounces that are left are alike, where they are not exactly so."""
SLOW = 2.0**-42
"""Share of the largest rate below which several contacts that bounce in turn come to rest."""
LISTED = 12
"""Bounces of one contact that are listed before the rest is summed up."""
FINER_BITS = (1280,)
TOLD = 16.0
"""The difference of the two tracks, times this, is what a state is taken to be wrong by."""
FLOOR = 2.0**-96
"""Share of the largest coordinate of its unit that a state is wrong by at least, once it is not exact."""
EXACT = 2.0**-130
"""Share up to which the width of a state in balls is nothing."""
HELD = 2.0**-240
"""Share of the largest coordinate to which a state is put onto its rows."""
NOUGHT = 2.0**-180
"""Share of the largest rate of its unit below which a rate is what is left of an exact zero."""
_STILL = 60
"""Events at one time before no motion is seen in them."""

Vector = list[Ball]


@dataclass(frozen=True)
class Track:
    """One computation of the motion: its time and state at the start of a phase."""

    time: Ball
    q: Vector
    v: Vector


@dataclass
class Phase:
    """A time in which nothing changes its state.

    Attributes
    ----------
    tracks : list of Track
        One where the state is exact, else two.
    models : list of Modelled
        One for each track.
    tables : list of PhaseTable
    states : list of State
    end : ball or None
        None for the last.
    bounces : Accumulation or None
        In place of the models, where infinitely many impacts are in the phase.
    """

    tracks: list[Track]
    models: list[Modelled]
    tables: list[PhaseTable]
    states: list[State]
    end: Ball | None = None
    bounces: Accumulation | None = None

    @property
    def start(self) -> Ball:
        """Time at which it begins."""
        return self.tracks[0].time


@dataclass
class PhaseMotion:
    """The motion of a scene through its phases.

    Attributes
    ----------
    base : Described
        The scene without its unilateral measures.
    noticed : list of str
    problem : Problem or None
        What ended the motion, where mechanics does not decide.
    """

    base: Described
    unilateral: Sequence[Unilateral]
    phases: list[Phase] = field(default_factory=list)
    events: list[SceneEvent] = field(default_factory=list)
    noticed: list[str] = field(default_factory=list)
    problem: Problem | None = None
    ended: SceneEvent | None = None


def one_sided(scene: Scene) -> bool:
    """Return whether a scene has anything that pushes and does not pull, or a string of which a jerk is foreseen."""
    return any(
        connection.kind == "contact" or getattr(connection, "restitution", None) is not None
        for connection in scene.connections
    )


def motion_in_phases(scene: Scene, end: float) -> PhaseMotion:
    """Return the phases of a scene up to a time; the precision of balls is the caller's.

    Raises
    ------
    InvalidParameter
        For a scene that cannot be.
    BudgetExceeded
        For more events than one question may have.
    """
    for bits in (BITS, *FINER_BITS):
        with precision(bits):
            run = _Run(described(scene, one_sided=True), end, last=bits == FINER_BITS[-1])
            run.assemble()
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
        self.base, self.end, self.last = base, end, last
        self.table: Table = base.measures.table
        self.unilateral = base.measures.unilateral
        self.motion = PhaseMotion(base, self.unilateral)
        self.touching: list[int] = []
        self.tracks: list[Track] = []
        self.states = [State.OPEN] * len(self.unilateral)
        self.bounced: dict[int, int] = {}
        self.floor = FLOOR
        self.largest: tuple[dict[str, float], dict[str, float]] = ({}, {})
        self.moved: list[str] = []
        self.fitted: list[str] = []

    # The start.

    def assemble(self) -> None:
        """Put the start onto what holds and what touches."""
        table, paths = self.table, self.base.paths
        self.moved = assemble_places(table, paths)
        for i, one in enumerate(self.unilateral):
            gap, scale = evaluated(one.gap, table.q), size(one.gap, table.q)
            if is_zero(gap) or bool(abs(gap) < TOUCHING * scale):
                self.touching.append(i)
                if not is_zero(gap):
                    self.moved.append(one.name)
            elif gap < 0:
                raise InvalidParameter(
                    paths.get(one.name.split(".")[0], ()),
                    f'start with what cannot overlap apart: "{one.name}" is missed by {float(-gap):.3g}',
                    remedy="move the bodies apart",
                )
        rows = [Row.held(self.unilateral[i].name, self.unilateral[i].gap) for i in self.touching]
        whole = replace(table, rows=[*table.rows, *rows])
        assemble_places(whole, paths)
        table.q = whole.q
        # Rates that are left out are such that what touches stays, if it can, and rolls or rests, if it can.
        self.fitted = assemble_rates(table, self.base.measures.coordinates.given, paths, rows)
        self._as_written()
        self.tracks = [Track(ZERO, list(table.q), list(table.v))]
        self._scales(self.tracks[0])

    def _as_written(self) -> None:
        """Take gaps to be at rest, and contacts to roll, if that is what rounded velocities say."""
        table, rows = self.table, []
        for i in self.touching:
            one = self.unilateral[i]
            for row in (Row.held(one.name, one.gap), *([Row(one.name, None, one.slip)] if one.slip else [])):
                line = row.line(table.q)
                rate = sum((x * table.v[j] for j, x in line.items()), ZERO)
                terms = sum((abs(x * table.v[j]) for j, x in line.items()), ZERO)
                if is_zero(rate) or bool(abs(rate) < TOUCHING * terms):
                    rows.append(row)
                    if not is_zero(rate) and one.name not in self.fitted:
                        self.fitted.append(one.name)
        if self.fitted:
            start = replace(table, rows=[*table.rows, *rows])
            _projected(start, table.q)
            table.q, table.v = start.q, start.v

    # From event to event.

    def go(self) -> None:
        """Go through the phases until the end, or until mechanics does not decide."""
        still, last = 0, -1.0
        while True:
            if not self._collide():
                return
            problem = self._decide()
            if problem is not None:
                self._stop(problem)
                return
            phase = self._phase()
            self.motion.phases.append(phase)
            if self._accumulate(phase):
                continue
            if not self._advance(phase):
                return
            now = float(self.tracks[0].time)
            still, last = (still + 1, last) if now <= last else (0, now)
            if still > _STILL:
                self._stop(Problem("no-progress", "events follow one another without any time between them", ()))
                return
            if len(self.motion.events) > MOST_EVENTS:
                raise BudgetExceeded(
                    "events", len(self.motion.events), MOST_EVENTS, path=("times",), remedy="ask for a shorter time"
                )

    def _stop(self, problem: Problem) -> None:
        self.motion.problem = problem
        time = self.tracks[0].time
        self.motion.ended = SceneEvent(problem.code, ", ".join(problem.contacts), nearest(time), self._late())
        self.motion.events.append(self.motion.ended)

    def wide(self) -> tuple[Vector, Vector]:
        """Return the state as balls that hold what is known of it."""
        first = self.tracks[0]
        if len(self.tracks) == 1:
            return first.q, first.v
        second = self.tracks[1]
        scales = self._scales(first)
        found = []
        for k, (a, b) in enumerate(((first.q, second.q), (first.v, second.v))):
            found.append(
                [
                    arb(x.mid(), TOLD * float(abs(x - y).mid()) + self.floor * scales[k][i])
                    for i, (x, y) in enumerate(zip(a, b, strict=True))
                ]
            )
        return found[0], found[1]

    def _scales(self, track: Track) -> tuple[list[float], list[float]]:
        """Return the largest coordinate and rate so far of the unit of each."""
        found = []
        for largest, vector in zip(self.largest, (track.q, track.v), strict=True):
            for unit, x in zip(self.table.units, vector, strict=True):
                largest[unit] = max(largest.get(unit, 0.0), abs(float(x.mid())))
            found.append([largest[unit] for unit in self.table.units])
        return found[0], found[1]

    def _lived(self, phase: Phase, crossing: Crossing) -> None:
        """Take account of how large coordinates and rates were during a phase, as far as its ends tell."""
        time, acceleration = float(crossing.time), phase.models[0].whole.acceleration
        for i, unit in enumerate(self.table.units):
            pull = abs(float(acceleration[i].mid()))
            moved = abs(float((crossing.q[i] - phase.tracks[0].q[i]).mid()))
            for largest, x in zip(self.largest, (pull * time * time, max(pull * time, moved / time)), strict=True):
                largest[unit] = max(largest.get(unit, 0.0), x)

    def _late(self) -> float:
        """Return what the time of the present event is wrong by."""
        time = self.tracks[0].time
        error = float(time.rad()) + 2.0**-53 * abs(float(time))
        if len(self.tracks) > 1:
            error += TOLD * abs(float(time - self.tracks[1].time)) + FLOOR * abs(float(time))
        return error

    # Impacts.

    def _collide(self) -> bool:
        """Resolve what approaches; return whether that is decided."""
        q, v = self.wide()
        for _ in range(_STILL):
            hit = approaching(self.unilateral, self.touching, q, v)
            if not hit:
                return True
            unilateral, share = self.unilateral, self._share(hit)
            if share > 0.0:
                # What still bounces so little comes to rest in no time; the tracks are moved apart by what that omits.
                unilateral = [replace(one, restitution=ZERO) for one in self.unilateral]
                self.floor = max(self.floor, share)
                self.tracks = self._apart(self.tracks, share)
                q, v = self.wide()
            outcome = impact(self.table, unilateral, self.touching, q, v)
            if isinstance(outcome, Problem):
                self._stop(outcome)
                return False
            self._record(hit, outcome)
            if len(self.tracks) == 1:
                self.tracks = [replace(self.tracks[0], v=outcome.v)]
            else:
                each = [impact(self.table, unilateral, self.touching, t.q, t.v, settled=True) for t in self.tracks]
                if any(isinstance(one, Problem) for one in each):
                    self._stop(next(one for one in each if isinstance(one, Problem)))
                    return False
                self.tracks = [
                    replace(t, v=one.v) for t, one in zip(self.tracks, each, strict=True) if isinstance(one, Impact)
                ]
            q, v = self.wide()
        self._stop(Problem("no-progress", "impacts follow one another without end", ()))
        return False

    def _share(self, hit: Sequence[int]) -> float:
        """Return how slowly what hits does so, as a share of the largest rate, if it has done so often; else 0."""
        if len(self.motion.events) < LISTED or all(is_zero(self.unilateral[i].restitution) for i in hit):
            return 0.0
        q, v = self.tracks[0].q, self.tracks[0].v
        largest = self.largest[1]
        share = 0.0
        for i in hit:
            fastest = largest.get("rad" if self.unilateral[i].unit == "N m" else "m", 0.0)
            if not fastest > 0.0:
                return 0.0
            share = max(share, abs(float(gap_rate(self.unilateral[i], q, v))) / fastest)
        return share if share < SLOW else 0.0

    def _record(self, hit: Sequence[int], outcome: Impact) -> None:
        first = True
        self.bounced = {hit[0]: self.bounced.get(hit[0], 0) + 1} if len(hit) == 1 else {}
        for i in sorted(outcome.impulses, key=lambda i: (i not in hit, i)):
            one, (push, rub) = self.unilateral[i], outcome.impulses[i]
            impulses = {"normal": nearest(push)}
            if one.slip is not None:
                impulses["friction"] = nearest(rub)
            loss = nearest(outcome.loss) if first else 0.0
            self.motion.events.append(
                SceneEvent(one.closes, one.name, nearest(self.tracks[0].time), self._late(), impulses, loss)
            )
            first = False

    # States.

    def _decide(self) -> Problem | None:
        q, v = self.wide()
        states = decided(self.table, self.unilateral, self.touching, q, v)
        if isinstance(states, Problem):
            return states
        for one, old, new in zip(self.unilateral, self.states, states, strict=True):
            kind = _change(one, old, new)
            if kind and self.motion.phases:
                self.motion.events.append(SceneEvent(kind, one.name, nearest(self.tracks[0].time), self._late()))
            if old is not new:
                self.bounced = {}
        self.states = states
        return None

    # Phases.

    def _phase(self) -> Phase:
        tracks, models, tables = [], [], []
        for track in self.tracks:
            table = phase_table(self.table, self.unilateral, self.states, track.q, track.v)
            if len(self.tracks) > 1:
                _projected(table.table, self.wide()[0])
                self._settled(table.table)
            model = self._model(table)
            tracks.append(Track(track.time, table.table.q, table.table.v))
            models.append(model)
            tables.append(table)
        return Phase(tracks, models, tables, list(self.states))

    def _settled(self, table: Table) -> None:
        """Make exact zeros of what the projection leaves of rates that the rows hold at zero."""
        for largest, vector in zip(self.largest, (table.q, table.v), strict=True):
            for i, (unit, x) in enumerate(zip(table.units, vector, strict=True)):
                if abs(float(x)) <= NOUGHT * largest.get(unit, 0.0):
                    vector[i] = ZERO

    def _model(self, phase: PhaseTable) -> Modelled:
        measures = copy.copy(self.base.measures)
        measures.table = phase.table
        measures.forces = [*self.base.measures.forces, *forces_of(self.unilateral, self.states, phase)]
        found = models_of(replace(self.base, measures=measures), self.moved, self.fitted)
        parts: list[tuple[Sequence[int], Motion]] = []
        for (indices, motion), piece in zip(found.whole.parts, found.pieces, strict=True):
            own = motion
            if isinstance(motion, Numerical):
                own = Numerical.of(piece.table, _pulls(piece), piece.chosen, motion.why)
                # The answer is a run in pairs, judged by a coarser one.
                own.lost_to_doubles = True
            parts.append((indices, own))
        return replace(found, whole=replace(found.whole, parts=parts))

    def _advance(self, phase: Phase) -> bool:
        """Go to the end of a phase; return whether anything comes after it."""
        left = arb(self.end) - phase.start
        if not left > 0:
            return False
        watched = watches(self.unilateral, phase.states, phase.tables[0])
        lengths = [limit for limit in self.base.measures.limits if limit.length is not None]
        if all(is_uniform(model) for model in phase.models) and not lengths:
            crossings = self._closed(phase, watched, left)
        else:
            crossings = self._sampled(phase, watched, float(left))
        if not crossings:
            return False
        watch = crossings[0].watch
        assert watch is not None
        exact = len(crossings) == 1
        self._lived(phase, crossings[0])
        before = phase.tracks if len(phase.tracks) == len(crossings) else phase.tracks * len(crossings)
        self.tracks = [Track(t.time + x.time, x.q, x.v) for t, x in zip(before, crossings, strict=True)]
        if exact and self._width() > EXACT:
            if not self.last:
                raise _TooWide
            exact = False
        if not exact:
            self.tracks = self._apart(self.tracks)
        phase.end = self.tracks[0].time
        q, _ = self.wide()
        closed = [i for i, state in enumerate(phase.states) if state is not State.OPEN]
        met = [
            i for i, one in enumerate(self.unilateral) if i not in closed and (i == watch.number or self._zero(one, q))
        ]
        self.touching = sorted({*closed, *met})
        if len(met) > 1:
            self.motion.noticed.append(
                f"{', '.join(self.unilateral[i].name for i in met)} touch at one time, as far as that is known"
            )
        return True

    def _zero(self, one: Unilateral, q: Vector) -> bool:
        gap = evaluated(one.gap, q)
        return is_zero(gap) or bool(gap < 0)

    def _width(self) -> float:
        track = self.tracks[0]
        scales = self._scales(track)
        return max(
            (
                float(x.rad()) / scale
                for vector, each in zip((track.q, track.v), scales, strict=True)
                for x, scale in zip(vector, each, strict=True)
                if scale > 0.0
            ),
            default=0.0,
        )

    def _own_time(self) -> float:
        """Return the time in which the scene moves by its own size."""
        place, rate = (largest.get("m", 0.0) for largest in self.largest)
        return place / rate if rate > 0.0 else 1.0

    def _apart(self, tracks: Sequence[Track], share: float = FLOOR) -> list[Track]:
        """Return two tracks, the second moved by a share of the largest, so that the growth of errors may be seen.

        Coordinates that were constants of the last phase on both are still the same.
        """
        expressions = self.motion.phases[-1].models[0].whole.reduced.expressions if self.motion.phases else []
        still = [not any(expression) for expression in expressions]
        first, second = _bare(tracks[0]), _bare(tracks[-1])
        scales = self._scales(first)
        vectors = []
        for k, (a, b) in enumerate(((first.q, second.q), (first.v, second.v))):
            moved = []
            for i, (x, y) in enumerate(zip(a, b, strict=True)):
                if still and still[i] and x == y:
                    moved.append(y)
                    continue
                least = share * scales[k][i]
                moved.append(y if abs(float(x - y)) >= least else arb((x + (least if i % 2 else -least)).mid()))
            vectors.append(moved)
        return [first, Track(second.time, *vectors)]

    def _closed(self, phase: Phase, watched: Sequence[Watch], left: Ball) -> list[Crossing]:
        found: list[Crossing] = []
        for table, model in zip(phase.tables, phase.models, strict=True):
            motion = uniform_motion(table.table, model)
            if found:
                chosen = [w for w in watched if w == found[0].watch]
                crossing, _ = first_in_closed_form(motion, chosen, 2 * left)
            else:
                crossing, grazes = first_in_closed_form(motion, watched, left)
                self.motion.noticed.extend(
                    f"{w.one.name} touches at rest at {float(phase.start + t):.6g} s, and nothing comes of it"
                    for w, t in grazes
                    if w.what == "gap"
                )
            if crossing is None:
                return [] if not found else [found[0], found[0]]
            found.append(crossing)
        return found

    def _sampled(self, phase: Phase, watched: Sequence[Watch], left: float) -> list[Crossing]:
        search = Sampled(phase.tables[0], phase.models[0], watched)
        try:
            hit = search.first(left)
        except SingularPlace as place:
            time = phase.start + place.time
            event = SceneEvent("singular", "", float(time), 1e-9 * float(time))
            self.motion.events.append(event)
            self.motion.ended = event
            phase.end = time
            return []
        if hit is None:
            return []
        time, watch = hit
        first = search.refined(watch, time, "fine")
        if not first.time > 0 or not first.time.is_finite():
            since = float(phase.start)
            raise AccuracyUnreachable(
                None,
                1.0,
                f'the event of "{watch.one.name}" {time:.6g} s after {since:.17g} s cannot be located',
                path=("times",),
                remedy=f"ask for earlier times than {since:.6g} s only",
            )
        if first.time > left:
            return []
        if len(phase.models) == 1:
            return [first, search.refined(watch, float(first.time), "check")]
        other = Sampled(phase.tables[1], phase.models[1], watched)
        return [first, other.refined(watch, float(first.time), "check")]

    # Bounces that accumulate.

    def _accumulate(self, phase: Phase) -> bool:
        """Pass over infinitely many bounces, where those that follow are alike; return whether that was done."""
        for i, count in self.bounced.items():
            one = self.unilateral[i]
            if phase.states[i] is not State.OPEN or not 0 < one.restitution < 1:
                continue
            exact = is_uniform(phase.models[0]) and len(one.gap) > 0 and all(len(key) < 2 for key in one.gap)
            if count < LISTED and exact:
                continue
            tails = [self._tail(i, phase, k) for k in range(len(phase.tracks))]
            if any(tail is None for tail in tails):
                continue
            found = [tail for tail in tails if tail is not None]
            length = found[0].length
            if not exact and not length < SHORT * self._own_time():
                continue
            if phase.start + length > self.end or not self._alone(i, phase, found[0]):
                continue
            phase.end = phase.start + length
            if exact:
                phase.bounces = found[0]
            self.tracks = []
            for track, tail in zip(phase.tracks, found, strict=True):
                q, v = tail.limit()
                self.tracks.append(Track(track.time + tail.length, q, v))
            if len(self.tracks) > 1:
                # Over the bounces the acceleration changes in proportion to their length.
                share = float(length) / self._own_time()
                self.tracks = self._apart(self.tracks, max(FLOOR, 0.0 if exact else share * share))
            self.touching = sorted({*(j for j, s in enumerate(phase.states) if s is not State.OPEN), i})
            self.motion.events.append(SceneEvent("settle", one.name, nearest(phase.end), self._late()))
            self.bounced = {}
            # The rate of the gap is zero by construction.
            return True
        return False

    def _tail(self, i: int, phase: Phase, k: int) -> Accumulation | None:
        one, track, table = self.unilateral[i], phase.tracks[k], phase.tables[k].table
        rows, _, slips = lines_of(self.unilateral, [i])
        acceleration = list(phase.models[k].whole.acceleration)
        found = responses(table, rows)
        push, yields, ratio = list(found.columns[0]), found.matrix[0][0], ZERO
        opening = gap_rate(one, track.q, track.v)
        row = Row.held(one.name, one.gap)
        at = replace(table, q=track.q, v=track.v)
        closing = at.convective(row) - sum((x * acceleration[j] for j, x in row.line(track.q).items()), ZERO)
        if not opening > 0 or not closing > 0:
            return None
        e = one.restitution
        if one.slip is not None:
            b, slip = slips[i], slip_rate(one, track.q, track.v)
            along = Row(one.name, None, one.slip)
            gain = sum((x * acceleration[j] for j, x in along.line(track.q).items()), ZERO) - at.convective(along)
            (nn, nt), (tn, tt) = found.matrix
            if is_zero(slip):
                # It slips during an arc, and stops at its end: by as much less, every time, as the arc is shorter.
                share = 2 * gain / (closing * (1 + e))
                ratio = -(tn + share * nn) / (tt + share * nt)
                if not abs(ratio) < one.static:
                    return None
            else:
                ratio = -one.kinetic if slip > 0 else one.kinetic
            push = [x + ratio * y for x, y in zip(push, found.columns[b], strict=True)]
            yields = nn + ratio * nt
            if not is_zero(slip):
                total = (1 + e) * opening / (yields * (1 - e))
                length = 2 * opening / (closing * (1 - e))
                if not abs(slip) > abs(gain) * length + abs((tn + ratio * tt) * total):
                    return None
        if not yields > 0 or not self._pressed(phase, k, found, ratio):
            return None
        return Accumulation(track.q, track.v, acceleration, push, yields, opening, closing, one.restitution)

    def _pressed(self, phase: Phase, k: int, found: Responses, ratio: Ball) -> bool:
        """Return whether what is closed takes its share of every impulse as it is: it is pressed, and sticks."""
        reactions = dict(found.reactions[0])
        if len(found.reactions) > 1:
            for r, x in found.reactions[1].items():
                reactions[r] = reactions[r] + ratio * x
        # The row's multiplier answers an acceleration; an impulse is answered alike.
        for j, (row, slip) in enumerate(zip(phase.tables[k].normal, phase.tables[k].slip, strict=True)):
            push: Ball = ZERO if row is None else reactions.get(row, ZERO)
            if not is_zero(push) and push < 0:
                return False
            rub: Ball = ZERO if slip is None else reactions.get(slip, ZERO)
            if not is_zero(rub) and not abs(rub) < self.unilateral[j].static * push:
                return False
        return True

    def _alone(self, i: int, phase: Phase, tail: Accumulation) -> bool:
        """Return whether nothing else can happen until the bounces end: all else is too far away, or not touched."""
        length = tail.length
        unit = (1 + tail.restitution) * tail.opening / (tail.yields * (1 - tail.restitution))
        reach = [
            length * (abs(v) + abs(a) * length + abs(r) * unit)
            for v, a, r in zip(tail.v, tail.a, tail.push, strict=True)
        ]
        here = phase.tracks[0].q
        around = [arb(x.mid(), float(y.upper())) for x, y in zip(here, reach, strict=True)]
        for j, (one, state) in enumerate(zip(self.unilateral, phase.states, strict=True)):
            if j == i:
                continue
            if state is State.OPEN:
                if not evaluated(one.gap, around) > 0:
                    return False
                continue
            # A contact whose slip the impulses do not stop.
            along = Row(one.name, None, one.slip or {}).line(here)
            jerk = sum((x * tail.push[k] for k, x in along.items()), ZERO)
            if state.sense:
                change = sum((x * tail.a[k] for k, x in along.items()), ZERO)
                if not abs(slip_rate(one, here, tail.v)) > abs(change) * length + abs(jerk) * unit:
                    return False
        return True


def _pulls(piece: Piece) -> Vector:
    """Return how fast a part may come to move: beside an equilibrium its accelerations say nothing of that."""
    found = []
    for i, x in enumerate(piece.acceleration):
        load, mass = piece.table.load.get(i), piece.table.mass.get((i, i))
        free: Ball = ZERO if load is None or mass is None else abs(load / mass)
        found.append(free if float(free) > abs(float(x)) else x)
    return found


def _bare(track: Track) -> Track:
    """Return a track without the width of its balls."""
    return Track(arb(track.time.mid()), [arb(x.mid()) for x in track.q], [arb(x.mid()) for x in track.v])


def _projected(table: Table, around: Sequence[Ball]) -> None:
    """Put a state onto the measures and rates of a table, in balls.

    Rows are redundant if they are within `around`, the places with the width to which they are known: beside the
    measures, redundant rows differ by what the places miss, and a change that undoes both has no bound.
    """
    held = [row for row in table.rows if row.measure is not None]
    chosen = independent(row.line(around) for row in held)
    for _ in range(3):
        lines = [held[i].line(table.q) for i in chosen]
        residuals = [arb(evaluated(held[i].measure or {}, table.q).mid()) for i in chosen]
        step = least_change(table, lines, residuals)
        table.q = [arb((q - d).mid()) for q, d in zip(table.q, step, strict=True)]
    chosen = independent(row.line(around) for row in table.rows)
    lines = [row.line(table.q) for row in table.rows]
    for _ in range(3):
        residuals = [sum((x * table.v[j] for j, x in lines[i].items()), ZERO) - table.rows[i].rate for i in chosen]
        step = least_change(table, [lines[i] for i in chosen], residuals)
        table.v = [arb((v - d).mid()) for v, d in zip(table.v, step, strict=True)]
    # What is left over is far below this: rows hold, and squares complete, as they would in exact numbers.
    for vector in (table.q, table.v):
        scale = max((abs(float(x)) for x in vector), default=0.0)
        vector[:] = [arb(x.mid(), HELD * scale) for x in vector]


def _change(one: Unilateral, old: State, new: State) -> str:
    """Return what the event is called by which a state changes; nothing for a closing, which is an impact."""
    if old is new:
        return ""
    if new is State.OPEN:
        return one.opens
    if old is State.OPEN:
        return ""
    if new is State.STICK:
        return "roll" if one.rolls else "stick"
    return "slip"
