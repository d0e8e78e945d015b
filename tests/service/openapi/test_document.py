"""The OpenAPI document of any route table, and FastAPI's way to the dispatcher."""

from __future__ import annotations

import copy
import dataclasses
import json
from collections.abc import Iterator
from typing import Any

import pytest
from fastapi import FastAPI

from service import VERSION
from service.openapi.document import ABOUT, openapi, serve_routes
from service.problem_types import REGISTRY
from service.problems import MEDIA_TYPE
from service.routing import GetRoute, Reply, Route
from tests.service.conftest import client_of
from tests.service.toy_routes import GOOD, TOY, Told

pytestmark = pytest.mark.anyio

DRAWN = dataclasses.replace(
    TOY, path="/v1/drawn", operation_id="draw_toy", representations={"image/svg+xml": lambda answer: b"<svg/>"}
)
PAGE = GetRoute("/hello", "hello", "Says hello", "pages", lambda: Reply(b"{}"), Told, description="In full.")
TEXT = GetRoute("/plain", "plain", "A text", "pages", lambda: Reply(b"", b"text/plain"), media_type="text/plain")
ROUTES: tuple[Route, ...] = (TOY, DRAWN, PAGE, TEXT)


async def unasked(scope: Any, receive: Any, send: Any) -> None:
    raise AssertionError


def documented(handler: Any = unasked) -> FastAPI:
    app = FastAPI(**ABOUT)
    serve_routes(app, {(route.method, route.path): handler for route in ROUTES}, unasked)
    return app


@pytest.fixture(scope="module")
def document() -> dict[str, Any]:
    return openapi(ROUTES)


def within(node: Any) -> Iterator[dict[str, Any]]:
    """Yield every object of a document."""
    if isinstance(node, dict):
        yield node
    for entry in node.values() if isinstance(node, dict) else node if isinstance(node, list) else ():
        yield from within(entry)


