"""The certified closed forms against integrals and Taylor series: no theta function, no Landen ladder, no R_F.

Near the separatrix down to 10^-300 and over 10^9 periods.
"""

from __future__ import annotations

from fractions import Fraction

import pytest
from mpmath import ellipfun, mp, mpf

from core.certified.free_rotation import CertifiedRotation
from core.certified.precession import certified_precession
from core.certified.stability import certified_stability
from tests.core.bodies.exact_tensors import of_tensor
from tests.oracles.free_rotation import reference_angular_velocity, reference_attitude
from tests.oracles.taylor import integrate, rigid_body

MOMENTS = ("1", "2", "3")
NEAR = [("0.3", "1", "0.5"), ("1e-3", "1", "1e-4"), ("1e-60", "1", "1e-60"), ("1e-300", "1", "0"), ("0", "1", "1e-300")]


def mp_of(number: Fraction) -> mpf:
    return mpf(number.numerator) / number.denominator


def constants(moments, rates) -> tuple[mpf, mpf, mpf]:
    """Return p, m1 and m from energy and momentum: L. D. Landau, E. M. Lifshitz, "Mechanics", section 37."""
    (a, b, c), w = [Fraction(x) for x in moments], [Fraction(x) for x in rates]
    twice = sum(i * x * x for i, x in zip((a, b, c), w, strict=True))
    square = sum((i * x) ** 2 for i, x in zip((a, b, c), w, strict=True))
    if square < twice * b:
        a, c = c, a
    rate = (c - b) * (square - twice * a) / (a * b * c)
    m1 = (c - a) * (square - twice * b) / ((c - b) * (square - twice * a))
    return mp.sqrt(mp_of(rate)), mp_of(m1), mp_of(1 - m1)


def complete_integral(m1: mpf) -> mpf:
    """Return K as the integral of dx/sqrt((1 + x^2)(1 + m1 x^2)) over x = tan(phi) > 0, with x = e^s.

    The integrand is analytic in a strip of half-width pi/2 and falls off exponentially, so that the trapezoidal rule
    with step h errs by e^(-pi^2/h): L. N. Trefethen, J. A. C. Weideman, SIAM Review 56 (2014) 385.
    """
    digits = mp.dps
    h = mp.pi**2 / (mp.log(10) * (digits + 5))
    low = mp.log(10) * (digits + 5)
    first, last = -int(low / h), int((low - mp.log(m1) / 2) / h) + 1
    total = mpf(0)
    for k in range(first, last + 1):
        x = mp.exp(k * h)
        total += x / mp.sqrt((1 + x * x) * (1 + m1 * x * x))
    return h * total


@pytest.mark.parametrize("rates", NEAR, ids=str)
def test_period_and_flips_by_the_trapezoidal_rule(rates):
    motion = CertifiedRotation.of_moments(MOMENTS, rates)
    with mp.workdps(60):
        p, m1, _ = constants(MOMENTS, rates)
        quarter = complete_integral(m1)
        assert abs(mpf(motion.period(50)) * p / (4 * quarter) - 1) < mpf("5.2e-50")
        assert abs(mpf(motion.flip_interval(50)) * p / (2 * quarter) - 1) < mpf("5.2e-50")
    flip = certified_stability(motion.inertia, rates[1], 50, (rates[0], rates[2])).flip
    assert flip.interval == motion.flip_interval(50)


