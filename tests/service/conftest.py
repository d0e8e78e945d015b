"""Clients of the application, in this process and over a socket."""

from __future__ import annotations

import os
import signal
import subprocess
import sys
import time
from collections.abc import AsyncIterator, Callable, Iterator
from contextlib import asynccontextmanager
from dataclasses import replace
from pathlib import Path
from threading import Thread
from typing import Any

import httpx
import pytest

from service.app import Service
from service.routes import questions
from service.routing import PostRoute
from service.settings import Settings

ROOT = Path(__file__).parents[2]
PATIENCE = 240.0
"""Seconds after which what a test waits for will not come: more than any load of a machine makes of moments, and less
than pytest's own limit, which would end the process."""

TOYS = "tests.service.toy_routes:table"


@pytest.fixture(scope="session")
def anyio_backend() -> str:
    return "asyncio"


@asynccontextmanager
async def client_of(app: Any) -> AsyncIterator[httpx.AsyncClient]:
    transport = httpx.ASGITransport(app, raise_app_exceptions=False)
    async with httpx.AsyncClient(transport=transport, base_url="http://test") as client:
        yield client


INLINE: dict[str, Any] = {"inline_work": 10**12, "inline_bytes": 10**9}
"""Settings with which everything that is small is answered in this process, whatever it costs."""


def toy_service(**settings: Any) -> Service:
    return Service(Settings(cached_answers=0, **settings), TOYS)


def inline_toys(**settings: Any) -> Service:
    """Return the toys' service without compute processes."""
    return Service(Settings(cached_answers=0, **INLINE, **settings), "tests.service.toy_routes:inline_table")


def everything_inline() -> tuple[PostRoute, ...]:
    """Return the route table with every question small."""
    return tuple(replace(route, small=lambda question: True) for route in questions())


def inline_service(**settings: Any) -> Service:
    """Return the service without compute processes."""
    return Service(Settings(cached_answers=0, **INLINE, **settings), "tests.service.conftest:everything_inline")


class Server:
    """A server process on a free port."""

    def __init__(self, **environment: str) -> None:
        self.process = subprocess.Popen(
            [sys.executable, "-m", "service", "--port", "0"],
            cwd=ROOT,
            env={**os.environ, **environment},
            stderr=subprocess.PIPE,
            text=True,
        )
        self.log: list[str] = []
        self.port = self._port()
        # A pipe that nobody empties would stop the server when it is full.
        self._reading = Thread(target=self._read, daemon=True)
        self._reading.start()
        self.url = f"http://127.0.0.1:{self.port}"

    def _port(self) -> int:
        assert self.process.stderr is not None
        for line in self.process.stderr:
            self.log.append(line)
            if "running on" in line:
                return int(line.split("running on http://127.0.0.1:")[1].split()[0].strip('",'))
        raise RuntimeError("".join(self.log))

    def _read(self) -> None:
        assert self.process.stderr is not None
        with self.process.stderr as lines:
            self.log.extend(lines)

    def wait_until_ready(self) -> None:
        deadline = time.monotonic() + PATIENCE
        while not self._ready():
            assert time.monotonic() < deadline
            time.sleep(0.05)

    def _ready(self) -> bool:
        try:
            return self.get("/readyz").status_code == 200
        except httpx.TransportError:
            return False

    def get(self, path: str) -> httpx.Response:
        """Return what is at a path; certificates, which nothing here has, would take 40 ms to load each time."""
        return httpx.get(self.url + path, verify=False, timeout=PATIENCE)

    def stop(self, told: signal.Signals = signal.SIGTERM) -> str:
        self.process.send_signal(told)
        self.process.wait(timeout=PATIENCE)
        self._reading.join(timeout=PATIENCE)
        return "".join(self.log)


@pytest.fixture(scope="session")
def start_server() -> Iterator[Callable[..., Server]]:
    started: list[Server] = []

    def start(**environment: str) -> Server:
        started.append(Server(**environment))
        return started[-1]

    yield start
    for server in started:
        if server.process.poll() is None:
            server.stop()


@pytest.fixture(scope="session")
def server(start_server: Callable[..., Server]) -> Server:
    running = start_server()
    running.wait_until_ready()
    return running
