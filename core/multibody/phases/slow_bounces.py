"""Bounces of several contacts in turn, which have no common limit that could be summed up: slow ones come to rest."""

from __future__ import annotations

import math
from collections import Counter
from collections.abc import Sequence

from core.multibody.algebra.polynomials import is_zero
from core.multibody.contacts.contact_responses import across_rate, gap_rate, slip_rate
from core.multibody.phases.recurring_bounces import LISTED
from core.multibody.phases.tracks import Tracks
from core.multibody.table.connection_effects import Unilateral
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


def stopped_share(
    unilateral: Sequence[Unilateral], touching: Sequence[int], events: Sequence[MotionEvent], tracks: Tracks
) -> float:
    """Return how much of a slip bounces may have stopped of which it is not known whether they strike, as a share.

    Of the largest rate; zero where nothing slips as far as is known, or nothing bounces so.

    Parameters
    ----------
    touching : sequence of int
        Measures that touch now and did not before, and do not approach as far as is known.
    """
    q, v = tracks.wide()
    found = 0.0
    for i in touching:
        one, most = unilateral[i], _fastest(unilateral[i], tracks)
        rate, slips = gap_rate(one, q, v), [slip_rate(one, q, v), across_rate(one, q, v)]
        if most > 0.0 and is_zero(rate) and not all(map(is_zero, slips)) and _bounce_often(unilateral, [i], events):
            slip = sum(float(x.abs_upper()) for x in slips) / most
            # What slips faster than that goes on, but for less than is known of it.
            if slip <= _left(float(rate.abs_upper()) / most, unilateral, [i]):
                found = max(found, slip)
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
