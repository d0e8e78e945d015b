"""A bounded mix of load and faults against a real server: every answer is checked against core, memory must stay flat.

Run: python -m benchmarks.soak [minutes]. Everything stays on 127.0.0.1. Faults: compute processes killed, clients that
leave, garbage, more large questions than are admitted. Only processes that the server itself started are killed.
"""

from __future__ import annotations

import http.client
import json
import os
import random
import re
import signal
import socket
import statistics
import subprocess
import sys
import threading
import time
from collections import Counter
from pathlib import Path
from typing import Any

import numpy as np

from benchmarks.machine import RESULTS, described
from core.bodies.measured import PrincipalMoments
from core.integration.solve import solve
from core.rotation.precession import precession
from core.rotation.torque_free import TorqueFree

JSON = {"content-type": "application/json"}
PRECESSION, TRAJECTORY = "/v1/rotation/precession", "/v1/rotation/trajectory"


class Soak:
    """The load, and what came of it."""

    def __init__(self, port: int, until: float) -> None:
        self.port, self.until = port, until
        self.outcomes: Counter[str] = Counter()
        self.waits: list[float] = []
        self.wrong: list[str] = []

    def small(self, seed: int) -> None:
        """Ask small questions and compare each answer."""
        draw, connection = random.Random(seed), http.client.HTTPConnection("127.0.0.1", self.port, timeout=60)
        while time.monotonic() < self.until:
            moments = (1.0, draw.uniform(1.0, 1.5), draw.uniform(1.5, 2.0))
            spin = [draw.uniform(-3, 3) for _ in range(3)]
            question = {"body": {"kind": "principal-moments", "moments": moments}, "angular_velocity": spin}
            since = time.perf_counter()
            status, answer = self._ask(connection, PRECESSION, question)
            self.waits.append(time.perf_counter() - since)
            expected = precession(PrincipalMoments(moments).mass_properties(), np.array(spin))
            if status != 200 or answer["period"] != expected.period:
                self.wrong.append(f"precession {question}: {status} {str(answer)[:200]}")
            self.outcomes["small answered"] += 1

    def large(self, seed: int) -> None:
        """Ask large questions; those that are admitted are compared."""
        draw, connection = random.Random(seed), http.client.HTTPConnection("127.0.0.1", self.port, timeout=120)
        while time.monotonic() < self.until:
            moments, count = (1.0, 1.5, draw.uniform(1.6, 2.4)), draw.choice([20_000, 100_000, 400_000])
            times = {"start": 0.0, "stop": draw.uniform(1.0, 50.0), "count": count}
            question = {
                "body": {"kind": "principal-moments", "moments": moments},
                "angular_velocity": [0.1, 2.0, 0.1],
                "times": times,
            }
            status, answer = self._ask(connection, TRAJECTORY, question)
            if status == 200:
                system = TorqueFree(PrincipalMoments(moments).mass_properties(), np.array([0.1, 2.0, 0.1]))
                expected = solve(system, np.linspace(0.0, times["stop"], count)).state
                if not np.array_equal(np.array(answer["angular_velocity"]), expected[:, :3]):
                    self.wrong.append(f"trajectory {question}")
                self.outcomes["large answered"] += 1
            elif status in (429, 503) and answer.get("code") in ("too-busy", "worker-lost", "deadline-exceeded"):
                self.outcomes[f"large {answer['code']}"] += 1
                time.sleep(0.05)
            else:
                self.wrong.append(f"trajectory: {status} {str(answer)[:200]}")

    def faults(self, seed: int, server: int) -> None:
        """Leave in the middle, send garbage, kill compute processes."""
        draw = random.Random(seed)
        body = json.dumps(
            {
                "body": {"kind": "principal-moments", "moments": [1.0, 2.0, 2.5]},
                "angular_velocity": [0.1, 1.0, 0.1],
                "times": {"start": 0.0, "stop": 9.0, "count": 500_000},
            }
        ).encode()
        head = b"POST %s HTTP/1.1\r\nhost: x\r\ncontent-type: application/json\r\n" % TRAJECTORY.encode()
        while time.monotonic() < self.until:
            kind = draw.choice(["leave", "leave early", "garbage", "kill"])
            if kind == "kill" and (workers := compute_processes(server)):
                os.kill(draw.choice(workers), signal.SIGKILL)
            elif kind != "kill":
                with socket.create_connection(("127.0.0.1", self.port), timeout=10) as connection:
                    sent = {
                        "leave": head + b"content-length: %d\r\n\r\n" % len(body) + body,
                        "leave early": head + b"content-length: 1000\r\n\r\n" + body[:50],
                        "garbage": draw.randbytes(2000),
                    }
                    connection.sendall(sent[kind])
                    time.sleep(draw.uniform(0.0, 0.1))
            self.outcomes[f"fault: {kind}"] += 1
            time.sleep(draw.uniform(0.1, 2.0))

    def _ask(self, connection: http.client.HTTPConnection, path: str, question: Any) -> tuple[int, Any]:
        connection.request("POST", path, json.dumps(question), JSON)
        response = connection.getresponse()
        return response.status, json.loads(response.read())


