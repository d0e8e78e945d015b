"""The protocol with its rounds: the same bytes on the wire as uvicorn's own, whatever a client does."""

import asyncio
import json
import re
from collections import Counter
from collections.abc import AsyncIterator, Iterator
from contextlib import asynccontextmanager
from pathlib import Path
from typing import Any

import pytest
import uvicorn
from uvicorn.server import ServerState

from service.app import Service
from service.composing import Document
from service.heads import MATTERS
from service.keys import new_key
from service.protocol import LONGEST_HEAD, MOST_BEHIND, PARSED_AT_ONCE, Protocol
from service.rounds import ROUNDS, Rounds
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

TRAP = HEAD + b"content-length: 2\r\n\r\n"
LOOSE = (HEAD + b"content-length: 6\r\n\r\n").replace(b"\r\n", b"\n") + b"{}\r\n\r\n"
FAILING = json.dumps(GOOD | {"behaviour": "unreachable"}).encode()
NOT_FINITE = json.dumps(GOOD | {"behaviour": "nan"}).encode()


def ask(body: bytes = BODY, more: bytes = b"") -> bytes:
    return HEAD + more + b"content-length: %d\r\n\r\n" % len(body) + body


def chunked(body: bytes, more: bytes = b"") -> bytes:
    parts = b"".join(b"%x\r\n%b\r\n" % (len(part), part) for part in (body[:9], body[9:]))
    return HEAD + more + b"transfer-encoding: chunked\r\n\r\n" + parts + b"0\r\n\r\n"


class InOneProcess(Service):
    """The application without compute processes, which starts at once."""

    async def __call__(self, scope: Any, receive: Any, send: Any) -> None:
        if scope["type"] != "lifespan":
            await super().__call__(scope, receive, send)
            return
        scope["state"][ROUNDS] = self.dispatcher.rounds
        for name in ("startup", "shutdown"):
            await receive()
            await send({"type": f"lifespan.{name}.complete"})


