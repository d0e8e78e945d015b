"""What the uncertainty of a description's numbers does to a motion through events.

Every number is moved in turn, to either side, and the motion is followed anew through all of its phases: an event comes
earlier or later, and what follows it changes by that as well as by the state that it starts from. The differences are,
to first order, what is otherwise propagated by saltation matrices; here the events are located anew, each to its own
error.
Where another number leads to other events, the derivative does not exist, and that is said.

References
----------
R. I. Leine, H. Nijmeijer, "Dynamics and Bifurcations of Non-Smooth Mechanical Systems" (2004), chapter 7.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from core.arrays import Floats, row_lengths
from core.balls import precision
from core.errors import MechanicsError, NotApplicable, Path
from core.multibody.algebra.polynomials import BITS
from core.multibody.contacts.contact_states import State
from core.multibody.language.numerals import Numerals
from core.multibody.language.scene import Scene
from core.multibody.phases.phase import PhaseMotion
from core.multibody.phases.phase_columns import ColumnsInPhases
from core.multibody.phases.phases import motion_in_phases
from core.multibody.trajectory.inherited import inputs_of

MOVED = 2.0**-34
"""Share by which a number is moved: its effect is seen in doubles to some 2^-18 of itself."""
KNOWN = 2.0**-40
"""Largest error of a column, relative to its largest value, from which derivatives are formed."""


@dataclass(frozen=True)
class ChangesInPhases:
    """Largest changes of columns by relative errors of one in every input, to first order.

    Attributes
    ----------
    times : ndarray, shape (t,)
    each : dict of str to ndarray, shape (t,)
        Sums of magnitudes, by column.
    """

    times: Floats
    each: dict[str, Floats]

    def of_columns(self, rows: np.ndarray) -> dict[str, float]:
        """Return the largest change of each column at some of the times."""
        return {name: float(np.max(one[rows], initial=0.0)) for name, one in self.each.items()}


def changes_in_phases(scene: Scene, columns: ColumnsInPhases, times: Floats, end: float) -> ChangesInPhases:
    """Return what the numbers of a scene do to the columns of its motion up to a time.

    Raises
    ------
    NotApplicable
        Where that cannot be told, with the reason.
    """
    motion, own = columns.motion, columns.at(times)
    poor = next((name for name, one in own.items() if one.error > KNOWN * one.largest > 0.0), None)
    if poor is not None:
        raise NotApplicable(f"{poor} is not known well enough for the effect of small changes to be seen in it")
    with precision(BITS):
        inputs = inputs_of(scene, motion.base)
    kinds = _kinds(motion)
    total = {name: np.zeros(len(times)) for name in own}
    for paths in inputs:
        both = [_moved(scene, paths, end, share) for share in (MOVED, -MOVED)]
        if any(_kinds(other) != kinds for other in both):
            raise NotApplicable(
                f"other events happen with another value of {_name(paths)}: the motion does not change in proportion"
            )
        more, less = (replace(columns, motion=other).at(times) for other in both)
        for name in own:
            away = (more[name].values - less[name].values) / (2.0 * MOVED)
            total[name] += np.abs(away) if away.ndim == 1 else row_lengths(away)
    return ChangesInPhases(times, total)


def _kinds(motion: PhaseMotion) -> tuple[list[tuple[str, str]], list[list[State]]]:
    """Return what happens: events, and the states between them."""
    after = [(event.kind, event.name) for event in motion.events if event is not motion.before]
    return after, [phase.states for phase in motion.phases]


def _name(paths: tuple[Path, ...]) -> str:
    return "/".join(map(str, paths[0]))


def _moved(scene: Scene, paths: tuple[Path, ...], end: float, share: float) -> PhaseMotion:
    """Return the motion of a scene with one of its numbers moved."""
    try:
        return motion_in_phases(scene, end, lambda: Numerals.of(scene.let, scene.numbers, paths, share))
    except MechanicsError as fault:
        raise NotApplicable(
            f"the scene hangs on {_name(paths)} being exactly what it is: with another value, {fault.detail}"
        ) from fault
