"""What there is to choose from: methods of integration, and what can go wrong."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import fields
from functools import cache
from typing import Any, cast

import orjson
from pydantic import Field

from core.quantities import members_of
from core.systems.accuracy import record
from core.systems.methods import Method
from core.systems.methods.method import AbstractMethod, Family, Invariance
from service.problems import registry
from service.routes.scenes import CATALOGUE
from service.routing import GetRoute, Reply
from service.schemas import SIGNATURE, View


class ProblemEntry(View):
    """One entry of the registry of problems."""

    code: str
    type: str
    status: int
    title: str
    meaning: str


class Errors(View):
    """The registry of problems."""

    signature: dict[str, str]
    errors: list[ProblemEntry]


class RecordView(View):
    """What a method with one setting was measured to do on problems with known solutions."""

    tolerance: float
    error: float = Field(description="Largest, relative to the largest norm of the motion.")
    evaluations: int


class MethodEntry(View):
    """One member of the catalogue of methods."""

    kind: str
    setting: str | None = Field(description="Name of the field that sets it: step (s) or tolerance.")
    order: int | None = Field(description="The error falls with this power of the step; null: no fixed order.")
    family: Family
    preserves: list[Invariance]
    between_steps: str = Field(description="How samples come about whose times lie between the ends of steps.")
    when_to_use: str
    record: list[RecordView]


class Methods(View):
    """The catalogue of methods."""

    signature: dict[str, str]
    methods: list[MethodEntry]


def methods() -> list[dict[str, Any]]:
    """Return the catalogue of methods as it is published."""
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
            "when_to_use": member.when_to_use,
            "record": sorted(measured.get(member.kind, []), key=lambda shown: shown["tolerance"]),
        }
        for member in members
    ]


def constant(build: Callable[[], Any]) -> Callable[[], Reply]:
    """Return a page's content that is built when it is first asked for."""

    @cache
    def content() -> Reply:
        return Reply(orjson.dumps({"signature": SIGNATURE, **build()}))

    return content


def catalogues() -> tuple[GetRoute, ...]:
    """Return the catalogues' routes."""
    return (
        GetRoute(
            "/v1/errors",
            "list_errors",
            "Every problem that can be answered",
            "catalogues",
            constant(lambda: {"errors": registry()}),
            Errors,
        ),
        GetRoute(
            "/v1/methods",
            "list_methods",
            "Every method that can be asked for, and when to use it",
            "catalogues",
            constant(lambda: {"methods": methods()}),
            Methods,
        ),
        CATALOGUE,
    )
