"""By how much two answers about one motion differ beyond what both state."""

from __future__ import annotations

from collections import Counter
from dataclasses import dataclass

import numpy as np

from core.arrays import Floats
from tests.core.multibody.relations.views import Event, Figure, Refusal, View

ROUNDING = 2.0**-48
"""What the transformation of an answer in doubles may add, relative to the largest value."""
NOTHING = 2.0**-90
"""Share of the largest figure of a unit below which pairs of doubles hold nothing."""
SAME_TIME = 1e-9
"""Share of a time within which events are at one instant, and their order means nothing."""
COMPARED_BOUNCES = 8
"""Bounces of one contact in a row that are compared: how many of those that accumulate are listed may differ."""
SLIGHT = 1e-9
"""Share of the largest impulse of an answer below which impacts are not compared one by one."""


@dataclass(frozen=True)
class Difference:
    """What differs, and by how many times the stated errors."""

    kind: str
    where: str
    ratio: float


def differences(expected: View | Refusal, found: View | Refusal) -> list[Difference]:
    """Return what of two answers differs by more than their stated errors."""
    if isinstance(expected, Refusal) or isinstance(found, Refusal):
        refusals = [one for one in (expected, found) if isinstance(one, Refusal)]
        crashed = [one for one in refusals if one.kind == "crash"]
        if crashed:
            return [Difference("crash", crashed[0].detail[:100], np.inf)]
        if len(refusals) == 2:
            return []
        return [Difference("refused in one form", f"{refusals[0].kind}: {refusals[0].detail[:100]}", np.inf)]
    return [
        *_figures(expected, found),
        *_events(expected, found),
        *_ends(expected, found),
        *_models(expected, found),
        *_found(expected, found),
    ]


def _figures(expected: View, found: View) -> list[Difference]:
    different = []
    count = min(len(expected.times), len(found.times))
    largest: dict[str, float] = {}
    for figure in expected.figures.values():
        largest[figure.unit] = max(largest.get(figure.unit, 0.0), float(np.abs(figure.values).max(initial=0.0)))
    # What moves along a line through the origin has no angular momentum.
    turning = largest.get("m", 0.0) * largest.get("kg m/s", 0.0)
    largest["kg m^2/s"] = max(largest.get("kg m^2/s", 0.0), turning)
    for key, figure in expected.figures.items():
        other = found.figures.get(key)
        if other is None:
            different.append(Difference("figure missing", key, np.inf))
            continue
        rows = min(len(figure.values), len(other.values), count if key.startswith("column") else 1)
        if figure.what == "extremes":
            away = _apart_in_range(figure, other)
        else:
            away = _apart(figure.values[:rows], other.values[:rows], figure.what)
        size = float(np.abs(figure.values).max(initial=0.0))
        allowed = figure.error + other.error + ROUNDING * size + NOTHING * largest[figure.unit] + 1e-300
        ratio = away / allowed
        if not ratio <= 1.0:
            kind = "figure of the start" if key.startswith("start") else "column"
            different.append(Difference(kind, key, float(ratio)))
    return different


def _apart_in_range(first: Figure, second: Figure) -> float:
    """Return how far least and largest values are apart; of what is searched until later, how much it leaves out.

    Where a motion ends is not known from one form as from another, and beside another part it may end sooner.
    """
    shorter, longer = sorted((first, second), key=lambda figure: figure.until)
    outside = (longer.values - shorter.values) * [1.0, -1.0]
    return float(np.max(np.abs(outside) if first.until == second.until else outside, initial=0.0))


def _apart(first: Floats, second: Floats, what: str) -> float:
    if first.ndim == 1 or first.shape != second.shape:
        return float(np.abs(first - second).max(initial=0.0)) if first.shape == second.shape else np.inf
    each = np.linalg.norm(first - second, axis=1)
    if what == "attitude":
        each = np.minimum(each, np.linalg.norm(first + second, axis=1))
    return float(each.max(initial=0.0))


