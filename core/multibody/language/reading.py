"""From JSON to the dataclasses of the language: fields that exist, kinds that exist, nothing missing."""

from __future__ import annotations

from collections.abc import Collection, Mapping, Sequence
from dataclasses import MISSING, fields
from typing import Any

from core.errors import InvalidParameter, Path
from core.multibody.language.body import SceneBody
from core.multibody.language.connection import Connection
from core.multibody.language.faults_of_parts import FaultsOfParts
from core.multibody.language.kinds import KINDS
from core.multibody.language.numerals import member
from core.multibody.language.scene import Scene, check_size
from core.near_names import did_you_mean


def scene_from(description: Any, kinds: Mapping[str, type[Connection]] = KINDS) -> Scene:
    """Return the scene that an object of JSON describes.

    Parameters
    ----------
    description : object
    kinds : mapping of str to type
        The kinds of connections that it may name.

    Raises
    ------
    InvalidParameter
        For fields that are missing or unknown, kinds that do not exist, and names that clash; for every body and
        connection that has such a fault.
    """
    given = _object(description, (), Scene)
    faults = FaultsOfParts()
    bodies = given.get("bodies")
    if isinstance(bodies, Mapping):
        check_size(bodies, ())
        read: dict[str, SceneBody] = {}
        for name, body in bodies.items():
            with faults.part():
                read[name] = SceneBody(**_object(body, member(("bodies",), name), SceneBody))
        given["bodies"] = read
    connections = given.get("connections", ())
    if isinstance(connections, Sequence) and not isinstance(connections, str):
        check_size((), connections)
        joined: list[Connection] = []
        for i, entry in enumerate(connections):
            with faults.part():
                joined.append(_connection(entry, ("connections", i), kinds))
        given["connections"] = tuple(joined)
    faults.raised()
    return Scene(**given)


def _connection(entry: Any, path: Path, kinds: Mapping[str, type[Connection]]) -> Connection:
    if not isinstance(entry, Mapping):
        raise InvalidParameter(path, "be an object")
    kind = entry.get("kind")
    if not isinstance(kind, str) or kind not in kinds:
        synonyms = {name: one.synonyms for name, one in kinds.items()}
        remedy = did_you_mean(kind, kinds, synonyms)
        raise InvalidParameter((*path, "kind"), f"be one of {', '.join(kinds)}", remedy=remedy)
    rest = {key: value for key, value in entry.items() if key != "kind"}
    return kinds[kind](**_object(rest, path, kinds[kind]))


def _object(value: Any, path: Path, cls: type[Any]) -> dict[str, Any]:
    if not isinstance(value, Mapping):
        raise InvalidParameter(path or ("scene",), "be an object")
    # A word of Python's has a sign behind it as the name of a field.
    known = {entry.name.rstrip("_"): entry for entry in fields(cls)}
    for key in value:
        if key not in known:
            raise unknown_field(key, known, path)
    for name, entry in known.items():
        if name not in value and entry.default is MISSING and entry.default_factory is MISSING:
            raise InvalidParameter((*path, name), "be given")
    return {known[key].name: entry for key, entry in value.items()}


def unknown_field(key: str, known: Collection[str], path: Path) -> InvalidParameter:
    """Return the fault of a field that does not exist in the object at a path."""
    rule = f"be left out; the fields here are {', '.join(known)}"
    return InvalidParameter(member(path, key), rule, remedy=did_you_mean(key, known))
