"""Formulas that are linear in places and rates, beside swings and exponentials of time.

Sines, cosines and exponentials of time, and their products, are real parts of sums of z exp(p t) with complex z and p.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field
from typing import Any

from flint import acb

from core.errors import InvalidParameter
from core.formulas import Node, value_of
from core.multibody.algebra.polynomials import ONE, ZERO, Ball, is_zero
from core.multibody.language.motion_formulas import TIME
from core.multibody.language.numerals import BALLS
from core.multibody.laws.law import Input

HIGHEST_POWER = 8
"""Of swings in a formula: each may double the number of its exponentials."""

Exponential = tuple[Any, Any]
"""Complex balls z and p of z exp(p t)."""


@dataclass(frozen=True)
class Linear:
    """A sum of names with constant factors, a constant, and the real part of a sum of exponentials of time.

    Attributes
    ----------
    factors : mapping of str to ball
        Of names; that of the empty name is a constant.
    exponentials : tuple of pairs of complex balls
        No two with the same p, whose imaginary part is not below zero.
    """

    factors: Mapping[str, Ball]
    exponentials: tuple[Exponential, ...] = field(default=())

    @property
    def constant(self) -> bool:
        """Whether it has nothing but a constant."""
        return not self.exponentials and self.factors.keys() <= {""}

    @property
    def timed(self) -> bool:
        """Whether it has nothing but a constant and exponentials."""
        return self.factors.keys() <= {""}

    def plus(self, other: Linear, factor: Ball) -> Linear:
        """Return the sum with a multiple of another."""
        found = dict(self.factors)
        for name, value in other.factors.items():
            found[name] = found.get(name, ZERO) + factor * value
        return Linear(found, _collected((*self.exponentials, *((factor * z, p) for z, p in other.exponentials))))

    def times(self, other: Linear) -> Linear | None:
        """Return the product; None where it is not linear."""
        for one, another in ((self, other), (other, self)):
            if one.constant:
                return Linear({}).plus(another, one.factors.get("", ZERO))
        if not (self.timed and other.timed):
            return None
        first, second = (((acb(x.factors.get("", ZERO)), acb(0)), *x.exponentials) for x in (self, other))
        # The product of the real parts of a and b is half the real part of a b + a conj(b).
        products = [
            (z * w / 2, p + q)
            for z, p in first
            for y, r in second
            for w, q in ((y, r), (acb(y.real, -y.imag), acb(r.real, -r.imag)))
        ]
        return _of_exponentials(products)


def _of_exponentials(given: Iterable[Exponential]) -> Linear:
    found = _collected(given)
    still = [z.real for z, p in found if is_zero(p.real) and is_zero(p.imag)]
    moving = tuple((z, p) for z, p in found if not (is_zero(p.real) and is_zero(p.imag)))
    return Linear({"": sum(still, ZERO)} if still else {}, moving)


def _collected(given: Iterable[Exponential]) -> tuple[Exponential, ...]:
    """Return exponentials of which no two have the same p, or ones that are conjugate."""
    found: list[Exponential] = []
    for z, p in given:
        if p.imag < 0:
            z, p = acb(z.real, -z.imag), acb(p.real, -p.imag)
        k = next((k for k, (_, q) in enumerate(found) if is_zero((p - q).real) and is_zero((p - q).imag)), None)
        if k is None:
            found.append((z, p))
        else:
            found[k] = (found[k][0] + z, found[k][1])
    return tuple((z, p) for z, p in found if not (is_zero(z.real) and is_zero(z.imag)))


def linear_form(root: Node, inputs: Mapping[str, Input], numbers: Mapping[str, Ball]) -> Linear | None:
    """Return a formula as a linear one, without names whose factor is zero; None where it is none."""
    try:
        found = _form(root, inputs, numbers)
    except InvalidParameter:
        return None
    if found is None or not all(factor.is_finite() for factor in found.factors.values()):
        return None
    return Linear({name: x for name, x in found.factors.items() if not is_zero(x)}, found.exponentials)


def _form(node: Node, inputs: Mapping[str, Input], numbers: Mapping[str, Ball]) -> Linear | None:
    if not _varies(node, inputs):
        return Linear({"": value_of(node, numbers, BALLS)})
    if node.kind == "name":
        return Linear({node.text: ONE})
    parts = [_form(inner, inputs, numbers) for inner in node.inner]
    if any(part is None for part in parts):
        return None
    first, *others = [part for part in parts if part is not None]
    match node.kind:
        case "negative":
            return Linear({}).plus(first, -ONE)
        case "+":
            return first.plus(others[0], ONE)
        case "-":
            return first.plus(others[0], -ONE)
        case "*":
            return first.times(others[0])
        case "/" if others[0].constant:
            return Linear({}).plus(first, 1 / others[0].factors.get("", ZERO))
        case "^" if others[0].constant:
            return _power(first, others[0].factors.get("", ZERO))
        case "sin" | "cos" | "exp" | "sinh" | "cosh" if first.factors.keys() <= {TIME, ""} and not first.exponentials:
            return _of_time(node.kind, first.factors.get(TIME, ZERO), first.factors.get("", ZERO))
    return None


def _power(base: Linear, exponent: Ball) -> Linear | None:
    whole = exponent.unique_fmpz()
    if whole is None or not 1 <= int(whole) <= HIGHEST_POWER:
        return None
    found: Linear | None = base
    for _ in range(int(whole) - 1):
        found = None if found is None else found.times(base)
    return found


def _of_time(kind: str, rate: Ball, start: Ball) -> Linear:
    """Return a function of ``rate t + start``."""
    along, turned = acb(start).exp(), acb(0, start).exp()
    match kind:
        case "exp":
            return _of_exponentials([(along, acb(rate))])
        case "cos":
            return _of_exponentials([(turned, acb(0, rate))])
        case "sin":
            return _of_exponentials([(turned * acb(0, -1), acb(0, rate))])
    sign = 1 if kind == "cosh" else -1
    return _of_exponentials([(along / 2, acb(rate)), (sign / along / 2, acb(-rate))])


def _varies(node: Node, inputs: Mapping[str, Input]) -> bool:
    return node.text in inputs if node.kind == "name" else any(_varies(inner, inputs) for inner in node.inner)
