"""Formulas of time as coordinates without mass: what drives a place, a length or a turn.

Every function becomes rows that are quadratic, whose coordinates follow from the time: a product is a measure, sine and
cosine are the components of a unit vector that turns with their argument, and an exponential is in proportion to its
rate. What drives is then a row as any other: its force, its work and its motion in every arithmetic follow.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from functools import partial
from operator import mul, truediv

from core.errors import InvalidParameter, Path
from core.formulas import Node, value_of
from core.multibody.algebra.polynomials import (
    ONE,
    ZERO,
    Ball,
    LinearForm,
    Poly,
    combined,
    constant,
    coordinate,
    degree,
    difference,
    entry,
    evaluated,
    product,
)
from core.multibody.language.motion_formulas import TIME, motion_formula
from core.multibody.language.numerals import BALLS
from core.multibody.language.switches import SWITCHING
from core.multibody.table.measures import Measures
from core.multibody.table.table import Following, Row

LARGEST_PRODUCT = 16
"""Whole powers up to this are products, of four factors at most; others are powers of positive numbers."""


def clock(measures: Measures) -> int:
    """Return the coordinate that is time, made once."""
    table = measures.table
    if "clock" in table.names:
        return table.names.index("clock")
    index = table.coordinate("clock", "s", ZERO)
    table.rows.append(Row("clock", None, {index: constant(ONE)}, ONE))
    return index


def of_time(measures: Measures, name: str, value: object, path: Path) -> Poly | None:
    """Return a formula of time as an affine polynomial of coordinates; None for a number.

    Parameters
    ----------
    name : str
        The connection to which its rows belong.

    Raises
    ------
    InvalidParameter
        For what is no formula of time alone, or has no value or no rate at the start.
    """
    formula = motion_formula(value, measures.numerals, (), (), path)
    if formula is None:
        return None
    found = FormulaRows(measures, name, path, {TIME: coordinate(clock(measures))}).of(formula.root)
    if not all(measures.table.q[i].is_finite() for key in found for i in key):
        raise InvalidParameter(
            path, f"have a value {measures.moment}: it divides by zero, or leaves the domain of a function"
        )
    return found


def driven(measures: Measures, name: str, value: object, path: Path) -> Poly:
    """Return a formula of time, or a number, as an affine polynomial of coordinates; see `of_time`."""
    found = of_time(measures, name, value, path)
    return constant(measures.numerals.number(value, path)) if found is None else found


class FormulaRows:
    """Adds the rows of one formula.

    Parameters
    ----------
    name : str
        Of the connection.
    names : mapping of str to polynomial
        What the names of the formula stand for, but those that are numbers.
    """

    def __init__(self, measures: Measures, name: str, path: Path, names: Mapping[str, Poly]) -> None:
        self.measures, self.table, self.name, self.path, self.names = measures, measures.table, name, path, names

    def of(self, node: Node) -> Poly:
        """Return a part of the formula."""
        numbers = self.measures.numerals.let
        if node.kind == "name" and node.text not in numbers:
            return self.names[node.text]
        if not node.inner:
            return constant(value_of(node, numbers, BALLS))
        inner = [self.of(one) for one in node.inner]
        if all(degree(one) <= 0 for one in inner):
            names = {str(i): _constant(one) for i, one in enumerate(inner)}
            parts = tuple(Node("name", name) for name in names)
            return constant(value_of(Node(node.kind, node.text, parts), names, BALLS))
        return self._function(node.kind, inner)

    def _function(self, kind: str, inner: list[Poly]) -> Poly:
        first, last = inner[0], inner[-1]
        match kind:
            case "negative":
                return combined((-ONE, first))
            case "+":
                return combined((ONE, first), (ONE, last))
            case "-":
                return difference(first, last)
            case "*":
                return self._product(first, last)
            case "/":
                return self._quotient(first, last)
            case "^":
                return self._power(first, last)
            case "sqrt":
                self._require_positive(first)
                root = self._coordinate(_square_root, first)
                self._hold(difference(product(root, root), first))
                return root
            case "sin" | "cos" | "tan":
                cosine, sine = self._direction(first)
                return {"sin": sine, "cos": cosine}[kind] if kind != "tan" else self._quotient(sine, cosine)
            case "exp":
                return self._exponential(first)
            case "sinh" | "cosh" | "tanh":
                up, down = self._exponential(first), self._exponential(combined((-ONE, first)))
                sinh, cosh = combined((ONE / 2, up), (-ONE / 2, down)), combined((ONE / 2, up), (ONE / 2, down))
                return {"sinh": sinh, "cosh": cosh}[kind] if kind != "tanh" else self._quotient(sinh, cosh)
            case "log":
                return self._integral(_logarithm, first, first)
            case "asin" | "acos":
                root = self._function("sqrt", [difference(constant(ONE), self._product(first, first))])
                angle = self._integral(_arc_sine, root, first)
                return angle if kind == "asin" else difference(constant(ONE.pi() / 2), angle)
            case "atan":
                square = combined((ONE, constant(ONE)), (ONE, self._product(first, first)))
                return self._integral(_arc_tangent, square, first)
        rule = "be a formula of time that has one piece" if kind in SWITCHING else f"do without {kind}"
        raise InvalidParameter(self.path, f"{rule} where it drives something")

    def _follow(self, values: Callable[[Ball], Sequence[Ball]], argument: Poly) -> list[Poly]:
        """Return coordinates that are functions of a polynomial, whose rate row is added next."""
        if self.measures.sketch and not self._is_timed(argument):
            rule = "have no functions of places or angles other than square roots"
            raise InvalidParameter(self.path, rule, remedy="give the places exactly")
        count = len(values(self._value(argument)))
        return [self._coordinate(partial(_component, values, i), argument) for i in range(count)]

    def _tie(self, found: Sequence[Poly], values: Callable[[Ball], Sequence[Ball]], argument: Poly) -> None:
        """Let the assembly of the start know of what coordinates the last row makes functions."""
        if not self._is_timed(argument):
            indices = tuple(key[0] for poly in found for key in poly)
            self.table.follows.append(Following(indices, values, argument, self.table.rows[-1]))

    def _note_twins(self, found: Sequence[Poly], *of: Poly) -> None:
        """Take note of what coordinates that follow from the time are, and of the same ones before them."""
        if not all(self._is_timed(poly) for poly in of):
            return
        known = self.measures.functions_of_time
        first = {index: twin for index, twin in self.table.twins}
        key = tuple(
            tuple(sorted((tuple(first.get(i, i) for i in at), str(x.mid()), str(x.rad())) for at, x in poly.items()))
            for poly in of
        )
        indices = [next(iter(poly))[0] for poly in found]
        self.table.twins.extend(zip(indices, known.setdefault((len(found), key), indices), strict=True))

    def _require_positive(self, poly: Poly) -> None:
        """Refuse roots and powers that have no rate at the start."""
        if not self._value(poly) > 0:
            rule = f"have a rate {self.measures.moment}: the root or power of a positive number"
            raise InvalidParameter(self.path, rule)

    def _value(self, poly: Poly) -> Ball:
        return evaluated(poly, self.table.q)

    def _coordinate(self, function: Callable[..., Ball], *of: Poly) -> Poly:
        """Return a coordinate that is a function of polynomials."""
        value = partial(_value_of, function, of)
        count = sum(name.startswith(f"{self.name}.formula") for name in self.table.names)
        index = self.table.coordinate(f"{self.name}.formula{count + 1}", "1", value(self.table.q))
        if all(self._is_timed(poly) for poly in of):
            self.table.timed[index] = value
        return coordinate(index)

    def _is_timed(self, poly: Poly) -> bool:
        """Return whether the time alone decides of a polynomial."""
        timed = self.table.timed
        return all(i in timed or self.table.units[i] == "s" for key in poly for i in key)

    def _hold(self, measure: Poly) -> None:
        self.table.rows.append(Row.held(self.name, measure))

    def _roll(self, *parts: tuple[Poly, Poly]) -> None:
        """Add the row by which the rates of polynomials, each times another one, add up to zero."""
        rates: LinearForm = {}
        for factor, poly in parts:
            for key, slope in poly.items():
                if key:
                    rates[key[0]] = combined((ONE, rates.get(key[0], {})), (slope, factor))
        self.table.rows.append(Row(self.name, None, {j: line for j, line in rates.items() if line}))

    def _product(self, first: Poly, last: Poly) -> Poly:
        for one, other in ((first, last), (last, first)):
            if degree(one) <= 0:
                return combined((_constant(one), other))
        found = self._coordinate(mul, first, last)
        self._hold(difference(found, product(first, last)))
        self._note_twins([found], first, last)
        return found

    def _quotient(self, first: Poly, last: Poly) -> Poly:
        if degree(last) <= 0:
            return combined((1 / _constant(last), first))
        found = self._coordinate(truediv, first, last)
        self._hold(difference(product(found, last), first))
        return found

    def _power(self, base: Poly, exponent: Poly) -> Poly:
        if degree(exponent) > 0:
            return self._exponential(self._product(exponent, self._function("log", [base])))
        given = _constant(exponent)
        whole = given.unique_fmpz()
        if whole is None or not 0 <= abs(int(whole)) <= LARGEST_PRODUCT:
            self._require_positive(base)

            def values(x: Ball) -> list[Ball]:
                return [x**given]

            (found,) = self._follow(values, base)
            self._roll((base, found), (combined((-given, found)), base))
            self._tie([found], values, base)
            return found
        found = constant(ONE)
        for bit in bin(abs(int(whole)))[2:]:
            found = self._product(found, found)
            found = self._product(found, base) if bit == "1" else found
        return found if whole >= 0 else self._quotient(constant(ONE), found)

    def _direction(self, angle: Poly) -> tuple[Poly, Poly]:
        """Return cosine and sine of an angle."""
        sine, cosine = pair = self._follow(_sine_and_cosine, angle)
        self._note_twins(pair, angle)
        self._hold(combined((ONE, product(cosine, cosine)), (ONE, product(sine, sine)), (-ONE, constant(ONE))))
        self._roll((cosine, sine), (combined((-ONE, sine)), cosine), (constant(-ONE), angle))
        self._tie(pair, _sine_and_cosine, angle)
        return cosine, sine

    def _exponential(self, exponent: Poly) -> Poly:
        (found,) = self._follow(_exponential, exponent)
        self._roll((constant(ONE), found), (combined((-ONE, found)), exponent))
        self._tie([found], _exponential, exponent)
        return found

    def _integral(self, values: Callable[[Ball], Sequence[Ball]], slope: Poly, argument: Poly) -> Poly:
        """Return what changes by the change of an argument over a slope."""
        (found,) = self._follow(values, argument)
        self._roll((slope, found), (constant(-ONE), argument))
        self._tie([found], values, argument)
        return found


def _value_of(function: Callable[..., Ball], of: Sequence[Poly], q: Sequence[Ball]) -> Ball:
    return function(*(evaluated(poly, q) for poly in of))


def _component(values: Callable[[Ball], Sequence[Ball]], i: int, x: Ball) -> Ball:
    return values(x)[i]


def _square_root(x: Ball) -> Ball:
    return x.sqrt()


def _sine_and_cosine(x: Ball) -> Sequence[Ball]:
    return x.sin_cos()  # type: ignore[no-any-return]


def _exponential(x: Ball) -> Sequence[Ball]:
    return [x.exp()]


def _logarithm(x: Ball) -> Sequence[Ball]:
    return [x.log()]


def _arc_sine(x: Ball) -> Sequence[Ball]:
    return [x.asin()]


def _arc_tangent(x: Ball) -> Sequence[Ball]:
    return [x.atan()]


def _constant(poly: Poly) -> Ball:
    """Return the value of a polynomial of degree zero."""
    return entry(poly, ())
