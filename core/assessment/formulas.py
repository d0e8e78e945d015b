"""Formulas of students: their value in doubles at any parameters, and their dimensions."""

from __future__ import annotations

import math
from collections.abc import Mapping
from fractions import Fraction

from core.formulas import FUNCTIONS, Formula, Node, value_of
from core.formulas_in_doubles import DOUBLES

Powers = Mapping[str, Fraction]
"""Powers of base units, none of them 0."""

LARGEST_POWER = 20
"""To which a quantity with a dimension is raised."""


class Undefined(ValueError):
    """The formula has no value at these parameters: a division by zero, a root of a negative number, an overflow."""


class DimensionFault(ValueError):
    """Terms of a sum have different dimensions, or a function or an exponent has one.

    Parameters
    ----------
    key : str
        Of the feedback on it.
    """

    def __init__(self, key: str) -> None:
        super().__init__(key)
        self.key = key


def value_in_doubles(formula: Formula, parameters: Mapping[str, float]) -> float:
    """Return the value of a formula at some parameters.

    Raises
    ------
    Undefined
        If there is none.
    """
    try:
        value = formula.value(parameters, DOUBLES)
    except (ValueError, ZeroDivisionError, OverflowError) as fault:
        raise Undefined from fault
    if not math.isfinite(value):
        raise Undefined
    return float(value)


def dimensions(formula: Formula, units: Mapping[str, Powers]) -> Powers:
    """Return the powers of base units of the value of a formula, from those of the parameters.

    Raises
    ------
    DimensionFault
        If terms of a sum have different ones, or a function or an exponent has any.
    """
    return _dimensions(formula.root, units)


def _dimensions(node: Node, units: Mapping[str, Powers]) -> Powers:
    if node.kind in ("number", "pi"):
        return {}
    if node.kind == "name":
        return units[node.text]
    inner = [_dimensions(one, units) for one in node.inner]
    if node.kind == "negative" or node.kind == "abs":
        return inner[0]
    if node.kind == "sqrt":
        return _scaled(inner[0], Fraction(1, 2))
    if node.kind in FUNCTIONS:
        if inner[0]:
            raise DimensionFault("dimension-function")
        return {}
    one, other = inner
    if node.kind in ("+", "-"):
        if one != other:
            raise DimensionFault("dimension-terms")
        return one
    if node.kind == "^":
        if other or (one and _exponent(node.inner[1]) is None):
            raise DimensionFault("dimension-exponent")
        return _scaled(one, _exponent(node.inner[1]) or Fraction(0))
    sign = 1 if node.kind == "*" else -1
    both = {name: one.get(name, Fraction(0)) + sign * other.get(name, Fraction(0)) for name in {*one, *other}}
    return {name: power for name, power in both.items() if power}


def _scaled(powers: Powers, times: Fraction) -> Powers:
    return {name: power * times for name, power in powers.items() if power * times}


def _exponent(node: Node) -> Fraction | None:
    """Return an exponent without names as a fraction of small numbers, None for any other."""
    try:
        value = value_of(node, {}, DOUBLES)
    except (KeyError, ValueError, ZeroDivisionError, OverflowError):
        return None
    if not math.isfinite(value) or abs(value) > LARGEST_POWER:
        return None
    near = Fraction(value).limit_denominator(12)
    return near if abs(float(near) - value) < 1e-12 else None
