"""First-order moves of the constants of a motion against difference quotients at 60 digits.

The constants are written here as functions of moments and start, from Landau and Lifshitz, section 37; a central
difference of 1e-20 is right to 1e-39, so that what is compared are the roundings of the code: some fifty, magnified by
what the gaps of the moments cancel.
"""

from __future__ import annotations

from collections.abc import Callable

import mpmath
import numpy as np
import pytest
from hypothesis import assume, given, settings
from hypothesis import strategies as st

from core.rotation.uncertainty import constant_sensitivities as at
from core.rotation.uncertainty.constant_sensitivities import COUNT, add_constants, add_start, slope_of_quarter
from tests.drawn import draws

U = 2.0**-53
STEP = mpmath.mpf(10) ** -20

gap = st.floats(0.05, 1.0)
spin = st.floats(0.05, 1.0).flatmap(lambda x: st.sampled_from([x, -x]))
direction = st.tuples(*3 * [st.floats(-1.0, 1.0)])
cases = st.tuples(
    gap, gap, gap, st.tuples(spin, spin, spin), st.lists(st.tuples(direction, direction), min_size=1, max_size=4)
)


class Constants:
    """Of the motion through a state, at 60 digits; d is 2 or 0."""

    def __init__(self, i: list, w: list, d: int) -> None:
        c = 2 - d
        I_c, I_b, I_d = i[c], i[1], i[d]
        squares = [x * x for x in w]
        momentum = sum(a * a * b for a, b in zip(i, squares, strict=True))
        energy = sum(a * b for a, b in zip(i, squares, strict=True))
        X, Y = abs(momentum - energy * I_d), abs(momentum - energy * I_c)
        self.A_c = mpmath.sqrt(X / (I_c * abs(I_d - I_c)))
        self.A_b = mpmath.sqrt(X / (I_b * abs(I_d - I_b)))
        self.A_d = mpmath.sqrt(Y / (I_d * abs(I_d - I_c)))
        self.p = mpmath.sqrt(abs(I_d - I_b) * Y / (i[0] * i[1] * i[2]))
        self.m = abs(I_b - I_c) * X / (abs(I_d - I_b) * Y)
        self.phi = mpmath.atan2(w[1] / self.A_b, w[c] / self.A_c)
        self.L = mpmath.sqrt(momentum)
        self.pole = [a * b / self.L for a, b in zip(i, w, strict=True)]
        self.poles = (I_c * self.A_c / self.L, I_b * self.A_b / self.L, I_d * self.A_d / self.L)

    @property
    def frequency(self) -> mpmath.mpf:
        return self.p / mpmath.ellipk(self.m)


def derivative(of: Callable[[Constants], object], i, w, dI, dw, d):
    def at(step):
        return of(
            Constants(
                [x + step * y for x, y in zip(i, dI, strict=True)],
                [x + step * y for x, y in zip(w, dw, strict=True)],
                d,
            )
        )

    above, below = at(STEP), at(-STEP)
    if isinstance(above, (list, tuple)):
        return [(a - b) / (2 * STEP) for a, b in zip(above, below, strict=True)]
    return (above - below) / (2 * STEP)


@settings(deadline=None, derandomize=True, max_examples=draws(80))
@given(cases)
def test_every_constant_moves_by_its_derivative(case) -> None:
    least, low, high, rates, inputs = case
    moments = np.array([least, least + low, least + low + high])
    # The gaps as the doubles leave them.
    low, high = float(moments[1] - moments[0]), float(moments[2] - moments[1])
    with mpmath.workdps(60):
        i, w = [mpmath.mpf(x) for x in moments], [mpmath.mpf(x) for x in rates]
        decides = i[2] * (i[2] - i[1]) * w[2] ** 2 - i[0] * (i[1] - i[0]) * w[0] ** 2
        assume(abs(decides) > 0.02)
        d = 2 if decides > 0 else 0
        here = Constants(i, w, d)
        m, k1, K = float(here.m), float(mpmath.sqrt(1 - here.m)), float(mpmath.ellipk(here.m))
        dn = mpmath.sqrt(1 - here.m * mpmath.sin(here.phi) ** 2)
        dI, dw = np.array([x for x, _ in inputs]), np.array([y for _, y in inputs])
        sums, table = np.zeros(COUNT), np.zeros((len(inputs), 6))
        add_constants(moments, low, high, np.array(rates), d, m, k1, K, dI, dw, sums, table)
        named: dict[int, mpmath.mpf] = dict.fromkeys(range(COUNT), mpmath.mpf(0))
        for k, (one, other) in enumerate(inputs):
            args = (i, w, one, other, d)
            A = [derivative(lambda x, n=n: getattr(x, n), *args) for n in ("A_c", "A_b", "A_d")]
            phase = derivative(lambda x: x.phi, *args) / dn
            rate = derivative(lambda x: mpmath.log(x.p), *args)
            modulus = derivative(lambda x: x.m, *args) / k1
            frequency = derivative(lambda x: mpmath.log(x.frequency), *args)
            poles = derivative(lambda x: x.poles, *args)
            tip = mpmath.norm(derivative(lambda x: x.pole, *args))
            wanted = [*A, phase, rate, modulus]
            # Sizes: a unit of an input over the gaps, rates and k1 that stand below it.
            few = 400 * U / (float(dn) * k1 * min(low, high, least) ** 2 * min(here.A_c, here.A_b, here.A_d))
            for got, want in zip(table[k], wanted, strict=True):
                assert abs(got - want) <= few
            # A_d > 0 for either sense of the spin.
            for n, value in zip(
                (at.AMPLITUDE_C, at.AMPLITUDE_B, at.AMPLITUDE_D, at.PHASE, at.RATE, at.MODULUS,
                 at.FREQUENCY, at.POLE_C, at.POLE_B, at.POLE_D, at.TIP),
                (*wanted, frequency, *poles, tip),
                strict=True,
            ):  # fmt: skip
                named[n] += abs(value)
        for n in (at.AMPLITUDE_C, at.AMPLITUDE_B, at.AMPLITUDE_D, at.PHASE, at.RATE, at.MODULUS,
                  at.POLE_C, at.POLE_B, at.POLE_D, at.TIP):  # fmt: skip
            assert abs(sums[n] - named[n]) <= len(inputs) * few
        # The slope of the quarter period is there to a few digits only.
        assert abs(sums[at.FREQUENCY] - named[at.FREQUENCY]) <= len(inputs) * few + 1e-7 * named[at.MODULUS]


