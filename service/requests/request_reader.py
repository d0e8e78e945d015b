"""From the bytes of a request to a question: form is checked here, meaning by the objects of core that are built.

A reader validates JSON bytes in one step, without an intermediate Python document. Where a number is the decimal that
is written and not the double nearest to it, the question has a method `with_digits`, which is given the document with
decimals for numbers. A question that is asked again with other numbers has a method `with_document`, which is given the
document itself.
"""

from __future__ import annotations

import gc
import json
from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from decimal import Decimal, InvalidOperation
from functools import cache, cached_property, partial
from typing import Any, Generic, TypeVar, cast

import orjson
from pydantic import TypeAdapter, ValidationError
from pydantic_core import SchemaValidator

from core.errors import Path
from service.problems import Fault, Refusal, headline
from service.requests.document_limits import Limits, enforce_document_limits, require_distinct_keys
from service.requests.error_messages import Wording
from service.requests.form_body import is_form, unpacked_form
from service.requests.layout import Layout
from service.requests.npz_body import Arrays, taking_arrays, unpacked

Q = TypeVar("Q")

DOUBLE = 8
"""Bytes of a number."""

LARGE = 65_536
"""Bytes of a document from which on objects are made by the ten thousand."""


class Reader(Generic[Q]):
    """Reads questions of one type.

    Parameters
    ----------
    question : type
        A pydantic model, which may hold dataclasses of core.
    limits : Limits
        On the document.
    elsewhere : mapping of str to str, optional
        Fields of another route, each with the remedy for who sends it to this one.
    """

    def __init__(self, question: type[Q], limits: Limits, elsewhere: Mapping[str, str] | None = None) -> None:
        self._schema = TypeAdapter(question).core_schema
        self._limits, self._elsewhere = limits, elsewhere or {}
        self._keeps_digits = hasattr(question, "with_digits")
        self._columns_at: Path = getattr(question, "COLUMNS_AT", ())
        self._keeps_document = hasattr(question, "with_document")

    @cached_property
    def _validate(self) -> Any:
        # Otherwise the validators that pydantic built with the classes would be taken, which lack the change.
        return SchemaValidator(_failing_fast(self._schema), _use_prebuilt=False).validate_json

    @cached_property
    def _validate_with_arrays(self) -> Any:
        schema = taking_arrays(self._schema, self._limits.bytes // DOUBLE)
        return SchemaValidator(_failing_fast(schema), _use_prebuilt=False).validate_json

    @cached_property
    def _wording(self) -> Wording:
        return Wording(Layout(_failing_fast(self._schema)), self._elsewhere)

    def read(self, body: bytes, *, npz: bool = False) -> Q:
        """Return the question that a request's body asks.

        Parameters
        ----------
        npz : bool
            Whether the body is a numpy archive, or has several parts; otherwise it is JSON.

        Raises
        ------
        Refusal
            With the pointers of what is wrong.
        """
        if npz and self._columns_at and is_form(body):
            return self._read(*unpacked_form(body, self._columns_at, self._limits))
        if npz:
            return self._read(*unpacked(body, self._limits.bytes))
        if len(body) < LARGE:
            return self._read(body)
        with _collecting_later():
            return self._read(body)

    def _read(self, document: bytes, arrays: Arrays | None = None) -> Q:
        try:
            enforce_document_limits(document, self._limits)
            if arrays is None:
                question: Q = self._validate(document, strict=True)
            else:
                question = self._validate_with_arrays(document, strict=True, context=arrays)
                arrays.require_all_named()
            require_distinct_keys(document)
            if self._keeps_digits:
                question = cast(Any, question).with_digits(json.loads(document, parse_float=_decimal))
            if self._keeps_document and arrays is None:
                question = cast(Any, question).with_document(document)
            return question
        except ValidationError as error:
            raise self._refusal(error, document) from None

    def _refusal(self, error: ValidationError, document: bytes) -> Refusal:
        found = error.errors(include_url=False, include_input=False)
        if found[0]["type"] == "json_invalid":
            # The parser's message gives line and column and quotes nothing.
            detail = str(found[0]["ctx"]["error"])
            fault = Fault("", f"must be JSON: {detail}", "see RFC 8259 for the grammar")
            return Refusal("invalid-json", detail, faults=[fault])
        faults, codes = self._wording.faults(found, cache(partial(_parsed, document)))
        code = codes.pop() if len(codes) == 1 else "invalid-parameter"
        return Refusal(code, headline(faults), faults=faults)


def _decimal(text: str) -> Decimal | float:
    """Return a number with all its digits; a double where its exponent is beyond every decimal."""
    try:
        return Decimal(text)
    except InvalidOperation:
        return float(text)


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


__all__ = ["Limits", "Reader"]
