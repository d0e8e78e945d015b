"""The closed form's kernel alone: time per sample against writing three doubles, on both branches, and its set-up."""

from __future__ import annotations

from typing import Any

import numpy as np

from benchmarks.machine import medians
from benchmarks.peers.cases import SAMPLES
from core.double_double import Scaled
from core.rotation.closed_form.constants_of_motion import constants_of_motion
from core.rotation.closed_form.sampling import sample_components

BRANCHES = (
    ("trigonometric branch", (1.0, 2.0, 3.0), (0.3, -0.2, 0.9)),
    ("hyperbolic branch", (437.685185185, 714.008200689, 837.195503014), (1.0, 10.0, 1.0)),
)


def kernel_rows() -> dict[str, Any]:
    """Return nanoseconds per sample, over one and 1e9 periods, and microseconds of the set-up."""
    nothing = np.zeros(3)
    out = np.empty((3, SAMPLES))
    runs: dict[str, Any] = {"three doubles written": lambda: out.fill(1.0)}
    for name, moments, start in BRANCHES:
        i, w = np.array(moments), np.array(start)
        motion = constants_of_motion(i, nothing, w, nothing, False, Scaled(0.0, 0.0, 0))
        period = 4 / motion.rate / motion.time_scale
        for periods in (1.0, 1e9):
            times = np.linspace(0, periods * period, SAMPLES)
            runs[f"{name}, {periods:g} periods"] = lambda m=motion, t=times: sample_components(
                m, t, out[0], out[1], out[2]
            )
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
