"""What begins, ends and strikes in a motion, and whether its occasion has come."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from typing import Literal

import numpy as np

from core.errors import InvalidParameter, Path
from core.multibody.algebra.polynomials import Ball
from core.multibody.language.declared_units import Measured, is_plain
from core.multibody.language.occasions import AtEvent, Event, Occasion, PassedValue, occasion
from core.multibody.phases.phase import Phase
from core.multibody.phases.phase_ends import expansions_of
from core.multibody.phases.watches import Passage, Watch
from core.multibody.search.first_of_motion import Expansions
from core.multibody.table.connection_effects import Unilateral
from core.multibody.table.description import Described
from core.multibody.table.law_pieces import switching
from core.multibody.trajectory.columns import COLUMNS_OF_STATES, Columns
from core.multibody.trajectory.occurrences import component, unknown_quantity
from core.multibody.trajectory.quantities import Sought, sought_in

Kind = Literal["begin", "end", "impulse"]

KINDS: Mapping[str, Kind] = {"from": "begin", "until": "end", "at": "impulse"}
"""What happens at the occasion of each field."""

CLEAR = 2.0**-40
"""Share of its terms above which a quantity less its value is not what rounding has left of zero."""
MOST_POWERS = 6
"""Powers of time by which it is told to which side a quantity leaves a value: as for signs of formulas."""


@dataclass
class Entry:
    """Something that happens at an occasion; afterwards it is an event.

    Attributes
    ----------
    name : str
        Of the connection.
    kind : {"begin", "end", "impulse"}
    occasion : Occasion
    path : Path
        To the field that says it.
    passages : int
        How often its quantity has passed through its value.
    side : int
        Sign of the quantity less the value at the end of the last phase; 0 where that is not known.
    """

    name: str
    kind: Kind
    occasion: Occasion
    path: Path
    passages: int = 0
    side: int = 0


@dataclass
class Schedule:
    """What is still to happen, in the order of the description.

    Attributes
    ----------
    entries : list of Entry
    checked : bool
        Whether the quantities are known to be some of the scene.
    """

    entries: list[Entry] = field(default_factory=list)
    checked: bool = False

    @classmethod
    def of(cls, base: Described) -> Schedule:
        """Return that of a scene.

        Raises
        ------
        InvalidParameter
            For what is no occasion, and for a time at which something is to end before it begins, or as it does.
        """
        names, found, events = base.scene.names(), list[Entry](), _events_of(base)
        for name, (i, connection) in zip(names, base.scene.numbered(), strict=True):
            times = dict[str, Ball]()
            for field_, written in connection.occasions().items():
                path = ("connections", i, field_)
                when = occasion(written, base.measures.numerals, _before(events, name, KINDS[field_]), path)
                if field_ != "at" and when.time is not None and not when.time > 0:
                    rule, remedy = "be later than the start", "leave it out: a connection acts from the start by itself"
                    if field_ == "until":
                        remedy = "leave out the connection, which would never act"
                    raise InvalidParameter(path, rule, remedy=remedy)
                found.append(Entry(name, KINDS[field_], when, path))
                if when.time is not None:
                    times[field_] = when.time
            if len(times) == 2 and not times["until"] > times["from"]:
                rule = "be later than the time at which the connection begins, its `from`"
                remedy = "exchange the two times, or leave out the connection, which would never act"
                raise InvalidParameter(("connections", i, "until"), rule, remedy=remedy)
        return cls(found)

    def pending(self) -> list[Entry]:
        """Return what may happen next: what has not begun does not end."""
        waiting = {entry.name for entry in self.entries if entry.kind == "begin"}
        return [entry for entry in self.entries if not (entry.kind == "end" and entry.name in waiting)]

    def due(self, now: Ball, events: Sequence[Event]) -> list[Entry]:
        """Return what happens now, and take it off the list: also what ends with something that ends now."""
        pending, found, happened = self.pending(), list[Entry](), list(events)
        while due := [one for one in pending if one.occasion.has_come(now, happened, one.passages)]:
            pending = [entry for entry in pending if entry not in due]
            found.extend(due)
            happened.extend(one for one in due if one.kind == "end")
        self.entries = [entry for entry in self.entries if entry not in found]
        return found

    def until(self, end: Ball) -> Ball:
        """Return the first time at which something is to happen, or an end before that."""
        times = [time for entry in self.pending() if (time := entry.occasion.time) is not None]
        return min([time for time in times if time < end], key=lambda time: time.mid(), default=end)

    def forbids(self, names: Sequence[str]) -> bool:
        """Return whether bounces of some measures may not be passed over: something may happen in the midst of them."""
        return any(
            entry.occasion.passed is not None
            or (isinstance(entry.occasion, AtEvent) and any(entry.occasion.counts("touch", name) for name in names))
            for entry in self.entries
        )

    def passages(self, phase: Phase) -> Iterator[tuple[Entry, Watch]]:
        """Yield what is watched in a phase: quantities that have not passed through their values often enough.

        A value that has been jumped over at the start of the phase is counted, and one that is passed just there, at
        the instant of what has ended the last phase.

        Raises
        ------
        InvalidParameter
            For a quantity that the scene has not, or whose passing through a value is not told by its sign.
        """
        waiting = [entry for entry in self.entries if entry.occasion.passed is not None]
        if not waiting:
            return
        whole = phase.models[0].whole
        named, expansions = sought_in(whole, phase.determined), expansions_of(phase)
        for entry in waiting:
            passed = entry.occasion.passed
            assert passed is not None
            one = named(passed.quantity)
            if not self.checked:
                _check_quantity(passed, one, phase)
            if one is None:
                # A force that is not determined in a phase is not watched in it.
                continue
            side, power = _side(one, passed, expansions)
            if entry.side and side and side != entry.side:
                entry.passages += 1
            entry.side = side or entry.side
            watch = Watch(
                -1,
                "value",
                Unilateral(entry.name, {}),
                entry.side,
                power=power,
                passage=Passage(one.less(passed.value), one.of_forces),
            )
            yield entry, watch
        self.checked = True


def _events_of(base: Described) -> dict[str, set[str]]:
    """Return what may happen to connections and their parts, by names of these."""
    found: dict[str, set[str]] = {}
    for name, (_, connection) in zip(base.scene.names(), base.scene.numbered(), strict=True):
        found[name] = {KINDS[field_] for field_ in connection.occasions()}
        if base.scene.switches_in(connection):
            found[name].add("switch")
    for law in base.measures.table.laws:
        if switching([law]):
            found.setdefault(law.name, set()).add("switch")
    for one in base.measures.unilateral:
        kinds = found.setdefault(one.name, set())
        kinds |= {one.closes, one.opens}
        if one.slips:
            kinds |= {"slip", "roll" if one.rolls else "stick"}
        if one.restitution > 0:
            kinds.add("settle")
    return found


def _before(events: Mapping[str, set[str]], name: str, kind: Kind) -> Mapping[str, set[str]]:
    """Return what may happen before something happens to a connection."""
    # Nothing happens to what has not begun.
    return {**events, name: events[name] - {kind} if kind == "end" else set()}


def _check_quantity(passed: PassedValue, one: Sought | None, phase: Phase) -> None:
    """Raise `InvalidParameter` for what is no quantity of the scene, or has no sign, and for a unit of another."""
    if one is not None and one.ambiguous:
        rule = "be no length and no component of an attitude, of which no sign says that they pass through a value"
        raise InvalidParameter((*passed.path, "quantity"), rule)
    if one is not None and is_plain(passed.written):
        return
    whole, times = phase.models[0].whole, np.zeros(1)
    columns = Columns(whole, times, whole.states(times), "closed form").chosen(COLUMNS_OF_STATES, phase.determined)
    column = component(columns, passed.quantity)
    if one is None or column is None:
        raise unknown_quantity(passed.quantity, (*passed.path, "quantity"), columns)
    Measured(column.unit).check(passed.written, (*passed.path, "equals"), None)


def _side(one: Sought, passed: PassedValue, expansions: Expansions) -> tuple[int, int]:
    """Return the sign of a quantity less its value just after the start of a phase, and the power that tells it."""
    motions = expansions.forces if one.of_forces else expansions.places
    pieces = motions[0](np.zeros(1), np.ones(1))
    curve = one.less(passed.value)(pieces)
    for k in range(MOST_POWERS):
        value, size = float(curve.values[0, k, 0]), float(curve.sizes[0, k])
        if abs(value) > CLEAR * size:
            return (1 if value > 0.0 else -1), k
    return 0, 0
