"""The names, kinds, lengths and units of the documents that a validator admits, read off its schema."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

Step = str | int

OBJECT, ARRAY = "<object>", "<array>"
"""Labels of the members of a union of an object and an array; a fault in the member not meant is dropped."""


class Layout:
    """What a validator's schema says of the documents that it admits.

    Attributes
    ----------
    tags : mapping of str to mapping of str to None
        For each name of a field that holds members of a union, their tags in order.
    names : mapping of str to mapping of str to None
        For each tag, or name of a field that holds an object, the keys of the object; for ``""`` those of the document.
    lengths : mapping of str to int
        For each name of a field that holds an array of fixed length, that length.
    maps : set of str
        Names of the fields that hold objects whose keys the client chooses.
    """

    def __init__(self, schema: Any) -> None:
        self.tags: dict[str, dict[str, None]] = {}
        self.names: dict[str, dict[str, None]] = {}
        self.lengths: dict[str, int] = {}
        self.maps: set[str] = set()
        self._units: dict[str, set[str]] = {}
        self._definitions: dict[str, Any] = {}
        self._followed: set[tuple[str, str]] = set()
        self._gather(schema)
        self._walk(schema, "", "")

    @property
    def of_free_rotation(self) -> bool:
        """Whether the documents ask about a body that turns freely."""
        names = self.names.get("", {})
        return "body" in names and not {"angular_velocity", "angular_velocities", "disturbance"}.isdisjoint(names)

    def unit_of(self, name: str) -> str:
        """Return the SI unit of the quantities in fields of a name; "1" where they share none."""
        units = self._units.get(name, set())
        return next(iter(units)) if len(units) == 1 else "1"

    def steps(self, location: Sequence[Step]) -> tuple[tuple[Step, ...], str]:
        """Return a location without the names of members of unions, and by what the object around its end is known."""
        found: list[Step] = []
        owners = ["", ""]
        tags = self.tags.get("", {})
        for step in location:
            if step in (OBJECT, ARRAY):
                continue
            if isinstance(step, str) and found and found[-1] in self.maps and owners[-1] == found[-1]:
                # A name that the client chose says nothing of what it names.
                pass
            elif isinstance(step, str):
                owners.append(step)
                if step in tags:
                    tags = {}
                    continue
                tags = self.tags.get(step, {})
            found.append(step)
        return tuple(found), owners[-2]

    def _gather(self, node: Any) -> None:
        if isinstance(node, Mapping):
            if "ref" in node:
                self._definitions[node["ref"]] = node
            for value in node.values():
                self._gather(value)
        elif isinstance(node, (list, tuple)):
            for value in node:
                self._gather(value)

    def _walk(self, node: Any, name: str, owner: str) -> None:
        """Look at what a field holds that may have tags, as whose member, or an object that is known as `owner`."""
        if isinstance(node, (list, tuple)):
            for value in node:
                self._walk(value, name, owner)
        if not isinstance(node, Mapping):
            return
        kind = node.get("type")
        if kind == "dict" and name:
            self.maps.add(name)
        if kind in ("float", "int"):
            self._units.setdefault(owner, set()).add(node.get("metadata", {}).get("unit", "1"))
        if kind == "definition-ref":
            reference = node["schema_ref"]
            if (reference, owner) not in self._followed and reference in self._definitions:
                self._followed.add((reference, owner))
                self._walk(self._definitions[reference], name, owner)
        elif kind == "tagged-union":
            self.tags.setdefault(name, {}).update(dict.fromkeys(node["choices"]))
            for tag, member in node["choices"].items():
                self._walk(member, "", tag)
        elif kind == "model-fields":
            for key, value in node["fields"].items():
                self._field(key, value, owner)
        elif kind == "dataclass-field":
            self._field(node["name"], node["schema"], owner)
        else:
            if kind == "tuple" and name and "variadic_item_index" not in node:
                self.lengths[name] = len(node["items_schema"])
                name = ""
            for key, value in node.items():
                if key not in ("definitions", "metadata"):
                    self._walk(value, name, owner)

    def _field(self, name: str, schema: Any, owner: str) -> None:
        self.names.setdefault(owner, {})[name] = None
        self._walk(schema, name, name)
