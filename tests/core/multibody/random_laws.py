"""Laws by formula drawn at random: of time, places, rates, lengths and of where other bodies are."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Any

import numpy as np

AXES = "xyz"
SHARE = 0.25
"""Part of the scenes to which a law is added."""


class Laws:
    """Draws laws that act on the bodies of a scene.

    Parameters
    ----------
    places : sequence of str
        Bodies, or places of bodies, on which a law may act.
    turning : sequence of str
        Rigid bodies of the plane.
    """

    def __init__(
        self, random: np.random.Generator, places: Sequence[str], turning: Sequence[str], dimension: int
    ) -> None:
        self.random, self.places, self.turning, self.axes = random, places, turning, AXES[:dimension]

    def any_law(self) -> dict[str, Any]:
        """Return a connection whose force is a formula."""
        kinds: list[Callable[[], dict[str, Any]]] = [self.force, self.force, self.field, self.spring, self.damper]
        kinds += [self.torque] if self.turning else []
        return {**self._one(kinds)(), "name": "formula"}

    def force(self) -> dict[str, Any]:
        """Return a force on a place: drag in air or oil, of time, of the place, or toward another body."""
        other = str(self._one(self.places)).partition(".")[0]
        place = self._one(self.places)
        laws = [
            [f"-0.2*speed*v{axis}" for axis in self.axes],
            [f"-v{axis}/2" for axis in self.axes],
            ["2*cos(3*t)", "sin(5*t)", "-t"][: len(self.axes)],
            [f"sin({axis}) - {axis}*exp(-{axis}^2)" for axis in self.axes],
        ]
        if other != place.partition(".")[0]:
            laws.append([f"{other}.{axis} - {axis} - v{axis}/3" for axis in self.axes])
        return {"kind": "force", "place": place, "force": self._one(laws)}

    def field(self) -> dict[str, Any]:
        """Return a field on the centres of all bodies: magnetic, or of places and rates."""
        beside = ["0"] * (len(self.axes) - 2)
        if self._one((True, False)):
            return {"kind": "field", "force": ["2*vy", "-2*vx", *beside]}
        return {"kind": "field", "acceleration": [f"-sin({self.axes[0]}) - vx*t", "-vy/3", *beside]}

    def spring(self) -> dict[str, Any]:
        """Return a spring that hardens, or one that gives way, to a point above."""
        law = self._one(("5*stretch + stretch^3/10", "20*(1 - exp(-stretch/4))", "3*length/(1 + rate^2)"))
        return {"kind": "spring", "a": self._one(self.places), "b": self._above(), "rest_length": 1, "law": law}

    def damper(self) -> dict[str, Any]:
        """Return a damper that is not linear, to a point above."""
        law = self._one(("2*rate + rate^3/5", "rate*length/4"))
        return {"kind": "damper", "a": self._one(self.places), "b": self._above(), "law": law}

    def torque(self) -> dict[str, Any]:
        """Return a torque in the plane, of time or of the turn."""
        law = self._one(("sin(4*t)", "-sin(angle) - rate/2", "rate*(1 - rate^2)/5"))
        return {"kind": "torque", "body": self._one(self.turning), "torque": law}

    def _above(self) -> list[float]:
        return [1.25, *[0.5] * (len(self.axes) - 2), 4.5]

    def _one(self, options: Sequence[Any]) -> Any:
        return options[int(self.random.integers(len(options)))]


def with_law(scene: dict[str, Any], seed: int) -> dict[str, Any]:
    """Return a scene with a law by formula beside what it has, for a part of all seeds."""
    random = np.random.default_rng([seed, 32])
    bodies = scene["bodies"]
    if random.random() >= SHARE or any(one["kind"] == "chain" for one in scene["connections"]):
        return scene
    dimension = len(next(iter(bodies.values()))["at"])
    turning = [name for name, body in bodies.items() if "inertia" in body and dimension == 2]
    law = Laws(random, list(bodies), turning, dimension).any_law()
    return {**scene, "connections": [*scene["connections"], law]}
