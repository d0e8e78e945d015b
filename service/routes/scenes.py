"""Questions about constrained scenes: one route for each member of core's catalogue, made from its own fields."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import MISSING, fields
from functools import cache
from typing import Any, Literal, cast, get_type_hints

import orjson
from pydantic import ConfigDict, Field, create_model

from core.quantities import Tolerance, members_of
from core.scenes import Scene
from core.scenes.answer import ConstrainedSystem
from core.scenes.answer import SceneAnswer as SceneFound
from core.systems.budget import Budget
from service.execution.cost_model import CalibratedCost, numbers
from service.responses.rounding import DIGITS, Digits, covering, notices_of, rounded
from service.routes.bodies import few_times
from service.routes.rotation.trajectory import AccuracyView, ModelView, WorkView
from service.routing import Answer, Example, GetRoute, PostRoute, Reply
from service.schemas import SIGNATURE, Envelope, Request, Times, View, sample_count, sample_times

TIMES: Any = Field(default=None, description="Measured from the given state, of either sign, in any order (s).")
OUTPUTS: Any = Field(default=None, min_length=1, description="What to compute; by default everything.")


class SceneAnswer(Envelope):
    """What was asked for of a scene, each figure under its own name."""

    model_config = ConfigDict(extra="allow")

    model: ModelView
    accuracy: AccuracyView
    work: WorkView
    requested_samples: int = Field(description="Samples asked for; work.samples counts those that exist.")
    ended: str | None = Field(
        description="horizon, or the event that ended the motion; null if no motion was asked for."
    )
    trajectory: dict[str, list[Any]] | None = Field(default=None, description="Columns, time first.")


class SceneEntry(View):
    """One scene of the catalogue."""

    name: str
    path: str
    summary: str
    outputs: list[str]
    example: dict[str, Any]


class Scenes(View):
    """The catalogue of scenes."""

    signature: dict[str, str]
    scenes: list[SceneEntry]


EXAMPLES: Mapping[str, Mapping[str, Example]] = {
    "unwinding-shafts": {
        "tension": Example(
            "the tension and accelerations of two solid shafts",
            {
                "masses": [2.0, 1.0],
                "radii": [0.1, 0.2],
                "slopes": [0.5, 0.9],
                "gravity": 9.81,
                "outputs": ["tension", "accelerations", "angular_accelerations"],
            },
        ),
        "motion": Example(
            "the motion until the string of one shaft has unwound",
            {
                "masses": [2.0, 1.0],
                "radii": [0.1, 0.2],
                "slopes": [0.5, 0.9],
                "gravity": 9.81,
                "positions": [1.0, 1.5],
                "wound": [0.5, 0.8],
                "times": {"start": 0.0, "stop": 2.0, "count": 21},
            },
        ),
    },
    "rod-in-hole": {
        "horizontal": Example(
            "how fast the rod turns when it is horizontal",
            {
                "hole_radius": 1.0,
                "length": 1.0,
                "mass": 1.0,
                "gravity": 9.81,
                "outputs": ["angular_velocity_at_horizontal", "period", "contact"],
            },
        ),
        "motion": Example(
            "one swing with the forces of the wall",
            {
                "hole_radius": 1.0,
                "length": 1.0,
                "mass": 1.0,
                "gravity": 9.81,
                "times": {"start": 0.0, "stop": 2.0, "count": 21},
            },
        ),
    },
    "chain-on-wedge": {
        "motion": Example(
            "a heavy chain that slides over the apex",
            {
                "masses": [1.0, 1.2],
                "slopes": [0.6, 0.8],
                "gravity": 9.81,
                "length": 2.0,
                "linear_density": 0.5,
                "position": 1.0,
                "velocity": 0.0,
                "times": {"start": 0.0, "stop": 0.5, "count": 11},
            },
        ),
    },
}


WARMING: Mapping[str, tuple[Mapping[str, Any], ...]] = {
    # A rod that comes to rest upright, and never arrives.
    "rod-in-hole": (
        {
            "hole_radius": 5.0,
            "length": 6.0,
            "mass": 1.0,
            "gravity": 25.0,
            "inertia_factor": 0.25,
            "hole": "cylinder",
            "angle": 0.0,
            "angular_velocity": 4.0,
            "times": [1.0],
        },
    ),
}


def members() -> tuple[type[ConstrainedSystem], ...]:
    """Return the scenes of core's catalogue."""
    return cast(tuple[type[ConstrainedSystem], ...], members_of(Scene))


def name_of(scene: type[ConstrainedSystem]) -> str:
    """Return the name by which requests tell a scene apart."""
    return str(scene.__dict__["kind"])


