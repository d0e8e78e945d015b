"""Constrained scenes to any number of digits: for each member of core's catalogue, its own fields as numerals."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from functools import cache
from typing import Any, Literal

from pydantic import ConfigDict, Field, create_model

from core.certified.scenes import certified_scene, exact_scene
from core.errors import InvalidParameter
from core.scenes.answer import ConstrainedSystem
from core.systems.budget import Budget
from core.systems.trajectory import Work
from service.requests.decimal_models import DigitCount, TimesInNumerals, explicit_fields, fields_in_numerals, instants
from service.routes.certified.questions import (
    AccuracyInDigits,
    CertifiedCost,
    Cost,
    InDigits,
    PerSample,
    accuracy,
    affordable,
    ends,
    times_written,
)
from service.routes.rotation.trajectory import ModelView, WorkView
from service.routes.scenes import OUTPUTS, TIMES, members, name_of
from service.routing import Answer, Example
from service.schemas import Envelope, Request

COLUMNS = 8
"""Numbers in a sample, at most."""

QUESTION = ("times", "outputs", "digits")
"""What is asked of a scene, beside the fields that are its own."""

ELEMENTARY = PerSample(1.1e-5, 3e-8, 1e-10)
SAMPLES: Mapping[str, PerSample] = {"rod-in-hole": PerSample(4.5e-5, 1.5e-7, 1.5e-9)}
"""Scenes with elliptic functions; the others are elementary."""

WRITTEN: Mapping[str, int] = {"rod-in-hole": 5, "chain-on-wedge": 4}
"""Numbers that are written of a sample, its time among them, where they are not as many as may be."""

EXAMPLES: Mapping[str, Mapping[str, Any]] = {
    "unwinding-shafts": {
        "masses": ["2", "1"],
        "radii": ["0.1", "0.2"],
        "slopes": ["0.5", "0.9"],
        "gravity": "9.81",
        "outputs": ["tension", "accelerations"],
        "digits": 50,
    },
    "rod-in-hole": {
        "hole_radius": "1",
        "length": "1",
        "mass": "1",
        "gravity": "9.81",
        "times": {"start": "0", "stop": "2", "count": 5},
        "digits": 50,
    },
    "chain-on-wedge": {
        "masses": ["1", "1.2"],
        "slopes": ["0.6", "0.8"],
        "gravity": "9.81",
        "length": "2",
        "linear_density": "0.5",
        "position": "1",
        "times": ["0.1", "0.2"],
        "digits": 50,
    },
}


class SceneAnswerInDigits(Envelope):
    """What was asked for of a scene, each figure under its own name, numbers as decimal strings."""

    model_config = ConfigDict(extra="allow")

    model: ModelView
    accuracy: AccuracyInDigits
    work: WorkView
    requested_samples: int = Field(description="Samples asked for; work.samples counts those that exist.")
    ended: str | None = Field(
        description="horizon, or the event that ended the motion; null if no motion was asked for."
    )
    trajectory: dict[str, list[Any]] | None = Field(default=None, description="Columns, time first.")


def request_of(scene: type[ConstrainedSystem]) -> type[Request]:
    """Return the request that has the scene's own fields as numerals, and beside them what is asked of it."""
    own = fields_in_numerals(scene)
    # Built by a call, because a type made of names that are only known here is no type to the checker.
    outputs: Any = list.__class_getitem__(Literal.__getitem__(tuple(scene.outputs)))
    own["times"] = (
        TimesInNumerals | None,
        TIMES,
    )
    own["outputs"] = (
        outputs | None,
        OUTPUTS,
    )
    own["digits"] = (DigitCount, ...)
    title = "".join(part.capitalize() for part in name_of(scene).split("-")) + "InDigits"
    made: type[Request] = create_model(title, __base__=Request, __doc__=scene.__doc__, **own)
    return made


def answering(scene: type[ConstrainedSystem]) -> Callable[[Any, Budget], Answer]:
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
        fields: Answer = {
            "model": found.model,
            "accuracy": accuracy(digits),
            "work": Work(0 if found.trajectory is None else len(found.trajectory["time"])),
            "requested_samples": samples,
            "ended": found.ended,
            **found.figures,
            "warnings": found.warnings,
        }
        if found.trajectory is not None:
            columns = dict(found.trajectory)
            fields["trajectory"] = columns | {"time": times_written(columns["time"], digits)}
        return fields

    return answer


def _samples(question: Any, budget: Budget) -> int:
    return 0 if question.times is None else affordable(question.times, question.digits, COLUMNS, budget)


def planning_probe(question: Any) -> Any:
    """Return the question about the earliest and the latest time alone."""
    return question if question.times is None else question.model_copy(update={"times": list(ends(question.times))})


@cache
def scenes_in_digits() -> Mapping[str, InDigits]:
    """Return by path what is asked and answered of each scene where a question has ``digits``."""
    return {f"/v1/scenes/{name_of(scene)}": _in_digits(scene) for scene in members()}


def _in_digits(scene: type[ConstrainedSystem]) -> InDigits:
    each = SAMPLES.get(name_of(scene), ELEMENTARY)

    def cost(question: Any, budget: Budget) -> Cost:
        return Cost(_samples(question, budget), WRITTEN.get(name_of(scene), COLUMNS), each)

    example = Example("50 digits, every one of them proven", EXAMPLES[name_of(scene)])
    return InDigits(
        request_of(scene),
        SceneAnswerInDigits,
        answering(scene),
        CertifiedCost(cost),
        planning_probe,
        {"digits": example},
    )
