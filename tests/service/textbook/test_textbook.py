"""Textbook questions asked backwards: every value is within its stated error of the closed form.

The quick ones are asked in every run, all of them by `make textbook`.
"""

from __future__ import annotations

import json
import os
from typing import Any

import pytest

from core.systems.budget import Budget
from service.execution.request_handler import RequestHandler
from service.requests.request_reader import Limits
from service.routes import questions
from tests.service.textbook.asked import Asked
from tests.service.textbook.contacts import CONTACTS
from tests.service.textbook.motion import MOTION
from tests.service.textbook.rotation import ROTATION
from tests.service.textbook.statics import STATICS

ALL = [*MOTION, *STATICS, *CONTACTS, *ROTATION]
WHOLE = bool(os.environ.get("WHOLE_TEXTBOOK"))
ROUTES = {route.path: route for route in questions()}
HANDLER = RequestHandler(ROUTES.values(), Budget(), Limits())
HALF_ULP = 2.0**-53
"""Of the expected value, which is rounded to a double."""


def found(one: Asked) -> Any:
    request = {"question": {"path": one.path, "request": one.request}, "vary": one.vary, "until": one.until}
    route = ROUTES["/v1/find"]
    return HANDLER.answer(route, HANDLER.read(route, json.dumps(request).encode()))


@pytest.mark.parametrize("one", [one for one in ALL if one.quick or WHOLE], ids=lambda one: str(one.name))
def test_what_must_it_be(one: Asked) -> None:
    answer = found(one)
    got = [(tuple(each["values"].values()), tuple(each["errors"].values())) for each in answer["solutions"]]
    expected = [tuple(map(float, values)) if isinstance(values, tuple) else (float(values),) for values in one.expected]
    assert len(got) == len(expected), (got, one.how)
    for (values, errors), right in zip(got, expected, strict=True):
        for value, error, true in zip(values, errors, right, strict=True):
            assert abs(value - true) <= error + HALF_ULP * abs(true), (value, error, true, one.how)
    if "equals" in one.until and len(expected) == 1 and answer["solutions"][0]["multiplicity"] == 1:
        assert answer["evaluations"] <= 30


def test_a_course_is_covered() -> None:
    assert len(ALL) >= 60
    assert len({one.name for one in ALL}) == len(ALL)
    assert sum(1 for one in ALL if one.quick) >= 15
