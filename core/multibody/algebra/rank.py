"""Linear equations in balls, solved sparsely, with what they leave open.

An entry that cannot be told from zero is zero: in balls of 320 bits the gap between what cancels and what does not is
wide (1e-90 against anything that a description of bounded digits can mean), and rank is decided there.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence

from core.multibody.algebra.polynomials import ZERO, Ball, is_zero

Line = dict[int, Ball]


class Elimination:
    """Equations in reduced echelon form, built up one by one.

    Attributes
    ----------
    pivots : dict of int to (line, value)
        For each determined unknown: its line, in which it has the coefficient one and only free unknowns beside it.

    Parameters
    ----------
    priority : sequence of int, optional
        Which unknowns to determine first: those of larger numbers.
    """

    def __init__(self, priority: Sequence[int] = ()) -> None:
        self.pivots: dict[int, tuple[Line, Ball]] = {}
        self._priority = priority

    def _merit(self, unknown: int, coefficient: Ball) -> tuple[int, float]:
        return (self._priority[unknown] if self._priority else 0, abs(float(coefficient.mid())))

    def add(self, line: Mapping[int, Ball], value: Ball) -> Ball | None:
        """Add an equation; return None if it determined something, else what is left of its right-hand side."""
        rest, value = self.reduced(line, value)
        if not rest:
            return value
        pivot = max(rest, key=lambda j: self._merit(j, rest[j])) if len(rest) > 1 else next(iter(rest))
        factor = rest.pop(pivot)
        rest = {j: x / factor for j, x in rest.items()}
        value = value / factor
        for j, (other, right) in self.pivots.items():
            x = other.pop(pivot, None)
            if x is not None:
                for k, y in rest.items():
                    _subtract(other, k, x * y)
                self.pivots[j] = (other, right - x * value)
        self.pivots[pivot] = (rest, value)
        return None

    def copy(self) -> Elimination:
        """Return the same equations, to which others can be added."""
        found = Elimination(self._priority)
        found.pivots = {j: (dict(line), value) for j, (line, value) in self.pivots.items()}
        return found

    def reduced(self, line: Mapping[int, Ball], value: Ball) -> tuple[Line, Ball]:
        """Return an equation with every determined unknown replaced."""
        rest: Line = {}
        for j, x in line.items():
            if j in self.pivots:
                other, right = self.pivots[j]
                value = value - x * right
                for k, y in other.items():
                    _subtract(rest, k, x * y)
            else:
                _subtract(rest, j, -x)
        return {j: x for j, x in rest.items() if not is_zero(x)}, value

    def solution(self, unknowns: Iterable[int]) -> list[Ball]:
        """Return the solution in which what is free is zero."""
        return [self.pivots[j][1] if j in self.pivots else ZERO for j in unknowns]


def independent(lines: Iterable[Mapping[int, Ball]], share: float = 0.0) -> list[int]:
    """Return the numbers of the lines that do not depend on those before them.

    Lines of which no more than a share is left beside those before depend on them, too, where they are known to that
    share only.
    """
    elimination = Elimination()
    found = []
    for i, line in enumerate(lines):
        if share > 0.0 and _largest(elimination.reduced(line, ZERO)[0]) <= share * _largest(line):
            continue
        if elimination.add(line, ZERO) is None:
            found.append(i)
    return found


def _largest(line: Mapping[int, Ball]) -> float:
    return max((abs(float(x.mid())) for x in line.values()), default=0.0)


def _subtract(line: Line, key: int, value: Ball) -> None:
    old = line.get(key)
    if old is None:
        line[key] = -value
        return
    difference = old - value
    if is_zero(difference):
        del line[key]
    else:
        line[key] = difference
