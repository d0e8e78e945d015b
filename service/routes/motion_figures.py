"""Free rotations and scenes as figures: the samples of an answer over time, and paths in the plane."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np

from core.errors import InvalidParameter
from service.requests.declared_units import unit_at
from service.responses.linear_svg import Line, Panel, panels
from service.responses.motion_svg import Column, numbers, over_time
from service.routing import Answer

ROTATION = (("angular_velocity", "rad s^-1"), ("attitude", "1"))
"""Columns of a free rotation that are drawn, and their units."""

REMEDY = "accept application/json, or change the request"


def draw_rotation(answer: Answer) -> bytes:
    """Return the samples of a free rotation, in doubles or as decimal strings, as an SVG document.

    Raises
    ------
    InvalidParameter
        Unless the outputs include times and a column.
    """
    columns = [Column(name, unit, numbers(answer[name])) for name, unit in ROTATION if name in answer]
    if "time" not in answer or not columns:
        rule = "include time, and angular_velocity or attitude, for a figure"
        raise InvalidParameter("outputs", rule, remedy=REMEDY)
    title = f"Free rotation: {answer['model'].regime}, by {answer['method']}"
    return panels(title, over_time(answer["time"], columns)).encode()


def draw_ensemble(answer: Answer) -> bytes:
    """Return the angular velocities of many free rotations as an SVG document: a panel for each component."""
    order = np.argsort(answer["time"], kind="stable")
    time, rates = answer["time"][order], answer["angular_velocity"][:, order]
    shown = [
        Panel(
            "time (s)",
            f"angular_velocity.{axis} (rad/s)",
            [Line(f"member {i}", time, own[:, k]) for i, own in enumerate(rates)],
        )
        for k, axis in enumerate("xyz")
    ]
    return panels(f"{len(rates)} free rotations", shown).encode()


def scene_drawing(view: Any) -> Callable[[Answer], bytes]:
    """Return what draws the motion in an answer to a named scene, with the units that the answer's model declares."""

    def draw(answer: Answer) -> bytes:
        motion = answer.get("trajectory")
        if motion is None:
            raise InvalidParameter("times", "be given, and trajectory among the outputs, for a figure", remedy=REMEDY)
        columns = [
            Column(name, unit_at(view, ("trajectory", name, 0)) or "1", numbers(values), "12")
            for name, values in motion.items()
            if name != "time" and values is not None
        ]
        model = answer["model"]
        return panels(f"{model.name}: {model.regime}", over_time(motion["time"], columns)).encode()

    return draw


def draw_described(answer: Answer) -> bytes:
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
