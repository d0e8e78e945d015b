"""Impacts by Newton's law of restitution with Coulomb's friction: all combinations of states are tried.

With p the impulses along gaps and s along slips: p >= 0 and the gap opens at e times the rate at which it closed, or
p = 0 and it opens at least as fast; where p > 0 the slip stops and |s| <= mu p, or s = -mu p along a slip that goes on.
Where several contacts take impulses, all at once and one after another in every order have to agree.

References
----------
F. Pfeiffer, C. Glocker, "Multibody Dynamics with Unilateral Contacts" (1996), chapter 8.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from itertools import permutations, product

import numpy as np
from scipy.optimize import brentq
from scipy.sparse.csgraph import connected_components

from tests.oracles.plain_engine.coordinates import Floats, State
from tests.oracles.plain_engine.mechanism import Mechanism, Undecided
from tests.oracles.plain_engine.phase import CLOSED, OPEN, STICK, Inconsistent, Kind, Mode, Phase, solved, sticks_more

NONE = 1e-9
"""Share of the largest rate, or impulse, below which one is zero."""
ALIKE = 1e-8
"""The same for two outcomes."""
COUPLED = 1e-11
"""Share of what an impulse changes below which it does not change the rate of another contact."""
IN_TURN = 400
"""Impacts one after another before an order is given up."""
ORDERED = 4
"""Contacts of which every order is tried."""


@dataclass(frozen=True)
class Impact:
    """Change of the rates, and the impulses (along the gap, along the slips) by measure."""

    change: Floats
    impulses: Mapping[int, tuple[float, Floats]]


class Struck:
    """Rows of what touches and of what holds, and the outcomes of impacts on them.

    Parameters
    ----------
    restitution : mapping of int to float
        By measure.
    """

    def __init__(
        self,
        mechanism: Mechanism,
        state: State,
        touching: Sequence[int],
        restitution: Mapping[int, float] | None = None,
    ) -> None:
        self.every, self.touching, self.restitution = mechanism.one_sided, list(touching), restitution or {}
        modes = [OPEN] * len(self.every)
        for i in touching:
            modes[i] = STICK if self.every[i].slips else CLOSED
        rows, normals, slips, _ = Phase(mechanism, modes).rows(state)
        self.gap = {i: rows.lines[k] for i, k in normals.items()}
        self.slip = {i: rows.lines[slips.get(i, slice(0, 0))] for i in touching}
        others = np.ones(len(rows.lines), dtype=bool)
        for part in (*normals.values(), *slips.values()):
            others[part] = False
        self.held, self.mass = rows.lines[others], mechanism.inertia(state)
        self.size = max(float(np.abs(state.rates).max(initial=0.0)), 1e-12)

    def clusters(self) -> list[list[int]]:
        """Return the measures in groups that do not push one another."""
        n, m = len(self.mass), len(self.held)
        whole = np.block([[self.mass, -self.held.T], [self.held, np.zeros((m, m))]])
        response = np.linalg.pinv(whole, rcond=COUPLED)[:n, :n]
        lines = [np.concatenate([self.gap[i][None], self.slip[i]]) for i in self.touching]
        coupled = [
            [np.abs(a @ response @ b.T).max() > COUPLED * max(np.linalg.norm(a @ response), 1e-300) for b in lines]
            for a in lines
        ]
        count, labels = connected_components(np.array(coupled).reshape(len(lines), -1))
        return [[i for i, label in zip(self.touching, labels, strict=True) if label == k] for k in range(count)]

    def closing(self, i: int, rates: Floats) -> float:
        """Return the rate at which a gap closes; negative where it opens."""
        return -float(self.gap[i] @ rates)

    def given(self, states: Mapping[int, Mode], rates: Floats) -> Impact | None:
        """Return what contacts in given states do; None if that contradicts what holds."""
        lines, columns, targets = [self.held], [self.held], [np.zeros(len(self.held))]
        taking = {i: mode for i, mode in states.items() if mode.kind is not Kind.OPEN}
        for i, mode in taking.items():
            push, closing = self.gap[i], self.closing(i, rates)
            if mode.kind is Kind.SLIDE:
                push = push - self.every[i].kinetic * np.array(mode.along) @ self.slip[i]
            lines.append(self.gap[i][None])
            columns.append(push[None])
            targets.append(np.array([-closing - self.restitution[i] * max(closing, 0.0)]))
            if mode.kind is Kind.STICK:
                lines.append(self.slip[i])
                columns.append(self.slip[i])
                targets.append(self.slip[i] @ rates)
        sizes = [len(x) for x in lines[1:]]
        gains = np.concatenate(targets)
        # Without loads, what the rows gain by themselves takes the place of the rates that they lose.
        try:
            found = solved(self.mass, np.zeros(len(rates)), np.concatenate(lines), gains, np.concatenate(columns).T)
        except Inconsistent:
            return None
        impulses = {i: (0.0, np.zeros(self.every[i].slips)) for i in states}
        blocks = iter(np.split(found[1][len(self.held) :], np.cumsum(sizes)[:-1]))
        for i, mode in taking.items():
            push = float(next(blocks)[0])
            rub = -self.every[i].kinetic * push * np.array(mode.along) if mode.kind is Kind.SLIDE else impulses[i][1]
            impulses[i] = (push, next(blocks) if mode.kind is Kind.STICK else rub)
        return Impact(found[0], impulses)

    def holds(self, states: Mapping[int, Mode], rates: Floats, found: Impact) -> bool:
        """Return whether an outcome goes with the states from which it comes."""
        after = rates + found.change
        nothing, still = NONE * max((abs(push) for push, _ in found.impulses.values()), default=0.0), NONE * self.size
        for i, mode in states.items():
            push, rub = found.impulses[i]
            if mode.kind is Kind.OPEN:
                if self.closing(i, after) > self.restitution[i] * -max(self.closing(i, rates), 0.0) + still:
                    return False
            elif push < -nothing:
                return False
            elif mode.kind is Kind.STICK:
                if float(np.linalg.norm(rub)) > self.every[i].static * push + nothing:
                    return False
            elif mode.kind is Kind.SLIDE and float(np.array(mode.along) @ self.slip[i] @ after) < -still:
                return False
        return True

    def at_once(self, group: Sequence[int], rates: Floats) -> Impact:
        """Return the outcome if all contacts of a group act together.

        Raises
        ------
        Undecided
            Where the law has no outcome, or several.
        """
        consistent: list[tuple[list[Mode], Impact]] = []
        for modes in product(*(_choices(self.every[i].slips) for i in group)):
            for states in self._directed(dict(zip(group, modes, strict=True)), rates):
                found = self.given(states, rates)
                if found is not None and self.holds(states, rates, found):
                    consistent.append((list(states.values()), found))
        names = [self.every[i].name for i in group]
        if not consistent:
            raise Undecided("no-impact", names)
        least = [one for one in consistent if not any(sticks_more(other[0], one[0]) for other in consistent)]
        if any(np.abs(other[1].change - least[0][1].change).max() > ALIKE * self.size for other in least):
            raise Undecided("several-impacts", names)
        return min(least, key=lambda one: sum(mode.kind is not Kind.OPEN for mode in one[0]))[1]

    def in_turn(self, order: Sequence[int], rates: Floats) -> Impact | None:
        """Return the outcome if contacts act one after another, the first of them that closes; None if it has none."""
        change = np.zeros(len(rates))
        total = {i: (0.0, np.zeros(self.every[i].slips)) for i in order}
        for _ in range(IN_TURN):
            hit = next((i for i in order if self.closing(i, rates + change) > 1e-14 * self.size), None)
            if hit is None:
                return Impact(change, total)
            try:
                one = self.at_once([hit], rates + change)
            except Undecided:
                return None
            change = change + one.change
            total[hit] = (total[hit][0] + one.impulses[hit][0], total[hit][1] + one.impulses[hit][1])
        return None

    def of_group(self, group: Sequence[int], rates: Floats) -> Impact:
        """Return the outcome of one group: in the order that is given, or if no order makes a difference.

        Raises
        ------
        Undecided
        """
        orders = {i: self.every[i].order for i in group}
        undecided = Undecided("simultaneous-impacts", [self.every[i].name for i in group])
        if len(group) > 1 and None not in orders.values():
            ordered = self.in_turn(sorted(group, key=lambda i: (orders[i] or 0.0, i)), rates)
            if ordered is None:
                raise undecided
            return ordered
        found = self.at_once(group, rates)
        least = NONE * max(push for push, _ in found.impulses.values())
        closing = [i for i in group if self.closing(i, rates) > NONE * self.size]
        # A string that is taut already takes its part at once.
        apart = [
            i
            for i in group
            if found.impulses[i][0] > least
            and (abs(self.closing(i, rates)) > NONE * self.size or self.every[i].closes != "taut")
        ]
        if len(apart) <= 1 and len(closing) <= 1:
            return found
        if len(group) > ORDERED:
            raise undecided
        for order in permutations(group):
            other = self.in_turn(order, rates)
            if other is not None and np.abs(other.change - found.change).max() > ALIKE * self.size:
                raise undecided
        return found

    def _directed(self, states: dict[int, Mode], rates: Floats) -> Iterator[dict[int, Mode]]:
        """Yield the states with the directions in space in which something slides afterwards."""
        open_ways = [i for i, mode in states.items() if mode.kind is Kind.SLIDE and not mode.along]
        if len(open_ways) != 1:
            yield from [] if open_ways else [states]
            return
        (i,) = open_ways
        frame = np.linalg.svd(self.slip[i].T)[2][:2]

        def along(angle: float) -> dict[int, Mode]:
            direction = np.array([np.cos(angle), np.sin(angle)]) @ frame
            return {**states, i: Mode(Kind.SLIDE, tuple(direction.tolist()))}

        def beside(angle: float) -> float:
            found = self.given(along(angle), rates)
            x, y = (np.nan, np.nan) if found is None else frame @ (self.slip[i] @ (rates + found.change))
            return float(np.cos(angle) * y - np.sin(angle) * x)

        grid = np.linspace(0.0, 2 * np.pi, 49)
        values = [beside(angle) for angle in grid]
        for a, b, x, y in zip(grid[:-1], grid[1:], values[:-1], values[1:], strict=True):
            if x == 0.0 or x * y < 0.0:
                yield along(float(a) if x == 0.0 else float(brentq(beside, a, b, xtol=1e-15, rtol=1e-15)))


def impact(mechanism: Mechanism, state: State, touching: Sequence[int], restitution: Mapping[int, float]) -> Impact:
    """Return the outcome of an impact of what touches.

    Raises
    ------
    Undecided
        Where the law has no outcome, or several.
    """
    struck = Struck(mechanism, state, touching, restitution)
    change, impulses = np.zeros(len(state.rates)), {}
    for group in struck.clusters():
        if any(struck.closing(i, state.rates) > NONE * struck.size for i in group):
            found = struck.of_group(group, state.rates)
            change = change + found.change
            impulses.update(found.impulses)
    before, after = (0.5 * rates @ struck.mass @ rates for rates in (state.rates, state.rates + change))
    if after > before * (1 + NONE) and not mechanism.rows(state).driven.any():
        raise Undecided("energy-gain", [mechanism.one_sided[i].name for i in impulses])
    return Impact(change, impulses)


def _choices(width: int) -> tuple[Mode, ...]:
    sliding = {0: (), 1: (Mode(Kind.SLIDE, (1.0,)), Mode(Kind.SLIDE, (-1.0,)))}.get(width, (Mode(Kind.SLIDE),))
    return (OPEN, STICK if width else CLOSED, *sliding)
