"""Units of the fields of a description, as their types declare them, and the check of numbers that have another."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from decimal import Decimal
from functools import cache
from typing import Any, Protocol, get_args, get_type_hints, runtime_checkable

from core.errors import InvalidParameter, Path
from core.multibody.language.units import unit_of

PLAIN = frozenset({type(None), int, float, Decimal, str})
"""Types of what is written without a unit, which is then that of its field."""


@runtime_checkable
class DeclaredUnit(Protocol):
    """What the type of a field is annotated with."""

    def check(self, value: object, path: Path, measure: object) -> None:
        """Raise `InvalidParameter` for a number whose unit the field cannot have."""

    def unit_at(self, path: Path, measure: object) -> str | None:
        """Return the unit of the number at a path within the field, None where none is declared."""


@dataclass(frozen=True)
class Measured:
    """The unit of a number, and of every number of a vector or list.

    Attributes
    ----------
    unit : str
    of_turn : str, optional
        The unit where the `measure` of the connection is "turn".
    """

    unit: str
    of_turn: str | None = None

    def check(self, value: object, path: Path, measure: object) -> None:
        """See `DeclaredUnit.check`; in polar form the second number is an angle."""
        if is_plain(value):
            return
        if isinstance(value, Mapping) and set(value) == {"value", "unit"}:
            self._check_unit(value["unit"], (*path, "unit"), measure)
        elif isinstance(value, Mapping) and set(value) == {"degrees"}:
            self._check_unit("deg", (*path, "degrees"), measure)
        elif isinstance(value, Mapping) and set(value) == {"polar"}:
            polar = value["polar"]
            if isinstance(polar, Sequence) and len(polar) == 2:
                self.check(polar[0], (*path, "polar", 0), measure)
                Measured("rad").check(polar[1], (*path, "polar", 1), measure)
        elif isinstance(value, Sequence) and not isinstance(value, str):
            for i, entry in enumerate(value):
                self.check(entry, (*path, i), measure)

    def unit_at(self, path: Path, measure: object) -> str | None:
        """See `DeclaredUnit.unit_at`."""
        if path[:2] == ("polar", 1):
            return "rad"
        return self._own(measure)

    def _own(self, measure: object) -> str:
        return self.of_turn if self.of_turn is not None and measure == "turn" else self.unit

    def _check_unit(self, written: object, where: Path, measure: object) -> None:
        unit, own = self._own(measure), unit_of(written, where)
        # An angle has no dimension, and yet is no plain number such as a coefficient of friction.
        if own.dimension != unit_of(unit, where).dimension or (unit == "1" and own.turns):
            raise InvalidParameter(
                where,
                f'be a unit of {unit}, unlike "{written}"',
                remedy=f"give the number in {unit}, or in another unit of its dimension",
            )


@dataclass(frozen=True, eq=False)
class Members:
    """The units of the members of an object.

    Attributes
    ----------
    units : mapping of str to str
        By member; those that are not here are no numbers.
    """

    units: Mapping[str, str]

    def check(self, value: object, path: Path, measure: object) -> None:
        """See `DeclaredUnit.check`."""
        if isinstance(value, Mapping):
            for name in (name for name in value if name in self.units):
                Measured(self.units[name]).check(value[name], (*path, name), measure)

    def unit_at(self, path: Path, measure: object) -> str | None:
        """See `DeclaredUnit.unit_at`."""
        unit = self.units.get(str(path[0])) if path else None
        return None if unit is None else Measured(unit).unit_at(path[1:], measure)


@dataclass(frozen=True)
class Named:
    """One unit of all numbers of an object whose names are the client's.

    Attributes
    ----------
    unit : str
    """

    unit: str

    def check(self, value: object, path: Path, measure: object) -> None:
        """See `DeclaredUnit.check`."""
        if isinstance(value, Mapping):
            for name, entry in value.items():
                Measured(self.unit).check(entry, (*path, name), measure)

    def unit_at(self, path: Path, measure: object) -> str | None:
        """See `DeclaredUnit.unit_at`."""
        return Measured(self.unit).unit_at(path[1:], measure)


def check_units(part: Any, path: Path) -> None:
    """Raise `InvalidParameter` for a number of a body or connection, or of the whole, whose unit its field cannot have.

    Parameters
    ----------
    part : dataclass
    path : Path
        Where it is in the description.
    """
    measure = getattr(part, "measure", None)
    for name, declared in declared_units(type(part)).items():  # type: ignore[arg-type]
        value = getattr(part, name)
        if not is_plain(value):
            # A word of Python's has a sign behind it as the name of a field.
            declared.check(value, (*path, name.rstrip("_")), measure)


def is_plain(value: object) -> bool:
    """Return whether something is written without a unit, or a list of what is."""
    kind = type(value)
    return kind in PLAIN or (isinstance(value, (list, tuple)) and PLAIN.issuperset(map(type, value)))


@cache
def declared_units(cls: type[object]) -> Mapping[str, DeclaredUnit]:
    """Return by field what a dataclass declares; a field without numbers, or of any unit, declares none."""
    hints = get_type_hints(cls, include_extras=True)
    found = {name: next(iter(_within(hint)), None) for name, hint in hints.items()}
    return {name: declared for name, declared in found.items() if declared is not None}


def _within(hint: Any) -> Iterable[DeclaredUnit]:
    """Yield what a type and the types of its parts are annotated with."""
    yield from (mark for mark in getattr(hint, "__metadata__", ()) if isinstance(mark, DeclaredUnit))
    for part in get_args(hint):
        yield from _within(part)
