"""The time of grading: numbers, formulas and trajectories, from the bytes of a request to those of its answer.

Run: python -m benchmarks.grading [repeats]. Reading, judging and writing happen in this process, as they do in a
compute process; the time is the processor's. The median and the least of all repeats are stated.
"""

from __future__ import annotations

import io
import json
import statistics
import sys
import time
from collections.abc import Callable
from typing import Any
from zipfile import ZipFile

import numpy as np

from benchmarks.machine import RESULTS, described
from core.systems.budget import Budget
from service.execution.request_handler import RequestHandler
from service.requests.request_reader import Limits
from service.responses.json_rows import written
from service.routes import questions

COUNT, SAMPLES = 500, 1000
ROUTES = {route.path: route for route in questions()}
HANDLER = RequestHandler(ROUTES.values(), Budget(), Limits(bytes=64_000_000))
T_HANDLE = {"kind": "principal-moments", "moments": [795.792181070, 713.509259259, 395.782921811]}
FLIP = {"path": "/v1/rotation/precession", "request": {"body": T_HANDLE, "angular_velocity": [1, 10, 1]}}
ROD = {
    "path": "/v1/scenes/rod-in-hole",
    "request": {"hole_radius": 1, "length": 1, "mass": 1, "gravity": 9.81},
}
HORIZONTAL = "/angular_velocity_at_horizontal"
MOTION = {
    "path": "/v1/rotation/trajectory",
    "request": {"body": T_HANDLE, "angular_velocity": [1, 10, 1], "times": [0, 1]},
}


def document(question: Any, submissions: list[Any]) -> bytes:
    """Return the request."""
    return json.dumps({"question": question, "submissions": submissions}).encode()


def trajectories() -> tuple[Any, Any]:
    """Return times, shape (n,), and right rows, shape (count, n, 3), each with small errors of its own."""
    route, times = ROUTES[MOTION["path"]], np.linspace(0.0, 20.0, SAMPLES)
    content = json.dumps({**MOTION["request"], "times": times.tolist()}).encode()
    right = np.array(HANDLER.answer(route, HANDLER.read(route, content))["angular_velocity"])
    return times, right + 1e-4 * np.random.default_rng(0).normal(size=(COUNT, SAMPLES, 3))


def archive(times: Any, rows: Any, kind: str) -> bytes:
    """Return the request as a numpy archive, rows in single ("f4") or double precision ("f8")."""
    claims = [
        {"value": {"array": f"w{i}"}, "times": {"array": "t"}, "unit": "rad/s"} for i in range(len(rows))
    ]  # fmt: skip
    arrays = {f"w{i}": one.astype(kind) for i, one in enumerate(rows)} | {"t": times}
    content = document(MOTION, [{"/angular_velocity": claim} for claim in claims])
    file = io.BytesIO()
    np.savez(file, **arrays)
    with ZipFile(file, "a") as packed:
        packed.writestr("metadata.json", content)
    return file.getvalue()


def graded(body: bytes, *, npz: bool = False) -> Callable[[], bytes]:
    """Return what answers a request."""
    route = ROUTES["/v1/assessments"]
    return lambda: written(HANDLER.answer(route, HANDLER.read(route, body, npz=npz)))


def runs() -> dict[str, Callable[[], bytes]]:
    """Return what is measured, by name."""
    times, rows = trajectories()
    formula = "sqrt(2*gravity*sqrt(hole_radius^2-length^2/4)*(1-length/(2*hole_radius))/(hole_radius^2-length^2/6))"
    wrong = [{"/flip_interval": {"value": 2.45 + 0.01 * i, "unit": "s"}} for i in range(COUNT)]
    return {
        "numbers, all right": graded(document(FLIP, [{"/flip_interval": {"value": 2.4537, "unit": "s"}}] * COUNT)),
        "numbers, most of them wrong": graded(document(FLIP, wrong)),
        "formulas": graded(document(ROD, [{HORIZONTAL: {"formula": formula}}] * COUNT)),
        "trajectories, archive in single precision": graded(archive(times, rows, "f4"), npz=True),
        "trajectories, archive in double precision": graded(archive(times, rows, "f8"), npz=True),
    }


def main() -> None:
    """Measure and write the results."""
    repeats = int(sys.argv[1]) if len(sys.argv) > 1 else 21
    found = {}
    for name, run in runs().items():
        run()
        taken = []
        for _ in range(repeats):
            start = time.process_time()
            run()
            taken.append(time.process_time() - start)
        found[name] = {"median": statistics.median(taken), "least": min(taken)}
        print(f"{name}: {1e3 * found[name]['median']:.1f} ms, at least {1e3 * found[name]['least']:.1f} ms")
    stated = {"machine": described("numpy", "pydantic"), "submissions": COUNT, "samples": SAMPLES, "repeats": repeats}
    (RESULTS / "grading.json").write_text(json.dumps(stated | {"seconds": found}, indent=2) + "\n")


if __name__ == "__main__":
    main()
