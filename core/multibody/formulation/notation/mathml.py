"""Formulas as presentation MathML, which browsers draw and screen readers read."""

from __future__ import annotations

from xml.sax.saxutils import escape

from core.formulas import Node
from core.multibody.formulation.notation.names import symbol_of

_USUAL = {"log": "ln", "asin": "arcsin", "acos": "arccos", "atan": "arctan"}
_RANK = {"+": 1, "-": 1, "negative": 2, "*": 3, "^": 4}
_DOTS = {1: "˙", 2: "¨"}
_APPLY = "<mo>&#x2061;</mo>"
_TIMES = "<mo>&#x2062;</mo>"


def mathml(*sides: Node) -> str:
    """Return a formula, or an equation of several sides, as an element."""
    return f"<math>{'<mo>=</mo>'.join(f'<mrow>{_of(side)}</mrow>' for side in sides)}</math>"


def _of(node: Node) -> str:
    match node.kind:
        case "number":
            digits, _, power = node.text.partition("e")
            ten = f"<mo>·</mo><msup><mn>10</mn><mn>{int(power)}</mn></msup>" if power else ""
            return f"<mn>{digits}</mn>{ten}"
        case "name":
            return _name(node.text)
        case "pi":
            return "<mi>π</mi>"
        case "negative":
            return f"<mo>−</mo>{_inside(node.inner[0], 3)}"
        case "+" | "-":
            first, second = node.inner
            sign = "+" if node.kind == "+" else "−"
            return f"{_inside(first, 1)}<mo>{sign}</mo>{_inside(second, 2)}"
        case "*":
            first, second = node.inner
            sign = "<mo>·</mo>" if second.kind == "number" else _TIMES
            return f"{_inside(first, 3)}{sign}{_inside(second, 3)}"
        case "/":
            return "<mfrac>{}{}</mfrac>".format(*(_row(one) for one in node.inner))
        case "^":
            base, exponent = node.inner
            return f"<msup><mrow>{_inside(base, 5)}</mrow>{_row(exponent)}</msup>"
        case "sqrt":
            return f"<msqrt>{_of(node.inner[0])}</msqrt>"
        case "abs":
            return f"<mrow><mo>|</mo>{_of(node.inner[0])}<mo>|</mo></mrow>"
    inner = "<mo>,</mo>".join(_of(one) for one in node.inner)
    return f"<mi>{_USUAL.get(node.kind, node.kind)}</mi>{_APPLY}<mrow><mo>(</mo>{inner}<mo>)</mo></mrow>"


def _row(node: Node) -> str:
    return f"<mrow>{_of(node)}</mrow>"


def _name(name: str) -> str:
    letter, index, order = symbol_of(name)
    shown = f"<mi>{escape(letter)}</mi>"
    if order:
        shown = f'<mover accent="true">{shown}<mo>{_DOTS[min(order, 2)]}</mo></mover>'
    return shown if not index else f"<msub>{shown}<mtext>{escape(index)}</mtext></msub>"


def _inside(node: Node, rank: int) -> str:
    text = _of(node)
    return text if _RANK.get(node.kind, 5) >= rank else f"<mrow><mo>(</mo>{text}<mo>)</mo></mrow>"
