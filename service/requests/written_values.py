"""Values of a description as the form of a question shows them: numbers, vectors and occasions, which core reads."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from decimal import Decimal
from fractions import Fraction
from functools import reduce
from operator import or_
from types import NoneType, UnionType
from typing import Annotated, Any, Literal, Union, get_args, get_origin

from pydantic import Field, SkipValidation

from core.multibody.language.connection import Occasion
from core.multibody.language.occasions import MOST_COUNTED
from core.multibody.language.units import LONGEST_UNIT
from core.multibody.trajectory.occurrences import MOST_FOUND
from service.requests.annotations import ANNOTATED
from service.schemas import Request


class NumberInUnit(Request):
    """An angle in degrees, or a number in a unit of its own, which are converted exactly."""

    degrees: float | str | None = Field(default=None, description="A decimal, or a formula in quotes; without a unit.")
    value: float | str | None = Field(default=None, description="A decimal, or a formula in quotes; with its unit.")
    unit: str | None = Field(default=None, max_length=LONGEST_UNIT, description='"cm", "kg m^2", "km/h", "rpm", ...')


class PolarVector(Request):
    """A vector of the plane by its length and its direction."""

    polar: list[float | str | NumberInUnit] = Field(
        min_length=2, max_length=2, description="Length, and angle from the first axis (rad)."
    )


class WhenQuestion(Request):
    """A quantity, and the value that it is to take."""

    quantity: str = Field(
        description="A column, such as rod.angle or s.tension; of a vector a component, such as ball.position.x, or "
        "its length, such as ball.velocity.length.",
        max_length=100,
    )
    equals: Annotated[float | str | NumberInUnit, SkipValidation()] = Field(
        description="In the unit of the quantity; a number as those of the description, which may use names of let."
    )
    nth: int | None = Field(
        default=None, ge=1, le=MOST_FOUND, description="Which time after the start; every one if left out."
    )


class EventQuestion(Request):
    """An event of the motion."""

    name: str = Field(max_length=200, description="Of the connection, as events give it.")
    kind: str | None = Field(default=None, max_length=100, description="Of the event; any if left out.")
    nth: int | None = Field(default=None, ge=1, le=MOST_COUNTED, description="Which of them; the first if left out.")


class TimeOrOccasion(NumberInUnit):
    """A time in a unit of its own, or an occasion of the motion."""

    event: EventQuestion | None = Field(default=None, description="The time at which it happens.")
    when: WhenQuestion | None = Field(default=None, description="The time at which a quantity takes a value.")


class PolarOrOccasion(TimeOrOccasion):
    """A vector by its length and its direction, or what a time may be."""

    polar: list[float | str | NumberInUnit] | None = Field(
        default=None, min_length=2, max_length=2, description=PolarVector.model_fields["polar"].description
    )


WIDER: Mapping[frozenset[Any], Any] = {
    frozenset({NumberInUnit, TimeOrOccasion}): TimeOrOccasion,
    frozenset({NumberInUnit, PolarVector, TimeOrOccasion}): PolarOrOccasion,
}
"""What stands for objects of several kinds: a union of them has nothing by which they are told apart."""


def _form(hint: Any) -> Any:
    """Return a type of the language as the form of a question shows it: without the numbers that only Python has."""
    if hint is Occasion:
        return TimeOrOccasion
    origin, parts = get_origin(hint), get_args(hint)
    if origin is Sequence:
        return list.__class_getitem__(_form(parts[0]))
    if origin is Mapping:
        return dict.__class_getitem__((str, Any if parts[1] is Any else _form(parts[1])))
    if not parts or origin is Literal:
        return hint
    shown = [part for part in parts if part not in (NoneType, Decimal, Fraction, int, Mapping[str, Any])]
    if not shown:
        return dict[str, Any]
    if Mapping[str, Any] in parts:
        # What may be a number or a vector is turned about an axis: polar vectors are places, and what may be a list of
        # names an object of its own.
        other = Mapping[str, Any] if Sequence[str] in parts else PolarVector
        shown.append(NumberInUnit if float in parts else other)
    return reduce(or_, map(_form, shown))


def _alternatives(form: Any) -> tuple[Any, ...]:
    return get_args(form) if get_origin(form) in (Union, UnionType) else (form,)


def read_by_core(*hints: Any) -> Any:
    """Return the type of a value that core checks, and that may be of each of some types; the document shows it."""
    shown = [part for form in map(_form, hints) for part in _alternatives(form)]
    # Two kinds of connection may share a field, each with words of its own.
    words = dict.fromkeys(word for part in shown if get_origin(part) is Literal for word in get_args(part))
    if words:
        shown = [*(part for part in shown if get_origin(part) is not Literal), Literal.__getitem__(tuple(words))]
    objects = frozenset(part for part in shown if part in (NumberInUnit, PolarVector, TimeOrOccasion))
    if objects in WIDER:
        shown = [*(part for part in shown if part not in objects), WIDER[objects]]
    return ANNOTATED[reduce(or_, shown), SkipValidation()]  # type: ignore[type-arg]
