"""Measure every engine on every case; write benchmarks/results/contact_peers.json and the section of docs/peers.md.

make peers-scenes                     (with every engine that can be installed)
python -m benchmarks.contact_peers    (with those that are)

Every run has a process of its own and a time limit: what fails, hangs or writes a warning is a result, too.
"""

from __future__ import annotations

import json
import os
import subprocess
import sys
import tempfile
from pathlib import Path
from typing import Any

from mpmath import mpf, workdps

from benchmarks.contact_peers.cases import CASES, DIGITS, ContactCase
from benchmarks.contact_peers.page import with_section
from benchmarks.contact_peers.worker import ENGINES, Engine
from benchmarks.machine import RESULTS, described

TARGET = RESULTS / "contact_peers.json"
ROOT = Path(__file__).parents[2]
PAGE = ROOT / "docs" / "peers.md"
NOTES = ("deformable contact", "pybullet build time")
"""What engines always write."""
LIMIT = 120.0
"""Seconds that one process may take, with its start; after it, dearer settings are left out."""


def ran(engine: Engine, case: ContactCase, setting: float) -> dict[str, Any]:
    """Return what one run gives, or how it fails."""
    command = [sys.executable, "-m", "benchmarks.contact_peers.worker", engine.name, case.name, repr(setting)]
    environment = {**os.environ, "PYTHONPATH": str(ROOT)}
    # MuJoCo writes its warnings to a file where it runs.
    with tempfile.TemporaryDirectory() as folder:
        try:
            done = subprocess.run(
                command, cwd=folder, env=environment, capture_output=True, text=True, timeout=LIMIT, check=False
            )
        except subprocess.TimeoutExpired:
            return {"failure": f"no answer within {LIMIT:g} s"}
        logs = [file.read_text(errors="replace").strip() for file in Path(folder).glob("*.TXT")]
    logs += [line for line in done.stderr.splitlines() if line.strip() and not any(note in line for note in NOTES)]
    if done.returncode:
        lines = done.stderr.strip().splitlines()
        return {"failure": lines[-1][:300] if lines else f"the process ended with {done.returncode}"}
    found: dict[str, Any] = json.loads(done.stdout.splitlines()[-1])
    if logs:
        found["warnings"] = logs
    found["errors"] = {
        name: off(found["figures"][name], value)
        for name, (value, _) in case.references.items()
        if name in found["figures"]
    }
    return found


def off(found: float, reference: str) -> float:
    """Return how far a double is from a number of 40 digits."""
    with workdps(DIGITS + 10):
        return float(abs(mpf(found) - mpf(reference)))


def swept(engine: Engine, case: ContactCase) -> list[dict[str, Any]]:
    """Return the runs of one engine, one for each setting."""
    points: list[dict[str, Any]] = []
    for setting in engine.settings:
        points.append({"setting": setting, **ran(engine, case, setting)})
        print(engine.name, "|", case.name, "|", json.dumps(points[-1]), file=sys.stderr, flush=True)
        if "no answer" in points[-1].get("failure", ""):
            break
    return points


def main() -> None:
    """Measure and write."""
    before = os.getloadavg()[0]
    there = [engine for engine in ENGINES if engine.installed]
    result = {
        "machine": described(*sorted({engine.package for engine in there})),
        "not installed": [engine.name for engine in ENGINES if engine not in there],
        "limit": LIMIT,
        "engines": {engine.name: engine.setting for engine in there},
        "cases": {
            case.name: {
                "note": case.note,
                "references": case.references,
                "engines": {engine.name: swept(engine, case) for engine in there},
            }
            for case in CASES
        },
        "load average": {"before": before, "after": os.getloadavg()[0]},
    }
    TARGET.write_text(json.dumps(result, indent=1) + "\n", encoding="utf-8")
    PAGE.write_text(with_section(PAGE.read_text(encoding="utf-8"), TARGET), encoding="utf-8")


if __name__ == "__main__":
    main()
