"""Questions about many free rotations of one body."""

from __future__ import annotations

from typing import Annotated, Any

import numpy as np
from pydantic import Field

from core.bodies import Body
from core.notices import Notice
from core.quantities import AngularVelocity, Energy, Tolerance
from core.rotation.ensemble import ensemble
from core.rotation.sampled_rotation import in_range
from core.rotation.surfaces.initial_states import initial_states
from core.rotation.torque_free import inherited_notices
from core.systems.budget import Budget
from core.systems.methods import Method
from core.systems.system import Model
from core.systems.trajectory import Work
from service.responses.svg import SVG
from service.routes.bodies import few_times, is_small, properties_of
from service.routes.motion_figures import draw_ensemble
from service.routes.rotation.surfaces import Count, Seed
from service.routes.rotation.trajectory import ACCURACY, METHOD, TIMES, Accuracy, accuracy_fields
from service.routing import Answer, PostRoute
from service.schemas import (
    ROUND,
    AngularVelocityRow,
    Envelope,
    Ratio,
    Request,
    Rounding,
    Seconds,
    Times,
    View,
    in_closed_form,
    require_one,
    sample_times,
)

FEW_MEMBERS = 8
"""Members of an ensemble up to which it may be begun in the event loop."""


class Sample(Request):
    """Starts of one energy, drawn uniformly over the scaled sphere."""

    energy: Energy = Field(description="Kinetic energy of every start.")
    count: Count = Field(description="Number of starts.")
    seed: Seed = Field(default=0, description="Of the draw; equal seeds give equal starts.")


class EnsembleRequest(Request):
    """A body, its starts, and the times at which every motion is wanted."""

    body: Body
    angular_velocities: Annotated[list[AngularVelocity], Field(min_length=1)] | None = Field(
        default=None, description="Starts at t = 0, in body axes; these or a sample."
    )
    sample: Sample | None = Field(default=None, description="Starts of one energy; this or angular_velocities.")
    times: Times = TIMES
    accuracy: Tolerance = ACCURACY
    method: Method | None = METHOD
    round: Rounding | None = ROUND


class Member(View):
    """One motion."""

    model: Model
    method: str = Field(description="Kind of the method that computed the samples.")
    period: Seconds[float] | None = Field(description="Of the angular velocity in the body.")
    accuracy: Accuracy
    work: Work
    ended: str = Field(description="horizon, or the event that ended the motion before it.")


class EnsembleAnswer(Envelope):
    """Samples of every motion."""

    error: Ratio[float] = Field(description="Largest stated error of any member.")
    seed: int | None = Field(description="Of the sample, null if the starts were given.")
    members: list[Member] = Field(description="In the order of the starts.")
    time: list[Seconds[float]] = Field(description="Of the samples of every member.")
    angular_velocity: list[list[AngularVelocityRow[float]]] = Field(
        description="By member, time and component, in body axes."
    )


def answer_ensemble(question: EnsembleRequest, budget: Budget) -> Answer:
    """Answer with the samples of every motion."""
    body = properties_of(question.body)
    times = sample_times(question.times, budget)
    many = ensemble(
        body,
        _starts(question, body),
        times,
        accuracy=question.accuracy,
        method=question.method,
        digits=question.round,
        budget=budget,
    )
    outside: list[Notice] = []
    members = [
        {
            "model": member.model,
            "method": member.method,
            "period": in_range("period", member.period, outside),
            "accuracy": accuracy_fields(member.accuracy),
            "work": member.work,
            "ended": member.ended,
        }
        for member in many.members
    ]
    return {
        "error": many.error,
        "seed": None if question.sample is None else question.sample.seed,
        "members": members,
        "time": many.time,
        "angular_velocity": many.angular_velocity,
        "warnings": (*inherited_notices(body), *many.warnings, *outside[:1]),
    }


def _starts(question: EnsembleRequest, body: Any) -> Any:
    require_one(question, "angular_velocities", "sample")
    if question.sample is not None:
        return initial_states(body, question.sample.energy, question.sample.count, question.sample.seed)
    return np.array(question.angular_velocities)


def _members(question: EnsembleRequest) -> int:
    return question.sample.count if question.sample is not None else len(question.angular_velocities or ())


def is_small_ensemble(question: EnsembleRequest) -> bool:
    """Return whether an ensemble has few members and few samples, in closed form."""
    few = _members(question) <= FEW_MEMBERS and few_times(question.times)
    return few and in_closed_form(question.method) and is_small(question)


ENSEMBLE = (
    PostRoute(
        "/v1/rotation/ensemble",
        "rotation_ensemble",
        "Many free rotations of one body, from given starts or a sample of one energy",
        "rotation",
        EnsembleRequest,
        EnsembleAnswer,
        answer_ensemble,
        is_small_ensemble,
        representations={SVG: draw_ensemble},
    ),
)
