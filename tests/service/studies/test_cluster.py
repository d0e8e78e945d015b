"""The cluster of this machine: nobody but the service can connect to it."""

from __future__ import annotations

import gc
import os
import socket
import ssl
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import httpx
import pytest
from distributed import Client
from distributed.security import Security

from service.settings import Settings
from service.studies.cluster import Cluster, require_scheduler

PATIENCE = "5s"
"""A refusal comes at once; one that does not come is a failure of the test."""


@pytest.fixture(scope="module")
def cluster(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Cluster]:
    before = os.umask(0)
    # Within a folder that everybody may look into, as one that was there before may be.
    folder = tmp_path_factory.mktemp("data")
    folder.chmod(0o755)
    made = Cluster(Settings(study_workers=1), folder / "scratch")
    made.open()
    os.umask(before)
    yield made
    made.close()


def addresses(cluster: Cluster) -> list[str]:
    """Return the addresses of all processes that accept connections."""
    described: dict[str, Any] = cluster.client.scheduler_info(n_workers=-1)
    found: list[str] = []
    for address, worker in described["workers"].items():
        found += [address, worker["nanny"]]
    return [described["address"], *found]


def test_it_computes(cluster: Cluster) -> None:
    assert cluster.connected
    assert cluster.client.submit(divmod, 17, 5).result(timeout=120) == (3, 2)


def test_every_address_is_encrypted(cluster: Cluster) -> None:
    found = addresses(cluster)
    assert len(found) == 3
    assert all(address.startswith("tls://127.0.0.1:") for address in found)


@pytest.mark.filterwarnings("ignore")
def test_nobody_without_its_certificate_is_admitted(cluster: Cluster) -> None:
    scheduler = addresses(cluster)[0]
    with pytest.raises(OSError, match=r"(Timed out|SSL|TLS|reset|closed)"):
        Client(scheduler.replace("tls:", "tcp:"), timeout=PATIENCE)
    # A certificate of the same kind that another authority has signed.
    with pytest.raises(OSError, match=r"(Timed out|SSL|TLS|reset|closed)"):
        Client(scheduler, security=Security.temporary(), timeout=PATIENCE)
    # Clients that did not connect complain when they are collected, which is not to happen in another test.
    gc.collect()


def closed_to_strangers(address: str) -> bool:
    """Return whether a process sends nothing, and ends the connection, to a client without a certificate."""
    context = ssl.create_default_context()
    context.check_hostname, context.verify_mode = False, ssl.CERT_NONE
    host, port = address.removeprefix("tls://").split(":")
    with socket.create_connection((host, int(port)), timeout=60) as plain:
        try:
            # In TLS 1.3 the refusal comes with the first bytes that are read. Dask speaks first where it accepts.
            with context.wrap_socket(plain) as secure:
                return secure.recv(1) == b""
        except (ssl.SSLError, ConnectionError):
            return True


def test_each_process_demands_a_certificate(cluster: Cluster) -> None:
    assert [closed_to_strangers(address) for address in addresses(cluster)] == [True, True, True]


def test_no_process_has_pages_for_other_users_of_the_machine(cluster: Cluster) -> None:
    described = cluster.client.scheduler_info(n_workers=-1)
    ports = [cluster.client.run_on_scheduler(lambda dask_scheduler: dask_scheduler.http_server.port)]
    ports += [worker["services"]["dashboard"] for worker in described["workers"].values()]
    for port in ports:
        for page in ("/", "/status", "/health", "/info/main/workers.html", "/metrics"):
            assert httpx.get(f"http://127.0.0.1:{port}{page}", timeout=60).status_code == 404


def test_what_its_processes_store_for_a_while_is_readable_by_its_owner_alone(cluster: Cluster) -> None:
    (scratch,) = {
        Path(worker["local_directory"]).parents[1]
        for worker in cluster.client.scheduler_info(n_workers=-1)["workers"].values()
    }
    assert scratch.name == "scratch"
    assert scratch.stat().st_mode & 0o077 == 0


def test_a_scheduler_is_known_by_its_first_bytes(cluster: Cluster, processes: str, silent: str) -> None:
    require_scheduler(addresses(cluster)[0])
    require_scheduler(processes)
    require_scheduler(processes.removeprefix("tcp://"))
    with pytest.raises(TimeoutError):
        require_scheduler(silent)
    with pytest.raises(TimeoutError):
        require_scheduler(silent.replace("tcp:", "tls:"))


def test_no_scheduler_is_known_at_once() -> None:
    with socket.create_server(("127.0.0.1", 0)) as closed:
        port = closed.getsockname()[1]
    with pytest.raises(ConnectionRefusedError):
        require_scheduler(f"tcp://127.0.0.1:{port}")
