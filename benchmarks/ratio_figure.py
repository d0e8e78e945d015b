"""A figure of stated over observed: for every class a bar from its 10 % to its 90 % quantile, whiskers beyond."""

from __future__ import annotations

import math
from typing import Any

# Okabe and Ito's colours, told apart with any colour vision; the rows are labelled as well.
COLOURS = {"inherited": "#0072B2", "inherited, attitude": "#56B4E9", "error": "#D55E00"}
LEFT, RIGHT, ROW, DECADES = 285.0, 850.0, 19.0, 4


def drawn(classes: list[dict[str, Any]]) -> str:
    """Return the figure as SVG."""
    groups: list[tuple[str, list[tuple[str, dict[str, Any]]]]] = []
    for of in sorted({row["of"] for row in classes}, key=lambda of: (not of.startswith("inherited"), of)):
        mine = [row for row in classes if row["of"] == of]
        lines = [(row["kind"], row) for row in mine if row["regime"] == "all" and row["kind"] != "all"]
        if of == "inherited":
            lines += [(row["regime"], row) for row in mine if row["kind"] == "all" and row["regime"] != "all"]
        if not of.startswith("inherited"):
            lines = [("", row) for row in mine if row["regime"] == row["kind"] == "all"]
        groups.append((of, lines))
    parts, y = [], 64.0
    for of, lines in groups:
        parts.append(f'<text x="20" y="{y + 4:.0f}" font-weight="bold">{of}</text>')
        if of.startswith("inherited"):
            y += ROW
        for name, row in lines:
            parts += _bar(name, row, COLOURS.get(of, COLOURS["error"]), y)
            y += ROW
        y += 5.0
    grid = []
    for k in range(DECADES + 1):
        x, stroke = _x(10.0**k), "#000" if k == 0 else "#ddd"
        grid.append(f'<line x1="{x:.1f}" y1="44" x2="{x:.1f}" y2="{y:.0f}" stroke="{stroke}"/>')
        grid.append(f'<text x="{x:.1f}" y="{y + 16:.0f}" text-anchor="middle" fill="#333">{10**k:g}</text>')
    head = (
        '<text x="20" y="22" font-size="15">Stated over observed: never left of 1</text>'
        '<text x="20" y="38" fill="#555">bar: 10 to 90 % of the cases, dot and number: median, line: all</text>'
    )
    box = f'viewBox="0 0 900 {y + 26:.0f}" font-family="sans-serif" font-size="12"'
    return (
        f'<svg xmlns="http://www.w3.org/2000/svg" {box}>'
        f'<rect width="900" height="{y + 26:.0f}" fill="white"/>{head}{"".join(grid)}{"".join(parts)}</svg>\n'
    )


def _x(ratio: float) -> float:
    share = min(max(math.log10(ratio) / DECADES, -0.02), 1.0)
    return LEFT + (RIGHT - LEFT) * share


def _bar(name: str, row: dict[str, Any], colour: str, y: float) -> list[str]:
    low, high = _x(row["p10"]), _x(row["p90"])
    width = max(high - low, 1.0)
    return [
        f'<text x="{LEFT - 12}" y="{y + 4:.0f}" text-anchor="end">{name}</text>',
        f'<line x1="{_x(row["min"]):.1f}" y1="{y:.0f}" x2="{_x(row["max"]):.1f}" y2="{y:.0f}" stroke="{colour}"/>',
        f'<rect x="{low:.1f}" y="{y - 5:.0f}" width="{width:.1f}" height="10" fill="{colour}" opacity="0.55"/>',
        f'<circle cx="{_x(row["median"]):.1f}" cy="{y:.0f}" r="3.5" fill="#000"/>',
        f'<text x="{RIGHT + 2:.0f}" y="{y + 4:.0f}" fill="#333">{row["median"]:.2g}</text>',
    ]
