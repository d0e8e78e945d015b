"""Questions about constrained scenes: one route for each member of core's catalogue, made from what it declares."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import MISSING, fields
from functools import cache
from typing import Any, Generic, Literal, cast, get_type_hints

from pydantic import Field, create_model

from core.quantities import Tolerance, members_of
from core.scenes import Scene
from core.scenes.figures import Errors, SceneEvent
from core.scenes.named_scene import NamedScene
from core.systems.budget import Budget
from core.systems.methods import Method
from core.systems.system import Model
from core.systems.trajectory import Work
from service.responses.svg import SVG
from service.routes.bodies import few_times
from service.routes.motion_figures import scene_drawing
from service.routes.rotation.trajectory import Accuracy, accuracy_fields
from service.routing import Answer, Example, PostRoute
from service.schemas import (
    ROUND,
    Envelope,
    N,
    Request,
    Rounding,
    Signed,
    Times,
    View,
    in_closed_form,
    sample_times,
)

TIMES: Any = Field(default=None, description="Measured from the given state, of either sign, in any order.")
METHOD: Any = Field(
    default=None,
    description="Computes the samples in place of the closed form, from which their error is measured, and is answered "
    "whatever that is. Events are those of the motion itself, and none but the last may interrupt it.",
)
OUTPUTS: Any = Field(default=None, min_length=1, description="What to compute; by default everything.")


class SceneAnswer(Envelope, Generic[N]):
    """The requested outputs of a scene; each figure is there if it is one of them."""

    model: Model
    method: str | None = Field(default=None, description="Kind of the method that was named, if one was.")
    work: Work
    requested_samples: int = Field(description="Number of requested times; work.samples counts the samples that exist.")
    ended: str | None = Field(description="horizon, or the event that ended the motion; null without times.")
    events: list[SceneEvent[N]] | None = Field(default=None, description="What happens from t = 0 on, in order.")


class SceneEntry(View):
    """One scene of the catalogue."""

    name: str = Field(description="Of a named scene the last step of the path.")
    path: str = Field(description="Where to send questions about it; described scenes go to /v1/scenes.")
    title: str = Field(description="As a gallery names it.")
    topic: str = Field(description="Under which a gallery lists it.")
    asks: str | None = Field(
        description="The question that its motion answers; null for scenes with endpoints of their own."
    )
    summary: str
    outputs: list[str] = Field(description="Names of what it answers.")
    example: dict[str, Any] = Field(description="A question.")


class SceneCatalogue(Signed):
    """The catalogue of scenes."""

    scenes: list[SceneEntry]


def members() -> tuple[type[NamedScene], ...]:
    """Return the scenes of core's catalogue."""
    return cast(tuple[type[NamedScene], ...], members_of(Scene))


def name_of(scene: type[NamedScene]) -> str:
    """Return the name of a scene, the last step of its path."""
    return str(scene.__dict__["kind"])


def operation_of(scene: type[NamedScene]) -> str:
    """Return the name of the operation that answers questions about a scene."""
    return "scene_" + name_of(scene).replace("-", "_")


def summary_of(scene: type[NamedScene]) -> str:
    """Return the first sentence of a scene's documentation."""
    return (scene.__doc__ or "").splitlines()[0].rstrip(".")


def request_model(scene: type[NamedScene], title: str, **own: Any) -> type[Request]:
    """Return the model of a question about a scene: fields of its own, and the outputs to choose from."""
    # Built by a call, because a type made of names that are only known here is no type to the checker.
    outputs: Any = list.__class_getitem__(Literal.__getitem__(tuple(scene.outputs)))
    made: type[Request] = create_model(
        f"{title}{scene.__name__}Request",
        __base__=Request,
        __doc__=scene.__doc__,
        outputs=(outputs | None, OUTPUTS),
        **own,
    )
    return made


def answer_model(scene: type[NamedScene], base: type[View], title: str, number: type) -> type[View]:
    """Return the model of an answer: the figures and columns that the scene declares, in one kind of number."""
    hints = get_type_hints(scene.figures_type, include_extras=True)
    own: dict[str, Any] = {name: (_in(hint, number) | None, None) for name, hint in hints.items()}
    samples = scene.samples_type.__class_getitem__(number)  # type: ignore[attr-defined]
    own["trajectory"] = (samples | None, Field(default=None, description="Of the times that the motion reaches."))
    docs = f"{scene.figures_type.__doc__}".replace("What ", "Figures: what ", 1)
    made: type[View] = create_model(f"{title}{scene.__name__}Answer", __base__=base, __doc__=docs, **own)
    return made


