"""Limits on a JSON document, enforced before it is built: nesting, keys, arrays, strings, keys named twice."""

from __future__ import annotations

import json
import re
from typing import Any, NamedTuple

import numpy as np

from core.errors import pointer_of
from service.problems import Fault, Refusal

_KEY_END = re.compile(rb'"[ \t\r\n]*:')
_KEY = re.compile(rb'"(\w*)"[ \t\r\n]*:')
_NUMBERS = re.compile(rb"\[[-+0-9.eE, \t\r\n]*(?:\][ ,\t\r\n]*\[[-+0-9.eE, \t\r\n]*)*\]")
"""Arrays of numbers that follow one another: the rows of a matrix."""
_OTHER = bytes(set(range(256)) - set(b'"[]{}'))
_STEP = np.zeros(256, np.int8)
_STEP[list(b"[{")], _STEP[list(b"]}")] = 1, -1

_FEW = 1_024
"""Bytes of a document that holds few strings."""

LONGEST_KEY_SHOWN = 40


class Limits(NamedTuple):
    """What a document may have: levels of nesting, keys, arrays and objects, strings; an archive, bytes unpacked.

    All but the last are constants of the service: the worst document within them is refused in some 50 ms.
    """

    nesting: int = 32
    keys: int = 20_000
    arrays: int = 110_000
    strings: int = 100_000
    bytes: int = 8_000_000


def enforce_document_limits(body: bytes, limits: Limits) -> None:
    """Refuse a document that is nested too deeply or has too many keys, arrays or strings, without building it."""
    deepest, most_keys, most_arrays, most_strings, _ = limits
    # Each string has two quotes; what is escaped in one costs about as much to read as one more would.
    if len(body) > 2 * most_strings and body.count(b'"') + body.count(b"\\") > 2 * most_strings:
        raise Refusal("too-complex", f"the body has more than {most_strings} strings or escapes")
    # A key with its value and comma takes five bytes, so a short document cannot have too many.
    if len(body) > 5 * most_keys and body.count(b":") > most_keys and len(_KEY_END.findall(body)) > most_keys:
        raise Refusal("too-complex", f"the body has more than {most_keys} keys")
    opened = body.count(b"[") + body.count(b"{")
    if opened > most_arrays:
        detail = f"the body has more than {most_arrays} arrays and objects; send rows as npz"
        raise Refusal("too-complex", detail)
    if opened > deepest and _depth(body) > deepest:
        raise Refusal("too-complex", f"the body is nested deeper than {deepest} levels")


def _depth(body: bytes) -> int:
    """Return how deeply brackets nest outside of strings; meaningless for what is not JSON, yet never an error."""
    if b"\\" in body:
        body = body.replace(b"\\\\", b"").replace(b'\\"', b"")
    codes = np.frombuffer(body.translate(None, _OTHER), np.uint8)
    inside = np.logical_xor.accumulate(codes == ord('"'))
    steps = np.where(inside, np.int8(0), _STEP[codes])
    return int(np.cumsum(steps, dtype=np.int64).max(initial=0))


def require_distinct_keys(body: bytes) -> None:
    """Refuse a valid JSON document of which an object names a key twice.

    Where no string at all occurs twice in the document, as in most small questions, or no key, looking at them is
    enough. Otherwise, and where a colon belongs to no plain name, it is read again, object by object.
    """
    if len(body) < _FEW and b"\\" not in body:
        # Every second piece between quotes is a string.
        strings = body.split(b'"')[1::2]
        if len(set(strings)) == len(strings):
            return
    names = _KEY.findall(body)
    if len(set(names)) != len(names) or len(names) != body.count(b":"):
        try:
            # Arrays of numbers hold no key. With a number in place of each the document is read ten times faster;
            # strings that differ in such a place may become equal, never equal ones different.
            json.loads(_NUMBERS.sub(b"0", body), object_pairs_hook=_distinct)
        except _Twice:
            path = _repeated(json.loads(body, object_pairs_hook=_Pairs))
            if path is None:
                return
            if path and len(str(path[-1])) > LONGEST_KEY_SHOWN:
                path = path[:-1]
            fault = Fault(pointer_of(path), "is given twice in one object")
            raise Refusal("duplicate-key", f"{fault.pointer} {fault.detail}", faults=[fault]) from None


class _Pairs(list[tuple[str, Any]]):
    """The members of an object as they were written."""


def _distinct(pairs: list[tuple[str, Any]]) -> None:
    if len({name for name, _ in pairs}) != len(pairs):
        raise _Twice


class _Twice(Exception):
    """An object names a key twice."""


def _repeated(node: Any, path: tuple[str | int, ...] = ()) -> tuple[str | int, ...] | None:
    """Return the path of the first key that is named twice."""
    if isinstance(node, _Pairs):
        seen = set()
        for name, value in node:
            if name in seen:
                return (*path, name)
            seen.add(name)
            found = _repeated(value, (*path, name))
            if found is not None:
                return found
    elif isinstance(node, list):
        for i, value in enumerate(node):
            found = _repeated(value, (*path, i)) if isinstance(value, list) else None
            if found is not None:
                return found
    return None
