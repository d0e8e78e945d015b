"""From the bytes of a question to the fields of its answer, the same in the server process and in compute processes."""

from __future__ import annotations

from collections.abc import Iterable
from contextlib import suppress
from math import inf, isfinite
from typing import Any

import orjson

from core.errors import NotApplicable, Path, pointer_of
from core.notices import Notice
from core.systems.budget import Budget
from core.systems.methods.from_scipy import has_scipy, scipy_integrate
from core.work import WorkLimitReached, work_limit
from service.requests.request_reader import Limits, Reader
from service.routing import Answer, PostRoute, never
from service.schemas import SIGNATURE

DESCRIBED_SCENES = "/v1/scenes"


class RequestHandler:
    """Reads and answers the questions of routes, within a budget for each and limits on documents."""

    def __init__(self, routes: Iterable[PostRoute], budget: Budget, limits: Limits) -> None:
        self._routes = tuple(routes)
        self._budget = budget
        self._readers = {route.path: Reader(route.question, limits, route.elsewhere).read for route in self._routes}

    def read(self, route: PostRoute, body: bytes, *, npz: bool = False) -> Any:
        """Return the question that a body asks; see `Reader.read`."""
        return self._readers[route.path](body, npz=npz)

    def answer(self, route: PostRoute, question: Any, attempt: int = 0) -> Answer:
        """Return the whole answer: signature, warnings, fields; from the second attempt on by `PostRoute.in_short`."""
        return signed((route.handle, *route.in_short)[attempt](question, self._budget))

    def study_of_one(self, route: PostRoute, question: Any) -> Answer:
        """Return the plan of a study in which nothing varies; what its answer takes is not known before."""
        plan = {"path": route.path, "count": 1, "together": False, "seconds": 0.0, "bytes": 0}
        return plan | {name: [] for name in ("shape", "inputs", "figures")}

    def warm(self, *, scenes_first: bool = False, work: float = inf) -> None:
        """Have every kernel that can be reached compiled or loaded, so that no client waits for that.

        A process that begins questions up to a limit of `work` (`core.work`) needs the kernels of small questions
        alone, and not the memory of the others.

        Of two processes that start at the same time on empty caches, one begins with the described scenes, the other
        ends with them: each compiles about half of the kernels and loads the other half.
        """
        asked = [
            (route, question)
            for route in self._routes
            if not (isfinite(work) and route.small is never)
            for question in (*(example.question for example in route.examples.values()), *route.warming)
        ]
        for route, question in sorted(asked, key=lambda each: (each[0].path == DESCRIBED_SCENES) != scenes_first):
            # An example may need an extra that is not installed.
            with suppress(WorkLimitReached, NotApplicable), work_limit(work):
                self.answer(route, self.read(route, orjson.dumps(question)))
        if not isfinite(work) and has_scipy():
            # The first question that names one of its methods would otherwise wait for it.
            scipy_integrate()

    def warm_many(self) -> None:
        """Have every kernel compiled by which members of studies are answered together.

        Few processes need them, which load them with the first study.
        """
        for route in self._routes:
            if route.many is not None:
                for arguments in route.warming_many:
                    route.many(*arguments)


def signed(fields: Answer) -> Answer:
    """Return the whole answer that has such fields."""
    answer = {"signature": SIGNATURE, "warnings": (), **fields}
    answer["warnings"] = [_warning(notice) for notice in answer["warnings"]]
    return answer


def _warning(notice: Notice) -> dict[str, str]:
    path: Path = notice.path
    entry = {"code": notice.code, "detail": notice.detail}
    return entry | {"pointer": pointer_of(path)} if path else entry
