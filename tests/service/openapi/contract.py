"""What an OpenAPI document promises, and which promises of a release another document breaks.

A client of an older release keeps working if it may send what it sent, and gets every field that it got. Breaks are: an
operation, a parameter, a field of a request or of a response that is gone; a new required field of a request; a type or
a value that a request may no longer have; a type that a response did not have; a field of a response that may be left
out. New values of enumerations in responses are no breaks: clients have to expect them.

``python -m tests.service.openapi.contract docs/openapi.json`` writes what a document promises.
"""

from __future__ import annotations

import json
import sys
from collections.abc import Iterator
from pathlib import Path
from typing import Any

METHODS = ("get", "put", "post", "delete", "options", "head", "patch")
WORDS = ("description", "summary", "title", "example", "examples", "default", "externalDocs", "tags", "info", "servers")
"""Members that promise nothing to a program."""

Document = dict[str, Any]


def promises(document: Any, named: bool = False) -> Any:
    """Return a document without what promises nothing; the keys of `named` objects are names of fields or types."""
    if isinstance(document, list):
        return [promises(entry) for entry in document]
    if not isinstance(document, dict):
        return document
    names = ("properties", "schemas", "parameters", "responses", "paths", "patternProperties")
    return {
        key: promises(entry, key in names and not named)
        for key, entry in document.items()
        if named or (key not in WORDS and not key.startswith("x-"))
    }


def breaks(old: Document, new: Document) -> list[str]:
    """Return the promises of an old document that a new one breaks, each with its place."""
    return sorted(set(_Comparison(old, new).operations()))


class _Comparison:
    """Walks two documents together."""

    def __init__(self, old: Document, new: Document) -> None:
        self.old, self.new = old, new
        self.made: list[Document] = []
        self.found: dict[tuple[int, int, bool], list[str]] = {}

    def operations(self) -> Iterator[str]:
        for path, methods in self.old["paths"].items():
            for method in METHODS:
                if method not in methods:
                    continue
                place = f"{method.upper()} {path}"
                other = self.new["paths"].get(path, {}).get(method)
                if other is None:
                    yield f"{place}: gone"
                else:
                    yield from self.operation(place, methods[method], other)

    def operation(self, place: str, old: Document, new: Document) -> Iterator[str]:
        theirs = {(one["name"], one["in"]): one for one in self.parameters(self.new, new)}
        ours = {(one["name"], one["in"]): one for one in self.parameters(self.old, old)}
        for key in ours.keys() - theirs.keys():
            yield f"{place}: parameter {key[0]} is gone"
        for key, one in theirs.items():
            if one.get("required") and not ours.get(key, {}).get("required"):
                yield f"{place}: parameter {key[0]} is required"
        yield from self.contents(f"{place} request", old.get("requestBody", {}), new.get("requestBody", {}), sent=True)
        for status, response in old["responses"].items():
            if status not in new["responses"]:
                yield f"{place}: response {status} is gone"
                continue
            pair = self.resolved(self.old, response), self.resolved(self.new, new["responses"][status])
            yield from self.contents(f"{place} {status}", *pair, sent=False)

    def parameters(self, document: Document, operation: Document) -> Iterator[Document]:
        for one in operation.get("parameters", ()):
            yield self.resolved(document, one)

    def contents(self, place: str, old: Document, new: Document, *, sent: bool) -> Iterator[str]:
        for media, content in old.get("content", {}).items():
            other = new.get("content", {}).get(media)
            if other is None:
                yield f"{place}: {media} is gone"
            elif "schema" in content and "schema" in other:
                yield from self.schemas(place, content["schema"], other["schema"], sent=sent)

    def schemas(self, place: str, old: Document, new: Document, *, sent: bool) -> Iterator[str]:
        old, new = self.resolved(self.old, old), self.resolved(self.new, new)
        # Schemas of scenes refer to one another in circles. Identities last as long as the documents.
        pair = id(old), id(new), sent
        if pair not in self.found:
            self.found[pair] = []
            self.found[pair] = list(self.compared(place, old, new, sent=sent))
        yield from self.found[pair]

    def compared(self, place: str, old: Document, new: Document, *, sent: bool) -> Iterator[str]:
        before, after = self.variants(self.old, old), self.variants(self.new, new)
        if any(sum(map(len, alternatives.values())) > 1 for alternatives in (before, after)):
            yield from self.unions(place, before, after, sent=sent)
            return
        fields, others = old.get("properties", {}), new.get("properties", {})
        for name in fields.keys() - others.keys():
            if new.get("type") == "object" or others:
                yield f"{place}: {name} is gone"
        needed, given = {*old.get("required", ())}, {*new.get("required", ())}
        for name in given - needed if sent else needed - given:
            yield f"{place}: {name} {'is required' if sent else 'may be left out'}"
        if sent and "enum" in new:
            for value in old.get("enum", ()):
                if value not in new["enum"]:
                    yield f"{place}: {value!r} is gone"
        for name in fields.keys() & others.keys():
            yield from self.schemas(f"{place}/{name}", fields[name], others[name], sent=sent)
        for inner in ("items", "additionalProperties"):
            if isinstance(old.get(inner), dict) and isinstance(new.get(inner), dict):
                yield from self.schemas(f"{place}/*", old[inner], new[inner], sent=sent)

    def unions(
        self, place: str, before: dict[str, list[Document]], after: dict[str, list[Document]], *, sent: bool
    ) -> Iterator[str]:
        for name in before.keys() - after.keys() if sent else after.keys() - before.keys():
            # A response may have a new alternative of objects, as it may have a new value of an enumeration.
            if sent or not name.startswith("object"):
                yield f"{place}: {'no longer' if sent else 'also'} {name}"
        for name in before.keys() & after.keys():
            # What may be sent still fits an alternative; what is answered fits one that it fitted.
            for one in before[name] if sent else after[name]:
                others = after[name] if sent else before[name]
                pairs = [(one, other) if sent else (other, one) for other in others]
                yield from min((list(self.schemas(place, *pair, sent=sent)) for pair in pairs), key=len)

    def variants(self, document: Document, schema: Document) -> dict[str, list[Document]]:
        """Return the alternatives of a schema by what tells them apart: type, and the tag of an object."""
        listed = schema.get("anyOf") or schema.get("oneOf")
        if not listed:
            types = schema.get("type")
            listed = [self.kept(schema | {"type": one}) for one in types] if isinstance(types, list) else [schema]
        found: dict[str, list[Document]] = {}
        for one in listed:
            own = self.resolved(document, one)
            tag = own.get("properties", {}).get("kind", {}).get("const", "")
            name = f"{own.get('type', 'anything')} {tag}".strip()
            if own.get("anyOf") or own.get("oneOf"):
                for inner, alternatives in self.variants(document, own).items():
                    found.setdefault(inner, []).extend(alternatives)
            else:
                found.setdefault(name, []).append(own)
        return found

    def kept(self, schema: Document) -> Document:
        """Return a schema that is made here, which lives as long as the documents."""
        self.made.append(schema)
        return schema

    @staticmethod
    def resolved(document: Document, entry: Document) -> Document:
        while "$ref" in entry:
            found: Any = document
            for step in entry["$ref"].removeprefix("#/").split("/"):
                found = found[step]
            entry = found
        return entry


if __name__ == "__main__":
    kept = promises(json.loads(Path(sys.argv[1]).read_text(encoding="utf-8")))
    json.dump(kept, sys.stdout, separators=(",", ":"), sort_keys=True)
    sys.stdout.write("\n")
