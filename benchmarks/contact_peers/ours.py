"""This project: the whole question, from the document to the error statements."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from benchmarks.contact_peers.cases import BETWEEN, BOUNCE, LADDER, SLIP, ContactCase
from core.multibody.answer import SceneSolution
from core.multibody.language.reading import scene_from
from core.multibody.solve import solve_scene

_WATCHED = {
    LADDER.name: (("lift-off", "leaves the wall at"), (("angle at 0.8 s", "ladder.angle", 0),)),
    SLIP.name: (
        ("roll", "rolls from"),
        (("velocity at 1 s", "disc.velocity", 0), ("place at 1 s", "disc.position", 0)),
    ),
    BOUNCE.name: (("settle", "rests from"), (("height at 2.2 s", "ball.position", 1),)),
}
"""By case: kind of the event and its name here; names here, columns, components."""


def prepared(case: ContactCase, accuracy: float) -> Callable[[], SceneSolution]:
    """Return the question of a case."""
    times = [BETWEEN, case.stop] if case is BOUNCE else [case.stop]
    return lambda: solve_scene(scene_from(dict(case.scene)), times, ("trajectory",), accuracy)


def measured(
    case: ContactCase, answer: SceneSolution
) -> tuple[dict[str, float], dict[str, float], dict[str, Any] | None]:
    """Return what is measured, the error that is stated of each, and what is undecided."""
    if answer.problem is not None:
        problem = answer.problem
        said = {
            "code": problem.code,
            "time": problem.time,
            "explanation": problem.explanation,
            "candidates": [dict(one) for one in problem.candidates],
            "decided by": problem.decided_by,
        }
        return {}, {}, said
    (kind, name), columns = _WATCHED[case.name]
    event = next(event for event in answer.events if event.kind == kind)
    found, stated = {name: event.time}, {name: event.error}
    assert answer.trajectory is not None
    for name, column, component in columns:
        own = answer.trajectory.columns[column]
        found[name] = float(own.values[0] if own.values.ndim == 1 else own.values[0, component])
        stated[name] = own.error
    return found, stated, None
