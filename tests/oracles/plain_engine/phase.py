"""Accelerations and forces while no contact changes its state: least squares, with rank by singular values.

With W the rows of what holds, M a = F + (W + X)^T p and W a = -(what the rows gain by themselves): X is the friction of
what slides, -mu along its slip for a unit of its push. Where p is not determined, all solutions are a particular one
and a null space, and what is one-sided asks for a share of the load that a linear programme finds.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from scipy.linalg.lapack import dgecon, dgetrf, dgetrs

from tests.oracles.plain_engine.coordinates import Floats, State
from tests.oracles.plain_engine.mechanism import Mechanism, Owner, Rows
from tests.oracles.plain_engine.modes import Directions, Kind, Mode, tangents
from tests.oracles.plain_engine.shares import Cone, best_share

Key = tuple[str, int]
"""Something that has to stay at or above zero: "push", "cone", "share", "gap", "slip" or "span", and its number."""

RANK = 1e-9
"""Singular value, of rows and columns of one size, below which it is zero: rows are known to some 1e-13."""
NO_ROW = 1e-6
"""Size of a row, relative to the largest, below which it is rounding: of a cosine of axes that stay parallel, say."""
NO_SCALE = 1e-4
"""Acceleration (m/s^2) beside which rounding has no sign, where nothing is loaded or moves."""
CONSISTENT = 1e-8
"""Residual of the equations, relative to their terms, up to which they have a solution."""
FREE = 1e-7
"""Component of a unit vector of the null space below which it is none."""
PROGRAMME = 5
"""Evaluations of accelerations that take as long as a linear programme."""


class Inconsistent(Exception):
    """No accelerations go with these states."""


@dataclass(frozen=True)
class Solution:
    """Accelerations, and the forces of what is held, closed and sticks.

    Attributes
    ----------
    accelerations : ndarray, shape (n,)
    forces : ndarray, shape (m,)
        One of the solutions.
    free : ndarray, shape (f, m)
        By what the forces may differ.
    unique : bool
        Whether the accelerations do not differ with them.
    scale : float
        Size of the forces of the scene (N, N m).
    columns : ndarray, shape (n, m)
        Generalized force of a unit of each.
    owners : list of Owner
    frames : dict of int to ndarray
        Unit vectors along which friction that sticks has its components.
    slips : dict of int to ndarray
        Rates of slip of what slides.
    """

    accelerations: Floats
    forces: Floats
    free: Floats
    unique: bool
    scale: float
    columns: Floats
    owners: list[Owner]
    frames: Directions
    slips: Directions

    def of(self, what: str, number: int) -> list[int]:
        """Return where the forces of an owner are."""
        return [k for k, owner in enumerate(self.owners) if owner == (what, number)]

    def rub(self, number: int) -> Floats:
        """Return the friction of what sticks, in the components of its slip."""
        found: Floats = self.forces[self.of("slip", number)] @ self.frames[number]
        return found


class Phase:
    """A scene while its one-sided measures keep their states.

    Parameters
    ----------
    modes : sequence of Mode
        One for each one-sided measure.
    """

    def __init__(self, mechanism: Mechanism, modes: Sequence[Mode]) -> None:
        self.mechanism, self.modes = mechanism, list(modes)
        self.closed = [i for i, mode in enumerate(modes) if mode.kind is not Kind.OPEN]
        self.sticking = [i for i in self.closed if modes[i].kind is Kind.STICK]
        self.sliding = [i for i in self.closed if modes[i].kind is Kind.SLIDE]
        # In space what slides turns the direction of its friction with it; from rest it begins along this one.
        self.along = {i: np.array(modes[i].along) for i in self.sliding}
        self.rank: int | None = None
        self.last: tuple[State, Rows] | None = None

    def rows(self, state: State) -> Rows:
        """Return the rows of what holds, of what is closed, and of all slips."""
        if self.last is None or self.last[0] is not state:
            self.last = state, self.mechanism.rows(state, self.closed, [*self.sticking, *self.sliding])
        return self.last[1]

    def independence(self, state: State) -> float:
        """Return the product of the squared singular values of what holds; it is zero where that loses its rank."""
        rows = self.rows(state)
        lines = rows.lines[[what != "slip" for what, _ in rows.owners]]
        values = np.linalg.svd(lines / sizes_of(lines)[:, None], compute_uv=False)
        self.rank = int((values > NO_ROW).sum()) if self.rank is None else self.rank
        return float(np.prod(values[: self.rank] ** 2))

    def direction(self, i: int, slip: Floats) -> Floats:
        """Return the direction in which something slides."""
        along, size = self.along[i], float(np.linalg.norm(slip))
        # Beside rounding a slip has no direction; one that has passed through zero goes on being continued.
        return along if len(along) == 1 or size < 1e-13 else slip / size * (1.0 if slip @ along >= 0.0 else -1.0)

    def turn(self, state: State) -> None:
        """Let what slides in space go on from its present direction."""
        if any(len(along) == 3 for along in self.along.values()):
            rows = self.rows(state)
            self.along = {i: self.direction(i, rows.rates[rows.of("slip", i)]) for i in self.sliding}

    def solve(self, state: State, restitution: Mapping[int, float] | None = None) -> Solution:
        """Return accelerations and forces; with restitutions, of an impact, the change of the rates and the impulses.

        Raises
        ------
        Inconsistent
            If there are none.
        """
        mechanism = self.mechanism
        mechanism.spend()
        rows = self.rows(state)
        gained = rows.gains if restitution is None else rows.after(restitution)
        loads = mechanism.loads(state) if restitution is None else np.zeros(len(state.rates))
        held = [k for k, (what, _) in enumerate(rows.owners) if what != "slip"]
        owners, lines, gains = [rows.owners[k] for k in held], [rows.lines[held]], [gained[held]]
        frames = {}
        for i in self.sticking:
            own = rows.of("slip", i)
            frames[i] = tangents(rows.lines[own])
            lines.append(frames[i] @ rows.lines[own])
            gains.append(frames[i] @ gained[own])
            owners += [("slip", i)] * len(frames[i])
        every = np.concatenate(lines)
        columns = every.T.copy()
        slips = {i: rows.rates[rows.of("slip", i)] for i in self.sliding}
        for i, slip in slips.items():
            direction = self.direction(i, slip) if restitution is None else self.along[i]
            against = direction @ rows.lines[rows.of("slip", i)]
            columns[:, owners.index(("push", i))] -= mechanism.one_sided[i].touch.kinetic * against
        found = solved(mechanism.inertia(state), loads, every, np.concatenate(gains), columns)
        return Solution(*found, columns, owners, frames, slips)

    def conditions(self, found: Solution, among: Sequence[int]) -> dict[Key, float]:
        """Return what pushes and friction of some measures have to satisfy, relative to the forces of the scene.

        Of forces that are determined, these are pushes, and how far friction that sticks is within its cone; of all
        others one share, the largest of the least of their conditions that any share of the load allows, at most 1.
        """
        conditions: dict[Key, float] = {}
        cones: list[Cone] = []
        loose = np.abs(found.free).max(axis=0, initial=0.0) > FREE
        for i in self.closed:
            if i not in among:
                continue
            (row,), rub = found.of("push", i), found.of("slip", i)
            static = self.mechanism.one_sided[i].touch.static
            if loose[[row, *rub]].any():
                cones.append(Cone(row, rub, static))
                continue
            conditions["push", i] = found.forces[row] / found.scale
            if rub:
                conditions["cone", i] = (static * found.forces[row] - np.linalg.norm(found.forces[rub])) / found.scale
        if cones:
            self.mechanism.spend(PROGRAMME)
            conditions["share", -1] = best_share(found.forces / found.scale, found.free, cones)
        return conditions


def solved(
    mass: Floats, loads: Floats, lines: Floats, gains: Floats, columns: Floats
) -> tuple[Floats, Floats, Floats, bool, float]:
    """Return accelerations and forces of [M, -columns; lines, 0] by the singular values of the scaled matrix.

    Returns
    -------
    accelerations, forces, free, unique, scale
        As in `Solution`.
    """
    n, m = len(loads), len(gains)
    diagonal = mass.diagonal()
    typical = float(diagonal[diagonal > 0.0].min()) if (diagonal > 0.0).any() else 1.0
    scale = 1.0 / np.sqrt(np.where(diagonal > 0.0, diagonal, typical))
    sizes = sizes_of(lines * scale)
    matrix = np.zeros((n + m, n + m))
    matrix[:n, :n] = scale[:, None] * mass * scale
    matrix[:n, n:] = -scale[:, None] * columns / sizes
    matrix[n:, :n] = lines * scale / sizes[:, None]
    right = np.concatenate([scale * loads, -gains / sizes])
    found, null = _least_squares(matrix, right)
    size = max(float(np.abs(right).max(initial=0.0)), float(np.abs(found[:n]).max(initial=0.0)))
    if not float(np.abs(matrix @ found - right).max(initial=0.0)) <= CONSISTENT * size:
        raise Inconsistent
    unique = bool(np.abs(null[:, :n]).max(initial=0.0) < FREE)
    forces, accelerations = found[n:] / sizes, found[:n] * scale
    terms = (loads, mass @ accelerations, forces, NO_SCALE * diagonal)
    largest = max(float(np.abs(x).max(initial=0.0)) for x in terms)
    return accelerations, forces, null[:, n:] / sizes, unique, largest


def sizes_of(lines: Floats) -> Floats:
    """Return the sizes of rows; that of one of nothing but rounding is the largest, so that it stays small."""
    sizes: Floats = np.linalg.norm(lines, axis=1)
    largest = float(sizes.max(initial=0.0)) or 1.0
    return np.where(sizes < NO_ROW * largest, largest, sizes)


def _least_squares(matrix: Floats, right: Floats) -> tuple[Floats, Floats]:
    """Return the shortest solution of least squares, and the null space as rows.

    A matrix whose condition says that no singular value is below `RANK` is solved by elimination.
    """
    if not np.isfinite(matrix).all() or not np.isfinite(right).all():
        raise Inconsistent
    factors, pivots, fault = dgetrf(matrix)
    if fault == 0 and dgecon(factors, float(np.abs(matrix).sum(axis=0).max()))[0] > RANK:
        return dgetrs(factors, pivots, right)[0], np.zeros((0, len(right)))
    u, s, vt = np.linalg.svd(matrix)
    rank = int((s > RANK * s[0]).sum())
    return vt[:rank].T @ ((u[:, :rank].T @ right) / s[:rank]), vt[rank:]
