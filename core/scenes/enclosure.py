"""Numbers with a proven enclosure: the set-up of every scene runs in ball arithmetic and is rounded to doubles once.

A scene has a dozen constants and a handful of instants at which something happens. Computed as balls of 320 bits
they cost microseconds, neither overflow nor underflow, and cancel harmlessly; each decision (taut or slack? which
event first?) is taken on a number whose error is known. Only samples of a trajectory are computed in doubles.

References
----------
F. Johansson, "Arb: efficient arbitrary-precision midpoint-radius interval arithmetic", IEEE Transactions on Computers
66 (2017).
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping
from collections.abc import Set as AbstractSet
from fractions import Fraction
from typing import Any

from flint import acb, arb, fmpq

from core.balls import distance_bound
from core.errors import Path
from core.notices import Notice

Ball = Any
"""A real number of `flint`, midpoint and radius; the package carries no types."""

Balls = tuple[Ball, Ball]
"""The same for the first and the second of two bodies."""

BITS = 320
MORE_BITS = 2048
"""Where 320 bits cancel: ratios of lengths or masses of 1e-90 and beyond that are subtracted from one."""
ZERO: Ball = arb(0)
ONE: Ball = arb(1)
UNIT_ROUNDOFF = 2.0**-53
SMALLEST_NORMAL = 2.0**-1022


def exact(number: float | Fraction) -> Ball:
    """Return a double as a ball of radius zero, a fraction as one of the current precision."""
    if isinstance(number, Fraction):
        return arb(fmpq(number.numerator, number.denominator))
    return arb(float(number))


def exact_pair(numbers: Iterable[float]) -> Balls:
    """Return two numbers as `exact` does."""
    first, second = numbers
    return exact(first), exact(second)


def sign(ball: Ball) -> int:
    """Return the sign, 0 if the ball cannot be told from zero."""
    return 1 if ball > 0 else -1 if ball < 0 else 0


def smaller(first: Ball | None, second: Ball | None) -> Ball | None:
    """Return the smaller of two instants, None being never."""
    if first is None or second is None:
        return second if first is None else first
    return second if second < first else first


def rf(x: Ball, y: Ball, z: Ball) -> Ball:
    """Return Carlson's integral R_F of non-negative arguments."""
    return acb.elliptic_rf(x, y, z).real


def square_root(ball: Ball) -> Ball:
    """Return the root of a number that is not negative, taking what cannot be told from zero as zero."""
    return ball.sqrt() if ball > 0 else ZERO


def angle_of(sine: Ball, cosine: Ball) -> Ball:
    """Return the angle with this sine and cosine, up to a common factor."""
    return arb.atan2(sine, cosine)


def as_pair(ball: Ball) -> tuple[float, float]:
    """Return the number as an unevaluated sum of two doubles."""
    high = float(ball)
    return high, float(ball - arb(high))


def _bound(value: Any, rounded: Any) -> Any:
    """Return a bound of the error of a number that was rounded, or those of several; None where there is none."""
    if rounded is None:
        return None
    if isinstance(value, (tuple, list)):
        return [_bound(*both) for both in zip(value, rounded, strict=True)]
    return distance_bound(value, rounded)


class Rounding:
    """Turns balls into doubles with bounds of their errors, and keeps account of what that cost.

    A mapping gets the bounds of the numbers that it holds: as ``error`` that of a single one, as ``errors`` those of
    several by their names.

    Parameters
    ----------
    measured : set of str
        Keys of numbers that have errors.

    Attributes
    ----------
    errors : dict
        Bounds of the errors of what was rounded at a path of one name, unless it is a mapping.
    error : float
        Bound of the relative error of every number rounded so far.
    notices : list of Notice
        One for every number that a double cannot hold.
    vague : bool
        Whether a number could not be told from zero though it may not be zero.
    """

    def __init__(self, measured: AbstractSet[str]) -> None:
        self.measured = measured
        self.errors: dict[str, Any] = {}
        self.error = 0.0
        self.notices: list[Notice] = []
        self.vague = False

    @property
    def sharp(self) -> bool:
        """Whether the balls were narrow enough for the error to be that of the doubles."""
        return self.error <= 2 * UNIT_ROUNDOFF and not self.vague

    def __call__(self, value: Any, path: Path = ()) -> Any:
        """Return `value` with every ball in it, however deep, as a double, or None where a double cannot hold it."""
        rounded = self._rounded(value, path)
        if len(path) == 1 and path[0] in self.measured:
            self.errors[str(path[0])] = _bound(value, rounded)
        return rounded

    def _rounded(self, value: Any, path: Path) -> Any:
        if isinstance(value, arb):
            return self._number(value, path)
        if isinstance(value, Mapping):
            rounded = {key: self._rounded(entry, (*path, key)) for key, entry in value.items()}
            errors = {key: _bound(value[key], rounded[key]) for key in value if key in self.measured}
            beside = {"error": next(iter(errors.values()))} if len(errors) == 1 else {"errors": errors}
            return rounded | beside if errors else rounded
        if isinstance(value, (tuple, list)):
            return [self._rounded(entry, (*path, i)) for i, entry in enumerate(value)]
        return value

    def _number(self, ball: Ball, path: Path) -> float | None:
        if sign(ball) == 0:
            self.vague = self.vague or not ball.is_zero()
            return 0.0
        number = float(ball)
        if not math.isfinite(number) or abs(number) < SMALLEST_NORMAL:
            self.notices.append(
                Notice("outside-double-range", f"{'/'.join(map(str, path))} is too large or too small for a double")
            )
            return None
        self.error = max(self.error, UNIT_ROUNDOFF + float(ball.rad() / abs(ball.mid())))
        return number
