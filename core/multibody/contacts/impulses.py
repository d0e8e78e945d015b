"""Impulses of contacts that act together: all combinations of states are tried.

With p the impulses along gaps, s along slips: p >= 0 and the gap opens at e times the rate at which it closed, or p = 0
and it opens faster; where p > 0, either the slip stops and |s| <= mu p, or s = -sigma mu p and the slip has the sign
sigma. With a tangential restitution e_t what stops, or has the sign, is the slip afterwards and e_t times that before.
The rates afterwards are r + A (p, s), with Delassus' operator A.

References
----------
F. Pfeiffer, C. Glocker, "Multibody Dynamics with Unilateral Contacts" (1996), chapter 8.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from itertools import product

from flint import arb_mat

from core.multibody.algebra.polynomials import ZERO, Ball, is_zero
from core.multibody.contacts.contact_responses import Forces, Responses
from core.multibody.contacts.contact_states import Problem, State, grips, pairs_of_sides, sticks_more
from core.multibody.contacts.slip_directions import AHEAD, Direction, directions, directions_together
from core.multibody.table.connection_effects import Unilateral

LIMIT = 2.0**-40
"""Share of the largest rate below which two outcomes differ by nothing."""

RatesByLine = dict[int, Ball]
"""RatesByLine by line, zero where they cannot be told from zero."""


def rates_after(impulses: Forces, rates: RatesByLine, found: Responses) -> RatesByLine:
    """Return the rates along every line after impulses."""
    return {a: x + sum((found.matrix[a][b] * p for b, p in impulses.items()), ZERO) for a, x in rates.items()}


def alike(first: RatesByLine, second: RatesByLine, before: RatesByLine) -> bool:
    """Return whether two outcomes are one, beside the rates before: impacts in turn may come to it as a limit."""
    scale = max((float(abs(x)) for x in (*first.values(), *before.values())), default=0.0)
    return all(is_zero(x - second[a]) or bool(abs(x - second[a]) < LIMIT * scale) for a, x in first.items())


def impulses_at_once(
    unilateral: Sequence[Unilateral], group: Sequence[int], rates: RatesByLine, found: Responses
) -> Forces | Problem:
    """Return the impulses of a group of contacts if all act together, or why they are undecided."""
    consistent: list[tuple[tuple[State, ...], Forces]] = []
    several, sides = False, pairs_of_sides(unilateral, group)
    for states in product(*(_choices(i, found) for i in group)):
        if any(State.OPEN not in (states[a], states[b]) for a, b in sides):
            continue
        slides = [i for i, state in zip(group, states, strict=True) if state.sense and i in found.across]
        every = _ways(unilateral, group, states, slides, rates, found)
        several = several or every is None
        for ways in every or ():
            impulses = _solved(unilateral, group, states, rates, found, ways)
            if impulses is None:
                continue
            after = rates_after(impulses, rates, found)
            if all(
                _holds(unilateral[i], i, state, after, impulses, rates, found, ways)
                for i, state in zip(group, states, strict=True)
            ):
                consistent.append((states, impulses))
    names = tuple(unilateral[i].name for i in group)
    if not consistent and several:
        return Problem(
            "several-onsets",
            "several contacts would slide after this impact in space: the directions in which they do follow from one "
            "another, and are not found",
            names,
            decided_by="impacts one after another",
        )
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
        if not alike(first, rates_after(other, rates, found), rates):
            return Problem(
                "several-impacts",
                "several outcomes of the impact are possible",
                names,
                tuple({name: s.value for name, s in zip(names, states, strict=True)} for states, _ in least),
                "another law of impact",
            )
    return min(least, key=lambda one: sum(state is not State.OPEN for state in one[0]))[1]


def likest(
    unilateral: Sequence[Unilateral], group: Sequence[int], rates: RatesByLine, change: Sequence[Ball], found: Responses
) -> Forces:
    """Return the impulses of the states that change the rates of all coordinates most nearly as wanted.

    Which states go with the impact is known from a state with its error; beside it signs may be otherwise by rounding,
    and lines that depend on one another may do so only nearly.
    """
    best: Forces = {}
    least, sides = float("inf"), pairs_of_sides(unilateral, group)
    for states in product(*(_choices(i, found) for i in group)):
        if any(State.OPEN not in (states[a], states[b]) for a, b in sides):
            continue
        slides = [i for i, state in zip(group, states, strict=True) if state.sense and i in found.across]
        for ways in _ways(unilateral, group, states, slides, rates, found) or ():
            impulses = _solved(unilateral, group, states, rates, found, ways)
            if impulses is None:
                continue
            forces = [impulses.get(b, ZERO) for b in range(len(found.columns))]
            changed = found.accelerations(forces, from_rest=True)
            apart = max((abs(float((x - y).mid())) for x, y in zip(changed, change, strict=True)), default=0.0)
            if apart < least:
                best, least = impulses, apart
    return best


def _choices(i: int, found: Responses) -> tuple[State, ...]:
    if i in found.across:
        return (State.OPEN, State.STICK, State.FORWARD)
    if i in found.slips:
        return (State.OPEN, State.STICK, State.FORWARD, State.BACKWARD)
    return (State.OPEN, State.CLOSED)


def _ways(
    unilateral: Sequence[Unilateral],
    group: Sequence[int],
    states: Sequence[State],
    slides: Sequence[int],
    rates: RatesByLine,
    found: Responses,
) -> list[dict[int, Direction]] | None:
    """Return the directions in which contacts may slide after an impact in space, each along the slip that it has then.

    None where there are several, and they are not found.
    """
    if not slides:
        return [{}]

    def slips(assumed: Sequence[Direction]) -> list[Direction] | None:
        impulses = _solved(unilateral, group, states, rates, found, dict(zip(slides, assumed, strict=True)))
        if impulses is None:
            return None
        then, after = rates_after(impulses, rates, found), []
        for i in slides:
            first, second = (then[line] + thrown_back(unilateral[i], i, line, rates, found) for line in found.grip(i))
            after.append((first, second))
        return after

    def follows(way: Direction) -> Direction | None:
        after = slips([way])
        return None if after is None else after[0]

    if len(slides) == 1:
        return [{slides[0]: way} for way in directions(follows)]
    first = slips([AHEAD] * len(slides))
    together = [] if first is None else directions_together(first, slips)
    return None if together is None else [dict(zip(slides, together, strict=True))] if together else []


def _solved(
    unilateral: Sequence[Unilateral],
    group: Sequence[int],
    states: Sequence[State],
    rates: RatesByLine,
    found: Responses,
    ways: Mapping[int, Direction],
) -> Forces | None:
    """Return the impulses that give the rates that states ask for, None where none or many do."""
    unknowns, held = found.unknowns(unilateral, group, states, ways)
    if not held:
        return {}
    wanted: RatesByLine = {a: -rates[a] for a in held}
    for i in group:
        a = found.normal[i]
        if a in wanted:
            wanted[a] = wanted[a] - _rebound(unilateral[i], rates[a])
        for line in found.grip(i):
            if line in wanted:
                wanted[line] = wanted[line] - thrown_back(unilateral[i], i, line, rates, found)
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


def thrown_back(one: Unilateral, i: int, line: int, rates: RatesByLine, found: Responses) -> Ball:
    """Return the share of a slip before an impact that friction turns back; zero where the gap does not close."""
    return one.tangential * rates[line] if rates[found.normal[i]] < 0 else ZERO


def _holds(
    one: Unilateral,
    i: int,
    state: State,
    after: RatesByLine,
    impulses: Forces,
    rates: RatesByLine,
    found: Responses,
    ways: Mapping[int, Direction],
) -> bool:
    """Return whether the outcome of an impact goes with what is taken to be the state of one contact."""
    a = found.normal[i]
    if state is State.OPEN:
        return _at_least_zero(after[a] + _rebound(one, rates[a]))
    push = impulses[a]
    if not _at_least_zero(push) or not is_zero(after[a] + _rebound(one, rates[a])):
        return False
    slip = {line: after[line] + thrown_back(one, i, line, rates, found) for line in found.grip(i)}
    if state is State.STICK:
        # Impulses that cannot be told from zero are zero: then what they would have to stop may be known to go on.
        return all(map(is_zero, slip.values())) and all(
            _at_least_zero(x) for x in grips(one.static * push, [impulses[line] for line in found.grip(i)])
        )
    if state.sense and i in ways:
        c, s = ways[i]
        return _at_least_zero(c * slip[found.slips[i]] + s * slip[found.across[i]])
    if state.sense:
        return _at_least_zero(state.sense * slip[found.slips[i]])
    return True


def _at_least_zero(x: Ball) -> bool:
    return is_zero(x) or bool(x > 0)
