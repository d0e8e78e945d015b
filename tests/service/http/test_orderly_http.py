"""What is done otherwise than uvicorn does it, with rounds before it."""

import asyncio
import json
import re
from collections import Counter
from collections.abc import Iterator

import pytest

from service.http.orderly_http import LONGEST_HEAD, MOST_BEHIND, PARSED_AT_ONCE
from service.http.protocol import Protocol
from service.responses.json_stream import Document
from tests.service.toy_routes import GOOD
from tests.service.wire import (
    BODY,
    HEAD,
    LARGE,
    LAST,
    ask,
    chunked,
    connect,
    connected,
    plain,
    serving,
    statuses,
    told,
    until_answered,
)

pytestmark = pytest.mark.anyio

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