class TestDocument:
    def test_it_is_plain_json_about_this_version(self, document: dict[str, Any]) -> None:
        assert json.loads(json.dumps(document, allow_nan=False)) == document
        assert (document["info"]["title"], document["info"]["version"]) == ("Polhode", VERSION)

    def test_every_route_is_there_as_the_table_has_it(self, document: dict[str, Any]) -> None:
        assert [*document["paths"]] == ["/v1/toy", "/v1/drawn", "/v1/drawn.svg", "/hello", "/plain"]
        for route in ROUTES:
            ((method, operation),) = document["paths"][route.path].items()
            assert method == route.method.lower()
            assert operation["operationId"] == route.operation_id
            assert (operation["summary"], operation["tags"]) == (route.summary, [route.tag])
            assert operation.get("description", "") == route.description

    def test_fields_with_a_default_are_described_and_not_given_one(self, document: dict[str, Any]) -> None:
        assert not [node for node in within(document["components"]) if "default" in node]
        assert (
            document["components"]["schemas"]["Ask"]["properties"]["behaviour"]["description"] == '"well" if left out.'
        )

    def test_questions_are_documented_with_their_examples(self, document: dict[str, Any]) -> None:
        body = document["paths"]["/v1/toy"]["post"]["requestBody"]
        assert body["required"]
        content = body["content"]["application/json"]
        assert content["schema"] == {"$ref": "#/components/schemas/Ask"}
        assert content["examples"] == {"small": {"summary": "three samples", "value": GOOD}}
        assert not [entry for entry in document["paths"]["/v1/toy"]["post"] if entry == "parameters"]

    def test_answers_are_documented_in_every_form_that_they_have(self, document: dict[str, Any]) -> None:
        for path in ("/v1/toy", "/v1/drawn"):
            content = document["paths"][path]["post"]["responses"]["200"]["content"]
            assert content == {"application/json": {"schema": {"$ref": "#/components/schemas/Told"}}}
        drawn = document["paths"]["/v1/drawn.svg"]["post"]
        assert drawn["operationId"] == "draw_toy_svg"
        assert drawn["responses"]["200"]["content"] == {"image/svg+xml": {"schema": {"type": "string"}}}
        assert drawn["requestBody"]["content"] == {"application/json": {"schema": {"$ref": "#/components/schemas/Ask"}}}
        assert set(document["paths"]["/hello"]["get"]["responses"]["200"]["content"]) == {"application/json"}
        assert set(document["paths"]["/plain"]["get"]["responses"]["200"]["content"]) == {"text/plain"}

    def test_problems_name_every_code_with_their_status(self, document: dict[str, Any]) -> None:
        responses = document["paths"]["/v1/toy"]["post"]["responses"]
        told = {
            code for status, one in responses.items() if status != "200" for code in codes(described(document, one))
        }
        # What depends on the path, the method or the name of the host alone belongs to no operation.
        assert set(REGISTRY) - told == {"not-found", "method-not-allowed", "results-not-ready", "unknown-host"}
        for verbs in document["paths"].values():
            for operation in verbs.values():
                for status, one in operation["responses"].items():
                    if int(status) >= 400:
                        problem = described(document, one)
                        assert {REGISTRY[code].status for code in codes(problem)} == {int(status)}
                        reference = {"schema": {"$ref": "#/components/schemas/ProblemDocument"}}
                        assert problem["content"] == {MEDIA_TYPE: reference}
        assert set(document["paths"]["/hello"]["get"]["responses"]) == {"200", "406", "500"}

    def test_keys_are_for_questions_and_may_be_left_out(self, document: dict[str, Any]) -> None:
        assert document["components"]["securitySchemes"]["key"]["scheme"] == "bearer"
        assert document["paths"]["/v1/toy"]["post"]["security"] == [{}, {"key": []}]
        assert "security" not in document["paths"]["/hello"]["get"]

    def test_every_reference_leads_somewhere(self, document: dict[str, Any]) -> None:
        references = {str(node["$ref"]) for node in within(document) if "$ref" in node}
        references |= {
            reference
            for node in within(document)
            for reference in node.get("discriminator", {}).get("mapping", {}).values()
        }
        assert len(references) >= 5
        for reference in references:
            found: Any = document
            for step in reference.removeprefix("#/").split("/"):
                found = found[step]
            assert found

    def test_the_field_that_distinguishes_members_is_required(self, document: dict[str, Any]) -> None:
        schemas = document["components"]["schemas"]
        for name in ("Moments", "Points", "Nest"):
            assert "kind" in schemas[name]["required"]
            assert "default" not in schemas[name]["properties"]["kind"]
            assert schemas[name]["required"].count("kind") == 1

    def test_it_is_the_same_each_time(self, document: dict[str, Any]) -> None:
        once = copy.deepcopy(openapi(ROUTES))
        assert openapi(ROUTES) == once == document


def described(document: dict[str, Any], response: dict[str, Any]) -> dict[str, Any]:
    """Return the response that is written once among the components."""
    found: dict[str, Any] = document["components"]["responses"][response["$ref"].rsplit("/", 1)[1]]
    return found


def codes(response: dict[str, Any]) -> list[str]:
    """Return the codes that a response's description lists."""
    return str(response["description"]).removeprefix("Problem: ").removesuffix(".").split(", ")


class TestServing:
    async def test_every_route_is_served_by_the_dispatcher_unread(self) -> None:
        seen: list[tuple[str, bytes]] = []

        async def serve(scope: Any, receive: Any, send: Any) -> None:
            seen.append((scope["path"], (await receive())["body"]))
            await send({"type": "http.response.start", "status": 299, "headers": []})
            await send({"type": "http.response.body", "body": b"by the dispatcher"})

        async with client_of(documented(serve)) as client:
            for route in ROUTES:
                # Not even JSON: FastAPI must not have a say.
                response = await client.request(route.method, route.path, content=b"{")
                assert (response.status_code, response.content) == (299, b"by the dispatcher")
        assert seen == [(route.path, b"{") for route in ROUTES]

    async def test_it_has_no_pages_of_its_own(self) -> None:
        own = {route.path for route in documented().routes}  # type: ignore[attr-defined]
        assert own == {route.path for route in ROUTES}
