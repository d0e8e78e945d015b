"""The OpenAPI document of the route table, and how FastAPI comes to serve the table."""

from __future__ import annotations

import re
from collections.abc import Collection, Iterator, Mapping, Sequence
from http import HTTPStatus
from typing import Any

from fastapi import FastAPI, Request
from pydantic import TypeAdapter
from starlette.responses import Response
from starlette.routing import Route as Endpoint
from starlette.types import ASGIApp

from core import bodies
from core.quantities import members_of
from service import VERSION
from service.http.deprecation import DEPRECATED
from service.openapi import components
from service.openapi.descriptions import describe
from service.problem_types import REGISTRY
from service.problems import MEDIA_TYPE
from service.responses.svg import SVG
from service.routing import PostRoute, ResourceRoute, Route, StudyRoute
from service.schemas import ProblemDocument

DESCRIPTION = """\
The motion of rigid bodies and small constrained scenes, and how accurate each answer is.

SI units, radians. Vectors are [x, y, z], matrices are written row by row, quaternions [w, x, y, z] turn body into
space. Body axes are the axes in which the body was defined. Times are measured from the given state. Arrays of samples
are rows. Every number is a finite double; a derived figure outside the range of doubles is null, with a warning.

`/v1/certified/...` answers the closed-form questions to any number of `digits` (16 to 1000): every number of the answer
is a decimal string whose digits are proven, and numbers of the question may be decimal strings too ("0.1" is one tenth,
0.1 a double).

Answers are JSON. Every path that answers a question also exists with the ending `.npz`, whose answer is a numpy archive
with the same names and the rest as JSON in metadata.json; `Accept: application/x-npz` on the path itself has the same
effect, as `Accept` has for the other endings. A question may be sent as such an archive, too
(`Content-Type: application/x-npz`): metadata.json is the document, in which `{"array": "positions"}` stands for the
array of the member positions.npy. To `/v1/fits` the data may be sent as a file beside the request
(`multipart/form-data`): the part `request` is the document without `data/columns`, the part `columns` a CSV table with
the names of the columns in its first line, or a numpy archive with an array for each.

Refusals are application/problem+json (RFC 9457) with a stable code and JSON pointers into the document that was sent.
"""

_PROBLEMS_OF_QUESTIONS = (400, 401, 406, 408, 413, 415, 422, 429, 500, 501, 503)

_PROBLEMS_OF_RESOURCES = (401, 404, 406, 422, 429, 500, 503)

PREFER = {
    "name": "Prefer",
    "in": "header",
    "required": False,
    "description": "respond-async: the answer is computed in the background and is the result of a study. The response "
    "is 202 with its state, as that of POST /v1/studies.",
    "schema": {"type": "string", "title": "Prefer"},
}

REPEATED = {
    "name": "Idempotency-Key",
    "in": "header",
    "required": False,
    "description": "A name of the client's own for this request. A request that is repeated with the name is answered "
    "with the study of the first, as long as that exists.",
    "schema": {"type": "string", "title": "IdempotencyKey", "maxLength": 255},
}

ABOUT: Mapping[str, Any] = {
    "title": "Polhode",
    "version": VERSION,
    "description": DESCRIPTION,
    "openapi_url": None,
    "docs_url": None,
    "redoc_url": None,
    "redirect_slashes": False,
}
"""Arguments of the FastAPI application."""


class _Dispatched(Response):
    """A response that lets the dispatcher answer."""

    def __init__(self, handler: ASGIApp) -> None:
        super().__init__()
        self._handler = handler

    async def __call__(self, scope: Any, receive: Any, send: Any) -> None:
        await self._handler(scope, receive, send)


PHRASES = {413: "Request Entity Too Large", 422: "Unprocessable Entity"}
"""Of statuses that Python calls otherwise from 3.13 on: names of the document do not depend on who writes it."""


def serve_routes(app: FastAPI, handlers: Mapping[tuple[str, str], ASGIApp], unrouted: ASGIApp) -> None:
    """Give FastAPI the handlers by method and path, and what answers where none of them fits."""
    for (method, path), handler in handlers.items():
        endpoint = Endpoint(path, unrouted, include_in_schema=False)
        # An endpoint that is a function would be given a request, and not what an ASGI application is.
        endpoint.app, endpoint.methods = handler, {method}
        app.router.routes.append(endpoint)

    async def refuse(request: Request, error: Exception) -> Response:
        return _Dispatched(unrouted)

    app.add_exception_handler(404, refuse)
    app.add_exception_handler(405, refuse)


def openapi(routes: Sequence[Route]) -> dict[str, Any]:
    """Return the OpenAPI document."""
    shown = [route for route in routes if isinstance(route, PostRoute) or route.documented]
    schemas, named = _schemas(shown)
    later = {path for route in shown if isinstance(route, StudyRoute) for path in route.paths}
    paths: dict[str, Any] = {}
    for route in shown:
        operation = _operation(route, schemas, later)
        paths.setdefault(route.path, {})[route.method.lower()] = operation
        for media, ending in route.endings.items():
            paths[route.path + ending] = {route.method.lower(): _in_form(operation, media, ending)}
    problem = ProblemDocument.model_json_schema(ref_template=components.PREFIX + "{model}")
    document: dict[str, Any] = {
        "openapi": "3.1.0",
        "info": {
            "title": ABOUT["title"],
            "description": DESCRIPTION,
            "version": VERSION,
            "license": {"name": "Apache License 2.0", "identifier": "Apache-2.0"},
            "contact": {"name": "The Polhode project"},
        },
        "paths": paths,
        "components": {
            "schemas": named | problem.pop("$defs") | {"ProblemDocument": problem},
            "securitySchemes": {
                "key": {
                    "type": "http",
                    "scheme": "bearer",
                    "description": "Needed where the service has a file of keys.",
                }
            },
            "parameters": {one["name"]: one for one in (PREFER, REPEATED)},
            "responses": {
                _response_name(status): _problem(status)
                for status in sorted({entry.status for entry in REGISTRY.values()})
            },
        },
        "servers": [
            {"url": "/", "description": "The service that serves this document."},
            {"url": "http://127.0.0.1:8000", "description": "`python -m service` on this machine."},
        ],
    }
    document = components.named(document)
    describe(document["components"]["schemas"], members_of(bodies.Body))
    components.require_tags(document)
    components.tidied(document)
    components.write_in_place(document)
    return document


