"""Server processes end with their supervisor, and with nobody else."""

from __future__ import annotations

import contextlib
import os
import signal
import subprocess
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[3]

SERVER = """
import asyncio, os, signal, sys
from service.execution.supervision import end_with_supervisor

async def main():
    end_with_supervisor()
    told = asyncio.Event()
    asyncio.get_running_loop().add_signal_handler(signal.SIGTERM, told.set)
    print(os.getpid(), flush=True)
    await told.wait()
    print("ended gracefully", flush=True)

def serve():
    asyncio.run(main())
"""

SUPERVISOR = """
import multiprocessing, sys, time
sys.path.insert(0, sys.argv[1])
import server

if __name__ == "__main__":
    process = multiprocessing.get_context("spawn").Process(target=server.serve)
    process.start()
    process.join()
"""


@pytest.mark.parametrize("by", [signal.SIGKILL, signal.SIGTERM])
def test_a_server_process_ends_with_its_supervisor(tmp_path: Path, by: signal.Signals) -> None:
    (tmp_path / "server.py").write_text(SERVER)
    (tmp_path / "supervisor.py").write_text(SUPERVISOR)
    supervisor = subprocess.Popen(
        [sys.executable, str(tmp_path / "supervisor.py"), str(tmp_path)],
        stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, text=True, env={**os.environ, "PYTHONPATH": str(ROOT)},
    )  # fmt: skip
    with supervisor:
        assert supervisor.stdout is not None
        pid = int(supervisor.stdout.readline())
        supervisor.send_signal(by)
        try:
            # Its end of the pipe is closed when the last process that has it has ended.
            assert supervisor.stdout.read() == "ended gracefully\n"
        finally:
            with contextlib.suppress(ProcessLookupError):
                os.kill(pid, signal.SIGKILL)
