"""Requests per second of a small question, relative to a bare ASGI application under the same server.

Run: python -m benchmarks.service_speed [rounds] [seconds]. Everything stays on 127.0.0.1. In each round every server is
driven for the same time, one after the other, each round in another order, and ratios are taken within a round, so that
a drifting machine drifts for all; the result is the median of the ratios and their quartiles. Processor time per
request is the server process's own, as its scheduler counts it, and suffers less from what else the machine does.

"bare" is uvicorn with uvloop and httptools, reading the body and answering as many bytes. "transport" answers the
question from a constant: all that is left is parsing, limits, metrics, writing. "plain" serves the same through
uvicorn's own protocol. "real" keeps no answers, so that every question is computed; "real, new" is the service as it
is set by default, asked for another body and another spin each time. The load comes from wrk where it is installed,
otherwise from threads of http.client, which flatter the slow servers.
"""

from __future__ import annotations

import asyncio
import contextlib
import http.client
import json
import math
import os
import shutil
import statistics
import subprocess
import sys
import tempfile
import threading
import time
from collections.abc import Callable, Iterator
from dataclasses import dataclass, replace
from pathlib import Path
from pkgutil import resolve_name
from typing import Annotated, Any, Literal

import uvicorn
import uvloop
from pydantic import BaseModel, Field

from benchmarks.machine import RESULTS, described
from core.bodies.measured import PrincipalMoments
from service.routes.rotation.precession import PRECESSION
from service.routing import TABLE, PostRoute

QUESTION = PRECESSION[0]
BODY = json.dumps(
    {"body": {"kind": "principal-moments", "moments": [1.0, 2.0, 2.5]}, "angular_velocity": [0.1, 1.0, 0.1]}
).encode()
CONNECTIONS = 16
Moment = Annotated[float, Field(gt=0)]
TRANSPORT = "benchmarks.service_speed:transport"
REAL = TABLE
OURS = "service.http.protocol:Protocol"


def transport() -> tuple[PostRoute, ...]:
    """Return a table with the question as the service has it, whose answer is a constant of the same content."""
    content = _content()
    (asked,) = (route for route in resolve_name(REAL)() if route.path == QUESTION.path)
    return (replace(asked, handle=lambda question, budget: content),)


def _content() -> dict[str, Any]:
    from core.systems.budget import Budget
    from service.execution.request_handler import RequestHandler
    from service.requests.request_reader import Limits

    answering = RequestHandler([QUESTION], Budget(), Limits())
    return QUESTION.handle(answering.read(QUESTION, BODY), Budget())


def _answer() -> bytes:
    from core.systems.budget import Budget
    from service.execution.request_handler import RequestHandler
    from service.requests.request_reader import Limits
    from service.responses.json_rows import written

    answering = RequestHandler([QUESTION], Budget(), Limits())
    return written(answering.answer(QUESTION, answering.read(QUESTION, BODY)))


def bare() -> Any:
    """Return an application that reads the body and answers bytes of the same size."""
    body = _answer()
    headers = [(b"content-type", b"application/json"), (b"content-length", b"%d" % len(body))]

    async def app(scope: Any, receive: Any, send: Any) -> None:
        if scope["type"] == "lifespan":
            await receive()
            await send({"type": "lifespan.startup.complete"})
            await receive()
            await send({"type": "lifespan.shutdown.complete"})
            return
        while (await receive()).get("more_body"):
            pass
        await send({"type": "http.response.start", "status": 200, "headers": headers})
        await send({"type": "http.response.body", "body": body})

    return app


def ours(table: str, cached: int) -> Any:
    """Return the service with every limit, metric and header on."""
    from service.app import Service
    from service.settings import Settings

    return Service(Settings(cached_answers=cached, compute_workers=1), table)


class AskedBody(BaseModel):
    """A body, as FastAPI's tutorial would declare it."""

    kind: Literal["principal-moments"]
    moments: tuple[Moment, Moment, Moment]


class Asked(BaseModel):
    """The question, likewise."""

    body: AskedBody
    angular_velocity: tuple[float, float, float]


def asked(question: Asked) -> dict[str, Any]:
    """Return the fields of the question that core is asked."""
    body = PrincipalMoments(moments=question.body.moments)
    return {"body": body, "angular_velocity": question.angular_velocity, "measure": None}


