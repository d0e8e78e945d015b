"""Figures of the precessions of many bodies that differ in moments or starts, for studies."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np

from core.errors import Path
from core.rotation.precession.many import Precessions, precessions
from core.rotation.precession.precession import FIGURES
from service.routing import Columns, ManyFigures

PLACES: Mapping[Path, tuple[str, int]] = {
    **{("body", "moments", k): ("moments", k) for k in range(3)},
    **{("angular_velocity", k): ("angular_velocity", k) for k in range(3)},
}
"""Where in a request a column stands, and in which array of core."""


def many_precessions(request: Any, columns: Columns, figures: Sequence[Path]) -> ManyFigures | None:
    """Return figures of many questions to /v1/rotation/precession; parameters as in `PostRoute.many`."""
    body = request["body"]
    if body["kind"] != "principal-moments" or request.get("measure") is not None or not set(columns) <= set(PLACES):
        return None
    if not all(_known(path) for path in figures):
        return None
    count = len(next(iter(columns.values())))
    arrays = {
        "moments": np.tile(np.array(body["moments"], dtype=np.float64), (count, 1)),
        "angular_velocity": np.tile(np.array(request["angular_velocity"], dtype=np.float64), (count, 1)),
    }
    for place, column in columns.items():
        name, k = PLACES[place]
        arrays[name][:, k] = column
    found = precessions(arrays["moments"], arrays["angular_velocity"])
    return ManyFigures(
        found.answered,
        np.stack([_figure(found, path) for path in figures], axis=1),
        {"unphysical-inertia": found.unphysical},
    )


def _known(path: Path) -> bool:
    name, *place = path
    if name in FIGURES or name == "tumbles":
        return not place
    return (name == "middle_axis_tilt" and place in ([0], [1])) or (name == "axis" and place in ([0], [1], [2]))


def _figure(found: Precessions, path: Path) -> Any:
    name, *place = path
    if name in FIGURES:
        return found.figures[:, FIGURES.index(str(name))]
    if name == "tumbles":
        return found.tumbles.astype(np.float64)
    return (found.tilt if name == "middle_axis_tilt" else found.axis)[:, int(place[0])]
