"""What a directly connected client may send: the service under uvicorn with the parser that it is run with."""

from __future__ import annotations

import asyncio
import json
import re
import socket
from collections.abc import AsyncIterator, Callable
from contextlib import asynccontextmanager, suppress
from typing import Any

import pytest
import uvicorn

from service.http import one_write
from service.http.connection import Connection
from service.responses.json_stream import Document
from tests.service.conftest import PATIENCE, inline_toys
from tests.service.toy_routes import GOOD

pytestmark = pytest.mark.anyio

BODY = json.dumps(GOOD).encode()
HEAD = b"POST /v1/toy HTTP/1.1\r\nhost: x\r\ncontent-type: application/json\r\n"
LAST = b"GET /healthz HTTP/1.1\r\nhost: x\r\nconnection: close\r\n\r\n"
OPEN = HEAD + b"transfer-encoding: chunked\r\n"
LARGE = json.dumps(GOOD | {"times": {"start": 0.0, "stop": 1.0, "count": 30_000}}).encode()
MANY = 10_000_000
"""Bytes, of which no connection may make the server keep more than a small part."""


def ask(body: bytes = BODY, more: bytes = b"") -> bytes:
    return HEAD + more + b"content-length: %d\r\n\r\n" % len(body) + body


def chunked(body: bytes, more: bytes = b"", behind: bytes = b"") -> bytes:
    parts = b"".join(b"%x\r\n%b\r\n" % (len(part), part) for part in (body[:9], body[9:]))
    return OPEN + more + b"\r\n" + parts + b"0\r\n" + behind + b"\r\n"


@asynccontextmanager
async def serving(keep_alive: int = 75, **settings: Any) -> AsyncIterator[int]:
    """Serve the toys; gives the port."""
    app = inline_toys(**settings)
    config = uvicorn.Config(
        app,
        port=0,
        http=Connection,
        lifespan="off",
        log_config=None,
        access_log=False,
        timeout_keep_alive=keep_alive,
        timeout_graceful_shutdown=20,
    )
    server = uvicorn.Server(config)
    started = asyncio.Event()
    startup = server.startup

    async def noted(*arguments: Any, **named: Any) -> None:
        await startup(*arguments, **named)
        started.set()

    server.startup = noted  # type: ignore[method-assign]
    task = asyncio.create_task(server.serve())
    watching = asyncio.create_task(app._bodies.watch())
    await started.wait()
    try:
        yield server.servers[0].sockets[0].getsockname()[1]
    finally:
        watching.cancel()
        server.should_exit = True
        await task


async def heard(port: int, *pieces: bytes) -> bytes:
    """Send pieces one by one and return all that comes back until the end."""
    reader, writer = await asyncio.open_connection("127.0.0.1", port)
    try:
        for piece in pieces:
            writer.write(piece)
            await writer.drain()
            await asyncio.sleep(0)
        return await asyncio.wait_for(reader.read(), PATIENCE)
    finally:
        writer.close()


def plain(received: bytes) -> bytes:
    """Return a response without what differs from request to request."""
    return re.sub(rb"(?<=\n)(x-request-id|server-timing|date): [^\r]*\r\n", b"", received)


def statuses(received: bytes) -> list[int]:
    return [int(status) for status in re.findall(rb"HTTP/1.1 (\d+) ", received)]


H2C = b"connection: Upgrade, HTTP2-Settings\r\nupgrade: h2c\r\nhttp2-settings: AAMAAABkAAQAAP__\r\n"


@pytest.mark.parametrize("request_", [ask, lambda more: chunked(BODY, more)], ids=["length", "chunked"])
async def test_an_offer_of_another_protocol_is_not_taken(request_: Callable[..., bytes]) -> None:
    """RFC 9110, 7.8: the request is answered in this one, byte for byte as without the offer."""
    async with serving() as port:
        offered = await heard(port, request_(more=H2C) + LAST)
        assert plain(offered) == plain(await heard(port, request_(more=b"") + LAST))
    assert statuses(offered) == [200, 200]


