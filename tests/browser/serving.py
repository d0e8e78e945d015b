"""A running service, and the Chromium that looks at it."""

from __future__ import annotations

import os
import shutil
import socket
import subprocess
import tempfile
import time
import urllib.error
import urllib.request
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

ROOT = Path(__file__).parent.parent.parent
CHROMIUM = next(filter(None, map(shutil.which, ("chromium", "chromium-browser", "google-chrome"))), None)
ARGUMENTS = (
    "--no-sandbox",
    "--enable-unsafe-swiftshader",
    "--no-first-run",
    "--disable-background-networking",
    "--disable-component-update",
    "--disable-sync",
)


@contextmanager
def serving(**settings: str) -> Iterator[str]:
    """Give the address of a service: the one that POLHODE_URL names, else one that runs as long as it is needed.

    One with settings of its own, such as ``POLHODE_KEYS_FILE``, always runs.
    """
    if "POLHODE_URL" in os.environ and not settings:
        yield os.environ["POLHODE_URL"].rstrip("/")
        return
    with socket.socket() as free:
        free.bind(("127.0.0.1", 0))
        port = free.getsockname()[1]
    url = f"http://127.0.0.1:{port}"
    command: list[object] = [ROOT / ".venv/bin/python", "-m", "service", "--port", str(port)]
    with (
        tempfile.TemporaryDirectory() as data,
        _running(command, os.environ | settings | {"POLHODE_DATA": data}) as process,
    ):
        while True:
            try:
                urllib.request.urlopen(f"{url}/readyz")
                break
            except (urllib.error.URLError, ConnectionError):
                if process.poll() is not None:
                    raise RuntimeError("the service has ended before it was ready") from None
                time.sleep(0.5)
        yield url


@contextmanager
def _running(command: list[object], environment: dict[str, str]) -> Iterator[subprocess.Popen[bytes]]:
    process = subprocess.Popen([str(part) for part in command], cwd=ROOT, env=environment)
    try:
        yield process
    finally:
        process.terminate()
        process.wait(20)
