"""The answer to a question about a described scene, as it is documented."""

from __future__ import annotations

from typing import Annotated, Generic, Literal

from pydantic import Field

from core.multibody.answer import MotionPhase, RestRange, SceneExtremes
from core.multibody.undecided import Code
from core.quantities import Unit
from core.systems.trajectory import Work
from service.routes.equations_answer import SceneEquations
from service.schemas import Envelope, Errors, Joules, N, PerSecond, Radians, RadiansPerSecond, Ratio, Seconds, View

Metres = Annotated[list[float], Unit("m"), Field(min_length=2, max_length=3)]
How = Literal["closed form", "measured against pairs", "measured against closed form"]
"""How errors of described scenes are known."""
OwnUnit = Unit("as in the field unit")
PROVEN = "Bounds of the errors, by the names of the fields; left out where every digit is proven."
UNDECIDED_PATH = "/v1/undecided"
"""Where the kinds of what is undecided are published."""


class SmallMotion(View, Generic[N]):
    """One mode: q = exp(growth_rate t) cos(frequency t)."""

    frequency: RadiansPerSecond[N]
    growth_rate: PerSecond[N]
    errors: Errors | None = Field(default=None, description=PROVEN)


class ScenePart(View, Generic[N]):
    """A part of a scene that has no force or connection in common with the others, and its smallest model."""

    name: str
    why: str
    degrees_of_freedom: int
    coordinates: list[str] = Field(description="Those that remain.")
    period: Seconds[N] | None = Field(description="Until it repeats, up to a turn about the vertical.")
    precession: Radians[N] | None = Field(description="That turn in a period.")
    modes: list[SmallMotion[N]] = Field(description="Of a linear part.")
    errors: Errors | None = Field(default=None, description=PROVEN)


class DescribedModel(View, Generic[N]):
    """The smallest model of a scene, and what was noticed on the way."""

    name: str
    why: str
    degrees_of_freedom: int = Field(description="Of the motion from the given state.")
    mobility: int = Field(description="Degrees of freedom of the scene: what could move, though it may not.")
    coordinates: int = Field(description="Coordinates that remain.")
    rows: int = Field(description="Equations of constraint that remain.")
    described: tuple[int, int] = Field(description="Coordinates and equations of constraint before.")
    apart: list[ScenePart[N]]
    noticed: list[str] = Field(description="Sentences.")
    redundant: dict[str, list[str]] = Field(
        description="Connections that hold at the start what others hold already, each with these others: the forces "
        "that they share are not determined. mobility does not count what is redundant."
    )


class BodyAccelerations(View, Generic[N]):
    """Accelerations of a body at the start; null beyond the range of doubles."""

    linear: list[Annotated[N, Unit("m s^-2")] | None] = Field(description="Of the centre of mass.")
    angular: Annotated[N | list[N | None] | None, Unit("rad s^-2")] = Field(
        description="A number in the plane, in body axes in space; null for particles and tops."
    )
    errors: Errors | None = Field(default=None, description=PROVEN)


class ConnectionForce(View, Generic[N]):
    """A force of a connection at the start."""

    value: Annotated[N | None, OwnUnit] = Field(description="null if it is not determined.")
    unit: str
    determined: bool = Field(description="Whether the scene determines it.")
    shared_with: list[str] = Field(description="Connections that share what is not determined.")
    error: Annotated[float, OwnUnit] | None = Field(
        default=None,
        description="Bound of the error of the value, null where that is; left out where digits are proven.",
    )


class StartEnergy(View, Generic[N]):
    """Energies at the start; the potential of gravity is zero at the origin."""

    kinetic: Joules[N] | None
    potential: Joules[N] | None
    total: Joules[N] | None
    conserved: bool = Field(
        description="Whether nothing works on the scene: no damper, motor or torque in space, and until the last time "
        "no friction and no impact that costs energy."
    )
    errors: Errors | None = Field(default=None, description=PROVEN)


class SceneColumn(View):
    """One quantity at every time."""

    values: Annotated[list[float | list[float]], OwnUnit] = Field(description="One row per time.")
    unit: str
    error: Annotated[float, OwnUnit] = Field(description="Largest error of any row, as the length of a vector.")
    how: How
    inherited: Annotated[float | None, OwnUnit] = Field(
        description="Largest change of any row by input_uncertainty, to first order; null for what is summed up along "
        "the motion, and where it is not known."
    )


class DescribedTrajectory(View):
    """Columns by name, such as wheel.angle or s.1.tension, at the times that the motion reaches."""

    time: list[Seconds[float]]
    rows: list[int] = Field(description="Which of the times of the question these are, from 0.")
    columns: dict[str, SceneColumn]


