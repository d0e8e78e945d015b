"""How server processes are run and left: the same as uvicorn runs them, but each ends by itself when it is told to.

uvicorn raises the signal that has stopped it again when it has finished, by which a process would end at once: what it
has started would leave its directories behind, and who watches it would see it killed.
"""

from __future__ import annotations

import contextlib
import signal
import sys
from types import FrameType

import uvicorn
from uvicorn.config import STARTUP_FAILURE
from uvicorn.supervisors import Multiprocess

from service.observability.shared_counts import sharing


class Config(uvicorn.Config):
    """The configuration of a server."""

    def configure_logging(self) -> None:
        """Prepare this process for the server: uvicorn calls this in each before anything else."""
        super().configure_logging()
        signal.signal(signal.SIGTERM, _leave)


def run(config: Config) -> None:
    """Run a server, or several processes that share its port, until they are told to stop."""
    if config.workers > 1:
        _run_several(config)
        return
    server = uvicorn.Server(config)
    # Whatever Ctrl-C could interrupt has been stopped by then.
    with contextlib.suppress(KeyboardInterrupt):
        server.run()
    if not server.started:
        sys.exit(STARTUP_FAILURE)


def _run_several(config: Config) -> None:
    with sharing():
        Multiprocess(config, sockets=[config.bind_socket()]).run()


def _leave(number: int, frame: FrameType | None) -> None:
    # Who says it twice must not interrupt the end.
    signal.signal(number, signal.SIG_IGN)
    sys.exit(0)
