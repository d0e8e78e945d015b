"""The motion of a table in balls: Taylor's series with a rigorous remainder.

The second derivatives of the measures turn the table into an ordinary differential equation, whose Taylor coefficients
follow from one another as in `motion.series`. A step first finds a box that the motion does not leave: by
Picard and Lindelof, any box that the integral of the equation maps into itself (R. E. Moore). The coefficient of the
first order that is left out, taken over the whole box, bounds the remainder of Lagrange. Radii grow from step to step
by what the boxes overestimate, which bits pay for: a motion is proven for some seconds, not for long.

References
----------
R. E. Moore, R. B. Kearfott, M. J. Cloud, Introduction to Interval Analysis, SIAM 2009, sections 9.3 and 9.4.
N. S. Nedialkov, K. R. Jackson, G. F. Corliss, "Validated solutions of initial value problems for ordinary differential
equations", Applied Mathematics and Computation 105 (1999).
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from operator import mul

from flint import arb, arb_mat, ctx

from core.balls import Undetermined, precision
from core.errors import BudgetExceeded
from core.multibody.algebra.polynomials import ZERO, Ball, Poly, evaluated
from core.multibody.motion.motion import BallState
from core.multibody.table.table import Table
from core.work import spend

MOST_STEPS = 400
"""Steps that a motion may take on either side of the start."""
MOST_WORK = 9e7
"""The same times the square of its unknowns and of their order: some twenty seconds."""
_FAST_BITS = 1000
"""Precision from which on a product takes longer in proportion to the square of its bits, about."""
_PROBE_BITS = 100
"""Precision of the step that shows how far a motion can be proven: its length hardly depends on the precision."""
_WORK_OF_A_STEP = 3_000
"""Units of work (`core.work`) of a step."""

_ORDERS = 0.35
"""Orders of a step for each bit of the precision: more would be as costly, in fewer steps."""
_SPARE = 24
"""Bits that the truncation of a step may lose beside rounding."""

_SHORTENINGS = 60
"""How often a step is shortened by 0.7 until it encloses its motion: down to 5e-10 of what the last order allows."""

Vector = list[Ball]


class ProvenSeries:
    """A table, of whose rows those `chosen` are independent, and the directions of which turns are counted."""

    def __init__(self, table: Table, chosen: Sequence[int], directions: Sequence[Poly] = ()) -> None:
        self.table, self.rows = table, [table.rows[r] for r in chosen]
        self.directions = directions
        self.count = len(table.names)

    def states(self, times: Sequence[Ball]) -> list[BallState]:
        """Return the states at times in any order.

        Raises
        ------
        Undetermined
            Where the precision does not suffice.
        BudgetExceeded
            Where it would take more steps than allowed.
        """
        found: dict[int, BallState] = {}
        for way in (1, -1):
            numbers = [k for k, t in enumerate(times) if (t >= 0 if way > 0 else t < 0)]
            self._march(way, sorted(((times[k] * way, k) for k in numbers), key=lambda pair: float(pair[0])), found)
        return [found[k] for k in range(len(times))]

    @property
    def most(self) -> int:
        """Steps that the motion may take at the present precision."""
        unknowns = max(1, self.count + len(self.rows))
        return min(MOST_STEPS, int(MOST_WORK / (unknowns * _order() * max(1.0, ctx.prec / _FAST_BITS)) ** 2))

    def _require_reachable(self, way: int, end: float) -> None:
        """Raise `BudgetExceeded` where the first step shows that a motion cannot be proven up to a time."""
        most = self.most
        with precision(_PROBE_BITS):
            start = self.table.q, self.table.v
            try:
                h, _ = self._tail(*start, self._coefficients(*start, _order()), _order(), way, math.inf)
            except Undetermined:
                return
        if not 2 * most * float(h) >= end:
            raise self._too_long(0.25 * float(h) * most, end, most)

    def _march(self, way: int, wanted: Sequence[tuple[Ball, int]], found: dict[int, BallState]) -> None:
        q, v, start, path = list(self.table.q), list(self.table.v), ZERO, [list(self.table.q)]
        order, most = _order(), self.most
        waiting, steps = list(wanted), 0
        if waiting:
            self._require_reachable(way, float(waiting[-1][0]))
        while waiting:
            spend(_WORK_OF_A_STEP)
            series = self._coefficients(q, v, order)
            # Steps may become longer, but where twice as many are needed they do not become long enough.
            least = float(waiting[-1][0] - start) / (2 * most - steps)
            h, tail = self._tail(q, v, series, order, way, least)
            if not tail:
                # Later steps are shorter, the more so the more digits are lost on the way.
                reach = float(start) + 0.25 * float(h) * (most - steps)
                raise self._too_long(reach, float(waiting[-1][0]), most)
            steps += 1
            if steps > most:
                raise self._too_long(float(start), float(waiting[-1][0]), steps)
            while waiting and not waiting[0][0] > start + h:
                time, k = waiting.pop(0)
                found[k] = BallState(*_at(series, tail, way * (time - start), order), path)
            q, v = _at(series, tail, way * h, order)
            start, path = start + h, [*path, q]

    def _too_long(self, reach: float, end: float, steps: int) -> BudgetExceeded:
        """Return the refusal of a motion of which so many steps reach to about some time (s) before its end."""
        times = f"for times up to about {reach:.2g} s, " if reach > 0.0 else ""
        remedy = f"ask {times}for fewer digits, or for an answer that is measured against pairs: POST /v1/scenes"
        needed = math.ceil(steps * end / reach) if reach > 0.0 else 1
        return BudgetExceeded("proven steps", max(needed, self.most + 1), self.most, path=("times",), remedy=remedy)

    def _tail(
        self, q: Vector, v: Vector, series: list[Vector], order: int, way: int, least: float
    ) -> tuple[Ball, list[Vector]]:
        """Return the length of a step, a double, and the coefficients of the order left out over all of it.

        There are none if the step is shorter than `least`.
        """
        small = arb(2) ** (_SPARE - ctx.prec)
        size = max((float(abs(x).upper()) for x in (*q, *v)), default=0.0) or 1.0
        last = max((float(abs(x[order]).upper()) for x in series), default=0.0)
        h = float((small * size / last) ** (arb(1) / order)) if last > 0.0 else 1e3
        for _ in range(_SHORTENINGS):
            if not 0.0 < h < math.inf:
                return arb(0), []
            step = arb(h)
            box = self._box(q, v, step * way)
            if box is not None:
                try:
                    tail = self._coefficients(*box, order + 1)
                except ZeroDivisionError:
                    tail = []
                left = [x[order + 1] * step ** (order + 1) for x in tail]
                if tail and all(float(abs(x).upper()) <= 64 * size * float(small) for x in left):
                    return step, tail if h >= least else []
            h = float(f"{0.7 * h:.3g}")
        raise Undetermined

    def _box(self, q: Vector, v: Vector, step: Ball) -> tuple[Vector, Vector] | None:
        """Return a box of places and rates that the motion does not leave during a step, None if none is found."""
        whole = step * arb(0.5, 0.5)
        try:
            gain = self._accelerations(q, v)
            for _ in range(8):
                fast = [x + whole * _wider(a) for x, a in zip(v, gain, strict=True)]
                far = [x + whole * _wider(y) for x, y in zip(q, fast, strict=True)]
                gain = self._accelerations(far, fast)
                held = all(y.contains(x + whole * a) for x, y, a in zip(v, fast, gain, strict=True)) and all(
                    y.contains(x + whole * w) for x, y, w in zip(q, far, fast, strict=True)
                )
                if held:
                    turned = (
                        abs(step * sum((x * fast[key[0]] for key, x in c.items() if key), ZERO))
                        for c in self.directions
                    )
                    return (far, fast) if all(x < 1 for x in turned) else None
        except ZeroDivisionError:
            pass
        return None

    def _accelerations(self, q: Vector, v: Vector) -> Vector:
        return [2 * x[2] for x in self._coefficients(q, v, 2)]

    def _coefficients(self, q0: Vector, v0: Vector, order: int) -> list[Vector]:
        """Return the Taylor coefficients of every coordinate, up to an order."""
        table, n, m = self.table, self.count, len(self.rows)
        q, v = [[x, y] for x, y in zip(q0, v0, strict=True)], [[y] for y in v0]
        lines = [
            (r, j, poly, [evaluated(poly, q0)]) for r, row in enumerate(self.rows) for j, poly in row.rates.items()
        ]
        drags = [(r, j, poly, [evaluated(poly, q0)]) for r, row in enumerate(self.rows) for j, poly in row.drag.items()]
        matrix = [[ZERO] * (n + m) for _ in range(n + m)]
        for (i, j), x in table.mass.items():
            matrix[i][j] = matrix[j][i] = x
        for r, j, _, w in lines:
            matrix[n + r][j] = w[0]
        for r, j, _, w in (*lines, *drags):
            matrix[j][n + r] = matrix[j][n + r] - w[0]
        inverse = arb_mat(matrix).inv() if matrix else None
        pushes: list[Vector] = [[] for _ in range(m)]
        for k in range(order - 1):
            for _, _, poly, w in (*lines, *drags):
                w.append(sum((x * q[key[0]][k + 1] for key, x in poly.items() if key), ZERO))
            right = [ZERO] * (n + m)
            if k == 0:
                for i, x in table.load.items():
                    right[i] = x
            for (i, j), x in table.stiffness.items():
                right[i] = right[i] - x * q[j][k]
            for (i, j), x in table.damping.items():
                right[i] = right[i] - x * v[j][k]
            for (i, j, other), x in table.gyration.items():
                right[i] = right[i] + x * _product(q[j], v[other], k)
            for r, j, _, w in (*lines, *drags):
                if k:
                    right[j] = right[j] + sum(map(mul, w[1 : k + 1], reversed(pushes[r])), ZERO)
            for r, j, _, w in lines:
                right[n + r] = right[n + r] - (k + 1) * sum(map(mul, w[1 : k + 2], reversed(v[j])), ZERO)
            assert inverse is not None
            solved = (inverse * arb_mat([[x] for x in right])).entries()
            for i in range(n):
                q[i].append(solved[i] / ((k + 1) * (k + 2)))
                v[i].append(solved[i] / (k + 1))
            for r in range(m):
                pushes[r].append(solved[n + r])
        return q


def _order() -> int:
    """Return the order of a step at the present precision."""
    return max(12, int(_ORDERS * ctx.prec))


def _product(first: Vector, second: Vector, k: int) -> Ball:
    """Return a coefficient of a product of series."""
    return sum(map(mul, first[: k + 1], reversed(second[: k + 1])), ZERO)


def _wider(ball: Ball) -> Ball:
    """Return a ball somewhat larger, so that a box that is nearly mapped into itself is."""
    return ball + arb(0, 1.5 * float(ball.rad()) + 0.1 * float(abs(ball).upper()) + 1e-300)


def _at(series: list[Vector], tail: list[Vector], t: Ball, order: int) -> tuple[Vector, Vector]:
    """Return places and rates at a time within a step."""
    q, v = [], []
    for known, left in zip(series, tail, strict=True):
        place, rate = left[order + 1], (order + 1) * left[order + 1]
        for k in range(order, -1, -1):
            place = place * t + known[k]
        for k in range(order, 0, -1):
            rate = rate * t + k * known[k]
        q.append(place)
        v.append(rate)
    return q, v
