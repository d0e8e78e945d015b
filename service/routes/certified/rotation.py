"""Free rotation, precession and stability to any number of digits."""

from __future__ import annotations

from typing import Literal

from pydantic import Field

from core.bodies.principal_inertia import Symmetry
from core.certified.exact_start import Regime
from core.certified.free_rotation import IDENTITY, CertifiedRotation
from core.certified.precession import certified_precession
from core.certified.stability import certified_stability
from core.systems.budget import Budget
from core.systems.trajectory import Work
from service.requests.decimal_models import (
    AngularVelocityInNumerals,
    BodyInNumerals,
    DigitCount,
    QuaternionInNumerals,
    RateInNumerals,
    TimesInNumerals,
    body_of,
    instants,
)
from service.routes.certified.questions import (
    AccuracyInDigits,
    CertifiedCost,
    Cost,
    InDigits,
    PerSample,
    accuracy,
    affordable,
    ends,
    notices,
    summing,
    times_written,
)
from service.routes.rotation.precession import DISTURBANCE, RATE
from service.routes.rotation.trajectory import (
    ANGULAR_VELOCITY,
    ATTITUDE,
    FLIP_INTERVAL,
    MIDDLE_AXIS_TILT,
    OUTPUTS,
    T_HANDLE,
    TIMES,
    TUMBLES,
    ModelView,
    Output,
    WorkView,
)
from service.routing import Answer, Example
from service.schemas import Envelope, Request, View, fields_of

RATES = PerSample(2e-5, 6e-8, 1.7e-10)
RATES_AND_ATTITUDES = PerSample(5e-5, 1.2e-7, 8.5e-10)
PRECESSION = PerSample(4e-4, 1e-6, 4e-9)
STABILITY = PerSample(1.5e-4, 3e-7, 5e-10)


class TrajectoryInDigits(Request):
    """A body, how it turns at t = 0, and the times at which its motion is wanted to a number of digits."""

    body: BodyInNumerals
    angular_velocity: AngularVelocityInNumerals = ANGULAR_VELOCITY
    attitude: QuaternionInNumerals | None = ATTITUDE
    times: TimesInNumerals = TIMES
    digits: DigitCount
    outputs: list[Output] | None = OUTPUTS


class TrajectoryAnswerInDigits(Envelope):
    """Samples of a free rotation, numbers as decimal strings."""

    model: ModelView
    method: Literal["closed-form"]
    period: str | None = Field(description="Of the angular velocity in the body (s); null where there is none.")
    flip_interval: str | None = FLIP_INTERVAL
    middle_axis_tilt: tuple[str, str] | None = MIDDLE_AXIS_TILT
    tumbles: bool = TUMBLES
    energy: str = Field(description="J")
    angular_momentum: str = Field(description="Magnitude (kg m^2/s).")
    accuracy: AccuracyInDigits
    work: WorkView
    ended: Literal["horizon"]
    time: list[str] | None = Field(default=None, description="s")
    angular_velocity: list[list[str]] | None = Field(
        default=None, description="One row per time, in body axes (rad/s)."
    )
    attitude: list[list[str]] | None = Field(default=None, description="One row per time, [w, x, y, z], body to space.")


class PrecessionInDigits(Request):
    """A body and how it turns at t = 0, the answer wanted to a number of digits."""

    body: BodyInNumerals
    angular_velocity: AngularVelocityInNumerals = ANGULAR_VELOCITY
    digits: DigitCount


