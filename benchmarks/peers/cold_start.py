"""Seconds from the start of a process to the first 10000 samples of the T-handle, for one peer of each package.

Code that a peer keeps compiled from one process to the next is there; what it compiles anew each time counts.
"""

from __future__ import annotations

import statistics
import subprocess
import sys
import time
from collections.abc import Iterable
from pathlib import Path

from benchmarks.peers.peer import Peer

STARTED = (
    "Polhode",
    "Dormand-Prince 853, Numba",
    "heyoka Taylor",
    "numbalsoda DOP853",
    "CyRK DOP853",
    "diffrax Dopri5",
    "SciPy solve_ivp DOP853",
    "SciPy odeint",
    "Orekit TorqueFree",
    "MuJoCo RK4",
    "Drake RK5, fixed step",
    "PyBullet",
)
ROOT = Path(__file__).parents[2]
CODE = (
    "import sys, importlib; from benchmarks.peers.cases import T_HANDLE;"
    "module = importlib.import_module(sys.argv[1]);"
    "peer = next(p for p in module.PEERS if p.name == sys.argv[2]);"
    "peer.prepare(T_HANDLE, float(sys.argv[3]))()"
)


def cold_starts(peers: Iterable[Peer], repeats: int) -> dict[str, float]:
    """Return the median by peer, for those in `STARTED` with a setting in the middle of their sweep."""
    found = {}
    for peer in peers:
        if peer.version is None or peer.name not in STARTED:
            continue
        setting = peer.settings[len(peer.settings) // 2]
        command = [sys.executable, "-c", CODE, peer.prepare.__module__, peer.name, repr(setting)]
        spent = []
        for _ in range(repeats):
            start = time.perf_counter()
            done = subprocess.run(command, cwd=ROOT, capture_output=True, check=False)
            spent.append(time.perf_counter() - start)
        if done.returncode:
            print(f"{peer.name} failed from cold: {done.stderr.decode()[-2000:]}", file=sys.stderr)
        else:
            found[peer.name] = statistics.median(spent)
    return found