def idiomatic(table: str) -> Any:
    """Return the question as FastAPI's tutorial would serve it: a model in, a model out, nothing else."""
    from fastapi import FastAPI

    from core.systems.budget import Budget

    handle = QUESTION.handle if table == REAL else transport()[0].handle
    signature = {"source": "polhode", "version": "0"}
    app = FastAPI()

    async def endpoint(question: Asked) -> Any:
        answer = dict(handle(QUESTION.question.model_construct(**asked(question)), Budget()))
        return {"signature": signature, **answer, "warnings": []}

    app.post(QUESTION.path, response_model=QUESTION.answer)(endpoint)
    return app


SERVERS: dict[str, tuple[Callable[[], Any], str]] = {
    "bare": (bare, "httptools"),
    "transport": (lambda: ours(TRANSPORT, 0), OURS),
    "transport, cache": (lambda: ours(TRANSPORT, 1024), OURS),
    "transport, plain": (lambda: ours(TRANSPORT, 0), "httptools"),
    "transport, cache, plain": (lambda: ours(TRANSPORT, 1024), "httptools"),
    "transport, FastAPI": (lambda: idiomatic(TRANSPORT), "httptools"),
    "real": (lambda: ours(REAL, 0), OURS),
    "real, new": (lambda: ours(REAL, 1024), OURS),
    "real, cache": (lambda: ours(REAL, 1024), OURS),
    "real, FastAPI": (lambda: idiomatic(REAL), "httptools"),
}
"""Applications, and the protocol they are served by."""

ALIKE = """wrk.method = "POST"
wrk.body = '%s'
wrk.headers["Content-Type"] = "application/json"
"""
NEW = """local question = '{"body": {"kind": "principal-moments", "moments": [%%.15f, %%.15f, %%.15f]}, '
  .. '"angular_velocity": [%%.15f, %%.15f, %%.15f]}'
local head = "POST %s HTTP/1.1\\r\\nHost: 127.0.0.1\\r\\nContent-Type: application/json\\r\\nContent-Length: "
function request()
  local r = math.random
  local body = question:format(1 + r(), 2 + r() / 2, 2.5 + r() / 2, r(), r(), r())
  return head .. #body .. "\\r\\n\\r\\n" .. body
end
"""
"""What wrk asks: the same question each time, or another one."""


def serve(name: str) -> None:
    """Serve one of the applications and print its port."""
    application, protocol = SERVERS[name]
    config = uvicorn.Config(
        application(),
        host="127.0.0.1",
        port=0,
        loop="uvloop",
        http=protocol,
        log_config=None,
        access_log=False,
        server_header=False,
        proxy_headers=False,
    )
    server = uvicorn.Server(config)

    async def run() -> None:
        task = asyncio.ensure_future(server.serve())
        while not server.started:
            await asyncio.sleep(0.01)
        print(server.servers[0].sockets[0].getsockname()[1], flush=True)
        await task

    uvloop.run(run())


@dataclass(frozen=True)
class Target:
    """A server that runs."""

    port: int
    process: int

    def processor_seconds(self) -> float:
        """Return the time for which its threads have had a processor, NaN where the system does not tell."""
        threads = Path(f"/proc/{self.process}/task").glob("*/schedstat")
        return sum(int(thread.read_text().split()[0]) for thread in threads) / 1e9 or math.nan


@contextlib.contextmanager
def running(name: str) -> Iterator[Target]:
    """Run a server in a process of its own, once it is ready."""
    process = subprocess.Popen(
        [sys.executable, "-m", "benchmarks.service_speed", "--serve", name], stdout=subprocess.PIPE, text=True
    )
    try:
        assert process.stdout is not None
        port = int(process.stdout.readline())
        while _status(port, "/readyz") == 503:
            time.sleep(0.1)
        _ask(port)
        yield Target(port, process.pid)
    finally:
        process.terminate()
        process.wait(30)


def _status(port: int, path: str) -> int:
    connection = http.client.HTTPConnection("127.0.0.1", port, timeout=60)
    with contextlib.closing(connection):
        connection.request("GET", path)
        return connection.getresponse().status


def _ask(port: int) -> bytes:
    connection = http.client.HTTPConnection("127.0.0.1", port, timeout=60)
    connection.request("POST", QUESTION.path, BODY, {"content-type": "application/json"})
    response = connection.getresponse()
    content = response.read()
    assert response.status == 200, content[:300]
    connection.close()
    return content


