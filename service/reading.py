"""From the bytes of a request to a question: form is checked here, meaning by the objects of core that are built.

A reader validates JSON bytes in one step (no intermediate Python document). Only when that fails is the document
parsed a second time, to turn the validator's locations into JSON pointers into what the client sent.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from typing import Any, Generic, TypeVar

from pydantic import TypeAdapter, ValidationError
from pydantic_core import SchemaValidator, from_json

from core.errors import InvalidParameter
from service.guards import LONGEST_KEY_SHOWN, require_distinct_keys, require_simple
from service.problems import MOST_FAULTS, Fault, Refusal, code_of, pointer_of

Q = TypeVar("Q")
Step = str | int

OBJECT, ARRAY = "<object>", "<array>"
"""Labels of the members of a union of an object and an array; a fault in the member not meant is dropped."""

TAG = "kind"
"""The field by which the members of every union of core are told apart."""

_RULES: Mapping[str, str] = {
    "missing": "is required",
    "missing_argument": "is required",
    "extra_forbidden": "is not known here",
    "unexpected_keyword_argument": "is not known here",
    "finite_number": "must be finite",
    "float_type": "must be a number",
    "float_parsing": "must be a number",
    "int_type": "must be an integer",
    "int_parsing": "must be an integer",
    "int_parsing_size": "must be an integer of moderate size",
    "int_from_float": "must be an integer",
    "bool_type": "must be true or false",
    "string_type": "must be a string",
    "model_type": "must be an object",
    "model_attributes_type": "must be an object",
    "dataclass_type": "must be an object",
    "dict_type": "must be an object",
    "list_type": "must be an array",
    "tuple_type": "must be an array",
    "greater_than": "must be greater than {gt:g}",
    "greater_than_equal": "must be at least {ge:g}",
    "less_than": "must be less than {lt:g}",
    "less_than_equal": "must be at most {le:g}",
    "literal_error": "must be {expected}",
    "union_tag_invalid": "must have one of these as {discriminator}: {expected_tags}",
    "union_tag_not_found": "must be an object with the key {discriminator}",
    "string_too_long": "must have at most {max_length} characters",
}
_UNKNOWN = ("extra_forbidden", "unexpected_keyword_argument")


class Reader(Generic[Q]):
    """Reads questions of one type.

    Parameters
    ----------
    question : type
        A pydantic model, which may hold dataclasses of core.
    deepest, most_keys : int
        Limits on the document.
    """

    def __init__(self, question: type[Q], *, deepest: int, most_keys: int) -> None:
        schema = _failing_fast(TypeAdapter(question).core_schema)
        # Otherwise the validators that pydantic built with the classes would be taken, which lack the change.
        self._validate = SchemaValidator(schema, _use_prebuilt=False).validate_json
        self._deepest, self._most_keys = deepest, most_keys

    def read(self, body: bytes) -> Q:
        """Return the question that a request's body asks.

        Raises
        ------
        Refusal
            With the pointers of what is wrong.
        """
        require_simple(body, self._deepest, self._most_keys)
        try:
            question: Q = self._validate(body, strict=True)
        except ValidationError as error:
            raise _refusal(error, body) from None
        require_distinct_keys(body)
        return question


def _failing_fast(schema: Any) -> Any:
    """Return a schema in which every array of free length stops at its first bad entry.

    A client is helped by the first faults, and 100 000 of them would cost more than the computation refused.
    """
    if isinstance(schema, Mapping):
        walked = {key: _failing_fast(value) for key, value in schema.items() if key != "metadata"}
        free = schema.get("type") == "tuple" and "variadic_item_index" in schema
        return walked | {"fail_fast": True} if free or schema.get("type") == "list" else walked
    if isinstance(schema, list):
        return [_failing_fast(entry) for entry in schema]
    if isinstance(schema, tuple):
        return tuple(_failing_fast(entry) for entry in schema)
    return schema


def _refusal(error: ValidationError, body: bytes) -> Refusal:
    found = error.errors(include_url=False, include_input=False)
    if found[0]["type"] == "json_invalid":
        # The parser's message gives line and column and quotes nothing.
        return Refusal("invalid-json", str(found[0]["ctx"]["error"]))
    document = from_json(body, allow_inf_nan=True)
    faults: list[Fault] = []
    codes: list[str] = []
    for entry in _without_repetition(found):
        steps = _steps(entry["loc"], document)
        if steps is None:
            continue
        cause = entry.get("ctx", {}).get("error")
        if isinstance(cause, InvalidParameter):
            faults.append(Fault(pointer_of((*steps, *cause.path)), f"must {cause.rule}", cause.remedy))
            codes.append(code_of(cause))
        else:
            faults.append(_fault(entry, steps, document))
            codes.append("invalid-parameter")
        if len(faults) == MOST_FAULTS:
            break
    if not faults:
        # Every fault lay in a member of a union that the client did not mean.
        steps = _resolved(found[0]["loc"], document)
        faults, codes = [Fault(pointer_of(steps), "must be an object or an array")], ["invalid-parameter"]
    code = codes[0] if len(set(codes)) == 1 else "invalid-parameter"
    where = faults[0].pointer or "the document"
    more = f", and {len(faults) - 1} more" if len(faults) > 1 else ""
    return Refusal(code, f"{where} {faults[0].detail}{more}", faults=faults)


def _without_repetition(found: Sequence[Any]) -> Iterator[Any]:
    """Yield the errors, those of the missing entries of one array as a single one that names its length."""
    length: dict[tuple[Step, ...], int] = {}
    for entry in found:
        if entry["type"] == "missing" and isinstance(entry["loc"][-1], int):
            parent = entry["loc"][:-1]
            length[parent] = max(length.get(parent, 0), entry["loc"][-1] + 1)
    for entry in found:
        parent = entry["loc"][:-1]
        if entry["type"] == "missing" and parent in length:
            yield {"type": "short", "loc": parent, "ctx": {"length": length.pop(parent)}}
        elif not (entry["type"] == "missing" and entry["loc"] and isinstance(entry["loc"][-1], int)):
            yield entry


def _fault(entry: Any, steps: tuple[Step, ...], document: Any) -> Fault:
    kind, context = entry["type"], entry.get("ctx", {})
    if kind in _UNKNOWN and len(str(steps[-1])) > LONGEST_KEY_SHOWN:
        return Fault(pointer_of(steps[:-1]), "has a key that is not known here")
    if kind == "short":
        return Fault(pointer_of(steps), f"must have {context['length']} entries, not {len(_at(document, steps))}")
    if kind == "too_short" and context["min_length"] == 1:
        return Fault(pointer_of(steps), "must not be empty")
    if kind in ("too_long", "too_short"):
        bound = f"at most {context['max_length']}" if kind == "too_long" else f"at least {context['min_length']}"
        return Fault(pointer_of(steps), f"must have {bound} entries, not {len(_at(document, steps))}")
    rule = _RULES.get(kind)
    # A rule of our own is worded where it is stated; other messages of the validator quote no input.
    detail = rule.format_map(context) if rule else str(entry["msg"]).removeprefix("Value error, ")
    return Fault(pointer_of(steps), detail)


def _steps(location: Sequence[Step], document: Any) -> tuple[Step, ...] | None:
    """Return a location without the labels of unions, or None for a fault in the member that was not meant."""
    node, steps, tagged = document, [], False
    for step in location:
        if step in (OBJECT, ARRAY):
            if isinstance(node, dict) != (step == OBJECT) or not isinstance(node, (dict, list)):
                return None
            continue
        if isinstance(node, dict) and not tagged and node.get(TAG) == step:
            # The name of the member of a union; it stands once before the steps into that member.
            tagged = True
            continue
        tagged = False
        steps.append(step)
        try:
            node = node[step]
        except (KeyError, IndexError, TypeError):
            # What is missing or not known can only be the last step.
            node = None
    return tuple(steps)


def _resolved(location: Sequence[Step], document: Any) -> tuple[Step, ...]:
    """Return the part of a location before the first union label."""
    steps: list[Step] = []
    for step in location:
        if step in (OBJECT, ARRAY):
            break
        steps.append(step)
    return tuple(steps)


def _at(document: Any, steps: Sequence[Step]) -> Any:
    for step in steps:
        document = document[step]
    return document


__all__ = ["ARRAY", "OBJECT", "Reader"]
