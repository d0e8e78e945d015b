"""POST /v1/scenes: scenes that the client describes, each answered by the smallest model of its parts."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from decimal import Decimal
from math import isfinite, log
from typing import Any

from core.multibody.answer import RestRange
from core.multibody.language.scene import check_size
from core.multibody.model_answer import Assembly, SceneModel, SmallMotion
from core.multibody.motion.generic_equation import weight_of
from core.multibody.solve import OUTPUTS, solve_scene
from core.multibody.trajectory.inherited import MOST_PROPAGATED_NUMBERS
from core.notices import Notice
from core.systems.budget import Budget
from core.systems.methods.from_scipy import FromSciPy
from service.execution.cost_model import CalibratedCost, evaluations, extent, in_closed_form
from service.requests.described_scene import DescribedSceneRequest, SceneDescription
from service.responses.svg import SVG
from service.routes.described_answer import UNDECIDED_PATH, DescribedAccuracy, DescribedSceneAnswer, SceneColumn
from service.routes.motion_figures import draw_described
from service.routes.scene_catalogue import scene_catalogue
from service.routing import Answer, PostRoute
from service.schemas import Request, View, fields_of, sample_count, sample_times

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
answer lists the phases between the events, each with its own smallest model. What mechanics leaves undecided is an
answer too: `problem` says what, and which assumption would decide it.

Not covered yet: friction of balls on one another in space, friction of held connections, connections with `from` and
`until`. They are refused. It is not proven that all equilibria are found.
`Accept: image/svg+xml` draws the paths of a motion in the plane, and its columns over time."""

QUICK = 10.0
"""How fast (rad/s) a scene is taken to move, where a method chooses its steps."""

VALUES = 270.0
"""About the most values of a number at which rest is looked for: 64 on either side, some 70 halvings for each end."""
FOLLOWED = 2000
"""Samples that a search along the motion takes, or a sum."""

AMPLIFIED = 1.0
"""By how many powers of e a second a chain of pendulums that one can watch amplifies rounding."""

PUSHING = ("spring", "torsion-spring", "damper", "inverse-square", "motor", "spinning-frame")
"""Connections that most often leave a motion without a period."""

SPRINGS, DAMPERS = ("spring", "torsion-spring"), ("damper",)
"""Connections that may make one linear system of all bodies, whose modes with damping are complex."""

LONGEST = 4000.0
"""About the time (s) after which a scene that one can watch has used up the steps that core allows."""


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
        answer["equilibria"] = [fields_of(one) | {"modes": _modes(one.modes)} for one in found.equilibria]
    if found.assembly is not None:
        answer["assembly"] = assembly_fields(found.assembly)
    if found.thresholds is not None:
        answer["thresholds"] = [_of_rest(one) for one in found.thresholds]
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


def counted(question: DescribedSceneRequest, budget: Budget) -> dict[str, float]:
    """Return what is counted of a question; how many steps a motion takes is only known by running it."""
    # What is refused anyway waits for no compute process.
    check_size(question.bodies, question.connections)
    bodies, connections = float(len(question.bodies)), float(len(question.connections))
    kinds = [one.get("kind") for one in question.connections if isinstance(one, Mapping)]
    pushing = float(sum(kind in PUSHING for kind in kinds))
    found = {
        "question": 1.0,
        "bodies": bodies,
        "connections": connections,
        "pairs of connections": connections**2,
        "connections times pairs of bodies": connections * bodies**2,
        "cubes of bodies on springs": bodies**3 * any(kind in SPRINGS for kind in kinds),
        "cubes of bodies with dampers": bodies**3 * any(kind in DAMPERS for kind in kinds),
    }
    # A scene is read anew for every value of a number at which it is looked.
    read = 1.0 + VALUES * len(_thresholds(question))
    found = {name: count * read for name, count in found.items()}
    if question.times is not None:
        # What is searched or summed up along the motion looks at it as often as thousands of samples do.
        samples = sample_count(question.times, budget) + FOLLOWED * len(_along(question))
        # The motion of a single body most often repeats, or has a closed form: then no time is long.
        coupled = 0.0 if _in_a_row(question) else max(0.0, min(bodies - 1.0, connections))
        seconds = min(LONGEST, extent(question.times))
        # Where doubles lose a motion to rounding, pairs of doubles follow it.
        lost = log(question.accuracy) < AMPLIFIED * seconds - 53.0 * log(2.0) if coupled else False
        found |= {
            "motion": 1.0,
            "motions": bodies + connections,
            "motions of bodies that turn": float(turning_bodies(question)),
            "motions of bodies in space": bodies * in_space(question),
            "motions by forces": pushing,
            "seconds of forces": seconds * min(1.0, pushing),
            "seconds of coupled bodies in pairs": seconds * coupled * lost,
            "seconds of pairs of coupled bodies in pairs": seconds * coupled**2 * lost,
            "samples of bodies": samples * bodies,
            "samples of connections": samples * connections,
            "seconds of coupled bodies": seconds * coupled,
            "seconds of pairs of coupled bodies": seconds * coupled**2,
        }
        if question.input_uncertainty is not None:
            # Everything is done again for every number.
            again = 1.0 + min(MOST_PROPAGATED_NUMBERS, numbers_in(question))
            found = {name: count * again for name, count in found.items()}
        found |= _of_method(question, bodies, connections)
    if "equilibria" in (question.outputs or ()):
        found |= {"search": 1.0, "searches": bodies, "searches of pairs": bodies**2}
    return found


