"""POST /v1/scenes: scenes that the client describes, each answered by the smallest model of its parts."""

from __future__ import annotations

from collections.abc import Sequence
from math import isfinite
from typing import Any

import numpy as np

from core.errors import Path
from core.multibody.answer import RestRange
from core.multibody.model_answer import Assembly, SceneModel, SmallMotion
from core.multibody.solve import OUTPUTS, solve_scene
from core.notices import Notice
from core.systems.budget import Budget
from service.requests.described_scene import DescribedSceneRequest
from service.responses.svg import SVG
from service.routes.described_answer import UNDECIDED_PATH, DescribedAccuracy, DescribedSceneAnswer, SceneColumn
from service.routes.equations_answer import equations_fields
from service.routes.many_scenes import many_scenes
from service.routes.motion_figures import draw_described
from service.routes.scene_catalogue import scene_catalogue
from service.routing import Answer, Columns, PostRoute
from service.schemas import View, fields_of, sample_times

PATH, OPERATION = "/v1/scenes", "described_scene"

SUMMARY = "A scene of your own: bodies and what connects them, answered by the smallest model that suffices"

DESCRIPTION = """Two components mean the plane, three space. A number is the decimal that is written, with all its
digits; it may also be a formula in quotes over the names in `let`, such as `"sqrt(2)/2"`, or `{"degrees": 30}`; a
vector of the plane may be `{"polar": [distance, angle]}`. Velocities that are left out follow from the connections.
Forces that the scene does not determine are null. `outputs` may also ask when a quantity takes a value,
`{"when": {"quantity": "rod.angle", "equals": 0, "nth": 2}}`, and how small and large it becomes,
`{"extremes": "rod.force"}`, between the start and the latest of the times. Between which
values of a number a scene stays at rest is requested by its JSON pointer,
`{"thresholds": {"vary": "/connections/0/friction", "between": [0, 2]}}`.

Contacts push and do not pull, with friction and restitution; strings become slack and taut again. The
answer lists the phases between the events, each with its own smallest model. A statically indeterminate or
ill-posed problem is answered too: `problem` says what is not determined, and which assumption would decide it.

Not covered yet: friction of balls on one another in space, friction of held connections, connections with `from` and
`until`. They are refused. It is not proven that all equilibria are found.
`Accept: image/svg+xml` draws the paths of a motion in the plane, and its columns over time."""


def solved(question: DescribedSceneRequest, budget: Budget) -> Answer:
    """Answer a question about a described scene."""
    times = () if question.times is None else sample_times(question.times, budget)
    found = solve_scene(
        question.scene(),
        times,
        question.requested(),
        question.accuracy,
        method=question.method,
        input_uncertainty=question.input_uncertainty,
        digits=question.round,
        budget=budget,
    )
    motion = found.trajectory
    answer: Answer = {"model": model_fields(found.model), "warnings": [] if motion is None else list(motion.warnings)}
    for name, start in (
        ("accelerations", {body: fields_of(one) for body, one in (found.accelerations or {}).items()}),
        ("forces", {force: fields_of(one) for force, one in (found.forces or {}).items()}),
        ("energy", None if found.energy is None else fields_of(found.energy)),
    ):
        if getattr(found, name) is not None:
            answer[name] = _in_range(start, name, answer["warnings"])
    if motion is not None and question.method is not None:
        answer |= {"method": motion.method, "work": motion.work}
    answer |= {"period": found.period, "errors": {"period": found.period_error}}
    answer["ended"] = None if motion is None else motion.ended
    answer["events"] = [fields_of(event) for event in found.events]
    if found.phases is not None:
        answer["phases"] = [fields_of(phase) for phase in found.phases]
    if found.problem is not None:
        answer["problem"] = fields_of(found.problem) | {"type": f"{UNDECIDED_PATH}#{found.problem.code}"}
    if motion is not None:
        columns = {name: _picked(column, SceneColumn) for name, column in motion.columns.items()}
        answer["trajectory"] = {"time": motion.time, "rows": motion.rows, "columns": columns}
        answer["accuracy"] = _picked(motion.accuracy, DescribedAccuracy)
    if found.occurrences is not None:
        answer |= {"occurrences": found.occurrences, "extremes": found.extremes}
    if found.equilibria is not None:
        answer["equilibria"] = [
            fields_of(one)
            | {
                "modes": _modes(one.modes),
                "shapes": [None if shape is None else fields_of(shape) for shape in one.shapes],
            }
            for one in found.equilibria
        ]
    if found.assembly is not None:
        answer["assembly"] = assembly_fields(found.assembly)
    if found.thresholds is not None:
        answer["thresholds"] = [_of_rest(one) for one in found.thresholds]
    if found.equations is not None:
        answer["equations"] = equations_fields(found.equations)
    return answer


