"""Whether the bounces that follow an impact are all alike, so that they may be summed up (`Accumulation`).

They are if the acceleration between them is constant, if the same impulses follow every arc with the same ratios of
friction, if whatever else is closed stays so under every impulse, and if nothing else is met until they end. Several
measures bounce as one where they strike at one time and with one coefficient of restitution, as both corners of a block
that falls flat: the rates of their gaps are then all multiplied by -e, and the next strike is common as well.

Where accelerations change, bounces are alike in the limit only. They are summed up three times, with the accelerations
and rows of the start, of the middle of the first arc and of the place where the first sum ends: the largest difference
is the error, and when it is small enough the rest is passed over.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

from flint import arb

from core.multibody.algebra.polynomials import ONE, ZERO, Ball, enclosed, evaluated, is_zero, size
from core.multibody.contacts.contact_responses import (
    Forces,
    Responses,
    across_rate,
    gap_rate,
    rate_along,
    responses,
    slip_rate,
)
from core.multibody.contacts.contact_states import State, grips
from core.multibody.contacts.projection import projected
from core.multibody.contacts.slip_directions import along_slip
from core.multibody.equations.dynamics import accelerations
from core.multibody.phases.accumulation import Accumulation
from core.multibody.phases.phase import Phase
from core.multibody.phases.shared_impulses import shared_impulses
from core.multibody.phases.tracks import Track, Tracks
from core.multibody.search.bands import FLOOR, SAFETY_FACTOR
from core.multibody.table.connection_effects import Unilateral
from core.multibody.table.table import Row, Table

ALIKE = 2.0**-60
"""Share of the largest rate by which two sums of the bounces that are left may differ: far below doubles."""
LISTED, LATER_LISTED = 12, 3
"""Bounces of one contact that are listed before the rest is summed up: at first; after `MANY` events, or if small."""
MANY = 60
"""Events of a motion after which fewer bounces are listed."""

SMALL = 2.0**-20
"""Share of the largest rate below which bounces are small."""


@dataclass(frozen=True)
class Recurring:
    """Bounces of measures that strike together, alike until they end.

    Attributes
    ----------
    tail : Accumulation
        On the first track.
    exact : bool
        Whether they are alike exactly, and not only in the limit.
    ends : list of Track
        Time and state at their end, on every track; on two at least where they are alike only in the limit.
    """

    tail: Accumulation
    exact: bool
    ends: list[Track]


def recurring(
    unilateral: Sequence[Unilateral], group: Sequence[int], phase: Phase, tracks: Tracks, end: Ball, *, listed: bool
) -> Recurring | None:
    """Return the bounces of measures that follow the start of a phase, None where they do not end as they are.

    Parameters
    ----------
    group : sequence of int
        The measures, which have struck together.
    tracks : Tracks
        The sizes by which errors are measured.
    end : ball
        Time up to which the motion is wanted (s).
    listed : bool
        Whether enough bounces are listed, so that those that follow may be summed up.
    """
    if not listed:
        return None
    every = [unilateral[i] for i in group]
    if not all(phase.states[i] is State.OPEN and 0 < one.restitution < 1 for i, one in zip(group, every, strict=True)):
        return None
    if not all(is_zero(one.restitution - every[0].restitution) for one in every):
        return None
    if any(one.law != "newton" and (one.slip is not None or len(group) > 1) for one in every):
        # The slip that is followed through an impulse changes its rebound from one bounce to the next.
        return None
    exact = phase.models[0].whole.uniform and all(one.gap and all(len(key) < 2 for key in one.gap) for one in every)
    found: list[Accumulation] = []
    known = tracks.wide()[0]
    for k in range(len(phase.tracks)):
        gain = list(phase.models[k].whole.acceleration)
        tail = _tail(unilateral, group, phase, k, phase.tables[k].table, gain, known)
        if tail is None or phase.start + tail.length > end:
            return None
        found.append(tail)
    if exact:
        ends = [_ended(track, tail) for track, tail in zip(phase.tracks, found, strict=True)]
    else:
        limits = _limits(unilateral, group, phase, found, tracks)
        if limits is None:
            return None
        ends = limits
    if not _alone(unilateral, group, phase, found, ends):
        return None
    return Recurring(found[0], exact, ends)


def _ended(track: Track, tail: Accumulation) -> Track:
    return Track(track.time + tail.length, *tail.limit())


def _limits(
    unilateral: Sequence[Unilateral], group: Sequence[int], phase: Phase, tails: Sequence[Accumulation], tracks: Tracks
) -> list[Track] | None:
    """Return the end of bounces that are alike in the limit only, as two sums have it; None where sums differ.

    The first track has the sum by what holds where the bounces begin, the last that which differs most, by what holds
    in the middle of the first of them or at the end. Both are put onto the rows: what is closed is held all the while.
    """
    ends = [_ended(track, tail) for track, tail in zip(phase.tracks, tails, strict=True)]
    k, around = len(tails) - 1, tracks.wide()[0]
    others: list[tuple[Ball, Track, Table]] = []
    # Forces by the place are at the end what they were at the start, and another in between.
    for q, v in (tails[k].state(tails[k].first / 2, ONE), tails[k].limit()):
        table = replace(phase.tables[k].table, q=q, v=v)
        known = [arb(x.mid(), float(y.rad())) for x, y in zip(q, around, strict=True)]
        later = _tail(unilateral, group, phase, k, table, accelerations(table)[0], known)
        if later is None:
            return None
        other = _ended(phase.tracks[k], later)
        change = zip(other.v, ends[k].v, tracks.scales()[1], strict=True)
        if any(abs(float((x - y).mid())) > ALIKE * scale for x, y, scale in change):
            return None
        # What comes to rest has the same rates by all sums, and not at the same time.
        late = abs((other.time - ends[k].time) * later.closing)
        if float(late) > ALIKE * tracks.fastest("rad" if unilateral[group[0]].unit == "N m" else "m"):
            return None
        others.append((late, other, table))
    _, other, table = max(others, key=lambda one: float(one[0]))
    each = ((ends[0], phase.tables[0].table), (other, replace(table, q=other.q, v=other.v)))
    return [Track(end.time, *projected(rows, end.q, end.v, around)) for end, rows in each]


def _tail(
    unilateral: Sequence[Unilateral],
    group: Sequence[int],
    phase: Phase,
    k: int,
    table: Table,
    acceleration: Sequence[Ball],
    known: Sequence[Ball],
) -> Accumulation | None:
    """Return the bounces of measures that follow the start of a track of a phase, None where they are not alike.

    Parameters
    ----------
    table : Table
        Of the phase, at the place whose rows are taken for all of them.
    acceleration : sequence of ball
        Likewise.
    known : sequence of ball
        That place, as far as it is known.
    """
    track = phase.tracks[k]
    turned = along_slip(unilateral, group, track.q, track.v)
    every = [turned[i] for i in group]
    openings = [gap_rate(one, track.q, track.v) for one in every]
    closings = [-acceleration_along(table, Row.held(one.name, one.gap), acceleration) for one in every]
    if not all(x > 0 for x in (*openings, *closings)) or not _together(openings, closings):
        return None
    found = responses(table, every, range(len(every)))
    slips = [slip_rate(one, track.q, track.v) for one in every]
    gains = [acceleration_along(table, Row(one.name, None, one.slip or {}), acceleration) for one in every]
    ratios: list[Ball | None] = [_sliding(one, slip) for one, slip in zip(every, slips, strict=True)]
    if len(every) == 1 and every[0].slip is not None:
        ratios = [_ratio(every[0], found, openings[0], closings[0], gains[0], slips[0])]
    for n, one in enumerate(every):
        if one.across is not None and not _straight(one, n, found, table, track.q, track.v, acceleration):
            return None
    impulses = shared_impulses(found, openings, ratios)
    # Of a level bar on two points one takes nothing of an impulse on the other: a share of rounding is none.
    as_known = responses(replace(table, q=list(known)), every, range(len(every)))
    if impulses is None or not _pressed(unilateral, phase, k, as_known, impulses):
        return None
    columns = [[p * x for x in found.columns[line]] for line, p in impulses.items()]
    push = [sum(parts, ZERO) for parts in zip(*columns, strict=True)]
    restitution = every[0].restitution
    tail = Accumulation(track.q, track.v, acceleration, push, ONE, openings[0], closings[0], restitution)
    if len(every) > 1 and not all(_slides_on(tail, *each) for each in zip(every, gains, slips, strict=True)):
        return None
    return tail


def _together(openings: Sequence[Ball], closings: Sequence[Ball]) -> bool:
    """Return whether gaps that open at some rates, and fall at others, close at one time."""
    w, fall = openings[0], closings[0]
    apart = (x * fall - w * y for x, y in zip(openings, closings, strict=True))
    return all(is_zero(x) or abs(float(x.mid())) <= ALIKE * float(w * fall) for x in apart)


def _sliding(one: Unilateral, slip: Ball) -> Ball:
    """Return the ratio of friction to push of what slides."""
    if is_zero(slip):
        return ZERO
    return -one.kinetic if slip > 0 else one.kinetic


def _slides_on(tail: Accumulation, one: Unilateral, gain: Ball, slip: Ball) -> bool:
    """Return whether a contact among several slides on through all bounces, or does not slide at all."""
    kick = rate_along(Row(one.name, None, one.slip or {}).line(tail.q), tail.push)
    if is_zero(slip):
        return is_zero(gain) and is_zero(kick)
    return bool(abs(slip) > abs(gain) * tail.length + abs(kick) * tail.total)


def acceleration_along(table: Table, row: Row, acceleration: Sequence[Ball]) -> Ball:
    """Return the acceleration along a row, with what its change of direction adds."""
    return rate_along(row.line(table.q), acceleration) - table.convective(row)


def _straight(
    one: Unilateral, n: int, found: Responses, table: Table, q: list[Ball], v: list[Ball], acceleration: Sequence[Ball]
) -> bool:
    """Return whether the slip of bounces in space stays along one direction."""
    gain = acceleration_along(table, Row(one.name, None, one.across or {}), acceleration)
    pushed = found.matrix[found.across[n]]
    along = [pushed[line] for lines in (found.normal, found.slips) for line in lines.values()]
    beside = (across_rate(one, q, v), gain, *along)
    return all(is_zero(x) for x in beside)


def _ratio(one: Unilateral, found: Responses, opening: Ball, closing: Ball, gain: Ball, slip: Ball) -> Ball | None:
    """Return the ratio of friction to push that every impulse has, None where it is not always the same.

    Parameters
    ----------
    opening, closing : ball
        Rate w of the gap after the impact, and gamma at which that falls.
    gain, slip : ball
        Acceleration of the slip during an arc, and its rate at the start.
    """
    e = one.restitution
    (nn, nt), (tn, tt) = (line[:2] for line in found.matrix[:2])
    if is_zero(slip) and not is_zero(one.tangential):
        # What slips during an arc is turned back at its end: the next impulse is another.
        return ZERO if is_zero(gain) and is_zero(tn) else None
    if is_zero(slip):
        # It slips during an arc, and stops at its end: by as much less, every time, as the arc is shorter.
        share = 2 * gain / (closing * (1 + e))
        ratio = -(tn + share * nn) / (tt + share * nt)
        return ratio if abs(ratio) < one.static else None
    ratio = -one.kinetic if slip > 0 else one.kinetic
    total = (1 + e) * opening / ((nn + ratio * nt) * (1 - e))
    length = 2 * opening / (closing * (1 - e))
    return ratio if abs(slip) > abs(gain) * length + abs((tn + ratio * tt) * total) else None


def _pressed(unilateral: Sequence[Unilateral], phase: Phase, k: int, found: Responses, impulses: Forces) -> bool:
    """Return whether what is closed takes its share of every impulse as it is: it is pressed, and sticks."""
    reactions: dict[int, Ball] = {}
    for line, p in impulses.items():
        for r, x in found.reactions[line].items():
            reactions[r] = p * x + reactions.get(r, ZERO)
    # The row's multiplier answers an acceleration; an impulse is answered alike.
    for j, (one, row) in enumerate(zip(unilateral, phase.tables[k].normal, strict=True)):
        push: Ball = ZERO if row is None else reactions.get(row, ZERO)
        if not is_zero(push) and push < 0:
            return False
        rubs = [reactions.get(slip, ZERO) for slip in phase.tables[k].grip(j)]
        if any(not is_zero(rub) for rub in rubs) and not all(x > 0 for x in grips(one.static * push, rubs)):
            return False
    return True


def _alone(
    unilateral: Sequence[Unilateral],
    group: Sequence[int],
    phase: Phase,
    tails: Sequence[Accumulation],
    ends: Sequence[Track],
) -> bool:
    """Return whether nothing else can happen until the bounces end: all else is too far away, or slips too fast.

    A gap may close at their end: one that shrinks all the while, and is not known to be below zero then.
    """
    tail = tails[0]
    length, total, here = tail.length, tail.total, phase.tracks[0].q
    change = [length * abs(a) + abs(r) * total for a, r in zip(tail.a, tail.push, strict=True)]
    around = [_within(x, length * (abs(v) + y)) for x, v, y in zip(here, tail.v, change, strict=True)]
    rates = [_within(v, y) for v, y in zip(tail.v, change, strict=True)]
    for j, (one, state) in enumerate(zip(unilateral, phase.states, strict=True)):
        if not all(enclosed(bound, around) > 0 for bound in one.region):
            return False
        if j in group:
            continue
        if state is State.OPEN and one.opposite is None:
            away = enclosed(one.gap, around) > 0
            if not (away or (gap_rate(one, around, rates) < 0 and _may_be_open(one, ends))):
                return False
        if state.sense:
            # A contact whose slip the impulses do not stop.
            along = Row(one.name, None, one.slip or {}).line(here)
            gain, jerk = rate_along(along, tail.a), rate_along(along, tail.push)
            if not abs(slip_rate(one, here, tail.v)) > abs(gain) * length + abs(jerk) * total:
                return False
    return True


def _may_be_open(one: Unilateral, ends: Sequence[Track]) -> bool:
    """Return whether a gap is not known to be below zero when bounces end."""
    gaps = [evaluated(one.gap, track.q) for track in ends]
    width = ZERO
    if len(ends) > 1:
        width = SAFETY_FACTOR * abs(gaps[0] - gaps[1]) + FLOOR * size(one.gap, ends[0].q)
    return not gaps[0] + width < 0


def _within(middle: Ball, reach: Ball) -> Ball:
    """Return everything that is no farther from a number than so much."""
    return (middle - reach).union(middle + reach)
