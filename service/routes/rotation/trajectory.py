"""Questions about bodies that turn freely."""

from __future__ import annotations

from typing import Any, Generic, Literal

from pydantic import Field

from core.bodies import Body
from core.quantities import AngularVelocity, Quaternion, Tolerance, Uncertainty
from core.rotation.sampled_rotation import Output, sample_rotation, wanted_outputs
from core.systems.budget import Budget
from core.systems.methods import Method
from core.systems.system import Model
from core.systems.trajectory import Accuracy as StatedAccuracy
from core.systems.trajectory import Work
from service.responses.svg import SVG
from service.routes.bodies import few_times, is_small, properties_of
from service.routes.motion_figures import draw_rotation
from service.routing import Answer, PostRoute
from service.schemas import (
    ROUND,
    AngularMomentumMagnitude,
    AngularVelocityRow,
    Envelope,
    Joules,
    N,
    QuaternionRow,
    Radians,
    RadiansPerSecond,
    Ratio,
    Request,
    Rounding,
    Seconds,
    Times,
    View,
    fields_of,
    in_closed_form,
    sample_times,
)

# Fields of ordinary and of certified questions, each in the types of its own.
ANGULAR_VELOCITY: Any = Field(description="At t = 0, in body axes.")
ATTITUDE: Any = Field(
    default=None,
    description="Body to space at t = 0, [w, x, y, z]; of any length but zero. If it is given, the attitude at "
    "every time is answered.",
)
TIMES: Any = Field(description="Measured from the given state, of either sign, in any order.")
ACCURACY: Any = Field(
    default=1e-9, description="Largest tolerated error of any sample, relative to the largest norm of the whole motion."
)
FLIP_INTERVAL: Any = Field(
    description="Time between sign changes of the component along the middle axis. It exists about a stable axis too, "
    "where the body does not turn over: see tumbles."
)
MIDDLE_AXIS_TILT: Any = Field(
    description="Least and largest angle between the middle axis and the angular momentum in the whole motion; null at "
    "rest and where two moments are equal. On the separatrix the limits 0 and pi."
)
TUMBLES: Any = Field(
    description="Whether the middle axis turns over, from within 45 degrees of the angular momentum to within 45 "
    "degrees of its opposite: every flip_interval, on the separatrix once."
)
METHOD: Any = Field(
    default=None, description="Leave it out to have the most accurate one chosen; it overrides the accuracy."
)
OUTPUTS: Any = Field(
    default=None,
    min_length=1,
    description="What to answer; default: time, angular_velocity, and attitude if one was given.",
)


class TrajectoryRequest(Request):
    """A body, how it turns at t = 0, and the times at which its motion is wanted."""

    body: Body
    angular_velocity: AngularVelocity = ANGULAR_VELOCITY
    attitude: Quaternion | None = ATTITUDE
    times: Times = TIMES
    accuracy: Tolerance = ACCURACY
    method: Method | None = METHOD
    input_uncertainty: Uncertainty = Field(
        default=2.0**-53,
        description="Relative uncertainty of every number of body and start, from which the inherited error follows. "
        "If it is given, accuracy.horizon says for how long the phase is known.",
    )
    round: Rounding | None = ROUND
    outputs: list[Output] | None = OUTPUTS


class Accuracy(View):
    """How right the answer is."""

    requested: Ratio[float] = Field(description="Largest tolerated error.")
    error: Ratio[float] = Field(
        description="Largest norm of any sample's error, inputs taken as exact, divided by largest_norm. Of a scene, "
        "the largest such quotient of any column. What it rests on is said in how."
    )
    final_error: Ratio[float] | None = Field(description="The same at the time farthest from the start.")
    how: Literal["closed form", "measured against closed form", "estimate (finer run)"] = Field(
        description="closed form: a bound. measured against closed form: the difference from it, with its bound added. "
        "Neither is below the true error. estimate (finer run): four times the difference from a finer run of the same "
        "method, which is no bound."
    )
    inherited: Ratio[float] | None = Field(
        description="Error propagated from input uncertainty, half a unit in the last place of every input or "
        "input_uncertainty: a bound of the change of any sample, divided by largest_norm. null where nothing is known "
        "of the phase, and for scenes."
    )
    largest_norm: RadiansPerSecond[float] | None = Field(
        default=None,
        description="Largest magnitude of the angular velocity in the whole motion, also between and beyond the times "
        "of the question; errors of closed forms and of methods are relative to it. null beyond the range of doubles, "
        "and for scenes, where every column is relative to its own largest magnitude.",
    )
    horizon: Seconds[float] | None = Field(
        default=None, description="Time after which input_uncertainty makes the phase unpredictable."
    )
    drifts: dict[str, Ratio[float]] = Field(
        description="Largest relative change of each conserved quantity; a drift is not an error."
    )
    attitude_error: Radians[float] | None = Field(
        default=None, description="Largest error of the attitude, as the angle of a turn."
    )
    attitude_inherited: Radians[float] | None = Field(
        default=None, description="Angle by which the input uncertainty may turn the attitude, at most pi."
    )
    attitude_horizon: Seconds[float] | None = Field(
        default=None, description="Time after which input_uncertainty makes the attitude unpredictable."
    )


