"""Formulas of the motion: of time, and of the places and rates of bodies, beside the numbers in `let`.

A name without a point is one of the place, body or connection whose law the formula is; ``bob.x`` and ``rod.end.vx``
are those of any body and place. A name in `let` may itself be such a formula: it then means what it says where it is
used. Numbers in `let` come before names without a point.
"""

from __future__ import annotations

import re
from collections.abc import Collection, Iterable, Iterator, Mapping
from dataclasses import dataclass

from core.errors import InvalidParameter, Path
from core.formulas import ARGUMENTS, FUNCTIONS, Formula, Node, names_in, names_of
from core.multibody.language.body import SceneBody
from core.multibody.language.numerals import Numerals
from core.multibody.language.written import Number

TIME = "t"
"""The name of the seconds from the start."""

TURNS = ("angle", "turn", "rate")
"""Names of the turn of a body of the plane, and of its rate."""

LENGTH = "length of"
"""The function of up to three numbers that is the length of their vector; no formula can call it."""

MOST_NODES = 1000
"""Numbers, names and operations of a formula with all that it uses in `let`."""

MOTION_FUNCTIONS = (*FUNCTIONS, *ARGUMENTS)
"""Functions of formulas of the motion."""


@dataclass(frozen=True)
class MotionFormula:
    """A formula that varies with the motion.

    Attributes
    ----------
    root : Node
        Without names of formulas in `let`, and without speeds.
    names : frozenset of str
        Of the motion, in it.
    """

    root: Node
    names: frozenset[str]


def columns_of(dimension: int) -> tuple[str, ...]:
    """Return the names of a place: its components, their rates, and the speed."""
    axes = "xyz"[:dimension]
    return (*axes, *(f"v{axis}" for axis in axes), "speed")


def names_of_bodies(bodies: Mapping[str, SceneBody], dimension: int) -> Iterator[str]:
    """Yield the names of the motion of all bodies and their places."""
    for name, body in bodies.items():
        for place in (name, *(f"{name}.{spot}" for spot in body.places)):
            yield from (f"{place}.{column}" for column in columns_of(dimension))
        if dimension == 2 and body.inertia is not None:
            yield from (f"{name}.{turn}" for turn in TURNS)


def motion_formula(
    value: object, numerals: Numerals, own: Collection[str], others: Iterable[str], path: Path
) -> MotionFormula | None:
    """Return the formula of the motion that stands in the place of a number; None for a number.

    Parameters
    ----------
    value : object
        As it was written.
    numerals : Numerals
    own : collection of str
        Names without a point, but the time.
    others : iterable of str
        Names with a point.
    path : path

    Raises
    ------
    InvalidParameter
        For a formula that cannot be read, with the character or the name that was probably meant.
    """
    if not isinstance(value, str):
        return None
    used = names_in(value)
    if used <= {*numerals.let, *FUNCTIONS, "pi"} or not used:
        return None
    return _Expanding(numerals, [TIME, *own, *others], path).of(value)


class _Expanding:
    """Reads a formula with what it uses in `let`."""

    def __init__(self, numerals: Numerals, names: list[str], path: Path) -> None:
        self.numerals, self.names, self.path = numerals, [name for name in names if name not in numerals.let], path
        self.count = 0

    def of(self, text: str) -> MotionFormula:
        root = self._read(text)
        return MotionFormula(root, names_of(root) - set(self.numerals.let))

    def _read(self, text: str) -> Node:
        known = [*self.numerals.let, *self.numerals.formulas, *self.names]
        try:
            formula = Formula.read(text, known, (*MOTION_FUNCTIONS, *self.numerals.tables))
        except InvalidParameter as fault:
            raise fault.inside(*self.path) from None
        return self._expanded(formula.root)

    def _expanded(self, node: Node) -> Node:
        self.count += 1
        if self.count > MOST_NODES:
            raise InvalidParameter(self.path, f"have at most {MOST_NODES} numbers, names and operations with its let")
        if node.kind != "name":
            inner = tuple(self._expanded(inner) for inner in node.inner)
            table = self.numerals.tables.get(node.kind)
            return Node(node.kind, node.text, inner) if table is None else table.of(*inner)
        if node.text in self.numerals.formulas and node.text not in self.names:
            return self._read(self.numerals.formulas[node.text])
        place, _, column = node.text.rpartition(".")
        if column != "speed" or node.text in self.numerals.let:
            return node
        rates = [f"{place}.v{axis}" if place else f"v{axis}" for axis in "xyz"]
        return Node(LENGTH, inner=tuple(Node("name", rate) for rate in rates if rate in self.names))


def references(values: Iterable[object], bodies: Iterable[str], let: Mapping[str, Number]) -> Iterator[tuple[str, str]]:
    """Yield the places that formulas name, and what they name of them; also through names in `let`."""
    texts = [value for value in values if isinstance(value, str)]
    if not texts:
        return
    waiting = {name: text for name, text in let.items() if isinstance(text, str)}
    used = set(texts)
    while reached := [name for name in waiting if any(re.search(rf"\b{re.escape(name)}\b", text) for text in used)]:
        used |= {waiting.pop(name) for name in reached}
    every = "\n".join(used)
    for body in bodies:
        for found in re.finditer(rf"(?<![\w.]){re.escape(body)}\.([\w-]+)(?:\.(\w+))?", every):
            spot, column = found.groups()
            yield (body, spot) if column is None else (f"{body}.{spot}", column)
