"""Write the typed part of the client from docs/openapi.json: python clients/python/generate.py.

`documents.py` has a TypedDict for every object that is sent or answered, `operations.py` a method for every operation,
for the blocking client and for the asynchronous one. Both are checked in; a test compares them with the document.
"""

from __future__ import annotations

import json
import subprocess
import sys
from collections.abc import Iterator, Mapping
from keyword import iskeyword
from pathlib import Path
from typing import Any

HERE = Path(__file__).parent
DOCUMENT = HERE.parents[1] / "docs" / "openapi.json"
PACKAGE = HERE / "polhode_client"
Schema = Mapping[str, Any]

PLAIN = {"string": "str", "number": "float", "integer": "int", "boolean": "bool", "null": "None"}
TEXT = ("image/svg+xml", "text/html", "text/plain", "text/javascript", "text/css", "text/event-stream")

HEAD = '''"""{}

Written by clients/python/generate.py from docs/openapi.json; do not edit.
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
                words.append(f"{field!r}: {annotation}")
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
    """Return the text of each generated module, by its name, before it is formatted."""
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
        media = next(entry["responses"][status] for status in ("200", "202") if status in entry["responses"])["content"]
        places = [parameter["name"] for parameter in entry.get("parameters", ()) if parameter["in"] == "path"]
        asked = (
            f"**question: Unpack[documents.{types.annotation(requests[name], sent=True)}]" if name in requests else ""
        )
        rows.append(f"{name!r}: Operation({method!r}, {path!r}, {entry['summary']!r}),")
        answers = {"": media["application/json"]["schema"]} if "application/json" in media else {}
        answers |= {"_svg" if answers else "": {"type": "string"} for kind in media if kind in TEXT}
        for suffix, schema in answers.items():
            plain = schema.get("type") == "string" or not schema
            answer = types.annotation(schema, sent=False)
            answer = {"str": "str", "Any": "dict[str, Any]"}[answer] if plain else f"documents.{answer}"
            kind = next((kind for kind in media if kind in TEXT), None) if plain and schema else None
            passed = "".join(f", {place}={place}" for place in places)
            call = f"self._ask({name!r}, {'question' if asked else 'None'}, {kind!r}{passed})"
            given = "".join(f", {place}: str" for place in places)
            head = f"def {name}{suffix}(self{given}{', ' + asked if asked else ''}) -> {answer}:"
            text = f'"""{entry["summary"]}{", as a drawing" if suffix else ""}."""'
            methods.append(f"    {head}\n        {text}\n        found: {answer} = {call}\n        return found\n")
            awaited.append(
                f"    async {head}\n        {text}\n        found: {answer} = await {call}\n        return found\n"
            )
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
        + "from typing import Any, NamedTuple, Unpack\n\n"
        + "from polhode_client import documents\n\n\n"
        + 'class Operation(NamedTuple):\n    """Method, path and summary."""\n\n'
        + "    method: str\n    path: str\n    summary: str\n\n"
        + "    def at(self, **places: str) -> Operation:\n"
        + '        """Return the operation with the braces of its path filled."""\n'
        + "        return self._replace(path=self.path.format(**places)) if places else self\n\n\n"
        + "OPERATIONS: Mapping[str, Operation] = {\n    "
        + "\n    ".join(rows)
        + "\n}\n\n\n"
        + _class("Operations", "def _ask", "Methods of the blocking client.", methods)
        + "\n\n"
        + _class("AsyncOperations", "async def _ask", "Methods of the asynchronous client.", awaited),
    }


def _class(name: str, ask: str, text: str, methods: list[str]) -> str:
    return (
        f'class {name}(ABC):\n    """{text}"""\n\n    @abstractmethod\n'
        f"    {ask}(self, name: str, question: Mapping[str, Any] | None, media: str | None, **places: str) -> Any:\n"
        f'        """Return what an operation answers, in a media type or as its document.\n\n'
        f'        `places` fill the braces of its path."""\n\n' + "\n".join(methods)
    )


def formatted(text: str, name: str) -> str:
    """Return a module as the formatter writes it."""
    command = [sys.executable, "-m", "ruff", "format", "--stdin-filename", str(PACKAGE / name), "-"]
    return subprocess.run(command, input=text, capture_output=True, text=True, check=True).stdout


def modules() -> dict[str, str]:
    """Return what the generated modules should hold, by name."""
    return {name: formatted(text, name) for name, text in generated(json.loads(DOCUMENT.read_text())).items()}


if __name__ == "__main__":
    for name, text in modules().items():
        (PACKAGE / name).write_text(text)
