"""What ends a phase: gaps, forces and rates of slip that may not become negative while it lasts."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import partial
from typing import Literal

from core.formulas import names_of
from core.multibody.algebra.polynomials import ONE, Ball
from core.multibody.contacts.admissible_forces import AdmissibleForce, admissible
from core.multibody.contacts.contact_states import PhaseTable, State
from core.multibody.equations.expansion import Expansion, Series, leading_sign
from core.multibody.equations.starting_pieces import series_of
from core.multibody.language.switches import ends_of_domain
from core.multibody.laws.law import Law
from core.multibody.phases.uniform_pieces import polynomial_of
from core.multibody.search.bands import Quantity
from core.multibody.search.curves import Curve
from core.multibody.search.first_of_motion import Watched
from core.multibody.search.pieces import Pieces
from core.multibody.table.connection_effects import Limit, Unilateral
from core.multibody.table.law_pieces import Argument
from core.multibody.table.table import Table


@dataclass(frozen=True)
class Passage:
    """A quantity that passes through a value.

    Attributes
    ----------
    along : callable
        The quantity less the value, along a motion in pieces.
    of_forces : bool
        Whether it depends on multipliers.
    """

    along: Quantity
    of_forces: bool


@dataclass(frozen=True)
class Watch:
    """Something that stays at or above zero during a phase.

    Attributes
    ----------
    number : int
        Of the unilateral measure.
    what : {"gap", "push", "grip", "slip", "length", "region", "switch", "value", "time"}
        A length is that of a part of a string, a spring or another line: where it is zero, the motion ends. A region is
        that in which a corner meets a facet of another shape, a switch the argument of a formula of several pieces, a
        value one through which a quantity passes, and a time one that is known beforehand.
    admissible : AdmissibleForce or None
        What has to be positive, for "push" and "grip".
    argument : Law or None
        Of a switch.
    power : int or None
        Of time with which a gap opens at the start of the phase, where that is known; zero where it is open.
    passage : Passage or None
        Of a value.
    """

    number: int
    what: Literal["gap", "push", "grip", "slip", "length", "region", "switch", "value", "time"]
    one: Unilateral
    sense: int = 1
    admissible: AdmissibleForce | None = None
    argument: Law | None = None
    power: int | None = None
    passage: Passage | None = None

    def series(self, motion: Expansion) -> Series | None:
        """Return it along a motion with constant accelerations; None of a value, and of what is no polynomial."""
        if self.passage is not None:
            return None
        if self.what in ("gap", "length", "region"):
            return motion.of(self.one.gap)
        if self.argument is not None:
            found = polynomial_of(self.argument, motion)
            return None if found is None else [self.sense * x for x in found]
        if self.what == "slip":
            return [self.sense * x for x in motion.of_rates(self.one.slip or {})]
        assert self.admissible is not None
        return self.admissible.series(motion)

    @property
    def watched(self) -> Watched:
        """What a search has to know of it."""
        jumps, length = self.what in ("gap", "length"), self.what == "length"
        of_forces = self.admissible is not None or (self.passage is not None and self.passage.of_forces)
        return Watched(self.along, of_forces, jumps, length, self.power)

    def along(self, pieces: Pieces) -> Curve:
        """Return it along a motion in pieces."""
        if self.what in ("gap", "length", "region"):
            return pieces.of(self.one.gap)
        if self.argument is not None:
            return pieces.nothing().plus(self.sense * ONE, pieces.law(self.argument))
        if self.passage is not None:
            return pieces.nothing().plus(self.sense * ONE, self.passage.along(pieces))
        if self.what == "slip":
            return pieces.nothing().plus(self.sense * ONE, pieces.of_rates(self.one.slip or {}))
        assert self.admissible is not None
        total = pieces.nothing()
        for row, factor in self.admissible.terms.items():
            total = total.plus(factor, pieces.multiplier(row))
        if not self.admissible.rubs:
            return total
        square = total.times(total)
        for row in self.admissible.rubs:
            square = square.plus(-ONE, pieces.multiplier(row).times(pieces.multiplier(row)))
        return square


def watches(
    unilateral: Sequence[Unilateral],
    states: Sequence[State],
    phase: PhaseTable,
    openings: Mapping[int, int],
    *,
    of_forces: bool = True,
) -> list[Watch]:
    """Return what ends a phase; of forces that are constant nothing is watched.

    Parameters
    ----------
    openings : mapping of int to int
        Powers of time with which gaps open; zero for those that are open.
    """
    closed = [i for i in range(len(unilateral)) if phase.normal[i] is not None]
    # The other side of a guide stays at zero.
    gaps = [i for i, one in enumerate(unilateral) if i not in closed and one.opposite is None]
    found = [Watch(i, "gap", unilateral[i], power=openings.get(i)) for i in gaps]
    for force in admissible(unilateral, closed, states, phase) if of_forces else ():
        what: Literal["push", "grip"] = "grip" if force.grips else "push"
        found.append(Watch(force.number, what, unilateral[force.number], admissible=force))
    found.extend(Watch(i, "slip", unilateral[i], states[i].sense) for i in closed if states[i].sense)
    found.extend(
        Watch(i, "region", Unilateral(one.name, bound)) for i, one in enumerate(unilateral) for bound in one.region
    )
    return found


def switches(arguments: Iterable[Argument], start: Table) -> list[Watch]:
    """Return the arguments of formulas that change their sign where these change their piece.

    An argument may do so by a pole as well: there it has no value, and what leads there is watched too.

    Parameters
    ----------
    start : Table
        With the state at the start of the phase.
    """
    found = []
    state = Expansion([[q, v] for q, v in zip(start.q, start.v, strict=True)], [])
    for one in arguments:
        if not one.sign or not one.law.inputs:
            continue
        watch = partial(Watch, -1, "switch", Unilateral(", ".join(one.names), {}))
        found.append(watch(one.sign, argument=one.law))
        for root in ends_of_domain(one.law.root):
            if names_of(root) & one.law.inputs.keys():
                domain = replace(one.law, root=root)
                found.append(watch(leading_sign(series_of(domain, state, 1)) or 1, argument=domain))
    return found


def lengths(limits: Sequence[Limit]) -> list[Watch]:
    """Return the lengths whose zeros end a motion."""
    return [Watch(-1, "length", Unilateral(one.name, one.length)) for one in limits if one.length is not None]


@dataclass(frozen=True)
class Crossing:
    """The end of a phase.

    Attributes
    ----------
    time : ball
        Since the start of the phase.
    watch : Watch
        What changed its sign.
    q, v : list of ball
        State there.
    """

    time: Ball
    watch: Watch
    q: list[Ball]
    v: list[Ball]
