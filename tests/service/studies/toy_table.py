"""The toys' route table with studies of them, and what the processes of a test's cluster import beforehand."""

from __future__ import annotations

from dataclasses import replace

import service.studies.task  # noqa: F401
from service.routes.studies import studying
from service.routing import PostRoute
from tests.service.toy_routes import TOY

TABLE = "tests.service.studies.toy_table:table"


def table() -> tuple[PostRoute, ...]:
    return TOY, replace(studying((TOY,)), small=lambda question: True)
