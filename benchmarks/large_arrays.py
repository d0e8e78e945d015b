"""Questions with clouds of points: from the text to the array, in this process and over HTTP.

Run: python -m benchmarks.large_arrays [repeats]. Times are relative to orjson.loads of the same document, which builds
the objects and checks nothing, and taken in turns. Over HTTP the answer is the number of points alone.
"""

from __future__ import annotations

import json
import os
import statistics
import sys
import time
from collections.abc import Callable
from typing import Any

import numpy as np
import orjson

from benchmarks.machine import RESULTS, described
from benchmarks.service_rows import MASS_PROPERTIES, Caller, running
from service.requests import large_arrays
from service.requests.request_reader import Limits, Reader

COUNTS = (1_000, 10_000, 100_000)


def document(count: int, masses: bool) -> bytes:
    """Return a question whose coordinates have every digit."""
    rng = np.random.default_rng(count)
    mass: Any = rng.uniform(0.1, 1.0, count).round(9).tolist() if masses else 1.0
    return orjson.dumps(
        {"body": {"kind": "point-masses", "masses": mass, "positions": rng.normal(size=(count, 3)).tolist()}}
    )


def validated_alone(reader: Reader[Any], text: bytes) -> None:
    """Read a question with every number validated by itself."""
    shortest, large_arrays.LEAST_BYTES = large_arrays.LEAST_BYTES, len(text) + 1
    try:
        reader.read(text)
    finally:
        large_arrays.LEAST_BYTES = shortest


def posted(caller: Caller, text: bytes) -> None:
    """Ask over HTTP how many points a question has."""
    caller.connection.request("POST", "/points", text, {"content-type": "application/json"})
    response = caller.connection.getresponse()
    reply = response.read()
    assert response.status == 200, reply


def main(repeats: int = 9) -> None:
    """Measure and write the result."""
    reader: Reader[Any] = Reader(MASS_PROPERTIES.question, Limits(arrays=10**6))
    before, found = os.getloadavg(), []
    with running() as port:
        caller = Caller(port)
        for count in COUNTS:
            for masses in (False, True):
                text = document(count, masses)
                ways: dict[str, Callable[[], Any]] = {
                    "orjson.loads": lambda text=text: orjson.loads(text),
                    "read": lambda text=text: reader.read(text),
                    "read, every number validated": lambda text=text: validated_alone(reader, text),
                    "over HTTP": lambda text=text: posted(caller, text),
                }
                seconds: dict[str, list[float]] = {way: [] for way in ways}
                for _ in range(repeats):
                    for way, run in ways.items():
                        since = time.perf_counter()
                        run()
                        seconds[way].append(time.perf_counter() - since)
                ratios = {
                    way: [one / base for one, base in zip(taken, seconds["orjson.loads"], strict=True)]
                    for way, taken in seconds.items()
                }
                found.append(
                    {
                        "points": count,
                        "a mass each": masses,
                        "bytes": len(text),
                        "median_ms": {way: round(1e3 * statistics.median(taken), 2) for way, taken in seconds.items()},
                        "least_ms": {way: round(1e3 * min(taken), 2) for way, taken in seconds.items()},
                        "over_orjson_loads": {way: round(statistics.median(r), 3) for way, r in ratios.items()},
                    }
                )
                print(json.dumps(found[-1]))
    result = {
        "machine": described("orjson", "pydantic", "numpy", "numba"),
        "load_average": {"before": before, "after": os.getloadavg()},
        "repeats": repeats,
        "measurements": found,
    }
    (RESULTS / "large_arrays.json").write_text(json.dumps(result, indent=2) + "\n")


if __name__ == "__main__":
    main(*map(int, sys.argv[1:2]))
