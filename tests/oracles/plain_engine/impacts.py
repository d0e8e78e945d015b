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

from tests.oracles.plain_engine.coordinates import Floats, State
from tests.oracles.plain_engine.mechanism import Mechanism, Undecided
from tests.oracles.plain_engine.phase import CLOSED, OPEN, STICK, Kind, Mode, Phase, sticks_more

NONE = 1e-9
"""Share of the largest rate, or impulse, below which one is zero."""
ALIKE = 1e-8
"""The same for two outcomes."""
IN_TURN = 400
"""Impacts one after another before an order is given up."""
ORDERED = 4
"""Contacts of which every order is tried."""


@dataclass(frozen=True)
class Impact:
    """Rates afterwards, and the impulses (along the gap, along the slips) by measure."""

    rates: Floats
    impulses: Mapping[int, tuple[float, Floats]]


class Struck:
    """What impulses at touching contacts change: Delassus' operator of their gaps and slips."""

    def __init__(
        self,
        mechanism: Mechanism,
        state: State,
        touching: Sequence[int],
        restitution: Mapping[int, float] | None = None,
    ) -> None:
        every = mechanism.one_sided
        modes = [OPEN] * len(every)
        for i in touching:
            modes[i] = STICK if every[i].slips else CLOSED
        phase = Phase(mechanism, modes)
        rows, normals, slips, count = phase.rows(state)
        taken = [*normals.values(), *(k for part in slips.values() for k in range(part.start, part.stop))]
        held = [k for k in range(count) if k not in taken]
        n, m = len(state.rates), len(held)
        mass = mechanism.inertia(state)
        matrix = np.zeros((n + m, n + m))
        matrix[:n, :n] = mass
        matrix[:n, n:] = -rows.lines[held].T
        matrix[n:, :n] = rows.lines[held]
        self.response = np.linalg.pinv(matrix, rcond=1e-11)[:n, :n]
        self.touching, self.every = list(touching), every
        self.restitution = restitution or {}
        self.lines = rows.lines
        self.normals, self.slips = normals, slips

    def lines_of(self, i: int) -> list[int]:
        """Return the lines of a measure: its gap, then its slips."""
        part = self.slips.get(i)
        return [self.normals[i], *(() if part is None else range(part.start, part.stop))]

    def clusters(self) -> list[list[int]]:
        """Return the measures in groups that do not push one another."""
        left, found = list(self.touching), []
        while left:
            group, left = [left[0]], left[1:]
            for i in group:
                for j in list(left):
                    block = self.lines[self.lines_of(i)] @ self.response @ self.lines[self.lines_of(j)].T
                    own = np.linalg.norm(self.lines[self.lines_of(i)] @ self.response)
                    if np.abs(block).max(initial=0.0) > 1e-11 * max(own, 1e-300):
                        group.append(j)
                        left.remove(j)
            found.append(sorted(group))
        return found


def impact(mechanism: Mechanism, state: State, touching: Sequence[int], restitution: Mapping[int, float]) -> Impact:
    """Return the outcome of an impact of what touches.

    Raises
    ------
    Undecided
        Where the law has no outcome, or several.
    """
    struck = Struck(mechanism, state, touching, restitution)
    rates, impulses = state.rates.copy(), {}
    mass = mechanism.inertia(state)
    energy = 0.5 * rates @ mass @ rates
    size = max(float(np.abs(rates).max(initial=0.0)), 1e-12)
    before = rates.copy()
    for group in struck.clusters():
        if not any(struck.lines[struck.normals[i]] @ before < -NONE * size for i in group):
            continue
        change, given = _group(struck, group, before, size)
        rates = rates + change
        impulses.update(given)
    driven = mechanism.rows(state).driven.any()
    if not driven and 0.5 * rates @ mass @ rates > energy * (1 + 1e-9):
        raise Undecided("energy-gain", [mechanism.one_sided[i].name for i in impulses])
    return Impact(rates, impulses)


Outcome = tuple[Floats, dict[int, tuple[float, Floats]]]


