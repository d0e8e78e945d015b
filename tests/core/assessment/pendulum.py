"""A question that is answered without the service: the small swings of a pendulum, and samples of its angle."""

from __future__ import annotations

import json
from collections.abc import Callable, Mapping
from math import cos, pi, sqrt
from typing import Any

import mpmath
import numpy as np

from core.errors import InvalidParameter

UNITS = {"period": "s", "rate": "rad s^-1", "length": "m", "gravity": "m s^-2", "angle": "rad", "attitude": "1"}
REQUEST = {"length": 0.5, "gravity": 9.81}


class Pendulum:
    """Answers requests, counts them, and refuses lengths that are not positive and times before the start."""

    subject = "scenes/pendulum"
    outputs: frozenset[str] = frozenset()

    def __init__(self) -> None:
        self.answered = 0

    def answer(self, request: str) -> Mapping[str, Any]:
        self.answered += 1
        document = json.loads(request)
        length, gravity = document["length"], document["gravity"]
        if not length > 0.0:
            raise InvalidParameter("length", "be positive")
        times = document.get("times", [0.0])
        if min(times) < 0.0:
            raise InvalidParameter("times", "be after the start")
        rate = sqrt(gravity / length)
        return {
            "period": 2.0 * pi / rate,
            "rate": rate,
            "flip": None,
            "kind": "center",
            "stable": True,
            "force": {"value": 1.0, "unit": "N", "parts": [1.0]},
            "mass": {"total": 1.0, "own": 0.5, "parts": [0.5, 0.5]},
            "angle": np.array([cos(rate * t) for t in times]),
            "warnings": (),
        }

    def certified(self, request: Any) -> Mapping[str, Any] | None:
        """Return the period to 20 digits, by another algorithm than the answer's."""
        if request.get("gravity") != 9.81 or request.get("length") != 0.5:
            return None
        with mpmath.workdps(30):
            return {"period": mpmath.nstr(2 * mpmath.pi * mpmath.sqrt(mpmath.mpf(0.5) / mpmath.mpf(9.81)), 20)}

    def errors(self, request: Any) -> tuple[Mapping[str, Any], str] | None:
        """Bound the error of the rate, for one length."""
        return ({"rate": 1e-6}, "a bound") if request["length"] == 0.25 else None

    def takes(self, field: str) -> bool:
        return False

    def unit_of_answer(self, path: Any) -> str | None:
        return UNITS.get(path[0])

    def units_of_request(self, request: Any) -> Callable[[Any], str | None]:
        return self.unit_of_answer

    def scales(self, answer: Mapping[str, Any], request: Any) -> Mapping[str, float]:
        return {}

    def rotation(self, request: Any) -> None:
        return None
