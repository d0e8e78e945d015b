"""Every endpoint is asked its own examples, spoilt at random: it answers or refuses, and never fails.

The environment variable POLHODE_FUZZ is the number of questions for each endpoint.
"""

from __future__ import annotations

import json
import os
from typing import Any

import anyio
import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from service.routing import PostRoute
from tests.service.conftest import inline_service
from tests.service.http.test_dispatch import receiving, scope, sending
from tests.service.spoilt_questions import NUMBERS, OTHERS, WAYS, spoilt

EXAMPLES = int(os.environ.get("POLHODE_FUZZ", "12"))
SERVICE = inline_service(max_samples=500, max_evaluations=20_000)
QUESTIONS = [route for route in SERVICE.table if isinstance(route, PostRoute)]

VALUES = st.one_of(
    st.sampled_from(NUMBERS),
    st.floats(allow_nan=False, allow_infinity=False),
    st.integers(-5, 200),
    st.sampled_from(OTHERS),
)
SPOILS = st.lists(
    st.tuples(st.integers(0, 10_000), st.sampled_from(WAYS), VALUES),
    min_size=1,
    max_size=4,
)


def refuse_constant(name: str) -> None:
    raise AssertionError(f"{name} in an answer")


@pytest.mark.filterwarnings("ignore::RuntimeWarning")
@pytest.mark.parametrize("route", QUESTIONS, ids=lambda route: route.operation_id)
@settings(
    max_examples=EXAMPLES,
    deadline=None,
    derandomize=EXAMPLES <= 12,
    suppress_health_check=[HealthCheck.too_slow],
)
@given(data=st.data())
def test_spoilt_questions_are_answered_or_refused(route: PostRoute, data: st.DataObject) -> None:
    name = data.draw(st.sampled_from(sorted(route.examples)))
    question = spoilt(route.examples[name].question, data.draw(SPOILS))
    messages: list[dict[str, Any]] = []

    async def run() -> None:
        body = json.dumps(question).encode()
        await SERVICE(
            scope("POST", route.path, {"content-type": "application/json"}), receiving(body), sending(messages)
        )

    anyio.run(run)
    content = b"".join(message["body"] for message in messages[1:])
    document = json.loads(content, parse_constant=refuse_constant)
    assert messages[0]["status"] in (200, 400, 422), (json.dumps(question), content[:500])
    if messages[0]["status"] != 200:
        assert len(content) <= 2048
        assert document["code"] != "internal-error"