class RotationSamples(Envelope, Generic[N]):
    """Samples of a free rotation."""

    model: Model
    method: str = Field(description="Kind of the method that computed the samples.")
    period: Seconds[N] | None = Field(description="Of the angular velocity in the body; null where there is none.")
    flip_interval: Seconds[N] | None = FLIP_INTERVAL
    middle_axis_tilt: tuple[Radians[N], Radians[N]] | None = MIDDLE_AXIS_TILT
    tumbles: bool = TUMBLES
    energy: Joules[N] | None = Field(description="Kinetic energy of the rotation.")
    angular_momentum: AngularMomentumMagnitude[N] | None = Field(description="Magnitude of the angular momentum.")
    work: Work
    ended: str = Field(description="horizon, or the event that ended the motion before it.")
    time: list[Seconds[N]] | None = Field(default=None, description="Of the samples, in the order of the question.")
    angular_velocity: list[AngularVelocityRow[N]] | None = Field(
        default=None, description="One row per time, in body axes."
    )
    attitude: list[QuaternionRow[Ratio[N]]] | None = Field(
        default=None, description="One row per time, [w, x, y, z], body to space."
    )


class TrajectoryAnswer(RotationSamples[float]):
    """Samples of a free rotation."""

    accuracy: Accuracy


def accuracy_fields(stated: StatedAccuracy) -> Answer:
    """Return what is said of the error of a state, or of a scene in closed form."""
    found = fields_of(stated)
    del found["horizon"], found["why"]
    return found


def trajectory(question: TrajectoryRequest, budget: Budget) -> Answer:
    """Answer with samples of the motion."""
    times = sample_times(question.times, budget)
    found = sample_rotation(
        properties_of(question.body),
        question.angular_velocity,
        times,
        attitude=question.attitude,
        accuracy=question.accuracy,
        method=question.method,
        input_uncertainty=question.input_uncertainty,
        digits=question.round,
        outputs=question.outputs,
        budget=budget,
    )
    accuracy, uncertain = accuracy_fields(found.motion.accuracy), "input_uncertainty" in question.model_fields_set
    if uncertain:
        accuracy["horizon"] = found.closed_form.horizon_of(question.input_uncertainty)
    samples = {"time": found.motion.time, "angular_velocity": found.motion.state}
    if found.attitude is not None:
        samples["attitude"] = found.attitude.quaternions
        accuracy |= {"attitude_error": found.attitude.error, "attitude_inherited": found.attitude.inherited}
        if uncertain:
            accuracy["attitude_horizon"] = found.attitude.closed_form.horizon_of(question.input_uncertainty)
    wanted = wanted_outputs(question.outputs, question.attitude)
    return {
        "model": found.motion.model,
        "method": found.motion.method,
        "period": found.period,
        "flip_interval": found.flip_interval,
        "middle_axis_tilt": found.middle_axis_tilt,
        "tumbles": found.tumbles,
        "energy": found.energy,
        "angular_momentum": found.angular_momentum,
        "accuracy": accuracy,
        "work": found.motion.work,
        "ended": found.motion.ended,
        "warnings": found.warnings,
        **{name: column for name, column in samples.items() if name in wanted},
    }


def is_small_trajectory(question: TrajectoryRequest) -> bool:
    """Return whether a trajectory has few samples, in closed form."""
    return in_closed_form(question.method) and few_times(question.times) and is_small(question)


T_HANDLE = {"kind": "principal-moments", "moments": [795.7921810699588, 713.5092592592592, 395.7829218106996]}

NEARLY_SYMMETRIC = {
    "body": {"kind": "principal-moments", "moments": [1.0, 1.0 + 2.0**-52, 2.0]},
    "angular_velocity": [1.0, 1.0, 1.0],
    "times": [1.0],
}

RESTING, STEADY = (
    {"body": T_HANDLE, "angular_velocity": rates, "attitude": [1.0, 0.0, 0.0, 0.0], "times": [1.0]}
    for rates in ([0.0, 0.0, 0.0], [0.0, 1.0, 0.0])
)

ROTATION = (
    PostRoute(
        "/v1/rotation/trajectory",
        "rotation_trajectory",
        "The free rotation of a body: angular velocity and, if requested, attitude at given times",
        "rotation",
        TrajectoryRequest,
        TrajectoryAnswer,
        trajectory,
        is_small_trajectory,
        warming=(RESTING, STEADY, NEARLY_SYMMETRIC),
        representations={SVG: draw_rotation},
    ),
)
