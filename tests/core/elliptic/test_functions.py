"""Elliptic functions against mpmath at 60 and more digits, each of their parts and all together.

mpmath evaluates sn, cn, dn by theta series at an argument reduced with its own K, with as many digits as are asked
for; its digits are raised by what 1 - m loses. Nearer to m = 1 the oracle is Landen's ladder, which is given the
complement (`tests.oracles.elliptic`).
"""

import math
import random
from fractions import Fraction

import mpmath
import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from core.elliptic.functions import (
    half_parity,
    jacobi_at,
    separatrix_at,
    sin_cos_quarter,
    sinh_cosh,
    split_phase,
    theta_parts,
)
from core.elliptic.lattice import lattice
from tests.core.elliptic.parameters import jacobi, moduli
from tests.drawn import draws
from tests.oracles.elliptic import Periodic

ULP = 2.0**-53


def parameters(seed: int, count: int):
    """Yield m, m1 as doubles, one of them exact, and the exact m: the middle, and both ends to 1e-30."""
    rng = random.Random(seed)
    for i in range(count):
        small = rng.uniform(0, 0.5) if i % 2 else 10 ** rng.uniform(-30, -1)
        if i % 4 < 2:
            yield small, 1.0 - small, mpmath.mpf(small)
        else:
            yield 1.0 - small, small, 1 - mpmath.mpf(small)


@pytest.mark.parametrize("reach", [0.4, 6.0, 1e6, 1e12])
def test_jacobian_functions_to_six_units_component_by_component(reach):
    rng = random.Random(3)
    for m, m1, _ in parameters(4, 150):
        with mpmath.workdps(110):
            # The smaller parameter is the exact one.
            exact = mpmath.mpf(m) if m <= m1 else 1 - mpmath.mpf(m1)
            K = mpmath.ellipk(exact)
            u = float(K * rng.uniform(-reach, reach))
            reduced = mpmath.mpf(u) - 4 * K * mpmath.nint(mpmath.mpf(u) / (4 * K))
            want = [mpmath.ellipfun(name, reduced, m=exact) for name in ("sn", "cn", "dn")]
            for got, true in zip(jacobi(np.array([u]), m, m1)[:, 0], want, strict=True):
                assert abs(float(got) - true) <= 6.5 * ULP * abs(true)


def test_separatrix_is_hyperbolic():
    u = np.array([-400.0, -3.0, 0.0, 1e-9, 0.7, 30.0])
    sn, cn, dn = jacobi(u, 1.0, 0.0)
    for i, x in enumerate(u):
        assert math.isclose(sn[i], float(mpmath.tanh(x)), rel_tol=1e-15)
        assert math.isclose(cn[i], float(mpmath.sech(x)), rel_tol=1e-15)
    assert np.array_equal(cn, dn)


def test_detest_b5():
    """Problem B5 of Hull et al. has the solution (sn, cn, dn), m = 0.51; these digits at x = 20 are published."""
    sn, cn, dn = jacobi(np.array([20.0]), 0.51, 0.49)[:, 0]
    assert (float(sn), float(cn), float(dn)) == pytest.approx(
        (-0.9396570798729192, -0.3421177754000779, 0.7414126596199957), abs=5e-15
    )


def test_a_phase_is_split_at_its_nearest_integer_up_to_the_last():
    rng = random.Random("phases")
    for _ in range(2000):
        exponent = rng.uniform(-3, 50)
        rate, start = rng.uniform(0.5, 1), rng.uniform(-1, 1)
        rate_tail, time = rate * 2.0**-54 * rng.uniform(-1, 1), 2.0**exponent * rng.choice((-1, 1))
        n, r, tail = split_phase(rate, rate_tail, time, start, 0.0)
        exact = (Fraction(rate) + Fraction(rate_tail)) * Fraction(time) + Fraction(start)
        assert n == round(n)
        # The polynomials of sine and cosine hold no farther.
        assert abs(r) <= 0.5
        assert abs(Fraction(n) + Fraction(r) + Fraction(tail) - exact) <= Fraction(2) ** -53


