"""A running service, and the Chromium that looks at it."""

from __future__ import annotations

import os
import shutil
import socket
import subprocess
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
    "--use-angle=swiftshader",
    "--enable-unsafe-swiftshader",
    "--no-first-run",
    "--disable-background-networking",
    "--disable-component-update",
    "--disable-sync",
)


@contextmanager
def serving() -> Iterator[str]:
    """Give the address of a service: the one that POLHODE_URL names, else one that runs as long as it is needed."""
    if "POLHODE_URL" in os.environ:
        yield os.environ["POLHODE_URL"].rstrip("/")
        return
    with socket.socket() as free:
        free.bind(("127.0.0.1", 0))
        port = free.getsockname()[1]
    url = f"http://127.0.0.1:{port}"
    process = subprocess.Popen([ROOT / ".venv/bin/python", "-m", "service", "--port", str(port)], cwd=ROOT)
    try:
        while True:
            try:
                urllib.request.urlopen(f"{url}/readyz")
                break
            except (urllib.error.URLError, ConnectionError):
                if process.poll() is not None:
                    raise RuntimeError("the service has ended before it was ready") from None
                time.sleep(0.5)
        yield url
    finally:
        process.terminate()
        process.wait(20)
