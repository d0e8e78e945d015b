"""A free rotation that turns, as balls of one precision: its constants, its samples, its attitude.

In the right-handed frame (x, y, z) with z along the circled axis d, towards the spin, and x along the other extreme c,

    w_x = A_c cn u,   w_y = g A_b sn u,   w_z = A_d dn u,   u = u0 + p t,

g = 1 where d has the largest moment and -1 where it has the smallest. The attitude is Rz(psi) P, P the shortest arc
that takes the angular momentum to z, which never is singular because M_z > 0; and psi' = (2E + L w_z)/(L + M_z), an
elliptic function of u with poles at 2iK' +- i eta, dn(i eta) = L/M_z(u=0), so that

    psi = kappa u + 2 g arg theta4(z - i eta/2K | 2i K'/K),   z = u/2K,

in which kappa follows from psi' at u = 0. On the separatrix psi = L u/(B p) - 2 g arctan(h tanh(u/2)) with
h = M_x/(L + M_z) at u = 0. Half of psi is all that a quaternion needs, and neither form has a branch to choose.

References
----------
E. T. Whittaker, "A Treatise on the Analytical Dynamics of Particles and Rigid Bodies", 4th ed., sections 69-71, for the
quotients of theta functions. NIST Digital Library of Mathematical Functions, 22.16 and 20.5 for their logarithms.
"""

from __future__ import annotations

from collections.abc import Callable
from functools import cached_property
from typing import NamedTuple, Protocol

from flint import arb

from core.balls import Undetermined
from core.elliptic.ball_functions import ONE, EllipticFunctions, PhaseOfTheta, carlson_rf, split
from core.rotation.exact_start import Balls, PrincipalState

QuaternionBalls = tuple[arb, arb, arb, arb]


class MotionConstants(NamedTuple):
    """What a polhode determines: amplitudes (rad/s), the rate p of the phase (1/s), and the parameter of the functions.

    Attributes
    ----------
    amplitudes : 3 balls
        A_c, A_b, A_d.
    p, m, m1 : arb
        m1 = 1 - m, formed without cancellation.
    """

    amplitudes: Balls
    p: arb
    m: arb
    m1: arb

    def least_tilt(self, moments: Balls, side: int) -> arb:
        """Return the least angle between the middle axis and the angular momentum, where w_c vanishes (rad).

        tan(least) = I_d A_d k'/(I_b A_b): see `core.rotation.precession.middle_axis`. Parameters as in `constants_of`.
        """
        circled = moments[2] if side > 0 else moments[0]
        return arb.atan2(circled * self.amplitudes[2] * self.m1.sqrt(), moments[1] * self.amplitudes[1])

    @property
    def half_period(self) -> arb:
        """2K/p (s), where m1 > 0."""
        return arb.pi() / (ONE.agm(self.m1.sqrt()) * self.p)


def constants_of(moments: Balls, gaps: Balls, rates: Balls, side: int, difference: arb) -> MotionConstants:
    """Return the constants of the motion through a state.

    Parameters
    ----------
    moments, rates : 3 balls
        Along ascending principal axes.
    gaps : 3 balls
        B - A, C - B, C - A.
    side : int
        1 where the axis of the largest moment is circled, -1 where that of the smallest is.
    difference : arb
        |L^2 - 2E B|.
    """
    low, middle, high = moments
    ab, bc, ac = gaps
    wa, wb, wc = (w * w for w in rates)
    # L^2 - 2E I of the circled axis d and of the other extreme c, as sums of terms of one sign.
    of_least, of_most = high * ac * wc + middle * ab * wb, low * ac * wa + middle * bc * wb
    X, Y, bd, cb = (of_most, of_least, bc, ab) if side > 0 else (of_least, of_most, ab, bc)
    I_c, I_d = (low, high) if side > 0 else (high, low)
    amplitudes = ((X / (I_c * ac)).sqrt(), (X / (middle * bd)).sqrt(), (Y / (I_d * ac)).sqrt())
    p = (bd * Y / (low * middle * high)).sqrt()
    return MotionConstants(amplitudes, p, cb * X / (bd * Y), ac * difference / (bd * Y))


