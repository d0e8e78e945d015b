"""POST /v1/find: with which inputs does the answer to a question have a property?"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from contextlib import contextmanager
from typing import Annotated, Any, Literal

from pydantic import Field

from core.assessment.graded_question import GradedQuestion
from core.assessment.stated_units import OF_THE_FIGURE, OF_THE_INPUT
from core.errors import InvalidParameter, MechanicsError, pointer_of
from core.find.search import found
from core.find.solutions import Family, Findings, Nearest, Solution
from core.notices import Notice
from core.quantities import Unit
from core.systems.budget import Budget
from service.routes.assessments.question_table import QuestionTable, within_question
from service.routes.find_questions import FindRequest, conditions_of, varied_of
from service.routing import Answer, PostRoute
from service.schemas import Envelope, View

PATH = "/v1/find"

OfInput = Annotated[float, Unit(OF_THE_INPUT)]
OfFigure = Annotated[float, Unit(OF_THE_FIGURE)]
Found = Annotated[Any, Unit(OF_THE_FIGURE)]
"""A number in that unit, a word or a truth value."""
InputValues = dict[str, OfInput]


class FoundSolution(View):
    """Inputs with which the conditions hold."""

    values: InputValues = Field(description="By pointer into the request.")
    errors: InputValues = Field(description="Bounds of the distances from the true values.")
    kind: Literal["root", "extreme", "border", "jump"] = Field(
        description="root: the figure takes the value; extreme: it is least or largest; border: what is said changes, "
        "the figure comes, goes or is infinite, or the range ends where it is least or largest; jump: the figure leaps."
    )
    multiplicity: int = Field(
        description="Of a root: 2 where the figure touches the value, 3 where it passes it without slope; else 1.",
        json_schema_extra={"x-unit": "1"},
    )
    figure: Found = Field(
        description="The figure of the answer with these values, an array of several; null at borders and jumps."
    )
    figure_error: OfFigure | list[OfFigure] | None = Field(description="Bound of its error; null where it is null.")
    below: Found = Field(default=None, description="The figure just below a border or a jump; null without one.")
    above: Found = Field(default=None, description="The figure just above it.")
    answer: dict[str, Any] | None = Field(default=None, description="Of the question, if answers were requested.")


class NearestMiss(View):
    """The inputs with which the conditions are missed by least."""

    values: InputValues
    figure: Found = Field(description="The figure there, an array of several.")
    figure_error: OfFigure | list[OfFigure] = Field(description="Bound of its error.")


class NotDetermined(View):
    """Values that are not isolated: the conditions hold with all of them."""

    between: dict[str, list[OfInput]] = Field(
        description="By pointer, ends of the range of these values; of several inputs, twice the value that was found."
    )
    direction: dict[str, Annotated[float, Unit("1")]] | None = Field(
        default=None,
        description="Of several inputs, in which they can change together to first order, as shares of their ranges.",
    )


class FindAnswer(Envelope):
    """All values that were found, and how completely."""

    solutions: list[FoundSolution] = Field(description="In ascending order of their values.")
    complete: bool = Field(description="Whether it is proven that the range has no other solutions.")
    resolution: InputValues | None = Field(
        description="Widths below which other solutions may have been missed; null where it is complete."
    )
    nearest: NearestMiss | None = Field(description="Where a figure never equals the value; null otherwise.")
    ranges: list[list[OfInput]] | None = Field(
        default=None, description="In which the event happens, or the word, count or truth value is as wanted."
    )
    not_determined: list[NotDetermined] = Field(description="Families of values with all of which the condition holds.")
    evaluations: int = Field(description="How often the question was answered.", json_schema_extra={"x-unit": "1"})
    units: dict[str, str | None] = Field(
        description="Units of the inputs as they are written, by pointer; null where that is not known, as of a plain "
        "number of let."
    )
    figure_units: list[str | None] = Field(
        description="Units of the figures, in the order of until; null where no answer has a number for it."
    )


DESCRIPTION = """The question is any other request. Each value has an error bound that follows from the error of the
figure and its slope: on both sides of a root the figure is above and below the value by more than its own errors. What
is not continuous is a result, too: a border where an event begins or ceases to happen, a jump where the figure leaps
past the value. Samples decide where to look: a pair of solutions closer than `resolution` may be missed, unless
`complete` is true."""


def finding(routes: Sequence[PostRoute], certified: Sequence[PostRoute]) -> PostRoute:
    """Return the route that asks questions to `routes` backwards, some of which have proven digits, too."""
    table = QuestionTable(routes, certified, "be asked backwards")

    def find(question: FindRequest, budget: Budget) -> Answer:
        route = table.route(question.question)
        varied = varied_of(question, lambda path: table.unit_of(question.question, path))
        conditions = conditions_of(question, route)
        if len(varied) != len(conditions):
            rule = f"have as many entries as numbers are varied: {len(varied)}, not {len(conditions)}"
            raise InvalidParameter("until", rule)

        def ask(request: Any) -> GradedQuestion:
            # No number is uncertain: errors are those of the computation alone.
            return table.graded(question.question, request, budget, {})

        with _at_own_place(question):
            findings, evaluations = found(question.question.request, varied, conditions, ask)
        pointers = [one.pointer for one in varied]
        answer = _fields(findings, pointers) | {"evaluations": evaluations.count}
        if question.answers:
            for shown, solution in zip(answer["solutions"], findings.solutions, strict=True):
                forward = evaluations.answer(solution.inputs)
                shown["answer"] = _without_notices(forward)
        answer["units"] = {one.pointer: one.unit for one in varied}
        answer["figure_units"] = [evaluations.unit(k) for k in range(len(conditions))]
        return answer | {"warnings": findings.notices}

    return PostRoute(
        PATH,
        "find",
        "Any problem asked backwards: which input makes a figure take a value, become extreme, infinite, or change",
        "find",
        FindRequest,
        FindAnswer,
        find,
        description=DESCRIPTION,
    )


@contextmanager
def _at_own_place(question: FindRequest) -> Iterator[None]:
    """Have refusals of conditions point at them, and those of the question into it."""
    try:
        yield
    except InvalidParameter as fault:
        if fault.path[:1] != ("until",):
            with within_question():
                raise
        path = fault.path if isinstance(question.until, list) else (*fault.path[:1], *fault.path[2:])
        raise InvalidParameter(path, fault.rule, remedy=fault.remedy) from None
    except MechanicsError:
        with within_question():
            raise


def _fields(findings: Findings, pointers: Sequence[str]) -> Answer:
    """Return what was found as it is written."""
    resolution = findings.resolution
    answer: Answer = {
        "solutions": [_solution(one, pointers) for one in findings.solutions],
        "complete": findings.complete,
        "resolution": None if resolution is None else dict(zip(pointers, resolution, strict=True)),
        "nearest": None if findings.nearest is None else _nearest(findings.nearest, pointers),
    }
    if findings.ranges is not None:
        answer["ranges"] = [list(ends) for ends in findings.ranges]
    return answer | {"not_determined": [_family(one, pointers) for one in findings.families]}


def _solution(one: Solution, pointers: Sequence[str]) -> Answer:
    shown: Answer = {
        "values": dict(zip(pointers, one.inputs, strict=True)),
        "errors": dict(zip(pointers, one.errors, strict=True)),
        "kind": one.kind,
        "multiplicity": one.multiplicity,
        "figure": _single(one.figures),
        "figure_error": _single(one.figure_errors),
    }
    return shown if one.figures is not None else shown | {"below": one.below, "above": one.above}


def _nearest(one: Nearest, pointers: Sequence[str]) -> Answer:
    return {
        "values": dict(zip(pointers, one.inputs, strict=True)),
        "figure": _single(one.figures),
        "figure_error": _single(one.figure_errors),
    }


def _family(one: Family, pointers: Sequence[str]) -> Answer:
    ends = {pointer: [least, most] for pointer, least, most in zip(pointers, one.least, one.most, strict=True)}
    shown: Answer = {"between": ends}
    return shown if one.direction is None else shown | {"direction": dict(zip(pointers, one.direction, strict=True))}


def _single(values: Sequence[Any] | None) -> Any:
    return None if values is None else values[0] if len(values) == 1 else list(values)


def _without_notices(answer: Mapping[str, Any]) -> Answer:
    """Return the fields of an answer, its warnings as they are written."""
    warnings = [_warning(notice) for notice in answer.get("warnings", ())]
    return dict(answer) | {"warnings": warnings}


def _warning(notice: Notice) -> dict[str, str]:
    entry = {"code": notice.code, "detail": notice.detail}
    return entry | {"pointer": pointer_of(notice.path)} if notice.path else entry
