"""Reads printed equations back, and computes accelerations from nothing but them and the columns of an answer.

Formulas are read by the grammar of Python, of which theirs is a part, and evaluated on values with their first two
derivatives by time. The accelerations and multipliers that satisfy the equations are then found by linear algebra.
"""

from __future__ import annotations

import ast
import re
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass

import mpmath
import numpy as np

from core.multibody.equations_answer import SceneEquations
from core.multibody.formulation.notation.plain import plain

Number = mpmath.mpf
ZERO = mpmath.mpf(0)


@dataclass(frozen=True)
class Jet:
    """A value with its first and second derivative by time."""

    value: Number
    rate: Number = ZERO
    gain: Number = ZERO

    def __add__(self, other: Jet) -> Jet:
        return Jet(self.value + other.value, self.rate + other.rate, self.gain + other.gain)

    def __sub__(self, other: Jet) -> Jet:
        return self + -other

    def __neg__(self) -> Jet:
        return Jet(-self.value, -self.rate, -self.gain)

    def __mul__(self, other: Jet) -> Jet:
        return Jet(
            self.value * other.value,
            self.rate * other.value + self.value * other.rate,
            self.gain * other.value + 2 * self.rate * other.rate + self.value * other.gain,
        )

    def through(self, function: Callable[[Number], Number], first: Number, second: Number) -> Jet:
        """Return a function of it, of which the derivatives are known."""
        return Jet(function(self.value), first * self.rate, first * self.gain + second * self.rate**2)


def _inverse(x: Jet) -> Jet:
    return x.through(lambda a: 1 / a, -1 / x.value**2, 2 / x.value**3)


def _power(x: Jet, exponent: Jet) -> Jet:
    n = exponent.value
    if n == int(n) and n >= 0:
        found = Jet(mpmath.mpf(1))
        for _ in range(int(n)):
            found = found * x
        return found
    return x.through(lambda a: a**n, n * x.value ** (n - 1), n * (n - 1) * x.value ** (n - 2))


def _atan2(y: Jet, x: Jet) -> Jet:
    square = x * x + y * y
    # The rate of the angle is (x y' - y x')/(x^2 + y^2), and its rate follows by the rule of the quotient.
    turning = x.value * y.rate - y.value * x.rate
    changing = x.value * y.gain - y.value * x.gain
    rate = turning / square.value
    return Jet(mpmath.atan2(y.value, x.value), rate, (changing - rate * square.rate) / square.value)


def _root(x: Jet) -> Jet:
    if x.value == x.rate == x.gain == 0:
        return x
    return x.through(mpmath.sqrt, 1 / (2 * mpmath.sqrt(x.value)), -1 / (4 * mpmath.sqrt(x.value) ** 3))


def _sn(u: Jet, m: Jet) -> Jet:
    sn, cn, dn = (mpmath.ellipfun(kind, u.value, m=m.value) for kind in ("sn", "cn", "dn"))
    return u.through(lambda _: sn, cn * dn, -sn * (dn * dn + m.value * cn * cn))


def _am(u: Jet, m: Jet) -> Jet:
    """Jacobi's amplitude, by which Legendre's integral of the first kind is u."""
    guess = mpmath.pi * u.value / (2 * mpmath.ellipk(m.value))
    angle = mpmath.findroot(lambda x: mpmath.ellipf(x, m.value) - u.value, guess)
    dn = mpmath.sqrt(1 - m.value * mpmath.sin(angle) ** 2)
    return u.through(lambda _: angle, dn, -m.value * mpmath.sin(angle) * mpmath.cos(angle))


def _asin(x: Jet) -> Jet:
    root = mpmath.sqrt(1 - x.value**2)
    return x.through(mpmath.asin, 1 / root, x.value / root**3)


_FUNCTIONS: dict[str, Callable[..., Jet]] = {
    "sn": _sn,
    "am": _am,
    "asin": _asin,
    "atan": lambda x: x.through(mpmath.atan, 1 / (1 + x.value**2), -2 * x.value / (1 + x.value**2) ** 2),
    "sinh": lambda x: x.through(mpmath.sinh, mpmath.cosh(x.value), mpmath.sinh(x.value)),
    "sin": lambda x: x.through(mpmath.sin, mpmath.cos(x.value), -mpmath.sin(x.value)),
    "cos": lambda x: x.through(mpmath.cos, -mpmath.sin(x.value), -mpmath.cos(x.value)),
    "exp": lambda x: x.through(mpmath.exp, mpmath.exp(x.value), mpmath.exp(x.value)),
    "sqrt": _root,
    "atan2": _atan2,
    "abs": lambda x: x if x.value >= 0 else -x,
}


