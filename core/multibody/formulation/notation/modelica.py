"""Formulas as expressions of Modelica (Modelica Language Specification 3.6, appendix A)."""

from __future__ import annotations

from collections.abc import Callable

from core.errors import NotApplicable
from core.formulas import Node

FUNCTIONS = (
    *("sqrt", "sin", "cos", "tan", "asin", "acos", "atan", "sinh", "cosh", "tanh", "exp", "log", "abs", "sign"),
    *("atan2", "min", "max"),
)
"""Functions that Modelica has under the names of formulas."""

RESERVED = {
    *("algorithm", "and", "annotation", "block", "break", "class", "connect", "connector", "constant", "constrainedby"),
    *("der", "discrete", "each", "else", "elseif", "elsewhen", "encapsulated", "end", "enumeration", "equation"),
    *("expandable", "extends", "external", "false", "final", "flow", "for", "function", "if", "import", "impure", "in"),
    *("initial", "inner", "input", "loop", "model", "not", "operator", "or", "outer", "output", "package", "parameter"),
    *("partial", "protected", "public", "pure", "record", "redeclare", "replaceable", "return", "stream", "then"),
    *("true", "type", "when", "while", "within"),
    *("Boolean", "Clock", "Integer", "Real", "String", "StateSelect", "time"),
}
"""Keywords (section 2.3.3), types that are built in, and the time: no variable may be called so."""

_RANK = {"+": 1, "-": 1, "negative": 2, "*": 3, "/": 3, "^": 4}
"""How tightly operations bind; numbers, names and functions bind most."""


def modelica(node: Node, called: Callable[[str], str]) -> str:
    """Return a formula as an expression.

    Parameters
    ----------
    node : Node
    called : callable
        Returns what stands for a name of the formula, with a prime for each derivative by time.

    Raises
    ------
    NotApplicable
        For a function that Modelica does not have.
    """

    def inside(inner: Node, rank: int) -> str:
        text = modelica(inner, called)
        return text if _RANK.get(inner.kind, 5) >= rank else f"({text})"

    match node.kind:
        case "number":
            return node.text
        case "name":
            return called(node.text)
        case "pi":
            return "pi"
        case "negative":
            return f"-{inside(node.inner[0], 3)}"
        case "+" | "-":
            first, second = node.inner
            # A sign stands before the first term of a sum alone.
            return f"{inside(first, 1)} {node.kind} {inside(second, 3)}"
        case "*" | "/":
            first, second = node.inner
            return f"{inside(first, 3)}{node.kind}{inside(second, 4)}"
        case "^":
            first, second = node.inner
            return f"{inside(first, 5)}^{inside(second, 5)}"
        case "if":
            condition, then, otherwise = (modelica(inner, called) for inner in node.inner)
            return f"(if {condition} > 0 then {then} else {otherwise})"
        case function if function in FUNCTIONS:
            return f"{function}({', '.join(modelica(inner, called) for inner in node.inner)})"
    raise NotApplicable(f"Modelica has no {node.kind} as formulas have it", path=("format",))
