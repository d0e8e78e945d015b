"""Questions about the energy ellipsoid, the polhodes on it and starts drawn from it."""

from __future__ import annotations

from typing import Annotated, Any, Generic, Literal

import numpy as np
from pydantic import Field

from core.bodies import Body
from core.bodies.mass_properties import MassProperties
from core.errors import BudgetExceeded
from core.quantities import AngularVelocity, Energy
from core.rotation.equal_moments import curve_notices
from core.rotation.surfaces.energy_surface import EnergyEllipsoid
from core.rotation.surfaces.initial_states import initial_states
from core.rotation.surfaces.polhodes import polhode, separatrix
from core.rotation.torque_free import inherited_notices
from core.systems.budget import Budget
from service.responses.ellipsoid_svg import ellipsoid_figure
from service.responses.svg import SVG
from service.routes.bodies import FEW_SAMPLES, is_small, properties_of
from service.routing import Answer, PostRoute
from service.schemas import (
    AngularMomentumMagnitude,
    AngularVelocityRow,
    Envelope,
    Joules,
    Matrix,
    N,
    Radians,
    RadiansPerSecond,
    Ratio,
    Request,
    View,
    fields_of,
    require_one,
)

Count = Annotated[int, Field(ge=1, le=10**9)]
COARSE, FEW_POINTS = 6, 512
"""Resolution and points of curves up to which a surface may be begun in the event loop."""
Seed = Annotated[int, Field(ge=0, le=2**63 - 1)]
SEED: Any = Field(default=0, description="Of the draw; equal seeds give equal starts.")


class Drawn(Request):
    """How many random starts to draw, uniformly over the scaled sphere, and the seed of the draw."""

    count: Count = Field(description="Number of starts.")
    seed: Seed = SEED


# Fields of ordinary and of certified questions, each in the types of its own.
ENERGY: Any = Field(default=None, description="Kinetic energy; this or angular_velocity.")
STATE: Any = Field(
    default=None, description="A state of that energy, in body axes; its polhode is drawn unless polhodes is given."
)
SEPARATRIX: Any = Field(default=False, description="Draw the separatrix.")
POINTS: Any = Field(default=256, description="Points of each curve; a multiple of 4 has the extreme points among them.")


class EllipsoidRequest(Request):
    """A body and the energy of its rotation, or a state that has it."""

    body: Body
    energy: Energy | None = ENERGY
    angular_velocity: AngularVelocity | None = STATE
    resolution: Count = Field(default=16, description="Parts of an icosahedron's edge, or points from pole to pole.")
    layout: Literal["triangles", "grid"] = Field(default="triangles", description="How the surface is written.")
    polhodes: Drawn | None = Field(default=None, description="Draw polhodes of that energy through random starts.")
    separatrix: bool = SEPARATRIX
    points: Count = POINTS


class MeshQuality(View, Generic[N]):
    """How well the triangles stand for the ellipsoid."""

    watertight: bool = Field(description="Whether every edge has two triangles.")
    euler_characteristic: int = Field(description="Vertices minus edges plus faces; 2 for a sphere.")
    volume_ratio: Ratio[N] = Field(description="Volume inside the triangles over that of the ellipsoid.")
    smallest_angle: Radians[N] = Field(description="Of any triangle.")
    longest_edge: RadiansPerSecond[N] = Field(description="Of any triangle.")


class SurfaceMesh(View, Generic[N]):
    """Triangles, counter-clockwise seen from outside."""

    vertices: list[AngularVelocityRow[N]] = Field(description="In body axes.")
    faces: list[Annotated[list[int], Field(min_length=3, max_length=3)]] = Field(description="Indices of vertices.")
    quality: MeshQuality[N]


class SurfaceGrid(View, Generic[N]):
    """Coordinates over longitude (down) and colatitude (along), both ends included."""

    x: list[list[RadiansPerSecond[N]]] = Field(description="Along the first body axis.")
    y: list[list[RadiansPerSecond[N]]] = Field(description="Along the second body axis.")
    z: list[list[RadiansPerSecond[N]]] = Field(description="Along the third body axis.")


class Polhode(View, Generic[N]):
    """One curve; the last point is the first if it is closed."""

    regime: str = Field(description="About which axis the curve runs.")
    closed: bool = Field(description="Whether the last point is the first.")
    angular_momentum: AngularMomentumMagnitude[N] | None = Field(description="Magnitude, the same at every point.")
    points: list[AngularVelocityRow[N]] = Field(description="In body axes.")


