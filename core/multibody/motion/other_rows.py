"""Another choice of independent rows, for a motion along which those of the start come to depend on one another.

Of rows that hold a mechanism redundantly as many as are independent at the start say the rest. Elsewhere it may be
others: in Bricard's linkage some of those chosen lose their rank in a place where all together keep theirs.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from core.arrays import Floats
from core.multibody.table.table import Table

_KEPT = 1e-4
"""Share of the largest singular value of unit lines, at several places, above which the smallest is no rounding: places
are known to 1e-12 and better, and where the rank is lost itself the smallest of all lines is as small as the change of
the place to where that shows, a millionth of a step."""


def rows_for(table: Table, count: int, places: Sequence[Floats]) -> list[int] | None:
    """Return rows that are independent at all of some places, None where those of a place are not so many.

    Parameters
    ----------
    table : Table
    count : int
        Of independent rows.
    places : sequence of ndarray, shape (n,)
        Coordinates.
    """
    lines = [_unit_lines(table, q) for q in places]
    ties = []
    for line in lines:
        u, values, _ = np.linalg.svd(line)
        if len(values) < count or values[count - 1] <= _KEPT * values[0]:
            return None
        ties.append(u[:, count:])
    # Left out is what the others say: rows with large shares in what ties them together at every place.
    shares, chosen = np.concatenate(ties, axis=1), list(range(len(table.rows)))
    while len(chosen) > count:
        left_out = int(np.argmax(np.linalg.norm(shares, axis=1)))
        chosen.remove(left_out)
        way = shares[left_out] / np.linalg.norm(shares[left_out])
        shares = shares - np.outer(shares @ way, way)
        shares[left_out] = 0.0
    smallest = [np.linalg.svd(line[chosen], compute_uv=False) for line in lines]
    return chosen if all(values[-1] > _KEPT * values[0] for values in smallest) else None


def _unit_lines(table: Table, q: Floats) -> Floats:
    found = np.zeros((len(table.rows), len(q)))
    for k, row in enumerate(table.rows):
        for j, poly in row.rates.items():
            found[k, j] = sum(float(x) * float(np.prod(q[list(key)])) for key, x in poly.items())
    size = np.linalg.norm(found, axis=1, keepdims=True)
    return found / np.where(size > 0.0, size, 1.0)