class ImpactErrors(View):
    """Bounds of the errors of an impact; null where contacts could share it otherwise."""

    impulses: dict[str, Annotated[float, Unit("N s")] | None] = Field(description="By the names of the impulses.")
    energy_loss: Joules[float] | None


class ImpactRates(View):
    """The rate along which an impulse acts, before and after an impact; of a stop, in rad/s."""

    before: Annotated[float, Unit("m/s")]
    after: Annotated[float, Unit("m/s")]
    error: Annotated[float, Unit("m/s")] = Field(description="Of both.")


class EndEvent(View):
    """Something that ends a phase of a motion, or the motion."""

    kind: str = Field(
        description="touch, lift-off, slip, stick, roll, settle (bounces accumulate and end) of contacts; taut and "
        "slack of strings; stop and release of turns; switch of a formula; begin and end of what acts for a time; "
        "impulse; singular: a length has become zero, or connections lose their hold; or the code of a problem."
    )
    name: str = Field(description="Of the connection; empty where several make a place singular.")
    time: Seconds[float]
    error: Seconds[float]
    impulses: dict[str, Annotated[float, Unit("N s")]] = Field(
        description="Of an impact: normal (of a stop, N m s), and friction where there is some. Of a blow its "
        "components, and of that and of what begins to hold what connections take, by the names of their forces."
    )
    energy_loss: Joules[float] = Field(
        description="Of an impact, by this connection: impulse times mean rate. Those of one time add up to what is "
        "lost; one of them may be negative. Below zero where a blow brings energy."
    )
    errors: ImpactErrors = Field(description="Of impulses and energy loss; that of the time is in error.")
    rates: dict[str, ImpactRates] = Field(
        description="Of an impact, by the names of its impulses: of the gap, below zero where it closes, and of slip."
    )


class SceneProblem(View):
    """Something that mechanics does not decide, or that is not followed any further: the motion ends there."""

    code: Code = Field(description="Stable name for machines; GET /v1/undecided lists them all.")
    type: str = Field(description="URI reference of its entry in GET /v1/undecided, which names its documentation.")
    explanation: str
    time: Seconds[float]
    connections: list[str] = Field(description="Between which it is undecided.")
    candidates: list[dict[str, str]] = Field(description="What is possible.")
    decided_by: str = Field(description="Which further assumption would decide it.")
    error: Seconds[float] = Field(description="Of the time.")


class SceneOccurrence(View):
    """A time at which a quantity takes the requested value."""

    quantity: str
    equals: Annotated[float, OwnUnit]
    unit: str
    nth: int = Field(description="Counted from 1, after the start.")
    time: Seconds[float]
    error: Seconds[float] = Field(description="Of the time.")
    how: How = Field(description="How the error of the quantity is known.")


class ModeShape(View):
    """How bodies move in a mode, with the largest change of a position 1 m, or of an angle 1 rad where no centre moves.

    q = Re((change + i change a quarter of a period apart) exp((growth_rate + i frequency) t)).
    """

    positions: dict[str, Metres] = Field(description="Changes of centres of mass.")
    angles: dict[str, Radians[float]] = Field(description="Changes of angles, in the plane.")
    positions_quarter: dict[str, Metres] | None = Field(
        description="Changes a quarter of a period apart; null where all moves in phase."
    )
    angles_quarter: dict[str, Radians[float]] | None = Field(description="The same of angles.")
    error: Annotated[float, Unit("as in the changes")] = Field(description="Bound of the error of all of them.")


class SceneEquilibrium(View):
    """A place where the scene can rest."""

    positions: dict[str, Metres] = Field(description="Of centres of mass.")
    angles: dict[str, Radians[float]] = Field(description="In the plane, where the direction of a body matters.")
    stable: bool | None = Field(description="null where the small motions do not decide.")
    modes: list[SmallMotion[float]]
    shapes: list[ModeShape | None] = Field(
        description="Of the modes, in their order; null of those that coincide, of which every combination is a mode."
    )
    residual: Ratio[float] = Field(description="Largest force left over, relative to the forces of the scene.")
    errors: dict[str, dict[str, Annotated[float, Unit("as in the field of that name")]]] = Field(
        description="Bounds of the errors of positions, as the length of a vector, and of angles, by body."
    )
    continuum: bool = Field(
        description="Whether it is one of a line or surface of places of rest, along its modes of frequency 0; the "
        "others that were found of it are left out."
    )


