"""The short cuts of the protocol: the same bytes on the wire as uvicorn's own, whatever a client does."""

import asyncio
import json
import re
from collections import Counter
from collections.abc import AsyncIterator, Iterator
from contextlib import asynccontextmanager
from typing import Any

import pytest
import uvicorn
from uvicorn.server import ServerState

from service.app import Service
from service.composing import Document
from service.protocol import LONG, LONGEST, Protocol, ShortCuts
from service.settings import Settings
from tests.service.conftest import TOYS
from tests.service.toy_routes import GOOD

pytestmark = pytest.mark.anyio

BODY = json.dumps(GOOD).encode()
HEAD = b"POST /v1/toy HTTP/1.1\r\nhost: x\r\ncontent-type: application/json\r\n"
LAST = b"GET /healthz HTTP/1.1\r\nhost: x\r\nconnection: close\r\n\r\n"
LARGE = json.dumps(GOOD | {"times": {"start": 0.0, "stop": 1.0, "count": 30_000}}).encode()
FAIR = json.dumps(GOOD | {"times": {"start": 0.0, "stop": 1.0, "count": 600}}).encode()
MIDDLING = json.dumps(GOOD | {"times": {"start": 0.0, "stop": 1.0, "count": 4_000}}).encode()


def ask(body: bytes = BODY, more: bytes = b"") -> bytes:
    return HEAD + more + b"content-length: %d\r\n\r\n" % len(body) + body


def chunked(body: bytes, more: bytes = b"") -> bytes:
    parts = b"".join(b"%x\r\n%b\r\n" % (len(part), part) for part in (body[:9], body[9:]))
    return HEAD + more + b"transfer-encoding: chunked\r\n\r\n" + parts + b"0\r\n\r\n"


@asynccontextmanager
async def serving(http: Any, **settings: Any) -> AsyncIterator[uvicorn.Server]:
    app = Service(Settings(inline_seconds=1e9, inline_bytes=10**9, **settings), TOYS)
    server = uvicorn.Server(
        uvicorn.Config(
            app,
            port=0,
            http=http,
            lifespan="off",
            log_config=None,
            access_log=False,
            server_header=False,
            date_header=False,
            headers=[("x-server", "one"), ("x-place", "two")],
        )
    )
    task = asyncio.create_task(server.serve())
    while not server.started:
        await asyncio.sleep(0.005)
    try:
        yield server
    finally:
        server.should_exit = True
        await task


async def connect(server: uvicorn.Server) -> tuple[asyncio.StreamReader, asyncio.StreamWriter]:
    return await asyncio.open_connection("127.0.0.1", server.servers[0].sockets[0].getsockname()[1])


async def told(server: uvicorn.Server, *pieces: bytes) -> bytes:
    """Send pieces with a pause between them and return all that comes back until the end."""
    reader, writer = await connect(server)
    for piece in pieces:
        writer.write(piece)
        await writer.drain()
        await asyncio.sleep(0.03 if len(pieces) > 1 else 0.0)
    received = await asyncio.wait_for(reader.read(), 20)
    writer.close()
    return received


def plain(received: bytes) -> bytes:
    """Return a response without what differs from request to request."""
    made = re.compile(rb"(?<=x-request-id: )[0-9a-f]{12}-[0-9a-f]+(?=\r\n)")
    return re.sub(rb"(?<=server-timing: total;dur=)[\d.]+", b"#", made.sub(b"#", received))


