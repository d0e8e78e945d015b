"""The angular velocity of a free rigid body in closed form, in every regime and at any horizon."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from core.arrays import Floats
from core.bodies.principal_inertia import PrincipalInertia
from core.double_double import Scaled, dd_div
from core.elliptic.functions import LARGEST_QUARTER
from core.errors import AccuracyUnreachable, InvalidParameter
from core.rotation.closed_form.circulation import (
    PERIODIC,
    REST,
    STEADY,
    UNDECIDED,
    UNREACHABLE,
    circulation,
    exact_difference,
    like_symmetric,
    too_near_the_separatrix,
)
from core.rotation.closed_form.constants_of_motion import ConstantsOfMotion, constants_of_motion
from core.rotation.closed_form.principal_frame import PrincipalFrame, Resolved
from core.rotation.closed_form.sampling import largest_magnitude, sample_components, turn_into_body
from core.rotation.closed_form.underflow import UNDERFLOW, UNMOVED, underflow_of, unmoved_until
from core.rotation.precession.middle_axis import MiddleAxisTilt, middle_axis_tilt
from core.rotation.regimes import model_of
from core.rotation.stability.classification import unstable_spin
from core.rotation.uncertainty.input_uncertainty import InputUncertainty, lost_after
from core.rotation.uncertainty.sensitivities import COMPONENTS, Sensitivities, tensors_of_moments
from core.systems.system import Model

UNIT_ROUNDOFF = 2.0**-53

EVALUATION_ERROR = 6.0 * UNIT_ROUNDOFF
"""Bound of the error of one sample along principal axes, relative to the largest angular velocity.

