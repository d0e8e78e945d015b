"""The start of a scene with unilateral measures: what touches is put in touch, what is left out rests or rolls."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

from core.balls import as_text
from core.errors import PlacesDisagree
from core.multibody.algebra.polynomials import ZERO, change_by, evaluated, is_zero
from core.multibody.contacts.contact_responses import rate_along
from core.multibody.contacts.projection import project
from core.multibody.equations.assembly import assemble_places, assemble_rates
from core.multibody.table.description import Described
from core.multibody.table.facing import facing
from core.multibody.table.scene_sizes import sizes
from core.multibody.table.table import Row

TOUCHING = 1e-9
"""Change of coordinates, as a share of their sizes in the scene, by which a gap may be closed of what touches at the
start; and rates, relative to their terms, below which it is at rest."""


@dataclass(frozen=True)
class ContactStart:
    """What is found about the start; the state itself is in the table.

    Attributes
    ----------
    touching : list of int
        Unilateral measures whose gap is zero.
    moved, fitted : list of str
        Connections for which positions, and velocities that were, taken as rounded.
    """

    touching: list[int]
    moved: list[str]
    fitted: list[str]


def assemble_contacts(base: Described) -> ContactStart:
    """Put the state of a table onto what holds and what touches.

    Raises
    ------
    InvalidParameter
        For things that overlap, and as `core.multibody.equations.assembly`.
    """
    table, paths, unilateral = base.measures.table, base.paths, base.measures.unilateral
    # What a guide without play holds is a condition of places and velocities, and nothing that these open or strike.
    guides = [Row.held(one.whole or one.name, one.gap) for one in unilateral if one.opposite is not None]
    table.rows.extend(guides)
    moved = list(dict.fromkeys([*base.measures.coordinates.rounded, *assemble_places(table, paths)]))
    rounding = [TOUCHING * x for x in sizes(table, table.q)]
    unilateral[:] = facing(unilateral, table.q, table.v, rounding)
    touching = []
    for i, one in enumerate(unilateral):
        gap = evaluated(one.gap, table.q)
        if one.facets and not one.region:
            # It is above an edge.
            continue
        if is_zero(gap) or bool(abs(gap) < change_by(one.gap, table.q, rounding)):
            touching.append(i)
            if not is_zero(gap):
                moved.append(one.name)
        elif gap < 0:
            raise PlacesDisagree(
                paths.get(one.name.split(".")[0], ()),
                f'start with what cannot overlap apart: "{one.name}" is missed by {as_text(-gap, 3)}',
                remedy="move the bodies apart",
            )
    rows = [Row.held(unilateral[i].name, unilateral[i].gap) for i in touching if unilateral[i].opposite is None]
    whole = replace(table, rows=[*table.rows, *rows])
    assemble_places(whole, paths)
    table.q = whole.q
    # Rates that are left out are such that what touches stays, if it can, and rolls or rests, if it can.
    fitted = assemble_rates(table, base.measures.coordinates.given, paths, rows)
    del table.rows[len(table.rows) - len(guides) :]
    _as_written(base, touching, fitted)
    # What rests has no rate, and not what rounding leaves of one.
    table.v = [ZERO if is_zero(x) else x for x in table.v]
    return ContactStart(touching, moved, fitted)


def _as_written(base: Described, touching: Sequence[int], fitted: list[str]) -> None:
    """Take gaps to be at rest, and contacts to roll, if that is what rounded velocities say."""
    table, rows = base.measures.table, []
    for i in touching:
        one = base.measures.unilateral[i]
        for row in (Row.held(one.name, one.gap), *(Row(one.name, None, slip) for slip in one.slips)):
            line = row.line(table.q)
            rate = rate_along(line, table.v)
            terms = sum((abs(x * table.v[j]) for j, x in line.items()), ZERO)
            if is_zero(rate) or bool(abs(rate) < TOUCHING * terms):
                rows.append(row)
                if not is_zero(rate) and one.name not in fitted:
                    fitted.append(one.name)
    if fitted:
        start = replace(table, rows=[*table.rows, *rows])
        project(start, table.q)
        table.q, table.v = start.q, start.v
