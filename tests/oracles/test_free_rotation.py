"""The oracle of the torque-free body, judged by another method, by invariants and by published numbers."""

from __future__ import annotations

import math
from collections.abc import Sequence
from fractions import Fraction
from functools import cache

import pytest
from mpmath import mp, mpf

from tests.drawn import sampled

from . import taylor
from .cases import T_HANDLE, T_HANDLE_ORIGIN, Case, Triple, cases
from .elliptic import Periodic
from .free_rotation import (
    flip_interval,
    free_motion,
    largest_rate,
    period,
    precession_per_period,
    reference_angular_velocity,
    reference_attitude,
)
from .motion import Moving, Quaternion, Vector, product

CASES = {case.name: case for case in sampled(cases(), __name__)}

BY_SERIES: dict[str, tuple[Triple, Triple, float]] = {
    "ABC about the least": ((1.0, 2.0, 3.0), (-1.1, 0.3, 0.2), 1),
    "ABC about the greatest": ((1.0, 2.0, 3.0), (0.3, -0.2, 0.9), 1),
    "ACB about the least": ((1.0, 3.0, 2.0), (1.1, 0.2, -0.3), 1),
    "BAC about the greatest": ((2.0, 1.0, 3.0), (-0.2, 0.3, -0.9), 1),
    "BCA about the least": ((2.0, 3.0, 1.0), (0.3, -0.2, -1.1), 1),
    "CAB about the greatest": ((3.0, 1.0, 2.0), (0.9, -0.3, 0.2), 1),
    "CBA about the least": ((3.0, 2.0, 1.0), (-0.2, -0.3, 1.1), 1),
    "m1 about 1e-8": ((2.0, 3.0, 1.0), (1.3, -1e-4, 1e-4), 0.6),
    "m1 about 1e-12, by cancellation": ((14.0, 21.0, 24.0), (6.0, 1.0, 7 * (1 + 1e-12)), 0.6),
    "separatrix": ((24.0, 14.0, 21.0), (-7.0, 6.0, -2.0), 3),
    "symmetric but for 1e-9": ((1.0, 1 + 1e-9, 1.7), (0.7, -0.4, 0.6), 1),
    "symmetric": ((0.3, 2.0, 2.0), (0.5, 0.3, -0.8), 1),
    "needle": ((1.0, 1e-3, 1.0001), (0.3, 2.0, -1.0), 1),
    "no body at all": ((2.0, 1.0, 0.5), (0.4, 1.0, 0.7), 1),
}


def distance(one: Sequence[mpf], other: Sequence[mpf]) -> mpf:
    return max(abs(x - y) for x, y in zip(one, other, strict=True))


def to_space(q: Quaternion, vector: Sequence[mpf]) -> Sequence[mpf]:
    w, x, y, z = q
    return product(product(q, (mpf(0), *vector)), (w, -x, -y, -z))[1:]


@cache
def references(case: Case, digits: int) -> tuple[list[Vector], list[Quaternion]]:
    _, moments, rates, times = case
    omega = reference_angular_velocity(moments, rates, times, digits)
    return omega, reference_attitude(moments, rates, times, (0.5, -1.0, 2.0, 0.25), digits)


@pytest.mark.parametrize("name", BY_SERIES)
def test_a_taylor_series_agrees(name: str) -> None:
    moments, rates, span = BY_SERIES[name]
    unit = span * float(period(moments, rates) or 1)
    times = [0.7 * unit, -0.6 * unit, 0.0, unit]
    omega = reference_angular_velocity(moments, rates, times)
    attitude = reference_attitude(moments, rates, times)
    with mp.workdps(50):
        start = [*map(mpf, rates), mpf(1), mpf(0), mpf(0), mpf(0)]
        states = taylor.integrate(taylor.rigid_body(moments), start, times)
        for state, w, q in zip(states, omega, attitude, strict=True):
            assert distance(state[:3], w) < 1e-35
            # The sign too: the series knows nothing but continuity.
            assert distance(state[3:], q) < 1e-35


@pytest.mark.parametrize("case", [*CASES.values()][::3], ids=[*CASES][::3])
def test_every_promised_digit_is_right(case: Case) -> None:
    size = largest_rate(case.moments, case.angular_velocity)
    omega, attitude = references(case, 30)
    finer_omega, finer_attitude = references(case, 50)
    with mp.workdps(60):
        assert all(distance(w, x) <= mpf("1e-30") * size for w, x in zip(omega, finer_omega, strict=True))
        assert all(distance(q, r) <= mpf("1e-30") for q, r in zip(attitude, finer_attitude, strict=True))


