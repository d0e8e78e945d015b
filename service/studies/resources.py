"""Studies over HTTP: submitted, listed, watched, dismissed, and their results. A client sees its own and no others."""

from __future__ import annotations

import asyncio
from collections import Counter
from collections.abc import AsyncIterator, Callable, Hashable, Iterator, Mapping, Sequence
from typing import Any

import orjson

from core.errors import BudgetExceeded
from service.execution.admission import Compute
from service.execution.daemon_thread import run_in_daemon_thread
from service.http.limits import idempotency_key, negotiated, parameters_of, refuse_parameters
from service.http.request_context import RequestContext
from service.problems import Fault, Refusal, headline
from service.responses import npz as archive
from service.responses.svg import SVG
from service.routes.studies import PATH
from service.routes.studies.views import RESULTS, STATE, StudyList, StudyResults, StudyState
from service.routing import ResourceRoute
from service.settings import Settings
from service.studies import comma_separated, grids, tables
from service.studies.chunk_files import CorruptedChunk
from service.studies.figures import figure
from service.studies.results import Results
from service.studies.states import JSON_TYPE, REPRESENTATIONS, signed, state_of
from service.studies.store import ORDERS, identity_of, storage_unavailable
from service.studies.study import DISMISSED, SUCCESSFUL, Owner, Quotas, Study
from service.studies.supervisor import Supervisor
from service.studies.unfinished_study import LARGEST_CHUNK

MOST_LISTED = 200
"""Studies of a page of the list."""

LONGEST_LIST = 10**9
"""The last study that a page of the list may begin with: more than a database holds."""

PAGE = 1000
LONGEST_PAGE = 10_000
"""Members of a page of results, unless asked for otherwise, and at most."""


def _in_query(name: str, description: str, **schema: Any) -> dict[str, Any]:
    return {"name": name, "in": "query", "description": description, "schema": schema}


PAGE_PARAMETERS = (
    _in_query("start", "The first of the members, 0 if left out.", type="integer", minimum=0),
    _in_query("count", f"Of members, {PAGE} if left out.", type="integer", minimum=1, maximum=LONGEST_PAGE),
)

LIST_PARAMETERS = (
    _in_query("start", "The first of the studies, 0 if left out.", type="integer", minimum=0),
    _in_query("count", f"Of studies, {MOST_LISTED} if left out.", type="integer", minimum=1, maximum=MOST_LISTED),
    _in_query("sort", "By which time, with a minus sign the latest first; -created if left out.", enum=[*ORDERS]),
)

