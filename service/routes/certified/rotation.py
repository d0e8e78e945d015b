"""Free rotation, precession and stability to any number of digits."""

from __future__ import annotations

from typing import Literal

from core.certified.free_rotation import CertifiedRotation
from core.certified.precession import certified_precession
from core.certified.stability import certified_stability
from core.rotation.sampled_rotation import IDENTITY, Output, wanted_outputs
from core.systems.budget import Budget
from core.systems.trajectory import Work
from service.requests.decimal_models import (
    DecimalAngularVelocity,
    DecimalBody,
    DecimalQuaternion,
    DecimalRate,
    DecimalTimes,
    DigitCount,
    body_of,
    instants,
)
from service.responses.svg import SVG
from service.routes.certified.answers import Certified, accuracy, certified_route, notices, samples_of, times_written
from service.routes.motion_figures import draw_rotation
from service.routes.rotation.precession import DISTURBANCE, PRECESSION, RATE, Equilibria, PrecessionFigures
from service.routes.rotation.trajectory import (
    ANGULAR_VELOCITY,
    ATTITUDE,
    OUTPUTS,
    ROTATION,
    TIMES,
    RotationSamples,
)
from service.routing import Answer
from service.schemas import DecimalString, Request, fields_of


class CertifiedTrajectoryRequest(Request):
    """A body, how it turns at t = 0, and the times at which its motion is wanted."""

    body: DecimalBody
    angular_velocity: DecimalAngularVelocity = ANGULAR_VELOCITY
    attitude: DecimalQuaternion | None = ATTITUDE
    times: DecimalTimes = TIMES
    digits: DigitCount
    outputs: list[Output] | None = OUTPUTS


class CertifiedTrajectoryAnswer(Certified, RotationSamples[DecimalString]):
    """Samples of a free rotation, numbers as decimal strings."""

    method: Literal["closed-form"]
    ended: Literal["horizon"]


class CertifiedPrecessionRequest(Request):
    """A body and how it turns at t = 0."""

    body: DecimalBody
    angular_velocity: DecimalAngularVelocity = ANGULAR_VELOCITY
    digits: DigitCount


class CertifiedPrecessionAnswer(Certified, PrecessionFigures[DecimalString]):
    """Rates and angles as decimal strings; null where the motion has no such thing."""


class CertifiedStabilityRequest(Request):
    """A body, and how fast it turns about its principal axes."""

    body: DecimalBody
    rate: DecimalRate = RATE
    disturbance: tuple[DecimalRate, DecimalRate] | None = DISTURBANCE
    digits: DigitCount


class CertifiedStabilityAnswer(Certified, Equilibria[DecimalString]):
    """Every equilibrium of a free body at one rate, numbers as decimal strings."""


def answer_trajectory(question: CertifiedTrajectoryRequest, budget: Budget) -> Answer:
    """Answer with samples of the motion."""
    digits, wanted = question.digits, wanted_outputs(question.outputs, question.attitude)
    samples = samples_of(question.times, digits, _numbers(wanted), budget)
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


def answer_precession(question: CertifiedPrecessionRequest, budget: Budget) -> Answer:
    """Answer with the figures."""
    body = body_of(question.body)
    motion = CertifiedRotation.of(body.of_motion, question.angular_velocity)
    found = fields_of(certified_precession(motion, question.digits))
    return found | {"accuracy": accuracy(question.digits), "warnings": [*notices(body), *motion.warnings]}


def answer_stability(question: CertifiedStabilityRequest, budget: Budget) -> Answer:
    """Answer with every equilibrium."""
    body = body_of(question.body)
    found = certified_stability(body.of_motion, question.rate, question.digits, question.disturbance)
    return {
        **fields_of(found),
        "equilibria": [fields_of(equilibrium) for equilibrium in found.equilibria],
        "accuracy": accuracy(question.digits),
        "warnings": notices(body),
    }


def _numbers(wanted: tuple[Output, ...]) -> int:
    return 7 if "attitude" in wanted else 3


CERTIFIED_ROTATION = (
    certified_route(
        ROTATION[0],
        question=CertifiedTrajectoryRequest,
        answer=CertifiedTrajectoryAnswer,
        handle=answer_trajectory,
        representations={SVG: draw_rotation},
    ),
    certified_route(
        PRECESSION[0],
        question=CertifiedPrecessionRequest,
        answer=CertifiedPrecessionAnswer,
        handle=answer_precession,
    ),
    certified_route(
        PRECESSION[1],
        question=CertifiedStabilityRequest,
        answer=CertifiedStabilityAnswer,
        handle=answer_stability,
    ),
)
