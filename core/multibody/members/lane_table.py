"""Tables of eight members of one scene in lanes.

Members of one plan have the arrays of `equations.packed.Packed` in one form and differ in their numbers. All numbers of
a member are one row; eight of them, one a lane, are what the kernels compute with.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from core.arrays import Floats, Integers
from core.multibody.equations.packed import Packed


class LaneForm(NamedTuple):
    """What the tables of all members have in common.

    Attributes
    ----------
    n, m : int
        Coordinates and rows.
    mass, load, stiff, damp, gyre, lines, slopes, offset, rate, q, v : int
        Where these begin in the numbers of a member; behind each number is its tail.
    stiff_at, damp_at, lines_at, held, group, binds
        As in `Packed`.
    varying : ndarray of int, shape (p, 4)
        Of each slope: its entry of W, the place of this among the entries that vary, the coordinate, and whether a
        slope before it changes the same entry.
    products : ndarray of int, shape (p', 5)
        Kind, row on the right-hand side, places of both factors, and of the number by which the product is multiplied.
    """

    n: int
    m: int
    mass: int
    load: int
    stiff: int
    damp: int
    gyre: int
    lines: int
    slopes: int
    offset: int
    rate: int
    q: int
    v: int
    stiff_at: Integers
    damp_at: Integers
    lines_at: Integers
    held: Integers
    group: Integers
    binds: Integers
    varying: Integers
    products: Integers


OF_LINE, OF_RATE, OF_TURN = 0, 1, 2
"""Kinds of products: a multiplier with an entry of W, an entry of W with a rate, a coordinate with a rate."""


def form_of(table: Packed) -> LaneForm:
    """Return what the tables of members have in common with the table of one of them."""
    n, m = len(table.load), len(table.rate)
    begins = np.cumsum([0, *(part.size for part in _parts(table))])
    varying: list[tuple[int, int, int, int]] = []
    place: dict[int, int] = {}
    for e, i in table.slopes_at.tolist():
        before = e in place
        varying.append((e, place.setdefault(e, len(place)), i, int(before)))
    products = []
    for e, (r, j) in enumerate(table.lines_at.tolist()):
        if e in place:
            products.append((OF_LINE, j, r, place[e], 0))
            if table.binds[e] == 1:
                products.append((OF_RATE, n + r, place[e], j, 0))
    turns = enumerate(table.gyre_at.tolist())
    products += [(OF_TURN, i, j, k, int(begins[4]) + 2 * g) for g, (i, j, k) in turns]
    mass, load, stiff, damp, gyre, lines, slopes, offset, rate, q = begins.tolist()
    return LaneForm(
        n,
        m,
        mass,
        load,
        stiff,
        damp,
        gyre,
        lines,
        slopes,
        offset,
        rate,
        q,
        q + 2 * n,
        table.stiff_at,
        table.damp_at,
        table.lines_at,
        table.held,
        table.group,
        table.binds,
        np.array(varying, dtype=np.int64).reshape(-1, 4),
        np.array(products, dtype=np.int64).reshape(-1, 5),
    )


def _parts(table: Packed) -> tuple[Floats, ...]:
    return (
        table.mass,
        table.load,
        table.stiff,
        table.damp,
        table.gyre,
        table.lines,
        table.slopes,
        table.offset,
        table.rate,
    )


def numbers_of(table: Packed, q: Floats, v: Floats) -> Floats:
    """Return the numbers of a member, with its state at the start."""
    return np.concatenate([part.ravel() for part in (*_parts(table), q, v)])