def turning_bodies(question: SceneDescription) -> int:
    """Return how many bodies have a moment of inertia."""
    known = {"inertia", "moments", "tensor", "body"}
    return sum(not known.isdisjoint(body.model_fields_set) for body in question.bodies.values())


def in_space(question: SceneDescription) -> bool:
    """Return whether gravity has three components."""
    return isinstance(question.gravity, list) and len(question.gravity) == 3


def _in_a_row(question: DescribedSceneRequest) -> bool:
    """Return whether springs and dampers alone connect bodies on one line: modes, for which no time is long."""
    connections = [one for one in question.connections if isinstance(one, Mapping)]
    vectors = [question.gravity]
    for body in question.bodies.values():
        vectors += [body.at, body.velocity]
    for one in connections:
        vectors += [end for end in (one.get("a"), one.get("b")) if not isinstance(end, str)]
    along = all(one is None or (isinstance(one, (list, tuple)) and not any(one[1:])) for one in vectors)
    return along and all(one.get("kind") in ("spring", "damper") for one in connections)


def _along(question: DescribedSceneRequest) -> list[Any]:
    """Return the outputs that need the motion between the samples."""
    summed = ("work-in-time", "paths-in-time")
    other = _thresholds(question)
    return [one for one in question.outputs or () if (not isinstance(one, str) or one in summed) and one not in other]


def _thresholds(question: DescribedSceneRequest) -> list[Any]:
    """Return the outputs that ask for ranges of numbers."""
    return [one for one in question.outputs or () if isinstance(one, Mapping) and "thresholds" in one]


def _of_method(question: DescribedSceneRequest, bodies: float, connections: float) -> dict[str, float]:
    """Return what is counted of the method that is named."""
    method = question.method
    if method is None or in_closed_form(method):
        return {}
    count = evaluations(method, question.times, QUICK)
    largest = min(1e4, 3.0 * bodies + connections)
    found = {f"evaluations of {method.kind}": count, "evaluations by their weight": count * weight_of(round(largest))}
    return found | {"evaluations by SciPy": count} if isinstance(method, FromSciPy) else found


def numbers_in(question: DescribedSceneRequest) -> int:
    """Return how many numbers a description has, those of formulas apart."""

    def among(value: Any) -> int:
        if isinstance(value, Request):
            return sum(among(getattr(value, name)) for name in value.model_fields_set)
        if isinstance(value, Mapping):
            return sum(map(among, value.values()))
        if isinstance(value, (list, tuple)):
            return sum(map(among, value))
        return isinstance(value, (int, float, Decimal)) and not isinstance(value, bool) and value != 0

    return among([question.gravity, question.bodies, question.connections, question.let])


HEAVY_BODY = scene_catalogue()["kovalevskaya-top"].question
TURNING_SLIP = {**scene_catalogue()["stone-across-slope"].question, "times": [0.01]}
BY_METHOD = {
    **scene_catalogue()["double-pendulum"].question,
    "times": [0.0, 0.1],
    "method": {"kind": "explicit-euler", "step": 0.1},
}

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
        # A heavy body about a point has kernels of its own, one of them for its start alone; so have a named method and
        # a slip that turns.
        warming=(HEAVY_BODY, {**HEAVY_BODY, "times": [0.0]}, BY_METHOD, TURNING_SLIP),
        description=DESCRIPTION,
        representations={SVG: draw_described},
    ),
)


def described_examples() -> list[dict[str, Any]]:
    """Return the described scenes as entries of the catalogue of scenes."""
    return [
        {"name": name, "path": PATH, "summary": one.summary, "outputs": list(OUTPUTS), "example": dict(one.question)}
        for name, one in scene_catalogue().items()
    ]
