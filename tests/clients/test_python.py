"""The client of Python programs: its methods are the service's operations, its errors the service's problems."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import httpx
import numpy as np
import pytest
from polhode_client import Client, Refused

from core.bodies import PrincipalMoments
from service.routes import questions

DOCUMENT: dict[str, Any] = json.loads((Path(__file__).parents[2] / "docs" / "openapi.json").read_text())


def answering(*responses: httpx.Response, key: str | None = None) -> tuple[Client, list[httpx.Request]]:
    asked: list[httpx.Request] = []
    remaining = iter(responses)

    def handler(request: httpx.Request) -> httpx.Response:
        if request.url.path == "/openapi.json":
            return httpx.Response(200, json=DOCUMENT)
        asked.append(request)
        return next(remaining)

    return Client("http://test", key=key, transport=httpx.MockTransport(handler)), asked


def test_every_route_is_a_method_that_sends_its_question() -> None:
    for route in questions():
        client, asked = answering(httpx.Response(200, json={"signature": {}}))
        example = next(iter(route.examples.values())).question
        assert getattr(client, route.operation_id)(**example) == {"signature": {}}
        assert (asked[0].method, asked[0].url.path) == ("POST", route.path)
        assert json.loads(asked[0].content) == json.loads(json.dumps(example))
        assert route.operation_id in dir(client)


def test_documents_are_fetched_without_a_question() -> None:
    client, asked = answering(httpx.Response(200, json={"methods": []}))
    assert client.list_methods() == {"methods": []}
    assert (asked[0].method, asked[0].url.path) == ("GET", "/v1/methods")


def test_an_operation_that_there_is_not_is_no_attribute() -> None:
    client, _ = answering()
    with pytest.raises(AttributeError, match="no operation frobnicate"):
        client.frobnicate()
    # Pages for people are no operations.
    assert not {"get_start_page", "get_metrics"} & set(client.operations)


def test_objects_and_arrays_are_written_as_the_wire_wants_them() -> None:
    client, asked = answering(httpx.Response(200, json={"model": {}}))
    with client:
        client.rotation_trajectory(
            body=PrincipalMoments((1.0, 2.0, 3.0)),
            angular_velocity=np.array([1.0, 2.0, 3.0]),
            times=np.linspace(0, 1, 3),
            accuracy=np.float64(1e-6),
        )
    assert json.loads(asked[0].content) == {
        "body": {"moments": [1.0, 2.0, 3.0], "kind": "principal-moments"},
        "angular_velocity": [1.0, 2.0, 3.0],
        "times": [0.0, 0.5, 1.0],
        "accuracy": 1e-6,
    }


def test_problems_are_raised() -> None:
    problem = {"status": 422, "code": "invalid-parameter", "detail": "no", "title": "t"}
    client, _ = answering(httpx.Response(422, json=problem))
    with pytest.raises(Refused, match="no") as caught:
        client.mass_properties(body={"kind": "ball"})
    assert (caught.value.status, caught.value.code, caught.value.problem) == (422, "invalid-parameter", problem)


def test_a_busy_service_is_retried() -> None:
    busy = httpx.Response(429, json={"status": 429, "code": "too-busy", "detail": "d"}, headers={"retry-after": "0"})
    client, asked = answering(busy, busy, httpx.Response(200, json={"answer": 1}))
    assert client.post("/x", {}) == {"answer": 1}
    assert len(asked) == 3


def test_a_key_is_sent() -> None:
    client, asked = answering(httpx.Response(200, json={}), key="secret")
    client.post("/x", {})
    assert asked[0].headers["authorization"] == "Bearer secret"
    client, asked = answering(httpx.Response(200, json={}))
    client.post("/x", {})
    assert "authorization" not in asked[0].headers


def test_patience_ends() -> None:
    busy = httpx.Response(429, json={"status": 429, "code": "too-busy", "detail": "d"}, headers={"retry-after": "60"})
    client, asked = answering(busy)
    with pytest.raises(Refused) as caught:
        client.post("/x", {})
    assert caught.value.code == "too-busy"
    assert len(asked) == 1
