"""Requests per second of a small question in the deployed configurations, relative to a bare ASGI application.

Run: python -m benchmarks.service_speed [rounds] [seconds]. It needs wrk; everything stays on 127.0.0.1. In each round
every server is driven for the same time, one after the other, each round in another order. Ratios are taken within a
round, so that a drifting machine drifts for all; the result is the median of the ratios and their quartiles. Processor
time per request is the server process's own, as its scheduler counts it.

"bare" is an application that reads the body and answers as many bytes, under uvicorn with its default parser. The
question is for another body and another spin each time, except for "cached", which is the same question each time, and
"constant", where the answer is a constant: what remains is reading, limits, keys, metrics and writing.
"""

from __future__ import annotations

import contextlib
import hashlib
import http.client
import json
import math
import os
import re
import statistics
import subprocess
import sys
import tempfile
from collections.abc import Iterator
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

from benchmarks.machine import RESULTS, described
from benchmarks.servers import Server, running, until_ready

PATH = "/v1/rotation/precession"
BODY = json.dumps(
    {"body": {"kind": "principal-moments", "moments": [1.0, 2.0, 2.5]}, "angular_velocity": [0.1, 1.0, 0.1]}
).encode()
KEY, ORIGIN = "benchmark-key", "https://pages.example"
CONNECTIONS = 32
UVICORN = [sys.executable, "-m", "uvicorn", "--port", "0", "--no-access-log"]
SERVICE = [sys.executable, "-m", "service", "--port", "0"]


@dataclass(frozen=True)
class Setup:
    """A server and what it is sent."""

    command: list[str]
    keys: bool = True
    cors: bool = False
    new: bool = True


SETUPS = {
    "bare": Setup([*UVICORN, "benchmarks.service_speed:bare"]),
    "service, no keys": Setup(SERVICE, keys=False),
    "service, keys": Setup(SERVICE),
    "service, keys and CORS": Setup(SERVICE, cors=True),
    "uvicorn service.app:app, keys": Setup([*UVICORN, "service.app:app"]),
    "service, keys, constant": Setup([*UVICORN, "--http", "zttp", "benchmarks.service_speed:constant"], new=False),
    "service, keys, cached": Setup(SERVICE, new=False),
}


def answer() -> dict[str, Any]:
    """Return the fields of the answer to `BODY`."""
    from core.systems.budget import Budget
    from service.execution.request_handler import RequestHandler
    from service.requests.document_limits import Limits
    from service.routes.rotation.precession import PRECESSION

    handler = RequestHandler([PRECESSION[0]], Budget(), Limits())
    return PRECESSION[0].handle(handler.read(PRECESSION[0], BODY), Budget())


def constant_table() -> tuple[Any, ...]:
    """Return a table with the question, whose answer is a constant."""
    from service.routes.rotation.precession import PRECESSION

    content = answer()
    return (replace(PRECESSION[0], handle=lambda question, budget: content),)


def __getattr__(name: str) -> Any:
    """Make the applications that servers ask for by name."""
    if name == "bare":
        return _bare()
    if name == "constant":
        from service.app import Service
        from service.settings import Settings

        return Service(Settings(cached_answers=0), "benchmarks.service_speed:constant_table")
    raise AttributeError(name)


def _bare() -> Any:
    from service.responses.json_rows import written

    body = written(answer() | {"signature": {"source": "polhode", "version": "1.0.0"}, "warnings": ()})
    headers = [(b"content-type", b"application/json"), (b"content-length", b"%d" % len(body))]

    async def app(scope: Any, receive: Any, send: Any) -> None:
        if scope["type"] == "lifespan":
            for name in ("startup", "shutdown"):
                await receive()
                await send({"type": f"lifespan.{name}.complete"})
            return
        while (await receive()).get("more_body"):
            pass
        await send({"type": "http.response.start", "status": 200, "headers": headers})
        await send({"type": "http.response.body", "body": body})

    return app


SCRIPT = """local question = '{"body": {"kind": "principal-moments", "moments": [%%.15f, %%.15f, %%.15f]}, '
  .. '"angular_velocity": [%%.15f, %%.15f, %%.15f]}'
local head = "POST %s HTTP/1.1\\r\\nHost: 127.0.0.1\\r\\nContent-Type: application/json\\r\\n%sContent-Length: "
local r = %s
function request()
  local body = question:format(1 + r(), 2 + r() / 2, 2.5 + r() / 2, r(), r(), r())
  return head .. #body .. "\\r\\n\\r\\n" .. body
end
"""
"""What wrk sends: another question each time, or the same."""


