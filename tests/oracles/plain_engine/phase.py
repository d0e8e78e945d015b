"""Accelerations and forces while no contact changes its state: least squares, with rank by singular values.

With W the rows of what holds, M a = F + (W + X)^T p and W a = -(what the rows gain by themselves): X is the friction of
what slides, -mu along its slip for a unit of its push. Where p is not determined, all solutions are a particular one
and a null space, and what is one-sided asks for a share of the load that a linear programme finds.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from enum import Enum

import numpy as np
from scipy.linalg.lapack import dgecon, dgetrf, dgetrs

from tests.oracles.plain_engine.coordinates import Floats, State
from tests.oracles.plain_engine.mechanism import Mechanism, OneSided, Rows
from tests.oracles.plain_engine.shares import Cone, best_share

RANK = 1e-9
"""Singular value, of rows and columns of one size, below which it is zero: rows are known to some 1e-13."""
NO_ROW = 1e-6
"""Size of a row, relative to the largest, below which it is rounding: of a cosine of axes that stay parallel, say."""
NO_SCALE = 1e-4
"""Acceleration (m/s^2) beside which rounding has no sign, where nothing is loaded or moves."""
CONSISTENT = 1e-8
"""Residual of the equations, relative to their terms, up to which they have a solution."""


class Kind(Enum):
    """What a one-sided measure does."""

    OPEN = "open"
    CLOSED = "closed"
    STICK = "stick"
    SLIDE = "slide"


@dataclass(frozen=True)
class Mode:
    """What a one-sided measure does, and along which unit vector it slides: (1,) or (-1,) in the plane."""

    kind: Kind
    along: tuple[float, ...] = ()

    @property
    def shown(self) -> str:
        """The state as the answer of the product calls it."""
        return "slide back" if self.kind is Kind.SLIDE and self.along == (-1.0,) else self.kind.value


OPEN, CLOSED, STICK = Mode(Kind.OPEN), Mode(Kind.CLOSED), Mode(Kind.STICK)


PROGRAMME = 5
"""Evaluations of accelerations that take as long as a linear programme."""


def sticks_more(other: Sequence[Mode], one: Sequence[Mode]) -> bool:
    """Return whether other states differ only in that something sticks where here it slides."""
    pairs = list(zip(other, one, strict=True))
    return any(a != b for a, b in pairs) and all(
        a == b or (a.kind is Kind.STICK and b.kind is Kind.SLIDE) for a, b in pairs
    )


class Inconsistent(Exception):
    """No accelerations go with these states."""


@dataclass(frozen=True)
class Solution:
    """Accelerations, and the forces of what is held, closed and sticks, in the order of the rows.

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
    normals, sticks : dict
        Where the forces of a one-sided measure are: its push, and its friction where it sticks.
    frames : dict of int to ndarray
        Unit vectors along which that friction has its components.
    slips : dict of int to ndarray
        Rates of slip of what slides.
    """

    accelerations: Floats
    forces: Floats
    free: Floats
    unique: bool
    scale: float
    columns: Floats
    normals: dict[int, int]
    sticks: dict[int, slice]
    frames: dict[int, Floats]
    slips: dict[int, Floats]


class Phase:
    """A scene while its one-sided measures keep their states.

    Parameters
    ----------
    modes : sequence of Mode
        One for each one-sided measure.
    """

    def __init__(self, mechanism: Mechanism, modes: Sequence[Mode]) -> None:
        self.mechanism, self.modes = mechanism, list(modes)
        every = mechanism.one_sided
        self.closed = [i for i, mode in enumerate(modes) if mode.kind is not Kind.OPEN]
        self.sticking = [i for i in self.closed if modes[i].kind is Kind.STICK]
        self.sliding = [i for i in self.closed if modes[i].kind is Kind.SLIDE]
        self.normals: list[OneSided] = [every[i] for i in self.closed]
        self.slips: list[OneSided] = [every[i] for i in (*self.sticking, *self.sliding)]
        # In space what slides turns the direction of its friction with it; from rest it begins along this one.
        self.along = {i: np.array(modes[i].along) for i in self.sliding}

    def rows(self, state: State) -> tuple[Rows, dict[int, int], dict[int, slice], int]:
        """Return all rows, where the normal and the slip of each closed measure are, and how many rows hold."""
        rows = self.mechanism.rows(state, self.normals, self.slips)
        total = len(rows.rates)
        widths = [one.slips for one in self.slips]
        start = total - sum(widths)
        slips: dict[int, slice] = {}
        for i, width in zip((*self.sticking, *self.sliding), widths, strict=True):
            slips[i] = slice(start, start + width)
            start += width
        first = total - sum(widths) - self.mechanism.rolling_rows - len(self.normals)
        normals = {i: first + k for k, i in enumerate(self.closed)}
        return rows, normals, slips, total - sum(self.mechanism.one_sided[i].slips for i in self.sliding)

    def direction(self, i: int, slip: Floats) -> Floats:
        """Return the direction in which something slides."""
        along = self.along[i]
        if len(along) == 1:
            return along
        size = float(np.linalg.norm(slip))
        # Beside rounding a slip has no direction; one that has passed through zero goes on being continued.
        return along if size < 1e-13 else slip / size * (1.0 if slip @ along >= 0.0 else -1.0)

    def turn(self, state: State) -> None:
        """Let what slides in space go on from its present direction."""
        if any(len(along) == 3 for along in self.along.values()):
            rows, _, slips, _ = self.rows(state)
            self.along = {i: self.direction(i, rows.rates[slips[i]]) for i in self.sliding}

    def solve(self, state: State) -> Solution:
        """Return accelerations and forces.

        Raises
        ------
        Inconsistent
            If there are none.
        """
        mechanism = self.mechanism
        mechanism.spend()
        rows, normals, slips, count = self.rows(state)
        first = count - sum(mechanism.one_sided[i].slips for i in self.sticking)
        lines, gains = [rows.lines[:first]], [rows.gains[:first]]
        sticks, frames, at = {}, {}, first
        for i in self.sticking:
            # A slip in space has three components, of which two are independent.
            own = rows.lines[slips[i]]
            frames[i] = np.eye(1) if len(own) == 1 else np.linalg.svd(own, full_matrices=False)[0][:, :2].T
            lines.append(frames[i] @ own)
            gains.append(frames[i] @ rows.gains[slips[i]])
            sticks[i] = slice(at, at + len(frames[i]))
            at += len(frames[i])
        held = np.concatenate(lines)
        columns = held.T.copy()
        for i in self.sliding:
            direction = self.direction(i, rows.rates[slips[i]])
            columns[:, normals[i]] -= mechanism.one_sided[i].kinetic * (direction @ rows.lines[slips[i]])
        found = solved(mechanism.inertia(state), mechanism.loads(state), held, np.concatenate(gains), columns)
        return Solution(*found, columns, normals, sticks, frames, {i: rows.rates[slips[i]] for i in self.sliding})


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
    typical = float(diagonal[diagonal > 0.0].min(initial=1.0)) if (diagonal > 0.0).any() else 1.0
    scale = 1.0 / np.sqrt(np.where(diagonal > 0.0, diagonal, typical))
    sizes = np.linalg.norm(lines * scale, axis=1)
    # A row of nothing but rounding stays small, and is no row.
    sizes[sizes < NO_ROW * sizes.max(initial=1e-300)] = sizes.max(initial=1.0)
    matrix = np.zeros((n + m, n + m))
    matrix[:n, :n] = scale[:, None] * mass * scale
    matrix[:n, n:] = -scale[:, None] * columns / sizes
    matrix[n:, :n] = lines * scale / sizes[:, None]
    right = np.concatenate([scale * loads, -gains / sizes])
    found, null = _least_squares(matrix, right)
    missed = matrix @ found - right
    size = max(float(np.abs(right).max(initial=0.0)), float(np.abs(found[:n]).max(initial=0.0)))
    if not float(np.abs(missed).max(initial=0.0)) <= CONSISTENT * size:
        raise Inconsistent
    unique = bool(np.abs(null[:, :n]).max(initial=0.0) < 1e-7)
    forces, accelerations = found[n:] / sizes, found[:n] * scale
    largest = max(
        float(np.abs(loads).max(initial=0.0)),
        float(np.abs(mass @ accelerations).max(initial=0.0)),
        float(np.abs(forces).max(initial=0.0)),
        NO_SCALE * float(np.abs(diagonal).max(initial=0.0)),
    )
    return accelerations, forces, null[:, n:] / sizes, unique, largest


def _least_squares(matrix: Floats, right: Floats) -> tuple[Floats, Floats]:
    """Return the shortest solution of least squares, and the null space as rows.

    A matrix whose condition says that no singular value is below `RANK` is solved by elimination.
    """
    if not np.isfinite(matrix).all() or not np.isfinite(right).all():
        raise Inconsistent
    if len(right):
        factors, pivots, fault = dgetrf(matrix)
        if fault == 0 and dgecon(factors, float(np.abs(matrix).sum(axis=0).max()))[0] > RANK:
            return dgetrs(factors, pivots, right)[0], np.zeros((0, len(right)))
    u, s, vt = np.linalg.svd(matrix)
    rank = int((s > RANK * s[0]).sum()) if len(s) else 0
    return vt[:rank].T @ ((u[:, :rank].T @ right) / s[:rank]), vt[rank:]


class Conditions:
    """What forces have to satisfy: pushes at least zero, friction within its cone; each relative to the scene's forces.

    Attributes
    ----------
    determined : dict of (str, int) to float
        By "push" or "cone" and the number of the measure, of forces that are determined.
    share : float or None
        Where some are not: the largest of the least of all conditions that any share of the load allows, at most 1.
    """

    def __init__(self, phase: Phase, found: Solution, among: Sequence[int] | None = None) -> None:
        self.determined: dict[tuple[str, int], float] = {}
        cones: list[Cone] = []
        loose = np.abs(found.free).max(axis=0, initial=0.0) > 1e-7 if len(found.free) else np.zeros(len(found.forces))
        for i in phase.closed if among is None else [i for i in phase.closed if i in among]:
            one, row = phase.mechanism.one_sided[i], found.normals[i]
            push = found.forces[row] / found.scale
            cone = found.sticks.get(i)
            open_to = bool(loose[row]) or (cone is not None and bool(loose[cone].any()))
            if open_to:
                cones.append(Cone(i, row, cone, one.static))
                continue
            self.determined["push", i] = push
            if cone is not None:
                rub = float(np.linalg.norm(found.forces[cone])) / found.scale
                self.determined["cone", i] = one.static * push - rub
        if cones:
            phase.mechanism.spend(PROGRAMME)
        self.share = best_share(found.forces / found.scale, found.free, cones) if cones else None
