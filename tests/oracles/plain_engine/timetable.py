"""What begins, ends and strikes in a scene, and when, as docs/describing-scenes.md says it."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import Any, Protocol

import numpy as np

from core.multibody.audit.bodies import Reader
from core.multibody.language.scene import Scene
from tests.oracles.plain_engine.coordinates import State
from tests.oracles.plain_engine.mechanism import NotSupported
from tests.oracles.plain_engine.phase import Phase
from tests.oracles.plain_engine.readouts import forces_of, quantities_of

HAPPENS = {"from": "begin", "until": "end", "at": "impulse"}
"""What happens at the occasion of each field."""
AT_VALUE = 1e-9
"""Share of a value, or of one unit, within which a quantity has it."""


class Happened(Protocol):
    """Something that has happened to a connection."""

    @property
    def kind(self) -> str:
        """What."""

    @property
    def name(self) -> str:
        """To which connection, or to which part of one."""


@dataclass
class Entry:
    """Something that is to happen to a connection.

    Attributes
    ----------
    what : str
        "begin", "end" or "impulse".
    time : float
        Of an occasion that is a time (s), infinite of others.
    event : mapping
        Of an occasion that is one: its ``name``, and ``kind`` and ``nth`` where they are given.
    quantity : str
        The one that passes through a value; "" of other occasions.
    left : int
        How often it still has to pass through it.
    side : float
        On which it is: 1 above, -1 below, 0 where that is not known.
    """

    name: str
    what: str
    time: float = np.inf
    event: Mapping[str, Any] | None = None
    quantity: str = ""
    value: float = 0.0
    left: int = 1
    side: float = 0.0

    def has_come(self, now: float, events: Iterable[Happened]) -> bool:
        """Return whether it is to happen now, after some events."""
        if self.event is not None:
            kind, name = self.event.get("kind"), self.event["name"]
            counted = [
                x for x in events if kind in (None, x.kind) and (x.name == name or x.name.startswith(f"{name}."))
            ]
            return len(counted) >= self.event.get("nth", 1)
        return self.left <= 0 if self.quantity else self.time <= now

    def above(self, phase: Phase, state: State) -> float:
        """Return by how much its quantity is beyond its value, on the side on which it is."""
        return self.side * self._beyond(phase, state)

    def begin(self, phase: Phase, state: State, after: State) -> None:
        """Count a value that was jumped over before a phase, and find the side on which the quantity is in it."""
        beyond = self._beyond(phase, state)
        if abs(beyond) > AT_VALUE * max(1.0, abs(self.value)):
            side = float(np.sign(beyond))
            self.left -= self.side == -side
            self.side = side
        elif not self.side:
            self.side = float(np.sign(self._beyond(phase, after)))

    def pass_through(self) -> None:
        """Count that the quantity has passed through its value."""
        self.left, self.side = self.left - 1, -self.side

    def _beyond(self, phase: Phase, state: State) -> float:
        found = quantities_of(phase.mechanism, state)
        if self.quantity not in found:
            found = forces_of(phase, state)
        if self.quantity not in found:
            raise NotSupported("a quantity that is no component of a motion and no force")
        return found[self.quantity] - self.value


class Timetable:
    """What is still to happen in a scene.

    Attributes
    ----------
    acting : set of str
        The connections that act at the start.
    """

    def __init__(self, scene: Scene) -> None:
        reader = Reader(scene)
        self.acting = {name for name, one in zip(scene.names(), scene.connections, strict=True) if one.starts}
        self.entries = list(_entries(scene, reader))

    def next_time(self) -> float:
        """Return the first time that is an occasion (s)."""
        return min((entry.time for entry in self._possible()), default=np.inf)

    def values(self) -> list[Entry]:
        """Return what waits for a quantity to pass through a value."""
        return [entry for entry in self.entries if entry.quantity and entry.left > 0]

    def due(self, now: float, events: Sequence[Happened]) -> list[Entry]:
        """Return what happens now, what ends first, and take it off the list."""
        found = [entry for entry in self._possible() if entry.has_come(now, events)]
        self.entries = [entry for entry in self.entries if entry not in found]
        return sorted(found, key=lambda entry: entry.what != "end")

    def _possible(self) -> list[Entry]:
        """Return what may happen: what has not begun does not end."""
        waiting = {entry.name for entry in self.entries if entry.what == "begin"}
        return [entry for entry in self.entries if entry.what != "end" or entry.name not in waiting]


def _entries(scene: Scene, reader: Reader) -> Iterator[Entry]:
    for name, (i, connection) in zip(scene.names(), scene.numbered(), strict=True):
        for field, written in connection.occasions().items():
            path = ("connections", i, field)
            if not isinstance(written, Mapping) or "value" in written:
                yield Entry(name, HAPPENS[field], time=reader.number(written, path))
            elif "event" in written:
                yield Entry(name, HAPPENS[field], event=written["event"])
            else:
                when = written["when"]
                value = reader.number(when["equals"], (*path, "when", "equals"))
                yield Entry(name, HAPPENS[field], quantity=when["quantity"], value=value, left=when.get("nth", 1))
