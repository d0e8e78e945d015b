"""What ends a scene: a string that would have to push, a chain that lifts off, a length of zero, a singular place."""

from __future__ import annotations

from collections.abc import Sequence
from math import copysign

import numpy as np

from core.arrays import Floats
from core.errors import NotApplicable
from core.multibody.algebra.polynomials import ZERO, is_zero, substituted
from core.multibody.motion.kepler import Kepler
from core.multibody.motion.modes import Modes
from core.multibody.motion.numerical import SINGULAR_TIME_ERROR, Numerical
from core.multibody.motion.uniform import Uniform, first_zero
from core.multibody.motion.whole import Whole, values
from core.multibody.table.connection_effects import Limit
from core.multibody.trajectory.turns import HALVINGS, closer_at_ends, dips
from core.systems.trajectory import MotionEvent

_SECTIONS = 33
_LEAST = 2.0**-1000
"""Force (N) beside which others are lost below the range of doubles."""
_NOISE = 2.0**-40
"""Share of a force's size below which its sign is noise."""
_GROWN = 16.0
"""Powers of e by which a motion grows before events are looked for beyond."""
_MOST_REACHES = 5
_NEIGHBOURS = 8
"""Samples after one by which the size is judged there: those of a motion that grows without bound say nothing of it."""
_CLOSER = 4
"""How often the neighbourhood of a lowest value is looked at, each time 66 times as closely."""


def first_event(whole: Whole, watched: Sequence[Limit], end: float) -> MotionEvent | None:
    """Return the first event between the start and `end`, which may be negative; None if there is none.

    Raises
    ------
    NotApplicable
        Where a force that is watched leaves the range of doubles before any event.
    """
    found: list[MotionEvent] = []
    for indices, motion in whole.parts:
        if isinstance(motion, Numerical):
            reached = motion.reach(end)
            if reached is not None:
                found.append(MotionEvent("singular", "", reached, SINGULAR_TIME_ERROR * abs(reached)))
                end = reached
        elif isinstance(motion, Kepler):
            reached = motion.reach(end)
            if reached is not None:
                name = next((limit.name for limit in watched if _follows(whole, limit, indices)), "")
                found.append(MotionEvent("singular", name, reached, 2.0**-52 * abs(reached)))
                end = reached
    if not watched or end == 0.0:
        return found[0] if found else None
    lengths = [limit for limit in watched if limit.length is not None]
    if all(isinstance(motion, Uniform) or motion.name == "rest" for _, motion in whole.parts):
        for limit in lengths:
            table = whole.reduced.table
            length = substituted(limit.length or {}, whole.reduced.expressions)
            root = first_zero(length, table, whole.reduced_accelerations, end < 0.0)
            time = None if root is None else float(root)
            if time is not None and abs(time) <= abs(end):
                found.append(MotionEvent(limit.event, limit.name, time, 2.0**-52 * abs(time)))
        watched = [limit for limit in watched if limit.force is not None]
    watched = [limit for limit in watched if not _safe(whole, limit)]
    lost: list[MotionEvent] = []
    for reach in _reaches(whole, end) if watched else ():
        grid = _grid(whole, reach)
        curves = _curves(whole, watched, grid)[0]
        _require_known(watched, curves[:, :1])
        _require_weight(whole, watched, curves)
        events = (_first_loss(whole, limit, grid, curve) for limit, curve in zip(watched, curves, strict=True))
        lost = [event for event in events if event is not None]
        if lost:
            break
        _require_known(watched, curves)
    found.extend(lost)
    return min(found, key=lambda event: abs(event.time)) if found else None


def _require_known(watched: Sequence[Limit], curves: Floats) -> None:
    """Raise for what is watched and not a number of doubles: whether it stays positive is not known."""
    for limit, curve in zip(watched, curves, strict=True):
        if not np.isfinite(curve).all():
            what = "a force" if limit.force is not None else "a length"
            raise NotApplicable(
                f"{what} of {limit.name} leaves the range of doubles, and whether it stays positive is not known",
                path=("times",),
                remedy="ask for a shorter time, or choose units in which the numbers are moderate",
            )


def _require_weight(whole: Whole, watched: Sequence[Limit], curves: Floats) -> None:
    """Raise for forces that are zero in doubles, as what moves a mass is: whether they stay positive is not known."""
    fastest = max((abs(x) for x in whole.acceleration), key=float, default=ZERO)
    moved = [abs(x) * fastest for x in whole.measures.table.mass.values()]
    weightless = any(not is_zero(x) and float(x) < _LEAST for x in moved)
    for limit, curve in zip(watched, curves, strict=True):
        if weightless and limit.force is not None and not curve.any():
            raise NotApplicable(
                f"a force of {limit.name} leaves the range of doubles, and whether it stays positive is not known",
                path=("bodies",),
                remedy="choose units in which the masses are moderate",
            )


def _safe(whole: Whole, limit: Limit) -> bool:
    """Return whether a length stays positive for all time, as the amplitudes of modes show."""
    if limit.length is None:
        return False
    length = substituted(limit.length, whole.reduced.expressions)
    for indices, motion in whole.parts:
        if isinstance(motion, Kepler) and _follows(whole, limit, indices):
            # It falls into the centre, which is known, or never.
            return True
        if isinstance(motion, Modes) and {key[0] for key in length if key} <= set(indices):
            number = {i: k for k, i in enumerate(indices)}
            return motion.lowest({tuple(number[i] for i in key): x for key, x in length.items()}) > 0.0
    return False