@asynccontextmanager
async def serving(http: Any, config: dict[str, Any] | None = None, **settings: Any) -> AsyncIterator[uvicorn.Server]:
    app = InOneProcess(Settings(inline_seconds=1e9, inline_bytes=10**9, **settings), TOYS)
    server = uvicorn.Server(
        uvicorn.Config(
            app,
            port=0,
            http=http,
            lifespan="on",
            log_config=None,
            server_header=False,
            date_header=False,
            headers=[("x-server", "one"), ("x-place", "two")],
            **{"access_log": False, **(config or {})},
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
    "ids one by one": (*(ask(more=b"X-Request-ID: mine-%d\r\n" % i) for i in range(3)), LAST),
    "ids that are not plain": (ask(), ask(more=b"x-request-id: m\xffne\r\n"), ask(more=b"x-request-id: \r\n"), LAST),
    "an id that is too long": (ask(), ask(more=b"x-request-id: %b\r\n" % (b"x" * 65)), LAST),
    "two ids one by one": (ask(), ask(more=b"x-request-id: a\r\nx-request-id: b\r\n"), LAST),
    "a folded id": (ask(), ask(more=b"x-request-id: a\r\n b\r\n")),
    "a trace": (ask(more=b"traceparent: 00-1-2-01\r\n"), ask(more=b"traceparent: 00-3-4-01\r\n"), LAST),
    "an archive": (ask(more=b"accept: application/x-npz\r\n") + LAST,),
    "several one by one": (ask(), ask(b"{}"), ask(LARGE), ask(FAIR), ask(), ask(b"{"), LAST),
    "warned": (ask(json.dumps(GOOD | {"behaviour": "warn"}).encode()), ask(), LAST),
    "failed one by one": (ask(FAILING), ask(more=b"x-request-id: same\r\n"), LAST),
    "not finite": (ask(NOT_FINITE, b"x-request-id: same\r\n"), ask(), LAST),
    "a pair behind one": (ask(), ask() + ask(), LAST),
    "one and a half": (ask(), ask() + ask()[:40], ask()[40:], LAST),
    "an empty body": (ask(b""), ask(b""), ask(), LAST),
    "head and body apart": (
        ask()[: -len(BODY)],
        BODY,
        ask()[: -len(BODY)],
        BODY,
        ask(),
        ask()[: -len(BODY)],
        BODY,
        LAST,
    ),
    "a known head, and its body piece by piece": (ask(), ask()[:-30], ask()[-30:-4], ask()[-4:], LAST),
    "a known head, and more than its body": (ask(), ask()[:-30], ask()[-30:] + ask() + LAST),
    "a body like a head": (ask(TRAP), ask(TRAP), TRAP.strip() + b"{}", LAST),
    "bodies like heads, without returns": (LOOSE,),
    "no length": (HEAD + b"\r\n", LAST),
    "two types": (ask(more=b"content-type: text/plain\r\n"), LAST),
    "another type": (ask().replace(b"application/json", b"text/plain"), ask(), LAST),
    "json with a character set": (ask().replace(b"/json", b"/json; charset=utf-8"), LAST),
    "a name of the client": (ask(more=b"user-agent: a\r\ncookie: b=c\r\n"), ask(), LAST),
    "kept alive by name": (ask(more=b"connection: keep-alive\r\n"), ask(), LAST),
    "a query": (ask().replace(b"/v1/toy ", b"/v1/toy?a=b "), LAST),
    "an escaped path": (ask().replace(b"/v1/toy ", b"/v1/t%6fy "), LAST),
    "an empty line before": (b"\r\n" + ask(), LAST),
    "lines without returns": ((HEAD + b"content-length: 2\r\n\r\n{}").replace(b"\r\n", b"\n"), LAST),
    "a length with a zero": (ask().replace(b"length: ", b"length: 0"), LAST),
    "a length that is none": (ask().replace(b"length: ", b"length: x"),),
    "a body that is too short": (ask()[:-1], b"}" + LAST),
    "head": (b"HEAD /healthz HTTP/1.1\r\nhost: x\r\n\r\n" + LAST,),
    "nothing there": (b"GET /nothing HTTP/1.1\r\nhost: x\r\n\r\n" + LAST,),
    "garbage": (b"GARBAGE\r\n\r\n",),
    "garbage later": (ask(), b"GARBAGE\r\n\r\n"),
    "garbage behind the last": (ask(more=b"connection: close\r\n") + b"GARBAGE\r\n\r\n",),
}


@pytest.mark.parametrize(
    ("case", "cached"),
    [*((case, 100) for case in CASES), *((case, 0) for case in CASES if "alive" in case or " by " in case)],
)
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


async def test_another_request_instead_of_the_rest_of_a_body_is_taken_for_it() -> None:
    async with serving(Protocol) as server:
        received = await told(server, ask(), ask()[:-30], ask())
    assert re.findall(rb"HTTP/1.1 \d+", received) == [b"HTTP/1.1 200", b"HTTP/1.1 400", b"HTTP/1.1 400"]
    assert received.index(b"invalid-json") < received.index(b"Invalid HTTP request received.")


TINY = b"GET /healthz HTTP/1.1\r\n\r\n"
LONG = b"x: " + b"y" * LONGEST_HEAD
TOO_LONG: dict[str, tuple[bytes, int]] = {
    "one field": (HEAD + LONG, 0),
    "many fields": (HEAD + b"x: y\r\n" * (LONGEST_HEAD // 6), 0),
    "a target": (b"GET /" + LONG[3:], 0),
    "behind others": (TINY * 3 + ask(LARGE) + HEAD + LONG, 4),
    "a name": (HEAD + LONG[3:], 0),
    "empty lines": (TINY + b"\r\n" * LONGEST_HEAD, 1),
    "behind a body": (chunked(BODY)[:-2] + LONG, 0),
    "the length of a chunk": (OPEN + b"\r\n1;" + LONG[3:], 0),
}


@pytest.mark.parametrize("case", TOO_LONG)
async def test_a_head_that_does_not_end_is_refused_in_its_turn(case: str) -> None:
    whole, before = TOO_LONG[case]
    async with serving(Protocol) as server:
        reader, writer = await connect(server)
        writer.write(whole + b"y" * (2 * PARSED_AT_ONCE))
        try:
            received = await asyncio.wait_for(reader.read(), 20)
        finally:
            writer.close()
    assert received.count(b"HTTP/1.1 200") == before
    assert re.findall(rb"HTTP/1.1 \d+", received)[before:] == [b"HTTP/1.1 400"]
    assert received.endswith(b"A request with more than 65536 bytes of headers is not read.")


async def test_long_heads_are_read_up_to_a_limit_that_each_request_has_to_itself() -> None:
    asked = ask(more=LONG[: LONGEST_HEAD - PARSED_AT_ONCE] + b"\r\n")
    closing = chunked(BODY, b"connection: close\r\n")[:-2]
    trailer = LONG[: LONGEST_HEAD - PARSED_AT_ONCE] + b"\r\n\r\n"
    async with serving(Protocol) as server:
        received = await told(server, asked + asked + ask(b" " * 100_000) + asked + closing + trailer)
    assert re.findall(rb"HTTP/1.1 (\d+)", received) == [b"200", b"200", b"400", b"200", b"200"]


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
def asked(monkeypatch: pytest.MonkeyPatch) -> list[bytes]:
    """The bodies of the questions that have been answered in rounds."""
    found: list[bytes] = []
    ask_in_round = Rounds.ask

    def noted(self: Rounds, asker: Any, route: Any, body: bytes, identity: bytes | None) -> None:
        found.append(body)
        ask_in_round(self, asker, route, body, identity)

    monkeypatch.setattr(Rounds, "ask", noted)
    return found


async def test_what_is_asked_as_before_is_answered_in_rounds(asked: list[bytes]) -> None:
    async with serving(Protocol) as server:
        await told(server, ask(), LAST)
        assert not asked
        other = BODY.replace(b"0.1", b"0.2")
        await told(server, ask(), ask(other), LAST)
        assert asked == [BODY, other]
        await told(server, ask() + ask(), chunked(BODY), ask(more=b"connection: close\r\n"))
        assert asked == [BODY, other]
        await told(server, ask()[:-9], ask()[-9:], LAST)
        assert asked == [BODY, other, BODY]
        await told(server, ask(more=b"x-request-id: a\r\n"), ask(more=b"x-request-id: b\r\n"), LAST)
        assert asked == [BODY, other, BODY, BODY, BODY]


async def test_a_head_is_learned_before_its_body_has_come(asked: list[bytes]) -> None:
    async with serving(Protocol) as server:
        apart = ask()[: -len(BODY)], BODY
        received = await told(server, *apart, *apart, LAST)
    assert asked == [BODY]
    assert received.count(b"HTTP/1.1 200") == 3


async def test_the_server_waits_for_the_rest_of_a_body_when_it_stops() -> None:
    async with serving(Protocol) as server:
        await told(server, ask(), LAST)
        reader, writer = await connect(server)
        writer.write(ask()[:-9])
        await asyncio.sleep(0.05)
        server.should_exit = True
        await asyncio.sleep(0.2)
        writer.write(ask()[-9:])
        received = await asyncio.wait_for(reader.read(), 20)
        writer.close()
    assert received.startswith(b"HTTP/1.1 200 OK\r\n")
    assert b"\r\nconnection: close\r\n" in received


@pytest.mark.parametrize("name", sorted(MATTERS - {b"x-request-id"}))
async def test_a_header_that_matters_is_looked_at_each_time(asked: list[bytes], name: bytes) -> None:
    values = {b"transfer-encoding": b"chunked", b"expect": b"100-continue", b"upgrade": b"h2c"}
    more = b"%b: %b\r\n" % (name, values.get(name, b"gzip"))
    question = chunked(BODY) if name == b"transfer-encoding" else ask(more=more)
    async with serving(Protocol) as server:
        for _ in range(2):
            await told(server, question, LAST)
    assert not asked


@pytest.mark.parametrize("config", [{"access_log": True}, {"limit_concurrency": 100}], ids=str)
async def test_what_the_server_is_to_do_for_each_request_is_left_to_it(
    monkeypatch: pytest.MonkeyPatch, asked: list[bytes], config: dict[str, Any]
) -> None:
    monkeypatch.setattr("logging.Logger.hasHandlers", lambda self: self.name == "uvicorn.access")
    async with serving(Protocol, config) as server:
        await told(server, ask(), ask(), LAST)
    assert not asked


@pytest.mark.parametrize("settings", [{"cors_origins": "*"}, {"keys_file": True}], ids=["origins", "keys"])
async def test_who_asks_is_looked_at_each_time(asked: list[bytes], settings: dict[str, Any], tmp_path: Path) -> None:
    if "keys_file" in settings:
        key, line = new_key("one")
        settings = {"keys_file": tmp_path / "keys"}
        settings["keys_file"].write_text(line + "\n")
        more = b"authorization: Bearer %b\r\n" % key.encode()
    else:
        more = b"origin: https://a.example\r\n"
    async with serving(Protocol, **settings) as server:
        received = await told(server, ask(more=more), ask(more=more), LAST)
    assert received.count(b"HTTP/1.1 200") == 3
    assert not asked


async def test_a_client_that_does_not_read_gets_everything_in_the_end(asked: list[bytes]) -> None:
    async with serving(Protocol) as server:
        reader, writer = await connect(server)
        # More than all buffers on the way hold, so that the server has to wait for the client.
        for _ in range(400):
            writer.write(ask(FAIR))
            await asyncio.sleep(0.001)
        writer.write(LAST)
        received = await asyncio.wait_for(reader.read(), 60)
        writer.close()
    assert received.count(b"HTTP/1.1 200") == 401
    assert received.endswith(b'{"status":"alive"}')
    assert 0 < len(asked) < 399


async def test_of_many_requests_in_a_row_few_wait_and_all_are_answered_in_turn(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    waiting: list[int] = []
    answered = Protocol.on_response_complete

    def noted(self: Protocol) -> None:
        waiting.append(len(self.pipeline))
        answered(self)

    monkeypatch.setattr(Protocol, "on_response_complete", noted)
    turns = [b"GET /%d HTTP/1.1\r\nx-request-id: %d\r\n\r\n" % (i, i) for i in range(6_000)]
    async with serving(Protocol) as server:
        received = await told(server, b"".join(turns[:3_000]) + ask(LARGE) + b"".join(turns[3_000:]) + LAST)
    assert [int(i) for i in re.findall(rb"x-request-id: (\d+)\r", received)] == list(range(6_000))
    assert received.endswith(b'{"status":"alive"}')
    assert 0 < max(waiting) <= PARSED_AT_ONCE // len(turns[0])


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


class Transport:
    """Notes what a protocol does to its transport."""

    def __init__(self) -> None:
        self.done: list[bytes] = []
        self.reading = True

    def pause_reading(self) -> None:
        self.reading = False

    def resume_reading(self) -> None:
        self.reading = True

    def write(self, data: bytes) -> None:
        self.done.append(data)

    def close(self) -> None:
        self.done.append(b"closed")

    def is_closing(self) -> bool:
        return b"closed" in self.done

    def get_extra_info(self, name: str) -> Any:
        return None


def connected() -> tuple[Protocol, Transport]:
    service = Service(Settings(), TOYS)
    config = uvicorn.Config(service, log_config=None, access_log=False, lifespan="off")
    protocol, transport = Protocol(config, ServerState(), {ROUNDS: service.dispatcher.rounds}), Transport()
    protocol.connection_made(transport)  # type: ignore[arg-type]
    protocol.data_received(ask())
    return protocol, transport


def statuses(transport: Transport) -> list[bytes]:
    return [
        done.split(b"\r\n")[0].removeprefix(b"HTTP/1.1 ") for done in transport.done if done[:4] in (b"HTTP", b"clos")
    ]


async def until_answered(transport: Transport, count: int) -> None:
    async with asyncio.timeout(20):
        while len(statuses(transport)) < count:
            await asyncio.sleep(0)


async def test_answers_are_sent_behind_all_work_that_is_ready() -> None:
    protocol, transport = connected()
    await until_answered(transport, 1)
    protocol.data_received(ask())
    found = []
    asyncio.get_running_loop().call_soon(lambda: found.append(statuses(transport)))
    assert statuses(transport) == [b"200 OK"]
    await asyncio.sleep(0)
    assert (statuses(transport), found) == ([b"200 OK"] * 2, [[b"200 OK"] * 2])


@pytest.mark.parametrize(
    ("event", "after"),
    [
        (lambda protocol: protocol.shutdown(), [b"closed"]),
        (lambda protocol: protocol.data_received(b"GET"), []),
        (lambda protocol: protocol.data_received(b"\0"), [b"400 Bad Request", b"closed"]),
        (lambda protocol: protocol.eof_received() or protocol.transport.close(), [b"closed"]),
    ],
    ids=["shutdown", "more", "no http", "the end of requests"],
)
async def test_nothing_overtakes_an_answer(event: Any, after: list[bytes]) -> None:
    protocol, transport = connected()
    await until_answered(transport, 1)
    protocol.data_received(ask())
    event(protocol)
    assert statuses(transport) == [b"200 OK", b"200 OK", *after]
    await asyncio.sleep(0)
    assert len(statuses(transport)) == 2 + len(after)
    assert protocol.server_state.total_requests == 2


async def test_a_question_that_is_declined_when_the_server_stops_is_answered_all_the_same() -> None:
    protocol, transport = connected()
    await until_answered(transport, 1)
    refused = BODY.replace(b"1.0", b"-10")
    assert len(refused) == len(BODY)
    protocol.data_received(ask(refused))
    protocol.shutdown()
    await until_answered(transport, 3)
    assert statuses(transport) == [b"200 OK", b"422 Unprocessable Entity", b"closed"]


async def test_a_client_that_has_left_is_told_nothing() -> None:
    for body in (BODY, BODY.replace(b"1.0", b"-10")):
        protocol, transport = connected()
        await until_answered(transport, 1)
        await asyncio.sleep(0.01)
        protocol.data_received(ask(body))
        transport.close()
        protocol.connection_lost(None)
        await asyncio.sleep(0)
        assert statuses(transport) == [b"200 OK", b"closed", b"closed"]
        assert not protocol.server_state.tasks


async def test_a_connection_is_kept_as_long_as_questions_come_on_it() -> None:
    protocol, transport = connected()
    protocol.timeout_keep_alive = 0.1  # type: ignore[assignment]
    await until_answered(transport, 1)
    for _ in range(8):
        await asyncio.sleep(0.03)
        protocol.data_received(ask())
    since = protocol.loop.time()
    async with asyncio.timeout(20):
        while not transport.is_closing():
            await asyncio.sleep(0.001)
    assert protocol.loop.time() - since > 0.09
    assert statuses(transport) == [b"200 OK"] * 9 + [b"closed"]


async def test_a_connection_on_which_a_question_waits_is_not_closed() -> None:
    protocol, transport = connected()
    await until_answered(transport, 1)
    protocol.data_received(ask())
    protocol._told_at = -1e9
    protocol.timeout_keep_alive_handler()
    assert not transport.is_closing()
    await asyncio.sleep(0)
    assert statuses(transport) == [b"200 OK"] * 2


async def test_who_has_much_waiting_is_not_read_until_it_is_answered() -> None:
    protocol, transport = connected()
    await until_answered(transport, 1)
    count = MOST_BEHIND // len(TINY) + 1_000
    protocol.data_received(TINY * count)
    read_on = []
    while len(statuses(transport)) <= count:
        await asyncio.sleep(0)
        read_on.append(transport.reading)
    assert read_on.index(True) > 100
    assert read_on[-1]


async def test_a_server_that_stops_answers_what_it_has_begun_to_read() -> None:
    protocol, transport = connected()
    await until_answered(transport, 1)
    halves = ask(b" " * 3 * PARSED_AT_ONCE)
    protocol.data_received(TINY + halves + TINY * 1_000)
    assert len(protocol.pipeline) == 1
    protocol.shutdown()
    await until_answered(transport, 4)
    assert statuses(transport) == [b"200 OK", b"200 OK", b"400 Bad Request", b"closed"]
    assert b"\r\nconnection: close\r\n" in transport.done[-3]
