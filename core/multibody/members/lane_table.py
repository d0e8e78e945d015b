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
    mass, load, stiff, lines, slopes, offset, rate, q, v : int
        Where these begin in the numbers of a member; behind each number is its tail. The first number is one.
    stiff_at, lines_at, held, group
        As in `Packed`.
    varying : ndarray of int, shape (p, 4)
        Of each slope: its entry of W, the series of this, the coordinate, and whether a slope before it changes the
        same entry.
    products : ndarray of int, shape (p', 4)
        Row on the right-hand side, the series of both factors, and the place of the number by which the product is
        multiplied.
    series : int
        How many there are: those of coordinates, rates, multipliers, and entries of W that vary.
    """

    n: int
    m: int
    mass: int
    load: int
    stiff: int
    lines: int
    slopes: int
    offset: int
    rate: int
    q: int
    v: int
    stiff_at: Integers
    lines_at: Integers
    held: Integers
    group: Integers
    varying: Integers
    products: Integers
    series: int


def form_of(table: Packed) -> LaneForm:
    """Return what the tables of members, of which nothing is damped, have in common with the table of one of them."""
    n, m = len(table.load), len(table.rate)
    mass, load, stiff, gyre, lines, slopes, offset, rate, q = np.cumsum([part.size for part in _parts(table)]).tolist()
    varying: list[tuple[int, int, int, int]] = []
    place: dict[int, int] = {}
    for e, i in table.slopes_at.tolist():
        before = e in place
        varying.append((e, place.setdefault(e, 2 * n + m + len(place)), i, int(before)))
    products = []
    for e, (r, j) in enumerate(table.lines_at.tolist()):
        if e in place:
            products += [(j, 2 * n + r, place[e], 0), (n + r, place[e], n + j, 0)]
    products += [(i, j, n + k, gyre + 2 * g) for g, (i, j, k) in enumerate(table.gyre_at.tolist())]
    return LaneForm(
        n,
        m,
        mass,
        load,
        stiff,
        lines,
        slopes,
        offset,
        rate,
        q,
        q + 2 * n,
        table.stiff_at,
        table.lines_at,
        table.held,
        table.group,
        np.array(varying, dtype=np.int64).reshape(-1, 4),
        np.array(products, dtype=np.int64).reshape(-1, 4),
        2 * n + m + len(place),
    )


def _parts(table: Packed) -> tuple[Floats, ...]:
    one = np.array([1.0, 0.0])
    return (
        one,
        table.mass,
        table.load,
        table.stiff,
        table.gyre,
        table.lines,
        table.slopes,
        table.offset,
        table.rate,
    )


def numbers_of(table: Packed, q: Floats, v: Floats) -> Floats:
    """Return the numbers of a member, with its state at the start."""
    return np.concatenate([part.ravel() for part in (*_parts(table), q, v)])