def _group(struck: Struck, group: Sequence[int], rates: Floats, size: float) -> Outcome:
    names = [struck.every[i].name for i in group]
    orders = [struck.every[i].order for i in group]
    if len(group) > 1 and all(x is not None for x in orders):
        in_turn = _in_turn(struck, sorted(group, key=lambda i: (struck.every[i].order or 0.0, i)), rates, size)
        if in_turn is None:
            raise Undecided("simultaneous-impacts", names)
        return in_turn
    at_once = _at_once(struck, group, rates, size)
    push = NONE * max((abs(x[0]) for x in at_once[1].values()), default=0.0)
    taking = [i for i in group if at_once[1][i][0] > push]
    closing = [i for i in group if struck.lines[struck.normals[i]] @ rates < -NONE * size]
    apart = [
        i for i in taking if i in closing or _rate(struck, i, rates) > NONE * size or struck.every[i].closes != "taut"
    ]
    if len(apart) <= 1 and len(closing) <= 1:
        return at_once
    if len(group) > ORDERED:
        raise Undecided("simultaneous-impacts", names)
    for order in permutations(group):
        in_turn = _in_turn(struck, order, rates, size)
        if in_turn is not None and np.abs(in_turn[0] - at_once[0]).max() > ALIKE * size:
            raise Undecided("simultaneous-impacts", names)
    return at_once


def _rate(struck: Struck, i: int, rates: Floats) -> float:
    return float(struck.lines[struck.normals[i]] @ rates)


def _in_turn(struck: Struck, order: Sequence[int], rates: Floats, size: float) -> Outcome | None:
    now = rates.copy()
    total = {i: (0.0, np.zeros(struck.every[i].slips)) for i in order}
    for _ in range(IN_TURN):
        hit = next((i for i in order if _rate(struck, i, now) < -1e-14 * size), None)
        if hit is None:
            return now - rates, total
        try:
            change, one = _at_once(struck, [hit], now, size)
        except Undecided:
            return None
        now = now + change
        total[hit] = (total[hit][0] + one[hit][0], total[hit][1] + one[hit][1])
    return None


def _at_once(struck: Struck, group: Sequence[int], rates: Floats, size: float) -> Outcome:
    """Return the change of the rates, and the impulses, if all contacts of a group act together."""
    consistent: list[tuple[tuple[Mode, ...], Outcome]] = []
    for states in product(*(_choices(struck.every[i].slips) for i in group)):
        for chosen in _ways(struck, group, states, rates):
            found = _solved(struck, group, chosen, rates)
            if found is not None and _holds(struck, group, chosen, rates, found, size):
                consistent.append((chosen, found))
    names = [struck.every[i].name for i in group]
    if not consistent:
        raise Undecided("no-impact", names)
    least = [one for one in consistent if not any(sticks_more(other[0], one[0]) for other in consistent)]
    first = least[0][1][0]
    if any(np.abs(other[1][0] - first).max() > ALIKE * size for other in least[1:]):
        raise Undecided("several-impacts", names)
    return min(least, key=lambda one: sum(mode.kind is not Kind.OPEN for mode in one[0]))[1]


def _choices(width: int) -> tuple[Mode, ...]:
    if width == 0:
        return (OPEN, CLOSED)
    if width == 1:
        return (OPEN, STICK, Mode(Kind.SLIDE, (1.0,)), Mode(Kind.SLIDE, (-1.0,)))
    return (OPEN, STICK, Mode(Kind.SLIDE, ()))


