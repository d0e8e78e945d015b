"""Sums and polynomials as the nodes of formulas, which can be written and read back.

A number of few digits, or a ratio of small whole numbers, stands as it is; others have the digits of the nearest
double.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from math import isfinite

from core.errors import NotApplicable
from core.formulas import Node
from core.multibody.algebra.polynomials import ONE, Ball, Poly, is_zero
from core.multibody.formulation.trigonometric_sums import Sum, Term, Variable, Wave

LARGEST_DENOMINATOR = 48
"""Up to which a number is written as a ratio: twelfths and forty-eighths are what moments of inertia bring."""

FEW_DIGITS = 6
"""Significant digits up to which a number stands in a formula as it is, and is given no name."""

Terms = list[tuple[Ball, list[Node]]]
"""Coefficients with what they multiply."""


def call(function: str, *arguments: Node) -> Node:
    """Return a function of formulas."""
    return Node(function, inner=arguments)


def is_short(text: str) -> bool:
    """Return whether a number has few digits."""
    return len(text.partition("e")[0].replace(".", "").lstrip("0")) <= FEW_DIGITS


def number(value: Ball) -> Node:
    """Return a positive number."""
    text = digits_of(float(value))
    if not is_short(text):
        for below in range(2, LARGEST_DENOMINATOR + 1):
            above = (value * below).unique_fmpz()
            if above is not None and 0 < int(above) < 10**FEW_DIGITS and is_zero(value * below - above):
                return Node("/", inner=(Node("number", str(int(above))), Node("number", str(below))))
    return Node("number", text)


def digits_of(value: float) -> str:
    """Return the digits that say a double, and no others; it raises as `require_doubles` does."""
    require_doubles([value])
    return repr(value).removesuffix(".0")


def require_doubles(numbers: Iterable[float]) -> None:
    """Raise `NotApplicable` where a number of an equation is none that a reader could compute with."""
    if not all(map(isfinite, numbers)):
        raise NotApplicable(
            "numbers of the equations leave the range of doubles",
            remedy="leave the equations out, or choose units in which the numbers are moderate",
        )


def node_of_sum(total: Sum) -> Node:
    """Return a sum as a formula."""
    return node_of_terms(terms_of(total))


def node_of_terms(terms: Terms) -> Node:
    """Return the sum of products as a formula, zero for none."""
    found: Node | None = None
    # A sum begins with a positive term where it has one.
    ordered = sorted(terms, key=lambda entry: bool(entry[0] < 0))
    for value, factors in ordered:
        part = _times(abs(value), factors)
        if found is None:
            found = Node("negative", inner=(part,)) if value < 0 else part
        else:
            found = Node("-" if value < 0 else "+", inner=(found, part))
    return found or Node("number", "0")


def _times(value: Ball, factors: list[Node]) -> Node:
    shown = factors if factors and is_zero(value - 1) else [number(value), *factors]
    above = [one for one in shown if not _is_inverse(one)]
    below = [one.inner[1] for one in shown if _is_inverse(one)]
    product = above[0] if above else Node("number", "1")
    for one in above[1:]:
        product = Node("*", inner=(product, one))
    for one in below:
        product = Node("/", inner=(product, one))
    return product


def _is_inverse(node: Node) -> bool:
    return node.kind == "inverse"


def terms_of(total: Sum) -> Terms:
    """Return the terms of a sum; a constant less a cosine of twice an argument is a square of a sine."""
    left, found = dict(total.terms), []
    for term in total.terms:
        if term.function != "cos" or any(x % 2 for _, x in term.wave) or term not in left:
            continue
        plain = Term(term.factors)
        value = left[term]
        if plain in left and is_zero(abs(left[plain]) - abs(value)):
            same = bool((left[plain] > 0) == (value > 0))
            half = tuple((name, x / 2) for name, x in term.wave)
            wave = _function("cos" if same else "sin", half)
            square = Node("^", inner=(wave, Node("number", "2")))
            found.append((2 * left[plain], [*_powers(term), square]))
            del left[plain], left[term]
    for term, value in sorted(left.items(), key=_place):
        shown = _powers(term)
        if term.function:
            shown.append(_function(term.function, term.wave))
        found.append((value, shown))
    return found


def _place(entry: tuple[Term, Ball]) -> tuple[object, ...]:
    """Return by what terms are put in order: those with most derivatives first, constants last."""
    term = entry[0]
    derivatives = sum(abs(power) * variable.order for variable, power in term.factors)
    return -derivatives, not term.factors and not term.function, not term.function, term


def variable_node(variable: Variable) -> Node:
    """Return a variable, with a prime for each derivative by time."""
    return Node("name", variable.name + "'" * variable.order)


def _powers(term: Term) -> list[Node]:
    found = []
    for variable, power in term.factors:
        base = variable_node(variable)
        shown = base if abs(power) == 1 else Node("^", inner=(base, Node("number", str(abs(power)))))
        found.append(shown if power > 0 else Node("inverse", inner=(Node("number", "1"), shown)))
    return found


def _function(function: str, wave: Wave) -> Node:
    terms: Terms = [(ONE * x, [Node("name", name)]) for name, x in wave]
    return call(function, node_of_terms(terms))


def node_of_poly(poly: Poly, names: Mapping[int, Node]) -> Node:
    """Return a polynomial of named coordinates as a formula."""
    return node_of_terms([(value, _product_of(key, names)) for key, value in poly.items()])


def _product_of(key: tuple[int, ...], names: Mapping[int, Node]) -> list[Node]:
    """Return the factors of a monomial."""
    if len(key) == 2 and key[0] == key[1]:
        return [Node("^", inner=(names[key[0]], Node("number", "2")))]
    return [names[i] for i in key]
