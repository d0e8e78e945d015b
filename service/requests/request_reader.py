"""From the bytes of a request to a question: form is checked here, meaning by the objects of core that are built.

A reader validates JSON bytes in one step, without an intermediate Python document.
"""

from __future__ import annotations

import gc
from collections.abc import Callable, Iterator, Mapping
from contextlib import contextmanager
from dataclasses import dataclass, field
from functools import cache, partial
from typing import Any, Generic, TypeVar, get_args

import orjson
from pydantic import TypeAdapter, ValidationError
from pydantic_core import SchemaValidator

from core.rows import Rows
from service.problems import Fault, Refusal, headline
from service.requests.document_limits import Limits, enforce_document_limits, require_distinct_keys
from service.requests.error_messages import Layout
from service.requests.large_arrays import LEAST_BYTES, ExtractedArrays, extract_arrays, placeholder_schema

Q = TypeVar("Q")

LARGE = 65_536
"""Bytes of a document from which on objects are made by the ten thousand."""
WITHOUT, WITH = "<without>", "<with>"
"""Labels of the two questions that a `DiscriminatedByKey` tells apart."""


@dataclass(frozen=True)
class DiscriminatedByKey:
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
        if having and name in self.beside and fault.detail == f"does not go with {self.key}":
            return Fault(fault.pointer, f"{fault.detail}: {self.beside[name]}", fault.remedy)
        remedy = self.remedies.get(fault.detail if not having else self.key if name == self.key else "")
        return Fault(fault.pointer, fault.detail, remedy) if remedy else fault

    def may_be_in(self, body: bytes) -> bool:
        """Return whether the key may be in a document, which most show at once that it is not."""
        # It might also be written with escapes.
        return self.key.encode() in body or b"\\" in body


class _Absent(Exception):
    """A document has not the key by which a question is told from another."""


class Reader(Generic[Q]):
    """Reads questions of one type.

    Parameters
    ----------
    question : type
        A pydantic model, which may hold dataclasses of core; or a union of two that a `DiscriminatedByKey` tells apart.
    limits : Limits
        On the document.
    advised : callable
        Returns a fault with what would mend it.
    """

    def __init__(
        self, question: type[Q], limits: Limits, advised: Callable[[Fault], Fault] = lambda fault: fault
    ) -> None:
        self._arrays: dict[str, Rows] = {}
        schema = _failing_fast(placeholder_schema(TypeAdapter(question).core_schema, self._arrays))
        # Otherwise the validators that pydantic built with the classes would be taken, which lack the change.
        self._validate = SchemaValidator(schema, _use_prebuilt=False).validate_json
        self._layout = Layout.of(schema)
        marks = [mark for mark in getattr(question, "__metadata__", ()) if isinstance(mark, DiscriminatedByKey)]
        self._key = ""
        # The discriminator of the union would have the whole document built to look for a key.
        self._told_apart: tuple[DiscriminatedByKey, Reader[Q], Reader[Q]] | None = None
        for mark in marks:
            without, having = [
                Reader(member, limits, partial(mark.advised, having=having))
                for having, member in zip((False, True), get_args(get_args(question)[0]), strict=True)
            ]
            having._layout = having._layout.told_from(mark.key, without._layout)
            having._key = mark.key
            self._told_apart = mark, without, having
        self._advised = advised
        self._limits = limits

    def read(self, body: bytes) -> Q:
        """Return the question that a request's body asks.

        Raises
        ------
        Refusal
            With the pointers of what is wrong.
        """
        if len(body) < LEAST_BYTES:
            apart = self._told_apart
            if apart is None:
                return self._plain(body)
            if not apart[0].may_be_in(body):
                return apart[1]._plain(body)
        if len(body) < LARGE:
            return self._read(body)
        with _collecting_later():
            return self._read(body)

    def _plain(self, body: bytes) -> Q:
        """Return the question of a document that is one of this kind, and has no large arrays."""
        try:
            return self._validated(body)
        except ValidationError as error:
            raise self._refusal(error, body) from None

    def _read(self, body: bytes) -> Q:
        return self._told(body, *extract_arrays(body, self._arrays))

    def _told(self, body: bytes, rest: bytes, taken: ExtractedArrays | None) -> Q:
        """Return the question of a document, from which arrays may have been taken out."""
        if self._told_apart is not None:
            mark, without, having = self._told_apart
            enforce_document_limits(rest, self._limits)
            if mark.may_be_in(rest):
                try:
                    return having._read(body)
                except _Absent:
                    pass
            return without._told(body, rest, taken)
        if taken is not None:
            try:
                question = self._validated(rest, taken)
                if not taken.shortened:
                    return question
            except ValidationError as error:
                # Faults of what is not JSON, or of an array where none is meant, are told of the document as it was.
                if taken.complete and error.errors(include_url=False, include_input=False)[0]["type"] != "json_invalid":
                    raise self._refusal(error, rest) from None
        return self._plain(body)

    def _validated(self, document: bytes, taken: ExtractedArrays | None = None) -> Q:
        enforce_document_limits(document, self._limits)
        question: Q = self._validate(document, strict=True, context=taken)
        require_distinct_keys(document)
        return question

    def _refusal(self, error: ValidationError, document: bytes) -> Refusal:
        found = error.errors(include_url=False, include_input=False)
        if found[0]["type"] == "json_invalid":
            # The parser's message gives line and column and quotes nothing.
            return Refusal("invalid-json", str(found[0]["ctx"]["error"]))
        if self._key and any(
            # What is no object has no key either.
            not fault["loc"] or (fault["type"] == "missing" and fault["loc"] == (self._key,))
            for fault in found
        ):
            raise _Absent
        found_faults, codes = self._layout.faults(found, cache(partial(_parsed, document)))
        faults = [self._advised(fault) for fault in found_faults]
        code = codes.pop() if len(codes) == 1 else "invalid-parameter"
        return Refusal(code, headline(faults), faults=faults)


def _parsed(document: bytes) -> Any:
    """Return what a document holds, None where this parser takes numbers more strictly than the validator's."""
    try:
        return orjson.loads(document)
    except ValueError:
        return None


@contextmanager
def _collecting_later() -> Iterator[None]:
    """Build a document without looking for garbage after every few hundred of its lists, none of which can be any."""
    collecting = gc.isenabled()
    gc.disable()
    try:
        yield
    finally:
        if collecting:
            gc.enable()


def _failing_fast(schema: Any) -> Any:
    """Return a schema in which every array of free length stops at its first bad entry.

    A client is helped by the first faults, and 100 000 of them would cost more than the computation refused.
    """
    if isinstance(schema, Mapping):
        walked = {key: _failing_fast(value) for key, value in schema.items() if key != "metadata"}
        if "unit" in schema.get("metadata", {}):
            walked["metadata"] = {"unit": schema["metadata"]["unit"]}
        free = schema.get("type") == "tuple" and "variadic_item_index" in schema
        return walked | {"fail_fast": True} if free or schema.get("type") == "list" else walked
    if isinstance(schema, (list, tuple)):
        return type(schema)(_failing_fast(entry) for entry in schema)
    return schema


__all__ = ["DiscriminatedByKey", "Limits", "Reader"]
