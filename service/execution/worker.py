"""What runs in the processes of a server: one request at a time, from its bytes to the document that is sent.

A request is read and priced by one process, then, when its price is accepted, answered by another. Both read it: a body
is at most a few megabytes, and what is read is no longer made of bytes.
"""

from __future__ import annotations

import contextlib
import os
import signal
import socket
import traceback
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from functools import cache
from pkgutil import resolve_name
from typing import Any, TypeVar

from core.errors import MechanicsError
from core.systems.budget import Budget
from service.execution.messages import BEGUN, LENGTH, apart, decoded, encoded
from service.execution.request_handler import RequestHandler
from service.problems import REGISTRY, Problem, Refusal, problem_of
from service.requests.request_reader import Limits
from service.responses.json_stream import Document, composed
from service.routing import PostRoute
from service.settings import Settings

T = TypeVar("T")

SMALL = 65_536
"""Bytes of a text from which on it travels beside the message that it belongs to."""

GRACE = 5.0
"""Seconds past the deadline after which a process ends by itself, in case that there is no server to kill it."""


@dataclass(frozen=True)
class Terms:
    """What a process needs to know.

    Attributes
    ----------
    table : str
        Where the route table is: ``"module:function"``.
    """

    table: str
    budget: Budget
    limits: Limits


@dataclass(frozen=True)
class Task:
    """A request on its way to a process.

    Attributes
    ----------
    npz : bool
        Whether the body is a numpy archive; otherwise it is JSON.
    media : str or None
        Media type of the document, None for JSON.
    deadline : float
        Longest time that it may take (s).
    """

    path: str
    body: bytes
    npz: bool
    media: str | None
    deadline: float


@dataclass(frozen=True)
class Failed:
    """A fault of the service, never of the request."""

    traceback: str


Operation = Callable[[Terms, Task], Any]
"""What a process does for a request: `price` or `answer`."""


@cache
def handler_of(terms: Terms) -> RequestHandler:
    """Return this process's handler of requests, warm; inherited warm if the fork server has made it."""
    return warm_handler(terms)


def warm_handler(terms: Terms, *, scenes_first: bool = False) -> RequestHandler:
    """Return a handler of requests for which every kernel is compiled or loaded; see `RequestHandler.warm`."""
    made = RequestHandler(_routes(terms.table).values(), terms.budget, terms.limits)
    made.warm(scenes_first=scenes_first)
    return made


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
    )


@cache
def _routes(table: str) -> Mapping[str, PostRoute]:
    return {route.path: route for route in resolve_name(table)()}


def price(terms: Terms, task: Task) -> float | Problem | Failed:
    """Return the predicted time of an answer (s), or why there is none."""
    return _guarded(terms, task, lambda handler, route, question: handler.price(route, question))


def answer(terms: Terms, task: Task) -> Document | Problem | Failed:
    """Return the document of an answer, or why there is none."""
    return _guarded(
        terms, task, lambda handler, route, question: composed(route, handler.answer(route, question), task.media)
    )


def _guarded(terms: Terms, task: Task, work: Callable[[RequestHandler, PostRoute, Any], T]) -> T | Problem | Failed:
    route, handler = _routes(terms.table)[task.path], handler_of(terms)
    try:
        return work(handler, route, handler.read(route, task.body, npz=task.npz))
    except Refusal as refusal:
        return refusal.problem
    except MechanicsError as error:
        return problem_of(error)
    except MemoryError:
        return Problem(REGISTRY["no-room"], "the machine lacks the memory for this answer", retry_after=1.0)
    except Exception:
        return Failed(traceback.format_exc())


def serve(channel: socket.socket, terms: Terms, work: Operation, nice: int) -> None:
    """Do the same work for one request after the other until the server process closes the connection.

    Nothing is sent but `BEGUN` when it is ready, and for each request `BEGUN` and the reply.
    """
    # Ctrl-C in a terminal reaches every process; the server ends this one when it has finished.
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    # Where they compete for a core, the server process goes first.
    os.nice(nice)
    handler_of(terms)
    # The server closes the connection when it stops or gives the process up.
    with contextlib.suppress(ConnectionError), channel, channel.makefile("rb") as requests:
        channel.sendall(BEGUN)
        while length := requests.read(LENGTH):
            channel.sendall(BEGUN)
            task: Task = decoded(memoryview(requests.read(int.from_bytes(length, "little"))))
            signal.setitimer(signal.ITIMER_REAL, task.deadline + GRACE)
            reply = work(terms, task)
            if isinstance(reply, Document):
                reply = Document(reply.numbers, apart(reply.parts, SMALL))
            signal.setitimer(signal.ITIMER_REAL, 0.0)
            for part in encoded(reply):
                channel.sendall(part)
