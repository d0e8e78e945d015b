"""Thumbnails of the catalogue: ``python -m docs.site.thumbnails`` writes them to docs/pictures/scenes."""

from __future__ import annotations

import json
from collections.abc import Iterator
from itertools import pairwise

import numpy as np

from core.arrays import Floats
from core.systems.budget import Budget
from docs.site.navigation import DOCS
from service.requests.request_reader import Limits, Reader
from service.responses.svg import stroke
from service.routes import questions
from service.routes.scene_catalogue import scene_catalogue
from service.routing import Answer

FOLDER = DOCS / "pictures/scenes"

WIDTH, HEIGHT, MARGIN = 120, 80, 6
"""Of a thumbnail (px)."""

POINTS = 2000
"""Of a path: enough for the forty swings of the longest motion."""

DEPTH = (-0.4, -0.25)
"""What a unit of y is across and up, where z points up: an oblique projection."""


def paths(answer: Answer) -> Iterator[Floats]:
    """Yield the paths of the bodies in the plane of the drawing, or the first column over time if none moves."""
    motion = answer["trajectory"]
    order = np.argsort(motion["time"], kind="stable")
    columns = {
        name: np.asarray(column["values"], dtype=np.float64)[order] for name, column in motion["columns"].items()
    }
    places = [values for name, values in columns.items() if name.endswith(".position")]
    moved = [values for values in places if np.ptp(values, axis=0).any()]
    if not moved:
        first = next(iter(columns.values())).reshape(order.size, -1)[:, 0]
        moved = [np.column_stack([np.asarray(motion["time"])[order], first])]
    for values in moved:
        if values.shape[1] == 3:
            values = values[:, [0, 2]] + values[:, 1:2] * np.array(DEPTH)
        yield values[np.isfinite(values).all(axis=1)]


def thumbnail(answer: Answer) -> str:
    """Return a motion as a small SVG document: each body's path with a dot at its end."""
    drawn = [path for path in paths(answer) if len(path)]
    together = np.concatenate(drawn)
    least, size = together.min(axis=0), np.ptp(together, axis=0)
    room = np.array([WIDTH, HEIGHT]) - 2.0 * MARGIN
    scale = min((float(free / extent) for free, extent in zip(room, size, strict=True) if extent > 0.0), default=1.0)
    parts = []
    for k, path in enumerate(drawn):
        at = MARGIN + 0.5 * (room - scale * size) + scale * (path - least)
        points = [f"{x:.0f},{HEIGHT - y:.0f}" for x, y in at]
        line, end = "", ""
        # What is gone through again is drawn once.
        for before, after in dict.fromkeys(pairwise(points)):
            if before != after:
                line += f"L{after}" if before == end else f"M{before}L{after}"
                end = after
        x, y = points[-1].split(",")
        parts.append(f'<path d="{line}" fill="none" {stroke(k)}/>')
        parts.append(f'<circle cx="{x}" cy="{y}" r="2.5" fill="none" {stroke(k)}/>')
    head = f'<svg xmlns="http://www.w3.org/2000/svg" width="{WIDTH}" height="{HEIGHT}">'
    return "\n".join([head, *parts, "</svg>"]) + "\n"


def answer_of(name: str) -> Answer:
    """Return the answer about a scene of the catalogue, with enough samples."""
    route = next(route for route in questions() if route.operation_id == "described_scene")
    asked = scene_catalogue()[name].question
    question = {key: value for key, value in asked.items() if key != "outputs"}
    question["times"] = asked["times"] | {"count": POINTS}
    return route.handle(Reader(route.question, Limits()).read(json.dumps(question).encode()), Budget())


def main() -> None:
    """Write a thumbnail of each scene."""
    FOLDER.mkdir(exist_ok=True)
    for name in scene_catalogue():
        answer = answer_of(name)
        # Of a scene without a unique motion there is nothing to draw.
        if len(answer["trajectory"]["time"]):
            (FOLDER / f"{name}.svg").write_text(thumbnail(answer))


if __name__ == "__main__":
    main()
