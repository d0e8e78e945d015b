"""A free rotation at given times: angular velocities, attitudes if they are wanted, and how right each of them is."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from math import isfinite
from typing import Literal

import numpy as np

from core.arrays import Floats
from core.bodies.mass_properties import MassProperties
from core.errors import AccuracyUnreachable, NotApplicable
from core.notices import Notice
from core.rotation.attitude.free_attitude import FreeAttitude
from core.rotation.free_rotation import FreeRotation
from core.rotation.motion_check import check_motion
from core.rotation.self_check import check_rotation
from core.rotation.torque_free import TorqueFree
from core.systems.budget import Budget
from core.systems.methods import ClosedFormEvaluation
from core.systems.methods.method import AbstractMethod
from core.systems.rounding import Digits, rounded
from core.systems.solve import solve
from core.systems.state_motion import HALF_ULP
from core.systems.trajectory import Trajectory

Output = Literal["time", "angular_velocity", "attitude"]
_BETWEEN = 0.5 * (5.0**0.5 - 1.0)
"""Share of the last time about which the motion is held against its equations: it meets no fraction of a period."""

IDENTITY = (1.0, 0.0, 0.0, 0.0)


def wanted_outputs(outputs: Sequence[Output] | None, attitude: object) -> tuple[Output, ...]:
    """Return what is wanted: the outputs that are named, by default all but the attitude, that too if one is given."""
    if outputs is not None:
        return tuple(outputs)
    return ("time", "angular_velocity") if attitude is None else ("time", "angular_velocity", "attitude")


@dataclass(frozen=True, eq=False)
class SampledAttitude:
    """Attitudes of a free rotation.

    Attributes
    ----------
    quaternions : ndarray, shape (n, 4)
        [w, x, y, z], body to space.
    error : float
        Largest error of any of them, as a turn (rad).
    inherited : float
        By what angle the uncertainty of the inputs may turn them, at most pi (rad).
    closed_form : FreeAttitude
    """

    quaternions: Floats
    error: float
    inherited: float
    closed_form: FreeAttitude


@dataclass(frozen=True, eq=False)
class SampledRotation:
    """Samples of a free rotation.

    Attributes
    ----------
    motion : Trajectory
        Its `state` is the angular velocity in body axes (rad/s).
    period, flip_interval : float or None
        Of the angular velocity in the body, and between its sign changes along the middle axis (s).
    middle_axis_tilt : tuple of 2 floats, or None
        Least and largest angle between the middle axis and the angular momentum (rad); None without such an axis.
    tumbles : bool
        Whether the middle axis turns over.
    energy, angular_momentum : float or None
        In J and kg m^2/s; None where a double cannot hold them.
    closed_form : FreeRotation
    attitude : SampledAttitude or None
    warnings : tuple of Notice
    """

    motion: Trajectory
    period: float | None
    flip_interval: float | None
    middle_axis_tilt: tuple[float, float] | None
    tumbles: bool
    energy: float | None
    angular_momentum: float | None
    closed_form: FreeRotation
    attitude: SampledAttitude | None
    warnings: tuple[Notice, ...]


def sample_rotation(
    body: MassProperties,
    angular_velocity: Sequence[float],
    times: Floats,
    *,
    attitude: Sequence[float] | None = None,
    accuracy: float = 1e-9,
    method: AbstractMethod | None = None,
    input_uncertainty: float = HALF_ULP,
    digits: Digits | None = None,
    outputs: Sequence[Output] | None = None,
    budget: Budget | None = None,
) -> SampledRotation:
    """Sample a free rotation at `times`, shape (n,), measured from the given state (s).

    Parameters
    ----------
    body : MassProperties
    angular_velocity : sequence of 3 floats
        At t = 0, in body axes (rad/s).
    attitude : sequence of 4 floats, optional
        Quaternion at t = 0, body to space; no turn if attitudes are wanted without it.
    accuracy, method, input_uncertainty, budget
        As for `core.systems.solve.solve`.
    digits : int or "meaningful", optional
        Round the samples that are wanted; the stated errors cover it.
    outputs : sequence of Output, optional
        What is wanted, by default as `wanted_outputs` says.

    Raises
    ------
    AccuracyUnreachable
        As `solve`, and if the bound of the attitude's closed form is larger than `accuracy`.
    NotApplicable
        For attitudes beside a method that is not the closed form.
    SelfCheckFailed
        If the samples break a conservation law beyond their stated errors.
    """
    system = TorqueFree(body, np.array(angular_velocity))
    wanted = wanted_outputs(outputs, attitude)
    solved = solve(
        system,
        times,
        accuracy=accuracy,
        method=method,
        budget=budget,
        input_uncertainty=input_uncertainty,
        digits=digits if "angular_velocity" in wanted else None,
    )
    exact, notices = system.closed_form(), [*system.warnings, *solved.warnings]
    turned = None
    if "attitude" in wanted:
        require_closed_form(method)
        free = FreeAttitude(exact, np.array(attitude or IDENTITY))
        turned = _attitude(free, times, accuracy, input_uncertainty, digits)
    if budget is None or budget.audited:
        stated = solved.accuracy
        check_rotation(
            system.tensor,
            system.angular_velocity,
            solved.time,
            solved.state,
            stated.error * (stated.largest_norm or 0.0),
            None if turned is None else turned.quaternions,
            0.0 if turned is None else turned.error,
        )
        norm = stated.largest_norm or 0.0
        check_motion(
            system.tensor,
            system.angular_velocity,
            # Apart from the samples, and of those times to which their error belongs.
            _BETWEEN * float(times[-1]) if len(times) else 0.0,
            (exact.sample, lambda at: exact.error(at) * norm),
            None if turned is None else (turned.closed_form.sample, turned.closed_form.error),
            solved.period,
        )
    tilt = exact.middle_axis_tilt
    least = None if tilt is None else in_range("middle_axis_tilt", tilt.least, notices)
    return SampledRotation(
        solved,
        in_range("period", solved.period, notices),
        in_range("flip_interval", exact.flip_interval, notices),
        None if tilt is None or least is None else tilt.range,
        tilt is not None and tilt.tumbles,
        system.energy,
        system.angular_momentum,
        exact,
        turned,
        tuple(notices),
    )


def require_closed_form(method: AbstractMethod | None) -> None:
    """Raise `NotApplicable` for a method by which no attitude is computed."""
    if method is not None and not isinstance(method, ClosedFormEvaluation):
        raise NotApplicable(
            "the attitude is computed in closed form only",
            path=("method",),
            remedy="leave out the method, or the attitude",
        )


def _attitude(
    free: FreeAttitude, times: Floats, accuracy: float, uncertainty: float, digits: Digits | None
) -> SampledAttitude:
    error = free.error(times)
    if not error <= accuracy:
        raise AccuracyUnreachable(
            accuracy,
            error,
            "the bound of the attitude's closed form is larger",
            remedy="ask for earlier times or for less accuracy",
        )
    quaternions, inherited = free.sample(times), free.inherited(times, uncertainty)
    if digits is not None:
        # Quaternions of two attitudes are half as far apart as the attitudes.
        quaternions, added = rounded(quaternions, digits, 0.5 * (error + inherited), 1.0)
        error += 2.0 * added
    return SampledAttitude(quaternions, error, inherited, free)


def in_range(name: str, figure: float | None, notices: list[Notice]) -> float | None:
    """Return a figure, or None and a further notice where it leaves the range of doubles."""
    if figure is None or isfinite(figure):
        return figure
    notices.append(Notice("out-of-range", f"{name} leaves the range of double precision and is null"))
    return None
