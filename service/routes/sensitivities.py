"""Derivatives of figures by numbers of the question, as an output of any question."""

from __future__ import annotations

import json
from collections.abc import Mapping
from copy import copy
from dataclasses import replace
from typing import Annotated, Any, Self, get_args

from pydantic import Discriminator, Field, PrivateAttr, Tag, ValidationError, create_model

from core.assessment.figures import steps_of
from core.errors import InvalidParameter, Path, inside_field
from core.quantities import Unit
from core.sensitivities.figure import figure_of
from core.sensitivities.sensitivities import Inputs, sensitivities
from core.systems.budget import Budget
from service.requests.annotations import ANNOTATED
from service.requests.declared_units import has_field
from service.requests.figures import SensitivitiesQuestion
from service.requests.request_reader import Limits, Reader
from service.routes.assessments.route_source import RouteSource
from service.routing import Answer, PostRoute, never
from service.schemas import Request, View

OUTPUT, OTHER = "sensitivities", "other"
"""Members of the union of outputs."""
OWN_UNIT = Unit("as in the field unit")


class SensitivitiesOutput(Request):
    """Derivatives of figures of the answer by numbers of the request; without other outputs, those are the default."""

    sensitivities: SensitivitiesQuestion


class FigureSensitivity(View):
    """The derivative of a figure of the answer by a number of the request."""

    of: str | dict[str, Any] = Field(description="As in the request.")
    to: str = Field(description="As in the request.")
    value: Annotated[float | list[float | list[float]], OWN_UNIT] = Field(description="Of the figure's shape.")
    error: Annotated[float, OWN_UNIT] = Field(
        description="Estimate of the largest error of any entry: what extrapolation leaves, and the error of the "
        "figure divided by the step."
    )
    unit: str = Field(description="Of the figure by that of the number; where that declares none, it is named.")


def _kind(output: Any) -> str:
    """Return which member of the union of outputs an output is."""
    wanted = isinstance(output, SensitivitiesOutput) or (isinstance(output, Mapping) and OUTPUT in output)
    return OUTPUT if wanted else OTHER


def _asked(question: Any) -> dict[int, Any]:
    """Return the outputs of a question that are derivatives, by their places."""
    return {k: output for k, output in enumerate(question.outputs or ()) if _kind(output) == OUTPUT}


class WithSensitivities(Request):
    """What a question that may ask for derivatives has besides its fields."""

    _document: bytes = PrivateAttr(b"")
    _wanted: dict[int, SensitivitiesQuestion] = PrivateAttr({})

    def with_document(self, document: bytes) -> Self:
        """Return the question with the document that it was read from, if it asks for derivatives."""
        asked = _asked(self)
        if asked:
            self._document = document
            self._wanted = {k: _checked(output, k) for k, output in asked.items()}
        return self


def _checked(output: Any, index: int) -> SensitivitiesQuestion:
    """Return which derivatives an output asks for, or raise `ValidationError` with its place in the request."""
    if isinstance(output, SensitivitiesOutput):
        return output.sensitivities
    try:
        return SensitivitiesOutput.model_validate(output, strict=True).sensitivities
    except ValidationError as error:
        found: list[Any] = [
            {name: fault[name] for name in ("type", "input", "ctx") if name in fault}
            | {"loc": ("outputs", index, *fault["loc"])}
            for fault in error.errors()
        ]
        raise ValidationError.from_exception_data(error.title, found) from None


def with_sensitivities(route: PostRoute) -> PostRoute:
    """Return a route whose questions may ask for derivatives of figures of their answers."""
    reader = Reader[Any](route.question, Limits(10**4, 10**9, 10**9, 10**9), route.elsewhere)

    def handle(question: Any, budget: Budget) -> Answer:
        asked = _asked(question)
        if not asked:
            return route.handle(question, budget)
        if not question._document:
            place = ("outputs", next(iter(asked)))
            raise InvalidParameter(place, "be part of a request in JSON", remedy="send application/json")
        own = [output for k, output in enumerate(question.outputs) if k not in asked]
        answer = route.handle(question.model_copy(update={"outputs": own or None}), budget)
        request = json.loads(question._document)
        outputs = [output for k, output in enumerate(request.pop("outputs")) if k not in asked]
        inputs = Inputs(RouteSource(route, reader.read, budget), request | ({"outputs": outputs} if outputs else {}))
        return answer | {OUTPUT: [view for k in asked for view in _derivatives(inputs, question._wanted[k], k)]}

    return replace(
        route,
        question=_question_model(route.question),
        answer=_answer_model(route.answer),
        handle=handle,
        # Where no question is small, the server process loads none of its kernels.
        small=never if route.small is never else lambda question: not _asked(question) and route.small(question),
    )


def _question_model(question: Any) -> type[Request]:
    """Return a question's model whose outputs may be derivatives, too."""
    made: type[Request]
    own = question.model_fields.get("outputs")
    if has_field(question, "outputs", 0, OUTPUT):
        # Its outputs are documented there, and checked by who reads them.
        made = create_model(question.__name__, __base__=(WithSensitivities, question), __doc__=question.__doc__)
        return made
    outputs: Any = list[SensitivitiesOutput]
    field = Field(default=None, min_length=1, description="What to answer besides the figures.")
    if own is not None:
        inner = get_args(get_args(own.annotation)[0])[0]
        # Built by calls, because a type made of what is only known here is no type to the checker.
        other: Any = ANNOTATED[inner, Tag(OTHER)]
        derivatives: Any = Annotated[SensitivitiesOutput, Tag(OUTPUT)]
        either: Any = ANNOTATED[other | derivatives, Discriminator(_kind)]
        outputs = list.__class_getitem__(either)
        field = copy(own)
    made = create_model(
        question.__name__,
        __base__=(WithSensitivities, question),
        __doc__=question.__doc__,
        __module__=question.__module__,
        outputs=(outputs | None, field),
    )
    return made


def _answer_model(answer: Any) -> type[View]:
    described = Field(default=None, description="By figure, then by number; there if they are requested.")
    made: type[View] = create_model(
        answer.__name__,
        __base__=answer,
        __doc__=answer.__doc__,
        __module__=answer.__module__,
        sensitivities=(list[FigureSensitivity] | None, described),
    )
    return made


def _derivatives(inputs: Inputs, wanted: SensitivitiesQuestion, index: int) -> list[Answer]:
    """Return the derivatives that an output asks for, as they are answered."""
    with inside_field("outputs", index, OUTPUT):
        of = [figure_of(figure, ("of", i)) for i, figure in enumerate(wanted.of)]
        to = [_place(pointer, ("to", j)) for j, pointer in enumerate(wanted.to)]
        found = sensitivities(inputs, of, to)
    names = [(given, pointer) for given in wanted.of for pointer in wanted.to]
    return [
        {"of": given, "to": pointer, "value": one.value, "error": one.error, "unit": one.unit}
        for (given, pointer), one in zip(names, found, strict=True)
    ]


def _place(pointer: str, path: Path) -> Path:
    try:
        return steps_of(pointer)
    except InvalidParameter:
        raise InvalidParameter(path, "be a JSON pointer into the request", remedy='such as "/let/g"') from None
