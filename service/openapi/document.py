"""The OpenAPI document, made by FastAPI from the route table."""

from __future__ import annotations

import inspect
import re
from collections.abc import Callable, Coroutine, Iterator, Mapping, Sequence
from http import HTTPStatus
from typing import Any

from fastapi import FastAPI, Request
from fastapi.routing import APIRoute
from pydantic import TypeAdapter
from starlette.responses import JSONResponse, Response
from starlette.types import ASGIApp

from core import bodies
from core.quantities import members_of
from service import VERSION
from service.openapi import components
from service.openapi.descriptions import describe
from service.problems import MEDIA_TYPE, REGISTRY
from service.responses import npz as archive
from service.routing import PostRoute, ResourceRoute, Route, StudyRoute
from service.schemas import ProblemDocument

DESCRIPTION = """\
The motion of rigid bodies and small constrained scenes, and how right each answer is.

SI units, radians. Vectors are [x, y, z], matrices are written row by row, quaternions [w, x, y, z] turn body into
space. Body axes are the axes in which the body was defined. Times are measured from the given state. Arrays of samples
are rows. Every number is a finite double; a derived figure outside the range of doubles is null, with a warning.

`/v1/certified/...` answers the closed-form questions to any number of `digits` (16 to 1000): every number of the answer
is a decimal string whose digits are proven, and numbers of the question may be decimal strings too ("0.1" is one tenth,
0.1 a double).

Answers are JSON, or a numpy archive to `Accept: application/x-npz`: the same names, and the rest
as JSON in metadata.json.

Refusals are application/problem+json (RFC 9457) with a stable code and JSON pointers into the document that was sent.
"""

_PROBLEMS_OF_QUESTIONS = (400, 401, 406, 408, 413, 415, 422, 429, 500, 501, 503)

_PROBLEMS_OF_RESOURCES = (401, 404, 406, 422, 429, 500, 503)

PACKED = {
    "type": "string",
    "format": "binary",
    "description": "numpy archive, as numpy.savez packs it: the JSON document as the member metadata.json, in which "
    '{"array": "positions"} stands for the array of the member positions.npy.',
}
"""A request that is a numpy archive."""


ABOUT: Mapping[str, Any] = {
    "title": "Polhode",
    "version": VERSION,
    "description": DESCRIPTION,
    "openapi_url": None,
    "docs_url": None,
    "redoc_url": None,
    "redirect_slashes": False,
    "separate_input_output_schemas": False,
}
"""Arguments of the FastAPI application."""


class _Dispatched(Response):
    """A response that lets the dispatcher answer."""

    def __init__(self, handler: ASGIApp) -> None:
        super().__init__()
        self._handler = handler

    async def __call__(self, scope: Any, receive: Any, send: Any) -> None:
        await self._handler(scope, receive, send)


def document_routes(
    app: FastAPI, routes: Sequence[Route], handlers: Mapping[tuple[str, str], ASGIApp], unrouted: ASGIApp
) -> None:
    """Give FastAPI the routes, their handlers by method and path, and what answers where none of them fits."""
    for route in routes:
        app.router.routes.append(_Route(route, handlers[route.method, route.path]))

    async def refuse(request: Request, error: Exception) -> Response:
        return _Dispatched(unrouted)

    app.add_exception_handler(404, refuse)
    app.add_exception_handler(405, refuse)


def openapi(app: FastAPI) -> dict[str, Any]:
    """Return the OpenAPI document."""
    document = app.openapi()
    document["components"] = {"schemas": _write_schemas(document, [*app.router.routes])}
    document["info"] |= {
        "license": {"name": "Apache License 2.0", "identifier": "Apache-2.0"},
        "contact": {"name": "The Polhode project"},
    }
    document["servers"] = [
        {"url": "/", "description": "The service that serves this document."},
        {"url": "http://127.0.0.1:8000", "description": "`python -m service` on this machine."},
    ]
    problem = ProblemDocument.model_json_schema(ref_template="#/components/schemas/{model}")
    document["components"]["schemas"] |= problem.pop("$defs") | {"ProblemDocument": problem}
    document["components"]["securitySchemes"] = {
        "key": {"type": "http", "scheme": "bearer", "description": "Needed where the service has a file of keys."}
    }
    document["components"]["responses"] = {
        _response_name(status): _problem(status) for status in sorted({entry.status for entry in REGISTRY.values()})
    }
    for verbs in document["paths"].values():
        if "post" in verbs:
            verbs["post"]["security"] = [{}, {"key": []}]
            verbs["post"]["requestBody"]["content"][archive.MEDIA_TYPE] = {"schema": PACKED}
        for operation in verbs.values():
            for status in operation["responses"]:
                if int(status) >= 400:
                    reference = f"#/components/responses/{_response_name(int(status))}"
                    operation["responses"][status] = {"$ref": reference}
    document = components.named(document)
    describe(document["components"]["schemas"], members_of(bodies.Body))
    components.require_tags(document)
    components.tidied(document)
    components.write_in_place(document)
    return document


