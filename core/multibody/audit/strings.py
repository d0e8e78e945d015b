"""Strings: what is at most as long as it is, and what rubs on fixed pegs."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property
from typing import ClassVar

import numpy as np

from core.multibody.audit.definition import Definition, Touch
from core.multibody.audit.placement import Motion, Numbers, Placement, rate
from core.multibody.audit.string_runs import StringRun


@dataclass(frozen=True)
class StringDefinition(Definition):
    """An inextensible string: every run of it is at most as long as it is; tensions pull its places together."""

    kind: ClassVar[str] = "string"
    runs: tuple[StringRun, ...]
    touch: Touch

    @property
    def coefficients(self) -> Touch | None:
        """See `Definition.coefficients`."""
        return self.touch

    def steps(self, force: str) -> tuple[float, ...]:
        """See `Definition.steps`."""
        return next(run.steps() for run in self.runs if f"{run.name}.tension" == force)

    def closed(self, state: Numbers | None, count: int) -> Numbers | None:
        """See `Definition.closed`: where there are no phases, a string is taut all the time."""
        return np.ones(count, dtype=bool) if state is None else state != "open"

    @cached_property
    def reach(self) -> float:
        """See `Definition.reach`."""
        radii = [knot.radius for run in self.runs for part in run.parts for knot in (part.a, part.b)]
        return max(max(radii), *(abs(run.length) for run in self.runs))

    def gaps(self, placement: Placement) -> Mapping[str, Numbers]:
        """See `Definition.gaps`.

        A string over drums may lack whole turns of the courses of its parts: see `StringRun.steps`.
        """
        return {f"{run.name}.tension": run.length - run.extent(placement) for run in self.runs}

    def efforts(self, placement: Placement, motion: Motion) -> Mapping[str, Numbers]:
        """See `Definition.efforts`."""
        return {f"{run.name}.tension": -rate(run.extent, placement, motion) for run in self.runs}


@dataclass(frozen=True)
class RubbingString(StringDefinition):
    """A string over fixed pegs, or a drum, on which it rubs: its tension is the mean of those at its ends.

    Its friction, by which the tension grows from the first end to the last, slips with half of the difference of the
    rates of the parts at the ends, less what a drum turns; `touch` has the coefficients of that.

    Attributes
    ----------
    drum : str or None
        On which it rubs.
    shortest : float
        Of its parts at the start (m), whose directions make its wrap.
    """

    drum: str | None
    shortest: float

    def coefficient_size(self, size: float) -> float:
        """See `Definition.coefficient_size`: directions are known as well as differences of places."""
        return max(1.0, size / self.shortest)

    def works(self) -> bool:
        """See `Definition.works`."""
        return self.touch.static > 0.0

    def _passed(self, placement: Placement) -> Numbers:
        """Return half of what the first part is longer than the last, less what a drum has turned (m)."""
        (run,) = self.runs
        first, last = run.parts[0], run.parts[-1]
        half = (first.extent(placement) - last.extent(placement)) / 2.0
        if self.drum is None:
            return half
        turn = placement[self.drum].turn
        assert turn is not None, "a drum that rubs has a turn"
        return half - first.senses[1] * first.b.radius * turn

    def slips(self, placement: Placement, motion: Motion) -> Mapping[str, Numbers]:
        """See `Definition.slips`."""
        return {f"{self.name}.tension": rate(self._passed, placement, motion)}

    def efforts(self, placement: Placement, motion: Motion) -> Mapping[str, Numbers]:
        """See `Definition.efforts`."""
        return {
            **super().efforts(placement, motion),
            f"{self.name}.friction": rate(self._passed, placement, motion),
        }

    @property
    def forces(self) -> tuple[str, ...]:
        """See `Definition.forces`."""
        return f"{self.name}.tension", f"{self.name}.friction"

    def derived(self, placement: Placement, motion: Motion, forces: Mapping[str, Numbers]) -> Mapping[str, Numbers]:
        """See `Definition.derived`: the tensions at the ends."""
        mean, half = forces[f"{self.name}.tension"], forces[f"{self.name}.friction"] / 2.0
        return {f"{self.name}.1.tension": mean - half, f"{self.name}.2.tension": mean + half}