def evaluated(text: str, names: Mapping[str, Jet]) -> Jet:
    """Return the value of a printed formula, in which primes are derivatives by time."""
    known: dict[str, Jet] = {}
    for name, x in names.items():
        known |= {name: x, f"{name}'": Jet(x.rate, x.gain), f"{name}''": Jet(x.gain)}
    longest_first = sorted(known, key=len, reverse=True)
    pattern = re.compile(rf"(?<![\w.])(?:{'|'.join(map(re.escape, longest_first))})(?![\w.'(])")
    used: dict[str, Jet] = {}

    def numbered(found: re.Match[str]) -> str:
        used[identifier := f"v{longest_first.index(found.group())}"] = known[found.group()]
        return identifier

    readable = pattern.sub(numbered, text).replace("^", "**")
    return _value(ast.parse(readable, mode="eval").body, used)


def _value(node: ast.expr, names: Mapping[str, Jet]) -> Jet:
    match node:
        case ast.Constant(value):
            return Jet(mpmath.mpf(value))  # type: ignore[arg-type]
        case ast.Name(name):
            return names[name]
        case ast.UnaryOp(ast.USub(), inner):
            return -_value(inner, names)
        case ast.BinOp(left, operation, right):
            return _OPERATIONS[type(operation)](_value(left, names), _value(right, names))
        case ast.Call(ast.Name(function), arguments):
            return _FUNCTIONS[function](*(_value(one, names) for one in arguments))
    raise AssertionError(f"{ast.dump(node)} is no formula")


_OPERATIONS: dict[type[ast.operator], Callable[[Jet, Jet], Jet]] = {
    ast.Add: lambda a, b: a + b,
    ast.Sub: lambda a, b: a - b,
    ast.Mult: lambda a, b: a * b,
    ast.Div: lambda a, b: a * _inverse(b),
    ast.Pow: _power,
}


@dataclass(frozen=True)
class Solved:
    """What printed equations say at a state.

    Attributes
    ----------
    jets : mapping of str to Jet
        Every coordinate with its rate and acceleration, the time and the constants.
    places : mapping of str to Jet
        The columns of bodies.
    rank : int
        Of the equations for accelerations and multipliers; `unknowns`, how many these are.
    """

    jets: Mapping[str, Jet]
    places: Mapping[str, Jet]
    rank: int
    unknowns: int


def solved(equations: SceneEquations, columns: Mapping[str, Jet], time: float = 0.0) -> Solved:
    """Return the accelerations that printed equations have.

    Parameters
    ----------
    equations : SceneEquations
    columns : mapping of str to Jet
        Values and rates of the columns by which the coordinates are given.
    """
    jets = {name: Jet(mpmath.mpf(x)) for name, x in equations.constants.items()}
    jets["t"] = Jet(mpmath.mpf(time), mpmath.mpf(1))
    for name, text in equations.coordinates.items():
        # What no column shows has a rate, of a turn about an axis of space; its value is nowhere used.
        given = columns.get(name, Jet(mpmath.mpf(0))) if text is None else evaluated(text, columns | jets)
        jets[name] = Jet(given.value, given.rate)
    every = " ".join(one.plain for one in equations.equations)
    for name, formula in equations.forces.items():
        # Those of connections have accelerations in them, and are in no equation.
        if name in every:
            jets[name] = Jet(evaluated(formula.plain, jets).value)
    multipliers = sorted(set(re.findall(r"lambda_\d+", every)))
    # Rates of turn about the axes of a body have equations of the first order.
    first_order = {name for name in equations.coordinates if re.search(r"\.(omega|gamma)_[123]$", name)}
    unknowns = [*equations.coordinates, *multipliers]

    def residuals(values: Sequence[Number]) -> list[Number]:
        tried = dict(jets)
        for name, value in zip(unknowns, values, strict=True):
            known = jets.get(name)
            if known is None:
                tried[name] = Jet(value)
            elif name in first_order:
                tried[name] = Jet(known.value, value)
            else:
                tried[name] = Jet(known.value, known.rate, value)
        found = []
        for one in equations.equations:
            left, right = one.plain.split(" = ")
            found.append((evaluated(left, tried) - evaluated(right, tried)).value)
        for one in equations.constraints:
            held = evaluated(one.plain.removesuffix(" = 0"), tried)
            found.append(held.rate if "'" in one.plain else held.gain)
        return found

    zero = [mpmath.mpf(0)] * len(unknowns)
    base = residuals(zero)
    matrix = np.zeros((len(base), len(unknowns)))
    exact = mpmath.matrix(len(base), len(unknowns))
    for k in range(len(unknowns)):
        moved = residuals([*zero[:k], mpmath.mpf(1), *zero[k + 1 :]])
        for i, (x, y) in enumerate(zip(moved, base, strict=True)):
            exact[i, k] = x - y
            matrix[i, k] = float(x - y)
    rank = int(np.linalg.matrix_rank(matrix)) if matrix.size else 0
    if unknowns:
        values = mpmath.lu_solve(exact, -mpmath.matrix(base))
        for name, value in zip(unknowns, values, strict=True):
            known = jets.get(name, Jet(mpmath.mpf(0)))
            if name in multipliers:
                jets[name] = Jet(value)
            elif name in first_order:
                jets[name] = Jet(known.value, value)
            else:
                jets[name] = Jet(known.value, known.rate, value)
    places = {column: evaluated(plain(node), jets) for column, node in equations.places.items()}
    return Solved(jets, places, rank, len(unknowns))
