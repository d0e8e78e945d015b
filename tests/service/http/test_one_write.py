"""What is written to a connection: one write for a response of one piece, whatever ends it."""

from __future__ import annotations

import asyncio
from collections.abc import Callable
from types import SimpleNamespace
from typing import Any

import pytest

from service.http.one_write import OneWrite

pytestmark = pytest.mark.anyio


class Written:
    """Takes the place of a transport."""

    def __init__(self) -> None:
        self.parts: list[bytes] = []
        self.closed = self.aborted = False
        self.left = 0

    def get_write_buffer_size(self) -> int:
        return self.left

    def abort(self) -> None:
        self.aborted = True

    def write(self, data: bytes) -> None:
        assert not self.closed
        self.parts.append(data)

    def close(self) -> None:
        self.closed = True


@pytest.fixture
async def pair() -> tuple[Any, Written]:
    written = Written()
    return OneWrite(written, asyncio.get_running_loop(), 0.02, lambda: False), written  # type: ignore[arg-type]


async def test_head_and_body_are_one_write(pair: tuple[Any, Written]) -> None:
    transport, written = pair
    for part in (b"head", b"body", b""):
        transport.write(part)
    assert written.parts == [b"headbody"]
    await asyncio.sleep(0)
    assert written.parts == [b"headbody"]


async def test_every_piece_of_a_stream_is_written_in_its_order(pair: tuple[Any, Written]) -> None:
    transport, written = pair
    for part in (b"head", b"1", b"2", b"3", b"4"):
        transport.write(part)
        await asyncio.sleep(0)
        await asyncio.sleep(0)
        assert b"".join(written.parts).endswith(part)
    assert b"".join(written.parts) == b"head1234"


async def test_a_head_alone_waits_no_longer_than_the_turn_of_the_loop(pair: tuple[Any, Written]) -> None:
    transport, written = pair
    transport.write(b"head")
    assert written.parts == []
    await asyncio.sleep(0)
    assert written.parts == [b"head"]


async def test_what_is_held_is_written_before_the_connection_closes(pair: tuple[Any, Written]) -> None:
    transport, written = pair
    transport.write(b"refused")
    transport.close()
    assert (written.parts, written.closed) == ([b"refused"], True)
    await asyncio.sleep(0)
    assert written.parts == [b"refused"]


class Clock:
    """Takes the place of a loop whose time goes on when the test says so."""

    def __init__(self) -> None:
        self.due: list[tuple[Callable[..., None], tuple[Any, ...]]] = []
        self.call_soon = asyncio.get_running_loop().call_soon

    def call_later(self, delay: float, call: Callable[..., None], *arguments: Any) -> Any:
        self.due.append((call, arguments))
        return SimpleNamespace(cancel=self.due.clear)

    def go_on(self) -> None:
        due, self.due = self.due, []
        for call, arguments in due:
            call(*arguments)


async def test_a_closed_connection_of_which_nothing_more_is_taken_is_aborted() -> None:
    written, clock = Written(), Clock()
    transport = OneWrite(written, clock, 0.02, lambda: False)  # type: ignore[arg-type]
    written.left = 100
    transport.close()
    for left in (90, 80, 70):
        written.left = left
        clock.go_on()
        assert not written.aborted
    clock.go_on()
    assert written.aborted
    assert not clock.due


async def test_a_connection_that_is_read_to_its_end_is_not_aborted() -> None:
    written, clock = Written(), Clock()
    transport = OneWrite(written, clock, 0.02, lambda: False)  # type: ignore[arg-type]
    written.left = 100
    transport.expect_progress()
    written.left = 0
    clock.go_on()
    transport.close()
    clock.go_on()
    assert not written.aborted
