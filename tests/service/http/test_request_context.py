"""One request and its response."""

from __future__ import annotations

import asyncio
import json
from collections.abc import Iterator
from typing import Any

import anyio
import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from service.http.etag import JSON, Representation, etag_of
from service.http.limits import ClientGone
from service.http.request_context import SHORT, VARY, RequestContext, network_of
from service.observability.metrics import Metrics
from service.observability.request_records import Records
from service.problem_types import REGISTRY
from service.problems import Problem

pytestmark = pytest.mark.anyio

ANSWER = Representation(b'{"a":1}')


class Wire:
    """What an exchange receives and sends."""

    def __init__(self, method: str = "POST", stays: bool = True, **headers: str) -> None:
        self.messages: list[dict[str, Any]] = []
        self.stays = stays
        self.metrics = Metrics()
        encoded = [(name.replace("_", "-").encode(), value.encode()) for name, value in headers.items()]
        scope: dict[str, Any] = {"type": "http", "method": method, "path": "/v1/toy", "headers": encoded}
        self.exchange = RequestContext(Records(self.metrics, "none"), "ask_toy", scope, self.receive, self.send)

    async def receive(self) -> dict[str, Any]:
        if self.stays:
            await asyncio.Event().wait()
        return {"type": "http.disconnect"}

    async def send(self, message: dict[str, Any]) -> None:
        self.messages.append(message)

    @property
    def status(self) -> int:
        assert self.messages[0]["type"] == "http.response.start"
        assert [message["type"] for message in self.messages[1:]] == ["http.response.body"] * (len(self.messages) - 1)
        return int(self.messages[0]["status"])

    @property
    def headers(self) -> dict[str, str]:
        """The headers that were sent, without those that differ from one request to the next."""
        found = [(name.decode(), value.decode()) for name, value in self.messages[0]["headers"]]
        assert all(name == name.lower() for name, _ in found)
        given = {name: ", ".join(value for other, value in found if other == name) for name, _ in found}
        assert given.pop("x-request-id") == self.exchange.id
        assert given.pop("server-timing").startswith("total;dur=")
        assert given.pop("x-content-type-options") == "nosniff"
        return given

    @property
    def body(self) -> bytes:
        assert not self.messages[-1].get("more_body", False)
        assert all(message["more_body"] for message in self.messages[1:-1])
        return b"".join(message["body"] for message in self.messages[1:])

    def counted(self) -> dict[str, str]:
        """How many requests are counted, by status."""
        prefix = 'polhode_request_seconds_count{operation="ask_toy",status="'
        lines = self.metrics.exposition().decode().splitlines()
        return dict(line.removeprefix(prefix).split('"} ') for line in lines if line.startswith(prefix))


class TestBody:
    async def test_gone_waits_for_the_end_of_the_connection(self) -> None:
        wire = Wire()
        messages = iter([{"type": "http.request", "body": b""}, {"type": "http.disconnect"}])
        wire.exchange.receive = lambda: asyncio.sleep(0, next(messages))  # type: ignore[assignment]
        await wire.exchange.gone()
        assert next(messages, None) is None

    @pytest.mark.parametrize(("given_id", "kept"), [("grading-1.a_b", True), ("a b", False), ("x" * 65, False)])
    def test_the_id_is_the_clients_where_it_is_plain(self, given_id: str, kept: bool) -> None:
        assert (Wire(x_request_id=given_id).exchange.id == given_id) is kept

    async def test_a_header_that_is_repeated_has_all_its_values(self) -> None:
        wire = Wire(accept="text/html", content_type="application/json")
        repeated = [*wire.exchange.scope["headers"], (b"accept", b"application/json")]
        scope = wire.exchange.scope | {"headers": repeated}
        headers = RequestContext(Records(wire.metrics, "none"), "ask_toy", scope, wire.receive, wire.send).headers
        assert headers == {b"accept": b"text/html, application/json", b"content-type": b"application/json"}


