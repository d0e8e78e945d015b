"""Limits on requests: documents, bodies under way, media types."""

import asyncio
import json
from typing import Any

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from service.http.held_bytes import HeldBytes
from service.http.limits import Bodies, ClientGone, negotiated, require_readable
from service.problems import Refusal
from service.requests.document_limits import Limits, enforce_document_limits, require_distinct_keys
from tests.drawn import draws
from tests.service.conftest import PATIENCE

OFFERED = ("application/json", "text/plain")
JAVA = b"text/html, image/gif, image/jpeg, *; q=.2, */*; q=.2"
"""What java.net.HttpURLConnection sends by default."""


def code(call: object, *arguments: object) -> str | None:
    try:
        call(*arguments)  # type: ignore[operator]
    except Refusal as refusal:
        return refusal.problem.type.code
    return None


documents = st.recursive(
    st.none() | st.booleans() | st.integers() | st.text('ab"\\:,{}[] \n', max_size=6),
    lambda inner: st.lists(inner, max_size=4) | st.dictionaries(st.text('ab":\\{[ ', max_size=4), inner, max_size=4),
    max_leaves=20,
)


def depth(node: object) -> int:
    if isinstance(node, dict):
        return 1 + max((depth(entry) for entry in node.values()), default=0)
    if isinstance(node, list):
        return 1 + max((depth(entry) for entry in node), default=0)
    return 0


@given(documents, st.integers(1, 6), st.booleans())
@settings(deadline=None, derandomize=True, max_examples=draws(300))
def test_depth_is_that_of_the_document(document: object, limit: int, spaced: bool) -> None:
    body = json.dumps(document, indent=1 if spaced else None).encode()
    assert (code(enforce_document_limits, body, Limits(nesting=limit)) == "too-complex") == (depth(document) > limit)


@given(documents)
@settings(deadline=None, derandomize=True, max_examples=draws(300))
def test_a_document_without_repeated_keys_passes(document: object) -> None:
    require_distinct_keys(json.dumps(document).encode())


@pytest.mark.parametrize(
    ("body", "pointer"),
    [
        (b'{"a":1,"a":2}', "/a"),
        (b'{"a" :1,"a"\n:2}', "/a"),
        (b'{"a":1,"\\u0061":2}', "/a"),
        (b'{"b":{"a":1},"c":[[{"a":1,"b":2,"a":3}]]}', "/c/0/0/a"),
        (b'{"a":"x",":a":1,  ":a":2}', "/:a"),
        (b'[{"k":1},{"k":1,"k":1}]', "/1/k"),
        (b'{"' + b"k" * 99 + b'":1,"' + b"k" * 99 + b'":1}', ""),
    ],
)
def test_repeated_keys_are_found(body: bytes, pointer: str) -> None:
    with pytest.raises(Refusal) as caught:
        require_distinct_keys(body)
    assert caught.value.problem.type.code == "duplicate-key"
    assert caught.value.problem.faults[0].pointer == pointer


def test_keys_are_counted_without_building_the_document() -> None:
    body = json.dumps({f"k{i}": 0 for i in range(50)}).encode()
    assert code(enforce_document_limits, body, Limits(keys=50)) is None
    assert code(enforce_document_limits, body, Limits(keys=49)) == "too-complex"


@pytest.mark.parametrize("document", [["a"] * 50, ["\n" * 49], {"k": ["a"] * 49}])
def test_strings_and_escapes_are_counted_without_building_the_document(document: object) -> None:
    body = json.dumps(document).encode()
    assert code(enforce_document_limits, body, Limits(strings=50)) is None
    assert code(enforce_document_limits, body, Limits(strings=49 - body.count(b"n"))) == "too-complex"


@pytest.mark.parametrize("accept", [b"*/*", b"application/json", b"text/html, application/*;q=0.2", b"", JAVA])
def test_json_is_acceptable(accept: bytes) -> None:
    assert negotiated(accept, OFFERED) == OFFERED[0]


def test_what_cannot_be_given_is_not_acceptable() -> None:
    assert code(negotiated, b"text/csv", OFFERED) == "not-acceptable"


