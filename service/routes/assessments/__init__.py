"""Submitted answers, graded: the reference is computed once for each question, each submission is judged by itself."""

from __future__ import annotations

import json
from collections.abc import Mapping, Sequence
from functools import cache
from typing import Annotated, Any

from pydantic import Field

from core.assessment.catalogue import MISTAKES
from core.assessment.compare import Form, Verdict
from core.assessment.comparisons import Comparison
from core.assessment.formulas import CONSTANTS, FUNCTIONS, NAME
from core.assessment.propagation import MOST_INPUTS, numbers_of, relative_uncertainties
from core.errors import InvalidParameter, MechanicsError, Path
from core.notices import Notice
from core.quantities import Quantity, Uncertainty, Unit
from core.systems.budget import Budget
from service.problems import Fault, Problem, Refusal, headline
from service.requests.request_reader import Limits, Reader
from service.requests.suggestions import nearest_path
from service.routes.assessments.assessed_question import AssessedQuestion, steps_of
from service.routes.assessments.grading import MOST_IDENTIFIED, Grader
from service.routes.assessments.submissions import LONGEST_POINTER, SubmissionList
from service.routing import Answer, PostRoute
from service.schemas import Envelope, RadiansPerSecond, Ratio, Request, Seconds, View
from service.schemas import Fault as FaultView

WITHIN: Path = ("question", "request")

OwnUnit = Unit("as in the field unit")

FEW_SUBMISSIONS = 1000
"""Submissions up to which an assessment may be begun in the event loop, if its question may."""

SECONDS_OF_A_SUBMISSION = 5e-5

SECONDS_OF_A_SEARCH = 1e-2
"""For the method that samples come from."""

Credit = Annotated[float, Quantity("1", at_least=0, at_most=1)]


class AskedQuestion(Request):
    """A request to another endpoint, whose answer is the reference."""

    path: str = Field(max_length=200, description="Of the endpoint, for example /v1/rotation/precession.")
    request: dict[str, Any] = Field(description="The body that it would be sent.")


class AssessmentRequest(Request):
    """A question, and what was submitted as its answer."""

    question: AskedQuestion
    submissions: Annotated[list[Any], SubmissionList()] = Field(
        description="Each an object of claims by JSON pointer into the answer of the question. One that cannot be read "
        "is answered with its format_errors, and the others are graded."
    )
    comparison: Comparison | None = Field(
        default=None, description="Of every figure without one of its own; default: relabs, 1 % of the reference."
    )
    comparisons: dict[str, Comparison] | None = Field(default=None, description="Of single figures, by pointer.")
    input_uncertainty: Uncertainty | None = Field(
        default=None,
        description="Relative uncertainty of every number of the question's request; default: half a unit in the last "
        "place. The comparison data accepts what follows from it.",
    )
    input_uncertainties: dict[str, Uncertainty] | None = Field(
        default=None,
        description='The same of single numbers, by pointer into the request, such as {"/gravity": 0.001}; the others '
        "are then exact.",
    )
    names: dict[str, str] | None = Field(
        default=None,
        description='Of the numbers of the request, in formulas, by pointer into it: {"M_1": "/masses/0"}; default: '
        "their fields, several with their number: gravity, masses_1.",
    )
    credits: dict[str, Credit] | None = Field(
        default=None, description="Share of the score for a recognised mistake, by tag, in place of the catalogue's."
    )
    reveal: bool = Field(
        default=True,
        description="If false, the answer holds verdicts and nothing else that depends on the reference.",
    )


class RecognisedMistake(View):
    """A mistake by which the submitted value comes out."""

    tag: str = Field(description="Of an entry of GET /v1/mistakes.")
    credit: Ratio[float] = Field(description="Share of the score.")
    feedback: str = Field(description="For who made it; it gives no number.")


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

    method: str = Field(description="Kind, as in GET /v1/methods; exact for samples as right as their digits.")
    step: Seconds[float] | None = Field(description="Length of the steps; null for exact.")
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
    feedback: str = Field(description="For who submitted it.")
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
    feedback: str = Field(description="For who submitted it.")


