"""Whether a load may be shared admissibly, as conditions in which the share has no part.

Where rigid bodies leave forces open, what has to be at least zero depends on the share: c_k + g_k.x with x free. By
Farkas' lemma an x with which all of it holds exists if and only if every sum with weights y_k >= 0 from which x
cancels is at least zero. The sums from which all others follow are found by eliminating one component of x after
another; each of them is a combination of forces that is the same whatever the share, and may be followed in time.

References
----------
A. Schrijver, "Theory of Linear and Integer Programming" (1986), sections 7.3 and 12.2 (Fourier, Motzkin).
S. N. Chernikov, "The solution of linear programming problems by elimination of unknowns", Doklady 139 (1961): which of
the sums follow from others.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence

from core.errors import BudgetExceeded
from core.multibody.algebra.polynomials import ONE, Ball, is_zero

MOST_SUMS_AT_A_TIME = 2000
"""Sums at a time: eight places of a bar that all stick need some hundred."""

Weights = dict[int, Ball]
"""Weights above zero, by the number of a condition."""


def certificates(slopes: Sequence[Mapping[int, Ball]]) -> list[Weights]:
    """Return the least sums of conditions that do not depend on what is free.

    Parameters
    ----------
    slopes : sequence of mapping
        By how much each condition changes with each free unknown.

    Raises
    ------
    BudgetExceeded
        For more sums than `MOST_SUMS_AT_A_TIME`.
    """
    sums: list[tuple[Weights, dict[int, Ball]]] = [
        ({k: ONE}, {f: x for f, x in slope.items() if not is_zero(x)}) for k, slope in enumerate(slopes)
    ]
    left = {f for _, slope in sums for f in slope}
    while left:
        f = min(left, key=lambda f: (_pairs(sums, f), f))
        left.remove(f)
        above = [one for one in sums if f in one[1] and one[1][f] > 0]
        below = [one for one in sums if f in one[1] and one[1][f] < 0]
        sums = [one for one in sums if f not in one[1]]
        if len(sums) + len(above) * len(below) > MOST_SUMS_AT_A_TIME:
            raise BudgetExceeded(
                "ways in which a load may be shared between contacts",
                len(sums) + len(above) * len(below),
                MOST_SUMS_AT_A_TIME,
                path=("connections",),
                remedy="let fewer places stick at once",
            )
        sums = _least([*sums, *(_cancelled(first, second, f) for first in above for second in below)])
    return [weights for weights, _ in sums]


def _pairs(sums: Sequence[tuple[Weights, dict[int, Ball]]], f: int) -> int:
    """Return how many sums more there are once an unknown is eliminated."""
    above = sum(1 for _, slope in sums if f in slope and slope[f] > 0)
    below = sum(1 for _, slope in sums if f in slope and slope[f] < 0)
    return above * below - above - below


def _cancelled(
    first: tuple[Weights, dict[int, Ball]], second: tuple[Weights, dict[int, Ball]], f: int
) -> tuple[Weights, dict[int, Ball]]:
    """Return the sum of two in which an unknown cancels."""
    x, y = -second[1][f], first[1][f]
    total = x + y
    x, y = x / total, y / total
    combined: list[dict[int, Ball]] = []
    for a, b in zip(first, second, strict=True):
        part = {k: x * value for k, value in a.items()}
        for k, value in b.items():
            part[k] = part[k] + y * value if k in part else y * value
        combined.append(part)
    weights, slope = combined
    return weights, {k: value for k, value in slope.items() if k != f and not is_zero(value)}


def _least(sums: Sequence[tuple[Weights, dict[int, Ball]]]) -> list[tuple[Weights, dict[int, Ball]]]:
    """Return the sums of which none consists of some of another's conditions: the others follow from them."""
    kept: list[tuple[frozenset[int], tuple[Weights, dict[int, Ball]]]] = []
    for one in sorted(sums, key=lambda one: len(one[0])):
        support = frozenset(one[0])
        if not any(other <= support for other, _ in kept):
            kept.append((support, one))
    return [one for _, one in kept]