def summary_of(scene: type[ConstrainedSystem]) -> str:
    """Return the first sentence of a scene's documentation."""
    return (scene.__doc__ or "").splitlines()[0].rstrip(".")


def request_of(scene: type[ConstrainedSystem]) -> type[Request]:
    """Return the request that has the scene's own fields, and beside them what is asked of it."""
    hints = get_type_hints(scene, include_extras=True)
    own: dict[str, Any] = {}
    for entry in fields(scene):
        default = ... if entry.default is MISSING else entry.default
        own[entry.name] = (hints[entry.name], default)
    # Built by a call, because a type made of names that are only known here is no type to the checker.
    outputs: Any = Literal.__getitem__(tuple(scene.outputs))
    listed: Any = list.__class_getitem__(outputs)
    own["times"] = (
        Times | None,
        TIMES,
    )
    own["outputs"] = (
        listed | None,
        OUTPUTS,
    )
    own["round"] = (Digits | None, DIGITS)
    own["accuracy"] = (Tolerance, Field(default=1e-9, description="Largest tolerated relative error."))
    title = "".join(part.capitalize() for part in name_of(scene).split("-")) + "Request"
    made: type[Request] = create_model(title, __base__=Request, __doc__=scene.__doc__, **own)
    return made


def answering(scene: type[ConstrainedSystem]) -> Callable[[Any, Budget], Answer]:
    """Return what answers a question about a scene."""
    names = tuple(entry.name for entry in fields(scene))

    def answer(question: Any, budget: Budget) -> Answer:
        system = scene(**{name: getattr(question, name) for name in names})
        times = None if question.times is None else sample_times(question.times, budget)
        wanted = None if question.outputs is None else frozenset(question.outputs)
        found = system.answer(times, wanted, question.accuracy)
        written: Answer = {
            "model": found.model,
            "accuracy": found.accuracy,
            "work": found.work,
            "requested_samples": found.requested_samples,
            "ended": found.ended,
            **found.figures,
            "warnings": found.warnings,
        }
        if found.trajectory is not None:
            written["trajectory"] = dict(found.trajectory)
            if question.round is not None:
                written |= _shortened(found, question.round)
        return written

    return answer


def _shortened(found: SceneFound, digits: Digits) -> Answer:
    """Return the fields of an answer that change where its columns, but not the times, are rounded."""
    columns, added = {}, 0.0
    for name, column in (found.trajectory or {}).items():
        if name == "time":
            columns[name] = column
        else:
            columns[name], more = rounded(column, digits, found.accuracy.error)
            added = max(added, more)
    warnings = (*found.warnings, *notices_of(found.accuracy, added))
    return {"trajectory": columns, "accuracy": covering(found.accuracy, added), "warnings": warnings}


def scene_counts(question: Any, budget: Budget) -> dict[str, float]:
    """Return what is counted of a scene."""
    samples = 0 if question.times is None else sample_count(question.times, budget)
    figures = 1.0 if question.outputs is None else len(question.outputs) / 10.0
    return {
        "question": 1.0,
        "figures": figures,
        "motions": float(samples > 0),
        "times": samples,
        **numbers(samples, question.round),
    }


def scene_probe(question: Any) -> Any:
    """Return the question about the earliest and the latest time alone."""
    if question.times is None:
        return question
    times = question.times if isinstance(question.times, list) else [question.times.start, question.times.stop]
    return question.model_copy(update={"times": [min(times), max(times)], "round": None})


def questions() -> tuple[PostRoute, ...]:
    """Return one route for each scene."""
    return tuple(
        PostRoute(
            f"/v1/scenes/{name_of(scene)}",
            "scene_" + name_of(scene).replace("-", "_"),
            summary_of(scene),
            "scenes",
            request_of(scene),
            SceneAnswer,
            answering(scene),
            CalibratedCost("scene_" + name_of(scene).replace("-", "_"), scene_counts),
            lambda question: question.times is None or few_times(question.times),
            scene_probe,
            examples=EXAMPLES[name_of(scene)],
            warming=WARMING.get(name_of(scene), ()),
        )
        for scene in members()
    )


@cache
def catalogue() -> Reply:
    """Return the catalogue of scenes as it is published."""
    entries = [
        {
            "name": name_of(scene),
            "path": f"/v1/scenes/{name_of(scene)}",
            "summary": summary_of(scene),
            "outputs": list(scene.outputs),
            "example": dict(next(iter(EXAMPLES[name_of(scene)].values())).question),
        }
        for scene in members()
    ]
    return Reply(orjson.dumps({"signature": SIGNATURE, "scenes": entries}))


CATALOGUE = GetRoute(
    "/v1/scenes", "list_scenes", "Every constrained scene and what it answers", "catalogues", catalogue, Scenes
)