@pytest.mark.parametrize(
    "behind",
    [
        b"x-request-id: another\r\n",
        b"accept: text/csv\r\n",
        b"if-none-match: *\r\n",
        b"authorization: Bearer one\r\nexpect: 100-continue\r\n",
    ],
)
async def test_fields_behind_a_body_are_no_headers(behind: bytes) -> None:
    async with serving() as port:
        whole = chunked(BODY, behind=behind)
        for pieces in ((whole + LAST,), (whole[:-9], whole[-9:] + LAST)):
            assert plain(await heard(port, *pieces)) == plain(await heard(port, chunked(BODY) + LAST))


@pytest.mark.parametrize(
    ("opening", "more"),
    [
        (HEAD + b"x: ", b"y" * 1000),
        (HEAD, b"x: y\r\n" * 200),
        (b"GET /", b"a" * 1000),
        (OPEN + b"\r\n1;", b"a" * 1000),
        (OPEN + b"\r\n1\r\n{\r\n0\r\n", b"x: y\r\n" * 200),
    ],
    ids=["one field", "many fields", "a target", "the length of a chunk", "behind a body"],
)
async def test_what_does_not_end_is_refused(opening: bytes, more: bytes) -> None:
    async with serving() as port:
        reader, writer = await asyncio.open_connection("127.0.0.1", port)
        writer.write(opening)
        sent, refused = 0, asyncio.create_task(reader.read())
        try:
            while sent < MANY and not refused.done():
                writer.write(more * 50)
                await writer.drain()
                sent += 50 * len(more)
        except ConnectionError:
            pass
        assert sent < MANY
        writer.close()
        refused.cancel()
        assert statuses(await heard(port, LAST)) == [200]


async def test_a_client_that_pipelines_without_reading_is_not_read_for_ever() -> None:
    loop, flood, sent = asyncio.get_running_loop(), ask(LARGE) * 20, 0
    # Buffers of the system take some megabytes besides those that the server reads.
    most = 4 * MANY
    async with serving() as port:
        # uvicorn cannot say in the middle of an answer that it refuses what follows; the loop closes the connection.
        loop.set_exception_handler(lambda loop, context: None)
        with socket.create_connection(("127.0.0.1", port)) as client:
            client.setblocking(False)
            try:
                while sent < most:
                    await asyncio.wait_for(loop.sock_sendall(client, flood), 2.0)
                    sent += len(flood)
            except (TimeoutError, ConnectionError):
                pass
            assert sent < most
            assert statuses(await heard(port, LAST)) == [200]


@pytest.mark.parametrize(
    ("request_", "expected"),
    [
        (HEAD + b"content-length: 2\r\ncontent-length: 3\r\n\r\n{}", 400),
        (HEAD + b"content-length: +2\r\n\r\n{}", 400),
        (HEAD + b"content-length: 2\r\ntransfer-encoding: chunked\r\n\r\n2\r\n{}\r\n0\r\n\r\n", 400),
        (HEAD + b"content-length : 2\r\n\r\n{}", 400),
        (HEAD + b"x: a\r\n b\r\ncontent-length: 2\r\n\r\n{}", 400),
        (HEAD.replace(b"\r\n", b"\n") + b"content-length: 2\n\n{}", 400),
        (HEAD + b"x: a\0b\r\ncontent-length: 2\r\n\r\n{}", 400),
        (OPEN + b"\r\n0x2\r\n{}\r\n0\r\n\r\n", 400),
        (OPEN + b"\r\n2\n{}\n0\n\n", 400),
        (OPEN + b"\r\nfffffffffffffffff\r\n{}\r\n0\r\n\r\n", 400),
        (HEAD + b"transfer-encoding: gzip\r\n\r\n{}", 400),
        (HEAD + b"transfer-encoding: gzip, chunked\r\n\r\n2\r\n{}\r\n0\r\n\r\n", 501),
        (chunked(BODY, behind=b"content-type: text/plain\r\n"), 400),
        (chunked(BODY, b"connection: keep-alive\r\n").replace(b"HTTP/1.1", b"HTTP/1.0", 1), 200),
        (b"GARBAGE\r\n\r\n", 400),
        (b"GET / HTTP/9.9\r\nhost: x\r\n\r\n", 400),
    ],
)
async def test_no_request_can_be_hidden_behind_another(request_: bytes, expected: int) -> None:
    """What two parsers could frame differently is refused, and the connection is closed."""
    async with serving() as port:
        received = await heard(port, request_ + LAST)
    assert statuses(received) == [expected]


