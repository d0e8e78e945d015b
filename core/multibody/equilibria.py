"""Where a scene can rest, and how it moves near there.

K q - b = W(q)^T lambda with g = 0 is quadratic again: Newton's method from many starts finds its solutions, those with
positive lengths and taut strings count. That all are found is not proven. Small motions are those of Z^T M Z, Z^T D Z
and Z^T (K - sum lambda dW) Z, with Z the directions that the connections leave free. Coordinates that a motion from the
given start would never move are free here.
"""

from __future__ import annotations

import numpy as np

from core.errors import AccuracyUnreachable, BudgetExceeded, NotApplicable
from core.multibody.answer import Equilibrium
from core.multibody.description import Described
from core.multibody.dynamics import accelerations
from core.multibody.frames import Frame
from core.multibody.packed import Floats, Packed, Units, packed, state, two_to, units_of
from core.multibody.passes import reduced
from core.multibody.reduction import Reduced
from core.multibody.resting_places import RestingPlaces
from core.multibody.small_systems import solutions
from core.work import spend

MOST_FOUND = 100
_STARTS = 128
"""Starts for every degree of freedom."""
_ROUNDS = 60
_MOST_OPERATIONS = 80_000_000
"""Of one round: starts times the cube of the unknowns. More would take longer than a minute, and gigabytes."""
_OPERATIONS_PER_UNIT = 40.0
"""So many, in every round, take a unit of work (`core.work`)."""
_SAME = 1e-7
_CONVERGED = 1e-10
_SETTLED = 1e-6
"""Largest last relative change of the multipliers: beside a length of zero they grow without bound."""
_ENDED = 1e-13
_FAR, _HARD = 1e6, 1e12
"""Places and multipliers beyond which a start is given up."""
_DWARFED = 1e4
"""Multipliers so many times the forces, where the equations are nearly singular, are those beside a length of zero."""
_REMOTE = 1e3
"""So far out, in the scene's own unit, nearly singular equations are those of forces that vanish at infinity."""
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
    arrays = packed(table, chosen, units)
    dense = _Dense(arrays)
    for number, r in enumerate(chosen):
        if r in tied:
            dense.tie(number, found, small, units, frames[table.rows[r].name], two_to(units.rows[r]))
    start = state(table, units)[0][:, 0]
    places = _search(dense, start, len(table.names) - len(chosen))
    resting = RestingPlaces(found, small, units)
    answers = [
        (dense.potential(q), _described(resting, units.time, dense, q, multipliers))
        for q, multipliers in places
        if resting.possible(q)
    ]
    answers.sort(key=lambda entry: entry[0])
    return tuple(entry[1] for entry in answers[:MOST_FOUND])


class _Dense:
    """The arrays of a table without tails: M, b, K, D, and W with its constant slopes."""

    def __init__(self, arrays: Packed) -> None:
        n, m = len(arrays.load), len(arrays.rate)
        self.mass, self.load = arrays.mass[..., 0], arrays.load[:, 0]
        self.stiffness, self.damping = np.zeros((n, n)), np.zeros((n, n))
        for (i, j), x in zip(arrays.stiff_at, arrays.stiff[:, 0], strict=True):
            self.stiffness[i, j] = x
        for (i, j), x in zip(arrays.damp_at, arrays.damp[:, 0], strict=True):
            self.damping[i, j] = x
        self.lines, self.slopes = np.zeros((m, n)), np.zeros((m, n, n))
        for (r, j), x in zip(arrays.lines_at, arrays.lines[:, 0], strict=True):
            self.lines[r, j] = x
        for (e, i), x in zip(arrays.slopes_at, arrays.slopes[:, 0], strict=True):
            r, j = arrays.lines_at[e]
            self.slopes[r, j, i] = x
        self.offset = arrays.offset[:, 0]
        self.ties: list[tuple[int, list[tuple[Floats, float]], tuple[float, float], float]] = []
        self.gyration = [(*at, x) for at, x in zip(arrays.gyre_at.tolist(), arrays.gyre[:, 0], strict=True)]

    def tie(self, row: int, found: Described, small: Reduced, units: Units, frame: Frame, factor: float) -> None:
        """Let a row hold the angle of a body to its direction: its rate is that of an angle with full turns."""
        assert frame.turn is not None
        assert frame.direction is not None
        up = np.array([two_to(e) for e in units.lengths])
        forms, start = [], []
        for i in (frame.turn, *frame.direction):
            line, offset = np.zeros(len(up)), 0.0
            for key, value in small.expressions[i].items():
                if key:
                    line[key[0]] = float(value) * up[key[0]]
                else:
                    offset = float(value)
            forms.append((line, offset))
            start.append(float(found.measures.table.q[i]))
        self.ties.append((row, forms, (start[0], float(np.arctan2(start[2], start[1]))), factor))

    def jacobian(self, q: Floats) -> Floats:
        """Return W at places of shape (..., n)."""
        m, n = self.lines.shape
        found: Floats = self.lines + (q @ self.slopes.reshape(m * n, n).T).reshape(*q.shape[:-1], m, n)
        return found

    def measures(self, q: Floats) -> Floats:
        """Return g at places of shape (..., n)."""
        found: Floats = self.offset + np.matmul((self.lines + self.jacobian(q)) / 2, q[..., None])[..., 0]
        for row, forms, (turn, angle), factor in self.ties:
            now, cosine, sine = (q @ line + offset for line, offset in forms)
            # The angle may differ from the direction by full turns: a spring that is wound up.
            away = (now - turn) - (np.arctan2(sine, cosine) - angle)
            found[..., row] = factor * (away - 2 * np.pi * np.round(away / (2 * np.pi)))
        return found

    def potential(self, q: Floats) -> float:
        """Return the potential energy of a place."""
        return float(q @ self.stiffness @ q / 2 - self.load @ q)

    def damping_at(self, q: Floats) -> Floats:
        """Return what multiplies the rates near a place at rest, gyroscopic terms included."""
        total = self.damping.copy()
        for i, j, k, x in self.gyration:
            total[i, k] -= x * q[j]
        return total


