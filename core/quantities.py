"""Physical quantities: unit and admissible range, each stated once.

The annotations are read by three parties. `check` enforces them wherever an object is built; the service's
validator and its OpenAPI document read the same marks through the two hooks below, which return plain
dictionaries, so that nothing is imported here for their sake. What is computed has a unit alone (`Unit`).
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, fields
from functools import cache
from math import inf, isfinite
from numbers import Real
from types import NoneType, UnionType
from typing import Annotated, Any, Union, get_args, get_origin, get_type_hints

from core.errors import InvalidParameter, Path

RADIANS = "angles are in radians: 30 degrees is 0.5236"


@dataclass(frozen=True)
class Quantity:
    """A real number with an SI unit and an admissible range.

    Parameters
    ----------
    unit : str
        SI unit, ``"1"`` for a pure number.
    above, at_least, at_most, below : float
        Open and closed ends of the range.
    """

    unit: str
    above: float = -inf
    at_least: float = -inf
    at_most: float = inf
    below: float = inf

    def test(self, value: object) -> bool:
        """Return whether `value` is a double inside the range, as nearly every value is."""
        # Infinities fail the strict comparisons and NaN fails all of them.
        return type(value) is float and self.above < value < self.below and self.at_least <= value <= self.at_most

    def check(self, path: Path, value: object) -> None:
        """Raise `InvalidParameter` unless `value` is a finite real number inside the range."""
        if self.test(value):
            return
        if isinstance(value, bool) or not isinstance(value, Real):
            raise InvalidParameter(path, "be a number")
        try:
            number = float(value)
        except OverflowError:
            raise InvalidParameter(path, "be within the range of doubles") from None
        unit = "" if self.unit == "1" else f" {self.unit}"
        if not isfinite(number):
            raise InvalidParameter(path, "be finite")
        remedy = RADIANS if self.unit == "rad" else None
        if number <= self.above:
            raise InvalidParameter(path, f"be greater than {self.above:g}{unit}", remedy=remedy)
        if number < self.at_least:
            raise InvalidParameter(path, f"be at least {self.at_least:g}{unit}", remedy=remedy)
        if number > self.at_most:
            raise InvalidParameter(path, f"be at most {self.at_most:g}{unit}", remedy=remedy)
        if number >= self.below:
            raise InvalidParameter(path, f"be less than {self.below:g}{unit}", remedy=remedy)

    @property
    def limits(self) -> dict[str, float]:
        """The finite ends of the range under their JSON Schema names."""
        ends = {
            "exclusiveMinimum": self.above,
            "minimum": self.at_least,
            "maximum": self.at_most,
            "exclusiveMaximum": self.below,
        }
        return {name: end for name, end in ends.items() if isfinite(end)}

    def __get_pydantic_core_schema__(self, source: Any, handler: Any) -> dict[str, Any]:
        names = {"gt": self.above, "ge": self.at_least, "le": self.at_most, "lt": self.below}
        # The unit is for the words in which a fault is told.
        rest = {name: end for name, end in names.items() if isfinite(end)} | {"metadata": {"unit": self.unit}}
        if source is int:
            return {"type": "int", "strict": True, **rest}
        return {"type": "float", "strict": True, "allow_inf_nan": False, **rest}

    def __get_pydantic_json_schema__(self, schema: Any, handler: Any) -> dict[str, Any]:
        kind = "integer" if schema["type"] == "int" else "number"
        return {"type": kind, **self.limits, "x-unit": self.unit}


@dataclass(frozen=True)
class Unit:
    """The unit of every number in a computed figure; nothing is checked.

    Parameters
    ----------
    unit : str
        SI unit, ``"1"`` for a pure number.
    """

    unit: str

    def __get_pydantic_json_schema__(self, schema: Any, handler: Any) -> dict[str, Any]:
        described: dict[str, Any] = self._on_numbers(handler(schema))
        return described

    def _on_numbers(self, schema: Any) -> Any:
        if isinstance(schema, list):
            return [self._on_numbers(entry) for entry in schema]
        if not isinstance(schema, Mapping):
            return schema
        if schema.get("type") in ("number", "string"):
            return {**schema, "x-unit": self.unit}
        return {key: self._on_numbers(entry) for key, entry in schema.items()}


@dataclass(frozen=True)
class TaggedBy:
    """A closed union of dataclasses told apart by the literal default of one field."""

    field: str

    def __get_pydantic_core_schema__(self, union: Any, handler: Any) -> dict[str, Any]:
        members = {getattr(member, self.field): member for member in members_of(union)}
        choices = {tag: handler.generate_schema(member) for tag, member in members.items()}
        return {"type": "tagged-union", "discriminator": self.field, "choices": choices}


def members_of(union: Any) -> tuple[type, ...]:
    """Return the classes of a union annotation, also of a union with one member, which Python collapses."""
    bare = get_args(union)[0] if get_origin(union) is Annotated else union
    return get_args(bare) if get_origin(bare) in (Union, UnionType) else (bare,)


PureNumber = Annotated[float, Quantity("1")]
Mass = Annotated[float, Quantity("kg", above=0)]
SignedMass = Annotated[float, Quantity("kg")]
SignedDensity = Annotated[float, Quantity("kg m^-3")]
Length = Annotated[float, Quantity("m", above=0)]
LengthOrZero = Annotated[float, Quantity("m", at_least=0)]
Coordinate = Annotated[float, Quantity("m")]
InertiaFactor = Annotated[float, Quantity("1", at_least=0)]
MomentOfInertia = Annotated[float, Quantity("kg m^2", at_least=0)]
InertiaComponent = Annotated[float, Quantity("kg m^2")]
AngularRate = Annotated[float, Quantity("rad s^-1")]
Slope = Annotated[float, Quantity("rad", at_least=0, at_most=1.5707963267948966)]
Time = Annotated[float, Quantity("s")]
Duration = Annotated[float, Quantity("s", above=0)]
Velocity = Annotated[float, Quantity("m s^-1")]
Acceleration = Annotated[float, Quantity("m s^-2", above=0)]
Energy = Annotated[float, Quantity("J", above=0)]
Tolerance = Annotated[float, Quantity("1", above=0, below=1)]
Uncertainty = Annotated[float, Quantity("1", at_least=0, below=1)]

Position = tuple[Coordinate, Coordinate, Coordinate]
AngularVelocity = tuple[AngularRate, AngularRate, AngularRate]
Quaternion = tuple[PureNumber, PureNumber, PureNumber, PureNumber]


def check_value(path: str | Path, hint: Any, value: object) -> None:
    """Enforce the range of one quantity, `hint` being its annotation such as `Tolerance`, on a value that is no field.

    Raises
    ------
    InvalidParameter
        With the path given, and the rule it breaks.
    """
    for quantity in hint.__metadata__:
        quantity.check((path,) if isinstance(path, str) else path, value)


def check(instance: Any) -> None:
    """Enforce every range declared in the annotations of a dataclass instance.

    Raises
    ------
    InvalidParameter
        Naming the field, as a path from `instance`, and the rule it breaks.
    """
    owner: Any = type(instance)
    for name, passes in _tests(owner):
        value = getattr(instance, name)
        if not passes(value):
            # Either at fault, or right in an unusual type: an integer, a list.
            _check((name,), _hints(owner)[name], value)


Test = Callable[[Any], bool]
"""Whether a value is admissible in the commonest way; false means only that it has to be looked at."""


@cache
def _tests(cls: Any) -> tuple[tuple[str, Test], ...]:
    """Return the names of a dataclass's fields that have anything to be checked, each with its test."""
    tests = ((name, _test(hint)) for name, hint in _hints(cls).items())
    return tuple((name, test) for name, test in tests if test is not None)


