"""Studies by real servers on real clusters give the same bits: 1 and 8 processes, an existing cluster, after kills.

Run: python -m tests.service.studies.real_clusters. Takes a minute or two.
"""

from __future__ import annotations

import hashlib
import io
import json
import os
import signal
import subprocess
import sys
import tempfile
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import httpx
import numpy as np

from service.studies.folder import Ownership
from tests.service.conftest import ROOT, Server

BODY = {"kind": "principal-moments", "moments": [1.0, 1.5, 2.0]}
TURNING = {"body": BODY, "angular_velocity": [0.01, 1.0, 0.01]}
VARY = [
    {"pointer": "/body/moments/0", "min": 1.0, "max": 1.4},
    {"pointer": "/angular_velocity/0", "distribution": "normal", "mean": 0.01, "deviation": 0.003},
]
STUDIES: dict[str, dict[str, Any]] = {
    "flip intervals": {
        "question": {"path": "/v1/rotation/precession", "request": TURNING},
        "vary": VARY,
        "design": "random",
        "count": 200_000,
        "quantities": ["/flip_interval", "/middle_axis_tilt/0"],
    },
    "integrations": {
        "question": {
            "path": "/v1/rotation/trajectory",
            "request": TURNING | {"times": [100.0], "method": {"kind": "runge-kutta-4", "step": 2e-3}},
        },
        "vary": VARY,
        "design": "sobol",
        "count": 600,
        "quantities": ["/angular_velocity/0/1", "/accuracy/error"],
    },
}
ENOUGH = 100
"""Members that are done when something is killed."""


@contextmanager
def serving(folder: str, **settings: str) -> Iterator[Server]:
    """Run a server."""
    server = Server(POLHODE_DATA=folder, **settings)
    try:
        server.wait_until_ready()
        yield server
    finally:
        if server.process.poll() is None:
            server.stop()


def said(line: str) -> None:
    """Write a line at once."""
    sys.stdout.write(line + "\n")
    sys.stdout.flush()


def submitted(server: Server, request: dict[str, Any]) -> str:
    """Submit a study and return its path."""
    answer = httpx.post(f"{server.url}/v1/studies", json=request, timeout=60.0)
    assert answer.status_code == 202, answer.text
    return answer.headers["location"]


def waited(server: Server, place: str, until: Callable[[dict[str, Any]], bool] = lambda state: False) -> None:
    """Wait for the end of a study, or until something is true of its state."""
    deadline = time.monotonic() + 300.0
    while (state := httpx.get(server.url + place).json())["status"] in ("accepted", "running") and not until(state):
        assert time.monotonic() < deadline, state
        time.sleep(0.05)
    assert until(state) or state["status"] == "successful", state


def digest(server: Server, place: str) -> str:
    """Return a digest of everything that a finished study has found."""
    archive = httpx.get(f"{server.url}{place}/results", headers={"accept": "application/x-npz"}, timeout=60.0)
    with np.load(io.BytesIO(archive.content)) as file:
        about = json.loads(file["metadata.json"])
        parts = [file[name].tobytes() for name in ("inputs", "figures", "failures", "warnings")]
    parts += [json.dumps(about[name]).encode() for name in ("statistics", "failure_names", "warning_names")]
    return hashlib.sha256(b"".join(parts)).hexdigest()


def found(server: Server) -> list[str]:
    """Have a server compute every study, and return digests of their results."""
    places = [submitted(server, request) for request in STUDIES.values()]
    for place in places:
        waited(server, place)
    return [digest(server, place) for place in places]


def descendants(process: int) -> list[int]:
    """Return the processes that a process has started, and those that they have."""
    listed = subprocess.run(["ps", "-eo", "pid=,ppid="], capture_output=True, text=True, check=True).stdout
    parents = {int(child): int(parent) for child, parent in map(str.split, listed.splitlines())}
    own = [child for child, parent in parents.items() if parent == process]
    return [*own, *(inner for child in own for inner in descendants(child))]


def named(processes: list[int], word: bytes) -> list[int]:
    """Return the processes whose command contains a word."""
    return [process for process in processes if word in Path(f"/proc/{process}/cmdline").read_bytes()]


def engine_of(server: Server) -> int:
    """Return the process that works on the studies of a server."""
    (engine,) = named(descendants(server.process.pid), b"service.studies.runner")
    return engine


@contextmanager
def existing_cluster(folder: Path) -> Iterator[str]:
    """Run a scheduler and two workers as documented, and yield their address."""
    dask = str(Path(sys.executable).with_name("dask"))
    file, quiet = folder / "scheduler.json", {"stdout": subprocess.DEVNULL, "stderr": subprocess.DEVNULL}
    common = ["--scheduler-file", str(file), "--no-dashboard"]
    settings: Any = {"cwd": ROOT, "env": {**os.environ, "PYTHONPATH": str(ROOT)}, **quiet}
    scheduler = subprocess.Popen([dask, "scheduler", "--port", "0", *common], **settings)
    workers = subprocess.Popen([dask, "worker", *common, "--nthreads", "1", "--nworkers", "2"], **settings)
    try:
        deadline = time.monotonic() + 60.0
        while not (file.exists() and file.read_text().strip()):
            assert time.monotonic() < deadline
            time.sleep(0.1)
        yield json.loads(file.read_text())["address"]
    finally:
        for process in (workers, scheduler):
            process.terminate()
            process.wait(30)


def main() -> None:
    """Compare, or raise."""
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        with serving(str(folder / "one"), POLHODE_STUDY_WORKERS="1") as server:
            expected = found(server)
        said(f"1 process: {expected}")
        with serving(str(folder / "eight"), POLHODE_STUDY_WORKERS="8") as server:
            assert found(server) == expected
        said("8 processes: the same")
        with (
            existing_cluster(folder) as address,
            serving(str(folder / "existing"), POLHODE_DASK=address) as server,
        ):
            assert found(server) == expected
        said("an existing cluster: the same")
        kills(str(folder / "killed"), expected[1])


def kills(folder: str, expected: str) -> None:
    """Kill, one after the other, what works on a study, and compare its results."""
    request = STUDIES["integrations"]
    with serving(folder, POLHODE_STUDY_WORKERS="2") as server:

        def halfway() -> str:
            place = submitted(server, request)
            waited(server, place, lambda state: state["done"] > ENOUGH)
            return place

        place = halfway()
        forked = named(descendants(engine_of(server)), b"forkserver")
        os.kill(max(forked), signal.SIGKILL)
        waited(server, place)
        assert digest(server, place) == expected
        said("after a killed process: the same")
        place = halfway()
        os.kill(engine_of(server), signal.SIGKILL)
        waited(server, place)
        assert digest(server, place) == expected
        said("after a killed engine with its scheduler: the same")
        place = halfway()
        server.stop(signal.SIGKILL)
    deadline = time.monotonic() + 60.0
    while Ownership(Path(folder)).taken:
        assert time.monotonic() < deadline
        time.sleep(0.1)
    with serving(folder, POLHODE_STUDY_WORKERS="2") as first, serving(folder, POLHODE_STUDY_WORKERS="2") as second:
        waited(first, place)
        assert digest(first, place) == digest(second, place) == expected
        said("after a killed server, by one of two others on its folder: the same")


if __name__ == "__main__":
    main()