class PrecessionAnswerInDigits(Envelope):
    """Rates and angles as decimal strings; null where the motion has no such thing."""

    symmetry: Symmetry
    regime: Regime = Field(description="Of the angular velocity in the body.")
    axis: list[str] | None = Field(description="Axis of symmetry, or the one that is circled, in body axes.")
    body_rate: str | None = Field(description="(I3 - I)/I w3, signed (rad/s).")
    space_rate: str | None = Field(description="L/I (rad/s).")
    period: str | None = Field(description="Of the angular velocity in the body (s).")
    flip_interval: str | None = FLIP_INTERVAL
    middle_axis_tilt: tuple[str, str] | None = MIDDLE_AXIS_TILT
    tumbles: bool = TUMBLES
    axis_to_angular_momentum: str | None = Field(description="rad")
    axis_to_angular_velocity: str | None = Field(description="Half-angle of the body cone (rad).")
    angular_momentum_to_angular_velocity: str | None = Field(description="Half-angle of the space cone (rad).")
    order_of_directions: str | None = Field(description="Which of the three directions lies between the others.")
    precession_per_period: str | None = Field(description="Not reduced modulo 2 pi (rad).")
    mean_precession_rate: str | None = Field(description="Of the axis about the angular momentum (rad/s).")
    absent: dict[str, str] = Field(description="Why a figure is null.")
    accuracy: AccuracyInDigits


class StabilityInDigits(Request):
    """A body, and how fast it turns about its principal axes, the answer wanted to a number of digits."""

    body: BodyInNumerals
    rate: RateInNumerals = RATE
    disturbance: tuple[RateInNumerals, RateInNumerals] | None = DISTURBANCE
    digits: DigitCount


class EquilibriumInDigits(View):
    """A constant angular velocity, and what becomes of one near it."""

    axis: list[str] | None = Field(description="In body axes; null for the state of rest.")
    moment: str | None
    eigenvalues: list[tuple[str, str]] = Field(description="Real and imaginary parts (1/s).")
    kind: Literal["center", "saddle", "degenerate"]
    stable: bool = Field(description="In the sense of Lyapunov, of the angular velocity.")
    growth_rate: str = Field(description="Exponential rate of a small disturbance (1/s).")
    drift_rate: str = Field(description="Linear rate per unit of disturbance (1/s).")
    linearly_stable: bool
    attitude: Literal["orbital", "unstable"] = Field(description="In which sense the attitude is stable.")
    survives_dissipation: bool
    reason: str


class FlipInDigits(View):
    """What becomes of a disturbed rotation about the middle axis."""

    disturbance: tuple[str, str]
    interval: str | None = Field(description="Between sign changes of the component along the middle axis (s).")
    reason: str


class StabilityAnswerInDigits(Envelope):
    """Every equilibrium of a free body at one rate: about its axes in ascending order of moments, and at rest."""

    symmetry: Symmetry
    rate: str
    equilibria: list[EquilibriumInDigits]
    flip: FlipInDigits | None
    accuracy: AccuracyInDigits


def answer_trajectory(question: TrajectoryInDigits, budget: Budget) -> Answer:
    """Answer with samples of the motion."""
    digits, wanted = question.digits, _outputs(question)
    samples = affordable(question.times, digits, _numbers(wanted), budget)
    times = instants(question.times)
    body = body_of(question.body)
    motion = CertifiedRotation.of(body.of_motion, question.angular_velocity)
    fields: Answer = {
        "model": motion.model,
        "method": "closed-form",
        "period": motion.period(digits),
        "flip_interval": motion.flip_interval(digits),
        "middle_axis_tilt": motion.middle_axis_tilt(digits),
        "tumbles": motion.tumbles,
        "energy": motion.energy(digits),
        "angular_momentum": motion.angular_momentum(digits),
        "accuracy": accuracy(digits),
        "work": Work(samples),
        "ended": "horizon",
        "warnings": [*notices(body), *motion.warnings],
    }
    if "time" in wanted:
        fields["time"] = times_written(times, digits)
    if "attitude" in wanted:
        rates, attitudes = motion.trajectory(times, digits, question.attitude or IDENTITY)
        fields |= {"angular_velocity": rates} if "angular_velocity" in wanted else {}
        fields["attitude"] = attitudes
    elif "angular_velocity" in wanted:
        fields["angular_velocity"] = motion.angular_velocity(times, digits)
    return fields


