"""The reference, made from what the service declares: its OpenAPI document, its registry of problems, its settings."""

from __future__ import annotations

import json
import re
from collections.abc import Iterator, Mapping
from typing import Any

from core.multibody.undecided import UNDECIDED
from docs.site.navigation import DOCS, GENERATED
from service.problem_types import REGISTRY
from service.routing import ENDINGS
from service.settings import Settings

HIDDEN = ("signature", "warnings")
"""Fields of every answer, described once."""


def reference() -> dict[str, str]:
    """Return the pages of the reference by their places on the site."""
    document = json.loads((DOCS / "openapi.json").read_text(encoding="utf-8"))
    texts = (_endpoints(document), _objects(document), _problems(), _settings())
    return {place: "\n".join(lines) + "\n" for place, lines in zip(GENERATED, texts, strict=True)}


def _endpoints(document: Mapping[str, Any]) -> Iterator[str]:
    yield "# Endpoints"
    yield ""
    yield "Generated from [openapi.json](../openapi.json). Every answer also has `signature` and `warnings`; every"
    yield "refusal is a [problem](problems.md)."
    by_tag: dict[str, list[tuple[str, str, Any]]] = {}
    for path, methods in document["paths"].items():
        for method, operation in methods.items():
            by_tag.setdefault(operation["tags"][0], []).append((method.upper(), path, operation))
    for tag, operations in by_tag.items():
        yield from ("", f"## {tag.capitalize()}")
        for method, path, operation in operations:
            yield from ("", f"### {method} {path}", "", f"{operation['summary']}.")
            if path.endswith(tuple(ENDINGS.values())):
                # The request is that of the operation before it.
                continue
            if operation.get("description"):
                yield from ("", operation["description"])
            yield from _question(operation, document)
            yield from _answer(operation, document)


def _question(operation: Mapping[str, Any], document: Mapping[str, Any]) -> Iterator[str]:
    content = operation.get("requestBody", {}).get("content", {}).get("application/json")
    if content is None:
        return
    schema = _resolved(content["schema"], document)
    yield from ("", "**Request**", "")
    if "properties" in schema:
        yield from _table(schema)
    else:
        yield f"One of {_type(schema)}."
    for name, example in list(content.get("examples", {}).items())[:1]:
        text = json.dumps(example["value"])
        if len(text) < 1000:
            yield from ("", f"Example `{name}`, {example['summary']}:", "", "```json", text, "```")


def _answer(operation: Mapping[str, Any], document: Mapping[str, Any]) -> Iterator[str]:
    # What goes on in the background is answered with 202.
    content = next(operation["responses"][status] for status in ("200", "202") if status in operation["responses"]).get(
        "content", {}
    )
    media = ", ".join(f"`{kind}`" for kind in content)
    if media:
        yield from ("", f"**Answer** as {media}", "")
    schema = _resolved(content.get("application/json", {}).get("schema", {}), document)
    if "properties" in schema:
        yield from _table(schema, of_answer=True)


def _objects(document: Mapping[str, Any]) -> Iterator[str]:
    yield "# Objects"
    yield ""
    yield "What requests and answers consist of, in alphabetical order. Generated from [openapi.json](../openapi.json)."
    for name, schema in sorted(document["components"]["schemas"].items()):
        yield from ("", f"## {name}", "", schema.get("description", ""), "")
        yield from _table(schema)


def _table(schema: Mapping[str, Any], *, of_answer: bool = False) -> Iterator[str]:
    """Yield the fields of an object; which of an answer are required is of no use."""
    required = schema.get("required", ())
    heads = ["field", "type", "unit", *([] if of_answer else ["required"]), ""]
    yield f"| {' | '.join(heads)} |"
    yield "|---" * len(heads) + "|"
    for name, field in schema.get("properties", {}).items():
        if of_answer and name in HIDDEN:
            continue
        needed = "yes" if name in required else ""
        meaning = _one_line(field.get("description", ""))
        unit = next(_units(field), "")
        cells = [f"`{name}`", _type(field), unit, *([] if of_answer else [needed]), meaning]
        yield f"| {' | '.join(cells)} |"


