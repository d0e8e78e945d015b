"""The motion of a scene as a figure: paths in the plane, and columns over time."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import Any, NamedTuple

import numpy as np

from core.errors import InvalidParameter
from service.responses.linear_svg import Line, Panel, panels


class Curves(NamedTuple):
    """A column: its samples of shape (n,) or (n, k), its unit, and the names of its k components."""

    values: Any
    unit: str
    components: str


def motion_figure(title: str, time: Any, columns: Mapping[str, Curves], paths: Mapping[str, Any]) -> bytes:
    """Return a motion as an SVG document: one panel with the paths, and one for the columns of each unit.

    Parameters
    ----------
    time : ndarray, shape (n,)
    columns : mapping of str to Curves
        By name.
    paths : mapping of str to ndarray, shape (n, 2)
        In the plane, by name.
    """
    order = np.argsort(time, kind="stable")
    found: list[Panel] = []
    if paths:
        lines = [Line(name, values[order, 0], values[order, 1]) for name, values in paths.items()]
        found.append(Panel("x (m)", "y (m)", lines, one_scale=True))
    by_unit: dict[str, list[Line]] = {}
    for name, column in columns.items():
        by_unit.setdefault(column.unit, []).extend(_over_time(name, time[order], column.values[order], column))
    found.extend(Panel("time (s)", unit, lines) for unit, lines in by_unit.items())
    return panels(title, found).encode()


def without_motion() -> InvalidParameter:
    """Return the fault of a question without times of which a figure is wanted."""
    return InvalidParameter("times", "be given where a figure is wanted", remedy="give times, or accept JSON")


def _over_time(name: str, time: Any, values: Any, column: Curves) -> Iterator[Line]:
    if values.ndim == 1:
        yield Line(name, time, values)
        return
    for k in range(values.shape[1]):
        yield Line(f"{name}.{column.components[k]}", time, values[:, k])
