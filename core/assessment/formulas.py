"""Formulas in the parameters of a question: read by a small grammar, evaluated at any parameters, with dimensions.

    sum     = product (("+" | "-") product)*
    product = factor (("*" | "/") factor)*
    factor  = ("+" | "-") factor | power
    power   = atom (("^" | "**") factor)?
    atom    = number | name | function "(" sum ")" | "(" sum ")"

Nothing is evaluated as code: names are parameters, functions those of a table, and length and nesting are limited. The
grammar of described scenes (`core.multibody.numerals`) is evaluated in balls, and has neither powers nor inverse
functions, which students write.
"""

from __future__ import annotations

import math
import re
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from fractions import Fraction

from core.errors import InvalidParameter

LONGEST_FORMULA = 300
"""Characters."""
DEEPEST = 20
"""Parentheses, signs and powers inside one another."""

FUNCTIONS: Mapping[str, Callable[[float], float]] = {
    "sqrt": math.sqrt,
    "sin": math.sin,
    "cos": math.cos,
    "tan": math.tan,
    "asin": math.asin,
    "acos": math.acos,
    "atan": math.atan,
    "arcsin": math.asin,
    "arccos": math.acos,
    "arctan": math.atan,
    "sinh": math.sinh,
    "cosh": math.cosh,
    "tanh": math.tanh,
    "exp": math.exp,
    "log": math.log,
    "ln": math.log,
    "abs": abs,
}
CONSTANTS = {"pi": math.pi}
NAME = re.compile(r"[A-Za-z][A-Za-z0-9_]{0,39}")
"""What a parameter may be called."""

_DIGITS = r"\d+\.?\d*(?:[eE][+-]?\d{1,3})?|\.\d+(?:[eE][+-]?\d{1,3})?"
_TOKEN = re.compile(rf"\s*(?:({_DIGITS})|([A-Za-z]\w*)|(\*\*|[-+*/^()]))", re.ASCII)

Powers = Mapping[str, Fraction]
"""Powers of base units, none of them 0."""


class Undefined(ValueError):
    """The formula has no value at these parameters: a division by zero, a root of a negative number, an overflow."""


@dataclass(frozen=True)
class Node:
    """A number, a name, or what is done to other nodes.

    Attributes
    ----------
    kind : str
        ``"number"``, ``"name"``, an operator, or the name of a function.
    number : float
        Of a number.
    name : str
        Of a name.
    inner : tuple of Node
        What it is done to.
    """

    kind: str
    number: float = 0.0
    name: str = ""
    inner: tuple[Node, ...] = ()


@dataclass(frozen=True)
class Formula:
    """A formula that can be read.

    Attributes
    ----------
    root : Node
    names : frozenset of str
        That occur in it.
    """

    root: Node
    names: frozenset[str]

    @classmethod
    def read(cls, text: str, known: Mapping[str, object]) -> Formula:
        """Return the formula that a text states.

        Raises
        ------
        InvalidParameter
            For a text that is none, is too long or too deeply nested, or names something that is not `known`.
        """
        if len(text) > LONGEST_FORMULA:
            raise InvalidParameter((), f"have at most {LONGEST_FORMULA} characters")
        reader = _Reader(_tokens(text), known)
        root = reader.sum()
        if reader.at != len(reader.tokens):
            raise InvalidParameter((), "be one complete formula")
        return cls(root, frozenset(reader.names))

    def value(self, parameters: Mapping[str, float]) -> float:
        """Return the value at some parameters.

        Raises
        ------
        Undefined
            If there is none.
        """
        try:
            value = _value(self.root, parameters)
        except (ValueError, ZeroDivisionError, OverflowError) as fault:
            raise Undefined from fault
        if isinstance(value, complex) or not math.isfinite(value):
            raise Undefined
        return float(value)

    def dimensions(self, units: Mapping[str, Powers]) -> Powers:
        """Return the powers of base units of the value, from those of the parameters.

        Raises
        ------
        InvalidParameter
            If terms of a sum have different ones, or a function or an exponent has any.
        """
        return _dimensions(self.root, units)


def _tokens(text: str) -> list[tuple[str, str, str]]:
    found, end, text = [], 0, text.rstrip()
    while end < len(text):
        token = _TOKEN.match(text, end)
        if token is None:
            raise InvalidParameter((), "be a formula of numbers, names, + - * / ^ ( ) and functions")
        number, name, sign = token.groups(default="")
        found.append((number, name, "^" if sign == "**" else sign))
        end = token.end()
    return found