def _search(dense: _Dense, start: Floats, freedom: int) -> list[tuple[Floats, Floats]]:
    n, m = len(start), len(dense.offset)
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
    with np.errstate(all="ignore"):
        q = _onto(dense, q)
        multipliers = np.zeros((count, m))
        if m:
            pulls = q @ dense.stiffness.T - dense.load
            multipliers = _saddle(dense.jacobian(q), pulls, np.zeros((count, m)))[:, n:]
        known = np.abs(multipliers).max(axis=1, initial=0.0) < _HARD
        q, multipliers = _followed(dense, q[known], multipliers[known])
        if not len(q):
            return []
        step, singular, left, measures = _newton(dense, q, multipliers)
    # A step alone may be short where the equations are nearly singular and not solved.
    size = 1.0 + np.abs(q).max(axis=1)
    terms = _forces(dense, q)
    done = np.abs(step[:, :n]).max(axis=1) < _CONVERGED * size
    done &= np.abs(left).max(axis=1) <= _CONVERGED * terms
    done &= np.abs(measures).max(axis=1, initial=0.0) < _CONVERGED * size**2
    largest = np.abs(multipliers).max(axis=1, initial=0.0)
    done &= np.abs(step[:, n:]).max(axis=1, initial=0.0) <= _SETTLED * (largest + terms)
    done &= ~(singular & ((largest > _DWARFED * terms) | (size > _REMOTE)))
    q, multipliers = q[done], multipliers[done]
    found: list[tuple[Floats, Floats]] = []
    while len(q) and len(found) < MOST_FOUND:
        found.append((q[0], multipliers[0]))
        other = np.abs(q - q[0]).max(axis=1) > _SAME * (1.0 + np.abs(q).max(axis=1))
        q, multipliers = q[other], multipliers[other]
    return found


def _forces(dense: _Dense, q: Floats) -> Floats:
    """Return the size of the forces at places, those of the connections apart."""
    found: Floats = np.abs(dense.load).max(initial=0.0) + np.abs(q @ dense.stiffness.T).max(axis=1)
    return found


def _followed(dense: _Dense, q: Floats, multipliers: Floats) -> tuple[Floats, Floats]:
    """Return where Newton's method leads, in the order of the starts; those that leave every bound are left out."""
    n = q.shape[1]
    order = np.arange(len(q))
    ended: list[tuple[Floats, Floats, np.ndarray]] = []
    for _ in range(_ROUNDS):
        step, singular, left, _ = _newton(dense, q, multipliers)
        # Where the equations are nearly singular a step may be short though they are not solved.
        solved = ~singular | (np.abs(left).max(axis=1) <= _ENDED * _forces(dense, q))
        q, multipliers = q + step[:, :n], multipliers + step[:, n:]
        largest = np.abs(q).max(axis=1)
        held = np.abs(multipliers).max(axis=1, initial=0.0)
        good = (largest < _FAR) & (held < _HARD)
        # Beyond a step as short as this there is only rounding.
        short = np.abs(step[:, :n]).max(axis=1) <= _ENDED * (1.0 + largest)
        short &= np.abs(step[:, n:]).max(axis=1, initial=0.0) <= _ENDED * (1.0 + held)
        short &= solved
        there = good & short
        ended.append((q[there], multipliers[there], order[there]))
        go = good & ~short
        q, multipliers, order = q[go], multipliers[go], order[go]
        if not len(q):
            break
    ended.append((q, multipliers, order))
    q, multipliers, order = (np.concatenate([entry[k] for entry in ended]) for k in range(3))
    as_started = np.argsort(order)
    return q[as_started], multipliers[as_started]


