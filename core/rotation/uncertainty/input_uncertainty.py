"""What a relative uncertainty of every input comes to, in angular velocity and attitude, as a function of time.

Of several first-order bounds, which all hold at once, the smallest is stated. The derivation of each is in
docs/physics/error-statements.md.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from core.rotation.closed_form.circulation import SEPARATRIX, STEADY
from core.rotation.closed_form.constants_of_motion import Motion
from core.rotation.uncertainty import constant_sensitivities as moved
from core.rotation.uncertainty.phase_sensitivities import largest_until
from core.rotation.uncertainty.sensitivities import FIRST_ORDER, Sensitivities

Floats = NDArray[np.float64]

WHOLE_MOTION = 2.0
"""An error of the angular velocity relative to its largest norm is never larger."""

WHOLE_TURN = math.pi
"""Nor an error of the attitude, as the angle (rad) of the turn that takes one attitude to the other."""

CURVATURE = 1.5
"""Second derivatives add at most this times the square of what the first ones move."""

_MOST = 600.0
_HUGE = 1e290


@dataclass(frozen=True, eq=False)
class InputUncertainty:
    """Bounds for one motion and a relative uncertainty of one, in scaled units.

    Attributes
    ----------
    motion : Motion
    moves : Sensitivities
        Of moments and start, with the sums over the inputs.
    unit : float
        The rate that scaled rates are measured in, a power of two (rad/s).
    largest : float
        Largest norm of the angular velocity in those units.
    """

    motion: Motion
    moves: Sensitivities
    unit: float
    largest: float

    def angular_velocity(self, uncertainty: float, horizon: float) -> float:
        """Return what the angular velocity may have moved by up to |t| = `horizon`, relative to its largest norm.

        At most 2, the whole motion, which is stated where the first order would be beyond a tenth.
        """
        grown = self._grown(uncertainty, self._scaled(horizon))
        return grown * (1.0 + CURVATURE * grown) if grown < FIRST_ORDER else WHOLE_MOTION

    def attitude(self, uncertainty: float, horizon: float) -> float:
        """Return the angle by which the attitude may have moved up to |t| = `horizon` (rad), at most pi.

        The attitude at the start is an input like the others; a component of a quaternion moves it by no more than
        the uncertainty, and all four by twice that.
        """
        time = self._scaled(horizon)
        # The attitude turns away by no more than the integral of the error of the angular velocity.
        turned = min(
            _known(self._grown(uncertainty, time) * self.largest * time), _known(self._turned(uncertainty, time))
        )
        turned = turned + 2.0 * uncertainty
        return turned * (1.0 + CURVATURE * turned) if turned < FIRST_ORDER else WHOLE_TURN

    def _scaled(self, horizon: float) -> float:
        return min(horizon * self.unit, 1e300)

    def _grown(self, uncertainty: float, time: float) -> float:
        early = self.moves.early(uncertainty, time)
        late = self._steady(uncertainty, time) if self.motion.regime == STEADY else self._turning(uncertainty, time)
        return min(_known(early), _known(late)) / self.largest

    def _steady(self, uncertainty: float, time: float) -> float:
        sums, growth = self.moves.sums, self.moves.crosswise(time)
        if uncertainty * sums[moved.TURN] > FIRST_ORDER:
            return math.inf
        return uncertainty * (sums[moved.ALONG] + sums[moved.TURN] * self.largest + growth * sums[moved.CROSSWISE])

    def _turning(self, u: float, time: float) -> float:
        m, s = self.motion, self.moves.sums
        if not self.moves.finite or u * max(s[moved.TURN], s[moved.RATE]) > FIRST_ORDER:
            return math.inf
        A = [abs(x) / self.unit for x in (m.A_c, m.A_b, m.A_d)]
        a = s[moved.AMPLITUDE_C], s[moved.AMPLITUDE_B], s[moved.AMPLITUDE_D]
        displaced = self._displaced(u, time, A, a)
        if self.moves.phases is not None and math.isfinite(self._phase(u, time)):
            half = 2.0 * m.lattice.K
            displaced = min(displaced, largest_until(self.moves.phases, self._angle(time), half, s[moved.FREQUENCY]))
        return u * (s[moved.TURN] * self.largest + displaced)

    def _displaced(self, u: float, time: float, A: list[float], a: tuple[float, float, float]) -> float:
        """Return a bound of |d(A_c cn, A_b sn, A_d dn)|, of which the amplitudes move by `a`."""
        m, s = self.motion, self.moves.sums
        amplitudes = math.hypot(max(a[0], a[1]), a[2])
        across = max(A[0], A[1])
        phase, slope = self._phase(u, time), math.hypot(across, 0.5 * m.m * A[2])
        by_phase = slope * phase + 0.5 * A[2] * s[moved.MODULUS] if math.isfinite(phase) else math.inf
        grown, escape = self._escape(time)
        early = s[moved.PHASE] + s[moved.RATE] * self._angle(time)
        by_escape = slope * early + s[moved.MODULUS] * (math.hypot(across, A[2]) * escape + 0.5 * A[2] * grown)
        return amplitudes + min(_known(by_phase), _known(by_escape))

    def _phase(self, u: float, time: float) -> float:
        """Return a bound of |Q|, what the phase u moves by, from the drift of the frequency."""
        m, s = self.motion, self.moves.sums
        if (
            m.regime == SEPARATRIX
            or not u * max(s[moved.FREQUENCY], _quotient(s[moved.MODULUS], self.moves.k1)) <= FIRST_ORDER
        ):
            return math.inf
        # Between phases the elliptic integral's derivative departs from its mean growth by K' at most, each.
        return float(s[moved.PHASE] + s[moved.FREQUENCY] * self._angle(time) + self._spread * s[moved.MODULUS])

    @property
    def _spread(self) -> float:
        m = self.motion
        return 2.0 * moved.slope_of_quarter(m.m, self.moves.k1, m.lattice.K) * (0.32 + 0.68 * m.m)

    def _angle(self, time: float) -> float:
        return self.motion.p / self.unit * time

    def _escape(self, time: float) -> tuple[float, float]:
        """Return bounds of k1/dn and of k1 dn times the integral of sn^2/2 dn^2 from the start: |dn'| <= dn."""
        angle = self._angle(time)
        if angle > _MOST:
            return _HUGE, _HUGE
        over = math.exp(angle) / self.moves.dn * (self.moves.k1 or 1.0)
        return over, 0.5 * angle * over

    def _turned(self, u: float, time: float) -> float:
        """Return a bound of the attitude's turn by way of the angular momentum, which it precesses about."""
        m, s = self.motion, self.moves.sums
        if (
            m.regime == STEADY
            or not self.moves.finite
            or u * max(s[moved.TURN], s[moved.RATE], s[moved.TIP]) > FIRST_ORDER
        ):
            return math.inf
        momenta, total = self._momenta
        pole = [_quotient(x, total) for x in momenta]
        wandering = self._displaced(u, time, pole, (s[moved.POLE_C], s[moved.POLE_B], s[moved.POLE_D]))
        angle, rate = self._angle(time), self.motion.p / self.unit
        if rate == 0.0:
            return math.inf
        early = s[moved.PHASE] + s[moved.RATE] * angle
        swing, steepest = self._swing
        late = early + s[moved.MODULUS] * self._growth(angle) if math.isfinite(self._phase(u, time)) else math.inf
        grown, escape = self._escape(time)
        by_phase = swing * late / rate + time * s[moved.SINGULAR] if math.isfinite(late) else math.inf
        by_escape = (swing * early + steepest * s[moved.MODULUS] * (escape + 0.5 * grown)) / rate
        by_escape += time * s[moved.SINGULAR] * grown
        turned = time * s[moved.PRECESSION] + min(_known(by_phase), _known(by_escape))
        return u * (s[moved.TIP] + 2.0 * s[moved.TURN] + math.sqrt(2.0) * (s[moved.TIP] + _known(wandering)) + turned)

    @cached_property
    def _momenta(self) -> tuple[list[float], float]:
        """Amplitudes of the angular momentum along c, b, d, and its norm."""
        m, (A, B, C) = self.motion, self.moves.moments.tolist()
        I_c, I_d = (A, C) if m.circled == 2 else (C, A)
        amplitudes = [abs(i * x) / self.unit for i, x in ((I_c, m.A_c), (B, m.A_b), (I_d, m.A_d))]
        return amplitudes, math.hypot(amplitudes[0], amplitudes[2])

    @cached_property
    def _swing(self) -> tuple[float, float]:
        """Range, and steepest slope against dn, of the rate of precession (2E + L w_d)/(L + I_d w_d)."""
        m, (x, _, z), L = self.motion, *self._momenta
        (low, high), k1 = self.moves.gaps, self.moves.k1
        I_c = float(self.moves.moments[0 if m.circled == 2 else 2])
        # |L^2 - 2E I_d| = I_c g_dc A_c^2.
        size = x * x * (low + high) / I_c * abs(m.A_d) / self.unit
        top, bottom = L + z, L + z * k1
        return _quotient(size * (1.0 - k1), top * bottom), _quotient(size, bottom * bottom)

    def _growth(self, angle: float) -> float:
        m = self.motion
        slope = moved.slope_of_quarter(m.m, self.moves.k1, m.lattice.K)
        return slope * (angle / m.lattice.K + 2.0)


def lost_after(lost: Callable[[float], bool], longest: float) -> float | None:
    """Return the last time at which nothing is lost, to a thousandth and never later; None if that is beyond 2^longest.

    What is lost stays lost, and is found by bisection of the exponent.
    """
    low, high = -1074.0, longest
    if not lost(2.0**high):
        return None
    if lost(2.0**low):
        return 0.0
    while high - low > 1e-3:
        middle = 0.5 * (low + high)
        low, high = (low, middle) if lost(2.0**middle) else (middle, high)
    return float(2.0**low)


def _quotient(dividend: float, divisor: float) -> float:
    """Return a quotient, infinite where the divisor is below every double, so that nothing is stated by it."""
    return dividend / divisor if divisor else math.inf


def _known(size: float) -> float:
    return size if math.isfinite(size) else math.inf
