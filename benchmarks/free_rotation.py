"""The free body: the closed form against SciPy's and heyoka's integrators, errors against 50 digits, all in one run.

    make peers          (needs heyoka, which only this benchmark installs)

Fairness: every peer runs compiled and warmed up, at its best setting for the error in question; heyoka's integrator
is built once and only propagated. Ours includes everything from moments and spin to samples.
"""

from __future__ import annotations

import json
import subprocess
import sys
import time
from pathlib import Path
from typing import Any

import mpmath
import numpy as np

from benchmarks.machine import RESULTS, described, medians
from core.bodies.mass_properties import PrincipalInertia, diagonal
from core.double_double import Scaled
from core.integration.solve import solve
from core.rotation.closed_form import FreeRotation
from core.rotation.constants_of_motion import constants_of_motion
from core.rotation.sampling import sample_components
from core.rotation.torque_free import TorqueFree
from tests.oracles.free_rotation import reference_angular_velocity

SAMPLES = 10_000
CASES: dict[str, tuple[tuple[float, float, float], tuple[float, float, float], float]] = {
    "A123": ((1.0, 2.0, 3.0), (0.1, 1.0, 0.1), 20.0),
    "T-handle": ((837.195503014, 714.008200689, 437.685185185), (1.0, 10.0, 1.0), 20.0),
    "near separatrix": ((1.0, 2.0, 3.0), (1e-8, 1.0, 1.001e-8), 100.0),
    "long": ((1.0, 2.0, 3.0), (0.1, 1.0, 0.1), 1e4),
}


def euler(moments: tuple[float, float, float]) -> Any:
    """Return Euler's equations as SciPy wants them."""
    a, b, c = moments
    p, q, r = (b - c) / a, (c - a) / b, (a - b) / c
    return lambda t, w: (p * w[1] * w[2], q * w[2] * w[0], r * w[0] * w[1])


def error(states: np.ndarray, case: str, times: np.ndarray) -> float:
    """Return the largest error over 41 samples, relative to the largest angular velocity."""
    moments, start, _ = CASES[case]
    rows = np.linspace(0, SAMPLES - 1, 41).astype(int)
    want = reference_angular_velocity(moments, start, [float(times[k]) for k in rows])
    with mpmath.workdps(60):
        size = max(mpmath.norm(w) for w in want)
        return float(
            max(
                mpmath.norm([mpmath.mpf(float(g)) - x for g, x in zip(states[k], w, strict=True)])
                for k, w in zip(rows, want, strict=True)
            )
            / size
        )


def case_rows(case: str) -> dict[str, Any]:
    """Measure one case."""
    import heyoka as hy
    from scipy.integrate import solve_ivp

    moments, start, horizon = CASES[case]
    times = np.linspace(0.0, horizon, SAMPLES)
    w0 = np.array(start)
    f = euler(moments)
    x, y, z = hy.make_vars("x", "y", "z")
    a, b, c = moments
    system = [(x, (b - c) / a * y * z), (y, (c - a) / b * z * x), (z, (a - b) / c * x * y)]
    integrator = hy.taylor_adaptive(system, start)

    def heyoka() -> np.ndarray:
        integrator.time = 0.0
        integrator.state[:] = w0
        return np.asarray(integrator.propagate_grid(times)[-1])

    def closed_form() -> np.ndarray:
        inertia = PrincipalInertia.of(np.diag(np.array(moments)))
        return FreeRotation(inertia, w0).sample(times)

    def solved() -> np.ndarray:
        return solve(TorqueFree(diagonal(moments), w0), times).state

    def dop853() -> np.ndarray:
        return solve_ivp(f, (0.0, horizon), w0, "DOP853", t_eval=times, rtol=1e-9, atol=1e-12).y.T

    runs: dict[str, Any] = {"closed form": closed_form, "solve, error stated": solved, "heyoka": heyoka}
    times_taken = medians(runs, 15)
    slow = {"solve_ivp DOP853, rtol 1e-9": dop853}
    times_taken |= medians(slow, 3 if case == "long" else 5)
    runs |= slow
    base = times_taken["closed form"]
    return {
        name: {
            "milliseconds": 1e3 * times_taken[name],
            "ratio": times_taken[name] / base,
            "error": error(run(), case, times),
        }
        for name, run in runs.items()
    }


def kernel_rows() -> dict[str, Any]:
    """Time per sample against writing three doubles, on both branches and at two horizons."""
    nothing = np.zeros(3)
    out = np.empty((3, SAMPLES))
    runs: dict[str, Any] = {"three doubles written": lambda: out.fill(1.0)}
    for name, moments, start in (
        ("trigonometric branch", (1.0, 2.0, 3.0), (0.3, -0.2, 0.9)),
        ("hyperbolic branch", (437.685185185, 714.008200689, 837.195503014), (1.0, 10.0, 1.0)),
    ):
        motion = constants_of_motion(np.array(moments), nothing, np.array(start), nothing, False, Scaled(0.0, 0.0, 0))
        period = 4 / motion.rate / motion.time_scale
        for periods in (1.0, 1e9):
            times = np.linspace(0, periods * period, SAMPLES)
            runs[f"{name}, {periods:g} periods"] = lambda m=motion, t=times: sample_components(
                m, t, out[0], out[1], out[2]
            )
        i, w = np.array(moments), np.array(start)
        runs[f"set-up, {name}"] = lambda i=i, w=w: constants_of_motion(
            i, nothing, w, nothing, False, Scaled(0.0, 0.0, 0)
        )
    spent = medians(runs, 25)
    write = spent["three doubles written"]
    return {
        name: {"microseconds": 1e6 * t}
        if name.startswith("set-up")
        else {"nanoseconds per sample": 1e9 * t / SAMPLES, "ratio": t / write}
        for name, t in spent.items()
    }


def cold_start() -> dict[str, float]:
    """Seconds from the start of a process to the first T-handle answer in core, compiled code being cached."""
    code = (
        "import numpy as np;from core.bodies.mass_properties import diagonal;from core.integration.solve import solve;"
        "from core.rotation.torque_free import TorqueFree;"
        "solve(TorqueFree(diagonal((837.2,714.0,437.7)),np.array([1.,10.,1.])),np.linspace(0,20,10000))"
    )
    spent = []
    for _ in range(5):
        start = time.perf_counter()
        subprocess.run([sys.executable, "-c", code], check=True, cwd=Path(__file__).parents[1])
        spent.append(time.perf_counter() - start)
    return {"median": sorted(spent)[2], "first": spent[0]}


def main() -> None:
    """Measure everything and write benchmarks/results/free_rotation.json."""
    result = {
        "machine": described("numpy", "scipy", "numba", "heyoka"),
        "samples": SAMPLES,
        "cases": {case: case_rows(case) for case in CASES},
        "kernel": kernel_rows(),
        "cold start in seconds": cold_start(),
    }
    RESULTS.mkdir(exist_ok=True)
    (RESULTS / "free_rotation.json").write_text(json.dumps(result, indent=1) + "\n")
    print(json.dumps(result, indent=1))


if __name__ == "__main__":
    main()
