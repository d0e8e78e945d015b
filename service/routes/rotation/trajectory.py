"""Questions about bodies that turn freely."""

from __future__ import annotations

from math import isfinite
from typing import Any, Literal

import numpy as np
from pydantic import Field

from core.bodies import Body
from core.errors import AccuracyUnreachable, NotApplicable
from core.notices import Notice
from core.quantities import AngularVelocity, Quaternion, Tolerance, Uncertainty
from core.rotation.attitude.free_attitude import FreeAttitude
from core.rotation.torque_free import TorqueFree
from core.systems.budget import Budget
from core.systems.methods import ClosedFormEvaluation, Method
from core.systems.solve import solve
from core.systems.system import Floats
from core.systems.trajectory import How
from service.execution.cost_model import CalibratedCost, effort, extreme, numbers, speed_of
from service.responses.rounding import DIGITS, Digits, covering, notices_of, rounded
from service.routes.bodies import counts, few_times, is_small, properties_of, speed_to_follow
from service.routing import Answer, Example, PostRoute
from service.schemas import Envelope, QuaternionRow, Request, Times, Vector, View, sample_count, sample_times

Output = Literal["time", "angular_velocity", "attitude"]

# Fields that a question has in doubles and in digits alike, each in the types of its own.
ANGULAR_VELOCITY: Any = Field(description="At t = 0, in body axes (rad/s).")
ATTITUDE: Any = Field(
    default=None,
    description="Body to space at t = 0, [w, x, y, z]; of any length but zero. If it is given, the attitude at "
    "every time is answered.",
)
TIMES: Any = Field(description="Measured from the given state, of either sign, in any order (s).")
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
    accuracy: Tolerance = Field(
        default=1e-9, description="Largest tolerated error of any sample, relative to the largest norm of the motion."
    )
    method: Method | None = Field(
        default=None, description="Leave it out to have the most accurate one chosen; it overrides the accuracy."
    )
    input_uncertainty: Uncertainty = Field(
        default=2.0**-53,
        description="Relative uncertainty of every number of body and start, for the inherited error. If it is given, "
        "accuracy.horizon says for how long the phase is known.",
    )
    round: Digits | None = DIGITS
    outputs: list[Output] | None = OUTPUTS


class ModelView(View):
    """The smallest model that suffices, and why."""

    name: str
    regime: str
    why: str
    degrees_of_freedom: int


class AccuracyView(View):
    """How right the answer is; errors are relative to the largest norm of the motion."""

    requested: float
    error: float = Field(description="Largest error of any sample, inputs taken as exact; see how.")
    final_error: float | None = Field(description="The same at the time farthest from the start.")
    how: How = Field(
        description="Of a closed form a bound, measured against it a difference with that bound added: neither is "
        "below the true error. A finer run estimates it."
    )
    inherited: float | None = Field(
        description="What half a unit in the last place of every input, or input_uncertainty, would move."
    )
    horizon: float | None = Field(
        default=None, description="Time after which input_uncertainty leaves nothing known of the phase (s)."
    )
    drifts: dict[str, float] = Field(description="Largest relative change of conserved quantities: not an error.")
    attitude_error: float | None = Field(default=None, description="Largest error of the attitude, as a turn (rad).")
    attitude_inherited: float | None = Field(
        default=None, description="By what angle the same uncertainty may turn the attitude (rad), at most pi."
    )
    attitude_horizon: float | None = Field(
        default=None, description="Time after which input_uncertainty leaves nothing known of the attitude (s)."
    )


class WorkView(View):
    """What the answer cost, the same on every machine."""

    samples: int
    evaluations: int = Field(description="Of equations of motion, for the samples; a closed form needs none.")
    steps: int
    rejected_steps: int = Field(description="Steps that a method with a tolerance took and threw away.")
    evaluations_for_error: int = Field(description="Of equations of motion, to find the error.")


