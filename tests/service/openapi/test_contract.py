"""The API keeps what the last release promised, unless its version says otherwise (semantic versioning)."""

from __future__ import annotations

import copy
import json
from pathlib import Path
from typing import Any

import pytest

from service import VERSION
from tests.service.openapi.contract import breaks, promises

ROOT = Path(__file__).parents[3]
CURRENT = json.loads((ROOT / "docs" / "openapi.json").read_text(encoding="utf-8"))
RELEASES = {tuple(map(int, file.stem.split("."))): file for file in (ROOT / "docs" / "releases").glob("*.json")}


def test_a_break_demands_a_major_version() -> None:
    last = max(RELEASES)
    found = breaks(json.loads(RELEASES[last].read_text(encoding="utf-8")), promises(CURRENT))
    own = tuple(map(int, VERSION.split(".")))
    assert own >= last
    assert not found or own[0] > last[0], "\n".join(found)


def test_the_promises_of_a_document_are_those_of_its_promises() -> None:
    assert breaks(CURRENT, promises(CURRENT)) == []
    assert breaks(promises(CURRENT), CURRENT) == []


POLAR, IN_UNIT, EVENT = (
    {"type": "object", "properties": {name: {"type": "string"}}} for name in ("polar", "unit", "event")
)


def document() -> Any:
    return {
        "paths": {
            "/v1/a": {
                "post": {
                    "requestBody": {"content": {"application/json": {"schema": {"$ref": "#/components/schemas/Q"}}}},
                    "responses": {
                        "200": {"content": {"application/json": {"schema": {"$ref": "#/components/schemas/A"}}}}
                    },
                }
            }
        },
        "components": {
            "schemas": {
                "Q": {
                    "type": "object",
                    "properties": {
                        "kind": {"enum": ["one", "two"]},
                        "mass": {"anyOf": [{"type": "number"}, {"type": "string"}]},
                        "at": {"anyOf": [POLAR, IN_UNIT]},
                    },
                    "required": ["mass"],
                },
                "A": {
                    "type": "object",
                    "properties": {"period": {"type": "number"}, "next": {"$ref": "#/components/schemas/A"}},
                    "required": ["period"],
                },
            }
        },
    }


def changed(*steps: str, to: Any) -> Any:
    """Return the document with a member set, or left out if `to` is None."""
    found = copy.deepcopy(document())
    inner = found
    for step in steps[:-1]:
        inner = inner[step]
    if to is None:
        del inner[steps[-1]]
    else:
        inner[steps[-1]] = to
    return found


Q, A = ("components", "schemas", "Q"), ("components", "schemas", "A")


@pytest.mark.parametrize(
    ("new", "said"),
    [
        (changed("paths", "/v1/a", to=None), "gone"),
        (changed(*Q, "properties", "kind", to=None), "kind is gone"),
        (changed(*Q, "required", to=["mass", "kind"]), "kind is required"),
        (changed(*Q, "properties", "kind", "enum", to=["one"]), "'two' is gone"),
        (changed(*Q, "properties", "mass", to={"type": "number"}), "no longer string"),
        (changed(*Q, "properties", "at", "anyOf", to=[EVENT, IN_UNIT]), "polar is gone"),
        (changed(*A, "properties", "period", to=None), "period is gone"),
        (changed(*A, "required", to=[]), "period may be left out"),
        (changed(*A, "properties", "period", to={"type": ["number", "null"]}), "also null"),
    ],
)
def test_breaks_are_found(new: Any, said: str) -> None:
    assert [found.endswith(said) for found in breaks(document(), new)] == [True]


@pytest.mark.parametrize(
    "new",
    [
        document(),
        changed(*Q, "properties", "colour", to={"type": "string"}),
        changed(*Q, "properties", "kind", "enum", to=["one", "two", "three"]),
        changed(*Q, "required", to=[]),
        changed(*Q, "properties", "at", "anyOf", to=[POLAR, EVENT, IN_UNIT]),
        changed(*A, "properties", "rate", to={"type": "number"}),
        changed(*A, "required", to=["period", "next"]),
    ],
)
def test_additions_are_none(new: Any) -> None:
    assert breaks(document(), new) == []
