"""Whether the errors of fits are true: how many true numbers lie within one standard error, and within the intervals.

Run: python -m benchmarks.coverage_of_fits [sets]. Each set of data is made with known numbers and fresh normal noise
and fitted from starting values that are off. The shares are compared with 68.27 and 95 % by their binomial errors,
number by number. Another question is timed: three numbers of a double pendulum from 1,000 rows.
"""

from __future__ import annotations

import json
import sys
from time import perf_counter, process_time
from typing import Any

import numpy as np

from benchmarks.machine import RESULTS, described
from core.arrays import Floats
from core.assessment.figures import steps_of
from core.assessment.propagation import changed
from core.fits.computed import Computed
from core.fits.fit import Data, fit
from core.fits.observations import Measured
from core.fits.unknowns import Unknown
from core.systems.budget import Budget
from service.routes import questions
from service.routes.assessments.question_table import EndpointRequest, QuestionTable
from service.routes.assessments.route_source import RouteSource

SHARES = {"standard errors": 0.6826894921370859, "intervals": 0.95}

PENDULUM: dict[str, Any] = {
    "gravity": [0, "-g"],
    "let": {"g": 9.81, "L": 0.83, "a": 1.2},
    "bodies": {"bob": {"mass": 1, "at": ["L*sin(a)", "-L*cos(a)"]}},
    "connections": [{"kind": "rod", "a": "bob", "b": [0, 0]}],
}
BODY: dict[str, Any] = {
    "body": {"kind": "principal-moments", "moments": [3.6, 2.4, 1.5]},
    "angular_velocity": [0.1, 4.0, 0.1],
    "times": [0.0],
}
DOUBLE: dict[str, Any] = {
    "gravity": [0, "-g"],
    "let": {"g": 9.81, "m": 1, "w": 0.5},
    "bodies": {
        "one": {"mass": 1, "inertia": 0.0833, "at": [0.5, 0], "angular_velocity": "w"}
        | {"places": {"top": [-0.5, 0], "end": [0.5, 0]}},
        "two": {"mass": "m", "inertia": 0.0833, "at": [1, 0.5], "angle": {"degrees": 90}, "places": {"top": [-0.5, 0]}},
    },
    "connections": [
        {"kind": "pin", "a": "one.top", "b": [0, 0]},
        {"kind": "pin", "a": "two.top", "b": "one.end"},
    ],
}
"""The true numbers of each."""

CASES: dict[str, tuple[str, dict[str, Any], dict[str, str], Floats, float, list[str]]] = {
    "pendulum at a large angle": (
        "/v1/scenes",
        PENDULUM,
        {"x": "bob.position.x", "y": "bob.position.y"},
        np.linspace(0.0, 2.0, 25),
        0.01,
        ["/let/g", "/let/L", "/let/a"],
    ),
    "free body that tumbles": (
        "/v1/rotation/trajectory",
        BODY,
        {axis: f"angular_velocity.{axis}" for axis in "xyz"},
        np.linspace(0.0, 6.0, 25),
        0.05,
        ["/body/moments/0", "/body/moments/1", "/angular_velocity/0", "/angular_velocity/1", "/angular_velocity/2"],
    ),
}


def source_of(path: str, request: Any) -> RouteSource:
    """Return what answers questions to a path."""
    table = QuestionTable([route for route in questions() if route.path == path], ())
    return table.source(EndpointRequest(path=path, request=request), Budget(audited=False))


def coverage(sets: int, name: str) -> dict[str, Any]:
    """Return the shares of true numbers that errors hold, and their distances in binomial errors."""
    path, request, figures, times, deviation, pointers = CASES[name]
    source, places = source_of(path, request), [steps_of(pointer) for pointer in pointers]
    exact = Computed(source, request, places, figures, times, len(times))
    truth = np.array([float(exact.start(place)) for place in places])
    values = exact(truth)
    start = changed(request, {place: 1.01 * number for place, number in zip(places, truth, strict=True)})
    within, chances = np.zeros((2, len(truth))), []
    begun = process_time()
    for seed in range(sets):
        seen = values + deviation * np.random.default_rng(seed).normal(size=values.shape)
        columns = {column: seen[:, k] for k, column in enumerate(figures)}
        measured = Measured(columns | {"t": times}, "t", tuple(figures), dict.fromkeys(figures, deviation), {})
        found = fit(source, start, Data(measured, figures), [Unknown(pointer) for pointer in pointers])
        known, away = found.statistics, np.abs(found.values - truth)
        within += [away <= known.standard_errors, away <= known.half_widths]
        chances.append(known.probability)
    seconds = process_time() - begun
    shares = {
        what: {
            "share": dict(zip(pointers, (count / sets).tolist(), strict=True)),
            "binomial_errors": dict(
                zip(pointers, ((count / sets - share) / (share * (1 - share) / sets) ** 0.5).tolist(), strict=True)
            ),
        }
        for (what, share), count in zip(SHARES.items(), within, strict=True)
    }
    # Probabilities of chi-squared are evenly spread if it is what it is said to be.
    decile = np.histogram(np.array(chances, dtype=float), bins=10, range=(0.0, 1.0))[0]
    return {"sets": sets, "seconds_each": seconds / sets} | shares | {"probabilities_by_tenth": decile.tolist()}


def double_pendulum() -> dict[str, Any]:
    """Return how long three numbers of a double pendulum take from 1,000 rows, on the second run."""
    source, times = source_of("/v1/scenes", DOUBLE), np.linspace(0.0, 2.0, 1000)
    pointers, figures = ["/let/g", "/let/m", "/let/w"], {"one": "one.angle", "two": "two.angle"}
    places = [steps_of(pointer) for pointer in pointers]
    exact = Computed(source, DOUBLE, places, figures, times, len(times))
    seen = exact(np.array([9.81, 1.0, 0.5])) + 0.01 * np.random.default_rng(0).normal(size=(1000, 2))
    measured = Measured(
        {"one": seen[:, 0], "two": seen[:, 1], "t": times}, "t", ("one", "two"), {"one": 0.01, "two": 0.01}, {}
    )
    unknown = [Unknown(pointer, start=start) for pointer, start in zip(pointers, (9.7, 1.02, 0.52), strict=True)]
    for _ in range(2):
        begun, worked = perf_counter(), process_time()
        found = fit(source, DOUBLE, Data(measured, figures), unknown)
    return {
        "seconds": perf_counter() - begun,
        "processor_seconds": process_time() - worked,
        "evaluations": found.evaluations,
        "probability": found.statistics.probability,
    }


def main(sets: int) -> None:
    """Write the record."""
    record = {"machine": described("numpy", "scipy"), "double_pendulum": double_pendulum()}
    record["coverage"] = {name: coverage(sets, name) for name in CASES}
    (RESULTS / "coverage_of_fits.json").write_text(json.dumps(record, indent=1) + "\n", encoding="utf-8")


if __name__ == "__main__":
    main(int(sys.argv[1]) if len(sys.argv) > 1 else 1000)