Each component is constant * numerator / denominator: one rounding in the constant, at most 2.2 units in each theta
function and 2 in the quotient; component by component that may reach 7.4 units, but the components' errors add as
squares and each is relative to its own component. The largest seen over 1e5 random motions is 4.9 units.
"""

TURNED_AXES_ERROR = 3.0 * UNIT_ROUNDOFF
"""What expressing the sample in body axes adds, where they are not the principal axes."""

SET_UP_ROUNDING = 2.0**-103
"""Relative rounding of the constants of motion formed from exact inputs."""


@dataclass(frozen=True, eq=False)
class FreeRotation:
    """The exact torque-free motion that starts with a given angular velocity at t = 0.

    Attributes
    ----------
    inertia : PrincipalInertia
        Principal moments and axes of the body; all moments positive.
    angular_velocity : ndarray, shape (3,)
        At t = 0, in body axes (rad/s).
    tensor_sensitivities : callable, optional
        By how much each of the numbers that describe the body changes its tensor, in units of 2^exponent kg m^2
        (`core.bodies.sensitivities`). Without it the principal moments are those numbers.
    """

    inertia: PrincipalInertia
    angular_velocity: Floats
    tensor_sensitivities: Callable[[int], Floats] | None = None

    def __post_init__(self) -> None:
        if self.inertia.moments[0] > 0.0:
            return
        (_, b, c), (x, y, z) = self.resolved.moments, self.resolved.angular_velocity
        # Across the line, and steadily: matter along a line has two equal moments, a triple of numbers need not.
        across = b > 0.0 and x == 0.0 and (b == c or y == 0.0 or z == 0.0)
        if np.any(self.angular_velocity) and not across:
            raise InvalidParameter(
                "body",
                "have three moments of inertia greater than 0 to rotate freely",
                remedy="give a body with extent in at least two directions, or let a line of matter turn across itself",
            )

    @cached_property
    def frame(self) -> PrincipalFrame:
        """Principal axes as the motion uses them."""
        return PrincipalFrame(self.inertia.axes, self.inertia.axes_tail)

    @cached_property
    def resolved(self) -> Resolved:
        """Moments and start along ascending principal axes, as the motion takes them."""
        return Resolved.of(self.inertia, self.angular_velocity)

    @cached_property
    def motion(self) -> ConstantsOfMotion:
        """Constants of the motion.

        Raises
        ------
        AccuracyUnreachable
            If the start is so near the separatrix, or the figures so far apart, that doubles cannot hold the constants.
        """
        i, it, w, wt = self.resolved.numbers
        motion: ConstantsOfMotion = constants_of_motion(i, it, w, wt, False, Scaled(0.0, 0.0, 0))
        if motion.regime == UNDECIDED:
            motion = constants_of_motion(i, it, w, wt, True, exact_difference(self.resolved))
        if motion.regime == UNREACHABLE:
            raise too_near_the_separatrix()
        return motion

    @property
    def model(self) -> Model:
        """The branch of the solution that holds, and why."""
        line = not self.inertia.moments[0] > 0.0
        return model_of(self.motion, self.inertia.apart, line, self.instability)

    @property
    def period(self) -> float | None:
        """Period of the angular velocity in the body, 4K/p (s); None if it is constant or on the separatrix."""
        motion = self.motion
        if motion.regime != PERIODIC:
            return None
        return float(dd_div(4.0, 0.0, motion.rate, motion.rate_tail)[0]) / motion.time_scale

    @property
    def flip_interval(self) -> float | None:
        """Time between sign changes of the component along the middle axis, 2K/p (s); None without such an axis.

        A body that moves as one with two equal moments has none, though what was derived of them differs by rounding.
        """
        if self.period is None or not all(self.inertia.apart):
            return None
        derived = self.inertia.nearly_equal and not self.inertia.rounding.exact_zeros
        return None if derived and not self.hangs_on_nearly_equal_moments else 0.5 * self.period

    @property
    def hangs_on_nearly_equal_moments(self) -> bool:
        """Whether nearly equal moments differ by enough for this motion to be none of equal ones."""
        if not self.inertia.nearly_equal or self.motion.regime in (REST, STEADY):
            return False
        return not like_symmetric(circulation(*self.resolved.numbers, self.motion.circled))

    @property
    def middle_axis_tilt(self) -> MiddleAxisTilt | None:
        """Range of the angle between the middle axis and the angular momentum; None without such an axis, or at rest.

        Whether the middle axis turns over, as it does not about a stable axis though `flip_interval` exists there too.
        """
        return middle_axis_tilt(self.resolved, self.inertia)

    @property
    def instability(self) -> str | None:
        """Why a steady spin is unstable; None where it is stable, where nothing turns and where the spin changes."""
        if self.motion.regime != STEADY or not self.inertia.moments[0] > 0.0:
            return None
        return unstable_spin(self.inertia.apart, self.resolved.angular_velocity.tolist())

    @property
    def largest_norm(self) -> float:
        """Largest norm of the angular velocity in the whole motion (rad/s)."""
        m = self.motion
        if m.regime in (REST, STEADY):
            return math.hypot(*(float(x) for x in self.angular_velocity))
        return max(math.hypot(m.A_c, m.A_d), math.hypot(m.A_b, m.A_d * math.sqrt(m.m1)))

    def horizon(self, times: Floats) -> float:
        """Return the largest |t|, having checked that every time can be answered.

        Raises
        ------
        InvalidParameter
            If a time is not finite.
        AccuracyUnreachable
            If a time lies beyond 2^50 quarter periods.
        """
        largest = float(largest_magnitude(times))
        if not math.isfinite(largest):
            raise InvalidParameter("times", "be finite")
        m = self.motion
        if m.regime == PERIODIC and largest * m.time_scale * m.rate > LARGEST_QUARTER:
            raise AccuracyUnreachable(
                None,
                2.0,
                "a time lies beyond 2^48 periods, where the phase has no digits left",
                path=("times",),
                remedy=f"ask for times up to {LARGEST_QUARTER / m.rate / m.time_scale:.3g} s",
            )
        return largest

    def sample(self, times: Floats) -> Floats:
        """Return the angular velocity in body axes, shape (n, 3), at `times`, shape (n,).

        The rows are views of one contiguous array per component.
        """
        times = np.ascontiguousarray(times, dtype=np.float64)
        self.horizon(times)
        m = self.motion
        out = np.empty((3, times.size))
        if m.regime in (REST, STEADY):
            out[:] = self.angular_velocity[:, None]
            return out.T
        c, d = (0, 2) if m.circled == 2 else (2, 0)
        if self.frame.aligned:
            row, sign = self.frame.rows, self.frame.signs
            m = m.mirrored(sign[c], sign[1], sign[d])
            sample_components(m, times, out[row[c]], out[row[1]], out[row[d]])
        else:
            sample_components(m, times, out[c], out[1], out[d])
            turn_into_body(np.ascontiguousarray(self.inertia.axes), out)
        if self._underflow > UNMOVED:
            out[:, np.abs(times) <= self._unmoved_until] = self.angular_velocity[:, None]
        return out.T

    def error(self, times: Floats) -> float:
        """Return a bound of the error of `sample`, relative to the largest norm of the whole motion, inputs as exact.

        Infinite where the rounding of the constants of the motion leaves nothing known of the phase.
        """
        m, horizon = self.motion, self.horizon(times)
        if m.regime in (REST, STEADY):
            # The start itself is answered.
            computed = 0.0
        else:
            computed = EVALUATION_ERROR + (0.0 if self.frame.aligned else TURNED_AXES_ERROR)
            computed += m.condition_bounds.at(SET_UP_ROUNDING, horizon)
            computed += UNMOVED if horizon <= self._unmoved_until else self._underflow
        if self.derivation is not None:
            computed += self.derivation.angular_velocity(self.derived_rounding, horizon)
        return computed if computed < 1.0 else math.inf

    @cached_property
    def _unmoved_until(self) -> float:
        """Time up to which the angular velocity moves by no more than `UNMOVED` of its norm (s)."""
        return unmoved_until(self.resolved.moments, self.largest_norm)

    @cached_property
    def _underflow(self) -> float:
        """What a sample may be wrong by, relative, because a factor of it is below the normal doubles."""
        return underflow_of(self.motion, self.largest_norm)

    def inherited(self, times: Floats, uncertainty: float = UNIT_ROUNDOFF) -> float:
        """Return a bound of the change of the samples by a relative `uncertainty` of every input.

        Relative to the largest norm of the whole motion; infinite where nothing is known of the phase.
        """
        horizon = self.horizon(times)
        if uncertainty == 0.0 or self.motion.regime == REST:
            return 0.0
        if self.input_uncertainty is None:
            return math.inf
        return self.input_uncertainty.angular_velocity(uncertainty, horizon)

    @cached_property
    def input_uncertainty(self) -> InputUncertainty | None:
        """What uncertain inputs come to, where the body is not at rest.

        None for a line of matter askew: what turns it out of line gives it a third moment, and nothing says how small.
        """
        if self.resolved.moments[0] == 0.0 and not self.frame.aligned:
            return None
        tensors = None if self.tensor_sensitivities is None else self.tensor_sensitivities(self._exponent)
        return self._uncertain(tensors, self.angular_velocity)

    @cached_property
    def derivation(self) -> InputUncertainty | None:
        """What an error of `derived_rounding` comes to; None where moments and components are exact.

        Where the axes are exact it is that of each moment. Otherwise it is that of each component of the tensor, next
        to the largest moment, and of the start, next to its norm: moments and axes found together are those of a tensor
        moved by so much.
        """
        exact_zeros = self.inertia.rounding.exact_zeros
        if (
            self.motion.regime == REST
            or self.inertia.rounding.share == 0.0
            or (self.motion.regime == STEADY and (exact_zeros or self.certainly_steady))
        ):
            return None
        if exact_zeros:
            # Equal moments are so exactly, and move as one; the start is exact.
            moments = np.ldexp(self.resolved.moments, -self._exponent)
            each = tensors_of_moments(self.inertia.axes, moments, self.inertia.apart)
            return self._uncertain(each, np.zeros(3))
        if self.resolved.moments[0] == 0.0:
            # A line of matter stays one: nothing that rounds gives it a moment about itself.
            return self._uncertain(None, self.angular_velocity)
        largest = math.ldexp(float(self.resolved.moments[2]), -self._exponent)
        return self._uncertain(largest * COMPONENTS, np.full(3, math.hypot(*self.angular_velocity.tolist())))

    @property
    def certainly_steady(self) -> bool:
        """Whether the start is certain to lie along a principal axis although the axes themselves are derived."""
        tensor = self.inertia.tensor
        return tensor is not None and tensor.turns_steadily(self.angular_velocity)

    @property
    def derived_rounding(self) -> float:
        """What derived moments, relative to the largest, and components, relative to the norm, may be wrong by."""
        (low, _, high), share = self.resolved.moments.tolist(), float(self.inertia.rounding.share)
        if self.inertia.rounding.exact_zeros:
            return float(share + UNDERFLOW / low)
        share += UNDERFLOW / high + UNDERFLOW / float(np.abs(self.angular_velocity).max())
        return float(share + self.resolved.dropped)

    @property
    def _exponent(self) -> int:
        """Binary exponent that brings the largest moment near one."""
        return math.frexp(float(self.resolved.moments[2]))[1]

    def _uncertain(self, tensors: Floats | None, velocity: Floats) -> InputUncertainty:
        """Return what uncertain tensors, shape (n, 3, 3), or moments where None, and an uncertain start come to."""
        i, it, w, _ = self.resolved.numbers
        exponent, rate = self._exponent, math.frexp(float(np.abs(w).max()))[1]
        rate = max(-1000, min(1000, rate))
        low, high = (math.ldexp(float(i[k + 1] - i[k] + (it[k + 1] - it[k])), -exponent) for k in (0, 1))
        largest = math.ldexp(self.largest_norm, -rate)
        sensitivities = Sensitivities.of(
            np.ldexp(i, -exponent),
            (low, high),
            np.ldexp(w, -rate),
            None if tensors is None and self.frame.aligned else np.ascontiguousarray(self.inertia.axes),
            tensors,
            np.ldexp(velocity, -rate),
            self.motion,
            largest,
            math.ldexp(1.0, -rate),
        )
        return InputUncertainty(self.motion, sensitivities, math.ldexp(1.0, rate), largest)

    def horizon_of(self, uncertainty: float = UNIT_ROUNDOFF) -> float | None:
        """Return the time after which a relative `uncertainty` of every input leaves nothing known of the phase (s).

        It is where `inherited` becomes infinite, found by bisection to a thousandth and never later.
        None if that does not happen at any time that `sample` answers.
        """
        return lost_after(lambda time: self.inherited(np.array([time]), uncertainty) > 1.0, self.longest_exponent)

    @property
    def longest_exponent(self) -> float:
        """Binary logarithm of the longest time that `sample` answers, and that powers of two reach (s)."""
        m, most = self.motion, 1023.0
        if m.regime != PERIODIC:
            return most
        return min(most, math.log2(LARGEST_QUARTER / m.rate) - math.log2(m.time_scale) - 1e-9)
