"""Large arrays of numbers in a question, read before the rest of it.

A cloud of points makes a document of a few hundred bytes and megabytes of numbers, for each of which the validator
would build an object. Here those arrays are read at once; what is validated has a token in place of each, and the
fields that keep their numbers as one array (`core.rows.Rows`) take the array for the token.
"""

from __future__ import annotations

import re
from collections.abc import Mapping
from functools import cache
from itertools import islice
from secrets import token_hex
from typing import Any

from numpy.typing import NDArray

from core.decimal_rows import read_rows
from core.rows import Rows

LEAST_BYTES = 2048
"""Shorter arrays stay in the document."""

MOST = 64
"""Arrays that are looked at in one document."""

UNREADABLE = 4
"""Arrays that may turn out not to be of numbers, each after a look at all that follows, before no more are tried."""

_TOKEN = token_hex(16)
"""Part of every token; a client does not know it and so cannot name an array that it did not send."""


class ExtractedArrays:
    """The arrays that were taken out of a document, by their tokens.

    Attributes
    ----------
    shortened : bool
        Whether an array was left off at a fault, so that the document can only be refused.
    """

    def __init__(self) -> None:
        self.shortened = False
        self._arrays: dict[str, NDArray[Any]] = {}
        self._placed: set[str] = set()

    def __len__(self) -> int:
        return len(self._arrays)

    def add(self, array: NDArray[Any]) -> bytes:
        """Return the text that stands for an array."""
        token = f"{_TOKEN}-{len(self._arrays)}"
        self._arrays[token] = array
        return b'"%s"' % token.encode()

    def array_for(self, value: Any) -> Any:
        """Return the array for a token, the rows of an array that goes on wrongly as a list, anything else as it is."""
        goes_on = type(value) is list and len(value) > 1
        token = value[0] if goes_on else value
        found = self._arrays.get(token) if type(token) is str else None
        if found is None:
            return value
        self._placed.add(token)
        return [*found.tolist(), *value[1:]] if goes_on else found

    @property
    def complete(self) -> bool:
        """Whether every array has been asked for, so that no token was taken for a string."""
        return len(self._placed) == len(self._arrays)


def extract_arrays(document: bytes, fields: Mapping[str, Rows]) -> tuple[bytes, ExtractedArrays | None]:
    """Return a JSON document with tokens in place of the large arrays of some fields, and these arrays if it has any.

    A document that is not JSON stays so, as tokens are JSON strings and stand where an array stood.

    Parameters
    ----------
    fields : mapping
        By name, what the numbers are of the fields whose arrays are wanted.
    """
    # Where nothing is escaped, a name in quotes before a colon cannot be part of a string.
    if len(document) < LEAST_BYTES or not fields or b"\\" in document:
        return document, None
    taken = ExtractedArrays()
    parts, done, unreadable = [], 0, 0
    for match in islice(_opening(tuple(fields)).finditer(document), MOST):
        start = match.end() - 1
        if start < done:
            # Within an array that has been taken as wrong.
            continue
        mark = fields[match[1].decode()]
        rows = read_rows(document, start, whole=mark.whole)
        if rows is None:
            unreadable += 1
            if unreadable == UNREADABLE:
                break
            continue
        if rows.end - start < LEAST_BYTES:
            continue
        array = taken.add(rows.values)
        if rows.wrong is not None:
            taken.shortened = True
            # What follows can mend nothing; of the rest only the first fault is looked at, by who names it.
            # It stands as often as makes entries enough: not their number is at fault.
            array = b"[" + b",".join([array, *[rows.wrong] * max(1, mark.at_least - len(rows.values))]) + b"]"
        parts += [document[done:start], array]
        done = rows.end
    return (b"".join([*parts, document[done:]]), taken) if parts else (document, None)


@cache
def _opening(names: tuple[str, ...]) -> re.Pattern[bytes]:
    return re.compile(rb'"(%s)"[ \t\r\n]*:[ \t\r\n]*\[' % b"|".join(name.encode() for name in names))


def placeholder_schema(schema: Any, fields: dict[str, Rows]) -> Any:
    """Return a validator's schema whose array fields take arrays for tokens; their names are put into `fields`."""

    def walked(node: Any, name: str) -> Any:
        if isinstance(node, (list, tuple)):
            return type(node)(walked(entry, name) for entry in node)
        if not isinstance(node, Mapping):
            return node
        rows = (node.get("metadata") or {}).get("rows") if node.get("type") == "any" else None
        if isinstance(rows, Rows):
            fields[name] = rows
            return {"type": "function-plain", "function": {"type": "with-info", "function": _taken}}
        named = node["name"] if node.get("type") == "dataclass-field" else name
        return {key: value if key == "metadata" else walked(value, named) for key, value in node.items()}

    return walked(schema, "")


def _taken(value: Any, info: Any) -> Any:
    return value if info.context is None else info.context.array_for(value)
