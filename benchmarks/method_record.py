"""Make core/systems/record.json: what each step-choosing method, with each tolerance, was measured to do.

    python -m benchmarks.method_record

The problems have solutions that are known without any of the methods. Each runs over several of its own times, with
samples throughout, so that interpolation counts.
"""

from __future__ import annotations

import json
import statistics
import time
from pathlib import Path

import numpy as np

from core.errors import MechanicsError
from core.systems.accuracy import CANDIDATES
from core.systems.error_statements import known_norm, measured
from core.systems.system import System
from tests.core.systems.systems import elliptic_functions, kepler, oscillator, rigid_body_with_solution

TARGET = Path(__file__).parents[1] / "core" / "integration" / "record.json"
TOLERANCES = [float(f"{10.0 ** (-k / 2):.2g}") for k in range(4, 33)]
REPEATS = 7
LONGEST_REPEATED = 0.1
"""Runs longer than this (s) are timed once: no repetition will make them the cheapest."""


def problems() -> list[tuple[System, np.ndarray]]:
    """Return systems with closed forms, each with its times."""
    times = np.linspace(0, 20, 400)
    systems = (oscillator(), elliptic_functions(), rigid_body_with_solution(), kepler(0.3), kepler(0.7))
    return [(system, times) for system in systems]


def main() -> None:
    """Measure and write."""
    cases = []
    for system, times in problems():
        exact = system.closed_form()
        assert exact is not None
        cases.append((system, times, exact.sample(times)))
    entries = []
    for kind, method in CANDIDATES.items():
        for tolerance in TOLERANCES:
            try:
                chosen = method(tolerance)
                runs = [chosen.integrate(system, times) for system, times, _ in cases]
            except MechanicsError:
                continue
            spent: list[float] = []
            while len(spent) < REPEATS and (not spent or spent[0] < LONGEST_REPEATED):
                start = time.perf_counter()
                for system, times, _ in cases:
                    chosen.integrate(system, times)
                spent.append(time.perf_counter() - start)
            errors = [
                measured(run.states, reference, times, known_norm(reference, reference[0])).largest
                for run, (_, times, reference) in zip(runs, cases, strict=True)
            ]
            entries.append(
                {
                    "kind": kind,
                    "tolerance": tolerance,
                    "error": float(f"{max(errors):.3g}"),
                    "evaluations": sum(run.work.evaluations for run in runs),
                    "microseconds": round(statistics.median(spent) * 1e6, 1),
                }
            )
    rows = ",\n  ".join(json.dumps(entry) for entry in entries)
    TARGET.write_text(f'{{"entries": [\n  {rows}\n]}}\n', encoding="utf-8")


if __name__ == "__main__":
    main()
