"""Which places of a table can be: those with bodies that are not mirrored, positive lengths and taut strings."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from flint import arb

from core.arrays import Floats
from core.multibody.algebra.polynomials import Poly, evaluated
from core.multibody.contacts.certificates import certificates
from core.multibody.reduction.reduction import Reduced
from core.multibody.statics.exact_places import ExactPlace
from core.multibody.table.description import Described
from core.multibody.table.table import Table

Terms = list[tuple[float, tuple[int, ...]]]


_DEPENDENT = 1e-9
"""Share of the largest below which doubles take singular values, and what shares do to tensions, for zero: far
above what rounding leaves of zero, about 1e-15, and far below what rows have that do not depend on one another."""

_LOOSE = 1e-9
"""Share of the largest load down to which a negative tension is taken for zero: a string may be straight and bear
nothing."""


@dataclass(frozen=True)
class Holds:
    """What bounds the places of a scene, with coefficients as doubles.

    Attributes
    ----------
    lines : list of (row, column, terms)
        Entries of W.
    forces : list of (list of (row, terms), terms)
        Of every string and chain: what makes up its tension, by multipliers and by the place alone.
    lengths : list of terms
        Those that are positive.
    """

    table: Table
    lines: list[tuple[int, int, Terms]]
    forces: list[tuple[list[tuple[int, Terms]], Terms]]
    lengths: list[Terms]


class RestingPlaces:
    """The whole scene at places of its reduced table.

    Parameters
    ----------
    found : Described
    entered : Table
        Its table with formulas as entries.
    small : Reduced
    """

    def __init__(self, found: Described, entered: Table, small: Reduced) -> None:
        self.expressions, measures = small.expressions, found.measures
        self._axes = [frame.axes for frame in measures.coordinates.frames.values() if frame.axes is not None]
        self._holds = Holds(
            entered,
            [(r, j, _terms(p)) for r, row in enumerate(entered.rows) for j, p in row.rates.items()],
            [
                (
                    [(row, _terms(p)) for row, p in measures.forces[limit.force].terms],
                    _terms(measures.forces[limit.force].of_state),
                )
                for limit in measures.limits
                if limit.force is not None
            ],
            [_terms(limit.length) for limit in measures.limits if limit.length is not None],
        )

    def possible(self, found: ExactPlace) -> bool:
        """Return whether lengths are positive there, strings taut, and the axes of bodies right-handed.

        What holds three axes at right angles holds those of the mirror image as well.
        """
        place, holds = [float(evaluated(expression, found.q)) for expression in self.expressions], self._holds
        if not all(np.linalg.det([[place[i] for i in axis] for axis in axes]) > 0.0 for axes in self._axes):
            return False
        if not all(_value(length, place) > 0.0 for length in holds.lengths):
            return False
        if not holds.forces:
            return True
        table = holds.table
        lines = np.zeros((len(table.rows), len(table.names)))
        for r, j, terms in holds.lines:
            lines[r, j] = _value(terms, place)
        load = np.zeros(len(table.names))
        for i, value in table.load.items():
            load[i] += float(value)
        for (i, j), value in table.stiffness.items():
            load[i] -= float(value) * place[j]
        scale = np.abs(lines).max(axis=1)
        multipliers = np.linalg.lstsq((lines / scale[:, None]).T, -load, rcond=_DEPENDENT)[0] / scale
        edge = -_LOOSE * float(np.max(np.abs(load), initial=0.0))

        def along(values: Floats) -> Floats:
            return np.array(
                [sum(_value(terms, place) * values[row] for row, terms in parts) for parts, _ in holds.forces]
            )

        tensions = along(multipliers) + [_value(own, place) for _, own in holds.forces]
        if not (tensions < edge).any():
            return True
        # What follows from others may share their load otherwise.
        _, sizes, every = np.linalg.svd((lines / scale[:, None]).T)
        rank = int(np.sum(sizes > _DEPENDENT * sizes.max(initial=0.0)))
        shares = np.array([along(one / scale) for one in every[rank:]]).reshape(-1, len(tensions))
        slopes = [{f: arb(float(x), _DEPENDENT) for f, x in enumerate(column)} for column in shares.T]
        return all(sum(float(y) * tensions[k] for k, y in weights.items()) >= edge for weights in certificates(slopes))


def _terms(poly: Poly) -> Terms:
    return [(float(value), key) for key, value in poly.items()]


def _value(terms: Terms, place: list[float]) -> float:
    total = 0.0
    for value, key in terms:
        for i in key:
            value *= place[i]
        total += value
    return total
