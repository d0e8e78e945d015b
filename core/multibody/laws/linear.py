"""Formulas that are linear in rates, whose forces are entries of D."""

from __future__ import annotations

from collections.abc import Mapping

from core.errors import InvalidParameter
from core.formulas import Node, value_of
from core.multibody.algebra.polynomials import ONE, ZERO, Ball, is_zero
from core.multibody.language.numerals import BALLS
from core.multibody.laws.law import Input

Form = dict[str, Ball]
"""Factors of names; that of the empty name is a constant."""


def linear_in_rates(root: Node, inputs: Mapping[str, Input], numbers: Mapping[str, Ball]) -> Form | None:
    """Return the factors of rates of which a formula is a sum with constant factors; None of another."""
    try:
        form = _form(root, inputs, numbers)
    except InvalidParameter:
        return None
    if form is None:
        return None
    found = {name: factor for name, factor in form.items() if not is_zero(factor)}
    return found if all(name and inputs[name].rate for name in found) else None


def _form(node: Node, inputs: Mapping[str, Input], numbers: Mapping[str, Ball]) -> Form | None:
    """Return a part of a formula as an affine form of its inputs; None where it is none."""
    if not _varies(node, inputs):
        return {"": value_of(node, numbers, BALLS)}
    if node.kind == "name":
        return {node.text: ONE}
    parts = [_form(inner, inputs, numbers) for inner in node.inner]
    if any(part is None for part in parts):
        return None
    forms = [part for part in parts if part is not None]
    match node.kind:
        case "negative":
            return _sum({}, forms[0], -ONE)
        case "+":
            return _sum(forms[0], forms[1], ONE)
        case "-":
            return _sum(forms[0], forms[1], -ONE)
        case "*" if forms[0].keys() <= {""} or forms[1].keys() <= {""}:
            constant, other = (forms[0], forms[1]) if forms[0].keys() <= {""} else (forms[1], forms[0])
            return _sum({}, other, constant.get("", ZERO))
        case "/" if forms[1].keys() <= {""}:
            return _sum({}, forms[0], 1 / forms[1][""])
    return None


def _varies(node: Node, inputs: Mapping[str, Input]) -> bool:
    return node.text in inputs if node.kind == "name" else any(_varies(inner, inputs) for inner in node.inner)


def _sum(first: Form, second: Form, factor: Ball) -> Form:
    found = dict(first)
    for name, value in second.items():
        found[name] = found.get(name, ZERO) + factor * value
    return found
