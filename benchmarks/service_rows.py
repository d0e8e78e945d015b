"""Large answers over HTTP, relative to writing their rows by one call of orjson: wall time, memory, blocking.

Run: python -m benchmarks.service_rows [repeats]. Everything stays on 127.0.0.1. "rows" are a constant (n, 3) array: all
that is left is the way out. "trajectory" is the real question, computed by another process, with its times beside the
rows. Blocking is how late a task of the server's event loop was that wants to run every millisecond; memory is the
largest growth of the server process's own pages (RssAnon) that this task saw.
"""

from __future__ import annotations

import asyncio
import contextlib
import http.client
import json
import os
import statistics
import subprocess
import sys
import time
from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import orjson
import uvicorn
import uvloop

from benchmarks.machine import RESULTS, described
from core.systems.budget import Budget
from service.responses.npz import MEDIA_TYPE
from service.routes.bodies import BODIES
from service.routes.rotation.trajectory import ROTATION
from service.routing import PostRoute
from service.settings import Settings

COUNTS = (10_000, 100_000, 1_000_000)
TABLE = "benchmarks.service_rows:table"
TRAJECTORY = next(route for route in ROTATION if route.path.endswith("/trajectory"))
MASS_PROPERTIES = BODIES[0]
T_HANDLE = {"kind": "principal-moments", "moments": [795.792181070, 713.509259259, 395.782921811]}
GOALS = {"json": {10_000: 3.5, 100_000: 1.6, 1_000_000: 0.75}, "npz": {100_000: 0.35}}


def rows(count: int) -> np.ndarray[Any, Any]:
    """Return rows whose numbers have every digit, as those of motions do."""
    return np.random.default_rng(count).normal(size=(count, 3))


def table() -> tuple[PostRoute, ...]:
    """Return the route table of the benchmarks: the trajectory, constant rows, and how many points a body has."""
    constant = {count: rows(count) for count in COUNTS} if os.environ.get("POLHODE_ROWS") else {}

    def handle(question: Any, budget: Budget) -> dict[str, Any]:
        return {"rows": constant[question.times.count]}

    return (
        TRAJECTORY,
        replace(
            TRAJECTORY,
            path="/rows",
            operation_id="rows",
            handle=handle,
            examples={},
        ),
        replace(
            MASS_PROPERTIES,
            path="/points",
            operation_id="points",
            handle=lambda question, budget: {"points": len(question.body.positions)},
            examples={},
        ),
    )


class Watched:
    """The service, and a task that watches its event loop; GET /watch tells what it saw and starts anew."""

    def __init__(self) -> None:
        from service.app import Service

        self.service = Service(Settings(cached_answers=0, compute_workers=1, max_samples=max(COUNTS)), TABLE)
        self.late = self.most = 0.0

    async def __call__(self, scope: Any, receive: Any, send: Any) -> None:
        """Serve a request."""
        if scope["type"] == "http" and scope["path"] == "/watch":
            body = json.dumps({"late": self.late, "grown": self.most - self.least}).encode()
            self.late, self.least = 0.0, _own()
            self.most = self.least
            await send({"type": "http.response.start", "status": 200, "headers": []})
            await send({"type": "http.response.body", "body": body})
        else:
            await self.service(scope, receive, send)

    async def watch(self) -> None:
        """Look every millisecond."""
        self.least = self.most = _own()
        while True:
            since = time.perf_counter()
            await asyncio.sleep(0.001)
            self.late = max(self.late, time.perf_counter() - since - 0.001)
            self.most = max(self.most, _own())


def _own() -> int:
    """Return the bytes of this process's own pages."""
    line = next(line for line in Path("/proc/self/status").read_text().splitlines() if line.startswith("RssAnon"))
    return 1024 * int(line.split()[1])


def serve() -> None:
    """Serve and print the port."""
    app = Watched()
    config = uvicorn.Config(app, port=0, loop="uvloop", http="zttp", log_config=None, access_log=False)
    server = uvicorn.Server(config)

    async def run() -> None:
        serving = asyncio.ensure_future(server.serve())
        watching = asyncio.ensure_future(app.watch())
        async with asyncio.timeout(120):
            while not (server.started and app.service.warm):
                await asyncio.sleep(0.01)
        print(server.servers[0].sockets[0].getsockname()[1], flush=True)
        await serving
        watching.cancel()

    uvloop.run(run())


