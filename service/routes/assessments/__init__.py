"""Grading: the reference is computed once for each problem, and each submission is judged by itself."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from contextlib import suppress
from typing import Annotated, Any

from pydantic import Field

from core.assessment.answer_key import Document, key_of
from core.assessment.carried import CarriedStep, checked_steps
from core.assessment.catalogue import MISTAKES
from core.assessment.claims import MOST_CLAIMS, Claim
from core.assessment.comparisons import Comparison
from core.assessment.feedback.languages import Language
from core.assessment.figures import is_null, steps_of, value_at
from core.assessment.graded_question import GradedQuestion
from core.assessment.grader import LONGEST_POINTER, MOST_IDENTIFIED, Grader, credited
from core.assessment.propagation import numbers_of, relative_uncertainties
from core.assessment.results import reference_views, submission_view
from core.assessment.terms import Terms
from core.assessment.typed_number import Locale
from core.errors import InvalidParameter, Path, inside_field
from core.formulas import is_name
from core.multibody.language.numerals import member
from core.notices import Notice
from core.quantities import Quantity, Uncertainty
from core.systems.budget import Budget
from service.requests.request_reader import Limits, Reader
from service.routes.assessments.question_table import WITHIN, EndpointRequest, QuestionTable
from service.routes.assessments.submissions import SubmissionList
from service.routes.assessments.views import AssessmentAnswer
from service.routing import Answer, PostRoute
from service.schemas import Request

FEW_SUBMISSIONS = 1000
"""Submissions up to which an assessment may be begun in the event loop, if its question may."""


Credit = Annotated[float, Quantity("1", at_least=0, at_most=1)]


class AssessmentRequest(Request):
    """A question, and what was submitted as its answer."""

    question: EndpointRequest
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
        "their fields, several with their number, which counts from 1: gravity, masses_1 (pointers count from 0: "
        "/masses/0); those that share one with the field around it: one_mass, two_mass.",
    )
    credits: dict[str, Credit] | None = Field(
        default=None, description="Share of the score for a recognised mistake, by tag, in place of the catalogue's."
    )
    locale: Locale | None = Field(
        default=None,
        description="Of each `text`: its decimal mark is a point (en) or a comma (de, es, fr), and units "
        "may be words of its language (Grad, tr/min). Without it a comma is one where it cannot group digits.",
    )
    language: Language = Field(default="en", description="Of the feedback.")
    steps: dict[str, CarriedStep] | None = Field(
        default=None,
        max_length=MOST_CLAIMS,
        description="How a figure follows from earlier ones of the same submission, by its pointer. An answer that is "
        "wrong only because an earlier one is has the verdict carried, and the credit.",
    )
    reveal: bool = Field(
        default=True,
        description="If false, the answer holds verdicts and nothing else that depends on the reference.",
    )


WRONG_SAMPLES: Any = {
    "question": {
        "path": "/v1/rotation/trajectory",
        "request": {
            "body": {"kind": "principal-moments", "moments": [1, 2, 3]},
            "angular_velocity": [0.1, 2, 0.1],
            "times": [0],
        },
    },
    "submissions": [
        {"/angular_velocity": {"times": [0, 1], "value": [[0.1, 2, 0.1], [-0.1, 1.93, 0.3]], "unit": "rad/s"}}
    ],
}
"""Samples whose method is looked for, which compiles the methods that are tried."""

DESCRIPTION = """A claim is judged by the form of the figure: angles modulo whole turns, attitudes up to the sign of the
quaternion, principal axes up to sign and, where moments are equal, up to rotation, eigenvalues as a set, samples at the
times of the claim. Arrays count as wrong as their worst entry. Units are converted; for an angular rate 1 Hz is 2 pi
rad/s. A tolerance finer than the reference is known is not widened: the claim is not gradable.

