"""Slips that begin from rest in space, as series: friction has the direction of what follows from it.

With the lines a and b of a slip, of which a is the direction in which it begins, let the slip be t^m w (c, s) with the
unit vector (c, s) = (1, 0) at the start. Friction is -mu N (c, s) with the push N. Coefficient k of s is that of the
friction along b, a multiplier of its own, and the slip along b is what it says: with an acceleration (m = 1) both have
the coefficient k of s, so that the slip gives way in proportion to the friction; with a later power the slip follows
from coefficients found before, and is held to it.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field

from core.multibody.algebra.polynomials import ONE, ZERO, Ball, is_zero
from core.multibody.laws.series import convolved
from core.multibody.table.table import Row, Table

Series = list[Ball]
"""Coefficients of powers of time, lowest first."""


@dataclass
class Onset:
    """The slip of one row from rest, as far as its coefficients are found.

    Attributes
    ----------
    factor : ball
        The coefficient of friction below zero.
    along, across : mapping of int to ball
    push : Series
        N, which belongs to the motion that is expanded.
    begins : int or None
        The power m, None until it is found.
    cosine, sine : Series
        Of the direction.
    size : Series
        w, from the power m of the slip on.
    """

    factor: Ball
    along: Mapping[int, Ball]
    across: Mapping[int, Ball]
    push: Series
    begins: int | None
    cosine: Series = field(default_factory=lambda: [ONE])
    sine: Series = field(default_factory=lambda: [ZERO])
    size: Series = field(default_factory=list)

    @classmethod
    def of(cls, row: Row, push: Series) -> Onset:
        """Return the onset of a row, from its push."""
        assert row.slide is not None
        factor, along, across = row.slide
        first, second = ({j: poly[()] for j, poly in line.items()} for line in (along, across))
        return cls(factor, first, second, push, row.begins)

    def drag(self, k: int) -> Ball:
        """Return what the turning until order k adds to the friction along the first line."""
        squares = (convolved(x[1:], x[1:]) for x in (self.cosine, self.sine))
        self.cosine.append(-sum(squares, ZERO) / 2)
        return self.factor * sum((self.cosine[i] * self.push[k - i] for i in range(1, k + 1)), ZERO)

    def compliance(self, k: int) -> Ball:
        """Return by how much the slip gives way to a unit of the friction across, at order k."""
        return (k + 1) * self.size[0] / (self.factor * self.push[0]) if self.begins == 1 else ZERO

    def slip_across(self, k: int) -> Ball:
        """Return coefficient k of the acceleration of the slip across, but for what it gives way at that order."""
        if self.begins is None or k + 1 < self.begins:
            return ZERO
        found = sum((self.size[i] * self.sine[j] for i, j in _pairs(k + 1 - self.begins, self.size, self.sine)), ZERO)
        if self.begins == 1:
            found = found - self.size[0] / self.push[0] * self._pushed(k)
        return (k + 1) * found

    def find(self, k: int, friction: Ball, gains: Sequence[Ball]) -> None:
        """Take up coefficient k of the friction across and of the accelerations."""
        if k:
            self.sine.append((friction / self.factor - self._pushed(k)) / self.push[0])
        slip = sum((x * gains[j] for j, x in self.along.items()), ZERO) / (k + 1)
        if self.begins is None and not is_zero(slip):
            self.begins = k + 1
        if self.begins is not None and k + 1 >= self.begins:
            own = k + 1 - self.begins
            self.size.append(slip - sum((self.size[i] * self.cosine[own - i] for i in range(own)), ZERO))

    def _pushed(self, k: int) -> Ball:
        """Return the sum of N_i s_(k-i) over 0 < i < k."""
        return sum((self.push[i] * self.sine[k - i] for i in range(1, k)), ZERO)


def _pairs(total: int, first: Series, second: Series) -> list[tuple[int, int]]:
    """Return the indices of found coefficients of two series that add up to a number."""
    return [(i, total - i) for i in range(total + 1) if i < len(first) and total - i < len(second)]


def rests(table: Table, row: Row) -> bool:
    """Return whether friction of a row would turn with a slip, and there is none."""
    return row.slide is not None and all(is_zero(x) for x in table.slip_of(row))
