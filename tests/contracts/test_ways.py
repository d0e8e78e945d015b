"""Every question of the table, asked in the three ways there are: the same bytes come back."""

from __future__ import annotations

import asyncio

import httpx
import orjson
import pytest
from service.http.rounds import FEW, SHORT, SMALL

from service.app import create_app
from service.responses.json_rows import array_size
from service.routing import PostRoute
from service.settings import Settings
from tests.service.http.test_rounds import Asker

pytestmark = pytest.mark.anyio

SERVICE = create_app(Settings(cached_answers=0, inline_seconds=1e9))
EXAMPLES = [
    (route, name) for route in SERVICE.routes if isinstance(route, PostRoute) for name in sorted(route.examples)
]
PASSING = ("x-request-id", "server-timing")


async def asked_of(app: object, route: PostRoute, body: bytes) -> tuple[dict[str, str], bytes]:
    transport = httpx.ASGITransport(app)  # type: ignore[arg-type]
    async with httpx.AsyncClient(transport=transport, base_url="http://test") as client:
        response = await client.post(route.path, content=body, headers={"content-type": "application/json"})
    assert response.status_code == 200, response.text
    return {name: value for name, value in response.headers.items() if name not in PASSING}, response.content


@pytest.fixture(scope="module", autouse=True)
def warm() -> None:
    # So that predicted times are times of computing.
    SERVICE._answering.warm()


@pytest.mark.parametrize(("route", "name"), EXAMPLES, ids=[f"{route.operation_id}: {name}" for route, name in EXAMPLES])
async def test_every_way_answers_the_same(route: PostRoute, name: str) -> None:
    body = orjson.dumps(route.examples[name].question)
    headers, text = await asked_of(SERVICE, route, body)
    assert await asked_of(SERVICE.documented, route, body) == (headers, text)
    rounds, asker = SERVICE.dispatcher.rounds, Asker()
    assert rounds is not None
    rounds.ask(asker, route, body)
    await asyncio.sleep(0)
    (heard,) = asker.heard
    question = SERVICE._answering.read(route, body)
    long = array_size(SERVICE._answering.answer(route, question)) > FEW or len(text) > SHORT
    assert (heard is None) is (SERVICE._answering.price(route, question) > SMALL or long)
    if heard is not None:
        lines = dict(line.split(": ", 1) for line in heard[0].decode().removesuffix("\r\n").split("\r\n"))
        assert {line: value for line, value in lines.items() if line not in PASSING} == headers
        assert heard[1] == text


async def test_small_questions_are_answered_in_rounds() -> None:
    rounds = SERVICE.dispatcher.rounds
    assert rounds is not None
    found = set()
    for route, name in EXAMPLES:
        asker = Asker()
        rounds.ask(asker, route, orjson.dumps(route.examples[name].question))
        await asyncio.sleep(0)
        found |= {route.operation_id} if asker.heard != [None] else set()
    assert found >= {"mass_properties", "precession", "stability", "wobble"}