class TrajectoryAnswer(Envelope):
    """Samples of a free rotation."""

    model: ModelView
    method: str
    period: float | None = Field(description="Of the angular velocity in the body (s); null where there is none.")
    flip_interval: float | None = Field(description="Between sign changes along the middle axis (s).")
    energy: float | None = Field(description="J")
    angular_momentum: float | None = Field(description="Magnitude (kg m^2/s).")
    accuracy: AccuracyView
    work: WorkView
    ended: str = Field(description="horizon, or the event that ended the motion before it.")
    time: list[float] | None = Field(default=None, description="s")
    angular_velocity: list[Vector] | None = Field(default=None, description="One row per time, in body axes (rad/s).")
    attitude: list[QuaternionRow] | None = Field(
        default=None, description="One row per time, [w, x, y, z], body to space."
    )


def trajectory(question: TrajectoryRequest, budget: Budget) -> Answer:
    """Answer with samples of the motion."""
    wanted = _outputs(question)
    times = sample_times(question.times, budget)
    system = TorqueFree(properties_of(question.body), np.array(question.angular_velocity))
    solved = solve(
        system,
        times,
        accuracy=question.accuracy,
        method=question.method,
        budget=budget,
        input_uncertainty=question.input_uncertainty,
    )
    exact = system.closed_form()
    notices = [*system.warnings, *solved.warnings]
    stated, states, added = solved.accuracy, solved.state, 0.0
    unknown = stated.inherited or 0.0
    if question.round is not None and "angular_velocity" in wanted:
        states, added = rounded(states, question.round, stated.error + unknown, exact.largest_rate)
        notices += notices_of(stated, added)
    accuracy = covering(stated, added)
    if "input_uncertainty" in question.model_fields_set:
        accuracy["horizon"] = exact.horizon_of(question.input_uncertainty)
    fields: Answer = {
        "model": solved.model,
        "method": solved.method,
        "period": in_range("period", solved.period, notices),
        "flip_interval": in_range("flip_interval", exact.flip_interval, notices),
        "energy": system.energy,
        "angular_momentum": system.angular_momentum,
        "accuracy": accuracy,
        "work": solved.work,
        "ended": solved.ended,
        "warnings": notices,
    }
    if "time" in wanted:
        fields["time"] = solved.time
    if "angular_velocity" in wanted:
        fields["angular_velocity"] = states
    if "attitude" in wanted:
        free, error = _attitude(question, system, times)
        attitude = free.sample(times)
        turned = free.inherited(times, question.input_uncertainty)
        if question.round is not None:
            # Quaternions of two attitudes are half as far apart as the attitudes.
            attitude, added = rounded(attitude, question.round, 0.5 * (error + turned), 1.0)
            error += 2.0 * added
        fields["attitude"], accuracy["attitude_error"] = attitude, error
        accuracy["attitude_inherited"] = turned
        if "input_uncertainty" in question.model_fields_set:
            accuracy["attitude_horizon"] = free.horizon_of(question.input_uncertainty)
    return fields


def _outputs(question: TrajectoryRequest) -> tuple[Output, ...]:
    if question.outputs is not None:
        return tuple(question.outputs)
    return ("time", "angular_velocity") if question.attitude is None else ("time", "angular_velocity", "attitude")


def _attitude(question: TrajectoryRequest, system: TorqueFree, times: Floats) -> tuple[FreeAttitude, float]:
    _require_closed_form(question)
    free = FreeAttitude(system.closed_form(), np.array(question.attitude or (1.0, 0.0, 0.0, 0.0)))
    error = free.error(times)
    if not error <= question.accuracy:
        raise AccuracyUnreachable(
            question.accuracy,
            error,
            "the bound of the attitude's closed form is larger",
            remedy="ask for earlier times or for less accuracy",
        )
    return free, error


def _require_closed_form(question: TrajectoryRequest) -> None:
    if question.method is not None and not isinstance(question.method, ClosedFormEvaluation):
        raise NotApplicable(
            "the attitude is computed in closed form only",
            path=("method",),
            remedy="leave out the method, or the attitude",
        )


def in_range(name: str, value: float | None, notices: list[Notice]) -> float | None:
    """Return a figure as it is written: null, with a notice, where it is too large for a double."""
    if value is None or isfinite(value):
        return value
    notices.append(Notice("out-of-range", f"{name} leaves the range of double precision and is null"))
    return None


