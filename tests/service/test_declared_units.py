"""Units that are read off annotations are those of the OpenAPI document."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import pytest
from pydantic import TypeAdapter

from core.assessment.stated_units import BESIDE, OF_THAT_NAME, OF_THE_FIGURE, OF_THE_INPUT
from service.requests.declared_units import has_field, numbers_within, outputs_of, unit_at
from service.routes import questions
from service.routing import PostRoute

WITHOUT_UNITS = ("/v1/scenes/import", "/v1/scenes/export")
"""Answers that are documents."""
ROUTES = {
    route.path: route
    for route in questions()
    if not route.path.startswith("/v1/certified/") and route.path not in WITHOUT_UNITS
}
DEEPEST = 6
GRADED = ("/v1/find", *(path for path in ROUTES if path.startswith(("/v1/bodies/", "/v1/rotation/", "/v1/scenes"))))
OF_CHANGES = "as in the changes"
"""Of the shapes of modes: metres for each metre, or radian, of the largest change, and so of no unit of its own."""


def resolved(schema: Any, node: Any) -> Any:
    while "$ref" in node:
        node = schema["$defs"][node["$ref"].rsplit("/", 1)[1]]
    return node


def units_in(schema: Any, node: Any, path: tuple[str | int, ...] = ()) -> Iterator[tuple[tuple[str | int, ...], str]]:
    """Yield path and unit of the numbers that a JSON schema describes; arrays by their first entry."""
    node = resolved(schema, node)
    if len(path) > DEEPEST:
        return
    # Where the request chooses the unit there are words in its place, which grading does not take for one.
    if not node.get("x-unit", "as in").startswith("as in") and node.get("type") in ("number", "string"):
        yield path, node["x-unit"]
    for name, entry in node.get("properties", {}).items():
        yield from units_in(schema, entry, (*path, name))
    if isinstance(node.get("additionalProperties"), dict):
        yield from units_in(schema, node["additionalProperties"], (*path, "any"))
    for first in (*node.get("prefixItems", ())[:1], *((node["items"],) if isinstance(node.get("items"), dict) else ())):
        yield from units_in(schema, first, (*path, 0))
    for member in (*node.get("anyOf", ()), *node.get("oneOf", ())):
        yield from units_in(schema, member, path)


@pytest.mark.parametrize("route", ROUTES.values(), ids=lambda route: route.operation_id)
def test_every_unit_of_an_answer_is_found_by_its_path(route: PostRoute) -> None:
    schema = TypeAdapter(route.answer).json_schema()
    found = list(units_in(schema, schema))
    assert found
    for path, unit in found:
        assert unit_at(route.answer, path) == unit, path
        while path and path[-1] == 0:
            path = path[:-1]
        assert unit_at(route.answer, path) == unit, path


def relative_units(schema: Any, node: Any, stated: bool = False) -> Iterator[tuple[str, bool]]:
    """Yield the units that only an answer states, and whether it does so beside what has them, or around that."""
    node = resolved(schema, node)
    unit = node.get("x-unit", "")
    if unit.startswith("as ") or unit.startswith("product"):
        yield unit, stated
    properties = node.get("properties", {})
    here = stated or "unit" in properties
    inner = [*properties.values(), *node.get("prefixItems", ()), *node.get("anyOf", ()), *node.get("oneOf", ())]
    inner += [node[key] for key in ("items", "additionalProperties") if isinstance(node.get(key), dict)]
    for entry in inner:
        yield from relative_units(schema, entry, here)


@pytest.mark.parametrize("route", [ROUTES[path] for path in GRADED], ids=lambda route: route.operation_id)
def test_every_unit_that_an_answer_states_can_be_found_in_it(route: PostRoute) -> None:
    schema = TypeAdapter(route.answer).json_schema()
    properties = resolved(schema, schema).get("properties", {})
    for unit, stated in relative_units(schema, schema):
        assert unit in (BESIDE, OF_THAT_NAME, OF_THE_INPUT, OF_THE_FIGURE, OF_CHANGES)
        assert unit != BESIDE or stated
        assert unit != OF_THE_INPUT or "units" in properties
        assert unit != OF_THE_FIGURE or "figure_units" in properties


def test_what_has_no_unit_has_none() -> None:
    answer = ROUTES["/v1/rotation/precession"].answer
    for path in (("regime",), ("nothing",), ("period", "x"), ("axis", 0, 0), (), ("tumbles",)):
        assert unit_at(answer, path) is None, path


def test_fields_and_outputs_of_questions() -> None:
    rod, trajectory = (ROUTES[path].question for path in ("/v1/scenes/rod-in-hole", "/v1/rotation/trajectory"))
    assert {"period", "trajectory", "contact"} <= outputs_of(rod)
    assert outputs_of(trajectory) == {"time", "angular_velocity", "attitude"}
    assert outputs_of(ROUTES["/v1/rotation/wobble"].question) == frozenset()
    assert has_field(trajectory, "input_uncertainty")
    assert not has_field(rod, "input_uncertainty")


def test_numbers_of_a_request_have_the_units_of_its_members() -> None:
    request = {"body": {"kind": "ball", "mass": 2, "radius": 0.5}, "angular_velocity": [0, -3.0, 1], "times": [4.0]}
    found = set(numbers_within(ROUTES["/v1/rotation/trajectory"].question, request))
    assert {("kg", 2.0), ("m", 0.5), ("rad s^-1", 3.0), ("s", 4.0)} <= found