def _picked(found: Any, view: type[View]) -> dict[str, Any]:
    """Return those fields of core's dataclass that a view has."""
    return {name: getattr(found, name) for name in view.model_fields}


def _of_rest(found: RestRange) -> dict[str, Any]:
    ends = {"lower": found.lower, "upper": found.upper}
    return fields_of(found) | {name: None if end is None else fields_of(end) for name, end in ends.items()}


def model_fields(model: SceneModel) -> dict[str, Any]:
    """Return the fields of a model, its modes as objects."""
    return fields_of(model) | {"apart": [fields_of(part) | {"modes": _modes(part.modes)} for part in model.apart]}


def assembly_fields(assembly: Assembly) -> dict[str, Any]:
    """Return the fields of an assembly, those of its bodies and of its linkage as objects."""
    linkage = assembly.four_bar
    return fields_of(assembly) | {
        "bodies": {name: fields_of(body) for name, body in assembly.bodies.items()},
        "four_bar": None if linkage is None else fields_of(linkage),
    }


def _modes(modes: Sequence[SmallMotion]) -> list[dict[str, Any]]:
    return [mode._asdict() for mode in modes]


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


# Questions that have kernels of their own: a heavy body about a point, one of them for its start alone, a loop of bars,
# a named method, a search, a slip that turns, also from rest, a formula of pieces, a stiff motion, soft places of rest.
HEAVY_BODY = scene_catalogue()["kovalevskaya-top"].question
TURNING_SLIP = {**scene_catalogue()["stone-across-slope"].question, "times": [0.01]}
LOOP = {**scene_catalogue()["four-bar-linkage"].question, "times": [0.05]}
BY_METHOD = {
    **scene_catalogue()["double-pendulum"].question,
    "times": [0.0, 0.1],
    "method": {"kind": "explicit-euler", "step": 0.1},
}
SEARCHED = {
    **scene_catalogue()["double-pendulum"].question,
    "times": [0.1],
    "outputs": ["trajectory", {"extremes": "one.velocity.x"}],
}
PIECES = {
    "bodies": {"one": {"at": [0.0, 0.0], "mass": 1.0, "velocity": [1.0, 0.0]}},
    "connections": [{"kind": "force", "place": "one", "force": ["sign(sin(x) - 1/2)", 0.0]}],
    "times": [0.01],
}
STIFF = {
    "bodies": {"bob": {"mass": 1.0, "at": [1.0, 0.0]}},
    "connections": [
        {"kind": "rod", "name": "rod", "a": "bob", "b": [0.0, 0.0]},
        {"kind": "damper", "a": "bob", "b": [0.0, 3.0], "coefficient": 1e7},
        {"kind": "spring", "a": "bob", "b": [0.0, 3.0], "stiffness": 1e7, "rest_length": 2.5},
    ],
    "times": [1e-3],
    "outputs": [{"extremes": "rod.force"}],
}
SLIP_FROM_REST = {
    "gravity": [0.0, 0.0, -9.81],
    "bodies": {"block": {"mass": 1.0, "at": [0.0, 0.0, 0.0]}},
    "connections": [
        {"kind": "contact", "place": "block", "on": {"at": [0, 0, 0], "normal": [0, 0, 1]}, "friction": 0.2},
        {"kind": "force", "place": "block", "force": [3.0, "t", 0.0]},
    ],
    "times": [0.01],
}
SOFT_REST = scene_catalogue()["lagrange-points"].question
MEMBERS: tuple[Any, Columns, Sequence[Path]] = (
    {**scene_catalogue()["double-pendulum"].question, "times": [0.0, 0.1]},
    {("bodies", "one", "mass"): np.array([1.0, 2.0])},
    [("accuracy", "error")],
)

DESCRIBED_SCENES = (
    PostRoute(
        PATH,
        OPERATION,
        SUMMARY,
        "scenes",
        DescribedSceneRequest,
        DescribedSceneAnswer,
        solved,
        warming=(
            HEAVY_BODY,
            {**HEAVY_BODY, "times": [0.0]},
            LOOP,
            BY_METHOD,
            SEARCHED,
            TURNING_SLIP,
            SLIP_FROM_REST,
            PIECES,
            STIFF,
            SOFT_REST,
        ),
        description=DESCRIPTION,
        representations={SVG: draw_described},
        many=many_scenes,
        warming_many=(MEMBERS,),
    ),
)


def described_examples() -> list[dict[str, Any]]:
    """Return the described scenes as entries of the catalogue of scenes."""
    return [
        {
            "name": name,
            "path": PATH,
            "title": one.title,
            "topic": one.topic,
            "asks": one.asks,
            "summary": one.summary,
            "outputs": list(OUTPUTS),
            "example": dict(one.question),
        }
        for name, one in scene_catalogue().items()
    ]
