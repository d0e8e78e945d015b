"""With what signs the arguments of formulas of several pieces grow from zero at the start."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from itertools import product

from core.errors import InvalidParameter
from core.formulas import Node, names_of
from core.multibody.algebra.polynomials import ZERO, is_zero
from core.multibody.equations.expansion import Series, expansion, leading_sign
from core.multibody.language.switches import STARTS, argument_of, switches_of, with_starts
from core.multibody.laws.law import Law
from core.multibody.laws.series import LawSeries
from core.multibody.table.table import Table

ORDER = 6
"""Highest power of time by which a sign is decided: a force that grows with its cube moves a place by the fifth."""
MOST_OPEN = 4
"""Arguments that may be zero at the start: sixteen combinations of signs."""

Key = tuple[Node, str]
"""An argument: its formula, and what its names stand for."""


def _key(law: Law, argument: Node) -> Key:
    """Return an argument: equal ones of several laws are one."""
    inputs = sorted((name, one) for name, one in law.inputs.items() if name in names_of(argument))
    return argument, str([(name, one.rate, list(one.form.items())) for name, one in inputs])


def with_starting_signs(table: Table) -> Table:
    """Return a table whose formulas of several pieces know on which of them the motion begins.

    Where an argument is zero at the start, the motion begins on the piece whose own motion leads there.

    Raises
    ------
    InvalidParameter
        Where no piece does, or more than one: neither side of the zero is left, or the formula does not say which.
    """
    laws = [law for law in table.acting if next(switches_of(law.root), None) is not None]
    if not laws:
        return table
    arguments = {_key(law, argument_of(node)): law for law in laws for node in switches_of(law.root)}
    found = {key: law for key, law in arguments.items() if is_zero(_series(table, law, key[0], 1)[0])}
    if not found:
        return table
    if len(found) > MOST_OPEN:
        raise _undecided(next(iter(found.values())), f"have at most {MOST_OPEN} zeros of what pieces depend on")
    kept = []
    for signs in product(STARTS, repeat=len(found)):
        chosen = dict(zip(found, signs, strict=True))
        tried = _with(table, chosen)
        leaving = {key: leading_sign(_series(tried, law, key[0], ORDER)) for key, law in found.items()}
        if all(sign in (0, STARTS[chosen[key]]) for key, sign in leaving.items()):
            kept.append({key: chosen[key] if sign else "" for key, sign in leaving.items()})
    if any(one != kept[0] for one in kept) or not kept:
        rule = "lead away from the zero of what its pieces depend on, on one side alone"
        raise _undecided(next(iter(found.values())), rule)
    return _with(table, kept[0])


def _undecided(law: Law, rule: str) -> InvalidParameter:
    remedy = "describe friction that holds what is at rest by a contact, or start beside the zero"
    return InvalidParameter(law.path, rule, remedy=remedy)


def _with(table: Table, signs: Mapping[Key, str]) -> Table:
    return replace(table, laws=[_started(law, signs) for law in table.laws])


def _started(law: Law, signs: Mapping[Key, str]) -> Law:
    return replace(law, root=with_starts(law.root, lambda node: signs.get(_key(law, argument_of(node)), "")))


def _series(table: Table, law: Law, argument: Node, count: int) -> Series:
    """Return the first coefficients of a part of a formula along the motion of a table."""
    part = LawSeries([replace(law, root=argument, push={})])
    if count == 1:
        places, rates = [[q] for q in table.q], [[v] for v in table.v]
    else:
        places = expansion(table, count).places
        rates = [[(k + 1) * place[k + 1] for k in range(count)] for place in places]
    for k in range(count):
        part.add_to([ZERO] * len(table.q), places, rates, k)
    return part.values[part.tape.outputs[0]]
