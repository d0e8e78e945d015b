"""Core's dataclasses as forms whose numbers may be decimal strings: what a question to any number of digits is made of.

A JSON number is the double that it is parsed to; a string is the decimal number that it says. The forms check form;
core builds exact objects from what was given, and checks meaning.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import MISSING, dataclass, fields, is_dataclass
from fractions import Fraction
from functools import cache
from types import UnionType
from typing import Annotated, Any, ForwardRef, Literal, Union, get_args, get_origin, get_type_hints

from pydantic import BaseModel, Field, create_model

from core.bodies.composite import Composite, Count, Part
from core.bodies.exact_bodies import UNIFORM, exact_body
from core.bodies.exact_mass import ExactMass
from core.bodies.measured import InertiaTensor, PointMasses, PrincipalMoments
from core.digits.decimals import FEWEST_DIGITS, MOST_DIGITS
from core.digits.exact_inputs import LONGEST_NUMERAL, NUMERAL, evenly_spaced, exact, exact_numbers
from core.errors import BudgetExceeded, InvalidParameter, NotApplicable, Path
from core.quantities import Quantity, TaggedBy
from core.rows import Rows
from service.requests.annotations import ANNOTATED, UNION
from service.schemas import ObjectOrArray, Request

DigitCount = Annotated[
    int,
    Field(
        ge=FEWEST_DIGITS,
        le=MOST_DIGITS,
        description="Significant digits of every number of the answer. Numbers of the question are taken as exact.",
    ),
]


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
        unit = {"x-unit": self.quantity.unit}
        # A pattern, which would be repeated for each number, has generators make a class of each.
        return {"anyOf": [{"type": "number"} | unit, {"type": "string"} | unit]}


@dataclass(frozen=True)
class OneOrMany:
    """Mark of one number for all or a list with one for each; core distinguishes them."""

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
                return ForwardRef("DecimalBody")
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
        return _annotated(Any, OneOrMany(many[0])) if many else UNION[tuple(map(in_numerals, parts))]
    return decimal_model_for(hint) if isinstance(hint, type) and is_dataclass(hint) else hint


def _annotated(bare: Any, mark: Any) -> Any:
    return ANNOTATED[bare, mark]


def fields_in_numerals(cls: Any) -> dict[str, Any]:
    """Return the fields of a dataclass of core as those of a pydantic model, numbers as numerals."""
    hints = get_type_hints(cls, include_extras=True)
    return {
        entry.name: (in_numerals(hints[entry.name]), ... if entry.default is MISSING else entry.default)
        for entry in fields(cls)
    }


@cache
def decimal_model_for(cls: type[Any]) -> type[Request]:
    """Return the form of a dataclass of core that is no member of a union."""
    made: type[Request] = create_model(
        f"Decimal{cls.__name__}", __base__=Request, __doc__=cls.__doc__, **fields_in_numerals(cls)
    )
    return made


def explicit_fields(form: BaseModel, *left_out: str) -> Mapping[str, Any]:
    """Return what a client gave, without defaults, which are doubles, and without some fields."""
    return form.model_dump(exclude_unset=True, exclude=set(left_out))


def _decimal_body() -> Any:
    """Return the form of every body that can be summed exactly: the fields of all kinds; core checks those of each."""
    members: tuple[Any, ...] = (PrincipalMoments, InertiaTensor, PointMasses, *UNIFORM.values(), Composite)
    kinds: dict[str, list[str]] = {}
    hints: dict[str, Any] = {}
    for member in members:
        for name, (hint, _) in fields_in_numerals(member).items():
            kinds.setdefault(name, []).append(member.kind)
            hints.setdefault(name, hint)
    del hints["kind"]
    own: dict[str, Any] = {
        name: (hint, Field(default=None, description=f"For {', '.join(kinds[name])}.")) for name, hint in hints.items()
    }
    of_kinds = Literal.__getitem__(tuple(kinds["kind"]))
    text = """A body whose numbers may be decimal strings, with the fields of the ordinary body of its kind."""
    kind: Any = (of_kinds, Field(description="As of ordinary bodies; meshes are summed in fixed precision."))
    return create_model("DecimalBody", __base__=Request, __doc__=text, kind=kind, **own)


DecimalBody: Any = _decimal_body()
for _form in (decimal_model_for(Part), DecimalBody):
    _form.model_rebuild(_types_namespace={"DecimalBody": DecimalBody})
DecimalRate = Annotated[float | str, Numeral(Quantity("rad s^-1"))]
DecimalAngularVelocity = tuple[DecimalRate, DecimalRate, DecimalRate]
_Pure = Annotated[float | str, Numeral(Quantity("1"))]
DecimalQuaternion = tuple[_Pure, _Pure, _Pure, _Pure]
DecimalEnergy = Annotated[float | str, Numeral(Quantity("J", above=0))]
DecimalTime = Annotated[float | str, Numeral(Quantity("s"))]


class DecimalSpan(Request):
    """Times at exactly equal distances, both ends included."""

    start: DecimalTime = Field(description="First time.")
    stop: DecimalTime = Field(description="Last time.")
    count: int = Field(ge=1, le=10**9, description="Number of times.")


DecimalTimes = Annotated[DecimalSpan | Annotated[list[DecimalTime], Field(min_length=1)], ObjectOrArray()]
"""Times from the given state, of either sign, in any order."""


def inexact_doubles(value: Any, path: Path = ()) -> Iterator[Path]:
    """Yield the places of the JSON numbers of a question that, as doubles, are not the decimals that they read as."""
    if isinstance(value, BaseModel):
        for name in value.model_fields_set:
            yield from inexact_doubles(getattr(value, name), (*path, name))
    elif isinstance(value, (list, tuple)):
        for i, entry in enumerate(value):
            yield from inexact_doubles(entry, (*path, i))
    elif type(value) is float and Fraction(repr(value)) != Fraction(value):
        yield path


def body_of(body: BaseModel) -> ExactMass:
    """Return a question's body; pointers of faults lead into the question."""
    try:
        return exact_body(explicit_fields(body))
    except InvalidParameter as fault:
        raise fault.inside("body") from None
    except (NotApplicable, BudgetExceeded) as fault:
        fault.path = ("body", *fault.path)
        raise


def instants(times: DecimalSpan | list[float | str]) -> tuple[Fraction, ...]:
    """Return the times of a question as the rational numbers that they are."""
    if isinstance(times, list):
        return exact_numbers(times, ("times",))
    return evenly_spaced(*_ends(times), times.count)


def ends(times: DecimalSpan | list[float | str]) -> tuple[Fraction, Fraction]:
    """Return the earliest and the latest of the times."""
    found = instants(times) if isinstance(times, list) else _ends(times)
    return min(found), max(found)


def _ends(times: DecimalSpan) -> tuple[Fraction, Fraction]:
    return exact(times.start, ("times", "start")), exact(times.stop, ("times", "stop"))
