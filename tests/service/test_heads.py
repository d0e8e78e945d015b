"""Which heads are remembered, and as what."""

from __future__ import annotations

from typing import Any

import pytest

from service.heads import LONGEST, LONGEST_BODY, MATTERS, MOST, Heads, Known
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


def test_a_plain_question_is_remembered_with_its_length() -> None:
    heads = Heads(ROUTES, 100)
    assert heads.known(HEAD) is None
    heads.learn(HEAD, scope())
    assert heads.known(HEAD) == Known(TOY, len(HEAD) + 10)
    assert heads.known(HEAD[:-1]) is None


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
    assert heads.known(HEAD)


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
    assert heads.known(HEAD) is None


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
    assert (heads.known(b"x" * head) is not None) is kept


def test_the_oldest_gives_way() -> None:
    heads = Heads(ROUTES, 100)
    for i in range(MOST + 2):
        heads.learn(b"%d" % i, scope())
    known = [i for i in range(MOST + 2) if heads.known(b"%d" % i)]
    assert known == list(range(2, MOST + 2))
