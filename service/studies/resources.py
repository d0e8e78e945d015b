"""Studies over HTTP: submitted, listed, watched, dismissed, and their results. A client sees its own and no others."""

from __future__ import annotations

import asyncio
from collections import Counter
from collections.abc import AsyncIterator, Callable, Hashable, Iterator
from typing import Any

import orjson

from core.errors import BudgetExceeded
from service.execution.admission import Compute
from service.execution.daemon_thread import run_in_daemon_thread
from service.http.limits import negotiated, parameters_of, refuse_parameters
from service.http.request_context import RequestContext
from service.problems import Fault, Refusal, headline
from service.responses import npz as archive
from service.responses.svg import SVG
from service.routes.studies import PATH
from service.routes.studies.views import RESULTS, STATE, StudyList, StudyResults, StudyState
from service.routing import ResourceRoute
from service.settings import Settings
from service.studies import grids, tables
from service.studies.chunk_files import CorruptedChunk
from service.studies.figures import figure
from service.studies.results import Results
from service.studies.states import JSON_TYPE, REPRESENTATIONS, signed, state_of
from service.studies.store import storage_unavailable
from service.studies.study import DISMISSED, SUCCESSFUL, Owner, Quotas, Study
from service.studies.supervisor import Supervisor

MOST_LISTED = 200

PAGE = 1000
LONGEST_PAGE = 10_000
"""Members of a page of results, unless asked for otherwise, and at most."""

WORDS_OF_PAGE = ("start", "count")
"""What a page of results may be chosen by."""


EVENTS_EVERY = 0.25
"""Seconds between two looks at a study that is watched."""

MOST_WATCHED = 200
"""Connections on which events are sent, in all; those of one study share the looks at it."""

MOST_WATCHED_BY_ONE = 50
"""Of them, those of one client."""


