"""Catalogues: methods of integration, scenes, mistakes, and statically indeterminate and ill-posed problems."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import fields
from functools import cache
from typing import Any, cast

import orjson
from pydantic import Field

from core.assessment.catalogue import MISTAKES
from core.assessment.feedback.languages import LANGUAGES, Language, Sentence
from core.multibody.undecided import UNDECIDED, Code
from core.quantities import members_of
from core.systems.accuracy import record
from core.systems.methods import Method
from core.systems.methods.method import AbstractMethod, Family, Invariance
from service.problem_types import registry
from service.routes.described_answer import UNDECIDED_PATH
from service.routes.described_scenes import described_examples
from service.routes.scenes import SceneCatalogue, members, scene_entries
from service.routing import GetRoute, Reply
from service.schemas import SIGNATURE, Ratio, Signed, View


class ProblemEntry(View):
    """One entry of the registry of problems."""

    code: str = Field(description="Stable name for machines.")
    type: str = Field(description="URI reference that problems of this type carry.")
    status: int = Field(description="HTTP status.")
    title: str = Field(description="The same for every occurrence.")
    meaning: str = Field(description="When it happens and what to do about it.")


class ProblemRegistry(Signed):
    """The registry of problems."""

    errors: list[ProblemEntry]


class UndecidedEntry(View):
    """One kind of thing that is left undecided about a scene with contacts."""

    code: Code = Field(description="Stable name for machines.")
    type: str = Field(description="URI reference that problem carries in an answer.")
    title: str = Field(description="The same for every occurrence.")
    meaning: str
    of_mechanics: bool = Field(
        description="Whether the problem itself is indeterminate; otherwise it is a limit of the solver."
    )
    documentation: str = Field(description="Its section in the documentation, from the root of the repository.")


class UndecidedRegistry(Signed):
    """What can be left undecided about a scene with contacts."""

    undecided: list[UndecidedEntry]


class MethodRecord(View):
    """What a method with one setting was measured to do on problems with known solutions."""

    tolerance: Ratio[float] = Field(description="Setting of the method.")
    error: Ratio[float] = Field(description="Largest, relative to the largest norm of the motion.")
    evaluations: int = Field(description="Of the equation of motion.")


class MethodEntry(View):
    """One member of the catalogue of methods."""

    kind: str
    setting: str | None = Field(description="Name of the field that sets it: step (s) or tolerance.")
    order: int | None = Field(description="The error falls with this power of the step; null: no fixed order.")
    family: Family
    preserves: list[Invariance]
    between_steps: str = Field(description="How samples come about whose times lie between the ends of steps.")
    on_constraints: str = Field(description="How constraints, such as those of a described scene, are enforced.")
    when_to_use: str
    record: list[MethodRecord]


class MethodCatalogue(Signed):
    """The catalogue of methods."""

    methods: list[MethodEntry]


class MistakeEntry(View):
    """One mistake that is recognised in submitted answers."""

    tag: str = Field(description="Stable name for machines.")
    summary: str = Field(description="What was done.")
    feedback: dict[Language, str] = Field(description="Feedback for the student, by language; it gives no number.")
    credit: Ratio[float] = Field(description="Share of the score, unless the assessment's credits change it.")


class MistakeCatalogue(Signed):
    """The catalogue of recognised mistakes."""

    mistakes: list[MistakeEntry]


def mistakes() -> list[dict[str, Any]]:
    """Return the catalogue of recognised mistakes as it is published."""
    return [
        {
            "tag": entry.tag,
            "summary": entry.summary,
            "feedback": {language: Sentence(entry.tag).text(language) for language in LANGUAGES},
            "credit": entry.credit,
        }
        for entry in MISTAKES
    ]


def undecided() -> list[dict[str, Any]]:
    """Return what can be undecided as it is published."""
    return [
        {
            "code": kind.code,
            "type": f"{UNDECIDED_PATH}#{kind.code}",
            "title": kind.title,
            "meaning": kind.meaning,
            "of_mechanics": kind.of_mechanics,
            "documentation": kind.section,
        }
        for kind in UNDECIDED.values()
    ]


def methods() -> list[dict[str, Any]]:
    """Return the catalogue of the methods that are installed, as it is published."""
    measured: dict[str, list[dict[str, Any]]] = {}
    for entry in record():
        shown = {"tolerance": entry.tolerance, "error": entry.error, "evaluations": entry.evaluations}
        measured.setdefault(entry.kind, []).append(shown)
    members = cast(tuple[type[AbstractMethod], ...], members_of(Method))
    return [
        {
            "kind": member.kind,
            "setting": next((field.name for field in fields(cast(Any, member)) if field.name != "kind"), None),
            "order": member.order,
            "family": member.family,
            "preserves": member.preserves,
            "between_steps": member.between_steps,
            "on_constraints": member.on_constraints,
            "when_to_use": member.when_to_use,
            "record": sorted(measured.get(member.kind, []), key=lambda shown: shown["tolerance"]),
        }
        for member in members
        if member.is_installed()
    ]


def _catalogue(path: str, operation_id: str, summary: str, answer: type[Signed], build: Callable[[], Any]) -> GetRoute:
    """Return the route of a catalogue, which is built at the first request; its example has one entry."""
    name = path.rsplit("/", 1)[1]

    @cache
    def content() -> Reply:
        return Reply(orjson.dumps({"signature": SIGNATURE, name: build()}))

    def example() -> dict[str, Any]:
        return {"signature": SIGNATURE, name: build()[:1]}

    return GetRoute(path, operation_id, summary, "catalogues", content, answer, example=example)


def catalogues() -> tuple[GetRoute, ...]:
    """Return the catalogues' routes."""
    return (
        _catalogue("/v1/errors", "list_errors", "Every problem that can be answered", ProblemRegistry, registry),
        _catalogue(
            "/v1/methods",
            "list_methods",
            "Every method that can be chosen, and when to use it",
            MethodCatalogue,
            methods,
        ),
        _catalogue(
            "/v1/mistakes",
            "list_mistakes",
            "Every mistake that is recognised in submitted answers",
            MistakeCatalogue,
            mistakes,
        ),
        _catalogue(
            UNDECIDED_PATH,
            "list_undecided",
            "Everything that can be left undecided about a scene with contacts",
            UndecidedRegistry,
            undecided,
        ),
        _catalogue(
            "/v1/scenes",
            "list_scenes",
            "Every named scene and what it answers, and examples of described ones",
            SceneCatalogue,
            lambda: [*scene_entries(members()), *described_examples()],
        ),
    )
