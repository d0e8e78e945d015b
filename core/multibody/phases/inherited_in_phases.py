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

from collections.abc import Callable

import numpy as np

from core.balls import precision
from core.errors import MechanicsError, NotApplicable, Path
from core.multibody.algebra.polynomials import BITS
from core.multibody.contacts.contact_states import State
from core.multibody.language.numerals import Numerals
from core.multibody.language.scene import Scene
from core.multibody.phases.phase import PhaseMotion
from core.multibody.phases.phases import motion_in_phases
from core.multibody.trajectory.inherited import MOST_PROPAGATED_NUMBERS, inputs_of
from core.systems.trajectory import Column

MOVED = 2.0**-34
"""Share by which a number is moved: its effect is seen in doubles to some 2^-18 of itself."""
KNOWN = 2.0**-40
"""Largest error of a column, relative to its largest value, from which derivatives are formed."""

ColumnsOf = Callable[[PhaseMotion], dict[str, Column]]
"""From a motion to the columns that are answered, at the same times."""


def inherited_in_phases(
    scene: Scene, motion: PhaseMotion, end: float, columns: dict[str, Column], columns_of: ColumnsOf
) -> dict[str, float]:
    """Return the largest change of every column by relative errors of one in all numbers, to first order.

    Raises
    ------
    NotApplicable
        Where that cannot be told, with the reason.
    """
    for name, body in scene.bodies.items():
        if body.body is not None:
            raise NotApplicable(f'"{name}" is a body of the catalogue, whose numbers are not propagated')
    poor = next((name for name, one in columns.items() if one.error > KNOWN * one.largest > 0.0), None)
    if poor is not None:
        raise NotApplicable(f"{poor} is not known well enough for the effect of small changes to be seen in it")
    with precision(BITS):
        inputs = list(inputs_of(motion.base.measures.numerals.read))
    if len(inputs) > MOST_PROPAGATED_NUMBERS:
        raise NotApplicable(
            f"the description has {len(inputs)} numbers, and at most {MOST_PROPAGATED_NUMBERS} are propagated"
        )
    kinds = _kinds(motion)
    total = {name: np.zeros(len(one.values)) for name, one in columns.items()}
    for paths in inputs:
        both = [_moved(scene, paths, end, share) for share in (MOVED, -MOVED)]
        if any(_kinds(other) != kinds for other in both):
            raise NotApplicable(
                f"other events happen with another value of {_name(paths)}: the motion does not change in proportion"
            )
        more, less = (columns_of(other) for other in both)
        for name in columns:
            away = (more[name].values - less[name].values) / (2.0 * MOVED)
            total[name] += np.abs(away) if away.ndim == 1 else np.linalg.norm(away, axis=1)
    return {name: float(np.max(one, initial=0.0)) for name, one in total.items()}


def _kinds(motion: PhaseMotion) -> tuple[list[tuple[str, str]], list[list[State]]]:
    """Return what happens: events, and the states between them."""
    return [(event.kind, event.name) for event in motion.events], [phase.states for phase in motion.phases]


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
