"""Members of a study of a described scene: the same bits as the same question by itself."""

from __future__ import annotations

import json
from typing import Any

import pytest

from core.systems.budget import Budget
from service.execution.worker import Terms
from service.requests.request_reader import Limits
from service.responses.json_rows import written
from service.routing import TABLE
from service.studies.task import opened
from tests.core.multibody.relations.sources import catalogue, without_search
from tests.service.test_variants import HANDLER, ROUTES, at

SCENES = ("ladder-leaves-wall", "physical-pendulum", "weight-lands", "spherical-pendulum", "elastic-pendulum")


@pytest.mark.parametrize("name", SCENES)
def test_a_member_has_the_bits_of_the_question_by_itself(name: str) -> None:
    request: dict[str, Any] = without_search(catalogue()[name])
    body = next(iter(request["bodies"]))
    masses = [1.0, 1.25]
    rows = (1, len(request["times"]) - 1)
    quantities = [f"/trajectory/columns/{body}.position/values/{row}/{i}" for row in rows for i in (0, 1)]
    study = {
        "question": {"path": "/v1/scenes", "request": request},
        "vary": [{"pointer": f"/bodies/{body}/mass", "values": masses}],
        "quantities": quantities,
    }
    block = opened(Terms(TABLE, Budget(), Limits(), 0), json.dumps(study).encode()).block(0, 2)
    route = ROUTES["/v1/scenes"]
    for mass, figures in zip(masses, block.figures, strict=True):
        request["bodies"][body]["mass"] = mass
        answer = json.loads(written(HANDLER.answer(route, HANDLER.read(route, json.dumps(request).encode()))))
        assert list(figures) == [at(answer, pointer) for pointer in quantities]
