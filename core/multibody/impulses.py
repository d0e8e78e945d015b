"""Impulses of contacts that act together: all combinations of states are tried.

With p the impulses along gaps, s along slips: p >= 0 and the gap opens at e times the rate at which it closed, or p = 0
and it opens faster; where p > 0, either the slip stops and |s| <= mu p, or s = -sigma mu p and the slip has the sign
sigma. The rates afterwards are r + A (p, s), with Delassus' operator A.

References
----------
F. Pfeiffer, C. Glocker, "Multibody Dynamics with Unilateral Contacts" (1996), chapter 8.
"""

from __future__ import annotations

from collections.abc import Sequence
from itertools import product

from flint import arb_mat

from core.multibody.contact_responses import Forces, Responses
from core.multibody.contact_states import Problem, State, sticks_more
from core.multibody.measures import Unilateral
from core.multibody.polynomials import ZERO, Ball, is_zero

LIMIT = 2.0**-40
"""Share of the largest rate below which two outcomes differ by nothing."""

Rates = dict[int, Ball]
"""Rates by line, zero where they cannot be told from zero."""


def rates_after(impulses: Forces, rates: Rates, found: Responses) -> Rates:
    """Return the rates along every line after impulses."""
    return {a: x + sum((found.matrix[a][b] * p for b, p in impulses.items()), ZERO) for a, x in rates.items()}


def alike(first: Rates, second: Rates) -> bool:
    """Return whether two outcomes are one: impacts in turn may come to it as a limit only."""
    scale = max((float(abs(x)) for x in first.values()), default=0.0)
    return all(is_zero(x - second[a]) or bool(abs(x - second[a]) < LIMIT * scale) for a, x in first.items())


def impulses_at_once(
    unilateral: Sequence[Unilateral], group: Sequence[int], rates: Rates, found: Responses
) -> Forces | Problem:
    """Return the impulses of a group of contacts if all act together, or why they are undecided."""
    consistent: list[tuple[tuple[State, ...], Forces]] = []
    choices = [
        (State.OPEN, State.STICK, State.FORWARD, State.BACKWARD) if i in found.slips else (State.OPEN, State.CLOSED)
        for i in group
    ]
    for states in product(*choices):
        impulses = _solved(unilateral, group, states, rates, found)
        if impulses is None:
            continue
        after = rates_after(impulses, rates, found)
        if all(
            _holds(unilateral[i], i, state, after, impulses, rates, found)
            for i, state in zip(group, states, strict=True)
        ):
            consistent.append((states, impulses))
    names = tuple(unilateral[i].name for i in group)
    if not consistent:
        return Problem(
            "no-impact",
            "no impulses of friction and restitution go with this impact",
            names,
            decided_by="another law of impact",
        )
    least = [one for one in consistent if not any(sticks_more(other[0], one[0]) for other in consistent)]
    first = rates_after(least[0][1], rates, found)
    for _, other in least[1:]:
        if not alike(first, rates_after(other, rates, found)):
            return Problem(
                "several-impacts",
                "several outcomes of the impact are possible",
                names,
                tuple({name: s.value for name, s in zip(names, states, strict=True)} for states, _ in least),
                "another law of impact",
            )
    return min(least, key=lambda one: sum(state is not State.OPEN for state in one[0]))[1]


def _solved(
    unilateral: Sequence[Unilateral],
    group: Sequence[int],
    states: Sequence[State],
    rates: Rates,
    found: Responses,
) -> Forces | None:
    """Return the impulses that give the rates that states ask for, None where none or many do."""
    unknowns, held = found.unknowns(unilateral, group, states)
    if not held:
        return {}
    wanted: Rates = {a: -rates[a] for a in held}
    for i in group:
        a = found.normal[i]
        if a in wanted:
            wanted[a] = wanted[a] - _rebound(unilateral[i], rates[a])
    try:
        solved = arb_mat(found.among(unknowns, held)).solve(arb_mat([[wanted[a]] for a in held])).entries()
    except ZeroDivisionError:
        return None
    impulses: Forces = {}
    for x, push in zip(solved, unknowns, strict=True):
        for b, factor in push.items():
            impulses[b] = impulses.get(b, ZERO) + x * factor
    return {b: ZERO if is_zero(x) else x for b, x in impulses.items()}


def _rebound(one: Unilateral, closing: Ball) -> Ball:
    """Return e times the rate of a gap before an impact, below zero; zero where the gap does not close."""
    return one.restitution * closing if closing < 0 else ZERO


def _holds(
    one: Unilateral, i: int, state: State, after: Rates, impulses: Forces, rates: Rates, found: Responses
) -> bool:
    """Return whether the outcome of an impact goes with what is taken to be the state of one contact."""
    a = found.normal[i]
    if state is State.OPEN:
        return _at_least_zero(after[a] + _rebound(one, rates[a]))
    push = impulses[a]
    if not _at_least_zero(push):
        return False
    if state is State.STICK:
        return _at_least_zero(one.static * push - abs(impulses[found.slips[i]]))
    if state.sense:
        return _at_least_zero(state.sense * after[found.slips[i]])
    return True


def _at_least_zero(x: Ball) -> bool:
    return is_zero(x) or bool(x > 0)
