"""What is submitted: claims about figures of an answer, each read by itself, so that a bad one spoils no other."""

from __future__ import annotations

import math
from collections.abc import Collection
from dataclasses import dataclass, replace
from itertools import chain
from typing import Any, Literal

import numpy as np

from core.arrays import Floats
from core.assessment.typed_entry import LONGEST_ENTRY, number_with_unit, typed_entry
from core.assessment.typed_number import Locale
from core.errors import InvalidParameter, Path
from core.formulas import LONGEST_FORMULA, names_in

MOST_CLAIMS = 100
"""Figures in one submission."""
LONGEST_TEXT = 200
"""Characters of a choice or a unit."""

KEYS = ("value", "unit", "times", "formula", "text")
NUMBERS = {float, int}


STABILITY = {
    **dict.fromkeys(("stabil", "stable", "estable"), True),
    **dict.fromkeys(("instabil", "labil", "unstable", "instable", "inestable"), False),
}
"""What is typed of an equilibrium in German, English, French and Spanish; elsewhere these may be words of an answer."""


@dataclass(frozen=True, eq=False)
class Claim:
    """A claim that can be read.

    Attributes
    ----------
    value : float, bool, str, None or ndarray
    unit : str or None
        As it was submitted.
    times : ndarray, shape (n,), or None
        Of samples (s).
    formula : str or None
        In place of a value; beside one that is a word, what the word is as a formula.
    field : {"formula", "text"}
        In which the formula was submitted.
    """

    value: Any
    unit: str | None = None
    times: Floats | None = None
    formula: str | None = None
    field: Literal["formula", "text"] = "formula"

    @classmethod
    def read(cls, entry: Any, locale: Locale | None = None) -> Claim:
        """Return the claim that a JSON value states; arrays in it may be arrays of numpy.

        Parameters
        ----------
        entry : Any
        locale : {"de", "en", "es", "fr"}, optional
            Of who typed a text.

        Raises
        ------
        InvalidParameter
            With the path to what is wrong, from the claim.
        """
        if not isinstance(entry, dict):
            raise InvalidParameter((), "be an object", remedy='write {"value": 4.9, "unit": "s"}')
        if not entry.keys() <= set(KEYS):
            place = next(key for key in entry if key not in KEYS)
            shown = (place,) if len(place) <= 40 else ()
            raise InvalidParameter(shown, "be left out: it is not known here", remedy=f"known here: {', '.join(KEYS)}")
        # An empty field of a form is no unit.
        unit = (_text(entry, "unit", LONGEST_TEXT) or "").strip() or None
        if entry.get("text") is not None:
            return cls._typed(entry, unit, locale)
        formula = _text(entry, "formula", LONGEST_FORMULA)
        if formula is not None:
            if "value" in entry or entry.get("times") is not None:
                raise InvalidParameter("formula", "be left out beside a value or times")
            return cls(None, unit, formula=formula)
        if "value" not in entry:
            raise InvalidParameter("value", "be given")
        return cls._of(_value(entry["value"], "value"), unit, entry, "value")

    @classmethod
    def _of(cls, value: Any, unit: str | None, entry: dict[str, Any], name: str) -> Claim:
        """Return the claim of a value of the field `name`, with the times beside it if there are any."""
        if entry.get("times") is None:
            return cls(value, unit)
        times = _value(entry["times"], "times")
        if not isinstance(times, np.ndarray) or times.ndim != 1:
            raise InvalidParameter("times", "be an array of numbers")
        if not isinstance(value, np.ndarray) or len(value) != len(times):
            raise InvalidParameter(name, f"have {len(times)} entries, one for each time")
        return cls(value, unit, times)

    @classmethod
    def _typed(cls, entry: dict[str, Any], unit: str | None, locale: Locale | None) -> Claim:
        """Return the claim of a text; a unit of its own takes precedence over the one beside it."""
        for other in ("value", "formula"):
            if entry.get(other) is not None:
                raise InvalidParameter(other, "be left out beside a text")
        text = _text(entry, "text", LONGEST_ENTRY) or ""
        try:
            typed = typed_entry(text, locale)
        except InvalidParameter as fault:
            raise fault.inside("text") from None
        if entry.get("times") is not None:
            return cls._of(_value(typed.value, "text"), typed.unit or unit, entry, "text")
        return cls(_value(typed.value, "text"), typed.unit or unit, formula=typed.formula, field="text")

    def as_quantity(self, unit: str, names: Collection[str]) -> Claim:
        """Return the claim with a number and its unit for a typed formula that is their product, such as 60/min.

        Parameters
        ----------
        unit : str
            Of the figure.
        names : collection of str
            Of the question's quantities, which come before units.
        """
        formula = self.formula or ""
        if self.field != "text" or self.unit is not None or names_in(formula) & {*names}:
            return self
        found = number_with_unit(formula, unit)
        return self if found is None else replace(self, value=found[0], unit=found[1], formula=None)

    @property
    def is_phrase(self) -> bool:
        """Whether several words were typed, of which none is meant as a quantity."""
        words = self.value.split() if isinstance(self.value, str) else []
        return len(words) > 1 and all(word.isalpha() for word in words)

    def as_truth(self, path: Path) -> Claim:
        """Return the claim with true or false for a typed word that says so of the field at a path."""
        said = STABILITY.get(self.value.lower()) if path[-1] == "stable" and isinstance(self.value, str) else None
        return self if said is None else replace(self, value=said, formula=None)


