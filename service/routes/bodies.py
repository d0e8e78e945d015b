"""Questions about bodies at rest."""

from __future__ import annotations

from dataclasses import fields
from functools import cache
from typing import Annotated, Any, Literal

from pydantic import Field

from core.bodies import Body
from core.bodies.mass_properties import MassProperties
from core.bodies.principal_inertia import PrincipalInertia, Symmetry
from core.bodies.rounding_errors import rounding_errors
from core.bodies.validity import Condition
from core.errors import InvalidParameter
from core.quantities import Unit
from core.systems.budget import Budget
from service.routing import Answer, PostRoute
from service.schemas import Envelope, Matrix, Ratio, Request, Vector, View, number_of

SMALL_BODY = 400
"""Points of a body up to which a request may be begun in the event loop: no composite has so few."""

FEW_SAMPLES = 256
"""Samples of a closed form up to which a request may be begun in the event loop."""


class MassPropertiesRequest(Request):
    """A body."""

    body: Body


MomentsOfInertia = Annotated[Vector[float], Unit("kg m^2")]
TensorOfInertia = Annotated[Matrix[float], Unit("kg m^2")]


class PrincipalAxes(View):
    """Principal moments and axes."""

    moments: MomentsOfInertia = Field(description="Ascending.")
    axes: Matrix[Ratio[float]] = Field(
        description="Columns are the principal axes in body axes, right-handed; written row by row."
    )


class InertiaTensors(View):
    """Tensors of inertia in body axes; I_xy = -(integral of x y dm)."""

    about_center_of_mass: TensorOfInertia = Field(description="About the centre of mass.")
    about_origin: TensorOfInertia | None = Field(description="About the origin of the frame of the body.")


class Validity(View):
    """Whether matter can have these mass properties, condition by condition."""

    physical: bool = Field(description="Whether every condition holds.")
    report: list[Condition] = Field(description="The conditions, one by one.")


class MassPropertiesAnswer(Envelope):
    """Mass properties of a body."""

    mass: Annotated[float, Unit("kg")] | None = Field(description="Null where the body was given by its moments alone.")
    center_of_mass: Annotated[Vector[float], Unit("m")] | None = Field(
        description="In the frame in which the body was given."
    )
    inertia: InertiaTensors = Field(description="Tensors of inertia in body axes; I_xy = -(integral of x y dm).")
    principal: PrincipalAxes = Field(description="About the centre of mass.")
    principal_about_origin: PrincipalAxes | None = Field(description="About the origin; null where it is not known.")
    symmetry: Symmetry = Field(description="Which of the principal moments are equal.")
    about: Literal["center-of-mass", "origin"] = Field(description="The point about which the body turns.")
    validity: Validity


def properties_of(body: Any) -> MassProperties:
    """Return the mass properties of a question's body; pointers of faults lead into the question."""
    try:
        properties: MassProperties = body.mass_properties()
    except InvalidParameter as fault:
        raise fault.inside("body") from None
    return properties


def mass_properties(question: MassPropertiesRequest, budget: Budget) -> Answer:
    """Answer with everything that is known of a body at rest."""
    body = properties_of(question.body)
    return {
        "mass": body.mass,
        "center_of_mass": body.center_of_mass,
        "inertia": {"about_center_of_mass": body.inertia, "about_origin": body.inertia_about_origin},
        "principal": principal(body.principal),
        "principal_about_origin": principal(body.principal_about_origin),
        "symmetry": body.symmetry,
        "about": body.about,
        "validity": body.validity,
        "warnings": tuple(notice.inside("body") for notice in body.warnings),
    }


def errors(question: MassPropertiesRequest, budget: Budget) -> tuple[Answer, str]:
    """Return bounds of the errors of the answer's figures, and what they rest on."""
    found = rounding_errors(properties_of(question.body))
    about_center, about_origin = found.pop("inertia"), found.pop("inertia_about_origin")
    tensors = {"about_center_of_mass": about_center, "about_origin": about_origin}
    return {**found, "inertia": tensors}, "sums of two doubles"


def principal(inertia: PrincipalInertia | None) -> dict[str, Any] | None:
    """Return principal moments and axes as they are written."""
    return None if inertia is None else {"moments": inertia.moments, "axes": inertia.axes}


def is_small(question: Any) -> bool:
    """Return whether a question is about a small body."""
    return _size(question.body) <= SMALL_BODY


def few_times(times: Any) -> bool:
    """Return whether a question's times are few."""
    return number_of(times) <= FEW_SAMPLES


def _size(body: Any) -> int:
    """Return how many points or faces a body has; each part of a composite counts as a thousand."""
    size = 0
    kind: Any = type(body)
    for name in _extents(kind):
        if name == "parts":
            size += sum(1000 + _size(part.body) for part in body.parts)
        else:
            size += len(getattr(body, name))
    return size


@cache
def _extents(kind: Any) -> tuple[str, ...]:
    """Return the fields of a kind of body by which it can be large."""
    return tuple(entry.name for entry in fields(kind) if entry.name in ("positions", "faces", "parts"))


# More points than are summed in whole numbers.
CLOUD = {
    "kind": "point-masses",
    "masses": 1.0,
    "positions": [[float(i % 7), float(i % 11), float(i % 13)] for i in range(500)],
}

TETRAHEDRON = {
    "kind": "mesh",
    "density": 1.0,
    "vertices": [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]],
    "faces": [[0, 2, 1], [0, 1, 3], [1, 2, 3], [0, 3, 2]],
}

BODIES = (
    PostRoute(
        "/v1/bodies/mass-properties",
        "mass_properties",
        "Mass, centre of mass, inertia, principal axes, symmetry and validity of a body",
        "bodies",
        MassPropertiesRequest,
        MassPropertiesAnswer,
        mass_properties,
        is_small,
        warming=({"body": TETRAHEDRON}, {"body": CLOUD}),
        errors=errors,
    ),
)
