"""A bounded mix of load and faults against a real server: every answer is checked against core, memory must stay flat.

Run: python -m benchmarks.soak [seconds]. Everything stays on 127.0.0.1. Faults: compute processes killed one by one and
all at once, clients that leave while they ask, while they wait and while they are answered, clients that read slowly,
garbage, more large questions than are admitted; studies whose processes are killed and whose file system is full now
and then (`soak_storage`). Only processes that the server itself started are killed.
"""

from __future__ import annotations

import contextlib
import http.client
import json
import multiprocessing
import os
import random
import signal
import socket
import subprocess
import sys
import tempfile
import threading
import time
from collections import Counter
from collections.abc import Callable
from concurrent.futures import ProcessPoolExecutor
from contextlib import ExitStack
from pathlib import Path
from typing import Any

import numpy as np

from benchmarks.machine import RESULTS, described
from benchmarks.servers import Server, service
from benchmarks.soak_storage import fill, go_on_in_own_namespace, small_disk, studies
from core.bodies.measured import PrincipalMoments
from core.rotation.precession.precession import precession
from core.rotation.torque_free import TorqueFree
from core.systems.solve import solve

JSON = {"content-type": "application/json"}
PRECESSION, TRAJECTORY = "/v1/rotation/precession", "/v1/rotation/trajectory"


MOST_GROWTH = 0.3
"""Megabytes per minute by which the floor of a server's memory may seem to grow: 10 MB in half an hour."""

TENTHS = 10
"""Parts of the time whose least is the floor."""

MOST_DESCRIPTORS = 2.0
"""Open files per minute by which their number may seem to grow, where clients come and go all the time."""

SLOWLY = 10.0
"""Seconds for which a client reads a thousand bytes ten times a second of an answer that has megabytes."""