def answer_precession(question: PrecessionInDigits, budget: Budget) -> Answer:
    """Answer with the figures."""
    body = body_of(question.body)
    motion = CertifiedRotation.of(body.of_motion, question.angular_velocity)
    found = fields_of(certified_precession(motion, question.digits))
    return found | {"accuracy": accuracy(question.digits), "warnings": [*notices(body), *motion.warnings]}


def answer_stability(question: StabilityInDigits, budget: Budget) -> Answer:
    """Answer with every equilibrium."""
    body = body_of(question.body)
    found = certified_stability(body.of_motion, question.rate, question.digits, question.disturbance)
    return {
        **fields_of(found),
        "equilibria": [fields_of(equilibrium) for equilibrium in found.equilibria],
        "accuracy": accuracy(question.digits),
        "warnings": notices(body),
    }


def _outputs(question: TrajectoryInDigits) -> tuple[Output, ...]:
    if question.outputs is not None:
        return tuple(question.outputs)
    return ("time", "angular_velocity") if question.attitude is None else ("time", "angular_velocity", "attitude")


def _numbers(wanted: tuple[Output, ...]) -> int:
    return 7 if "attitude" in wanted else 3


def trajectory_cost(question: TrajectoryInDigits, budget: Budget) -> Cost:
    """Return what is counted of a trajectory."""
    wanted = _outputs(question)
    numbers = _numbers(wanted)
    samples = affordable(question.times, question.digits, numbers, budget)
    each = RATES_AND_ATTITUDES if "attitude" in wanted else RATES
    return Cost(samples, numbers + ("time" in wanted), each, summing(question.body))


def trajectory_probe(question: TrajectoryInDigits) -> TrajectoryInDigits:
    """Return the question about the farthest time alone."""
    return question.model_copy(update={"times": [max(ends(question.times), key=abs)]})


def precession_cost(question: PrecessionInDigits, budget: Budget) -> Cost:
    """Return what is counted of a question without times: a handful of figures that cost a few samples each."""
    return Cost(1, 0, PRECESSION, summing(question.body), beside=9, text=900.0)


def stability_cost(question: StabilityInDigits, budget: Budget) -> Cost:
    """Return the same of the equilibria, of which each is explained in some 600 characters."""
    return Cost(1, 0, STABILITY, summing(question.body), beside=18, text=3000.0)


EXACT_T_HANDLE = {"kind": "principal-moments", "moments": ["837.2", "714", "437.7"]}

TRAJECTORY_IN_DIGITS = InDigits(
    TrajectoryInDigits,
    TrajectoryAnswerInDigits,
    answer_trajectory,
    CertifiedCost(trajectory_cost),
    trajectory_probe,
    {
        "digits": Example(
            "the T-handle to 50 digits, every one of them proven",
            {
                "body": T_HANDLE,
                "angular_velocity": [1.0, 10.0, 1.0],
                "attitude": [1.0, 0.0, 0.0, 0.0],
                "times": {"start": 0.0, "stop": 20.0, "count": 5},
                "digits": 50,
            },
        ),
        "decimal-strings": Example(
            "moments that are exactly what they say: 837.2 is no double",
            {
                "body": EXACT_T_HANDLE,
                "angular_velocity": ["0.1", "10", "0.1"],
                "times": ["0.1", "1e6"],
                "digits": 30,
            },
        ),
    },
)

PRECESSION_IN_DIGITS = InDigits(
    PrecessionInDigits,
    PrecessionAnswerInDigits,
    answer_precession,
    CertifiedCost(precession_cost),
    examples={
        "digits": Example(
            "a spinning coin, 100 digits of its precession",
            {
                "body": {"kind": "principal-moments", "moments": [1.0, 1.0, 2.0]},
                "angular_velocity": ["0.1", "0", "1"],
                "digits": 100,
            },
        )
    },
)

STABILITY_IN_DIGITS = InDigits(
    StabilityInDigits,
    StabilityAnswerInDigits,
    answer_stability,
    CertifiedCost(stability_cost),
    examples={"digits": Example("a T-handle, 40 digits", {"body": EXACT_T_HANDLE, "rate": "10", "digits": 40})},
)
