"""The attitude of a free rigid body in closed form: quaternions without sign jumps, in every regime, at any time."""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from core.arrays import Floats
from core.compiled import kernel
from core.double_double import PI, Scaled, dd_div, sc_add, sc_mul, sc_sqrt, scaled
from core.elliptic.functions import LARGEST_QUARTER
from core.errors import AccuracyUnreachable, InvalidParameter
from core.rotation.attitude.frame import fill_at_rest, from_precession, from_steady
from core.rotation.attitude.sampling import sample_attitude, sample_steady
from core.rotation.closed_form.circulation import PERIODIC, REST, STEADY
from core.rotation.free_rotation import SET_UP_ROUNDING, UNIT_ROUNDOFF, FreeRotation
from core.rotation.precession.constants import PrecessionConstants, angle_per_period, precession_constants
from core.rotation.uncertainty.input_uncertainty import WHOLE_TURN, lost_after

ATTITUDE_ERROR = 14.0 * UNIT_ROUNDOFF
"""Bound of the error of one attitude, as the largest change of a unit vector that it turns.

The largest seen over 1e5 random motions is 10.8 units.
"""


@kernel()
def _spin(v: NDArray[np.float64]) -> tuple[float, float, float]:
    """Return |v|/pi, quarter turns of half angle per unit time: mantissa as a pair and a power of two."""
    total = Scaled(0.0, 0.0, 0)
    for k in range(3):
        x = scaled(v[k], 0.0, 0)
        total = sc_add(total, sc_mul(x, x))
    norm = sc_sqrt(total)
    h, low = dd_div(norm.high, norm.low, PI[0], PI[1])
    return h, low, float(norm.exponent)


@dataclass(frozen=True, eq=False)
class FreeAttitude:
    """The attitude of a free rotation, body to space: v_space = R v_body.

    Attributes
    ----------
    rotation : FreeRotation
    attitude : ndarray, shape (4,)
        Quaternion [w, x, y, z] at t = 0; any length but zero, normalised here.
    """

    rotation: FreeRotation
    attitude: Floats

    def __post_init__(self) -> None:
        if not np.any(self.attitude):
            raise InvalidParameter(
                "attitude", "not be zero", remedy="give a unit quaternion [w, x, y, z]; [1, 0, 0, 0] is no turn"
            )

    @cached_property
    def constants(self) -> PrecessionConstants:
        """Constants of the precession about the angular momentum, where the angular velocity changes."""
        i, it, w, wt = self.rotation.resolved.numbers
        constants: PrecessionConstants = precession_constants(self.rotation.motion, i, it, w, wt)
        if not all(map(math.isfinite, (*constants[:-1], *constants.quarter))):
            raise self._beyond_doubles()
        return constants

    @property
    def precession_per_period(self) -> float | None:
        """Angle by which the circled axis turns about the angular momentum in one period, not reduced (rad)."""
        if self.rotation.motion.regime != PERIODIC:
            return None
        return float(angle_per_period(self.constants.quarter, self.constants.eta)[0])

    def sample(self, times: Floats) -> Floats:
        """Return unit quaternions [w, x, y, z], shape (n, 4), continuous in time from the one at t = 0."""
        times = np.ascontiguousarray(times, dtype=np.float64)
        self._countable(self.rotation.horizon(times))
        motion = self.rotation.motion
        start = np.ascontiguousarray(self.attitude, dtype=np.float64)
        out = np.empty((4, times.size))
        if motion.regime == REST:
            fill_at_rest(start, out)
        elif motion.regime == STEADY:
            v = np.ascontiguousarray(self.rotation.angular_velocity, dtype=np.float64)
            h, low, exponent = _spin(v)
            turn, axis = from_steady(start, v)
            sample_steady(h, low, axis, math.ldexp(1.0, int(exponent)), times, turn, out)
        else:
            inertia = self.rotation.inertia
            onto = from_precession(
                motion, self.constants, *self.rotation.resolved.numbers, inertia.axes, inertia.axes_tail, start
            )
            sample_attitude(motion, self.constants, times, onto, out)
        if not np.isfinite(out).all():
            raise self._beyond_doubles()
        return out.T

    def _beyond_doubles(self) -> AccuracyUnreachable:
        reason = "moments and rates lie too far apart for doubles to hold the constants of the attitude"
        return AccuracyUnreachable(None, 2.0, reason, path=("attitude",), remedy="ask without the attitude")

    def error(self, times: Floats) -> float:
        """Return a bound of the error of `sample`: how far it may turn a unit vector wrongly, inputs taken as exact."""
        motion, horizon = self.rotation.motion, self.rotation.horizon(times)
        if motion.regime == REST:
            # Four components rounded by 2^-54 at most: a distance of 2^-53, and a vector is turned by twice as much.
            return 2.0 * UNIT_ROUNDOFF
        computed = ATTITUDE_ERROR
        if motion.regime != STEADY:
            turned = math.pi * self._turns(horizon)
            computed += 8.0 * SET_UP_ROUNDING * turned + 4.0 * motion.condition_bounds.at(SET_UP_ROUNDING, horizon)
        if self.rotation.derivation is None:
            return computed
        derived = self.rotation.derivation.attitude(self.rotation.derived_rounding, horizon)
        return min(WHOLE_TURN, computed + derived)

    def inherited(self, times: Floats, uncertainty: float = UNIT_ROUNDOFF) -> float:
        """Return by what angle (rad) a relative `uncertainty` of every input may turn the samples, at most pi.

        The inputs are the numbers of the body, of the angular velocity and of the attitude at t = 0.
        """
        horizon = self.rotation.horizon(times)
        if uncertainty == 0.0:
            return 0.0
        if self.rotation.motion.regime == REST:
            return min(WHOLE_TURN, 2.0 * uncertainty)
        if self.rotation.input_uncertainty is None:
            return WHOLE_TURN
        return self.rotation.input_uncertainty.attitude(uncertainty, horizon)

    def horizon_of(self, uncertainty: float = UNIT_ROUNDOFF) -> float | None:
        """Return the time after which a relative `uncertainty` of every input leaves nothing known of the attitude (s).

        None if that does not happen at any time that `sample` answers.
        """
        if self.rotation.motion.regime == REST:
            return None
        turns = self._turns(1.0)
        # Of the slowest rotations not even the turns in a second are above every double.
        countable = math.log2(LARGEST_QUARTER) - math.log2(turns) - 1e-9 if turns > 0.0 else math.inf
        longest = min(self.rotation.longest_exponent, countable)
        return lost_after(lambda time: self.inherited(np.array([time]), uncertainty) > 1.0, longest)

    def _turns(self, horizon: float) -> float:
        """Return the quarter turns of the half angle up to a horizon."""
        motion = self.rotation.motion
        if motion.regime == REST:
            return 0.0
        if motion.regime == STEADY:
            return self.rotation.largest_norm / math.pi * horizon
        return abs(self.constants.turn) * motion.time_scale * horizon

    def _countable(self, horizon: float) -> None:
        turns = self._turns(horizon)
        if turns > LARGEST_QUARTER:
            raise AccuracyUnreachable(
                None,
                2.0,
                "the body turns more than 2^48 times, and its angle has no digits left",
                path=("times",),
                remedy=f"ask for times up to {LARGEST_QUARTER / turns * horizon:.3g} s, or without the attitude",
            )
