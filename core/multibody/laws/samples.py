"""The values of formulas at many states, in doubles, with the sizes to which their rounding is in proportion."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from core.arrays import Floats
from core.formulas import Arithmetic, value_of
from core.multibody.language.motion_formulas import LENGTH
from core.multibody.laws.law import Input, Law


@dataclass(frozen=True)
class Rounded:
    """Values, and sums of the magnitudes of the terms that they consist of, of one shape.

    A function adds to its value what its slope makes of the size of its argument.
    """

    value: Floats
    size: Floats

    def __neg__(self) -> Rounded:
        return Rounded(-self.value, self.size)

    def __add__(self, other: Rounded) -> Rounded:
        return Rounded(self.value + other.value, self.size + other.size)

    def __sub__(self, other: Rounded) -> Rounded:
        return Rounded(self.value - other.value, self.size + other.size)

    def __mul__(self, other: Rounded) -> Rounded:
        return Rounded(self.value * other.value, self.size * other.size)


def _exactly(value: float | Floats) -> Rounded:
    return Rounded(np.array(value), np.abs(np.array(value)))


def _quotient(one: Rounded, other: Rounded) -> Rounded:
    value = one.value / other.value
    return Rounded(value, (one.size + np.abs(value) * other.size) / np.abs(other.value))


def _power(one: Rounded, other: Rounded) -> Rounded:
    value = one.value**other.value
    slope = np.abs(other.value * one.value ** (other.value - 1.0))
    with np.errstate(divide="ignore", invalid="ignore"):
        steepness = np.where(one.value > 0.0, np.abs(value * np.log(np.abs(one.value))), 0.0)
    return Rounded(value, np.abs(value) + slope * one.size + steepness * other.size)


def _function(function: Callable[[Floats], Floats], slope: Callable[[Floats], Floats]) -> Callable[[Rounded], Rounded]:
    def found(x: Rounded) -> Rounded:
        value = function(x.value)
        return Rounded(value, np.abs(value) + np.abs(slope(x.value)) * x.size)

    return found


def _atan2(y: Rounded, x: Rounded) -> Rounded:
    value, square = np.arctan2(y.value, x.value), x.value**2 + y.value**2
    return Rounded(value, np.abs(value) + (np.abs(x.value) * y.size + np.abs(y.value) * x.size) / square)


def _length(*vector: Rounded) -> Rounded:
    value: Floats = np.sqrt(sum(part.value**2 for part in vector))
    return Rounded(value, sum((part.size for part in vector), value))


ROUNDED = Arithmetic[Rounded](
    lambda text: _exactly(float(text)),
    lambda: _exactly(np.pi),
    _quotient,
    _power,
    {
        "sqrt": _function(np.sqrt, lambda x: 0.5 / np.sqrt(x)),
        "sin": _function(np.sin, np.cos),
        "cos": _function(np.cos, np.sin),
        "tan": _function(np.tan, lambda x: 1.0 / np.cos(x) ** 2),
        "asin": _function(np.arcsin, lambda x: 1.0 / np.sqrt(1.0 - x * x)),
        "acos": _function(np.arccos, lambda x: 1.0 / np.sqrt(1.0 - x * x)),
        "atan": _function(np.arctan, lambda x: 1.0 / (1.0 + x * x)),
        "sinh": _function(np.sinh, np.cosh),
        "cosh": _function(np.cosh, np.sinh),
        "tanh": _function(np.tanh, lambda x: 1.0 / np.cosh(x) ** 2),
        "exp": _function(np.exp, np.exp),
        "log": _function(np.log, lambda x: 1.0 / x),
        "atan2": _atan2,
        LENGTH: _length,
    },
)
"""Formulas in doubles with their sizes."""


def values_of(law: Law, q: Floats, v: Floats) -> tuple[Floats, Floats]:
    """Return the values of a law at states of shape (t, n, 2), and their sizes, each of shape (t,)."""
    names = {name: _exactly(float(number)) for name, number in law.numbers.items()}
    names |= {name: _input(given, v if given.rate else q) for name, given in law.inputs.items()}
    with np.errstate(divide="ignore", invalid="ignore", over="ignore"):
        found = value_of(law.root, names, ROUNDED)
    shape = (len(q),)
    return np.broadcast_to(found.value, shape), np.broadcast_to(found.size, shape)


def _input(given: Input, of: Floats) -> Rounded:
    value, size = np.zeros(len(of)), np.zeros(len(of))
    for key, slope in given.form.items():
        if key or not given.rate:
            term = float(slope) * (of[:, key[0], 0] if key else np.ones(len(of)))
            value, size = value + term, size + np.abs(term)
    return Rounded(value, size)
