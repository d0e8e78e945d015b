"""The unit in which a number of a description is written."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from typing import Any

from core.errors import Path
from core.multibody.language.declared_units import declared_units
from core.multibody.language.scene import Scene

DEGREES, VALUE, UNIT = "degrees", "value", "unit"
"""Members of ``{"degrees": number}`` and of ``{"value": number, "unit": text}``."""


def unit_at(scene: Scene, path: Path) -> str | None:
    """Return the unit in which the number at a path of a description is written, None where it is not known.

    A plain number is in the SI unit that its field declares; one of `let` in that of all fields that are its name.
    """
    part, (name, *rest) = _part_of(scene, path)
    value = _field(part, str(name))
    if rest and rest[-1] == DEGREES:
        return "deg"
    holder = _inside(value, rest[:-1])
    if rest and rest[-1] == VALUE and isinstance(holder, Mapping) and isinstance(holder.get(UNIT), str):
        return str(holder[UNIT])
    if name == "let" and len(rest) == 1:
        used = {*_units_of_uses(scene, str(rest[0]))}
        return used.pop() if len(used) == 1 else None
    units = declared_units(type(part))  # type: ignore[arg-type]
    # A word of Python's has a sign behind it as the name of a field.
    declared = units.get(str(name)) or units.get(f"{name}_")
    return None if declared is None else declared.unit_at(tuple(rest), getattr(part, "measure", None))


def within_object(scene: Scene, path: Path) -> Path | None:
    """Return where the plain number stands in what is written with its unit at a path, None if nothing such is."""
    part, (name, *rest) = _part_of(scene, path)
    return number_within(_inside(_field(part, str(name)), rest), path)


def number_within(found: object, path: Path) -> Path | None:
    """Return the place of the number in ``{"degrees"}`` or ``{"value", "unit"}`` at a path; None for anything else."""
    keys = set(found) if isinstance(found, Mapping) else set()
    return (*path, DEGREES) if keys == {DEGREES} else (*path, VALUE) if keys == {VALUE, UNIT} else None


def _part_of(scene: Scene, path: Path) -> tuple[Any, Path]:
    """Return the body, the connection or the scene that has what stands at a path, and the path within it."""
    if path[0] == "bodies" and len(path) > 2 and path[1] in scene.bodies:
        return scene.bodies[str(path[1])], path[2:]
    if path[0] == "connections" and len(path) > 2 and isinstance(path[1], int) and path[1] < len(scene.connections):
        return scene.connections[path[1]], path[2:]
    return scene, path


def _units_of_uses(scene: Scene, name: str) -> Iterator[str | None]:
    """Yield the units of the numbers that are a name of `let`, or its negative."""
    for part in (scene, *scene.bodies.values(), *scene.connections):
        for field, declared in declared_units(type(part)).items():  # type: ignore[arg-type]
            for path, text in _texts(getattr(part, field)):
                # A place may be the name of a body.
                if text.strip().removeprefix("-").strip() == name and name not in scene.bodies:
                    yield declared.unit_at(path, getattr(part, "measure", None))


def _texts(found: object, path: Path = ()) -> Iterator[tuple[Path, str]]:
    if isinstance(found, str):
        yield path, found
    elif isinstance(found, (Mapping, Sequence)):
        for step, entry in found.items() if isinstance(found, Mapping) else enumerate(found):
            yield from _texts(entry, (*path, step))


def _field(part: Any, name: str) -> Any:
    return getattr(part, name, getattr(part, f"{name}_", None))


def _inside(found: Any, path: Sequence[str | int]) -> Any:
    for step in path:
        if isinstance(found, Mapping):
            found = found.get(step)
        elif isinstance(found, Sequence) and not isinstance(found, str) and isinstance(step, int):
            found = found[step] if step < len(found) else None
        else:
            return None
    return found
