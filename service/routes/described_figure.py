"""The motion of a described scene as a figure: paths in the plane, and columns over time."""

from __future__ import annotations

import numpy as np

from core.errors import InvalidParameter
from service.responses.linear_svg import Line, Panel, panels
from service.responses.motion_svg import Column, numbers, over_time
from service.routing import Answer


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
    order = np.argsort(numbers(motion["time"]), kind="stable")
    samples = {name: numbers(column["values"]) for name, column in motion["columns"].items()}
    places = {name: one for name, one in samples.items() if name.endswith(".position") and one.shape[1] == 2}
    paths = [
        Line(name.removesuffix(".position"), values[order, 0], values[order, 1]) for name, values in places.items()
    ]
    columns = [
        Column(name, column["unit"], samples[name]) for name, column in motion["columns"].items() if name not in places
    ]
    shown = [Panel("x (m)", "y (m)", paths, one_scale=True)] if paths else []
    title = f"Motion by {answer.get('method') or answer['model']['name']}"
    return panels(title, [*shown, *over_time(motion["time"], columns)]).encode()
