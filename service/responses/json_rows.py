"""From an answer to the bytes of a response: small answers in one piece, large ones in chunks straight from arrays.

An answer is a dict, in the order in which it is written, of numbers, strings, lists, dicts, dataclasses and numpy
arrays at any depth. Numbers are written so that reading them gives the same double. Lists of decimal strings, and lists
of rows of them, are arrays too.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import fields, is_dataclass
from functools import cache
from itertools import repeat
from math import isfinite
from operator import is_
from typing import Any

import numpy as np
import orjson

ONE_PIECE = 16_384
"""Answers with fewer numbers in their arrays are written in one piece; beyond, chunks cost less, as they fit caches."""

CHUNK = 20_480
"""Numbers per chunk of a large answer, about 0.7 ms: longer text would have its memory mapped anew for every chunk."""

UNDIVIDED = 12_288
"""Numbers in arrays up to which a part of a large answer is one chunk; as strings they may be longer than doubles."""

CHARACTERS = 20
"""Of a number, as they are counted where numbers are strings of any length."""

FEW = 24
"""Arrays of so few numbers are looked through number by number, which costs less than numpy's calls."""

_NO_NUMBERS = frozenset((str, int, bool, type(None)))
_NO_ARRAYS = _NO_NUMBERS | {float}

_OPTIONS = orjson.OPT_SERIALIZE_NUMPY


class NotFinite(ValueError):
    """An answer holds NaN or an infinity, which it must not: a fault of the mechanics, never of the question."""


def strings_in(value: Any) -> int:
    """Return how many decimal strings a list holds, each an entry or in one of rows of equally many; 0 for others."""
    if type(value) is not list or not value:
        return 0
    first = value[0]
    if type(first) is list:
        return len(value) * len(first) if first and type(first[0]) is str else 0
    return len(value) if type(first) is str else 0


def array_size(answer: Any) -> int:
    """Return how many numbers the arrays of an answer hold."""
    size = 0
    for value in answer.values() if type(answer) is dict else answer:
        kind = type(value)
        if kind in _NO_ARRAYS:
            continue
        if kind is np.ndarray:
            size += value.size
        elif kind is dict:
            size += array_size(value)
        elif strings := strings_in(value):
            size += strings
        elif (kind is list or kind is tuple) and value and type(value[0]) not in _NO_ARRAYS:
            size += array_size(value)
    return size


def written(answer: Any) -> bytes:
    """Return an answer as JSON in one piece.

    Raises
    ------
    NotFinite
        For NaN and infinities.
    """
    text = orjson.dumps(answer, default=_plain, option=_OPTIONS)
    # NaN and infinities are written as null, so an answer need be looked through only for nulls that are not its own.
    nulls = text.count(b"null")
    if nulls and not (type(answer) is dict and nulls == sum(map(is_, answer.values(), repeat(None)))):
        require_finite(answer)
    return text


def parts(value: Any) -> Iterator[bytes | memoryview | np.ndarray[Any, Any]]:
    """Yield an answer as JSON, but for its large arrays of doubles, which `rows` writes; it has to be finite."""
    if array_size((value,)) <= UNDIVIDED:
        yield orjson.dumps(value, default=_plain, option=_OPTIONS)
    elif type(value) is dict:
        opening = b"{"
        for key, entry in value.items():
            yield opening + orjson.dumps(key) + b":"
            yield from parts(entry)
            opening = b","
        yield b"}"
    elif isinstance(value, np.ndarray):
        yield value
    elif strings_in(value):
        yield from _blocks(value, max(1, CHUNK * CHARACTERS // len(orjson.dumps(value[0]))))
    else:
        opening = b"["
        for entry in value:
            yield opening
            yield from parts(entry)
            opening = b","
        yield b"]"


def rows(array: np.ndarray[Any, Any]) -> Iterator[bytes | memoryview]:
    """Yield an array as JSON in chunks; it has to be finite."""
    if array.size > CHUNK * len(array):
        # Few and long: a row alone would hold the event loop for as long as it takes to write all of it.
        opening = b"["
        for row in array:
            yield opening
            yield from rows(row)
            opening = b","
        yield b"]"
    else:
        yield from _blocks(array, CHUNK * len(array) // array.size)


def _blocks(value: Any, rows: int) -> Iterator[bytes | memoryview]:
    """Yield an array as JSON, so many rows at a time, and what stands between them."""
    opening = b"["
    for start in range(0, len(value), rows):
        block = value[start : start + rows]
        if isinstance(block, np.ndarray):
            block = np.ascontiguousarray(block)
        yield opening
        # The brackets are left out without a copy.
        yield memoryview(orjson.dumps(block, option=_OPTIONS))[1:-1]
        opening = b","
    yield b"]"


def _plain(value: Any) -> Any:
    """Return what orjson cannot write by itself as something it can."""
    if isinstance(value, np.ndarray):
        # A transposed view, as arrays of samples often are.
        return np.ascontiguousarray(value)
    if isinstance(value, np.generic):
        return value.item()
    raise TypeError(f"an answer cannot hold {type(value).__name__}")


def require_finite(value: Any) -> None:
    """Raise `NotFinite` if NaN or an infinity is anywhere in an answer."""
    kind = type(value)
    if kind is dict or kind is list or kind is tuple:
        for entry in value.values() if kind is dict else value:
            inner = type(entry)
            # Plain numbers are looked at here: a call for each would cost more than writing the answer.
            if inner is float:
                if not isfinite(entry):
                    raise NotFinite
            elif inner not in _NO_NUMBERS:
                require_finite(entry)
    elif kind is np.ndarray:
        if value.dtype.kind == "f" and not _all_finite(value):
            raise NotFinite
    elif is_dataclass(kind):
        require_finite([getattr(value, name) for name in _names(kind)])
    elif isinstance(value, float) and not isfinite(value):
        raise NotFinite


@cache
def _names(kind: Any) -> tuple[str, ...]:
    return tuple(entry.name for entry in fields(kind))


def _all_finite(array: np.ndarray[Any, Any]) -> bool:
    if array.size <= FEW:
        return all(map(isfinite, array.ravel().tolist()))
    rows = max(1, ONE_PIECE * len(array) // max(array.size, 1))
    return all(np.isfinite(array[i : i + rows]).all() for i in range(0, len(array), rows))
