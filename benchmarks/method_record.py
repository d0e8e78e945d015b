"""Make core/integration/record.json: what each step-choosing method, with each tolerance, was measured to do.

    python -m benchmarks.method_record

The problems have solutions that are known without the methods, or are compared with one of them at the end of its
tolerance. Each runs over several of its own times with samples throughout, so that interpolation counts.
"""

from __future__ import annotations

import json
import statistics
import time
from pathlib import Path

import numpy as np

from core.errors import MechanicsError
from core.integration.accuracy import CANDIDATES
from core.integration.error_statements import measured
from core.integration.methods import DormandPrince853
from tests.core.integration.systems import Given, elliptic_functions, kepler, oscillator, prey_and_predator, rigid_body

TARGET = Path(__file__).parents[1] / "core" / "integration" / "record.json"
TOLERANCES = [10.0 ** (-k / 2) for k in range(4, 31)]
REPEATS = 5


def problems() -> list[tuple[Given, np.ndarray]]:
    """Return systems, each with its times."""
    return [
        (oscillator(), np.linspace(0, 20, 400)),
        (elliptic_functions(), np.linspace(0, 20, 400)),
        (rigid_body((1, 2, 3), (0.1, 1, 0.1)), np.linspace(0, 20, 400)),
        (prey_and_predator(), np.linspace(0, 20, 400)),
        (kepler(0.3), np.linspace(0, 20, 400)),
    ]


def main() -> None:
    """Measure and write."""
    cases = []
    for system, times in problems():
        exact = system.closed_form()
        reference = exact.sample(times) if exact else DormandPrince853(1e-15).integrate(system, times).states
        cases.append((system, times, reference))
    entries = []
    for kind, method in CANDIDATES.items():
        for tolerance in TOLERANCES:
            try:
                chosen = method(tolerance)
                runs = [chosen.integrate(system, times) for system, times, _ in cases]
            except MechanicsError:
                continue
            spent = []
            for _ in range(REPEATS):
                start = time.perf_counter()
                for system, times, _ in cases:
                    chosen.integrate(system, times)
                spent.append(time.perf_counter() - start)
            errors = [
                measured(run.states, reference, times).largest
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
    TARGET.write_text(json.dumps({"entries": entries}, indent=1) + "\n", encoding="utf-8")


if __name__ == "__main__":
    main()
