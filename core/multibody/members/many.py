"""Answers to one question about many scenes that differ in numbers alone, to the bit as by themselves."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass

import numpy as np

from core.arrays import Floats, Integers
from core.balls import precision
from core.errors import Path
from core.multibody.algebra.polynomials import BITS
from core.multibody.audit.definitions import description_of
from core.multibody.language.independent_parts import independent_parts
from core.multibody.language.scene import Scene
from core.multibody.members.follow import TIMES_BESIDE, Followed, followed
from core.multibody.members.member_audit import TOGETHER, keep_the_laws, sets_of
from core.multibody.members.plan import Plans


@dataclass(frozen=True)
class AnsweredTogether:
    """Members that were answered, with the columns of their motion.

    Attributes
    ----------
    members : ndarray of int
        Their numbers.
    motion : Followed
        That of more members, and which rows are theirs.
    rows : ndarray of int
    """

    members: Integers
    motion: Followed
    rows: Integers


MOST_SAMPLES = 2**16
"""Samples of members that are followed at a time, so that their arrays stay within some tens of megabytes."""


class ManyScenes:
    """Answers members of a scene, as many as can be answered together.

    Parameters
    ----------
    scene : Scene
        With `recorded_balls.Varied` in place of the numbers that vary.
    places : sequence of paths
        Where these stand.
    scene_of : callable
        From the numbers of a member to its scene, for the audit.
    """

    def __init__(self, scene: Scene, places: Sequence[Path], scene_of: Callable[[Sequence[float]], Scene]) -> None:
        self.scene, self.scene_of = scene, scene_of
        self._plans = Plans(scene, places)

    def can_follow(self, times: Floats) -> bool:
        """Return whether members may be answered together: smooth motions of one part, followed forwards as written."""
        scene = self.scene
        return (
            scene.assemble is None
            and not scene.one_sided
            and not scene.changes
            and not scene.switches
            and 0 < len(times) <= MOST_SAMPLES
            and bool(times.min() >= 0.0)
            and bool(times.max() > 0.0)
            and len(independent_parts(scene)) == 1
        )

    def answered(self, numbers: Floats, times: Floats, accuracy: float) -> Iterator[AnsweredTogether]:
        """Yield members that are answered; those that are left out are to be answered by themselves.

        Parameters
        ----------
        numbers : ndarray, shape (members, k)
            What each has at the places.
        times : ndarray, shape (t,)
            As `can_follow` requires them (s).
        accuracy : float
            Largest error of any column, relative to the largest value in columns of its unit, that is tolerated.
        """
        count = max(TOGETHER, MOST_SAMPLES // (len(times) + TIMES_BESIDE))
        for k in range(0, len(numbers), count):
            some = numbers[k : k + count]
            with precision(BITS):
                found = followed(self._plans, some, times, accuracy)
            for one in found:
                rows = _audited(one, some, self.scene_of)
                if len(rows):
                    yield AnsweredTogether(one.members[rows] + k, one, rows)


def _audited(found: Followed, numbers: Floats, scene_of: Callable[[Sequence[float]], Scene]) -> Integers:
    """Return the rows of the members that keep all laws."""
    kept = [np.zeros(0, dtype=np.int64)]
    descriptions = [description_of(scene_of(row)) for row in numbers[found.members].tolist()]
    for rows, description in sets_of(descriptions, found.error):
        checked = {name: column.of(rows) for name, column in found.checked.items()}
        if keep_the_laws(description, checked, found.windows.at(rows)):
            kept.append(rows)
    return np.sort(np.concatenate(kept))
