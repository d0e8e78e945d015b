"""On which piece formulas of several pieces are, and the formulas that hold there.

A formula changes its piece where an argument of it is zero. Between two such times it is a formula of one piece: what
is constant then is a load, and what is linear in rates a damping.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field, replace

from core.formulas import NOTHING, Node, names_of, value_of
from core.multibody.algebra.polynomials import Ball
from core.multibody.language.numerals import BALLS
from core.multibody.language.switches import SWITCHING, argument_of, switches_of
from core.multibody.laws.law import Law
from core.multibody.laws.linear import Linear, linear_form
from core.multibody.table.table import Table

Key = tuple[Node, str]
"""An argument: its formula, and what its names stand for. Equal ones of several laws are one."""


@dataclass
class Argument:
    """What is zero where formulas change their piece.

    Attributes
    ----------
    law : Law
        With the argument as its formula, of one piece; it pushes nothing.
    sign : int
        On the piece that holds; 0 of what stays zero.
    names : list of str
        The connections of which a formula has it.
    """

    law: Law
    sign: int
    names: list[str] = field(default_factory=list)


def key_of(law: Law) -> Key:
    """Return what tells an argument from others."""
    inputs = sorted((name, one) for name, one in law.inputs.items() if name in names_of(law.root))
    return law.root, str([(name, one.rate, list(one.form.items())) for name, one in inputs])


def in_pieces(table: Table, sign: Callable[[Law], int]) -> tuple[Table, dict[Key, Argument]]:
    """Return a table with formulas of one piece, and the arguments that tell which these are.

    Parameters
    ----------
    sign : callable
        Returns the sign of an argument, which is given as a law that pushes nothing.
    """
    pieces = _Pieces(sign)
    found = replace(table, load=dict(table.load), damping=dict(table.damping), laws=[])
    for law in table.laws:
        one = pieces.of(law)
        found.laws.append(one if one is law else entered(found, one))
    return found, pieces.arguments


def switching(laws: Sequence[Law]) -> bool:
    """Return whether any formula has several pieces."""
    return any(next(switches_of(law.root), None) is not None for law in laws)


class _Pieces:
    """Replaces functions of several pieces by the piece that holds."""

    def __init__(self, sign: Callable[[Law], int]) -> None:
        self.sign = sign
        self.arguments: dict[Key, Argument] = {}

    def of(self, law: Law) -> Law:
        """Return a law of one piece; the law itself where it has no other."""
        root = self._of(law, law.root)
        return law if root is law.root else _with_root(law, root)

    def _of(self, law: Law, node: Node) -> Node:
        if node.kind not in SWITCHING:
            inner = tuple(self._of(law, one) for one in node.inner)
            return node if all(a is b for a, b in zip(inner, node.inner, strict=True)) else replace(node, inner=inner)
        chooses = node.kind == "if"
        # Of a choice only the branch that holds has arguments of its own.
        settled = [one if chooses and k else self._of(law, one) for k, one in enumerate(node.inner)]
        side = self._sign(law, argument_of(replace(node, inner=tuple(settled))))
        match node.kind:
            case "abs":
                return settled[0] if side > 0 else NOTHING if side == 0 else Node("negative", inner=(settled[0],))
            case "sign":
                return NOTHING if side == 0 else _ONE if side > 0 else Node("negative", inner=(_ONE,))
            case "if":
                return self._of(law, settled[1 if side > 0 else 2])
        return settled[0 if (side > 0) == (node.kind == "max") else 1]

    def _sign(self, law: Law, root: Node) -> int:
        argument = replace(_with_root(law, root), push={})
        key = key_of(argument)
        if key not in self.arguments:
            self.arguments[key] = Argument(argument, self.sign(argument))
        found = self.arguments[key]
        if law.name not in found.names:
            found.names.append(law.name)
        return found.sign


_ONE = Node("number", "1")


def _with_root(law: Law, root: Node) -> Law:
    names = names_of(root)
    return replace(law, root=root, inputs={name: one for name, one in law.inputs.items() if name in names})


def entered(table: Table, law: Law) -> Law:
    """Return a law of one piece, whose forces are added to a table where they are constant or linear in rates."""
    if not law.inputs:
        constant: Ball = value_of(law.root, law.numbers, BALLS)
        for i, x in law.push.items():
            table.add_load(i, x * constant)
        return replace(law, in_table=True)
    form = linear_form(law.root, law.inputs, law.numbers)
    if form is None or form.exponentials or not all(name and law.inputs[name].rate for name in form.factors):
        return law
    enter(table, law, form)
    return replace(law, in_table=True)


def enter(table: Table, law: Law, form: Linear) -> None:
    """Add what is constant or linear in places and rates to the loads, stiffness and damping of a table."""
    for name, factor in form.factors.items():
        given = law.inputs[name] if name else None
        for i, x in law.push.items():
            if given is None:
                table.add_load(i, x * factor)
                continue
            for key, slope in given.form.items():
                if key and given.rate:
                    table.add_damping(i, key[0], -x * factor * slope)
                elif key:
                    table.add_stiffness(i, key[0], -x * factor * slope)
                elif not given.rate:
                    table.add_load(i, x * factor * slope)


def all_entered(table: Table) -> Table | None:
    """Return a table without formulas, whose forces at rest are its entries; None where some are not linear.

    What the time or the motion changes has no part in it: formulas that read the time are not linear here.
    """
    found = replace(table, load=dict(table.load), stiffness=dict(table.stiffness), damping=dict(table.damping), laws=[])
    for law in table.laws:
        form = linear_form(law.root, law.inputs, law.numbers)
        timed = {i for one in law.inputs.values() for i in one.coordinates() if table.units[i] == "s"}
        if form is None or form.exponentials or timed:
            return None
        if not law.in_table:
            enter(found, law, form)
    return found