@pytest.mark.parametrize("rates", [("0.3", "1", "0.5"), ("0.5", "-1", "0.1"), ("0.01", "1", "0.02")], ids=str)
def test_precession_per_period_by_the_trapezoidal_rule(rates):
    """phi' = L (A w_a^2 + B w_b^2)/(A^2 w_a^2 + B^2 w_b^2) about the angular momentum, over one period.

    H. Goldstein, C. Poole, J. Safko, "Classical Mechanics", 3rd ed., section 5.6, with the axis circled as the third of
    Euler's angles; over a period of a periodic analytic function the rule converges geometrically.
    """
    found = certified_precession(CertifiedRotation.of_moments(MOMENTS, rates), 40)
    with mp.workdps(55):
        moments, w = [mpf(x) for x in MOMENTS], [mpf(x) for x in rates]
        _, _, m = constants(MOMENTS, rates)
        twice = sum(i * x * x for i, x in zip(moments, w, strict=True))
        square = sum((i * x) ** 2 for i, x in zip(moments, w, strict=True))
        a, b, c = moments if square > twice * moments[1] else moments[::-1]
        # Amplitudes of the two components across the circled axis.
        amplitude_a, amplitude_b = ((twice * c - square) / (i * (c - i)) for i in (a, b))
        quarter = complete_integral(1 - m)
        # The nearest pole is no farther off than K' from a period of 4K, so that a longer period needs more points.
        n, total = 300 * int(mp.ceil(quarter)), mpf(0)
        for k in range(n):
            u = 4 * quarter * k / n
            x, y = amplitude_a * ellipfun("cn", u, m=m) ** 2, amplitude_b * ellipfun("sn", u, m=m) ** 2
            total += (a * x + b * y) / (a * a * x + b * b * y)
        angle = mp.sqrt(square) * total / n * mpf(found.period)
        assert abs(mpf(found.precession_per_period) / angle - 1) < mpf("1e-38")
        assert abs(mpf(found.mean_precession_rate) / (mp.sqrt(square) * total / n) - 1) < mpf("1e-38")


@pytest.mark.parametrize(
    ("moments", "rates", "times"),
    [
        (MOMENTS, ("0.3", "1", "0.5"), ("1.5", "-4", "12")),
        (("3", "1", "2"), ("1e-8", "0.5", "1"), ("17", "40")),
        (("1", "1", "2"), ("0.3", "1", "0.5"), ("9",)),
        (("14", "21", "24"), ("6", "1", "7"), ("0.5", "-1")),
    ],
    ids=["tumbling", "near the separatrix, past a flip", "symmetric", "separatrix"],
)
def test_motion_and_attitude_by_taylor_series(moments, rates, times):
    motion = CertifiedRotation.of_moments(moments, rates)
    found, turned = motion.trajectory(times, 40)
    with mp.workdps(60):
        k = rigid_body([mpf(x) for x in moments])
        start = [*map(mpf, rates), mpf(1), mpf(0), mpf(0), mpf(0)]
        for state, w, q in zip(integrate(k, start, [mpf(t) for t in times]), found, turned, strict=True):
            for x, y in zip(state, [*w, *q], strict=True):
                assert abs(x - mpf(y)) < mpf("1e-38")


@pytest.mark.parametrize("rates", NEAR[2:], ids=str)
def test_in_the_middle_of_a_turn_after_long_rest(rates):
    """300 digits below the separatrix: while it turns over, after one flip and after 10^9 periods."""
    motion = CertifiedRotation.of_moments(MOMENTS, rates)
    flip = Fraction(motion.flip_interval(400))
    # A component that the start lacks starts the turn half a flip later or earlier: both quarters are looked at.
    times = [flip / 2 + Fraction(1, 3), flip + Fraction(1, 7), 2 * 10**9 * flip + flip / 2 - Fraction(1, 5)]
    found, turned = motion.trajectory(times, 50)
    exact = [Fraction(x) for x in MOMENTS], [Fraction(x) for x in rates], times
    with mp.workdps(80):
        wanted = reference_angular_velocity(*exact, 56)
        attitudes = reference_attitude(*exact, digits=56)
        for row, want in zip([*found, *turned], [*wanted, *attitudes], strict=True):
            for x, y in zip(row, want, strict=True):
                assert abs(mpf(x) - y) < mpf("1e-49")


def test_flips_of_irrational_moments_by_the_trapezoidal_rule():
    tensor = [[2, 1, 0], [1, 3, 1], [0, 1, 5]]
    flip = certified_stability(of_tensor(tensor), "0.7", 40, ("1e-30", "0.2")).flip
    with mp.workdps(55):
        a, b, c = sorted(mp.eigsy(mp.matrix(tensor), eigvals_only=True))
        w = mpf("1e-30"), mpf("0.7"), mpf("0.2")
        twice = sum(i * x * x for i, x in zip((a, b, c), w, strict=True))
        square = sum((i * x) ** 2 for i, x in zip((a, b, c), w, strict=True))
        p = mp.sqrt((c - b) * (square - twice * a) / (a * b * c))
        m1 = (c - a) * (square - twice * b) / ((c - b) * (square - twice * a))
        assert abs(mpf(flip.interval) * p / (2 * complete_integral(m1)) - 1) < mpf("1e-39")