@given(st.integers(-(2**50), 2**50))
@settings(deadline=None, derandomize=True, max_examples=draws(300))
def test_parity_of_quarters_is_that_of_whole_numbers(n):
    assert half_parity(float(n)) == (n % 2 == 1, -1.0 if (n // 2) % 2 else 1.0)


quarters = st.floats(-0.5, 0.5)
part_of_ulp = st.floats(-0.5, 0.5)


def tail_of(x: float, part: float) -> float:
    return part * math.ulp(x)


@given(quarters, part_of_ulp)
@settings(deadline=None, derandomize=True, max_examples=draws(500))
def test_sine_and_cosine_of_a_quarter_round_once(r, part):
    tail = tail_of(r, part)
    with mpmath.workdps(60):
        angle = (mpmath.mpf(r) + mpmath.mpf(tail)) * mpmath.pi / 2
        # One rounding of the sum, the remainder 2^-55 of the polynomial, and the roundings of the correction, which
        # is at most a sixth of (pi/4)^2 of the whole for the sine, (pi/4)^4/24 for the cosine.
        for got, want in zip(sin_cos_quarter(r, tail), (mpmath.sin(angle), mpmath.cos(angle)), strict=True):
            assert abs(got - want) <= (1 + 0.25 + 2 * 0.11) * ULP * abs(want) + 5e-324


@given(st.floats(-690, 690) | st.floats(-1, 1) | st.floats(-300, 0).map(lambda e: 10.0**e), part_of_ulp)
@settings(deadline=None, derandomize=True, max_examples=draws(500))
def test_hyperbolic_functions_have_full_relative_precision(x, part):
    tail = tail_of(x, part)
    with mpmath.workdps(60):
        whole = mpmath.mpf(x) + mpmath.mpf(tail)
        # Three sums one after the other, the last of full size and the others below half of it.
        for got, want in zip(sinh_cosh(x, tail), (mpmath.sinh(whole), mpmath.cosh(whole)), strict=True):
            assert abs(got - want) <= 2.5 * ULP * abs(want) + 5e-324


@given(st.floats(-1100, 1100) | st.floats(-40, 40), part_of_ulp)
@settings(deadline=None, derandomize=True, max_examples=draws(500))
def test_separatrix_down_to_nothing(x, part):
    tail = tail_of(x, part)
    with mpmath.workdps(60):
        whole = mpmath.mpf(x) + mpmath.mpf(tail)
        tanh, sech = separatrix_at(x, tail)
        assert abs(tanh - mpmath.tanh(whole)) <= 5 * ULP * abs(mpmath.tanh(whole))
        # Beyond 350 the tail of the argument, half an ulp of it, is left out.
        beyond = abs(x) > 350
        want = mpmath.sech(whole)
        assert abs(sech - want) <= ((3 + abs(x)) if beyond else 4) * ULP * want + 5e-324
        assert separatrix_at(-x, -tail) == (-tanh, sech)


def theta_series(sine, cosine, z, q) -> tuple:
    """Return theta1, theta2 (over 2 q^(1/4)), theta3, theta4 term by term (DLMF 20.2.1-4); sinh, cosh for i z."""
    odd = [(q ** (n * (n + 1)), 2 * n + 1) for n in range(16)]
    even = [(q ** (n * n), 2 * n) for n in range(1, 16)]
    return (
        mpmath.fsum((-1) ** n * w * sine(k * z) for n, (w, k) in enumerate(odd)),
        mpmath.fsum(w * cosine(k * z) for w, k in odd),
        1 + 2 * mpmath.fsum(w * cosine(k * z) for w, k in even),
        1 + 2 * mpmath.fsum((-1) ** (k // 2) * w * cosine(k * z) for w, k in even),
    )


@given(st.floats(0.0, 0.0433) | st.floats(-300, -2).map(lambda e: 10.0**e), quarters)
@settings(deadline=None, derandomize=True, max_examples=draws(200))
def test_circular_theta_functions(q, r):
    s, c = math.sin(0.5 * math.pi * r), math.cos(0.5 * math.pi * r)
    with mpmath.workdps(50):
        # The point (s, c) is on the unit circle to within their rounding.
        z, size = mpmath.atan2(s, c), mpmath.hypot(s, c)
        first, second, third, fourth = theta_series(mpmath.sin, mpmath.cos, z, mpmath.mpf(q))
        for got, want in zip(
            theta_parts(True, q, math.sqrt(q), s, c), (size * first, size * second, third, fourth), strict=True
        ):
            # One rounding of full size; what is small beside it is at most 2q = 0.09 and has a dozen.
            assert abs(got - want) <= (1 + 14 * 0.09) * ULP * abs(want) + 5e-324


@given(st.floats(0.0, 1.0), st.floats(1.5707963267948966, 340.0))
@settings(deadline=None, derandomize=True, max_examples=draws(200))
def test_hyperbolic_theta_functions(part, scale):
    """Jacobi's imaginary transformation: arguments up to half a quarter period, where q'^(1/2) sinh^2 is 1/4."""
    with mpmath.workdps(60):
        q, root = float(mpmath.exp(-2 * mpmath.mpf(scale))), float(mpmath.exp(-mpmath.mpf(scale)))
        x = mpmath.mpf(0.5 * part * scale)
        s, c = float(mpmath.sinh(x)), float(mpmath.cosh(x))
        wanted = theta_series(mpmath.sinh, mpmath.cosh, mpmath.asinh(s), mpmath.mpf(root) ** 2)
        for got, want in zip(theta_parts(False, q, root, s, c), wanted, strict=True):
            # As above; y is at most 2 q^(1/2) cosh 2x <= 1/4 + 0.09, and the root itself carries a rounding, squared.
            assert abs(got - want) <= (1.5 + 14 * 0.34) * ULP * abs(want)


@given(
    st.floats(-300, -0.302).map(lambda e: 10.0**e) | st.floats(2.0**-20, 0.5),
    st.booleans(),
    st.integers(-9, 9),
    quarters,
    part_of_ulp,
)
@settings(deadline=None, derandomize=True, max_examples=draws(200))
def test_jacobian_functions_at_a_phase_to_the_ends_of_both_parameters(least, near_one, n, r, part):
    tail = tail_of(r, part)
    m, m1 = (1.0 - least, least) if near_one else (least, 1.0 - least)
    lat = lattice(*moduli(m, m1))
    # As many digits as a phase next to the end of a quarter loses there.
    with mpmath.workdps(340):
        exact = mpmath.mpf(least)
        ladder = Periodic(*((1 - exact, exact) if near_one else (exact, 1 - exact)), mpmath.mpf(0))
        at = ladder.phase((n + mpmath.mpf(r) + mpmath.mpf(tail)) * ladder.quarter)
        turned = -1 if at.turns % 2 else 1
        for got, want in zip(jacobi_at(lat, float(n), r, tail), (turned * at.sn, turned * at.cn, at.dn), strict=True):
            assert abs(got - want) <= 6.5 * ULP * abs(want) + 5e-324
