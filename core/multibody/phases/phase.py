"""A phase: a time in which nothing changes its state, with the smallest model of the scene that suffices in it."""

from __future__ import annotations

import copy
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from functools import cached_property

from core.errors import NotApplicable
from core.multibody.algebra.polynomials import ONE, ZERO, Ball, evaluated, gradient, is_zero
from core.multibody.contacts.complementarity import Decided
from core.multibody.contacts.contact_responses import slip_rate
from core.multibody.contacts.contact_start import ContactStart
from core.multibody.contacts.contact_states import PhaseTable, Problem, State, forces_of, phase_table
from core.multibody.contacts.projection import project
from core.multibody.equations.dynamics import ForceAtStart, Multipliers, forces_at_start, multipliers_at_start
from core.multibody.equations.expansion import Expansion
from core.multibody.motion.modelling import Modelled, models_of
from core.multibody.phases.accumulation import Accumulation
from core.multibody.phases.tracks import Track, Tracks
from core.multibody.phases.turning_slip import ENDED, turning_model
from core.multibody.phases.uniform_pieces import keeps_its_forces, uniform_motion
from core.multibody.search.bands import FLOOR
from core.multibody.table.connection_effects import Force, Unilateral
from core.multibody.table.description import Described
from core.multibody.table.law_pieces import Argument, switching
from core.systems.trajectory import MotionEvent

