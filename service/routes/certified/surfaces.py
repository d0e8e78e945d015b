"""The energy ellipsoid and the curves on it to any number of digits."""

from __future__ import annotations

from typing import Any, Literal

from pydantic import Field

from core.bodies.exact import tensor_pairs
from core.bodies.mass_properties import MassProperties
from core.certified.adaptive_precision import check_digits
from core.certified.ellipsoid_mesh import certified_grid, certified_triangles
from core.certified.energy_ellipsoid import CertifiedEllipsoid
from core.certified.exact_inertia import ExactInertia
from core.certified.exact_inputs import nearest
from core.errors import BudgetExceeded
from core.rotation.surfaces.initial_states import initial_states
from core.systems.budget import Budget
from service.requests.decimal_models import (
    AngularVelocityInNumerals,
    BodyInNumerals,
    DigitCount,
    EnergyInNumerals,
    body_of,
)
from service.routes.certified.questions import SET_UP, AccuracyInDigits, InDigits, PerSample, accuracy, notices, summing
from service.routes.rotation.surfaces import Count, Drawn, require_one
from service.routing import Answer, Example
from service.schemas import Envelope, Request, View, fields_of

Row = list[str]


class EllipsoidInDigits(Request):
    """A body and the energy of its rotation, or a state that has it, the answer wanted to a number of digits."""

    body: BodyInNumerals
    energy: EnergyInNumerals | None = Field(default=None, description="Kinetic energy (J); this or angular_velocity.")
    angular_velocity: AngularVelocityInNumerals | None = Field(
        default=None, description="A state of that energy (rad/s)."
    )
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
        description="Draw polhodes through random starts: the same doubles as without digits, each then scaled to the "
        "energy exactly.",
    )
    separatrix: bool = Field(default=False, description="Draw the separatrix.")
    points: Count = Field(
        default=256, description="Points of each curve; a multiple of 4 has the extreme points among them."
    )
    digits: DigitCount


class QualityInDigits(View):
    """How well the triangles stand for the ellipsoid."""

    watertight: bool
    euler_characteristic: int
    volume_ratio: str = Field(description="Volume inside the triangles over that of the ellipsoid.")
    smallest_angle: str = Field(description="Of any triangle (rad).")
    longest_edge: str = Field(description="Of any triangle (rad/s).")


class MeshInDigits(View):
    """Triangles, counter-clockwise seen from outside."""

    vertices: list[Row]
    faces: list[list[int]]
    quality: QualityInDigits


class GridInDigits(View):
    """Coordinates over longitude (down) and colatitude (along), both ends included."""

    x: list[Row]
    y: list[Row]
    z: list[Row]


class PolhodeInDigits(View):
    """One curve; the last point is the first if it is closed."""

    regime: str
    closed: bool
    angular_momentum: str = Field(description="Magnitude, the same at every point (kg m^2/s).")
    points: list[Row]


class EllipsoidAnswerInDigits(Envelope):
    """The surface w.I.w = 2E in body axes (rad/s)."""

    energy: str
    semi_axes: Row = Field(description="sqrt(2E/I) along each of `axes` (rad/s).")
    axes: list[Row] = Field(description="Columns: the body axes if principal, else the principal axes.")
    accuracy: AccuracyInDigits
    mesh: MeshInDigits | None = None
    grid: GridInDigits | None = None
    polhodes: list[PolhodeInDigits] | None = None
    separatrix: list[PolhodeInDigits] | None = Field(default=None, description="Empty if two moments are equal.")


def energy_ellipsoid(question: EllipsoidInDigits, budget: Budget) -> Answer:
    """Answer with the semi-axes, and with the surface and the curves that are asked for."""
    body, digits = body_of(question.body), question.digits
    check_digits(digits, _numbers(question))
    require_one(question)
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
        starts = _drawn(body.of_motion, surface, question.polhodes)
    elif question.angular_velocity is not None:
        starts = [question.angular_velocity]
    if starts:
        answer["polhodes"] = [fields_of(surface.polhode(start, question.points, digits)) for start in starts]
    if question.separatrix:
        answer["separatrix"] = [fields_of(curve) for curve in surface.separatrix(question.points, digits)]
    return answer