class EllipsoidSurface(Envelope, Generic[N]):
    """The surface w.I.w = 2E in body axes."""

    energy: Joules[N] = Field(description="Kinetic energy of every state on the surface.")
    semi_axes: AngularVelocityRow[N] = Field(description="sqrt(2E/I) along each of `axes`.")
    axes: Matrix[Ratio[N]] = Field(description="Columns: the body axes if principal, else the principal axes.")
    mesh: SurfaceMesh[N] | None = Field(default=None, description="The surface as triangles.")
    grid: SurfaceGrid[N] | None = Field(default=None, description="The surface as a grid.")
    polhodes: list[Polhode[N]] | None = Field(default=None, description="Through the starts, in their order.")
    separatrix: list[Polhode[N]] | None = Field(default=None, description="Empty if two moments are equal.")


class EllipsoidAnswer(EllipsoidSurface[float]):
    """The surface w.I.w = 2E in body axes."""


class StatesRequest(Request):
    """A body, an energy, and how many starts to draw."""

    body: Body
    energy: Energy = Field(description="Kinetic energy of every start.")
    count: Count = Field(description="Number of starts.")
    seed: Seed = SEED


class StatesAnswer(Envelope):
    """Angular velocities of one energy, in body axes."""

    angular_velocities: list[AngularVelocityRow[float]] = Field(description="One row per start.")
    energy: Joules[float] = Field(description="As in the request.")
    seed: int = Field(description="As in the request.")


def energy_ellipsoid(question: EllipsoidRequest, budget: Budget) -> Answer:
    """Answer with the surface and the curves on it."""
    require_few_points(question, budget)
    body = properties_of(question.body)
    surface = _surface(question, body)
    answer: Answer = {
        "energy": surface.energy,
        "semi_axes": surface.semi_axes,
        "axes": surface.axes,
        "warnings": inherited_notices(body),
    }
    if question.layout == "triangles":
        mesh = surface.triangles(question.resolution)
        answer["mesh"] = {"vertices": mesh.vertices, "faces": mesh.faces, "quality": mesh.quality}
    else:
        x, y, z = surface.grid(question.resolution)
        answer["grid"] = {"x": x, "y": y, "z": z}
    if question.polhodes is not None:
        starts = initial_states(body, surface.energy, question.polhodes.count, question.polhodes.seed)
        answer["polhodes"] = [fields_of(polhode(body, start, question.points)) for start in starts]
    elif question.angular_velocity is not None:
        answer["polhodes"] = [fields_of(polhode(body, np.array(question.angular_velocity), question.points))]
    if question.separatrix:
        answer["separatrix"] = [fields_of(curve) for curve in separatrix(body, surface.energy, question.points)]
    if "polhodes" in answer or "separatrix" in answer:
        answer["warnings"] += curve_notices(body.principal_of_motion)
    return answer


def _surface(question: EllipsoidRequest, body: MassProperties) -> EnergyEllipsoid:
    require_one(question, "energy", "angular_velocity")
    if question.energy is not None:
        return EnergyEllipsoid.of(body, question.energy)
    return EnergyEllipsoid.through(body, np.array(question.angular_velocity))


def curves_drawn(question: Any) -> int:
    """Return how many curves a question asks for."""
    drawn = question.polhodes.count if question.polhodes is not None else 0
    return int((drawn or (question.angular_velocity is not None)) + 2 * question.separatrix)


def require_few_points(question: Any, budget: Budget) -> None:
    """Refuse more points on the curves of a question than one answer may have."""
    points: int = curves_drawn(question) * question.points
    if points > budget.samples:
        path = ("polhodes", "count") if question.polhodes is not None else ("points",)
        remedy = "ask for fewer curves, or for fewer points on each"
        raise BudgetExceeded("points", points, budget.samples, path=path, remedy=remedy)


def is_small_ellipsoid(question: EllipsoidRequest) -> bool:
    """Return whether a surface is coarse, and has few curves of few points."""
    curves = 3 if question.polhodes is None else 2 + question.polhodes.count
    return question.resolution <= COARSE and curves * question.points <= FEW_POINTS and is_small(question)


def states(question: StatesRequest, budget: Budget) -> Answer:
    """Answer with starts of one energy."""
    body = properties_of(question.body)
    return {
        "angular_velocities": initial_states(body, question.energy, question.count, question.seed),
        "energy": question.energy,
        "seed": question.seed,
        "warnings": tuple(notice.inside("body") for notice in body.warnings),
    }


SURFACES = (
    PostRoute(
        "/v1/rotation/energy-ellipsoid",
        "energy_ellipsoid",
        "The energy ellipsoid as a mesh or a grid, with polhodes and separatrix",
        "rotation",
        EllipsoidRequest,
        EllipsoidAnswer,
        energy_ellipsoid,
        is_small_ellipsoid,
        description="`Accept: image/svg+xml` returns the same as a figure, without the mesh.",
        representations={SVG: ellipsoid_figure},
    ),
    PostRoute(
        "/v1/rotation/initial-states",
        "initial_states",
        "Starts of one energy, drawn uniformly over the scaled sphere",
        "rotation",
        StatesRequest,
        StatesAnswer,
        states,
        lambda question: question.count <= FEW_SAMPLES and is_small(question),
    ),
)
