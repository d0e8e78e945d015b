"""Numpy archives: the same names and the same doubles as the JSON answer."""

from __future__ import annotations

import io
import json
from typing import Any
from zipfile import ZipFile

import httpx
import numpy as np
import pytest

from service.responses.npz import CHUNK, MEDIA_TYPE, METADATA, archive
from service.routing import PostRoute, StudyRoute
from tests.service.conftest import client_of, inline_service

SERVICE = inline_service()
# The answer to a study is what it will be, in JSON alone.
QUESTIONS = [route for route in SERVICE.table if isinstance(route, PostRoute) and not isinstance(route, StudyRoute)]
NPZ = {"accept": MEDIA_TYPE}

pytestmark = pytest.mark.anyio


def unpacked(content: bytes) -> Any:
    """Return the document of an archive with its arrays as lists, so that it can be compared with the JSON answer."""
    with np.load(io.BytesIO(content), allow_pickle=False) as members:
        metadata = json.loads(members[METADATA])
        used: set[str] = set()

        def filled(node: Any) -> Any:
            if isinstance(node, dict) and list(node) == ["array"]:
                used.add(node["array"])
                return members[node["array"]].tolist()
            if isinstance(node, dict):
                return {key: filled(entry) for key, entry in node.items()}
            return [filled(entry) for entry in node] if isinstance(node, list) else node

        document = filled(metadata)
        assert used | {METADATA} == set(members.files)
    return document


@pytest.mark.parametrize("route", QUESTIONS, ids=lambda route: route.operation_id)
async def test_every_example_says_the_same_both_ways(route: PostRoute) -> None:
    question = next(iter(route.examples.values())).question
    async with client_of(SERVICE) as client:
        plain = await client.post(route.path, json=dict(question))
        packed = await client.post(route.path, json=dict(question), headers=NPZ)
        again = await client.post(route.path, json=dict(question), headers=NPZ)
    assert packed.status_code == 200
    assert packed.headers["content-type"] == MEDIA_TYPE
    assert packed.headers["vary"] == "accept"
    assert packed.headers["etag"] != plain.headers["etag"]
    assert packed.content == again.content
    assert unpacked(packed.content) == plain.json()


async def test_arrays_are_under_their_own_names() -> None:
    question = {
        "body": {"kind": "principal-moments", "moments": [1.0, 2.0, 2.5]},
        "angular_velocity": [0.1, 1.0, 0.1],
        "times": {"start": 0.0, "stop": 10.0, "count": 100_000},
    }
    async with client_of(SERVICE) as client:
        response = await client.post("/v1/rotation/trajectory", json=question, headers=NPZ)
        etag = response.headers["etag"]
        known = await client.post("/v1/rotation/trajectory", json=question, headers=NPZ | {"if-none-match": etag})
    with np.load(io.BytesIO(response.content)) as members:
        assert members["angular_velocity"].shape == (100_000, 3)
        np.testing.assert_array_equal(members["time"], np.linspace(0.0, 10.0, 100_000))
        assert json.loads(members[METADATA])["signature"]["source"] == "polhode"
    assert (known.status_code, known.content) == (304, b"")


@pytest.mark.parametrize(
    ("accept", "media"),
    [
        ("application/json, application/x-npz", "application/json"),
        ("application/json;q=0.5, application/x-npz", MEDIA_TYPE),
        ("application/x-npz;q=0.2, */*;q=0.1", MEDIA_TYPE),
        ("application/*", "application/json"),
        ("application/x-npz;q=0, */*", "application/json"),
    ],
)
async def test_the_accept_header_chooses(accept: str, media: str) -> None:
    route = QUESTIONS[0]
    question = dict(next(iter(route.examples.values())).question)
    async with client_of(SERVICE) as client:
        response = await client.post(route.path, json=question, headers={"accept": accept})
    assert response.headers["content-type"] == media


async def test_problems_stay_json() -> None:
    async with client_of(SERVICE) as client:
        response: httpx.Response = await client.post(QUESTIONS[0].path, json={}, headers=NPZ)
    assert (response.status_code, response.headers["content-type"]) == (422, "application/problem+json")


def test_members_are_as_they_are_in_memory_and_pieces_are_small() -> None:
    rng = np.random.default_rng(7)
    answer = {
        "rows": rng.normal(size=(3, 50_000)).T,
        "deep": [{"faces": rng.integers(0, 9, (4, 3))}, {"faces": np.zeros((0, 3))}],
        "scalar": np.array(1.5),
    }
    pieces = list(archive(answer))
    assert max(map(len, pieces)) < CHUNK + 2048
    with np.load(io.BytesIO(b"".join(pieces))) as members:
        np.testing.assert_array_equal(members["rows"], answer["rows"])
        assert members["deep/0/faces"].dtype == np.int64
        assert members["deep/1/faces"].shape == (0, 3)
    with ZipFile(io.BytesIO(b"".join(pieces))) as file:
        assert file.testzip() is None