class DescribedAccuracy(View):
    """How right the samples are."""

    requested: Ratio[float]
    error: Ratio[float] = Field(description="Largest of any column, relative to the largest value in its unit.")
    how: How = Field(
        description="closed form: bounded. measured against pairs: the difference from a run with numbers of 106 bits. "
        "measured against closed form: of a method, the difference from it with its bound added."
    )
    inherited: Ratio[float] | None = Field(
        description="Largest change of any column by input_uncertainty, to first order, relative "
        "to the largest value in its unit; null where it is not requested or not known."
    )
    horizon: Seconds[float] | None = Field(
        description="Until when that change stays below the accuracy, one of 64 times up to the farthest; null where "
        "it does all the time, or is not known."
    )
    why: str | None = Field(description="Why one of these is null, where an uncertainty was given.")


class AtStart(Envelope, Generic[N]):
    """What is answered about the model and the start of a scene."""

    model: DescribedModel[N]
    accelerations: dict[str, BodyAccelerations[N]] | None = Field(default=None, description="By body.")
    forces: dict[str, ConnectionForce[N]] | None = Field(default=None, description="By connection.")
    energy: StartEnergy[N] | None = None


class AssembledBody(View):
    """A body at the place that was found for it."""

    at: Metres = Field(description="Centre of mass.")
    angle: Radians[float] | None = Field(description="In the plane; null for particles.")
    axes: list[list[Ratio[float]]] | None = Field(description="In space, the directions of its axes; null elsewhere.")
    moved: Annotated[float, Unit("m")] = Field(description="Distance of its centre of mass from the sketch.")
    turned: Radians[float] = Field(description="Angle from the sketch, in the plane counter-clockwise.")
    errors: Errors = Field(description="Bounds of the errors, by the names of the fields; of vectors, of a component.")


class FourBarLinkage(View):
    """A planar four-bar linkage."""

    links: list[str] = Field(description="In the order of the loop, from the ground on if that is a link.")
    lengths: list[Annotated[float, Unit("m")]] = Field(description="Distances of their joints.")
    kind: Literal["crank-rocker", "double-crank", "double-rocker", "triple-rocker", "change-point"] = Field(
        description="By which link turns fully relative to the others; of a triple-rocker none does."
    )
    margin: Annotated[float, Unit("m")] = Field(
        description="By how much the shortest and the longest link together are shorter than the other two: Grashof's "
        "condition is that it is not negative."
    )
    branch: Literal["open", "crossed"] = Field(description="Whether the quadrilateral of its joints crosses itself.")
    errors: Errors = Field(description="Bounds of the errors of the lengths and the margin.")


class Assembly(View):
    """The start that satisfies the connections, nearest to the places that were given."""

    distance: Annotated[float, Unit("m")] = Field(
        description="Root of the sum over the bodies of the mean square of the displacements of their points: the "
        "least that was found."
    )
    bodies: dict[str, AssembledBody]
    others: list[Annotated[float, Unit("m")]] = Field(
        description="Distances of other places that satisfy the connections, nearest among their neighbours, as far as "
        "they were found: of other branches."
    )
    velocities_changed: bool = Field(description="Whether velocities were changed to the nearest that are possible.")
    four_bar: FourBarLinkage | None = Field(description="If the scene is one.")
    errors: Errors = Field(description="Bounds of the errors of the distance and of the others.")


class DescribedSceneAnswer(AtStart[float]):
    """The requested answer about a scene."""

    method: str | None = Field(default=None, description="Kind of the method that was named, if one was.")
    work: Work | None = Field(default=None, description="What that method cost.")
    period: Seconds[float] | None = Field(
        description="Of the motion; null where nothing moves, several parts move, or it is not known to repeat."
    )
    errors: Errors = Field(description="Bound of the error of the period; null where that is.")
    ended: str | None = Field(
        description="horizon, or the kind of the event that ended the motion; null without times."
    )
    events: list[EndEvent]
    phases: list[MotionPhase] | None = Field(
        default=None, description="Of a scene with contacts, stops, or strings that become slack."
    )
    problem: SceneProblem | None = Field(
        default=None, description="If the problem is statically indeterminate or ill-posed."
    )
    trajectory: DescribedTrajectory | None = None
    occurrences: list[SceneOccurrence] | None = Field(default=None, description="If when was requested, in its order.")
    extremes: list[SceneExtremes] | None = Field(default=None, description="If extremes were requested.")
    equilibria: list[SceneEquilibrium] | None = None
    thresholds: list[RestRange] | None = Field(default=None, description="If thresholds were requested, in order.")
    assembly: Assembly | None = Field(default=None, description="If assemble was requested.")
    equations: SceneEquations | None = Field(
        default=None, description="If equations were requested; left out where mechanics decides no motion."
    )
    accuracy: DescribedAccuracy | None = Field(default=None, description="If there is a trajectory.")
