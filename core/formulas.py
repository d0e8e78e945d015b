"""Formulas as clients and students write them: one grammar, evaluated in whatever arithmetic is needed.

    sum     = product (("+" | "-") product)*
    product = factor (("*" | "/") factor)*
    factor  = ("+" | "-") factor | power
    power   = atom (("^" | "**") factor)?
    atom    = number | "pi" | name | function "(" sum ("," sum)* ")" | "(" sum ")"

Nothing is evaluated as code: names are those that the caller knows, functions those of a list, and length, nesting and
exponents are limited. A name may have parts behind points, such as bob.x.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Collection, Iterable, Mapping
from dataclasses import dataclass
from functools import lru_cache
from typing import Any, Generic, TypeVar

from core.errors import InvalidParameter, Path
from core.near_names import did_you_mean

LONGEST_FORMULA = 300
"""Characters."""
DEEPEST = 20
"""Parentheses, signs and powers inside one another."""
LARGEST_EXPONENT = 400
"""Of ten, in a number."""
READ = 1024
"""Texts whose names are remembered: those of a request are looked at several times, in some 0.5 MB."""
PARSED = 256
"""Formulas that are remembered: set-up and audit read those of a scene again. The longest take 10 MB."""

FUNCTIONS = ("sqrt", "sin", "cos", "tan", "asin", "acos", "atan", "sinh", "cosh", "tanh", "exp", "log", "abs")
ARGUMENTS = {"atan2": 2, "min": 2, "max": 2, "sign": 1, "if": 3}
"""Functions that a caller may know beside these, and how many arguments they have; if(c, a, b) is a for c > 0, or b."""
_ALSO = {"arcsin": "asin", "arccos": "acos", "arctan": "atan", "ln": "log"}
"""Other names of functions."""
NAMES_OF_FUNCTIONS = (*FUNCTIONS, *ARGUMENTS, *_ALSO)

_NAME = re.compile(r"[A-Za-z][A-Za-z0-9_]{0,63}")
_DIGITS = r"(?:\d+\.?\d*|\.\d+)(?:[eE]([+-]?\d+))?"
_TOKEN = re.compile(rf"\s*(?:({_DIGITS})|([A-Za-z]\w*(?:\.[A-Za-z]\w*)*)|(\*\*|[-+*/^(),]))", re.ASCII)

T = TypeVar("T")


class UnknownName(InvalidParameter):
    """A formula uses a name that is not known.

    Parameters
    ----------
    name : str
    path, rule, remedy, further
        As of `InvalidParameter`.
    """

    def __init__(
        self,
        path: str | Path,
        rule: str,
        *,
        remedy: str | None = None,
        further: Iterable[InvalidParameter] = (),
        name: str = "",
    ) -> None:
        super().__init__(path, rule, remedy=remedy, further=further)
        self.name = name

    @classmethod
    def among(cls, name: str, known: Collection[str], functions: Collection[str]) -> UnknownName:
        """Return the fault of a name that is none of some names and functions, with the one that was probably meant."""
        near, here = did_you_mean(name, [*known, *functions]), _names_here(known, functions)
        remedy = here if near is None else f"{near} {here}"
        return cls((), f'use known names, unlike "{name}"', remedy=remedy, name=name)

    def inside(self, *outer: str | int) -> UnknownName:
        """Return the same error with the path from an enclosing object."""
        return UnknownName((*outer, *self.path), self.rule, remedy=self.remedy, name=self.name)


def is_name(text: object) -> bool:
    """Return whether something can be called that in a formula: letters, digits and _, and no function."""
    return isinstance(text, str) and _NAME.fullmatch(text) is not None and text not in (*NAMES_OF_FUNCTIONS, "pi")


@dataclass(frozen=True)
class Node:
    """A number, a name, or what is done to other nodes.

    Attributes
    ----------
    kind : str
        ``"number"``, ``"pi"``, ``"name"``, ``"negative"``, one of ``+ - * / ^``, or one of `FUNCTIONS` or `ARGUMENTS`.
    text : str
        The digits of a number, or a name.
    inner : tuple of Node
        What it is done to.
    """

    kind: str
    text: str = ""
    inner: tuple[Node, ...] = ()


@dataclass(frozen=True)
class Arithmetic(Generic[T]):
    """How formulas are evaluated, beside the operators + - * of the values themselves.

    Attributes
    ----------
    number : callable
        Value of digits.
    pi : callable
        Its value, without arguments.
    divide, power : callable
        Of two values.
    functions : mapping of str to callable
        One for each of `FUNCTIONS`, and for those of `ARGUMENTS` that formulas may have.
    """

    number: Callable[[str], T]
    pi: Callable[[], T]
    divide: Callable[[T, T], T]
    power: Callable[[T, T], T]
    functions: Mapping[str, Callable[..., T]]


NOTHING = Node("number", "0")
"""The formula of zero."""


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
    def read(cls, text: str, known: Collection[str], functions: Collection[str] = FUNCTIONS) -> Formula:
        """Return the formula that a text states.

        Parameters
        ----------
        text : str
        known : collection of str
            Names that it may use; one with a sign in it, such as rod-2.x, is read as a whole.
        functions : collection of str
            Functions that it may use.

        Raises
        ------
        InvalidParameter
            For a text that is none, is too long or too deeply nested.
        UnknownName
            For a name that is not among `known`.
        """
        if len(text) > LONGEST_FORMULA:
            raise InvalidParameter((), f"have at most {LONGEST_FORMULA} characters, not {len(text)}")
        return _parsed(text, tuple(known), tuple(functions))

    def value(self, names: Mapping[str, T], arithmetic: Arithmetic[T]) -> T:
        """Return the value with some values of its names; errors are those of the arithmetic."""
        return value_of(self.root, names, arithmetic)


@lru_cache(maxsize=PARSED)
def _parsed(text: str, known: Collection[str], functions: Collection[str]) -> Formula:
    reader = _Reader(_tokens(text, known), known, functions)
    root = reader.sum()
    if reader.at != len(reader.tokens):
        raise reader.left_over()
    return Formula(root, frozenset(reader.names))


def value_of(node: Node, names: Mapping[str, T], arithmetic: Arithmetic[T]) -> T:
    """Return the value of a part of a formula."""
    if node.kind == "number":
        return arithmetic.number(node.text)
    if node.kind == "pi":
        return arithmetic.pi()
    if node.kind == "name":
        return names[node.text]
    values: list[Any] = [value_of(inner, names, arithmetic) for inner in node.inner]
    match node.kind:
        case "negative":
            found = -values[0]
        case "+":
            found = values[0] + values[1]
        case "-":
            found = values[0] - values[1]
        case "*":
            found = values[0] * values[1]
        case "/":
            found = arithmetic.divide(values[0], values[1])
        case "^":
            found = arithmetic.power(values[0], values[1])
        case _:
            found = arithmetic.functions[node.kind](*values)
    return found  # type: ignore[no-any-return]


def names_of(node: Node) -> frozenset[str]:
    """Return the names that occur in a part of a formula."""
    return frozenset({node.text}) if node.kind == "name" else frozenset().union(*map(names_of, node.inner))


def is_formula(text: str, known: Collection[str]) -> bool:
    """Return whether a text is a decimal, or a formula over known names."""
    try:
        Formula.read(text, known)
    except InvalidParameter:
        return False
    return True


@lru_cache(maxsize=READ)
def names_in(text: str) -> frozenset[str]:
    """Return what stands as a name or function in a text; nothing of what is no formula."""
    try:
        return frozenset(name for _, name, _ in _tokens(text, ()) if name)
    except InvalidParameter:
        return frozenset()


def _tokens(text: str, known: Collection[str]) -> list[tuple[str, str, str]]:
    with_signs = sorted((name for name in known if "-" in name), key=len, reverse=True)
    signed = re.compile(rf"\s*({'|'.join(map(re.escape, with_signs))})(?![\w.])") if with_signs else None
    found, end, text = [], 0, text.rstrip()
    while end < len(text):
        name_with_sign = None if signed is None else signed.match(text, end)
        if name_with_sign is not None:
            found.append(("", name_with_sign.group(1), ""))
            end = name_with_sign.end()
            continue
        token = _TOKEN.match(text, end)
        if token is None:
            at = end + len(text[end:]) - len(text[end:].lstrip())
            rule = "be a formula of numbers, names, + - * / ^ ( ) and functions"
            raise InvalidParameter((), f'{rule}, unlike "{text[at]}" (character {at + 1})')
        number, exponent, name, sign = token.groups(default="")
        if exponent and abs(int(exponent)) > LARGEST_EXPONENT:
            raise InvalidParameter((), f"have an exponent between -{LARGEST_EXPONENT} and {LARGEST_EXPONENT}")
        found.append((number, name, "^" if sign == "**" else sign))
        end = token.end()
    return found


class _Reader:
    """Reads tokens by recursive descent."""

    def __init__(self, tokens: list[tuple[str, str, str]], known: Collection[str], functions: Collection[str]) -> None:
        self.tokens, self.known, self.at, self.depth = tokens, known, 0, 0
        self.functions = functions
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
        if not number and not name:
            return self._parenthesis()
        self.at += 1
        if number:
            return Node("number", number)
        if name in self.known:
            self.names.add(name)
            return Node("name", name)
        if name == "pi":
            return Node("pi")
        function = _ALSO.get(name, name)
        if function in self.functions:
            return Node(function, inner=self._arguments(ARGUMENTS.get(function, 1)))
        raise UnknownName.among(name[:64], self.known, self.functions)

    def _parenthesis(self) -> Node:
        return self._arguments(1)[0]

    def _arguments(self, count: int) -> tuple[Node, ...]:
        if not self._take("("):
            raise InvalidParameter((), "be one complete formula")
        found = [self.sum()]
        while self._take(","):
            found.append(self.sum())
        if not self._take(")"):
            raise InvalidParameter((), "close every parenthesis")
        if len(found) != count:
            raise InvalidParameter((), f"have {count} values in a parenthesis where it has {len(found)}")
        return tuple(found)

    def _take(self, *signs: str) -> str:
        sign = self.tokens[self.at][2] if self.at < len(self.tokens) else ""
        if sign and sign in signs:
            self.at += 1
            return sign
        return ""

    def left_over(self) -> InvalidParameter:
        """Return the fault of a text that goes on behind a formula: most often behind a decimal comma."""
        before, sign, after = [*self.tokens, ("", "", "")][max(self.at - 1, 0) :][:3]
        if sign[2] == "," and before[0].isdigit() and after[0].isdigit():
            written = f"{before[0]},{after[0]}"
            return InvalidParameter(
                (), f'have decimal points, unlike "{written}"', remedy=f"write {written.replace(',', '.')}"
            )
        return InvalidParameter((), "be one complete formula")

    def _enter(self) -> None:
        self.depth += 1
        if self.depth > DEEPEST:
            raise InvalidParameter((), f"be nested at most {DEEPEST} deep")


def _names_here(known: Iterable[str], of: Iterable[str]) -> str:
    names = ", ".join(sorted(known))
    functions = "functions: " + ", ".join(of)
    return f"names: {names}; {functions}" if names and len(names) < 200 else functions
