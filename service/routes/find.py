"""POST /v1/find: with which inputs does the answer to a question have a property?"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from contextlib import contextmanager
from math import isfinite
from typing import Annotated, Any, Literal

from pydantic import Field, SkipValidation

from core.assessment.figures import steps_of
from core.assessment.graded_question import GradedQuestion
from core.assessment.propagation import at, numbers_of
from core.assessment.units import factor
from core.assessment.varied_input import LONGEST_WORD
from core.errors import InvalidParameter, MechanicsError, Path, inside_field, pointer_of
from core.find.figures import Happens
from core.find.search import MOST_INPUTS, Condition, Wanted, found
from core.find.solutions import Family, Findings, Nearest, Solution
from core.find.varied import Scale, Varied
from core.formulas import Formula
from core.near_names import did_you_mean
from core.notices import Notice
from core.quantities import Unit
from core.sensitivities.figure import figure_of
from core.systems.budget import Budget
from service.requests.figures import NamedEvent, WrittenFigure
from service.requests.layout import ARRAY, OBJECT
from service.routes.assessments.question_table import EndpointRequest, QuestionTable, within_question
from service.routes.declared_units import unit_at
from service.routing import Answer, PostRoute
from service.schemas import Envelope, Request, View

PATH = "/v1/find"

Number = Annotated[float | str | dict[str, Any], SkipValidation()]
"""A number as it is written: a JSON number, a decimal, or a value with its unit."""

OfInput = Annotated[float, Field(json_schema_extra={"x-unit": "as in the request at that pointer"})]
"""No unit that claims could be converted to is declared: it is that of whatever the pointer leads to."""
OfFigure = Annotated[float, Unit("as in the figure of the answer")]
InputValues = dict[str, OfInput]


class InputRange(Request):
    """A number of the request that is varied."""

    pointer: str = Field(max_length=LONGEST_WORD, description="JSON pointer into the request: /bodies/bob/velocity/0.")
    between: list[Number] = Field(
        min_length=2,
        max_length=2,
        description="Ends of the range, the smaller first, in the unit of the number in the request; or "
        '{"value": "30", "unit": "deg"} where that number has a declared unit.',
    )
    scale: Scale = Field(default="linear", description="log: samples are evenly spaced in the logarithm.")


class ConditionForm(Request):
    """What is to hold of a figure or an event: one of equals, least, largest, infinite, changes and happens."""

    figure: WrittenFigure | None = Field(
        default=None,
        description='JSON pointer into the answer, {"event": {"kind", "name", "nth"}} for its time, or '
        '{"count": pointer} for the number of entries of a list.',
    )
    event: Annotated[NamedEvent | None, SkipValidation()] = Field(
        default=None, description="With happens: the event that is to happen."
    )
    equals: Annotated[float | str | bool | dict[str, Any] | None, SkipValidation()] = Field(
        default=None,
        description="The figure has this value: a number in its unit, a value with a unit, a word or a truth value.",
    )
    least: Literal[True] | None = Field(default=None, description="The figure is locally least in the closed range.")
    largest: Literal[True] | None = Field(default=None, description="The figure is locally largest in the range.")
    infinite: Literal[True] | None = Field(default=None, description="The figure grows beyond all bounds.")
    changes: Literal[True] | None = Field(
        default=None,
        description="What is said changes: a word, a truth value, a count, whether there is such a figure, or a number "
        "jumps.",
    )
    happens: Literal[True] | None = Field(default=None, description="The event happens.")


class OneOrMany:
    """Labels the two members of a union, so that a fault names the one that the client meant."""

    def __get_pydantic_core_schema__(self, source: Any, handler: Any) -> dict[str, Any]:
        schema: dict[str, Any] = handler(source)
        first, second = schema["choices"]
        return {"type": "union", "mode": "left_to_right", "choices": [(first, OBJECT), (second, ARRAY)]}


class FindRequest(Request):
    """A question, what is varied in it, and what is to hold of its answer."""

    question: EndpointRequest
    vary: Annotated[
        InputRange | Annotated[list[InputRange], Field(min_length=1, max_length=MOST_INPUTS)], OneOrMany()
    ] = Field(description=f"What is varied: one number, or up to {MOST_INPUTS} of them in an array.")
    until: Annotated[
        ConditionForm | Annotated[list[ConditionForm], Field(min_length=1, max_length=MOST_INPUTS)], OneOrMany()
    ] = Field(description="What is to hold of the answer: as many conditions as numbers that are varied.")
    answers: bool = Field(default=False, description="Whether the answer to the question comes with each solution.")


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
    figure: Any = Field(
        description="The figure of the answer with these values, an array of several; null at borders and jumps."
    )
    figure_error: OfFigure | list[OfFigure] | None = Field(description="Bound of its error; null where it is null.")
    below: Any = Field(default=None, description="The figure just below a border or a jump; null where there is none.")
    above: Any = Field(default=None, description="The figure just above it.")
    answer: dict[str, Any] | None = Field(default=None, description="Of the question, if answers were requested.")


class NearestMiss(View):
    """The inputs with which the conditions are missed by least."""

    values: InputValues
    figure: Any = Field(description="The figure there, an array of several.")
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
        description="Declared units of the inputs, by pointer; null where the request declares none there."
    )


DESCRIPTION = """The question is any other request. Each value has an error bound that follows from the error of the
figure and its slope: on both sides of a root the figure is above and below the value by more than its own errors. What
is not continuous is a result, too: an event that comes or goes is a border, a leap past the value a jump. Samples
decide where is looked; a pair of solutions closer than `resolution` may be missed, unless `complete` is true."""

WANTED: tuple[Wanted, ...] = ("equals", "least", "largest", "infinite", "changes", "happens")


def finding(routes: Sequence[PostRoute], certified: Sequence[PostRoute]) -> PostRoute:
    """Return the route that asks questions to `routes` backwards, some of which have proven digits, too."""
    table = QuestionTable(routes, certified, "be asked backwards")

    def find(question: FindRequest, budget: Budget) -> Answer:
        route = table.route(question.question)
        varied = _varied(question, route)
        conditions = _conditions(question, route)
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
        units = {one.pointer: unit_at(route.question, one.path) for one in varied}
        return answer | {"units": units, "warnings": findings.notices}

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


def _varied(question: FindRequest, route: PostRoute) -> list[Varied]:
    """Return what is varied, or refuse what is no number of the request."""
    several = isinstance(question.vary, list)
    entries = question.vary if isinstance(question.vary, list) else [question.vary]
    request = question.question.request
    made: list[Varied] = []
    for k, entry in enumerate(entries):
        within: Path = ("vary", k) if several else ("vary",)
        path = _place(entry.pointer, request, (*within, "pointer"))
        if any(path[: len(one.path)] == one.path or one.path[: len(path)] == path for one in made):
            raise InvalidParameter((*within, "pointer"), "vary nothing that another entry varies")
        unit = unit_at(route.question, path)
        least, most = (_number(end, unit, (*within, "between", i)) for i, end in enumerate(entry.between))
        with inside_field(*within):
            made.append(Varied(entry.pointer, path, least, most, entry.scale))
    return made


def _place(pointer: str, request: Any, within: Path) -> Path:
    """Return the place of a number of the request."""
    known = dict(numbers_of(request, zeros=True))
    try:
        path = steps_of(pointer)
    except InvalidParameter:
        path = ()
    present = at(request, path) if path else None
    if path and _is_number(present, request):
        return path
    near = did_you_mean(pointer, [pointer_of(one) for one in known])
    remedy = near or "what is varied has to be in the request of the question, with any value"
    raise InvalidParameter(within, "lead to a number in the request", remedy=remedy)


def _is_number(present: Any, request: Any) -> bool:
    if isinstance(present, str):
        try:
            Formula.read(present, request.get("let") or ())
        except InvalidParameter:
            return False
        return True
    return type(present) in (int, float)


def _number(given: Any, unit: str | None, place: Path) -> float:
    """Return a number as it is written, in the unit of what it is for."""
    if isinstance(given, Mapping) and set(given) == {"value", "unit"}:
        if unit is None:
            rule = "be a plain number: no unit is declared for what it is compared with"
            raise InvalidParameter(place, rule, remedy="write it in the unit of the number in the request")
        if not isinstance(given["unit"], str):
            raise InvalidParameter((*place, "unit"), "be a word")
        try:
            scale = factor(given["unit"], unit)
        except InvalidParameter as fault:
            raise InvalidParameter((*place, "unit"), fault.rule, remedy=fault.remedy) from None
        return _number(given["value"], None, (*place, "value")) * scale
    number = given
    if isinstance(given, str) and len(given) <= LONGEST_WORD:
        try:
            number = float(given)
        except ValueError:
            number = None
    if isinstance(number, bool) or not isinstance(number, (int, float)):
        raise InvalidParameter(place, 'be a number, a decimal in quotes, or {"value", "unit"}')
    if abs(number) > 1.7e308 or not isfinite(number):
        raise InvalidParameter(place, "be finite")
    return float(number)


def _conditions(question: FindRequest, route: PostRoute) -> list[Condition]:
    several = isinstance(question.until, list)
    entries = question.until if isinstance(question.until, list) else [question.until]
    return [_condition(entry, route, ("until", k) if several else ("until",)) for k, entry in enumerate(entries)]


def _condition(form: ConditionForm, route: PostRoute, within: Path) -> Condition:
    """Return a condition, or refuse one that says nothing, or more than one thing."""
    given = [name for name in WANTED if getattr(form, name) is not None]
    if len(given) != 1:
        remedy = "give one of equals, least, largest, infinite, changes and happens"
        raise InvalidParameter(within, f"say one thing, not {len(given)}", remedy=remedy)
    wanted = given[0]
    if wanted == "happens":
        if form.event is None or form.figure is not None:
            raise InvalidParameter((*within, "event"), "say what happens, in place of figure")
        event = figure_of({"event": form.event}, within)
        return Condition(Happens(**vars(event)), wanted, of_event=True)
    if form.event is not None:
        remedy = 'write {"figure": {"event": ...}} for its time, or happens: true'
        raise InvalidParameter((*within, "event"), "be left out unless it happens", remedy=remedy)
    if form.figure is None:
        raise InvalidParameter((*within, "figure"), "be given")
    figure = figure_of(form.figure, (*within, "figure"))
    of_event = isinstance(form.figure, Mapping) and "event" in form.figure
    equals: Any = form.equals
    if wanted == "equals" and not isinstance(equals, (bool, str)):
        unit = "s" if of_event else unit_at(route.answer, figure.path)
        equals = _number(equals, unit, (*within, "equals"))
    elif isinstance(equals, str) and len(equals) > LONGEST_WORD:
        raise InvalidParameter((*within, "equals"), f"have at most {LONGEST_WORD} characters")
    return Condition(figure, wanted, equals, of_event)


__all__ = ["FindRequest", "finding"]
