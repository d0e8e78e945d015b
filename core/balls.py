"""The working precision of ball arithmetic, which the library holds once per process; balls in words.

References
----------
F. Johansson, "Arb: efficient arbitrary-precision midpoint-radius interval arithmetic", IEEE Transactions on Computers
66 (2017).
"""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from math import inf, isfinite, nextafter
from threading import RLock

from flint import arb, ctx


class Undetermined(ArithmeticError):
    """An enclosure is too wide for a decision or a digit; a higher precision makes it narrower."""


def as_text(ball: arb, digits: int) -> str:
    """Return the middle of a ball as text; also beyond the range of doubles, where it is written with all digits."""
    value = float(ball.mid())
    plain = isfinite(value) and (value != 0.0 or ball.mid() == 0)
    return f"{value:.{digits}g}" if plain else str(ball.mid().str(digits, radius=False))


def distance_bound(ball: arb, value: float) -> float | None:
    """Return a bound of how far a double is from the number in a ball; None where no double bounds it."""
    if not isfinite(value):
        return None
    apart = abs(ball - arb(value)).upper()
    if apart == 0:
        return 0.0
    bound = nextafter(float(apart), inf)
    return bound if isfinite(bound) else None


def raised(ball: arb, exponent: arb | int) -> arb:
    """Return a power of a ball; a whole power by multiplication, as the library's is no number around zero."""
    exponent = arb(exponent)
    only = exponent.unique_fmpz()
    if only is None or not exponent.is_integer():
        return ball**exponent
    whole = int(only)
    found = arb(1)
    for bit in bin(abs(whole))[2:]:
        found = found * found * ball if bit == "1" else found * found
    return 1 / found if whole < 0 else found


# Held while the precision is changed, so that no thread computes at the precision of another.
_precision_lock = RLock()


@contextmanager
def precision(bits: int) -> Iterator[None]:
    """Set the working precision to `bits` inside the block."""
    with _precision_lock, ctx.workprec(bits):
        yield