Place = tuple[str, str]
"""An operation, and its question or its answer."""


def _schemas(routes: Sequence[Route]) -> tuple[dict[Place, Any], dict[str, Any]]:
    """Return the schemas of questions and answers, and the components that they refer to."""
    found = {(route.operation_id, part): kind for route in routes for part, kind in _types(route)}
    schemas, defined = TypeAdapter.json_schemas(
        [(place, "validation", TypeAdapter(kind)) for place, kind in found.items()],
        ref_template=components.PREFIX + "{model}",
    )
    return {place: schemas[place, "validation"] for place in found}, defined["$defs"]


def _types(route: Route) -> Iterator[tuple[str, Any]]:
    if isinstance(route, PostRoute):
        yield "question", route.question
    if route.answer is not None:
        yield "answer", route.answer


def _operation(route: Route, schemas: Mapping[Place, Any], later: Collection[str]) -> dict[str, Any]:
    """Return an operation of the document; `later` are the paths of what may be answered in the background."""
    found: dict[str, Any] = {"tags": [route.tag], "summary": route.summary}
    if route.operation_id in DEPRECATED:
        found["deprecated"] = True
    if route.description:
        found["description"] = route.description
    found["operationId"] = route.operation_id
    if names := re.findall(r"{(\w+)}", route.path):
        text = {"type": "string"}
        found["parameters"] = [
            {"name": name, "in": "path", "required": True, "schema": text | {"title": name.capitalize()}}
            for name in names
        ]
    asked = isinstance(route, PostRoute)
    if isinstance(route, PostRoute):
        examples = {
            name: {"summary": example.summary, "value": dict(example.question)}
            for name, example in route.examples.items()
        }
        content = {"examples": examples, "schema": schemas[route.operation_id, "question"]}
        found["requestBody"] = {"content": {"application/json": content}, "required": True}
    found["responses"] = {
        "202" if isinstance(route, StudyRoute) else "200": {
            "description": "The answer." if asked else "The document.",
            "content": {route.media_type: _content(route, schemas.get((route.operation_id, "answer"), {}))},
        }
    }
    given = [*found.get("parameters", ()), *route.parameters]
    given += (
        [PREFER, REPEATED] if route.path in later and asked else [REPEATED] if isinstance(route, StudyRoute) else []
    )
    if given:
        found["parameters"] = given
    for status in _problems_of(route):
        found["responses"][str(status)] = {"$ref": f"#/components/responses/{_response_name(status)}"}
    if asked:
        found["security"] = [{}, {"key": []}]
    return found


def _content(route: Route, answer: Any) -> dict[str, Any]:
    """Return the one form of an answer that an operation has."""
    if isinstance(route, PostRoute):
        return {"schema": answer}
    example = {} if route.example is None else {"example": route.example()}
    return {"schema": answer if route.media_type == "application/json" else {"type": "string"}} | example


def _in_form(operation: Mapping[str, Any], media: str, ending: str) -> dict[str, Any]:
    """Return an operation whose answer is not JSON but has another media type."""
    name = ending.removeprefix(".").replace(".", "_")
    found = {key: entry for key, entry in operation.items() if key not in ("description", "parameters")}
    found |= {"summary": f"{operation['summary']}: as {media}", "operationId": f"{operation['operationId']}_{name}"}
    if places := [one for one in operation.get("parameters", ()) if one.get("in") == "path"]:
        found["parameters"] = places
    if "requestBody" in operation:
        ((kind, content),) = operation["requestBody"]["content"].items()
        found["requestBody"] = {"content": {kind: {"schema": content["schema"]}}, "required": True}
    text = {"type": "string"} if media.startswith(("text/", SVG)) else {"type": "string", "format": "binary"}
    answer = {"description": "The answer.", "content": {media: {"schema": text}}}
    return found | {"responses": operation["responses"] | {"200": answer}}


def _problems_of(route: Route) -> tuple[int, ...]:
    if isinstance(route, PostRoute):
        return _PROBLEMS_OF_QUESTIONS
    if isinstance(route, ResourceRoute):
        return _PROBLEMS_OF_RESOURCES
    return (406, 500) if route.takes_parameters else (406, 422, 500)


def _response_name(status: int) -> str:
    return PHRASES.get(status, HTTPStatus(status).phrase).title().replace(" ", "").replace("-", "")


def _problem(status: int) -> dict[str, Any]:
    codes = [entry.code for entry in REGISTRY.values() if entry.status == status]
    reference = {"schema": {"$ref": "#/components/schemas/ProblemDocument"}}
    return {"description": f"Problem: {', '.join(codes)}.", "content": {MEDIA_TYPE: reference}}
