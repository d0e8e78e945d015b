"""Bounces of several contacts in turn, which have no common limit that could be summed up: slow ones come to rest."""

from __future__ import annotations

import math
from collections import Counter
from collections.abc import Sequence
from dataclasses import replace

from core.multibody.algebra.polynomials import is_zero
from core.multibody.contacts.contact_responses import across_rate, gap_rate, slip_rate
from core.multibody.equations.dynamics import accelerations
from core.multibody.phases.phase import Phase
from core.multibody.phases.recurring_bounces import LISTED, acceleration_along
from core.multibody.phases.tracks import Tracks
from core.multibody.table.connection_effects import Unilateral
from core.multibody.table.table import Row
from core.systems.trajectory import MotionEvent

SLOW = 2.0**-42
"""Share of the largest rate below which several contacts that bounce in turn come to rest."""
NEAR = 2.0**-36
"""The same where their order is beyond what is known: what is left out stays below the usual accuracy of 1e-9."""
OFTEN = 3
"""Impacts among the last ones by which a contact shows that it bounces in turn with others."""


def slowness(
    unilateral: Sequence[Unilateral], hit: Sequence[int], events: Sequence[MotionEvent], tracks: Tracks, limit: float
) -> float:
    """Return what is left of bounces that are slow, as a share of the largest rate, if there were many; else 0.

    Parameters
    ----------
    hit : sequence of int
        Measures that approach.
    events : sequence of MotionEvent
        All events until now.
    limit : float
        Share of the largest rate below which bounces are slow.
    """
    if not _bounce_often(unilateral, hit, events):
        return 0.0
    share = max(rate_share(unilateral[i], tracks) for i in hit)
    return _left(share, unilateral, hit) if share < limit else 0.0


def may_strike(
    unilateral: Sequence[Unilateral], touching: Sequence[int], events: Sequence[MotionEvent], tracks: Tracks
) -> list[int]:
    """Return which measures have bounced often, and now touch without a rate that is known: they may strike again.

    Parameters
    ----------
    touching : sequence of int
        Measures that touch now and did not before, and do not approach as far as is known.
    """
    q, v = tracks.wide()
    slow = [i for i in touching if is_zero(gap_rate(unilateral[i], q, v))]
    return [i for i in slow if unilateral[i].restitution > 0 and _bounce_often(unilateral, [i], events)]


def stopped_share(unilateral: Sequence[Unilateral], settling: Sequence[int], tracks: Tracks) -> float:
    """Return how much of a slip measures that may strike again may stop then, as a share of the largest rate.

    Zero where nothing slips as far as is known.
    """
    q, v = tracks.wide()
    found = 0.0
    for i in settling:
        one, most = unilateral[i], _fastest(unilateral[i], tracks)
        slips = [slip_rate(one, q, v), across_rate(one, q, v)]
        if most > 0.0 and not all(map(is_zero, slips)):
            slip = sum(float(x.abs_upper()) for x in slips) / most
            # What slips faster than that goes on, but for less than is known of it.
            if slip <= _left(float(gap_rate(one, q, v).abs_upper()) / most, unilateral, [i]):
                found = max(found, slip)
    return found


def time_left(unilateral: Sequence[Unilateral], settling: Sequence[int], phase: Phase, tracks: Tracks) -> float:
    """Return how long (s) bounces at most would have gone on that are left out, as far as accelerations tell.

    Parameters
    ----------
    phase : Phase
        The last one, in which they were open.
    """
    q, v = tracks.wide()
    # As the phase goes on: what has just let go may have had no acceleration at its start.
    table = replace(phase.tables[0].table, q=tracks.first.q, v=tracks.first.v)
    found, acceleration = 0.0, accelerations(table)[0]
    for i in settling:
        one = unilateral[i]
        closing = -acceleration_along(table, Row.held(one.name, one.gap), acceleration)
        rate, bounciness = float(gap_rate(one, q, v).abs_upper()), float(one.restitution)
        if rate > 0.0 and bounciness < 1.0:
            # What is pressed on by other contacts alone has no acceleration of its own.
            arc = 2.0 * rate / float(closing.mid()) if closing > 0 else rate / max(_fastest(one, tracks), rate)
            found = max(found, arc / (1.0 - bounciness))
    return found


def _bounce_often(unilateral: Sequence[Unilateral], hit: Sequence[int], events: Sequence[MotionEvent]) -> bool:
    names = Counter(event.name for event in events[-2 * LISTED :])
    return len(events) >= LISTED and all(names[unilateral[i].name] >= OFTEN for i in hit)


def _left(share: float, unilateral: Sequence[Unilateral], hit: Sequence[int]) -> float:
    """Return all bounces that would follow, each less than the one before by the restitution, and as much again."""
    bounciest = max(float(unilateral[i].restitution) for i in hit)
    return 2.0 * share / (1.0 - bounciest) if bounciest < 1.0 else 0.0


def rate_share(one: Unilateral, tracks: Tracks) -> float:
    """Return the rate of a gap as a share of the largest rate so far of its unit."""
    first, fastest = tracks.first, _fastest(one, tracks)
    return abs(float(gap_rate(one, first.q, first.v))) / fastest if fastest > 0.0 else math.inf


def _fastest(one: Unilateral, tracks: Tracks) -> float:
    return tracks.fastest("rad" if one.unit == "N m" else "m")