class TestHas:
    @pytest.mark.parametrize(
        ("known", "has"),
        [
            ("*", True),
            (ANSWER.etag.decode(), True),
            (f'"x",{ANSWER.etag.decode()}', True),
            (f' {ANSWER.etag.decode()} , "x"', True),
            # A proxy that compresses an answer makes its validator weak; the comparison is weak (RFC 9110, 13.1.2).
            (f"W/{ANSWER.etag.decode()}", True),
            (f'"x", W/{ANSWER.etag.decode()}', True),
            ('"x"', False),
            ('W/"x"', False),
            (ANSWER.etag.decode().strip('"'), False),
            (ANSWER.etag.decode()[:-2] + '"', False),
            (f"w/{ANSWER.etag.decode()}", False),
            ("", False),
            ('"*"', False),
        ],
    )
    async def test_what_the_client_has_is_not_sent_again(self, known: str, has: bool) -> None:
        wire = Wire(if_none_match=known)
        await wire.exchange.answer(ANSWER)
        assert (wire.status, wire.body) == ((304, b"") if has else (200, ANSWER.body))
        assert wire.headers["etag"] == ANSWER.etag.decode()
        assert ("content-length" in wire.headers) is not has
        assert wire.counted() == {str(wire.status): "1.0"}

    async def test_a_page_an_archive_and_a_stream_neither(self) -> None:
        body = b"x" * 3000
        etag = etag_of(body).decode()
        for known, status in ((f"W/{etag}", 304), ('"x"', 200)):
            page, figure, stream = (Wire("GET", if_none_match=known) for _ in range(3))
            await page.exchange.page(body, b"text/html; charset=utf-8", 200)
            await figure.exchange.answer(Representation(body, (b"content-type", b"image/svg+xml"), (VARY,)))
            await stream.exchange.stream(iter([body]), etag.encode(), 10.0, [JSON, VARY], asyncio.Lock())
            for wire in (page, figure, stream):
                assert (wire.status, wire.body) == (status, body if status == 200 else b"")
                assert wire.headers["etag"] == etag
                assert ("content-type" in wire.headers) is (status == 200)
            # What tells caches how to use what they have is in both (RFC 9110, 15.4.5).
            assert page.headers["cache-control"] == "no-cache"
            assert figure.headers["vary"] == stream.headers["vary"] == "accept, accept-encoding"


class TestInOnePiece:
    async def test_pages_may_load_nothing_from_elsewhere(self) -> None:
        for media, guarded in ((b"text/html; charset=utf-8", True), (b"text/css", False)):
            wire = Wire("GET")
            await wire.exchange.page(b"x", media, 200)
            assert ("content-security-policy" in wire.headers) is guarded
            assert ("referrer-policy" in wire.headers) is guarded

    async def test_the_head_of_a_page_is_that_of_the_page(self) -> None:
        head, whole = Wire("HEAD"), Wire("GET")
        for wire in (head, whole):
            await wire.exchange.page(b"abc", b"text/plain", 200)
        assert (head.status, head.headers, head.body) == (200, whole.headers, b"")
        assert whole.headers["content-length"] == "3"

    async def test_a_page_that_is_no_success_has_no_validator(self) -> None:
        wire = Wire("GET", if_none_match="*")
        await wire.exchange.page(b"abc", b"application/json", 503)
        assert (wire.status, wire.body) == (503, b"abc")
        assert "etag" not in wire.headers
        assert wire.counted() == {"503": "1.0"}

    @pytest.mark.parametrize("method", ["POST", "HEAD"])
    async def test_problems_are_counted_by_code_and_carry_their_headers(self, method: str) -> None:
        wire = Wire(method)
        problem = Problem(REGISTRY["too-busy"], "later", retry_after=6.2)
        await wire.exchange.problem(problem)
        assert wire.status == problem.type.status == 429
        assert wire.headers == {
            "content-type": "application/problem+json",
            "content-length": str(len(problem.body(wire.exchange.id))),
            "retry-after": "7",
        }
        assert wire.body == (b"" if method == "HEAD" else problem.body(wire.exchange.id))
        assert b'polhode_problems_total{code="too-busy"} 1.0' in wire.metrics.exposition()
        assert wire.counted() == {"429": "1.0"}


SIZES = st.lists(st.sampled_from([0, 1, 2, 100, SHORT - 1, SHORT, SHORT + 1, 5 * SHORT]), max_size=12)


