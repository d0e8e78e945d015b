"""Every condition of order of the coefficients, for all rooted trees, in rational arithmetic.

A method is of order p if sum b_i Phi_i(t) = 1/gamma(t) for every rooted tree t of at most p nodes (Butcher; E. Hairer,
S. P. Nørsett, G. Wanner, Solving Ordinary Differential Equations I, theorem II.2.13), an interpolant if the same sum is
theta^|t|/gamma(t) for all theta. The coefficients are doubles: each product of n of them is off by at most n u of
itself, u = 2^-53, and the conditions by no more than the sum of that over their terms.
"""

from __future__ import annotations

from collections.abc import Iterator
from fractions import Fraction
from functools import cache
from itertools import combinations_with_replacement

import pytest

from core.systems.methods.dormand_prince_tableau import ERROR_3, ERROR_5, INTERPOLANT, STAGES, A, B, C

U = Fraction(2) ** -53
Tree = tuple  # of its branches, each a tree

ROWS = [[(j, Fraction(float(x))) for j, x in enumerate(row) if x] for row in A]
NODES = [Fraction(float(x)) for x in C]


@cache
def trees(order: int) -> tuple[Tree, ...]:
    """Return the rooted trees of so many nodes, each once: 1, 1, 2, 4, 9, 20, 48, 115 of them."""
    return tuple(_forests(order - 1, order - 1))


def _forests(nodes: int, largest: int) -> Iterator[Tree]:
    """Yield all collections of trees of at most `largest` nodes each, so many nodes together."""
    if nodes == 0:
        yield ()
    for size in range(min(nodes, largest), 0, -1):
        for count in range(1, nodes // size + 1):
            for chosen in combinations_with_replacement(trees(size), count):
                for rest in _forests(nodes - size * count, min(size - 1, nodes - size * count)):
                    yield (*chosen, *rest)


def nodes_of(tree: Tree) -> int:
    return 1 + sum(nodes_of(branch) for branch in tree)


@cache
def density(tree: Tree) -> int:
    """gamma(t): the product over all nodes of the size of what hangs on them."""
    out = nodes_of(tree)
    for branch in tree:
        out *= density(branch)
    return out


@cache
def weights(tree: Tree, stages: int) -> tuple[tuple[Fraction, Fraction], ...]:
    """Return Phi_i(t) for every stage, and the same with all coefficients positive."""
    out = []
    for i in range(stages):
        value = size = Fraction(1)
        for branch in tree:
            inner = weights(branch, stages)
            value *= sum((a * inner[j][0] for j, a in ROWS[i] if j < stages), Fraction(0))
            size *= sum((abs(a) * inner[j][1] for j, a in ROWS[i] if j < stages), Fraction(0))
        out.append((value, size))
    return tuple(out)


def off(b: list[Fraction], tree: Tree, want: Fraction) -> Fraction:
    """Return by how much a condition is missed, as a share of what rounding the coefficients explains."""
    found = weights(tree, len(b))
    value = sum(x * phi for x, (phi, _) in zip(b, found, strict=True))
    size = sum(abs(x) * phi for x, (_, phi) in zip(b, found, strict=True))
    return abs(value - want) / (nodes_of(tree) * U * size)


def exact(row) -> list[Fraction]:
    return [Fraction(float(x)) for x in row]


def test_there_are_as_many_trees_as_there_should_be() -> None:
    assert [len(trees(n)) for n in range(1, 9)] == [1, 1, 2, 4, 9, 20, 48, 115]
    assert all(len(set(trees(n))) == len(trees(n)) for n in range(1, 9))


def test_row_sums_are_the_nodes() -> None:
    for row, node in zip(ROWS, NODES, strict=True):
        size = sum((abs(a) for _, a in row), Fraction(0))
        assert abs(sum((a for _, a in row), Fraction(0)) - node) <= U * (size + node)


@pytest.mark.parametrize("order", range(1, 9))
def test_all_conditions_up_to_order_eight(order: int) -> None:
    for tree in trees(order):
        assert off(exact(B), tree, Fraction(1, density(tree))) <= 1


def test_order_nine_is_not_reached() -> None:
    missed = [off(exact(B), tree, Fraction(1, density(tree))) for tree in trees(9)]
    assert max(missed) > 10**6


@pytest.mark.parametrize(("row", "order"), [(ERROR_5, 5), (ERROR_3, 3)])
def test_estimates_vanish_up_to_their_order_and_no_further(row, order: int) -> None:
    """The estimate is the difference to a formula of that order: both fulfil the conditions alike."""
    for n in range(1, order + 1):
        for tree in trees(n):
            assert off(exact(row), tree, Fraction(0)) <= 1
    assert max(off(exact(row), tree, Fraction(0)) for tree in trees(order + 1)) > 10**6


def interpolating(theta: Fraction) -> list[Fraction]:
    """Return the weights of the sixteen stages at theta.

    The interpolant is y + th (d + t1 (s + th (r + t1 (f0 + th (f1 + t1 (f2 + th f3)))))), t1 = 1 - th, in which
    d = y1 - y, s = h k_1 - d, r = d - h k_13 - s (Hairer, Nørsett, Wanner, section II.6).
    """
    other = 1 - theta
    d = [*exact(B), *4 * [Fraction(0)]]
    first, last = ([Fraction(int(j == n)) for j in range(16)] for n in (0, STAGES))
    s = [x - y for x, y in zip(first, d, strict=True)]
    r = [x - y - z for x, y, z in zip(d, last, s, strict=True)]
    out = [Fraction(0)] * 16
    for part, factor in zip((*map(exact, INTERPOLANT[::-1]), r, s, d), 4 * (theta, other), strict=False):
        out = [factor * (x + y) for x, y in zip(out, part, strict=True)]
    return out


@pytest.mark.parametrize("order", range(1, 8))
@pytest.mark.parametrize("theta", [Fraction(1, 7), Fraction(1, 2), Fraction(9, 11)])
def test_the_interpolant_is_of_order_seven(order: int, theta: Fraction) -> None:
    # Its weights are sums of eight rounded terms of sizes up to 500.
    rounded = 8 * 600 * U
    for tree in trees(order):
        found = weights(tree, 16)
        value = sum(x * phi for x, (phi, _) in zip(interpolating(theta), found, strict=True))
        size = sum(max(abs(x), 1) * phi for x, (_, phi) in zip(interpolating(theta), found, strict=True))
        assert abs(value - theta**order / density(tree)) <= (rounded + order * U) * size


def test_the_interpolant_ends_where_the_step_does() -> None:
    assert interpolating(Fraction(1)) == [*exact(B), *4 * [Fraction(0)]]
    assert interpolating(Fraction(0)) == [Fraction(0)] * 16