def _follows(whole: Whole, limit: Limit, indices: Sequence[int]) -> bool:
    """Return whether a length is one of a part."""
    length = substituted(limit.length or {}, whole.reduced.expressions)
    return bool(length) and {key[0] for key in length if key} <= set(indices)


def _reaches(whole: Whole, end: float) -> list[float]:
    """Return the times up to which events are looked for in turn: what grows without bound soon meets one."""
    growths = [float(mode.growth) for _, motion in whole.parts if isinstance(motion, Modes) for mode in motion.modes]
    # Backwards in time, what decays grows.
    growth = max((copysign(1.0, end) * x for x in growths), default=0.0)
    first = _GROWN / growth if growth > 0.0 else abs(end)
    nearer = [2.0**k * first for k in range(_MOST_REACHES)]
    return [*(copysign(reach, end) for reach in nearer if reach < abs(end)), end]


def _grid(whole: Whole, end: float) -> Floats:
    times = np.unique(np.abs(np.concatenate([motion.nodes(end) for _, motion in whole.parts] or [np.zeros(1)])))
    return copysign(1.0, end) * closer_at_ends(times[times <= abs(end)])


def _curves(
    whole: Whole, watched: Sequence[Limit], times: Floats, *, by_reference: bool = False
) -> tuple[Floats, Floats]:
    """Return every watched quantity at the times, by the answer or by its reference, and the sizes of its terms.

    Both have the shape (limits, t).
    """
    states = whole.states(times)
    q, v = (states.q, states.v) if not by_reference or states.reference is None else states.reference
    multipliers = whole.multipliers(q, v) if any(limit.force is not None for limit in watched) else np.zeros((0, 0))
    found, size = np.empty((len(watched), len(times))), np.empty((len(watched), len(times)))
    for number, limit in enumerate(watched):
        if limit.force is not None:
            found[number], size[number] = whole.force(whole.measures.forces[limit.force], q, v, multipliers)
        else:
            found[number], size[number] = values(limit.length or {}, q)
    return found, size


def _first_loss(whole: Whole, limit: Limit, grid: Floats, curve: Floats) -> MotionEvent | None:
    largest = np.maximum.accumulate(np.maximum(np.abs(curve), limit.scale))
    ahead = np.arange(len(curve)) + _NEIGHBOURS
    # Where intervals double, two of them are far enough.
    ahead[:HALVINGS] -= _NEIGHBOURS - 2
    if limit.force is not None and limit.scale == 0.0:
        # A tension of zero at the start has no size before the first whole interval.
        ahead = np.maximum(ahead, HALVINGS + 1 + _NEIGHBOURS)
    threshold = -_NOISE * largest[np.minimum(ahead, len(curve) - 1)]
    lost = curve < threshold
    if lost[0]:
        return MotionEvent(limit.event, limit.name, 0.0, 0.0)
    low, high = None, None
    low_enough = dips(grid, curve) < 0.25 * np.abs(np.append(curve[:1], curve[:-1]))
    for i in range(1, len(curve)):
        if lost[i]:
            low, high = _sign_change(grid, curve, i)
            break
        if low_enough[i]:
            bracket = _dip_below(whole, limit, float(grid[i - 1]), float(grid[i + 1]), float(threshold[i]))
            if bracket is not None:
                low, high = bracket
                break
    if low is None or high is None:
        return None
    for _ in range(14):
        fine = np.linspace(low, high, _SECTIONS)
        below = _curves(whole, [limit], fine)[0][0] < 0.0
        k = int(np.argmax(below)) if np.any(below) else _SECTIONS - 1
        if k == 0 or (fine[k - 1] == low and fine[k] == high):
            break
        low, high = fine[k - 1], fine[k]
    around = np.array([low - (high - low) - 1e-7 * abs(high), high, high + (high - low) + 1e-7 * abs(high)])
    curve, size = (x[0] for x in _curves(whole, [limit], around))
    by_reference = _curves(whole, [limit], around, by_reference=True)[0][0]
    slope = (curve[2] - curve[0]) / (around[2] - around[0])
    off = abs(curve[1] - by_reference[1]) * 1.01 + 2.0**-50 * float(np.max(size))
    error = off / abs(slope) if slope != 0.0 else abs(high)
    return MotionEvent(limit.event, limit.name, float(high), float(error + (abs(high - low)) + 2.0**-52 * abs(high)))


def _sign_change(grid: Floats, curve: Floats, below: int) -> tuple[float, float]:
    """Return the times between which a curve became negative that is below its threshold at a sample.

    Where slopes are small it is negative for long before it is below.
    """
    above = np.flatnonzero(curve[:below] >= 0.0)
    k = int(above[-1]) + 1 if len(above) else below
    return float(grid[k - 1]), float(grid[k])


def _dip_below(whole: Whole, limit: Limit, start: float, end: float, threshold: float) -> tuple[float, float] | None:
    """Return times between which a curve falls below a threshold near its lowest value, if it does."""
    for _ in range(_CLOSER):
        fine = np.linspace(start, end, 4 * _SECTIONS)
        curve = _curves(whole, [limit], fine)[0][0]
        below = curve < threshold
        if np.any(below):
            return _sign_change(fine, curve, int(np.argmax(below)))
        k = int(np.argmin(curve))
        if k in (0, len(fine) - 1):
            return None
        start, end = float(fine[k - 1]), float(fine[k + 1])
    return None
