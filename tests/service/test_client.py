import httpx
import numpy as np
import orjson
import pytest

from core.bodies import PrincipalMoments
from service.client import Client, Refused


def answering(*responses: httpx.Response, key: str | None = None) -> tuple[Client, list[httpx.Request]]:
    asked: list[httpx.Request] = []
    remaining = iter(responses)

    def handler(request: httpx.Request) -> httpx.Response:
        asked.append(request)
        return next(remaining)

    return Client("http://test", key=key, transport=httpx.MockTransport(handler)), asked


def test_objects_and_arrays_are_written_as_the_wire_wants_them() -> None:
    client, asked = answering(httpx.Response(200, json={"model": {}}))
    with client:
        client.trajectory(
            PrincipalMoments((1.0, 2.0, 3.0)), np.array([1.0, 2.0, 3.0]), np.linspace(0, 1, 3), accuracy=1e-6
        )
    assert asked[0].url.path == "/v1/rotation/trajectory"
    assert orjson.loads(asked[0].content) == {
        "body": {"moments": [1.0, 2.0, 3.0], "kind": "principal-moments"},
        "angular_velocity": [1.0, 2.0, 3.0],
        "times": [0.0, 0.5, 1.0],
        "accuracy": 1e-6,
    }


def test_problems_are_raised() -> None:
    problem = {"status": 422, "code": "invalid-parameter", "detail": "no", "title": "t"}
    client, _ = answering(httpx.Response(422, json=problem))
    with pytest.raises(Refused, match="no") as caught:
        client.mass_properties({"kind": "ball"})
    assert (caught.value.status, caught.value.code, caught.value.problem) == (422, "invalid-parameter", problem)


def test_a_busy_service_is_asked_again() -> None:
    busy = httpx.Response(429, json={"status": 429, "code": "too-busy", "detail": "d"}, headers={"retry-after": "0"})
    client, asked = answering(busy, busy, httpx.Response(200, json={"methods": []}))
    assert client.ask("/x", {}) == {"methods": []}
    assert len(asked) == 3


def test_a_key_is_sent() -> None:
    client, asked = answering(httpx.Response(200, json={"methods": []}), httpx.Response(200, json={}), key="secret")
    client.methods()
    client.mass_properties({"kind": "ball"})
    assert [request.headers["authorization"] for request in asked] == ["Bearer secret"] * 2
    client, asked = answering(httpx.Response(200, json={}))
    client.mass_properties({"kind": "ball"})
    assert "authorization" not in asked[0].headers


def test_patience_ends() -> None:
    busy = httpx.Response(429, json={"status": 429, "code": "too-busy", "detail": "d"}, headers={"retry-after": "60"})
    client, asked = answering(busy)
    with pytest.raises(Refused) as caught:
        client.ask("/x", {})
    assert caught.value.code == "too-busy"
    assert len(asked) == 1