def _onto(dense: _Dense, q: Floats) -> Floats:
    if not len(dense.offset):
        return q
    for _ in range(8):
        step = _saddle(dense.jacobian(q), np.zeros_like(q), -dense.measures(q))[:, : q.shape[1]]
        q = q + np.clip(step, -1.0, 1.0)
        q = np.where(np.isfinite(q), q, 0.0)
    return q


def _saddle(w: Floats, first: Floats, second: Floats) -> Floats:
    """Return the solutions (x, y) of x + W^T y = first, W x = second: the shortest x, or the y of least squares."""
    n, m = first.shape[1], second.shape[1]
    system = np.zeros((len(w), n + m, n + m))
    system[:, :n, :n] = np.eye(n)
    system[:, :n, n:] = np.swapaxes(w, 1, 2)
    system[:, n:, :n] = w
    return solutions(system, np.concatenate([first, second], axis=1))[0]


def _newton(dense: _Dense, q: Floats, multipliers: Floats) -> tuple[Floats, np.ndarray, Floats, Floats]:
    """Return the steps of places and multipliers, which systems were nearly singular, and what the steps are to end.

    That is the forces left over and the measures that are not held.
    """
    n, m = q.shape[1], multipliers.shape[1]
    w = dense.jacobian(q)
    system = np.zeros((len(q), n + m, n + m))
    system[:, :n, :n] = (multipliers @ dense.slopes.reshape(m, n * n)).reshape(-1, n, n) - dense.stiffness
    system[:, :n, n:] = np.swapaxes(w, 1, 2)
    system[:, n:, :n] = w
    left = dense.load - q @ dense.stiffness.T + np.matmul(multipliers[:, None, :], w)[:, 0]
    measures = dense.measures(q)
    # Places without a single solution nearby make no step of their own.
    return *solutions(system, -np.concatenate([left, measures], axis=1)), left, measures


def _described(resting: RestingPlaces, time: int, dense: _Dense, q: Floats, multipliers: Floats) -> Equilibrium:
    left = dense.load - dense.stiffness @ q + dense.jacobian(q).T @ multipliers
    terms = np.abs(dense.load).max(initial=0.0) + np.abs(dense.stiffness @ q).max(initial=0.0)
    modes, stable = _small_motion(dense, q, multipliers)
    rate = two_to(-time)
    shown = tuple((float(w * rate), float(g * rate)) for w, g in modes)
    if not np.isfinite(shown).all():
        reason = "the search for equilibria leaves the range of doubles"
        remedy = "ask without equilibria, or choose units in which the numbers are moderate"
        raise AccuracyUnreachable(None, np.inf, reason, path=("outputs",), remedy=remedy)
    residual = float(np.abs(left).max(initial=0.0) / terms) if terms else 0.0
    return Equilibrium(*resting.shown(q), stable, shown, residual)


def _small_motion(dense: _Dense, q: Floats, multipliers: Floats) -> tuple[list[tuple[float, float]], bool | None]:
    """Return (frequency, growth rate) of the small motions near an equilibrium, and whether it is stable."""
    n, m = len(q), len(multipliers)
    z = _directions(dense.jacobian(q)) if m else np.eye(n)
    if not z.shape[1]:
        return [], True
    mass = z.T @ dense.mass @ z
    damping = z.T @ dense.damping_at(q) @ z
    stiffness = z.T @ (dense.stiffness - np.einsum("rji,r->ji", dense.slopes, multipliers)) @ z
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


def _directions(w: Floats) -> Floats:
    """Return an orthonormal basis of what rows of shape (m, n) leave free, by their singular values."""
    _, sizes, right = np.linalg.svd(w)
    rank = int(np.sum(sizes > np.finfo(float).eps * max(w.shape) * sizes.max(initial=0.0)))
    free: Floats = right[rank:].T
    return free