class Soak:
    """The load, and what came of it.

    Attributes
    ----------
    folder : Path
        Where the server keeps studies.
    small_disk : bool
        Whether that is a small file system of its own.
    waits : mapping of str to list of float
        By kind of question, how long its answers took (s).
    lost : list of str
        Questions that got no answer at all, though nobody left.
    """

    def __init__(self, server: Server, until: float, folder: Path, *, small_disk: bool) -> None:
        self.server, self.until, self.folder, self.small_disk = server, until, folder, small_disk
        self.outcomes: Counter[str] = Counter()
        self.waits: dict[str, list[float]] = {"small": [], "large": [], "refused": []}
        self.wrong: list[str] = []
        self.lost: list[str] = []

    def add(self, other: Soak) -> None:
        """Take over what came of another part of the load."""
        self.outcomes += other.outcomes
        self.wrong += other.wrong
        self.lost += other.lost
        for kind, waits in other.waits.items():
            self.waits[kind] += waits

    def small(self, seed: int) -> None:
        """Ask small questions and compare each answer."""
        draw = random.Random(seed)
        connection = http.client.HTTPConnection("127.0.0.1", self.server.port, timeout=60)
        while time.monotonic() < self.until:
            moments = (1.0, draw.uniform(1.0, 1.5), draw.uniform(1.5, 2.0))
            spin = [draw.uniform(-3, 3) for _ in range(3)]
            question = {"body": {"kind": "principal-moments", "moments": moments}, "angular_velocity": spin}
            status, answer, spent = self._ask(connection, PRECESSION, question)
            self.waits["small"].append(spent)
            expected = precession(PrincipalMoments(moments).mass_properties(), np.array(spin))
            if status != 0 and (status != 200 or answer["period"] != expected.period):
                self.wrong.append(f"precession {question}: {status} {str(answer)[:200]}")
            self.outcomes["small answered"] += status == 200
            time.sleep(0.002)

    def large(self, seed: int) -> None:
        """Ask large questions; those that are admitted are compared."""
        draw = random.Random(seed)
        while time.monotonic() < self.until:
            # Comparing may take longer than the server keeps an idle connection open.
            connection = http.client.HTTPConnection("127.0.0.1", self.server.port, timeout=120)
            moments, count = (1.0, 1.5, draw.uniform(1.6, 2.4)), draw.choice([20_000, 100_000, 400_000])
            times = {"start": 0.0, "stop": draw.uniform(1.0, 50.0), "count": count}
            question = {
                "body": {"kind": "principal-moments", "moments": moments},
                "angular_velocity": [0.1, 2.0, 0.1],
                "times": times,
            }
            status, answer, spent = self._ask(connection, TRAJECTORY, question)
            connection.close()
            if status == 200:
                self.waits["large"].append(spent)
                system = TorqueFree(PrincipalMoments(moments).mass_properties(), np.array([0.1, 2.0, 0.1]))
                expected = solve(system, np.linspace(0.0, times["stop"], count)).state
                if not np.array_equal(np.array(answer["angular_velocity"]), expected[:, :3]):
                    self.wrong.append(f"trajectory {question}")
                self.outcomes["large answered"] += 1
            elif status in (429, 503) and answer.get("code") in ("too-busy", "worker-lost", "not-ready"):
                self.waits["refused"].append(spent)
                self.outcomes[f"large {answer['code']}"] += 1
                time.sleep(0.05)
            elif status != 0:
                self.wrong.append(f"trajectory: {status} {str(answer)[:200]}")

    def crowd(self, seed: int) -> None:
        """Now and then ask many questions at once, more than are admitted."""
        draw = random.Random(seed)
        body = json.dumps(HEAVY)
        while time.monotonic() < self.until:
            time.sleep(draw.uniform(3.0, 8.0))

            def one() -> None:
                connection = http.client.HTTPConnection("127.0.0.1", self.server.port, timeout=120)
                status, answer, spent = self._ask(connection, TRAJECTORY, json.loads(body))
                if status == 200:
                    self.waits["large"].append(spent)
                    self.outcomes["crowd answered"] += 1
                elif status in (429, 503):
                    self.waits["refused"].append(spent)
                    self.outcomes[f"crowd {answer['code']}"] += 1
                elif status != 0:
                    self.wrong.append(f"crowd: {status} {str(answer)[:200]}")

            threads = [threading.Thread(target=one) for _ in range(12)]
            for thread in threads:
                thread.start()
            for thread in threads:
                thread.join()

    def faults(self, seed: int) -> None:
        """Leave in the middle, send garbage, kill compute processes."""
        draw = random.Random(seed)
        body = json.dumps(HEAVY).encode()
        streamed = json.dumps(LONG).encode()
        head = b"POST %s HTTP/1.1\r\nhost: x\r\ncontent-type: application/json\r\n" % TRAJECTORY.encode()
        while time.monotonic() < self.until:
            kind = draw.choice([*LEAVING, "garbage", "kill", "kill all"])
            if kind.startswith("kill"):
                workers = self.server.compute_processes()
                for worker in workers if kind == "kill all" else draw.sample(workers, min(1, len(workers))):
                    with contextlib.suppress(ProcessLookupError):
                        os.kill(worker, signal.SIGKILL)
            else:
                with (
                    # While all processes are killed, an answer may begin later than this client waits.
                    contextlib.suppress(ConnectionError, TimeoutError),
                    socket.create_connection(("127.0.0.1", self.server.port), timeout=10) as connection,
                ):
                    sent = {
                        "left waiting": head + b"content-length: %d\r\n\r\n" % len(body) + body,
                        "left being answered": head + b"content-length: %d\r\n\r\n" % len(streamed) + streamed,
                        "left after reading slowly": head + b"content-length: %d\r\n\r\n" % len(streamed) + streamed,
                        "left asking": head + b"content-length: 1000\r\n\r\n" + body[:50],
                        "garbage": draw.randbytes(2000),
                    }
                    connection.sendall(sent[kind])
                    if kind == "left being answered":
                        connection.recv(20_000)
                    end = time.monotonic() + SLOWLY
                    while kind == "left after reading slowly" and time.monotonic() < end and connection.recv(1000):
                        time.sleep(0.1)
                    time.sleep(draw.uniform(0.0, 0.1))
            self.outcomes[f"fault: {kind}"] += 1
            time.sleep(draw.uniform(0.3, 3.0))

    def _ask(self, connection: http.client.HTTPConnection, path: str, question: Any) -> tuple[int, Any, float]:
        """Return status, answer and time; the status of a question without an answer is 0."""
        since = time.perf_counter()
        try:
            connection.request("POST", path, json.dumps(question), JSON)
            response = connection.getresponse()
            content = response.read()
            return response.status, json.loads(content), time.perf_counter() - since
        except (OSError, http.client.HTTPException, ValueError) as error:
            connection.close()
            self.lost.append(f"{path}: {error!r}")
            return 0, None, time.perf_counter() - since


LEAVING = ("left waiting", "left asking", "left being answered", "left after reading slowly")

LOADS: dict[str, Callable[[Soak, int], None]] = {
    "small": Soak.small,
    "large": Soak.large,
    "crowd": Soak.crowd,
    "faults": Soak.faults,
    "studies": studies,
    "fill": fill,
}
GROUPS = (
    (("small", 1), ("small", 2)),
    (("large", 3), ("large", 4)),
    (("crowd", 5), ("faults", 6), ("fill", 7)),
    (("studies", 8),),
)
"""Which clients share a process, with their seeds: those that compare large answers would make the others late."""


def load(soak: Soak, group: tuple[tuple[str, int], ...]) -> Soak:
    """Run some clients to the end."""
    threads = [threading.Thread(target=LOADS[name], args=(soak, seed)) for name, seed in group]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    return soak


