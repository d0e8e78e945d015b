"""What a process of the cluster does: the results of some members, as the bytes of their file."""

from __future__ import annotations

import os
import signal
import time
from functools import lru_cache
from math import inf
from pkgutil import resolve_name
from typing import Any, NamedTuple

import numpy as np

from service.execution.worker import Terms
from service.requests.request_reader import Reader
from service.routing import StudyRoute
from service.studies.chunk_files import packed

OPENED = 8
"""Studies that a process remembers, the latest ones."""


class Computed(NamedTuple):
    """Results of a stretch of members.

    Attributes
    ----------
    data : bytes
        Of their file.
    members : int
        How many it has.
    failed : int
        Members that have no result but a problem.
    seconds : float
        Processor time.
    reason : str
        Why a study of one whole answer has none; see `service.studies.one_answer`.
    """

    data: bytes
    members: int
    failed: int
    seconds: float
    reason: str = ""


def compute(terms: Terms, request: bytes, start: int, stop: int, seconds: float = inf) -> Computed:
    """Return the results of the members from `start` up to `stop` of a study, or of the first of them.

    Parameters
    ----------
    seconds : float
        Time after which no further member is begun.
    """
    members = opened(terms, request)
    since = time.thread_time()
    return _computed(members.block(start, stop, seconds), since)


def trial(terms: Terms, request: bytes, seconds: float) -> str:
    """Return why no member of a sample has an answer, empty if one has; see `Members.trial`."""
    reasons: str = opened(terms, request).trial(seconds)
    return reasons


def without_answer(terms: Terms, request: bytes, member: int, code: str) -> Computed:
    """Return the result of a member that no process could answer."""
    return _computed(opened(terms, request).failed(member, member + 1, code), time.thread_time())


async def end_process() -> None:
    """End this process, which its nanny then replaces: a thread that computes cannot be ended."""
    os.kill(os.getpid(), signal.SIGKILL)


@lru_cache(OPENED)
def opened(terms: Terms, request: bytes) -> Any:
    """Return what answers the members of a study."""
    route = next(route for route in resolve_name(terms.table)() if isinstance(route, StudyRoute))
    return route.members(Reader(route.question, terms.limits, route.elsewhere).read(request), terms.budget)


def _computed(block: Any, since: float) -> Computed:
    data = packed(block.document())
    return Computed(data, len(block.figures), int(np.count_nonzero(block.failures)), time.thread_time() - since)
