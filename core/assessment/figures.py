"""Figures of an answer: found by JSON pointer, and the form by which each is compared."""

from __future__ import annotations

import re
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import is_dataclass
from typing import Any

import numpy as np

from core.assessment.compare import Form
from core.errors import InvalidParameter, Path
from core.formulas import is_name

DESCRIBED = "scenes"
"""Subject of questions about described scenes."""

EQUAL = 1e-9
"""Difference of moments, of the largest, up to which they count as equal."""


_ONE_VALUE = (np.generic, bool, int, float, str, type(None))


def steps_of(pointer: str) -> Path:
    """Return the steps of an RFC 6901 JSON pointer into an answer.

    Raises
    ------
    InvalidParameter
        If it is none, or leads to the whole document.
    """
    if not pointer.startswith("/"):
        raise InvalidParameter((), "be a JSON pointer into the answer", remedy='such as "/flip_interval"')
    plain = (step.replace("~1", "/").replace("~0", "~") for step in pointer[1:].split("/"))
    return tuple(int(step) if _is_place(step) else step for step in plain)


def _is_place(step: str) -> bool:
    """Return whether a step may be a place in an array: by RFC 6901 it has no leading zeros."""
    return step.isascii() and step.isdigit() and len(step) < 10 and str(int(step)) == step


def value_at(answer: Any, path: Path) -> Any:
    """Return the figure at a path of an answer: a number, a string, true or false, an array of finite numbers, or None.

    Objects, and arrays that hold anything else, are no figures, and None too.
    """
    found = answer
    for step in path:
        found = inside(found, step)
        if found is None:
            return None
    if isinstance(found, (np.generic, bool, int, float, str)):
        plain = found.item() if isinstance(found, np.generic) else found
        return float(plain) if type(plain) is int else plain
    if isinstance(found, (list, tuple, np.ndarray)):
        try:
            array = np.array(found, dtype=np.float64)
        except (TypeError, ValueError):
            return None
        return array if array.size and array.ndim <= 2 and np.isfinite(array).all() else None
    return None


def inside(found: Any, step: str | int) -> Any:
    """Return what stands inside of an object or an array, None where nothing does."""
    if isinstance(found, Mapping):
        return found.get(str(step))
    if isinstance(step, str):
        named = is_dataclass(found) or hasattr(found, "_fields")
        return getattr(found, step, None) if named and not step.startswith("_") else None
    if isinstance(found, (list, tuple, np.ndarray)) and not hasattr(found, "_fields"):
        return found[step] if step < len(found) else None
    return None


def figures_within(answer: Any, path: Path) -> list[str]:
    """Return the fields of the object at a path that are figures, null ones last; none where no object is."""
    found = answer
    for step in path:
        found = inside(found, step)
    if hasattr(found, "_asdict"):
        found = found._asdict()
    elif is_dataclass(found) and not isinstance(found, type):
        found = vars(found)
    if not isinstance(found, Mapping):
        return []
    figures = {
        str(name): entry
        for name, entry in found.items()
        if isinstance(entry, (*_ONE_VALUE, list, tuple, np.ndarray)) and str(name)[:1] != "_"
    }
    return sorted(figures, key=lambda name: (figures[name] is None, name))


def is_null(answer: Any, path: Path) -> bool:
    """Return whether the field at a path exists and is null."""
    outer = answer
    for step in path[:-1]:
        outer = inside(outer, step)
    last = path[-1]
    if isinstance(outer, Mapping):
        return last in outer and outer[last] is None
    if isinstance(last, str):
        return not last.startswith("_") and getattr(outer, last, 0) is None
    return isinstance(outer, (list, tuple)) and last < len(outer) and outer[last] is None


def form_of(path: Path, value: Any, unit: str) -> Form:
    """Return the form by which the figure at a path is compared."""
    if isinstance(value, (bool, str)):
        return "choice"
    if isinstance(value, float):
        return "angle" if unit == "rad" else "number"
    name = next((step for step in reversed(path) if isinstance(step, str)), "")
    shaped: Mapping[tuple[str, tuple[int, ...]], Form] = {
        ("attitude", (4,)): "attitude",
        ("axis", (3,)): "direction",
        ("axes", (3, 3)): "axes",
    }
    if (name, value.shape) in shaped:
        return shaped[name, value.shape]
    if name == "points" and value.ndim == 2 and np.array_equal(value[0], value[-1]) and len(value) > 1:
        return "curve"
    if name == "eigenvalues":
        return "set"
    if name in ("angular_velocity", "attitude") and value.ndim == 2:
        return "samples"
    return "vector" if value.ndim == 1 else "matrix"


def names_of(paths: Iterable[Path]) -> dict[str, Path]:
    """Return the default names of parameters.

    A number is named by its field, one of several with its place among them, counted from 1: gravity, masses_1. Where
    several numbers have one name so, each has the names of the fields around it before its own: light_mass, heavy_mass.
    """
    depths = dict.fromkeys(paths, 1)
    while True:
        places: dict[str, list[Path]] = {}
        for path, depth in depths.items():
            places.setdefault(_name_of(path, depth), []).append(path)
        unclear = [
            path
            for name, alike in places.items()
            for path in alike
            if (len(alike) > 1 or (depths[path] > 1 and not is_name(name))) and depths[path] < len(_fields(path))
        ]
        if not unclear:
            return {name: alike[-1] for name, alike in places.items()}
        for path in unclear:
            depths[path] += 1


def _name_of(path: Path, depth: int) -> str:
    """Return the last fields of a path, and its places in lists, as a word of a formula."""
    steps = [*_fields(path)[-depth:], *(str(step + 1) for step in path if isinstance(step, int))]
    return re.sub(r"\W", "_", "_".join(steps), flags=re.ASCII)


def _fields(path: Path) -> list[str]:
    return [step for step in path if isinstance(step, str)]


def equal_moments(moments: Sequence[float] | None) -> tuple[tuple[int, ...], ...]:
    """Return principal axes in groups of equal moments; neighbours, as moments ascend."""
    groups: list[list[int]] = []
    for k, moment in enumerate(() if moments is None else moments):
        if moments is not None and k and abs(moment - moments[k - 1]) <= EQUAL * abs(moments[-1]):
            groups[-1].append(k)
        else:
            groups.append([k])
    return tuple(map(tuple, groups))
