"""The service, and a bare application to compare it with, each in a process of its own on a free port of 127.0.0.1."""

from __future__ import annotations

import contextlib
import http.client
import os
import re
import subprocess
import sys
import threading
import time
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Any

ROOT = Path(__file__).parents[1]


@dataclass(frozen=True)
class Server:
    """A running server."""

    port: int
    pid: int

    def compute_processes(self) -> list[int]:
        """Return the processes that its fork server has started."""
        return [process for server in self.fork_servers() for process in children(server)]

    def fork_servers(self) -> list[int]:
        """Return the processes from which compute processes are forked."""
        return [child for child in children(self.pid) if b"forkserver" in command_of(child)]


def command_of(process: int) -> bytes:
    """Return how a process was started, nothing if it has ended."""
    with contextlib.suppress(OSError):
        return Path(f"/proc/{process}/cmdline").read_bytes()
    return b""


def children(process: int) -> list[int]:
    """Return the processes that any thread of a process has started."""
    found = ""
    for thread in Path(f"/proc/{process}/task").iterdir():
        # It may have ended since.
        with contextlib.suppress(OSError):
            found += (thread / "children").read_text()
    return [int(child) for child in found.split()]


@contextlib.contextmanager
def service(**settings: str) -> Iterator[Server]:
    """Run the service until it is ready and as long as it is used; `settings` are POLHODE_* variables."""
    environment = {**os.environ, **{f"POLHODE_{name.upper()}": value for name, value in settings.items()}}
    with running([sys.executable, "-m", "service", "--port", "0"], environment) as server:
        until_ready(server)
        yield server


def until_ready(server: Server) -> None:
    """Wait until a service is ready; an application without readiness is at once."""
    until = time.monotonic() + 300.0
    while _status(server.port) == 503:
        assert time.monotonic() < until, "the service does not get ready"
        time.sleep(0.2)


@contextlib.contextmanager
def control() -> Iterator[Server]:
    """Run an application that does nothing but answer."""
    command = [sys.executable, "-m", "uvicorn", "benchmarks.servers:bare", "--port", "0", "--no-access-log"]
    with running([*command, "--loop", "uvloop", "--http", "httptools"], dict(os.environ)) as server:
        yield server


@contextlib.contextmanager
def running(command: list[str], environment: dict[str, str]) -> Iterator[Server]:
    process = subprocess.Popen(command, stderr=subprocess.PIPE, env=environment, cwd=ROOT)
    try:
        assert process.stderr is not None
        for line in process.stderr:
            found = re.search(rb"running on http://127.0.0.1:(\d+)", line)
            if found:
                break
        else:
            raise RuntimeError("the server has not started")
        # A pipe that nobody empties would stop the server when it is full.
        threading.Thread(target=lambda: [None for _ in process.stderr or ()], daemon=True).start()
        yield Server(int(found[1]), process.pid)
    finally:
        process.terminate()
        process.wait(60)


def _status(port: int) -> int:
    connection = http.client.HTTPConnection("127.0.0.1", port, timeout=120)
    connection.request("GET", "/readyz")
    return connection.getresponse().status


async def bare(scope: Any, receive: Any, send: Any) -> None:
    """Answer the same to everything."""
    if scope["type"] == "lifespan":
        await receive()
        await send({"type": "lifespan.startup.complete"})
        await receive()
        await send({"type": "lifespan.shutdown.complete"})
        return
    while (await receive()).get("more_body"):
        pass
    headers = [(b"content-type", b"application/json"), (b"content-length", b"18")]
    await send({"type": "http.response.start", "status": 200, "headers": headers})
    await send({"type": "http.response.body", "body": b'{"status":"alive"}'})
