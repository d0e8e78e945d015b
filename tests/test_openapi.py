"""The OpenAPI document is docs/openapi.json, which ``python -m service --openapi > docs/openapi.json`` renews."""

from __future__ import annotations

import json
import re
from collections.abc import Iterator
from dataclasses import fields
from pathlib import Path
from typing import Any

import httpx
import jsonschema
import pytest

from core.quantities import members_of
from core.scenes import Scene
from service.routing import PostRoute, StudyRoute
from tests.service.conftest import inline_service

SNAPSHOT = Path(__file__).parent.parent / "docs" / "openapi.json"
SERVICE = inline_service()
DOCUMENT: dict[str, Any] = json.loads(SERVICE.openapi_text())
QUESTIONS = [route for route in SERVICE.table if isinstance(route, PostRoute)]
EXAMPLES = [(route, name) for route in QUESTIONS for name in route.examples]


def test_the_document_is_the_committed_one() -> None:
    assert json.loads(SNAPSHOT.read_text()) == DOCUMENT, "run: python -m service --openapi > docs/openapi.json"


def nodes(node: Any) -> Iterator[dict[str, Any]]:
    """Yield every object of a document."""
    if isinstance(node, dict):
        yield node
    for entry in node.values() if isinstance(node, dict) else node if isinstance(node, list) else ():
        yield from nodes(entry)


OPERATIONS = [entry for verbs in DOCUMENT["paths"].values() for entry in verbs.values()]
SCHEMAS = DOCUMENT["components"]["schemas"]


def test_operations_have_ids_and_problems() -> None:
    ids = [entry["operationId"] for entry in OPERATIONS]
    assert len(set(ids)) == len(ids)
    for entry in OPERATIONS:
        problems = [one for status, one in entry["responses"].items() if int(status) >= 400]
        assert problems
        for problem in problems:
            name = problem["$ref"].rsplit("/", 1)[1]
            assert list(DOCUMENT["components"]["responses"][name]["content"]) == ["application/problem+json"]


def test_an_operation_has_one_kind_of_answer() -> None:
    for entry in OPERATIONS:
        (status,) = (status for status in entry["responses"] if status.startswith("2"))
        assert len(entry["responses"][status]["content"]) == 1, entry["operationId"]


def test_it_is_served_compact() -> None:
    served = SERVICE.openapi_text()
    assert json.loads(served) == DOCUMENT
    assert len(served) == len(json.dumps(DOCUMENT, separators=(",", ":"), ensure_ascii=False).encode())


def test_a_client_learns_who_serves_it_under_which_licence() -> None:
    assert DOCUMENT["info"]["license"]["identifier"] == "Apache-2.0"
    assert DOCUMENT["info"]["contact"]["name"]
    assert DOCUMENT["servers"][0]["url"] == "/"


def test_every_json_operation_has_an_example() -> None:
    for entry in OPERATIONS:
        if "requestBody" in entry:
            # Other forms of an answer have the question of the operation before them.
            forms = [form for one in entry["responses"].values() for form in one.get("content", {})]
            assert "examples" in entry["requestBody"]["content"]["application/json"] or "application/json" not in forms
        elif content := entry["responses"]["200"]["content"].get("application/json"):
            assert content["example"], entry["operationId"]


def test_there_are_no_more_schemas_than_questions_and_answers_need() -> None:
    # Four of them are the named scenes and their friction, which a comparison of methods tells apart by kind; four are
    # the questions and answers of import and export, four the occasions at which connections begin and end.
    assert len(SCHEMAS) <= 147


def test_every_number_of_an_answer_has_its_unit() -> None:
    for name in [name for name in SCHEMAS if name.endswith("Answer")] + ["ProblemDocument"]:
        for node in nodes(SCHEMAS[name]):
            kinds = node.get("type", [])
            if {"number", "integer"} & ({kinds} if isinstance(kinds, str) else set(kinds)):
                assert "x-unit" in node, (name, node)
    for name in [name for name in SCHEMAS if name.startswith("Certified") and name.endswith("Answer")]:
        units = [node for node in nodes(SCHEMAS[name]) if "string" in str(node.get("type")) and "x-unit" in node]
        assert len(units) >= 4, name


