"""Units that the model of a question or an answer declares, found by JSON pointer."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from functools import cache
from typing import Any

from pydantic import TypeAdapter

from core.errors import Path


@cache
def schema_of(model: Any) -> Mapping[str, Any]:
    """Return the JSON schema of a pydantic model or a union of them."""
    schema: Mapping[str, Any] = TypeAdapter(model).json_schema()
    return schema


def unit_at(schema: Mapping[str, Any], path: Path) -> str | None:
    """Return the unit that a schema declares for the numbers at a path, None if it declares none there."""
    found = [schema]
    for step in path:
        found = [inner for node in found for inner in _stepped(schema, node, step)]
    return next((unit for node in found for unit in _units(schema, node)), None)


def outputs_of(schema: Mapping[str, Any]) -> frozenset[str]:
    """Return what a question may name as its outputs, nothing if it has no such field."""
    names: set[str] = set()
    for node in _members(schema, schema.get("properties", {}).get("outputs", {})):
        for entry in _members(schema, node.get("items", {})):
            names |= {*entry.get("enum", ())}
    return frozenset(names)


def numbers_within(schema: Mapping[str, Any], document: Any) -> Iterator[tuple[str, float]]:
    """Yield unit and magnitude of the numbers of a document that its schema declares units for."""
    yield from _numbers(schema, [schema], document)


def _numbers(schema: Mapping[str, Any], nodes: list[Any], document: Any) -> Iterator[tuple[str, float]]:
    if type(document) in (int, float):
        unit = next((unit for node in nodes for unit in _units(schema, node)), None)
        if unit is not None:
            yield unit, abs(float(document))
    elif isinstance(document, (dict, list)):
        entries = document.items() if isinstance(document, dict) else enumerate(document)
        for step, entry in entries:
            yield from _numbers(schema, [inner for node in nodes for inner in _stepped(schema, node, step)], entry)


def _members(schema: Mapping[str, Any], node: Any) -> Iterator[Mapping[str, Any]]:
    """Yield a node and, where it is a reference or a union, what it stands for."""
    if not isinstance(node, Mapping):
        return
    if "$ref" in node:
        yield from _members(schema, schema["$defs"][node["$ref"].rsplit("/", 1)[1]])
    yield node
    for union in ("anyOf", "oneOf", "allOf"):
        for member in node.get(union, ()):
            yield from _members(schema, member)


def _stepped(schema: Mapping[str, Any], node: Any, step: str | int) -> Iterator[Any]:
    for member in _members(schema, node):
        if isinstance(step, str):
            inner = member.get("properties", {}).get(step, member.get("additionalProperties"))
        else:
            entries = member.get("prefixItems", ())
            inner = entries[step] if step < len(entries) else member.get("items")
        if isinstance(inner, Mapping):
            yield inner


def _units(schema: Mapping[str, Any], node: Any) -> Iterator[str]:
    for member in _members(schema, node):
        if "x-unit" in member:
            yield member["x-unit"]
        for inner in (*member.get("prefixItems", ())[:1], member.get("items")):
            yield from _units(schema, inner)
