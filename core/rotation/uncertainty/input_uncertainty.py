"""What a relative uncertainty of every input comes to, in angular velocity and attitude, as a function of time.

Of several first-order bounds, which all hold at once, the smallest is stated. The derivation of each is in
docs/physics/error-statements.md.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property

from core.rotation.closed_form.circulation import SEPARATRIX, STEADY
from core.rotation.closed_form.constants_of_motion import ConstantsOfMotion
from core.rotation.uncertainty import constant_sensitivities as at
from core.rotation.uncertainty.phase_sensitivities import largest_until
from core.rotation.uncertainty.sensitivities import FIRST_ORDER, Sensitivities

WHOLE_TURN = math.pi
"""An error of the attitude, as the angle (rad) of the turn that takes one attitude to the other, is never larger."""

CURVATURE = 1.5
"""Second derivatives add at most this times the product of a first-order change and the relative changes."""

_MOST = 600.0
_HUGE = 1e290


@dataclass(frozen=True, eq=False)
class InputUncertainty:
    """Bounds for one motion and a relative uncertainty of one, in scaled units.

    Attributes
    ----------
    motion : ConstantsOfMotion
    sensitivities : Sensitivities
        Of moments and start, with the sums over the inputs.
    unit : float
        The rate that scaled rates are measured in, a power of two (rad/s).
    largest : float
        Largest norm of the angular velocity in those units.
    """

    motion: ConstantsOfMotion
    sensitivities: Sensitivities
    unit: float
    largest: float

    def angular_velocity(self, uncertainty: float, horizon: float) -> float:
        """Return a bound of the change of the angular velocity up to |t| = `horizon`, relative to its largest norm.

        Infinite where the first order is beyond a tenth: nothing is known of the phase there, and a body with a small
        moment may come to turn many times faster than the largest norm.
        """
        return self._changed(uncertainty, self._scaled(horizon)) / self.largest

    def attitude(self, uncertainty: float, horizon: float) -> float:
        """Return a bound of the angle between the attitudes up to |t| = `horizon` (rad), at most pi.

        The attitude at the start is an input like the others; a component of a quaternion turns it by no more than
        the uncertainty, and all four by twice that.
        """
        time = self._scaled(horizon)
        # The attitude turns away by no more than the integral of the error of the angular velocity.
        turned = min(self._changed(uncertainty, time) * time if time else 0.0, self._turned(uncertainty, time))
        turned += 2.0 * uncertainty
        return turned * (1.0 + CURVATURE * turned) if turned < FIRST_ORDER else WHOLE_TURN

    def _scaled(self, horizon: float) -> float:
        return min(horizon * self.unit, 1e300)

    def _changed(self, u: float, time: float) -> float:
        """Return the smallest bound of the change of the angular velocity."""
        late = self._steady(u, time) if self.motion.regime == STEADY else self._turning(u, time)
        if time == 0.0:
            # The angular velocity at the start is an input itself.
            return min(late, self._limited(u * self.sensitivities.own_start, self.largest, u))
        early = self.sensitivities.early(u, time)
        return min(late, self._limited(early, self.largest, u * self.sensitivities.sums[at.MOMENTS]))

    def _limited(self, grown: float, size: float, constants: float, phase: float = 0.0) -> float:
        """Return a bound to first order, enlarged by what the second may add; infinite where the first order ends.

        Next to the first derivatives of a motion the second are as large as the relative changes of its constants and,
        as far as these go round, of its phase: a small nutation may change altogether while the angular velocity hardly
        does.
        """
        share = grown / size
        if not (share < FIRST_ORDER and constants < 2.0 * FIRST_ORDER):
            return math.inf
        return grown * (1.0 + CURVATURE * max(share, constants, min(1.0, phase)))

    def _limited_by_constants(self, grown: float, size: float, u: float, time: float) -> float:
        s = self.sensitivities.sums
        phase = s[at.PHASE] + s[at.FREQUENCY] * self._angle(time)
        return self._limited(grown, size, u * max(s[at.MOMENTS], s[at.GAPS]), u * phase)

    def _steady(self, u: float, time: float) -> float:
        s, growth = self.sensitivities.sums, self.sensitivities.crosswise(time)
        if u * s[at.TURN] > FIRST_ORDER:
            return math.inf
        grown = u * (s[at.ALONG] + s[at.TURN] * self.largest + growth * s[at.CROSSWISE])
        # Without a disturbance across the axis the moments do not matter.
        constants = u * max(s[at.MOMENTS], s[at.GAPS]) if s[at.CROSSWISE] or s[at.TURN] else 0.0
        return self._limited(grown, self.largest, constants)

    def _turning(self, u: float, time: float) -> float:
        m, s = self.motion, self.sensitivities.sums
        if not self.sensitivities.finite or u * max(s[at.TURN], s[at.RATE]) > FIRST_ORDER:
            return math.inf
        A = [abs(x) / self.unit for x in (m.A_c, m.A_b, m.A_d)]
        a = s[at.AMPLITUDE_C], s[at.AMPLITUDE_B], s[at.AMPLITUDE_D]
        displaced = self._displaced(u, time, A, a)
        phases = self.sensitivities.phases
        if phases is not None and math.isfinite(self._phase(u, time)):
            displaced = min(displaced, largest_until(phases, self._angle(time), 2.0 * m.lattice.K, s[at.FREQUENCY]))
        return self._limited_by_constants(u * (s[at.TURN] * self.largest + displaced), self.largest, u, time)

    def _displaced(self, u: float, time: float, A: list[float], a: tuple[float, float, float]) -> float:
        """Return a bound of |d(A_c cn, A_b sn, A_d dn)|, of which the amplitudes move by `a`."""
        m, s = self.motion, self.sensitivities.sums
        amplitudes = math.hypot(max(a[0], a[1]), a[2])
        across = max(A[0], A[1])
        phase, slope = self._phase(u, time), math.hypot(across, 0.5 * m.m * A[2])
        by_phase = slope * phase + 0.5 * A[2] * s[at.MODULUS] if math.isfinite(phase) else math.inf
        grown, escape = self._escape(time)
        early = s[at.PHASE] + s[at.RATE] * self._angle(time)
        by_escape = slope * early + s[at.MODULUS] * (math.hypot(across, A[2]) * escape + 0.5 * A[2] * grown)
        return amplitudes + min(_known(by_phase), _known(by_escape))

    def _phase(self, u: float, time: float) -> float:
        """Return a bound of |Q|, the change of the phase u, from the drift of the frequency."""
        m, s = self.motion, self.sensitivities.sums
        if (
            m.regime == SEPARATRIX
            or not u * max(s[at.FREQUENCY], _quotient(s[at.MODULUS], self.sensitivities.k1)) <= FIRST_ORDER
        ):
            return math.inf
        # Between phases the elliptic integral's derivative departs from its mean growth by K' at most, each.
        return float(s[at.PHASE] + s[at.FREQUENCY] * self._angle(time) + self._spread * s[at.MODULUS])

    @property
    def _spread(self) -> float:
        m = self.motion
        return 2.0 * at.slope_of_quarter(m.m, self.sensitivities.k1, m.lattice.K) * (0.32 + 0.68 * m.m)

    def _angle(self, time: float) -> float:
        return self.motion.p / self.unit * time

    def _escape(self, time: float) -> tuple[float, float]:
        """Return bounds of k1/dn and of k1 dn times the integral of sn^2/2 dn^2 from the start: |dn'| <= dn."""
        angle = self._angle(time)
        if angle > _MOST:
            return _HUGE, _HUGE
        over = math.exp(angle) / self.sensitivities.dn * (self.sensitivities.k1 or 1.0)
        return over, 0.5 * angle * over

    def _turned(self, u: float, time: float) -> float:
        """Return a bound of the attitude's turn by way of the angular momentum, which it precesses about."""
        m, s = self.motion, self.sensitivities.sums
        if (
            m.regime == STEADY
            or not self.sensitivities.finite
            or u * max(s[at.TURN], s[at.RATE], s[at.TIP]) > FIRST_ORDER
        ):
            return math.inf
        momenta, total = self._momenta
        pole = [_quotient(x, total) for x in momenta]
        wandering = self._displaced(u, time, pole, (s[at.POLE_C], s[at.POLE_B], s[at.POLE_D]))
        angle, rate = self._angle(time), self.motion.p / self.unit
        if rate == 0.0:
            return math.inf
        early = s[at.PHASE] + s[at.RATE] * angle
        swing, steepest = self._swing
        late = early + s[at.MODULUS] * self._growth(angle) if math.isfinite(self._phase(u, time)) else math.inf
        grown, escape = self._escape(time)
        by_phase = swing * late / rate + time * s[at.SINGULAR] if math.isfinite(late) else math.inf
        by_escape = (swing * early + steepest * s[at.MODULUS] * (escape + 0.5 * grown)) / rate
        by_escape += time * s[at.SINGULAR] * grown
        turned = time * s[at.PRECESSION] + min(_known(by_phase), _known(by_escape))
        turned += s[at.TIP] + 2.0 * s[at.TURN] + math.sqrt(2.0) * (s[at.TIP] + _known(wandering))
        return self._limited_by_constants(u * turned, 1.0, u, time)

    @cached_property
    def _momenta(self) -> tuple[list[float], float]:
        """Amplitudes of the angular momentum along c, b, d, and its norm."""
        m, (A, B, C) = self.motion, self.sensitivities.moments.tolist()
        I_c, I_d = (A, C) if m.circled == 2 else (C, A)
        amplitudes = [abs(i * x) / self.unit for i, x in ((I_c, m.A_c), (B, m.A_b), (I_d, m.A_d))]
        return amplitudes, math.hypot(amplitudes[0], amplitudes[2])

    @cached_property
    def _swing(self) -> tuple[float, float]:
        """Range, and steepest slope against dn, of the rate of precession (2E + L w_d)/(L + I_d w_d)."""
        m, (x, _, z), L = self.motion, *self._momenta
        (low, high), k1 = self.sensitivities.gaps, self.sensitivities.k1
        I_c = float(self.sensitivities.moments[0 if m.circled == 2 else 2])
        # |L^2 - 2E I_d| = I_c g_dc A_c^2.
        size = x * x * (low + high) / I_c * abs(m.A_d) / self.unit
        top, bottom = L + z, L + z * k1
        return _quotient(size * (1.0 - k1), top * bottom), _quotient(size, bottom * bottom)

    def _growth(self, angle: float) -> float:
        m = self.motion
        slope = at.slope_of_quarter(m.m, self.sensitivities.k1, m.lattice.K)
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
