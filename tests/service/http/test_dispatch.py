"""Requests and responses beside what a question means: paths, methods, headers, streams, failures."""

import asyncio
import itertools
import json
import logging
from datetime import date
from typing import Any

import anyio
import httpx
import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from starlette.applications import Starlette
from starlette.routing import Mount

from service import app as app_module
from service.app import Service
from service.http import dispatch
from service.http.deprecation import Deprecation
from service.openapi import document
from service.responses.json_rows import CHUNK
from service.settings import Settings
from tests.drawn import draws
from tests.service import hostile
from tests.service.conftest import INLINE, TOYS, client_of, inline_toys, toy_service
from tests.service.toy_routes import GOOD

pytestmark = pytest.mark.anyio

JSON = {"content-type": "application/json"}
FUZZED = inline_toys()


@pytest.fixture(scope="module")
def service() -> Service:
    return inline_toys()


@pytest.fixture
async def client(service: Service):  # type: ignore[no-untyped-def]
    async with client_of(service) as open_client:
        yield open_client


async def test_an_answer_has_signature_and_warnings(client: httpx.AsyncClient) -> None:
    response = await client.post("/v1/toy", json=GOOD | {"behaviour": "warn"})
    answer = response.json()
    assert response.status_code == 200
    assert list(answer) == ["signature", "warnings", "time", "position", "nothing"]
    assert answer["signature"] == {"source": "polhode", "version": "1.0.0"}
    assert answer["warnings"] == [{"code": "toy", "detail": "this is a toy", "pointer": "/body/moments/0"}]
    assert answer["time"] == [0.0, 0.5, 1.0]
    assert int(response.headers["content-length"]) == len(response.content)


async def test_every_response_has_id_timing_and_nosniff(client: httpx.AsyncClient) -> None:
    for request in (client.build_request("POST", "/v1/toy", json=GOOD), client.build_request("GET", "/nothing")):
        headers = (await client.send(request)).headers
        assert headers["x-content-type-options"] == "nosniff"
        assert headers["server-timing"].startswith("total;dur=")
        assert headers["x-request-id"]


async def test_request_ids_are_the_clients_where_they_are_plain(client: httpx.AsyncClient) -> None:
    given_id = await client.get("/healthz", headers={"x-request-id": "grading-17.a_b"})
    assert given_id.headers["x-request-id"] == "grading-17.a_b"
    made = [
        (await client.get("/healthz", headers={"x-request-id": bad})).headers["x-request-id"]
        for bad in ("a b", "x" * 65, "")
    ]
    assert len(set(made)) == 3
    assert not {"a b", "x" * 65, ""} & set(made)


async def test_equal_questions_get_equal_bytes(client: httpx.AsyncClient) -> None:
    one, two = [await client.post("/v1/toy", json=GOOD) for _ in range(2)]
    assert one.content == two.content
    assert one.headers["etag"] == two.headers["etag"]
    other = await toy_client_post(GOOD)
    assert (one.content, one.headers["etag"]) == (other.content, other.headers["etag"])


async def toy_client_post(question: dict[str, Any]) -> httpx.Response:
    async with client_of(inline_toys()) as fresh:
        return await fresh.post("/v1/toy", json=question)


@pytest.mark.parametrize("count", [3, 100_000])
async def test_what_the_client_has_is_not_sent_again(client: httpx.AsyncClient, count: int) -> None:
    question = GOOD | {"times": {"start": 0.0, "stop": 1.0, "count": count}}
    etag = (await client.post("/v1/toy", json=question)).headers["etag"]
    for known in (etag, f'"other", {etag}', "*"):
        again = await client.post("/v1/toy", json=question, headers={"if-none-match": known})
        assert (again.status_code, again.content, again.headers["etag"]) == (304, b"", etag)
    assert (await client.post("/v1/toy", json=question, headers={"if-none-match": '"other"'})).status_code == 200


