"""The equation of a table at a state, and its derivatives there by accelerations, rates and places: the kernels.

With the unknowns x = (q'', lambda) the equation is

    M q'' - (W + X)^T lambda = F(q, q'),    W q'' + W' q' = 0.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from core.arrays import Floats
from core.compiled import kernel
from core.double_double import dd_add, dd_mul
from core.multibody.algebra.pair_arrays import gathered, settled
from core.multibody.equations.packed import Packed
from core.multibody.equations.saddle import Saddle, inverted, saddle_space
from core.multibody.laws.kernel import PackedLaws, values_of_laws
from core.multibody.motion.series_pairs import entries_of_lines_pairs

NUDGE = 2.0**-40
"""By how much inputs of formulas are changed for their derivatives, in the units of a table: forces are in pairs, so
that what is lost by rounding is less than what is left out."""


class Linearised(NamedTuple):
    """Derivatives of the equation by x, by rates and by places; the last two have no columns for multipliers.

    Attributes
    ----------
    mass : (n + m, n + m)
    damping, stiffness : (n + m, n)
    """

    mass: Floats
    damping: Floats
    stiffness: Floats


@kernel()
def linearised_space(table: Packed) -> Linearised:
    """Return space for the derivatives."""
    n, m = table.load.shape[0], table.rate.shape[0]
    return Linearised(np.zeros((n + m, n + m)), np.zeros((n + m, n)), np.zeros((n + m, n)))


@kernel()
def forces_of_laws(laws: PackedLaws, path: Floats, values: Floats, force: Floats) -> None:
    """Fill in what formulas push, shape (n, 2), at a state; `path` of shape (2, 2 n) has places and then rates."""
    force[:] = 0.0
    values_of_laws(laws, path, force.shape[0], 0, 1.0, values)
    for p in range(laws.push.shape[0]):
        i, o = laws.push_at[p, 0], laws.push_at[p, 1]
        ph, pl = dd_mul(laws.push[p, 0], laws.push[p, 1], values[o, 0, 0], values[o, 0, 1])
        force[i, 0], force[i, 1] = dd_add(force[i, 0], force[i, 1], ph, pl)


@kernel()
def linearise(table: Packed, q: Floats, v: Floats, x: Floats, out: Linearised) -> None:
    """Fill in the derivatives at places, rates and unknowns of shape (n, 2), (n, 2) and (n + m, 2)."""
    n = table.load.shape[0]
    mass, damping, stiffness = out.mass, out.damping, out.stiffness
    mass[:], damping[:], stiffness[:] = 0.0, 0.0, 0.0
    for i in range(n):
        for j in range(n):
            mass[i, j] = table.mass[i, j, 0]
    for p in range(table.stiff.shape[0]):
        stiffness[table.stiff_at[p, 0], table.stiff_at[p, 1]] += table.stiff[p, 0]
    for p in range(table.damp.shape[0]):
        damping[table.damp_at[p, 0], table.damp_at[p, 1]] += table.damp[p, 0]
    for p in range(table.gyre.shape[0]):
        i, j, k = table.gyre_at[p, 0], table.gyre_at[p, 1], table.gyre_at[p, 2]
        stiffness[i, j] -= table.gyre[p, 0] * v[k, 0]
        damping[i, k] -= table.gyre[p, 0] * q[j, 0]
    for e in range(table.lines.shape[0]):
        r, j = table.lines_at[e, 0], table.lines_at[e, 1]
        mass[j, n + r] -= table.lines[e, 0]
        if table.binds[e] == 1:
            mass[n + r, j] += table.lines[e, 0]
    for p in range(table.slopes.shape[0]):
        e, i = table.slopes_at[p, 0], table.slopes_at[p, 1]
        r, j, slope = table.lines_at[e, 0], table.lines_at[e, 1], table.slopes[p, 0]
        mass[j, n + r] -= slope * q[i, 0]
        stiffness[j, i] -= slope * x[n + r, 0]
        if table.binds[e] == 1:
            mass[n + r, j] += slope * q[i, 0]
            stiffness[n + r, i] += slope * x[j, 0]
            damping[n + r, i] += slope * v[j, 0]
            damping[n + r, j] += slope * v[i, 0]
    if table.laws.push.shape[0] > 0:
        _linearise_laws(table.laws, q, v, damping, stiffness)


@kernel()
def _linearise_laws(laws: PackedLaws, q: Floats, v: Floats, damping: Floats, stiffness: Floats) -> None:
    """Subtract the derivatives of forces of formulas, by differences, for every coordinate that formulas read."""
    n = len(q)
    path, values = np.empty((2, 2 * n)), np.zeros((laws.operations.shape[0], 1, 2))
    before, after = np.empty((n, 2)), np.empty((n, 2))
    for i in range(n):
        path[0, i], path[1, i], path[0, n + i], path[1, n + i] = q[i, 0], q[i, 1], v[i, 0], v[i, 1]
    forces_of_laws(laws, path, values, before)
    read = np.zeros(n)
    for t in range(laws.terms_at.shape[0]):
        read[laws.terms_at[t]] = 1.0
    for k in range(2 * n):
        if read[k % n] == 0.0:
            continue
        high, low = path[0, k], path[1, k]
        by = NUDGE * max(1.0, abs(high))
        path[0, k], path[1, k] = dd_add(high, low, by, 0.0)
        forces_of_laws(laws, path, values, after)
        path[0, k], path[1, k] = high, low
        for i in range(n):
            slope = ((after[i, 0] - before[i, 0]) + (after[i, 1] - before[i, 1])) / by
            if k < n:
                stiffness[i, k] -= slope
            else:
                damping[i, k - n] -= slope


@kernel()
def residual(
    table: Packed, q: Floats, v: Floats, x: Floats, lines: Floats, path: Floats, values: Floats, out: Floats
) -> None:
    """Fill in by how much a state and its unknowns miss the equation, shape (n + m, 2).

    Parameters
    ----------
    q, v, x : (n, 2), (n, 2) and (n + m, 2)
    lines : (e, 2)
        Entries of W and X at the place.
    path, values : (2, 2 n) and (o, 1, 2)
        Space.
    """
    n = table.load.shape[0]
    out[:] = 0.0
    for i in range(n):
        out[i, 0], out[i, 1] = -table.load[i, 0], -table.load[i, 1]
        for j in range(n):
            if table.mass[i, j, 0] != 0.0:
                out[i, 0], out[i, 1] = gathered(
                    out[i, 0], out[i, 1], table.mass[i, j, 0], table.mass[i, j, 1], x[j, 0], x[j, 1]
                )
    for p in range(table.stiff.shape[0]):
        i, j = table.stiff_at[p, 0], table.stiff_at[p, 1]
        out[i, 0], out[i, 1] = gathered(out[i, 0], out[i, 1], table.stiff[p, 0], table.stiff[p, 1], q[j, 0], q[j, 1])
    for p in range(table.damp.shape[0]):
        i, j = table.damp_at[p, 0], table.damp_at[p, 1]
        out[i, 0], out[i, 1] = gathered(out[i, 0], out[i, 1], table.damp[p, 0], table.damp[p, 1], v[j, 0], v[j, 1])
    for p in range(table.gyre.shape[0]):
        i, j, k = table.gyre_at[p, 0], table.gyre_at[p, 1], table.gyre_at[p, 2]
        ph, pl = dd_mul(q[j, 0], q[j, 1], v[k, 0], v[k, 1])
        out[i, 0], out[i, 1] = gathered(out[i, 0], out[i, 1], -table.gyre[p, 0], -table.gyre[p, 1], ph, pl)
    for e in range(table.lines.shape[0]):
        r, j = table.lines_at[e, 0], table.lines_at[e, 1]
        out[j, 0], out[j, 1] = gathered(out[j, 0], out[j, 1], -lines[e, 0], -lines[e, 1], x[n + r, 0], x[n + r, 1])
        if table.binds[e] == 1:
            out[n + r, 0], out[n + r, 1] = gathered(
                out[n + r, 0], out[n + r, 1], lines[e, 0], lines[e, 1], x[j, 0], x[j, 1]
            )
    for p in range(table.slopes.shape[0]):
        e, i = table.slopes_at[p, 0], table.slopes_at[p, 1]
        if table.binds[e] == 1:
            r, j = n + table.lines_at[e, 0], table.lines_at[e, 1]
            ph, pl = dd_mul(v[i, 0], v[i, 1], v[j, 0], v[j, 1])
            out[r, 0], out[r, 1] = gathered(out[r, 0], out[r, 1], table.slopes[p, 0], table.slopes[p, 1], ph, pl)
    for i in range(out.shape[0]):
        out[i, 0], out[i, 1] = settled(out[i, 0], out[i, 1])
    laws = table.laws
    if laws.push.shape[0] > 0:
        for i in range(n):
            path[0, i], path[1, i], path[0, n + i], path[1, n + i] = q[i, 0], q[i, 1], v[i, 0], v[i, 1]
        values_of_laws(laws, path, n, 0, 1.0, values)
        for p in range(laws.push.shape[0]):
            i, o = laws.push_at[p, 0], laws.push_at[p, 1]
            ph, pl = dd_mul(laws.push[p, 0], laws.push[p, 1], values[o, 0, 0], values[o, 0, 1])
            out[i, 0], out[i, 1] = dd_add(out[i, 0], out[i, 1], -ph, -pl)


@kernel()
def unknowns_at(table: Packed, space: Saddle, q: Floats, v: Floats, x: Floats) -> bool:
    """Fill in accelerations and multipliers at a state, shape (n + m, 2), in doubles; return whether they are known."""
    size, n = len(x), len(q)
    lines, missed = np.empty((table.lines.shape[0], 2)), np.empty((size, 2))
    path, values = np.empty((2, 2 * n)), np.zeros((table.laws.operations.shape[0], 1, 2))
    entries_of_lines_pairs(table, q, lines)
    if not inverted(table, lines[:, 0].copy(), space):
        return False
    x[:] = 0.0
    residual(table, q, v, x, lines, path, values, missed)
    for i in range(size):
        for j in range(size):
            x[i, 0] -= space.columns[0, j, i] * missed[j, 0]
    return True


@kernel()
def linearised_at(table: Packed, q: Floats, v: Floats) -> Linearised:
    """Return the derivatives of the equation at a state; no numbers where accelerations are not determined."""
    at, x = linearised_space(table), np.zeros((table.load.shape[0] + table.rate.shape[0], 2))
    if not unknowns_at(table, saddle_space(table, 1), q, v, x):
        x[:] = np.nan
    linearise(table, q, v, x, at)
    return at
