"""Designs: from varied inputs to the numbers of each member, for any stretch of members alone.

Members are numbered from 0. The numbers of a member depend on the design and the seed and on nothing else: not on the
stretches in which they are asked for. Random numbers come in blocks of `BLOCK` members, each from its own child of the
seed (numpy's ``SeedSequence``); scrambled Sobol points from one sequence, in which any place can be found.

References
----------
J. K. Salmon et al., "Parallel random numbers: as easy as 1, 2, 3", SC11 (on streams by counting). A. B. Owen,
"Scrambling Sobol' and Niederreiter-Xing points", Journal of Complexity 14 (1998) 466.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from math import prod
from typing import Literal

import numpy as np

from core.arrays import Floats
from core.errors import InvalidParameter
from core.studies.sobol import BITS, SobolPoints
from core.studies.study_input import StudyInput

Kind = Literal["product", "zip", "sobol", "random"]

BLOCK = 4096
"""Members whose random numbers come from one generator."""

MOST_MEMBERS = 2**BITS
"""Members of a study: the points that the Sobol sequence has."""


@dataclass(frozen=True)
class Design:
    """Members of a study.

    Attributes
    ----------
    inputs : tuple of StudyInput
    kind : {"product", "zip", "sobol", "random"}
        Every combination of levels, the last input varying fastest; levels side by side; scrambled Sobol points; or
        independent draws.
    count : int or None
        Of members, for the last two.
    seed : int or None
        Of the last two, where None stands for 0.
    """

    inputs: tuple[StudyInput, ...]
    kind: Kind = "product"
    count: int | None = None
    seed: int | None = None

    def __post_init__(self) -> None:
        if self.kind in ("sobol", "random"):
            if self.count is None:
                raise InvalidParameter("count", f"be given for the design {self.kind}")
            if self.count > MOST_MEMBERS:
                raise InvalidParameter("count", f"be at most {MOST_MEMBERS}")
            for k, entry in enumerate(self.inputs):
                if entry.count is not None:
                    remedy = "the study's own count says how many members there are"
                    raise InvalidParameter(
                        ("vary", k, "count"), f"be left out in the design {self.kind}", remedy=remedy
                    )
            return
        if self.count is not None:
            remedy = "each varied input has its own count"
            raise InvalidParameter("count", f"be left out in the design {self.kind}", remedy=remedy)
        if self.seed is not None:
            remedy = "only the designs random and sobol draw members"
            raise InvalidParameter("seed", f"be left out in the design {self.kind}", remedy=remedy)
        for k, entry in enumerate(self.inputs):
            if entry.levels is None:
                rule = f"be given in the design {self.kind}"
                raise InvalidParameter(("vary", k, "count"), rule, remedy="give a count of levels, or values")
        if self.kind == "product" and self.members > MOST_MEMBERS:
            rule = f"have at most {MOST_MEMBERS} combinations"
            raise InvalidParameter(
                "vary", rule, remedy="take fewer levels, or the design sobol, which has its own count"
            )
        if self.kind == "zip":
            for k, entry in enumerate(self.inputs):
                if entry.levels != self.inputs[0].levels:
                    rule = f"have as many levels as the first: {self.inputs[0].levels}"
                    raise InvalidParameter(("vary", k), rule)

    @cached_property
    def shape(self) -> tuple[int, ...]:
        """Lengths of the axes of a grid: one for each input of a product, otherwise the number of members."""
        if self.kind == "product":
            return tuple(entry.levels or 1 for entry in self.inputs)
        return (self.count if self.count is not None else self.inputs[0].levels or 1,)

    @property
    def members(self) -> int:
        """How many there are."""
        return prod(self.shape)

    def numbers(self, start: int, stop: int) -> Floats:
        """Return the numbers of members from `start` up to `stop`, shape (stop - start, inputs); see `StudyInput`."""
        if self.kind in ("product", "zip"):
            return self._of_levels(start, stop)
        chances = self._sobol(start, stop) if self.kind == "sobol" else self._random(start, stop)
        return np.stack([entry.numbers(chances[:, k]) for k, entry in enumerate(self.inputs)], axis=1)

    def levels(self, k: int) -> Floats:
        """Return the numbers of one input's levels, in a design of levels."""
        entry = self.inputs[k]
        return entry.numbers(entry.chances_of_levels(np.arange(entry.levels or 1)))

    def _of_levels(self, start: int, stop: int) -> Floats:
        members = np.arange(start, stop)
        places: Sequence[np.ndarray] = (
            np.unravel_index(members, self.shape) if self.kind == "product" else (members,) * len(self.inputs)
        )
        columns = []
        for entry, place in zip(self.inputs, places, strict=True):
            # Levels of a slow input repeat: each is formed once.
            which, inverse = np.unique(place, return_inverse=True)
            columns.append(entry.numbers(entry.chances_of_levels(which))[inverse])
        return np.stack(columns, axis=1)

    def _random(self, start: int, stop: int) -> Floats:
        found = np.empty((stop - start, len(self.inputs)))
        for block in range(start // BLOCK, -(-stop // BLOCK)):
            child = np.random.SeedSequence(self.seed or 0, spawn_key=(block,))
            drawn = np.random.Generator(np.random.PCG64(child)).random((BLOCK, len(self.inputs)))
            low, high = max(start, block * BLOCK), min(stop, (block + 1) * BLOCK)
            found[low - start : high - start] = drawn[low - block * BLOCK : high - block * BLOCK]
        return found

    def _sobol(self, start: int, stop: int) -> Floats:
        chance = np.random.Generator(np.random.PCG64(np.random.SeedSequence(self.seed or 0, spawn_key=(0,))))
        return SobolPoints(len(self.inputs), chance).points(start, stop)
