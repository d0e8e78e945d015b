"""Whether a gap turns back exactly at zero: that of a pendulum which comes by its lowest place, above a floor there.

Along a motion such a gap cannot be told from one that closes by less than is known. The connections tell: next to where
it turns back is a place at which it is least among all that they leave, and there it is zero or it is not.
"""

from __future__ import annotations

import math
import sys
from collections.abc import Sequence
from dataclasses import replace

import numpy as np
from flint import arb

from core.arrays import Floats
from core.multibody.algebra.polynomials import ZERO, Ball, Poly, evaluated, is_zero
from core.multibody.equations.packed import two_to
from core.multibody.reduction.degenerate_rows import is_least
from core.multibody.table.table import Row, Table

_STEPS = 60
"""Newton steps with one inverse in doubles, each of which leaves 1e-10 of the distance: thirty are enough for balls."""
_KNOWN = 2.0**-300
"""Share of its coordinates to which a place is found: differences of 1e-90 are nothing, as at the start of a scene."""
_INDEPENDENT = 1e-9
"""Singular values, as shares of the largest, that are zero: rows may follow from others."""


def turns_back_at_zero(table: Table, gap: Poly, near: Sequence[Ball]) -> bool:
    """Return whether a gap has a least value next to a place, among those that the measures allow, and it is zero.

    Parameters
    ----------
    near : sequence of ball
        Where it turns back, to the digits of doubles.
    """
    rows = [row for row in table.rows if row.measure is not None and not row.drag]
    q = [arb(x.mid()) for x in near]
    # In units in which coordinates and slopes are of the order of one.
    sizes: dict[str, float] = {}
    for unit, x in zip(table.units, q, strict=True):
        sizes[unit] = max(sizes.get(unit, 0.0), abs(float(x)))
    scale = np.array([two_to(math.frexp(sizes[unit] or 1.0)[1]) for unit in table.units])
    all_rows = [Row.held("", gap), *rows]
    slopes = np.array([_dense(row, q) for row in all_rows]) * scale
    weights = 1.0 / np.maximum(np.linalg.norm(slopes, axis=1), sys.float_info.min)
    slopes *= weights[:, None]
    shares = [1.0, *np.linalg.lstsq(slopes[1:].T, -slopes[0], rcond=_INDEPENDENT)[0]]
    bends = [_bend(row, len(q)) * weight for row, weight in zip(all_rows, weights, strict=True)]
    bend = sum(share * one for share, one in zip(shares, bends, strict=True)) * np.outer(scale, scale)
    none = np.zeros((len(rows), len(rows)))
    inverse = np.linalg.pinv(np.block([[bend, slopes[1:].T], [slopes[1:], none]]), rcond=_INDEPENDENT)
    factors = [arb(share) * float(weight) for share, weight in zip(shares, weights, strict=True)]
    for _ in range(_STEPS):
        left = _missed(all_rows, factors, q, scale, weights)
        size = max(float(abs(x)) for x in left)
        if size < _KNOWN:
            break
        # In doubles squares of what is left would underflow.
        change = inverse @ [float(x / size) for x in left]
        q = [arb((x - size * float(y)).mid()) for x, y in zip(q, change[: len(q)] * scale, strict=True)]
        pulls = change[len(q) :] * weights[1:]
        factors[1:] = [arb((x - size * float(y)).mid()) for x, y in zip(factors[1:], pulls, strict=True)]
    else:
        return False
    place = [arb(x, _KNOWN * max(float(unit), abs(float(x)))) for x, unit in zip(q, scale, strict=True)]
    return is_zero(evaluated(gap, place)) and is_least(replace(table, q=place), gap)


def _missed(
    rows: Sequence[Row], factors: Sequence[Ball], q: Sequence[Ball], scale: Floats, weights: Floats
) -> list[Ball]:
    """Return what is left of all slopes times their factors, that of a gap first, and the measures."""
    total = [ZERO] * len(q)
    for factor, row in zip(factors, rows, strict=True):
        for j, poly in row.rates.items():
            total[j] = total[j] + factor * evaluated(poly, q)
    missed = [float(weight) * evaluated(row.measure or {}, q) for weight, row in zip(weights, rows, strict=True)]
    return [x.mid() for x in [*(x * float(y) for x, y in zip(total, scale, strict=True)), *missed[1:]]]


def _dense(row: Row, q: Sequence[Ball]) -> Floats:
    found = np.zeros(len(q))
    for j, poly in row.rates.items():
        found[j] = float(evaluated(poly, q).mid())
    return found


def _bend(row: Row, count: int) -> Floats:
    """Return the second derivatives of a measure."""
    found = np.zeros((count, count))
    for j, poly in row.rates.items():
        for key, x in poly.items():
            if key:
                found[j, key[0]] = float(x.mid())
    return found
