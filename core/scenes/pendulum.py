"""The plane pendulum, psi'' = -w0^2 sin psi, in closed form: swinging, turning over, on the separatrix, at rest.

With s = sin(psi/2), c = cos(psi/2), r = psi'/(2 w0): m = s^2 + r^2 is constant, 1 - m = c^2 - r^2, and

    m < 1:  s = sqrt(m) sn(u|m),  c = dn(u|m),  r = sqrt(m) cn(u|m),        u = u0 + w0 t,
    m > 1:  s = d sn(u|1/m),      c = cn(u|1/m), r = d sqrt(m) dn(u|1/m),   u = u0 + sqrt(m) w0 t,
    m = 1:  s = d tanh u,         c = sech u,    r = d sech u,              u = u0 + w0 t,

d being the sign of psi'.

References
----------
NIST Digital Library of Mathematical Functions, 22.19(i); 19.25(v) for u0 by R_F.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import Literal

import numpy as np

from core.arrays import Floats
from core.balls import raised
from core.compiled import kernel
from core.double_double import dd_add, dd_mul_d
from core.elliptic.functions import LARGEST_QUARTER, jacobi_at, separatrix_at, split_phase
from core.elliptic.lattice import Lattice, lattice
from core.errors import AccuracyUnreachable
from core.scenes.enclosure import ONE, UNIT_ROUNDOFF, ZERO, Ball, as_pair, exact, rf, sign, square_root

Regime = Literal["rest", "libration", "separatrix", "rotation"]


@kernel()
def _jacobi_along(times: Floats, lat: Lattice, f: float, f_low: float, u: float, u_low: float, out: Floats) -> None:
    """Fill in sn, cn, dn and the number of quarter periods for the phase f t + u in quarter periods."""
    for i in range(times.size):
        n, r, low = split_phase(f, f_low, times[i], u, u_low)
        out[0, i], out[1, i], out[2, i] = jacobi_at(lat, n, r, low)
        out[3, i] = n + r


@kernel()
def _separatrix_along(times: Floats, f: float, f_low: float, u: float, u_low: float, out: Floats) -> None:
    """Fill in tanh and sech of f t + u."""
    for i in range(times.size):
        h, low = dd_mul_d(f, f_low, times[i])
        h, low = dd_add(h, low, u, u_low)
        out[0, i], out[1, i] = separatrix_at(h, low)


@dataclass(frozen=True)
class Pendulum:
    """A pendulum in its given state, as balls.

    Attributes
    ----------
    frequency : ball
        w0, of small oscillations (rad/s).
    sine, cosine : ball
        Of half the angle from the downward vertical; the cosine is positive.
    rate : ball
        psi' (rad/s).
    """

    frequency: Ball
    sine: Ball
    cosine: Ball
    rate: Ball

    @property
    def _r(self) -> Ball:
        return self.rate / (2 * self.frequency)

    @cached_property
    def m(self) -> Ball:
        """Energy over that of the upright rest: sin^2 of half the amplitude while it swings."""
        return raised(self.sine, 2) + raised(self._r, 2)

    @cached_property
    def m1(self) -> Ball:
        """1 - m, negative while it turns over."""
        return raised(self.cosine, 2) - raised(self._r, 2)

    @property
    def whole(self) -> tuple[Ball, Ball]:
        """Sine and cosine of the angle itself."""
        return 2 * self.sine * self.cosine, (self.cosine - self.sine) * (self.cosine + self.sine)

    @property
    def direction(self) -> int:
        """Sign of the rate."""
        return sign(self.rate)

    @property
    def regime(self) -> Regime:
        """Which branch of the solution holds."""
        if sign(self.m) == 0:
            return "rest"
        return {1: "libration", 0: "separatrix", -1: "rotation"}[sign(self.m1)]  # type: ignore[return-value]

    @cached_property
    def _modulus(self) -> tuple[Ball, Ball]:
        """Parameter of the elliptic functions, and its complement."""
        return (self.m, self.m1) if self.regime == "libration" else (1 / self.m, -self.m1 / self.m)

    @cached_property
    def _quarter(self) -> Ball:
        """K of that parameter."""
        return ONE.pi() / (2 * ONE.agm(self._modulus[1].sqrt()))

    @cached_property
    def speed(self) -> Ball:
        """du/dt."""
        return self.frequency * (self.m.sqrt() if self.regime == "rotation" else 1)

    @cached_property
    def start(self) -> Ball:
        """u0."""
        return self._argument(self.sine, self.cosine, self.direction if self.regime != "libration" else sign(self._r))

    def _argument(self, sine: Ball, cosine: Ball, way: int) -> Ball:
        """Return u at half an angle of the given sine and cosine, passed in the direction `way`."""
        if self.regime == "separatrix":
            return (way * sine / cosine).asinh()
        m, m1 = self._modulus
        if self.regime == "rotation":
            return way * sine * rf(raised(cosine, 2), m1 + m * raised(cosine, 2), ONE)
        sn = sine / self.m.sqrt()
        cn2 = 1 - raised(sn, 2)
        if sign(cn2) <= 0:
            return sign(sine) * self._quarter
        u = sn * rf(cn2, raised(cosine, 2), ONE)
        if way >= 0:
            return u
        return (2 if sign(sine) >= 0 else -2) * self._quarter - u

    @property
    def period(self) -> Ball | None:
        """Period of the angle, modulo a whole turn; None at rest and on the separatrix."""
        if self.regime in ("rest", "separatrix"):
            return None
        return (4 if self.regime == "libration" else 2) * self._quarter / self.speed

    def passes(self, sine: Ball, cosine: Ball, way: int) -> Ball | None:
        """Return the first t >= 0 at which half the angle is passed the given way, or None.

        Half the angle is given by its sine and its positive cosine. A turning point counts as moving both ways.
        """
        regime = self.regime
        if regime == "rest" or (regime != "libration" and way != self.direction):
            return None
        if regime == "libration" and sign(raised(sine, 2) - self.m) > 0:
            return None
        distance = self._argument(sine, cosine, way) - self.start
        if regime == "separatrix":
            return None if sign(distance) < 0 else distance / self.speed
        cycle = (4 if regime == "libration" else 2) * self._quarter
        turns = distance / cycle
        nearest = exact(float(turns.mid().floor()))
        rest = distance - nearest * cycle
        if sign(rest - cycle) == 0 or sign(rest) == 0:
            return ZERO
        return rest / self.speed

    def sample(self, times: Floats) -> tuple[Floats, Floats, Floats, Floats]:
        """Return s, c, psi' and the angle psi (continued over whole turns) at `times`.

        Raises
        ------
        AccuracyUnreachable
            Where the phase has no digits left.
        """
        regime = self.regime
        if regime == "rest":
            flat = np.zeros_like(times)
            return flat, flat + 1.0, flat, flat.copy()
        swing = float(2 * self.frequency * square_root(self.m))
        if regime == "separatrix":
            out = np.empty((2, times.size))
            _separatrix_along(times, *as_pair(self.speed), *as_pair(self.start), out)
            d = float(self.direction)
            return d * out[0], out[1], d * swing * out[1], d * 2.0 * np.arctan2(out[0], out[1])
        quarters = as_pair(self.speed / self._quarter)
        if float(np.max(np.abs(times), initial=0.0)) * quarters[0] > LARGEST_QUARTER:
            raise AccuracyUnreachable(
                UNIT_ROUNDOFF, 1.0, "the phase of the swing is lost after 2^50 quarter periods", path=("times",)
            )
        m, m1 = self._modulus
        k, kc = as_pair(m.sqrt()), as_pair(m1.sqrt())
        out = np.empty((4, times.size))
        _jacobi_along(times, lattice(*k, *kc), *quarters, *as_pair(self.start / self._quarter), out)
        sn, cn, dn, phase = out
        if regime == "libration":
            s = float(m.sqrt()) * sn
            return s, dn, swing * cn, 2.0 * np.arctan2(s, dn)
        d = float(self.direction)
        half = np.arctan2(sn, cn)
        turns = np.round((0.5 * np.pi * phase - half) / (2.0 * np.pi))
        return d * sn, cn, d * swing * dn, d * (2.0 * half + 4.0 * np.pi * turns)
