"""From the bytes of a request to a question: form is checked here, meaning by the objects of core that are built.

A reader validates JSON bytes in one step, without an intermediate Python document.
"""

from __future__ import annotations

import gc
from collections.abc import Callable, Iterator, Mapping
from contextlib import contextmanager
from dataclasses import dataclass, field
from functools import cached_property, partial
from typing import Any, Generic, TypeVar, get_args

from pydantic import TypeAdapter, ValidationError
from pydantic_core import SchemaValidator

from service.problems import Fault, Refusal
from service.requests.document_limits import Limits, enforce_document_limits, require_distinct_keys
from service.requests.error_messages import Layout
from service.requests.npz_body import Arrays, taking_arrays, unpacked

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
        self._schema = TypeAdapter(question).core_schema
        schema = _failing_fast(self._schema)
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

    @cached_property
    def _validate_with_arrays(self) -> Any:
        return SchemaValidator(_failing_fast(taking_arrays(self._schema)), _use_prebuilt=False).validate_json

    def read(self, body: bytes, *, npz: bool = False) -> Q:
        """Return the question that a request's body asks.

        Parameters
        ----------
        npz : bool
            Whether the body is a numpy archive; otherwise it is JSON.

        Raises
        ------
        Refusal
            With the pointers of what is wrong.
        """
        if npz:
            return self._read(*unpacked(body, self._limits.bytes))
        if len(body) < LARGE:
            return self._read(body)
        with _collecting_later():
            return self._read(body)

    def _read(self, document: bytes, arrays: Arrays | None = None) -> Q:
        apart = self._told_apart
        if apart is not None:
            mark, without, having = apart
            if mark.may_be_in(document):
                try:
                    return having._read(document, arrays)
                except _Absent:
                    pass
            return without._read(document, arrays)
        try:
            enforce_document_limits(document, self._limits)
            if arrays is None:
                question: Q = self._validate(document, strict=True)
            else:
                question = self._validate_with_arrays(document, strict=True, context=arrays)
            require_distinct_keys(document)
            return question
        except ValidationError as error:
            raise self._refusal(error) from None

    def _refusal(self, error: ValidationError) -> Refusal:
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
        found_faults, codes = self._layout.faults(found)
        faults = [self._advised(fault) for fault in found_faults]
        code = codes.pop() if len(codes) == 1 else "invalid-parameter"
        more = f", and {len(faults) - 1} more" if len(faults) > 1 else ""
        return Refusal(code, f"{faults[0].sentence}{more}", faults=faults)


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
        free = schema.get("type") == "tuple" and "variadic_item_index" in schema
        return walked | {"fail_fast": True} if free or schema.get("type") == "list" else walked
    if isinstance(schema, (list, tuple)):
        return type(schema)(_failing_fast(entry) for entry in schema)
    return schema


__all__ = ["DiscriminatedByKey", "Limits", "Reader"]
