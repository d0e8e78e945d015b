"""Questions about methods: what error each of them buys for which work, on the client's own motion."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Annotated, Any

import numpy as np
from pydantic import Field

from core.bodies import Body
from core.errors import InvalidParameter, inside_field
from core.multibody.motion.modelling import system_of
from core.notices import Notice
from core.quantities import AngularVelocity, Tolerance
from core.rotation.torque_free import TorqueFree
from core.scenes import Scene as NamedScene
from core.scenes.sampled_motion import ComparableEquation
from core.systems.budget import Budget
from core.systems.methods import Method
from core.systems.system import InitialValueProblem
from core.work_precision import (
    DEFAULT_RUNS,
    Measurement,
    work_precision,
)
from service.requests.described_scene import SceneDescription
from service.responses.svg import SVG, Curve, Level, log_log
from service.routes.bodies import properties_of
from service.routes.rotation.trajectory import TIMES
from service.routing import Answer, PostRoute
from service.schemas import (
    Envelope,
    Ratio,
    Request,
    Seconds,
    Times,
    View,
    ends_of,
    fields_of,
    require_one,
    sample_times,
)


class WorkPrecisionRequest(Request):
    """A free rotation, a described scene or a named one, and the methods to be compared on it."""

    body: Body | None = Field(default=None, description="That turns freely; this with its angular velocity, or scene.")
    angular_velocity: AngularVelocity | None = Field(default=None, description="At t = 0, in body axes.")
    scene: SceneDescription | None = Field(default=None, description="As to POST /v1/scenes.")
    named_scene: NamedScene | None = Field(default=None, description="As to POST /v1/scenes/{kind}.")
    times: Times = TIMES
    methods: Annotated[list[Method], Field(min_length=1, max_length=100)] | None = Field(
        default=None, description="With their settings, a method as often as wanted; default: a ladder of every method."
    )
    accuracy: Tolerance = Field(default=1e-9, description="What the recommendation is for.")
    repeats: Annotated[int, Field(ge=0, le=101)] = Field(
        default=0, description="How often each run is timed; 0 times nothing, and equal questions get equal answers."
    )

    def with_digits(self, document: Any) -> WorkPrecisionRequest:
        """Return the question with the numbers of its scene as they are written."""
        if self.scene is None:
            return self
        return self.model_copy(update={"scene": self.scene.with_digits(document["scene"])})

    def rotation(self) -> tuple[Any, AngularVelocity]:
        """Return the body that turns and how, or raise `InvalidParameter`."""
        require_one(self, "body", "scene", "named_scene")
        if self.body is None or self.angular_velocity is None:
            raise InvalidParameter("angular_velocity", "be given with the body", remedy="or give a scene alone")
        return self.body, self.angular_velocity


class MethodMeasurement(View):
    """One method with one setting; errors are relative to the largest norm of the state in the whole motion.

    The state of a described scene holds the coordinates that remain of it, and then their rates, in units in which they
    are of the order of one: SI units times powers of two. That of a named scene holds its coordinates, and then their
    rates, in SI units.
    """

    method: Method = Field(description="With its setting.")
    error: Ratio[float] | None = Field(description="Largest of any sample; null if the method failed.")
    final_error: Ratio[float] | None = Field(description="At the time farthest from the start.")
    component_errors: list[Ratio[float]] = Field(
        description="Of each component, relative to its own largest magnitude."
    )
    drifts: dict[str, Ratio[float]] | None = Field(description="Of conserved quantities: not an error.")
    evaluations: int = Field(description="Of the equation of motion.")
    steps: int = Field(description="Taken by the method.")
    seconds: Seconds[float] | None = Field(description="Median of the repeats; null if nothing was timed.")
    failure: str | None = Field(description="Why there are no samples.")


class MethodCurve(View):
    """All settings of one method, cheapest first."""

    kind: str = Field(description="Of the method.")
    declared_order: int | None = Field(description="The error falls with this power of the step; null: no fixed order.")
    fitted_order: Ratio[float] | None = Field(
        description="Between the coarse settings and the floor; null with too few."
    )
    floor: Ratio[float] | None = Field(description="Where more work brings no smaller error; null if it was not met.")
    measurements: list[MethodMeasurement] = Field(description="Cheapest first.")


class Recommendation(View):
    """The cheapest setting that was measured to reach the accuracy."""

    method: Method | None = Field(description="Null if none was measured to reach the accuracy.")
    reason: str = Field(description="Why, in one sentence.")


class WorkPrecisionAnswer(Envelope):
    """Error against cost."""

    reference: str = Field(description="What errors are measured against.")
    reference_error: Ratio[float] = Field(description="Contained in every error that is stated.")
    curves: list[MethodCurve] = Field(description="One for each kind of method.")
    pareto_front: list[MethodMeasurement] = Field(description="Beaten by none in both error and evaluations.")
    recommendation: Recommendation


def answer_work_precision(question: WorkPrecisionRequest, budget: Budget) -> Answer:
    """Answer with every method's errors and work."""
    warnings: Sequence[Notice] = ()
    times = sample_times(question.times, budget)
    if question.scene is not None:
        require_one(question, "body", "scene", "named_scene")
        with inside_field("scene"):
            system: InitialValueProblem = system_of(question.scene.scene())
    elif question.named_scene is not None:
        require_one(question, "body", "scene", "named_scene")
        with inside_field("named_scene"):
            motion = question.named_scene.motion_to(max(0.0, *ends_of(question.times)))
        system = ComparableEquation.of(motion)
    else:
        body, rates = question.rotation()
        system = turning = TorqueFree(properties_of(body), np.array(rates))
        warnings = turning.warnings
    # The budget is for the question, and each of its runs has an equal share.
    share = max(1, budget.evaluations // ((1 + question.repeats) * _runs(question)))
    found = work_precision(
        system,
        times,
        question.methods,
        accuracy=question.accuracy,
        repeats=question.repeats,
        budget=Budget(share, budget.samples),
    )
    return fields_of(found) | {"warnings": warnings}


def _runs(question: WorkPrecisionRequest) -> int:
    return DEFAULT_RUNS if question.methods is None else len(question.methods)


def drawn(answer: Answer) -> bytes:
    """Return the answer as a figure: error over evaluations, the closed form as a line, the front under the curves."""
    curves = [Curve("", _points(answer["pareto_front"]), emphasised=True)]
    levels = []
    for curve in answer["curves"]:
        points = _points(curve.measurements)
        if any(evaluations > 0 for evaluations, _ in points):
            order = "" if curve.fitted_order is None else f", order {curve.fitted_order:.1f}"
            curves.append(Curve(curve.kind + order, points))
        else:
            levels += [Level(curve.kind, error) for _, error in points[:1]]
    title = f"Error against work, measured against: {answer['reference']}"
    return log_log(title, "evaluations", "largest error, relative", curves, levels).encode()


def _points(measurements: tuple[Measurement, ...]) -> list[tuple[float, float]]:
    return [(float(one.evaluations), one.error) for one in measurements if one.error is not None]


WORK_PRECISION = (
    PostRoute(
        "/v1/work-precision",
        "work_precision",
        "What error each method buys for which work, on a motion of your own",
        "accuracy",
        WorkPrecisionRequest,
        WorkPrecisionAnswer,
        answer_work_precision,
        description="`Accept: image/svg+xml` returns the same as a figure.",
        representations={SVG: drawn},
    ),
)