class _Reader:
    """Reads tokens by recursive descent."""

    def __init__(self, tokens: list[tuple[str, str, str]], known: Mapping[str, object]) -> None:
        self.tokens, self.known, self.at, self.depth = tokens, known, 0, 0
        self.names: set[str] = set()

    def sum(self) -> Node:
        self._enter()
        node = self._product()
        while sign := self._take("+", "-"):
            node = Node(sign, inner=(node, self._product()))
        self.depth -= 1
        return node

    def _product(self) -> Node:
        node = self._factor()
        while sign := self._take("*", "/"):
            node = Node(sign, inner=(node, self._factor()))
        return node

    def _factor(self) -> Node:
        if sign := self._take("+", "-"):
            self._enter()
            node = self._factor()
            self.depth -= 1
            return Node("negative", inner=(node,)) if sign == "-" else node
        node = self._atom()
        if self._take("^"):
            self._enter()
            node = Node("^", inner=(node, self._factor()))
            self.depth -= 1
        return node

    def _atom(self) -> Node:
        number, name, _ = self.tokens[self.at] if self.at < len(self.tokens) else ("", "", "")
        if number:
            self.at += 1
            return Node("number", float(number))
        if not name:
            return self._parenthesis()
        self.at += 1
        if name in self.known:
            self.names.add(name)
            return Node("name", name=name)
        if name in CONSTANTS:
            return Node("number", CONSTANTS[name])
        if name in FUNCTIONS:
            return Node(name, inner=(self._parenthesis(),))
        known = ", ".join(sorted(self.known))
        remedy = f"names here: {known}" if len(known) < 200 else None
        raise InvalidParameter((), "use names of parameters and functions that are known", remedy=remedy)

    def _parenthesis(self) -> Node:
        if not self._take("("):
            raise InvalidParameter((), "be one complete formula")
        node = self.sum()
        if not self._take(")"):
            raise InvalidParameter((), "close every parenthesis")
        return node

    def _take(self, *signs: str) -> str:
        sign = self.tokens[self.at][2] if self.at < len(self.tokens) else ""
        if sign and sign in signs:
            self.at += 1
            return sign
        return ""

    def _enter(self) -> None:
        self.depth += 1
        if self.depth > DEEPEST:
            raise InvalidParameter((), f"be nested at most {DEEPEST} deep")


def _value(node: Node, parameters: Mapping[str, float]) -> float:
    if node.kind == "number":
        return node.number
    if node.kind == "name":
        return parameters[node.name]
    values = [_value(inner, parameters) for inner in node.inner]
    if node.kind in FUNCTIONS:
        return FUNCTIONS[node.kind](values[0])
    if node.kind == "negative":
        return -values[0]
    one, other = values
    if node.kind == "^":
        return math.pow(one, other)
    if node.kind == "/":
        return one / other
    return one * other if node.kind == "*" else one + other if node.kind == "+" else one - other


def _dimensions(node: Node, units: Mapping[str, Powers]) -> Powers:
    if node.kind == "number":
        return {}
    if node.kind == "name":
        return units[node.name]
    inner = [_dimensions(one, units) for one in node.inner]
    if node.kind == "negative" or node.kind == "abs":
        return inner[0]
    if node.kind == "sqrt":
        return _scaled(inner[0], Fraction(1, 2))
    if node.kind in FUNCTIONS:
        if inner[0]:
            raise InvalidParameter((), "have functions of pure numbers only")
        return {}
    one, other = inner
    if node.kind in ("+", "-"):
        if one != other:
            raise InvalidParameter((), "add only terms of equal dimensions")
        return one
    if node.kind == "^":
        if other or (one and _exponent(node.inner[1]) is None):
            raise InvalidParameter((), "have pure numbers as exponents")
        return _scaled(one, _exponent(node.inner[1]) or Fraction(0))
    sign = 1 if node.kind == "*" else -1
    both = {name: one.get(name, Fraction(0)) + sign * other.get(name, Fraction(0)) for name in {*one, *other}}
    return {name: power for name, power in both.items() if power}


def _scaled(powers: Powers, times: Fraction) -> Powers:
    return {name: power * times for name, power in powers.items() if power * times}


def _exponent(node: Node) -> Fraction | None:
    """Return an exponent without names as a fraction of small numbers, None for any other."""
    try:
        value = _value(node, {})
    except (KeyError, ValueError, ZeroDivisionError, OverflowError):
        return None
    if not math.isfinite(value) or abs(value) > DEEPEST:
        return None
    near = Fraction(value).limit_denominator(12)
    return near if abs(float(near) - value) < 1e-12 else None
