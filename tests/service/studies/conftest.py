"""Studies of toys: a store in a temporary folder, and clusters in this process and in others."""

from __future__ import annotations

import json
import socket
import subprocess
import sys
import time
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from core.systems.budget import Budget
from service.execution.worker import Terms
from service.requests.request_reader import Limits
from service.settings import Settings
from service.studies.chunk_files import ChunkFiles
from service.studies.cluster import Cluster
from service.studies.engine import Engine
from service.studies.results import Results
from service.studies.store import Store
from service.studies.study import Owner, Quotas, Study
from service.studies.task import opened
from tests.service.conftest import PATIENCE
from tests.service.studies.toy_table import TABLE
from tests.service.toy_routes import GOOD

TERMS = Terms(TABLE, Budget(), Limits(), 0)

UNIFORM: dict[str, Any] = {
    "question": {"path": "/v1/toy", "request": GOOD},
    "vary": [
        {"pointer": "/angular_velocity/0", "min": 0.0, "max": 1.0},
        {"pointer": "/body/moments/2", "distribution": "normal", "mean": 3.0, "deviation": 0.1},
    ],
    "design": "random",
    "count": 300,
    "seed": 4,
    "quantities": ["/position/2/0", "/position/1/1"],
}
"""A study whose members are quickly answered."""


FOREVER = 10 * PATIENCE
"""Seconds that no test waits for."""


def sleeping(seconds: float, count: int) -> dict[str, Any]:
    """Return a study of whose members each takes so long."""
    request = GOOD | {"behaviour": "sleep", "angular_velocity": [seconds, 1.0, 0.1]}
    return {
        "question": {"path": "/v1/toy", "request": request},
        "vary": [{"pointer": "/angular_velocity/1", "min": 0.0, "max": 1.0, "count": count}],
        "quantities": ["/position/2/1"],
    }


@pytest.fixture(scope="session")
def in_process() -> Iterator[str]:
    """Yield the address of a cluster of one thread of this process."""
    from distributed import LocalCluster

    with LocalCluster(n_workers=1, threads_per_worker=1, processes=False, dashboard_address="127.0.0.1:0") as cluster:
        yield cluster.scheduler_address


@pytest.fixture(scope="session")
def processes() -> Iterator[str]:
    """Yield the address of a cluster of two processes, to which studies connect as to any existing one."""
    command = [sys.executable, "-m", "tests.service.studies.toy_cluster"]
    with subprocess.Popen(command, stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True) as cluster:
        assert cluster.stdout is not None
        address = cluster.stdout.readline().strip()
        assert address, "the cluster has not started"
        yield address


@pytest.fixture
def silent() -> Iterator[str]:
    """Yield the address of a peer that accepts connections and sends nothing."""
    with socket.create_server(("127.0.0.1", 0)) as listening:
        yield f"tcp://127.0.0.1:{listening.getsockname()[1]}"


class Desk:
    """A store, its files and an engine on some cluster."""

    def __init__(self, folder: Path, address: str, longest: float = 30.0) -> None:
        self.store, self.files = Store(folder), ChunkFiles(str(folder / "studies"))
        self.cluster = Cluster(Settings(dask=address), folder)
        self.engine = Engine(self.store, self.files, self.cluster, TERMS, longest, longest)

    def submit(self, request: dict[str, Any], each: float = 1e-3) -> str:
        """Store a study; `each` is the price of a member (s), which decides how many are computed at a time."""
        body = json.dumps(request).encode()
        count = opened(TERMS, body).design.members
        figures = [{"pointer": pointer, "unit": None} for pointer in request["quantities"]]
        inputs = [{"pointer": entry["pointer"], "unit": None, "levels": None} for entry in request["vary"]]
        plan = {"path": "/v1/toy", "count": count, "shape": [count], "inputs": inputs, "figures": figures}
        rest = {"together": False, "seconds": each * count, "bytes": 0}
        return self.store.create(Owner(""), body, plan | rest, Quotas(100, 100, 10**9))

    def submit_question(self, body: bytes) -> str:
        """Store a study of one answer."""
        plan = {"path": "/v1/toy", "count": 1, "shape": [], "inputs": [], "figures": []}
        rest = {"together": False, "seconds": 1e-3, "bytes": 0}
        return self.store.create(Owner(""), body, plan | rest, Quotas(100, 100, 10**9))

    def work(self, until: Callable[[], Any] = lambda: False) -> None:
        """Work until there is nothing to do, or something has come about."""
        end = time.monotonic() + PATIENCE
        while not until() and self.engine.turn():
            assert time.monotonic() < end

    def study(self, identity: str) -> Study:
        found = self.store.get(identity)
        assert found is not None
        return found

    def bits(self, identity: str) -> tuple[bytes, ...]:
        """Return everything that a finished study has found, as bytes."""
        chunks = [*Results(self.study(identity), self.store, self.files).chunks()]
        columns = [np.concatenate([getattr(chunk, name) for chunk in chunks]) for name in ("inputs", "figures")]
        failed = [chunk.failure_names[k - 1] if k else "" for chunk in chunks for k in chunk.failures.tolist()]
        statistics = json.dumps(self.store.statistics(identity)).encode()
        return (*(column.tobytes() for column in columns), json.dumps(failed).encode(), statistics)


@pytest.fixture
def desk_on(tmp_path: Path) -> Iterator[Callable[..., Desk]]:
    """Yield what makes desks, on one folder unless another is named."""
    made: list[Desk] = []

    def make(address: str, folder: Path = tmp_path, **settings: Any) -> Desk:
        made.append(Desk(folder, address, **settings))
        return made[-1]

    yield make
    for desk in made:
        desk.engine.stop()
        desk.store.close()