class TestStream:
    @given(SIZES)
    @settings(deadline=None, derandomize=True)
    def test_all_pieces_are_sent_and_none_is_short(self, sizes: list[int]) -> None:
        """The last may be short, it has no next."""
        pieces = [bytes([97 + i]) * size for i, size in enumerate(sizes)]
        wire = Wire()

        async def run() -> None:
            given = (memoryview(piece) if i % 2 else piece for i, piece in enumerate(pieces))
            await wire.exchange.stream(given, b'"x"', 10.0, [JSON], asyncio.Lock())

        anyio.run(run)
        assert (wire.status, wire.body) == (200, b"".join(pieces))
        assert wire.headers == {"content-type": "application/json", "etag": '"x"', "vary": "accept-encoding"}
        assert all(len(message["body"]) >= SHORT for message in wire.messages[1:-1])
        assert len(wire.messages) == 2 + sum(size >= SHORT for size in sizes)
        assert wire.counted() == {"200": "1.0"}

    async def test_others_run_between_the_pieces(self) -> None:
        wire, seen = Wire(), []

        async def other() -> None:
            while True:
                seen.append(len(wire.messages))
                await asyncio.sleep(0)

        running = asyncio.ensure_future(other())
        await wire.exchange.stream(iter([b"x" * SHORT] * 5), b'"x"', 10.0, [JSON], asyncio.Lock())
        running.cancel()
        assert set(seen) >= {2, 3, 4, 5, 6}

    async def test_streams_take_turns(self) -> None:
        """However many there are, one piece is made before others run: a health check waits for one, not for each."""
        turns, made, seen = asyncio.Lock(), [], []

        def pieces() -> Iterator[bytes]:
            for _ in range(5):
                made.append(1)
                yield b"x" * SHORT

        async def other() -> None:
            while True:
                seen.append(len(made))
                await asyncio.sleep(0)

        running = asyncio.ensure_future(other())
        async with asyncio.TaskGroup() as group:
            for _ in range(7):
                group.create_task(Wire().exchange.stream(pieces(), b'"x"', 10.0, [JSON], turns))
        running.cancel()
        assert seen[-1] == 35
        assert max(np.diff(seen)) == 1

    async def test_nothing_more_is_made_once_the_client_has_gone(self) -> None:
        wire, made = Wire(), []

        def pieces() -> Iterator[bytes]:
            for i in range(100):
                made.append(i)
                if i == 3:
                    wire.left.set()
                yield b"x" * SHORT

        wire.left = asyncio.Event()  # type: ignore[attr-defined]

        async def receive() -> dict[str, Any]:
            await wire.left.wait()
            return {"type": "http.disconnect"}

        wire.exchange.receive = receive  # type: ignore[assignment]
        with pytest.raises(ClientGone):
            await wire.exchange.stream(pieces(), b'"x"', 10.0, [JSON], asyncio.Lock())
        assert len(made) < 10
        # Without its end it does not seem whole; who catches the error counts the request.
        assert wire.messages[-1]["more_body"]
        assert wire.counted() == {}

    async def test_a_client_that_takes_nothing_is_let_go(self) -> None:
        wire = Wire()
        send = wire.exchange._send

        async def stalling(message: Any) -> None:
            await send(message)
            if message["type"] == "http.response.body":
                await asyncio.Event().wait()

        wire.exchange._send = stalling
        pieces = iter([b"x" * SHORT] * 3)
        async with asyncio.timeout(60):
            with pytest.raises(ClientGone):
                await wire.exchange.stream(pieces, b'"x"', 0.02, [JSON], asyncio.Lock())
        assert len([*pieces]) == 2
        assert wire.counted() == {}

    async def test_patience_is_for_each_piece(self, monkeypatch: pytest.MonkeyPatch) -> None:
        """A slow reader that goes on reading is served to the end."""
        allowed: list[float | None] = []
        timeout = asyncio.timeout

        def noted(seconds: float | None) -> asyncio.Timeout:
            allowed.append(seconds)
            return timeout(seconds)

        monkeypatch.setattr("service.http.request_context.asyncio.timeout", noted)
        await Wire().exchange.stream(iter([b"x" * SHORT, b"short"] * 4), b'"x"', 7.0, [JSON], asyncio.Lock())
        assert allowed == [7.0] * 4

    async def test_a_failure_in_the_middle_leaves_nobody_waiting(self) -> None:
        wire = Wire()

        def failing() -> Iterator[bytes]:
            yield b"x" * SHORT
            raise RuntimeError("in the middle")

        before = asyncio.all_tasks()
        with pytest.raises(RuntimeError, match="in the middle"):
            await wire.exchange.stream(failing(), b'"x"', 10.0, [JSON], asyncio.Lock())
        await asyncio.sleep(0)
        await asyncio.sleep(0)
        assert asyncio.all_tasks() == before
        assert wire.exchange.started
        assert wire.counted() == {}

    async def test_what_the_client_has_is_not_even_made(self) -> None:
        wire = Wire(if_none_match='"x"')

        def never() -> Iterator[bytes]:
            raise AssertionError
            yield b""

        await wire.exchange.stream(never(), b'"x"', 10.0, [JSON, VARY], asyncio.Lock())
        assert (wire.status, wire.headers) == (304, {"vary": "accept, accept-encoding", "etag": '"x"'})


async def test_logs_and_counts_agree(caplog: pytest.LogCaptureFixture) -> None:
    wire = Wire(x_request_id="mine")
    wire.exchange._records = Records(wire.metrics, "all")
    with caplog.at_level("INFO", "polhode"):
        wire.exchange.close(499)
    (record,) = caplog.records
    told = {name: vars(record)[name] for name in ("request_id", "operation", "method", "status")}
    assert told == {"request_id": "mine", "operation": "ask_toy", "method": "POST", "status": 499}
    assert json.dumps(vars(record)["milliseconds"])
    assert wire.counted() == {"499": "1.0"}


@pytest.mark.parametrize(
    ("address", "network"),
    [
        ("192.0.2.7", "192.0.2.7"),
        ("2001:db8:1:2:3:4:5:6", "2001:db8:1:2::/64"),
        ("::ffff:192.0.2.7", "192.0.2.7"),
        ("fe80::1%eth0", "fe80::/64"),
        ("", ""),
        ("not:an:address", "not:an:address"),
    ],
)
def test_a_client_of_ipv6_is_its_network(address: str, network: str) -> None:
    assert network_of(address) == network
