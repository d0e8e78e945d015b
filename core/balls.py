"""The working precision of ball arithmetic, which the library holds once per process, and the lock that protects it.

References
----------
F. Johansson, "Arb: efficient arbitrary-precision midpoint-radius interval arithmetic", IEEE Transactions on Computers
66 (2017).
"""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from threading import RLock

from flint import ctx


class Undetermined(ArithmeticError):
    """An enclosure is too wide for a decision or a digit; a higher precision makes it narrower."""


# Held while the precision is changed, so that no thread computes at the precision of another.
_precision_lock = RLock()


@contextmanager
def precision(bits: int) -> Iterator[None]:
    """Set the working precision to `bits` inside the block."""
    with _precision_lock, ctx.workprec(bits):
        yield
