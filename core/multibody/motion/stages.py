"""The stages of a step by collocation: accelerations and multipliers at the nodes, where the equation holds.

They are found by Newton's method with the derivatives at the middle of the step: in the eigenvectors of the method's
matrix, whose eigenvalues are g, the systems of the stages fall apart into

    (M~ + h g D~ + h^2 g^2 K~) x = r,

one for each conjugate pair. Residuals are formed in pairs, so that what derivatives in doubles miss costs iterations
alone.

References
----------
E. Hairer, G. Wanner, Solving Ordinary Differential Equations II, 2nd ed., Springer 1996, section IV.8.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from core.arrays import Complexes, Floats
from core.compiled import kernel
from core.double_double import dd_add, dd_add_d, dd_mul, dd_mul_d
from core.multibody.algebra.complex_systems import factored, solved
from core.multibody.algebra.pair_arrays import gathered, settled
from core.multibody.equations.packed import Packed
from core.multibody.motion.linearised import Linearised, residual
from core.multibody.motion.radau import Radau
from core.multibody.motion.series_pairs import entries_of_lines_pairs

MOST_ITERATIONS = 40
"""Iterations for a step; more are taken by the two steps of half the length together."""
SLOWEST = 0.7
"""Contraction of an iteration above which a shorter step, whose derivatives change less, is better."""
REACHED = 2.0**-6
"""Share of the tolerance that may be left of the iteration's last change."""
ROUNDED = 2.0**-40
"""Share of the motion below which changes that do not become smaller are rounding: an iteration that does not contract
shows by larger ones, and rounding is 2^-100 of forces that may be far larger than what they leave."""


class Stages(NamedTuple):
    """Space for a step of s stages.

    Attributes
    ----------
    unknowns, missed : (s, n + m, 2)
    places, rates : (s, n, 2)
    modes : (p, n + m)
    matrices : (p, n + m, n + m)
        Factored.
    pivots : (p, n + m)
    """

    unknowns: Floats
    missed: Floats
    places: Floats
    rates: Floats
    modes: Complexes
    matrices: Complexes
    pivots: Floats


@kernel()
def stages_of(method: Radau, n: int, size: int) -> Stages:
    """Return space for the steps of a method, of n coordinates and `size` unknowns at each node."""
    s, p = method.values.shape[0], method.eigenvalues.shape[0]
    return Stages(
        np.zeros((s, size, 2)),
        np.zeros((s, size, 2)),
        np.zeros((s, n, 2)),
        np.zeros((s, n, 2)),
        np.zeros((p, size), np.complex128),
        np.zeros((p, size, size), np.complex128),
        np.zeros((p, size)),
    )


@kernel()
def at_nodes(method: Radau, q: Floats, v: Floats, h: float, stages: Stages) -> None:
    """Fill in places and rates at the nodes from the accelerations there."""
    s, n = stages.places.shape[0], stages.places.shape[1]
    x = stages.unknowns
    for k in range(s):
        ch, cl = dd_mul_d(method.nodes[k, 0], method.nodes[k, 1], h)
        for i in range(n):
            sh, sl, rh, rl = 0.0, 0.0, 0.0, 0.0
            for j in range(s):
                ah, al = x[j, i, 0], x[j, i, 1]
                sh, sl = gathered(sh, sl, method.places[k, j, 0], method.places[k, j, 1], ah, al)
                rh, rl = gathered(rh, rl, method.rates[k, j, 0], method.rates[k, j, 1], ah, al)
            sh, sl = settled(sh, sl)
            rh, rl = settled(rh, rl)
            sh, sl = dd_mul_d(sh, sl, h)
            sh, sl = dd_mul_d(sh, sl, h)
            rh, rl = dd_mul_d(rh, rl, h)
            ph, pl = dd_mul(ch, cl, v[i, 0], v[i, 1])
            ph, pl = dd_add(ph, pl, q[i, 0], q[i, 1])
            stages.places[k, i, 0], stages.places[k, i, 1] = dd_add(ph, pl, sh, sl)
            stages.rates[k, i, 0], stages.rates[k, i, 1] = dd_add(v[i, 0], v[i, 1], rh, rl)