class ReferenceFigure(View):
    """What is right, and how well it is known."""

    pointer: str = Field(description="Into the answer of the question.")
    value: Any = Field(description="As in the answer; null where there is no such figure.")
    unit: str = Field(description="1 for pure numbers.")
    form: Form = Field(description="How submitted values are compared with it.")
    error: Annotated[float, OwnUnit] = Field(description="Numerical error; how says what it rests on.")
    how: str = Field(description="closed form and measured ...: a bound; estimate ...: none.")
    inherited: Annotated[float, OwnUnit] | None = Field(
        description="Error propagated from the uncertainty of the question's numbers, to first order; null if unknown."
    )
    sensitive: str | None = Field(description="Figure in which errors show, where this one is near a constant.")


class AssessmentAnswer(Envelope):
    """Verdicts, in the order of the submissions."""

    results: list[SubmissionResult] = Field(description="One for each submission.")
    reference: list[ReferenceFigure] | None = Field(
        default=None, description="Of every figure that was claimed; left out unless revealed."
    )


DESCRIPTION = """A claim is judged by the form of the figure: angles modulo whole turns, attitudes up to the sign of the
quaternion, principal axes up to sign and, where moments are equal, up to rotation, eigenvalues as a set, samples at the
times of the claim. Arrays count as wrong as their worst entry. Units are converted; for an angular rate 1 Hz is 2 pi
rad/s. A tolerance finer than the reference is known is not widened: the claim is not gradable.

With `reveal: false` no mistakes are named and none gives credit: who knows that a factor of 2 is missing has the
reference."""


def assessing(routes: Sequence[PostRoute]) -> PostRoute:
    """Return the route that assesses answers to questions to `routes`."""
    table: Mapping[str, PostRoute] = {route.path: route for route in routes}

    @cache
    def reader(path: str) -> Reader[Any]:
        # The document that holds the request has been held against the service's own limits.
        return Reader(table[path].question, Limits(10**4, 10**9, 10**9, 10**9), table[path].elsewhere)

    def routed(question: AssessmentRequest) -> PostRoute:
        path = question.question.path
        if path not in table:
            near = nearest_path(path, table)
            remedy = f"did you mean {near}?" if near else "GET /openapi.json lists every path"
            raise _refusal(Fault("/question/path", "must be the path of a question that can be assessed", remedy))
        return table[path]

    def assess(question: AssessmentRequest, budget: Budget) -> Answer:
        route = routed(question)
        request = question.question.request
        uncertainty = _uncertainty(question)
        try:
            asked = AssessedQuestion(route, reader(route.path).read, request, budget, uncertainty)
            warnings = [notice.inside(*WITHIN) for notice in asked.answer.get("warnings", ())]
        except Refusal as refusal:
            raise _moved(refusal.problem) from None
        except MechanicsError as error:
            error.path = (*WITHIN, *error.path)
            raise
        credits = question.credits or {}
        _check_tags(credits)
        comparisons = question.comparisons or {}
        grader = Grader(asked, question.comparison, comparisons, question.reveal, MISTAKES, credits, _names(question))
        results = [grader.result(i, submission) for i, submission in enumerate(question.submissions)]
        shown = {"reference": grader.references()} if question.reveal else {}
        warnings = warnings if question.reveal else []
        if grader.looked_for > MOST_IDENTIFIED:
            detail = f"the method is looked for in the first {MOST_IDENTIFIED} wrong samples of a request"
            warnings.append(Notice("methods-not-looked-for", detail, ("submissions",)))
        return {"results": results, **shown, "warnings": warnings}

    def price(question: AssessmentRequest, budget: Budget) -> float:
        route = routed(question)
        try:
            once = route.price(reader(route.path).read(json.dumps(question.question.request).encode()), budget)
        except Refusal as refusal:
            raise _moved(refusal.problem) from None
        except MechanicsError as error:
            error.path = (*WITHIN, *error.path)
            raise
        inputs = sum(1 for _ in numbers_of(question.question.request))
        again = 1 + 2 * min(inputs, MOST_INPUTS) + len(MISTAKES)
        timed = sum(map(_timed, question.submissions))
        methods = SECONDS_OF_A_SEARCH * min(timed, MOST_IDENTIFIED)
        return (again + timed) * once + methods + SECONDS_OF_A_SUBMISSION * len(question.submissions)

    def small(question: AssessmentRequest) -> bool:
        route = table.get(question.question.path)
        if route is None or len(question.submissions) > FEW_SUBMISSIONS:
            return route is None
        try:
            return route.small(reader(route.path).read(json.dumps(question.question.request).encode()))
        except (Refusal, MechanicsError):
            return True

    return PostRoute(
        "/v1/assessments",
        "assess",
        "Submitted answers to any other question, graded: verdict, error, recognised mistakes",
        "assessment",
        AssessmentRequest,
        AssessmentAnswer,
        assess,
        price,
        small,
        description=DESCRIPTION,
    )