CASES: dict[str, tuple[bytes, ...]] = {
    "kept alive": (ask(), ask(), LAST),
    "pipelined": (ask() + ask() + ask(b"{}") + ask(LARGE) + ask() + LAST,),
    "closed by the client's wish": (ask(more=b"connection: close\r\n"),),
    "http 1.0": ((HEAD + b"content-length: %d\r\n\r\n" % len(BODY)).replace(b"1.1", b"1.0") + BODY,),
    "http 1.0 kept alive": (
        (HEAD + b"connection: keep-alive\r\ncontent-length: %d\r\n\r\n" % len(BODY)).replace(b"1.1", b"1.0") + BODY,
    ),
    "chunked": (chunked(BODY) + LAST,),
    "chunked in pieces": (chunked(BODY)[:-20], chunked(BODY)[-20:], LAST),
    "a body in pieces": (ask()[:-30], ask()[-30:-4], ask()[-4:], LAST),
    "headers in pieces": (ask()[:30], ask()[30:], LAST),
    "continue, asked": (HEAD + b"expect: 100-continue\r\ncontent-length: %d\r\n\r\n" % len(BODY), BODY, LAST),
    "continue, not waited for": (ask(more=b"expect: 100-continue\r\n"), LAST),
    "too large": (ask(b" " * 70_000),),
    "too large, chunked": (chunked(b" " * 70_000),),
    "refused": (ask(b"{}") + ask(b"{") + LAST,),
    "failed": (ask(json.dumps(GOOD | {"behaviour": "fail"}).encode(), b"x-request-id: same\r\n") + LAST,),
    "a large answer": (ask(LARGE) + LAST,),
    "a middling answer": (ask(MIDDLING) + LAST,),
    "had already": (ask(more=b"if-none-match: *\r\n") + LAST,),
    "had otherwise": (ask(more=b'if-none-match: "other"\r\n') + LAST,),
    "another origin": (ask(more=b"origin: https://a.example\r\n") + LAST,),
    "an id": (ask(more=b"x-request-id: mine-1\r\n") + LAST,),
    "an archive": (ask(more=b"accept: application/x-npz\r\n") + LAST,),
    "head": (b"HEAD /healthz HTTP/1.1\r\nhost: x\r\n\r\n" + LAST,),
    "nothing there": (b"GET /nothing HTTP/1.1\r\nhost: x\r\n\r\n" + LAST,),
    "garbage": (b"GARBAGE\r\n\r\n",),
    "garbage later": (ask(), b"GARBAGE\r\n\r\n"),
    "garbage behind the last": (ask(more=b"connection: close\r\n") + b"GARBAGE\r\n\r\n",),
}


@pytest.mark.parametrize("cached", [0, 100])
@pytest.mark.parametrize("case", CASES)
async def test_the_wire_is_that_of_uvicorn(case: str, cached: int) -> None:
    settings = {"max_body_bytes": 65_000, "cached_answers": cached}
    found = []
    for http in ("httptools", Protocol):
        async with serving(http, **settings) as server:
            # The second time an answer may come from those that are kept.
            found.append([plain(await told(server, *CASES[case])) for _ in range(2)])
    assert found[0] == found[1]
    assert found[0][0].startswith(b"HTTP/1.1 ")


H2C = b"connection: Upgrade, HTTP2-Settings\r\nupgrade: h2c\r\nhttp2-settings: AAMAAABkAAQAAP__\r\n"
WEBSOCKET = b"upgrade: websocket\r\nconnection: keep-alive, upgrade\r\nsec-websocket-version: 13\r\n"
CLOSING = b"connection: close, upgrade\r\nupgrade: websocket\r\n"
OFFERED = H2C, WEBSOCKET, CLOSING
OFFERS: dict[str, tuple[bytes, ...]] = {
    "http 2": (ask(more=H2C) + LAST,),
    "websocket": (ask(more=WEBSOCKET) + LAST,),
    "chunked": (chunked(BODY, H2C) + LAST,),
    "again and again": (ask(more=H2C) + ask() + chunked(BODY, WEBSOCKET) + ask(more=H2C) + LAST,),
    "in pieces": (ask(more=H2C)[:-30], ask(more=H2C)[-30:] + LAST),
    "in the headers": (ask(more=H2C)[:90], ask(more=H2C)[90:], LAST),
    "continue": (HEAD + H2C + b"expect: 100-continue\r\ncontent-length: %d\r\n\r\n" % len(BODY), BODY, LAST),
    "the last": (ask(more=CLOSING),),
    "no body": (LAST.replace(b"connection: close\r\n", CLOSING),),
    "refused": (ask(b"{", H2C) + LAST,),
    "garbage after": (ask(more=H2C) + b"GARBAGE\r\n\r\n",),
    "two lengths": (ask(more=H2C + b"content-length: 1\r\n") + LAST,),
}


@pytest.mark.parametrize("case", OFFERS)
async def test_who_offers_another_protocol_is_answered_in_this_one(case: str) -> None:
    """Byte for byte as who does not."""
    whole = b"".join(OFFERS[case])
    for offer in OFFERED:
        whole = whole.replace(offer, b"connection: close\r\n" if b"close" in offer else b"")
    # Whoever sends all at once is not told to continue.
    async with serving(Protocol, cached_answers=0) as server:
        offered = plain(await told(server, *OFFERS[case])).removeprefix(b"HTTP/1.1 100 Continue\r\n\r\n")
        assert offered == plain(await told(server, whole)).removeprefix(b"HTTP/1.1 100 Continue\r\n\r\n")
    assert offered.startswith(b"HTTP/1.1 ")