def _drawn(inertia: ExactInertia, surface: CertifiedEllipsoid, drawn: Drawn) -> list[Any]:
    """Return the starts that a question in doubles is answered with, of which only the directions count."""
    body = MassProperties(*tensor_pairs(inertia.tensor))
    return list(initial_states(body, nearest(surface.twice_energy / 2), drawn.count, drawn.seed).tolist())


def _surface(question: EllipsoidInDigits) -> tuple[str | None, int]:
    if question.layout is None and question.resolution is None:
        return None, 0
    return question.layout or "triangles", question.resolution or 16


def _curves(question: EllipsoidInDigits) -> int:
    drawn = question.polhodes.count if question.polhodes is not None else 0
    return (drawn or (question.angular_velocity is not None)) + 2 * question.separatrix


def _vertices(question: EllipsoidInDigits) -> int:
    layout, resolution = _surface(question)
    return {None: 0, "triangles": 10 * resolution**2 + 2, "grid": 2 * resolution**2}[layout]


def _numbers(question: EllipsoidInDigits) -> int:
    return 3 * (_vertices(question) + _curves(question) * question.points)


POINT = PerSample(7e-6, 2e-8, 6e-11)
CURVE = PerSample(3e-4, 5e-7, 8e-10)
VERTEX = PerSample(5e-6, 1e-8, 6e-11)
FACE = PerSample(2e-5, 2.5e-8, 1.5e-10)


class EllipsoidPrice:
    """Price of an ellipsoid in digits: points of curves, vertices, and triangles, of which angles are measured."""

    def __call__(self, question: EllipsoidInDigits, budget: Budget) -> float:
        """Return the predicted time of computing an answer (s), or raise `BudgetExceeded`."""
        digits, curves = question.digits, _curves(question)
        points = curves * question.points
        if points > budget.samples:
            path = ("polhodes", "count") if question.polhodes is not None else ("points",)
            remedy = "ask for fewer curves, or for fewer points on each"
            raise BudgetExceeded("points", points, budget.samples, path=path, remedy=remedy)
        check_digits(digits, _numbers(question))
        layout, resolution = _surface(question)
        faces = 20 * resolution**2 if layout == "triangles" else 0
        return (
            SET_UP
            + summing(question.body)
            + curves * CURVE.seconds(digits)
            + points * POINT.seconds(digits)
            + _vertices(question) * VERTEX.seconds(digits)
            + faces * FACE.seconds(digits)
        )

    def size(self, question: EllipsoidInDigits, budget: Budget) -> float:
        """Return the predicted length of an answer as JSON (bytes)."""
        layout, resolution = _surface(question)
        faces = 20 * resolution**2 * 14 if layout == "triangles" else 0
        # A numeral has a sign, a point, two quotes and a comma; a third of the axes' components are zeros.
        return 600.0 + faces + (8 + _numbers(question)) * (question.digits + 5.5)


def planning_probe(question: EllipsoidInDigits) -> EllipsoidInDigits:
    """Return the question about a coarse surface and few points."""
    changes: dict[str, Any] = {"points": min(question.points, 16)}
    if question.resolution is not None and question.resolution <= 200:
        changes["resolution"] = min(question.resolution, 4)
    elif question.layout is not None and question.resolution is None:
        changes["resolution"] = 4
    if question.polhodes is not None:
        changes["polhodes"] = question.polhodes.model_copy(update={"count": min(question.polhodes.count, 4)})
    return question.model_copy(update=changes)


ELLIPSOID_IN_DIGITS = InDigits(
    EllipsoidInDigits,
    EllipsoidAnswerInDigits,
    energy_ellipsoid,
    EllipsoidPrice(),
    planning_probe,
    {
        "digits": Example(
            "semi-axes, a polhode and the separatrix to 40 digits, every point on both quadrics",
            {
                "body": {"kind": "principal-moments", "moments": ["2", "1", "0.5"]},
                "angular_velocity": ["0.4", "1", "0.7"],
                "separatrix": True,
                "points": 8,
                "digits": 40,
            },
        ),
        "digits-mesh": Example(
            "the icosahedron on the ellipsoid and two of the seeded polhodes",
            {
                "body": {"kind": "principal-moments", "moments": ["2", "1", "0.5"]},
                "energy": "1",
                "resolution": 1,
                "polhodes": {"count": 2, "seed": 1},
                "points": 8,
                "digits": 20,
            },
        ),
    },
)
