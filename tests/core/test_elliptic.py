"""Elliptic functions and integrals against mpmath at 60 and more digits.

mpmath evaluates sn, cn, dn by theta series at an argument reduced with its own K, with as many
digits as are asked for; its digits are raised by what 1 - m loses.
"""

import math
import random
from fractions import Fraction

import mpmath
import numpy as np
import pytest

from core.elliptic.functions import LARGEST_QUARTER, jacobi, split_phase
from core.elliptic.integrals import carlson_rf, complete_k
from core.errors import AccuracyUnreachable, InvalidParameter

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


def test_complete_integral():
    with mpmath.workdps(90):
        for m, m1, exact in parameters(1, 300):
            want = mpmath.ellipk(exact)
            assert abs(complete_k(m, m1) - want) <= 0.7 * 2 * ULP * want


def test_complete_integral_at_the_smallest_complement():
    with mpmath.workdps(400):
        for m1 in (1e-100, 1e-300):
            want = mpmath.ellipk(1 - mpmath.mpf(m1))
            assert abs(complete_k(1.0, m1) - want) <= 2 * ULP * want


def test_carlson():
    rng = random.Random(2)
    with mpmath.workdps(40):
        for _ in range(200):
            x, y, z = (10 ** rng.uniform(-100, 100) for _ in range(3))
            if rng.random() < 0.2:
                x = 0.0
            want = mpmath.elliprf(x, y, z)
            assert abs(carlson_rf(x, y, z) - want) <= 2 * ULP * want


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
            for got, true in zip(jacobi(u, m, m1), want, strict=True):
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
    sn, cn, dn = jacobi(20.0, 0.51, 0.49)
    assert (float(sn), float(cn), float(dn)) == pytest.approx(
        (-0.9396570798729192, -0.3421177754000779, 0.7414126596199957), abs=5e-15
    )


def test_shape_is_kept():
    assert [part.shape for part in jacobi(np.zeros((2, 3)), 0.3, 0.7)] == [(2, 3)] * 3


def test_what_cannot_be_right_is_refused():
    with pytest.raises(AccuracyUnreachable):
        jacobi(2 * LARGEST_QUARTER, 0.3, 0.7)
    for bad in ((0.3, 0.3), (-0.1, 1.1), (math.nan, 0.5)):
        with pytest.raises(InvalidParameter):
            jacobi(0.1, *bad)
    with pytest.raises(InvalidParameter):
        jacobi(math.inf, 0.3, 0.7)
    with pytest.raises(InvalidParameter):
        complete_k(1.0, 0.0)
    with pytest.raises(InvalidParameter):
        carlson_rf(0.0, 0.0, 1.0)
    with pytest.raises(InvalidParameter):
        carlson_rf(-1.0, 0.0, 1.0)


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
