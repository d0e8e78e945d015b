"""What runs in the processes of a server: one request at a time, from its bytes to the document that is sent.

Everything about a request is done where it is answered, reading and writing included: no other process has to be free.
"""

from __future__ import annotations

import contextlib
import ctypes
import os
import resource
import signal
import socket
import sys
import traceback
from collections.abc import Mapping
from dataclasses import dataclass
from functools import cache
from pathlib import Path
from pkgutil import resolve_name

from core.errors import MechanicsError
from core.systems.budget import Budget
from service.execution.messages import BEGUN, LENGTH, apart, decoded, encoded
from service.execution.request_handler import RequestHandler
from service.problem_types import REGISTRY
from service.problems import Problem, Refusal, problem_of
from service.requests.request_reader import Limits
from service.responses.json_stream import Document, composed
from service.routing import PostRoute
from service.settings import Settings

SMALL = 65_536
"""Bytes of a text from which on it travels beside the message that it belongs to."""

PR_SET_PDEATHSIG = 1
"""Of prctl(2)."""


@dataclass(frozen=True)
class Terms:
    """What a process needs to know.

    Attributes
    ----------
    table : str
        Where the route table is: ``"module:function"``.
    memory : int
        Bytes that a process may take beyond what it begins with; 0 for no limit.
    """

    table: str
    budget: Budget
    limits: Limits
    memory: int


@dataclass(frozen=True)
class Task:
    """A request on its way to a process.

    Attributes
    ----------
    npz : bool
        Whether the body is a numpy archive; otherwise it is JSON.
    media : str or None
        Media type of the document, None for JSON.
    attempt : int
        How many attempts have used more than the slice of the short class.
    later : bool
        Whether the answer is computed in the background; the reply is the plan of a study of one answer.
    """

    path: str
    body: bytes
    npz: bool
    media: str | None
    attempt: int = 0
    later: bool = False


@dataclass(frozen=True)
class Failed:
    """A fault of the service, never of the request."""

    traceback: str


@cache
def handler_of(terms: Terms) -> RequestHandler:
    """Return this process's handler of requests, warm; inherited warm if the fork server has made it."""
    made = new_handler(terms)
    made.warm()
    return made


def new_handler(terms: Terms) -> RequestHandler:
    """Return a handler of requests for which no kernel is loaded; see `RequestHandler.warm`."""
    return RequestHandler(_routes(terms.table).values(), terms.budget, terms.limits)


def terms_of(settings: Settings, table: str) -> Terms:
    """Return what processes need to know of the settings."""
    return Terms(
        table,
        Budget(
            samples=settings.max_samples,
            evaluations=settings.max_evaluations,
            members=settings.max_study_members,
            audited=settings.audit,
        ),
        Limits(bytes=settings.max_body_bytes),
        settings.compute_memory_bytes,
    )


@cache
def _routes(table: str) -> Mapping[str, PostRoute]:
    return {route.path: route for route in resolve_name(table)()}


def answer(terms: Terms, task: Task) -> Document | Problem | Failed:
    """Return the document of an answer, or why there is none."""
    route, handler = _routes(terms.table)[task.path], handler_of(terms)
    try:
        question = handler.read(route, task.body, npz=task.npz)
        if task.later:
            return composed(route, handler.study_of_one(route, question), None)
        return composed(route, handler.answer(route, question, task.attempt), task.media)
    except Refusal as refusal:
        return refusal.problem
    except MechanicsError as error:
        return problem_of(error)
    except MemoryError:
        if terms.memory:
            # The same question would need as much again: nothing says to repeat it.
            detail = f"this answer needs more than {terms.memory} bytes, the limit compute_memory_bytes"
            return Problem(REGISTRY["no-room"], f"{detail}: request fewer samples, or less at a time")
        return Problem(REGISTRY["no-room"], "this answer needs more memory than the machine has now", retry_after=1.0)
    except Exception:
        return Failed(traceback.format_exc())


def serve(channel: socket.socket, terms: Terms, nice: int) -> None:
    """Answer one request after the other until the server process closes the connection.

    Nothing is sent but `BEGUN` when it is ready, and for each request `BEGUN` and the reply.
    """
    # Ctrl-C in a terminal reaches every process; the server ends this one when it has finished.
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    # Where they compete for a core, the server process goes first.
    os.nice(nice)
    handler_of(terms)
    _end_with_parent()
    if terms.memory:
        _limit_memory(terms.memory)
    # The server closes the connection when it stops or gives the process up.
    with contextlib.suppress(ConnectionError), channel, channel.makefile("rb") as requests:
        channel.sendall(BEGUN)
        while length := requests.read(LENGTH):
            channel.sendall(BEGUN)
            task: Task = decoded(memoryview(requests.read(int.from_bytes(length, "little"))))
            reply = answer(terms, task)
            if isinstance(reply, Document):
                reply = Document(reply.numbers, apart(reply.parts, SMALL))
            for part in encoded(reply):
                channel.sendall(part)


def _end_with_parent() -> None:
    """Have this process killed when the fork server ends, which ends with the server: it may be stopped by then."""
    if sys.platform == "linux":
        ctypes.CDLL(None).prctl(PR_SET_PDEATHSIG, signal.SIGKILL)


def _limit_memory(most: int) -> None:
    """Have allocations fail that exceed what is taken now by so many bytes (setrlimit(2))."""
    if sys.platform == "linux":
        taken = int(Path("/proc/self/statm").read_text().split()[5]) * resource.getpagesize()
        resource.setrlimit(resource.RLIMIT_DATA, (taken + most, taken + most))
