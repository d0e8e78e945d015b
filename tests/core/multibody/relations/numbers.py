"""Numbers and vectors of a request, as they are written, changed exactly: by formulas around what was written."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

Json = dict[str, Any]


def text(number: Any) -> str:
    """Return a number as a formula."""
    if isinstance(number, dict):
        return f"({text(number['degrees'])})*pi/180"
    return number if isinstance(number, str) else repr(number)


def is_zero(number: Any) -> bool:
    return not isinstance(number, (str, dict)) and number == 0


def times(number: Any, factor: str) -> Any:
    return number if is_zero(number) or factor == "1" else f"({factor})*({text(number)})"


def plus(number: Any, other: Any) -> Any:
    if is_zero(number) or is_zero(other):
        return other if is_zero(number) else number
    return f"({text(number)})+({text(other)})"


def components(vector: Any) -> list[Any]:
    """Return the components of a vector, which may be polar."""
    if isinstance(vector, dict):
        r, angle = vector["polar"]
        return [f"({text(r)})*cos({text(angle)})", f"({text(r)})*sin({text(angle)})"]
    return list(vector)


def transformed(matrix: Sequence[Sequence[str]], vector: Any) -> list[Any]:
    """Return the product of a matrix of formulas and a vector."""
    own = components(vector)
    rows: list[Any] = []
    for row in matrix:
        total: Any = 0
        for factor, x in zip(row, own, strict=True):
            if factor != "0":
                total = plus(total, times(x, factor))
        rows.append(total)
    return rows
