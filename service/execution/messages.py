"""Objects on their way between processes: pickled, large arrays and texts beside the pickle and never copied into it.

A message is its length, the number and the lengths of its buffers, the pickle, and the buffers, each at a multiple of
`ALIGNMENT`, so that arrays are used where they arrive (pickle protocol 5, PEP 574).
"""

from __future__ import annotations

import pickle
from collections.abc import Sequence
from itertools import accumulate
from typing import Any

LENGTH = 8
"""Bytes of a message that say how long the rest is, little end first."""

BEGUN = bytes(LENGTH)
"""What a process sends when it is ready, and when it begins a request: a message of no length."""

ALIGNMENT = 64

Buffer = bytes | memoryview


def encoded(message: Any) -> list[Buffer]:
    """Return the parts that are to be written one after the other."""
    apart: list[pickle.PickleBuffer] = []
    text = pickle.dumps(message, 5, buffer_callback=apart.append)
    buffers: list[Buffer] = [text, *(buffer.raw() for buffer in apart)]
    sizes = b"".join(size.to_bytes(LENGTH, "little") for size in (len(buffers), *map(len, buffers)))
    parts: list[Buffer] = []
    for part in (sizes, *buffers):
        parts += [part, bytes(-len(part) % ALIGNMENT)]
    return [sum(map(len, parts)).to_bytes(LENGTH, "little"), *parts]


def decoded(data: memoryview) -> Any:
    """Return the message whose bytes, without their length, these are; its arrays are views of them."""
    count = int.from_bytes(data[:LENGTH], "little")
    sizes = [int.from_bytes(data[LENGTH * k : LENGTH * (k + 1)], "little") for k in range(1, count + 1)]
    ends = list(accumulate([_padded(LENGTH * (count + 1)), *map(_padded, sizes)]))
    text, *buffers = (data[end : end + size] for end, size in zip(ends, sizes, strict=False))
    return pickle.loads(text, buffers=buffers)


def apart(parts: Sequence[Any], least: int) -> tuple[Any, ...]:
    """Return parts of which texts of at least so many bytes travel beside the pickle; they arrive as memory views."""
    return tuple(
        pickle.PickleBuffer(part) if isinstance(part, (bytes, memoryview)) and len(part) >= least else part
        for part in parts
    )


def _padded(size: int) -> int:
    return size + -size % ALIGNMENT