OPEN = HEAD + b"transfer-encoding: chunked\r\n"
BROKEN = b"\r\n1\r\n{\r\nno size\r\n"
IN_TURN: dict[str, tuple[bytes, list[int]]] = {
    "between requests": (ask() + ask(LARGE) + ask() + b"GARBAGE\r\n\r\n" + LAST, [200, 200, 200, 400]),
    "in the headers": (ask(LARGE) + HEAD + b"no colon\r\n\r\n" + LAST, [200, 400]),
    "in a body": (OPEN + BROKEN + LAST, [400]),
    "in a body behind others": (ask() + ask(LARGE) + OPEN + BROKEN + LAST, [200, 200, 400]),
    "behind an offer": (ask(LARGE) + ask(more=H2C) + b"\0\1\2" + LAST, [200, 200, 400]),
    "after nothing is left to be answered": (ask(more=b"connection: close\r\n") + b"\0" + LAST, [200]),
}


@pytest.mark.parametrize("case", IN_TURN)
async def test_what_is_no_http_is_answered_in_its_turn(case: str) -> None:
    whole, expected = IN_TURN[case]
    async with serving(Protocol) as server:
        for pieces in ((whole,), (whole[:-200], whole[-200:])):
            received = await told(server, *pieces)
            # Nothing stands within an answer that does not belong to it.
            found = [int(line[9:12]) for line in re.findall(rb"(?:^|(?<=[\n}\d.]))HTTP/1.1 \d+ ", received)]
            assert found == expected
            assert received.count(b"\r\n0\r\n\r\n") == whole.count(LARGE)
            assert received.endswith(b"}" if expected[-1] == 200 else b"\r\n\r\nInvalid HTTP request received.")


async def test_a_request_is_answered_once_though_its_body_breaks_off_into_nonsense() -> None:
    async with serving(Protocol) as server:
        head = OPEN.replace(b"application/json", b"text/plain")
        received = await told(server, head + b"\r\n1\r\n{\r\n", b"no size\r\n" + LAST)
    assert re.findall(rb"HTTP/1.1 \d+", received) == [b"HTTP/1.1 415"]


@pytest.mark.parametrize(
    "trailer",
    [
        b"content-type: text/plain\r\n",
        b"x-request-id: another\r\n",
        b"accept: text/csv\r\n",
        b"if-none-match: *\r\n",
        b"authorization: Bearer one\r\nexpect: 100-continue\r\n",
        b"connection: upgrade\r\nupgrade: h2c\r\n",
    ],
)
async def test_fields_behind_a_body_are_no_headers(trailer: bytes) -> None:
    question = chunked(BODY)
    async with serving(Protocol) as server:
        for pieces in (1, 2):
            asked = question[:-2] + trailer + b"\r\n"
            parts = (asked + LAST,) if pieces == 1 else (asked[:-9], asked[-9:] + LAST)
            assert plain(await told(server, *parts)) == plain(await told(server, question + LAST))


async def test_a_connection_that_is_closed_behind_a_body_is_closed() -> None:
    async with serving(Protocol) as server:
        asked = chunked(BODY)[:-2] + b"connection: close\r\n\r\n"
        received = await told(server, asked + LAST)
        assert plain(received) == plain(await told(server, ask(more=b"connection: close\r\n")))
        refused = asked.replace(b"application/json", b"text/plain")
        received = await told(server, refused[:-30], refused[-30:] + LAST)
    assert re.findall(rb"HTTP/1.1 \d+", received) == [b"HTTP/1.1 415"]


async def test_a_connection_to_somewhere_else_is_not_made() -> None:
    async with serving(Protocol) as server:
        assert (await told(server, b"CONNECT a:1 HTTP/1.1\r\nhost: x\r\n\r\n")).startswith(b"HTTP/1.1 400 ")


async def test_origins_are_told_either_way() -> None:
    for http in ("httptools", Protocol):
        async with serving(http, cors_origins="https://a.example") as server:
            received = await told(server, ask(more=b"origin: https://a.example\r\n") + LAST)
            assert b"\r\naccess-control-allow-origin: https://a.example\r\n" in received


