"""What the guide to fitting says of the coverage of errors, against the record of the run."""

from __future__ import annotations

import json
from pathlib import Path

RECORD = json.loads((Path(__file__).parents[2] / "benchmarks/results/coverage_of_fits.json").read_text())


def test_errors_hold_as_many_true_numbers_as_they_say() -> None:
    shares: dict[str, list[float]] = {"standard errors": [], "intervals": []}
    for case in RECORD["coverage"].values():
        assert case["sets"] >= 1000
        for what, found in shares.items():
            found += case[what]["share"].values()
            assert max(map(abs, case[what]["binomial_errors"].values())) <= 1.2
    assert all(0.67 <= share <= 0.7 for share in shares["standard errors"])
    assert all(0.946 <= share <= 0.953 for share in shares["intervals"])
    pendulum = RECORD["double_pendulum"]
    assert pendulum["evaluations"] == 27
    assert 0.3 < pendulum["processor_seconds"] < 0.36
