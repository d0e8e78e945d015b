"""Where a phase ends: its first crossing, on every track."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from core.errors import AccuracyUnreachable
from core.multibody.algebra.polynomials import Ball
from core.multibody.contacts.contact_states import State, phase_table
from core.multibody.contacts.projection import project
from core.multibody.equations.expansion import expansion
from core.multibody.motion.whole import Whole
from core.multibody.phases.crossings import Crossing, first_in_closed_form, uniform_motion
from core.multibody.phases.grazing import Graze, grazed
from core.multibody.phases.phase import Phase
from core.multibody.phases.sampled_crossings import KNOWN, Sampled
from core.multibody.phases.taylor_crossings import located
from core.multibody.phases.turning_slip import TurningSlip
from core.multibody.phases.watches import Watch, watches
from core.multibody.table.description import Described
from core.multibody.table.table import Row, Table

_BEYOND = 1.001
"""How far beyond the end of a phase, as a share of it, a gap is looked at that may only just have closed."""


class Undecided(Exception):
    """A gap turns back where it is zero, as far as it is known."""

    def __init__(self, graze: Graze) -> None:
        super().__init__(graze)
        self.graze = graze


def crossings_of(base: Described, phase: Phase, left: Ball, noticed: list[str]) -> list[Crossing]:
    """Return the first crossing of a phase within the time that is left, none where nothing ends it.

    There is one for each track, and two where the motion was exact and is so no more. What only grazes zero before is
    added to what is noticed.

    Raises
    ------
    SingularPlace
        Where the connections lose their hold before.
    AccuracyUnreachable
        If the end cannot be located.
    Undecided
        If it is not known whether a gap closes before that.
    """
    watched = watches(phase.unilateral, phase.states, phase.tables[0])
    found = _crossings(base, phase, watched, left, noticed)
    ends = float(left) if not found else min(float(left), _BEYOND * float(found[0].time))
    graze = grazed(phase, watched, ends)
    if graze is None or (found and graze.watch != found[0].watch and not graze.time < found[0].time):
        return found
    if not graze.closes:
        raise Undecided(graze)
    return found if found and found[0].time < graze.time else _located(phase, graze.watch, float(graze.time))


def _crossings(
    base: Described, phase: Phase, watched: Sequence[Watch], left: Ball, noticed: list[str]
) -> list[Crossing]:
    lengths = any(limit.length is not None for limit in base.measures.limits)
    if phase.uniform and not lengths:
        return _in_closed_form(phase, watched, left, noticed)
    if phase.turning:
        return _while_turning(base, phase, watched, float(left))
    return _sampled(phase, watched, float(left))


def _in_closed_form(phase: Phase, watched: Sequence[Watch], left: Ball, noticed: list[str]) -> list[Crossing]:
    motions = [uniform_motion(table.table, model) for table, model in zip(phase.tables, phase.models, strict=True)]
    first, grazes = first_in_closed_form(motions[0], watched, left)
    noticed.extend(
        f"{w.one.name} touches at rest at {float(phase.start + t):.6g} s, and nothing comes of it"
        for w, t in grazes
        if w.what == "gap"
    )
    if first is None:
        return []
    found = [first]
    for motion in motions[1:]:
        # The other track may come there later than the first, even after the time that is left; or only just not.
        other, _ = first_in_closed_form(motion, [w for w in watched if w == first.watch], 2 * left)
        found.append(first if other is None else other)
    return found


def _while_turning(base: Described, phase: Phase, watched: Sequence[Watch], left: float) -> list[Crossing]:
    """Return the end of a phase in which friction turns: that of a slip, if nothing else comes before."""
    turning = {row.name for row in phase.tables[0].table.rows if row.slide is not None}
    others = [one for one in watched if not (one.what == "slip" and one.one.name in turning)]
    runs = []
    for model, kind in zip([phase.models[0], phase.models[-1]], ("fine", "check"), strict=True):
        (_, motion), *_ = model.whole.parts
        assert isinstance(motion, TurningSlip)
        runs.append(motion.run(kind, left))
    ended = [run.ended for run in runs]
    reach = left if ended[0] is None else min(left, float(runs[0].starts[-1]))
    found = _sampled(phase, others, reach)
    if found or ended[0] is None or runs[0].starts[-1] > left:
        return found
    number = next(i for i, one in enumerate(phase.unilateral) if one.name == (ended[0] or Row("", None, {})).name)
    crossings = []
    states = [State.STICK if i == number else state for i, state in enumerate(phase.states)]
    for run in runs:
        # What is left of the slip is taken out, as the connections would.
        table = phase_table(base.measures.table, phase.unilateral, states, run.table.q, run.table.v).table
        project(table, table.q)
        watch = Watch(number, "slip", phase.unilateral[number])
        crossings.append(Crossing(run.starts[-1], watch, table.q, table.v))
    return crossings


def _sampled(phase: Phase, watched: Sequence[Watch], left: float) -> list[Crossing]:
    tables, wholes = [one.table for one in phase.tables], [model.whole for model in phase.models]
    hit = Sampled(tables[0], wholes[0], watched, tables[-1]).first(left)
    if hit is None:
        return []
    time, watch = hit
    first = _before(tables[0], wholes[0], watched, located(tables[0], wholes[0], watch, time, "fine"))
    watch = first.watch
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
    return [first, located(tables[-1], wholes[-1], watch, float(first.time), "check")]


def _before(table: Table, whole: Whole, watched: Sequence[Watch], found: Crossing) -> Crossing:
    """Return a crossing, or that of something else that is negative there already.

    About when something changes its sign is known less well than events may follow one another.
    """
    while found.time > 0 and found.time.is_finite():
        others = [watch for watch in watched if watch is not found.watch]
        if not others:
            break
        curves, noise = (x[:, 0] for x in Sampled(table, whole, others).curves(np.array([float(found.time)])))
        near = [k for k in range(len(others)) if curves[k] < noise[k]]
        if not near:
            break
        motion = expansion(replace(table, q=found.q, v=found.v), 2)
        lost = [others[k] for k in near if others[k].series(motion)[0] < -float(noise[k]) * KNOWN]
        crossings = [located(table, whole, watch, float(found.time), "fine") for watch in lost]
        crossings = [one for one in crossings if one.time > 0 and one.time < found.time]
        if not crossings:
            break
        found = min(crossings, key=lambda one: float(one.time))
    return found


def _located(phase: Phase, watch: Watch, time: float) -> list[Crossing]:
    """Return the crossing next to a time, by both runs."""
    first = located(phase.tables[0].table, phase.models[0].whole, watch, time, "fine")
    table, whole = phase.tables[-1].table, phase.models[-1].whole
    return [first, located(table, whole, watch, float(first.time), "check")]
