"""Numbers of many digits get names, so that formulas can be read; formulas are written in every notation."""

from __future__ import annotations

from collections.abc import Collection, Mapping

from core.formulas import Node
from core.multibody.equations_answer import WrittenFormula
from core.multibody.formulation.formula_nodes import digits_of, is_short
from core.multibody.formulation.notation.latex import latex
from core.multibody.formulation.notation.mathml import mathml
from core.multibody.formulation.notation.plain import plain
from core.multibody.formulation.unused_names import unused


class Constants:
    """Writes formulas, and names their constants c1, c2, ...

    Parameters
    ----------
    reserved : collection of str
        Names that constants must not have.
    """

    def __init__(self, reserved: Collection[str]) -> None:
        self._reserved, self._named = frozenset(reserved), dict[str, str]()

    def plain(self, node: Node) -> str:
        """Return a formula as text."""
        return plain(self.named(node))

    def formula(self, node: Node) -> WrittenFormula:
        """Return a formula in every notation."""
        named = self.named(node)
        return WrittenFormula(plain(named), latex(named), mathml(named), (named,))

    def equation(self, left: Node, right: Node) -> WrittenFormula:
        """Return an equation in every notation."""
        sides = self.named(left), self.named(right)
        return WrittenFormula(" = ".join(map(plain, sides)), " = ".join(map(latex, sides)), mathml(*sides), sides)

    def values(self, others: Mapping[str, float]) -> dict[str, float]:
        """Return the constants that have been named by now, after others."""
        return {**others, **{name: float(digits) for digits, name in self._named.items()}}

    def named(self, node: Node) -> Node:
        """Return a formula with names for its numbers of many digits."""
        if node.kind == "number":
            # Of a client's formula, which may have any digits.
            text = digits_of(float(node.text))
            return Node("number", text) if is_short(text) else Node("name", self._name(text))
        return Node(node.kind, node.text, tuple(self.named(inner) for inner in node.inner))

    def _name(self, digits: str) -> str:
        if digits not in self._named:
            self._named[digits] = unused("c", {*self._reserved, *self._named.values()}, first="1")
        return self._named[digits]
