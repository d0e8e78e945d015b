"""Content codings: which one is chosen, and that every body is the same once it is decompressed."""

from __future__ import annotations

import asyncio
import gzip
import json
from collections.abc import AsyncIterator, Callable, Iterator

import anyio
import pyarrow
import pytest

from service.http.compression import CODINGS, KEPT, LEAST, Coding, coding_for, compressed
from service.http.etag import JSON, Header, Representation
from service.routes.pages import FOLDER
from tests.service.conftest import PATIENCE, client_of, toy_service
from tests.service.http.test_request_context import Wire

pytestmark = pytest.mark.anyio

DOCUMENT = json.dumps([0.1 * k for k in range(3000)]).encode()


def unzstd(data: bytes) -> bytes:
    return pyarrow.CompressedInputStream(pyarrow.py_buffer(data), "zstd").read()  # type: ignore[no-any-return]


DECOMPRESS: dict[str, Callable[[bytes], bytes]] = {"gzip": gzip.decompress, "zstd": unzstd}


@pytest.mark.parametrize(
    ("accepted", "name"),
    [
        (None, None),
        (b"", None),
        (b"gzip", b"gzip"),
        (b"gzip, deflate, br, zstd", b"zstd"),
        (b"GZIP;q=0.5", b"gzip"),
        (b"gzip;q=0", None),
        (b"gzip;q=1.0, zstd;q=0.2", b"gzip"),
        (b"zstd; q=0, *;q=0.1", b"gzip"),
        (b"*", b"zstd"),
        (b"*;q=0", None),
        (b"identity", None),
        (b"br", None),
        (b"gzip;q=nonsense", None),
        (b"gzip;level=3", b"gzip"),
    ],
)
async def test_the_coding_is_the_best_that_is_accepted(accepted: bytes | None, name: bytes | None) -> None:
    found = coding_for(accepted, b"application/json")
    assert (found and found.name) == name


@pytest.mark.parametrize(
    ("media", "shrinks"),
    [
        (b"application/json", True),
        (b"text/javascript; charset=utf-8", True),
        (b"image/svg+xml", True),
        (b"text/event-stream", False),
        (b"application/x-npz", False),
    ],
)
async def test_only_text_is_compressed_and_no_events(media: bytes, shrinks: bool) -> None:
    assert (coding_for(b"gzip", media) is not None) == shrinks


@pytest.mark.parametrize("coding", CODINGS, ids=[coding.name.decode() for coding in CODINGS])
@pytest.mark.parametrize("kept", [False, True])
async def test_bodies_come_back(coding: Coding, kept: bool) -> None:
    for body in (b"", b"a", DOCUMENT):
        assert DECOMPRESS[coding.name.decode()](await compressed(coding, body, kept=kept)) == body