@pytest.fixture
def writes(monkeypatch: pytest.MonkeyPatch) -> Counter[bool]:
    """Count which short cuts were taken, and which declined."""
    found: Counter[bool] = Counter()
    write = ShortCuts.write

    def counted(self: ShortCuts, headers: bytes, body: bytes, took: float) -> bool:
        taken = write(self, headers, body, took)
        found[taken] += 1
        return taken

    monkeypatch.setattr(ShortCuts, "write", counted)
    return found


async def test_small_answers_take_the_short_cut(writes: Counter[bool]) -> None:
    async with serving(Protocol, cached_answers=10) as server:
        await told(server, ask() + ask() + chunked(BODY) + ask(LARGE) + ask(MIDDLING) + LAST)
        assert writes == {True: 3, False: 1}
        await told(server, ask(more=b"connection: close\r\n"))
        assert writes == {True: 3, False: 2}


async def test_a_client_that_does_not_read_gets_everything_in_the_end(writes: Counter[bool]) -> None:
    async with serving(Protocol) as server:
        reader, writer = await connect(server)
        # More than all buffers on the way hold, so that the server has to wait for the client.
        writer.write(ask(FAIR) * 400 + LAST)
        await asyncio.sleep(0.5)
        received = await asyncio.wait_for(reader.read(), 60)
        writer.close()
    assert received.count(b"HTTP/1.1 200") == 401
    assert received.endswith(b'{"status":"alive"}')
    assert min(writes[True], writes[False]) > 0


async def test_a_client_that_leaves_harms_nobody() -> None:
    async with serving(Protocol) as server:
        for pieces in ((ask(),), (ask()[:-4],), (ask() * 50,), (ask(LARGE),)):
            _, writer = await connect(server)
            for piece in pieces:
                writer.write(piece)
            writer.transport.abort()
        await asyncio.sleep(0.1)
        assert (await told(server, ask() + LAST)).count(b"HTTP/1.1 200") == 2
        assert not server.server_state.tasks


@pytest.mark.parametrize("behind", [b"", ask()], ids=["alone", "another waits behind it"])
async def test_nothing_more_is_written_for_a_client_that_has_left(
    monkeypatch: pytest.MonkeyPatch, behind: bytes
) -> None:
    pieces: Counter[str] = Counter()
    written = Document.pieces

    def counted(self: Document) -> Iterator[bytes]:
        for piece in written(self):
            pieces["taken"] += 1
            yield piece

    monkeypatch.setattr(Document, "pieces", counted)
    endless = json.dumps(GOOD | {"times": {"start": 0.0, "stop": 1.0, "count": 1_000_000}}).encode()
    async with serving(Protocol) as server:
        reader, writer = await connect(server)
        writer.write(ask(endless) + behind)
        assert (await reader.readline()) == b"HTTP/1.1 200 OK\r\n"
        await asyncio.sleep(0.2)
        unread = pieces["taken"]
        writer.transport.abort()
        async with asyncio.timeout(20):
            while server.server_state.tasks:
                await asyncio.sleep(0.01)
    assert pieces["taken"] <= unread + 2


async def test_an_idle_connection_is_closed_when_the_server_stops() -> None:
    async with serving(Protocol) as server:
        reader, writer = await connect(server)
        writer.write(ask())
        assert (await reader.readline()) == b"HTTP/1.1 200 OK\r\n"
        server.should_exit = True
        rest = await asyncio.wait_for(reader.read(), 20)
        assert rest.endswith(b"}")
        writer.close()


class Cycle:
    """What a short cut sees of uvicorn's cycle: a request that has arrived whole and may be answered at once."""

    def __init__(self, **changes: Any) -> None:
        self.body, self.more_body = bytearray(b"{}"), False
        self.response_started = self.response_complete = self.disconnected = self.access_log = False
        self.waiting_for_100_continue, self.keep_alive = False, True
        self.default_headers = [(b"a", b"b")]
        self.scope: dict[str, Any] = {"method": "POST", "extensions": {}}
        self.write_paused = False
        self.written: list[bytes] = []
        self.flow = self.transport = self
        self.message_event = asyncio.Event()
        self.message_event.set()
        self.completed = 0
        for name, value in changes.items():
            setattr(self, name, value)

    def resume_reading(self) -> None:
        pass

    def write(self, data: bytes) -> None:
        self.written.append(data)

    def on_response(self) -> None:
        self.completed += 1


