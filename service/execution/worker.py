"""What runs in a compute process: one question at a time, from its bytes to the document that is sent.

Large documents do not travel through the socket between the processes. They are put into a file in shared memory that
the server process maps: texts as they are sent, large arrays as numbers, which take less room.
"""

from __future__ import annotations

import contextlib
import os
import pickle
import signal
import socket
import traceback
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from functools import cache
from pathlib import Path
from pkgutil import resolve_name
from typing import Any, BinaryIO

import numpy as np

from core.errors import MechanicsError
from core.systems.budget import Budget
from service.execution.request_handler import RequestHandler
from service.execution.worker_pool import HEADER, framed
from service.problems import Problem, Refusal, problem_of
from service.requests.request_reader import Limits
from service.responses.json_stream import Document, Part, composed
from service.routing import PostRoute
from service.settings import Settings

SMALL = 65_536
"""Bytes of a document that travel through the socket."""

GRACE = 5.0
"""Seconds past the deadline after which a process ends by itself, in case that there is no server to kill it."""


@dataclass(frozen=True)
class Terms:
    """What a compute process needs to know.

    Attributes
    ----------
    table : str
        Where the route table is: ``"module:function"``.
    """

    table: str
    budget: Budget
    limits: Limits


@dataclass(frozen=True)
class Asked:
    """A question on its way to a compute process.

    Attributes
    ----------
    media : str or None
        Media type of the document, None for JSON.
    file : str
        Where a large document is put.
    deadline : float
        Longest time that it may take (s).
    """

    path: str
    body: bytes
    media: str | None
    file: str
    deadline: float


@dataclass(frozen=True)
class Stored:
    """A part of a document that lies in the file: numbers of a type and in a shape; text is bytes in a row."""

    offset: int
    shape: tuple[int, ...]
    dtype: str
    text: bool


@dataclass(frozen=True)
class Failed:
    """A fault of the service, never of the question."""

    traceback: str


@cache
def answering(terms: Terms) -> RequestHandler:
    """Return this process's answering of questions, warm; inherited warm if the fork server has made it."""
    made = RequestHandler(_routes(terms.table).values(), terms.budget, terms.limits)
    made.warm()
    return made


def terms_of(settings: Settings, table: str) -> Terms:
    """Return what compute processes need to know of the settings."""
    return Terms(
        table,
        Budget(samples=settings.max_samples, evaluations=settings.max_evaluations),
        Limits(settings.max_nesting, settings.max_keys, settings.max_arrays, settings.max_strings),
    )


@cache
def _routes(table: str) -> Mapping[str, PostRoute]:
    return {route.path: route for route in resolve_name(table)()}


def serve(channel: socket.socket, terms: Terms) -> None:
    """Answer questions one by one until the server process closes the connection.

    Nothing is sent but "ready", and for each question "begun" and the reply; see `service.execution.worker_pool`.
    """
    # Ctrl-C in a terminal reaches every process; the server ends this one when it has finished.
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    prepare(terms)
    # Once the connection is closed nobody waits for anything.
    with contextlib.suppress(ConnectionError), channel, channel.makefile("rb") as requests:
        channel.sendall(framed(b""))
        while header := requests.read(HEADER):
            asked: Asked = pickle.loads(requests.read(int.from_bytes(header, "little")))
            channel.sendall(framed(b""))
            signal.setitimer(signal.ITIMER_REAL, asked.deadline + GRACE)
            reply = pickle.dumps(work(terms, asked), pickle.HIGHEST_PROTOCOL)
            signal.setitimer(signal.ITIMER_REAL, 0.0)
            channel.sendall(framed(reply))


def prepare(terms: Terms) -> None:
    """Make this process ready, and let it yield to the server process where they compete for a core."""
    os.nice(10)
    answering(terms)


def work(terms: Terms, asked: Asked) -> Document | Problem | Failed:
    """Answer one question; what is refused is returned as a problem, and a large document as it is stored."""
    route = _routes(terms.table)[asked.path]
    try:
        question = answering(terms).read(route, asked.body)
        return spill_to_shared_memory(
            composed(route, answering(terms).answer(route, question), asked.media), Path(asked.file)
        )
    except Refusal as refusal:
        return refusal.problem
    except MechanicsError as error:
        return problem_of(error)
    except Exception:
        return Failed(traceback.format_exc())


def spill_to_shared_memory(document: Document, file: Path) -> Document:
    """Return a document as it travels: a large one with its parts in the file, or refuse it for want of room."""
    if all(not isinstance(part, np.ndarray) for part in document.parts) and sum(map(len, document.parts)) <= SMALL:
        return document
    with _room(), file.open("xb") as out:
        return Document(document.numbers, tuple(_stored(part, out) for part in document.parts))


@contextlib.contextmanager
def _room() -> Iterator[None]:
    """Refuse, where the file cannot be written or mapped: it is the machine that lacks something, not the service."""
    try:
        yield
    except OSError as error:
        detail = f"the answer could not be stored: {error.strerror}"
        raise Refusal("no-room", detail, headers=(("Retry-After", "1"),)) from error


def _stored(part: Part, out: BinaryIO) -> Any:
    """Put a part into the file, C-contiguous, so that it is copied only once."""
    # Arrays of doubles are read where they lie, which is faster if that is a multiple of their size.
    out.write(bytes(-out.tell() % 16))
    if isinstance(part, np.ndarray):
        stored = Stored(out.tell(), part.shape, part.dtype.str, text=False)
        out.write(np.ascontiguousarray(part).data)
    else:
        stored = Stored(out.tell(), (len(part),), "|u1", text=True)
        out.write(part)
    return stored


def map_shared_memory(document: Document, file: Path) -> Document:
    """Return a document whose stored parts are mapped from the file, which may be removed after that, or refuse it."""
    if not any(isinstance(part, Stored) for part in document.parts):
        return document
    with _room():
        data = np.asarray(np.memmap(file, np.uint8, "r"))
    return Document(document.numbers, tuple(_restored(part, data) for part in document.parts))


def _restored(part: Any, data: np.ndarray[Any, Any]) -> Part:
    dtype = np.dtype(part.dtype)
    flat = data[part.offset : part.offset + int(np.prod(part.shape)) * dtype.itemsize]
    return flat.data if part.text else flat.view(dtype).reshape(part.shape)
