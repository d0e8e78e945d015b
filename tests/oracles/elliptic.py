"""Jacobi's elliptic functions and the integrals of the first and third kind, to any precision, for m in [0, 1].

The functions climb Landen's ladder, the incomplete integrals are Carlson's: neither uses theta functions. That of the
third kind is FLINT's, in balls, which takes a thirtieth of `mpmath`'s time.
`mpmath.ellipfun` would not do, since it takes the parameter m and not its complement and so knows nothing
of a pendulum that is 1e-300 short of the upright.

Everything works at the current precision of `mpmath.mp`.

References
----------
.. [1] NIST Digital Library of Mathematical Functions, 19.8 (arithmetic-geometric mean), 19.25 (Carlson's forms),
   22.20(ii) (Landen's ladder).
"""

from __future__ import annotations

from functools import cached_property
from typing import NamedTuple

from flint import acb, arb, ctx
from mpmath import mp, mpf

# Digits carried beyond those wanted, to cover plain rounding in a few hundred operations.
SLACK = 10


def decimal_digits(x: mpf) -> int:
    """Return how many digits stand before the decimal point of `x`, 0 if none."""
    return max(0, int(mp.mag(x) * 0.30103) + 1) if x else 0


def real_of(ball: arb) -> mpf:
    """Return the middle of a ball, rounded to the current precision."""
    mantissa, exponent = ball.mid().man_exp()
    return mp.ldexp(mpf(int(mantissa)), int(exponent))


def carlson_rj(x: mpf, y: mpf, z: mpf, p: mpf) -> mpf:
    """Return Carlson's integral of the third kind of real arguments, x, y, z >= 0 and p > 0."""
    bits, before = mp.prec, ctx.prec
    try:
        while True:
            bits *= 2
            ctx.prec = bits
            ball = acb.elliptic_rj(*map(acb, (x, y, z, p))).real
            if ball.rel_accuracy_bits() > mp.prec + 2:
                return real_of(ball)
    finally:
        ctx.prec = before


class Phase(NamedTuple):
    """An argument ``2 K turns + rest``, with ``rest`` in [-K, K], and sn, cn, dn of the rest."""

    turns: int
    rest: mpf
    sn: mpf
    cn: mpf
    dn: mpf


class Periodic:
    """The functions for ``m < 1``.

    Parameters
    ----------
    m, m1 : mpf
        Parameter and its complement ``m1 = 1 - m > 0``, each right to full relative precision; where one does not
        determine the other, the smaller is the truth.
    n : mpf
        Characteristic of the integral of the third kind, ``n >= 0``.
    """

    def __init__(self, m: mpf, m1: mpf, n: mpf) -> None:
        self.m, self.m1, self.n = m, m1, n
        self.quarter = mp.pi / (2 * mp.agm(1, mp.sqrt(m1)))

    def argument(self, sn: mpf, cn2: mpf, dn2: mpf) -> mpf:
        """Return the argument in [-K, K] whose sn, cn**2 and dn**2 are given [1]_ (19.25.5)."""
        return sn * mp.elliprf(cn2, dn2, 1)

    def phase(self, argument: mpf) -> Phase:
        """Return the phase of any argument."""
        turns = int(mp.nint(argument / (2 * self.quarter)))
        rest = argument - 2 * turns * self.quarter
        return Phase(turns, rest, *self._ladder(rest))

    def third_kind(self, phase: Phase) -> mpf:
        """Return the integral of ``sn**2 / (1 + n sn**2)`` from 0 [1]_ (19.25.14).

        It is the difference of the integrals of the third and the first kind over ``-n``, free of their cancellation.
        """
        _, _, sn, cn, dn = phase
        rest = sn**3 * carlson_rj(cn**2, dn**2, mpf(1), 1 + self.n * sn**2) / 3
        return rest + 2 * phase.turns * self.complete_third_kind if phase.turns else rest

    @cached_property
    def complete_third_kind(self) -> mpf:
        """The integral of ``sn**2 / (1 + n sn**2)`` from 0 to K."""
        return carlson_rj(mpf(0), self.m1, mpf(1), 1 + self.n) / 3

    def _ladder(self, u: mpf) -> tuple[mpf, mpf, mpf]:
        """Return sn, cn, dn of `u` in [-K, K], each right in relative precision [1]_ (22.20(ii)).

        Near the saddle each rung multiplies an error, by up to 1/sqrt(m1) over the whole ladder, and cn and dn are
        the distance of the amplitude from a right angle, as small as sqrt(m1). So 1/m1 says how many digits are
        lost, and as many more are carried.
        """
        with mp.workdps(mp.dps + SLACK + decimal_digits(1 / self.m1)):
            m, m1 = (1 - self.m1, self.m1) if self.m1 < self.m else (self.m, 1 - self.m)
            a, b, c = mpf(1), mp.sqrt(m1), mp.sqrt(m)
            ratios = []
            while c > mp.eps * a:
                # The next c is (a - b)/2, here without the cancellation.
                a, b, c = (a + b) / 2, mp.sqrt(a * b), c * c / (2 * (a + b))
                ratios.append(c / a)
            amplitude = mp.ldexp(a * u, len(ratios))
            for ratio in reversed(ratios):
                amplitude = (amplitude + mp.asin(ratio * mp.sin(amplitude))) / 2
            cn, sn = mp.cos_sin(amplitude)
            return sn, cn, mp.sqrt(cn**2 + m1 * sn**2)


class Aperiodic:
    """The functions for ``m = 1``: sn is tanh, cn and dn are sech, and nothing ever returns.

    Parameters
    ----------
    n : mpf
        As for `Periodic`, but positive.
    """

    def __init__(self, n: mpf) -> None:
        self.n = n

    def argument(self, sn: mpf, cn2: mpf, dn2: mpf) -> mpf:
        """Return the argument whose sn and cn**2 are given; cn is positive."""
        return mp.asinh(sn / mp.sqrt(cn2))

    def phase(self, argument: mpf) -> Phase:
        """Return the phase of any argument."""
        sech = mp.sech(argument)
        return Phase(0, argument, mp.tanh(argument), sech, sech)

    def third_kind(self, phase: Phase) -> mpf:
        """Return the integral of ``sn**2 / (1 + n sn**2)`` from 0, by partial fractions in sn."""
        root = mp.sqrt(self.n)
        return (phase.rest - mp.atan(root * phase.sn) / root) / (1 + self.n)
