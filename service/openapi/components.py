"""The schemas of the OpenAPI document as a client's generator wants them: named, described, and each written once.

Components are what several places share: questions, answers, members of unions, parts of several answers. What occurs
in one place is written there, under its title.
"""

from __future__ import annotations

import json
import re
from collections import Counter
from collections.abc import Iterator
from typing import Any

PREFIX = "#/components/schemas/"

_GENERIC = {"_float_": "", "_DecimalString_": "Certified"}
"""By the suffix that a view has in one kind of number, the prefix of its name."""


def named(document: dict[str, Any]) -> dict[str, Any]:
    """Return a document in which views of decimal strings are named after those of doubles: Flip, CertifiedFlip."""
    text = json.dumps(document)
    for suffix, prefix in _GENERIC.items():
        text = re.sub(rf'"({PREFIX})?(\w+){suffix}"', rf'"\g<1>{prefix}\2"', text)
    found: dict[str, Any] = json.loads(text)
    return found


def tidied(document: dict[str, Any]) -> None:
    """Name every schema by its title, and leave out what says nothing: titles of fields, defaults that are null."""
    for name, schema in document["components"]["schemas"].items():
        schema["title"] = name
        for node in _within(schema):
            for field in node.get("properties", {}).values():
                field.pop("title", None)
                if "default" in field and field["default"] is None:
                    del field["default"]
            entries = node.get("prefixItems")
            if isinstance(entries, list) and all(entry == entries[0] for entry in entries):
                node["items"] = entries[0]
                del node["prefixItems"]
            if node.get("type") == "integer":
                # Whole numbers are counts.
                node.setdefault("x-unit", "1")


def require_tags(document: dict[str, Any]) -> None:
    """Mark the field by which the members of a union are told apart as required, which on the wire it is."""
    for node in _within(document):
        for reference in node.get("discriminator", {}).get("mapping", {}).values() if "oneOf" in node else ():
            schema = document["components"]["schemas"][reference.removeprefix(PREFIX)]
            kind = schema["properties"]["kind"]
            if "const" in kind and "kind" not in schema.get("required", []):
                kind.pop("default", None)
                schema["required"] = [*schema.get("required", []), "kind"]


def write_in_place(document: dict[str, Any]) -> None:
    """Write schemas that occur in one place there, but for questions, answers and members of unions."""
    schemas = document["components"]["schemas"]
    while single := _used_once(document):
        for node in _within(document):
            name = str(node.get("$ref", "")).removeprefix(PREFIX)
            if name in single:
                own = {key: value for key, value in node.items() if key != "$ref"}
                node.clear()
                node.update(schemas.pop(name) | own)
                break


def _used_once(document: dict[str, Any]) -> set[str]:
    nodes = [*_within(document)]
    uses = Counter(node["$ref"].removeprefix(PREFIX) for node in nodes if "$ref" in node)
    shared = {
        reference.removeprefix(PREFIX)
        for node in nodes
        for reference in node.get("discriminator", {}).get("mapping", {}).values()
    }
    # What paths and responses hold are questions, answers and problems.
    roots = {"paths": document["paths"], "responses": document["components"].get("responses", {})}
    shared |= {node["$ref"].removeprefix(PREFIX) for node in _within(roots) if "$ref" in node}
    return {name for name, count in uses.items() if count == 1 and name in document["components"]["schemas"]} - shared


def _within(node: Any) -> Iterator[dict[str, Any]]:
    """Yield every object of a document."""
    if isinstance(node, dict):
        yield node
        for entry in [*node.values()]:
            yield from _within(entry)
    elif isinstance(node, list):
        for entry in node:
            yield from _within(entry)
