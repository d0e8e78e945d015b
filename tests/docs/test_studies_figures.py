"""The figures in docs/studies.md are those of the committed run of the benchmark, to the digits that it gives."""

from __future__ import annotations

import json
import re

import pytest

from tests.service.conftest import ROOT

PAGE = (ROOT / "docs" / "studies.md").read_text()
RUN = json.loads((ROOT / "benchmarks" / "results" / "studies.json").read_text())
SECONDS, RATIOS = RUN["seconds"], RUN["ratios"]


def rate(run: dict[str, float]) -> float:
    return run["count"] / run["wall"]


MEASURED = {
    "a study of 1e6, two processes": rate(SECONDS["flips, 2"]),
    "a study of 1e6, one process": rate(SECONDS["flips, 1"]),
    "`multiprocessing.Pool(2)`": rate(SECONDS["peers"]["multiprocessing.Pool(2)"]),
    "joblib, two processes": rate(SECONDS["peers"]["joblib, 2 processes"]),
    "the library in a loop": rate(SECONDS["peers"]["the library in a loop"]),
    "single requests on one connection": rate(SECONDS["single requests"]),
    "`solve_ivp` (DOP853 with an event, tolerance 1e-9) in a loop": rate(SECONDS["peers"]["scipy solve_ivp in a loop"]),
} | {str(run["workers"]): run["per_second"] for run in SECONDS["held back"]}


def row(label: str) -> list[float]:
    found = re.search(rf"^\| {re.escape(label)} \| (.*) \|$", PAGE, re.MULTILINE)
    assert found, f"no row {label}"
    return [float(cell.replace(",", "")) for cell in found[1].split(" | ")]


@pytest.mark.parametrize("label", MEASURED)
def test_rates_are_those_of_the_run(label: str) -> None:
    assert row(label)[0] == float(f"{MEASURED[label]:.3g}")


def test_ratios_are_those_of_the_run() -> None:
    first, *_ = SECONDS["held back"]
    for run in SECONDS["held back"]:
        assert row(str(run["workers"]))[1] == round(run["per_second"] / first["per_second"], 2)
    for name, given in {
        "flips: study over single requests, wall, 1 process": "{:.0f} times the rate of single requests",
        "flips: study over single requests, processor time": "by processor time {:.0f} times",
        "flips: 2 processes over 1, wall": "Two processes are {:.2f} times as fast as one",
        "long members: 2 processes over 1, wall": "answered one by one, {:.2f} times",
    }.items():
        assert given.format(RATIOS[name]) in PAGE
    share = 100 * RATIOS["long members: engine's share of processor time"]
    assert f"{share:.1f} % of the processor time" in PAGE