Load = tuple[int, float]
"""Requests that were answered, and how many in a second."""


def with_wrk(port: int, seconds: float, script: Path) -> Load:
    """Return what wrk counts."""
    url = f"http://127.0.0.1:{port}{QUESTION.path}"
    command = ["wrk", "-t1", f"-c{CONNECTIONS}", f"-d{seconds:g}s", "-s", str(script), url]
    out = subprocess.run(command, capture_output=True, text=True, check=True).stdout
    assert "Non-2xx" not in out, out
    done = next(line for line in out.splitlines() if "requests in" in line).split()[0]
    return int(done), float(next(line for line in out.splitlines() if "Requests/sec" in line).split(":")[1])


def with_threads(port: int, seconds: float, script: Path) -> Load:
    """Return what a few threads count, who ask the same question each time."""
    counts: list[int] = []
    until = time.monotonic() + seconds

    def drive() -> None:
        connection = http.client.HTTPConnection("127.0.0.1", port)
        done = 0
        while time.monotonic() < until:
            connection.request("POST", QUESTION.path, BODY, {"content-type": "application/json"})
            connection.getresponse().read()
            done += 1
        counts.append(done)

    threads = [threading.Thread(target=drive) for _ in range(4)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    return sum(counts), sum(counts) / seconds


def main(rounds: int = 9, seconds: float = 1.0) -> None:
    """Measure and write the result."""
    rates: dict[str, list[float]] = {name: [] for name in SERVERS}
    costs: dict[str, list[float]] = {name: [] for name in SERVERS}
    before = os.getloadavg()
    drive = with_wrk if shutil.which("wrk") else with_threads
    with contextlib.ExitStack() as stack:
        folder = Path(stack.enter_context(tempfile.TemporaryDirectory()))
        alike, new = folder / "alike.lua", folder / "new.lua"
        alike.write_text(ALIKE % BODY.decode())
        new.write_text(NEW % QUESTION.path)
        targets = {name: stack.enter_context(running(name)) for name in SERVERS}
        scripts = {name: new if name.endswith(", new") else alike for name in SERVERS}
        for name, target in targets.items():
            drive(target.port, 1.0, scripts[name])
        order = list(targets)
        for _ in range(rounds):
            for name in order:
                since = targets[name].processor_seconds()
                done, rate = drive(targets[name].port, seconds, scripts[name])
                rates[name].append(rate)
                costs[name].append((targets[name].processor_seconds() - since) / done)
            order = order[1:] + order[:1]
        bytes_out = {name: len(_ask(targets[name].port)) for name in SERVERS}
    ratios = {name: [own / base for own, base in zip(rates[name], rates["bare"], strict=True)] for name in SERVERS}
    result = {
        "machine": described("uvicorn", "fastapi", "starlette", "uvloop", "httptools", "pydantic", "orjson"),
        "load_average": {"before": before, "after": os.getloadavg()},
        "driver": drive.__name__,
        "rounds": rounds,
        "seconds_per_round": seconds,
        "connections": CONNECTIONS,
        "bytes_in": len(BODY),
        "bytes_out": bytes_out,
        "requests_per_second": {name: round(statistics.median(found)) for name, found in rates.items()},
        "processor_microseconds_per_request": {
            name: round(1e6 * statistics.median(found), 1) for name, found in costs.items()
        },
        "relative_to_bare": {name: round(statistics.median(found), 3) for name, found in ratios.items()},
        "relative_to_bare_quartiles": {
            name: [round(edge, 3) for edge in statistics.quantiles(found, n=4)[::2]] for name, found in ratios.items()
        },
        "processor_time_of_bare_relative": {
            name: round(statistics.median(b / own for own, b in zip(found, costs["bare"], strict=True)), 3)
            for name, found in costs.items()
        },
    }
    (RESULTS / "service_speed.json").write_text(json.dumps(result, indent=2) + "\n")
    print(json.dumps(result, indent=2))


if __name__ == "__main__":
    if sys.argv[1:2] == ["--serve"]:
        serve(sys.argv[2])
    else:
        main(*(kind(value) for kind, value in zip((int, float), sys.argv[1:], strict=False)))