class TurningStart(Protocol):
    """The start of a rotation that is no steady spin."""

    @property
    def side(self) -> int:
        """The sign of D_B = L^2 - 2E B."""

    def principal_state(self) -> PrincipalState:
        """Return the start in principal axes at the current precision."""

    def difference(self, middle: arb) -> arb:
        """Return |D_B|, given the middle moment B."""

    def invariants(self) -> tuple[arb, arb]:
        """Return L^2 and 2E."""


class TurningMotion:
    """The constants of one motion at the precision at which it was built.

    Parameters
    ----------
    start : TurningStart
        Of regime ``"periodic"`` or ``"separatrix"``.

    Raises
    ------
    Undetermined
        If the precision does not tell what the constants are.
    """

    def __init__(self, start: TurningStart) -> None:
        state = start.principal_state()
        self.start, self.side, self.axes = start, start.side or -1, state.axes
        self.moments = state.moments
        d, c = (2, 0) if self.side > 0 else (0, 2)
        self.circled, self.other = d, c
        difference = start.difference(state.moments[1])
        constants = constants_of(state.moments, state.gaps, state.rates, self.side, difference)
        self.constants = constants
        self.A_c, self.A_b, self.A_d = constants.amplitudes
        self.p, self.m, self.m1 = constants.p, constants.m, constants.m1
        squared, self.twice_energy = start.invariants()
        self.L = squared.sqrt()
        # x and z along or against their principal axes; y completes them.
        towards_d = _sign(state.rates[d])
        towards_c = _sign(state.rates[c]) if self.separatrix else 1
        self.signs = (towards_c, towards_c * towards_d * (1 if d == 2 else -1), towards_d)
        sx, sy, sz = self.signs
        sn, cn, dn = (
            self.side * sy * state.rates[1] / self.A_b,
            sx * state.rates[c] / self.A_c,
            sz * state.rates[d] / self.A_d,
        )
        if self.separatrix:
            self.u0 = sn * carlson_rf(cn * cn, cn * cn, ONE)
            self.z0, self.frequency = self.u0, self.p
        else:
            self.functions = EllipticFunctions(self.m, self.m1)
            half = 2 * self.functions.quarter
            self.u0 = self.functions.argument(sn, cn, dn)
            self.z0, self.frequency = self.u0 / half, self.p / half

    @property
    def separatrix(self) -> bool:
        """Whether the motion tends to the middle axis and never returns."""
        return self.start.side == 0

    @property
    def largest_rate(self) -> arb:
        """Largest norm of the angular velocity in the whole motion."""
        first = (self.A_c * self.A_c + self.A_d * self.A_d).sqrt()
        second = (self.A_b * self.A_b + self.m1 * self.A_d * self.A_d).sqrt()
        return first if first.mid() >= second.mid() else second

    @property
    def least_tilt(self) -> arb:
        """Least angle between the middle axis and the angular momentum, 0 on the separatrix (rad)."""
        return self.constants.least_tilt(self.moments, self.side)

    def phase(self, time: arb) -> arb:
        """Return the phase in half periods of the elliptic functions; on the separatrix, u itself."""
        return self.z0 + self.frequency * time

    def in_frame(self, phase: arb) -> Balls:
        """Return the angular velocity in the frame (x, y, z)."""
        if self.separatrix:
            sech, tanh = phase.sech(), phase.tanh()
            return self.A_c * sech, self.side * self.A_b * tanh, self.A_d * sech
        sn, cn, dn = self.functions.at(phase)
        return self.A_c * cn, self.side * self.A_b * sn, self.A_d * dn

    def along_principal_axes(self, v: Balls) -> Balls:
        """Return a vector of the frame along the ascending principal axes."""
        x, y, z = (s * entry for s, entry in zip(self.signs, v, strict=True))
        return (x, y, z) if self.circled == 2 else (z, y, x)

    def in_body(self, v: Balls) -> Balls:
        """Return a vector of the frame in body axes."""
        a, b, c = self.along_principal_axes(v)
        x, y, z = (row[0] * a + row[1] * b + row[2] * c for row in self.axes)
        return x, y, z

    def angular_velocity(self, time: arb) -> Balls:
        """Return the angular velocity in body axes."""
        return self.in_body(self.in_frame(self.phase(time)))

    def attitudes(self, q0: QuaternionBalls) -> Callable[[arb, Balls], QuaternionBalls]:
        """Return the attitude that is `q0` at t = 0, as a function of phase and angular velocity in the frame."""
        w, x, y, z = self.turned(self.z0, self.in_frame(self.z0))
        columns = []
        for k in range(4):
            back = product((w, -x, -y, -z), _unit_quaternion(k))
            columns.append(product(q0, (back[0], *self.in_body(back[1:]))))
        rows = list(zip(*columns, strict=True))

        def at(phase: arb, v: Balls) -> QuaternionBalls:
            a, b, c, d = self.turned(phase, v)
            w, x, y, z = (row[0] * a + row[1] * b + row[2] * c + row[3] * d for row in rows)
            return w, x, y, z

        return at

    @property
    def period(self) -> arb | None:
        """4K/p, None on the separatrix."""
        return None if self.separatrix else 2 / self.frequency

    @cached_property
    def _at_zero(self) -> tuple[arb, arb]:
        """M_x and M_z at u = 0."""
        return self.moments[self.other] * self.A_c, self.moments[self.circled] * self.A_d

    @cached_property
    def _phase_of_theta(self) -> PhaseOfTheta | None:
        if self.m.is_zero():
            return None
        x, z = self._at_zero
        tangent = x * x / (self.m * z * z)
        over = 1 / (1 + tangent)
        eta = (tangent * over).sqrt() * carlson_rf(over, (1 + self.m * tangent) * over, ONE)
        return PhaseOfTheta(self.functions, eta)

    @cached_property
    def psi_per_half_period(self) -> arb:
        """By how much psi grows while u grows by 2K."""
        _, z = self._at_zero
        half = 2 * self.functions.quarter
        uniform = (self.twice_energy + self.L * self.A_d) / (self.p * (self.L + z)) * half
        if self._phase_of_theta is None:
            return uniform
        return uniform - 2 * self.side * self._phase_of_theta.rate()

    @property
    def precession_per_period(self) -> arb | None:
        """Angle by which axis d turns about the angular momentum in one period, not reduced; None on the separatrix."""
        if self.separatrix:
            return None
        # psi differs from Euler's angle by the turn that P makes with the momentum, once a period.
        return 2 * self.psi_per_half_period + 2 * self.side * arb.pi()

    @cached_property
    def _half_turns(self) -> arb:
        return self.psi_per_half_period / (2 * arb.pi())

    def _half_psi(self, phase: arb) -> tuple[arb, arb]:
        """Return cosine and sine of psi/2, up to a common positive factor."""
        if self.separatrix:
            x, z = self._at_zero
            real, imag = ONE, -self.side * x / (self.L + z) * (phase / 2).tanh()
            sin, cos = (self.L / (2 * self.moments[1] * self.p) * phase).sin_cos()
        else:
            sin, cos = (self._half_turns * phase).sin_cos_pi()
            if self._phase_of_theta is None:
                return cos, sin
            _, r = split(phase)
            real, imag = self._phase_of_theta.at(r)
            imag = self.side * imag
        return cos * real - sin * imag, sin * real + cos * imag

    def turned(self, phase: arb, v: Balls) -> QuaternionBalls:
        """Return the attitude Rz(psi) P of the frame, as a unit quaternion, where the angular velocity in it is `v`."""
        mx, my, mz = self.moments[self.other] * v[0], self.moments[1] * v[1], self.moments[self.circled] * v[2]
        c, s = self._half_psi(phase)
        total = self.L + mz
        q = (c * total, c * my + s * mx, s * my - c * mx, s * total)
        over = 1 / ((c * c + s * s) * (2 * self.L * total)).sqrt()
        w, x, y, z = (entry * over for entry in q)
        return w, x, y, z


def _sign(ball: arb) -> int:
    if ball > 0:
        return 1
    if ball < 0:
        return -1
    raise Undetermined


def product(p: QuaternionBalls, q: QuaternionBalls) -> QuaternionBalls:
    """Return Hamilton's product of two quaternions [w, x, y, z]."""
    a, b, c, d = p
    w, x, y, z = q
    return (
        a * w - b * x - c * y - d * z,
        a * x + b * w + c * z - d * y,
        a * y - b * z + c * w + d * x,
        a * z + b * y - c * x + d * w,
    )


def _unit_quaternion(k: int) -> QuaternionBalls:
    w, x, y, z = (arb(int(k == n)) for n in range(4))
    return w, x, y, z