@pytest.mark.parametrize("accept", ["application/json", "application/x-npz"])
async def test_the_validator_of_a_stream_names_the_version(
    client: httpx.AsyncClient, monkeypatch: pytest.MonkeyPatch, accept: str
) -> None:
    question = GOOD | {"times": {"start": 0.0, "stop": 1.0, "count": 30_000}}
    before = (await client.post("/v1/toy", json=question, headers={"accept": accept})).headers["etag"]
    monkeypatch.setattr(dispatch, "_VERSION", b"0.1.1")
    known = {"accept": accept, "if-none-match": before}
    after = await client.post("/v1/toy", json=question, headers=known)
    assert after.status_code == 200
    assert after.headers["etag"] != before
    known["if-none-match"] = after.headers["etag"]
    again = await client.post("/v1/toy", json=question, headers=known)
    assert (again.status_code, again.headers.get("vary")) == (304, after.headers.get("vary"))


async def test_large_answers_are_streamed_and_complete(service: Service) -> None:
    messages = []
    question = json.dumps(GOOD | {"times": {"start": 0.0, "stop": 1.0, "count": 100_001}}).encode()
    await service(scope("POST", "/v1/toy", JSON), receiving(question), sending(messages))
    pieces = [message["body"] for message in messages[1:]]
    assert len(pieces) > 400_004 // CHUNK
    assert max(map(len, pieces)) < 25 * CHUNK
    answer = json.loads(b"".join(pieces))
    np.testing.assert_array_equal(answer["time"], np.linspace(0, 1, 100_001))
    np.testing.assert_array_equal(np.array(answer["position"])[:, 1], np.linspace(0, 1, 100_001))


async def test_cached_answers_are_the_same(service: Service) -> None:
    keeping = Service(Settings(**INLINE, cached_answers=2), TOYS)
    async with client_of(keeping) as client, client_of(service) as plain:
        for stop in (1.0, 2.0, 3.0, 1.0, 3.0, 3.0, 1.0):
            question = GOOD | {"times": {"start": 0.0, "stop": stop, "count": 3}}
            assert (await client.post("/v1/toy", json=question)).content == (
                await plain.post("/v1/toy", json=question)
            ).content
        assert "polhode_cache_hits_total 2.0" in (await client.get("/metrics")).text
        # A question that was refused is refused again.
        for _ in range(2):
            assert (await client.post("/v1/toy", json={})).status_code == 422


async def test_what_is_cached_is_sent_to_those_who_accept_it() -> None:
    keeping = Service(Settings(**INLINE, cached_answers=2), TOYS)
    found = []
    async with client_of(keeping) as client:
        for accept in (
            "*/*",
            "application/x-npz",
            "*/*",
            "application/json",
            "application/x-npz;q=0.5, */*;q=0.1",
            "text/csv",
        ):
            response = await client.post("/v1/toy", json=GOOD, headers={"accept": accept})
            found.append((response.status_code, response.headers["content-type"], response.headers.get("etag")))
        assert "polhode_cache_hits_total 1.0" in (await client.get("/metrics")).text
    kinds = ["json", "x-npz", "json", "json", "x-npz"]
    assert [kind for _, kind, _ in found[:5]] == [f"application/{kind}" for kind in kinds]
    assert (found[0], found[0], found[1], found[5][0]) == (found[2], found[3], found[4], 406)
    assert found[0][2] != found[1][2]


@pytest.mark.parametrize(
    ("headers", "status", "code"), [row[1:] for row in hostile.HEADERS], ids=[row[0] for row in hostile.HEADERS]
)
async def test_headers_are_refused(client: httpx.AsyncClient, headers: dict[str, str], status: int, code: str) -> None:
    encoded = [(name.encode(), value.encode("latin-1")) for name, value in headers.items()]
    response = await client.post("/v1/toy", content=json.dumps(GOOD).encode(), headers=encoded)
    assert (response.status_code, response.json()["code"]) == (status, code)


async def test_media_type_may_have_parameters(client: httpx.AsyncClient) -> None:
    headers = {"content-type": "Application/JSON ; charset=utf-8"}
    assert (await client.post("/v1/toy", content=json.dumps(GOOD), headers=headers)).status_code == 200


async def test_an_unknown_path_is_answered_with_the_nearest_one(client: httpx.AsyncClient) -> None:
    response = await client.post("/v1/toys", json=GOOD, headers={"x-request-id": "mine"})
    document = response.json()
    assert document["detail"] == (
        "there is nothing at this path; did you mean /v1/toy? GET /openapi.json lists every path"
    )
    assert document["instance"] == "urn:polhode:request:mine"
    assert document["request_id"] == response.headers["x-request-id"] == "mine"


