"""From the bytes of a request to a question: form is checked here, meaning by the objects of core that are built.

A reader validates JSON bytes in one step, without an intermediate Python document. The validator's locations of faults
name members of unions as if they were steps; left out, they are JSON pointers into what the client sent.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from functools import cache, partial
from typing import Any, Generic, TypeVar, get_args

from pydantic import TypeAdapter, ValidationError
from pydantic_core import SchemaValidator

from core.errors import InvalidParameter
from service.guards import LONGEST_KEY_SHOWN, require_distinct_keys, require_simple
from service.problems import MOST_FAULTS, Fault, Refusal, code_of, pointer_of

Q = TypeVar("Q")
Step = str | int

OBJECT, ARRAY = "<object>", "<array>"
"""Labels of the members of a union of an object and an array; a fault in the member not meant is dropped."""

WITHOUT, WITH = "<without>", "<with>"
"""Labels of the two questions that a `ByPresence` tells apart."""

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
    "neither": "must be an object or an array",
    "union_tag_invalid": "must have one of these as {discriminator}: {expected_tags}",
    "union_tag_not_found": "must be an object with the key {discriminator}",
    "string_too_long": "must have at most {max_length} characters",
}
_TYPES = ("model_type", "model_attributes_type", "dataclass_type", "list_type", "tuple_type")
_UNKNOWN = ("extra_forbidden", "unexpected_keyword_argument")


@dataclass(frozen=True)
class Limits:
    """What a document may have: levels of nesting, keys, arrays and objects."""

    nesting: int = 32
    keys: int = 4000
    arrays: int = 150_000


@dataclass(frozen=True)
class ByPresence:
    """Mark of a union of two questions: the second is meant where the document has a key, otherwise the first.

    Attributes
    ----------
    key : str
        Name of a plain ASCII key of the document itself.
    beside : mapping of str to str
        Fields of the first question that the second has not, and why they cannot go with the key.
    remedies : mapping of str to str
        What would mend a fault: by the rule broken in a document without the key; under the key itself, what to give.
    """

    key: str
    beside: Mapping[str, str] = field(default_factory=dict, hash=False)
    remedies: Mapping[str, str] = field(default_factory=dict, hash=False)

    def __get_pydantic_core_schema__(self, union: Any, handler: Any) -> dict[str, Any]:
        without, having = (handler.generate_schema(member) for member in get_args(union))
        return {"type": "tagged-union", "discriminator": self._label, "choices": {WITHOUT: without, WITH: having}}

    def _label(self, document: Any) -> str:
        return WITH if isinstance(document, dict) and self.key in document else WITHOUT

    def advised(self, fault: Fault, having: bool) -> Fault:
        """Return a fault of a document that has the key, or has not, with what would mend it."""
        name = fault.pointer.removeprefix("/")
        if having and name in self.beside and fault.detail == _RULES["extra_forbidden"]:
            return Fault(
                fault.pointer,
                f"cannot go with {self.key}: {self.beside[name]}",
                f"leave out {name} or {self.key}",
            )
        remedy = self.remedies.get(self.key) if having and name == self.key else None
        if not having:
            remedy = self.remedies.get(fault.detail)
        return fault if remedy is None or fault.remedy else Fault(fault.pointer, fault.detail, remedy)

    def in_document(self, body: bytes) -> bool:
        """Return whether the document has the key, building nothing but its value."""
        # Most documents show at once that it is absent; it might also be written with escapes.
        if self.key.encode() not in body and b"\\" not in body:
            return False
        try:
            _having(self.key).validate_json(body)
        except ValidationError:
            return False
        return True


@cache
def _having(key: str) -> SchemaValidator:
    """Return a validator of objects that have a key, whatever else they have."""
    value: Any = {"type": "typed-dict-field", "schema": {"type": "any"}, "required": True}
    schema: Any = {"type": "typed-dict", "fields": {key: value}, "extra_behavior": "ignore"}
    return SchemaValidator(schema)


class Reader(Generic[Q]):
    """Reads questions of one type.

    Parameters
    ----------
    question : type
        A pydantic model, which may hold dataclasses of core; or a union of two that a `ByPresence` tells apart.
    limits : Limits
        On the document.
    advised : callable
        Returns a fault with what would mend it.
    """

    def __init__(
        self, question: type[Q], limits: Limits, advised: Callable[[Fault], Fault] = lambda fault: fault
    ) -> None:
        schema = _failing_fast(TypeAdapter(question).core_schema)
        # Otherwise the validators that pydantic built with the classes would be taken, which lack the change.
        self._validate = SchemaValidator(schema, _use_prebuilt=False).validate_json
        self._tags = _tags_of(schema)
        marks = [mark for mark in getattr(question, "__metadata__", ()) if isinstance(mark, ByPresence)]
        # The discriminator of the union would have the whole document built to look for a key.
        self._told_apart = [
            (
                mark,
                [
                    Reader(member, limits, partial(mark.advised, having=having))
                    for having, member in zip((False, True), get_args(get_args(question)[0]), strict=True)
                ],
            )
            for mark in marks
        ]
        self._advised = advised
        self._deepest, self._most_keys, self._most_arrays = limits.nesting, limits.keys, limits.arrays

    def read(self, body: bytes) -> Q:
        """Return the question that a request's body asks.

        Raises
        ------
        Refusal
            With the pointers of what is wrong.
        """
        for mark, members in self._told_apart:
            meant: Q = members[mark.in_document(body)].read(body)
            return meant
        require_simple(body, self._deepest, self._most_keys, self._most_arrays)
        try:
            question: Q = self._validate(body, strict=True)
        except ValidationError as error:
            raise self._refusal(error) from None
        require_distinct_keys(body)
        return question

    def _refusal(self, error: ValidationError) -> Refusal:
        found = error.errors(include_url=False, include_input=False)
        if found[0]["type"] == "json_invalid":
            # The parser's message gives line and column and quotes nothing.
            return Refusal("invalid-json", str(found[0]["ctx"]["error"]))
        faults, codes = [], set()
        for entry in _of_the_member_meant(_lengths_once(found)):
            steps = self._steps(entry["loc"])
            cause = entry.get("ctx", {}).get("error")
            if isinstance(cause, InvalidParameter):
                fault = Fault(pointer_of((*steps, *cause.path)), f"must {cause.rule}", cause.remedy)
                faults.append(self._advised(fault))
                codes.add(code_of(cause))
            else:
                faults.append(self._advised(_fault(entry, steps)))
                codes.add("invalid-parameter")
            if len(faults) == MOST_FAULTS:
                break
        code = codes.pop() if len(codes) == 1 else "invalid-parameter"
        more = f", and {len(faults) - 1} more" if len(faults) > 1 else ""
        return Refusal(code, f"{faults[0].pointer or 'the document'} {faults[0].detail}{more}", faults=faults)

    def _steps(self, location: Sequence[Step]) -> tuple[Step, ...]:
        """Return a location without the names of members of unions."""
        steps: list[Step] = []
        tags = self._tags.get("", frozenset())
        for step in location:
            if step in (OBJECT, ARRAY):
                continue
            if isinstance(step, str):
                if step in tags:
                    tags = frozenset()
                    continue
                tags = self._tags.get(step, frozenset())
            steps.append(step)
        return tuple(steps)


def _failing_fast(schema: Any) -> Any:
    """Return a schema in which every array of free length stops at its first bad entry.

    A client is helped by the first faults, and 100 000 of them would cost more than the computation refused.
    """
    if isinstance(schema, Mapping):
        walked = {key: _failing_fast(value) for key, value in schema.items() if key != "metadata"}
        free = schema.get("type") == "tuple" and "variadic_item_index" in schema
        return walked | {"fail_fast": True} if free or schema.get("type") == "list" else walked
    if isinstance(schema, (list, tuple)):
        return type(schema)(_failing_fast(entry) for entry in schema)
    return schema


def _tags_of(schema: Any) -> Mapping[str, frozenset[str]]:
    """Return, for each name of a field that holds members of a union, the tags by which they are told apart."""
    definitions: dict[str, Any] = {}
    found: dict[str, set[str]] = {}
    followed: set[tuple[str, str]] = set()

    def gather(node: Any) -> None:
        if isinstance(node, Mapping):
            if "ref" in node:
                definitions[node["ref"]] = node
            for value in node.values():
                gather(value)
        elif isinstance(node, (list, tuple)):
            for value in node:
                gather(value)

    def walk(node: Any, field: str) -> None:
        if isinstance(node, (list, tuple)):
            for value in node:
                walk(value, field)
        if not isinstance(node, Mapping):
            return
        kind = node.get("type")
        if kind == "definition-ref":
            reference = node["schema_ref"]
            if (reference, field) not in followed and reference in definitions:
                followed.add((reference, field))
                walk(definitions[reference], field)
        elif kind == "tagged-union":
            found.setdefault(field, set()).update(node["choices"])
            for member in node["choices"].values():
                walk(member, "")
        elif kind == "model-fields":
            for name, value in node["fields"].items():
                walk(value, name)
        elif kind == "dataclass-field":
            walk(node["schema"], node["name"])
        else:
            for key, value in node.items():
                if key not in ("definitions", "metadata"):
                    walk(value, field)

    gather(schema)
    walk(schema, "")
    return {field: frozenset(tags) for field, tags in found.items()}


def _lengths_once(found: Sequence[Any]) -> Iterator[Any]:
    """Yield the faults, those of the missing entries of one array as a single one that tells its length."""
    length: dict[tuple[Step, ...], tuple[int, int]] = {}
    for entry in found:
        if _missing_entry(entry):
            parent, at = entry["loc"][:-1], entry["loc"][-1]
            least, most = length.get(parent, (at, at))
            length[parent] = min(least, at), max(most, at)
    for entry in found:
        if not _missing_entry(entry):
            yield entry
        elif entry["loc"][:-1] in length:
            has, last = length.pop(entry["loc"][:-1])
            yield {"type": "short", "loc": entry["loc"][:-1], "ctx": {"has": has, "needs": last + 1}}


def _missing_entry(entry: Any) -> bool:
    return entry["type"] == "missing" and bool(entry["loc"]) and isinstance(entry["loc"][-1], int)


def _of_the_member_meant(found: Iterator[Any]) -> Iterator[Any]:
    """Yield the faults without those of the member of an object-or-array union that the client did not mean.

    That member has a single fault, its type, and stands first or second; if both members have it, neither was meant.
    """
    entries = list(found)
    other = {OBJECT: ARRAY, ARRAY: OBJECT}
    wrong = {
        entry["loc"] for entry in entries if entry["type"] in _TYPES and entry["loc"] and entry["loc"][-1] in other
    }
    for entry in entries:
        location = entry["loc"]
        if location not in wrong:
            yield entry
        elif (*location[:-1], other[location[-1]]) in wrong and location[-1] == OBJECT:
            yield {"type": "neither", "loc": location[:-1]}


def _fault(entry: Any, steps: tuple[Step, ...]) -> Fault:
    kind, context = entry["type"], entry.get("ctx", {})
    if kind in _UNKNOWN and len(str(steps[-1])) > LONGEST_KEY_SHOWN:
        return Fault(pointer_of(steps[:-1]), "has a key that is not known here")
    if kind == "short":
        return Fault(pointer_of(steps), f"must have {context['needs']} entries, not {context['has']}")
    if kind == "too_long":
        return Fault(pointer_of(steps), f"must have at most {context['max_length']} entries")
    if kind == "too_short":
        least = context["min_length"]
        return Fault(pointer_of(steps), f"must have at least {least} entries" if least > 1 else "must not be empty")
    rule = _RULES.get(kind)
    # A rule of our own is worded where it is stated; other messages of the validator quote no input.
    detail = rule.format_map(context) if rule else str(entry["msg"]).removeprefix("Value error, ")
    return Fault(pointer_of(steps), detail)


__all__ = ["ARRAY", "OBJECT", "ByPresence", "Limits", "Reader"]