@pytest.mark.parametrize("name", DECOMPRESS)
class TestAnswers:
    async def test_in_one_piece(self, name: str) -> None:
        wire, plain = Wire(accept_encoding=name), Wire()
        answer = Representation(DOCUMENT)
        with anyio.fail_after(PATIENCE):
            await wire.exchange.answer(answer)
            await plain.exchange.answer(answer)
        assert DECOMPRESS[name](wire.body) == plain.body == DOCUMENT
        assert wire.headers["content-encoding"] == name
        assert wire.headers["content-length"] == str(len(wire.body))
        assert wire.headers["vary"] == plain.headers["vary"] == "accept-encoding"
        # Other bytes have another strong validator.
        assert wire.headers["etag"] == f'{plain.headers["etag"][:-1]}-{name}"'
        assert "content-encoding" not in plain.headers

    async def test_clients_revalidate_what_they_have(self, name: str) -> None:
        etag = Representation(DOCUMENT).etag.decode()[:-1] + f'-{name}"'
        wire = Wire(accept_encoding=name, if_none_match=etag)
        other = Wire(accept_encoding="identity", if_none_match=etag)
        await wire.exchange.answer(Representation(DOCUMENT))
        await other.exchange.answer(Representation(DOCUMENT))
        assert (wire.status, wire.body, wire.headers["etag"]) == (304, b"", etag)
        assert "content-length" not in wire.headers
        assert (other.status, other.body) == (200, DOCUMENT)

    async def test_head_has_the_headers_of_get(self, name: str) -> None:
        head, get = Wire("HEAD", accept_encoding=name), Wire("GET", accept_encoding=name)
        for wire in (head, get):
            await wire.exchange.page(DOCUMENT, b"text/plain", 200)
        assert head.headers == get.headers
        assert head.body == b""

    async def test_short_bodies_stay_as_they_are(self, name: str) -> None:
        wire = Wire(accept_encoding=name)
        await wire.exchange.answer(Representation(b"1" * (LEAST - 1)))
        assert wire.body == b"1" * (LEAST - 1)
        assert not {"vary", "content-encoding"} & set(wire.headers)

    @pytest.mark.parametrize("size", [10, 5_000, 50_000])
    async def test_in_pieces(self, name: str, size: int) -> None:
        wire, plain = Wire(accept_encoding=name), Wire()
        headers: list[Header] = [JSON]

        def pieces() -> Iterator[bytes]:
            return (DOCUMENT[k : k + size] for k in range(0, len(DOCUMENT), size))

        with anyio.fail_after(PATIENCE):
            await wire.exchange.stream(pieces(), b'"e"', 5.0, headers, asyncio.Lock())
            await plain.exchange.stream(pieces(), b'"e"', 5.0, headers, asyncio.Lock())
        assert DECOMPRESS[name](wire.body) == plain.body == DOCUMENT
        assert (wire.headers["etag"], plain.headers["etag"]) == (f'"e-{name}"', '"e"')
        # An empty piece would end a chunked body.
        assert all(message["body"] for message in wire.messages[1:])

    async def test_made_elsewhere(self, name: str) -> None:
        wire, archive = Wire(accept_encoding=name), Wire(accept_encoding=name)
        with anyio.fail_after(PATIENCE):
            await wire.exchange.stream_made_elsewhere(iter([DOCUMENT, DOCUMENT]), b"application/json", 5.0)
            await archive.exchange.stream_made_elsewhere(iter([DOCUMENT, DOCUMENT]), b"application/x-npz", 5.0)
        assert DECOMPRESS[name](wire.body) == archive.body == 2 * DOCUMENT
        assert "content-encoding" not in archive.headers

    async def test_documents_that_change(self, name: str) -> None:
        wire = Wire(accept_encoding=name)
        await wire.exchange.document(DOCUMENT, 200)
        assert DECOMPRESS[name](wire.body) == DOCUMENT
        assert wire.headers["content-length"] == str(len(wire.body))

    async def test_events_are_sent_one_by_one(self, name: str) -> None:
        wire = Wire(accept_encoding=name)

        async def events() -> AsyncIterator[bytes]:
            for k in range(3):
                yield b"data: %d\n\n" % k * 400

        with anyio.fail_after(PATIENCE):
            await wire.exchange.events(events())
        assert "content-encoding" not in wire.headers
        assert [message["body"][:9] for message in wire.messages[1:4]] == [
            b"data: 0\n\n",
            b"data: 1\n\n",
            b"data: 2\n\n",
        ]


async def test_files_are_compressed_once_and_well() -> None:
    script = FOLDER / "vendor" / "swagger-ui-bundle.js"
    async with client_of(toy_service()) as client:
        bodies = []
        for name in DECOMPRESS:
            for _ in range(2):
                async with client.stream(
                    "GET", "/page/vendor/swagger-ui-bundle.js", headers={"accept-encoding": name}
                ) as response:
                    bodies.append(b"".join([part async for part in response.aiter_raw()]))
                assert response.headers["content-encoding"] == name
    assert bodies[0] == bodies[1]
    assert bodies[2] == bodies[3]
    assert gzip.decompress(bodies[0]) == unzstd(bodies[2]) == script.read_bytes()
    assert max(map(len, bodies)) < 0.32 * script.stat().st_size


def test_every_file_is_kept_in_every_coding() -> None:
    assert sum(file.is_file() for file in FOLDER.rglob("*")) * len(CODINGS) < KEPT