async def test_a_question_has_no_parameters_in_its_address(client: httpx.AsyncClient) -> None:
    response = await client.post("/v1/toy?digits=30&" + "n" * 100 + "=1", json=GOOD)
    document = response.json()
    assert (response.status_code, document["code"]) == (422, "invalid-parameter")
    assert [fault["pointer"] for fault in document["errors"]] == ["?digits", "?" + "n" * 40]
    assert "body" in document["detail"]
    assert (await client.post("/v1/toy?", json=GOOD)).status_code == 200


async def test_unknown_paths_and_methods(client: httpx.AsyncClient) -> None:
    for path in ("/v1", "/v1/toy/", "/V1/TOY", "/v1//toy", "/..%2f..%2fetc/passwd", "/page/", "/page/../settings.py"):
        response = await client.post(path, json=GOOD)
        assert (response.status_code, response.json()["code"]) == (404, "not-found")
    for method, path, allowed in (
        ("GET", "/v1/toy", "POST, OPTIONS"),
        ("DELETE", "/healthz", "GET, HEAD, OPTIONS"),
        ("TRACE", "/", "GET, HEAD, OPTIONS"),
    ):
        response = await client.request(method, path)
        assert (response.status_code, response.headers["allow"]) == (405, allowed)
        options = await client.options(path)
        assert (options.status_code, options.headers["allow"], options.content) == (204, allowed, b"")
    assert (await client.options("/nothing")).status_code == 404


async def test_a_path_with_an_ending_answers_in_its_form(client: httpx.AsyncClient) -> None:
    accepted = await client.post("/v1/toy", json=GOOD, headers={"accept": "application/x-npz"})
    found = await client.post("/v1/toy.npz", json=GOOD, headers={"accept": "application/json"})
    assert (found.status_code, found.content) == (200, accepted.content)
    assert found.headers["content-type"] == "application/x-npz"
    assert (await client.post("/v1/toy.svg", json=GOOD)).status_code == 404


async def test_operations_that_are_to_end_say_when(monkeypatch: pytest.MonkeyPatch) -> None:
    ending = Deprecation(date(2026, 11, 26), date(2027, 6, 1), "/changes")
    monkeypatch.setattr(dispatch, "DEPRECATED", {"ask_toy": ending})
    monkeypatch.setattr(document, "DEPRECATED", {"ask_toy": ending})
    announcing = inline_toys()
    async with client_of(announcing) as client:
        for answer in (await client.post("/v1/toy", json=GOOD), await client.post("/v1/toy", json={})):
            # 2026-11-26 00:00 UTC is 20783 days after 1970-01-01.
            assert answer.headers["deprecation"] == f"@{20783 * 86400}"
            assert answer.headers["sunset"] == "Tue, 01 Jun 2027 00:00:00 GMT"
            assert answer.headers["link"] == '</changes>; rel="deprecation"'
        assert "sunset" not in (await client.get("/healthz")).headers
    marked = [
        one["operationId"]
        for verbs in announcing.openapi()["paths"].values()
        for one in verbs.values()
        if "deprecated" in one
    ]
    assert marked == ["ask_toy"]


@pytest.mark.parametrize(
    ("target", "status"),
    [("http://test/healthz", 200), ("HTTP://example.org:8000/healthz", 200), ("http://test", 200), ("*", 404)],
)
async def test_targets_in_absolute_form_lead_to_their_path(target: str, status: int) -> None:
    sent = await respond_to(toy_service(), target)
    assert sent[0]["status"] == status


@pytest.mark.parametrize(("host", "status"), [("polhode.example.org", 200), ("attacker.net", 421)])
async def test_the_host_of_a_target_in_absolute_form_takes_the_place_of_the_header(host: str, status: int) -> None:
    messages: list[dict[str, Any]] = []
    named = toy_service(allowed_hosts="polhode.example.org")
    other = {"polhode.example.org": "attacker.net", "attacker.net": "polhode.example.org"}[host]
    await named(scope("GET", f"http://{host}:80/healthz", {"host": other}), receiving(b""), sending(messages))
    assert messages[0]["status"] == status


