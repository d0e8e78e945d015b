"""Against Landen's ladder in mpmath, which uses no theta functions."""

import mpmath
import pytest
from flint import acb, arb
from mpmath import mp, mpf

from core.balls import precision
from core.elliptic.ball_functions import EllipticFunctions, PhaseOfTheta, split
from tests.oracles.elliptic import Periodic

DIGITS = 60
COMPLEMENTS = ["0.999", "0.75", "0.5000000001", "0.4999999999", "0.1", "1e-5", "1e-30", "1e-300", "1e-1000"]


def exactly(ball: arb) -> mpf:
    return mpf(ball.mid().str(DIGITS + 5, radius=False))


@pytest.mark.parametrize("m1", COMPLEMENTS)
def test_functions_in_every_quarter(m1: str):
    with precision(320), mp.workdps(DIGITS):
        small = arb(m1)
        functions = EllipticFunctions(1 - small, small)
        oracle = Periodic(1 - mpf(m1), mpf(m1), mpf(1))
        assert mpmath.almosteq(exactly(functions.quarter), oracle.quarter, mpf(10) ** -50)
        for z in ("0", "0.1", "-0.3", "0.5", "0.4999", "0.75", "1.2", "-2.45", "1001.3"):
            phase = oracle.phase(2 * oracle.quarter * mpf(z))
            odd = -1 if phase.turns % 2 else 1
            want = (odd * phase.sn, odd * phase.cn, phase.dn)
            for got, true in zip(functions.at(arb(z)), want, strict=True):
                # Relative to itself; where cn vanishes, relative to its slope k' there and the oracle's own digits.
                assert abs(exactly(got) - true) <= mpf(10) ** -45 * abs(true) + mpf(10) ** -55 * mp.sqrt(mpf(m1))


@pytest.mark.parametrize("m1", COMPLEMENTS)
def test_the_argument_is_found_again_from_its_functions(m1: str):
    with precision(400):
        small = arb(m1)
        functions = EllipticFunctions(1 - small, small)
        for z in ("0", "0.1", "-0.3", "0.45", "-0.499999", "0.55", "-0.7", "0.99"):
            u = 2 * functions.quarter * arb(z)
            found = functions.argument(*functions.at(arb(z)))
            turns, rest = split((found - u) / (4 * functions.quarter))
            assert turns in (-1, 0, 1)
            assert abs(rest) < arb("1e-70")


def test_no_parameter_at_all_is_trigonometry():
    with precision(200):
        functions = EllipticFunctions(arb(0), arb(1))
        sn, cn, dn = functions.at(arb("0.3"))
        assert sn.overlaps((arb("0.3") * arb.pi()).sin())
        assert cn.overlaps((arb("0.3") * arb.pi()).cos())
        assert dn == 1


@pytest.mark.parametrize("m1", ["0.9", "0.3", "1e-3"])
def test_direction_of_theta_on_either_lattice(m1: str):
    with precision(300):
        small = arb(m1)
        functions = EllipticFunctions(1 - small, small)
        K, K1 = functions.quarter, functions.other_quarter
        for share in ("0.1", "0.7", "0.999"):
            eta = arb(share) * K1
            phase = PhaseOfTheta(functions, eta)
            for z in ("0", "0.2", "-0.4", "0.5"):
                theta = acb.modular_theta(acb(arb(z), -eta / (2 * K)), acb(0, 2 * K1 / K))[3]
                c, s = phase.at(arb(z))
                assert (c * abs(theta)).overlaps(theta.real)
                assert (s * abs(theta)).overlaps(theta.imag)
            step = arb("1e-20")
            c, s = phase.at(step)
            assert abs(s / c / step - phase.rate()) < arb("1e-15") * (1 + abs(phase.rate()))


def test_splitting():
    for z, n in (("2.75", 3), ("-2.75", -3), ("1e40", 10**40)):
        with precision(200):
            whole, rest = split(arb(z))
        assert whole == n
        assert abs(rest) <= arb("0.25")
