"""Where a phase ends: its first crossing, on every track."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from functools import partial

from flint import arb

from core.errors import AccuracyUnreachable
from core.multibody.algebra.polynomials import Ball, evaluated, gradient, is_zero
from core.multibody.contacts.contact_states import State, phase_table
from core.multibody.contacts.projection import project
from core.multibody.equations.expansion import Series
from core.multibody.equations.packed import two_to
from core.multibody.equations.polynomial_roots import first_negative, sharpened
from core.multibody.motion.numerical import BEFORE_SINGULAR, SINGULAR_TIME_ERROR, Numerical
from core.multibody.motion.whole import Whole
from core.multibody.phases.phase import Phase
from core.multibody.phases.shared_friction import first_without_share
from core.multibody.phases.turning_pieces import ExpandedTurning
from core.multibody.phases.turning_slip import SlipSeries, TurningSlip
from core.multibody.phases.uniform_pieces import ExpandedUniform
from core.multibody.phases.watches import Crossing, Watch, lengths, switches, watches
from core.multibody.reduction.least_places import turns_back_at_zero
from core.multibody.search.bands import FLOOR, SAFETY_FACTOR
from core.multibody.search.first_of_motion import Expansions, FirstOfMotion
from core.multibody.search.followed import Found
from core.multibody.search.location import NotLocated, located, state_after, state_at
from core.multibody.search.pieces import Expanded, ExpandedWhole, repeats_after
from core.multibody.table.connection_effects import Unilateral
from core.multibody.table.description import Described
from core.multibody.trajectory.events import follows, runs_of

_TOO_SHORT = 2.0**-44
"""Share of the time until a slip ends: so short before that end no other event is looked for, as pieces there are
shorter than doubles tell times apart, and what happens is decided anew at the end."""
_TURNED = 2.0**20
"""How much longer than what is not known of the end of a slip the time before it is in which its direction is not known
to a millionth, so that forces have no sign."""


class SingularPlace(Exception):
    """The motion ends in a phase: its connections lose their hold, or a length is zero.

    Attributes
    ----------
    time : ball
        Since the start of the phase.
    error : float
    name : str
        The connection whose length is zero.
    """

    def __init__(self, time: Ball, error: float, name: str = "") -> None:
        super().__init__(time)
        self.time, self.error, self.name = time, error, name


@dataclass(frozen=True)
class Graze:
    """A gap that turns back at zero, as far as it is known.

    Attributes
    ----------
    time : ball
        Since the start of the phase: as wide as the gap stays below what is known of it.
    watch : Watch
    """

    time: Ball
    watch: Watch


class Undecided(Exception):
    """A gap turns back where it is zero, as far as it is known."""

    def __init__(self, graze: Graze) -> None:
        super().__init__(graze)
        self.graze = graze


def state_at_time(phase: Phase, time: Ball) -> list[Crossing]:
    """Return the end of a phase at a time from the start of the scene, which nothing in the motion tells."""
    watch, found = Watch(-1, "time", Unilateral("", {})), list[Crossing]()
    if phase.uniform:
        for track, exact in zip(phase.tracks, phase.exact_motions, strict=True):
            late = time - track.time
            found.append(Crossing(late, watch, *exact.state(late)))
        return found
    motions = expansions_of(phase).places
    tracks = phase.tracks if len(phase.tracks) == len(motions) else phase.tracks * len(motions)
    for track, motion in zip(tracks, motions, strict=True):
        late = time - track.time
        found.append(Crossing(late, watch, *state_after(motion, late)))
    return found if len(found) > 1 else found * 2


def crossings_of(
    base: Described, phase: Phase, left: Ball, noticed: list[str], passages: Sequence[Watch] = ()
) -> list[Crossing]:
    """Return the first crossing of a phase within the time that is left, none where nothing ends it.

    There is one for each track, and two where the motion was exact and is so no more. What only grazes zero before is
    added to what is noticed.

    Parameters
    ----------
    passages : sequence of Watch
        Quantities that may pass through values.

    Raises
    ------
    SingularPlace
        Where the connections lose their hold before, or a length reaches zero.
    AccuracyUnreachable
        If the end cannot be located.
    Undecided
        If it is not known whether a gap closes before that.
    """
    in_closed_form = phase.uniform and len(phase.tracks) == 1
    watched = [
        *watches(phase.unilateral, phase.states, phase.tables[0], phase.openings, of_forces=not in_closed_form),
        *switches(phase.arguments, phase.tables[0].table),
        *lengths(phase.models[0].whole.limits),
        *passages,
    ]
    found = _crossings(base, phase, watched, left, noticed)
    gone = next((watch.one.name for watch in watched if watch.what == "length" and _is_gone(phase, watch, found)), None)
    if gone is not None:
        time = found[0].time
        apart = SAFETY_FACTOR * abs(float(time - found[-1].time))
        raise SingularPlace(time, apart + float(time.rad()) + 2.0**-52 * abs(float(time)), gone)
    return found


def _is_gone(phase: Phase, watch: Watch, found: Sequence[Crossing]) -> bool:
    """Return whether a length is zero at the end of a phase, as far as is known: whatever else happens there."""
    if not found:
        return False
    one, other = (evaluated(watch.one.gap, crossing.q) for crossing in (found[0], found[-1]))
    # A length that is a coordinate has no other terms beside which it is nothing.
    units = phase.tables[0].table.units
    lengths_now = (x for q in (phase.tracks[0].q, found[0].q) for x, unit in zip(q, units, strict=True) if unit == "m")
    known = SAFETY_FACTOR * abs(one - other) + FLOOR * max(map(float, map(abs, lengths_now)))
    return found[0].watch is watch or is_zero(one) or bool(abs(one) <= known)


def _crossings(
    base: Described, phase: Phase, watched: Sequence[Watch], left: Ball, noticed: list[str]
) -> list[Crossing]:
    if phase.uniform and len(phase.tracks) == 1:
        series = [(w, w.series(phase.exact_motions[0])) for w in watched]
        polynomials = [(w, own) for w, own in series if own is not None]
        if len(polynomials) == len(series):
            return _in_closed_form(phase, polynomials, left, noticed)
    if phase.turning:
        return _while_turning(base, phase, watched, float(left))
    if phase.uniform:
        return _searched(phase, watched, float(left))
    return first_without_share(phase, watched, float(left), partial(_searched, phase))


def _in_closed_form(
    phase: Phase, watched: Sequence[tuple[Watch, Series]], left: Ball, noticed: list[str]
) -> list[Crossing]:
    """Return the end of a phase whose state is exact and whose accelerations are constant."""
    motion = phase.exact_motions[0]
    found = [(w, *first_negative(own, left)) for w, own in watched]
    ends = [(root, watch) for watch, root, _ in found if root is not None]
    first = min(ends, key=lambda one: one[0].mid(), default=None)
    noticed.extend(
        f"{watch.one.name} touches at rest at {float(phase.start + time):.6g} s, and nothing comes of it"
        for watch, _, touched in found
        for time in touched
        if watch.what == "gap" and (first is None or time < first[0])
    )
    return [] if first is None else [Crossing(*first, *motion.state(first[0]))]


def _while_turning(base: Described, phase: Phase, watched: Sequence[Watch], left: float) -> list[Crossing]:
    """Return the end of a phase in which friction turns: that of a slip, if nothing else comes before."""
    turning = {row.name for row in phase.tables[0].table.rows if row.slide is not None}
    others = [one for one in watched if not (one.what == "slip" and one.one.name in turning)]
    found = _searched(phase, others, left)
    if found:
        return found
    runs = _runs_of_slip(phase, left)
    ended = runs[0].ended
    if ended is None or runs[0].reached > left:
        return []
    if runs[1].ended is None:
        since = float(phase.start)
        raise AccuracyUnreachable(
            None,
            1.0,
            f'whether "{ended.name}" slips on {float(runs[0].reached):.6g} s after {since:.17g} s is not known',
            path=("times",),
            remedy=f"ask for earlier times than {since:.6g} s only",
        )
    number = next(i for i, one in enumerate(phase.unilateral) if one.name == ended.name)
    crossings = []
    states = [State.STICK if i == number else state for i, state in enumerate(phase.states)]
    (q, v), (other, rates) = (run.end_state() for run in runs)
    scale = FLOOR * max(abs(float(x.mid())) for x in q)
    known = [arb(x.mid(), SAFETY_FACTOR * float(abs(x - y).mid()) + scale) for x, y in zip(q, other, strict=True)]
    for run, state in zip(runs, ((q, v), (other, rates)), strict=True):
        # What is left of the slip is taken out, as the connections would.
        table = phase_table(base.measures.table, phase.unilateral, states, *state).table
        project(table, known)
        watch = Watch(number, "slip", phase.unilateral[number])
        crossings.append(Crossing(run.reached, watch, table.q, table.v))
    return crossings


def _runs_of_slip(phase: Phase, end: float) -> tuple[SlipSeries, SlipSeries]:
    """Return both computations of a motion while friction turns, up to a time or to the end of the slip."""
    first, last = (_turning(model.whole) for model in (phase.models[0], phase.models[-1]))
    run = first.run("fine", end)
    return run, last.run("check", end if run.ended is None else 2.0 * float(run.reached))


def _turning(whole: Whole) -> TurningSlip:
    (_, motion), *_ = whole.parts
    assert isinstance(motion, TurningSlip), "friction that turns has a model of its own"
    return motion


def _before_end_of_slip(phase: Phase, reach: float) -> float:
    """Return the time before which other events are looked for in a phase: a reach, or a little before a slip ends."""
    if not phase.turning:
        return reach
    runs = _runs_of_slip(phase, reach)
    if runs[0].ended is None:
        return reach
    last = float(runs[0].reached)
    apart = abs(float(runs[0].reached - runs[1].reached)) if runs[1].ended is not None else 0.0
    return min(reach, last - max(_TOO_SHORT * last, _TURNED * apart))


def _searched(phase: Phase, watched: Sequence[Watch], left: float) -> list[Crossing]:
    """Return the first crossing of a phase on both of its tracks, none where nothing ends it."""
    expansions, period = expansions_of(phase), repeats_after(phase.models[0].whole)
    search = FirstOfMotion(expansions, [watch.watched for watch in watched])
    last = left if period is None else min(left, period)
    reach, singular = min(last, _first_reach(phase)), None
    while True:
        singular = _singular(phase, watched, reach)
        until = _before_end_of_slip(phase, reach)
        hit = search.until(until if singular is None else min(until, float(singular.time) * BEFORE_SINGULAR))
        if hit is not None or singular is not None or until < reach or reach >= last:
            break
        reach = min(last, 2.0 * reach)
    if singular is not None and (hit is None or hit[1].time > float(singular.time) * BEFORE_SINGULAR):
        # What is found beyond the end of a search is the singular place itself.
        if hit is not None and watched[hit[0]].what == "length":
            singular.name = watched[hit[0]].one.name
        raise singular
    if hit is None:
        return []
    number, one = hit
    watch = watched[number]
    if one.width > 0.0 and watch.what == "length":
        raise SingularPlace(arb(one.time), one.width, watch.one.name)
    if one.width > 0.0:
        turned = _turned_back(phase, expansions.places, watch, one.time, left)
        if not turned:
            raise Undecided(Graze(arb(one.time, one.width), watch))
        return turned
    try:
        crossings = _located(phase, expansions.by(watch.watched), watch, one, left)
    except NotLocated:
        since = float(phase.start)
        raise AccuracyUnreachable(
            None,
            1.0,
            f'the event of "{watch.one.name}" {one.time:.6g} s after {since:.17g} s cannot be located',
            path=("times",),
            remedy=f"ask for earlier times than {since:.6g} s only",
        ) from None
    if crossings[0].time > left:
        return []
    return crossings if one.unsure == 0.0 else _unsure(phase, expansions.places, crossings[0], one.unsure, left)


def _turned_back(phase: Phase, motions: Sequence[Expanded], watch: Watch, time: float, left: float) -> list[Crossing]:
    """Return where a gap turns back exactly at zero, on both tracks; nothing where that is not known."""
    gap = watch.one.gap
    near = state_at(motions[0], time, left)[0]
    if watch.what != "gap" or not turns_back_at_zero(phase.tables[0].table, gap, near):
        return []
    slope = gradient(gap)
    states = [located(motion, lambda pieces: pieces.of_rates(slope), time, 0.0, left) for motion in motions]
    crossings = [Crossing(one.time, watch, one.q, one.v) for one in states]
    return crossings if len(crossings) > 1 else crossings * 2


def _unsure(phase: Phase, motions: Sequence[Expanded], first: Crossing, unsure: float, left: float) -> list[Crossing]:
    """Return a crossing just after the start on both tracks, the second as much later as its time is unsure.

    Rates are as unsure then. What rounding puts before the start is after it.
    """

    def at(time: Ball, track: int) -> Crossing:
        if phase.uniform:
            return Crossing(time, first.watch, *phase.exact_motions[track].state(time))
        return Crossing(arb(float(time)), first.watch, *state_at(motions[track], float(time), left))

    apart = arb(unsure / SAFETY_FACTOR)
    first = first if first.time > 0 else at(apart, 0)
    return [first, at(first.time + apart, -1)]


def _located(phase: Phase, motions: Sequence[Expanded], watch: Watch, found: Found, left: float) -> list[Crossing]:
    """Return a crossing on both tracks, or by both runs."""
    if not phase.uniform:
        states = [located(motion, watch.along, found.time, found.rest, left) for motion in motions]
        crossings = [Crossing(one.time, watch, one.q, one.v) for one in states]
        return crossings if len(crossings) > 1 else crossings * 2
    # Bounces in turn grow shorter than pairs resolve: where accelerations are constant, balls know the state.
    crossings = []
    for motion, expanded in zip(phase.exact_motions, motions, strict=False):
        series = watch.series(motion)
        if series is None:
            one = located(expanded, watch.along, found.time, found.rest, left)
            time, late = one.time, one.width * FLOOR
        else:
            time, late = sharpened(series, arb(found.time) + arb(found.rest)), 0.0
        if not time.is_finite():
            raise NotLocated
        crossings.append(Crossing(time, watch, *motion.state(time)))
    if len(crossings) == 1:
        # The motion was exact, and its time is known in pairs.
        crossings.append(Crossing(time + late, watch, *motion.state(time + late)))
    return crossings


def expansions_of(phase: Phase, coordinates: Sequence[int] | None = None, *, finer: bool = False) -> Expansions:
    """Return the motion on both tracks, or by both of its runs; only one where it is known in closed form.

    Parameters
    ----------
    coordinates : sequence of int, optional
        What is of interest: the expansion of places leaves out parts that these do not follow.
    finer : bool
        Whether the runs are those in pairs of doubles where there is a choice.
    """
    first, last = phase.models[0].whole, phase.models[-1].whole
    if phase.turning:
        both = [ExpandedTurning(first, "fine"), ExpandedTurning(last, "check")]
        return Expansions(both, both)
    if phase.uniform:
        uniform = [ExpandedUniform(motion) for motion in phase.exact_motions]
        forces = uniform if phase.constant_forces else [ExpandedWhole(*run) for run in runs_of(first, last)]
        return Expansions(uniform, forces)
    return Expansions.of(runs_of(first, last, finer=finer), coordinates)


def _first_reach(phase: Phase) -> float:
    """Return how far a search goes at first: series that are followed beyond an event are in vain."""
    if phase.turning:
        return _turning(phase.models[0].whole).first_reach
    known = [motion.in_arrays for _, motion in phase.models[0].whole.parts]
    scales = [one[1].time for one in known if one is not None]
    return 2.0 * two_to(max(scales)) if scales else math.inf


def _singular(phase: Phase, watched: Sequence[Watch], end: float) -> SingularPlace | None:
    """Return the first singular place before a time of a phase, None without one."""
    found = []
    runs = {
        (id(model.whole), kind): model.whole
        for model, kind in zip([phase.models[0], phase.models[-1]], ("fine", "check"), strict=True)
    }
    for (_, kind), whole in runs.items():
        for indices, motion in whole.parts:
            if isinstance(motion, Numerical):
                run = motion.run(kind, end * two_to(-motion.units.time))
                if run.singular and kind == "fine":
                    time = run.end * two_to(motion.units.time)
                    found.append(SingularPlace(arb(time), SINGULAR_TIME_ERROR * time))
            elif (ended := motion.ended(end)) is not None:
                # A closed form ends where a length is zero.
                named = (
                    one.one.name for one in watched if one.what == "length" and follows(whole, one.one.gap, indices)
                )
                found.append(SingularPlace(arb(ended[0]), ended[1], next(named, "")))
    return min(found, key=lambda one: float(one.time), default=None)
