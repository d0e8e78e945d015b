"""Which heads are remembered, and as what."""

from __future__ import annotations

from typing import Any

import pytest

from service.http.heads import LONGEST, LONGEST_BODY, MATTERS, MOST, Heads, Known
from service.routes.operations import operations
from service.routing import Route
from tests.service.toy_routes import TOY

PAGE = operations(ready=lambda: True, metrics=None)[0]  # type: ignore[arg-type]
ROUTES: dict[tuple[str, str], Route] = {("POST", TOY.path): TOY, ("GET", PAGE.path): PAGE, ("POST", "/page"): PAGE}
HEAD = b"POST /v1/toy HTTP/1.1\r\ncontent-type: application/json\r\ncontent-length: 10\r\n\r\n"
HEADERS = {b"content-type": b"application/json", b"content-length": b"10"}


def scope(method: str = "POST", path: str = TOY.path, **headers: bytes) -> dict[str, Any]:
    named = {name.replace("_", "-").encode(): value for name, value in headers.items()}
    return {"method": method, "path": path, "headers": list((HEADERS | named).items())}


def found(heads: Heads, head: bytes) -> Known | None:
    known, identity = heads.find(head)
    assert identity is None
    return known


def test_a_plain_question_is_remembered_with_its_length() -> None:
    heads = Heads(ROUTES, 100)
    assert found(heads, HEAD) is None
    heads.learn(HEAD, scope())
    assert found(heads, HEAD) == Known(TOY, len(HEAD) + 10)
    assert found(heads, HEAD[:-1]) is None


@pytest.mark.parametrize(
    "headers",
    [
        {"host": b"x", "user_agent": b"y", "cookie": b"z", "accept_encoding": b"gzip", "connection": b"keep-alive"},
        {"accept": b"*/*"},
        {"accept": b"application/json"},
        {"content_type": b"Application/JSON; charset=utf-8"},
        {"origin": b"https://a.example", "authorization": b"Bearer a"},
    ],
    ids=str,
)
def test_headers_that_change_nothing_do_not_matter(headers: dict[str, bytes]) -> None:
    heads = Heads(ROUTES, 100)
    heads.learn(HEAD, scope(**headers))
    assert found(heads, HEAD)


@pytest.mark.parametrize(
    "told",
    [
        scope("GET"),
        scope("GET", PAGE.path),
        scope("POST", "/page"),
        scope(path="/nothing"),
        scope(accept=b"application/x-npz"),
        scope(accept=b"text/html, */*"),
        scope(content_type=b"text/plain"),
        scope(content_length=b"-1"),
        scope(content_length=b"1e1"),
        scope(content_length=b""),
        scope(content_length=b"1" * 5000),
        scope() | {"headers": [*HEADERS.items(), (b"accept", b"*/*"), (b"accept", b"text/csv")]},
        scope() | {"headers": [(b"content-type", b"application/json")]},
        *(scope(**{name.decode(): b"x"}) for name in sorted(MATTERS)),
    ],
    ids=str,
)
def test_what_is_no_plain_question_is_not_remembered(told: dict[str, Any]) -> None:
    heads = Heads(ROUTES, 100)
    heads.learn(HEAD, told)
    assert found(heads, HEAD) is None


@pytest.mark.parametrize(
    ("head", "body", "most", "kept"),
    [
        (LONGEST, LONGEST_BODY, 10**9, True),
        (LONGEST + 1, 10, 100, False),
        (50, LONGEST_BODY + 1, 10**9, False),
        (50, 101, 100, False),
        (50, 100, 100, True),
    ],
)
def test_long_heads_and_long_bodies_are_not_small_questions(head: int, body: int, most: int, kept: bool) -> None:
    heads = Heads(ROUTES, most)
    heads.learn(b"x" * head, scope(content_length=b"%d" % body))
    assert (found(heads, b"x" * head) is not None) is kept


def test_the_oldest_gives_way() -> None:
    heads = Heads(ROUTES, 100)
    for i in range(MOST + 2):
        heads.learn(b"%d" % i, scope())
    known = [i for i in range(MOST + 2) if found(heads, b"%d" % i)]
    assert known == list(range(2, MOST + 2))


def own(**lines: str) -> tuple[bytes, dict[str, Any]]:
    """Return a head and its scope, with lines of its own."""
    named = {name.replace("_", "-"): value for name, value in lines.items()}
    more = "".join(f"{name}: {value}\r\n" for name, value in named.items()).encode()
    return HEAD[:-2] + more + b"\r\n", scope(**{name: value.encode() for name, value in lines.items()})


@pytest.mark.parametrize(
    "lines",
    [
        {"x_request_id": "a-1"},
        {"traceparent": "00-1-2-01", "tracestate": "a=b"},
        {"x_request_id": "1", "traceparent": "2"},
    ],
    ids=str,
)
def test_what_names_a_single_request_does_not_make_another_head(lines: dict[str, str]) -> None:
    for first in ({}, lines, {name: value + "9" for name, value in lines.items()}):
        heads = Heads(ROUTES, 100)
        heads.learn(*own(**first))
        head, _ = own(**lines)
        known, identity = heads.find(head)
        assert known == Known(TOY, len(head) + 10)
        assert identity == (lines["x_request_id"].encode() if "x_request_id" in lines else None)
        assert heads.find(HEAD)[0] == Known(TOY, len(HEAD) + 10)


@pytest.mark.parametrize("line", ["", "a b", "a\t", " a", "a ", "\x00", "\x80", "a\r\n b", "a\rx", "x" * 513], ids=repr)
def test_a_line_that_is_not_plain_stays_in_the_head(line: str) -> None:
    heads = Heads(ROUTES, 100)
    heads.learn(HEAD, scope())
    head = HEAD[:-2] + b"X-Request-Id: " + line.encode("latin-1") + b"\r\n\r\n"
    assert heads.find(head) == (None, None)
    heads.learn(head, scope(x_request_id=line.strip().encode("latin-1")))
    assert heads.find(head) == (None, None)


def test_two_ids_are_none() -> None:
    heads = Heads(ROUTES, 100)
    heads.learn(HEAD, scope())
    head = HEAD[:-2] + b"x-request-id: a\r\nX-Request-ID: b\r\n\r\n"
    assert heads.find(head) == (None, None)
    two = scope()
    two["headers"] += [(b"x-request-id", b"a"), (b"x-request-id", b"b")]
    heads.learn(head, two)
    assert heads.find(head) == (None, None)
