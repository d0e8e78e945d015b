"""Bodies in rational numbers: every figure is compared exactly."""

from __future__ import annotations

from fractions import Fraction
from itertools import combinations

import pytest
from flint import fmpq
from hypothesis import assume, given, settings
from hypothesis import strategies as st

from core.bodies.exact import rotation
from core.bodies.exact_mass import LONGEST_LIST, ExactMass, fmpq_of, fraction_of
from core.errors import InvalidParameter, UnphysicalInertia

whole = st.integers(-9, 9)
weight = st.fractions(Fraction(1, 10), 10, max_denominator=50)
points = st.lists(st.tuples(weight, st.tuples(whole, whole, whole)), min_size=1, max_size=6)
quaternion = st.tuples(*4 * [whole]).filter(any)


def of(given_points) -> ExactMass:
    return ExactMass.of_point_masses([m for m, _ in given_points], [p for _, p in given_points])


def test_point_masses_give_their_tensor_exactly():
    # Source: sum of m (r.r 1 - r r^T) about the centre of mass, worked by hand for three masses.
    inertia = ExactMass.of_point_masses(["0.1", "0.2", "0.1"], [(0, 0, 0), (1, 0, 0), (0, 2, "0.5")]).of_motion
    center = [Fraction(1, 2), Fraction(1, 2), Fraction(1, 8)]
    points = [(Fraction(1, 10), (0, 0, 0)), (Fraction(1, 5), (1, 0, 0)), (Fraction(1, 10), (0, 2, Fraction(1, 2)))]
    for i in range(3):
        for j in range(3):
            expected = Fraction(0)
            for m, p in points:
                d = [Fraction(x) - c for x, c in zip(p, center, strict=True)]
                expected += m * ((sum(x * x for x in d) if i == j else 0) - d[i] * d[j])
            assert inertia.tensor[i][j] == expected


def test_point_masses_about_the_origin_have_an_offset():
    points = [(1, 0, 0), (0, 1, 0), (0, 0, 1)]
    assert ExactMass.of_point_masses(1, points, "origin").of_motion.tensor[0] == (2, 0, 0)
    assert ExactMass.of_point_masses("1", points).inertia[0] == (Fraction(4, 3), Fraction(1, 3), Fraction(1, 3))


@settings(deadline=None, derandomize=True)
@given(points)
def test_inertia_about_the_centre_from_pairs_of_points(given_points) -> None:
    """Lagrange's identity: sum over pairs of m_i m_j/M (r^2 1 - r r^T), r between the two. No centre is formed."""
    body = of(given_points)
    total = sum(m for m, _ in given_points)
    assert body.mass == total
    for i in range(3):
        for j in range(3):
            want = Fraction(0)
            for (m, p), (n, q) in combinations(given_points, 2):
                r = [x - y for x, y in zip(p, q, strict=True)]
                want += m * n / total * ((sum(x * x for x in r) if i == j else 0) - r[i] * r[j])
            assert body.inertia[i][j] == want


@settings(deadline=None, derandomize=True)
@given(points, quaternion, st.tuples(whole, whole, whole))
def test_a_placed_body_is_that_of_its_placed_points(given_points, q, position) -> None:
    turn = rotation([Fraction(x) for x in q])
    moved = [
        (m, tuple(sum(a * x for a, x in zip(row, p, strict=True)) + y for row, y in zip(turn, position, strict=True)))
        for m, p in given_points
    ]
    one = of(given_points).placed([Fraction(x) for x in q], [Fraction(x) for x in position])
    other = of(moved)
    assert (one.mass, one.center_of_mass, one.inertia) == (other.mass, other.center_of_mass, other.inertia)


@settings(deadline=None, derandomize=True)
@given(points, points)
def test_parts_together_are_all_their_points_and_a_hole_takes_them_away_again(first, second) -> None:
    one, other = of(first), of(second)
    whole_body = ExactMass.together([one, other], "center-of-mass")
    both = of([*first, *second])
    assert (whole_body.mass, whole_body.center_of_mass, whole_body.inertia) == (
        both.mass,
        both.center_of_mass,
        both.inertia,
    )
    back = ExactMass.together([whole_body, other.taken_away()], "center-of-mass")
    assert (back.mass, back.center_of_mass, back.inertia) == (one.mass, one.center_of_mass, one.inertia)


@settings(deadline=None, derandomize=True)
@given(points)
def test_about_the_origin_no_centre_enters(given_points) -> None:
    body = ExactMass.of_point_masses([m for m, _ in given_points], [p for _, p in given_points], "origin")
    tensor = [
        [sum(m * ((sum(x * x for x in p) if i == j else 0) - p[i] * p[j]) for m, p in given_points) for j in range(3)]
        for i in range(3)
    ]
    assume(any(tensor[i][i] for i in range(3)))
    try:
        found = body.of_motion.tensor
    except InvalidParameter:
        # All on one point, which is the origin, or no moment that is positive twice.
        assert len({p for _, p in given_points}) == 1
        return
    assert [list(row) for row in found] == tensor


def test_a_hole_larger_than_what_it_is_cut_from() -> None:
    cross = [(1, (1, 0, 0)), (1, (-1, 0, 0)), (1, (0, 1, 0)), (1, (0, -1, 0))]
    wide = [(Fraction(1, 2), (9, 0, 0)), (Fraction(1, 2), (-9, 0, 0))]
    cut = ExactMass.together([of(cross), of(wide).taken_away()], "center-of-mass")
    assert cut.mass == 3
    with pytest.raises(UnphysicalInertia) as refused:
        assert cut.of_motion
    assert refused.value.path == ("parts",)
    with pytest.raises(InvalidParameter, match="weigh more than the holes"):
        ExactMass.together([of(wide), of(cross).taken_away()], "center-of-mass")


def test_what_is_no_list_of_points_is_refused() -> None:
    for masses, positions, path in (
        ([1, 0], [(0, 0, 0), (1, 0, 0)], ("masses", 1)),
        (1, [], ("positions",)),
        ([1], [(0, 0, 0), (1, 0, 0)], ("masses",)),
        (1, [(0, 0)], ("positions", 0)),
        (1, [(0, 0, 0)] * (LONGEST_LIST + 1), ("positions",)),
    ):
        with pytest.raises(InvalidParameter) as refused:
            ExactMass.of_point_masses(masses, positions)
        assert refused.value.path == path


@settings(deadline=None, derandomize=True)
@given(st.fractions())
def test_both_libraries_hold_the_same_fraction(x: Fraction) -> None:
    assert fraction_of(fmpq_of(x)) == x
    assert fmpq_of(x) == fmpq(x.numerator, x.denominator)
