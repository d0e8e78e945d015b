"""A cluster of two processes, in a process of its own that ends with its standard input; writes its address.

Run: python -m tests.service.studies.toy_cluster. The processes come from a fork server that has imported what they
need. A process has one fork server: in that of the tests, others have imported something else, and each process that
takes the place of an ended one would import everything anew, for half a minute on a busy machine.
"""

from __future__ import annotations

import sys
from multiprocessing import forkserver

import dask

SETTINGS = {
    "distributed.worker.multiprocessing-method": "forkserver",
    "distributed.scheduler.allowed-failures": 0,
    "logging.distributed": "critical",
}


def main() -> None:
    """Serve until there is nothing more to read."""
    forkserver.set_forkserver_preload(["tests.service.studies.toy_table", "distributed"])
    forkserver.ensure_running()
    with dask.config.set(SETTINGS):
        from distributed import LocalCluster

        with LocalCluster(n_workers=2, threads_per_worker=1, dashboard_address="127.0.0.1:0") as cluster:
            sys.stdout.write(f"{cluster.scheduler_address}\n")
            sys.stdout.flush()
            sys.stdin.read()


if __name__ == "__main__":
    main()
