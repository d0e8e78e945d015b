"""The motion of a described scene as a figure: paths in the plane, and columns over time."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import numpy as np

from core.errors import InvalidParameter
from service.responses.linear_svg import Line, Panel, panels
from service.routing import Answer

AXES = "xyz"


def drawn(answer: Answer) -> bytes:
    """Return a motion as an SVG document: one panel with the paths, and one for the columns of each unit.

    Raises
    ------
    InvalidParameter
        If no motion was asked for.
    """
    motion = answer.get("trajectory")
    if motion is None:
        raise InvalidParameter("times", "be given where a figure is wanted", remedy="give times, or accept JSON")
    order = np.argsort(motion["time"], kind="stable")
    time = motion["time"][order]
    found: list[Panel] = []
    paths = [
        Line(name.removesuffix(".position"), column["values"][order, 0], column["values"][order, 1])
        for name, column in motion["columns"].items()
        if name.endswith(".position") and column["values"].shape[1] == 2
    ]
    if paths:
        found.append(Panel("x (m)", "y (m)", paths, one_scale=True))
    by_unit: dict[str, list[Line]] = {}
    for name, column in motion["columns"].items():
        if not (paths and name.endswith(".position")):
            by_unit.setdefault(column["unit"], []).extend(_over_time(name, time, column["values"][order]))
    found.extend(Panel("time (s)", unit, lines) for unit, lines in by_unit.items())
    return panels(f"Motion by {answer.get('method') or answer['model']['name']}", found).encode()


def _over_time(name: str, time: Any, values: Any) -> Iterator[Line]:
    if values.ndim == 1:
        yield Line(name, time, values)
        return
    # Quaternions begin with their scalar part.
    axes = AXES if values.shape[1] < 4 else "wxyz"
    for k in range(values.shape[1]):
        yield Line(f"{name}.{axes[k]}", time, values[:, k])
