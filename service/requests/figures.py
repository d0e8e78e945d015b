"""Figures as requests name them: by pointer, an event, or a count; core reads them."""

from __future__ import annotations

from typing import Annotated

from pydantic import Field, SkipValidation

from core.sensitivities.sensitivities import MOST_FIGURES, MOST_INPUTS
from service.schemas import Request


class NamedEvent(Request):
    """Which event."""

    kind: str = Field(description="As in the answer: touch, slip, release.")
    name: str | None = Field(default=None, description="Of the connection; of any one if left out.")
    nth: int = Field(default=1, ge=1, description="Which one of these, in the order of the answer.")


class FigureOfAList(Request):
    """A figure that does not stand at one place of the answer: one of its fields is given."""

    event: NamedEvent | None = Field(
        default=None, description="The time of an event, wherever it stands in the list of events."
    )
    count: str | None = Field(default=None, description="How many entries the list at this JSON pointer has.")


WrittenFigure = Annotated[str | FigureOfAList, SkipValidation()]
"""A JSON pointer into the answer, such as ``"/period"``, or one of the objects."""


class SensitivitiesQuestion(Request):
    """Which derivatives."""

    of: list[WrittenFigure] = Field(
        min_length=1, max_length=MOST_FIGURES, description="Numbers, or arrays of numbers, of the answer."
    )
    to: list[str] = Field(
        min_length=1, max_length=MOST_INPUTS, description="JSON pointers to numbers of the request: /let/g, /times/0."
    )
