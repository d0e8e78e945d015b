"""Questions about the free wobble of a planet."""

from __future__ import annotations

from typing import Annotated

from pydantic import Field

from core.quantities import Quantity, Unit
from core.rotation.wobble import Day, EarthFigures, from_ellipticity, from_period
from core.systems.budget import Budget
from service.execution.cost_model import CalibratedCost, one
from service.routing import Answer, PostRoute
from service.schemas import Envelope, Ratio, Request, fields_of, require_one


class WobbleRequest(Request):
    """A period, or the shape of the body."""

    period: Annotated[float, Quantity("d", above=0)] | None = Field(
        default=None, description="In days of the kind `day`."
    )
    day: Day = Field(default="sidereal", description="A sidereal day is one rotation.")
    ellipticity: Annotated[float, Quantity("1", above=1)] | None = Field(
        default=None, description="Major over minor axis, a/c; this or the period."
    )


class WobbleAnswer(Envelope):
    """A wobble and the body that has it."""

    period: Annotated[float, Unit("d")] = Field(description="In days of the kind `day`.")
    day: Day = Field(description="Kind of day in which the period is given.")
    rotations: Ratio[float] = Field(description="The period in rotations of the body, 1/asymmetry.")
    asymmetry: Ratio[float] = Field(description="(I1 - I)/I")
    ellipticity: Ratio[float] = Field(description="a/c for a scaled spherically symmetric density.")
    flattening: Ratio[float] = Field(description="(a - c)/a")
    earth: EarthFigures = Field(description="The Earth's measured figures, and why they differ from a rigid body's.")


def wobble(question: WobbleRequest, budget: Budget) -> Answer:
    """Answer with the wobble."""
    require_one(question, "period", "ellipticity")
    if question.period is not None:
        return fields_of(from_period(question.period, question.day))
    assert question.ellipticity is not None
    return fields_of(from_ellipticity(question.ellipticity, question.day))


WOBBLE = (
    PostRoute(
        "/v1/rotation/wobble",
        "wobble",
        "The free wobble of a planet: asymmetry, ellipticity and period",
        "rotation",
        WobbleRequest,
        WobbleAnswer,
        wobble,
        CalibratedCost("wobble", one),
        lambda question: True,
    ),
)
