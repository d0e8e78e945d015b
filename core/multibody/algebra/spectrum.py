"""Characteristic roots and vectors of a matrix, proven: found in doubles, refined by Newton's method, then enclosed.

With approximate vectors X, T = X^-1 A X is nearly diagonal. To first order X (1 + E) with E_ij = T_ij/(T_jj - T_ii) are
the vectors, so that every step doubles the digits. The last T, in balls, encloses: by Gershgorin's theorem roots that
are farther from one another than the rows' other entries sum up to lie one by one beside the diagonal, and Brouwer's
applied to the equation of e_i + w encloses the vectors. It takes some four solutions of linear equations, where the
QR algorithm in balls takes hundreds of times as long.

References
----------
G. H. Golub and C. F. Van Loan, *Matrix Computations*, 4th edition, sections 7.2.1 and 7.6. T. Ogita and K. Aishima,
"Iterative refinement for symmetric eigenvalue decomposition", Japan J. Indust. Appl. Math. 35 (2018).
"""

from __future__ import annotations

from typing import Any

import numpy as np
from flint import acb, acb_mat, arb, arb_mat, ctx

from core.balls import precision
from core.work import spend

_UNITS_OF_A_SPECTRUM = 0.02
"""Units of work (`core.work`), times the cube of the size, for real numbers; complex ones take four times as much."""
_RIGHT = 40
"""Bits of the vectors that are trusted to be right in doubles."""
_GUARD_OF_VECTORS = 64
"""Bits of a refinement beyond those that it makes right, for the rounding of its products."""

_ROUNDED_ROOTS = 2.0**-50
"""Four units in the last place of doubles: roots are compared as doubles, and one is rounded by half of a unit."""


def spectrum(matrix: Any) -> tuple[list[Any], Any] | None:
    """Return the roots of a square matrix of real balls, and a matrix with their vectors as columns.

    Both are real balls where all roots are real, and complex ones elsewhere. None where roots coincide, or lie too
    close to one another for doubles to tell them apart.
    """
    size = matrix.nrows()
    numbers = np.array([float(x.mid()) for x in matrix.entries()]).reshape(size, size)
    largest = np.max(np.abs(numbers), initial=0.0)
    if not 0.0 < largest < np.inf:
        return None
    try:
        found, columns = np.linalg.eig(numbers)
    except np.linalg.LinAlgError:
        return None
    real = not np.iscomplexobj(found)
    spend(_UNITS_OF_A_SPECTRUM * size**3 * (1 if real else 4))
    matrices = arb_mat if real else acb_mat
    vectors = matrices([[_exactly(x) for x in row] for row in columns.tolist()])
    matrix = matrices(matrix)
    right = _RIGHT
    try:
        while right < ctx.prec:
            right *= 2
            with precision(min(ctx.prec, right + _GUARD_OF_VECTORS)):
                nearly = vectors.solve(matrix * vectors).mid().tolist()
                vectors = (vectors + vectors * matrices(_change(nearly))).mid()
        return _enclosed(vectors, vectors.solve(matrix * vectors), matrices)
    except ZeroDivisionError:
        return None


def _exactly(number: complex) -> Any:
    return acb(number.real, number.imag) if isinstance(number, complex) else arb(number)


def _change(nearly: list[list[Any]]) -> list[list[Any]]:
    """Return E for the midpoints of T; it raises ZeroDivisionError where two roots are equal."""
    roots = [row[i] for i, row in enumerate(nearly)]
    return [
        [x * 0 if i == j else _quotient(x, roots[j] - roots[i]) for j, x in enumerate(row)]
        for i, row in enumerate(nearly)
    ]


def _quotient(x: Any, gap: Any) -> Any:
    if gap == 0:
        raise ZeroDivisionError
    return (x / gap).mid()


def _enclosed(vectors: Any, diagonalised: Any, matrices: Any) -> tuple[list[Any], Any] | None:
    """Return roots and vectors from T in balls, None where it does not tell the roots apart."""
    rows = diagonalised.tolist()
    size = len(rows)
    roots = [row[i].mid() for i, row in enumerate(rows)]
    # The radius of the diagonal counts as an entry beside it.
    beside = [sum((abs(x) for j, x in enumerate(row) if j != i), abs(row[i] - roots[i])) for i, row in enumerate(rows)]
    most = max((x.upper() for x in beside), default=arb(0))
    places = np.array([complex(float(root.real), float(root.imag)) for root in roots])
    gaps = np.abs(places[:, None] - places) - _ROUNDED_ROOTS * (np.abs(places)[:, None] + np.abs(places))
    np.fill_diagonal(gaps, np.inf)
    nearest = gaps.min(axis=1)
    if not np.all(np.isfinite(places)) or not (nearest > 8.0 * float(most)).all():
        return None
    # w_j (T_ii - T_jj) = T_ji + ... has a solution with |w_j| <= 2 most/gap.
    around = [[arb(0, (2 * most / arb(float(gap))).upper()) if size > 1 else arb(0) for gap in nearest]] * size
    if matrices is acb_mat:
        turned = [[acb(x, x) for x in row] for row in around]
        enclosed = vectors + vectors * acb_mat(turned)
        return [_around(root, most) for root in roots], enclosed
    return [root + arb(0, most) for root in roots], vectors + vectors * arb_mat(around)


def _around(root: Any, radius: Any) -> Any:
    """Return a disc as a square, on the real axis where it touches that: conjugate roots have discs of their own."""
    width = arb(0, radius)
    return acb(root.real + width, 0 if abs(root.imag) <= radius else root.imag + width)