async def test_pipelined_requests_are_answered_in_turn_and_garbage_last() -> None:
    async with serving() as port:
        received = await heard(port, ask() + ask(LARGE) + chunked(BODY) + b"GARBAGE\r\n\r\n" + LAST)
    assert statuses(received) == [200, 200, 200, 400]


@pytest.mark.parametrize(
    "request_",
    [
        b"GARBAGE\r\n\r\n",
        b"GET /healthz HTTP/1.1\r\n\r\n",
        HEAD + b"x: " + b"y" * 100_000 + b"\r\n\r\n",
        HEAD + b"content-length: +2\r\n\r\n{}",
        OPEN + b"\r\nZ\r\n",
        b"GET /\xc3\xa9 HTTP/1.1\r\nhost: x\r\n\r\n",
    ],
    ids=["garbage", "no host", "a long field", "a length", "a chunk", "a path"],
)
async def test_what_is_no_request_is_refused_as_everything_is(request_: bytes) -> None:
    async with serving() as port:
        for before in (b"", ask()):
            *answers, refusal = (await heard(port, before + request_)).split(b"HTTP/1.1 ")[1:]
            head, _, body = refusal.partition(b"\r\n\r\n")
            assert head.startswith(b"400 ")
            assert b"content-type: application/problem+json" in head
            assert b"connection: close" in head
            assert json.loads(body)["code"] == "malformed-request"
            assert len(answers) == before.count(BODY)


async def test_what_follows_an_early_answer_and_cannot_be_read_ends_the_connection() -> None:
    loop, failures = asyncio.get_running_loop(), []
    loop.set_exception_handler(lambda loop, context: failures.append(context))
    early = OPEN.replace(b"application/json", b"text/csv") + b"\r\n"
    async with serving() as port:
        reader, writer = await asyncio.open_connection("127.0.0.1", port)
        writer.write(early)
        assert statuses(await reader.readuntil(b"}")) == [415]
        writer.write(b"ZZ\r\n")
        assert await asyncio.wait_for(reader.read(), PATIENCE) == b""
        writer.close()
    assert failures == []


async def answered_while_sending(port: int, begin: bytes, more: bytes) -> bytes:
    """Send, wait until the server has answered, send more, and read only then until the end of the connection."""
    loop = asyncio.get_running_loop()
    with socket.create_connection(("127.0.0.1", port)) as client:
        client.setblocking(False)
        await loop.sock_sendall(client, begin)
        answered = asyncio.Event()
        loop.add_reader(client, answered.set)
        await asyncio.wait_for(answered.wait(), PATIENCE)
        loop.remove_reader(client)
        # A connection that is closed already resets at the first of these and breaks at the second.
        for piece in (more[:1000], more[1000:]):
            await loop.sock_sendall(client, piece)
            await asyncio.sleep(0.05)
        received = b""
        while part := await asyncio.wait_for(loop.sock_recv(client, 65536), PATIENCE):
            received += part
    return received


