"""What scenes are drawn from: figures of textbooks, so that much is equal, level, symmetric or at right angles."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import Any, TypeVar

import numpy as np

T = TypeVar("T")
Json = dict[str, Any]

DIRECTIONS = (
    ("0.8", "0.6", "atan(3/4)"),
    ("0.6", "0.8", "atan(4/3)"),
    ("1", "0", "0"),
    ("0", "1", "pi/2"),
    ("sqrt(3)/2", "1/2", "pi/6"),
    ("sqrt(1/2)", "sqrt(1/2)", "pi/4"),
    ("1/2", "sqrt(3)/2", "pi/3"),
)
"""Cosine, sine and angle: 37, 53, 0, 90, 30, 45 and 60 degrees."""
BEYOND = (
    ("-0.8", "0.6", "pi - atan(3/4)"),
    ("-0.6", "0.8", "pi - atan(4/3)"),
    ("-1", "0", "pi"),
    ("-sqrt(1/2)", "sqrt(1/2)", "3*pi/4"),
    ("-1/2", "sqrt(3)/2", "2*pi/3"),
)
"""The same of obtuse angles: 143, 127, 180, 135 and 120 degrees."""
MASSES = (0.5, 1, 1, 1, 2, 3)
SPEEDS = (0, 0, 0, 0.5, 1, 2, 3, -1, -2)
COEFFICIENTS = (0, 0.1, 0.2, 0.3, 0.5, 0.75)
RESTITUTIONS = (0, 0, 0.5, 0.8, 1)


@dataclass
class Unit:
    """A few bodies with what connects them, and the places of it that something else may be tied to."""

    bodies: Json = field(default_factory=dict)
    connections: list[Json] = field(default_factory=list)
    ends: list[str] = field(default_factory=list)


class Draw:
    """Draws figures with one seed.

    Attributes
    ----------
    tag : str
        Ending of the names of bodies, so that units do not share one.
    x : float
        Where the unit stands (m).
    """

    def __init__(self, random: np.random.Generator, tag: str, x: float) -> None:
        self.random, self.tag, self.x = random, tag, x

    def one(self, values: Sequence[T]) -> T:
        """Return one of some values."""
        return values[int(self.random.integers(len(values)))]

    def chance(self, part: float) -> bool:
        """Return whether something of a probability happens."""
        return bool(self.random.random() < part)

    def mass(self) -> float:
        """Return a mass (kg)."""
        return self.one(MASSES)

    def speed(self) -> float:
        """Return a speed (m/s), zero in a third of all cases."""
        return self.one(SPEEDS)

    def direction(self) -> tuple[str, str, str]:
        """Return cosine, sine and angle of a direction, as formulas."""
        return self._either_way(self.one(DIRECTIONS))

    def turned(self) -> tuple[str, str, str]:
        """Return cosine, sine and angle of a direction, in a quarter of all cases at an obtuse angle."""
        return self._either_way(self.one(BEYOND)) if self.chance(0.25) else self.direction()

    def _either_way(self, direction: tuple[str, str, str]) -> tuple[str, str, str]:
        c, s, angle = direction
        return direction if self.chance(0.5) else (c, f"-({s})", f"-({angle})")

    def rough(self) -> Json:
        """Return friction and restitution of a contact, each in half of all cases."""
        found: Json = {}
        if self.chance(0.6):
            mu = self.one(COEFFICIENTS)
            found["friction"] = [mu, mu / 2] if self.chance(0.2) else mu
        if self.chance(0.4):
            found["restitution"] = self.one(RESTITUTIONS)
        return found

    def name(self, stem: str) -> str:
        """Return a name of this unit."""
        return f"{stem}{self.tag}"

    def at(self, x: object, y: object) -> list[str]:
        """Return a place of the plane, relative to where the unit stands."""
        return [f"{self.x} + ({x})", f"{y}"]
