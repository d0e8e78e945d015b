"""What is submitted: claims about figures of an answer, each read by itself, so that a bad one spoils no other."""

from __future__ import annotations

from dataclasses import dataclass
from itertools import chain
from math import isfinite
from typing import Any

import numpy as np
from pydantic import Field, TypeAdapter

from core.assessment.formulas import LONGEST_FORMULA
from core.errors import Path
from core.systems.system import Floats
from service.problems import Fault, pointer_of
from service.requests.suggestions import nearest
from service.schemas import View

MOST_CLAIMS = 100
"""Figures in one submission."""
LONGEST_POINTER = 200
LONGEST_TEXT = 200
"""Characters of a choice or a unit."""


class ClaimDocument(View):
    """A claim about one figure of the answer."""

    value: Any = Field(
        default=None,
        description="Number, vector, matrix, quaternion [w, x, y, z], set, true, false or string, as the figure is; "
        "null claims that there is no such figure.",
    )
    unit: str | None = Field(
        default=None, max_length=LONGEST_TEXT, description="Such as deg, rpm, Hz, cm or hours; needed but for pure "
        "numbers and angles in radians."
    )  # fmt: skip
    formula: str | None = Field(
        default=None, max_length=LONGEST_FORMULA, description="In place of a value: in the names of the question's "
        "parameters, with + - * / ^ ( ), pi and functions such as sqrt, sin, atan."
    )  # fmt: skip
    times: list[float] | None = Field(
        default=None, description="Of the samples in value, at any times (s); of a column of samples."
    )


class SubmissionList:
    """Any entries, documented as submissions: each is read and refused by itself."""

    @classmethod
    def __get_pydantic_core_schema__(cls, source: Any, handler: Any) -> dict[str, Any]:
        return {"type": "list", "items_schema": {"type": "any"}, "min_length": 1, "max_length": 5000}

    @classmethod
    def __get_pydantic_json_schema__(cls, schema: Any, handler: Any) -> dict[str, Any]:
        entry: dict[str, Any] = TypeAdapter(ClaimDocument).json_schema()
        entry["properties"]["times"]["anyOf"][0]["items"]["x-unit"] = "s"
        submission = {
            "type": "object",
            "title": "Submission",
            "description": "Claims by JSON pointer into the answer of the question.",
            "additionalProperties": entry,
            "maxProperties": MOST_CLAIMS,
        }
        return {"type": "array", "items": submission, "minItems": 1, "maxItems": 5000}


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
        In place of a value.
    """

    value: Any
    unit: str | None
    times: Floats | None
    formula: str | None = None


class Unreadable(Exception):
    """A claim that has not the form of one."""

    def __init__(self, detail: str, *path: str | int, remedy: str | None = None) -> None:
        super().__init__(detail)
        self.detail, self.path, self.remedy = detail, path, remedy

    def fault(self, within: Path) -> Fault:
        """Return the fault as it is written, by its pointer into the document that was sent."""
        return Fault(pointer_of((*within, *self.path)), self.detail, self.remedy)


KEYS = ("value", "unit", "times", "formula")


def read_claim(entry: Any) -> Claim:
    """Return the claim that a JSON value states.

    Raises
    ------
    Unreadable
        With the path to what is wrong, from the claim.
    """
    if not isinstance(entry, dict):
        raise Unreadable("must be an object", remedy='write {"value": 4.9, "unit": "s"}')
    for key in entry:
        if key not in KEYS:
            near = nearest(key, KEYS) if len(key) <= LONGEST_TEXT else None
            remedy = f"did you mean {near}?" if near else f"known here: {', '.join(KEYS)}"
            raise Unreadable("is not known here", *((key,) if len(key) <= 40 else ()), remedy=remedy)
    unit = entry.get("unit")
    if unit is not None and (type(unit) is not str or len(unit) > LONGEST_TEXT):
        raise Unreadable(f"must be a string of at most {LONGEST_TEXT} characters", "unit")
    times, formula = entry.get("times"), entry.get("formula")
    if formula is not None:
        if type(formula) is not str or len(formula) > LONGEST_FORMULA:
            raise Unreadable(f"must be a string of at most {LONGEST_FORMULA} characters", "formula")
        if "value" in entry or times is not None:
            raise Unreadable("must be left out beside a value or times", "formula")
        return Claim(None, unit, None, formula)
    if "value" not in entry:
        raise Unreadable("is required", "value")
    if times is not None:
        times = _value(times, "times")
        if not isinstance(times, np.ndarray) or times.ndim != 1:
            raise Unreadable("must be an array of numbers", "times")
    value = _value(entry["value"], "value")
    if times is not None and (not isinstance(value, np.ndarray) or len(value) != len(times)):
        raise Unreadable(f"must have {len(times)} entries, one for each time", "value")
    return Claim(value, unit, times)


def _value(value: Any, name: str) -> Any:
    kind = type(value)
    if kind is float or kind is int:
        try:
            number = float(value)
        except OverflowError:
            number = float("inf")
        if not isfinite(number):
            raise Unreadable("must be finite", name)
        return number
    if value is None or kind is bool:
        return value
    if kind is str:
        if len(value) > LONGEST_TEXT:
            raise Unreadable(f"must have at most {LONGEST_TEXT} characters", name)
        return value
    if kind is list:
        return _array(value, name)
    raise Unreadable("must be a number, an array of numbers, a string, true, false or null", name)


NUMBERS = {float, int}


def _array(value: list[Any], name: str) -> Floats:
    rows = value if value and type(value[0]) is list else [value]
    plain = {*map(type, rows)} == {list} and len({*map(len, rows)}) == 1 and rows[0] != []
    if not plain or not {*map(type, chain.from_iterable(rows))} <= NUMBERS:
        raise _fault(value, rows, name)
    try:
        array = np.array(value, dtype=np.float64)
    except OverflowError:
        raise Unreadable("must be within the range of doubles", name) from None
    if not np.isfinite(array).all():
        raise Unreadable("must have finite entries", name)
    return array


def _fault(value: list[Any], rows: list[Any], name: str) -> Unreadable:
    """Return the first thing that is wrong with rows of which something is."""
    length = len(rows[0])
    for i, row in enumerate(rows):
        place = (name, i) if rows is value else (name,)
        if type(row) is not list or len(row) != length or not row:
            return Unreadable(f"must be an array of {length or 'some'} numbers, as the first row is", *place)
        for j, number in enumerate(row):
            if type(number) not in NUMBERS:
                return Unreadable("must be a number", *place, j)
    return Unreadable("must be an array of numbers", name)
