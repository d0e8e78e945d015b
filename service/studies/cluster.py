"""The Dask cluster that computes studies: one of this machine, or an existing one."""

from __future__ import annotations

import logging
import os
import socket
import ssl
from pathlib import Path
from typing import Any
from urllib.parse import urlsplit

from service.settings import Settings
from service.studies.folder import make_private

CONNECTING = 1.5
"""Seconds in which an existing scheduler must have accepted a client."""

ANSWERING = 0.5
"""Seconds in which it must send its first byte: what hinders studies is in their states within two seconds."""

TRIED_AGAIN = "the Dask cluster cannot be used, and is tried again"
"""What the state of a study says while its scheduler does not answer."""

PORT = 8786
"""Of a scheduler by default, as Dask has it."""

WATCHED_EVERY = {"distributed.admin.tick.interval": "1s", "distributed.worker.memory.monitor-interval": "500ms"}
"""How often processes look at themselves; by Dask's own settings (20 ms, 100 ms) idle ones take 6 % of a core."""

SHARE_OF_MEMORY = 0.5
"""Of the machine's, which the processes take together unless the settings say how much."""


class Cluster:
    """Connected while it is needed; `client` is None until then.

    Parameters
    ----------
    settings : Settings
    scratch : Path
        Folder for what the processes of this machine store for a while.
    """

    def __init__(self, settings: Settings, scratch: Path) -> None:
        self._settings, self._scratch = settings, scratch
        self._local: Any = None
        self.client: Any = None

    def open(self) -> Any:
        """Return the connection, made where there is none.

        Raises
        ------
        OSError
            If the existing scheduler does not answer, or the connection has broken.
        """
        import dask

        if self.client is not None:
            if not self.connected:
                raise ConnectionAbortedError
            return self.client
        # Its own log would repeat, for each process, what is said here once.
        dask.config.set({"logging.distributed": "critical", **WATCHED_EVERY})
        from distributed import Client, LocalCluster

        settings = self._settings
        if settings.dask:
            # Without this, the client would wait without limit for a peer that accepts connections and sends nothing.
            require_scheduler(settings.dask)
            self.client = Client(settings.dask, timeout=CONNECTING, name="polhode")
            return self.client
        from distributed.security import Security
        from distributed.system import MEMORY_LIMIT

        cores = len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count() or 1
        workers = settings.study_workers or cores
        memory = settings.study_memory_bytes or int(SHARE_OF_MEMORY * MEMORY_LIMIT)
        # A member that ends its process is found by halves; it need not end three others first.
        dask.config.set(
            {
                "distributed.scheduler.allowed-failures": 0,
                "distributed.worker.multiprocessing-method": "forkserver",
                "distributed.worker.profile.enabled": False,
                # Pages would tell every user of the machine what is computed.
                "distributed.scheduler.http.routes": [],
                "distributed.worker.http.routes": [],
            }
        )
        # Whoever connects to a Dask process runs code in it: every connection needs the certificate that is made
        # here for this cluster, and that only its processes are given.
        security = Security.temporary()
        make_private(self._scratch)
        self._local = LocalCluster(
            security=security,
            n_workers=workers,
            threads_per_worker=1,
            memory_limit=memory // workers,
            # Its HTTP server cannot be left out; the dashboard, which it has where bokeh is installed, can.
            dashboard_address="127.0.0.1:0",
            scheduler_kwargs={"dashboard": False},
            local_directory=str(self._scratch),
            silence_logs=logging.CRITICAL,
        )
        self.client = Client(self._local, direct_to_workers=True, security=security)
        return self.client

    @property
    def connected(self) -> bool:
        """Whether the connection is there."""
        return self.client is not None and self.client.status == "running"

    def close(self) -> None:
        """End the processes of this machine, or leave the existing cluster."""
        for part in (self.client, self._local):
            if part is not None:
                part.close(timeout=5)
        self.client = self._local = None


def require_scheduler(address: str) -> None:
    """Connect to a scheduler and wait for its first byte, which comes before it knows who has connected.

    Raises
    ------
    OSError
        If there is none.
    """
    place = urlsplit(address if "://" in address else f"//{address}")
    if place.scheme not in ("", "tcp", "tls"):
        # Other transports have no first byte.
        return
    with socket.create_connection((place.hostname or "", place.port or PORT), ANSWERING) as connection:
        connection.settimeout(ANSWERING)
        if place.scheme == "tls":
            # Whose certificate it is, the client checks that connects after this.
            context = ssl.create_default_context()
            context.check_hostname, context.verify_mode = False, ssl.CERT_NONE
            context.wrap_socket(connection).close()
        elif not connection.recv(1):
            raise ConnectionAbortedError