@kernel()
def factored_at(method: Radau, h: float, at: Linearised, stages: Stages) -> bool:
    """Factor the systems of a step of length h; return whether all are regular."""
    size, n = at.damping.shape
    for p in range(method.eigenvalues.shape[0]):
        a, g = stages.matrices[p], h * method.eigenvalues[p]
        for i in range(size):
            for j in range(size):
                a[i, j] = at.mass[i, j]
            for j in range(n):
                a[i, j] += g * (at.damping[i, j] + g * at.stiffness[i, j])
        if not factored(a, stages.pivots[p]):
            return False
    return True


@kernel()
def iterate(
    table: Packed, method: Radau, h: float, bounds: Floats, tolerance: float, q: Floats, v: Floats, stages: Stages
) -> float:
    """Find the unknowns of a step from a guess; return how large their rounding is, infinite if they are not found.

    Parameters
    ----------
    bounds : (n, 2)
        Sizes of places and rates, of which `tolerance` is a share.
    """
    s, size, n = stages.unknowns.shape[0], stages.unknowns.shape[1], stages.places.shape[1]
    p = method.eigenvalues.shape[0]
    lines = np.empty((table.lines.shape[0], 2))
    path, values = np.empty((2, 2 * n)), np.zeros((table.laws.operations.shape[0], 1, 2))
    before, last = np.inf, np.inf
    for turn in range(MOST_ITERATIONS):
        at_nodes(method, q, v, h, stages)
        for k in range(s):
            entries_of_lines_pairs(table, stages.places[k], lines)
            residual(
                table, stages.places[k], stages.rates[k], stages.unknowns[k], lines, path, values, stages.missed[k]
            )
        for a in range(p):
            for i in range(size):
                total = 0.0j
                for k in range(s):
                    total += method.to_modes[a, k] * stages.missed[k, i, 0]
                stages.modes[a, i] = total
            solved(stages.matrices[a], stages.pivots[a], stages.modes[a])
        change = 0.0
        for k in range(s):
            for i in range(size):
                total = 0.0
                for a in range(p):
                    factor, mode = method.from_modes[k, a], stages.modes[a, i]
                    total += factor.real * mode.real - factor.imag * mode.imag
                x = stages.unknowns[k, i]
                x[0], x[1] = dd_add_d(x[0], x[1], -total)
                if i < n:
                    moved = h * abs(total)
                    if not moved < np.inf:
                        return np.inf
                    change = max(change, moved / bounds[i, 1], h * moved / bounds[i, 0])
        if change <= REACHED * tolerance:
            at_nodes(method, q, v, h, stages)
            return 0.0
        # Of two iterations in a row, as the first may come closer by chance.
        if turn > 1 and change > SLOWEST**2 * before:
            if change > ROUNDED:
                return np.inf
            at_nodes(method, q, v, h, stages)
            return change
        before, last = last, change
    return np.inf


@kernel()
def guess(method: Radau, ratio: float, before: Floats, stages: Stages) -> None:
    """Continue the accelerations and multipliers of the last step, shape (s, n + m, 2), to the nodes of the next."""
    s, size = stages.unknowns.shape[0], stages.unknowns.shape[1]
    weights = np.empty(s)
    stages.unknowns[:] = 0.0
    for k in range(s):
        share = 1.0 + ratio * method.nodes[k, 0]
        for j in range(s):
            total = 0.0
            for power in range(s - 1, -1, -1):
                total = total * share + method.values[power, j]
            weights[j] = total
        for i in range(size):
            total = 0.0
            for j in range(s):
                total += weights[j] * before[j, i, 0]
            stages.unknowns[k, i, 0] = total
