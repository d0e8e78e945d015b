"""The values of formulas at many states, in doubles, with the sizes to which their rounding is in proportion."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from core.arrays import Floats
from core.formulas import Arithmetic, value_of
from core.multibody.language.motion_formulas import LENGTH
from core.multibody.laws.law import Input, Law

UNIT_ROUNDING = 2.0**-52
"""Share of its terms up to which an argument is zero: one rounding of doubles."""


@dataclass(frozen=True)
class Rounded:
    """Values, sums of the magnitudes of the terms that they consist of, and rates along the motion, of one shape.

    A function adds to its value what its slope makes of the size of its argument.
    """

    value: Floats
    size: Floats
    rate: Floats

    def __neg__(self) -> Rounded:
        return Rounded(-self.value, self.size, -self.rate)

    def __add__(self, other: Rounded) -> Rounded:
        return Rounded(self.value + other.value, self.size + other.size, self.rate + other.rate)

    def __sub__(self, other: Rounded) -> Rounded:
        return Rounded(self.value - other.value, self.size + other.size, self.rate - other.rate)

    def __mul__(self, other: Rounded) -> Rounded:
        rate = self.rate * other.value + self.value * other.rate
        return Rounded(self.value * other.value, self.size * other.size, rate)

    @property
    def sign(self) -> Floats:
        """Sign just after the present time: of what is zero to rounding, that of its rate."""
        zero = np.abs(self.value) <= UNIT_ROUNDING * self.size
        return np.sign(np.where(zero, self.rate, self.value))


def _exactly(value: float | Floats) -> Rounded:
    given = np.array(value)
    return Rounded(given, np.abs(given), np.zeros_like(given))


def _quotient(one: Rounded, other: Rounded) -> Rounded:
    value = one.value / other.value
    size = (one.size + np.abs(value) * other.size) / np.abs(other.value)
    return Rounded(value, size, (one.rate - value * other.rate) / other.value)


def _power(one: Rounded, other: Rounded) -> Rounded:
    value = one.value**other.value
    slope = other.value * one.value ** (other.value - 1.0)
    with np.errstate(divide="ignore", invalid="ignore"):
        steepness = np.where(one.value > 0.0, value * np.log(np.abs(one.value)), 0.0)
    size = np.abs(value) + np.abs(slope) * one.size + np.abs(steepness) * other.size
    return Rounded(value, size, slope * one.rate + steepness * other.rate)


def _function(function: Callable[[Floats], Floats], slope: Callable[[Floats], Floats]) -> Callable[[Rounded], Rounded]:
    def found(x: Rounded) -> Rounded:
        value, steepness = function(x.value), slope(x.value)
        return Rounded(value, np.abs(value) + np.abs(steepness) * x.size, steepness * x.rate)

    return found


def _atan2(y: Rounded, x: Rounded) -> Rounded:
    value, square = np.arctan2(y.value, x.value), x.value**2 + y.value**2
    size = np.abs(value) + (np.abs(x.value) * y.size + np.abs(y.value) * x.size) / square
    return Rounded(value, size, (x.value * y.rate - y.value * x.rate) / square)


def _sign(x: Rounded) -> Rounded:
    return _exactly(x.sign)


def _absolute(x: Rounded) -> Rounded:
    return Rounded(np.abs(x.value), x.size, x.sign * x.rate)


def _chosen(condition: Rounded, one: Rounded, other: Rounded) -> Rounded:
    """Return one of two where a condition is positive just after, and else the other."""
    first = condition.sign > 0.0
    both = ((one.value, other.value), (one.size, other.size), (one.rate, other.rate))
    return Rounded(*(np.where(first, *pair) for pair in both))


def _length(*vector: Rounded) -> Rounded:
    value: Floats = np.sqrt(sum(part.value**2 for part in vector))
    rate = sum((part.value * part.rate for part in vector), np.zeros(()))
    return Rounded(value, sum((part.size for part in vector), value), rate / np.where(value > 0.0, value, 1.0))


ROUNDED = Arithmetic[Rounded](
    lambda text: _exactly(float(text)),
    lambda: _exactly(np.pi),
    _quotient,
    _power,
    {
        "sqrt": _function(np.sqrt, lambda x: 0.5 / np.sqrt(x)),
        "sin": _function(np.sin, np.cos),
        "cos": _function(np.cos, lambda x: -np.sin(x)),
        "tan": _function(np.tan, lambda x: 1.0 / np.cos(x) ** 2),
        "asin": _function(np.arcsin, lambda x: 1.0 / np.sqrt(1.0 - x * x)),
        "acos": _function(np.arccos, lambda x: -1.0 / np.sqrt(1.0 - x * x)),
        "atan": _function(np.arctan, lambda x: 1.0 / (1.0 + x * x)),
        "sinh": _function(np.sinh, np.cosh),
        "cosh": _function(np.cosh, np.sinh),
        "tanh": _function(np.tanh, lambda x: 1.0 / np.cosh(x) ** 2),
        "exp": _function(np.exp, np.exp),
        "log": _function(np.log, lambda x: 1.0 / x),
        "atan2": _atan2,
        "abs": _absolute,
        "sign": _sign,
        "min": lambda x, y: _chosen(y - x, x, y),
        "max": lambda x, y: _chosen(x - y, x, y),
        "if": _chosen,
        LENGTH: _length,
    },
)
"""Formulas in doubles with their sizes."""


def values_of(law: Law, q: Floats, v: Floats) -> tuple[Floats, Floats]:
    """Return the values of a law at states of shape (t, n, 2), and their sizes, each of shape (t,).

    Where an argument of a function of several pieces is zero, and depends on no rate, the value is that just after.
    """
    names = {name: _exactly(float(number)) for name, number in law.numbers.items()}
    names |= {name: _input(given, q, v) for name, given in law.inputs.items()}
    with np.errstate(divide="ignore", invalid="ignore", over="ignore"):
        found = value_of(law.root, names, ROUNDED)
    shape = (len(q),)
    return np.broadcast_to(found.value, shape), np.broadcast_to(found.size, shape)


def _input(given: Input, q: Floats, v: Floats) -> Rounded:
    value, size, rate = np.zeros(len(q)), np.zeros(len(q)), np.zeros(len(q))
    for key, ball in given.form.items():
        slope = float(ball)
        if not key:
            term = np.full(len(q), 0.0 if given.rate else slope)
        else:
            term = slope * (v if given.rate else q)[:, key[0], 0]
            if not given.rate:
                rate = rate + slope * v[:, key[0], 0]
        value, size = value + term, size + np.abs(term)
    return Rounded(value, size, rate)
