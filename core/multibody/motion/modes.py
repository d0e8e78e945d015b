"""Linear equations with constant coefficients: q'' = a - A q - C q', in closed form by their characteristic roots.

Without damping the squares of the roots are those of -A alone, which is half as large. The roots are enclosed as balls;
where they are distinct the motion is a sum over them, about the equilibrium. Where some are not, or there is no
equilibrium, the motion is a sum over those of the first-order system of x = (q, q', 1) without what stays zero, and at
last x(t) = exp(Bt) x_0 by the exponential of its matrix B. All errors are proven.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, field
from functools import cached_property
from typing import Any

import numpy as np
from flint import acb, acb_mat, arb, arb_mat, ctx

from core.arrays import Floats, largest_magnitude
from core.balls import precision
from core.multibody.algebra.characteristic_roots import roots_but_zero
from core.multibody.algebra.polynomials import BITS, ONE, ZERO, Ball, Poly, degree, entry, is_zero
from core.multibody.algebra.spectrum import spectrum
from core.multibody.equations.packed import pair
from core.multibody.motion.motion import BallState, ElementaryTerm, Mode, Motion, States
from core.multibody.motion.turning import FEW_RADIANS
from core.multibody.table.table import Table
from core.work import spend

_UNITS_OF_ROOTS = 0.4
"""Units of work (`core.work`) for characteristic roots, times the cube of their number."""
_BITS = 192
"""Bits of sums over modes, and multiples of it where modes grow: those of pairs, and 86 that cancellation may take."""

MOST_CANCELLED = 64.0
"""How much larger the terms of a sum over modes may be than the start that they add up to, where doubles have to do."""


@dataclass(frozen=True)
class Modes(Motion):
    """A linear part.

    Attributes
    ----------
    matrix : list of lists of balls
        Of the first-order system of (q, v, 1).
    """

    table: Table
    matrix: list[list[Ball]]
    name: str = "modes"
    why: str = "the geometry is linear and the forces are linear in places and velocities"
    how: str = "closed form"
    _known: dict[int | str, Any] = field(default_factory=dict, repr=False)

    @classmethod
    def of(cls, table: Table, chosen: Sequence[int]) -> Modes:
        """Return the linear system of a table with constant rows."""
        n, m = len(table.names), len(chosen)
        entries = [[ZERO] * (n + m) for _ in range(n + m)]
        for (i, j), value in table.mass.items():
            entries[i][j] = entries[j][i] = value
        for k, r in enumerate(chosen):
            for j, value in table.rows[r].line(table.q).items():
                entries[n + k][j] = value
            for j, value in table.rows[r].pushed(table.q).items():
                entries[j][n + k] = -value
        # Columns: the response to K, to D and to the constant load, all at once.
        right = [[ZERO] * (2 * n + 1) for _ in range(n + m)]
        for (i, j), value in table.stiffness.items():
            right[i][j] = right[i][j] - value
        for (i, j), value in table.damping.items():
            right[i][n + j] = right[i][n + j] - value
        for i, value in table.load.items():
            right[i][2 * n] = value
        response = arb_mat(entries).solve(arb_mat(right)).tolist()[:n]
        size = 2 * n + 1
        matrix = [[ONE if j == n + i else ZERO for j in range(size)] for i in range(n)]
        matrix.extend([list(row) for row in response])
        matrix.append([ZERO] * size)
        return cls(table, matrix)

    @cached_property
    def _undamped(self) -> bool:
        """Whether the squares of its roots are real: there is no damping, and what pulls has a potential."""
        pulls = self.table.stiffness
        return not self.table.damping and all(is_zero(x - entry(pulls, (j, i))) for (i, j), x in pulls.items())

    def _spectrum(self) -> tuple[list[Any], Any] | None:
        """Return roots and vectors of A, negative, or with damping of the homogeneous first-order system."""
        # One suffices for all that is rounded to pairs.
        with precision(max(BITS, ctx.prec)):
            key = f"spectrum {ctx.prec}"
            if key not in self._known:
                n = len(self.table.names)
                rows = self.matrix[n : 2 * n] if self._undamped else self.matrix[: 2 * n]
                columns = n if self._undamped else 2 * n
                self._known[key] = spectrum(arb_mat([row[:columns] for row in rows]))
            return self._known[key]  # type: ignore[no-any-return]

    def _roots(self) -> list[Any] | None:
        found = self._spectrum()
        if found is None:
            return None
        squares = [acb(x) for x in found[0]]
        return [sign * x.sqrt() for x in squares for sign in (1, -1)] if self._undamped else squares

    @property
    def is_faster_in_doubles(self) -> bool:
        """Whether it is a sum over modes whose terms do not cancel."""
        return len(self._terms_in_doubles([*self.table.q, *self.table.v, ONE])[0]) > 0

    @cached_property
    def modes(self) -> tuple[Mode, ...]:
        """The characteristic roots of the motion about its equilibrium, slowest first; () where they are not found."""
        roots = self._roots()
        if roots is None:
            n = len(self.table.names)
            inner = acb_mat([row[: 2 * n] for row in self.matrix[: 2 * n]])
            spend(_UNITS_OF_ROOTS * (2 * n) ** 3)
            try:
                roots = inner.eig(multiple=True)
            except ValueError:
                try:
                    roots = roots_but_zero(inner)
                except ValueError:
                    return ()
        found = []
        for root in roots:
            swings, grows = not is_zero(root.imag), not is_zero(root.real)
            if (swings and root.imag < 0) or not (swings or grows):
                continue
            found.append((float(root.imag) if swings else 0.0, float(root.real), Mode(root.imag, root.real)))
        return tuple(mode for *_, mode in sorted(found, key=lambda entry: entry[:2]))

    @property
    def period(self) -> Ball | None:
        """The period, where a single undamped mode is all that moves."""
        modes = self.modes
        if len(modes) == 1 and is_zero(modes[0].growth) and modes[0].frequency > 0 and self._bounded:
            return 2 * arb.pi() / modes[0].frequency
        return None

    @property
    def _bounded(self) -> bool:
        return 2 * len(self.modes) == 2 * len(self.table.names)

    def states(self, times: Floats, *, finer: bool = False) -> States:
        """Return the states, enclosed by balls and rounded to pairs."""
        n = len(self.table.names)
        start = [*self.table.q, *self.table.v, ONE]
        q, v = np.empty((len(times), n, 2)), np.empty((len(times), n, 2))
        errors = np.empty((len(times), 2 * n))
        largest = largest_magnitude(times)
        size = max((float(abs(x)) for row in self.matrix for x in row), default=1.0)
        growth = math.log2(1.0 + size * largest) if size * largest < 1e300 else 1000.0
        # In whole steps, so that other times and bounds find the same roots.
        with precision(min(BITS, _BITS * (1 + (159 + int(growth)) // _BITS))):
            terms = self._terms(start)
            for s, t in enumerate(times):
                # A sum over modes would make a width of the zeros of the start.
                values = start if t == 0.0 else self._at(arb(float(t)), start, terms)
                for i in range(n):
                    q[s, i], v[s, i] = pair(values[i], 0), pair(values[n + i], 0)
                errors[s] = [float(x.rad()) + 2.0**-104 * abs(float(x)) for x in values[: 2 * n]]
        return States(q, v, errors[:, :n], errors[:, n:])

    def in_balls(self, times: Sequence[Ball]) -> list[BallState]:
        """Return the states at each time."""
        start, n = [*self.table.q, *self.table.v, ONE], len(self.table.q)
        terms = self._terms(start)
        return [BallState(x[:n], x[n : 2 * n]) for x in (self._at(t, start, terms) for t in times)]

    def elementary(self) -> list[list[ElementaryTerm]] | None:
        """Return the coordinates as sums over modes, None where roots coincide."""
        terms = self._terms([*self.table.q, *self.table.v, ONE])
        if terms is None:
            return None
        found: list[list[ElementaryTerm]] = [[] for _ in self.table.q]
        for root, column in terms:
            growth, frequency = acb(root).real, acb(root).imag
            for own, x in zip(found, column, strict=False):
                own.append(ElementaryTerm(acb(x).real, 0, growth, frequency))
                own.append(ElementaryTerm(-acb(x).imag, 0, growth, frequency, sine=True))
        return found

    def _terms(self, start: list[Ball]) -> Any:
        """Return roots and their vector coefficients, or None where roots coincide.

        Of two roots that are conjugate, as their coefficients are, one stands for both, with twice its coefficients.
        """
        if ctx.prec not in self._known:
            self._known[ctx.prec] = self._new_terms(start)
        return self._known[ctx.prec]

    def _new_terms(self, start: list[Ball]) -> Any:
        return self._about_equilibrium(start) or self._of_first_order(start)

    def _about_equilibrium(self, start: list[Ball]) -> Any:
        """Return the terms by the spectrum, None without one or where nothing pulls a mode back that a load pushes."""
        found = self._spectrum()
        if found is None:
            return None
        squares, vectors = found
        n, matrices = len(self.table.names), type(vectors)
        loads = [row[-1] for row in self.matrix]
        if self._undamped:
            given = [[start[i], start[n + i], loads[n + i]] for i in range(n)]
        else:
            given = [[start[i], ZERO, loads[i]] for i in range(2 * n)]
        weights = vectors.solve(matrices(given)).tolist()
        columns = vectors.transpose().tolist()
        middle, terms = [acb(0)] * n, []
        for root, column, (place, rate, load) in zip(squares, columns, weights, strict=True):
            if 0 in acb(root).real and 0 in acb(root).imag:
                return None
            away = -load / root
            middle = [x + y * away for x, y in zip(middle, column[:n], strict=True)]
            for value, weight in self._swings(root, place - away, rate):
                places = [x * weight for x in column[:n]]
                terms.append((value, [*places, *(value * x for x in places), acb(0)]))
        return [(acb(0), [*middle, *[acb(0)] * n, acb(1)]), *terms]

    def _swings(self, root: Any, place: Any, rate: Any) -> list[tuple[Any, Any]]:
        """Return the roots that belong to one of the spectrum and their weights, one of two that are conjugate."""
        if not self._undamped:
            root = acb(root)
            if root.imag < 0:
                return []
            return [(root, place if root.imag == 0 else 2 * place)]
        if root < 0:
            frequency = (-root).sqrt()
            return [(acb(0, frequency), acb(place, -rate / frequency))]
        growth = root.sqrt()
        return [(acb(sign * growth), acb(place + sign * rate / growth) / 2) for sign in (1, -1)]

    def _of_first_order(self, start: list[Ball]) -> Any:
        """Return the terms by the first-order system, None where its roots coincide or are too little known."""
        seen = self._seen(start)
        inner = acb_mat([[self.matrix[i][j] for j in seen] for i in seen])
        spend(_UNITS_OF_ROOTS * len(seen) ** 3)
        try:
            roots, vectors = inner.eig(right=True)
            weights = vectors.solve(acb_mat([[acb(start[i])] for i in seen])).entries()
        except (ValueError, ZeroDivisionError):
            return None
        table = vectors.tolist()
        columns = [[acb(0)] * len(start) for _ in roots]
        for a, i in enumerate(seen):
            for k, column in enumerate(columns):
                column[i] = table[a][k] * weights[k]
        if any(x.rad() > 1e-20 * (1 + abs(x)) for column in columns for z in column for x in (z.real, z.imag)):
            return None
        above, below = sum(root.imag > 0 for root in roots), sum(root.imag < 0 for root in roots)
        if above != below:
            return list(zip(roots, columns, strict=True))
        twice = [(root, [2 * x for x in column]) for root, column in zip(roots, columns, strict=True) if root.imag > 0]
        return twice + [
            (root, column) for root, column in zip(roots, columns, strict=True) if not (root.imag > 0 or root.imag < 0)
        ]

    def _seen(self, start: list[Ball]) -> list[int]:
        """Return what is not zero for ever: what stays zero would only make the root zero multiple."""
        seen = {i for i, x in enumerate(start) if not is_zero(x)}
        while True:
            more = {i for i, row in enumerate(self.matrix) if any(not is_zero(row[j]) for j in seen)} - seen
            if not more:
                return sorted(seen)
            seen |= more

    def _at(self, t: Ball, start: list[Ball], terms: Any) -> list[Ball]:
        if terms is None:
            return (arb_mat(self.matrix) * t).exp().__mul__(arb_mat([[x] for x in start])).entries()  # type: ignore[no-any-return]
        total = acb_mat([[(root * t).exp() for root, _ in terms]]) * acb_mat([column for _, column in terms])
        return [x.real for x in total.entries()]

    def in_doubles(self, times: Floats) -> tuple[Floats, Floats] | None:
        """Return coordinates and rates in doubles, None where roots coincide or have turned far."""
        n, start = len(self.table.names), [*self.table.q, *self.table.v, ONE]
        roots, columns = self._terms_in_doubles(start)
        turned = np.max(np.abs(roots), initial=0.0) * np.max(np.abs(times), initial=0.0)
        if not len(roots) or turned > FEW_RADIANS:
            return None
        values = (np.exp(np.outer(times, roots)) @ columns).real
        return values[:, :n], values[:, n : 2 * n]

    def _terms_in_doubles(self, start: list[Ball]) -> tuple[Any, Any]:
        """Return roots and their vector coefficients in doubles, none where roots coincide or terms cancel."""
        if "doubles" not in self._known:
            with precision(_BITS):
                terms = self._terms(start) or []
            roots = np.array([complex(root) for root, _ in terms], dtype=np.complex128)
            columns = np.array([[complex(x) for x in column] for _, column in terms], dtype=np.complex128)
            largest = max((abs(float(x)) for x in start), default=1.0)
            if len(terms) and np.max(np.abs(columns)) > MOST_CANCELLED * largest:
                roots = roots[:0]
            self._known["doubles"] = roots, columns.reshape(-1, len(start))
        return self._known["doubles"]  # type: ignore[no-any-return]

    def keeps_positive(self, length: Poly) -> bool:
        """Return whether the amplitudes of the modes show it."""
        return self.lowest(length) > 0.0

    def lowest(self, poly: Poly) -> float:
        """Return what an affine polynomial of the coordinates is never below, minus infinity without a bound."""
        if degree(poly) > 1:
            return -math.inf
        start = [*self.table.q, *self.table.v, ONE]
        with precision(_BITS):
            terms = self._terms(start)
        if terms is None or any(root.real > 0 for root, _ in terms if not is_zero(root.real)):
            return -math.inf
        total = entry(poly, ())
        for root, column in terms:
            part = sum((x * column[key[0]] for key, x in poly.items() if key), acb(0))
            total = total + part.real if 0 in root.real and 0 in root.imag else total - abs(part)
        return float(total.lower())
