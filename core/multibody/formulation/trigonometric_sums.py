"""Sums of powers of variables times one sine or cosine: what the equations of a scene are in generalised coordinates.

Products of sines and cosines become sums at once, so that a sum has one form: what cancels is gone, and what is equal
is seen to be equal.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, field
from typing import NamedTuple

from core.balls import raised
from core.multibody.algebra.polynomials import ONE, ZERO, Ball, Poly, add_term, is_zero

TIME = "t"
"""The name of the time."""

WAVE_DIGITS = 15
"""Significant digits by which the factors of variables in a sine are compared: those of doubles."""


class Variable(NamedTuple):
    """A named quantity (order 0) or one of its derivatives by time."""

    name: str
    order: int = 0


Factors = tuple[tuple[Variable, int], ...]
"""Variables with their powers, in the order of their names."""

Wave = tuple[tuple[str, float], ...]
"""The argument of a sine or cosine: names of variables with their factors, the first of which is positive."""


class Term(NamedTuple):
    """What a coefficient of a sum belongs to.

    Attributes
    ----------
    factors : Factors
    function : {"", "cos", "sin"}
    wave : Wave
    """

    factors: Factors = ()
    function: str = ""
    wave: Wave = ()


@dataclass(frozen=True)
class Sum:
    """A sum of terms with coefficients in balls; those that contain zero are left out."""

    terms: Mapping[Term, Ball] = field(default_factory=dict)

    @classmethod
    def number(cls, value: Ball) -> Sum:
        """Return a constant."""
        return _cleaned({Term(): value})

    @classmethod
    def variable(cls, name: str, order: int = 0, power: int = 1) -> Sum:
        """Return a power of a variable or of one of its derivatives."""
        return cls({Term(((Variable(name, order), power),)): ONE})

    @classmethod
    def cosine(cls, name: str) -> Sum:
        """Return the cosine of a variable."""
        return cls({Term((), "cos", ((name, 1.0),)): ONE})

    @classmethod
    def sine(cls, name: str) -> Sum:
        """Return the sine of a variable."""
        return cls({Term((), "sin", ((name, 1.0),)): ONE})

    @classmethod
    def of(cls, poly: Poly, values: Sequence[Sum] | Mapping[int, Sum]) -> Sum:
        """Return a polynomial of coordinates that are sums."""
        parts = []
        for key, factor in poly.items():
            part = cls.number(factor)
            for i in key:
                part = part * values[i]
            parts.append(part)
        return added(parts)

    def __bool__(self) -> bool:
        return bool(self.terms)

    def __add__(self, other: Sum) -> Sum:
        return added((self, other))

    def __sub__(self, other: Sum) -> Sum:
        return added((self, other.times(-ONE)))

    def __mul__(self, other: Sum) -> Sum:
        found: dict[Term, Ball] = {}
        for a, x in self.terms.items():
            for b, y in other.terms.items():
                factors = _product(a.factors, b.factors)
                for factor, function, wave in _waves(a, b):
                    add_term(found, Term(factors, function, wave), x * y * factor)
        return _cleaned(found)

    def times(self, factor: Ball) -> Sum:
        """Return a multiple."""
        return _cleaned({term: factor * value for term, value in self.terms.items()})

    def names(self) -> set[str]:
        """Return the names of all variables that occur."""
        return self.in_factors() | self.in_waves()

    def in_factors(self) -> set[str]:
        """Return the names of variables that occur outside of sines and cosines."""
        return {variable.name for term in self.terms for variable, _ in term.factors}

    def in_places(self) -> set[str]:
        """Return the names of variables that occur themselves, not only their rates, outside of sines and cosines."""
        return {variable.name for term in self.terms for variable, _ in term.factors if variable.order == 0}

    def in_waves(self) -> set[str]:
        """Return the names of variables that occur inside of sines and cosines."""
        return {name for term in self.terms for name, _ in term.wave}

    def derivative(self, variable: Variable) -> Sum:
        """Return the partial derivative by a variable."""
        found: dict[Term, Ball] = {}
        for (factors, function, wave), value in self.terms.items():
            for at, power in factors:
                if at == variable:
                    add_term(found, Term(_product(factors, ((at, -1),)), function, wave), power * value)
            for name, factor in wave:
                if variable == Variable(name):
                    turned, sign = ("cos", 1) if function == "sin" else ("sin", -1)
                    add_term(found, Term(factors, turned, wave), sign * factor * value)
        return _cleaned(found)

    def rate(self) -> Sum:
        """Return the derivative by time along a motion."""
        parts = []
        inside = {Variable(name) for name in self.in_waves()}
        for variable in sorted({variable for term in self.terms for variable, _ in term.factors} | inside):
            slope = self.derivative(variable)
            moving = variable.name != TIME
            parts.append(slope * Sum.variable(variable.name, variable.order + 1) if moving else slope)
        return added(parts)

    def inverse(self) -> Sum | None:
        """Return the inverse of a product of powers, None of another sum."""
        if len(self.terms) != 1:
            return None
        ((term, value),) = self.terms.items()
        if term.function:
            return None
        return Sum({Term(tuple((variable, -power) for variable, power in term.factors)): 1 / value})

    def admits(self, name: str, value: Sum) -> bool:
        """Return whether a variable can be replaced: inside of sines by an affine sum, as a divisor by a product."""
        divides = any(at == Variable(name) and power < 0 for term in self.terms for at, power in term.factors)
        turns = name in self.in_waves()
        return not (divides and value.inverse() is None) and not (turns and value.affine() is None)

    def replaced(self, name: str, value: Sum) -> Sum:
        """Return the sum with a variable replaced, whose derivatives do not occur, by a sum that it admits."""
        parts, inverse = [], value.inverse()
        for term, factor in self.terms.items():
            power = dict(term.factors).get(Variable(name), 0)
            slope = dict(term.wave).get(name, 0.0)
            rest = tuple(entry for entry in term.factors if entry[0] != Variable(name))
            wave = tuple(entry for entry in term.wave if entry[0] != name)
            part = Sum({Term(rest): factor})
            factor_of_each = value if power >= 0 else inverse
            assert factor_of_each is not None, "a divisor is replaced by a product of powers"
            for _ in range(abs(power)):
                part = part * factor_of_each
            if term.function:
                part = part * _turned(term.function, wave, slope, value)
            parts.append(part)
        return added(parts)

    def value(self, places: Mapping[str, Ball], *derivatives: Mapping[str, Ball]) -> Ball:
        """Return the value of a sum.

        Parameters
        ----------
        places : mapping of str to ball
            Of every variable in it, the time among them.
        *derivatives : mapping of str to ball
            Rates, accelerations and so on, of which orders are left out at the end that are zero.

        Raises
        ------
        KeyError
            For a variable that has no value.
        """
        total = ZERO
        for (factors, function, wave), value in self.terms.items():
            for (name, order), exponent in factors:
                known = (places, *derivatives)[order][name] if order <= len(derivatives) else ZERO
                value = value * raised(known, exponent)
            if function:
                angle = sum((places[name] * x for name, x in wave), ZERO)
                value = value * (angle.cos() if function == "cos" else angle.sin())
            total = total + value
        return total

    def constant(self) -> Ball | None:
        """Return the value of a sum that is a constant, None of another."""
        if not self.terms:
            return ONE - ONE
        return self.terms[Term()] if set(self.terms) == {Term()} else None

    def affine(self, order: int = 0) -> tuple[dict[str, Ball], Ball] | None:
        """Return the factors of variables of one order and the constant of an affine sum, None of another."""
        factors, constant = {}, ONE - ONE
        for term, value in self.terms.items():
            if term == Term():
                constant = value
            elif not term.function and len(term.factors) == 1 and term.factors[0][1] == 1:
                variable = term.factors[0][0]
                if variable.order != order:
                    return None
                factors[variable.name] = value
            else:
                return None
        return factors, constant


def added(parts: Iterable[Sum]) -> Sum:
    """Return the sum of sums."""
    found: dict[Term, Ball] = {}
    for part in parts:
        for term, value in part.terms.items():
            add_term(found, term, value)
    return _cleaned(found)


def _cleaned(terms: Mapping[Term, Ball]) -> Sum:
    return Sum({term: value for term, value in terms.items() if not is_zero(value)})


def _product(first: Factors, second: Factors) -> Factors:
    powers = dict(first)
    for variable, power in second:
        powers[variable] = powers.get(variable, 0) + power
    return tuple(sorted((entry for entry in powers.items() if entry[1]), key=lambda entry: entry[0]))


def _wave(parts: Mapping[str, float]) -> tuple[int, Wave]:
    """Return the sign that was taken out of an argument, and the argument."""
    known = sorted((name, float(f"{x:.{WAVE_DIGITS}g}")) for name, x in parts.items())
    kept = [(name, x) for name, x in known if x != 0.0]
    sign = -1 if kept and kept[0][1] < 0.0 else 1
    return sign, tuple((name, sign * x) for name, x in kept)


def _waves(a: Term, b: Term) -> list[tuple[Ball, str, Wave]]:
    """Return the sines and cosines, with their factors, of which the product of two is the sum."""
    if not (a.function and b.function):
        return [(ONE, a.function or b.function, a.wave or b.wave)]
    plus = {name: dict(a.wave).get(name, 0.0) + dict(b.wave).get(name, 0.0) for name, _ in (*a.wave, *b.wave)}
    minus = {name: dict(a.wave).get(name, 0.0) - dict(b.wave).get(name, 0.0) for name, _ in (*a.wave, *b.wave)}
    half = ONE / 2
    signs = {
        ("cos", "cos"): ("cos", half, half),
        ("sin", "sin"): ("cos", half, -half),
        ("sin", "cos"): ("sin", half, half),
        ("cos", "sin"): ("sin", -half, half),
    }
    function, of_minus, of_plus = signs[a.function, b.function]
    found = []
    for factor, parts in ((of_minus, minus), (of_plus, plus)):
        sign, wave = _wave(parts)
        if wave:
            found.append((factor * sign if function == "sin" else factor, function, wave))
        elif function == "cos":
            found.append((factor, "", wave))
    return found


def _turned(function: str, wave: Wave, slope: float, value: Sum) -> Sum:
    """Return a sine or cosine of an argument that has had a variable replaced by an affine sum."""
    parts = dict(wave)
    known = value.affine() if slope else ({}, ONE - ONE)
    assert known is not None, "what stands inside of a sine is replaced by what is affine"
    for name, factor in known[0].items():
        parts[name] = parts.get(name, 0.0) + slope * float(factor)
    sine, cosine = (known[1] * slope).sin_cos()
    sign, turned = _wave(parts)
    first, second = (
        (Sum({Term((), f, turned): ONE}) if turned else Sum.number(ONE if f == "cos" else ONE - ONE))
        for f in (("cos", "sin") if function == "cos" else ("sin", "cos"))
    )
    # cos(w + c) = cos w cos c - sin w sin c; sin(w + c) = sin w cos c + cos w sin c.
    if function == "cos":
        return first.times(cosine) - second.times(sine * sign)
    return first.times(cosine * sign) + second.times(sine)