def _ways(
    struck: Struck,
    group: Sequence[int],
    states: tuple[Mode, ...],
    rates: Floats,
) -> Iterator[tuple[Mode, ...]]:
    """Yield the states with the directions in space in which something slides afterwards."""
    open_ways = [k for k, mode in enumerate(states) if mode.kind is Kind.SLIDE and not mode.along]
    if not open_ways:
        yield states
        return
    if len(open_ways) > 1:
        return
    k = open_ways[0]
    part = struck.slips[group[k]]
    _, _, vt = np.linalg.svd(struck.lines[part].T)
    frame = vt[:2]

    def along(angle: float) -> tuple[Mode, ...]:
        direction = np.array([np.cos(angle), np.sin(angle)]) @ frame
        return (*states[:k], Mode(Kind.SLIDE, tuple(direction.tolist())), *states[k + 1 :])

    def beside(angle: float) -> float:
        found = _solved(struck, group, along(angle), rates)
        if found is None:
            return np.nan
        x, y = frame @ (struck.lines[part] @ (rates + found[0]))
        return float(np.cos(angle) * y - np.sin(angle) * x)

    grid = np.linspace(0.0, 2 * np.pi, 49)
    values = [beside(angle) for angle in grid]
    for a, b, x, y in zip(grid[:-1], grid[1:], values[:-1], values[1:], strict=True):
        if x == 0.0:
            yield along(float(a))
        elif x * y < 0.0:
            yield along(float(brentq(beside, a, b, xtol=1e-15, rtol=1e-15)))


def _solved(struck: Struck, group: Sequence[int], states: Sequence[Mode], rates: Floats) -> Outcome | None:
    pushes: list[Floats] = []
    wanted: list[int] = []
    targets: list[float] = []
    owners: list[tuple[int, Floats, float]] = []
    for i, mode in zip(group, states, strict=True):
        if mode.kind is Kind.OPEN:
            continue
        one, row = struck.every[i], struck.normals[i]
        push = struck.lines[row].copy()
        rub = np.zeros(one.slips)
        if mode.kind is Kind.SLIDE:
            rub = -one.kinetic * np.array(mode.along)
            push = push + rub @ struck.lines[struck.slips[i]]
        pushes.append(push)
        owners.append((i, rub, 1.0))
        wanted.append(row)
        targets.append(-_rate(struck, i, rates) - struck.restitution[i] * min(_rate(struck, i, rates), 0.0))
        if mode.kind is Kind.STICK:
            part = struck.slips[i]
            for k, line in enumerate(range(part.start, part.stop)):
                pushes.append(struck.lines[line])
                owners.append((i, np.eye(one.slips)[k], 0.0))
                wanted.append(line)
                targets.append(-float(struck.lines[line] @ rates))
    impulses = {i: (0.0, np.zeros(struck.every[i].slips)) for i in group}
    if not pushes:
        return np.zeros(len(rates)), impulses
    spread = struck.response @ np.array(pushes).T
    matrix = struck.lines[wanted] @ spread
    sizes = np.sqrt(np.abs(matrix.diagonal()))
    sizes[sizes == 0.0] = 1.0
    right = np.array(targets)
    found, _, _, _ = np.linalg.lstsq(matrix / sizes[:, None] / sizes, right / sizes, rcond=1e-10)
    if np.abs(matrix / sizes[:, None] / sizes @ found - right / sizes).max() > 1e-8 * max(
        np.abs(right / sizes).max(), 1e-300
    ):
        return None
    found = found / sizes
    for x, (i, rub, normal) in zip(found, owners, strict=True):
        impulses[i] = (impulses[i][0] + x * normal, impulses[i][1] + x * rub)
    return spread @ found, impulses


def _holds(
    struck: Struck,
    group: Sequence[int],
    states: Sequence[Mode],
    rates: Floats,
    found: Outcome,
    size: float,
) -> bool:
    after = rates + found[0]
    largest = max((abs(push) for push, _ in found[1].values()), default=0.0)
    for i, mode in zip(group, states, strict=True):
        rebound = struck.restitution[i] * min(_rate(struck, i, rates), 0.0)
        opening = float(struck.lines[struck.normals[i]] @ after) + rebound
        push, rub = found[1][i]
        if mode.kind is Kind.OPEN:
            if opening < -NONE * size:
                return False
            continue
        if push < -NONE * largest:
            return False
        if mode.kind is Kind.STICK and float(np.linalg.norm(rub)) > struck.every[i].static * push + NONE * largest:
            return False
        if mode.kind is Kind.SLIDE:
            slip = struck.lines[struck.slips[i]] @ after
            if float(np.array(mode.along) @ slip) < -NONE * size:
                return False
    return True
