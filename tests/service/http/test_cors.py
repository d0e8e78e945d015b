"""Cross-origin requests, as a browser applies the Fetch standard (https://fetch.spec.whatwg.org, 3.3 and 4.8)."""

from __future__ import annotations

import pytest

from tests.service.conftest import client_of, inline_toys
from tests.service.toy_routes import GOOD

pytestmark = pytest.mark.anyio

A, B = "https://a.example", "https://b.example:8443"
PREFLIGHT = {"origin": A, "access-control-request-method": "POST"}


async def test_no_origin_is_allowed_by_default() -> None:
    async with client_of(inline_toys()) as client:
        answer = await client.post("/v1/toy", json=GOOD, headers={"origin": A})
        before = await client.options("/v1/toy", headers=PREFLIGHT)
    assert not [name for name in (*answer.headers, *before.headers) if name.startswith("access-control")]
    assert before.status_code == 204


@pytest.mark.parametrize("origins", [f"{A},{B}", f"  {A} ,, {B},"])
async def test_listed_origins_are_allowed_and_others_not(origins: str) -> None:
    async with client_of(inline_toys(cors_origins=origins)) as client:
        for origin in (A, B, A + ".evil", "null", "http://a.example", A.upper(), B[:17], "*", A + "/"):
            allowed = origin in (A, B)
            for question in (GOOD, {}):
                answer = await client.post("/v1/toy", json=question, headers={"origin": origin})
                assert answer.headers.get("access-control-allow-origin") == (origin if allowed else None)
                # Caches must not give an answer for one origin to another, nor one without an origin.
                assert "origin" in answer.headers["vary"].lower()
                assert "access-control-allow-credentials" not in answer.headers
            before = await client.options("/v1/toy", headers=PREFLIGHT | {"origin": origin})
            assert (before.status_code == 200) is allowed
            assert (before.headers.get("access-control-allow-origin") == origin) is allowed
        assert "origin" in (await client.post("/v1/toy", json=GOOD)).headers["vary"].lower()


@pytest.mark.parametrize("origins", ["*", A])
async def test_what_the_service_reads_may_be_sent_and_what_it_says_may_be_read(origins: str) -> None:
    async with client_of(inline_toys(cors_origins=origins)) as client:
        for names, fits in (
            ("accept, authorization, content-type, idempotency-key, if-none-match, x-request-id", True),
            ("content-type, x-other", False),
        ):
            before = await client.options("/v1/toy", headers=PREFLIGHT | {"access-control-request-headers": names})
            assert (before.status_code == 200) is fits
        for method, fits in (("GET", True), ("HEAD", True), ("POST", True), ("DELETE", True), ("PUT", False)):
            before = await client.options("/v1/toy", headers=PREFLIGHT | {"access-control-request-method": method})
            assert (before.status_code == 200) is fits
        answer = await client.post("/v1/toy", json=GOOD, headers={"origin": A})
        exposed = {name.strip() for name in answer.headers["access-control-expose-headers"].split(",")}
        assert exposed >= {"etag", "location", "retry-after", "server-timing", "x-request-id"}
        assert answer.headers["access-control-allow-origin"] == origins


async def test_an_archive_varies_by_media_type_and_by_origin() -> None:
    async with client_of(inline_toys(cors_origins=A)) as client:
        answer = await client.post("/v1/toy", json=GOOD, headers={"origin": A, "accept": "application/x-npz"})
    assert {name.strip().lower() for name in answer.headers["vary"].split(",")} == {"accept", "origin"}
