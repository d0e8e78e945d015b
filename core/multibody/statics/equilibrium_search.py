"""Where the equations of rest hold: Newton's method from many starts.

Where the equations are nearly singular, the step is the shortest of least squares. That all solutions are found is not
proven.
"""

from __future__ import annotations

import numpy as np

from core.arrays import Floats
from core.compiled import kernel
from core.errors import BudgetExceeded
from core.multibody.algebra.small_systems import solve
from core.multibody.statics.static_equations import StaticArrays, StaticEquations, linearised
from core.work import spend

MOST_FOUND = 100
"""Places of rest that are answered: a chain of six pendulums has 64."""

_STARTS = 128
"""Starts for every degree of freedom."""
_NEWTON_STEPS_OF_A_START = 60
"""Newton steps of a start: quadratic convergence takes some ten from nearby, the others are for the way there."""

_MOST_OPERATIONS = 80_000_000
"""Of one round: starts times the cube of the unknowns. More would take longer than a minute, and gigabytes."""
_OPERATIONS_PER_UNIT = 40.0
"""So many, in every round, take a unit of work (`core.work`)."""
_SAME = 1e-7
"""Relative distance up to which two ends are one place of rest: a thousand times what `_CONVERGED` leaves."""

_CONVERGED = 1e-10
"""Relative size of the last step and of the forces that are left: rounding leaves some 1e-13 of a few dozen
unknowns."""

_IN_REACH = 1e-3
"""Length of a last step, relative to the size, within which a place of rest lies whose forces are rounding alone: where
one direction is softer than others by 1e9, rounding is amplified by as much. Balls find it from there."""
_SPREAD = 16.0
"""Ends that are so many last steps apart are two, where these are long."""

_SETTLED = 1e-6
"""Largest last relative change of the multipliers: beside a length of zero they grow without bound."""
_ENDED = 1e-13
"""Relative length of a step that is nothing but rounding, of some hundred operations in doubles."""

_FAR, _HARD = 1e6, 1e12
"""Places and multipliers beyond which a start is given up."""
_DWARFED = 1e4
"""Multipliers so many times the forces, where the equations are nearly singular, are those beside a length of zero."""
_HOPELESS = 24
"""Rounds in a row in such a place after which a start is given up. Multipliers double in each of them; starts that end
at an equilibrium nevertheless leave such places within 13 rounds, in every scene of the catalogue."""
_ONTO = 8
"""Rounds that put a start onto the measures."""
_REMOTE = 1e3
"""So far out, in the scene's own unit, nearly singular equations are those of forces that vanish at infinity."""


def solutions_of(equations: StaticEquations, start: Floats, freedom: int) -> list[tuple[Floats, Floats]]:
    """Return places and multipliers at which the equations of rest hold, at most `MOST_FOUND`.

    Parameters
    ----------
    equations : StaticEquations
    start : ndarray, shape (n,)
        The place around which starts are drawn.
    freedom : int
        Degrees of freedom.

    Raises
    ------
    BudgetExceeded
        If the search would take too long.
    """
    n, m = len(start), len(equations.arrays.offset)
    count = min(4096, _STARTS * max(1, freedom))
    operations = count * (n + m) ** 3
    if operations > _MOST_OPERATIONS:
        what = f"operations in each round of the search for equilibria ({count} starts, {n + m} unknowns)"
        remedy = "ask without equilibria, or about fewer bodies"
        raise BudgetExceeded(what, operations, _MOST_OPERATIONS, path=("outputs",), remedy=remedy)
    spend(operations / _OPERATIONS_PER_UNIT)
    # Always the same starts: equal questions have equal answers.
    random = np.random.Generator(np.random.Philox(7))
    q = start + random.normal(size=(count, n)) * random.uniform(0.05, 2.0, size=(count, 1))
    q[0] = start
    multipliers = np.zeros((count, m))
    steps = _followed(equations.arrays, q, multipliers)
    done = np.isfinite(steps)
    # Of ends that are one those come first that are known best.
    order = np.flatnonzero(done)[np.argsort(steps[done] > _CONVERGED, kind="stable")]
    q, multipliers, steps = q[order], multipliers[order], steps[order]
    found: list[tuple[Floats, Floats]] = []
    while len(q) and len(found) < MOST_FOUND:
        found.append((q[0], multipliers[0]))
        far = np.maximum(_SAME, _SPREAD * np.maximum(steps, steps[0]))
        other = np.abs(q - q[0]).max(axis=1) > far * (1.0 + np.abs(q).max(axis=1))
        q, multipliers, steps = q[other], multipliers[other], steps[other]
    return found


