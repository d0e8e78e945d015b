"""Error against work of every method over 200 bodies: the study examples/studies/work-precision.json, run and drawn.

    python -m benchmarks.dial

has the service compute the study, and writes benchmarks/results/dial.json and docs/pictures/dial.svg. Work is counted
in evaluations of the equation of motion, errors are measured against the closed form: both are the same to the bit on
every run of one version.
"""

from __future__ import annotations

import io
import json
import os
import tempfile
import time
from pathlib import Path
from typing import Any

import numpy as np

from benchmarks.machine import RESULTS
from benchmarks.servers import service
from benchmarks.studies import asked, downloaded
from service.responses.svg import Curve, Level, log_log

ROOT = Path(__file__).parents[1]
STUDY = ROOT / "examples" / "studies" / "work-precision.json"
PICTURE = ROOT / "docs" / "pictures" / "dial.svg"
PROBABILITIES = (0.0, 0.5, 1.0)
"""The best body, the median, the worst one."""


def studied(request: dict[str, Any]) -> Any:
    """Return all results of a study as the archive that the service answers."""
    with (
        tempfile.TemporaryDirectory() as folder,
        service(data=folder, study_workers=str(os.cpu_count() or 1)) as server,
    ):
        state = asked(server.port, "POST", "/v1/studies", request)
        place = f"/v1/studies/{state['jobID']}"
        while state["status"] in ("accepted", "running"):
            time.sleep(0.5)
            state = asked(server.port, "GET", place)
        assert (state["status"], state["failed"]) == ("successful", 0), state
        return np.load(io.BytesIO(downloaded(server.port, f"{place}/results", "application/x-npz")))


def points(request: dict[str, Any], figures: np.ndarray[Any, Any]) -> list[dict[str, Any]]:
    """Return the errors and evaluations of each method with each setting, as quantiles over the bodies.

    Parameters
    ----------
    figures : ndarray, shape (bodies * settings, quantities)
    """
    bodies, settings = request["vary"][0]["count"], request["vary"][1]["values"]
    # Curves of an answer are in alphabetic order of their methods.
    kinds = sorted(method["kind"] for method in settings[0])
    columns = dict(zip(request["quantities"], figures.reshape(bodies, len(settings), -1).T, strict=True))
    found = []
    for k, kind in enumerate(kinds):
        errors = columns[f"/curves/{k}/measurements/0/error"]
        evaluations = columns[f"/curves/{k}/measurements/0/evaluations"]
        for n, methods in enumerate(settings):
            found.append(
                {
                    "method": next(method for method in methods if method["kind"] == kind),
                    "evaluations": np.quantile(evaluations[n], PROBABILITIES).tolist(),
                    "error": np.quantile(errors[n], PROBABILITIES).tolist(),
                }
            )
    return found


def picture(measured: list[dict[str, Any]], closed_form: float) -> str:
    """Return the figure: the median body in colour, over bars from the best body to the worst one."""
    curves = []
    for kind in dict.fromkeys(point["method"]["kind"] for point in measured):
        own = [point for point in measured if point["method"]["kind"] == kind]
        for point in own:
            spread = [(point["evaluations"][1], error) for error in point["error"]]
            curves.append(Curve("", spread, emphasised=True))
        curves.append(Curve(kind, [(point["evaluations"][1], point["error"][1]) for point in own]))
    title = "Error against work: the median of 200 bodies, over the range of all of them"
    return log_log(title, "evaluations", "largest error, relative", curves, [Level("closed form, bound", closed_form)])


def main() -> None:
    """Compute, write, draw."""
    request = json.loads(STUDY.read_text())
    figures = studied(request)["figures"]
    measured, closed_form = (
        points(request, figures),
        float(figures[:, request["quantities"].index("/reference_error")].max()),
    )
    result = {"study": str(STUDY.relative_to(ROOT)), "probabilities": PROBABILITIES, "closed_form": closed_form}
    (RESULTS / "dial.json").write_text(json.dumps(result | {"points": measured}, indent=1) + "\n", encoding="utf-8")
    PICTURE.write_text(picture(measured, closed_form), encoding="utf-8")
    for point in measured:
        print(point["method"], *(f"{point['evaluations'][1]:10.0f} {point['error'][1]:9.2g}",))


if __name__ == "__main__":
    main()