def _test(hint: Any) -> Test | None:
    """Return the test of an annotation, made once, or None for one that admits everything."""
    origin = get_origin(hint)
    if origin is Annotated:
        marks = [mark for mark in hint.__metadata__ if hasattr(mark, "check")]
        if not marks:
            return None
        return marks[0].test if len(marks) == 1 and hasattr(marks[0], "test") else _never
    if origin is tuple:
        return _test_of_tuple(get_args(hint))
    if origin in (Union, UnionType) and NoneType in get_args(hint):
        inner = [arg for arg in get_args(hint) if arg is not NoneType]
        test = _test(inner[0]) if len(inner) == 1 else None
        return None if test is None else lambda value: value is None or test(value)
    return None


def _never(value: Any) -> bool:
    return False


def _test_of_tuple(args: tuple[Any, ...]) -> Test:
    free, alike = args[-1] is ..., len({*args} - {...}) == 1
    length = len(args)
    if alike and get_origin(args[0]) is Annotated and isinstance(args[0].__metadata__[0], Quantity):
        # Nearly all vectors: one loop, without a call for each number.
        quantity: Quantity = args[0].__metadata__[0]
        above, at_least, at_most, below = quantity.above, quantity.at_least, quantity.at_most, quantity.below

        def numbers(value: Any) -> bool:
            if type(value) is not tuple or not (free or len(value) == length):
                return False
            for entry in value:
                if type(entry) is not float or not (above < entry < below and at_least <= entry <= at_most):
                    return False
            return True

        return numbers
    tests = [_test(arg) for arg in args if arg is not ...]

    def entries(value: Any) -> bool:
        if type(value) is not tuple or not (free or len(value) == length):
            return False
        each = tests * len(value) if free else tests
        return all(test is None or test(entry) for test, entry in zip(each, value, strict=True))

    return entries


@cache
def _hints(cls: Any) -> Mapping[str, Any]:
    hints = get_type_hints(cls, include_extras=True)
    return {field.name: hints[field.name] for field in fields(cls)}


def _check(path: Path, hint: Any, value: Any) -> None:
    origin = get_origin(hint)
    if origin is Annotated:
        for mark in hint.__metadata__:
            if hasattr(mark, "check"):
                mark.check(path, value)
    elif origin is tuple:
        _check_tuple(path, get_args(hint), value)
    elif origin in (Union, UnionType) and NoneType in get_args(hint):
        inner = [arg for arg in get_args(hint) if arg is not NoneType]
        if value is not None and len(inner) == 1:
            _check(path, inner[0], value)


def _check_tuple(path: Path, args: tuple[Any, ...], value: Any) -> None:
    if not isinstance(value, (tuple, list)):
        raise InvalidParameter(path, "be a list")
    expected = args[:1] * len(value) if args[-1] is ... else args
    if len(expected) != len(value):
        raise InvalidParameter(path, f"have {len(expected)} entries, not {len(value)}")
    for i, (hint, entry) in enumerate(zip(expected, value, strict=True)):
        _check((*path, i), hint, entry)
