"""Core's dataclasses as forms whose numbers may be decimal strings: what a question to any number of digits is made of.

A JSON number is the double that it is parsed to; a string is the decimal number that it says. The forms check form;
core builds exact objects from what was given, and checks meaning.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import MISSING, dataclass, fields, is_dataclass
from fractions import Fraction
from functools import cache
from types import UnionType
from typing import Annotated, Any, ForwardRef, Union, get_args, get_origin, get_type_hints

from pydantic import BaseModel, Field, create_model

from core.bodies import Body
from core.bodies.composite import Composite, Count, Part
from core.bodies.measured import InertiaTensor, PointMasses, PrincipalMoments
from core.certified.decimals import FEWEST_DIGITS, MOST_DIGITS
from core.certified.exact_bodies import UNIFORM, exact_body
from core.certified.exact_inputs import LONGEST_NUMERAL, NUMERAL, evenly_spaced, exact, exact_numbers
from core.certified.exact_mass import ExactMass
from core.errors import BudgetExceeded, InvalidParameter, NotApplicable
from core.quantities import Quantity, TaggedBy, members_of
from core.rows import Rows
from service.schemas import ObjectOrArray, Request

DigitCount = Annotated[
    int,
    Field(
        ge=FEWEST_DIGITS,
        le=MOST_DIGITS,
        description="Significant digits of every number of the answer, computed in ball arithmetic and written as "
        "decimal strings. Numbers of the question are exact: doubles, or decimal strings.",
    ),
]


ANY_BODY = "AnyBodyInNumerals"
"""Name by which the form of a part refers to the forms of all bodies, of which it is itself a piece."""


@dataclass(frozen=True)
class Numeral:
    """Mark of a number that may be given as a decimal string; its range is checked where it is exact."""

    quantity: Quantity

    def __get_pydantic_core_schema__(self, source: Any, handler: Any) -> dict[str, Any]:
        return {
            "type": "union",
            "mode": "left_to_right",
            "choices": [
                {"type": "float", "strict": True, "allow_inf_nan": False},
                {"type": "str", "strict": True, "max_length": LONGEST_NUMERAL, "pattern": f"^(?:{NUMERAL})$"},
            ],
            "custom_error_type": "numeral",
            "custom_error_message": "must be a finite number, or a decimal string of at most "
            f'{LONGEST_NUMERAL} characters, for example "0.1" or "6.02e23"',
        }

    def __get_pydantic_json_schema__(self, schema: Any, handler: Any) -> dict[str, Any]:
        text = {"type": "string", "format": "decimal", "maxLength": LONGEST_NUMERAL, "pattern": f"^(?:{NUMERAL})$"}
        return {"anyOf": [{"type": "number", **self.quantity.limits}, text], "x-unit": self.quantity.unit}


@dataclass(frozen=True)
class OneOrMany:
    """Mark of one number for all or a list with one for each; core tells them apart."""

    rows: Rows

    def __get_pydantic_core_schema__(self, source: Any, handler: Any) -> dict[str, Any]:
        return {"type": "any"}

    def __get_pydantic_json_schema__(self, schema: Any, handler: Any) -> dict[str, Any]:
        one = Numeral(self.rows.quantity).__get_pydantic_json_schema__(schema, handler)
        many = {"type": "array", "items": one, "minItems": self.rows.at_least, "maxItems": self.rows.at_most}
        return {"anyOf": [one, many]}


def in_numerals(hint: Any) -> Any:
    """Return the annotation of a field of core with every real number in it as a `Numeral`."""
    origin, parts = get_origin(hint), get_args(hint)
    if origin is Annotated:
        for mark in parts[1:]:
            if isinstance(mark, TaggedBy):
                return ForwardRef(ANY_BODY)
            if isinstance(mark, Count):
                bounds = Field(min_length=mark.at_least, max_length=mark.at_most)
                return _annotated(list.__class_getitem__(decimal_model_for(get_args(parts[0])[0])), bounds)
            if isinstance(mark, Quantity) and parts[0] is float:
                return _annotated(float | str, Numeral(mark))
            if isinstance(mark, Rows):
                row = tuple.__class_getitem__((in_numerals(_annotated(float, mark.quantity)),) * mark.width)
                bounds = Field(min_length=mark.at_least, max_length=mark.at_most)
                return _annotated(list.__class_getitem__(row), bounds)
        return hint
    if origin is tuple:
        return tuple.__class_getitem__(tuple(map(in_numerals, parts)))
    if origin in (Union, UnionType):
        many = [mark for part in parts for mark in getattr(part, "__metadata__", ()) if isinstance(mark, Rows)]
        return _annotated(Any, OneOrMany(many[0])) if many else Union.__getitem__(tuple(map(in_numerals, parts)))
    return decimal_model_for(hint) if isinstance(hint, type) and is_dataclass(hint) else hint


def _annotated(bare: Any, mark: Any) -> Any:
    return Annotated.__class_getitem__((bare, mark))  # type: ignore[attr-defined]


def fields_in_numerals(cls: Any) -> dict[str, Any]:
    """Return the fields of a dataclass of core as those of a pydantic model, numbers as numerals."""
    hints = get_type_hints(cls, include_extras=True)
    return {
        entry.name: (in_numerals(hints[entry.name]), ... if entry.default is MISSING else entry.default)
        for entry in fields(cls)
    }


@cache
def decimal_model_for(cls: type[Any]) -> type[Request]:
    """Return the form of a dataclass of core."""
    own = fields_in_numerals(cls)
    if "kind" in own:
        own["kind"] = (own["kind"][0], ...)
    made: type[Request] = create_model(f"{cls.__name__}InNumerals", __base__=Request, __doc__=cls.__doc__, **own)
    return made


def explicit_fields(form: BaseModel, *left_out: str) -> Mapping[str, Any]:
    """Return what a client gave, without defaults, which are doubles, and without some fields."""
    return form.model_dump(exclude_unset=True, exclude=set(left_out))


def _bodies() -> Any:
    """Return the union of the forms of bodies that can be summed exactly: all but meshes."""
    members = (PrincipalMoments, InertiaTensor, PointMasses, *UNIFORM.values(), Composite)
    forms = tuple(decimal_model_for(member) for member in members_of(Body) if member in members)
    union = _annotated(Union.__getitem__(forms), Field(discriminator="kind"))
    # A composite holds parts and a part any body, composites among them.
    decimal_model_for(Part).model_rebuild(_types_namespace={ANY_BODY: union})
    decimal_model_for(Composite).model_rebuild()
    return union


BodyInNumerals: Any = _bodies()
RateInNumerals = Annotated[float | str, Numeral(Quantity("rad s^-1"))]
AngularVelocityInNumerals = tuple[RateInNumerals, RateInNumerals, RateInNumerals]
_Pure = Annotated[float | str, Numeral(Quantity("1"))]
QuaternionInNumerals = tuple[_Pure, _Pure, _Pure, _Pure]
EnergyInNumerals = Annotated[float | str, Numeral(Quantity("J", above=0))]
TimeInNumerals = Annotated[float | str, Numeral(Quantity("s"))]


class SpanInNumerals(Request):
    """Times at exactly equal distances, both ends included."""

    start: TimeInNumerals
    stop: TimeInNumerals
    count: int = Field(ge=1, le=10**9)


TimesInNumerals = Annotated[
    SpanInNumerals | Annotated[list[TimeInNumerals], Field(min_length=1)],
    ObjectOrArray(),
]
"""Times from the given state, of either sign, in any order."""


def body_of(body: BaseModel) -> ExactMass:
    """Return a question's body; faults are told as seen from the question."""
    try:
        return exact_body(explicit_fields(body))
    except InvalidParameter as fault:
        raise fault.inside("body") from None
    except NotApplicable as fault:
        raise NotApplicable(fault.detail, path=("body", *fault.path), remedy=fault.remedy) from None
    except BudgetExceeded as fault:
        fault.path = ("body", *fault.path)
        raise


def instants(times: SpanInNumerals | list[float | str]) -> tuple[Fraction, ...]:
    """Return the times of a question as the rational numbers that they are."""
    if isinstance(times, list):
        return exact_numbers(times, ("times",))
    start, stop = exact(times.start, ("times", "start")), exact(times.stop, ("times", "stop"))
    return evenly_spaced(start, stop, times.count)
