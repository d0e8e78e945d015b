"""Linear equations in balls, solved sparsely, with what they leave open.

An entry that cannot be told from zero is zero: in balls of 320 bits the gap between what cancels and what does not is
wide (1e-90 against anything that a description of bounded digits can mean), and rank is decided there.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence

from core.multibody.algebra.polynomials import ZERO, Ball, is_zero
from core.multibody.algebra.recordable import recordable

Line = dict[int, Ball]

CLEAR = 2.0**-20
"""Share of a line that is left beside the others, from which on nothing but the line itself can have left it: far above
what roundings of doubles (2^-53) leave of a line that depends on others, far below what angles of a description leave.
What is between is still told from zero by its ball, only after the lines that are clear."""


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

    def _pivot(self, rest: Line) -> int:
        """Return which unknown of an equation to determine: of those of the first priority the one that counts most."""
        first = max((self._priority[j] for j in rest), default=0) if self._priority else 0
        unknowns = [j for j in rest if not self._priority or self._priority[j] == first]
        return unknowns[largest_of([rest[j] for j in unknowns])] if len(unknowns) > 1 else unknowns[0]

    def add(self, line: Mapping[int, Ball], value: Ball) -> Ball | None:
        """Add an equation; return None if it determined something, else what is left of its right-hand side."""
        rest, value = self.reduced(line, value)
        if not rest:
            return value
        self.determine(rest, value)
        return None

    def determine(self, rest: Line, value: Ball) -> None:
        """Add an equation of free unknowns only, of which there is at least one."""
        pivot = self._pivot(rest) if len(rest) > 1 else next(iter(rest))
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
    """Return the numbers of lines on which all others depend, in order, each of which depends on none of the rest.

    Of several such choices it is one that holds well: a line of which little is left beside those before it is tried
    after all the others, since beside a better one nothing but its rounding may be left of it.

    Lines of which no more than a share is left beside those before depend on them, too, where they are known to that
    share only.
    """
    elimination = Elimination()
    found, doubtful = [], []
    for i, line in enumerate(lines):
        rest = elimination.reduced(line, ZERO)[0]
        if is_share_of([*rest.values()], max(share, CLEAR), [*line.values()]):
            doubtful.append((i, line))
        else:
            elimination.determine(rest, ZERO)
            found.append(i)
    for i, line in doubtful:
        rest = elimination.reduced(line, ZERO)[0]
        if rest and not is_share_of([*rest.values()], share, [*line.values()]):
            elimination.determine(rest, ZERO)
            found.append(i)
    return sorted(found)


@recordable
def largest_of(numbers: Sequence[Ball]) -> int:
    """Return the place of the largest magnitude among numbers, to the digits of doubles."""
    sizes = [abs(float(x.mid())) for x in numbers]
    return sizes.index(max(sizes))


@recordable
def is_share_of(numbers: Sequence[Ball], share: float, others: Sequence[Ball]) -> bool:
    """Return whether the largest of numbers is at most a share of the largest of others, to the digits of doubles.

    Of what cancels, others leave as much as they are wide: what is taken for zero on the way has that width no more.
    """
    sizes, whole = ([abs(float(x.mid())) for x in one] for one in (numbers, others))
    wide = max((float(x.rad()) for x in others), default=0.0)
    return max(sizes, default=0.0) <= max(share * max(whole, default=0.0), wide)


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
