"""Functions of several pieces, which change from one to another where an argument is zero."""

from __future__ import annotations

from collections.abc import Iterator

from core.formulas import Node

SWITCHING = ("abs", "sign", "min", "max", "if")
"""Functions that change their piece where their first argument is zero, or where two arguments are equal."""


def argument_of(node: Node) -> Node:
    """Return what is zero where a function changes its piece."""
    return Node("-", inner=node.inner) if node.kind in ("min", "max") else node.inner[0]


def switches_of(node: Node) -> Iterator[Node]:
    """Yield the functions of several pieces in a formula."""
    if node.kind in SWITCHING:
        yield node
    for inner in node.inner:
        yield from switches_of(inner)


_ONE = Node("number", "1")


def ends_of_domain(node: Node) -> Iterator[Node]:
    """Yield what is zero where a formula leaves its domain."""
    match node.kind:
        case "sqrt" | "log":
            yield node.inner[0]
        case "tan":
            yield Node("cos", inner=node.inner)
        case "/":
            yield node.inner[1]
        case "^":
            # A whole power of zero is told from others by its value alone, which goes on.
            yield node.inner[0]
        case "asin" | "acos":
            yield Node("-", inner=(_ONE, Node("*", inner=(node.inner[0], node.inner[0]))))
    for inner in node.inner:
        yield from ends_of_domain(inner)
