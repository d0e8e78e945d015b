"""Every endpoint is asked its own examples, spoilt at random: it answers or refuses, and never fails.

The environment variable POLHODE_FUZZ is the number of questions for each endpoint.
"""

from __future__ import annotations

import copy
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

EXAMPLES = int(os.environ.get("POLHODE_FUZZ", "12"))
SERVICE = inline_service(max_samples=500, max_evaluations=20_000)
QUESTIONS = [route for route in SERVICE.table if isinstance(route, PostRoute)]

NUMBERS = [
    0,
    -0.0,
    1,
    -1,
    1e-300,
    5e-324,
    1e300,
    -1e300,
    1e154,
    1e-160,
    1.7976931348623157e308,
    2**53 + 1,
    3.5,
    1e9,
    -7,
]
OTHERS: list[Any] = [None, True, "", "meaningful", "NaN", [], {}, [1.0, 2.0, 3.0], [[1, 2, 3]], {"kind": "ball"}, "1e5"]
VALUES = st.one_of(
    st.sampled_from(NUMBERS),
    st.floats(allow_nan=False, allow_infinity=False),
    st.integers(-5, 200),
    st.sampled_from(OTHERS),
)
SPOILS = st.lists(
    st.tuples(st.integers(0, 10_000), st.sampled_from(["set", "set", "scale", "drop", "twin", "rename"]), VALUES),
    min_size=1,
    max_size=4,
)


def places(node: Any) -> list[tuple[Any, Any]]:
    """Return every (container, key) of a document."""
    keys = list(node) if isinstance(node, dict) else list(range(len(node))) if isinstance(node, list) else []
    found = [(node, key) for key in keys]
    for key in keys:
        found += places(node[key])
    return found


def spoilt(question: Any, spoils: list[tuple[int, str, Any]]) -> Any:
    """Return a question with a few changes."""
    document = json.loads(json.dumps(question))
    for where, how, value in spoils:
        choices = places(document)
        if not choices:
            break
        container, key = choices[where % len(choices)]
        old = container[key]
        number = isinstance(old, (int, float)) and isinstance(value, (int, float))
        if how == "drop":
            del container[key]
        elif how == "twin" and isinstance(container, list):
            container.insert(key, copy.deepcopy(old))
        elif how == "rename" and isinstance(container, dict):
            container[f"{key}s"] = container.pop(key)
        elif how == "scale" and number and abs(product := float(old) * float(value)) < 1e308:
            container[key] = product
        else:
            container[key] = copy.deepcopy(value)
    return document


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