def compute_processes(server: int) -> list[int]:
    """Return the processes that the server's fork server has started."""
    found: list[int] = []
    for child in _children(server):
        if b"forkserver" in Path(f"/proc/{child}/cmdline").read_bytes():
            found += _children(child)
    return found


def _children(process: int) -> list[int]:
    text = Path(f"/proc/{process}/task/{process}/children").read_text()
    return [int(child) for child in text.split()]


def _resident(process: int) -> float:
    text = Path(f"/proc/{process}/status").read_text()
    return int(text.split("RssAnon:")[1].split()[0]) / 1024


def main(minutes: float = 5.0) -> None:
    """Run and write the figures; fails if anything was wrong or memory grew."""
    command = [sys.executable, "-m", "service", "--port", "0"]
    environment = {**os.environ, "POLHODE_MAX_BACKLOG_SECONDS": "0.2", "POLHODE_LOG_LEVEL": "info"}
    process = subprocess.Popen(command, stderr=subprocess.PIPE, env=environment)
    try:
        assert process.stderr is not None
        port = 0
        for line in process.stderr:
            found = re.search(rb"running on http://127.0.0.1:(\d+)", line)
            if found:
                port = int(found[1])
                break
        log = threading.Thread(target=lambda: [None for _ in process.stderr or ()], daemon=True)
        log.start()
        while _status(port) != 200:
            time.sleep(0.2)
        before, soak = os.getloadavg(), Soak(port, time.monotonic() + 60.0 * minutes)
        jobs: list[tuple[Any, tuple[int, ...]]] = [(soak.small, (1,)), (soak.small, (2,))]
        jobs += [(soak.large, (seed,)) for seed in (3, 4, 5)] + [(soak.faults, (6, process.pid))]
        threads = [threading.Thread(target=job, args=given) for job, given in jobs]
        for thread in threads:
            thread.start()
        memory: list[float] = []
        while time.monotonic() < soak.until:
            memory.append(_resident(process.pid))
            time.sleep(1.0)
        for thread in threads:
            thread.join()
        # The first fifth fills caches.
        settled = memory[len(memory) // 5 :]
        third = max(1, len(settled) // 3)
        growth = statistics.median(settled[-third:]) - statistics.median(settled[:third])
        waits = sorted(soak.waits)
        result = {
            "machine": described("uvicorn", "pebble"),
            "load_average": {"before": before, "after": os.getloadavg()},
            "minutes": minutes,
            "outcomes": dict(sorted(soak.outcomes.items())),
            "wrong": soak.wrong[:20],
            "small_ms": {"p50": 1e3 * waits[len(waits) // 2], "p99": 1e3 * waits[int(0.99 * len(waits))]},
            "memory_MB": {"first": settled[0], "last": settled[-1], "most": max(settled), "growth": growth},
        }
        (RESULTS / "soak.json").write_text(json.dumps(result, indent=2) + "\n")
        print(json.dumps(result, indent=2))
        assert not soak.wrong, "an answer was wrong or missing"
        assert growth < 10.0, "memory grew"
    finally:
        process.terminate()
        process.wait(60)


def _status(port: int) -> int:
    connection = http.client.HTTPConnection("127.0.0.1", port, timeout=10)
    connection.request("GET", "/readyz")
    return connection.getresponse().status


if __name__ == "__main__":
    main(*map(float, sys.argv[1:2]))
