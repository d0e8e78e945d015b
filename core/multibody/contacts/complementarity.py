"""Which of the touching contacts stay closed, stick, slide or open: all combinations are tried.

A closed contact has N >= 0, an open one a gap that does not shrink, a sticking one |F| <= mu N, one that begins to
slide a rate of slip that grows against its friction. A sign is that of the first Taylor coefficient that is not zero,
in balls: where the acceleration is zero the jerk decides, and so on.
Contacts that do not push one another are decided apart.

References
----------
F. Pfeiffer, C. Glocker, "Multibody Dynamics with Unilateral Contacts" (1996). P. Painleve, "Sur les lois du frottement
de glissement", Comptes rendus 121 (1895).
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from itertools import product

from core.multibody.algebra.polynomials import Ball, is_zero
from core.multibody.contacts.contact_forces import Balance, balanced
from core.multibody.contacts.contact_responses import Responses, gap_rate, require_few, responses, slip_rate
from core.multibody.contacts.contact_states import Problem, State, disc, grips, phase_table, sticks_more
from core.multibody.contacts.slip_directions import Direction, along_slip, directions, turned
from core.multibody.equations.expansion import expansion, leading_sign
from core.multibody.table.connection_effects import Unilateral
from core.multibody.table.table import Table

LOOKED = 8
"""Highest Taylor coefficient of the places that is looked at."""


@dataclass(frozen=True)
class _Situation:
    """A state with contacts about which something is to be decided.

    Attributes
    ----------
    choices : dict of int to tuple of State
        What each touching measure may do, as far as its rates tell.
    """

    base: Table
    unilateral: Sequence[Unilateral]
    q: Sequence[Ball]
    v: Sequence[Ball]
    choices: dict[int, tuple[State, ...]]
    found: Responses

    def begins_somewhere(self, i: int, state: State) -> bool:
        """Return whether a measure begins to slide in space, in a direction that is still to be found."""
        return self.may_slip(i, state) and self.unilateral[i].across is not None

    def may_slip(self, i: int, state: State) -> bool:
        """Return whether a measure begins to slide: it could as well stick."""
        return state.sense != 0 and State.STICK in self.choices[i]


@dataclass(frozen=True)
class Decided:
    """What unilateral measures do after a state.

    Attributes
    ----------
    states : list of State
    unilateral : list of Unilateral
        The measures; what slides in space is turned into the direction of its slip.
    """

    states: list[State]
    unilateral: list[Unilateral]


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
        For more contacts that push one another than `core.multibody.contacts.contact_responses.MOST`.
    """
    unilateral = along_slip(measures, touching, q, v)
    states = [State.OPEN] * len(unilateral)
    choices = {i: _choices(unilateral[i], q, v) for i in touching if is_zero(gap_rate(unilateral[i], q, v))}
    if not choices:
        return Decided(states, unilateral)
    found = responses(phase_table(base, (), (), q, v).table, unilateral, list(choices))
    at = _Situation(base, unilateral, q, v, choices, found)
    for group in found.clusters():
        require_few(unilateral, group, "undecided contacts at once")
        chosen = _decided_group(at, group, states)
        if isinstance(chosen, Problem):
            return chosen
        for i, state in zip(group, chosen.states, strict=True):
            states[i] = state
        for i, direction in chosen.directions.items():
            unilateral[i] = turned(unilateral[i], direction)
    return Decided(states, unilateral)


def stays(base: Table, unilateral: Sequence[Unilateral], touching: Sequence[int]) -> bool:
    """Return whether a scene without any motion is in equilibrium: what touches may stay closed, and nothing moves.

    A contact that could as well open without a force on it is closed with the force zero. Where mechanics would allow
    another motion besides, the scene is in equilibrium all the same.
    """
    q, v = base.q, base.v
    states = [State.OPEN] * len(unilateral)
    for i in touching:
        states[i] = State.CLOSED if unilateral[i].slip is None else State.STICK
    found = responses(phase_table(base, (), (), q, v).table, unilateral, touching)
    acceleration = list(found.start)
    at = _Situation(base, unilateral, q, v, {i: (states[i],) for i in touching}, found)
    for group in found.clusters():
        require_few(unilateral, group, "contacts in equilibrium at once")
        balance = balanced(unilateral, group, [states[i] for i in group], found)
        if balance is None or isinstance(balance, Problem):
            return False
        if not all(is_zero(x) or x > 0 for x in _conditions(at, group, balance)):
            return False
        acceleration = [a + (b - c) for a, b, c in zip(acceleration, balance.acceleration, found.start, strict=True)]
    return all(is_zero(x) for x in acceleration)


def _choices(one: Unilateral, q: Sequence[Ball], v: Sequence[Ball]) -> tuple[State, ...]:
    if one.slip is None:
        return (State.CLOSED, State.OPEN)
    slip = slip_rate(one, q, v)
    if is_zero(slip):
        if one.across is not None:
            return (State.STICK, State.FORWARD, State.OPEN)
        return (State.STICK, State.FORWARD, State.BACKWARD, State.OPEN)
    return (State.FORWARD if slip > 0 else State.BACKWARD, State.OPEN)


