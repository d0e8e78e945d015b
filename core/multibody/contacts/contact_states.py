"""States of unilateral measures, and the table of a phase in which they stay the same."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from enum import Enum

from core.multibody.algebra.polynomials import ONE, ZERO, Ball, LinearForm, Poly, combined, constant, is_zero
from core.multibody.equations.expansion import product
from core.multibody.table.connection_effects import Force, Unilateral
from core.multibody.table.measures import COMPONENTS
from core.multibody.table.table import Row, Table
from core.multibody.undecided import Code


class State(Enum):
    """What a unilateral measure does."""

    OPEN = "open"
    CLOSED = "closed"
    STICK = "stick"
    FORWARD = "slide"
    BACKWARD = "slide back"

    @property
    def sense(self) -> int:
        """Sign of the rate of slip while it slides."""
        return {State.FORWARD: 1, State.BACKWARD: -1}.get(self, 0)


def sticks_more(other: Sequence[State], one: Sequence[State]) -> bool:
    """Return whether other states differ only in that something sticks where here it begins to slide.

    With a static coefficient above the kinetic both may be consistent; sticking wins.
    """
    pairs = list(zip(other, one, strict=True))
    return any(a is not b for a, b in pairs) and all(a is b or (a is State.STICK and b.sense != 0) for a, b in pairs)


def pairs_of_sides(unilateral: Sequence[Unilateral], group: Sequence[int]) -> list[tuple[int, int]]:
    """Return which of a group are both sides of a place in a guide without play, by their places in the group."""
    where = {unilateral[i].name: k for k, i in enumerate(group)}
    pairs = ((k, where.get(unilateral[i].opposite or "", -1)) for k, i in enumerate(group))
    return [(k, other) for k, other in pairs if k < other]


def grips(most: Ball, rubs: Sequence[Ball]) -> list[Ball]:
    """Return what has to be at least zero where friction of at most so much holds: linear in the plane, not in space.

    Parameters
    ----------
    most : ball
        The coefficient times the push, at least zero.
    rubs : sequence of ball
        One component of friction, or two.
    """
    if len(rubs) == 1:
        return [most - rubs[0], most + rubs[0]]
    return [most * most - sum((x * x for x in rubs), ZERO)]


def disc(most: Sequence[Ball], rubs: Sequence[Sequence[Ball]]) -> list[Ball]:
    """Return the same of two components in time, as series."""
    total = product(most, most)
    for rub in rubs:
        total = [a - b for a, b in zip(total, product(rub, rub), strict=True)]
    return total


def change_of(one: Unilateral, old: State, new: State) -> str:
    """Return what the event is called by which a state changes; nothing for a closing, which is an impact."""
    if old is new:
        return ""
    if new is State.OPEN:
        return one.opens
    if old is State.OPEN:
        return ""
    if new is State.STICK:
        return "roll" if one.rolls else "stick"
    return "slip"


@dataclass(frozen=True)
class Problem:
    """Something that mechanics does not decide.

    Attributes
    ----------
    code : str
        One of `core.multibody.undecided`.
    explanation : str
    contacts : tuple of str
        Those between which it is undecided.
    candidates : tuple of mapping of str to str
        What is possible.
    decided_by : str
        Which further assumption would decide it.
    """

    code: Code
    explanation: str
    contacts: tuple[str, ...]
    candidates: tuple[Mapping[str, str], ...] = ()
    decided_by: str = ""


@dataclass(frozen=True)
class PhaseTable:
    """The table of a phase.

    Attributes
    ----------
    table : Table
    normal, slip, across : list of int or None
        Number of the row of each unilateral measure, and of its rates of slip where it sticks.
    """

    table: Table
    normal: list[int | None]
    slip: list[int | None]
    across: list[int | None]

    def grip(self, i: int) -> list[int]:
        """Return the numbers of the rows by which a measure sticks."""
        return [row for row in (self.slip[i], self.across[i]) if row is not None]


def phase_table(
    base: Table, unilateral: Sequence[Unilateral], states: Sequence[State], q: Sequence[Ball], v: Sequence[Ball]
) -> PhaseTable:
    """Return the table whose rows are those of the base and of what is closed, from a state."""
    table = replace(base, rows=list(base.rows), q=list(q), v=list(v))
    normal: list[int | None] = []
    slip: list[int | None] = []
    across: list[int | None] = []
    for one, state in zip(unilateral, states, strict=True):
        normal.append(None)
        slip.append(None)
        across.append(None)
        if state is State.OPEN:
            continue
        drag: LinearForm = {}
        slide = None
        if state.sense and one.slip is not None:
            factor = -state.sense * one.kinetic
            drag = {j: scaled for j, poly in one.slip.items() if (scaled := combined((factor, poly)))}
            if one.across is not None and not is_zero(factor):
                slide = (factor, one.slip, one.across)
        normal[-1] = len(table.rows)
        table.rows.append(Row(one.name, one.gap, one.normal, drag=drag, slide=slide))
        if state is State.STICK:
            for number, line in zip((slip, across), one.slips, strict=False):
                number[-1] = len(table.rows)
                table.rows.append(Row(one.name, None, line))
    return PhaseTable(table, normal, slip, across)


def force_names(one: Unilateral) -> tuple[str, ...]:
    """Return what the forces of a unilateral measure are called."""
    if one.closes == "taut":
        return (f"{one.name}.tension",) if one.slip is None else (f"{one.name}.tension", f"{one.name}.friction")
    if one.unit == "N m":
        return (f"{one.name}.torque",)
    if one.tangents is not None:
        return (f"{one.name}.normal", *(f"{one.name}.friction.{axis}" for axis in COMPONENTS))
    return (f"{one.name}.normal",) if one.slip is None else (f"{one.name}.normal", f"{one.name}.friction")


def forces_of(unilateral: Sequence[Unilateral], states: Sequence[State], phase: PhaseTable) -> list[Force]:
    """Return the forces of unilateral measures in a phase: none without terms is other than zero."""
    found = []
    for number, (one, state) in enumerate(zip(unilateral, states, strict=True)):
        names = force_names(one)
        row, slip = phase.normal[number], phase.slip[number]
        found.append(Force(names[0], one.unit, [] if row is None else [(row, constant(ONE))]))
        if one.tangents is not None:
            found.extend(_in_space(one, state, phase, number, names[1:]))
        elif len(names) > 1:
            terms = []
            if slip is not None:
                terms = [(slip, constant(ONE))]
            elif row is not None and state.sense:
                terms = [(row, constant(-state.sense * one.kinetic))]
            found.append(Force(names[1], "N", terms))
            if one.closes == "taut":
                found.extend(_at_ends(one.name, *found[-2:]))
    return [*found, *_sums(unilateral, found)]


def _at_ends(name: str, mean: Force, change: Force) -> Iterator[Force]:
    """Yield the tensions at the ends of a string that rubs: half of its friction below and above their mean."""
    for number, half in ((1, -ONE / 2), (2, ONE / 2)):
        factors = dict(mean.terms)
        for row, factor in change.terms:
            factors[row] = combined((ONE, factors.get(row, {})), (half, factor))
        yield Force(f"{name}.{number}.tension", "N", list(factors.items()))


def _sums(unilateral: Sequence[Unilateral], forces: Sequence[Force]) -> list[Force]:
    """Return the forces of shapes: the sums of those of their corners."""
    found: dict[str, Force] = {}
    by_name = {force.name: force for force in forces}
    for one in unilateral:
        for name in force_names(one) if one.whole is not None else ():
            total = f"{one.whole}{name[len(one.name) :]}"
            found.setdefault(total, Force(total, one.unit)).terms.extend(by_name[name].terms)
    return list(found.values())


def _in_space(one: Unilateral, state: State, phase: PhaseTable, number: int, names: Sequence[str]) -> list[Force]:
    """Return the components of the friction of a contact in space, whose first tangent is that of its slip."""
    assert one.tangents is not None
    row, found = phase.normal[number], []
    for axis, name in enumerate(names):
        terms: list[tuple[int, Poly]] = []
        if row is not None and state.sense:
            terms = [(row, constant(-one.kinetic * one.tangents[0][axis]))]
        else:
            grips = zip(phase.grip(number), one.tangents, strict=False)
            terms = [(grip, constant(e[axis])) for grip, e in grips if not is_zero(e[axis])]
        found.append(Force(name, "N", [(r, factor) for r, factor in terms if factor]))
    return found
