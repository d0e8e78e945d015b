"""Write benchmarks/results/finer_run.json: how often an error estimated by a finer run is below the true one.

python -m benchmarks.finer_run [MOTIONS]

Every motion is a free rotation of a random body (a quarter of them with moments up to 1e3 apart, a quarter started near
the middle axis), sampled at random times up to thirty turns. A method drawn from the catalogue, with a random setting
from coarse to the round-off of double precision, or no method and a random accuracy, answers as it does for a motion
without a closed form: with an estimate from a finer run. The closed form, whose bound is below 2e-15, is the judge.
"""

from __future__ import annotations

import json
import math
import sys
from collections import Counter
from concurrent.futures import ProcessPoolExecutor
from typing import Any

import numpy as np

from benchmarks.machine import RESULTS, described
from core.arrays import Floats
from core.bodies.mass_properties import diagonal
from core.errors import MechanicsError
from core.rotation.torque_free import TorqueFree
from core.systems.error_statements import known_norm, measured
from core.systems.methods import (
    DiscreteMoserVeselov,
    DormandPrince853,
    ExplicitEuler,
    ImplicitMidpoint,
    Lsoda,
    Radau,
    RungeKutta4,
    SymmetricSplitting,
)
from core.systems.solve import solve

MOTIONS = 10_000
CHUNK = 50
STEPS = {ExplicitEuler: (-5, -1), RungeKutta4: (-4.5, -0.3), ImplicitMidpoint: (-4.5, -0.5),
         SymmetricSplitting: (-4.5, -0.5), DiscreteMoserVeselov: (-4, -0.7)}  # fmt: skip
"""Powers of ten between which a step lies, in units of the time of a radian."""

TOLERANCES = {DormandPrince853: (-16, -1), Lsoda: (-13.6, -2), Radau: (-10, -2)}
"""Powers of ten between which a tolerance lies."""

CHOSEN = "none named"


class WithoutClosedForm(TorqueFree):
    """The same body for integrators, whose error is then estimated by a finer run."""

    def closed_form(self) -> Any:
        """Return None."""
        return None


def motion(random: np.random.Generator) -> tuple[TorqueFree, Floats]:
    """Return a random free rotation, and times up to thirty turns."""
    shape = random.random()
    if shape < 0.25:
        a, b, c = 10.0 ** random.uniform(-3.0, 0.0, 3)
    else:
        a, b, c = random.uniform(0.05, 1.0, 3)
    moments = np.array([b + c, c + a, a + b])
    spin = random.normal(size=3)
    if shape > 0.75:
        middle = int(np.argsort(moments)[1])
        spin *= 10.0 ** random.uniform(-6.0, -1.0)
        spin[middle] = 1.0
    spin /= np.linalg.norm(spin)
    span = 2.0 * math.pi * 10.0 ** random.uniform(-1.0, math.log10(30.0))
    return TorqueFree(diagonal(tuple(moments.tolist())), spin), np.sort(random.uniform(-0.2, 1.0, 12)) * span


def judged(seed: int) -> dict[str, Any]:
    """Return what is stated about a motion, and what is true."""
    random = np.random.default_rng(seed)
    system, times = motion(random)
    kinds: list[Any] = [*STEPS, *TOLERANCES, None]
    kind = kinds[seed % len(kinds)]
    low, high = STEPS.get(kind) or TOLERANCES.get(kind) or (-12.0, -1.0)
    setting = float(10.0 ** random.uniform(low, high))
    row: dict[str, Any] = {"method": CHOSEN if kind is None else kind.kind, "seed": seed, "setting": setting}
    asked: dict[str, Any] = {"accuracy": setting} if kind is None else {"method": kind(setting)}
    try:
        found = solve(WithoutClosedForm(system.body, system.angular_velocity), times, **asked)
    except MechanicsError as fault:
        return row | {"refused": type(fault).__name__}
    exact = system.closed_form()
    reference = exact.sample(times)
    norm = known_norm(reference, system.angular_velocity)
    true = measured(found.state, reference, times, norm).largest
    # What the closed form leaves open is not held against the estimate.
    return row | {"stated": found.accuracy.error, "true": max(0.0, true - exact.error(times))}


def summary(rows: list[dict[str, Any]]) -> list[dict[str, Any]]:
    """Return, for every method and for all, how often statements are below the truth, and by how much."""
    found = []
    for name in (*dict.fromkeys(row["method"] for row in rows), "all"):
        chosen = [row for row in rows if name in (row["method"], "all") and "stated" in row]
        below = [row["true"] / row["stated"] for row in chosen if row["true"] > row["stated"]]
        over = np.array([row["stated"] / row["true"] for row in chosen if row["true"] > 0.0])
        entry: dict[str, Any] = {"method": name, "motions": len(chosen), "below": len(below)}
        entry["true_over_stated_where_below"] = {
            "median": _short(np.median(below)) if below else None, "largest": _short(max(below, default=0.0)) or None
        }  # fmt: skip
        entry["stated_over_true"] = {
            f"p{100 * q:g}": _short(np.quantile(over, q)) for q in (0.001, 0.01, 0.1, 0.5, 0.9)
        }
        # Without its factor of safety the estimate would be so often below.
        entry["below_without_safety"] = sum(row["true"] > row["stated"] / 4.0 for row in chosen)
        found.append(entry)
    return found


def _short(value: Any) -> float:
    return float(f"{value:.3g}")


def main() -> None:
    """Judge the motions and write what was found."""
    count = int(sys.argv[1]) if len(sys.argv) > 1 else MOTIONS
    rows: list[dict[str, Any]] = []
    done = 0
    with ProcessPoolExecutor(2) as pool:
        # Until so many were answered: some settings are refused, and state nothing.
        while len([row for row in rows if "stated" in row]) < count:
            rows += pool.map(judged, range(done, done + 20 * CHUNK), chunksize=CHUNK)
            done += 20 * CHUNK
    stated = [row for row in rows if "stated" in row][:count]
    refused = Counter(row["refused"] for row in rows if "refused" in row)
    below = sorted((row for row in stated if row["true"] > row["stated"]), key=lambda row: -row["true"] / row["stated"])
    result = {
        "machine": described("numpy", "scipy"), "motions": len(stated), "refused": dict(refused),
        "methods": summary(stated), "below": below,
    }  # fmt: skip
    (RESULTS / "finer_run.json").write_text(json.dumps(result, indent=1) + "\n", encoding="utf-8")
    for entry in result["methods"]:
        print(entry)


if __name__ == "__main__":
    main()
