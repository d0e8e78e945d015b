"""Every zero of polynomials with planted roots, simple, double and close together, against the roots themselves."""

from __future__ import annotations

import random
from collections.abc import Iterator, Sequence
from fractions import Fraction
from functools import partial

import numpy as np
import pytest
from flint import arb

from core.arrays import Floats
from core.balls import precision
from core.multibody.algebra.polynomials import BITS
from core.multibody.search.curves import Curve
from core.multibody.search.every_zero import EveryZero
from core.multibody.search.followed import Found
from core.multibody.search.pieces import COEFFICIENTS, Pieces
from core.multibody.search.taylor import ORDER

LENGTH = 0.25
RESOLVED = Fraction(1, 2**48)
"""To which zeros are located on pieces of this length."""


@pytest.fixture(autouse=True)
def exact_numbers() -> Iterator[None]:
    with precision(BITS):
        yield


class Clock:
    """A motion whose one coordinate is the time, which another computation may get wrong."""

    def __init__(self, wrong: float = 0.0) -> None:
        self.wrong = wrong

    def __call__(self, times: Floats, reach: Floats) -> Pieces:
        lengths = np.copysign(np.minimum(LENGTH, 2.0 ** np.ceil(np.log2(np.abs(reach)))), reach)
        places = np.zeros((len(times), 1, ORDER + 1, 2))
        places[:, 0, 0, 0], places[:, 0, 0, 1], places[:, 0, 1, 0] = times, self.wrong, lengths
        nothing = np.zeros((len(times), 0, COEFFICIENTS, 2))
        sizes = np.abs(places[..., 0])
        return Pieces(lengths, np.full(len(times), LENGTH), places, sizes, nothing, nothing[..., 0])


def product(roots: Sequence[Fraction], pieces: Pieces) -> Curve:
    """Return the product of the time less each root."""
    total = pieces.nothing().plus(arb(1), Curve.constant(arb(1), pieces.shape))
    for root in roots:
        total = total.times(pieces.of({(0,): arb(1), (): -arb(root.numerator) / root.denominator}))
    return total


def zeros(roots: Sequence[Fraction], end: float, wrong: float = 0.0, way: float = 1.0) -> list[Found]:
    motions = [Clock()] if wrong == 0.0 else [Clock(), Clock(wrong)]
    return list(EveryZero(motions, [partial(product, roots)], way=way).until(end))


def require_same(found: Sequence[Found], roots: Sequence[Fraction]) -> None:
    """Require each root once, double ones as wide as they are not known."""
    once = sorted(set(roots), key=abs)
    assert len(found) == len(once)
    for one, root in zip(found, once, strict=True):
        exact = Fraction(one.time) + Fraction(one.rest)
        assert abs(exact - root) <= Fraction(one.width) + RESOLVED * max(abs(root), 1)
        if roots.count(root) % 2 == 0:
            assert one.width > 0.0
        assert one.width < 1e-9


def planted(chance: random.Random) -> list[Fraction]:
    roots = [Fraction(chance.randrange(1, 10**6), 250_000) for _ in range(chance.randrange(1, 4))]
    roots = list(dict.fromkeys(roots))
    kind = chance.randrange(4)
    if kind == 1:
        roots.append(roots[0])
    elif kind == 2:
        roots.append(roots[0] + Fraction(1, 10 ** chance.randrange(3, 11)))
    elif kind == 3:
        near = Fraction(1, 10 ** chance.randrange(3, 7))
        roots.extend([roots[0] + near, roots[0] + 2 * near])
    return roots if len(set(roots)) == len(roots) or kind == 1 else planted(chance)


@pytest.mark.parametrize("seed", range(60))
def test_planted_roots_are_found_once_each(seed: int) -> None:
    roots = planted(random.Random(seed))
    require_same(zeros(roots, 4.5), roots)
    backwards = zeros([-root for root in roots], 4.5, way=-1.0)
    require_same(backwards, [-root for root in roots])


def test_ten_zeros_within_one_piece() -> None:
    roots = [Fraction(1, 64) * Fraction(100 + k, 99) for k in range(10)]
    require_same(zeros(roots, 0.25), roots)


def test_what_is_zero_at_the_start_is_no_zero_and_what_follows_soon_is_one() -> None:
    soon = Fraction(1, 10**17)
    assert zeros([Fraction(0)], 1.0) == []
    assert zeros([Fraction(0), Fraction(0)], 1.0) == []
    (found,) = zeros([Fraction(0), soon], 1.0)
    assert abs(Fraction(found.time) + Fraction(found.rest) - soon) <= soon / 10**9


def test_a_zero_in_the_last_place_before_the_end() -> None:
    (found,) = zeros([1 - Fraction(1, 2**53)], 1.0)
    assert Fraction(found.time) + Fraction(found.rest) <= 1
    assert zeros([1 + Fraction(1, 2**20)], 1.0) == []


@pytest.mark.parametrize(("apart", "count"), [(1e-9, 2), (0.0, 1), (-1e-9, 0)])
def test_a_graze_from_both_sides(apart: float, count: int) -> None:
    """(t - 1/3)^2 less a constant."""
    middle = Fraction(1, 3)

    def quantity(pieces: Pieces) -> Curve:
        curve = product([middle, middle], pieces)
        return curve.plus(arb(-1), Curve.constant(arb(apart) ** 2 * (1 if apart > 0.0 else -1), pieces.shape))

    found = list(EveryZero([Clock()], [quantity]).until(1.0))
    assert len(found) == count
    assert [one.width > 0.0 for one in found] == ([True] if count == 1 else [False] * count)
    for one in found:
        assert (
            abs(abs(Fraction(one.time) + Fraction(one.rest) - middle) - Fraction(apart))
            <= Fraction(one.width) + RESOLVED
        )


def test_what_two_computations_do_not_tell_apart_is_one_wide_zero() -> None:
    """Two zeros 2e-12 apart, of a motion that is known to 1e-10 s only."""
    middle = Fraction(1, 3)
    near = Fraction(1, 10**12)
    (found,) = zeros([middle - near, middle + near], 1.0, wrong=1e-10)
    assert 1e-12 < found.width < 1e-4
    assert abs(Fraction(found.time) - middle) <= Fraction(found.width)


def test_zeros_of_several_quantities_come_in_their_order() -> None:
    first, second = [Fraction(1, 5), Fraction(3, 5)], [Fraction(2, 5), Fraction(4, 5)]
    found = list(EveryZero([Clock()], [partial(product, first), partial(product, second)]).until(1.0))
    assert [one.index for one in found] == [0, 1, 0, 1]
