"""Questions about rates and angles of a free rotation; none of them integrates unless a measurement is requested."""

from __future__ import annotations

from typing import Annotated, Any, Generic, Literal

import numpy as np
from pydantic import Field

from core.bodies import Body
from core.bodies.principal_inertia import Symmetry
from core.quantities import AngularRate, AngularVelocity, Unit
from core.rotation.precession.measurement import Measure, MeasuredPeriod, measure_period
from core.rotation.precession.precession import Precession, Regime, precession
from core.rotation.stability.stability import stability
from core.rotation.torque_free import TorqueFree
from core.systems.budget import Budget
from service.routes.bodies import is_small, properties_of
from service.routes.rotation.many_precessions import many_precessions
from service.routes.rotation.trajectory import ANGULAR_VELOCITY, FLIP_INTERVAL, MIDDLE_AXIS_TILT, TUMBLES
from service.routing import Answer, PostRoute
from service.schemas import (
    Envelope,
    N,
    PerSecond,
    Radians,
    RadiansPerSecond,
    Ratio,
    Request,
    Seconds,
    UnitVector,
    View,
)


class PrecessionRequest(Request):
    """A body and how it turns at t = 0."""

    body: Body
    angular_velocity: AngularVelocity = ANGULAR_VELOCITY
    measure: Measure | None = Field(
        default=None, description="Measure the period by an integrator, as the first return within a tolerance."
    )


class PrecessionFigures(Envelope, Generic[N]):
    """Rates and angles; null where the motion has no such thing."""

    symmetry: Symmetry = Field(description="Which of the principal moments are equal.")
    regime: Regime = Field(description="Of the angular velocity in the body.")
    axis: UnitVector[N] | None = Field(description="Axis of symmetry, or the one that is circled, in body axes.")
    body_rate: RadiansPerSecond[N] | None = Field(
        description="(I3 - I)/I w3, signed: 0 for a spin across the axis, null for one along it."
    )
    space_rate: RadiansPerSecond[N] | None = Field(description="L/I.")
    period: Seconds[N] | None = Field(description="Of the angular velocity in the body.")
    flip_interval: Seconds[N] | None = FLIP_INTERVAL
    middle_axis_tilt: tuple[Radians[N], Radians[N]] | None = MIDDLE_AXIS_TILT
    tumbles: bool = TUMBLES
    axis_to_angular_momentum: Radians[N] | None = Field(description="Angle from the axis to the angular momentum.")
    axis_to_angular_velocity: Radians[N] | None = Field(description="Half-angle of the body cone.")
    angular_momentum_to_angular_velocity: Radians[N] | None = Field(description="Half-angle of the space cone.")
    order_of_directions: str | None = Field(description="Which of the three directions lies between the others.")
    precession_per_period: Radians[N] | None = Field(description="Not reduced modulo 2 pi.")
    mean_precession_rate: RadiansPerSecond[N] | None = Field(description="Of the axis about the angular momentum.")
    absent: dict[str, str] = Field(description="Why a figure is null.")


class PrecessionAnswer(PrecessionFigures[float]):
    """Rates and angles; null where the motion has no such thing."""

    errors: dict[str, Annotated[float | list[float] | None, Unit("as in the field of that name")]] = Field(
        description="Bounds of the errors of axis, rates, times and angles, by the names of the fields: of rounding, "
        "also that of derived moments. Of the axis the length of the difference; null where the figure is."
    )
    measured: MeasuredPeriod | None = Field(default=None, description="The period by an integrator, if requested.")


RATE: Any = Field(default=1.0, description="About each principal axis in turn.")
DISTURBANCE: Any = Field(
    default=None,
    description="Rates along the axes of smallest and largest moment, added to the rotation about the middle axis: "
    "the interval between sign changes of the component along that axis is then answered.",
)


class StabilityRequest(Request):
    """A body, and how fast it turns about its principal axes."""

    body: Body
    rate: AngularRate = RATE
    disturbance: tuple[AngularRate, AngularRate] | None = DISTURBANCE