def _decided_group(at: _Situation, group: Sequence[int], settled: Sequence[State]) -> Balance | Problem:
    """Return the states of contacts that push one another; those of groups before it are settled."""
    names = tuple(at.unilateral[i].name for i in group)
    consistent: list[Balance] = []
    several = False
    for states in product(*(at.choices[i] for i in group)):
        onsets = [i for i, state in zip(group, states, strict=True) if at.begins_somewhere(i, state)]
        if onsets and any(sticks_more(other.states, states) for other in consistent):
            continue
        if len(onsets) > 1:
            several = True
            continue
        for ways in _onsets(at, group, states, onsets):
            balance = balanced(at.unilateral, group, states, at.found, ways)
            if isinstance(balance, Problem):
                return balance
            if balance is not None and _lasts(at, group, settled, balance):
                consistent.append(balance)
    if not consistent and several:
        return Problem(
            "several-onsets",
            "several contacts would begin to slide at once in space: the directions in which they do follow from one "
            "another, and are not looked for",
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
    for other in sticking[1:]:
        if not _same(sticking[0].acceleration, other.acceleration):
            return Problem(
                "several-motions",
                f"several motions are possible: {'; '.join(_in_words(one.states) for one in sticking)}",
                names,
                tuple({name: state.value for name, state in zip(names, one.states, strict=True)} for one in sticking),
                "a compliance of the contact and how it came to this state",
            )
    return max(sticking, key=lambda one: (sum(s is not State.OPEN for s in one.states), _stuck(one.states)))


def _onsets(
    at: _Situation, group: Sequence[int], states: Sequence[State], onsets: Sequence[int]
) -> list[dict[int, Direction]]:
    """Return the directions in which contacts may begin to slide in space; nothing is to be found where none does."""
    if not onsets:
        return [{}]
    (i,) = onsets

    def after(direction: Direction) -> Direction | None:
        balance = balanced(at.unilateral, group, states, at.found, {i: direction})
        if not isinstance(balance, Balance):
            return None
        along, across = (at.found.along(balance.forces, line) for line in at.found.grip(i))
        return along, across

    return [{i: direction} for direction in directions(after)]


def _in_words(states: Sequence[State]) -> str:
    return ", ".join(state.value for state in states)


def _stuck(states: Sequence[State]) -> int:
    return sum(state is State.STICK for state in states)


def _same(first: Sequence[Ball], second: Sequence[Ball]) -> bool:
    return all(is_zero(a - b) for a, b in zip(first, second, strict=True))


def _lasts(at: _Situation, group: Sequence[int], settled: Sequence[State], balance: Balance) -> bool:
    """Return whether every condition of states holds just after the start."""
    signs = [0 if is_zero(x) else 1 if x > 0 else -1 for x in _conditions(at, group, balance)]
    if min(signs) < 0:
        return False
    if min(signs) > 0 or balance.undetermined:
        return True
    states = list(settled)
    for i, state in zip(group, balance.states, strict=True):
        states[i] = state
    unilateral = list(at.unilateral)
    for i, direction in balance.directions.items():
        unilateral[i] = turned(unilateral[i], direction)
    now = replace(at, unilateral=unilateral)
    return all(leading_sign(series) >= 0 for series in _conditions_in_time(now, group, states))


def _conditions(at: _Situation, group: Sequence[int], balance: Balance) -> Iterator[Ball]:
    """Yield everything that has to be at least zero at the start."""
    found, forces = at.found, balance.forces
    for i, state in zip(group, balance.states, strict=True):
        push = forces[found.normal[i]]
        yield found.along(forces, found.normal[i]) if state is State.OPEN else push
        if state is State.STICK:
            yield from grips(at.unilateral[i].static * push, [forces[line] for line in found.grip(i)])
        if at.begins_somewhere(i, state):
            c, s = balance.directions[i]
            along, across = (found.along(forces, line) for line in found.grip(i))
            yield c * along + s * across
        elif at.may_slip(i, state):
            yield state.sense * found.along(forces, found.slips[i])


def _conditions_in_time(at: _Situation, group: Sequence[int], states: Sequence[State]) -> Iterator[list[Ball]]:
    """Yield the Taylor series of everything that has to stay at or above zero."""
    phase = phase_table(at.base, at.unilateral, states, at.q, at.v)
    motion = expansion(phase.table, LOOKED)
    for i in group:
        one, row, stuck = at.unilateral[i], phase.normal[i], phase.grip(i)
        if row is None:
            # Gap and rate are zero: the contact touches.
            yield motion.of(one.gap)[2:]
            continue
        push = motion.multipliers[row]
        yield push
        if len(stuck) == 1:
            rub = motion.multipliers[stuck[0]]
            yield [one.static * a - b for a, b in zip(push, rub, strict=True)]
            yield [one.static * a + b for a, b in zip(push, rub, strict=True)]
        elif stuck:
            yield disc([one.static * a for a in push], [motion.multipliers[line] for line in stuck])
        if at.may_slip(i, states[i]):
            yield [states[i].sense * x for x in motion.of_rates(one.slip or {})[1:]]
