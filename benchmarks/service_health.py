"""How long a health check waits while every core computes: ours, beside a bare application on the same loaded machine.

Run: python -m benchmarks.service_health [seconds]. Everything stays on 127.0.0.1. Three kinds of load are put on the
service by clients in a process of their own: long integrations, answers of a million samples with attitudes, and a
study that occupies every core. A small question, the precession of another body each time, waits beside them. All
servers are asked in turn over raw sockets, 100 times a second, by a client at raised priority where that is allowed.
What the machine itself does to a waiting process shows in the control, a bare ASGI application under uvicorn that has
nothing else to do: its waits contain the same delays of the network, of the scheduler and of the asking client.
"""

from __future__ import annotations

import contextlib
import http.client
import json
import os
import random
import re
import socket
import subprocess
import sys
import tempfile
import threading
import time
from collections.abc import Iterator
from typing import Any

from benchmarks.machine import RESULTS, described
from benchmarks.servers import ROOT, control, service
from benchmarks.studies import LONG, asked

PING = b"GET /healthz HTTP/1.1\r\nhost: x\r\n\r\n"
SMALL = (
    "POST /v1/rotation/precession HTTP/1.1\r\nhost: x\r\ncontent-type: application/json\r\ncontent-length: {}\r\n\r\n{}"
)
BODY = {"kind": "principal-moments", "moments": [1.0, 2.0, 2.5]}
TRAJECTORY = "/v1/rotation/trajectory"
LOADS: dict[str, dict[str, Any]] = {
    "integrations": {
        "body": BODY,
        "angular_velocity": [0.1, 1.0, 0.1],
        "times": {"start": 0.0, "stop": 1000.0, "count": 11},
        "method": {"kind": "runge-kutta-4", "step": 2.5e-4},
    },
    "a million samples": {
        "body": BODY,
        "angular_velocity": [0.1, 1.0, 0.1],
        "attitude": [1.0, 0.0, 0.0, 0.0],
        "times": {"start": 0.0, "stop": 1000.0, "count": 1_000_000},
    },
}
STUDY, QUESTION = "a study", "small question"
CLIENTS = 4


def load(port: int, name: str) -> None:
    """Ask large questions until this process is ended."""
    # Clients are elsewhere in reality; here they are not to compete with the servers.
    os.nice(19)
    if name == STUDY:
        asked(port, "POST", "/v1/studies", {**LONG, "count": 3_000_000})
        return
    body = json.dumps(LOADS[name])

    def ask() -> None:
        while True:
            connection = http.client.HTTPConnection("127.0.0.1", port, timeout=120)
            connection.request("POST", TRAJECTORY, body, {"content-type": "application/json"})
            response = connection.getresponse()
            while response.read(1 << 20):
                pass
            if response.status != 200:
                time.sleep(0.2)

    for _ in range(CLIENTS):
        threading.Thread(target=ask).start()


def small_question() -> bytes:
    """Return a request that no answer is remembered for."""
    moments = [1.0, 1.5 + 0.1 * random.random(), 2.0]
    body = json.dumps({"body": {"kind": "principal-moments", "moments": moments}, "angular_velocity": [0.1, 1.0, 0.1]})
    return SMALL.format(len(body), body).encode()


def received(line: socket.socket) -> None:
    """Read a whole answer."""
    answer = line.recv(65536)
    head, _, body = answer.partition(b"\r\n\r\n")
    left = int(re.search(rb"content-length: (\d+)", head)[1]) - len(body)  # type: ignore[index]
    while left > 0:
        left -= len(line.recv(65536))


def waits(ports: dict[str, int], seconds: float) -> dict[str, list[float]]:
    """Return how long each server took to answer, asked in turn (s); `SMALL` goes to the server that has its name."""
    found: dict[str, list[float]] = {name: [] for name in ports}
    with contextlib.ExitStack() as stack:
        lines = {
            name: stack.enter_context(socket.create_connection(("127.0.0.1", port))) for name, port in ports.items()
        }
        for line in lines.values():
            line.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)
        until = time.perf_counter() + seconds
        while time.perf_counter() < until:
            for name, line in lines.items():
                request = small_question() if name == QUESTION else PING
                since = time.perf_counter()
                line.sendall(request)
                received(line)
                found[name].append(time.perf_counter() - since)
                time.sleep(0.005)
    return found


@contextlib.contextmanager
def raised() -> Iterator[bool]:
    """Give this process a higher priority where that is allowed."""
    before = os.getpriority(os.PRIO_PROCESS, 0)
    try:
        os.setpriority(os.PRIO_PROCESS, 0, -10)
        yield True
    except PermissionError:
        yield False
    finally:
        os.setpriority(os.PRIO_PROCESS, 0, before)


def figures(found: list[float]) -> dict[str, float]:
    """Return quantiles (ms)."""
    ordered = sorted(1e3 * wait for wait in found)
    chosen = {"p50": 0.5, "p99": 0.99, "p99.9": 0.999}
    return {name: round(ordered[int(q * len(ordered))], 2) for name, q in chosen.items()} | {
        "worst": round(ordered[-1], 2),
        "asked": len(ordered),
    }


def main(seconds: float = 30.0) -> None:
    """Measure and write the result."""
    before, result = os.getloadavg(), {}
    with tempfile.TemporaryDirectory() as folder, service(data=folder) as ours, control() as bare:
        ports = {"service": ours.port, QUESTION: ours.port, "control": bare.port}
        for name in ("no load", *LOADS, STUDY):
            driver = None
            if name != "no load":
                command = [sys.executable, "-m", "benchmarks.service_health", "--load", str(ours.port), name]
                driver = subprocess.Popen(command, cwd=ROOT)
                time.sleep(10.0 if name == STUDY else 3.0)
            try:
                with raised() as allowed:
                    found = waits(ports, seconds)
            finally:
                if driver is not None:
                    driver.kill()
                    driver.wait()
            result[name] = {server: figures(own) for server, own in found.items()}
            print(name, result[name], flush=True)
    document = {
        "machine": described("uvicorn", "uvloop"),
        "load_average": {"before": before, "after": os.getloadavg()},
        "clients": CLIENTS,
        "asking_client_at_raised_priority": allowed,
        "milliseconds": result,
    }
    (RESULTS / "service_health.json").write_text(json.dumps(document, indent=2) + "\n")


if __name__ == "__main__":
    if sys.argv[1:2] == ["--load"]:
        load(int(sys.argv[2]), sys.argv[3])
    else:
        main(*map(float, sys.argv[1:2]))
