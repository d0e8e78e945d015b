"""What is proved about each equilibrium, proved again: by linear algebra, and by energies on the momentum sphere.

Rational points of the sphere |M| = L next to an axis come from rational points of the circle,
((1 - t^2)/(1 + t^2), 2t/(1 + t^2)); the energy sum M_k^2/2 I_k is compared there without rounding.
"""

from __future__ import annotations

from fractions import Fraction
from itertools import product

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from core.rotation.stability.classification import REST, UNSTABLE_SPINS, classify_equilibrium, drift, unstable_spin

ORDERS = {
    (0, 1, 2): (Fraction(2), Fraction(3), Fraction(5)),
    (0, 0, 1): (Fraction(2), Fraction(2), Fraction(5)),
    (0, 1, 1): (Fraction(2), Fraction(5), Fraction(5)),
    (0, 0, 0): (Fraction(2), Fraction(2), Fraction(2)),
}
CASES = [(ranks, axis) for ranks in ORDERS for axis in range(3)]


def neighbours(axis: int, reach: Fraction) -> list[list[Fraction]]:
    """Return rational points of the unit sphere next to an axis, all round it."""
    found = []
    for a, b in product(range(-4, 5), repeat=2):
        if (a, b) == (0, 0):
            continue
        # Inverse stereographic projection of a point of the plane.
        x, y = reach * a, reach * b
        square = x * x + y * y
        point = [Fraction(0)] * 3
        point[axis] = (1 - square) / (1 + square)
        point[axis - 2], point[axis - 1] = 2 * x / (1 + square), 2 * y / (1 + square)
        assert sum(p * p for p in point) == 1
        found.append(point)
    return found


def energies(moments, axis: int) -> tuple[Fraction, list[Fraction]]:
    around = neighbours(axis, Fraction(1, 100))
    return 1 / moments[axis], [sum(p * p / i for p, i in zip(point, moments, strict=True)) for point in around]


def couplings(moments, axis: int) -> tuple[Fraction, Fraction]:
    """Return the two entries of Euler's equation linearised about a unit spin."""
    j, k = (axis + 1) % 3, (axis + 2) % 3
    return (moments[k] - moments[axis]) / moments[j], (moments[axis] - moments[j]) / moments[k]


@pytest.mark.parametrize(("ranks", "axis"), CASES)
def test_stability_is_that_of_the_energy_on_the_momentum_sphere(ranks, axis) -> None:
    moments, found = ORDERS[ranks], classify_equilibrium(ranks, axis, True)
    own, around = energies(moments, axis)
    strict = all(e > own for e in around) or all(e < own for e in around)
    flat = all(e == own for e in around)
    assert found.stable == (strict or flat)
    assert found.attitude == ("orbital" if strict or flat else "unstable")
    # Losing energy at constant momentum leads away unless no neighbour has less.
    assert found.survives_dissipation == all(e >= own for e in around)


@pytest.mark.parametrize(("ranks", "axis"), CASES)
def test_kind_is_that_of_the_linear_equation(ranks, axis) -> None:
    first, second = couplings(ORDERS[ranks], axis)
    found = classify_equilibrium(ranks, axis, True)
    square = first * second
    assert found.kind == ("center" if square < 0 else "saddle" if square > 0 else "degenerate")
    # Eigenvalues on the imaginary axis do not grow; zero ones only without a Jordan block.
    jordan = square == 0 and (first, second) != (0, 0)
    assert found.linearly_stable == (square <= 0 and not jordan)


@pytest.mark.parametrize(("ranks", "axis"), CASES)
def test_reasons_name_what_holds(ranks, axis) -> None:
    found = classify_equilibrium(ranks, axis, True)
    own, around = energies(ORDERS[ranks], axis)
    if found.kind == "center":
        assert ("strictly least" in found.reason) == (min(around) > own)
        assert ("The moment is the largest" in found.reason) == (axis == 2)
    if ranks != (0, 0, 0):
        assert ("the body ends here" in found.reason) == found.survives_dissipation
    assert ("Jordan block" in found.reason) == (found.kind == "degenerate" and not found.stable)


@pytest.mark.parametrize(("ranks", "axis"), CASES)
def test_rest_is_distinguished_from_every_rotation(ranks, axis) -> None:
    assert classify_equilibrium(ranks, axis, False) is REST
    assert classify_equilibrium(ranks, axis, True) != REST


positive = st.fractions(Fraction(1, 1000), 1000)


@settings(deadline=None, derandomize=True)
@given(positive, positive, st.fractions(-100, 100))
def test_drift_is_the_entry_of_the_jordan_block(equal, single, rate) -> None:
    moments = (equal, equal, single)
    for axis in (0, 1, 2):
        others = [moments[k] for k in range(3) if k != axis]
        entries = [abs(rate * x) for x in couplings(moments, axis)]
        want = max(entries) if entries[0] * entries[1] == 0 else Fraction(0)
        assert drift(moments[axis], *others, rate) == want


def test_three_different_moments_and_three_equal_ones_do_not_drift() -> None:
    assert drift(Fraction(2), Fraction(1), Fraction(3), Fraction(5)) == 0
    assert drift(Fraction(2), Fraction(2), Fraction(2), Fraction(5)) == 0


def test_an_unstable_spin_is_distinguished_from_a_stable_one() -> None:
    assert unstable_spin((True, True), (0.0, -2.0, 0.0)) == UNSTABLE_SPINS["saddle"]
    assert unstable_spin((False, True), (3.0, -2.0, 0.0)) == UNSTABLE_SPINS["degenerate"]
    assert unstable_spin((True, False), (0.0, 1.0, 0.0)) == UNSTABLE_SPINS["degenerate"]
    for k in (0, 2):
        assert unstable_spin((True, True), tuple(float(n == k) for n in range(3))) is None
    assert unstable_spin((False, True), (0.0, 0.0, 1.0)) is None
    assert unstable_spin((False, False), (1.0, 1.0, 0.0)) is None
