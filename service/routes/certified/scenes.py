"""Constrained scenes to any number of digits: for each member of core's catalogue, its own fields as numerals."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from functools import cache
from typing import Any

from core.certified.scenes import certified_scene, exact_scene
from core.errors import InvalidParameter
from core.scenes.named_scene import NamedScene
from core.systems.budget import Budget
from core.systems.trajectory import Work
from service.requests.decimal_models import (
    DecimalTimes,
    DigitCount,
    explicit_fields,
    fields_in_numerals,
    instants,
)
from service.responses.svg import SVG
from service.routes.certified.answers import Certified, accuracy, certified_route, samples_of, times_written
from service.routes.motion_figures import scene_drawing
from service.routes.scenes import (
    TIMES,
    SceneAnswer,
    answer_model,
    answer_of,
    request_model,
    scene_routes,
)
from service.routing import Answer, Example, PostRoute
from service.schemas import DecimalString

COLUMNS = 8
"""Numbers in a sample, at most."""

QUESTION = ("times", "outputs", "digits")
"""Fields of a question that are not the scene's own."""


SHOWN_DIGITS = 50
"""Digits of the examples."""


def answering(scene: type[NamedScene]) -> Callable[[Any, Budget], Answer]:
    """Return what answers a question about a scene."""

    def answer(question: Any, budget: Budget) -> Answer:
        digits = question.digits
        samples = _samples(question, budget)
        system = exact_scene(scene, explicit_fields(question, *QUESTION))
        times = None if question.times is None else instants(question.times)
        wanted = None if question.outputs is None else frozenset(question.outputs)
        try:
            found = certified_scene(system, digits, times, wanted)
        except InvalidParameter as fault:
            if fault.path[:1] == ("times",) and not isinstance(question.times, list):
                # Evenly spaced times have no entries to point at.
                raise InvalidParameter("times", fault.rule, remedy=fault.remedy) from None
            raise
        work = Work(0 if found.trajectory is None else len(found.trajectory["time"]))
        motion = found.trajectory
        shown = None if motion is None else {**motion, "time": times_written(motion["time"], digits)}
        return answer_of(found, accuracy(digits), work, samples, shown)

    return answer


def _samples(question: Any, budget: Budget) -> int:
    return 0 if question.times is None else samples_of(question.times, question.digits, COLUMNS, budget)


class CertifiedSceneAnswer(Certified, SceneAnswer[DecimalString]):
    """The requested outputs of a scene, numbers as decimal strings."""


@cache
def certified_scenes(scenes: tuple[type[NamedScene], ...]) -> tuple[PostRoute, ...]:
    """Return one route for each scene."""
    return tuple(map(_route, scene_routes(scenes), scenes))


def _route(ordinary: PostRoute, scene: type[NamedScene]) -> PostRoute:
    *_, shown = scene.examples.values()

    own = fields_in_numerals(scene) | {"times": (DecimalTimes | None, TIMES), "digits": (DigitCount, ...)}
    answer = answer_model(scene, CertifiedSceneAnswer, "Certified", DecimalString)
    return certified_route(
        ordinary,
        question=request_model(scene, "Certified", **own),
        answer=answer,
        handle=answering(scene),
        examples={
            "digits": Example(f"{SHOWN_DIGITS} proven digits", in_decimals(shown.question) | {"digits": SHOWN_DIGITS})
        },
        representations={SVG: scene_drawing(answer)},
    )


def in_decimals(value: Any) -> Any:
    """Return a question with its doubles as the shortest decimal strings that read as them."""
    if isinstance(value, Mapping):
        return {name: in_decimals(entry) for name, entry in value.items()}
    if isinstance(value, list):
        return [in_decimals(entry) for entry in value]
    return repr(value).removesuffix(".0") if isinstance(value, float) else value