class Studies:
    """The resources of studies in one server process."""

    def __init__(self, settings: Settings, supervisor: Supervisor, compute: Compute) -> None:
        self._settings, self._supervisor, self._compute = settings, supervisor, compute
        self._store = supervisor.store
        self._watching = Counter[Hashable]()
        self._looks: dict[tuple[str, str], asyncio.Future[Study]] = {}

    def routes(self) -> tuple[ResourceRoute, ...]:
        """Return the routes of studies that exist."""
        one = PATH + "/{study}"
        return (
            ResourceRoute(
                "GET",
                PATH,
                "list_studies",
                "The client's own studies",
                "studies",
                self.list_all,
                StudyList,
                example=signed({"studies": [STATE]}),
            ),
            ResourceRoute(
                "GET",
                one,
                "get_study",
                "The state of a study",
                "studies",
                self.state,
                StudyState,
                example=signed(dict(STATE)),
            ),
            ResourceRoute(
                "DELETE",
                one,
                "dismiss_study",
                "Stop a study, or remove one that has ended with its results",
                "studies",
                self.dismiss,
                StudyState,
                example=signed({**STATE, "status": "dismissed"}),
            ),
            ResourceRoute(
                "GET",
                one + "/results",
                "get_study_results",
                "Statistics and results of a study, page by page or as a whole",
                "studies",
                self.results,
                StudyResults,
                description="`?start=` and `?count=` (at most 10000) choose the members of a page. Other media types "
                "have all members.",
                representations=(archive.MEDIA_TYPE, tables.MEDIA_TYPE, grids.MEDIA_TYPE, SVG),
                example=signed(dict(RESULTS)),
            ),
            ResourceRoute(
                "GET",
                one + "/events",
                "watch_study",
                "The state of a study as server-sent events, until it ends",
                "studies",
                self.events,
                representations=("text/event-stream",),
            ),
        )

    async def submit(
        self, context: RequestContext, body: bytes, plan: bytes, headers: tuple[tuple[bytes, bytes], ...]
    ) -> None:
        """Record a study whose plan is known, and answer with its state, with some headers more."""
        known = orjson.loads(plan)
        seconds, limit = known["seconds"], self._settings.max_study_seconds
        if seconds > limit:
            remedy = "take fewer members, or several studies"
            raise BudgetExceeded("seconds", round(seconds), round(limit), path=("vary",), remedy=remedy)
        # What has no place for its results is refused at once.
        await self._in_thread(self._supervisor.files)
        if context.key is not None:
            context.key.work(seconds)
        limits = self._settings
        most = Quotas(limits.max_studies, limits.max_address_studies, limits.max_studies_bytes)
        owner = Owner(_owner(context), "" if context.key is not None else str(context.client))
        try:
            identity = await run_in_daemon_thread(lambda: self._store.create(owner, body, known, most))
        except Refusal:
            if context.key is not None:
                context.key.charge(-seconds)
            raise
        await run_in_daemon_thread(self._supervisor.ensure)
        study = await self._own(context, identity)
        location = f"{PATH}/{identity}".encode()
        await self._send(context, signed(state_of(study)), 202, ((b"location", location), *headers))

    async def list_all(self, context: RequestContext) -> None:
        """Answer with the client's studies."""
        found = await self._in_thread(lambda: self._store.listed(_owner(context), MOST_LISTED))
        await self._send(context, signed({"studies": [state_of(study) for study in found]}))

    async def state(self, context: RequestContext) -> None:
        """Answer with the state of a study."""
        await self._send(context, signed(state_of(await self._own(context))))

    async def dismiss(self, context: RequestContext) -> None:
        """Stop a study; remove one that has ended."""
        study = await self._own(context)
        if study.unfinished:
            await self._in_thread(lambda: self._store.end(study.id, DISMISSED, "dismissed by its client"))
            if context.key is not None:
                # What is not going to be computed is given back.
                left = study.plan["seconds"] * (1.0 - study.done / study.count)
                context.key.charge(-left)
            await self._send(context, signed(state_of(await self._own(context))))
            return

        def remove() -> None:
            self._supervisor.files().remove(study.id)
            self._store.remove(study.id)

        await self._in_thread(remove)
        await self._send(context, signed(state_of(study)))

    async def results(self, context: RequestContext) -> None:
        """Answer with results, in the media type that the client accepts."""
        study = await self._own(context)
        if study.status != SUCCESSFUL:
            detail = f"the study is {study.status}"
            raise Refusal("results-not-ready", detail, retry_after=1.0 if study.unfinished else None)
        accept = context.headers.get(b"accept", b"*/*")
        media = negotiated(accept, (JSON_TYPE,) if study.whole else tuple(REPRESENTATIONS))
        try:
            found = await self._in_thread(lambda: Results(study, self._store, self._supervisor.files()))
            if study.whole:
                refuse_parameters(parameters_of(context.scope), "must be left out: the result is one answer")
                pieces = _stored(found.answer())
                await context.stream_made_elsewhere(pieces, media.encode(), self._settings.stalled_seconds)
            elif media == JSON_TYPE:
                await self._page(context, study, found)
            else:
                refuse_parameters(parameters_of(context.scope), f"must be left out: {media} has all members")
                pieces = {
                    archive.MEDIA_TYPE: found.archive,
                    tables.MEDIA_TYPE: lambda: tables.table(found),
                    grids.MEDIA_TYPE: lambda: grids.grid(found, self._store.folder / "scratch"),
                    SVG: lambda: figure(found),
                }[media]()
                await context.stream_made_elsewhere(_stored(pieces), media.encode(), self._settings.stalled_seconds)
        except ImportError as missing:
            detail = f"this service is installed without {missing.name}, which writes {media}"
            raise Refusal("not-acceptable", detail) from None
        except CorruptedChunk:
            await run_in_daemon_thread(self._supervisor.ensure)
            detail = "some of the results were damaged and are being computed again"
            raise Refusal("results-not-ready", detail, retry_after=2.0) from None

    async def _page(self, context: RequestContext, study: Study, found: Results) -> None:
        query = parameters_of(context.scope)
        refuse_parameters((name for name in query if name not in WORDS_OF_PAGE), "is not known here")
        refuse_parameters((name for name in WORDS_OF_PAGE if len(query.get(name, ())) > 1), "must be given once")
        start = _whole(query, "start", 0, study.count - 1, 0)
        size = _whole(query, "count", 1, LONGEST_PAGE, PAGE)
        stop = min(study.count, start + size)

        def made() -> dict[str, Any]:
            page = {
                "warnings": [],
                "jobID": study.id,
                "count": study.count,
                "shape": study.plan["shape"],
                "statistics": self._store.statistics(study.id),
                "start": start,
                **found.page(start, stop),
            }
            after = f"{PATH}/{study.id}/results?start={stop}&count={size}"
            return signed(page | {"next": after if stop < study.count else None})

        await self._send(context, await self._in_thread(made))

    async def events(self, context: RequestContext) -> None:
        """Send the state of a study whenever it has changed, until it has ended."""
        study = await self._own(context)
        negotiated(context.headers.get(b"accept", b"*/*"), ("text/event-stream",))
        client = context.client
        if self._watching.total() >= MOST_WATCHED or self._watching[client] >= MOST_WATCHED_BY_ONE:
            detail = f"{self._watching.total()} connections watch studies, {self._watching[client]} of them yours"
            raise Refusal("too-busy", detail, retry_after=5.0)
        self._watching[client] += 1
        try:
            await context.events(self._changes(context, study))
        finally:
            self._watching[client] -= 1
            if not self._watching[client]:
                del self._watching[client]

    async def _changes(self, context: RequestContext, study: Study) -> AsyncIterator[bytes]:
        before = None
        while True:
            now = (study.status, study.message, study.done)
            if now != before:
                before = now
                yield b"event: %s\ndata: %s\n\n" % (study.status.encode(), orjson.dumps(state_of(study)))
            if not study.unfinished:
                return
            await asyncio.sleep(EVENTS_EVERY)
            study = await self._looked_at(context, study.id)

    async def _looked_at(self, context: RequestContext, identity: str) -> Study:
        """Return a client's own study as it was at most half of `EVENTS_EVERY` ago.

        Each look is a thread and a query: for every connection on its own, they would hold up other requests.
        """
        key = (_owner(context), identity)
        look = self._looks.get(key)
        if look is None:
            look = self._looks[key] = asyncio.ensure_future(self._own(context, identity))
            look.add_done_callback(lambda done: self._forget_later(key, done))
        # A client that leaves takes the look away from nobody.
        return await asyncio.shield(look)

    def _forget_later(self, key: tuple[str, str], look: asyncio.Future[Study]) -> None:
        if not look.cancelled():
            # Where all who waited have left, nobody else takes note of a failure.
            look.exception()
        look.get_loop().call_later(EVENTS_EVERY / 2, self._looks.pop, key, None)

    async def _own(self, context: RequestContext, identity: str | None = None) -> Study:
        """Return the study that a request is about, if it is its client's."""
        name = identity or context.scope["path_params"]["study"]
        found: Study | None = await self._in_thread(lambda: self._store.get(name, _owner(context)))
        if found is None:
            raise Refusal("not-found", "there is no such study; GET /v1/studies lists yours")
        return found

    async def _in_thread(self, work: Callable[[], Any]) -> Any:
        try:
            return await run_in_daemon_thread(work)
        except OSError as fault:
            raise storage_unavailable(fault) from fault

    async def _send(
        self, context: RequestContext, document: Any, status: int = 200, headers: tuple[tuple[bytes, bytes], ...] = ()
    ) -> None:
        await context.document(orjson.dumps(document), status, headers)


def _stored(pieces: Iterator[bytes]) -> Iterator[bytes]:
    """Yield what is made of stored results, or raise that they cannot be read now."""
    try:
        yield from pieces
    except OSError as fault:
        raise storage_unavailable(fault) from fault


def _owner(context: RequestContext) -> str:
    return "" if context.key is None else context.key.name


def _whole(query: dict[str, list[str]], name: str, least: int, most: int, default: int) -> int:
    given = query.get(name, [str(default)])[-1]
    if not (given.isascii() and given.isdigit() and len(given) < 16 and least <= int(given) <= most):
        fault = Fault(f"?{name}", f"must be a whole number from {least} to {most}")
        raise Refusal("invalid-parameter", headline([fault]), faults=[fault])
    return int(given)
