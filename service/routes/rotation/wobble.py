"""Questions about the free wobble of a planet."""

from __future__ import annotations

from fractions import Fraction
from typing import Annotated

from pydantic import Field

from core.certified.wobble import wobble_errors
from core.quantities import Quantity, Unit
from core.rotation.wobble import (
    EARTH,
    Day,
    EarthFigures,
    Wobble,
    from_ellipticity,
    from_period,
    rotations_of_ellipticity,
    rotations_of_period,
)
from core.systems.budget import Budget
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
    return fields_of(_answered(question)[0])


def errors(question: WobbleRequest, budget: Budget) -> tuple[Answer, str]:
    """Return bounds of the errors of the answer's figures, and what they rest on; the Earth's are as measured."""
    earth = dict.fromkeys(fields_of(EARTH), 0.0)
    return {**wobble_errors(*_answered(question)), "earth": earth}, "ball arithmetic"


def _answered(question: WobbleRequest) -> tuple[Wobble, Fraction]:
    """Return the wobble, and the period in rotations that it is computed from."""
    require_one(question, "period", "ellipticity")
    if question.period is not None:
        return from_period(question.period, question.day), rotations_of_period(question.period, question.day)
    assert question.ellipticity is not None
    return from_ellipticity(question.ellipticity, question.day), rotations_of_ellipticity(question.ellipticity)


WOBBLE = (
    PostRoute(
        "/v1/rotation/wobble",
        "wobble",
        "The free wobble of a planet: asymmetry, ellipticity and period",
        "rotation",
        WobbleRequest,
        WobbleAnswer,
        wobble,
        lambda question: True,
        errors=errors,
    ),
)