def trajectory_counts(question: TrajectoryRequest, budget: Budget) -> dict[str, float]:
    """Return what is counted of a trajectory."""
    samples, wanted = sample_count(question.times, budget), _outputs(question)
    found = counts(question, budget) | {"samples": samples}
    if "attitude" in wanted:
        found |= {"attitudes": 1.0, "attitude samples": samples}
    speed = speed_to_follow((question.method,), question.body, speed_of(question.angular_velocity))
    found |= effort(question.method, question.times, speed, samples)
    columns = 3 * ("angular_velocity" in wanted) + 4 * ("attitude" in wanted)
    return found | {"times": samples * ("time" in wanted)} | numbers(samples * columns, question.round)


def in_closed_form(method: Any) -> bool:
    """Return whether nothing is to be integrated."""
    return method is None or isinstance(method, ClosedFormEvaluation)


def is_small_trajectory(question: TrajectoryRequest) -> bool:
    """Return whether a trajectory has few samples, in closed form."""
    return in_closed_form(question.method) and few_times(question.times) and is_small(question)


def trajectory_probe(question: TrajectoryRequest) -> TrajectoryRequest:
    """Return the question about the farthest time alone, in closed form."""
    if "attitude" in _outputs(question):
        _require_closed_form(question)
    changes: dict[str, Any] = {"times": [extreme(question.times)], "method": None, "round": None}
    if question.method is not None and not isinstance(question.method, ClosedFormEvaluation):
        # A method that is named is answered whatever its error.
        changes["accuracy"] = 0.5
    return question.model_copy(update=changes)


T_HANDLE = {"kind": "principal-moments", "moments": [795.7921810699588, 713.5092592592592, 395.7829218106996]}

RESTING, STEADY = (
    {"body": T_HANDLE, "angular_velocity": rates, "attitude": [1.0, 0.0, 0.0, 0.0], "times": [1.0]}
    for rates in ([0.0, 0.0, 0.0], [0.0, 1.0, 0.0])
)

ROTATION = (
    PostRoute(
        "/v1/rotation/trajectory",
        "rotation_trajectory",
        "The free rotation of a body: angular velocity and, if asked, attitude at given times",
        "rotation",
        TrajectoryRequest,
        TrajectoryAnswer,
        trajectory,
        CalibratedCost("rotation_trajectory", trajectory_counts),
        is_small_trajectory,
        trajectory_probe,
        examples={
            "t-handle": Example(
                "a T-handle that tumbles",
                {
                    "body": T_HANDLE,
                    "angular_velocity": [1.0, 10.0, 1.0],
                    "times": {"start": 0.0, "stop": 20.0, "count": 101},
                },
            ),
            "attitude": Example(
                "the same with its attitude in space",
                {
                    "body": T_HANDLE,
                    "angular_velocity": [1.0, 10.0, 1.0],
                    "attitude": [1.0, 0.0, 0.0, 0.0],
                    "times": [0.0, 1.0, 2.453763074],
                    "accuracy": 1e-12,
                },
            ),
            "points": Example(
                "four point masses, their principal axes askew, with the attitude",
                {
                    "body": {
                        "kind": "point-masses",
                        "masses": [1.0, 2.0, 1.0, 0.5],
                        "positions": [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.2, 0.3, 1.0]],
                    },
                    "angular_velocity": [1.0, 2.0, 0.5],
                    "attitude": [1.0, 0.0, 0.0, 0.0],
                    "times": {"start": 0.0, "stop": 10.0, "count": 21},
                },
            ),
            "explicit-euler": Example(
                "the same by explicit Euler, to see what that does",
                {
                    "body": T_HANDLE,
                    "angular_velocity": [1.0, 10.0, 1.0],
                    "times": {"start": 0.0, "stop": 5.0, "count": 51},
                    "method": {"kind": "explicit-euler", "step": 0.002},
                },
            ),
        },
        warming=(RESTING, STEADY),
    ),
)
