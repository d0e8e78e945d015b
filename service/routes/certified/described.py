"""Described scenes to any number of digits: the start, and the motion where it can be proven."""

from __future__ import annotations

from typing import Annotated, Any, Literal

from pydantic import Field

from core.digits.adaptive_precision import check_digits
from core.multibody.proven.proven_answer import PROVEN_OUTPUTS, proven_answer
from core.systems.budget import Budget
from service.requests.decimal_models import DecimalTimes, DigitCount, instants
from service.requests.described_scene import SceneDescription
from service.responses.svg import SVG
from service.routes.certified.answers import Certified, accuracy, certified_route, times_written
from service.routes.described_answer import AtStart, OwnUnit
from service.routes.described_scenes import DESCRIBED_SCENES, model_fields
from service.routes.motion_figures import draw_described
from service.routing import Answer
from service.schemas import DecimalString, Seconds, View, fields_of, sample_count

NUMBERS_OF_A_BODY = 8
"""Numbers in a sample of a body, about."""

Output = Literal["accelerations", "forces", "energy", "trajectory"]


class CertifiedSceneRequest(SceneDescription):
    """Bodies, their connections, and the number of proven digits."""

    times: DecimalTimes | None = Field(
        default=None,
        description="Measured from the given state, of either sign, in any order. Motions with a closed form are "
        "proven at any time: constant accelerations, modes, uniform rotations, pendulums, Kepler orbits, free bodies "
        "whose axes are principal. Others are for some seconds; the more digits, the shorter.",
    )
    outputs: list[Output] | None = Field(
        default=None, min_length=1, description=f"What to answer; default: {', '.join(PROVEN_OUTPUTS)}."
    )
    digits: DigitCount


class CertifiedColumn(View):
    """One quantity at every time."""

    values: Annotated[list[DecimalString | list[DecimalString]], OwnUnit] = Field(description="One row per time.")
    unit: str


class CertifiedMotion(View):
    """Columns by name, such as rod.angle, at the times that the motion reaches."""

    time: list[Seconds[DecimalString]]
    rows: list[int] = Field(description="Which of the times of the question these are, from 0.")
    columns: dict[str, CertifiedColumn]


class CertifiedDescribedAnswer(Certified, AtStart[DecimalString]):
    """The requested answer about a scene, numbers as decimal strings."""

    ended: str | None = Field(description="horizon, or the kind of the event that ends the motion; null without times.")
    trajectory: CertifiedMotion | None = None


def answer_certified_scene(question: CertifiedSceneRequest, budget: Budget) -> Answer:
    """Answer a question about a described scene with proven digits."""
    digits = question.digits
    _samples(question, budget)
    times = () if question.times is None else instants(question.times)
    found = proven_answer(question.scene(), digits, times, question.outputs, audited=budget.audited)
    answer: Answer = {
        "model": _proven(model_fields(found.model)),
        "accuracy": accuracy(digits),
        "ended": found.ended,
        "warnings": found.warnings,
    }
    for name in ("accelerations", "forces"):
        figures = getattr(found, name)
        if figures is not None:
            answer[name] = {key: _proven(fields_of(one)) for key, one in figures.items()}
    if found.energy is not None:
        answer["energy"] = _proven(fields_of(found.energy))
    if found.columns is not None and found.rows is not None:
        answer["trajectory"] = {
            "time": times_written([times[row] for row in found.rows], digits),
            "rows": found.rows,
            "columns": {name: fields_of(column) for name, column in found.columns.items()},
        }
    return answer


def _proven(fields: Any) -> Any:
    """Return fields without those of errors, at any depth: every digit is proven."""
    if isinstance(fields, dict):
        return {name: _proven(value) for name, value in fields.items() if name not in ("error", "errors")}
    return [_proven(entry) for entry in fields] if isinstance(fields, list) else fields


def _samples(question: CertifiedSceneRequest, budget: Budget) -> int:
    if question.times is None:
        return 0
    samples = sample_count(question.times, budget)
    check_digits(question.digits, NUMBERS_OF_A_BODY * len(question.bodies) * samples)
    return samples


CERTIFIED_DESCRIBED = certified_route(
    DESCRIBED_SCENES[0],
    question=CertifiedSceneRequest,
    answer=CertifiedDescribedAnswer,
    handle=answer_certified_scene,
    description="Numbers of the description are the decimals that are written, unless `numbers` says otherwise; JSON "
    "numbers among the times are doubles, and decimal strings mean what they say.",
    representations={SVG: draw_described},
)
