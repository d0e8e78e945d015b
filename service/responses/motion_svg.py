"""Columns of a motion over time as SVG: one panel for each unit."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from typing import Any

import numpy as np

from core.arrays import Floats
from core.errors import InvalidParameter
from service.responses.linear_svg import Line, Panel
from service.responses.unit_text import unit_text


@dataclass(frozen=True)
class Column:
    """A quantity at every time.

    Attributes
    ----------
    name, unit : str
    values : ndarray, shape (n,) or (n, k)
    components : str
        Their names, a letter each; those of quaternions are w, x, y, z.
    """

    name: str
    unit: str
    values: Floats
    components: str = "xyz"


def numbers(values: Any) -> Floats:
    """Return samples, in doubles or as decimal strings, as an array of doubles.

    Raises
    ------
    InvalidParameter
        For decimal strings beyond the range of doubles.
    """
    found = np.asarray(values, dtype=np.float64)
    if not np.isfinite(found).all():
        remedy = "accept application/json instead"
        raise InvalidParameter("times", "have samples within the range of doubles, for a figure", remedy=remedy)
    return found


def over_time(time: Any, columns: Iterable[Column]) -> list[Panel]:
    """Return a panel for each unit, with the columns that have it; times may be in any order."""
    instants = numbers(time)
    order = np.argsort(instants, kind="stable")
    by_unit: dict[str, list[Line]] = {}
    for column in columns:
        by_unit.setdefault(unit_text(column.unit), []).extend(_lines(column, instants[order], column.values[order]))
    return [Panel("time (s)", unit, lines) for unit, lines in by_unit.items()]


def _lines(column: Column, time: Floats, values: Floats) -> Iterator[Line]:
    if values.ndim == 1:
        yield Line(column.name, time, values)
        return
    components = "wxyz" if values.shape[1] == 4 else column.components
    for k in range(values.shape[1]):
        yield Line(f"{column.name}.{components[k]}", time, values[:, k])
