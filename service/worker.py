"""What runs in a compute process: one question, from its bytes to its answer.

Large arrays do not travel through the pipe between the processes. They are written to a file in shared memory that the
server process maps; arrays of decimal strings as JSON, so that the server process makes no string of them.
"""

from __future__ import annotations

import os
from collections.abc import Mapping
from dataclasses import dataclass
from functools import cache
from pathlib import Path
from pkgutil import resolve_name
from typing import Any, BinaryIO

import numpy as np

from core.errors import MechanicsError
from core.integration.budget import Budget
from service.answering import Answering
from service.problems import Problem, Refusal, problem_of
from service.reading import Limits
from service.routing import Question
from service.writing import Text, array_size, strings_in, text_of

SMALL = 8_192
"""Arrays of fewer numbers travel with the rest of the answer."""


@dataclass(frozen=True)
class Terms:
    """What a compute process needs to know; small, immutable and cheap to send with every question.

    Attributes
    ----------
    table : str
        Where the route table is: ``"module:function"``.
    """

    table: str
    budget: Budget
    limits: Limits


@dataclass(frozen=True)
class Stored:
    """An array that lies in the file."""

    offset: int
    shape: tuple[int, ...]
    dtype: str


@dataclass(frozen=True)
class StoredText:
    """An array of decimal strings that lies in the file as JSON."""

    offset: int
    length: int
    numbers: int


@cache
def answering(terms: Terms) -> Answering:
    """Return this process's answering of questions."""
    return Answering(_routes(terms.table).values(), terms.budget, terms.limits)


@cache
def _routes(table: str) -> Mapping[str, Question]:
    return {route.path: route for route in resolve_name(table)()}


def prepare(terms: Terms) -> None:
    """Make this process ready, and let it yield to the server process where they compete for a core."""
    os.nice(10)
    answering(terms).warm()


def work(terms: Terms, path: str, body: bytes, file: str) -> Any:
    """Answer one question; what is refused is returned as a problem."""
    route = _routes(terms.table)[path]
    try:
        question = answering(terms).read(route, body)
        answer = answering(terms).answer(route, question)
    except Refusal as refusal:
        return refusal.problem
    except MechanicsError as error:
        return problem_of(error)
    if array_size(answer) <= SMALL:
        return answer
    with Path(file).open("xb") as out:
        return _stored(answer, out)


def _stored(value: Any, out: BinaryIO) -> Any:
    """Return an answer with its large arrays moved to a file, C-contiguous."""
    if isinstance(value, np.ndarray) and value.size > SMALL:
        # Numbers of eight bytes are read where eight divides the address.
        out.write(bytes(-out.tell() % 8))
        stored = Stored(out.tell(), value.shape, value.dtype.str)
        # In blocks that fit caches, so that what is not contiguous needs no second array of its size.
        rows = max(1, SMALL * len(value) // value.size)
        for start in range(0, len(value), rows):
            out.write(np.ascontiguousarray(value[start : start + rows]).data)
        return stored
    strings = strings_in(value)
    if strings > SMALL:
        offset = out.tell()
        out.writelines(text_of(value))
        return StoredText(offset, out.tell() - offset, strings)
    if type(value) is dict:
        return {key: _stored(entry, out) for key, entry in value.items()}
    if isinstance(value, (list, tuple)):
        return [_stored(entry, out) for entry in value]
    return value


def restored(value: Any, file: Path) -> Any:
    """Return an answer whose stored arrays are mapped from the file; the file may be removed after that."""
    if isinstance(value, Problem):
        return value
    # An answer may be large by many small arrays, of which none is stored: an empty file cannot be mapped.
    stored = file.exists() and file.stat().st_size > 0
    data = np.memmap(file, np.uint8, "r") if stored else np.empty(0, np.uint8)
    return _restored(value, data)


def _restored(value: Any, data: np.ndarray[Any, Any]) -> Any:
    if isinstance(value, Stored):
        dtype = np.dtype(value.dtype)
        length = int(np.prod(value.shape)) * dtype.itemsize
        flat = np.asarray(data)[value.offset : value.offset + length]
        return flat.view(dtype).reshape(value.shape)
    if isinstance(value, StoredText):
        return Text(np.asarray(data)[value.offset : value.offset + value.length].data, value.numbers)
    if type(value) is dict:
        return {key: _restored(entry, data) for key, entry in value.items()}
    if isinstance(value, list):
        return [_restored(entry, data) for entry in value]
    return value