def _timed(submission: Any) -> int:
    """Return how many claims of a submission have times of their own."""
    claims = submission.values() if isinstance(submission, dict) else ()
    return sum(isinstance(claim, dict) and "times" in claim for claim in claims)


def _uncertainty(question: AssessmentRequest) -> float | dict[Path, float] | None:
    if question.input_uncertainties is None:
        return question.input_uncertainty
    if question.input_uncertainty is not None:
        remedy = "give one of input_uncertainty and input_uncertainties"
        raise InvalidParameter("input_uncertainties", "be left out beside input_uncertainty", remedy=remedy)
    found = {}
    for pointer, share in question.input_uncertainties.items():
        within = ("input_uncertainties", pointer) if len(pointer) <= LONGEST_POINTER else ("input_uncertainties",)
        try:
            path = steps_of(pointer)
            relative_uncertainties(question.question.request, {path: share})
        except InvalidParameter as fault:
            raise InvalidParameter(within, fault.rule, remedy=fault.remedy) from None
        found[path] = share
    return found


def _names(question: AssessmentRequest) -> dict[str, Path] | None:
    if question.names is None:
        return None
    numbers, found = dict(numbers_of(question.question.request, zeros=True)), {}
    for name, pointer in question.names.items():
        place = ("names", name) if NAME.fullmatch(name) else ("names",)
        if not NAME.fullmatch(name) or name in FUNCTIONS or name in CONSTANTS:
            raise InvalidParameter(place, "have names of letters, digits and _ that are no functions")
        if not pointer.startswith("/") or steps_of(pointer) not in numbers:
            raise InvalidParameter(place, "lead to a number of the request", remedy='such as "/gravity"')
        found[name] = steps_of(pointer)
    return found


def _check_tags(credits: Mapping[str, float]) -> None:
    known = {entry.tag for entry in MISTAKES}
    for tag in credits:
        if tag not in known:
            path = ("credits", tag) if len(tag) <= 40 else ("credits",)
            raise InvalidParameter(path, "be the tag of a recognised mistake", remedy="GET /v1/mistakes lists them")


def _moved(problem: Problem) -> Refusal:
    """Return the refusal of the question itself, with pointers into the document that holds it."""
    faults = problem.faults or (Fault("", problem.detail),)
    moved = [Fault("/question/request" + fault.pointer, fault.detail, fault.remedy) for fault in faults]
    code = problem.type.code if problem.type.status == 422 else "invalid-parameter"
    return Refusal(code, headline(moved), faults=moved, extra=problem.extra)


def _refusal(fault: Fault) -> Refusal:
    return Refusal("invalid-parameter", headline([fault]), faults=[fault])
