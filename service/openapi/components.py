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
    """Write fields so that generators make the plainest types of them, and name what they make classes of.

    Titles of fields and defaults that are null say nothing. Other defaults are part of descriptions, because generators
    demand fields that have one, or send it always. A vector is an array of equal items; a number or an array
    that may be null has two types.
    """
    for name, schema in document["components"]["schemas"].items():
        for node in _within(schema):
            for field_name, field in node.get("properties", {}).items():
                _tidy_field(field_name, field)
            entries = node.get("prefixItems")
            if isinstance(entries, list) and all(entry == entries[0] for entry in entries):
                node["items"] = entries[0]
                del node["prefixItems"]
            if "integer" in _types(node):
                # Whole numbers are counts.
                node.setdefault("x-unit", "1")
        schema["title"] = name


def _tidy_field(name: str, field: dict[str, Any]) -> None:
    field.pop("title", None)
    default = field.pop("default", None)
    if default is not None:
        said = f"{json.dumps(default, ensure_ascii=False)} if left out."
        field["description"] = f"{field['description']} {said}" if "description" in field else said.capitalize()
    title = "".join(word.capitalize() for word in name.split("_"))
    members = field.get("anyOf", [field])
    for member in members:
        kind, items = member.get("type"), member.get("items", {})
        entries = items.get("anyOf") or items.get("oneOf") or [items]
        named = [entry for entry in entries if "enum" in entry or (len(entries) > 1 and entry.get("type") == "object")]
        if kind == "object" or "enum" in member:
            member["title"] = title
        elif kind == "array" and named:
            named[0].setdefault("title", title.removesuffix("s"))
        elif kind == "array" and {"type": "null"} not in members and len(members) > 1:
            member["title"] = f"{title}List"
    plain = members[0].get("type") in ("number", "integer", "string", "array") and "enum" not in members[0]
    if len(members) == 2 and members[1] == {"type": "null"} and plain:
        field.update(members[0])
        field["type"] = [members[0]["type"], "null"]
        del field["anyOf"]


def _types(schema: dict[str, Any]) -> set[str]:
    found = schema.get("type", [])
    return {found} if isinstance(found, str) else set(found)


def require_tags(document: dict[str, Any]) -> None:
    """Mark the discriminator of a union as required, which on the wire it is."""
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
    single = _used_once(document)
    for node in _within(document):
        name = str(node.get("$ref", "")).removeprefix(PREFIX)
        if name in single:
            single.remove(name)
            own = {key: value for key, value in node.items() if key != "$ref"}
            node.clear()
            # What it refers to itself is met next.
            node.update(schemas.pop(name) | own)


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
