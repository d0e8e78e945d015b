"""A peer: a way to compute a case with a setting, and what has to be installed for it."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from importlib import metadata

from benchmarks.peers.cases import Case
from core.arrays import Floats

Run = Callable[[], Floats]

OURS, CLOSED_FORM, COMPILED, INTERPRETED, ENGINE = (
    "this project",
    "closed form",
    "integrator, compiled equation",
    "integrator stepping in Python",
    "physics engine",
)


@dataclass(frozen=True)
class Peer:
    """One method of one package.

    Attributes
    ----------
    name : str
    family : str
    package : str
        The distribution that has to be installed.
    prepare : callable
        From a case and a setting to a run without arguments; everything that need not be done again for another
        start or horizon of the same equation belongs here. A run returns the samples, shape (10000, k).
    setting : str
        What is swept, "" if nothing is.
    settings : tuple of float
        From cheap to dear.
    angular_velocity, attitude : bool
        What it can be asked for.
    longest : float
        The longest motion that it is asked for (s).
    """

    name: str
    family: str
    package: str
    prepare: Callable[[Case, float], Run]
    setting: str = ""
    settings: tuple[float, ...] = (0.0,)
    angular_velocity: bool = True
    attitude: bool = True
    longest: float = math.inf

    @property
    def version(self) -> str | None:
        """The version that is installed, None if there is none."""
        try:
            return metadata.version(self.package)
        except metadata.PackageNotFoundError:
            return None

    def answers(self, case: Case) -> bool:
        """Tell whether the case can be asked of it."""
        return case.stop <= self.longest and (self.attitude if case.attitude else self.angular_velocity)


TOLERANCES = tuple(10.0**-k for k in range(3, 15))
"""Tolerances of integrators, 1e-3 to 1e-14."""
