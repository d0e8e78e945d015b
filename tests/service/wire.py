"""Requests to the toy application as bytes, a server for them, and a protocol without one."""

import asyncio
import json
import re
from collections.abc import AsyncIterator
from contextlib import asynccontextmanager
from typing import Any

import uvicorn
from service.http.protocol import Protocol
from service.http.rounds import ROUNDS
from uvicorn.server import ServerState

from service.app import Service
from service.settings import Settings
from tests.service.conftest import TOYS
from tests.service.toy_routes import GOOD

BODY = json.dumps(GOOD).encode()
HEAD = b"POST /v1/toy HTTP/1.1\r\nhost: x\r\ncontent-type: application/json\r\n"
LAST = b"GET /healthz HTTP/1.1\r\nhost: x\r\nconnection: close\r\n\r\n"
LARGE = json.dumps(GOOD | {"times": {"start": 0.0, "stop": 1.0, "count": 30_000}}).encode()
FAIR = json.dumps(GOOD | {"times": {"start": 0.0, "stop": 1.0, "count": 600}}).encode()
MIDDLING = json.dumps(GOOD | {"times": {"start": 0.0, "stop": 1.0, "count": 4_000}}).encode()


def ask(body: bytes = BODY, more: bytes = b"") -> bytes:
    return HEAD + more + b"content-length: %d\r\n\r\n" % len(body) + body


def chunked(body: bytes, more: bytes = b"") -> bytes:
    parts = b"".join(b"%x\r\n%b\r\n" % (len(part), part) for part in (body[:9], body[9:]))
    return HEAD + more + b"transfer-encoding: chunked\r\n\r\n" + parts + b"0\r\n\r\n"


class InOneProcess(Service):
    """The application without compute processes, which starts at once."""

    async def __call__(self, scope: Any, receive: Any, send: Any) -> None:
        if scope["type"] != "lifespan":
            await super().__call__(scope, receive, send)
            return
        scope["state"][ROUNDS] = self.dispatcher.rounds
        for name in ("startup", "shutdown"):
            await receive()
            await send({"type": f"lifespan.{name}.complete"})


@asynccontextmanager
async def serving(http: Any, config: dict[str, Any] | None = None, **settings: Any) -> AsyncIterator[uvicorn.Server]:
    app = InOneProcess(Settings(inline_seconds=1e9, inline_bytes=10**9, **settings), TOYS)
    server = uvicorn.Server(
        uvicorn.Config(
            app,
            port=0,
            http=http,
            lifespan="on",
            log_config=None,
            server_header=False,
            date_header=False,
            headers=[("x-server", "one"), ("x-place", "two")],
            **{"access_log": False, **(config or {})},
        )
    )
    task = asyncio.create_task(server.serve())
    while not server.started:
        await asyncio.sleep(0.005)
    try:
        yield server
    finally:
        server.should_exit = True
        await task


async def connect(server: uvicorn.Server) -> tuple[asyncio.StreamReader, asyncio.StreamWriter]:
    return await asyncio.open_connection("127.0.0.1", server.servers[0].sockets[0].getsockname()[1])


async def told(server: uvicorn.Server, *pieces: bytes) -> bytes:
    """Send pieces with a pause between them and return all that comes back until the end."""
    reader, writer = await connect(server)
    for piece in pieces:
        writer.write(piece)
        await writer.drain()
        await asyncio.sleep(0.03 if len(pieces) > 1 else 0.0)
    received = await asyncio.wait_for(reader.read(), 20)
    writer.close()
    return received


def plain(received: bytes) -> bytes:
    """Return a response without what differs from request to request."""
    # In a header, and in the document of a problem.
    made = re.compile(rb"\b[0-9a-f]{12}-[0-9a-f]+\b")
    return re.sub(rb"(?<=server-timing: total;dur=)[\d.]+", b"#", made.sub(b"#", received))


class Transport:
    """Notes what a protocol does to its transport."""

    def __init__(self) -> None:
        self.done: list[bytes] = []
        self.reading = True

    def pause_reading(self) -> None:
        self.reading = False

    def resume_reading(self) -> None:
        self.reading = True

    def write(self, data: bytes) -> None:
        self.done.append(data)

    def close(self) -> None:
        self.done.append(b"closed")

    def is_closing(self) -> bool:
        return b"closed" in self.done

    def get_extra_info(self, name: str) -> Any:
        return None


def connected() -> tuple[Protocol, Transport]:
    service = Service(Settings(), TOYS)
    config = uvicorn.Config(service, log_config=None, access_log=False, lifespan="off")
    protocol, transport = Protocol(config, ServerState(), {ROUNDS: service.dispatcher.rounds}), Transport()
    protocol.connection_made(transport)  # type: ignore[arg-type]
    protocol.data_received(ask())
    return protocol, transport


def statuses(transport: Transport) -> list[bytes]:
    return [
        done.split(b"\r\n")[0].removeprefix(b"HTTP/1.1 ") for done in transport.done if done[:4] in (b"HTTP", b"clos")
    ]


async def until_answered(transport: Transport, count: int) -> None:
    async with asyncio.timeout(20):
        while len(statuses(transport)) < count:
            await asyncio.sleep(0)
