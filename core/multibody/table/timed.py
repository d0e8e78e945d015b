"""Connections that begin and end: their coordinates are in the table all the time, and act while they do.

What such a connection takes from the start, as a rod its length, is that of the state at which it begins. While it
waits, or after its end, its own coordinates stay as they are, and nothing of it has an effect.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import replace
from typing import TypeVar

from core.errors import Path
from core.formulas import names_in
from core.multibody.algebra.polynomials import ONE, Ball, constant
from core.multibody.language.connection import Connection
from core.multibody.language.motion_formulas import TIME
from core.multibody.language.written import Number
from core.multibody.table.connection_effects import Force, Timed, WorkTerm
from core.multibody.table.measures import AT_BEGINNING, AT_START, Measures
from core.multibody.table.moving_places import driven_works
from core.multibody.table.rows import add_rows
from core.multibody.table.table import Row

Entry = TypeVar("Entry")

ENTRIES = ("mass", "load", "stiffness", "damping", "gyration")
"""What a table has by coordinates."""

OF_TABLE, OF_MEASURES = (
    ("names", "rows", "laws", "follows"),
    ("unilateral", "forces", "works", "limits", "kept", "level_rims"),
)
"""What connections add to the lists of a table and of its measures."""


def add_timed(
    connection: Connection, measures: Measures, name: str, path: Path, begun: Sequence[Ball] | None, *, acts: bool
) -> None:
    """Add a connection that begins or ends.

    Parameters
    ----------
    begun : sequence of ball, optional
        The coordinates of the table at its beginning; None of what acts from the start, or does not act.
    acts : bool
        Whether it acts at this time.
    """
    table = measures.table
    counts = _counts(measures)
    entries = {part: dict(getattr(table, part)) for part in ENTRIES}
    potential, fall, pressed = measures.potential, dict(measures.fall), measures.pressed_by
    lengths, inverses = measures.shared()
    before = list(table.q)
    if begun is not None:
        table.q[:] = begun[: len(before)]
        measures.moment = AT_BEGINNING
    measures.waiting = not acts
    try:
        add_rows(connection, measures, name, path)
    finally:
        measures.waiting, measures.moment = False, AT_START
        table.q[: len(before)] = before
        measures.restore_shared(lengths, inverses)
    measures.works.extend(list(driven_works(measures, name, counts["rows"])))
    measures.conservative = False
    now = _counts(measures)
    spans = {part: range(counts[part], now[part]) for part in counts}
    if not acts:
        for part, old in entries.items():
            setattr(table, part, old)
        measures.potential, measures.fall, measures.pressed_by = potential, fall, pressed
        _silence(measures, name, spans)
    measures.timed[name] = Timed(acts, spans["names"], spans["unilateral"], spans["forces"], spans["works"])


def needs_clock(connections: Iterable[Connection], let: Mapping[str, Number]) -> bool:
    """Return whether a formula of some connections may name the time: its coordinate is then none of their own."""
    names = {TIME, *(name for name, value in let.items() if isinstance(value, str))}
    return any(not names.isdisjoint(names_in(text)) for one in connections for text in _texts(vars(one).values()))


def _texts(values: Iterable[object]) -> Iterator[str]:
    for value in values:
        if isinstance(value, str):
            yield value
        elif isinstance(value, Mapping):
            yield from _texts(value.values())
        elif isinstance(value, Sequence):
            yield from _texts(value)


def _counts(measures: Measures) -> dict[str, int]:
    """Return how many there are of what connections add, by its name."""
    own = {part: len(getattr(measures, part)) for part in OF_MEASURES}
    return own | {part: len(getattr(measures.table, part)) for part in OF_TABLE}


def _silence(measures: Measures, name: str, spans: Mapping[str, range]) -> None:
    """Take back all effects of a connection but its coordinates, of which those of the time go on."""
    table = measures.table
    del table.laws[spans["laws"].start :]
    for part in ("limits", "kept", "level_rims"):
        del getattr(measures, part)[spans[part].start :]
    timed = {*table.timed, *table.clocks}
    table.rows[spans["rows"].start :] = [row for row in _own(table.rows, spans["rows"]) if row.coordinates() <= timed]
    table.rows.extend(Row(name, None, {i: constant(ONE)}) for i in spans["names"] if i not in timed)
    table.follows[spans["follows"].start :] = [
        one for one in _own(table.follows, spans["follows"]) if timed.issuperset(one.indices)
    ]
    for k in spans["forces"]:
        measures.forces[k] = Force(measures.forces[k].name, measures.forces[k].unit)
    for k in spans["works"]:
        measures.works[k] = WorkTerm(measures.works[k].name)
    for k in spans["unilateral"]:
        one = measures.unilateral[k]
        measures.unilateral[k] = replace(one, gap=constant(ONE), facets=(), region=(), opposite=None)


def _own(entries: list[Entry], span: range) -> list[Entry]:
    return entries[span.start : span.stop]
