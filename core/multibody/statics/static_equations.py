"""The equations of rest of a table, K q - b = W(q)^T lambda with g(q) = 0, in doubles."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from core.arrays import Floats
from core.compiled import kernel
from core.multibody.equations.packed import Packed, Units, two_to
from core.multibody.reduction.reduction import Reduced
from core.multibody.table.description import Described
from core.multibody.table.frames import Frame


class StaticArrays(NamedTuple):
    """What compiled code needs of the equations.

    Attributes
    ----------
    load : ndarray, shape (n,)
    stiffness : ndarray, shape (n, n)
    lines : ndarray, shape (m, n)
        W where all coordinates are zero.
    slopes : ndarray, shape (k,)
        Derivatives of W that are not zero, ``dW[r, j]/dq[i]``.
    slope_at : ndarray, shape (k, 3)
        Their (r, j, i).
    offset : ndarray, shape (m,)
        g where all coordinates are zero.
    tie_rows : ndarray, shape (t,)
        Rows that hold the angle of a body to its direction, in place of a quadratic measure.
    tie_forms : ndarray, shape (t, 3, n + 1)
        That angle, and the cosine and sine of the direction: what multiplies the coordinates, and a constant.
    tie_starts : ndarray, shape (t, 2)
        Angle and direction at the start (rad).
    tie_factors : ndarray, shape (t,)
        Unit of the row.
    weights : ndarray, shape (n,)
        What the force of each coordinate is compared with: a light body's weight, not that of a heavy one beside it.
    touched : ndarray, shape (m, n)
        Which coordinates each row may pull.
    """

    load: Floats
    stiffness: Floats
    lines: Floats
    slopes: Floats
    slope_at: np.ndarray
    offset: Floats
    tie_rows: np.ndarray
    tie_forms: Floats
    tie_starts: Floats
    tie_factors: Floats
    weights: Floats
    touched: np.ndarray


class StaticEquations:
    """The equations of rest of a table, without the tails of its numbers.

    Parameters
    ----------
    packed : Packed

    Attributes
    ----------
    arrays : StaticArrays
    slopes : ndarray, shape (m, n, n)
        ``dW[r, j]/dq[i]``.
    """

    def __init__(self, packed: Packed) -> None:
        n, m = len(packed.load), len(packed.rate)
        mass, stiffness = packed.mass[..., 0], np.zeros((n, n))
        for (i, j), x in zip(packed.stiff_at, packed.stiff[:, 0], strict=True):
            stiffness[i, j] = x
        lines, self.slopes = np.zeros((m, n)), np.zeros((m, n, n))
        for (r, j), x in zip(packed.lines_at, packed.lines[:, 0], strict=True):
            lines[r, j] = x
        for (e, i), x in zip(packed.slopes_at, packed.slopes[:, 0], strict=True):
            r, j = packed.lines_at[e]
            self.slopes[r, j, i] = x
        # Where there is one slope only, numpy returns another layout, and kernels would be compiled for that again.
        at = np.ascontiguousarray(np.argwhere(self.slopes))
        self.arrays = StaticArrays(
            packed.load[:, 0].copy(),
            stiffness,
            lines,
            self.slopes[at[:, 0], at[:, 1], at[:, 2]],
            at,
            packed.offset[:, 0].copy(),
            np.empty(0, np.int64),
            np.empty((0, 3, n + 1)),
            np.empty((0, 2)),
            np.empty(0),
            _weights(np.diag(mass), packed.load[:, 0], stiffness),
            (lines != 0.0) | (self.slopes != 0.0).any(axis=2),
        )

    def tie(self, row: int, found: Described, small: Reduced, units: Units, frame: Frame, factor: float) -> None:
        """Let a row hold the angle of a body to its direction: its rate is that of an angle with full turns."""
        assert frame.turn is not None
        assert frame.direction is not None
        up = np.array([two_to(e) for e in units.lengths])
        forms, start = np.zeros((1, 3, len(up) + 1)), []
        for form, i in zip(forms[0], (frame.turn, *frame.direction), strict=True):
            for key, value in small.expressions[i].items():
                if key:
                    form[key[0]] = float(value) * up[key[0]]
                else:
                    form[-1] = float(value)
            start.append(float(found.measures.table.q[i]))
        now = self.arrays
        self.arrays = now._replace(
            tie_rows=np.append(now.tie_rows, row),
            tie_forms=np.append(now.tie_forms, forms, axis=0),
            tie_starts=np.append(now.tie_starts, [[start[0], float(np.arctan2(start[2], start[1]))]], axis=0),
            tie_factors=np.append(now.tie_factors, factor),
        )


def _weights(mass: Floats, load: Floats, stiffness: Floats) -> Floats:
    """Return the force on each coordinate at the largest acceleration of any, or that of its springs if larger."""
    heavy = mass > 0.0
    fastest = np.max(np.abs(load[heavy]) / mass[heavy], initial=0.0)
    own = np.maximum.reduce([mass * fastest, np.abs(load), np.abs(stiffness).max(axis=1, initial=0.0)])
    weights: Floats = np.where(own > 0.0, own, np.max(own, initial=0.0))
    return weights


@kernel()
def linearised(
    arrays: StaticArrays, q: Floats, multipliers: Floats, system: Floats, right: Floats
) -> tuple[float, float, float]:
    """Write the system whose solution is Newton's step of places and multipliers, in compiled code.

    Parameters
    ----------
    arrays : StaticArrays
    q : ndarray, shape (n,)
    multipliers : ndarray, shape (m,)
    system : ndarray, shape (n + m, n + m)
    right : ndarray, shape (n + m,)
        What the step is to end: forces left over, and measures that are not held.

    Returns
    -------
    left, terms, off : float
        The largest share that is left over of the forces on a coordinate, the size of the forces but those of the
        connections, the largest of the measures.
    """
    n, m = len(q), len(multipliers)
    system[:] = 0.0
    for r in range(m):
        for j in range(n):
            system[n + r, j] = arrays.lines[r, j]
    for k in range(len(arrays.slopes)):
        r, j, i = arrays.slope_at[k]
        system[n + r, j] += arrays.slopes[k] * q[i]
        system[j, i] += arrays.slopes[k] * multipliers[r]
    load = pull = left = off = 0.0
    for j in range(n):
        total = 0.0
        for i in range(n):
            total += arrays.stiffness[j, i] * q[i]
            system[j, i] -= arrays.stiffness[j, i]
        load, pull = max(load, abs(arrays.load[j])), max(pull, abs(total))
        right[j] = total - arrays.load[j]
        for r in range(m):
            right[j] -= multipliers[r] * system[n + r, j]
            system[j, n + r] = system[n + r, j]
    for j in range(n):
        total = arrays.weights[j]
        for r in range(m):
            if arrays.touched[r, j]:
                size = 0.0
                for i in range(n):
                    size = max(size, abs(system[n + r, i]))
                total += abs(multipliers[r]) * size
        if right[j] != 0.0:
            left = max(left, abs(right[j]) / total) if total > 0.0 else np.inf
    for r in range(m):
        right[n + r] = -arrays.offset[r]
        for j in range(n):
            right[n + r] -= 0.5 * (arrays.lines[r, j] + system[n + r, j]) * q[j]
    for t in range(len(arrays.tie_rows)):
        form = arrays.tie_forms[t]
        now, cosine, sine = form[0, n], form[1, n], form[2, n]
        for j in range(n):
            now, cosine, sine = now + form[0, j] * q[j], cosine + form[1, j] * q[j], sine + form[2, j] * q[j]
        away = (now - arrays.tie_starts[t, 0]) - (np.arctan2(sine, cosine) - arrays.tie_starts[t, 1])
        # The angle may differ from the direction by full turns: a spring that is wound up.
        right[n + arrays.tie_rows[t]] = -arrays.tie_factors[t] * (away - 2 * np.pi * np.round(away / (2 * np.pi)))
    for r in range(m):
        off = max(off, abs(right[n + r]))
    return left, load + pull, off
