"""How large the coordinates of a scene are as parts of it, beside which places are meant as they are rounded."""

from __future__ import annotations

from collections.abc import Sequence

from core.multibody.algebra.polynomials import ZERO, Ball, larger, smaller
from core.multibody.table.table import Table

FAR = 2.0**-20
"""Share of a coordinate that counts as its size however far the scene is from the origin: of that, a relative rounding
of 1e-9 is four units in the last place of a double, and places that were computed in doubles are known no better."""


def sizes(table: Table, of: Sequence[Ball]) -> list[Ball]:
    """Return the magnitudes of coordinates; those of lengths are at most how far apart the places of the scene are.

    Where the origin is does not matter then to what is taken as meant, but for what doubles round.

    Parameters
    ----------
    table : Table
        With the places that are read so far (m).
    of : sequence of ball
        The coordinates, or numbers with their units.
    """
    extents = [_extent(axis) for axis in zip(*table.places, strict=True)]
    if not extents:
        return [abs(x) for x in of]
    span = max(extents, key=lambda x: float(x.mid()))
    return [
        smaller(abs(x), span + FAR * abs(x)) if unit == "m" else abs(x) for x, unit in zip(of, table.units, strict=True)
    ]


def _extent(values: Sequence[Ball]) -> Ball:
    least, largest = values[0], values[0]
    for value in values[1:]:
        least, largest = smaller(least, value), larger(largest, value)
    found: Ball = largest - least
    return found if found > 0 else ZERO