HEAVY: dict[str, Any] = {
    "body": {"kind": "principal-moments", "moments": [1.0, 2.0, 2.5]},
    "angular_velocity": [0.1, 1.0, 0.1],
    "times": {"start": 0.0, "stop": 9.0, "count": 11},
    "method": {"kind": "runge-kutta-4", "step": 5e-6},
}
LONG = {name: value for name, value in HEAVY.items() if name != "method"} | {
    "times": {"start": 0.0, "stop": 9.0, "count": 500_000}
}


def resident(process: int) -> float:
    """Return the memory that is a process's own (MB)."""
    text = Path(f"/proc/{process}/status").read_text()
    return int(text.split("RssAnon:")[1].split()[0]) / 1024


class Memory:
    """How much the server and its compute processes take (MB), and its open files, as time goes by."""

    def __init__(self, server: Server) -> None:
        self.server = server
        self.times: list[float] = []
        self.kinds: dict[str, list[float]] = {
            "server": [],
            "fork server": [],
            "largest compute process": [],
            "open files": [],
        }

    def look(self) -> None:
        """Take one sample."""
        workers = [0.0]
        for worker in self.server.compute_processes():
            # It may have been killed since.
            with contextlib.suppress(OSError, IndexError):
                workers.append(resident(worker))
        self.times.append(time.monotonic())
        self.kinds["server"].append(resident(self.server.pid))
        self.kinds["fork server"].append(sum(map(resident, self.server.fork_servers())))
        self.kinds["largest compute process"].append(max(workers))
        self.kinds["open files"].append(len(os.listdir(f"/proc/{self.server.pid}/fd")))

    def figures(self) -> dict[str, dict[str, float]]:
        """Return first, last, most, and slopes per minute after the first fifth, which fills caches.

        Answers that are being read come and go by tens of megabytes; what is left for good raises the floor, the least
        of each tenth of the time.
        """
        start = len(self.times) // 5
        found = {}
        for name, own in self.kinds.items():
            slope = float(np.polyfit(self.times[start:], own[start:], 1)[0])
            parts = np.array_split(np.array([self.times[start:], own[start:]]), TENTHS, axis=1)
            floor = np.array([part[:, part[1].argmin()] for part in parts])
            found[name] = {
                "first": round(own[start], 1),
                "last": round(own[-1], 1),
                "least": round(min(own[start:]), 1),
                "most": round(max(own), 1),
                "slope_per_minute": round(60.0 * slope, 3),
                "slope_of_floor_per_minute": round(60.0 * float(np.polyfit(*floor.T, 1)[0]), 3),
            }
        return found


def quantiles(waits: list[float]) -> dict[str, float]:
    """Return median and 99th percentile (ms)."""
    ordered = sorted(waits)
    return {"p50": round(1e3 * ordered[len(ordered) // 2], 2), "p99": round(1e3 * ordered[int(0.99 * len(ordered))], 2)}


def main(seconds: float = 300.0) -> None:
    """Run and write the figures; fails if anything was wrong or lost, or memory grew."""
    before = os.getloadavg()
    with tempfile.TemporaryDirectory() as folder, ExitStack() as disk:
        small = small_disk(folder)
        if small:
            disk.callback(subprocess.run, ["umount", "--lazy", folder], check=True)
        with service(max_waiting="2", data=folder, study_workers="1") as server:
            until, memory = time.monotonic() + seconds, Memory(server)
            soak = Soak(server, until, Path(folder), small_disk=small)
            with ProcessPoolExecutor(len(GROUPS), multiprocessing.get_context("spawn")) as clients:
                parts = [clients.submit(load, soak, group) for group in GROUPS]
                while time.monotonic() < until:
                    memory.look()
                    time.sleep(1.0)
                for part in parts:
                    soak.add(part.result())
            left = {
                "processes": len(server.compute_processes()),
                "files of studies": sum(file.is_file() for file in (Path(folder) / "studies").rglob("*")),
            }
    result = {
        "machine": described("uvicorn", "uvloop"),
        "load_average": {"before": before, "after": os.getloadavg()},
        "seconds": seconds,
        "small_disk": small,
        "outcomes": dict(sorted(soak.outcomes.items())),
        "wrong": len(soak.wrong),
        "lost": len(soak.lost),
        "first_wrong_or_lost": (soak.wrong + soak.lost)[:20],
        "milliseconds": {kind: quantiles(waits) for kind, waits in soak.waits.items() if waits},
        "taken": memory.figures(),
        "left": left,
    }
    (RESULTS / "soak.json").write_text(json.dumps(result, indent=2) + "\n")
    print(json.dumps(result, indent=2))
    assert not soak.wrong, "an answer was wrong"
    assert not soak.lost, "an answer was lost"
    taken = memory.figures()
    assert taken["server"]["slope_of_floor_per_minute"] < MOST_GROWTH, "memory grew"
    assert taken["open files"]["slope_per_minute"] < MOST_DESCRIPTORS, "open files are left"


if __name__ == "__main__":
    go_on_in_own_namespace(sys.argv[1:])
    main(*map(float, sys.argv[1:2]))
