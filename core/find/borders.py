"""Where what an answer says changes: words, truth values, counts, whether there is a figure, and jumps of numbers.

Between two inputs with different answers the change is halved in until no double is between. What is refused is no
answer: the error of a border that questions without an answer surround covers all of these.
"""

from __future__ import annotations

from collections.abc import Callable, Hashable
from itertools import pairwise
from math import inf

from core.find.evaluations import Curve
from core.find.figures import Value
from core.find.scanning import Run, first_shares, scanned
from core.find.solutions import Kind, Solution
from core.find.varied import neighbours, rounding

FIRST = 32
"""Intervals between the first samples: a case that lasts for a thirty-second of the range is seen."""

MOST_HALVINGS = 128
"""Halvings of a border, as `core.multibody.statics.thresholds` has it: 64 reach neighbouring doubles."""

MOST_SAMPLES = 600
"""Questions after which no border is narrowed down any further: its error is then what is left of its interval."""

MOST_BORDERS = 100
"""Borders that are located."""

LEAP = 0.5
"""A step is followed as a jump while it keeps so much of itself in every eighth of the interval."""

LEAST_LEAP = 1e-3
"""Of the change between neighbouring samples: smooth figures differ from what their neighbours say by less."""

Case = Callable[[float], Hashable]
"""What is answered with an input, as far as it is told apart."""

REFUSED = object()
"""Case of an input with which the question is refused."""


def case_of(curve: Curve, x: float) -> Hashable:
    """Return the value of a figure that is told apart, and whether there is one."""
    return REFUSED if curve.sample(x).refused is not None else (type(curve.value(x)).__name__, curve.value(x))


def borders_of(curve: Curve, case: Case, value: Callable[[float], Value | None]) -> list[Solution]:
    """Return where a case changes along the range."""
    varied = curve.varied
    for share in first_shares(FIRST):
        curve.value(varied.at_share(share))
    found: list[Solution] = []
    answered = [x for x in curve.known if case(x) is not REFUSED]
    for low, high in pairwise(answered):
        found += _between(curve, case, value, low, high)
    return found[:MOST_BORDERS]


def _between(
    curve: Curve, case: Case, value: Callable[[float], Value | None], low: float, high: float
) -> list[Solution]:
    """Return the borders between two inputs; several, if a third case is met."""
    if case(low) == case(high):
        return []
    first, last = low, high
    for _ in range(MOST_HALVINGS):
        if neighbours(low, high) or len(curve.known) > MOST_SAMPLES:
            break
        middle = curve.varied.middle(low, high)
        here = case(middle)
        if here is REFUSED:
            # What is refused is narrowed down from either side.
            low, high = _edge(curve, case, low, middle), _edge(curve, case, high, middle)
            break
        if here == case(low):
            low = middle
        elif here == case(high):
            high = middle
        else:
            return _between(curve, case, value, low, middle) + _between(curve, case, value, middle, high)
    if case(low) != case(first) or case(high) != case(last):
        return _between(curve, case, value, first, low) + _between(curve, case, value, high, last)
    return [_border("border", low, high, value(low), value(high))]


def _edge(curve: Curve, case: Case, inside: float, outside: float) -> float:
    """Return the last double towards another with the case of the first."""
    for _ in range(MOST_HALVINGS):
        if neighbours(inside, outside):
            break
        middle = curve.varied.middle(inside, outside)
        if case(middle) == case(inside):
            inside = middle
        else:
            outside = middle
    return inside


def _border(kind: Kind, low: float, high: float, below: Value | None, above: Value | None) -> Solution:
    middle = low if neighbours(low, high) else low + 0.5 * (high - low)
    # Half a unit in the last place of either end is the decimal by which it is written.
    return Solution((middle,), (high - low + rounding(middle),), kind, below=below, above=above)


def unresolved_step(run: Run, i: int) -> bool:
    """Return whether a jump might be between two samples."""
    return run.doubt(i) > LEAST_LEAP * run.variation(i)


def jumps_of(curve: Curve) -> list[Solution]:
    """Return where a number jumps, or where the answer begins or ceases to have it."""
    run = scanned(curve, 0.0, unresolved_step, FIRST)
    found = borders_of(curve, lambda x: _presence(curve, x), curve.value)
    for i in range(len(run.xs) - 1):
        one, other = run.numbers[i], run.numbers[i + 1]
        if one is not None and other is not None and unresolved_step(run, i):
            jump = _jump(curve, run.xs[i], run.xs[i + 1])
            found += [] if jump is None else [jump]
    return sorted(found, key=lambda one: one.inputs)


def _presence(curve: Curve, x: float) -> Hashable:
    return REFUSED if curve.sample(x).refused is not None else curve.number(x) is not None


def _jump(curve: Curve, low: float, high: float) -> Solution | None:
    """Return the jump between two inputs: the step that does not become smaller with the interval; None without one."""
    step, halvings = inf, 0
    while not neighbours(low, high) and halvings < MOST_HALVINGS:
        middle = curve.varied.middle(low, high)
        values = [curve.number(x) for x in (low, middle, high)]
        if any(value is None for value in values):
            return None
        left, here, right = (value for value in values if value is not None)
        if abs(here - left) >= abs(right - here):
            high = middle
        else:
            low = middle
        halvings += 1
        if halvings % 3 == 0:
            # Of what is continuous the step falls with the interval, of a root by 0.35 in three halvings.
            now = abs((curve.number(high) or 0.0) - (curve.number(low) or 0.0))
            if not now > LEAP * step and step < inf:
                return None
            step = now
    below, above = curve.number(low), curve.number(high)
    if below is None or above is None or abs(above - below) <= curve.error(low) + curve.error(high):
        return None
    return _border("jump", low, high, below, above)
