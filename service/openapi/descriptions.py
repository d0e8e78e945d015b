"""Descriptions of fields in the OpenAPI document, from where they stand already: the docstrings and units of core."""

from __future__ import annotations

import inspect
import re
from collections.abc import Iterable, Mapping
from typing import Any

_SECTION = re.compile(
    r"\n\s*(?:Attributes|Parameters)\n\s*-{3,}\n(.*?)(?=\n\s*[A-Z][A-Za-z ]+\n\s*-{3,}\n|\Z)", re.DOTALL
)
_ENTRY = re.compile(r"^(\w[\w, ]*?) : ", re.MULTILINE)


def attributes_of(text: str) -> dict[str, str]:
    """Return the descriptions of the attributes that a numpydoc docstring lists, by name."""
    section = _SECTION.search(inspect.cleandoc(text))
    if section is None:
        return {}
    found: dict[str, str] = {}
    entries = [*_ENTRY.finditer(section[1])]
    for entry, following in zip(entries, [*entries[1:], None], strict=True):
        block = section[1][entry.start() : following.start() if following else None]
        words = " ".join(" ".join(block.split("\n")[1:]).split())
        if words:
            found |= {name.strip(): words for name in entry[1].split(",")}
    return found


def inherited_of(cls: type) -> dict[str, str]:
    """Return the descriptions of the attributes of a class and of those that it is built on."""
    found: dict[str, str] = {}
    for base in reversed(cls.__mro__):
        found |= attributes_of(base.__doc__ or "") if base is not object else {}
    return found


def describe(schemas: Mapping[str, Any], classes: Iterable[type]) -> None:
    """Give fields without a description that of their docstring; take the lists out of descriptions.

    Parameters
    ----------
    schemas : mapping
        Components of an OpenAPI document, by name; changed in place.
    classes : iterable of type
        Those whose names schemas bear.
    """
    known = {cls.__name__: inherited_of(cls) for cls in classes}
    for title, schema in schemas.items():
        own = known.get(title, {}) | attributes_of(schema.get("description", ""))
        if "description" in schema:
            schema["description"] = _SECTION.sub("", inspect.cleandoc(schema["description"])).strip()
        for name, field in schema.get("properties", {}).items():
            words = own.get(name)
            if words and "description" not in field:
                field["description"] = words
