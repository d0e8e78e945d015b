"""Make docs/pictures/work-precision.svg and docs/pictures/uncertainty.svg, the figures of docs/accuracy.md.

python -m benchmarks.work_precision
"""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np

from benchmarks.machine import T_HANDLE
from core.bodies.measured import PrincipalMoments
from core.rotation.free_rotation import FreeRotation
from core.systems.budget import Budget
from service.responses.svg import Curve, Level, log_log
from service.routes.work_precision import WorkPrecisionRequest, answer_work_precision, drawn

PICTURES = Path(__file__).parents[1] / "docs" / "pictures"
START = [1.0, 10.0, 1.0]
UNCERTAINTIES = (2.0**-53, 1e-12, 1e-9, 1e-6, 1e-3)


def main() -> None:
    """Measure and draw."""
    times = {"start": 0.0, "stop": 20.0, "count": 201}
    question = WorkPrecisionRequest.model_validate_json(
        json.dumps({"body": T_HANDLE, "angular_velocity": START, "times": times})
    )
    picture = drawn(answer_work_precision(question, Budget()))
    (PICTURES / "work-precision.svg").write_bytes(picture)

    body = PrincipalMoments(tuple(T_HANDLE["moments"])).mass_properties()
    motion = FreeRotation(body.principal, np.array(START))
    instants = np.geomspace(1e-2, 1e12, 200)
    curves = []
    for uncertainty in UNCERTAINTIES:
        grown = [(t, motion.inherited(np.array([t]), uncertainty)) for t in instants.tolist()]
        curves.append(Curve(f"inputs known to {uncertainty:.1g}", [(t, g) for t, g in grown if g < 1.0]))
    levels = [Level("closed form's own error", motion.error(np.array([20.0])))]
    title = "What uncertain inputs do to a tumbling T-handle"
    text = log_log(title, "time from the given state (s)", "inherited error, relative", curves, levels)
    (PICTURES / "uncertainty.svg").write_text(text, encoding="utf-8")


if __name__ == "__main__":
    main()
