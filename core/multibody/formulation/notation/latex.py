"""Formulas as LaTeX."""

from __future__ import annotations

from core.formulas import Node
from core.multibody.formulation.notation.names import LETTERS, symbol_of

_OWN = {"sin", "cos", "tan", "sinh", "cosh", "tanh", "exp", "min", "max"}
"""Functions that LaTeX has a command for; others are written upright."""
_USUAL = {"log": "ln", "asin": "arcsin", "acos": "arccos", "atan": "arctan"}
_RANK = {"+": 1, "-": 1, "negative": 2, "*": 3, "^": 4}
_DOTS = {0: "{}", 1: r"\dot{{{}}}", 2: r"\ddot{{{}}}"}


def latex(node: Node) -> str:
    """Return a formula as LaTeX, without signs of mathematics about it."""
    match node.kind:
        case "number":
            digits, _, power = node.text.partition("e")
            return rf"{digits} \cdot 10^{{{int(power)}}}" if power else digits
        case "name":
            return _name(node.text)
        case "pi":
            return r"\pi"
        case "negative":
            return f"-{_inside(node.inner[0], 3)}"
        case "+" | "-":
            first, second = node.inner
            return f"{_inside(first, 1)} {node.kind} {_inside(second, 2)}"
        case "*":
            first, second = node.inner
            sign = r" \cdot " if second.kind == "number" else r" \, "
            return f"{_inside(first, 3)}{sign}{_inside(second, 3)}"
        case "/":
            return rf"\frac{{{latex(node.inner[0])}}}{{{latex(node.inner[1])}}}"
        case "^":
            return _power(*node.inner)
        case "sqrt":
            return rf"\sqrt{{{latex(node.inner[0])}}}"
        case "abs":
            return rf"\left| {latex(node.inner[0])} \right|"
    return f"{_command(node.kind)}{_arguments(node)}"


def _power(base: Node, exponent: Node) -> str:
    if base.kind in _OWN and len(base.inner) == 1:
        return rf"{_command(base.kind)}^{{{latex(exponent)}}}{_arguments(base)}"
    return f"{_inside(base, 5)}^{{{latex(exponent)}}}"


def _command(function: str) -> str:
    usual = _USUAL.get(function, function)
    return rf"\{usual}" if function in _OWN or function in _USUAL else rf"\operatorname{{{usual}}}"


def _arguments(node: Node) -> str:
    shown = ", ".join(latex(one) for one in node.inner)
    # One letter needs no parentheses.
    return f" {shown}" if len(node.inner) == 1 and node.inner[0].kind == "name" else rf"\left( {shown} \right)"


def _name(name: str) -> str:
    letter, index, order = symbol_of(name)
    shown = "".join(LETTERS.get(one, one) for one in letter)
    if letter[:1] == "Δ":
        shown = rf"\Delta {letter[1:]}"
    elif len(letter) > 1:
        shown = rf"\mathit{{{shown}}}"
    shown = _DOTS[min(order, 2)].format(shown)
    return shown if not index else rf"{shown}_{{\text{{{index.replace('_', chr(92) + '_')}}}}}"


def _inside(node: Node, rank: int) -> str:
    text = latex(node)
    return text if _RANK.get(node.kind, 5) >= rank else rf"\left( {text} \right)"
