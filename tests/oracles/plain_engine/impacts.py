"""Impacts. Where several contacts take impulses, all at once and one after another in every order have to agree."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from itertools import permutations

import numpy as np

from tests.oracles.plain_engine.combinations import NEARLY, Combinations, clusters
from tests.oracles.plain_engine.coordinates import Floats, State
from tests.oracles.plain_engine.mechanism import Mechanism, Undecided
from tests.oracles.plain_engine.modes import OPEN, ways

ALIKE = 1e-8
"""Share of the rates within which those after two orders are the same."""
CLOSES = 1e-14
"""Share of the rates at which a gap closes in a sequence of impacts."""
GAIN = 1e-12
"""Share of the kinetic energy that an impact may add by rounding."""
IN_TURN = 400
"""Impacts one after another before an order is given up."""
ORDERED = 4
"""Contacts of which every order is tried."""


@dataclass(frozen=True)
class Impact:
    """Rates afterwards, and the impulses along the gaps by measure."""

    rates: Floats
    pushes: Mapping[int, float]


class _Struck(Combinations):
    codes = ("no-impact", "several-impacts", "several-impacts")


class Impacts:
    """What touches in a state, and the outcomes of its impacts.

    Parameters
    ----------
    restitution : mapping of int to float
        By measure.
    """

    def __init__(self, mechanism: Mechanism, state: State, restitution: Mapping[int, float]) -> None:
        self.mechanism, self.state, self.restitution = mechanism, state, restitution
        rows = mechanism.rows(state, restitution)
        self.gaps = {i: rows.lines[rows.of("push", i)[0]] for i in restitution}
        self.size = max(float(np.abs(state.rates).max(initial=0.0)), 1e-12)

    def at_once(self, group: Sequence[int], rates: Floats) -> Impact:
        """Return the outcome if all contacts of a group act together."""
        mechanism, state = self.mechanism, replace(self.state, rates=rates)
        struck = _Struck(mechanism, state, group, self.restitution)
        nothing = [OPEN] * len(mechanism.one_sided)
        _, found = struck.only(nothing, {i: ways(mechanism.one_sided[i].slips) for i in group})
        pushes = {i: float(found.forces[found.of("push", i)].sum()) for i in group}
        return Impact(rates + found.accelerations, pushes)

    def in_turn(self, order: Sequence[int], rates: Floats) -> Impact | None:
        """Return the outcome if contacts act one after another, the first of them that closes; None if it has none."""
        pushes = dict.fromkeys(order, 0.0)
        for _ in range(IN_TURN):
            hit = next((i for i in order if self.gaps[i] @ rates < -CLOSES * self.size), None)
            if hit is None:
                return Impact(rates, pushes)
            try:
                one = self.at_once([hit], rates)
            except Undecided:
                return None
            rates, pushes[hit] = one.rates, pushes[hit] + one.pushes[hit]
        return None

    def of_group(self, group: Sequence[int], rates: Floats) -> Impact:
        """Return the outcome of one group: in the order that is given, or if no order makes a difference.

        Raises
        ------
        Undecided
        """
        every = self.mechanism.one_sided
        orders = {i: every[i].order for i in group}
        undecided = Undecided("simultaneous-impacts", [every[i].name for i in group])
        if len(group) > 1 and None not in orders.values():
            ordered = self.in_turn(sorted(group, key=lambda i: (orders[i] or 0.0, i)), rates)
            if ordered is None:
                raise undecided
            return ordered
        found = self.at_once(group, rates)
        moves = {i: float(self.gaps[i] @ rates) / self.size for i in group}
        taking = [i for i in group if found.pushes[i] > NEARLY * max(found.pushes.values())]
        # A string that is taut already takes its part at once.
        apart = [i for i in taking if abs(moves[i]) > NEARLY or every[i].closes != "taut"]
        if len(apart) <= 1 and sum(rate < -NEARLY for rate in moves.values()) <= 1:
            return found
        for order in permutations(group):
            other = self.in_turn(order, rates) if len(group) <= ORDERED else found
            if len(group) > ORDERED or (
                other is not None and np.abs(other.rates - found.rates).max() > ALIKE * self.size
            ):
                raise undecided
        return found


def impact(mechanism: Mechanism, state: State, restitution: Mapping[int, float]) -> Impact:
    """Return the outcome of an impact of what touches.

    Raises
    ------
    Undecided
        Where the law has no outcome, or several.
    """
    impacts = Impacts(mechanism, state, restitution)
    rates, pushes = state.rates, dict[int, float]()
    for group in clusters(mechanism, state, list(restitution)):
        if any(impacts.gaps[i] @ rates < -NEARLY * impacts.size for i in group):
            found = impacts.of_group(group, rates)
            rates, pushes = found.rates, {**pushes, **found.pushes}
    mass = mechanism.inertia(state)
    gained = (rates - state.rates) @ mass @ (rates + state.rates) > GAIN * (state.rates @ mass @ state.rates)
    if gained and not mechanism.rows(state).driven.any():
        raise Undecided("energy-gain", [mechanism.one_sided[i].name for i in pushes])
    return Impact(rates, pushes)