@pytest.mark.parametrize(
    ("host", "status"),
    [
        ("polhode.example.org", 200),
        ("Polhode.Example.ORG:8443", 200),
        ("a.course.example.org", 200),
        ("localhost:8000", 200),
        ("127.0.0.1", 200),
        ("[::1]:8000", 200),
        ("course.example.org", 421),
        ("polhode.example.org.attacker.net", 421),
        ("attackercourse.example.org", 421),
        ("", 421),
    ],
)
async def test_other_host_names_are_refused_where_those_of_the_service_are_known(host: str, status: int) -> None:
    named = toy_service(allowed_hosts="polhode.example.org, *.course.example.org")
    async with client_of(named) as client:
        for path in ("/healthz", "/v1/nothing"):
            response = await client.get(path, headers={"host": host})
            if status == 421:
                assert (response.status_code, response.json()["code"]) == (421, "unknown-host")
            else:
                assert response.status_code in (200, 404)


async def respond_to(app: Service, target: str) -> list[Any]:
    """Return what an application sends as its response to GET, however its target is written."""
    sent: list[Any] = []

    async def receive() -> Any:
        return {"type": "http.disconnect"}

    async def send(message: Any) -> None:
        sent.append(message)

    scope = {"type": "http", "method": "GET", "path": target, "raw_path": target.encode(), "headers": [],
             "query_string": b"", "http_version": "1.1", "root_path": ""}  # fmt: skip
    await app(scope, receive, send)
    return sent


async def test_pages(client: httpx.AsyncClient) -> None:
    for path, kind in (
        ("/", "text/html"),
        ("/docs", "text/html"),
        ("/openapi.json", "application/json"),
        ("/v1/errors", "application/json"),
        ("/healthz", "application/json"),
        ("/metrics", "text/plain"),
    ):
        response = await client.get(path)
        assert response.status_code == 200
        assert response.headers["content-type"].startswith(kind)
        head = await client.head(path)
        assert (head.status_code, head.content) == (200, b"")
        if path != "/metrics":
            assert head.headers["content-length"] == response.headers["content-length"]
            again = await client.get(path, headers={"if-none-match": response.headers["etag"]})
            assert (again.status_code, again.content) == (304, b"")


async def test_a_failure_gives_an_id_and_nothing_else(
    client: httpx.AsyncClient, caplog: pytest.LogCaptureFixture
) -> None:
    for behaviour in ("fail", "nan"):
        caplog.clear()
        with caplog.at_level(logging.INFO, "polhode"):
            response = await client.post("/v1/toy", json=GOOD | {"behaviour": behaviour})
        document = response.json()
        assert (response.status_code, document["code"]) == (500, "internal-error")
        assert document["id"] == response.headers["x-request-id"]
        assert "secret" not in response.text
        assert document["id"] in [getattr(record, "request_id", None) for record in caplog.records if record.exc_info]


async def test_nothing_is_sent_of_a_large_answer_that_is_not_finite(client: httpx.AsyncClient) -> None:
    question = GOOD | {"behaviour": "nan", "times": {"start": 0.0, "stop": 1.0, "count": 100_000}}
    response = await client.post("/v1/toy", json=question)
    assert (response.status_code, response.json()["code"]) == (500, "internal-error")


async def test_refusals_and_requests_are_counted(client: httpx.AsyncClient) -> None:
    for question in (GOOD, {}):
        await client.post("/v1/toy", json=question)
    text = (await client.get("/metrics")).text
    assert 'polhode_problems_total{code="invalid-parameter"}' in text
    assert 'polhode_request_seconds_count{operation="ask_toy",status="200"}' in text


async def test_not_ready_before_the_start(client: httpx.AsyncClient) -> None:
    response = await client.get("/readyz")
    assert (response.status_code, response.json()["code"]) == (503, "not-ready")
    assert (await client.get("/healthz")).json() == {"status": "alive"}


async def test_questions_are_refused_while_the_service_starts() -> None:
    starting = inline_toys()
    async with starting.lifespan(), client_of(starting) as client:
        response = await client.post("/v1/toy", json=GOOD)
        assert (response.status_code, response.json()["code"]) == (503, "not-ready")
        assert response.headers["retry-after"] == "2"
        assert (await client.get("/healthz")).status_code == 200


