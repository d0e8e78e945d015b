"""What there is to choose from: methods of integration, and what can go wrong."""

from __future__ import annotations

from collections.abc import Callable
from functools import cache
from typing import Any

import orjson

from service.problems import registry
from service.routing import Page, Reply
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


def constant(build: Callable[[], Any]) -> Callable[[], Reply]:
    """Return a page's content that is built when it is first asked for."""

    @cache
    def content() -> Reply:
        return Reply(orjson.dumps({"signature": SIGNATURE, **build()}))

    return content


def catalogues() -> tuple[Page, ...]:
    """Return the catalogues' routes."""
    return (
        Page(
            "/v1/errors",
            "list_errors",
            "Every problem that can be answered",
            "catalogues",
            constant(lambda: {"errors": registry()}),
            Errors,
        ),
    )
