"""What POST /v1/find is asked: which numbers of a request are varied, and what is to hold of its answer."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from math import isfinite
from typing import Annotated, Any, Literal

from pydantic import Field, SkipValidation

from core.assessment.figures import steps_of
from core.assessment.propagation import at, numbers_of
from core.assessment.units import factor
from core.assessment.varied_input import LONGEST_WORD
from core.errors import InvalidParameter, Path, inside_field, pointer_of
from core.find.figures import Happens
from core.find.search import MOST_INPUTS, WANTED, Condition
from core.find.varied import LARGEST, Scale, Varied, can_vary
from core.multibody.language.written_units import number_within
from core.near_names import did_you_mean
from core.sensitivities.figure import figure_of
from service.requests.declared_units import unit_at, unknown_name
from service.requests.figures import NamedEvent, WrittenFigure
from service.routes.assessments.question_table import EndpointRequest
from service.routing import PostRoute
from service.schemas import ObjectOrArray, Request

Number = Annotated[float | str | dict[str, Any], SkipValidation()]
"""A number as it is written: a JSON number, a decimal, or a value with its unit."""


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


class FindRequest(Request):
    """A question, what is varied in it, and what is to hold of its answer."""

    question: EndpointRequest
    vary: Annotated[
        InputRange | Annotated[list[InputRange], Field(min_length=1, max_length=MOST_INPUTS)], ObjectOrArray()
    ] = Field(description=f"What is varied: one number, or up to {MOST_INPUTS} of them in an array.")
    until: Annotated[
        ConditionForm | Annotated[list[ConditionForm], Field(min_length=1, max_length=MOST_INPUTS)], ObjectOrArray()
    ] = Field(description="What is to hold of the answer: as many conditions as numbers that are varied.")
    answers: bool = Field(default=False, description="Whether the answer to the question comes with each solution.")


def varied_of(question: FindRequest, unit_of: Callable[[Path], str | None]) -> list[Varied]:
    """Return what is varied, or refuse what is no number of the request, of which `unit_of` gives the units."""
    several = isinstance(question.vary, list)
    entries = question.vary if isinstance(question.vary, list) else [question.vary]
    request = question.question.request
    made: list[Varied] = []
    for k, entry in enumerate(entries):
        within: Path = ("vary", k) if several else ("vary",)
        path = _place(entry.pointer, request, (*within, "pointer"))
        if any(path[: len(one.path)] == one.path or one.path[: len(path)] == path for one in made):
            raise InvalidParameter((*within, "pointer"), "vary nothing that another entry varies")
        unit = unit_of(path)
        least, most = (_number(end, unit, (*within, "between", i)) for i, end in enumerate(entry.between))
        with inside_field(*within):
            made.append(Varied(entry.pointer, path, least, most, entry.scale, unit))
    return made


def _place(pointer: str, request: Any, within: Path) -> Path:
    """Return the place of a number of the request."""
    known = dict(numbers_of(request, zeros=True))
    try:
        path = steps_of(pointer)
    except InvalidParameter:
        path = ()
    present = at(request, path) if path else None
    if path and can_vary(present, request.get("let") or ()):
        return path
    if (inner := number_within(present, path)) is not None:
        rule = "lead to the number itself, which is written with its unit"
        raise InvalidParameter(within, rule, remedy=f"write {pointer_of(inner)}; between is in that unit")
    near = did_you_mean(pointer, [pointer_of(one) for one in known])
    remedy = near or "write the number that is varied into the request of the question, with any value"
    raise InvalidParameter(within, "lead to a number in the request", remedy=remedy)


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
    if abs(number) > LARGEST or not isfinite(number):
        raise InvalidParameter(place, "be finite")
    return float(number)


def conditions_of(question: FindRequest, route: PostRoute) -> list[Condition]:
    """Return what is to hold, of figures that the answer has or of events."""
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
    unknown = unknown_name(route.answer, figure.path)
    if unknown is not None:
        k, known = unknown
        rule = "lead to something that answers to the question may have"
        before = pointer_of(figure.path[:k])
        near = did_you_mean(pointer_of((figure.path[k],)), [pointer_of((name,)) for name in known])
        listed = f"{before} has {', '.join(known)}" if before else f"these begin with {', '.join(known)}"
        remedy = f"{near} {listed}" if near and before else near or listed
        raise InvalidParameter((*within, "figure"), rule, remedy=remedy)
    of_event = isinstance(form.figure, Mapping) and "event" in form.figure
    equals: Any = form.equals
    if wanted == "equals" and not isinstance(equals, (bool, str)):
        unit = "s" if of_event else unit_at(route.answer, figure.path)
        equals = _number(equals, unit, (*within, "equals"))
    elif isinstance(equals, str) and len(equals) > LONGEST_WORD:
        raise InvalidParameter((*within, "equals"), f"have at most {LONGEST_WORD} characters")
    return Condition(figure, wanted, equals, of_event)
