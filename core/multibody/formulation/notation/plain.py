"""Formulas as text that the grammar of `core.formulas` reads back, with a prime for each derivative by time."""

from __future__ import annotations

from core.formulas import Node

_RANK = {"+": 1, "-": 1, "negative": 2, "*": 3, "/": 3, "^": 4}
"""How tightly operations bind; numbers, names and functions bind most."""


def plain(node: Node) -> str:
    """Return a formula as text."""
    match node.kind:
        case "number" | "name":
            return node.text
        case "pi":
            return "pi"
        case "negative":
            return f"-{_inside(node.inner[0], 3)}"
        case "+" | "-":
            first, second = node.inner
            return f"{_inside(first, 1)} {node.kind} {_inside(second, 2)}"
        case "*" | "/":
            first, second = node.inner
            return f"{_inside(first, 3)}{node.kind}{_inside(second, 4)}"
        case "^":
            first, second = node.inner
            return f"{_inside(first, 5)}^{_inside(second, 5)}"
    return f"{node.kind}({', '.join(plain(one) for one in node.inner)})"


def _inside(node: Node, rank: int) -> str:
    text = plain(node)
    return text if _RANK.get(node.kind, 5) >= rank else f"({text})"
