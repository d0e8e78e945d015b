"""The periods and constants of a modulus: against mpmath at 60 digits, and by identities that the code does not use.

The constants in front of the theta quotients are formed from the series; their squares are powers of the moduli and of
the nome besides (NIST Digital Library of Mathematical Functions, 20.9.1 and 22.2.2), which no series enters.
"""

from __future__ import annotations

import mpmath
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from core.elliptic.lattice import lattice, periods, theta_constants
from tests.core.elliptic.parameters import moduli
from tests.drawn import draws

U = 2.0**-53
SQUARE = 2.0**-106

# The smaller of m and m1.
small = st.floats(-290, -0.302).map(lambda e: 10.0**e) | st.floats(2.0**-20, 0.5)
sides = st.booleans()


def number(pair: tuple[float, float]) -> mpmath.mpf:
    return mpmath.mpf(pair[0]) + mpmath.mpf(pair[1])


def near(got: mpmath.mpf, want: mpmath.mpf, relative: float) -> None:
    assert abs(got - want) <= relative * abs(want)


def given_moduli(least: float, near_one: bool) -> tuple[tuple[float, ...], mpmath.mpf, mpmath.mpf]:
    """Return the pairs, and the exact parameter with its complement."""
    m, m1 = (1.0 - least, least) if near_one else (least, 1.0 - least)
    exact = mpmath.mpf(least)
    return moduli(m, m1), *((1 - exact, exact) if near_one else (exact, 1 - exact))


@pytest.fixture(autouse=True)
def _sixty_digits():
    with mpmath.workdps(60):
        yield


@settings(deadline=None, derandomize=True, max_examples=draws(200))
@given(st.floats(0.0, 0.05) | st.floats(-300, -2).map(lambda e: 10.0**e))
def test_theta_constants_are_right_to_the_terms_that_are_formed_in_doubles(q: float) -> None:
    t3h, t3l, t4h, t4l, ph, pl = theta_constants(q, 0.0)
    exact = mpmath.mpf(q)
    # q^9 and q^6 carry the roundings of four doubles; all else is pairs, at most six operations of 4 u^2.
    for got, want, power in (
        ((t3h, t3l), mpmath.jtheta(3, 0, exact), 2 * q**9),
        ((t4h, t4l), mpmath.jtheta(4, 0, exact), 2 * q**9),
        ((ph, pl), mpmath.jtheta(2, 0, exact) / (2 * exact**0.25) if q else mpmath.mpf(1), q**6),
    ):
        near(number(got), want, 24 * SQUARE + 4 * U * power)


@settings(deadline=None, derandomize=True, max_examples=draws(300))
@given(small, sides)
def test_quarter_periods_both_ways(least: float, near_one: bool) -> None:
    pairs, m, m1 = given_moduli(least, near_one)
    found = periods(*pairs)
    # Carlson's duplication instead of the mean; 14 steps of 5 u^2, a quotient, and the modulus itself.
    K, other = mpmath.elliprf(0, m1, 1), mpmath.elliprf(0, m, 1)
    few = 90 * SQUARE
    near(number((found.K, found.K_tail)), K, few)
    near(number((found.complementary_mean, found.complementary_mean_tail)), mpmath.pi / 2 / K, few)
    assert found.circular == (m1 >= 0.5)
    scale = number((found.scale, found.scale_tail))
    near(scale, mpmath.pi / 2 if found.circular else mpmath.pi * K / (2 * other), 2 * few)
    if found.mean == 0.0:
        # Left out where q = m/16 is below the last bit of everything.
        assert m < mpmath.mpf(10) ** -79
    else:
        near(number((found.mean, found.mean_tail)), mpmath.pi / 2 / other, few)


@settings(deadline=None, derandomize=True, max_examples=draws(300))
@given(small, sides)
def test_constants_of_the_quotients_are_powers_of_moduli_and_nome(least: float, near_one: bool) -> None:
    pairs, m, m1 = given_moduli(least, near_one)
    lat = lattice(*pairs)
    K, other = mpmath.elliprf(0, m1, 1), mpmath.elliprf(0, m, 1)
    k, k1 = mpmath.sqrt(m), mpmath.sqrt(m1)
    if lat.circular:
        root = mpmath.exp(-mpmath.pi * other / (2 * K))
        squares = (4 * root / k, 4 * root * k1 / k, k1, 4 * root / k, 4 * root * k1 / k, k1)
    else:
        root = mpmath.exp(-mpmath.pi * K / (2 * other))
        below = 4 * root
        squares = (1 / k, k1 / (k * below), k1 / below, 1 / k, k1 * below / k, k1 * below)
    q = float(root) ** 2
    constants = (lat.even_sn, lat.even_cn, lat.even_dn, lat.odd_sn, lat.odd_cn, lat.odd_dn)
    # Of a constant: theta3, theta4 and P (above), two quotients and a product in pairs; of a square twice as much.
    allowed = 2 * (3 * (24 * SQUARE + 4 * U * (q**6 + 2 * q**9)) + 100 * SQUARE)
    for got, want in zip(constants, squares, strict=True):
        near(number(got) ** 2, want, allowed)
    assert [c[0] > 0 for c in constants] == [True, True, True, True, False, True]


@settings(deadline=None, derandomize=True, max_examples=draws(300))
@given(small, sides)
def test_nome(least: float, near_one: bool) -> None:
    pairs, m, m1 = given_moduli(least, near_one)
    lat = lattice(*pairs)
    K, other = mpmath.elliprf(0, m1, 1), mpmath.elliprf(0, m, 1)
    exact = mpmath.exp(-mpmath.pi * (other / K if lat.circular else K / other))
    assert lat.nome <= 0.0433
    if lat.nome == 0.0:
        assert exact < mpmath.mpf(10) ** (-80 if lat.circular else -260)
    else:
        near(lat.nome, exact, (1 + 1e-12) * U)
    if not (lat.circular and lat.nome == 0.0):
        near(lat.root_nome, mpmath.sqrt(exact), 1.6 * U)


def test_equal_moduli_have_the_lemniscate_s_nome() -> None:
    """m = 1/2: both periods are equal and q = e^-pi."""
    lat = lattice(*moduli(0.5, 0.5))
    near(lat.nome, mpmath.exp(-mpmath.pi), (1 + 1e-12) * U)
    near(number((lat.K, lat.K_tail)), mpmath.gamma(0.25) ** 2 / (4 * mpmath.sqrt(mpmath.pi)), 90 * SQUARE)
