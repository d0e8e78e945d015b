"""The two kinds of torque-free motion, constant and moving, evaluated to any number of digits from exact inputs.

References
----------
.. [1] L. D. Landau, E. M. Lifshitz, Mechanics, 3rd ed., sections 35 (Euler's angles) and 37 (the asymmetrical top).
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from fractions import Fraction
from functools import cached_property

from mpmath import mp, mpf

from .elliptic import SLACK, Aperiodic, Periodic, Phase, decimal_digits
from .polhode import Axes, Polhode

Vector = tuple[mpf, mpf, mpf]
Quaternion = tuple[mpf, mpf, mpf, mpf]


def real(x: Fraction) -> mpf:
    """Round a fraction to the current precision."""
    return mpf(x.numerator) / x.denominator


def root(x: Fraction) -> mpf:
    """Return the square root of a fraction at the current precision."""
    return mp.sqrt(real(x))


def rounded(values: Iterable[mpf], digits: int) -> tuple[mpf, ...]:
    """Round to `digits` significant digits."""
    with mp.workdps(digits):
        return tuple(+x for x in values)


def product(p: Sequence[mpf], q: Sequence[mpf]) -> Quaternion:
    """Return Hamilton's product of two quaternions [w, x, y, z]."""
    a, b, c, d = p
    w, x, y, z = q
    return (
        a * w - b * x - c * y - d * z,
        a * x + b * w + c * z - d * y,
        a * y - b * z + c * w + d * x,
        a * z + b * y - c * x + d * w,
    )


class Constant:
    """A body that keeps its angular velocity, and turns about it.

    Parameters
    ----------
    rates : sequence of 3 fractions
        Angular velocity along the body's axes.
    horizon : Fraction
        The largest absolute time that will be asked for.
    digits : int
        Digits wanted.
    """

    period = None
    precession_per_period = None

    def __init__(self, rates: Sequence[Fraction], horizon: Fraction, digits: int) -> None:
        self.rates, self.digits = rates, digits
        self.dps = digits + SLACK + decimal_digits(real(horizon * max(map(abs, rates))))
        with mp.workdps(self.dps):
            self.largest_rate = root(sum((w * w for w in rates), Fraction(0)))

    def angular_velocity(self, time: Fraction) -> Vector:
        """Return the angular velocity in the body."""
        with mp.workdps(self.digits):
            x, y, z = map(real, self.rates)
            return x, y, z

    def rotation(self, time: Fraction) -> Quaternion:
        """Return the rotation since the start, to a few more digits than wanted."""
        with mp.workdps(self.dps):
            if not self.largest_rate:
                return mpf(1), mpf(0), mpf(0), mpf(0)
            cosine, sine = mp.cos_sin(self.largest_rate * real(time) / 2)
            x, y, z = (sine * real(w) / self.largest_rate for w in self.rates)
            return cosine, x, y, z