With `reveal: false` no mistakes are named and none gives credit: a student who learns that a factor of 2 is missing
knows the reference."""


def assessing(routes: Sequence[PostRoute], certified: Sequence[PostRoute]) -> PostRoute:
    """Return the route that assesses answers to questions to `routes`, some of which have proven digits, too."""
    table = QuestionTable(routes, certified)

    def assess(question: AssessmentRequest, budget: Budget) -> Answer:
        uncertainty = _uncertainty(question)
        graded = table.answered(question.question, budget, uncertainty)
        warnings = [notice.inside(*WITHIN) for notice in graded.answer.get("warnings", ())]
        credits, comparisons = question.credits or {}, question.comparisons or {}
        _check_tags(credits)
        _check_figures(comparisons, graded.answer)
        catalogue = credited(MISTAKES, credits)
        grader = Grader(graded, _terms(question, graded), catalogue)
        results = [
            submission_view(i, grader.judged(submission), grader.terms)
            for i, submission in enumerate(question.submissions)
        ]
        shown: Answer = {"reference": reference_views(grader)} if question.reveal else {}
        if question.reveal and graded.answer.get("equations") is not None:
            shown["equations"] = graded.answer["equations"]
        warnings = warnings if question.reveal else []
        return {"results": results, **shown, "warnings": [*warnings, *_left_out(question, grader)]}

    def small(question: AssessmentRequest) -> bool:
        if len(question.submissions) > FEW_SUBMISSIONS:
            return False
        if any(_claims_with(key, question.submissions) for key in ("formula", "text", "times")):
            # The question is then answered in many variations, or methods are run.
            return False
        return table.small(question.question)

    return PostRoute(
        "/v1/assessments",
        "assess",
        "Student answers to any problem that the service can solve, graded: verdict, error, recognised mistakes",
        "assessment",
        AssessmentRequest,
        AssessmentAnswer,
        assess,
        small,
        description=DESCRIPTION,
        warming=(WRONG_SAMPLES,),
    )


def _left_out(question: AssessmentRequest, grader: Grader) -> list[Notice]:
    """Return warnings of what a grader did not do: methods that it did not look for, formulas that it did not judge."""
    found: list[Notice] = []
    if grader.looked_for > MOST_IDENTIFIED:
        detail = f"the method is looked for in the first {MOST_IDENTIFIED} wrong samples of a request"
        found.append(Notice("methods-not-looked-for", detail, ("submissions",)))
    if grader.formulas_left:
        # Says nothing of the reference, and is for who set the question.
        remedy = "choose other numbers in names"
        if question.names is None:
            remedy = 'say in names, beside question, which numbers formulas have: {"m": "/bodies/block/mass"}'
        detail = f"a formula for {grader.formulas_left[0]} is not judged: where its numbers change alone, "
        detail += f"the question has no such figure, or is about another arrangement; {remedy}"
        found.append(Notice("formulas-not-judged", detail, ("names",)))
    return found


def answer_key(routes: Sequence[PostRoute], certified: Sequence[PostRoute], body: bytes) -> Document:
    """Return the answer key of the question of an assessment: of all its figures, and of what its submissions claim.

    Raises
    ------
    Refusal, MechanicsError
        For what an assessment is refused with.
    """
    question: AssessmentRequest = Reader(AssessmentRequest, Limits()).read(body)
    graded = QuestionTable(routes, certified).answered(question.question, Budget(), _uncertainty(question))
    _check_tags(question.credits or {})
    _check_figures(question.comparisons or {}, graded.answer)
    claimed: list[str] = []
    timed: list[tuple[str, tuple[float, ...]]] = []
    for pointer, entry in (pair for one in question.submissions if isinstance(one, dict) for pair in one.items()):
        # What cannot be read is no example of what students claim.
        with suppress(InvalidParameter):
            times = Claim.read(entry, question.locale).times
            steps_of(pointer)
            if times is None:
                claimed.append(pointer)
            else:
                timed.append((pointer, tuple(times.tolist())))
    return key_of(
        graded, _terms(question, graded), credited(MISTAKES, question.credits or {}), claimed, [*dict.fromkeys(timed)]
    )


def _terms(question: AssessmentRequest, graded: GradedQuestion) -> Terms:
    """Return how submissions are graded, or refuse names and steps that the question does not have."""
    names, steps = _names(question), question.steps or {}
    if steps:
        parameters = {name: value for name, (_, value, _) in graded.parameters(names).items()}
        with inside_field("steps"):
            checked_steps(steps, parameters, graded.reference)
    return Terms(
        question.comparison,
        question.comparisons or {},
        question.reveal,
        names,
        question.locale,
        question.language,
        steps,
    )


def _claims_with(key: str, submissions: Sequence[Any]) -> list[dict[str, Any]]:
    """Return the claims that have a key, such as times of their own."""
    claims = (claim for one in submissions if isinstance(one, dict) for claim in one.values())
    return [claim for claim in claims if isinstance(claim, dict) and key in claim]


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
            path = _steps(pointer, "request", "/gravity")
            relative_uncertainties(question.question.request, {path: share})
        except InvalidParameter as fault:
            raise InvalidParameter(within, fault.rule, remedy=fault.remedy) from None
        found[path] = share
    return found


def _steps(pointer: str, document: str, example: str) -> Path:
    try:
        return steps_of(pointer)
    except InvalidParameter:
        raise InvalidParameter((), f"be a JSON pointer into the {document}", remedy=f'such as "{example}"') from None


def _check_figures(pointers: Iterable[str], answer: Mapping[str, Any]) -> None:
    """Refuse a comparison for a figure that the answer has not: it would be left unused without a word."""
    for pointer in pointers:
        within = ("comparisons", pointer) if len(pointer) <= LONGEST_POINTER else ("comparisons",)
        try:
            path = _steps(pointer, "answer of the question", "/flip_interval")
        except InvalidParameter as fault:
            raise InvalidParameter(within, fault.rule, remedy=fault.remedy) from None
        if value_at(answer, path) is None and not is_null(answer, path):
            raise InvalidParameter(within, "lead to a figure of the answer")


def _names(question: AssessmentRequest) -> dict[str, Path] | None:
    if question.names is None:
        return None
    numbers, found = dict(numbers_of(question.question.request, zeros=True)), {}
    for name, pointer in question.names.items():
        place = member(("names",), name)
        if not is_name(name):
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
