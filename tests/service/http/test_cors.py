"""Origins, as a browser applies the Fetch standard to what is sent (https://fetch.spec.whatwg.org, 3.3 and 4.8)."""

from __future__ import annotations

import pytest
from hypothesis import given
from hypothesis import strategies as st
from service.http.cors import Cors, Header

from tests.service.conftest import client_of, inline_toys
from tests.service.toy_routes import GOOD

A, B = b"https://a.example", b"https://b.example:8443"
ASKED = b"access-control-request-method"

SAFELISTED_METHODS = {b"GET", b"HEAD", b"POST"}
SAFELISTED_RESPONSE_HEADERS = {
    b"cache-control", b"content-language", b"content-length", b"content-type", b"expires", b"last-modified", b"pragma"
}  # fmt: skip


def values(headers: tuple[Header, ...], name: bytes) -> list[bytes]:
    return [value for own, value in headers if own == name]


def listed(headers: tuple[Header, ...], name: bytes) -> set[bytes]:
    return {entry.strip().lower() for value in values(headers, name) for entry in value.split(b",")}


def passes(origin: bytes, headers: tuple[Header, ...]) -> bool:
    """Return whether a browser lets a page read an answer ("CORS check", credentials mode "same-origin")."""
    allowed = values(headers, b"access-control-allow-origin")
    # Several headers are joined to one value, which then is no origin.
    return b", ".join(allowed) in (b"*", origin) if allowed else False


def preflight_passes(cors: Cors, origin: bytes, method: bytes, names: set[bytes]) -> bool:
    """Return whether a browser sends a request after its question ("CORS-preflight fetch", 7)."""
    request = {b"origin": origin, ASKED: method, b"access-control-request-headers": b",".join(sorted(names))}
    answer = cors.preflight("OPTIONS", request)
    if answer is None:
        # Answered as any other request with this method: not by an ok status.
        return False
    answer += cors.headers(request)
    if not passes(origin, answer):
        return False
    methods = {value.strip() for line in values(answer, b"access-control-allow-methods") for value in line.split(b",")}
    return method in methods | SAFELISTED_METHODS and names <= listed(answer, b"access-control-allow-headers")


@pytest.mark.parametrize(("origins", "allowed"), [("https://a.example,https://b.example:8443", {A, B}), ("*", None)])
@given(origin=st.sampled_from([A, B, b"null", A + b".evil", b"http://a.example", A.upper(), B[:17], b"*", A + b"/"]))
def test_answers_are_read_by_pages_of_the_origins_that_are_listed(
    origins: str, allowed: set[bytes] | None, origin: bytes
) -> None:
    cors = Cors(origins)
    expected = allowed is None or origin in allowed
    request = {b"origin": origin}
    assert passes(origin, cors.headers(request)) is expected
    assert preflight_passes(cors, origin, b"POST", {b"content-type"}) is expected


@pytest.mark.parametrize("origins", ["*", A.decode()])
class TestWhatIsAllowed:
    def test_every_header_that_the_service_reads_may_be_sent(self, origins: str) -> None:
        cors = Cors(origins)
        for name in (b"accept", b"authorization", b"content-type", b"if-none-match", b"x-request-id"):
            assert preflight_passes(cors, A, b"POST", {name})
        assert preflight_passes(cors, A, b"POST", {b"authorization", b"content-type"})
        assert not preflight_passes(cors, A, b"POST", {b"content-type", b"x-other"})

    def test_methods_that_no_path_answers_may_not(self, origins: str) -> None:
        cors = Cors(origins)
        for method in (b"GET", b"HEAD", b"POST"):
            assert preflight_passes(cors, A, method, set())
        for method in (b"PUT", b"DELETE", b"PATCH", b"post"):
            assert not preflight_passes(cors, A, method, set())

    def test_what_is_told_about_an_answer_may_be_read(self, origins: str) -> None:
        told = listed(Cors(origins).headers({b"origin": A}), b"access-control-expose-headers")
        assert {b"etag", b"retry-after", b"server-timing", b"x-request-id"} <= told | SAFELISTED_RESPONSE_HEADERS

    def test_credentials_are_never_allowed(self, origins: str) -> None:
        """With them "*" would not do, and a page could ask in its visitor's name."""
        cors, request = Cors(origins), {b"origin": A, ASKED: b"POST", b"cookie": b"a=1"}
        answer = cors.headers(request) + (cors.preflight("OPTIONS", request) or ())
        assert not values(answer, b"access-control-allow-credentials")


@pytest.mark.parametrize(
    ("method", "request_"),
    [
        ("OPTIONS", {}),
        ("OPTIONS", {b"origin": A}),
        ("OPTIONS", {ASKED: b"POST"}),
        ("POST", {b"origin": A, ASKED: b"POST"}),
        ("GET", {b"origin": A, ASKED: b"GET"}),
    ],
)
def test_only_a_browsers_question_is_one(method: str, request_: dict[bytes, bytes]) -> None:
    assert Cors(A.decode()).preflight(method, request_) is None
    assert Cors("*").preflight(method, request_) is None


def test_answers_that_depend_on_the_origin_say_so_to_caches() -> None:
    """Also that to a request without an origin, which a cache would otherwise give to a page ("CORS and caches")."""
    for request in ({}, {b"origin": A}, {b"origin": b"https://c.example"}):
        assert values(Cors(A.decode()).headers(request), b"vary") == [b"origin"]
    assert Cors("*").headers({}) == ()


@pytest.mark.parametrize("origins", ["", " ", ",", " , ,"])
def test_without_origins_there_is_nothing(origins: str) -> None:
    assert not Cors(origins)


def test_spaces_around_origins_do_not_count() -> None:
    cors = Cors(f"  {A.decode()} ,, {B.decode()},")
    assert cors
    assert all(passes(origin, cors.headers({b"origin": origin})) for origin in (A, B))


PREFLIGHT = {"origin": "https://a.example", "access-control-request-method": "POST"}


@pytest.mark.anyio
class TestOverHttp:
    """Pages of other origins."""

    async def test_nobody_is_allowed_by_default(self) -> None:
        async with client_of(inline_toys()) as client:
            asked = await client.post("/v1/toy", json=GOOD, headers={"origin": "https://a.example"})
            before = await client.options("/v1/toy", headers=PREFLIGHT)
        assert not [name for name in (*asked.headers, *before.headers) if name.startswith("access-control")]
        assert before.status_code == 405

    async def test_listed_origins_are_allowed_and_others_not(self) -> None:
        service = inline_toys(cors_origins="https://a.example, https://b.example")
        async with client_of(service) as client:
            for origin, allowed in (
                ("https://a.example", True),
                ("https://b.example", True),
                ("https://a.example.evil", False),
                ("null", False),
            ):
                for question in (GOOD, {}):
                    answer = await client.post("/v1/toy", json=question, headers={"origin": origin})
                    assert answer.headers.get("access-control-allow-origin") == (origin if allowed else None)
                    assert answer.headers["vary"] == "origin"
                    assert "access-control-allow-credentials" not in answer.headers
            before = await client.options("/v1/toy", headers=PREFLIGHT)
            assert (before.status_code, before.content) == (204, b"")
            assert before.headers["access-control-allow-origin"] == "https://a.example"
            assert "content-type" in before.headers["access-control-allow-headers"]
            assert (await client.options("/nothing", headers=PREFLIGHT)).status_code == 404

    async def test_all_may_be_allowed(self) -> None:
        async with client_of(inline_toys(cors_origins="*")) as client:
            answer = await client.post("/v1/toy", json=GOOD, headers={"origin": "null"})
        assert answer.headers["access-control-allow-origin"] == "*"
