"""Formulas as sums of terms with constant factors, each of them one law: what cancels in a push is seen to be zero.

The components of a force along a slope have its size as a common term, so that what they push across it vanishes.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import replace

from core.errors import InvalidParameter
from core.formulas import Node, value_of
from core.multibody.algebra.polynomials import ONE, Ball, entry, is_zero
from core.multibody.language.numerals import BALLS
from core.multibody.laws.law import Input, Law


def merged(laws: Iterable[Law]) -> list[Law]:
    """Return the terms of laws, of which no two are the same, without those that push nothing."""
    found: list[Law] = []
    for law in laws:
        for term in _terms_of(law):
            k = next((k for k, other in enumerate(found) if _are_one(other, term)), len(found))
            if k == len(found):
                found.append(term)
            else:
                push = found[k].push
                total = {i: entry(push, i) + entry(term.push, i) for i in {**push, **term.push}}
                scale = term.scale if is_zero(found[k].scale) else found[k].scale
                found[k] = replace(found[k], push=total, scale=scale)
    kept = (replace(law, push={i: x for i, x in law.push.items() if not is_zero(x)}) for law in found)
    return [law for law in kept if law.push]


def _terms_of(law: Law) -> list[Law]:
    """Return the terms of a law, their factors in their push; the law where a factor has no value."""
    try:
        terms = _terms(law.root, law.numbers)
    except InvalidParameter:
        return [law]
    if not all(factor.is_finite() for factor, _ in terms):
        return [law]
    return [
        replace(
            law,
            root=root,
            inputs={name: one for name, one in law.inputs.items() if name in _names(root)},
            push={i: factor * x for i, x in law.push.items()},
            scale=factor * law.scale,
        )
        for factor, root in terms
    ]


def _terms(node: Node, numbers: Mapping[str, Ball]) -> list[tuple[Ball, Node]]:
    """Return the terms of which a formula is the sum, with constant factors."""
    if _names(node) <= numbers.keys():
        return [(value_of(node, numbers, BALLS), Node("number", "1"))]
    if node.kind == "negative":
        return [(-factor, root) for factor, root in _terms(node.inner[0], numbers)]
    if node.kind in ("+", "-", "*", "/"):
        first, second = node.inner
        if node.kind in ("+", "-"):
            sign = ONE if node.kind == "+" else -ONE
            return [*_terms(first, numbers), *((sign * factor, root) for factor, root in _terms(second, numbers))]
        if _names(second) <= numbers.keys():
            value = value_of(second, numbers, BALLS)
            value = value if node.kind == "*" else ONE / value
            return [(factor * value, root) for factor, root in _terms(first, numbers)]
        if node.kind == "*" and _names(first) <= numbers.keys():
            value = value_of(first, numbers, BALLS)
            return [(value * factor, root) for factor, root in _terms(second, numbers)]
    return [(ONE, node)]


def _names(node: Node) -> set[str]:
    return {node.text} if node.kind == "name" else set().union(*map(_names, node.inner))


def _are_one(first: Law, second: Law) -> bool:
    """Return whether the formulas of two laws are the same, of the same inputs and numbers."""
    return (
        first.root == second.root
        and first.inputs.keys() == second.inputs.keys()
        and all(_are_alike(one, second.inputs[name]) for name, one in first.inputs.items())
        and all(is_zero(x - second.numbers[name]) for name, x in first.numbers.items() if name in second.numbers)
    )


def _are_alike(first: Input, second: Input) -> bool:
    keys = {*first.form, *second.form}
    return first.rate == second.rate and all(is_zero(entry(first.form, k) - entry(second.form, k)) for k in keys)