def _in(hint: Any, number: type) -> Any:
    """Return an annotation in one kind of number."""
    return hint[number] if getattr(hint, "__parameters__", ()) else hint


class SceneAnswerInDoubles(SceneAnswer[float]):
    """The requested outputs of a scene."""

    accuracy: Accuracy
    errors: Errors = Field(
        description="Bounds of the errors of figures by their names, of pairs one for each entry; null where the "
        "figure is. Objects have those of their own figures."
    )


def request_of(scene: type[NamedScene]) -> type[Request]:
    """Return the request that has the scene's own fields, and beside them times and options."""
    hints = get_type_hints(scene, include_extras=True)
    own: dict[str, Any] = {
        entry.name: (hints[entry.name], ... if entry.default is MISSING else entry.default) for entry in fields(scene)
    }
    own["times"] = (Times | None, TIMES)
    own["round"] = (Rounding | None, ROUND)
    own["accuracy"] = (Tolerance, Field(default=1e-9, description="Largest tolerated relative error."))
    own["method"] = (Method | None, METHOD)
    return request_model(scene, "", **own)


def _system(scene: type[NamedScene], question: Any) -> NamedScene:
    given = {entry.name: getattr(question, entry.name) for entry in fields(scene)}
    left_out = {name: value for name, value in scene.exact_defaults.items() if name not in question.model_fields_set}
    return scene(**given | left_out)


def answering(scene: type[NamedScene]) -> Callable[[Any, Budget], Answer]:
    """Return what answers a question about a scene."""

    def answer(question: Any, budget: Budget) -> Answer:
        system = _system(scene, question)
        times = None if question.times is None else sample_times(question.times, budget)
        wanted = None if question.outputs is None else frozenset(question.outputs)
        found = system.answer(times, wanted, question.accuracy, question.round, method=question.method, budget=budget)
        motion = found.trajectory
        requested = 0 if times is None else times.size
        samples = None if motion is None else {name: motion[name] for name in ("time", *motion.columns)}
        fields = answer_of(found, accuracy_fields(found.accuracy), found.work, requested, samples)
        fields = {**fields, "errors": found.errors}
        return fields if motion is None or question.method is None else fields | {"method": motion.method}

    return answer


def answer_of(
    found: Any, accuracy: Answer, work: Work, requested_samples: int, samples: Mapping[str, Any] | None
) -> Answer:
    """Return the fields of an answer that core has found, in either kind of number; `samples` are by column."""
    return {
        "model": found.model,
        "accuracy": accuracy,
        "work": work,
        "requested_samples": requested_samples,
        "ended": found.ended,
        **found.figures,
        "warnings": found.warnings,
        **({} if samples is None else {"trajectory": samples}),
    }


@cache
def scene_routes(scenes: tuple[type[NamedScene], ...]) -> tuple[PostRoute, ...]:
    """Return one route for each scene."""
    return tuple(map(_route, scenes))


def _route(scene: type[NamedScene]) -> PostRoute:
    answer = answer_model(scene, SceneAnswerInDoubles, "", float)
    return PostRoute(
        f"/v1/scenes/{name_of(scene)}",
        operation_of(scene),
        summary_of(scene),
        "scenes",
        request_of(scene),
        answer,
        answering(scene),
        lambda question: question.times is None or (few_times(question.times) and in_closed_form(question.method)),
        examples={name: Example(one.summary, one.question) for name, one in scene.examples.items()},
        warming=scene.warming,
        representations={SVG: scene_drawing(answer)},
    )


def scene_entries(scenes: tuple[type[NamedScene], ...]) -> list[dict[str, Any]]:
    """Return the catalogue of scenes as it is published."""
    return [
        {
            "name": name_of(scene),
            "path": f"/v1/scenes/{name_of(scene)}",
            "title": name_of(scene).replace("-", " ").capitalize(),
            "topic": "With endpoints of their own",
            "asks": None,
            "summary": summary_of(scene),
            "outputs": list(scene.outputs),
            "example": dict(next(iter(scene.examples.values())).question),
        }
        for scene in scenes
    ]