@pytest.mark.parametrize("case", CASES.values(), ids=CASES)
def test_momentum_stands_still_in_space_and_energy_is_conserved(case: Case) -> None:
    omega, attitude = references(case, 50)
    with mp.workdps(60):
        moments = [mpf(i) for i in case.moments]
        energies = [mp.fsum(i * x * x for i, x in zip(moments, w, strict=True)) for w in omega]
        momenta = [
            to_space(q, [i * x for i, x in zip(moments, w, strict=True)]) for q, w in zip(attitude, omega, strict=True)
        ]
        start = case.times.index(0.0)
        given = [mpf(w) for w in case.angular_velocity]
        assert distance(omega[start], given) <= mpf("1e-49") * mp.norm(given)
        assert all(abs(e - energies[start]) <= mpf("1e-45") * energies[start] for e in energies)
        assert all(distance(m, momenta[start]) <= mpf("1e-45") * mp.norm(momenta[start]) for m in momenta)
        assert all(abs(mp.norm(q) - 1) < mpf("1e-49") for q in attitude)


@pytest.mark.parametrize("case", [*CASES.values()][::3], ids=[*CASES][::3])
def test_the_equations_of_motion_hold(case: Case) -> None:
    """By central differences over 2e-12 radians, whose error is that squared: where no series would reach."""
    _, moments, rates, times = case
    size = largest_rate(moments, rates)
    with mp.workdps(60):
        k = taylor.rigid_body(moments)
        step = Fraction(1e-12) / Fraction(float(size) or 1.0)
        span = 2 * mpf(step.numerator) / step.denominator
        for time in times[0], times[4]:
            instants = [Fraction(time) + i * step for i in (-1, 0, 1)]
            before, now, after = reference_angular_velocity(moments, rates, instants)
            for i in range(3):
                expected = k[i] * now[i - 2] * now[i - 1]
                assert abs((after[i] - before[i]) / span - expected) <= mpf("1e-22") * size**2
            (w, x, y, z), _, end = reference_attitude(moments, rates, instants)
            scalar, *vector = product((w, -x, -y, -z), end)
            # Near +1 and not near -1, for the sign is continuous.
            assert scalar > 0
            assert distance(vector, [span * rate / 2 for rate in now]) <= mpf("1e-22") * span * size


@pytest.mark.parametrize(
    ("moments", "rates"),
    [
        ((1.0, 2.0, 3.0), (1.1, 0.3, 0.2)),
        ((1.0, 2.0, 3.0), (-0.3, -0.2, 0.9)),
        ((2.0, 1.0, 3.0), (0.3, -1.1, 0.2)),
        ((2.0, 3.0, 1.0), (0.2, 0.9, -0.3)),
        ((1.0, 1.5, 1.0), (0.2, -0.9, -0.3)),
    ],
)
def test_montgomerys_formula(moments: Triple, rates: Triple) -> None:
    """The body turns by 2 E T / L less the solid angle that L sweeps in it [1]_, here without elliptic functions.

    The polhode is run through by the angle chi of ``(w_c, w_b) = (A_c cos chi, A_b sin chi)``, and integrated by the
    trapezoidal rule, which converges geometrically on a closed curve.

    References
    ----------
    .. [1] R. Montgomery, How much does the rigid body rotate?, American Journal of Physics 59 (1991) 394.
    """
    points = 400
    duration, angle = period(moments, rates), precession_per_period(moments, rates)
    assert duration is not None
    assert angle is not None
    motion = free_motion(moments, rates)
    assert isinstance(motion, Moving)
    b, c, d = motion.polhode.axes
    with mp.workdps(50):
        i_b, i_c, i_d = (mpf(moments[axis]) for axis in (b, c, d))
        twice_energy = mp.fsum(i * mpf(w) ** 2 for i, w in zip(moments, rates, strict=True))
        momentum = mp.norm([i * mpf(w) for i, w in zip(moments, rates, strict=True)])
        a_b, a_c = (mp.sqrt((momentum**2 - twice_energy * i_d) / (i * (i - i_d))) for i in (i_b, i_c))
        # Euler's equation of the middle axis is chi' = pace w_d; its sign is that of the order (c, b, d).
        pace = (1 if b == (c + 1) % 3 else -1) * (i_d - i_c) * a_c / (i_b * a_b)
        whole = swept = mpf(0)
        for j in range(points):
            cosine, sine = mp.cos_sin(2 * mp.pi * j / points)
            w_b, w_c = a_b * sine, a_c * cosine
            w_d = math.copysign(1, rates[d]) * mp.sqrt((twice_energy - i_b * w_b**2 - i_c * w_c**2) / i_d)
            whole += 2 * mp.pi / (points * abs(pace * w_d))
            turned = i_b * a_b * i_c * a_c / ((i_b * w_b) ** 2 + (i_c * w_c) ** 2)
            swept += (1 - i_d * w_d / momentum) * turned * 2 * mp.pi / points
        around = math.copysign(1, pace * rates[d]) * (1 if b == (c + 1) % 3 else -1)
        assert abs(whole - duration) < mpf("1e-40")
        # Montgomery's angle is known modulo a turn; Euler's is the whole of it.
        assert abs(angle - (twice_energy * whole / momentum - around * swept + around * 2 * mp.pi)) < mpf("1e-40")