@pytest.mark.parametrize(
    ("begin", "status"),
    [
        (b"GET /" + b"a" * 40_000, 400),
        (HEAD + b"x: " + b"y" * 40_000, 400),
        (HEAD + b"content-length: 90000000\r\n\r\n{", 413),
        (HEAD + b"expect: 100-continue\r\ncontent-length: 90000000\r\n\r\n", 413),
    ],
    ids=["a target", "a field", "a body", "a body that was not asked for"],
)
async def test_a_client_that_is_still_sending_can_read_why_it_is_refused(begin: bytes, status: int) -> None:
    """RFC 9112, 9.6: the server ends its side first, and drops for a while what is still sent."""
    async with serving() as port:
        received = await answered_while_sending(port, begin, b"a" * 100_000)
    assert statuses(received) == [status]
    assert received.endswith(b"}")


@pytest.mark.parametrize(("bound", "value"), [("MOST_DROPPED", 50_000), ("LINGERING", 0.01)])
@pytest.mark.parametrize("begin", [b"POST /v1/nothing", b"DELETE /v1/scenes", b"GET /healthz"])
async def test_what_is_left_of_a_body_that_is_answered_is_not_dropped_for_ever(
    monkeypatch: pytest.MonkeyPatch, bound: str, value: float, begin: bytes
) -> None:
    monkeypatch.setattr(one_write, "LINGERING", 600.0)
    monkeypatch.setattr(one_write, bound, value)
    async with serving() as port:
        _, writer = await asyncio.open_connection("127.0.0.1", port)
        writer.write(begin + b" HTTP/1.1\r\nhost: x\r\ncontent-length: 700000000\r\n\r\n")

        async def send_for_ever() -> None:
            while True:
                writer.write(b"a" * 5_000)
                await writer.drain()
                await asyncio.sleep(0.01)

        with pytest.raises(ConnectionError):
            await asyncio.wait_for(send_for_ever(), PATIENCE)


