"""Where a scene can rest, and how it moves near there.

K q - b = W(q)^T lambda with g = 0 is quadratic again: Newton's method from many starts finds its solutions, those with
positive lengths and taut strings count. That all are found is not proven. Small motions are those of Z^T M Z, Z^T D Z
and Z^T (K - sum lambda dW) Z, with Z the directions that the connections leave free. Coordinates that a motion from the
given start would never move are free here.
"""

from __future__ import annotations

import numpy as np

from core.arrays import Floats
from core.errors import AccuracyUnreachable, NotApplicable
from core.multibody.answer import Equilibrium, SmallMotion
from core.multibody.equations.dynamics import accelerations
from core.multibody.equations.packed import packed, state, two_to, units_of
from core.multibody.reduction.passes import reduced
from core.multibody.statics.equilibrium_search import MOST_FOUND, solutions_of
from core.multibody.statics.resting_places import RestingPlaces
from core.multibody.statics.static_equations import StaticEquations
from core.multibody.table.description import Described

_SMALL = 1e-9


def equilibria_of(found: Described) -> tuple[Equilibrium, ...]:
    """Return the equilibria that Newton's method finds, those of lowest potential first.

    Raises
    ------
    NotApplicable
        For scenes that are driven, or held by rates that no measure gives: rolling on curves, and drums.
    BudgetExceeded
        If the search would take too long.
    """
    small = reduced(found.measures.table, pinning=False)
    table = small.table
    frames = found.measures.coordinates.frames
    tied = [r for r, row in enumerate(table.rows) if row.measure is None]
    if any(table.rows[r].name not in frames or frames[table.rows[r].name].turn is None for r in tied):
        raise NotApplicable(
            "equilibria are not answered where rates are held that no measure gives: motors, rolling on curves, drums",
            path=("outputs",),
        )
    if not table.names:
        return ()
    gains, chosen = accelerations(table)
    units = units_of(table, gains)
    equations = StaticEquations(packed(table, chosen, units))
    for number, r in enumerate(chosen):
        if r in tied:
            equations.tie(number, found, small, units, frames[table.rows[r].name], two_to(units.rows[r]))
    start = state(table, units)[0][:, 0]
    places = solutions_of(equations, start, len(table.names) - len(chosen))
    resting = RestingPlaces(found, small, units)
    answers = [
        (equations.potential(q), _described(resting, units.time, equations, q, multipliers))
        for q, multipliers in places
        if resting.possible(q)
    ]
    answers.sort(key=lambda entry: entry[0])
    return tuple(entry[1] for entry in answers[:MOST_FOUND])


def _described(
    resting: RestingPlaces, time: int, equations: StaticEquations, q: Floats, multipliers: Floats
) -> Equilibrium:
    load, pull = equations.arrays.load, equations.arrays.stiffness @ q
    left = load - pull + equations.jacobian(q).T @ multipliers
    terms = np.abs(load).max(initial=0.0) + np.abs(pull).max(initial=0.0)
    try:
        modes, stable = _small_motion(equations, q, multipliers)
    except np.linalg.LinAlgError as fault:
        raise _out_of_range("the masses differ by more than doubles can resolve") from fault
    rate = two_to(-time)
    shown = tuple(SmallMotion(float(w * rate), float(g * rate)) for w, g in modes)
    if not np.isfinite([mode[:2] for mode in shown]).all():
        raise _out_of_range("the search for equilibria leaves the range of doubles")
    residual = float(np.abs(left).max(initial=0.0) / terms) if terms else 0.0
    return Equilibrium(*resting.shown(q), stable, shown, residual)


def _out_of_range(reason: str) -> AccuracyUnreachable:
    remedy = "ask without equilibria, or choose units in which the numbers are moderate"
    return AccuracyUnreachable(None, np.inf, reason, path=("outputs",), remedy=remedy)


def _small_motion(
    equations: StaticEquations, q: Floats, multipliers: Floats
) -> tuple[list[tuple[float, float]], bool | None]:
    """Return (frequency, growth rate) of the small motions near an equilibrium, and whether it is stable."""
    n, m = len(q), len(multipliers)
    z = _directions(equations.jacobian(q)) if m else np.eye(n)
    if not z.shape[1]:
        return [], True
    # Directions are scaled so that each has the same mass: light bodies beside heavy ones are then resolved as well.
    z = z * _one_over_root(np.diag(z.T @ equations.mass @ z))
    mass = z.T @ equations.mass @ z
    damping = z.T @ equations.damping_at(q) @ z
    stiffness = z.T @ (equations.arrays.stiffness - np.einsum("rji,r->ji", equations.slopes, multipliers)) @ z
    inverse = np.linalg.inv(mass)
    symmetric = np.abs(stiffness - stiffness.T).max() <= _SMALL * np.abs(stiffness).max()
    bound = np.sqrt(np.abs(inverse @ stiffness).max()) + np.abs(inverse @ damping).max()
    if symmetric and np.abs(damping).max(initial=0.0) <= _SMALL * bound * np.abs(mass).max():
        low = np.linalg.cholesky((mass + mass.T) / 2)
        squares = np.linalg.eigvalsh(np.linalg.solve(low, np.linalg.solve(low, (stiffness + stiffness.T) / 2).T))
        modes = [(float(np.sqrt(x)), 0.0) if x > 0 else (0.0, float(np.sqrt(-x))) for x in squares]
        edge = _SMALL * float(np.abs(squares).max(initial=0.0))
        lowest = float(squares.min())
        return modes, True if lowest > edge else (False if lowest < -edge else None)
    size = len(mass)
    system = np.block([[np.zeros((size, size)), np.eye(size)], [-inverse @ stiffness, -inverse @ damping]])
    roots = np.linalg.eigvals(system)
    modes = sorted((float(x.imag), float(x.real)) for x in roots if x.imag >= -_SMALL * bound)
    growth = float(roots.real.max())
    if growth > 1e-7 * bound:
        return modes, False
    if growth < -1e-7 * bound:
        return modes, True
    # Damping and gyroscopic terms cannot destroy a minimum of the potential.
    convex = symmetric and float(np.linalg.eigvalsh((stiffness + stiffness.T) / 2).min()) > _SMALL * bound
    return modes, True if convex else None


def _one_over_root(masses: Floats) -> Floats:
    positive = masses > 0.0
    roots: Floats = 1.0 / np.sqrt(np.where(positive, masses, 1.0))
    return roots


def _directions(w: Floats) -> Floats:
    """Return a basis of what rows of shape (m, n) leave free, by Gauss and Jordan's elimination with full pivoting.

    Each vector moves one free coordinate and those that depend on it. An orthonormal basis would mix coordinates at
    will, and rounding at the heavy bodies would then hide the light ones.
    """
    rows, held = w.copy(), list[int]()
    least = np.finfo(float).eps * max(w.shape) * np.abs(w).max(initial=0.0)
    for k in range(min(w.shape)):
        i, j = np.unravel_index(np.argmax(np.abs(rows[k:])), rows[k:].shape)
        if abs(rows[k + i, j]) <= least:
            break
        rows[k], rows[k + i] = rows[k + i].copy(), rows[k].copy()
        rows[k] /= rows[k, j]
        others = np.arange(len(rows)) != k
        rows[others] -= np.outer(rows[others, j], rows[k])
        held.append(int(j))
    free = [j for j in range(w.shape[1]) if j not in held]
    basis = np.zeros((w.shape[1], len(free)))
    basis[free, np.arange(len(free))] = 1.0
    basis[held] = -rows[: len(held)][:, free]
    return basis
