"""The OpenAPI document is docs/openapi.json, which ``python -m service --openapi > docs/openapi.json`` renews."""

from __future__ import annotations

import json
import re
from pathlib import Path
from typing import Any

import httpx
import jsonschema
import pytest

from service.app import create_app
from service.routing import PostRoute
from service.settings import Settings

SNAPSHOT = Path(__file__).parent.parent / "docs" / "openapi.json"
SERVICE = create_app(Settings(cached_answers=0, inline_seconds=1e9))
DOCUMENT: dict[str, Any] = json.loads(SERVICE.openapi_text())
QUESTIONS = [route for route in SERVICE.table if isinstance(route, PostRoute)]
EXAMPLES = [(route, name) for route in QUESTIONS for name in route.examples]


def test_the_document_is_the_committed_one() -> None:
    assert json.loads(SNAPSHOT.read_text()) == DOCUMENT, "run: python -m service --openapi > docs/openapi.json"


def test_operations_have_ids_and_problems() -> None:
    operations = [entry for verbs in DOCUMENT["paths"].values() for entry in verbs.values()]
    ids = [entry["operationId"] for entry in operations]
    assert len(set(ids)) == len(ids)
    for entry in operations:
        problems = [status for status in entry["responses"] if int(status) >= 400]
        assert problems
        for status in problems:
            assert list(entry["responses"][status]["content"]) == ["application/problem+json"]


def test_kinds_are_required_where_they_tell_members_of_a_union_apart() -> None:
    schemas = DOCUMENT["components"]["schemas"]
    bodies = schemas["MassPropertiesRequest"]["properties"]["body"]["discriminator"]["mapping"]
    assert len(bodies) > 1
    for reference in bodies.values():
        schema = schemas[reference.rsplit("/", 1)[1]]
        assert "kind" in schema["required"]
        assert "default" not in schema["properties"]["kind"]


def asked(name: str) -> dict[str, Any]:
    """Return the descriptions of the fields of a schema."""
    properties = DOCUMENT["components"]["schemas"][name]["properties"]
    return {field: entry.get("description") for field, entry in properties.items()}


def test_every_number_that_is_asked_for_is_described() -> None:
    schemas = DOCUMENT["components"]["schemas"]
    bodies = schemas["MassPropertiesRequest"]["properties"]["body"]["discriminator"]["mapping"].values()
    methods = schemas["TrajectoryRequest"]["properties"]["method"]["anyOf"][0]["discriminator"]["mapping"].values()
    scenes = [f"{name}{form}" for name in ("RodInHole", "ChainOnWedge", "UnwindingShafts") for form in ("Request",)]
    for name in [reference.rsplit("/", 1)[1] for reference in (*bodies, *methods)] + scenes:
        missing = [field for field, words in asked(name).items() if not words and field != "kind"]
        assert not missing, f"{name}: {missing}"


def test_descriptions_are_those_of_the_docstrings_with_their_units() -> None:
    assert asked("Ball") == {"radius": "(m).", "mass": "Not 0 (kg).", "density": "Not 0 (kg m^-3).", "kind": None}
    assert asked("BallInNumerals")["density"] == "Not 0 (kg m^-3)."
    assert "rad" in asked("RodInHoleRequest")["angle"]
    assert "rad" in asked("ChainOnWedgeRequest")["slopes"]
    assert asked("TrajectoryRequest")["angular_velocity"] == "At t = 0, in body axes (rad/s)."
    assert not [
        name
        for name, schema in DOCUMENT["components"]["schemas"].items()
        if re.search("(Attributes|Parameters).{1,3}--", str(schema))
    ]


def resolved(schema: dict[str, Any]) -> dict[str, Any]:
    return {**schema, "components": DOCUMENT["components"]}


@pytest.mark.anyio
@pytest.mark.parametrize(("route", "name"), EXAMPLES, ids=[f"{route.operation_id}: {name}" for route, name in EXAMPLES])
async def test_examples_run_and_fit_their_schemas(route: PostRoute, name: str) -> None:
    operation = DOCUMENT["paths"][route.path]["post"]
    question = operation["requestBody"]["content"]["application/json"]["examples"][name]["value"]
    jsonschema.validate(question, resolved(operation["requestBody"]["content"]["application/json"]["schema"]))
    async with httpx.AsyncClient(transport=httpx.ASGITransport(SERVICE), base_url="http://test") as client:
        response = await client.post(route.path, json=question)
    assert response.status_code == 200, response.text
    jsonschema.validate(
        response.json(), resolved(operation["responses"]["200"]["content"]["application/json"]["schema"])
    )


@pytest.mark.anyio
async def test_pages_fit_their_schemas() -> None:
    async with httpx.AsyncClient(transport=httpx.ASGITransport(SERVICE), base_url="http://test") as client:
        for path in ("/v1/errors", "/v1/methods", "/healthz"):
            schema = DOCUMENT["paths"][path]["get"]["responses"]["200"]["content"]["application/json"]["schema"]
            jsonschema.validate((await client.get(path)).json(), resolved(schema))
        problem = await client.post("/v1/bodies/mass-properties", json={})
        jsonschema.validate(problem.json(), resolved({"$ref": "#/components/schemas/ProblemDocument"}))


@pytest.fixture(scope="module")
def anyio_backend() -> str:
    return "asyncio"