@pytest.mark.parametrize(
    ("moments", "rates", "interval"),
    [
        (T_HANDLE_ORIGIN, (1.0, 10.0, 1.0), 2.803939295),
        (T_HANDLE, (1.0, 10.0, 1.0), 2.453763074),
        (T_HANDLE, (0.01, 10.0, 0.0), 5.639808),
    ],
)
def test_a_t_handle_flips_at_the_known_intervals(moments: Triple, rates: Triple, interval: float) -> None:
    flip = flip_interval(moments, rates)
    assert flip is not None
    assert float(flip) == pytest.approx(interval, abs=6e-10 if rates[2] else 6e-7)


def test_the_exact_separatrix() -> None:
    """For moments (14, 21, 24) and rates (6, 0, 7) the equations are solved in a line: p and A_b are 5**.5, 4 5**.5."""
    times = [0.3, -2.5, 40.0]
    for t, w in zip(times, reference_angular_velocity((14, 21, 24), (6, 0, 7), times), strict=True):
        with mp.workdps(60):
            root = mp.sqrt(5)
            exact = 6 * mp.sech(root * t), 4 * root * mp.tanh(root * t), 7 * mp.sech(root * t)
            assert distance(w, exact) < mpf("1e-48")
    assert period((14, 21, 24), (6, 0, 7)) is None
    assert precession_per_period((14, 21, 24), (6, 0, 7)) is None
    assert period((14, 21, 24), (6, 0, math.nextafter(7, 8))) is not None


def test_the_departure_from_the_saddle_is_exponential() -> None:
    """Of a hair of 1e-150 the equations are linear until it has grown by many orders, to nearly 300 digits."""
    hair, times = 1e-150, [1.0, 30.0, 200.0]
    for t, w in zip(times, reference_angular_velocity((1.0, 2.0, 3.0), (hair, 1.0, 0.0), times), strict=True):
        with mp.workdps(60):
            # w_1' = -w_3, w_3' = -w_1/3
            rate = 1 / mp.sqrt(3)
            linear = hair * mp.cosh(rate * t), -hair * rate * mp.sinh(rate * t)
            assert abs(w[0] / linear[0] - 1) < mpf("1e-48")
            assert abs(w[2] / linear[1] - 1) < mpf("1e-48")


@pytest.mark.parametrize("moments", [(2.0, 2.0, 0.3), (1.0, 1.0, 2.0), (0.7, 0.7, 0.7)])
def test_a_symmetric_body_is_two_rotations(moments: Triple) -> None:
    """The axis goes round the angular momentum at L/I while the body turns about its axis at (1 - I_3/I) w_3."""
    rates, times = (0.3, -0.8, 0.5), [0.7, -31.0, 1e7]
    for t, q in zip(times, reference_attitude(moments, rates, times), strict=True):
        with mp.workdps(70):
            momentum = [mpf(i) * w / moments[0] for i, w in zip(moments, rates, strict=True)]
            rate = mp.norm(momentum)
            cosine, sine = mp.cos_sin(rate * t / 2)
            about_momentum = cosine, *(sine * x / rate for x in momentum)
            cosine, sine = mp.cos_sin((1 - mpf(moments[2]) / moments[0]) * rates[2] * t / 2)
            assert distance(q, product(about_momentum, (cosine, mpf(0), mpf(0), sine))) < mpf("1e-48")


def test_the_published_values_of_detest_b5() -> None:
    """Euler's equations at y = (sn, cn, dn)(x | 0.51), x = 20, to what double precision made of them [1]_.

    References
    ----------
    .. [1] W. H. Enright, J. D. Pryce, Two FORTRAN packages for assessing initial value methods, ACM Transactions on
       Mathematical Software 13 (1987) 1, problem B5.
    """
    with mp.workdps(50):
        m = mpf(51) / 100
        (series,) = taylor.integrate([mpf(1), mpf(-1), -m], [mpf(0), mpf(1), mpf(1)], [20.0])
        phase = Periodic(m, 1 - m, mpf(0)).phase(mpf(20))
        odd = (-1) ** phase.turns
        assert distance(series, (odd * phase.sn, odd * phase.cn, phase.dn)) < mpf("1e-45")
        assert distance(series, (-0.9396570798729192, -0.3421177754000779, 0.7414126596199957)) < 5e-15