@pytest.mark.parametrize("scene", members_of(Scene), ids=lambda scene: str(scene.__name__))
@pytest.mark.parametrize("form", ["", "Certified"])
def test_a_scene_answers_with_its_own_figures(scene: Any, form: str) -> None:
    properties = SCHEMAS[f"{form}{scene.__name__}Answer"]["properties"]
    assert set(scene.outputs) <= set(properties)
    columns = properties["trajectory"]["anyOf"][0]["properties"]
    assert set(columns) == {entry.name for entry in fields(scene.samples_type)}


def test_unions_of_objects_are_distinguished() -> None:
    for node in nodes(DOCUMENT):
        members = [
            m for m in (*node.get("oneOf", ()), *node.get("anyOf", ())) if "$ref" in m or m.get("type") == "object"
        ]
        assert len(members) <= 1 or "discriminator" in node, node


def test_what_a_problem_adds_is_in_its_schema() -> None:
    own = {"needed", "limit", "what", "requested", "achievable", "retry_after_seconds", "instance", "errors", "code"}
    assert own <= set(SCHEMAS["ProblemDocument"]["properties"])


def test_kinds_are_required_where_they_distinguish_members_of_a_union() -> None:
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


def test_every_number_that_is_requested_is_described() -> None:
    schemas = DOCUMENT["components"]["schemas"]
    bodies = schemas["MassPropertiesRequest"]["properties"]["body"]["discriminator"]["mapping"].values()
    methods = schemas["TrajectoryRequest"]["properties"]["method"]["anyOf"][0]["discriminator"]["mapping"].values()
    scenes = [f"{name}{form}" for name in ("RodInHole", "ChainOnWedge", "UnwindingShafts") for form in ("Request",)]
    for name in [reference.rsplit("/", 1)[1] for reference in (*bodies, *methods)] + scenes:
        missing = [field for field, words in asked(name).items() if not words and field != "kind"]
        assert not missing, f"{name}: {missing}"


def test_descriptions_are_those_of_the_docstrings_with_their_units() -> None:
    assert asked("Ball")["mass"] == "Given by this or by the density; not 0 (kg)."
    assert asked("RodInHoleRequest")["hole_radius"] == "Radius of the hole (m)."
    assert asked("UnwindingShaftsRequest")["masses"] == "Of the shafts (kg)."
    assert "rad" in asked("RodInHoleRequest")["angle"]
    assert "rad" in asked("ChainOnWedgeRequest")["slopes"]
    assert asked("TrajectoryRequest")["angular_velocity"] == "At t = 0, in body axes."
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
    status = 202 if isinstance(route, StudyRoute) else 200
    assert response.status_code == status, response.text
    jsonschema.validate(
        response.json(), resolved(operation["responses"][str(status)]["content"]["application/json"]["schema"])
    )


@pytest.mark.anyio
async def test_pages_fit_their_schemas() -> None:
    async with httpx.AsyncClient(transport=httpx.ASGITransport(SERVICE), base_url="http://test") as client:
        for path in ("/v1/errors", "/v1/methods", "/v1/mistakes", "/v1/undecided", "/healthz"):
            schema = DOCUMENT["paths"][path]["get"]["responses"]["200"]["content"]["application/json"]["schema"]
            jsonschema.validate((await client.get(path)).json(), resolved(schema))
        problem = await client.post("/v1/bodies/mass-properties", json={})
        jsonschema.validate(problem.json(), resolved({"$ref": "#/components/schemas/ProblemDocument"}))


@pytest.fixture(scope="module")
def anyio_backend() -> str:
    return "asyncio"