def _write_schemas(document: dict[str, Any], routes: Sequence[Any]) -> dict[str, Any]:
    """Write the schemas of questions and answers into the paths, and return the components that they refer to.

    FastAPI would make an adapter of every field of every model to collect the same; that takes a second more.
    """
    places = {
        (route.entry.operation_id, part): (found, content)
        for route in routes
        if isinstance(route, _Route) and route.include_in_schema
        for part, found, content in _typed_content(route.entry, document["paths"][route.path])
    }
    schemas, defined = TypeAdapter.json_schemas(
        [(place, "validation", TypeAdapter(found)) for place, (found, _) in places.items()],
        ref_template=components.PREFIX + "{model}",
    )
    for place, (_, content) in places.items():
        content["schema"] = schemas[place, "validation"]
    named: dict[str, Any] = defined["$defs"]
    return named


def _typed_content(route: Route, operations: dict[str, Any]) -> Iterator[tuple[str, Any, dict[str, Any]]]:
    """Yield what has a type of its own in an operation: its part, the type, and where the schema belongs."""
    operation = operations[route.method.lower()]
    if isinstance(route, PostRoute):
        yield "question", route.question, operation["requestBody"]["content"]["application/json"]
    if route.answer is not None:
        yield "answer", route.answer, operation["responses"][str(_status(route))]["content"]["application/json"]


def _status(route: Route) -> int:
    return 202 if isinstance(route, StudyRoute) else 200


def _response_name(status: int) -> str:
    return HTTPStatus(status).phrase.title().replace(" ", "").replace("-", "")


def _problem(status: int) -> dict[str, Any]:
    codes = [entry.code for entry in REGISTRY.values() if entry.status == status]
    reference = {"schema": {"$ref": "#/components/schemas/ProblemDocument"}}
    return {"description": f"Problem: {', '.join(codes)}.", "content": {MEDIA_TYPE: reference}}


class _Route(APIRoute):
    """One route of the table, as FastAPI sees it."""

    def __init__(self, route: Route, handler: ASGIApp) -> None:
        self.entry, self._handler = route, handler
        super().__init__(
            route.path,
            _endpoint(route),
            methods=[route.method],
            operation_id=route.operation_id,
            name=route.operation_id,
            summary=route.summary,
            description=route.description,
            tags=[route.tag],
            status_code=_status(route),
            include_in_schema=isinstance(route, PostRoute) or route.documented,
            response_model=None,
            response_description="The answer." if isinstance(route, PostRoute) else "The document.",
            response_class=_response_class(route),
            responses=_representations(route) | _problems(_problems_of(route)),
            openapi_extra=_request_body(route),
        )

    def get_route_handler(self) -> Callable[[Request], Coroutine[Any, Any, Response]]:
        async def handler(request: Request) -> Response:
            return _Dispatched(self._handler)

        return handler


def _response_class(route: Route) -> type[Response]:
    if isinstance(route, ResourceRoute):
        return JSONResponse if route.answer is not None else Response
    if isinstance(route, PostRoute) or route.media_type == "application/json":
        return JSONResponse
    return type("_Media", (Response,), {"media_type": route.media_type})


def _endpoint(route: Route) -> Callable[..., Any]:
    """Return a function whose signature has the parameters of the path; it is never called."""

    def endpoint(**arguments: Any) -> None:
        raise NotImplementedError

    names = re.findall(r"{(\w+)}", route.path)
    parameters = [inspect.Parameter(name, inspect.Parameter.KEYWORD_ONLY, annotation=str) for name in names]
    endpoint.__signature__ = inspect.Signature(parameters)  # type: ignore[attr-defined]
    endpoint.__doc__ = None
    return endpoint


def _request_body(route: Route) -> dict[str, Any] | None:
    if not isinstance(route, PostRoute):
        return None
    examples = {
        name: {"summary": example.summary, "value": dict(example.question)} for name, example in route.examples.items()
    }
    return {"requestBody": {"content": {"application/json": {"examples": examples}}, "required": True}}


def _representations(route: Route) -> dict[int | str, dict[str, Any]]:
    """Return how an answer is documented that is not JSON; the Accept header chooses."""
    if isinstance(route, StudyRoute):
        return {}
    if isinstance(route, ResourceRoute):
        forms: dict[str, Any] = {} if route.example is None else {"application/json": {"example": dict(route.example)}}
        for media in route.representations:
            text = {"type": "string"}
            forms[media] = {"schema": text if media.startswith("text/") else text | {"format": "binary"}}
        return {200: {"content": forms}}
    if not isinstance(route, PostRoute):
        if route.example is None:
            return {}
        return {200: {"content": {route.media_type: {"example": route.example()}}}}
    content: dict[str, Any] = {media: {"schema": {"type": "string"}} for media in route.representations}
    content[archive.MEDIA_TYPE] = {
        "schema": {
            "type": "string",
            "format": "binary",
            "description": "numpy archive: each array under its name in the JSON answer (steps joined by slashes), the "
            "rest in the member metadata.json.",
        }
    }
    return {200: {"description": "The answer.", "content": content}}


def _problems_of(route: Route) -> tuple[int, ...]:
    if isinstance(route, PostRoute):
        return _PROBLEMS_OF_QUESTIONS
    return _PROBLEMS_OF_RESOURCES if isinstance(route, ResourceRoute) else (406, 500)


def _problems(statuses: Sequence[int]) -> dict[int | str, dict[str, Any]]:
    """Return the statuses of problems; what they are is written once, among the components."""
    return {status: {"description": ""} for status in statuses}