@kernel()
def _followed(arrays: StaticArrays, q: Floats, multipliers: Floats) -> Floats:
    """Follow each start in place; return the last steps of those that have come to a solution, shape (c,).

    They are relative to the size, and infinite for others.
    """
    size = q.shape[1] + multipliers.shape[1]
    found, system, right = np.full(len(q), np.inf), np.empty((size, size)), np.empty(size)
    for s in range(len(q)):
        _begin(arrays, q[s], multipliers[s], system, right)
        if _newton(arrays, q[s], multipliers[s], system, right):
            found[s] = _last_step(arrays, q[s], multipliers[s], system, right)
    return found


@kernel()
def _begin(arrays: StaticArrays, q: Floats, multipliers: Floats, system: Floats, right: Floats) -> None:
    """Put a start onto the measures, and give it the multipliers that leave the least force over."""
    n = len(q)
    for turn in range(_ONTO + 1):
        linearised(arrays, q, multipliers, system, right)
        for j in range(n):
            for i in range(n):
                system[j, i] = 1.0 if i == j else 0.0
        if turn == _ONTO:
            right[n:] = 0.0
        else:
            right[:n] = 0.0
        solve(system, right)
        if turn < _ONTO:
            for j in range(n):
                moved = q[j] + min(1.0, max(-1.0, right[j]))
                q[j] = moved if np.isfinite(moved) else 0.0
    for r in range(len(multipliers)):
        multipliers[r] = right[n + r]


@kernel()
def _newton(arrays: StaticArrays, q: Floats, multipliers: Floats, system: Floats, right: Floats) -> bool:
    """Follow Newton's method; return whether it stays within every bound."""
    n, dwarfed = len(q), 0
    for _ in range(_NEWTON_STEPS_OF_A_START):
        left, terms, _off = linearised(arrays, q, multipliers, system, right)
        largest, far = _largest(multipliers), _largest(q)
        singular = _step(arrays, system, right)
        dwarfed = dwarfed + 1 if singular and (largest > _DWARFED * terms or far > _REMOTE) else 0
        q += right[:n]
        multipliers += right[n:]
        far, held = _largest(q), _largest(multipliers)
        if not (far < _FAR and held < _HARD) or dwarfed == _HOPELESS:
            return False
        # Beyond a step as short as this there is only rounding; where the equations are nearly singular, a step may be
        # short though they are not solved.
        short = _largest(right[:n]) <= _ENDED * (1.0 + far) and _largest(right[n:]) <= _ENDED * (1.0 + held)
        if short and (not singular or left <= _ENDED):
            break
    return True


@kernel()
def _step(arrays: StaticArrays, system: Floats, right: Floats) -> bool:
    """Put Newton's step in place of the right side; return whether the system is nearly singular.

    A connection is measured by the lightest that it pulls, and the forces on a coordinate by the largest of them:
    without that, what hangs below something much heavier would be lost in rounding.
    """
    n, m = len(arrays.load), len(arrays.offset)
    scales, heaviest = np.ones(m), _largest(arrays.weights)
    for r in range(m):
        least = heaviest
        for j in range(n):
            if arrays.touched[r, j]:
                least = min(least, arrays.weights[j])
        if least > 0.0:
            scales[r] = least / heaviest
        for j in range(n):
            system[j, n + r] *= scales[r]
    for j in range(n):
        largest = _largest(system[j])
        if largest > 0.0:
            right[j] /= largest
            for i in range(n + m):
                system[j, i] /= largest
    for r in range(m):
        largest = _largest(system[:, n + r])
        if largest > 0.0:
            scales[r] /= largest
            for j in range(n + m):
                system[j, n + r] /= largest
    singular = solve(system, right)
    for r in range(m):
        right[n + r] *= scales[r]
    return singular


@kernel()
def _last_step(arrays: StaticArrays, q: Floats, multipliers: Floats, system: Floats, right: Floats) -> float:
    """Return the last step; infinity where the equations do not hold, near a length of zero, and far out."""
    n = len(q)
    left, terms, off = linearised(arrays, q, multipliers, system, right)
    size, largest = 1.0 + _largest(q), _largest(multipliers)
    singular = _step(arrays, system, right)
    if singular and (largest > _DWARFED * terms or size > _REMOTE):
        return np.inf
    # A step alone may be short where the equations are nearly singular and not solved.
    solved = left <= _CONVERGED and off < _CONVERGED * size**2
    settled = _largest(right[n:]) <= _SETTLED * (largest + terms)
    step = _largest(right[:n]) / size
    short = step < (_IN_REACH if left <= _ENDED else _CONVERGED)
    return step if solved and settled and short else np.inf


@kernel()
def _largest(x: Floats) -> float:
    """Return the largest size, infinite where a number is none."""
    found = 0.0
    for i in range(len(x)):
        if not np.isfinite(x[i]):
            return np.inf
        found = max(found, abs(x[i]))
    return found