@contextlib.contextmanager
def running() -> Iterator[int]:
    """Run the server in a process of its own; gives its port."""
    command = [sys.executable, "-m", "benchmarks.service_rows", "--serve"]
    process = subprocess.Popen(command, stdout=subprocess.PIPE, text=True, env={**os.environ, "POLHODE_ROWS": "1"})
    try:
        assert process.stdout is not None
        yield int(process.stdout.readline())
    finally:
        process.terminate()
        process.wait(60)


class Caller:
    """A client that keeps nothing of what it receives."""

    def __init__(self, port: int) -> None:
        self.connection = http.client.HTTPConnection("127.0.0.1", port, timeout=120)
        self.sink = memoryview(bytearray(1 << 18))

    def ask(self, path: str, count: int, accept: str) -> tuple[float, int]:
        """Return the time to the last byte (s) and the number of bytes."""
        question = {
            "body": T_HANDLE,
            "angular_velocity": [1.0, 10.0, 1.0],
            "times": {"start": 0.0, "stop": 100.0, "count": count},
        }
        body, received = json.dumps(question), 0
        since = time.perf_counter()
        self.connection.request("POST", path, body, {"content-type": "application/json", "accept": accept})
        response = self.connection.getresponse()
        assert response.status == 200, response.read()[:500]
        while got := response.readinto(self.sink):
            received += got
        return time.perf_counter() - since, received

    def seen(self) -> dict[str, float]:
        """Return what the watching task saw since it was last asked."""
        self.connection.request("GET", "/watch")
        found: dict[str, float] = json.loads(self.connection.getresponse().read())
        return found


def main(repeats: int = 7) -> None:
    """Measure and write the result."""
    before, found = os.getloadavg(), []
    with running() as port:
        caller = Caller(port)
        for count in COUNTS:
            data = rows(count)
            ways = {
                f"{path}, {kind}": (path, accept)
                for path in ("/rows", TRAJECTORY.path)
                for kind, accept in (("json", "application/json"), ("npz", MEDIA_TYPE))
            }
            ratios: dict[str, list[float]] = {way: [] for way in ways}
            sizes: dict[str, int] = {}
            worst: dict[str, dict[str, float]] = {way: {"late": 0.0, "grown": 0.0} for way in ways}
            for path, accept in ways.values():
                caller.ask(path, count, accept)
            for _ in range(repeats if count < 1_000_000 else max(3, repeats // 2)):
                for way, (path, accept) in ways.items():
                    since = time.perf_counter()
                    orjson.dumps(data, option=orjson.OPT_SERIALIZE_NUMPY)
                    once = time.perf_counter() - since
                    caller.seen()
                    seconds, sizes[way] = caller.ask(path, count, accept)
                    seen = caller.seen()
                    ratios[way].append(seconds / once)
                    worst[way] = {name: max(value, seen[name]) for name, value in worst[way].items()}
            for way in ways:
                goal = GOALS[way.rsplit(" ", 1)[1]].get(count)
                found.append(
                    {
                        "rows": count,
                        "way": way,
                        "bytes": sizes[way],
                        "wall_over_one_orjson_dumps": {
                            "median": round(statistics.median(ratios[way]), 3),
                            "least": round(min(ratios[way]), 3),
                        },
                        "goal": goal if way.startswith("/rows") else None,
                        "loop_blocked_ms": round(1e3 * worst[way]["late"], 2),
                        "extra_memory_MB": round(worst[way]["grown"] / 1e6, 1),
                    }
                )
                print(json.dumps(found[-1]))
    result = {
        "machine": described("uvicorn", "uvloop", "orjson", "numpy"),
        "load_average": {"before": before, "after": os.getloadavg()},
        "repeats": repeats,
        "measurements": found,
    }
    (RESULTS / "service_rows.json").write_text(json.dumps(result, indent=2) + "\n")


if __name__ == "__main__":
    if sys.argv[1:2] == ["--serve"]:
        serve()
    else:
        main(*map(int, sys.argv[1:2]))
