"""What ends a scene: a string that would have to push, a chain that lifts off, a length of zero, a singular place."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import partial
from math import copysign

from core.errors import AccuracyUnreachable, NotApplicable
from core.multibody.algebra.polynomials import ZERO, Poly, is_zero, substituted, variables
from core.multibody.motion.numerical import BEFORE_SINGULAR, SINGULAR_TIME_ERROR
from core.multibody.motion.whole import Whole
from core.multibody.search.bands import FLOOR, SAFETY_FACTOR
from core.multibody.search.curves import Curve
from core.multibody.search.first_of_motion import Expansions, FirstOfMotion, Watched
from core.multibody.search.followed import Found
from core.multibody.search.location import NotLocated, located
from core.multibody.search.pieces import Expanded, Pieces, repeats_after
from core.multibody.table.connection_effects import Limit
from core.systems.trajectory import MotionEvent

OF_LENGTHS = ("singular", "end-of-chain")
"""Ends at which a length is zero: there the motion cannot be expanded."""
_LEAST = 2.0**-1000
"""Force (N) beside which others are lost below the range of doubles."""


@dataclass(frozen=True)
class End:
    """What ends a motion where it falls below zero.

    Attributes
    ----------
    event, name : str
        Kind of the event, and the connection.
    watched : Watched
    length : polynomial or None
        The length that it is, if it is one.
    """

    event: str
    name: str
    watched: Watched
    length: Poly | None = None


def end_of(whole: Whole, limit: Limit) -> End:
    """Return the end of a motion by a limit."""
    length = limit.force is None
    return End(
        limit.event, limit.name, Watched(partial(_along, whole, limit), not length, length, length), limit.length
    )


def first_event(
    whole: Whole, ends: Sequence[End], end: float, expansions_of: Callable[[], Expansions]
) -> MotionEvent | None:
    """Return the first event between the start and `end`, which may be negative; None if there is none.

    Parameters
    ----------
    expansions_of : callable
        Returns the computations of the motion, once they are needed.

    Raises
    ------
    NotApplicable
        Where a force that is watched leaves the range of doubles before any event.
    """
    ended = _singular(whole, ends, end)
    end = end if ended is None else ended.time * BEFORE_SINGULAR
    watched = [one for one in ends if not _safe(whole, one)]
    if not watched or end == 0.0:
        return ended
    _require_weight(whole, watched)
    expansions = expansions_of()
    best: MotionEvent | None = None
    for group, reach in _groups(whole, watched, end):
        quantities = [one.watched for one in group]
        search = FirstOfMotion(expansions, quantities, copysign(1.0, end))
        try:
            hit = search.until(min(reach, abs(end if best is None else best.time)))
        except AccuracyUnreachable:
            raise _out_of_range(group[0]) from None
        if search.below:
            below = group[search.below[0]]
            return MotionEvent(below.event, below.name, 0.0, 0.0)
        if hit is None:
            continue
        number, found = hit
        event = _event(expansions.by(quantities[number]), group[number], found)
        if abs(event.time) <= abs(end) and (best is None or abs(event.time) < abs(best.time)):
            best = event
    return ended if best is None else best


def searched_until(end: float, ended: MotionEvent | None) -> float:
    """Return the time until which quantities are searched (s): not quite to a place where they may be unbounded."""
    if ended is None:
        return end
    if ended.kind in ("formula", "lost-event"):
        # A formula that has lost its value may have done so as its slope grew, and bodies that come close are fast; the
        # pieces of formulas end at a known time.
        return min(end, ended.time - ended.error if ended.error > 2.0**-40 * ended.time else ended.time)
    return min(end, BEFORE_SINGULAR * ended.time if ended.kind in OF_LENGTHS else ended.time)


def _singular(whole: Whole, watched: Sequence[End], end: float) -> MotionEvent | None:
    """Return the first place at which the motion itself ends."""
    found = None
    for indices, motion in whole.parts:
        ended = motion.ended(end)
        if ended is not None:
            # A closed form ends where a length is zero, a series where connections lose their hold.
            named = watched if motion.how == "closed form" else []
            name = next((limit.name for limit in named if follows(whole, limit.length, indices)), "")
            found, end = MotionEvent("singular", name, *ended), ended[0]
    return found


def runs_of(first: Whole, last: Whole, *, finer: bool = False) -> list[tuple[Whole, str]]:
    """Return a motion by the run that is answered and by one that is more right, or in closed form.

    Parameters
    ----------
    first, last : Whole
        The same twice, or what is known of it from two tracks.
    finer : bool
        Whether the runs are those in pairs of doubles where there is a choice.
    """
    if first is last and all(motion.how == "closed form" for _, motion in first.parts):
        return [(first, "fine")]
    in_pairs = finer or first is not last or any(motion.lost_to_doubles for _, motion in first.parts)
    kinds = ("fine", "check") if in_pairs else ("reference", "doubles")
    return list(zip((first, last), kinds, strict=True))


def _groups(whole: Whole, watched: Sequence[End], end: float) -> list[tuple[list[End], float]]:
    """Return what is watched with the time until which it is: where all that it follows repeats, no longer."""
    found: dict[float, list[End]] = {}
    for limit in watched:
        seen = None if limit.length is None else sorted(variables([limit.length]))
        period = repeats_after(whole, seen)
        found.setdefault(abs(end) if period is None else min(abs(end), period), []).append(limit)
    return [(limits, reach) for reach, limits in sorted(found.items())]


def _along(whole: Whole, limit: Limit, pieces: Pieces) -> Curve:
    if limit.force is None:
        return pieces.of(limit.length or {})
    curve = pieces.force(whole.measures.forces[limit.force])
    curve.sizes[:, 0] += limit.scale
    return curve


def _event(motions: Sequence[Expanded], end: End, found: Found) -> MotionEvent:
    if found.width > 0.0:
        return MotionEvent(end.event, end.name, found.time, found.width)
    reach = copysign(max(abs(found.time), 2.0**-1000), found.time)
    try:
        zeros = [located(motion, end.watched.along, found.time, found.rest, reach) for motion in motions]
    except NotLocated:
        # The series of a length that is one of the coordinates do not reach beyond its zero.
        return MotionEvent(end.event, end.name, found.time, SINGULAR_TIME_ERROR * abs(found.time))
    time = float(zeros[0].time)
    error = (found.unsure or FLOOR * zeros[0].width) + 2.0**-52 * abs(time)
    error += SAFETY_FACTOR * abs(float(zeros[0].time - zeros[-1].time))
    if end.watched.singular:
        # Beside a singular place slopes tell nothing; that it lies there is known.
        error = min(error, SINGULAR_TIME_ERROR * abs(time))
    return MotionEvent(end.event, end.name, time, error)


def _out_of_range(limit: End) -> NotApplicable:
    what = "a force" if limit.watched.of_forces else "a length"
    return NotApplicable(
        f"{what} of {limit.name} leaves the range of doubles, and whether it stays positive is not known",
        path=("times",),
        remedy="ask for a shorter time, or choose units in which the numbers are moderate",
    )


def _require_weight(whole: Whole, watched: Sequence[End]) -> None:
    """Raise where what moves a mass is no double: then whether forces stay positive is not known."""
    fastest = max((abs(x) for x in whole.acceleration), key=float, default=ZERO)
    moved = [abs(x) * fastest for x in whole.measures.table.mass.values()]
    limit = next((limit for limit in watched if limit.watched.of_forces), None)
    if limit is not None and any(not is_zero(x) and float(x) < _LEAST for x in moved):
        raise NotApplicable(
            f"a force of {limit.name} leaves the range of doubles, and whether it stays positive is not known",
            path=("bodies",),
            remedy="choose units in which the masses are moderate",
        )


def _safe(whole: Whole, limit: End) -> bool:
    """Return whether a length stays positive for all time, as the model of its motion shows."""
    if limit.length is None:
        return False
    for indices, motion in whole.parts:
        if follows(whole, limit.length, indices):
            number = {i: k for k, i in enumerate(indices)}
            length = substituted(limit.length, whole.reduced.expressions)
            return motion.keeps_positive({tuple(number[i] for i in key): x for key, x in length.items()})
    return False


def follows(whole: Whole, length: Poly | None, indices: Sequence[int]) -> bool:
    """Return whether a length is one of a part, which has some of the reduced coordinates."""
    reduced = substituted(length or {}, whole.reduced.expressions)
    return bool(reduced) and {key[0] for key in reduced if key} <= set(indices)
