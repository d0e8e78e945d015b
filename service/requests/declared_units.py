"""Units that the model of a question or an answer declares, found by the path of a figure in its annotations.

The JSON schemas hold the same; making those takes some 50 ms for each route.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import is_dataclass
from functools import cache
from types import UnionType
from typing import Annotated, Any, Literal, Union, get_args, get_origin, get_type_hints

from pydantic import BaseModel

from core.errors import Path
from service.requests.annotations import ANNOTATED

Node = tuple[Any, str | None]
"""An annotation without its marks, and the unit that they, or those of what holds it, give to the numbers in it."""


def unit_at(model: Any, path: Path) -> str | None:
    """Return the unit that a model declares for the numbers at a path, None if it declares none there."""
    nodes = [*_bare(model, None)]
    for step in path:
        nodes = [inner for node in nodes for inner in _stepped(node, step)]
    return next((unit for node in nodes for unit in _units(node)), None)


def outputs_of(model: Any) -> frozenset[str]:
    """Return what a question may name as its outputs, nothing if it has no such field."""
    nodes = [inner for node in _bare(model, None) for inner in _stepped(node, "outputs")]
    named = [inner for node in nodes for inner in _stepped(node, 0)]
    return frozenset(name for hint, _ in named if _origin(hint) is Literal for name in get_args(hint))


def has_field(model: Any, *path: str | int) -> bool:
    """Return whether a question may have a field."""
    nodes = [*_bare(model, None)]
    for step in path:
        nodes = [inner for node in nodes for inner in _stepped(node, step)]
    return bool(nodes)


def unknown_name(model: Any, path: Path) -> tuple[int, list[str]] | None:
    """Return where a path has a name that no document of a model has, and the names that it has there.

    Returns
    -------
    (int, list of str) or None
        The number of the step, and the fields; None for a path that some document may have.
    """
    nodes = [*_bare(model, None)]
    for k, step in enumerate(path):
        inner = [one for node in nodes for one in _stepped(node, step)]
        if not inner:
            fields = [name for hint, _ in nodes for name in _fields(_origin(hint) or hint)]
            plain = all(_fields(_origin(hint) or hint) or hint is type(None) for hint, _ in nodes)
            return (k, fields) if fields and plain and isinstance(step, str) else None
        nodes = inner
    return None


def numbers_within(model: Any, document: Any) -> Iterator[tuple[str, float]]:
    """Yield unit and magnitude of the numbers of a document that its model declares units for."""
    yield from _numbers([*_bare(model, None)], document)


def _numbers(nodes: list[Node], document: Any) -> Iterator[tuple[str, float]]:
    if type(document) in (int, float):
        unit = next((unit for node in nodes for unit in _units(node)), None)
        if unit is not None:
            yield unit, abs(float(document))
    elif isinstance(document, (dict, list)):
        entries: Any = document.items() if isinstance(document, dict) else enumerate(document)
        for step, entry in entries:
            yield from _numbers([inner for node in nodes for inner in _stepped(node, step)], entry)


def _origin(hint: Any) -> Any:
    return get_origin(hint)


def _bare(hint: Any, unit: str | None) -> Iterator[Node]:
    """Yield the members of an annotation without its marks."""
    origin = _origin(hint)
    if origin is Annotated:
        inner, *marks = get_args(hint)
        yield from _bare(inner, _marked(marks) or unit)
    elif origin in (Union, UnionType):
        for member in get_args(hint):
            yield from _bare(member, unit)
    else:
        yield hint, unit


def _marked(marks: Any) -> str | None:
    return next((mark.unit for mark in marks if isinstance(getattr(mark, "unit", None), str)), None)


def _stepped(node: Node, step: str | int) -> Iterator[Node]:
    hint, unit = node
    origin = _origin(hint)
    args = get_args(hint)
    if isinstance(step, int):
        if origin is list or (origin is tuple and args[-1:] == (...,)):
            yield from _bare(args[0], unit)
        elif origin is tuple and step < len(args):
            yield from _bare(args[step], unit)
    elif origin in (dict, Mapping):
        yield from _bare(args[1], unit)
    elif step in (fields := _fields(origin or hint)):
        yield from _bare(fields[step], unit)


@cache
def _fields(owner: Any) -> Mapping[str, Any]:
    """Return the annotated fields of a class, with their marks."""
    if not isinstance(owner, type):
        return {}
    if issubclass(owner, BaseModel):
        return {
            name: ANNOTATED[field.annotation, *field.metadata] if field.metadata else field.annotation
            for name, field in owner.model_fields.items()
        }
    return get_type_hints(owner, include_extras=True) if is_dataclass(owner) or hasattr(owner, "_fields") else {}


def _units(node: Node) -> Iterator[str]:
    """Yield the unit of a number, or of the first number of an array."""
    hint, unit = node
    origin = _origin(hint)
    args = get_args(hint)
    if origin in (list, tuple) and args:
        for inner in _bare(args[0], unit):
            yield from _units(inner)
    elif unit is not None and not (isinstance(hint, type) and issubclass(hint, (BaseModel, str, bool))):
        yield unit
