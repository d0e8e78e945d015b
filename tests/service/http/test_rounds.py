"""Questions through the rounds: what is answered there, what is declined, and in which order."""

from __future__ import annotations

import asyncio
import json
import logging
from typing import Any

import pytest

from core.systems.budget import Budget
from service.execution.request_handler import RequestHandler
from service.execution.response_cache import ResponseCache
from service.http.etag import etag_of
from service.http.heads import Heads
from service.http.rounds import FEW, SMALL, TOGETHER, Rounds
from service.observability.metrics import Metrics
from service.observability.request_records import Records
from service.requests.request_reader import Limits
from service.responses.json_rows import written
from tests.service.toy_routes import GOOD, TOY

pytestmark = pytest.mark.anyio


class Asker:
    """Notes what it is told."""

    def __init__(self, log: list[Any] | None = None, stays: bool = True) -> None:
        self.log, self.stays = log if log is not None else [], stays
        self.heard: list[tuple[bytes, bytes] | None] = []

    def told(self, headers: bytes, body: bytes) -> bool:
        self.log.append(self)
        self.heard.append((headers, body))
        return self.stays

    def declined(self) -> None:
        self.log.append(self)
        self.heard.append(None)


class Room:
    """Rounds, and what they are made of."""

    def __init__(self, cached: int = 0, most_seconds: float = 1.0) -> None:
        self.metrics, self.kept = Metrics(), ResponseCache(cached, 10**6)
        self.answering = RequestHandler([TOY], Budget(), Limits())
        heads = Heads({("POST", TOY.path): TOY}, 10**6)
        records = Records(self.metrics, "none")
        self.rounds = Rounds(heads, self.answering, self.kept, self.metrics, records, most_seconds)

    def ask(self, asker: Asker, **changes: Any) -> None:
        self.rounds.ask(asker, TOY, json.dumps(GOOD | changes).encode())

    def counted(self) -> dict[str, str]:
        prefix = 'polhode_request_seconds_count{operation="ask_toy",status="'
        lines = self.metrics.exposition().decode().splitlines()
        return dict(line.removeprefix(prefix).split('"} ') for line in lines if line.startswith(prefix))

    def answer(self, **changes: Any) -> bytes:
        return written(self.answering.answer(TOY, self.answering.read(TOY, json.dumps(GOOD | changes).encode())))


def samples(count: int) -> dict[str, Any]:
    return {"times": {"start": 0.0, "stop": 1.0, "count": count}}


async def test_an_answer_comes_with_the_headers_of_any_answer() -> None:
    room, asker = Room(), Asker()
    room.ask(asker, behaviour="warn")
    assert asker.heard == []
    await asyncio.sleep(0)
    ((headers, body),) = asker.heard  # type: ignore[misc]
    assert body == room.answer(behaviour="warn")
    lines = [line.split(b": ", 1) for line in headers.removesuffix(b"\r\n").split(b"\r\n")]
    found = {name: value for name, value in lines}
    assert found.pop(b"server-timing").startswith(b"total;dur=")
    assert found.pop(b"x-request-id").endswith(b"-1")
    assert found == {
        b"content-type": b"application/json",
        b"content-length": b"%d" % len(body),
        b"etag": etag_of(body),
        b"x-content-type-options": b"nosniff",
    }
    assert room.counted() == {"200": "1.0"}


@pytest.mark.parametrize(
    "changes",
    [
        {"behaviour": "fail"},
        {"behaviour": "nan"},
        {"behaviour": "unreachable"},
        {"behaviour": "sleep"},
        {"angular_velocity": [1.0, 2.0]},
        samples(0),
        samples(10**9),
        samples(int(SMALL / 1e-8) + 1),
        samples(FEW // 4 + 1),
    ],
    ids=str,
)
async def test_what_is_not_small_and_sound_is_declined(
    changes: dict[str, Any], caplog: pytest.LogCaptureFixture
) -> None:
    """Without a trace: it is recorded and logged where it goes."""
    room, odd, before, behind = Room(cached=10), Asker(), Asker(), Asker()
    room.kept._is_new = lambda key: False  # type: ignore[method-assign]
    with caplog.at_level(logging.DEBUG):
        room.ask(before)
        room.ask(odd, **changes)
        room.ask(behind)
        await asyncio.sleep(0)
    assert odd.heard == [None]
    assert room.counted() == {"200": "2.0"}
    assert before.heard[0] is not None
    assert behind.heard[0] is not None
    assert len(room.kept) == 1
    assert not caplog.records


async def test_what_is_kept_is_not_computed_again(monkeypatch: pytest.MonkeyPatch) -> None:
    room, first, again = Room(cached=10), Asker(), Asker()
    for asker in (Asker(), first):
        room.ask(asker)
        await asyncio.sleep(0)
    monkeypatch.setattr(room.answering, "read", None)
    room.ask(again)
    await asyncio.sleep(0)
    assert first.heard[0][1] == again.heard[0][1]  # type: ignore[index]
    assert room.metrics.cache_hits._count == 1  # type: ignore[union-attr]


async def test_questions_wait_for_what_is_ready_and_are_answered_in_turn() -> None:
    room, log = Room(), []  # type: ignore[var-annotated]
    askers = [Asker(log) for _ in range(2 * TOGETHER + 1)]
    for asker in askers:
        room.ask(asker)
    asyncio.get_running_loop().call_soon(log.append, "between")
    await asyncio.sleep(0)
    assert log == [*askers[:TOGETHER], "between"]
    room.ask(late := Asker(log))
    while len(log) < len(askers) + 2:
        await asyncio.sleep(0)
    log.remove("between")
    assert log == [*askers, late]


async def test_who_cannot_wait_is_answered_at_once() -> None:
    room = Room()
    askers = [Asker() for _ in range(TOGETHER + 5)]
    for asker in askers:
        room.ask(asker)
    room.rounds.finish()
    assert [len(asker.heard) for asker in askers] == [1] * len(askers)
    await asyncio.sleep(0)
    assert [len(asker.heard) for asker in askers] == [1] * len(askers)
    assert room.counted() == {"200": f"{len(askers)}.0"}


async def test_a_client_that_has_left_is_counted_as_such() -> None:
    room = Room()
    room.ask(Asker(stays=False))
    await asyncio.sleep(0)
    assert room.counted() == {"499": "1.0"}


async def test_nothing_is_answered_here_that_is_to_be_computed_elsewhere() -> None:
    room, small, larger = Room(most_seconds=1e-7), Asker(), Asker()
    room.ask(small, **samples(10))
    room.ask(larger, **samples(11))
    await asyncio.sleep(0)
    assert small.heard[0] is not None
    assert larger.heard == [None]


async def test_what_is_long_is_not_written_to_be_declined(monkeypatch: pytest.MonkeyPatch) -> None:
    """Though it cost little to find."""
    seen: list[Any] = []
    monkeypatch.setattr("service.http.rounds.written", lambda answer: seen.append(answer) or written(answer))
    room, short, longer = Room(), Asker(), Asker()
    room.ask(short, **samples(FEW // 4))
    room.ask(longer, **samples(FEW // 4 + 1))
    await asyncio.sleep(0)
    assert short.heard[0] is not None
    assert longer.heard == [None]
    assert len(seen) == 1