class Moving:
    """A body whose angular velocity runs along a polhode.

    Parameters
    ----------
    polhode : Polhode
        The exact facts.
    horizon, digits
        As for `Constant`.
    """

    def __init__(self, polhode: Polhode, horizon: Fraction, digits: int) -> None:
        self.polhode, self.digits = polhode, digits
        self._set_up(digits + SLACK)
        # Every digit that the phase or the precession has before its decimal point is lost behind it.
        reach = real(horizon) + (self.period or abs(self.start) / self.p)
        fastest = max(self.p, self.momentum / min(self.moments.b, self.moments.c))
        self._set_up(digits + SLACK + decimal_digits(reach * fastest))

    def _set_up(self, dps: int) -> None:
        polhode, self.dps = self.polhode, dps
        with mp.workdps(dps):
            self.p, self.momentum = root(polhode.squared_p), root(polhode.squared_momentum)
            self.k, n = real(polhode.k), real(polhode.n)
            self.moments = Axes(*map(real, polhode.moments))
            self.amplitudes = Axes(*map(root, polhode.squared_amplitudes))
            self.functions = Periodic(real(polhode.m), real(polhode.m1), n) if polhode.m1 else Aperiodic(n)
            _, cn2, dn2 = (w * w / a for w, a in zip(polhode.rates, polhode.squared_amplitudes, strict=True))
            self.start = self.functions.argument(real(polhode.rates.b) / self.amplitudes.b, real(cn2), real(dn2))

    @property
    def period(self) -> mpf | None:
        """Period of the angular velocity, None on the separatrix."""
        if isinstance(self.functions, Aperiodic):
            return None
        with mp.workdps(self.dps):
            return 4 * self.functions.quarter / self.p

    @property
    def precession_per_period(self) -> mpf | None:
        """Angle by which axis d turns about the angular momentum in a period, None on the separatrix."""
        if isinstance(self.functions, Aperiodic):
            return None
        with mp.workdps(self.dps):
            turned = self.functions.quarter - self.k * self.functions.complete_third_kind
            return 4 * self.momentum / self.moments.c * turned / self.p

    @property
    def largest_rate(self) -> mpf:
        """Largest angular velocity of the whole motion."""
        with mp.workdps(self.dps):
            return root(self.polhode.squared_largest_rate)

    def angular_velocity(self, time: Fraction) -> Vector:
        """Return the angular velocity in the body."""
        with mp.workdps(self.dps):
            components = zip(self.polhode.axes, self._components(self._phase(time)), strict=True)
        x, y, z = rounded((w for _, w in sorted(components)), self.digits)
        return x, y, z

    def rotation(self, time: Fraction) -> Quaternion:
        """Return the rotation since the start, to a few more digits than wanted."""
        with mp.workdps(self.dps):
            first, swept_before = self._first
            now = self._phase(time)
            swept = self.functions.third_kind(now) - swept_before
            unhurried = real(time) - self.polhode.direction * self.k * swept / self.p
            precession = self.momentum / self.moments.c * unhurried
            w, x, y, z = self._to_inertial(mpf(0), first)
            w, *vector = product((w, -x, -y, -z), self._to_inertial(precession, now))
            # The Euler angles live in the right-handed axes (d + 1, d + 2, d).
            d = self.polhode.axes.d
            x, y, z = (vector[i - d - 1] for i in range(3))
            return w, x, y, z

    @cached_property
    def _first(self) -> tuple[Phase, mpf]:
        first = self.functions.phase(self.start)
        return first, self.functions.third_kind(first)

    def _phase(self, time: Fraction) -> Phase:
        return self.functions.phase(self.start + self.polhode.direction * self.p * real(time))

    def _components(self, phase: Phase) -> Axes[mpf]:
        _, sign_c, sign_d = self.polhode.signs
        b, c, d = self.amplitudes
        odd = -1 if phase.turns % 2 else 1
        return Axes(odd * b * phase.sn, odd * sign_c * c * phase.cn, sign_d * d * phase.dn)

    def _to_inertial(self, precession: mpf, phase: Phase) -> Quaternion:
        """Return the rotation from the axes (d + 1, d + 2, d) to axes of which the third is the angular momentum.

        Euler's angles [1]_: precession, inclination of axis d, spin about it. No angle is ever reduced,
        so the half angles are as continuous as the motion.
        """
        m_b, m_c, m_d = (i * a for i, a in zip(self.moments, self.amplitudes, strict=True))
        _, sign_c, sign_d = self.polhode.signs
        m_b, m_c, m_d = m_b * phase.sn, m_c * phase.cn, sign_d * m_d * phase.dn
        around = mp.atan2(m_b, m_c) + phase.turns * mp.pi
        # Along (d + 1, d + 2) the momentum is proportional to (sin spin, cos spin).
        b, _, d = self.polhode.axes
        spin = sign_c * (around if b == (d + 1) % 3 else mp.pi / 2 - around)
        if b == (d + 1) % 3 and sign_c < 0:
            spin += mp.pi
        # Half the inclination from whichever of its sine and cosine is not small.
        sine, cosine = mp.hypot(m_b, m_c) / self.momentum, m_d / self.momentum
        large = mp.sqrt((1 + abs(cosine)) / 2)
        small = sine / (2 * large)
        tilt_cos, tilt_sin = (large, small) if cosine > 0 else (small, large)
        sum_cos, sum_sin = mp.cos_sin((precession + spin) / 2)
        difference_cos, difference_sin = mp.cos_sin((precession - spin) / 2)
        return tilt_cos * sum_cos, tilt_sin * difference_cos, tilt_sin * difference_sin, tilt_cos * sum_sin