async def test_a_body_that_arrives_behind_its_answer_leaves_the_connection_open(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setattr(one_write, "MOST_DROPPED", 50_000)
    monkeypatch.setattr(one_write, "LINGERING", 0.2)
    async with serving() as port:
        reader, writer = await asyncio.open_connection("127.0.0.1", port)
        # Bytes are counted, and time is, for each of the bodies by itself.
        for _ in range(3):
            writer.write(b"POST /v1/nothing HTTP/1.1\r\nhost: x\r\ncontent-length: 30000\r\n\r\n")
            assert statuses(await reader.readuntil(b"}")) == [404]
            writer.write(b"a" * 30_000)
            await asyncio.sleep(0.3)
        writer.write(LAST)
        assert statuses(await asyncio.wait_for(reader.read(), PATIENCE)) == [200]
        writer.close()


@pytest.mark.parametrize(("bound", "value"), [("MOST_DROPPED", 50_000), ("LINGERING", 0.01)])
async def test_what_is_sent_to_a_closing_connection_is_not_dropped_for_ever(
    monkeypatch: pytest.MonkeyPatch, bound: str, value: float
) -> None:
    monkeypatch.setattr(one_write, "LINGERING", 600.0)
    monkeypatch.setattr(one_write, bound, value)
    async with serving() as port:
        _, writer = await asyncio.open_connection("127.0.0.1", port)

        async def send_for_ever() -> None:
            while True:
                writer.write(b"GET /" + b"a" * 20_000)
                await writer.drain()
                await asyncio.sleep(0.01)

        with pytest.raises(ConnectionError):
            await asyncio.wait_for(send_for_ever(), PATIENCE)


async def test_a_client_that_takes_nothing_is_not_waited_for_for_ever() -> None:
    loop = asyncio.get_running_loop()
    # So many that the answers fill what the kernel takes off the server's hands.
    flood = b"GET /openapi.json HTTP/1.1\r\nhost: x\r\n\r\n" * 400
    async with serving(keep_alive=1) as port:
        with socket.create_connection(("127.0.0.1", port)) as client:
            client.setblocking(False)
            await loop.sock_sendall(client, flood)
            await asyncio.sleep(3.0)
            received, whole = 0, b""
            while more := await asyncio.wait_for(loop.sock_recv(client, 1 << 20), PATIENCE):
                received, whole = received + len(more), whole + more
        assert 0 < len(statuses(whole)) < 400


async def test_half_a_body_is_refused_in_time_and_the_connection_closed() -> None:
    async with serving(body_seconds=0.05) as port:
        for half in (ask()[:-20], ask()[: -len(BODY)], chunked(BODY)[:-20]):
            received = await heard(port, half)
            assert statuses(received) == [408]
            assert b"\r\nconnection: close\r\n" in received
            assert b'"code":"body-too-slow"' in received


async def until_closed(reader: asyncio.StreamReader) -> bytes:
    """Return all that comes; bytes that are still sent to a closed connection reset it."""
    received = b""
    with suppress(ConnectionResetError):
        while piece := await reader.read(2**16):
            received += piece
    return received


@pytest.mark.parametrize("begin", [b"", b"P", HEAD, ask(), ask() + HEAD, ask() + b"P"])
async def test_a_connection_without_a_whole_head_is_closed_in_time(begin: bytes) -> None:
    """However slowly its bytes come; what was sent before that is answered."""
    async with serving(keep_alive=1) as port:
        reader, writer = await asyncio.open_connection("127.0.0.1", port)
        writer.write(begin)
        received = asyncio.create_task(until_closed(reader))
        while not received.done():
            writer.write(b"x" if begin and begin != ask() else b"")
            await asyncio.wait([received], timeout=0.05)
        assert statuses(received.result()) == [200] * begin.count(BODY)
        writer.close()


async def test_a_request_that_takes_long_is_not_ended_by_the_limit_of_heads() -> None:
    async with serving(keep_alive=1) as port:
        slow = json.dumps(GOOD | {"behaviour": "sleep", "angular_velocity": [1.5, 1.0, 1.0]}).encode()
        assert statuses(await heard(port, ask(slow)[:30], ask(slow)[30:] + LAST)) == [200, 200]


async def test_unfinished_bodies_are_bounded_together() -> None:
    async with serving(max_held_bytes=2_000_000) as port:
        waiting = []
        for _ in range(3):
            reader, writer = await asyncio.open_connection("127.0.0.1", port)
            writer.write(HEAD + b"content-length: 500000\r\n\r\n" + b" " * 400_000)
            waiting.append((reader, writer))
        finished = [asyncio.create_task(reader.read()) for reader, _ in waiting]
        (first, *_), _ = await asyncio.wait(finished, timeout=PATIENCE, return_when=asyncio.FIRST_COMPLETED)
        assert statuses(first.result()) == [429]
        assert sum(one.done() for one in finished) == 1
        for _, writer in waiting:
            writer.close()


@pytest.mark.parametrize("behind", [b"", ask()], ids=["alone", "another waits behind it"])
async def test_nothing_more_is_written_for_a_client_that_has_left(
    monkeypatch: pytest.MonkeyPatch, behind: bytes
) -> None:
    ended = asyncio.Event()
    written = Document.pieces
    taken = 0

    def counted(self: Document) -> Any:
        nonlocal taken
        try:
            for piece in written(self):
                taken += 1
                yield piece
        finally:
            ended.set()

    monkeypatch.setattr(Document, "pieces", counted)
    endless = json.dumps(GOOD | {"times": {"start": 0.0, "stop": 1.0, "count": 1_000_000}}).encode()
    async with serving() as port:
        reader, writer = await asyncio.open_connection("127.0.0.1", port)
        writer.write(ask(endless) + behind)
        assert (await reader.readline()) == b"HTTP/1.1 200 OK\r\n"
        writer.transport.abort()
        await asyncio.wait_for(ended.wait(), PATIENCE)
    assert taken < 150
