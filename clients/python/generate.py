"""Write the typed part of the client from the OpenAPI document: python clients/python/generate.py.

`documents.py` has a TypedDict for every object that is sent or answered, `operations.py` a method for every operation,
for the blocking client and for the asynchronous one. They are part of the package, which is built with them, and not of
the repository.
"""

from __future__ import annotations

import json
import os
from collections.abc import Iterator, Mapping
from keyword import iskeyword
from pathlib import Path
from typing import Any

HERE = Path(__file__).resolve().parent
# A source distribution has the document beside this file.
DOCUMENT = next(
    (file for file in (HERE / "openapi.json", HERE.parents[1] / "docs" / "openapi.json") if file.exists()), HERE
)
PACKAGE = HERE / "polhode_client"
MODULES = ("documents.py", "operations.py")
Schema = Mapping[str, Any]

PLAIN = {"string": "str", "number": "float", "integer": "int", "boolean": "bool", "null": "None"}
ANSWERS = {
    "application/vnd.apache.parquet": "bytes",
    "application/vnd.zarr+zip": "bytes",
    "application/x-npz": "dict[str, Any]",
    **dict.fromkeys(("image/svg+xml", "text/csv", "text/event-stream", "text/html", "text/plain"), "str"),
}
"""Annotations of answers that are not JSON."""

HEAD = '''"""{}

Written by generate.py from the OpenAPI document; do not edit.
"""

# ruff: noqa: E501, D1
from __future__ import annotations
'''


class Types:
    """Python annotations of schemas, and the TypedDicts that they name.

    Parameters
    ----------
    components : mapping
        Schemas by name.
    sent : set of str
        Names of those that are part of requests, in which arrays may be given as any sequences.
    """

    def __init__(self, components: Mapping[str, Schema], sent: set[str]) -> None:
        self._components, self._sent = components, sent
        self._names: dict[str, str] = {}
        self.definitions: dict[str, str] = {}

    def annotation(self, schema: Schema, *, sent: bool) -> str:
        """Return the annotation of a schema."""
        if "$ref" in schema:
            return self.named(str(schema["$ref"]).rsplit("/", 1)[-1])
        if "const" in schema:
            return f"Literal[{schema['const']!r}]"
        if "enum" in schema:
            return f"Literal[{', '.join(map(repr, schema['enum']))}]"
        for union in ("anyOf", "oneOf"):
            if union in schema:
                return _joined(self.annotation(member, sent=sent) for member in schema[union])
        kind = schema.get("type")
        if isinstance(kind, list):
            return _joined(self.annotation({**schema, "type": one}, sent=sent) for one in kind)
        if kind == "array":
            if (number := _entry_of_array(schema)) is not None:
                return "Numbers" if sent else {"number": "Floats", "integer": "Integers"}[number]
            inner = self.annotation(schema.get("items", {}), sent=sent)
            return f"Sequence[{inner}]" if sent else f"list[{inner}]"
        if kind == "object":
            if "properties" in schema:
                return self._defined(str(schema["title"]), schema, sent)
            entries = schema.get("additionalProperties")
            value = self.annotation(entries, sent=sent) if isinstance(entries, Mapping) else "Any"
            return f"Mapping[str, {value}]" if sent else f"dict[str, {value}]"
        return PLAIN[kind] if kind is not None else "Any"

    def named(self, name: str) -> str:
        """Return the annotation of a component."""
        return self._defined(name, self._components[name], name in self._sent)

    def _defined(self, title: str, schema: Schema, sent: bool) -> str:
        key = json.dumps([title, schema, sent], sort_keys=True)
        if key not in self._names:
            # Different objects may have one title.
            name = title
            while name in self.definitions:
                name += "_"
            self._names[key] = name
            self.definitions[name] = ""
            self.definitions[name] = self._body(name, schema, sent)
        return self._names[key]

    def _body(self, name: str, schema: Schema, sent: bool) -> str:
        required = schema.get("required", ())
        words, lines = [], []
        for field, inner in schema["properties"].items():
            annotation = self.annotation(inner, sent=sent)
            annotation = annotation if field in required else f"NotRequired[{annotation}]"
            if iskeyword(field):
                # Evaluated at once, unlike what stands in a class: it may name what is defined further down.
                words.append(f"{field!r}: {annotation!r}")
            else:
                lines.append(f"    {field}: {annotation}")
        head = [
            f"class {name}({f'_{name}' if words else 'TypedDict'}):",
            f'    """{schema.get("description", name)}"""',
        ]
        # A field that is called like a word of Python's cannot stand in the body of a class.
        before = [f'_{name} = TypedDict("_{name}", {{{", ".join(words)}}})', "", ""] if words else []
        return "\n".join([*before, *head, "", *lines])


def _joined(annotations: Iterator[str]) -> str:
    # Of an array and null, the entries are the same.
    return " | ".join(dict.fromkeys(annotations))


def _entry_of_array(schema: Schema) -> str | None:
    """Return "number" or "integer" for an array, or rows, of nothing else."""
    inner = schema.get("items", {})
    if inner.get("type") == "array":
        return _entry_of_array(inner)
    return inner["type"] if inner.get("type") in ("number", "integer") else None