def _events(expected: View, found: View) -> list[Difference]:
    until = min(one.ended[1] if one.ended else np.inf for one in (expected, found))
    own, other = (_compared(view.events, until) for view in (expected, found))
    counts = [Counter((event.kind, event.name) for event in events) for events in (own, other)]
    different = [
        Difference("event missing", f"{kind} {name}", np.inf)
        for (kind, name), _ in ((counts[0] - counts[1]) + (counts[1] - counts[0])).items()
    ]
    if different:
        return different
    order = lambda event: (event.kind, event.name, event.time)  # noqa: E731
    for first, second in zip(sorted(own, key=order), sorted(other, key=order), strict=True):
        allowed = first.error + second.error + ROUNDING * abs(first.time) + 1e-300
        if not abs(first.time - second.time) <= allowed:
            ratio = abs(first.time - second.time) / allowed
            different.append(Difference("time of an event", f"{first.kind} {first.name}", float(ratio)))
    return different


def _compared(events: list[Event], until: float) -> list[Event]:
    """Return the events before the motion ends in either answer, without the slightest impacts and what they open."""
    largest = max((abs(event.impulse) for event in events), default=0.0)
    bounces: Counter[str] = Counter()
    first: list[Event] = []
    for event in events:
        bounces[event.name] = bounces[event.name] + 1 if event.kind in ("touch", "taut") else 0
        if bounces[event.name] <= COMPARED_BOUNCES:
            first.append(event)
    slight = {event.time for event in events if 0.0 < abs(event.impulse) <= SLIGHT * largest}
    names = {event.name for event in events if event.time in slight and event.kind in ("touch", "taut")}
    began = min(slight, default=np.inf)

    def told(event: Event) -> bool:
        # Which of those that bounce in turn is the last one, without an impulse, depends on how many are listed.
        last = event.kind in ("touch", "taut") and event.name in names and event.time >= began
        return abs(event.impulse) > SLIGHT * largest or not (event.time in slight or last)

    return [event for event in first if event.time < until * (1.0 - SAME_TIME) and told(event)]


def _ends(expected: View, found: View) -> list[Difference]:
    if (expected.ended is None) != (found.ended is None) or expected.problem != found.problem:
        ends = [view.problem or (view.ended[0] if view.ended else "goes on") for view in (expected, found)]
        return [Difference("how it ends", " / ".join(ends), np.inf)]
    if expected.ended and found.ended:
        errors = [max((event.error for event in view.events), default=0.0) for view in (expected, found)]
        allowed = sum(errors) + ROUNDING * abs(expected.ended[1]) + 1e-300
        ratio = abs(expected.ended[1] - found.ended[1]) / allowed
        if expected.ended[0] != found.ended[0] or not ratio <= 1.0:
            return [Difference("how it ends", f"{expected.ended[0]} / {found.ended[0]}", float(ratio))]
    return []


def _models(expected: View, found: View) -> list[Difference]:
    # How many parts move in straight lines depends on the axes.
    names = [sorted({part[0] for part in view.models}) for view in (expected, found)]
    if names[0] != names[1]:
        return [Difference("model", f"{', '.join(names[0])} / {', '.join(names[1])}", np.inf)]
    different = []
    curved = [[part for part in view.models if part[0] != "constant acceleration"] for view in (expected, found)]
    if [part[:2] for part in curved[0]] != [part[:2] for part in curved[1]]:
        return [Difference("parts", f"{curved[0]} / {curved[1]}"[:120], np.inf)]
    for (name, _, first), (_, _, second) in zip(*curved, strict=True):
        if (first is None) != (second is None):
            different.append(Difference("period in one form", name, np.inf))
        elif first is not None and second is not None and not abs(first - second) <= 1e-12 * first:
            different.append(Difference("period", f"{name} {first / second:.6g}", abs(first / second - 1.0)))
    return different


def _found(expected: View, found: View) -> list[Difference]:
    different = [
        Difference("occurrence missing", key, np.inf) for key in sorted(expected.found.keys() ^ found.found.keys())
    ]
    for key in expected.found.keys() & found.found.keys():
        (first, error), (second, other) = expected.found[key], found.found[key]
        allowed = error + other + ROUNDING * abs(first) + 1e-300
        if not abs(first - second) <= allowed:
            different.append(Difference("occurrence", key, abs(first - second) / allowed))
    return different
