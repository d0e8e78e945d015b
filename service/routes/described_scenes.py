"""POST /v1/scenes: scenes that the client describes, each answered by the smallest model of its parts."""

from __future__ import annotations

from collections.abc import Sequence
from math import isfinite
from typing import Any

import numpy as np

from core.multibody.answer import SceneModel
from core.multibody.columns import worst
from core.multibody.solve import DEFAULT_OUTPUTS, OUTPUTS, solve_scene
from core.notices import Notice
from core.systems.budget import Budget
from core.work import WorkLimitReached, work_limit
from service.execution.cost_model import CalibratedCost, extent
from service.requests.described_scene import DescribedSceneRequest
from service.routes.described_answer import DescribedSceneAnswer
from service.routes.planning_probes import few_of
from service.routes.scene_catalogue import scene_catalogue
from service.routing import Answer, PlanningProbe, PostRoute
from service.schemas import fields_of, sample_count, sample_times

PATH, OPERATION = "/v1/scenes", "described_scene"

SUMMARY = "A scene of your own: bodies and what connects them, answered by the smallest model that suffices"

DESCRIPTION = """Two components mean the plane, three space. A number is the decimal that is written, with all its
digits; it may also be a formula in quotes over the names in `let`, such as `"sqrt(2)/2"`, or `{"degrees": 30}`; a
vector of the plane may be `{"polar": [distance, angle]}`. Velocities that are left out follow from the connections.
Forces that the scene does not determine are null.

Not covered yet: contact, friction, impacts, strings that become taut again, connections with `from` and `until`. They
are refused, and a string that becomes slack ends the motion. There is no choice of method, no rounding and no
propagated uncertainty. It is not proven that all equilibria are found. A plan reads numbers as doubles, and foresees
neither for how long a motion can be followed nor the equilibria of more than about three bodies."""

NEAR = 0.01
"""How far (s) a motion is followed when it is planned."""

SEARCHED = 10_000.0
"""Work (`core.work`) up to which equilibria are looked for when a scene is planned: those of about three bodies."""

LONGEST = 4000.0
"""About the time (s) after which a scene that one can watch has used up the steps that core allows."""


def solved(question: DescribedSceneRequest, budget: Budget) -> Answer:
    """Answer a question about a described scene."""
    times = () if question.times is None else sample_times(question.times, budget)
    outputs = DEFAULT_OUTPUTS if question.outputs is None else question.outputs
    found = solve_scene(question.scene(), times, outputs, question.accuracy)
    answer: Answer = {"model": _model(found.model), "warnings": []}
    for name, start in (
        ("accelerations", {body: fields_of(one) for body, one in (found.accelerations or {}).items()}),
        ("forces", {force: fields_of(one) for force, one in (found.forces or {}).items()}),
        ("energy", None if found.energy is None else fields_of(found.energy)),
    ):
        if getattr(found, name) is not None:
            answer[name] = _in_range(start, name, answer["warnings"])
    answer["period"] = found.period
    answer["ended"] = None if found.trajectory is None else "horizon" if found.ended is None else found.ended.kind
    answer["events"] = found.events
    if found.trajectory is not None:
        columns = found.trajectory.columns
        answer["trajectory"] = {
            "time": found.trajectory.time,
            "rows": found.trajectory.rows,
            "columns": {name: fields_of(column) for name, column in columns.items()},
        }
        hows = {column.how for column in columns.values()}
        answer["accuracy"] = {
            "requested": question.accuracy,
            "error": worst(columns),
            "how": "measured against pairs" if "measured against pairs" in hows else "closed form",
        }
    if found.equilibria is not None:
        answer["equilibria"] = [fields_of(one) | {"modes": _modes(one.modes)} for one in found.equilibria]
    return answer


def _model(model: SceneModel) -> dict[str, Any]:
    return fields_of(model) | {"apart": [fields_of(part) | {"modes": _modes(part.modes)} for part in model.apart]}


def _modes(modes: Sequence[tuple[float, float]]) -> list[dict[str, float]]:
    return [{"frequency": frequency, "growth_rate": growth} for frequency, growth in modes]


def _in_range(value: Any, name: str, warnings: list[Notice]) -> Any:
    """Return a figure of the start with null for what leaves the range of doubles, and a warning for each."""
    if isinstance(value, dict):
        return {key: _in_range(entry, f"{name}/{key}", warnings) for key, entry in value.items()}
    if isinstance(value, tuple):
        return [_in_range(entry, f"{name}/{i}", warnings) for i, entry in enumerate(value)]
    if isinstance(value, float) and not isfinite(value):
        warnings.append(Notice("out-of-range", f"{name} leaves the range of double precision and is null"))
        return None
    return value


def counted(question: DescribedSceneRequest, budget: Budget) -> dict[str, float]:
    """Return what is counted of a question; how many steps a motion takes is only known by running it."""
    bodies, connections = float(len(question.bodies)), float(len(question.connections))
    found = {
        "question": 1.0,
        "bodies": bodies,
        "connections": connections,
        "pairs of connections": connections**2,
        "connections times pairs of bodies": connections * bodies**2,
    }
    if "equilibria" in (question.outputs or ()):
        found |= {"searches": bodies, "searches of pairs": bodies**2}
    if question.times is not None:
        samples = sample_count(question.times, budget)
        # The motion of a single body most often repeats, or has a closed form: then no time is long.
        coupled, seconds = max(0.0, min(bodies - 1.0, connections)), min(LONGEST, extent(question.times))
        found |= {
            "motions": bodies + connections,
            "samples of bodies": samples * bodies,
            "samples of connections": samples * connections,
            "seconds of coupled bodies": seconds * coupled,
            "seconds of pairs of coupled bodies": seconds * coupled**2,
        }
    return found


def probed(question: DescribedSceneRequest, budget: Budget) -> PlanningProbe:
    """Answer a question at few times near the start, where the rows are as long; its error is known from the whole."""
    if question.times is None:
        return PlanningProbe(_without_long_searches(question, budget))
    instants = sample_times(question.times, budget)
    few = instants[few_of(instants.size)]
    near = few * min(1.0, NEAR / max(NEAR, float(np.abs(few).max())))
    fields = _without_long_searches(question.model_copy(update={"times": near.tolist()}), budget)
    del fields["accuracy"]
    return PlanningProbe(fields, {"trajectory": instants.size / few.size})


def _without_long_searches(question: DescribedSceneRequest, budget: Budget) -> Answer:
    """Answer a question, without its equilibria if looking for them takes long."""
    try:
        with work_limit(SEARCHED):
            return solved(question, budget)
    except WorkLimitReached:
        others = question.outputs and [name for name in question.outputs if name != "equilibria"]
        return solved(question.model_copy(update={"outputs": others}), budget)


DESCRIBED_SCENES = (
    PostRoute(
        PATH,
        OPERATION,
        SUMMARY,
        "scenes",
        DescribedSceneRequest,
        DescribedSceneAnswer,
        solved,
        CalibratedCost(OPERATION, counted),
        planning_probe=probed,
        description=DESCRIPTION,
    ),
)


def described_examples() -> list[dict[str, Any]]:
    """Return the described scenes as entries of the catalogue of scenes."""
    return [
        {"name": name, "path": PATH, "summary": one.summary, "outputs": list(OUTPUTS), "example": dict(one.question)}
        for name, one in scene_catalogue().items()
    ]
