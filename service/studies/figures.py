"""Results as SVG: figures over one or two varied numbers as curves, otherwise how their values are distributed."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import numpy as np

from core.arrays import Floats
from service.responses.linear_svg import Line, Panel, panels
from service.responses.unit_text import unit_text
from service.studies.grids import names
from service.studies.results import Results

MOST_CURVES = 9
"""Curves of a panel; of more levels of the second number, as many are drawn, evenly chosen, and the title says so."""


def figure(results: Results) -> Iterator[bytes]:
    """Yield the results as an SVG document: one panel for each figure, without the members that have none."""
    about, shape = results.metadata(), tuple(results.study.plan["shape"])
    chunks = [*results.chunks()]
    inputs = np.concatenate([chunk.inputs for chunk in chunks])
    columns = np.concatenate([chunk.figures for chunk in chunks])
    inner = names([axis["pointer"] for axis in about["axes"]])
    axes = [_titled(name, axis) for name, axis in zip(inner, about["axes"], strict=True)]
    figures = names([column["pointer"] for column in about["columns"]])
    shown, drawn = [], ""
    for k, (name, column) in enumerate(zip(figures, about["columns"], strict=True)):
        up, values = _titled(name, column), columns[:, k]
        if any(axis["values"] is not None and not _numbers(axis["values"]) for axis in about["axes"]):
            shown.append(_distribution(up, values))
        elif len(axes) == 1 and about["request"].get("design", "product") in ("product", "zip"):
            shown.append(Panel(axes[0], up, [_curve("", _given(about["axes"][0], inputs[:, 0]), values)]))
        elif len(axes) == len(shape) == 2:
            first, second = (_given(axis, inputs[:, j]).reshape(shape) for j, axis in enumerate(about["axes"]))
            levels = np.unique(np.linspace(0, shape[1] - 1, min(MOST_CURVES, shape[1])).round().astype(int))
            rows = values.reshape(shape)
            lines = [_curve(f"{inner[1]} {second[0, j]:.6g}", first[:, j], rows[:, j]) for j in levels]
            shown.append(Panel(axes[0], up, lines))
            drawn = f"; curves at {len(levels)} of {shape[1]} values of {inner[1]}"
        else:
            shown.append(_distribution(up, values))
    yield panels(f"Study of {results.study.count} members{drawn}", shown).encode()


def _distribution(title: str, values: Floats) -> Panel:
    known = np.sort(values[np.isfinite(values)])
    share = np.arange(1, len(known) + 1) / max(1, len(known))
    return Panel(title, "share of members up to it", [Line("", known, share)])


def _curve(label: str, across: Floats, up: Floats) -> Line:
    known = np.isfinite(up)
    order = np.argsort(across[known], kind="stable")
    return Line(label, across[known][order], up[known][order])


def _given(axis: Any, column: Floats) -> Floats:
    """Return the numbers that a varied input had; listed values are stored by their place in the list."""
    return column if axis["values"] is None else np.array(axis["values"], dtype=np.float64)[column.astype(int)]


def _numbers(listed: Any) -> bool:
    return all(type(value) in (int, float) for value in listed)


def _titled(name: str, entry: Any) -> str:
    return name if entry.get("unit") is None else f"{name} ({unit_text(entry['unit'])})"
