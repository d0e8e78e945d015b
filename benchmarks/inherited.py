"""Write benchmarks/results/inherited.json and docs/pictures/error-statements.svg: what is stated against what is true.

python -m benchmarks.inherited [CASES OF EACH KIND AND REGIME]

Every case is a random body of one kind and regime. Its inputs are moved by a relative uncertainty, with the signs that
add up most to first order and with random ones, the moved problem is solved to 50 digits, and the largest change at
any of seven times up to the horizon is compared with the statement. The errors themselves, inputs taken as exact,
are compared with the same solution.
"""

from __future__ import annotations

import json
import math
import sys
from concurrent.futures import ProcessPoolExecutor
from fractions import Fraction
from itertools import product
from pathlib import Path
from typing import Any

import numpy as np

from benchmarks.machine import RESULTS, described
from benchmarks.ratio_figure import drawn
from core.rotation.attitude.free_attitude import FreeAttitude
from core.rotation.torque_free import TorqueFree
from core.systems.methods import DormandPrince853, RungeKutta4
from core.systems.solve import solve
from tests.oracles.perturbed import ATTITUDE, Perturbed
from tests.oracles.uncertain_bodies import KINDS, REGIMES, Uncertain, uncertain

UNCERTAINTIES = (2.0**-53, 1e-9, 1e-6, 1e-3)
KNOWN = 1e-6
"""Uncertainty for which the horizon is compared with the time at which the phase is really lost."""

PICTURE = Path(__file__).parents[1] / "docs" / "pictures" / "error-statements.svg"
Row = dict[str, Any]


class WithoutClosedForm(TorqueFree):
    """The same body for integrators, whose error is then estimated by a finer run."""

    def closed_form(self) -> Any:
        """Return None."""
        return None


def times_of(case: Uncertain, period: float | None) -> list[float]:
    """Return times up to the horizon, the last of them over a whole period."""
    last = min(period or case.horizon, case.horizon)
    early = {case.horizon * share for share in (0.2, 0.6)}
    return sorted(early | {case.horizon - last * k / 6 for k in range(5)})


def compared(which: tuple[int, str, str]) -> list[Row]:
    """Return a row for every statement about one case: what it is of, stated, and observed."""
    seed, kind, regime = which
    case = uncertain(seed, kind, regime)
    system = TorqueFree(case.body(case.numbers).mass_properties(), np.array(case.start))
    exact = system.closed_form()
    free = FreeAttitude(exact, np.array([float(x) for x in ATTITUDE]))
    times = times_of(case, exact.period)
    horizon, size = np.array([case.horizon]), exact.largest_norm
    oracle = Perturbed(case, times)
    random = np.random.default_rng(seed)
    tries = [*oracle.worst_signs(), random.choice([-1, 1], len(oracle.inputs)).tolist()]
    rows: list[Row] = []

    def told(of: str, stated: float, observed: float, uncertainty: float = 0.0) -> None:
        rows.append(
            {"kind": kind, "regime": regime, "seed": seed, "of": of, "uncertainty": uncertainty}
            | {"stated": float(stated), "observed": float(observed)}
        )

    for uncertainty in UNCERTAINTIES:
        rate, turn = exact.inherited(horizon, uncertainty), free.inherited(horizon, uncertainty)
        if rate == math.inf and turn > 3.0:
            told("inherited", rate, 0.0, uncertainty)
            continue
        moved = [oracle.moved(Fraction(uncertainty), signs) for signs in tries]
        told("inherited", rate, max(np.linalg.norm(change / size, axis=1).max() for change, _ in moved), uncertainty)
        told("inherited, attitude", turn, max(np.linalg.norm(angle, axis=1).max() for _, angle in moved), uncertainty)
    instants = np.array(times)
    told("error, closed form", exact.error(instants), oracle.error(exact.sample(instants), size))
    turned = oracle.attitude_error(free.sample(instants))
    told("error, attitude", free.error(instants), turned)
    known = exact.horizon_of(KNOWN)
    if regime in ("ordinary", "near separatrix") and known and exact.period:
        told("horizon", lost_at(case, known, exact.period, tries[0], size), known, KNOWN)
    if regime == "ordinary" and case.horizon * size < 30.0:
        for system_ in (system, WithoutClosedForm(system.body, system.angular_velocity)):
            for method in (RungeKutta4(case.horizon / 400), DormandPrince853(1e-8)):
                found = solve(system_, times, method=method)
                told(f"error, {found.accuracy.how}", found.accuracy.error, oracle.error(found.state, size))
    return rows


def lost_at(case: Uncertain, horizon: float, period: float, signs: list[int], size: float) -> float:
    """Return the first of many times, around the horizon and beyond, at which a moved motion is off by half of it."""
    doubled = [horizon * 2.0 ** (0.5 * k) for k in range(-2, 14)]
    times = sorted(time + period * k / 8 for time in doubled for k in range(4))
    change, _ = Perturbed(case, times).moved(Fraction(KNOWN), signs)
    off = np.linalg.norm(change / size, axis=1) > 0.5
    return times[int(off.argmax())] if off.any() else times[-1]


def summary(rows: list[Row]) -> list[Row]:
    """Return number, coverage and quantiles of stated/observed for every class of rows."""
    found = []
    for of, kind, regime in product(sorted({r["of"] for r in rows}), (*KINDS, "all"), (*REGIMES, "all")):
        chosen = [r for r in rows if r["of"] == of and kind in (r["kind"], "all") and regime in (r["regime"], "all")]
        lost = [r for r in chosen if r["stated"] == math.inf]
        ratios = np.array([r["stated"] / r["observed"] for r in chosen if r not in lost and r["observed"] > 1e-30])
        if not ratios.size:
            continue
        quantiles = {
            name: float(f"{np.quantile(ratios, q):.3g}")
            for name, q in (("min", 0), ("p10", 0.1), ("median", 0.5), ("p90", 0.9), ("max", 1))
        }
        # What is exact differs from the reference by the reference's own rounding.
        covered = sum(r["observed"] <= max(r["stated"], 1e-30) for r in chosen)
        found.append(
            {"of": of, "kind": kind, "regime": regime, "statements": len(chosen), "covered": covered}
            | {"phase_lost": len(lost)}
            | quantiles
        )
    return found


def written(rows: list[Row], cases: int) -> list[Row]:
    """Write result and figure of the rows that there are, and return the summary."""
    below = [row for row in rows if row["stated"] < row["observed"]]
    found = summary(rows)
    result = {"machine": described("numpy", "python-flint"), "cases": cases, "below": below, "classes": found}
    (RESULTS / "inherited.json").write_text(json.dumps(result, indent=1) + "\n", encoding="utf-8")
    PICTURE.write_text(drawn(found), encoding="utf-8")
    return found


def main() -> None:
    """Compare, summarise and draw, anew after every round of all kinds and regimes."""
    rows: list[Row] = []
    classes = list(product(KINDS, REGIMES))
    with ProcessPoolExecutor(2) as pool:
        for n in range(int(sys.argv[1]) if len(sys.argv) > 1 else 34):
            cases = [(1000 * n + k, kind, regime) for k, (kind, regime) in enumerate(classes)]
            rows += [row for found in pool.map(compared, cases, chunksize=3) for row in found]
            found = written(rows, (n + 1) * len(classes))
            print(n, "below:", [row for row in rows if row["stated"] < row["observed"]], flush=True)
    for row in found:
        if row["regime"] == "all" or row["kind"] == "all":
            print(row)


if __name__ == "__main__":
    main()
