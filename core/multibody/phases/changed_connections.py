"""Where connections begin and end, and blows fall: the table and the state that follow.

Places stay. Rates change by what begins to hold, and by blows, as `core.multibody.contacts.impulsive_rates` says;
contacts that touch take no part in that, and those that approach afterwards collide.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

from core.balls import distance_bound
from core.errors import InvalidParameter, Path
from core.multibody.algebra.polynomials import ZERO, Ball, evaluated, is_zero
from core.multibody.contacts.contact_responses import rate_along
from core.multibody.contacts.impulsive_rates import Struck, struck
from core.multibody.equations.assembly import CLOSE_RATE, assemble_places
from core.multibody.equations.dynamics import kinetic
from core.multibody.equations.packed import nearest
from core.multibody.phases.schedule import Entry
from core.multibody.phases.tracks import Track, Tracks, late
from core.multibody.table.connection_effects import Push
from core.multibody.table.description import Acting, Described, described
from core.multibody.table.table import Table
from core.systems.trajectory import ImpactErrors, MotionEvent


@dataclass(frozen=True)
class Change:
    """What follows where connections begin and end.

    Attributes
    ----------
    base : Described
    acting : mapping
        See `core.multibody.table.description.Acting`.
    each : list of Track
        The state on every track.
    events : list of MotionEvent
    works : mapping of str to ball
        Energy that each gives to the motion (J).
    names : frozenset of str
        The connections that begin or end.
    """

    base: Described
    acting: Acting
    each: list[Track]
    events: list[MotionEvent]
    works: Mapping[str, Ball]
    names: frozenset[str]


def changed(base: Described, acting: Acting, due: Sequence[Entry], tracks: Tracks) -> Change:
    """Return what follows a state in which some things begin, end, or strike.

    Raises
    ------
    InvalidParameter
        For a connection that cannot begin there.
    """
    begin, end, blows = (
        frozenset(entry.name for entry in due if entry.kind == kind) for kind in ("begin", "end", "impulse")
    )
    before = [_placed(base, track) for track in tracks.each]
    fresh = [_acting(acting, begin, end, track) for track in before]
    bases = [
        described(base.scene, base.measures.numerals, one_sided=True, acting=one) if begin or end else base
        for one in fresh
    ]
    tables = [_begun(own, track, begin, base.paths) for own, track in zip(bases, before, strict=True)]
    if not tracks.exact:
        # What is held from here on is taken from the first track, and not known better than that.
        q, v = tracks.wide()
        if begin:
            tracks.lose([float(x.rad()) for x in q], [float(x.rad()) for x in v])
    pushes = {name: bases[0].measures.blows[name] for name in sorted(blows)}
    each = [
        replace(track, q=table.q, v=struck(table, pushes.values()).v)
        for track, table in zip(tracks.each, tables, strict=True)
    ]
    # What is at rest is so as far as its rates are known.
    unsure = [float(x.rad()) for x in tracks.wide()[1]]
    for track, table in zip(each, tables, strict=True):
        _require_kept(table, track.v, unsure, base.paths)
    wide = tables[0] if tracks.exact else _widened(tables[0], tracks)
    events, works = _recorded(bases[0], wide, due, pushes, tracks)
    return Change(bases[0], fresh[0], each, events, works, begin | end)


def _acting(acting: Acting, begin: frozenset[str], end: frozenset[str], track: Track) -> Acting:
    """Return what acts from now on, with the coordinates at which it begins."""
    found = {name: state for name, state in acting.items() if name not in end}
    return found | {name: list(track.q) for name in begin}


def _placed(base: Described, track: Track) -> Track:
    """Return a track with places that meet what has held until now.

    What begins takes its directions from these: axes of a body that are at right angles but for the rounding of a
    motion would be held at an angle that the body does not allow. Redundant connections, which are redundant on these
    places alone, would share out an impulse by that rounding.
    """
    table = replace(base.measures.table, q=list(track.q))
    table.follow_time()
    assemble_places(table, base.paths)
    return replace(track, q=table.q)


def _begun(base: Described, track: Track, begin: frozenset[str], paths: Mapping[str, object]) -> Table:
    """Return the table with the state of a track, put onto what begins to hold."""
    measures = base.measures
    table = replace(measures.table, rows=list(measures.table.rows), q=list(track.q), v=list(track.v))
    for name, one in measures.timed.items():
        for i in one.coordinates:
            if name in begin:
                table.q[i] = measures.table.q[i]
            if not one.acts and i not in table.timed:
                table.v[i] = ZERO
    if begin:
        assemble_places(table, base.paths)
    return table


def _require_kept(table: Table, v: Sequence[Ball], unsure: Sequence[float], paths: Mapping[str, Path]) -> None:
    """Raise `InvalidParameter` where rates keep some rows and not what others hold beside these."""
    # What has been stopped is at rest as far as it is known beside its rates before.
    fastest = max((abs(float(x.mid())) for x in (*table.v, *v)), default=0.0)
    for row in table.rows:
        line = row.line(table.q)
        left = row.rate - rate_along(line, v)
        allowed = sum(abs(float(x.mid())) * (CLOSE_RATE * fastest + unsure[j]) for j, x in line.items())
        if not abs(float(left.mid())) <= allowed:
            rule = "agree with the rates that other connections hold"
            raise InvalidParameter(paths.get(row.name, ()), rule, remedy="end what holds another rate before")


def _widened(table: Table, tracks: Tracks) -> Table:
    """Return a table with the state as wide as it is not known."""
    q, v = tracks.wide()
    return replace(
        table,
        q=[x if is_zero(y - x) else y for x, y in zip(table.q, q, strict=True)],
        v=list(v),
    )


def _recorded(
    base: Described, table: Table, due: Sequence[Entry], pushes: Mapping[str, Push], tracks: Tracks
) -> tuple[list[MotionEvent], dict[str, Ball]]:
    """Return the events, with impulses and energies: of what begins first, then of blows one after another."""
    time, error = nearest(tracks.time), late(tracks.each)
    events, works = [], dict[str, Ball]()
    done, rates = struck(table, ()), list(table.v)
    for entry in due:
        if entry.kind == "end":
            events.append(MotionEvent("end", entry.name, time, error))
    for entry in due:
        if entry.kind == "end":
            continue
        blow = [pushes[entry.name]] if entry.kind == "impulse" else []
        done = struck(replace(table, v=rates), blow)
        work = kinetic(replace(table, v=done.v)) - kinetic(replace(table, v=rates))
        own = {part: evaluated(poly, table.q) for part, poly in blow[0].components.items()} if blow else {}
        events.append(_event(entry, base, done, own, work, (time, error)))
        works[entry.name] = work
        rates = done.v
    return events, works


def _event(
    entry: Entry, base: Described, done: Struck, own: Mapping[str, Ball], work: Ball, when: tuple[float, float]
) -> MotionEvent:
    found = dict(own)
    for force in base.measures.forces:
        value = done.impulse(force) if force.terms else None
        if value is not None and not is_zero(value):
            name, _, part = force.name.rpartition(".")
            found[part if name == entry.name else force.name] = value
    impulses = {name: nearest(x) for name, x in found.items()}
    loss = 0.0 if is_zero(work) else -nearest(work)
    errors = ImpactErrors(
        {name: distance_bound(x, impulses[name]) for name, x in found.items()}, distance_bound(-work, loss)
    )
    return MotionEvent(entry.kind, entry.name, *when, impulses, loss, errors)
