"""Write benchmarks/results/rounding.json: what fewer digits save in bytes and in time.

python -m benchmarks.rounding
"""

from __future__ import annotations

import json
from typing import Any

import orjson

from benchmarks.machine import RESULTS, T_HANDLE, described, medians
from core.systems.budget import Budget
from service.execution.request_handler import RequestHandler
from service.requests.request_reader import Limits
from service.responses.json_stream import composed
from service.routes import questions

QUESTION: dict[str, Any] = {
    "body": T_HANDLE,
    "angular_velocity": [1.0, 10.0, 1.0],
    "times": {"start": 0.0, "stop": 20.0, "count": 100_000},
    "outputs": ["angular_velocity"],
}
CASES: dict[str, dict[str, Any]] = {
    "full round trip": {},
    "meaningful, inputs exact to half an ulp": {"round": "meaningful"},
    "meaningful, inputs known to 1e-6": {"round": "meaningful", "input_uncertainty": 1e-6},
    "meaningful, Runge-Kutta 4 with step 0.01": {
        "round": "meaningful",
        "method": {"kind": "runge-kutta-4", "step": 0.01},
    },
    "9 digits": {"round": 9},
    "4 digits": {"round": 4},
}


def main() -> None:
    """Measure and write."""
    route = next(route for route in questions() if route.path == "/v1/rotation/trajectory")
    answering = RequestHandler((route,), Budget(), Limits())

    def whole(more: dict[str, Any]) -> bytes:
        question = answering.read(route, orjson.dumps(QUESTION | more))
        return composed(route, answering.answer(route, question), None).whole()

    texts = {name: whole(more) for name, more in CASES.items()}
    spent = medians({name: lambda more=more: whole(more) for name, more in CASES.items()}, repeats=15)
    read = medians({name: lambda text=text: orjson.loads(text) for name, text in texts.items()}, repeats=9)
    first = next(iter(CASES))
    rows = {}
    for name, text in texts.items():
        rows[name] = {
            "bytes": len(text),
            "bytes_ratio": round(len(text) / len(texts[first]), 3),
            "milliseconds": round(1e3 * spent[name], 2),
            "milliseconds_of_reading_it": round(1e3 * read[name], 2),
            "stated_error": orjson.loads(text)["accuracy"]["error"],
        }
        print(name, rows[name])
    result = {"machine": described("numpy", "orjson"), "samples": QUESTION["times"]["count"], "cases": rows}
    (RESULTS / "rounding.json").write_text(json.dumps(result, indent=1) + "\n", encoding="utf-8")


if __name__ == "__main__":
    main()
