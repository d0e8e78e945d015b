"""Jacobi's elliptic functions as quotients of theta functions, in ball arithmetic, for 0 <= m < 1.

The argument is counted in half periods: z = u/2K. For a small ratio of half periods K'/K Jacobi's
imaginary transformation is applied, so the nome never exceeds exp(-pi), however near to 1 the parameter is.

References
----------
NIST Digital Library of Mathematical Functions, 22.2 (theta quotients), 22.6(iv) (imaginary transformation),
20.7(viii) (its theta functions), 19.25(v) (arguments by Carlson's R_F), 19.8 (K by the arithmetic-geometric mean).
"""

from __future__ import annotations

from functools import cached_property

from flint import acb, arb

from core.balls import Undetermined

ONE, HALF, ZERO = arb(1), arb(1) / 2, arb(0)


def carlson_rf(x: arb, y: arb, z: arb) -> arb:
    """Return R_F of non-negative arguments."""
    return acb.elliptic_rf(x, y, z).real


def _theta(z: acb, tau: acb, derivative: int = 0) -> tuple[acb, acb, acb, acb]:
    """Return theta1 to theta4 at pi z, or their derivatives with respect to z."""
    return acb.modular_theta(z, tau, derivative)


def split(z: arb) -> tuple[int, arb]:
    """Return the integer nearest to a number and the remainder, in [-1/2, 1/2]."""
    nearest = (z.mid() + HALF).mid().floor()
    whole = nearest.unique_fmpz()
    if whole is None:
        raise Undetermined
    return int(whole), z - nearest


class EllipticFunctions:
    """sn, cn and dn of one parameter, at the precision of its construction.

    Parameters
    ----------
    m, m1 : arb
        The parameter and 1 - m, each enclosed with a small relative radius; m >= 0, m1 > 0.
    """

    def __init__(self, m: arb, m1: arb) -> None:
        self.m, self.m1, self.k1 = m, m1, m1.sqrt()
        self.quarter = arb.pi() / (2 * ONE.agm(self.k1))
        self.circular = m.is_zero() or m1.mid() >= m.mid()

    @cached_property
    def other_quarter(self) -> arb:
        """K' = K(1 - m), for m > 0."""
        return arb.pi() / (2 * ONE.agm(self.m.sqrt()))

    @cached_property
    def _tau(self) -> acb:
        ratio = self.other_quarter / self.quarter
        return acb(0, ratio if self.circular else 1 / ratio)

    @cached_property
    def _factors(self) -> tuple[arb, arb, arb]:
        """Constant factors of the quotients sn, cn, dn: theta functions at 0."""
        _, t2, t3, t4 = (theta.real for theta in _theta(acb(0), self._tau))
        return (t3 / t2, t4 / t2, t4 / t3) if self.circular else (t3 / t4, t2 / t4, t2 / t3)

    @cached_property
    def _turn(self) -> arb:
        return self.quarter / self.other_quarter

    def at(self, z: arb) -> tuple[arb, arb, arb]:
        """Return sn, cn, dn of u = 2K z."""
        n, r = split(z)
        sn, cn, dn = self.near(r)
        return (-sn, -cn, dn) if n % 2 else (sn, cn, dn)

    def near(self, r: arb) -> tuple[arb, arb, arb]:
        """Return sn, cn, dn of u = 2K r for r in [-1/2, 1/2]."""
        if self.m.is_zero():
            sn, cn = r.sin_cos_pi()
            return sn, cn, ONE
        s, c, d = self._factors
        if self.circular:
            t1, t2, t3, t4 = _theta(acb(r), self._tau)
            over = 1 / t4.real
            return s * t1.real * over, c * t2.real * over, d * t3.real * over
        t1, t2, t3, t4 = _theta(acb(0, r * self._turn), self._tau)
        over = 1 / t2.real
        return s * t1.imag * over, c * t4.real * over, d * t3.real * over

    def argument(self, sn: arb, cn: arb, dn: arb) -> arb:
        """Return u in [-2K, 2K] from its three functions; near a quarter period from the distance to it."""
        if (sn * sn * (1 + self.k1)).mid() <= 1:
            u = sn * carlson_rf(cn * cn, dn * dn, ONE)
            if cn.mid() >= 0:
                return u
            return 2 * self.quarter - u
        left = cn * carlson_rf(self.m1 * sn * sn, self.m1, dn * dn)
        return self.quarter - left if sn.mid() > 0 else left - self.quarter


class PhaseOfTheta:
    """The argument of theta4(z - i eta/2K | 2i K'/K), z real in half periods.

    This is the part of a precession angle that is not proportional to time.

    Parameters
    ----------
    functions : EllipticFunctions
        With m > 0.
    eta : arb
        In (0, K').
    """

    def __init__(self, functions: EllipticFunctions, eta: arb) -> None:
        self._functions = functions
        K, K1 = functions.quarter, functions.other_quarter
        if functions.circular:
            self._shift, self._tau = eta / (2 * K), acb(0, 2 * K1 / K)
        else:
            self._shift, self._tau = eta / (4 * K1), acb(0, K / (2 * K1))
            self._turn, self._slope = K / (2 * K1), eta / (2 * K1)

    def _value(self, r: arb, derivative: int = 0) -> acb:
        if self._functions.circular:
            return _theta(acb(r, -self._shift), self._tau, derivative)[3]
        return _theta(acb(-self._shift, -r * self._turn), self._tau, derivative)[1]

    def at(self, r: arb) -> tuple[arb, arb]:
        """Return cosine and sine of the argument, for r in [-1/2, 1/2]."""
        value = self._value(r)
        over = 1 / abs(value)
        c, s = value.real * over, value.imag * over
        if self._functions.circular:
            return c, s
        # The argument of the Gaussian factor of the transformed theta function is proportional to r.
        y, x = (r * self._slope).sin_cos_pi()
        return c * x - s * y, s * x + c * y

    def rate(self) -> arb:
        """Return d(argument)/dz at z = 0."""
        zero = arb(0)
        logarithmic = self._value(zero, 1) / self._value(zero)
        if self._functions.circular:
            return logarithmic.imag
        return (acb(0, -self._turn) * logarithmic).imag + arb.pi() * self._slope