def _text(entry: dict[str, Any], name: str, longest: int) -> str | None:
    text = entry.get(name)
    if text is not None and (type(text) is not str or len(text) > longest):
        raise InvalidParameter(name, f"be a string of at most {longest} characters")
    return text


def _value(value: Any, name: str) -> Any:
    kind = type(value)
    if kind is float or kind is int:
        try:
            number = float(value)
        except OverflowError:
            number = float("inf")
        if not math.isfinite(number):
            raise InvalidParameter(name, "be finite")
        return number
    if value is None or kind is bool:
        return value
    if kind is str:
        if len(value) > LONGEST_TEXT:
            raise InvalidParameter(name, f"have at most {LONGEST_TEXT} characters")
        return value
    if kind is list or kind is np.ndarray:
        return _array(value, name)
    raise InvalidParameter(name, "be a number, an array of numbers, a string, true, false or null")


def array_of(value: list[Any]) -> Floats | None:
    """Return a list of numbers, or of equally long lists of them, as an array; None for any other list."""
    if value and type(value[0]) is list:
        if {*map(type, value)} != {list} or len({*map(len, value)}) != 1 or not {*map(type, chain(*value))} <= NUMBERS:
            return None
        shape: tuple[int, ...] = len(value), len(value[0])
        numbers = chain.from_iterable(value)
    else:
        if not {*map(type, value)} <= NUMBERS:
            return None
        shape, numbers = (len(value),), chain(value)
    try:
        return np.fromiter(numbers, np.float64, math.prod(shape)).reshape(shape)
    except OverflowError:
        return np.full(shape, np.inf)


def _array(value: Any, name: str) -> Floats:
    # Arrays of an archive may be read-only, or by columns.
    array = np.array(value, np.float64, order="C") if type(value) is np.ndarray else array_of(value)
    if array is None:
        raise _fault(value, name)
    if not array.size:
        raise InvalidParameter(name, "have entries")
    if not np.isfinite(array).all():
        raise InvalidParameter(name, "have finite entries, within the range of doubles")
    return array


def _fault(value: list[Any], name: str) -> InvalidParameter:
    """Return the first thing that is wrong with rows of which something is."""
    rows = value if type(value[0]) is list else [value]
    length = len(rows[0])
    for i, row in enumerate(rows):
        place = (name, i) if rows is value else (name,)
        if type(row) is not list or len(row) != length or not row:
            return InvalidParameter(place, f"be an array of {length or 'some'} numbers, as the first row is")
        for j, number in enumerate(row):
            if type(number) not in NUMBERS:
                return InvalidParameter((*place, j), "be a number")
    return InvalidParameter(name, "be an array of numbers")
