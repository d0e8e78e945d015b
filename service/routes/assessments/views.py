"""Results of an assessment as they are written: verdicts, and unless they are withheld errors and references."""

from __future__ import annotations

from typing import Annotated, Any, Literal

from pydantic import Field

from core.assessment.compare import Form, Verdict
from core.quantities import Unit
from service.routes.equations_answer import SceneEquations
from service.schemas import Envelope, RadiansPerSecond, Ratio, Seconds, View
from service.schemas import Fault as FaultView

OwnUnit = Unit("as in the field unit")


class RecognisedMistake(View):
    """A mistake by which the submitted value comes out."""

    tag: str = Field(description="Of an entry of GET /v1/mistakes.")
    credit: Ratio[float] = Field(description="Share of the score.")
    feedback: str = Field(description="Feedback for the student; it gives no number.")


class ClaimError(View):
    """How far a claim is from the reference."""

    absolute: Annotated[float, OwnUnit] | None = Field(description="null where the error has no size.")
    relative: Ratio[float] | None = Field(description="To the largest magnitude of the reference; null if that is 0.")
    in_tolerances: Ratio[float] | None = Field(description="Over the tolerance; null without one.")
    tolerance: Annotated[float, OwnUnit] | None = Field(description="Largest error that is accepted.")
    sensitive: Ratio[float] | None = Field(description="Relative error of the reference's sensitive figure.")
    unit: str = Field(description="Of the absolute error and of the tolerance.")


class ConsistentMethod(View):
    """A method by which the samples come out, confirmed by running it."""

    method: str = Field(
        description="Kind, as in GET /v1/methods, or semi-implicit-euler, explicit-midpoint, heun; RK45, DOP853 or "
        "LSODA of scipy.integrate.solve_ivp; exact for samples as accurate as their digits."
    )
    step: Seconds[float] | None = Field(description="Length of the steps; null for exact, and where it is chosen.")
    tolerance: Ratio[float] | None = Field(description="Relative, of a method that chooses its steps.")
    unexplained: RadiansPerSecond[float] = Field(description="Largest norm of the difference that is left.")


class SamplesError(View):
    """How wrong samples of the angular velocity are."""

    largest: RadiansPerSecond[float] = Field(description="Largest norm of the error of any sample.")
    final: RadiansPerSecond[float] = Field(description="At the time farthest from the start.")
    within_until: Seconds[float] | None = Field(
        description="First time, outwards from the start, at which the error is beyond the tolerance."
    )
    energy_drift: Ratio[float] | None = Field(description="Largest relative change of the energy; null at rest.")
    angular_momentum_drift: Ratio[float] | None = Field(description="The same of the angular momentum's magnitude.")
    phase_lag: Seconds[float] | None = Field(
        description="By how much the samples are late, negative if early: the shift of the motion that is nearest to "
        "them; null if none leaves less than half of the error."
    )
    separatrix_crossed: Seconds[float] | None = Field(
        description="First time, outwards from the start, at which the samples circle another axis than the motion."
    )
    consistent_with: ConsistentMethod | None = Field(
        description="null if no method explains the error, or a recognised mistake does."
    )


class ClaimResult(View):
    """What becomes of one claim."""

    pointer: str = Field(description="Of the figure in the answer.")
    verdict: Verdict
    correct: bool | None = Field(description="null if that cannot be said.")
    score: Ratio[float] | None = Field(description="From 0 to 1.")
    matches: list[RecognisedMistake] = Field(description="Mistakes by which the value comes out.")
    feedback: str = Field(description="Feedback for the student, in the language of the request.")
    error: ClaimError | None = Field(default=None, description="Left out unless the reference is revealed.")
    samples: SamplesError | None = Field(
        default=None, description="Of samples of the angular velocity that are not right; left out likewise."
    )


class SubmissionResult(View):
    """What becomes of one submission."""

    score: Ratio[float] | None = Field(description="Mean of its claims, from 0 to 1; null if it is not gradable.")
    correct: bool | None = Field(description="Whether every claim is right; null if it is not gradable.")
    gradable: bool = Field(description="Whether every claim could be read and judged.")
    format_errors: list[FaultView] = Field(description="What cannot be read, by pointer into the document sent.")
    tests: list[ClaimResult] = Field(description="Of the claims that can be read.")
    matches: list[str] = Field(description="Tags of all recognised mistakes.")
    feedback: str = Field(description="Feedback for the student, in the language of the request.")


class ReferenceFigure(View):
    """What is right, and how well it is known."""

    pointer: str = Field(description="Into the answer of the question.")
    value: Any = Field(description="As in the answer; null where there is no such figure.")
    unit: str = Field(description="1 for pure numbers.")
    form: Form = Field(description="How submitted values are compared with it.")
    error: Annotated[float, OwnUnit] = Field(description="Numerical error; how says what it rests on.")
    how: str = Field(
        description="closed form, ball arithmetic, sums of two doubles and measured ...: a bound; estimate ...: none."
    )
    inherited: Annotated[float, OwnUnit] | None = Field(
        description="Error propagated from the uncertainty of the question's numbers, to first order; null if unknown."
    )
    body_axis: Literal[1, 2, 3] | None = Field(
        description="Body axis that the figure belongs to, by its order in the request and not by its moment; null if "
        "it belongs to none."
    )
    sensitive: str | None = Field(description="Figure in which errors show, where this one is near a constant.")


class AssessmentAnswer(Envelope):
    """Verdicts, in the order of the submissions."""

    results: list[SubmissionResult] = Field(description="One for each submission.")
    reference: list[ReferenceFigure] | None = Field(
        default=None, description="Of every figure that was claimed; left out unless revealed."
    )
    equations: SceneEquations | None = Field(
        default=None,
        description="Of the scene of the question, if they are among its outputs; left out unless revealed.",
    )
