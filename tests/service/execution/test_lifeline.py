"""What a process has stopped goes on when it is killed."""

from __future__ import annotations

import subprocess
import sys

SERVER = """
import os, signal, subprocess, sys
from service.execution.lifeline import Lifeline
end, ours = os.pipe()
child = subprocess.Popen([sys.executable, "-c", "import os; os.read(0, 1)"], stdin=end)
os.close(end)
lifeline = Lifeline()
os.kill(child.pid, signal.SIGSTOP)
os.waitid(os.P_PID, child.pid, os.WSTOPPED)
if sys.argv[1] == "killed":
    os.kill(os.getpid(), signal.SIGKILL)
os.close(ours)
lifeline.close()
child.wait()
"""


def ended(how: str) -> int:
    """Return the exit code of a process whose child is stopped; the output ends with the last of them."""
    process = subprocess.Popen([sys.executable, "-c", SERVER, how], stdout=subprocess.PIPE, start_new_session=True)
    process.communicate(timeout=240)
    return process.returncode


def test_what_is_stopped_goes_on_when_the_server_is_killed_and_when_it_ends() -> None:
    assert ended("killed") == -9
    assert ended("in order") == 0
