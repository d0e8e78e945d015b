"""Occasions: the times, events and values at which connections begin and end, and blows fall."""

from __future__ import annotations

from collections.abc import Collection, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Any, Protocol

from core.errors import InvalidParameter, Path
from core.multibody.algebra.polynomials import Ball
from core.multibody.language.numerals import Numerals
from core.multibody.language.written import Number
from core.near_names import did_you_mean, near_and_all

EVENTS = (
    "touch",
    "lift-off",
    "slip",
    "stick",
    "roll",
    "settle",
    "taut",
    "slack",
    "stop",
    "release",
    "switch",
    "begin",
    "end",
    "impulse",
)
"""Kinds of events that may be occasions: those after which a motion goes on."""

ONCE = ("begin", "end", "impulse")
"""Kinds of events that happen once to a connection."""

MOST_COUNTED = 1000
"""Largest `nth` of an occasion."""


class Event(Protocol):
    """Something that has happened in a motion."""

    @property
    def kind(self) -> str:
        """What has happened."""

    @property
    def name(self) -> str:
        """To which connection."""


class Occasion(Protocol):
    """When something begins or ends."""

    @property
    def time(self) -> Ball | None:
        """The time (s), where it is known beforehand."""

    @property
    def passed(self) -> PassedValue | None:
        """The quantity whose passing through a value is the occasion; None of others."""

    def has_come(self, now: Ball, events: Sequence[Event], passages: int) -> bool:
        """Return whether it has come.

        Parameters
        ----------
        now : ball
            The present time (s).
        events : sequence of Event
            All so far.
        passages : int
            How often the quantity has passed through the value.
        """


@dataclass(frozen=True)
class AtTime:
    """A time from the start (s)."""

    time: Ball
    passed = None

    def has_come(self, now: Ball, events: Sequence[Event], passages: int) -> bool:
        """See `Occasion.has_come`."""
        return not self.time > now


@dataclass(frozen=True)
class AtEvent:
    """The n-th event of a kind, or of any, that happens to a connection or to a part of it."""

    kind: str | None
    name: str
    nth: int
    time = None
    passed = None

    def counts(self, kind: str, name: str) -> bool:
        """Return whether an event is one of those that are counted."""
        return self.kind in (None, kind) and (name == self.name or name.startswith(f"{self.name}."))

    def has_come(self, now: Ball, events: Sequence[Event], passages: int) -> bool:
        """See `Occasion.has_come`."""
        return sum(self.counts(event.kind, event.name) for event in events) >= self.nth


@dataclass(frozen=True)
class PassedValue:
    """The n-th time that a quantity passes through a value, which is `written` in a unit of its own or that of it."""

    quantity: str
    value: Ball
    nth: int
    written: Number
    path: Path
    time = None

    @property
    def passed(self) -> PassedValue:
        """Itself."""
        return self

    def has_come(self, now: Ball, events: Sequence[Event], passages: int) -> bool:
        """See `Occasion.has_come`."""
        return passages >= self.nth


def occasion(written: object, numerals: Numerals, events: Mapping[str, Collection[str]], path: Path) -> Occasion:
    """Return an occasion as it was written: a number, ``{"event": {...}}`` or ``{"when": {...}}``.

    Parameters
    ----------
    events : mapping of str to collection of str
        The kinds of events that may happen to connections and their parts, by names of these.

    Raises
    ------
    InvalidParameter
        For a time before the start, and for what is no occasion.
    """
    if isinstance(written, Mapping) and set(written) == {"event"}:
        return _event(_members(written["event"], ("name",), ("kind", "nth"), (*path, "event")), events, path)
    if isinstance(written, Mapping) and set(written) == {"when"}:
        where = (*path, "when")
        given = _members(written["when"], ("quantity", "equals"), ("nth",), where)
        if not isinstance(given["quantity"], str):
            raise InvalidParameter((*where, "quantity"), "be the name of a quantity, such as bob.position.x")
        value = numerals.number(given["equals"], (*where, "equals"))
        return PassedValue(given["quantity"], value, _count(given, where), given["equals"], where)
    if isinstance(written, Mapping) and not {"value", "degrees"} & set(written):
        rule = 'be a time, {"event": {"kind", "name", "nth"}} or {"when": {"quantity", "equals", "nth"}}'
        raise InvalidParameter(path, rule)
    time = numerals.number(written, path)
    if time < 0:
        raise InvalidParameter(path, "be at least 0 s, the time of the start")
    return AtTime(time)


def _event(given: Mapping[str, Any], events: Mapping[str, Collection[str]], path: Path) -> AtEvent:
    where, kind, name = (*path, "event"), given.get("kind"), given["name"]
    if kind is not None and kind not in EVENTS:
        raise InvalidParameter(
            (*where, "kind"), f"be one of {', '.join(EVENTS)}", remedy=did_you_mean(str(kind), EVENTS)
        )
    found = AtEvent(kind, str(name), _count(given, where))
    counted = [one for part, kinds in events.items() for one in kinds if replace(found, kind=None).counts(one, part)]
    if not counted:
        names = [part for part, kinds in events.items() if kinds]
        rule, remedy = "name a connection to which something may happen, or a part", "give a time, or a value"
        if names:
            remedy = near_and_all(name, names, "connections with events")
        raise InvalidParameter((*where, "name"), rule, remedy=remedy)
    if kind is not None and kind not in counted:
        rule = (
            f'be one of {", ".join(one for one in EVENTS if one in counted)}, as no other may happen to "{found.name}"'
        )
        raise InvalidParameter((*where, "kind"), rule, remedy=did_you_mean(kind, counted))
    often = [one for one in counted if kind in (None, one)]
    if set(often) <= {*ONCE} and found.nth > len(often):
        rule = f'be at most {len(often)}, as nothing more of that may happen to "{found.name}"'
        raise InvalidParameter((*where, "nth"), rule)
    return found


def _members(given: object, needed: Sequence[str], others: Sequence[str], path: Path) -> Mapping[str, Any]:
    if not isinstance(given, Mapping):
        raise InvalidParameter(path, "be an object")
    for name in needed:
        if name not in given:
            raise InvalidParameter((*path, name), "be given")
    for name in given:
        if name not in (*needed, *others):
            known = (*needed, *others)
            rule = f"be left out; the fields here are {', '.join(known)}"
            raise InvalidParameter((*path, str(name)[:64]), rule, remedy=did_you_mean(str(name), known))
    return given


def _count(given: Mapping[str, Any], path: Path) -> int:
    nth = given.get("nth", 1)
    if isinstance(nth, bool) or not isinstance(nth, int) or not 1 <= nth <= MOST_COUNTED:
        raise InvalidParameter((*path, "nth"), f"be a whole number from 1 to {MOST_COUNTED}")
    return nth


def named_by(written: object) -> Iterator[str]:
    """Yield what an occasion names, as far as it can be read: a connection, or a quantity."""
    if isinstance(written, Mapping):
        for of, field in (("event", "name"), ("when", "quantity")):
            inner = written.get(of)
            if isinstance(inner, Mapping) and isinstance(inner.get(field), str):
                yield inner[field]