def script(setup: Setup, folder: Path) -> Path:
    """Return the file with what is sent."""
    headers = f"Authorization: Bearer {KEY}\\r\\n" if setup.keys else ""
    headers += f"Origin: {ORIGIN}\\r\\n" if setup.cors else ""
    numbers = "math.random" if setup.new else "function() return 0.25 end"
    text = SCRIPT % (PATH, headers, numbers)
    file = folder / hashlib.sha256(text.encode()).hexdigest()[:12]
    file.write_text(text)
    return file


@contextlib.contextmanager
def started(setup: Setup, keys: Path) -> Iterator[Server]:
    """Run a server until it is ready and as long as it is used."""
    environment = {**os.environ, "POLHODE_COMPUTE_WORKERS": "1"}
    if setup.keys:
        environment["POLHODE_KEYS_FILE"] = str(keys)
    if setup.cors:
        environment["POLHODE_CORS_ORIGINS"] = ORIGIN
    with running(setup.command, environment) as server:
        until_ready(server)
        yield server


def processor_seconds(process: int) -> float:
    """Return the time for which a process's threads have had a processor, NaN where the system does not tell."""
    threads = Path(f"/proc/{process}/task").glob("*/schedstat")
    return sum(int(thread.read_text().split()[0]) for thread in threads) / 1e9 or math.nan


def drive(port: int, seconds: float, what: Path) -> tuple[int, float]:
    """Return how many requests were answered, and how many in a second."""
    url = f"http://127.0.0.1:{port}{PATH}"
    command = ["wrk", "-t1", f"-c{CONNECTIONS}", f"-d{seconds:g}s", "-s", str(what), url]
    out = subprocess.run(command, capture_output=True, text=True, check=True).stdout
    done, rate = re.search(r"(\d+) requests in", out), re.search(r"Requests/sec: +([\d.]+)", out)
    assert done
    assert rate
    assert "Non-2xx" not in out, out
    return int(done[1]), float(rate[1])


def answered(port: int, keys: bool) -> int:
    """Return the length of an answer."""
    connection = http.client.HTTPConnection("127.0.0.1", port, timeout=60)
    headers = {"content-type": "application/json"} | ({"authorization": f"Bearer {KEY}"} if keys else {})
    with contextlib.closing(connection):
        connection.request("POST", PATH, BODY, headers)
        return len(connection.getresponse().read())


def main(rounds: int = 9, seconds: float = 1.0) -> None:
    """Measure and write the result."""
    rates: dict[str, list[float]] = {name: [] for name in SETUPS}
    costs: dict[str, list[float]] = {name: [] for name in SETUPS}
    load = os.getloadavg()
    with contextlib.ExitStack() as stack:
        folder = Path(stack.enter_context(tempfile.TemporaryDirectory()))
        keys = folder / "keys"
        keys.write_text(f"benchmark {hashlib.sha256(KEY.encode()).hexdigest()} - -\n")
        servers = {name: stack.enter_context(started(setup, keys)) for name, setup in SETUPS.items()}
        scripts = {name: script(setup, folder) for name, setup in SETUPS.items()}
        for name, server in servers.items():
            drive(server.port, 1.0, scripts[name])
        order = list(SETUPS)
        for _ in range(rounds):
            for name in order:
                since = processor_seconds(servers[name].pid)
                done, rate = drive(servers[name].port, seconds, scripts[name])
                rates[name].append(rate)
                costs[name].append((processor_seconds(servers[name].pid) - since) / done)
            order = order[1:] + order[:1]
        lengths = {name: answered(server.port, SETUPS[name].keys) for name, server in servers.items()}
    ratios = {name: [own / base for own, base in zip(rates[name], rates["bare"], strict=True)] for name in SETUPS}
    result = {
        "machine": described("uvicorn", "fastapi", "starlette", "uvloop", "httptools", "zttp", "pydantic", "orjson"),
        "load_average": {"before": load, "after": os.getloadavg()},
        "rounds": rounds,
        "seconds_per_round": seconds,
        "connections": CONNECTIONS,
        "bytes_in": len(BODY),
        "bytes_out": lengths,
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
    main(*(kind(value) for kind, value in zip((int, float), sys.argv[1:], strict=False)))