def test_a_long_accept_header_is_not_read() -> None:
    long = b"text/html," * 110 + b"application/json"
    assert code(negotiated, long, OFFERED) == "not-acceptable"


@pytest.mark.parametrize(
    ("coding", "found"), [(b"chunked", None), (b"Chunked", None), (b"gzip, chunked", 501), (b"identity", 501)]
)
def test_transfer_codings_other_than_chunked_are_not_implemented(coding: bytes, found: int | None) -> None:
    headers = {b"content-type": b"application/json", b"transfer-encoding": coding}
    expected = None if found is None else "unsupported-transfer-coding"
    assert code(require_readable, headers) == expected


class Sender:
    """A client that sends a body in parts, when it is told to."""

    def __init__(self) -> None:
        self.parts: asyncio.Queue[dict[str, Any]] = asyncio.Queue()

    def send(self, body: bytes, more: bool = True) -> None:
        self.parts.put_nowait({"type": "http.request", "body": body, "more_body": more})


async def until_waiting() -> None:
    for _ in range(10):
        await asyncio.sleep(0)


@pytest.mark.anyio
class TestBodies:
    async def test_parts_are_joined(self) -> None:
        held = HeldBytes(10)
        sender, bodies = Sender(), Bodies(10, held, 60.0)
        for part, more in ((b"ab", True), (b"", True), (b"c", False)):
            sender.send(part, more)
        assert await bodies.read(sender.parts.get, {}, "client") == b"abc"
        assert held.total == 0

    async def test_what_is_unfinished_is_counted_with_the_rest_and_refused_beyond_the_limit(self) -> None:
        held = HeldBytes(100)
        held.add("answered", 40)
        bodies = Bodies(60, held, 60.0)
        first, second, third = senders = Sender(), Sender(), Sender()
        reading = [asyncio.create_task(bodies.read(each.parts.get, {}, i)) for i, each in enumerate(senders)]
        first.send(b"x" * 45)
        await until_waiting()
        assert held.total == 85
        second.send(b"x" * 20)
        with pytest.raises(Refusal) as caught:
            await reading[1]
        problem = caught.value.problem
        assert (problem.type.code, dict(problem.headers)) == ("too-busy", {"Connection": "close"})
        assert problem.retry_after == 1.0
        # Nothing is held for who was refused; the others go on.
        assert held.total == 85
        third.send(b"x" * 10, more=False)
        assert len(await reading[2]) == 10
        first.send(b"x", more=False)
        assert len(await reading[0]) == 46
        assert held.total == 40

    @pytest.mark.parametrize("begun", [False, True])
    async def test_a_body_that_does_not_arrive_in_time_is_refused(self, begun: bool) -> None:
        held = HeldBytes(100)
        sender, bodies = Sender(), Bodies(100, held, 0.01)
        if begun:
            sender.send(b"x")
        watching = asyncio.create_task(bodies.watch())
        with pytest.raises(Refusal) as caught:
            await asyncio.wait_for(bodies.read(sender.parts.get, {}, "client"), PATIENCE)
        watching.cancel()
        assert caught.value.problem.type.status == 408
        assert ("Connection", "close") in caught.value.problem.headers
        assert held.total == 0

    async def test_who_is_in_time_is_not_cancelled_and_who_cancels_is_obeyed(self) -> None:
        sender, bodies = Sender(), Bodies(100, HeldBytes(100), 60.0)
        watching = asyncio.create_task(bodies.watch())
        reading = asyncio.create_task(bodies.read(sender.parts.get, {}, "client"))
        await until_waiting()
        reading.cancel()
        with pytest.raises(asyncio.CancelledError):
            await reading
        watching.cancel()

    async def test_a_client_that_leaves_holds_nothing(self) -> None:
        held = HeldBytes(100)
        sender, bodies = Sender(), Bodies(100, held, 60.0)
        sender.send(b"x" * 9)
        sender.parts.put_nowait({"type": "http.disconnect"})
        with pytest.raises(ClientGone):
            await bodies.read(sender.parts.get, {}, "client")
        assert held.total == 0