class Transport:
    """Notes what a protocol does to its transport."""

    def __init__(self) -> None:
        self.done: list[bytes] = []

    def write(self, data: bytes) -> None:
        self.done.append(data)

    def close(self) -> None:
        self.done.append(b"closed")

    def is_closing(self) -> bool:
        return b"closed" in self.done

    def get_extra_info(self, name: str) -> Any:
        return None


def connected() -> tuple[Protocol, Transport]:
    config = uvicorn.Config(Service(Settings(), TOYS), log_config=None, lifespan="off")
    protocol, transport = Protocol(config, ServerState(), {}), Transport()
    protocol.connection_made(transport)  # type: ignore[arg-type]
    return protocol, transport


async def test_responses_are_sent_behind_all_work_that_is_ready() -> None:
    protocol, transport = connected()
    found = []
    protocol.send_soon(b"answer")
    asyncio.get_running_loop().call_soon(lambda: found.append(list(transport.done)))
    assert not transport.done
    await asyncio.sleep(0)
    assert (transport.done, found) == ([b"answer"], [[b"answer"]])


@pytest.mark.parametrize(
    ("event", "after"),
    [
        (lambda protocol: protocol.shutdown(), [b"closed"]),
        (lambda protocol: protocol.data_received(b"GET"), []),
        (lambda protocol: protocol.send_400_response("no"), [b"HTTP/1.1 400 Bad Request", b"closed"]),
        (lambda protocol: protocol.eof_received() or protocol.transport.close(), [b"closed"]),
    ],
    ids=["shutdown", "more", "no http", "the end of requests"],
)
async def test_nothing_overtakes_a_response(event: Any, after: list[bytes]) -> None:
    protocol, transport = connected()
    protocol.send_soon(b"answer")
    event(protocol)
    assert [done.split(b"\r\n")[0] for done in transport.done] == [b"answer", *after]
    await asyncio.sleep(0)
    assert transport.done.count(b"answer") == 1


@pytest.mark.parametrize(("took", "soon"), [(0.0, True), (LONG / 2, True), (LONG, False), (0.1, False)])
def test_what_took_long_waits_for_nothing_else(took: float, soon: bool) -> None:
    cycle: Any = Cycle()
    kept: list[bytes] = []
    assert ShortCuts(cycle, kept.append).write(b"c: d\r\n", b"body", took)
    assert (len(kept), len(cycle.written)) == (int(soon), int(not soon))


def test_a_response_is_written_once() -> None:
    cycle: Any = Cycle()
    cuts = ShortCuts(cycle, cycle.write)
    assert cuts.read(2) == b"{}"
    assert not cycle.message_event.is_set()
    assert cuts.write(b"c: d\r\n", b"body", 0.0)
    assert cycle.written == [b"HTTP/1.1 200 OK\r\na: b\r\nc: d\r\n\r\nbody"]
    assert (cycle.response_complete, cycle.completed, cycle.message_event.is_set()) == (True, 1, True)
    assert not cuts.write(b"c: d\r\n", b"body", 0.0)
    assert len(cycle.written) == 1


@pytest.mark.parametrize(
    "change",
    [
        {"response_started": True},
        {"disconnected": True},
        {"keep_alive": False},
        {"waiting_for_100_continue": True},
        {"more_body": True},
        {"write_paused": True},
        {"access_log": True},
        {"scope": {"method": "HEAD", "extensions": {}}},
    ],
    ids=lambda change: next(iter(change)),
)
def test_a_response_that_is_no_plain_matter_is_left_alone(change: dict[str, Any]) -> None:
    cycle: Any = Cycle(**change)
    assert not ShortCuts(cycle, cycle.write).write(b"c: d\r\n", b"body", 0.0)
    assert (cycle.written, cycle.completed, cycle.response_complete) == ([], 0, False)


def test_a_long_body_is_not_copied() -> None:
    cycle: Any = Cycle()
    assert not ShortCuts(cycle, cycle.write).write(b"", b"x" * (LONGEST + 1), 0.0)


@pytest.mark.parametrize(
    "change",
    [
        {"more_body": True},
        {"waiting_for_100_continue": True},
        {"disconnected": True},
        {"response_complete": True},
        {"body": bytearray(b"{} ")},
    ],
    ids=lambda change: next(iter(change)),
)
def test_a_request_that_is_no_plain_matter_is_left_alone(change: dict[str, Any]) -> None:
    cycle: Any = Cycle(**change)
    body = bytes(cycle.body)
    assert ShortCuts(cycle, cycle.write).read(2) is None
    assert bytes(cycle.body) == body
    assert cycle.message_event.is_set()