ROUNDING = 2.0**-90
"""Share of the largest rate or acceleration up to which one may be what pairs of doubles (2^-106) leave of zero."""


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
    unilateral : list of Unilateral
        The measures; those that slide in space are turned into the direction in which they do at the start.
    unknown : two lists of float, or None
        By how much every coordinate and rate is wrong at the start on all tracks alike.
    end : ball or None
        None for the last.
    bounces : Accumulation or None
        In place of the models, where infinitely many impacts are in the phase.
    tail : Accumulation or None
        Bounces at the end that are alike in the limit only, and so small that they are passed over.
    settles : tuple of str
        The measures that come to rest at the end, after impacts that are not listed.
    arguments : sequence of Argument
        What is zero where formulas change their piece.
    openings : mapping of int to int
        Powers of time with which measures open; zero for those that are open at the start.
    """

    tracks: list[Track]
    models: list[Modelled]
    tables: list[PhaseTable]
    states: list[State]
    unilateral: list[Unilateral]
    unknown: tuple[list[float], list[float]] | None = None
    end: Ball | None = None
    bounces: Accumulation | None = None
    tail: Accumulation | None = None
    settles: tuple[str, ...] = ()
    arguments: Sequence[Argument] = ()
    openings: Mapping[int, int] = field(default_factory=dict)

    @property
    def start(self) -> Ball:
        """Time at which it begins."""
        return self.tracks[0].time

    @cached_property
    def uniform(self) -> bool:
        """Whether every acceleration is constant, and, where a contact is closed, every force."""
        if not all(model.whole.uniform for model in self.models):
            return False
        return all(row is None for row in self.tables[0].normal) or self.constant_forces

    @cached_property
    def constant_forces(self) -> bool:
        """Whether the forces of a motion with constant accelerations are constant."""
        return keeps_its_forces(self.tables[0].table, self.exact_motions[0])

    @property
    def _rounding(self) -> float:
        """Share to which its start is known: a state of two tracks has rounded places."""
        return 0.0 if len(self.tracks) == 1 else ROUNDING

    @cached_property
    def exact_motions(self) -> list[Expansion]:
        """The motion on every track from the start of the phase, where accelerations are constant."""
        found = [self.start_forces[0]]
        for model in self.models[1:]:
            found.append(multipliers_at_start(model.described.measures, model.whole.acceleration, self._rounding))
        tracks = zip(self.tables, self.models, found, strict=True)
        return [uniform_motion(table.table, model.whole.acceleration, forces) for table, model, forces in tracks]

    @cached_property
    def start_forces(self) -> tuple[Multipliers, list[ForceAtStart]]:
        """Multipliers at its start, and the forces of connections."""
        measures = self.models[0].described.measures
        multipliers = multipliers_at_start(measures, self.models[0].whole.acceleration, self._rounding)
        return multipliers, forces_at_start(measures, multipliers)

    @cached_property
    def determined(self) -> list[bool]:
        """Which of the forces the scene determines; some are zero along an axis at the start alone."""
        multipliers, forces = self.start_forces
        lines = [self._first_lines(force) for force in self.models[0].described.measures.forces]
        return [
            force.value is not None and not any(multipliers.elimination.reduced(line, ZERO)[0] for line in own)
            for force, own in zip(forces, lines, strict=True)
        ]

    def pulls(self, force: int) -> bool:
        """Return whether a force is certainly positive at the start."""
        value = self.start_forces[1][force].value
        return value is not None and bool(value > 0)

    def _first_lines(self, force: Force) -> list[Mapping[int, Ball]]:
        """Return the factors of multipliers in a force just after the start, of the first power of time with any.

        What turns with several pushes, as the friction of a shape with its corners, has to know each of them.
        """
        whole = self.models[0].whole
        rows = whole.turns_with(force)
        if rows:
            return [{row: ONE} for row in rows]
        table = whole.measures.table
        for change in (None, table.v, whole.acceleration):
            line = {
                r: evaluated(poly, table.q)
                if change is None
                else sum((evaluated(x, table.q) * change[i] for i, x in gradient(poly).items()), ZERO)
                for r, poly in force.terms
            }
            found = {r: x for r, x in line.items() if not is_zero(x)}
            if found:
                return [found]
        return [{}]

    @property
    def turning(self) -> bool:
        """Whether friction turns with the slip."""
        return any(row.slide is not None for row in self.tables[0].table.rows)

    @property
    def share(self) -> float:
        """Share of the largest rates by which what is known of its end is wrong at least."""
        return ENDED if self.turning else FLOOR

    @property
    def still(self) -> list[bool]:
        """Which coordinates are constants of its motion."""
        return [not any(expression) for expression in self.models[0].whole.reduced.expressions]


@dataclass
class PhaseMotion:
    """The motion of a scene through its phases.

    Attributes
    ----------
    base : Described
        The scene without its unilateral measures.
    unilateral : sequence of Unilateral
    phases : list of Phase
    events : list of MotionEvent
    noticed : list of str
    problem : Problem or None
        What ended the motion, where mechanics does not decide.
    ended : MotionEvent or None
        The event that ended it.
    impacts : list of (int, str, ball or None)
        Work of every impulse: the number of the phase that begins with it, the measure, and the work (J), None where
        contacts could share it otherwise. A ball about zero is what bounces that are left out may take.
    fastest : dict of str to float
        The largest rates by their units, beside which a rate that is zero when it is sampled has its error.
    before : MotionEvent or None
        The event up to which the first phase is followed backwards.
    """

    base: Described
    unilateral: Sequence[Unilateral]
    phases: list[Phase] = field(default_factory=list)
    events: list[MotionEvent] = field(default_factory=list)
    noticed: list[str] = field(default_factory=list)
    problem: Problem | None = None
    ended: MotionEvent | None = None
    impacts: list[tuple[int, str, Ball | None]] = field(default_factory=list)
    fastest: dict[str, float] = field(default_factory=dict)
    before: MotionEvent | None = None

    @property
    def smooth(self) -> bool:
        """Whether nothing is unilateral, in pieces, or begins and ends: a method may compute the one phase as well."""
        return not self.unilateral and not switching(self.base.measures.table.laws) and not self.base.scene.changes


def phase_of(
    base: Described,
    found: Decided,
    turning: Mapping[str, int | None],
    tracks: Tracks,
    start: ContactStart,
    opening: Mapping[int, int],
) -> Phase:
    """Return the phase that begins at the present state.

    Parameters
    ----------
    turning : mapping of str to int or None
        Contacts whose friction turns with their slip, and the powers of time with which slips begin from rest.
    opening : mapping of int to int
        See `Phase.openings`.

    Where the state is known from two tracks, each is put onto the rows of the phase: it came there by a series.
    """
    each, models, tables = [], [], []
    # What begins to slide in space has no slip yet: what rounding leaves of one would be a direction.
    rests = [one.across is not None and is_zero(slip_rate(one, *tracks.wide())) for one in found.unilateral]
    onsets = [State.STICK if begun and state.sense else state for begun, state in zip(rests, found.states, strict=True)]
    # What lets go still touches, at rest.
    onsets = [State.CLOSED if opening.get(i, 0) > 1 else state for i, state in enumerate(onsets)]
    for track in tracks.each:
        phase = phase_table(base.measures.table, found.unilateral, found.states, track.q, track.v)
        phase.table.rows = [
            replace(row, begins=turning[row.name]) if row.name in turning else replace(row, slide=None)
            for row in phase.table.rows
        ]
        if not tracks.exact:
            onto = phase_table(base.measures.table, found.unilateral, onsets, track.q, track.v).table
            project(onto, tracks.wide()[0])
            tracks.settle(onto.q, onto.v)
            phase.table.q, phase.table.v = onto.q, onto.v
            if track is tracks.first:
                table = phase.table
                # What is zero as far as it is known becomes zero on all tracks, which may then agree too well.
                known = tracks.wide()
                lost = [
                    [_apart(x, y) for x, y in zip(*both, strict=True)]
                    for both in zip((table.q, table.v), known, strict=True)
                ]
                tracks.lose(*lost)
        models.append(model_of(base, found, phase, start, 0.0 if tracks.exact else ROUNDING))
        each.append(Track(track.time, phase.table.q, phase.table.v))
        tables.append(phase)
    unknown = tracks.lost if any(map(any, tracks.lost)) else None
    return Phase(each, models, tables, found.states, found.unilateral, unknown, openings=opening)


def model_of(
    base: Described, decided: Decided, phase: PhaseTable, start: ContactStart, rounding: float = 0.0
) -> Modelled:
    """Return the models of the table of a phase; a series runs in pairs, judged by a coarser one.

    Raises
    ------
    NotApplicable
        Where something moves that a law takes to be at rest.
    """
    measures = copy.copy(base.measures)
    measures.table = phase.table
    measures.forces = [*base.measures.forces, *forces_of(decided.unilateral, decided.states, phase)]
    own = replace(base, measures=measures)
    if any(row.slide is not None for row in phase.table.rows):
        found = turning_model(own, decided.unilateral, phase.normal, start)
    else:
        found = models_of(own, start.moved, start.fitted, rounding)
        for _, motion in found.whole.parts:
            motion.keep_to_pairs()
    for kept in measures.kept:
        if not found.whole.keeps(kept.measure):
            raise NotApplicable(kept.rule, path=kept.path, remedy=kept.remedy)
    return found


def _apart(now: Ball, known: Ball) -> float:
    """Return how far a number is at most from what is known of it."""
    return abs(float((now - known).mid())) + float(known.rad())