BYTES_OF_A_NUMBER = 64
"""Of a page of results while it is made: 32 as an object in a list, 25 as text."""

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
                example=lambda: signed({"studies": [STATE], "next": None}),
                parameters=LIST_PARAMETERS,
            ),
            ResourceRoute(
                "GET",
                one,
                "get_study",
                "The state of a study",
                "studies",
                self.state,
                StudyState,
                example=lambda: signed(dict(STATE)),
            ),
            ResourceRoute(
                "DELETE",
                one,
                "dismiss_study",
                "Stop a study, or remove one that has ended with its results",
                "studies",
                self.dismiss,
                StudyState,
                example=lambda: signed({**STATE, "status": "dismissed"}),
            ),
            ResourceRoute(
                "GET",
                one + "/results",
                "get_study_results",
                "Statistics and results of a study, page by page or as a whole",
                "studies",
                self.results,
                StudyResults,
                representations=[kind for kind in REPRESENTATIONS if kind != JSON_TYPE],
                example=lambda: signed(dict(RESULTS)),
                parameters=PAGE_PARAMETERS,
            ),
            ResourceRoute(
                "GET",
                one + "/events",
                "watch_study",
                "The state of a study as server-sent events, until it ends",
                "studies",
                self.events,
                media_type="text/event-stream",
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
        limits = self._settings
        most = Quotas(limits.max_studies, limits.max_address_studies, limits.max_studies_bytes)
        owner = Owner(_owner(context), "" if context.key is not None else str(context.client))
        once = idempotency_key(context.headers)
        identity = identity_of(owner, once) if once else ""
        if not identity or not await self._in_thread(lambda: self._store.repeats(identity, body, known["path"])):
            if context.key is not None:
                context.key.work(seconds)
            try:
                identity = await run_in_daemon_thread(lambda: self._store.create(owner, body, known, most, identity))
            except Refusal:
                if context.key is not None:
                    context.key.charge(-seconds)
                raise
            if context.key is not None:
                self._supervisor.charge(identity, context.key, seconds)
        await run_in_daemon_thread(self._supervisor.ensure)
        study = await self._own(context, identity)
        location = f"{PATH}/{identity}".encode()
        await self._send(context, signed(state_of(study)), 202, ((b"location", location), *headers))

    async def list_all(self, context: RequestContext) -> None:
        """Answer with the client's studies."""
        query = _query(context, LIST_PARAMETERS)
        sort = query.get("sort", "-created")
        if sort not in ORDERS:
            fault = Fault("?sort", f"must be one of {', '.join(ORDERS)}")
            raise Refusal("invalid-parameter", headline([fault]), faults=[fault])
        start = _whole(query, "start", 0, LONGEST_LIST, 0)
        size = _whole(query, "count", 1, MOST_LISTED, MOST_LISTED)
        # One more than is sent says whether there are more.
        found = await self._in_thread(lambda: self._store.listed(_owner(context), ORDERS[sort], start, size + 1))
        after = f"{PATH}?start={start + size}&count={size}&sort={sort}" if len(found) > size else None
        await self._send(context, signed({"studies": [state_of(study) for study in found[:size]], "next": after}))

    async def state(self, context: RequestContext) -> None:
        """Answer with the state of a study."""
        await self._send(context, signed(state_of(await self._own(context))))

    async def dismiss(self, context: RequestContext) -> None:
        """Stop a study; remove one that has ended."""
        study = await self._own(context)
        if study.unfinished:
            await self._in_thread(lambda: self._store.end(study.id, DISMISSED, "dismissed by its client"))
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
                await self._stream(context, study, found.answer(), media)
            elif media == JSON_TYPE:
                await self._page(context, study, found)
            else:
                refuse_parameters(parameters_of(context.scope), f"must be left out: {media} has all members")
                pieces = {
                    archive.MEDIA_TYPE: found.archive,
                    tables.MEDIA_TYPE: lambda: tables.table(found),
                    grids.MEDIA_TYPE: lambda: grids.grid(found, self._store.folder / "scratch"),
                    comma_separated.MEDIA_TYPE: lambda: comma_separated.rows(found),
                    SVG: lambda: figure(found),
                }[media]()
                await self._stream(context, study, pieces, media)
        except ImportError as missing:
            detail = f"this service is installed without {missing.name}, which writes {media}"
            raise Refusal("not-acceptable", detail) from None
        except CorruptedChunk:
            await run_in_daemon_thread(self._supervisor.ensure)
            detail = "some of the results were damaged and are being computed again"
            raise Refusal("results-not-ready", detail, retry_after=2.0) from None

    async def _stream(self, context: RequestContext, study: Study, pieces: Iterator[bytes], media: str) -> None:
        # A stretch of members is in memory at a time; of one answer, all of it.
        size = study.plan["bytes"] * min(study.count, LARGEST_CHUNK) // study.count
        with self._compute.held.reserved(context.client, size):
            await context.stream_made_elsewhere(_stored(pieces), media.encode(), self._settings.stalled_seconds)

    async def _page(self, context: RequestContext, study: Study, found: Results) -> None:
        query = _query(context, PAGE_PARAMETERS)
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

        columns = len(study.plan["inputs"]) + len(study.plan["figures"])
        with self._compute.held.reserved(context.client, (stop - start) * columns * BYTES_OF_A_NUMBER):
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


def _query(context: RequestContext, known: Sequence[Mapping[str, Any]]) -> dict[str, str]:
    """Return the parameters of the query, or refuse those that are not known or are repeated."""
    query, names = parameters_of(context.scope), [one["name"] for one in known]
    unknown = (name for name in query if name not in names)
    refuse_parameters(unknown, "is not known here", f"known here: {', '.join(names)}")
    refuse_parameters((name for name in query if len(query[name]) > 1), "must be given once")
    return {name: given for name, (given,) in query.items()}


def _whole(query: Mapping[str, str], name: str, least: int, most: int, default: int) -> int:
    given = query.get(name, str(default))
    if not (given.isascii() and given.isdigit() and len(given) < 16 and least <= int(given) <= most):
        fault = Fault(f"?{name}", f"must be a whole number from {least} to {most}")
        raise Refusal("invalid-parameter", headline([fault]), faults=[fault])
    return int(given)
