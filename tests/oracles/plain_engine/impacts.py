"""Impacts. Where several contacts take impulses, all at once and one after another in every order have to agree."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from itertools import chain, permutations

import numpy as np

from tests.oracles.plain_engine.combinations import NEARLY, Combinations, clusters, free_response
from tests.oracles.plain_engine.coordinates import Floats, State
from tests.oracles.plain_engine.mechanism import Mechanism, NotSupported, Undecided
from tests.oracles.plain_engine.modes import OPEN, ways
from tests.oracles.plain_engine.slip_in_impact import impulses

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
        alone = self._by_its_law(group, rates)
        return self._together(group, rates) if alone is None else alone

    def _together(self, group: Sequence[int], rates: Floats) -> Impact:
        mechanism, state = self.mechanism, replace(self.state, rates=rates)
        struck = _Struck(mechanism, state, group, self.restitution)
        nothing = [OPEN] * len(mechanism.one_sided)
        _, found = struck.only(nothing, {i: ways(mechanism.one_sided[i].slips) for i in group})
        pushes = {i: float(found.forces[found.of("push", i)].sum()) for i in group}
        return Impact(rates + found.accelerations, pushes)

    def _by_its_law(self, group: Sequence[int], rates: Floats) -> Impact | None:
        """Return the outcome of the only contact that closes, by the law of Poisson or Stronge; None by Newton's.

        Where there is no slip the three are one for a contact alone, and in space friction goes with Newton's.
        """
        every = [self.mechanism.one_sided[i] for i in group]
        smooth = not any(one.slips for one in every)
        inelastic = all(self.restitution[i] == 0.0 for i in group)
        if all(one.touch.law == "newton" or one.slips == 3 for one in every) or (
            smooth and (inelastic or len(group) == 1)
        ):
            return None
        closing = [i for i in group if self.gaps[i] @ rates < -CLOSES * self.size]
        if len(closing) == 1:
            after = self._alone(closing[0], rates)
            if all(self.gaps[i] @ after.rates >= -CLOSES * self.size for i in group):
                return after
        raise NotSupported("several impacts at once by the laws of Poisson or Stronge")

    def _alone(self, i: int, rates: Floats) -> Impact:
        one, state = self.mechanism.one_sided[i], replace(self.state, rates=rates)
        if one.touch.law == "newton" or not one.slips:
            return self._together([i], rates)
        rows = self.mechanism.rows(state, [i], [i])
        lines = rows.lines[[*rows.of("push", i), *rows.of("slip", i)]]
        changes = free_response(self.mechanism, state) @ lines.T
        touch = replace(one.touch, restitution=self.restitution[i])
        found = impulses(lines @ changes, rows.rates[[*rows.of("push", i), *rows.of("slip", i)]], touch)
        if found is None:
            raise Undecided("no-impact", [one.name])
        return Impact(rates + changes @ found, {i: float(found[0])})

    def in_turn(self, order: Sequence[Sequence[int]], rates: Floats) -> Impact | None:
        """Return the outcome if contacts act one set after another, the first that closes; None if it has none."""
        pushes = dict.fromkeys(chain.from_iterable(order), 0.0)
        for _ in range(IN_TURN):
            hit = next((one for one in order if any(self.gaps[i] @ rates < -CLOSES * self.size for i in one)), None)
            if hit is None:
                return Impact(rates, pushes)
            try:
                one = self.at_once(hit, rates)
            except Undecided:
                return None
            rates = one.rates
            for i in hit:
                pushes[i] += one.pushes.get(i, 0.0)
        return None

    def _in_given_order(self, group: Sequence[int]) -> list[list[int]] | None:
        """Return the sets of contacts in the order in which they act, if that is given."""
        orders = {i: self.mechanism.one_sided[i].order for i in group}
        numbers = sorted({order for order in orders.values() if order is not None})
        left = [[i] for i in group if orders[i] is None]
        if len(group) < 2 or (left and self.mechanism.simultaneous != "in order"):
            return None
        return [[i for i in group if orders[i] == number] for number in numbers] + left

    def of_group(self, group: Sequence[int], rates: Floats) -> Impact:
        """Return the outcome of one group: in the order that is given, or if no order makes a difference.

        Raises
        ------
        Undecided
        """
        every = self.mechanism.one_sided
        undecided = Undecided("simultaneous-impacts", [every[i].name for i in group])
        given = self._in_given_order(group)
        if given is not None:
            ordered = self.in_turn(given, rates)
            if ordered is None:
                raise undecided
            return ordered
        found = self.at_once(group, rates)
        moves = {i: float(self.gaps[i] @ rates) / self.size for i in group}
        taking = [i for i in group if found.pushes[i] > NEARLY * max(found.pushes.values())]
        # A string that is taut already, and a guide without play, takes its part at once.
        passing = [i for i in taking if every[i].closes == "taut" or every[i].opposite]
        apart = [i for i in taking if abs(moves[i]) > NEARLY or i not in passing]
        if self.mechanism.simultaneous == "together":
            return found
        if len(apart) <= 1 and sum(rate < -NEARLY for rate in moves.values()) <= 1:
            return found
        for order in permutations(group):
            other = self.in_turn([[i] for i in order], rates) if len(group) <= ORDERED else found
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
