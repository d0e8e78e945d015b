"""The protocol with its rounds: the same bytes on the wire as uvicorn's own, whatever a client does."""

import asyncio
import json
from pathlib import Path
from typing import Any

import pytest

from service.http.heads import MATTERS
from service.http.keys import new_key
from service.http.protocol import Protocol
from service.http.rounds import Rounds
from tests.service.toy_routes import GOOD
from tests.service.wire import (
    BODY,
    FAIR,
    HEAD,
    LARGE,
    LAST,
    MIDDLING,
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

TRAP = HEAD + b"content-length: 2\r\n\r\n"
LOOSE = (HEAD + b"content-length: 6\r\n\r\n").replace(b"\r\n", b"\n") + b"{}\r\n\r\n"
FAILING = json.dumps(GOOD | {"behaviour": "unreachable"}).encode()
NOT_FINITE = json.dumps(GOOD | {"behaviour": "nan"}).encode()


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


async def test_an_idle_connection_is_closed_when_the_server_stops() -> None:
    async with serving(Protocol) as server:
        reader, writer = await connect(server)
        writer.write(ask())
        assert (await reader.readline()) == b"HTTP/1.1 200 OK\r\n"
        server.should_exit = True
        rest = await asyncio.wait_for(reader.read(), 20)
        assert rest.endswith(b"}")
        writer.close()


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
