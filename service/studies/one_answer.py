"""One answer in the background: the result of a study in which nothing varies (Prefer: respond-async, RFC 7240)."""

from __future__ import annotations

import time
import traceback
from pkgutil import resolve_name

import numpy as np

from core.errors import MechanicsError
from service.execution.request_handler import signed
from service.execution.worker import Terms
from service.observability.logs import LOG
from service.problems import Problem, Refusal, problem_of
from service.requests.request_reader import Reader
from service.responses.json_stream import composed
from service.routes.studies.members import FAULT, NO_ROOM, shortened
from service.studies.chunk_files import packed
from service.studies.task import Computed


def compute_answer(terms: Terms, request: bytes, path: str) -> Computed:
    """Return the answer to a request as the bytes of a file of results; without it, why there is none.

    Parameters
    ----------
    request : bytes
        As it was sent: numerals have more digits than doubles have.
    path : str
        Of its endpoint.
    """
    since = time.thread_time()
    try:
        answer = _answer(terms, request, path)
    except Refusal as refusal:
        reason = _reason(refusal.problem)
    except MechanicsError as error:
        reason = _reason(problem_of(error))
    except MemoryError:
        reason = f"{NO_ROOM}: the process lacks the memory for its answer"
    except Exception:
        LOG.error("an answer in the background has failed", extra={"traceback": traceback.format_exc()})
        reason = f"{FAULT}: the service failed"
    else:
        none = np.zeros(1, np.uint16)
        names: dict[str, list[str]] = {"failure_names": [], "warning_names": []}
        columns = {"inputs": np.empty((1, 0)), "figures": np.empty((1, 0)), "failures": none, "warnings": none}
        data = packed({"start": 0, **columns, **names, "answer": np.frombuffer(answer, np.uint8)})
        return Computed(data, 1, 0, time.thread_time() - since)
    return Computed(b"", 1, 1, time.thread_time() - since, reason)


def _answer(terms: Terms, request: bytes, path: str) -> bytes:
    route = next(route for route in resolve_name(terms.table)() if route.path == path)
    question = Reader(route.question, terms.limits, route.elsewhere).read(request)
    return composed(route, signed(route.handle(question, terms.budget)), None).whole()


def _reason(problem: Problem) -> str:
    return f"{problem.type.code}: {shortened(str(problem.detail))}"