def _within(schema: Any, components: Mapping[str, Schema]) -> Iterator[str]:
    """Yield the names of the components that a schema refers to, however deeply."""
    seen: set[str] = set()
    rest = [schema]
    while rest:
        here = rest.pop()
        if isinstance(here, Mapping):
            reference = here.get("$ref")
            if isinstance(reference, str) and (name := reference.rsplit("/", 1)[-1]) not in seen:
                seen.add(name)
                rest.append(components[name])
            rest.extend(here.values())
        elif isinstance(here, list):
            rest.extend(here)
    yield from seen


def generated(document: Mapping[str, Any]) -> dict[str, str]:
    """Return the text of each generated module, by its name."""
    components = document["components"]["schemas"]
    table = [
        (entry["operationId"], method.upper(), path, entry)
        for path, verbs in document["paths"].items()
        for method, entry in verbs.items()
    ]
    requests = {
        name: entry["requestBody"]["content"]["application/json"]["schema"]
        for name, _, _, entry in table
        if "requestBody" in entry
    }
    types = Types(components, {name for schema in requests.values() for name in _within(schema, components)})
    rows, methods, awaited = [], [], []
    for name, method, path, entry in table:
        status = next(status for status in ("200", "202") if status in entry["responses"])
        ((media, content),) = entry["responses"][status]["content"].items()
        given, passed = ["self"], ["None", "None"]
        own = [one for one in entry.get("parameters", ()) if "$ref" not in one]
        places = [one["name"] for one in own if one["in"] == "path"]
        given += [f"{place}: str" for place in places]
        if query := [one for one in own if one["in"] == "query"]:
            given += [
                "*",
                *(f"{one['name']}: {types.annotation(one['schema'], sent=True)} | None = None" for one in query),
            ]
            passed[1] = "{" + ", ".join(f"{one['name']!r}: {one['name']}" for one in query) + "}"
        if name in requests:
            given.append(f"**question: Unpack[documents.{types.annotation(requests[name], sent=True)}]")
            passed[0] = "question"
        passed += [f"{place}={place}" for place in places]
        answer = types.annotation(content["schema"], sent=False) if media == "application/json" else ANSWERS[media]
        answer = f"documents.{answer}" if answer in types.definitions else {"Any": "dict[str, Any]"}.get(answer, answer)
        # A study is not begun twice by a request that is repeated.
        rows.append(f"{name!r}: Operation({method!r}, {path!r}, {entry['summary']!r}, {media!r}, {status == '202'}),")
        head = f"def {name}({', '.join(given)}) -> {answer}:"
        text = f'        """{entry["summary"]}."""'
        call = f"self._ask({name!r}, {', '.join(passed)})"
        methods.append(f"    {head}\n{text}\n        found: {answer} = {call}\n        return found\n")
        awaited.append(f"    async {head}\n{text}\n        found: {answer} = await {call}\n        return found\n")
    types.named("ProblemDocument")
    documents = "\n\n\n".join(types.definitions[name] for name in types.definitions)
    return {
        "documents.py": HEAD.format("Objects that are sent and answered.")
        + "\nfrom collections.abc import Mapping, Sequence\nfrom typing import Any, Literal, NotRequired, TypedDict\n\n"
        + "from polhode_client.arrays import Floats, Integers, Numbers\n\n\n"
        + documents
        + "\n",
        "operations.py": HEAD.format("Every operation of the service as a method.")
        + "\nfrom abc import ABC, abstractmethod\nfrom collections.abc import Mapping\n"
        + "from typing import Any, Literal, Unpack\n\n"
        + "from polhode_client import documents\nfrom polhode_client.operation import Operation\n\n"
        + "OPERATIONS: Mapping[str, Operation] = {\n    "
        + "\n    ".join(rows)
        + "\n}\n\n\n"
        + _class("Operations", "def _ask", "Methods of the blocking client.", methods)
        + "\n\n"
        + _class("AsyncOperations", "async def _ask", "Methods of the asynchronous client.", awaited),
    }


def _class(name: str, ask: str, text: str, methods: list[str]) -> str:
    return (
        f'class {name}(ABC):\n    """{text}"""\n\n    @abstractmethod\n    {ask}(\n'
        "        self, name: str, question: Mapping[str, Any] | None, query: Mapping[str, Any] | None, **places: str\n"
        "    ) -> Any:\n"
        f'        """Return the answer of an operation; `places` fill the braces of its path."""\n\n'
        + "\n".join(methods)
    )


def write() -> None:
    """Write the generated modules into the package where they are older than what they are made from."""
    made_from = max(file.stat().st_mtime_ns for file in (DOCUMENT, Path(__file__)))
    if all((PACKAGE / name).exists() and (PACKAGE / name).stat().st_mtime_ns >= made_from for name in MODULES):
        return
    for name, text in generated(json.loads(DOCUMENT.read_text(encoding="utf-8"))).items():
        # Tests of several processes may write at once, while others read.
        beside = PACKAGE / f".{name}.{os.getpid()}"
        beside.write_text(text, encoding="utf-8")
        beside.replace(PACKAGE / name)


if __name__ == "__main__":
    write()