async def test_a_body_is_not_held_beyond_the_limit() -> None:
    small = toy_service(max_body_bytes=1000)
    for declared in (True, False):
        sent = 0

        async def endless() -> dict[str, Any]:
            nonlocal sent
            sent += 100
            return {"type": "http.request", "body": b" " * 100, "more_body": True}

        messages: list[dict[str, Any]] = []
        headers = JSON | ({"content-length": "100000000"} if declared else {})
        await small(scope("POST", "/v1/toy", headers), endless, sending(messages))
        assert messages[0]["status"] == 413
        assert sent <= 4200
        assert json.loads(messages[1]["body"])["limit"] == 1000
        assert (b"connection", b"close") in messages[0]["headers"]


async def test_a_client_that_leaves_while_it_sends_is_let_go(service: Service) -> None:
    messages: list[dict[str, Any]] = []
    parts = iter([{"type": "http.request", "body": b"{", "more_body": True}, {"type": "http.disconnect"}])

    async def leaving() -> dict[str, Any]:
        return next(parts)

    await service(scope("POST", "/v1/toy", JSON), leaving, sending(messages))
    assert messages == []


@given(
    st.lists(st.integers(0, 400), max_size=6),
    st.binary(max_size=400),
)
@settings(deadline=None, derandomize=True, max_examples=draws(100))
def test_any_bytes_in_any_parts_get_a_problem(cuts: list[int], body: bytes) -> None:
    messages: list[dict[str, Any]] = []
    edges = [0, *sorted(min(cut, len(body)) for cut in cuts), len(body)]
    parts = [body[a:b] for a, b in itertools.pairwise(edges)]

    async def run() -> None:
        await FUZZED(scope("POST", "/v1/toy", JSON), receiving(*parts), sending(messages))

    anyio.run(run)
    assert messages[0]["status"] in (400, 422)


def test_no_path_is_declared_twice(service: Service) -> None:
    ours = [(route.method, route.path) for route in service.table]
    theirs = [(method, route.path) for route in service.routes for method in route.methods]  # type: ignore[attr-defined]
    assert len(set(ours)) == len(ours)
    assert len(set(theirs)) == len(theirs)
    assert set(ours) <= set(theirs)


async def test_the_application_may_be_mounted(service: Service, client: httpx.AsyncClient) -> None:
    outer = Starlette(routes=[Mount("/mechanics", app=service)])
    async with client_of(outer) as mounted:
        for method, path, body in (("POST", "/v1/toy", GOOD), ("GET", "/v1/toy", None), ("HEAD", "/healthz", None)):
            same = {"x-request-id": "same"}
            inside = await mounted.request(method, "/mechanics" + path, json=body, headers=same)
            outside = await client.request(method, path, json=body, headers=same)
            assert (inside.status_code, inside.content) == (outside.status_code, outside.content)
            assert inside.headers.get("allow") == outside.headers.get("allow")
        assert (await mounted.get("/mechanics/nothing")).json()["code"] == "not-found"


def test_the_module_has_an_application_for_servers() -> None:
    """Some servers look into the module itself, so that it must be there without having been asked for."""
    assert isinstance(vars(app_module)["app"], Service)


def scope(method: str, path: str, headers: dict[str, str]) -> dict[str, Any]:
    encoded = [(name.encode(), value.encode()) for name, value in headers.items()]
    return {"type": "http", "method": method, "path": path, "headers": encoded, "query_string": b""}


def receiving(*parts: bytes) -> Any:
    """Return what a client sends that waits for the answer, or leaves at once if it sends nothing."""
    messages = [{"type": "http.request", "body": part, "more_body": i < len(parts) - 1} for i, part in enumerate(parts)]
    remaining = iter(messages)

    async def receive() -> dict[str, Any]:
        for message in remaining:
            return message
        if parts:
            await asyncio.Event().wait()
        return {"type": "http.disconnect"}

    return receive


def sending(messages: list[dict[str, Any]]) -> Any:
    async def send(message: dict[str, Any]) -> None:
        messages.append(message)

    return send
