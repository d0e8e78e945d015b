"""Questions about rates and angles of a free rotation; none of them integrates unless a measurement is asked for."""

from __future__ import annotations

from typing import Any

import numpy as np
from pydantic import Field

from core.bodies import Body
from core.bodies.principal_inertia import Symmetry
from core.integration.budget import Budget
from core.quantities import AngularVelocity
from core.rotation.measurement import Measure, MeasuredPeriod, measure_period
from core.rotation.precession import Cones, precession
from core.rotation.torque_free import TorqueFree
from service.routes.bodies import properties_of, reading_price
from service.routes.rotation import T_HANDLE, ModelView
from service.routing import Answer, Example, Question
from service.schemas import Envelope, Request, Vector


class PrecessionRequest(Request):
    """A body and how it turns at t = 0."""

    body: Body
    angular_velocity: AngularVelocity = Field(description="At t = 0, in body axes (rad/s).")
    measure: Measure | None = Field(
        default=None, description="Measure the period by an integrator, as the first return within a tolerance."
    )


class PrecessionAnswer(Envelope):
    """Rates and angles; null where the motion has no such thing."""

    model: ModelView
    symmetry: Symmetry
    regime: str
    axis: Vector | None = Field(description="Axis of symmetry, or the one that is circled, in body axes.")
    body_rate: float | None = Field(description="(I3 - I)/I w3, signed (rad/s).")
    space_rate: float | None = Field(description="L/I (rad/s).")
    period: float | None = Field(description="Of the angular velocity in the body (s).")
    flip_interval: float | None = Field(description="Between sign changes along the middle axis (s).")
    cones: Cones | None = Field(description="Half-angles (rad).")
    nutation: tuple[float, float] | None = Field(description="Least and largest angle of axis and momentum (rad).")
    mean_precession_rate: float | None = Field(description="Of the axis about the angular momentum (rad/s).")
    precession_per_period: float | None = Field(description="Not reduced modulo 2 pi (rad).")
    measured: MeasuredPeriod | None = None


FIGURES = (
    "model", "symmetry", "regime", "axis", "body_rate", "space_rate", "period", "flip_interval", "cones", "nutation",
    "mean_precession_rate", "precession_per_period",
)  # fmt: skip


def answer_precession(question: PrecessionRequest, budget: Budget) -> Answer:
    """Answer with the figures and, if asked for, the measurement."""
    body = properties_of(question.body)
    system = TorqueFree(body, np.array(question.angular_velocity))
    found = precession(system.closed_form())
    answer: Answer = {name: getattr(found, name) for name in FIGURES}
    answer["warnings"] = (*(notice.inside("body") for notice in body.warnings), *found.warnings)
    if question.measure is not None:
        answer["measured"] = measure_period(system, question.measure, budget)
    return answer


def price(question: PrecessionRequest, budget: Budget) -> float:
    """Return the predicted time (s)."""
    own = reading_price(question, budget) + 2e-4
    return own if question.measure is None else own + 0.02 + _steps(question.measure) * 1e-7


def _steps(measure: Measure) -> float:
    step: Any = getattr(measure.method, "step", None)
    return measure.samples + (measure.duration / step if step else 0.0)


PRECESSION = (
    Question(
        "/v1/rotation/precession",
        "precession",
        "Rates, period, flip interval and cones of a free rotation",
        "rotation",
        PrecessionRequest,
        PrecessionAnswer,
        answer_precession,
        price,
        examples={
            "coin": Example(
                "a spinning coin",
                {
                    "body": {"kind": "principal-moments", "moments": [1.0, 1.0, 2.0]},
                    "angular_velocity": [1.0, 1.0, 1.0],
                },
            ),
            "t-handle": Example("a T-handle", {"body": T_HANDLE, "angular_velocity": [1.0, 10.0, 1.0]}),
            "source": Example(
                "the source's experiment: forward Euler and the first return within 0.035",
                {
                    "body": {"kind": "principal-moments", "moments": [1.0, 1.0, 2.0]},
                    "angular_velocity": [1.0, 1.0, 1.0],
                    "measure": {
                        "method": {"kind": "explicit-euler", "step": 0.0075037518759379685},
                        "duration": 15.0,
                        "samples": 2000,
                        "tolerance": 0.035,
                    },
                },
            ),
        },
    ),
)
