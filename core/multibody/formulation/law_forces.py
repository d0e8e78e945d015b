"""Forces that clients give as formulas: the names that they have in the equations, and what they are."""

from __future__ import annotations

from collections.abc import Collection, Sequence
from functools import reduce

from core.formulas import Node, names_of, value_of
from core.multibody.algebra.polynomials import ONE, Ball
from core.multibody.formulation.chart import Chart
from core.multibody.formulation.formula_nodes import call, node_of_sum, node_of_terms
from core.multibody.formulation.trigonometric_sums import TIME, Sum
from core.multibody.formulation.unused_names import unused
from core.multibody.language.motion_formulas import LENGTH
from core.multibody.language.numerals import BALLS
from core.multibody.laws.law import Input, Law

MOST_PRODUCTS = 256
"""Of terms, where two sums are multiplied out: laws with squares and cubes have a dozen, nested powers grow at once."""
MULTIPLIER = "lambda_"
"""How the names of multipliers begin."""


def force_symbols(laws: Sequence[Law], taken: Collection[str]) -> list[str]:
    """Return names for the values of laws: that of the connection, with a number where it has several."""
    owners = [law.name for law in laws]
    found: list[str] = []
    for name in owners:
        used, alone = {*found, *taken}, f"{name}.force"
        free = owners.count(name) == 1 and alone not in used
        found.append(alone if free else unused(f"{alone}_", used, first="1"))
    return found


def law_nodes(chart: Chart, names: Sequence[str]) -> dict[str, Node]:
    """Return the formulas of the laws of a chart's table in its variables, by the names of their values."""
    laws = zip(names, chart.table.acting, strict=True)
    return {name: node_of_terms([(law.scale, [_node(law.root, law, chart)])]) for name, law in laws}


def law_sums(chart: Chart, names: Sequence[str]) -> dict[str, Sum]:
    """Return the laws of a chart's table that are polynomials of its variables, by the names of their values."""
    sums = ((name, law, _sum(law.root, law, chart)) for name, law in zip(names, chart.table.acting, strict=True))
    return {name: total.times(law.scale) for name, law, total in sums if total is not None}


def _sum(node: Node, law: Law, chart: Chart) -> Sum | None:
    if node.kind in ("number", "pi"):
        return Sum.number(value_of(node, {}, BALLS))
    if node.kind == "name":
        return _value(law.inputs[node.text], chart) if node.text in law.inputs else Sum.number(law.numbers[node.text])
    parts = [_sum(one, law, chart) for one in node.inner]
    known = [one for one in parts if one is not None]
    if len(known) < len(parts):
        return None
    match node.kind:
        case "negative":
            return known[0].times(-ONE)
        case "+":
            return known[0] + known[1]
        case "-":
            return known[0] - known[1]
        case "*":
            return _product(known[0], known[1])
        case "/":
            inverse = known[1].inverse()
            return _product(known[0], inverse)
        case "^":
            power = known[1].constant()
            if power is not None and power in range(1, MOST_PRODUCTS + 1):
                return reduce(_product, parts[:1] * int(float(power)))
    return None


def _product(first: Sum | None, second: Sum | None) -> Sum | None:
    """Return a product that is not too long, None of what is none."""
    if first is None or second is None or len(first.terms) * len(second.terms) > MOST_PRODUCTS:
        return None
    return first * second


def _node(node: Node, law: Law, chart: Chart) -> Node:
    if node.kind == "name" and node.text in law.inputs:
        return node_of_sum(_value(law.inputs[node.text], chart))
    if node.kind == "name" and _is_ambiguous(node.text):
        return node_of_sum(Sum.number(law.numbers[node.text]))
    inner = tuple(_node(one, law, chart) for one in node.inner)
    if node.kind == LENGTH:
        total = None
        for one in inner:
            square = Node("^", inner=(one, Node("number", "2")))
            total = square if total is None else Node("+", inner=(total, square))
        assert total is not None, "a speed has components"
        return call("sqrt", total)
    return Node(node.kind, node.text, inner)


def constants_of(law: Law) -> dict[str, Ball]:
    """Return the named constants that stand in a law."""
    used = names_of(law.root) - set(law.inputs)
    return {name: law.numbers[name] for name in sorted(used) if not _is_ambiguous(name)}


def _is_ambiguous(name: str) -> bool:
    """Return whether a constant is called as the time or a multiplier is."""
    return name == TIME or name.startswith(MULTIPLIER)


def _value(given: Input, chart: Chart) -> Sum:
    place = Sum.of(given.form, chart.places)
    return place.rate() if given.rate else place