def _type(field: Mapping[str, Any]) -> str:
    if "$ref" in field:
        name = field["$ref"].rpartition("/")[2]
        return f"[{name}](objects.md#{name.lower()})"
    if "enum" in field:
        return ", ".join(f"`{json.dumps(value)}`" for value in field["enum"])
    if "const" in field:
        return f"`{json.dumps(field['const'])}`"
    for union in ("oneOf", "anyOf"):
        if union in field:
            return " or ".join(dict.fromkeys(map(_type, field[union])))
    kind = field.get("type", "any")
    kinds = kind if isinstance(kind, list) else [kind]
    named = [_named(own, field) for own in kinds]
    return " or ".join(named)


def _named(kind: str, field: Mapping[str, Any]) -> str:
    if kind == "array" and isinstance(field.get("items"), dict):
        return f"list of {_type(field['items'])}"
    inner = field.get("additionalProperties")
    if kind == "object" and isinstance(inner, dict):
        return f"object of {_type(inner)}"
    bounds = [
        f"{sign} {field[key]:g}"
        for key, sign in (("minimum", "≥"), ("exclusiveMinimum", ">"), ("maximum", "≤"), ("exclusiveMaximum", "<"))
        if key in field and kind in ("number", "integer")
    ]
    return " ".join([kind, *bounds])


def _units(field: Any) -> Iterator[str]:
    if isinstance(field, dict):
        if "x-unit" in field and field["x-unit"] != "1":
            yield field["x-unit"]
        for key in ("items", "oneOf", "anyOf", "additionalProperties"):
            yield from _units(field.get(key))
    elif isinstance(field, list):
        for entry in field:
            yield from _units(entry)


def _problems() -> Iterator[str]:
    yield "# Problems"
    yield ""
    yield "A request that is not answered gets `application/problem+json` (RFC 9457). `code` is the stable name;"
    yield "`errors` lists the places in the request as JSON pointers, each with the rule and often a `remedy`."
    yield "`GET /v1/errors` answers this table as JSON."
    yield from ("", "| code | status | title | |", "|---|---|---|---|")
    for entry in REGISTRY.values():
        yield f"| `{entry.code}` | {entry.status} | {_one_line(entry.title)} | {_one_line(entry.meaning)} |"
    yield from ("", "## Undecided", "")
    yield "An answer about a described scene with contacts may carry a `problem`: the motion ends there, because"
    yield "mechanics does not decide or because it is not followed any further."
    yield "`GET /v1/undecided` answers this table as JSON."
    yield from ("", "| code | title | |", "|---|---|---|")
    for kind in UNDECIDED.values():
        link = f"[`{kind.code}`](../physics/undecided.md#{kind.code})"
        yield f"| {link} | {_one_line(kind.title)} | {_one_line(kind.meaning)} |"


def _settings() -> Iterator[str]:
    yield "# Settings"
    yield ""
    yield "Settings are environment variables; `python -m service --help` prints them. `--host`, `--port`"
    yield "and `--workers` are also options of the command line."
    yield from ("", "| variable | default | |", "|---|---|---|")
    for name, field in Settings.model_fields.items():
        default = "none" if field.default in (None, "") else f"`{field.default}`"
        yield f"| `POLHODE_{name.upper()}` | {default} | {_one_line(field.description or '')} |"


def _one_line(text: str) -> str:
    return re.sub(r"\s+", " ", text).replace("|", "\\|")


def _resolved(schema: Mapping[str, Any], document: Mapping[str, Any]) -> Mapping[str, Any]:
    if "$ref" not in schema:
        return schema
    found: Mapping[str, Any] = document["components"]["schemas"][schema["$ref"].rpartition("/")[2]]
    return found
