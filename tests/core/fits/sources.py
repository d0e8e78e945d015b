"""Questions to be fitted, and data made with known numbers."""

from __future__ import annotations

import json
from typing import Any

import numpy as np

from core.arrays import Floats
from core.fits.fit import Data
from core.fits.observations import Measured
from core.systems.budget import Budget
from service.requests.request_reader import Limits, Reader
from service.routes.assessments.route_source import RouteSource
from service.routes.described_scenes import DESCRIBED_SCENES
from service.routes.rotation.trajectory import ROTATION
from service.routing import PostRoute

SCENES, BODIES = DESCRIBED_SCENES[0], ROTATION[0]

DECAY: dict[str, Any] = {
    "let": {"b1": 1.0, "b2": 1.0},
    "bodies": {"p": {"mass": 1, "at": [0, 0], "velocity": ["b1*b2", 0]}},
    "connections": [{"kind": "force", "place": "p", "force": ["-b2*vx", 0]}],
}
"""A body that drag stops: x = b1 (1 - exp(-b2 t))."""

THROW: dict[str, Any] = {
    "gravity": [0, "-g"],
    "let": {"g": 9.0, "v": 3.0, "h": 0.0},
    "bodies": {"p": {"mass": 2, "at": [0, "h"], "velocity": [1, "v"]}},
    "connections": [],
}
"""A throw: y = h + v t - g t^2/2, linear in all three."""


def source(route: PostRoute = SCENES) -> RouteSource:
    reader = Reader[Any](route.question, Limits(10**4, 10**6, 10**5, 10**4), route.elsewhere)
    return RouteSource(route, reader.read, Budget(audited=False))


def column(request: dict[str, Any], times: Floats, name: str, numbers: dict[str, float]) -> Floats:
    """Return a column of the answer with other numbers in `let`."""
    changed = request | {"let": request["let"] | numbers, "times": times.tolist(), "outputs": ["trajectory"]}
    return np.array(source().answer(json.dumps(changed))["trajectory"]["columns"][name]["values"])


def data(times: Floats, deviation: float | None = None, figures: dict[str, str] | None = None, **columns: Any) -> Data:
    """Return data of columns at times, with one deviation for all of them."""
    figures = figures or {"y": "p.position.y"}
    deviations = {} if deviation is None else dict.fromkeys(figures, deviation)
    return Data(Measured({"t": times, **columns}, "t", tuple(figures), deviations, {}), figures)
