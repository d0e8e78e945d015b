"""A pendulum of 1 m that starts with a speed: its motion by Jacobi's functions, to check what is followed along it."""

from __future__ import annotations

from dataclasses import dataclass
from itertools import pairwise
from typing import Any

from mpmath import acos, asin, cos, ellipf, ellipfun, ellipk, floor, mpf, sin, sqrt

from core.multibody.language.scene import Scene
from tests.core.multibody.worked_examples import read

GRAVITY, ANGLE = "9.81", "0.5"


@dataclass(frozen=True)
class Swing:
    """A start at 0.5 rad with a speed (m/s) upwards; to be used with the digits that are wanted."""

    speed: float

    @property
    def amplitude(self) -> mpf:
        """Largest angle (rad)."""
        return acos(cos(mpf(ANGLE)) - mpf(self.speed) ** 2 / 2 / mpf(GRAVITY))

    @property
    def modulus(self) -> mpf:
        """The sine of half the amplitude."""
        return sin(self.amplitude / 2)

    @property
    def quarter(self) -> mpf:
        """A quarter of the period (s)."""
        return ellipk(self.modulus**2) / sqrt(mpf(GRAVITY))

    def phase(self, angle: mpf) -> mpf:
        """Time (s) since the lowest place at which it comes through an angle upwards."""
        return ellipf(asin(sin(angle / 2) / self.modulus), self.modulus**2) / sqrt(mpf(GRAVITY))

    @property
    def start(self) -> mpf:
        """The time (s) since it came through its lowest place."""
        upwards = self.phase(mpf(ANGLE))
        return upwards if self.speed >= 0 else 2 * self.quarter - upwards

    def angle(self, time: mpf) -> mpf:
        """Return the angle at a time since the start."""
        at = sqrt(mpf(GRAVITY)) * (self.start + time)
        return 2 * asin(self.modulus * ellipfun("sn", at, m=self.modulus**2))

    def path(self, time: mpf) -> mpf:
        """Return the length of the path (m) up to a time."""
        first, last = (int(floor((t - self.quarter) / (2 * self.quarter))) for t in (self.start, self.start + time))
        turns = [(-1) ** n * self.amplitude for n in range(first + 1, last + 1)]
        places = [mpf(ANGLE), *turns, self.angle(time)]
        return sum(abs(b - a) for a, b in pairwise(places))

    def scene(self, **connections: Any) -> Scene:
        """Return the scene, with further connections."""
        bob = {
            "mass": 1,
            "at": [f"sin({ANGLE})", f"-cos({ANGLE})"],
            "velocity": [f"{self.speed!r}*cos({ANGLE})", f"{self.speed!r}*sin({ANGLE})"],
        }
        rod = {"kind": "rod", "a": "bob", "b": [0, 0]}
        more = [{"name": name, **one} for name, one in connections.items()]
        return read({"gravity": [0, f"-{GRAVITY}"], "bodies": {"bob": bob}, "connections": [rod, *more]})
