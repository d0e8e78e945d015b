"""The map of double pendulums: released at rest from any two angles, when the second rod first turns over.

Run: python -m benchmarks.flip_map [side [processes]]. The members of a study of side x side are computed as processes
of a study compute them, and drawn as docs/pictures/double-pendulums.png: bright where the rod turns over soon, black
where it does not within 10 s. A rod has turned over when it has gone through the upright; it is looked at every half
second.
"""

from __future__ import annotations

import json
import multiprocessing
import os
import struct
import sys
import time
import zlib
from pathlib import Path
from typing import Any

import numpy as np

from benchmarks.machine import RESULTS, described
from core.arrays import Floats
from core.systems.budget import Budget
from service.execution.worker import Terms
from service.requests.request_reader import Limits
from service.routing import TABLE
from service.studies.task import opened

SIDE = 140
STRETCH = 1000
"""Members that a process computes at a time."""
PICTURE = Path(__file__).parents[1] / "docs" / "pictures" / "double-pendulums.png"
TIMES = [0.5 * k for k in range(1, 21)]
RANGE = {"min": -3.141, "max": 3.141}
ROD = {"mass": 1, "inertia": "1/12", "places": {"top": [-0.5, 0], "end": [0.5, 0]}}
"""Angles are from hanging down: the first axis of a rod at rest points down."""
SCENE: dict[str, Any] = {
    "gravity": [9.81, 0],
    "let": {"a": 0.0, "b": 0.0},
    "bodies": {
        "one": ROD | {"at": ["cos(a)/2", "sin(a)/2"], "angle": "a"},
        "two": ROD | {"at": ["cos(a) + cos(b)/2", "sin(a) + sin(b)/2"], "angle": "b"},
    },
    "connections": [
        {"kind": "pin", "a": "one.top", "b": [0, 0]},
        {"kind": "pin", "a": "two.top", "b": "one.end"},
    ],
    "times": TIMES,
    "outputs": ["trajectory"],
    "accuracy": 1e-3,
}


def study(side: int) -> dict[str, Any]:
    """Return the study of side x side members."""
    return {
        "question": {"path": "/v1/scenes", "request": SCENE},
        "vary": [{"pointer": f"/let/{name}", **RANGE, "count": side} for name in ("a", "b")],
        "quantities": [f"/trajectory/columns/two.angle/values/{k}" for k in range(len(TIMES))],
    }


def first_turn(angles: Floats) -> Floats:
    """Return when each member has first turned over, at one of the times; infinite where it has not."""
    over = np.abs(angles) > np.pi
    return np.where(over.any(axis=1), np.array(TIMES)[over.argmax(axis=1)], np.inf)


def png(brightness: Floats) -> bytes:
    """Return an image of grey levels between 0 and 1, shape (rows, columns)."""
    levels = np.round(255.0 * brightness).astype(np.uint8)
    lines = b"".join(b"\0" + line.tobytes() for line in levels)
    height, width = levels.shape
    parts = (b"IHDR", struct.pack(">IIBBBBB", width, height, 8, 0, 0, 0, 0)), (b"IDAT", zlib.compress(lines, 9))
    found = b"\x89PNG\r\n\x1a\n"
    for kind, data in (*parts, (b"IEND", b"")):
        found += struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))
    return found


def block(share: tuple[dict[str, Any], int, int]) -> tuple[Floats, float]:
    """Return the figures of some members of a study, and the processor time that they took (s)."""
    request, start, stop = share
    members = opened(Terms(TABLE, Budget(), Limits(), 0), json.dumps(request).encode())
    begun = time.process_time()
    return members.block(start, stop).figures, time.process_time() - begun


def main(side: int = SIDE, processes: int = 2) -> None:
    """Compute, draw, and write what it took."""
    before, request, count = os.getloadavg(), study(side), side * side
    shares = [(request, k, min(k + STRETCH, count)) for k in range(0, count, STRETCH)]
    begun = time.perf_counter()
    with multiprocessing.get_context("spawn").Pool(processes) as pool:
        found = pool.map(block, shares, chunksize=1)
    wall = time.perf_counter() - begun
    turned = first_turn(np.concatenate([figures for figures, _ in found]))
    shade = np.where(np.isfinite(turned), 1.0 - 0.9 * (turned - TIMES[0]) / (TIMES[-1] - TIMES[0]), 0.0)
    # The first angle to the right, the second upwards.
    PICTURE.write_bytes(png(shade.reshape(side, side).T[::-1]))
    result = {
        "machine": described("numpy", "numba"),
        "load_average": {"before": before, "after": os.getloadavg()},
        "members": count,
        "processes": processes,
        "wall seconds, with the start of the processes": wall,
        "processor seconds of the members": sum(seconds for _, seconds in found),
        "share that turns over": float(np.isfinite(turned).mean()),
    }
    (RESULTS / "flip_map.json").write_text(json.dumps(result, indent=2) + "\n", encoding="utf-8")
    print(json.dumps(result))


if __name__ == "__main__":
    main(*map(int, sys.argv[1:3]))
