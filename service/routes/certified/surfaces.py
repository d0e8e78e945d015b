"""The energy ellipsoid and the curves on it to any number of digits."""

from __future__ import annotations

from typing import Any, Literal

from pydantic import Field

from core.certified.ellipsoid_mesh import certified_grid, certified_triangles
from core.certified.energy_ellipsoid import CertifiedEllipsoid
from core.digits.adaptive_precision import check_digits
from core.systems.budget import Budget
from service.requests.decimal_models import DecimalAngularVelocity, DecimalBody, DecimalEnergy, DigitCount, body_of
from service.responses.ellipsoid_svg import ellipsoid_figure
from service.responses.svg import SVG
from service.routes.certified.answers import Certified, accuracy, certified_route, notices
from service.routes.rotation.surfaces import (
    ENERGY,
    POINTS,
    SEPARATRIX,
    STATE,
    SURFACES,
    Count,
    Drawn,
    EllipsoidSurface,
    curves_drawn,
    require_few_points,
)
from service.routing import Answer
from service.schemas import DecimalString, Request, fields_of, require_one


class CertifiedEllipsoidRequest(Request):
    """A body and the energy of its rotation, or a state that has it."""

    body: DecimalBody
    energy: DecimalEnergy | None = ENERGY
    angular_velocity: DecimalAngularVelocity | None = STATE
    resolution: Count | None = Field(
        default=None,
        description="Parts of an icosahedron's edge, or points from pole to pole; 16 if only the layout is given. "
        "Without both no surface is answered.",
    )
    layout: Literal["triangles", "grid"] | None = Field(
        default=None, description="triangles if only the resolution is given."
    )
    polhodes: Drawn | None = Field(
        default=None,
        description="Draw polhodes through random starts: the same doubles as in the ordinary question, each "
        "then scaled to the energy exactly.",
    )
    separatrix: bool = SEPARATRIX
    points: Count = POINTS
    digits: DigitCount


class CertifiedEllipsoidAnswer(Certified, EllipsoidSurface[DecimalString]):
    """The surface w.I.w = 2E in body axes, numbers as decimal strings."""


def energy_ellipsoid(question: CertifiedEllipsoidRequest, budget: Budget) -> Answer:
    """Answer with the semi-axes, and with the requested surface and curves."""
    body, digits = body_of(question.body), question.digits
    require_few_points(question, budget)
    check_digits(digits, _numbers(question))
    require_one(question, "energy", "angular_velocity")
    if question.energy is not None:
        surface = CertifiedEllipsoid.of(body.of_motion, question.energy)
    else:
        assert question.angular_velocity is not None
        surface = CertifiedEllipsoid.through(body.of_motion, question.angular_velocity)
    answer: Answer = {
        "energy": surface.energy(digits),
        "semi_axes": surface.semi_axes(digits),
        "axes": surface.axes(digits),
        "accuracy": accuracy(digits),
        "warnings": notices(body),
    }
    layout, resolution = _surface(question)
    if layout == "triangles":
        mesh = certified_triangles(surface, resolution, digits)
        answer["mesh"] = {"vertices": mesh.vertices, "faces": mesh.faces, "quality": mesh.quality}
    elif layout == "grid":
        answer["grid"] = dict(zip("xyz", certified_grid(surface, resolution, digits), strict=True))
    starts: list[Any] = []
    if question.polhodes is not None:
        starts = surface.drawn_starts(question.polhodes.count, question.polhodes.seed)
    elif question.angular_velocity is not None:
        starts = [question.angular_velocity]
    if starts:
        answer["polhodes"] = [fields_of(surface.polhode(start, question.points, digits)) for start in starts]
    if question.separatrix:
        answer["separatrix"] = [fields_of(curve) for curve in surface.separatrix(question.points, digits)]
    return answer


def _surface(question: CertifiedEllipsoidRequest) -> tuple[str | None, int]:
    if question.layout is None and question.resolution is None:
        return None, 0
    return question.layout or "triangles", question.resolution or 16


def _vertices(question: CertifiedEllipsoidRequest) -> int:
    layout, resolution = _surface(question)
    return {None: 0, "triangles": 10 * resolution**2 + 2, "grid": 2 * resolution**2}[layout]


def _numbers(question: CertifiedEllipsoidRequest) -> int:
    return 3 * (_vertices(question) + curves_drawn(question) * question.points)


CERTIFIED_ELLIPSOID = certified_route(
    SURFACES[0],
    question=CertifiedEllipsoidRequest,
    answer=CertifiedEllipsoidAnswer,
    handle=energy_ellipsoid,
    representations={SVG: ellipsoid_figure},
)
