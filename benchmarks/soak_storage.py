"""The part of the soak that stores something: studies on a small file system that is full now and then."""

from __future__ import annotations

import contextlib
import http.client
import io
import json
import os
import random
import shutil
import signal
import subprocess
import sys
import time
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from benchmarks.servers import children, command_of
from core.bodies.measured import PrincipalMoments
from core.rotation.precession.precession import precession

if TYPE_CHECKING:
    from benchmarks.soak import Soak

ROOM = "24m"
"""Of the file system for studies, of which each takes less than a hundredth."""

INSIDE = "POLHODE_SOAK_INSIDE"
"""Set in the process that may mount a file system."""

PATIENCE = 600.0
"""Seconds in which a study of two thousand members must have ended, whatever is killed or full meanwhile: its processes
have the lowest priority, and took 50 s to start beside other programs that filled all cores."""

MEMBERS = 2000
MOMENTS = (1.0, 1.5, 2.0)
ENDED = ("successful", "failed", "dismissed")


def go_on_in_own_namespace(arguments: list[str]) -> None:
    """Replace this process by one that may mount file systems which nobody else sees (unshare(1)), where possible."""
    ours = ["unshare", "--map-root-user", "--mount"]
    if INSIDE in os.environ or not shutil.which("unshare") or subprocess.run([*ours, "true"], check=False).returncode:
        return
    os.environ[INSIDE] = "1"
    os.execvp(ours[0], [*ours, sys.executable, "-m", "benchmarks.soak", *arguments])


def small_disk(folder: str) -> bool:
    """Mount a small file system on a folder; return whether that was possible."""
    if INSIDE not in os.environ:
        return False
    subprocess.run(["mount", "-t", "tmpfs", "-o", f"size={ROOM}", "none", folder], check=True)
    return True


def fill(soak: Soak, seed: int) -> None:
    """Fill the small file system for some seconds now and then; kill what works on studies in between."""
    draw, filler, killed = random.Random(seed), soak.folder / "filler", 0.0
    while time.monotonic() < soak.until:
        time.sleep(draw.uniform(5.0, 25.0))
        if draw.random() < 0.3 and stored_since(soak.folder / "studies", killed):
            killed = time.time()
            for child in children(soak.server.pid):
                if b"service.studies.runner" in command_of(child):
                    with contextlib.suppress(ProcessLookupError):
                        os.kill(child, signal.SIGKILL)
                    soak.outcomes["fault: kill what works on studies"] += 1
        elif soak.small_disk:
            with contextlib.suppress(OSError), filler.open("wb", buffering=0) as file:
                while file.write(bytes(65_536)) == 65_536:
                    pass
            time.sleep(draw.uniform(2.0, 6.0))
            filler.unlink()
            soak.outcomes["fault: full disk"] += 1


def stored_since(folder: Path, moment: float) -> bool:
    """Return whether results have been stored since some time (s): what is killed again before has not begun to work.

    On a machine whose cores are busy a cluster may take longer to start than what passes between two kills.
    """
    with contextlib.suppress(OSError):
        return any(file.stat().st_mtime > moment for file in folder.rglob("*"))
    return False


def studies(soak: Soak, seed: int) -> None:
    """Have studies computed one after the other, and compare each member with core."""
    draw = random.Random(seed)
    while time.monotonic() < soak.until:
        low = draw.uniform(0.05, 0.5)
        request = {
            "question": {
                "path": "/v1/rotation/precession",
                "request": {
                    "body": {"kind": "principal-moments", "moments": MOMENTS},
                    "angular_velocity": [0.1, 1.0, 0.1],
                },
            },
            "vary": [{"pointer": "/angular_velocity/0", "min": low, "max": low + 0.4, "count": MEMBERS}],
            "quantities": ["/period"],
        }
        status, state, _ = asked(soak, "POST", "/v1/studies", request)
        if status != 202:
            refused(soak, status, state)
            time.sleep(0.5)
            continue
        place = f"/v1/studies/{state['jobID']}"
        end = time.monotonic() + PATIENCE
        while state["status"] not in ENDED and time.monotonic() < end:
            time.sleep(0.3)
            status, found, _ = asked(soak, "GET", place)
            state = found if status == 200 else state
            if status != 200:
                refused(soak, status, found)
        if state["status"] != "successful":
            soak.lost.append(f"study: {state['status']} {state['done']} {state['message']}")
            continue
        compare(soak, place)
        while asked(soak, "DELETE", place)[0] == 503 and time.monotonic() < end + PATIENCE:
            time.sleep(0.5)


def compare(soak: Soak, place: str) -> None:
    """Compare the members of a study with core, bit by bit."""
    status, _, content = asked(soak, "GET", f"{place}/results", accept="application/x-npz")
    if status != 200:
        soak.lost.append(f"results: {status} {content[:200]!r}")
        return
    with np.load(io.BytesIO(content)) as file:
        inputs, figures = file["inputs"][:, 0], file["figures"][:, 0]
    body = PrincipalMoments(MOMENTS).mass_properties()
    expected = [precession(body, np.array([rate, 1.0, 0.1])).period for rate in inputs.tolist()]
    if len(inputs) != MEMBERS or figures.tolist() != expected:
        soak.wrong.append(f"study {place}: {len(inputs)} members")
    soak.outcomes["study answered"] += 1


def refused(soak: Soak, status: int, problem: Any) -> None:
    """Count a refusal; only a folder that cannot be used is one of a study's."""
    code = problem.get("code") if isinstance(problem, dict) else None
    if status == 503 and code in ("storage-unavailable", "not-ready", "worker-lost"):
        soak.outcomes[f"study {code}"] += 1
    elif status:
        soak.wrong.append(f"study: {status} {str(problem)[:200]}")


def asked(
    soak: Soak, method: str, path: str, body: Any = None, accept: str = "application/json"
) -> tuple[int, Any, bytes]:
    """Return status, document and bytes of an answer; the status of a question without an answer is 0."""
    connection = http.client.HTTPConnection("127.0.0.1", soak.server.port, timeout=60)
    try:
        sent = None if body is None else json.dumps(body)
        connection.request(method, path, sent, {"content-type": "application/json", "accept": accept})
        response = connection.getresponse()
        content = response.read()
        return response.status, json.loads(content) if content[:1] == b"{" else None, content
    except (OSError, http.client.HTTPException) as error:
        soak.lost.append(f"{method} {path}: {error!r}")
        return 0, None, b""
    finally:
        connection.close()