@settings(deadline=None, derandomize=True, max_examples=draws(100))
@given(
    st.tuples(gap, gap, gap),
    st.tuples(spin, spin, spin),
    direction,
    direction,
    st.floats(0, 1),
    st.sampled_from([0, 2]),
    st.sampled_from([-1, 0, 2]),
)
def test_what_holds_of_every_motion(moments, rates, dI, dw, turned, axis, third) -> None:
    i, w = np.sort(np.array(moments)), np.array(rates)
    if third >= 0:
        i[1] = i[2 - third]
    low, high = np.diff(i)
    sums = np.zeros(COUNT)
    add_start(i, low, high, w, axis, np.array([dI, dI]), np.array([dw, dw]), np.array([turned, turned]), sums)
    a, b = np.array(dI), np.array(dw)
    size = np.linalg.norm(w)
    h = 1e-6
    coefficients = [np.array([(x[k - 2] - x[k - 1]) / x[k] for k in range(3)]) for x in (i + h * a, i - h * a)]
    # A central difference in doubles: rounding over h, and h^2.
    force = np.abs(coefficients[0] - coefficients[1]).max() / (2 * h)
    assert sums[at.FORCE] == pytest.approx(2 * force, abs=1e-6)
    third = 2 if low == 0.0 < high else 0 if high == 0.0 < low else -1
    others = [abs(a[k] - a[axis]) / abs(i[k] - i[axis]) for k in range(3) if i[k] != i[axis]]
    assert sums[at.GAPS] == pytest.approx(2 * max(others, default=0.0), rel=1e-6)
    each = np.abs(coefficients[0] - coefficients[1]) / (2 * h)
    assert sums[at.FORCE_ALONG] == pytest.approx(2 * each[third] if third >= 0 else 0.0, abs=1e-6)
    assert sums[at.FORCE_ACROSS] == pytest.approx(2 * max(each[k] for k in range(3) if k != third), abs=1e-6)
    assert sums[at.START_A : at.START_C + 1] == pytest.approx(2 * np.abs(b), rel=8 * U)
    assert sums[at.TURN] == 2 * turned
    assert sums[at.MOMENTS] == pytest.approx(2 * np.abs(a / i).max(), rel=8 * U)
    along, across = b @ w / size, np.linalg.norm(b - (b @ w) * w / size**2)
    assert sums[at.ALONG] == pytest.approx(2 * abs(along), abs=16 * U)
    assert sums[at.CROSSWISE] == pytest.approx(2 * across, abs=16 * U)


@settings(deadline=None, derandomize=True, max_examples=draws(200))
@given(st.floats(-12, -0.302).map(lambda e: 10.0**e), st.booleans())
def test_slope_of_the_quarter_period(least, near_one) -> None:
    with mpmath.workdps(60):
        m1 = mpmath.mpf(least) if near_one else 1 - mpmath.mpf(least)
        m, k1 = 1 - m1, mpmath.sqrt(m1)
        K = mpmath.ellipk(m)
        want = k1 * mpmath.diff(mpmath.ellipk, m, h=m * m1 * STEP)
        # The series that is used below m = 1e-4 leaves out 75 m^2/64 = 1.2e-8; nowhere else is it worse.
        assert abs(slope_of_quarter(float(m), float(k1), float(K)) - want) <= 1.3e-8 * want


def test_the_separatrix_has_no_quarter_period() -> None:
    assert slope_of_quarter(1.0, 0.0, 0.0) == 0.0
