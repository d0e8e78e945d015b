"""Where a request is answered: in the event loop if it is small, otherwise in a compute process.

Small is what a route declares to be, by counts that its question states. That decides only where a request starts: its
work is counted while it is done (`core.work`), reading and writing included, and beyond the limit it is ended and given
to a compute process as if it had never begun. So nothing holds the event loop for long, whatever it was taken for.
"""

from __future__ import annotations

from time import perf_counter

from core.work import WorkLimitReached, work_limit
from service.execution.admission import Compute, Sender
from service.execution.request_handler import RequestHandler
from service.observability.logs import LOG
from service.observability.metrics import Metrics
from service.responses.json_stream import Document, composed
from service.routing import PostRoute
from service.settings import Settings

LONG = 0.02
"""Seconds for which no request should hold the event loop; one that does is counted and logged."""


class Executor:
    """Answers requests: `handler` in this process, `compute` in others."""

    def __init__(self, handler: RequestHandler, compute: Compute, metrics: Metrics, settings: Settings) -> None:
        self._handler, self._compute, self._metrics = handler, compute, metrics
        self._bytes, self._work = settings.inline_bytes, settings.inline_work

    async def answer(
        self, route: PostRoute, body: bytes, npz: bool, media: str | None, sender: Sender, *, later: bool = False
    ) -> Document:
        """Return the answer to a request; parameters and errors are those of `Compute.answer`."""
        if sender.key is not None:
            # What it costs is charged when that is known; who has debts is refused.
            sender.key.work(0.0)
        if not npz and len(body) <= self._bytes:
            self._compute.held.require_share(sender.client)
            since = perf_counter()
            try:
                document = self.answer_inline(route, body, media, later=later)
            finally:
                seconds = perf_counter() - since
                if sender.key is not None:
                    sender.key.charge(seconds)
                if seconds > LONG:
                    self._metrics.long_inline.labels(route.operation_id).inc()
                    LOG.warning(
                        "the event loop was held",
                        extra={"operation": route.operation_id, "milliseconds": round(1e3 * seconds, 1)},
                    )
            if document is not None:
                return document
        return await self._compute.answer(route, body, npz, media, sender, later=later)

    def answer_inline(
        self, route: PostRoute, body: bytes, media: str | None = None, *, later: bool = False
    ) -> Document | None:
        """Return the answer to a small JSON request, None for one that belongs into a compute process.

        Parameters
        ----------
        media : str or None
            Media type of the document, None for JSON.
        later : bool
            As in `Compute.answer`.

        Raises
        ------
        Refusal, MechanicsError
            The request's own problem.
        """
        try:
            with work_limit(self._work):
                question = self._handler.read(route, body)
                if later:
                    return composed(route, self._handler.study_of_one(route, question), None)
                if not route.small(question):
                    return None
                return composed(route, self._handler.answer(route, question), media)
        except WorkLimitReached:
            self._metrics.handed_over.labels(route.operation_id).inc()
            return None
