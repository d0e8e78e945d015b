"""Functions given by points, between which they are straight lines or a natural cubic spline.

Each is a formula of as many pieces as there are intervals, so that every corner is an event of the motion.

References
----------
C. de Boor, *A Practical Guide to Splines*, chapter IV.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from itertools import pairwise

from flint import arb, arb_mat

from core.errors import InvalidParameter, Path
from core.formulas import Node
from core.multibody.algebra.polynomials import ONE, ZERO, Ball
from core.near_names import did_you_mean

MOST_POINTS = 60
"""Points of a table: the pieces of a formula with one of them are as many as formulas may have nodes, or so."""

_DIGITS = 96
"""Digits of a number: as many as the precision of the set-up has."""

_FIELDS = ("points", "interpolation", "outside")
_INTERPOLATIONS, _OUTSIDE = ("linear", "cubic"), ("constant", "end")


@dataclass(frozen=True)
class Tabulated:
    """A function by intervals.

    Attributes
    ----------
    places : tuple of str
        Where the intervals begin, and where the last one ends, as digits.
    pieces : tuple of tuples of str
        Of each interval, the coefficients of the powers of the distance from where it begins.
    outside : tuple of two str, or None
        Values before and after; None where it has none there.
    """

    places: tuple[str, ...]
    pieces: tuple[tuple[str, ...], ...]
    outside: tuple[str, str] | None

    def of(self, argument: Node) -> Node:
        """Return the formula of the function of an argument."""
        before, after = (_nowhere(argument),) * 2 if self.outside is None else map(_number, self.outside)
        inside = Node("if", inner=(self._beyond(argument, 0), self._between(argument, 0, len(self.pieces)), before))
        return Node("if", inner=(self._beyond(argument, -1), after, inside))

    def _between(self, argument: Node, first: int, end: int) -> Node:
        """Return the formula that holds on some intervals."""
        if end - first > 1:
            middle = (first + end) // 2
            sides = (self._between(argument, middle, end), self._between(argument, first, middle))
            return Node("if", inner=(self._beyond(argument, middle), *sides))
        found = _number(self.pieces[first][-1])
        for factor in self.pieces[first][-2::-1]:
            found = _sum(_number(factor), _product(self._beyond(argument, first), found))
        return found

    def _beyond(self, argument: Node, place: int) -> Node:
        start = _number(self.places[place])
        return argument if _equals(start, ZERO) else Node("-", inner=(argument, start))


def _equals(node: Node, value: Ball) -> bool:
    return node.kind == "number" and bool(arb(node.text) == value)


def _sum(a: Node, b: Node) -> Node:
    """Return a sum as it would be written: without a zero."""
    return b if _equals(a, ZERO) else a if _equals(b, ZERO) else Node("+", inner=(a, b))


def _product(a: Node, b: Node) -> Node:
    """Return a product as it would be written: without a one, and zero by itself."""
    return b if _equals(b, ZERO) else a if _equals(b, ONE) else Node("*", inner=(a, b))


def _nowhere(argument: Node) -> Node:
    """Return a formula of an argument that has no value anywhere."""
    square = Node("+", inner=(Node("number", "1"), Node("*", inner=(argument, argument))))
    return Node("sqrt", inner=(Node("negative", inner=(square,)),))


def _number(digits: str) -> Node:
    return Node("number", digits)


def is_table(value: object) -> bool:
    """Return whether something in `let` is meant as a table of points."""
    return isinstance(value, Mapping) and "points" in value


def tabulated(value: Mapping[str, object], number: Callable[[object, Path], Ball], path: Path) -> Tabulated:
    """Return the function that a table states.

    Parameters
    ----------
    value : mapping
        As it was written: ``points``, and ``interpolation`` and ``outside`` if they are given.
    number : callable
        Reads a number at a path.

    Raises
    ------
    InvalidParameter
        For a table that states no function.
    """
    for key in value:
        if key not in _FIELDS:
            rule = f"be left out; the fields here are {', '.join(_FIELDS)}"
            raise InvalidParameter((*path, str(key)[:64]), rule, remedy=did_you_mean(str(key), _FIELDS))
    by, outside = value.get("interpolation", "linear"), value.get("outside", "end")
    for field, given, words in (("interpolation", by, _INTERPOLATIONS), ("outside", outside, _OUTSIDE)):
        if given not in words:
            raise InvalidParameter((*path, field), f"be one of {', '.join(words)}", remedy=did_you_mean(given, words))
    points, where = value["points"], (*path, "points")
    if isinstance(points, str) or not isinstance(points, Sequence) or not 2 <= len(points) <= MOST_POINTS:
        raise InvalidParameter(where, f"be a list of 2 to {MOST_POINTS} points")
    x, y = [], []
    for i, point in enumerate(points):
        if isinstance(point, str) or not isinstance(point, Sequence) or len(point) != 2:
            raise InvalidParameter((*where, i), "be a list of two numbers: a place, and the value there")
        x.append(number(point[0], (*where, i, 0)))
        y.append(number(point[1], (*where, i, 1)))
        if i and not x[i] > x[i - 1]:
            raise InvalidParameter((*where, i, 0), "be greater than that of the point before it")
    bends = _bends(x, y) if by == "cubic" else [ZERO] * len(x)
    pieces = []
    for i, h in enumerate(b - a for a, b in pairwise(x)):
        slope = (y[i + 1] - y[i]) / h - h * (2 * bends[i] + bends[i + 1]) / 6
        line = [y[i], slope]
        pieces.append(line if by == "linear" else [*line, bends[i] / 2, (bends[i + 1] - bends[i]) / (6 * h)])
    ends = (_digits(y[0]), _digits(y[-1])) if outside == "constant" else None
    return Tabulated(tuple(map(_digits, x)), tuple(tuple(map(_digits, piece)) for piece in pieces), ends)


def _bends(x: Sequence[Ball], y: Sequence[Ball]) -> list[Ball]:
    """Return the second derivatives of a natural cubic spline at its points."""
    n = len(x)
    rows, right = [[ZERO] * n for _ in range(n)], [[ZERO] for _ in range(n)]
    rows[0][0] = rows[-1][-1] = ONE
    for i in range(1, n - 1):
        before, after = x[i] - x[i - 1], x[i + 1] - x[i]
        rows[i][i - 1], rows[i][i], rows[i][i + 1] = before, 2 * (before + after), after
        right[i][0] = 6 * ((y[i + 1] - y[i]) / after - (y[i] - y[i - 1]) / before)
    return arb_mat(rows).solve(arb_mat(right)).entries()


def _digits(number: Ball) -> str:
    return str(number.str(_DIGITS, radius=False))
