"""Which of the touching contacts stay closed, stick, slide or open: all combinations are tried.

What has to hold of each is in `conditions_of_states`. Contacts that do not push one another are decided apart.

References
----------
F. Pfeiffer, C. Glocker, "Multibody Dynamics with Unilateral Contacts" (1996). P. Painleve, "Sur les lois du frottement
de glissement", Comptes rendus 121 (1895).
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from itertools import product

from core.multibody.algebra.polynomials import ZERO, Ball, is_zero
from core.multibody.contacts.conditions_of_states import Situation, conditions_of, lasts, moves_as, same_motion
from core.multibody.contacts.contact_forces import Balance, balanced
from core.multibody.contacts.contact_responses import (
    MOST_UNDECIDED,
    Responses,
    gap_rate,
    require_few,
    responses,
    slip_rate,
)
from core.multibody.contacts.contact_states import Problem, State, pairs_of_sides, phase_table, sticks_more
from core.multibody.contacts.frictionless import decided_without_friction, is_smooth
from core.multibody.contacts.shared_loads import Share
from core.multibody.contacts.slip_directions import (
    AHEAD,
    Direction,
    along_slip,
    directions,
    directions_together,
    one_of,
    turned,
)
from core.multibody.table.connection_effects import Unilateral
from core.multibody.table.table import Table


@dataclass(frozen=True)
class Decided:
    """What unilateral measures do after a state.

    Attributes
    ----------
    states : list of State
    unilateral : list of Unilateral
        The measures; what slides in space is turned into the direction of its slip.
    shares : sequence of Share
        How the load may be shared otherwise, with the same accelerations.
    """

    states: list[State]
    unilateral: list[Unilateral]
    shares: Sequence[Share] = ()


def decided(
    base: Table, measures: Sequence[Unilateral], touching: Sequence[int], q: Sequence[Ball], v: Sequence[Ball]
) -> Decided | Problem:
    """Return the states of all unilateral measures just after a state, or what is undecided about them.

    Parameters
    ----------
    touching : sequence of int
        Those whose gap is zero; none of them approaches.

    Raises
    ------
    BudgetExceeded
        For more contacts with friction that push one another than
        `core.multibody.contacts.contact_responses.MOST_UNDECIDED`.
    """
    aligned = along_slip(measures, touching, q, v)
    unilateral, states = list(aligned), [State.OPEN] * len(aligned)
    choices = {i: _choices(unilateral[i], q, v) for i in touching if is_zero(gap_rate(unilateral[i], q, v))}
    if not choices:
        return Decided(states, unilateral)
    found = responses(phase_table(base, (), (), q, v).table, unilateral, list(choices))
    groups = found.clusters()
    # Accelerations do not tie groups to one another, but conditions on what follows them do: those of a group hold
    # beside what the others do. What is not decided yet is taken to stay closed.
    for i, possible in choices.items():
        states[i] = possible[0]
    known = list(choices)
    for _, other in pairs_of_sides(unilateral, known):
        states[known[other]] = State.OPEN
    assumed: dict[int, list[State]] = {}
    problems: dict[int, Problem] = {}
    shares: dict[int, list[Share]] = {}
    for _ in range(len(groups) + 1):
        stale = [k for k, group in enumerate(groups) if assumed.get(k) != _beside(states, group)]
        if not stale:
            break
        for k in stale:
            group, assumed[k] = groups[k], _beside(states, groups[k])
            for i in group:
                unilateral[i] = aligned[i]
            chosen = _decided_alone(Situation(base, unilateral, q, v, choices, found), group, states)
            problems.pop(k, None)
            if isinstance(chosen, Problem):
                problems[k] = chosen
                continue
            for i, state in zip(group, chosen.states, strict=True):
                states[i] = state
            shares[k] = [
                {i: share[found.normal[i]] for i in group if not is_zero(share[found.normal[i]])}
                for share in chosen.shares
            ]
            for i, direction in chosen.directions.items():
                unilateral[i] = turned(unilateral[i], one_of(direction))
    if problems:
        return problems[min(problems)]
    return Decided(states, unilateral, [share for own in shares.values() for share in own])


def _beside(states: Sequence[State], group: Sequence[int]) -> list[State]:
    """Return the states of what is not in a group."""
    return [state for i, state in enumerate(states) if i not in group]


def _decided_alone(at: Situation, group: Sequence[int], states: Sequence[State]) -> Balance | Problem:
    """Return the states of one group, beside those of the others."""
    if len(group) > MOST_UNDECIDED and is_smooth(at.unilateral, group):
        return decided_without_friction(at, group, states)
    require_few(at.unilateral, group, "undecided contacts at once")
    return _decided_group(at, group, states)


def stays(base: Table, unilateral: Sequence[Unilateral], touching: Sequence[int]) -> bool:
    """Return whether a scene without any motion is in equilibrium: what touches may stay closed, and nothing moves.

    A contact that could as well open without a force on it is closed with the force zero. Where mechanics would allow
    another motion besides, the scene is in equilibrium all the same.
    """
    q, v = base.q, base.v
    closed = {i: State.CLOSED if unilateral[i].slip is None else State.STICK for i in touching}
    found = responses(phase_table(base, (), (), q, v).table, unilateral, touching)
    acceleration = list(found.start)
    at = Situation(base, unilateral, q, v, {i: (state,) for i, state in closed.items()}, found)
    for group in found.clusters():
        require_few(unilateral, group, "contacts in equilibrium at once")
        balances = (
            balanced(unilateral, group, states, found) for states in _pressed_on_one_side(unilateral, group, closed)
        )
        balance = next((one for one in balances if one is not None and _holds(at, group, one)), None)
        if balance is None:
            return False
        acceleration = [a + (b - c) for a, b, c in zip(acceleration, balance.acceleration, found.start, strict=True)]
    return all(is_zero(x) for x in acceleration)


def _holds(at: Situation, group: Sequence[int], balance: Balance) -> bool:
    return all(is_zero(x) or bool(x > 0) for x in conditions_of(at, group, balance))


def _pressed_on_one_side(
    unilateral: Sequence[Unilateral], group: Sequence[int], closed: Mapping[int, State]
) -> Iterator[list[State]]:
    """Yield the states of a group in which all is closed, but of both sides of a guide one or the other."""
    for open_ in product(*pairs_of_sides(unilateral, group)):
        yield [State.OPEN if k in open_ else closed[i] for k, i in enumerate(group)]


def _choices(one: Unilateral, q: Sequence[Ball], v: Sequence[Ball]) -> tuple[State, ...]:
    if one.slip is None:
        return (State.CLOSED, State.OPEN)
    slip = slip_rate(one, q, v)
    if is_zero(slip):
        if one.across is not None:
            return (State.STICK, State.FORWARD, State.OPEN)
        return (State.STICK, State.FORWARD, State.BACKWARD, State.OPEN)
    return (State.FORWARD if slip > 0 else State.BACKWARD, State.OPEN)


def _decided_group(at: Situation, group: Sequence[int], settled: Sequence[State]) -> Balance | Problem:
    """Return the states of contacts that push one another; those of the others are given."""
    names = tuple(at.unilateral[i].name for i in group)
    consistent: list[Balance] = []
    several = False
    alike, sides = _sliding_alike(at, group), pairs_of_sides(at.unilateral, group)
    exactly = at.found
    for states in product(*(at.choices[i] for i in group)):
        # In a guide without play and preload one side presses, if by nothing.
        if not all((states[a] is State.OPEN) != (states[b] is State.OPEN) for a, b in sides):
            continue
        if not all(_agree(states[a], states[b], sense) for a, b, sense in alike):
            continue
        if any(sticks_more(other.states, states) for other in consistent):
            continue
        onsets = [i for i, state in zip(group, states, strict=True) if at.begins_somewhere(i, state)]
        found = _onsets(at, group, states, onsets, exactly)
        several = several or found is None
        for ways in found or ():
            balance = balanced(at.unilateral, group, states, at.found, ways)
            if balance is not None and balance.marginal and at.found is exactly:
                at = at.letting_go(group)
            if balance is not None and lasts(at, group, settled, balance):
                consistent.append(balance)
    if not consistent and several:
        return Problem(
            "several-onsets",
            "several contacts would begin to slide at once in space: the directions in which they do follow from one "
            "another, and are not found",
            names,
            decided_by="velocities with which they slide already",
        )
    if not consistent:
        return Problem(
            "no-motion",
            "no motion of rigid bodies is possible here: the friction of what slides presses it on "
            "more strongly than its inertia gives way (Painleve)",
            names,
            decided_by="a compliance of the contact, or an impact without collision, in which the slip stops at once",
        )
    sticking = [one for one in consistent if not any(sticks_more(other.states, one.states) for other in consistent)]
    decided_motions = [one for one in sticking if not one.moves]
    for other in sticking:
        if other.moves and not moves_as(at, group, other, decided_motions):
            return Problem(
                "undetermined-friction",
                "how the load is shared between the contacts is not determined, and their friction depends on it",
                tuple(name for name, state in zip(names, other.states, strict=True) if state is not State.OPEN),
                decided_by="compliances of the contacts, or one coefficient of friction for all of them",
            )
    for other in decided_motions[1:]:
        if not same_motion(decided_motions[0].acceleration, other.acceleration):
            return Problem(
                "several-motions",
                f"several motions are possible: {'; '.join(_in_words(one.states) for one in decided_motions)}",
                names,
                tuple(
                    {name: state.value for name, state in zip(names, one.states, strict=True)}
                    for one in decided_motions
                ),
                "a compliance of the contact and how it came to this state",
            )
    return max(decided_motions, key=lambda one: (sum(s is not State.OPEN for s in one.states), _stuck(one.states)))


def _sliding_alike(at: Situation, group: Sequence[int]) -> list[tuple[int, int, int]]:
    """Return pairs of contacts, as places in a group, that begin to slide at one rate, with its sign between them.

    States in which only one of two such contacts slides, or both against one another, hold where nothing is accelerated
    along them only, by forces with which both stick.
    """
    found, pairs = at.found, []
    lines = {
        a: [found.free[found.slips[i]], *found.matrix[found.slips[i]]]
        for a, i in enumerate(group)
        if State.STICK in at.choices[i] and at.unilateral[i].across is None
    }
    for a, first in lines.items():
        for b, second in lines.items():
            if a < b:
                if all(is_zero(x - y) for x, y in zip(first, second, strict=True)):
                    pairs.append((a, b, 1))
                elif all(is_zero(x + y) for x, y in zip(first, second, strict=True)):
                    pairs.append((a, b, -1))
    return pairs


def _agree(first: State, second: State, sense: int) -> bool:
    """Return whether two contacts that begin to slide alike do so, if both touch."""
    return State.OPEN in (first, second) or first.sense == sense * second.sense


def _onsets(
    at: Situation, group: Sequence[int], states: Sequence[State], onsets: Sequence[int], exactly: Responses
) -> list[dict[int, Direction]] | None:
    """Return the directions in which contacts may begin to slide in space; None where several are not found.

    What translates keeps the direction of slip without friction, which is known exactly where what slips is not.
    """
    if not onsets:
        return [{}]

    def after(
        assumed: Sequence[Direction], measures: Sequence[Unilateral] = at.unilateral, responses: Responses = at.found
    ) -> list[Direction] | None:
        ways = dict(zip(onsets, assumed, strict=True))
        balance = balanced(measures, group, states, responses, ways, shared=False)
        if balance is None:
            return None
        lines = [responses.grip(i) for i in onsets]
        return [(responses.along(balance.forces, x), responses.along(balance.forces, y)) for x, y in lines]

    def follows(way: Direction) -> Direction | None:
        slips = after([way])
        return None if slips is None else slips[0]

    smooth = [replace(one, kinetic=ZERO) if i in onsets else one for i, one in enumerate(at.unilateral)]
    first = after([AHEAD] * len(onsets), smooth, exactly)
    if len(onsets) == 1:
        return [{onsets[0]: way} for way in directions(follows, first[0] if first else AHEAD)]
    together = directions_together(first, after) if first else []
    return None if together is None else [dict(zip(onsets, together, strict=True))] if together else []


def _in_words(states: Sequence[State]) -> str:
    return ", ".join(state.value for state in states)


def _stuck(states: Sequence[State]) -> int:
    return sum(state is State.STICK for state in states)
