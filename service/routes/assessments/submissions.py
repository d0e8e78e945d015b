"""Submissions in the documentation; each is read by itself, so that a bad one spoils no other."""

from __future__ import annotations

from typing import Any

from pydantic import Field, TypeAdapter

from core.assessment.claims import LONGEST_TEXT, MOST_CLAIMS, array_of
from core.assessment.typed_entry import LONGEST_ENTRY
from core.formulas import LONGEST_FORMULA
from service.schemas import View


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
    text: str | None = Field(
        default=None, max_length=LONGEST_ENTRY, description="In place of value and formula: what somebody typed, such "
        "as 6,28 s or 2*pi s or 3·10² N. What can be read in two ways is a format error; see locale."
    )  # fmt: skip
    times: list[float] | None = Field(
        default=None, description="Of the samples in value or in the list of text, at any times (s)."
    )


class SubmissionList:
    """Any entries, documented as submissions: each is read and refused by itself."""

    @classmethod
    def __get_pydantic_core_schema__(cls, source: Any, handler: Any) -> dict[str, Any]:
        anything = {"type": "any", "metadata": {"arrays_within": True}}
        entry = {
            "type": "function-after",
            "function": {"type": "no-info", "function": _with_arrays},
            "schema": anything,
        }
        return {"type": "list", "items_schema": entry, "min_length": 1, "max_length": 5000}

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


def _with_arrays(submission: Any) -> Any:
    """Return a submission with arrays for its lists of numbers, each made while its list is still at hand."""
    for claim in submission.values() if type(submission) is dict else ():
        for name in ("value", "times") if type(claim) is dict else ():
            if type(claim.get(name)) is list:
                array = array_of(claim[name])
                claim[name] = claim[name] if array is None else array
    return submission