class Equilibrium(View, Generic[N]):
    """A constant angular velocity, and what becomes of one near it."""

    axis: UnitVector[N] | None = Field(description="In body axes; null for the state of rest.")
    moment: Annotated[N, Unit("kg m^2")] | None = Field(description="Of inertia about the axis.")
    eigenvalues: list[tuple[PerSecond[N], PerSecond[N]]] | None = Field(description="Real and imaginary parts.")
    kind: Literal["center", "saddle", "degenerate"] = Field(description="Of the fixed point, by its eigenvalues.")
    stable: bool = Field(description="In the sense of Lyapunov, of the angular velocity.")
    growth_rate: PerSecond[N] | None = Field(description="Exponential rate of a small disturbance.")
    drift_rate: PerSecond[N] | None = Field(description="Linear rate per unit of disturbance.")
    linearly_stable: bool = Field(description="Whether no eigenvalue has a positive real part.")
    attitude: Literal["orbital", "unstable"] = Field(description="In which sense the attitude is stable.")
    survives_dissipation: bool = Field(description="Whether it stays stable where energy is lost.")
    reason: str = Field(description="Why, in one sentence.")


class Flip(View, Generic[N]):
    """What becomes of a disturbed rotation about the middle axis."""

    disturbance: tuple[RadiansPerSecond[N], RadiansPerSecond[N]] = Field(
        description="Rates along the axes of smallest and largest moment."
    )
    interval: Seconds[N] | None = Field(description="Between sign changes of the component along the middle axis.")
    reason: str = Field(description="Why, in one sentence.")


class Equilibria(Envelope, Generic[N]):
    """Every equilibrium of a free body at one rate: about its axes in ascending order of moments, and at rest."""

    symmetry: Symmetry = Field(description="Which of the principal moments are equal.")
    rate: RadiansPerSecond[N] = Field(description="As in the request.")
    equilibria: list[Equilibrium[N]] = Field(description="About the axes in ascending order of moments, and at rest.")
    flip: Flip[N] | None = Field(description="Of the disturbance; null without one.")


class EquilibriumErrors(View):
    """Bounds of the errors of an equilibrium's figures, also of derived moments; null where the figure is."""

    axis: Ratio[float] | None = Field(description="Length of the difference.")
    moment: Annotated[float, Unit("kg m^2")] | None = Field(description="Of the moment.")
    eigenvalue: PerSecond[float] | None = Field(
        description="Of the two eigenvalues that may differ from 0, and of the growth rate; the third is 0 exactly."
    )
    drift_rate: PerSecond[float] | None = Field(description="Of the drift rate.")


class EquilibriumInDoubles(Equilibrium[float]):
    """A constant angular velocity, and what becomes of one near it."""

    errors: EquilibriumErrors = Field(description="Of rounding, and of derived moments.")


class FlipInDoubles(Flip[float]):
    """What becomes of a disturbed rotation about the middle axis."""

    error: Seconds[float] | None = Field(description="Bound of the error of the interval; null without one.")


class StabilityAnswer(Equilibria[float]):
    """Every equilibrium of a free body at one rate."""

    equilibria: list[EquilibriumInDoubles] = Field(  # type: ignore[assignment]
        description="About the axes in ascending order of moments, and at rest."
    )
    flip: FlipInDoubles | None = Field(description="Of the disturbance; null without one.")


def answer_precession(question: PrecessionRequest, budget: Budget) -> Answer:
    """Answer with the figures and, if requested, the measurement."""
    body = properties_of(question.body)
    found: Precession = precession(body, question.angular_velocity)
    answer = found._asdict()
    if question.measure is not None:
        start = np.array(question.angular_velocity)
        answer["measured"] = measure_period(TorqueFree(body, start), question.measure, budget)
    return answer


def answer_stability(question: StabilityRequest, budget: Budget) -> Answer:
    """Answer with every equilibrium."""
    found = stability(properties_of(question.body), question.rate, question.disturbance)
    listed = [one._asdict() | {"errors": one.errors._asdict()} for one in found.equilibria]
    return found._asdict() | {"equilibria": listed}


PRECESSION = (
    PostRoute(
        "/v1/rotation/precession",
        "precession",
        "Rates, period, flip interval and cones of a free rotation",
        "rotation",
        PrecessionRequest,
        PrecessionAnswer,
        answer_precession,
        lambda question: question.measure is None and is_small(question),
        many=many_precessions,
    ),
    PostRoute(
        "/v1/rotation/stability",
        "stability",
        "Every equilibrium of a free body: eigenvalues, kind, stability and the reason",
        "rotation",
        StabilityRequest,
        StabilityAnswer,
        answer_stability,
        is_small,
    ),
)
