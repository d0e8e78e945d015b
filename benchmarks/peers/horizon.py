"""What 10000 samples cost and how right they are over 1 to 1e9 periods."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

from benchmarks.machine import medians_in_turn
from benchmarks.peers.cases import A123, T_HANDLE, Case
from benchmarks.peers.catalogue import PEERS
from benchmarks.peers.measures import measured
from benchmarks.peers.reference import reference
from benchmarks.peers.sweep import repeats
from tests.oracles.free_rotation import period

PERIODS = (1.0, 1e3, 1e6, 1e9)
ASKED: tuple[tuple[str, float, float], ...] = (
    ("Polhode", 0.0, 1e9),
    ("SciPy ellipj, textbook form", 0.0, 1e9),
    ("heyoka Taylor", 2.0**-52, 1e3),
    ("Dormand-Prince 853, Numba", 1e-14, 1e3),
)
"""Peer, setting, and the number of periods beyond which it would take more than seconds."""


def over(case: Case, periods: float) -> Case:
    """Return the case over a number of periods."""
    own = period(case.moments, case.start)
    assert own is not None
    return replace(case, name=f"{case.name}, {periods:g} periods", stop=periods * float(own))


def horizons() -> dict[str, Any]:
    """Return cost and error by case, peer and number of periods."""
    by_name = {peer.name: peer for peer in PEERS}
    found: dict[str, Any] = {}
    for short in (A123, T_HANDLE):
        rows: dict[str, Any] = {name: {} for name, _, _ in ASKED if by_name[name].version}
        runs, once = {}, {}
        for periods in PERIODS:
            case = over(short, periods)
            true = reference(case, case.times)
            for name, setting, most in ASKED:
                if name in rows and periods <= most:
                    run = by_name[name].prepare(case, setting)
                    states = run()
                    rows[name][f"{periods:g}"] = {"error": measured(case, states, true)["error"]}
                    key = f"{name}|{periods:g}"
                    runs[key] = run
                    once[key] = medians_in_turn({key: run}, {key: 1.0}, lambda _: 1)[key]
        for key, spent in medians_in_turn(runs, once, repeats).items():
            name, periods_text = key.split("|")
            rows[name][periods_text]["milliseconds"] = 1e3 * spent
        found[short.name] = rows
    return found
