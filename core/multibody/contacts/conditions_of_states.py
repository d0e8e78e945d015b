"""What has to hold of touching contacts that stay closed, stick, slide or open: at the start, and just after it.

A closed contact has N >= 0, an open one a gap that does not shrink, a sticking one |F| <= mu N, one that begins to
slide a rate of slip that grows against its friction. A sign is that of the first Taylor coefficient that is not zero,
in balls: where the acceleration is zero the jerk decides, and so on. Where forces are shared, it has to hold for some
share of the load (`certificates`).
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace

from flint import arb

from core.multibody.algebra.polynomials import ONE, ZERO, Ball, is_zero
from core.multibody.contacts.admissible_forces import admissible
from core.multibody.contacts.certificates import Weights, certificates
from core.multibody.contacts.contact_forces import Balance, sticks_in_space
from core.multibody.contacts.contact_responses import Forces, Responses, rate_along
from core.multibody.contacts.contact_states import State, grips, phase_table
from core.multibody.contacts.shares_in_space import MARGINAL
from core.multibody.contacts.slip_directions import turned
from core.multibody.equations.expansion import expansion, leading_sign
from core.multibody.table.connection_effects import Unilateral
from core.multibody.table.table import Table

LOOKED = 8
"""Highest Taylor coefficient of the places that is looked at."""


@dataclass(frozen=True)
class Situation:
    """A state with contacts about which something is to be decided.

    Attributes
    ----------
    choices : dict of int to tuple of State
        What each touching measure may do, as far as its rates tell.
    missed : ball
        Zero, with the width by which accelerations along the lines may be off: those of a state in which what sticks in
        space lets go are known no better than the share of the load with which it does.
    """

    base: Table
    unilateral: Sequence[Unilateral]
    q: Sequence[Ball]
    v: Sequence[Ball]
    choices: dict[int, tuple[State, ...]]
    found: Responses
    missed: Ball = ZERO

    def letting_go(self, group: Sequence[int]) -> Situation:
        """Return the same where what sticks in space of a group does so by nothing, as far as that is known."""
        found = self.found
        lines = [line for i in group for line in (found.normal[i], *found.grip(i))]
        missed = arb(0, MARGINAL * max(abs(float(found.free[line])) for line in lines))
        return replace(self, found=replace(found, free=[x + missed for x in found.free]), missed=missed)

    def begins_somewhere(self, i: int, state: State) -> bool:
        """Return whether a measure begins to slide in space, in a direction that is still to be found."""
        return self.may_slip(i, state) and self.unilateral[i].across is not None

    def may_slip(self, i: int, state: State) -> bool:
        """Return whether a measure begins to slide: it could as well stick."""
        return state.sense != 0 and State.STICK in self.choices[i]


def lasts(at: Situation, group: Sequence[int], settled: Sequence[State], balance: Balance) -> bool:
    """Return whether every condition of states holds just after the start."""
    signs = [0 if is_zero(x) else 1 if x > 0 else -1 for x in conditions_of(at, group, balance)]
    least = min(signs, default=1)
    if least < 0:
        return False
    if least > 0 or balance.moves:
        return True
    states = list(settled)
    for i, state in zip(group, balance.states, strict=True):
        states[i] = state
    unilateral = list(at.unilateral)
    for i, direction in balance.directions.items():
        unilateral[i] = turned(unilateral[i], direction)
    now = replace(at, unilateral=unilateral)
    return all(leading_sign(series) >= 0 for series in _conditions_in_time(now, group, states, balance))


def conditions_of(at: Situation, group: Sequence[int], balance: Balance) -> list[Ball]:
    """Return everything that has to be at least zero at the start, whatever the share of a load."""
    if balance.shares and not sticks_in_space(at.unilateral, group, balance.states):
        conditions = _linear_conditions(at, group, balance)
        return [_value(weights, balance, conditions) for weights in _certificates(balance, conditions)]
    found, forces = at.found, balance.forces
    best = balance.best or forces
    values: list[Ball] = []
    for i, state in zip(group, balance.states, strict=True):
        if state is State.STICK and balance.marginal:
            values.append(ZERO)
        elif state is State.STICK:
            push = best[found.normal[i]]
            values.append(push)
            values.extend(grips(at.unilateral[i].static * push, [best[line] for line in found.grip(i)]))
        else:
            for start, form in _of_contact(at, i, state, balance):
                # Accelerations are the same for every share.
                shared = list(form) == [found.normal[i]]
                values.append(start + rate_along(form, best if shared else forces))
    return values


def _linear_conditions(at: Situation, group: Sequence[int], balance: Balance) -> list[tuple[Ball, Forces]]:
    """Return everything that has to be at least zero, as constants and sums of the forces along lines."""
    return [
        condition
        for i, state in zip(group, balance.states, strict=True)
        for condition in _of_contact(at, i, state, balance)
    ]


def _of_contact(at: Situation, i: int, state: State, balance: Balance) -> Iterator[tuple[Ball, Forces]]:
    found, normal = at.found, at.found.normal[i]
    if state is State.OPEN:
        yield found.free[normal], dict(enumerate(found.matrix[normal]))
        return
    if state is State.STICK:
        # That it pushes follows.
        for sense in (ONE, -ONE):
            yield ZERO, {normal: at.unilateral[i].static, found.slips[i]: sense}
        return
    yield ZERO, {normal: ONE}
    if at.begins_somewhere(i, state):
        c, s = balance.directions[i]
        along, across = (found.matrix[line] for line in found.grip(i))
        start = c * found.free[found.slips[i]] + s * found.free[found.across[i]]
        yield start, {b: c * x + s * y for b, (x, y) in enumerate(zip(along, across, strict=True))}
    elif at.may_slip(i, state):
        line = found.slips[i]
        yield state.sense * found.free[line], {b: state.sense * x for b, x in enumerate(found.matrix[line])}


def _certificates(balance: Balance, conditions: Sequence[tuple[Ball, Forces]]) -> list[Weights]:
    return certificates(
        [{f: rate_along(form, share) for f, share in enumerate(balance.shares)} for _, form in conditions]
    )


def _value(weights: Weights, balance: Balance, conditions: Sequence[tuple[Ball, Forces]]) -> Ball:
    """Return a sum of conditions."""
    return sum(
        (y * (conditions[k][0] + rate_along(conditions[k][1], balance.forces)) for k, y in weights.items()), ZERO
    )


def _conditions_in_time(
    at: Situation, group: Sequence[int], states: Sequence[State], balance: Balance
) -> Iterator[list[Ball]]:
    """Yield the Taylor series of everything that has to stay at or above zero."""
    phase = phase_table(at.base, at.unilateral, states, at.q, at.v)
    motion = expansion(phase.table, LOOKED)
    for condition in admissible(at.unilateral, group, states, phase):
        series = condition.series(motion)
        # What sticks in space by nothing, as far as that is known, does so exactly.
        yield [ZERO, *series[1:]] if balance.marginal and condition.grips else series
    for i in group:
        if phase.normal[i] is None:
            # Gap and rate are zero: the contact touches.
            yield motion.of(at.unilateral[i].gap)[2:]
        elif at.may_slip(i, states[i]):
            start, *later = motion.of_rates(at.unilateral[i].slip or {})[1:]
            yield [states[i].sense * x for x in (start + at.missed, *later)]


def moves_as(at: Situation, group: Sequence[int], balance: Balance, others: Sequence[Balance]) -> bool:
    """Return whether all admissible shares of a balance give one motion, which is one of others."""
    conditions = _linear_conditions(at, group, balance)
    # What is zero in a sum that cannot be negative is zero for every admissible share.
    zero = {
        k
        for weights in _certificates(balance, conditions)
        if is_zero(_value(weights, balance, conditions))
        for k in weights
    }
    chosen = [conditions[k] for k in sorted(zero)]
    only = balance.with_shares_where([form for _, form in chosen], [-start for start, _ in chosen])
    return only is not None and any(same_motion(only.acceleration, other.acceleration) for other in others)


def same_motion(first: Sequence[Ball], second: Sequence[Ball]) -> bool:
    """Return whether accelerations cannot be told apart."""
    return all(is_zero(a - b) for a, b in zip(first, second, strict=True))
