"""Measure every peer on every case; write the results, docs/peers.md and the pictures.

make peers                                  (the whole, some minutes)
python -m benchmarks.peers --quick          (a few settings of two cases, printed and kept nowhere)
python -m benchmarks.peers --draw           (page and pictures again, from the results that are there)
"""

from __future__ import annotations

import argparse
import json
import os
import sys
import time
from pathlib import Path
from typing import Any

from benchmarks.contact_peers.page import with_section
from benchmarks.machine import RESULTS, described
from benchmarks.peers.cases import CASES, NEAR_SEPARATRIX, SAMPLES, T_HANDLE
from benchmarks.peers.catalogue import LEFT_OUT, PEERS
from benchmarks.peers.cold_start import cold_starts
from benchmarks.peers.horizon import horizons
from benchmarks.peers.kernel import kernel_rows
from benchmarks.peers.page import page
from benchmarks.peers.picture import picture
from benchmarks.peers.sweep import measure

DOCS = Path(__file__).parents[2] / "docs"
TARGET = RESULTS / "peers.json"


def measured(quick: bool) -> dict[str, Any]:
    """Return the results."""
    packages = sorted({peer.package for peer in PEERS if peer.version})
    result: dict[str, Any] = {
        "machine": described(*packages),
        "samples": SAMPLES,
        "load average": {"before": os.getloadavg()[0]},
        "not installed": sorted({peer.name for peer in PEERS if not peer.version}),
        "left out": LEFT_OUT,
        "peers": {peer.name: {"family": peer.family, "package": peer.package} for peer in PEERS},
        "cases": {},
    }
    for case in (T_HANDLE, NEAR_SEPARATRIX) if quick else CASES:
        since = time.perf_counter()
        result["cases"][case.name] = measure(case, PEERS, quick)
        print(f"{case.name}: {time.perf_counter() - since:.0f} s", file=sys.stderr, flush=True)
    if not quick:
        result["horizons"] = horizons()
        result["kernel"] = kernel_rows()
        result["load average"]["after"] = os.getloadavg()[0]
        result["cold start in seconds"] = cold_starts(PEERS, 3)
    return result


def main() -> None:
    """Do as the command line says."""
    parser = argparse.ArgumentParser(prog="python -m benchmarks.peers", description=__doc__.splitlines()[0])
    parser.add_argument("--quick", action="store_true", help="a few settings of two cases, printed and kept nowhere")
    parser.add_argument("--draw", action="store_true", help="page and pictures again, from the results that are there")
    asked = parser.parse_args()
    if asked.quick:
        for name, case in measured(quick=True)["cases"].items():
            for peer, own in case["peers"].items():
                for point in own["points"]:
                    outcome = point.get("failure") or f"{point['milliseconds']:10.3f} ms, error {point['error']:.1e}"
                    print(f"{name:16} {peer:28} {point['setting']:8.2g} {outcome}")
        return
    if not asked.draw:
        TARGET.write_text(json.dumps(measured(quick=False), indent=1) + "\n", encoding="utf-8")
    result = json.loads(TARGET.read_text(encoding="utf-8"))
    text = with_section(page(result), RESULTS / "contact_peers.json")
    (DOCS / "peers.md").write_text(text, encoding="utf-8")
    pictures = DOCS / "pictures"
    cases = result["cases"]
    short = [T_HANDLE.name, NEAR_SEPARATRIX.name]
    (pictures / "peers.svg").write_text(picture({name: cases[name] for name in short}), encoding="utf-8")
    others = {name: case for name, case in cases.items() if name not in short}
    (pictures / "peers-others.svg").write_text(picture(others), encoding="utf-8")


if __name__ == "__main__":
    main()
